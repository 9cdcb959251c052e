"""A vector of 16 doubles as a numba value: load, store, multiply-add, horizontal sum.

Numba's loops over short arrays pay for alias checks in every time step and are often not vectorised at all.
With these intrinsics the modes of the brake stay in vector registers for the whole run; LLVM splits the 16
lanes into what the machine has (4 x AVX2, 2 x AVX-512, 8 x NEON).
NOT its job: anything about brakes.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic, models, register_model

LANES = 16
_VECTOR = ir.VectorType(ir.DoubleType(), LANES)
_FAST = ("fast",)


class Vector16Type(types.Type):
    """Numba type of the vector."""

    def __init__(self) -> None:
        super().__init__(name="Vector16")


vector16 = Vector16Type()


@register_model(Vector16Type)
class _Vector16Model(models.PrimitiveModel):
    def __init__(self, dmm: Any, fe_type: Any) -> None:
        super().__init__(dmm, fe_type, _VECTOR)


def _pointer(context: Any, builder: Any, array_type: Any, array: Any, row: Any) -> Any:
    """Pointer to row `row` of a C-contiguous (rows, 16) float64 array."""
    data = cgutils.create_struct_proxy(array_type)(context, builder, array).data
    offset = builder.mul(row, ir.Constant(row.type, LANES))
    return builder.bitcast(builder.gep(data, [offset]), _VECTOR.as_pointer())


@intrinsic
def load(typing_context: Any, array: Any, row: Any) -> Any:
    """Return row `row` of a C-contiguous (rows, 16) float64 array."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        row_index = context.cast(builder, args[1], signature.args[1], types.intp)
        value = builder.load(_pointer(context, builder, signature.args[0], args[0], row_index))
        value.align = 8
        return value

    return vector16(array, row), code


@intrinsic
def store(typing_context: Any, array: Any, row: Any, value: Any) -> Any:
    """Write row `row` of a C-contiguous (rows, 16) float64 array."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        row_index = context.cast(builder, args[1], signature.args[1], types.intp)
        instruction = builder.store(
            args[2], _pointer(context, builder, signature.args[0], args[0], row_index)
        )
        instruction.align = 8
        return context.get_dummy_value()

    return types.void(array, row, value), code


@intrinsic
def multiply(typing_context: Any, a: Any, b: Any) -> Any:
    """Return a * b by lanes."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.fmul(args[0], args[1], flags=_FAST)

    return vector16(a, b), code


@intrinsic
def multiply_add(typing_context: Any, a: Any, b: Any, c: Any) -> Any:
    """Return a * b + c by lanes, rounded once where the machine can."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.fadd(builder.fmul(args[0], args[1], flags=_FAST), args[2], flags=_FAST)

    return vector16(a, b, c), code


@intrinsic
def negative_multiply_add(typing_context: Any, a: Any, b: Any, c: Any) -> Any:
    """Return c - a * b by lanes."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.fsub(args[2], builder.fmul(args[0], args[1], flags=_FAST), flags=_FAST)

    return vector16(a, b, c), code


def _splat(builder: Any, factor: Any) -> Any:
    undefined = ir.Constant(_VECTOR, ir.Undefined)
    one = builder.insert_element(undefined, factor, ir.Constant(ir.IntType(32), 0))
    return builder.shuffle_vector(one, undefined, ir.Constant(ir.VectorType(ir.IntType(32), LANES), None))


@intrinsic
def scale(typing_context: Any, a: Any, factor: Any) -> Any:
    """Return a * factor by lanes, with a scalar factor."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.fmul(args[0], _splat(builder, args[1]), flags=_FAST)

    return vector16(a, types.float64), code


@intrinsic
def scale_add(typing_context: Any, a: Any, factor: Any, c: Any) -> Any:
    """Return a * factor + c by lanes, with a scalar factor."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.fadd(
            builder.fmul(args[0], _splat(builder, args[1]), flags=_FAST), args[2], flags=_FAST
        )

    return vector16(a, types.float64, c), code


@intrinsic
def total(typing_context: Any, a: Any) -> Any:
    """Return the sum of all lanes."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        function = builder.module.declare_intrinsic(
            f"llvm.vector.reduce.fadd.v{LANES}f64",
            fnty=ir.FunctionType(ir.DoubleType(), [ir.DoubleType(), _VECTOR]),
        )
        return builder.call(function, [ir.Constant(ir.DoubleType(), 0.0), args[0]], fastmath=_FAST)

    return types.float64(a), code
