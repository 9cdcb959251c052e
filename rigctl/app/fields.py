"""KEY=VALUE words of a command line as values.

Job: one way to read them for all commands. Not its job: what the keys mean.
"""

from __future__ import annotations

import json
import re
from typing import Any

from rigctl.core.errors import ConfigError


def parsed_fields(fields: list[str], command: str) -> dict[str, Any]:
    """KEY=VALUE pairs; a value is a JSON value or a hexadecimal number, else a text.

    Raises
    ------
    ConfigError
        One of them is no pair.
    """
    found: dict[str, Any] = {}
    for field in fields:
        key, sign, text = field.partition("=")
        if not sign or not key.isidentifier() or key in ("to", "do"):
            raise ConfigError(
                f"{field!r} is not KEY=VALUE.",
                place=command,
                value=field,
                remedy="E.g. for_s=2.",
            )
        found[key] = _value(text)
    return found


def _value(text: str) -> Any:
    if re.fullmatch(r"0[xX][0-9a-fA-F]+", text):
        return int(text, 16)
    try:
        return json.loads(text)
    except ValueError:
        return text
