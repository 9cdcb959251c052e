"""All expressions of a brake file as one function of its parameters, with exact derivatives.

Nearly all expressions are linear in the parameters: those are one matrix product; products and quotients of
parameters are evaluated one by one. NOT its job: validation and units (`expressions`, `spec` have done that).
"""

from __future__ import annotations

import ast
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
#: value and gradient
Dual = tuple[float, Array]


class Formulas:
    """Values of expressions over a vector of parameters.

    Parameters
    ----------
    texts : expression of each place, checked before
    parameters : names in the order of the parameter vector

    Attributes
    ----------
    places : names of the places, in the order of all results
    """

    def __init__(self, texts: Mapping[str, str], parameters: Sequence[str]) -> None:
        self.places = tuple(texts)
        self._index = {name: i for i, name in enumerate(parameters)}
        trees = [ast.parse(text.strip(), mode="eval").body for text in texts.values()]
        zero = np.zeros(len(parameters))
        self._constant = np.zeros(len(trees))
        self._linear = np.zeros((len(trees), len(parameters)))
        self._curved: dict[int, ast.expr] = {}
        for row, tree in enumerate(trees):
            if _is_linear(tree):
                self._constant[row], self._linear[row] = self._dual(tree, zero)
            else:
                self._curved[row] = tree

    def values(self, parameters: Array) -> Array:
        """Values of all places, (n_places,), from the parameters, (n_parameters,)."""
        values = self._constant + self._linear @ parameters
        for row, tree in self._curved.items():
            values[row] = self._dual(tree, parameters)[0]
        return values

    def gradient(self, parameters: Array, name: str) -> Array:
        """Derivatives of all places by one parameter, (n_places,)."""
        column = self._index[name]
        gradient = self._linear[:, column].copy()
        for row, tree in self._curved.items():
            gradient[row] = self._dual(tree, parameters)[1][column]
        return gradient

    def _dual(self, node: ast.expr, parameters: Array) -> Dual:
        """Value and gradient of a node: forward differentiation."""
        match node:
            case ast.Constant(value=float() | int() as number):
                return float(number), np.zeros(len(parameters))
            case ast.Name(id=name):
                column = self._index[name]
                gradient = np.zeros(len(parameters))
                gradient[column] = 1.0
                return float(parameters[column]), gradient
            case ast.UnaryOp(op=sign, operand=operand):
                value, gradient = self._dual(operand, parameters)
                return (-value, -gradient) if isinstance(sign, ast.USub) else (value, gradient)
            case ast.BinOp(left=left, op=operator, right=right):
                return _combined(self._dual(left, parameters), operator, self._dual(right, parameters))
        raise AssertionError(f"{ast.dump(node)} was not refused by `expressions`")


def _combined(left: Dual, operator: ast.operator, right: Dual) -> Dual:
    (a, da), (b, db) = left, right
    match operator:
        case ast.Add():
            return a + b, da + db
        case ast.Sub():
            return a - b, da - db
        case ast.Mult():
            return a * b, da * b + a * db
        case _:
            return a / b, (da - a / b * db) / b


def _is_linear(node: ast.expr) -> bool:
    match node:
        case ast.UnaryOp(operand=operand):
            return _is_linear(operand)
        case ast.BinOp(left=left, op=ast.Add() | ast.Sub(), right=right):
            return _is_linear(left) and _is_linear(right)
        case ast.BinOp(left=left, op=ast.Mult(), right=right):
            return (_is_linear(left) and _is_number(right)) or (_is_number(left) and _is_linear(right))
        case ast.BinOp(left=left, right=right):
            return _is_linear(left) and _is_number(right)
    return True


def _is_number(node: ast.expr) -> bool:
    return not any(isinstance(inner, ast.Name) for inner in ast.walk(node))
