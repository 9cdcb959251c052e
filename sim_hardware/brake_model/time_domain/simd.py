"""Short vectors of doubles as numba values: load, store, multiply-add, division, square root, selection.

Numba's loops over short arrays pay for alias checks in every time step and are often not vectorised at all.
With these intrinsics values stay in vector registers; LLVM splits the lanes into what the machine has (a
vector of 16: 4 x AVX2, 2 x AVX-512, 8 x NEON). Products may be fused with additions, nothing is reordered.
NOT its job: anything about brakes.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic, models, register_model

_FLAGS = ("contract", "nsz")
_DOUBLE = ir.DoubleType()
_INDEX = ir.IntType(32)


class VectorType(types.Type):
    """Numba type of a vector of `lanes` doubles."""

    def __init__(self, lanes: int) -> None:
        self.lanes = lanes
        super().__init__(name=f"Vector{lanes}")


@register_model(VectorType)
class _VectorModel(models.PrimitiveModel):
    def __init__(self, dmm: Any, fe_type: Any) -> None:
        super().__init__(dmm, fe_type, ir.VectorType(_DOUBLE, fe_type.lanes))


vector2, vector4, vector8, vector16 = (VectorType(lanes) for lanes in (2, 4, 8, 16))


def _pointer(context: Any, builder: Any, array_type: Any, array: Any, first: Any, lanes: int) -> Any:
    """Pointer to `lanes` elements of a C-contiguous float64 array from its element `first` (flat) on."""
    data = cgutils.create_struct_proxy(array_type)(context, builder, array).data
    return builder.bitcast(builder.gep(data, [first]), ir.VectorType(_DOUBLE, lanes).as_pointer())


def _load(vector: VectorType) -> Any:
    @intrinsic
    def load(typing_context: Any, array: Any, first: Any) -> Any:
        """Return elements of a C-contiguous float64 array from the flat index `first` on."""

        def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            index = context.cast(builder, args[1], signature.args[1], types.intp)
            value = builder.load(_pointer(context, builder, signature.args[0], args[0], index, vector.lanes))
            value.align = 8
            return value

        return vector(array, first), code

    return load


load2, load4, load8, load16 = (_load(vector) for vector in (vector2, vector4, vector8, vector16))


def _zero(vector: VectorType) -> Any:
    @intrinsic
    def zero(typing_context: Any) -> Any:
        """Return zeros."""

        def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            return ir.Constant(ir.VectorType(_DOUBLE, vector.lanes), None)

        return vector(), code

    return zero


zero8, zero16 = _zero(vector8), _zero(vector16)


@intrinsic
def store(typing_context: Any, array: Any, first: Any, value: Any) -> Any:
    """Write all lanes to a C-contiguous float64 array from the flat index `first` on."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        index = context.cast(builder, args[1], signature.args[1], types.intp)
        lanes = signature.args[2].lanes
        instruction = builder.store(
            args[2], _pointer(context, builder, signature.args[0], args[0], index, lanes)
        )
        instruction.align = 8
        return context.get_dummy_value()

    return types.void(array, first, value), code


@intrinsic
def add(typing_context: Any, a: Any, b: Any) -> Any:
    """Return a + b by lanes."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.fadd(args[0], args[1], flags=_FLAGS)

    return a(a, b), code


@intrinsic
def multiply(typing_context: Any, a: Any, b: Any) -> Any:
    """Return a * b by lanes."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.fmul(args[0], args[1], flags=_FLAGS)

    return a(a, b), code


@intrinsic
def multiply_add(typing_context: Any, a: Any, b: Any, c: Any) -> Any:
    """Return a * b + c by lanes, rounded once where the machine can."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.fadd(builder.fmul(args[0], args[1], flags=_FLAGS), args[2], flags=_FLAGS)

    return a(a, b, c), code


@intrinsic
def negative_multiply_add(typing_context: Any, a: Any, b: Any, c: Any) -> Any:
    """Return c - a * b by lanes."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.fsub(args[2], builder.fmul(args[0], args[1], flags=_FLAGS), flags=_FLAGS)

    return a(a, b, c), code


@intrinsic
def subtract(typing_context: Any, a: Any, b: Any) -> Any:
    """Return a - b by lanes."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.fsub(args[0], args[1], flags=_FLAGS)

    return a(a, b), code


@intrinsic
def divide(typing_context: Any, a: Any, b: Any) -> Any:
    """Return a / b by lanes."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.fdiv(args[0], args[1], flags=_FLAGS)

    return a(a, b), code


@intrinsic
def over_root(typing_context: Any, a: Any, b: Any) -> Any:
    """Return a / sqrt(b) by lanes."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        kind = args[1].type
        name = f"llvm.sqrt.v{signature.args[1].lanes}f64"
        root = builder.module.declare_intrinsic(name, fnty=ir.FunctionType(kind, [kind]))
        return builder.fdiv(args[0], builder.call(root, [args[1]]), flags=_FLAGS)

    return a(a, b), code


def _select(order: str) -> Any:
    @intrinsic
    def select(typing_context: Any, a: Any, b: Any) -> Any:
        """Return the larger or smaller of a and b by lanes; b where they cannot be compared."""

        def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            return builder.select(builder.fcmp_ordered(order, args[0], args[1]), args[0], args[1])

        return a(a, b), code

    return select


larger, smaller = _select(">"), _select("<")


def _broadcast(builder: Any, value: Any, lanes: int) -> Any:
    undefined = ir.Constant(ir.VectorType(_DOUBLE, lanes), ir.Undefined)
    one = builder.insert_element(undefined, value, ir.Constant(_INDEX, 0))
    return builder.shuffle_vector(one, undefined, ir.Constant(ir.VectorType(_INDEX, lanes), None))


def _splat(vector: VectorType) -> Any:
    @intrinsic
    def splat(typing_context: Any, value: Any) -> Any:
        """Return a vector with the scalar `value` in all lanes."""

        def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            return _broadcast(builder, args[0], vector.lanes)

        return vector(types.float64), code

    return splat


splat2, splat8 = _splat(vector2), _splat(vector8)


@intrinsic
def coefficient8(typing_context: Any, table: Any, group: Any, index: Any) -> Any:
    """Return a coefficient for eight lanes: from a (size,) table of all lanes, or from row `group` of a
    (groups, 8 size) table, where each lane has its own."""
    lanes = vector8.lanes

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        at = context.cast(builder, args[2], signature.args[2], types.intp)
        if signature.args[0].ndim == 1:
            data = cgutils.create_struct_proxy(signature.args[0])(context, builder, args[0]).data
            return _broadcast(builder, builder.load(builder.gep(data, [at])), lanes)
        shape = cgutils.create_struct_proxy(signature.args[0])(context, builder, args[0]).shape
        row = context.cast(builder, args[1], signature.args[1], types.intp)
        begin = builder.mul(row, builder.extract_value(shape, 1))
        first = builder.add(begin, builder.mul(at, ir.Constant(at.type, lanes)))
        value = builder.load(_pointer(context, builder, signature.args[0], args[0], first, lanes))
        value.align = 8
        return value

    return vector8(table, group, index), code


@intrinsic
def where_positive(typing_context: Any, condition: Any, a: Any, b: Any) -> Any:
    """Return a in the lanes where `condition` > 0, b in the others."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        zero = ir.Constant(args[0].type, None)
        return builder.select(builder.fcmp_ordered(">", args[0], zero), args[1], args[2])

    return a(condition, a, b), code


@intrinsic
def positive_lanes(typing_context: Any, a: Any) -> Any:
    """Return an integer with bit i set where lane i is > 0."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        positive = builder.fcmp_ordered(">", args[0], ir.Constant(args[0].type, None))
        bits = builder.bitcast(positive, ir.IntType(signature.args[0].lanes))
        return builder.zext(bits, ir.IntType(64))

    return types.int64(a), code


@intrinsic
def scale_add(typing_context: Any, a: Any, factor: Any, c: Any) -> Any:
    """Return a * factor + c by lanes, with a scalar factor."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        wide = _broadcast(builder, args[1], signature.args[0].lanes)
        return builder.fadd(builder.fmul(args[0], wide, flags=_FLAGS), args[2], flags=_FLAGS)

    return a(a, types.float64, c), code


def _part(first: int) -> Any:
    @intrinsic
    def part(typing_context: Any, a: Any) -> Any:
        """Return two lanes of a vector of 4."""

        def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            mask = ir.Constant(ir.VectorType(_INDEX, 2), [first, first + 1])
            return builder.shuffle_vector(args[0], ir.Constant(args[0].type, ir.Undefined), mask)

        return vector2(a), code

    return part


lower_half, upper_half = _part(0), _part(2)


def _lane(index: int) -> Any:
    @intrinsic
    def lane(typing_context: Any, a: Any) -> Any:
        """Return one lane as a scalar."""

        def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            return builder.extract_element(args[0], ir.Constant(_INDEX, index))

        return types.float64(a), code

    return lane


lane0, lane1 = _lane(0), _lane(1)
