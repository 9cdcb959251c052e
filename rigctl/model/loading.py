"""Reading a model for studies, whatever it is: brake file, or matrices made elsewhere; errors for people.

Job: choose the reader by the file's kind, translate what the numerics raise. NOT its job: the formats
themselves (`sim_hardware.brake_model.spec`, `.foreign`).
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from pydantic import ValidationError

from rigctl.config.loading import translated
from rigctl.core.errors import ConfigError
from sim_hardware.brake_model.assembly import Brake, load_brake
from sim_hardware.brake_model.spec import BrakeSpec

if TYPE_CHECKING:
    from sim_hardware.brake_model.linear import LinearModel


def read_brake_file(path: Path) -> Brake:
    """Load a brake file, whatever its name.

    Raises
    ------
    ConfigError
        names file, key, value and remedy
    """
    with translated(path, model=BrakeSpec):
        return load_brake(path)
    raise AssertionError  # `translated` has raised


def read_brake(path: Path) -> Brake:
    """Load a brake file for a study that needs bodies and contacts; matrices are refused by their name.

    Raises
    ------
    ConfigError
        names file, key, value and remedy
    """
    if path.suffix != ".toml" and path.exists():
        raise ConfigError(
            "this study needs a brake with bodies and contacts, not matrices.",
            place=str(path),
            remedy="Name a brake file, for example configs/brakes/model.toml.",
        )
    return read_brake_file(path)


def read_model(path: Path) -> LinearModel:
    """Load a brake file (.toml) or matrices made elsewhere (.npz, .mat, folder of .mtx) for linear studies.

    Raises
    ------
    ConfigError
        names file, key, value and remedy
    """
    if path.suffix == ".toml":
        from sim_hardware.brake_model.parametric import LinearBrake

        return LinearBrake(read_brake(path))
    from sim_hardware.brake_model.foreign.files import load_matrices

    with translated(path), study_errors(str(path)):
        return load_matrices(path)
    raise AssertionError  # `translated` has raised


@contextmanager
def study_errors(place: str) -> Iterator[None]:
    """Turn what the numerics raise for wrong input (KeyError, ValueError, …) into a `ConfigError`."""
    try:
        yield
    except ConfigError:
        raise
    except ValidationError as error:
        raise ConfigError(f"{error.errors()[0]['msg']}.", place=place) from error
    except KeyError as error:
        raise ConfigError(f"{error.args[0]}.", place=place) from error
    except (ValueError, ArithmeticError, np.linalg.LinAlgError) as error:
        raise ConfigError(f"{error}.", place=place) from error
