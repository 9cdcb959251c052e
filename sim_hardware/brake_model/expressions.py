"""Small arithmetic expressions of parameters with units, as written in a brake file ("-x_con", "y_disc +
h_pad").

An expression is parsed into a syntax tree and only whitelisted nodes are evaluated: numbers, parameter names,
unary sign, + - * /. Every value carries its physical dimension, so that adding a length to a mass is refused.
NOT its job: knowing which quantity is expected where (`spec`), or converting units: brake files are SI only.
"""

import ast
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

from pydantic_core import PydanticCustomError


class Dimension(NamedTuple):
    """Exponents of kg, m and s."""

    kg: int
    m: int
    s: int


DIMENSIONLESS = Dimension(0, 0, 0)

#: every unit a brake file may use, with its dimension (rad counts as 1)
UNITS: dict[str, Dimension] = {
    "1": DIMENSIONLESS,
    "rad": DIMENSIONLESS,
    "kg": Dimension(1, 0, 0),
    "kg m2": Dimension(1, 2, 0),
    "m": Dimension(0, 1, 0),
    "m2": Dimension(0, 2, 0),
    "N/m": Dimension(1, 0, -2),
    "N s/m": Dimension(1, 0, -1),
    "N m/rad": Dimension(1, 2, -2),
    "N m s/rad": Dimension(1, 2, -1),
    "N/m3": Dimension(1, -2, -2),
    "N m/rad3": Dimension(1, 2, -2),
    "s/m": Dimension(0, -1, 1),
}

_MAX_LENGTH = 200


@dataclass(frozen=True)
class Quantity:
    """A value in SI units with its dimension."""

    value: float
    dimension: Dimension


def unit_name(dimension: Dimension) -> str:
    """Return the unit of `dimension` as brake files write it, or its exponents where it has no entry."""
    for name, known in UNITS.items():
        if known == dimension:
            return name
    return f"kg^{dimension.kg} m^{dimension.m} s^{dimension.s}"


def refuse(problem: str, *, place: str, value: object, remedy: str) -> PydanticCustomError:
    """Return the error for a brake file: place, problem, offending value and remedy."""
    return PydanticCustomError(
        "brake_file",
        "{place}: {problem}",
        {"place": place, "problem": problem, "value": value, "remedy": remedy},
    )


def evaluate(text: str, parameters: Mapping[str, Quantity], *, place: str) -> Quantity:
    """Evaluate an expression of parameters.

    Parameters
    ----------
    text : the expression, for example "-(y_disc + h_pad) - y_cal"
    parameters : value and dimension of every parameter that may be named
    place : where the expression stands, for messages

    Raises
    ------
    PydanticCustomError
        not arithmetic, unknown parameter, unequal dimensions in a sum, division by zero, result not finite
    """
    if len(text) > _MAX_LENGTH:
        raise refuse(
            f"the expression is longer than {_MAX_LENGTH} characters",
            place=place,
            value=text[:40] + "...",
            remedy="introduce a parameter for the value",
        )
    try:
        tree = ast.parse(text.strip(), mode="eval")
        result = _value(tree.body, parameters, text, place)
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        if isinstance(error, PydanticCustomError):
            raise
        raise refuse(
            f"'{text}' is not an arithmetic expression",
            place=place,
            value=text,
            remedy="write numbers and parameter names joined by + - * / and parentheses",
        ) from error
    if not math.isfinite(result.value):
        raise refuse(
            f"'{text}' is not finite", place=place, value=text, remedy="correct the parameters it names"
        )
    return result


def _value(node: ast.expr, parameters: Mapping[str, Quantity], text: str, place: str) -> Quantity:
    match node:
        case ast.Constant(value=float() | int() as number) if not isinstance(number, bool):
            return Quantity(float(number), DIMENSIONLESS)
        case ast.Name(id=name):
            if name not in parameters:
                raise refuse(
                    f"unknown parameter '{name}' in '{text}'",
                    place=place,
                    value=name,
                    remedy=f"add parameters.{name} or use one of: {', '.join(sorted(parameters))}",
                )
            return parameters[name]
        case ast.UnaryOp(op=ast.UAdd() | ast.USub() as sign, operand=operand):
            inner = _value(operand, parameters, text, place)
            return Quantity(-inner.value if isinstance(sign, ast.USub) else inner.value, inner.dimension)
        case ast.BinOp(left=left, op=operator, right=right):
            return _combine(
                _value(left, parameters, text, place),
                operator,
                _value(right, parameters, text, place),
                text,
                place,
            )
    raise refuse(
        f"'{text}' holds something other than numbers, parameters, + - * / and parentheses",
        place=place,
        value=text,
        remedy="write numbers and parameter names joined by + - * / and parentheses",
    )


def _combine(a: Quantity, operator: ast.operator, b: Quantity, text: str, place: str) -> Quantity:
    match operator:
        case ast.Add() | ast.Sub():
            if a.dimension != b.dimension:
                raise refuse(
                    f"'{text}' adds {unit_name(a.dimension)} to {unit_name(b.dimension)}",
                    place=place,
                    value=text,
                    remedy="add only quantities of the same unit",
                )
            return Quantity(
                a.value + b.value if isinstance(operator, ast.Add) else a.value - b.value, a.dimension
            )
        case ast.Mult():
            return Quantity(
                a.value * b.value, Dimension(*(i + j for i, j in zip(a.dimension, b.dimension, strict=True)))
            )
        case ast.Div() if b.value != 0.0:
            return Quantity(
                a.value / b.value, Dimension(*(i - j for i, j in zip(a.dimension, b.dimension, strict=True)))
            )
        case ast.Div():
            raise refuse(f"'{text}' divides by zero", place=place, value=text, remedy="correct the divisor")
    raise refuse(
        f"'{text}' uses an operator other than + - * /",
        place=place,
        value=text,
        remedy="write numbers and parameter names joined by + - * / and parentheses",
    )
