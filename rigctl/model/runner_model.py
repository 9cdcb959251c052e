"""The model of a study as data that travels to workers: a brake file as its text, matrices by path and
digest.

Job: `model_source`, `load_source`. NOT its job: the formats (`rigctl.model.loading`), sending anything
anywhere.
"""

from __future__ import annotations

import hashlib
import tomllib
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

from rigctl.core.errors import ConfigError
from rigctl.model.loading import read_model
from sim_hardware.brake_model.linear import LinearModel


def model_source(path: Path) -> dict[str, Any]:
    """JSON-able description of a model file that `load_source` turns into the model, here or on a worker.

    A brake file travels as its text. Matrices made elsewhere may be large: they travel as path and digest,
    and workers on other machines must see the same file system.

    Raises
    ------
    ConfigError
        the model cannot be read
    """
    read_model(path)  # refused here with file, key and remedy rather than by a worker
    if path.suffix == ".toml":
        text = path.read_text(encoding="utf-8")
        return {"name": path.name, "sha256": hashlib.sha256(text.encode()).hexdigest(), "text": text}
    return {"name": path.name, "sha256": _digest(path), "path": str(path.resolve())}


def load_source(source: Mapping[str, Any]) -> LinearModel:
    """The model of a description; read once in each process.

    Raises
    ------
    ConfigError
        the file is not there, or is another one than when the study was started
    """
    return _loaded(source["name"], source["sha256"], source.get("text"), source.get("path"))


@lru_cache(maxsize=4)
def _loaded(name: str, sha256: str, text: str | None, path: str | None) -> LinearModel:
    if text is not None:
        from sim_hardware.brake_model.assembly import Brake
        from sim_hardware.brake_model.parametric import LinearBrake
        from sim_hardware.brake_model.spec import BrakeSpec

        model: Any = LinearBrake(Brake(BrakeSpec.model_validate(tomllib.loads(text))))
        return model
    file = Path(path or name)
    if not file.exists() or _digest(file) != sha256:
        raise ConfigError(
            "a worker does not find the model that the study was started with.",
            place=str(file),
            remedy="Put the model on a file system that all workers share, and leave it as it is.",
        )
    return read_model(file)


def _digest(path: Path) -> str:
    files = sorted(p for p in path.rglob("*") if p.is_file()) if path.is_dir() else [path]
    digest = hashlib.sha256()
    for file in files:
        digest.update(file.name.encode() + b"\0" + file.read_bytes())
    return digest.hexdigest()
