"""Reading TOML into models, and the one translator of validation errors into a person's language.

Job: `load_model` for any pydantic model, `translated` around any loader that lets `OSError`,
`TOMLDecodeError` or `ValidationError` out (programs, brakes, plants). Result: one `ConfigError` whose text
has a line per fault: ``file: key = value: problem. Remedy``. Not its job: what is valid.
"""

from __future__ import annotations

import difflib
import os
import tomllib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from rigctl.core.errors import ConfigError

Model = TypeVar("Model", bound=BaseModel)

_MAX_FAULTS = 12
_REMEDIES = {
    "missing": "Add this key.",
    "extra_forbidden": "Remove it or correct its name.",
    "finite_number": "Give a finite number; nan and inf are not accepted.",
    "float_type": "Give a number.",
    "float_parsing": "Give a number, without a unit in the value: the unit is part of the key's name.",
    "int_type": "Give a whole number.",
    "int_parsing": "Give a whole number.",
    "int_from_float": "Give a whole number.",
    "string_type": "Give a text in quotes.",
    "bool_type": "Give true or false.",
    "list_type": "Give a list: [ … ].",
    "tuple_type": "Give a list: [ … ].",
    "model_type": "Give a table with the keys of this section.",
    "dict_type": "Give a table.",
}


def read_toml(path: Path) -> dict[str, Any]:
    """Content of a TOML file.

    Raises
    ------
    ConfigError
        The file is missing, cannot be read, or is not TOML.
    """
    with translated(path), path.open("rb") as file:
        return tomllib.load(file)
    raise AssertionError  # `translated` has raised


def load_model(path: Path, model: type[Model]) -> Model:
    """Read and validate a file.

    Raises
    ------
    ConfigError
        With one line for each fault.
    """
    mapping = read_toml(path)
    with translated(path, mapping, model):
        return model.model_validate(mapping)
    raise AssertionError  # `translated` has raised


@contextmanager
def translated(
    path: Path, mapping: Mapping[str, Any] | None = None, model: type[BaseModel] | None = None
) -> Iterator[None]:
    """Turn what a loader raises into a `ConfigError` that names file, key, value and remedy."""
    place = _display(path)
    try:
        yield
    except FileNotFoundError as error:
        raise ConfigError("no such file.", place=place, remedy=_near_file(path)) from error
    except IsADirectoryError as error:
        raise ConfigError(
            "this is a folder, not a file.", place=place, remedy="Name a .toml file."
        ) from error
    except UnicodeDecodeError as error:
        raise ConfigError("not a text file in UTF-8.", place=place, remedy="Name a .toml file.") from error
    except tomllib.TOMLDecodeError as error:
        raise ConfigError(
            f"not valid TOML: {error}.", place=place, remedy="Correct the line named."
        ) from error
    except OSError as error:
        raise ConfigError(f"cannot be read: {error.strerror}.", place=place) from error
    except ValidationError as error:
        raise ConfigError(describe(error, place, model)) from error


def describe(error: ValidationError, place: str, model: type[BaseModel] | None = None) -> str:
    """All faults of a validation, a line each: ``file: key = value: problem Remedy``."""
    faults = error.errors(include_url=False)
    lines = [_line(fault, place, model) for fault in faults[:_MAX_FAULTS]]
    if len(faults) > _MAX_FAULTS:
        lines.append(f"{place}: … and {len(faults) - _MAX_FAULTS} more faults.")
    return "\n".join(lines)


def _line(fault: Any, place: str, model: type[BaseModel] | None) -> str:
    kind, location, value = fault["type"], fault["loc"], fault.get("input")
    context = fault.get("ctx") or {}
    key = _key(location)
    problem = str(fault["msg"]).removeprefix("Value error, ").rstrip(".")
    remedy = str(context.get("remedy") or "")
    if kind == "extra_forbidden":
        known = _known_keys(model, location[:-1])
        near = difflib.get_close_matches(str(location[-1]), known, n=1)
        problem = "unknown key"
        if near:
            remedy = f"Did you mean {near[0]!r}?"
        elif known:
            remedy = f"Known keys here: {', '.join(known)}."
    elif kind == "missing":
        problem = "missing"
    if not remedy:
        remedy = _REMEDIES.get(kind) or _bounds_remedy(context)
    shown = "" if kind == "missing" or isinstance(value, (Mapping, BaseModel)) else f" = {_short(value)}"
    where = f"{place}: {key}{shown}" if key else place
    return f"{where}: {problem}. {remedy}".rstrip()


def _key(location: tuple[int | str, ...]) -> str:
    text = ""
    for part in location:
        if isinstance(part, int):
            text += f"[{part}]"
        elif part.isidentifier() or "-" in part:
            text += f".{part}" if text else part
    return text


def _bounds_remedy(context: Mapping[str, Any]) -> str:
    words = {"ge": "at least", "gt": "more than", "le": "at most", "lt": "less than"}
    bounds = [f"{words[name]} {context[name]}" for name in words if name in context]
    if bounds:
        return f"Give a value of {' and '.join(bounds)}."
    return f"Expected {context['expected']}." if "expected" in context else "Correct the value."


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "…"


def _known_keys(model: type[BaseModel] | None, location: tuple[int | str, ...]) -> list[str]:
    """Names of the fields at a place of a model, as far as they can be followed."""
    for part in location:
        if model is None:
            return []
        if isinstance(part, int):
            continue
        field = model.model_fields.get(part)
        if field is None:
            field = next((f for f in model.model_fields.values() if f.alias == part), None)
        if field is None:
            continue  # the name of a variant of a union
        model = _model_in(field.annotation, location)
    if model is None:
        return []
    return [field.alias or name for name, field in model.model_fields.items()]


def _model_in(annotation: Any, location: tuple[int | str, ...]) -> type[BaseModel] | None:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    found = [_model_in(argument, location) for argument in getattr(annotation, "__args__", ())]
    models = [model for model in found if model is not None]
    return models[0] if len(models) == 1 else None


def _display(path: Path) -> str:
    try:
        relative = os.path.relpath(path)
    except ValueError:
        return str(path)
    return str(path) if relative.startswith("..") else relative


def _near_file(path: Path) -> str:
    folder = path.parent
    if not folder.is_dir():
        return f"There is no folder {_display(folder)} either."
    names = sorted(entry.name for entry in folder.glob("*.toml"))
    near = difflib.get_close_matches(path.name, names, n=1)
    if near:
        return f"Did you mean {near[0]!r}?"
    return f"In that folder there are: {', '.join(names[:8])}." if names else "Check the path."
