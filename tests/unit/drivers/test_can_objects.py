"""Codecs of CANopen objects, PDOs and scaling: what goes in comes out, and what does not fit is refused."""

from __future__ import annotations

import math
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic_core import PydanticCustomError

from drivers.can.objects import TYPES, ObjectRef, PdoCodec, Scaling, parse_object
from rigctl.core.errors import DeviceError

kinds = st.sampled_from(sorted(TYPES))
refs = st.builds(ObjectRef, st.integers(0x1000, 0xFFFF), st.integers(0, 0xFF), kinds)
whole = refs.filter(lambda ref: ref.kind != "f32")


@given(whole, st.data())
def test_values_come_back(ref: ObjectRef, data):
    low, high = ref.limits
    value = data.draw(st.integers(int(low), int(high)))
    packed = ref.pack(value)
    assert len(packed) == ref.size
    assert ref.unpack(packed) == value
    assert int.from_bytes(packed, "little", signed=ref.kind[0] == "i") == value


@given(whole, st.integers(-(2**70), 2**70))
def test_values_that_do_not_fit_are_refused(ref: ObjectRef, value):
    low, high = ref.limits
    if low <= value <= high:
        assert ref.unpack(ref.pack(value)) == value
    else:
        with pytest.raises(ValueError, match="does not fit"):
            ref.pack(value)


@given(refs, st.binary(max_size=9))
def test_data_of_another_length_are_no_value(ref: ObjectRef, data):
    if len(data) == ref.size:
        ref.unpack(data)
    else:
        with pytest.raises(ValueError, match="bytes instead of"):
            ref.unpack(data)


@given(refs)
def test_text_form_is_read_back(ref: ObjectRef):
    text = f"{ref.index:04X}h:{ref.sub:X} {ref.kind}"
    assert parse_object(text) == parse_object(text.lower()) == parse_object(text.replace("h:", ":")) == ref


@given(refs)
def test_mapping_holds_index_sub_index_and_bits(ref: ObjectRef):
    index, sub, bits = ref.mapping >> 16, ref.mapping >> 8 & 0xFF, ref.mapping & 0xFF
    assert (index, sub, bits) == (ref.index, ref.sub, 8 * ref.size)


@pytest.mark.parametrize(
    "text", ["", "6300", "6300h:1", "6300h:1 i24", "63000h:1 i16", "x300 u8", 24832, None]
)
def test_other_texts_are_refused(text):
    with pytest.raises(PydanticCustomError):
        parse_object(text)


@given(st.integers(0, 0xFFFF), st.integers(-32768, 32767))
def test_frame_of_the_regulator(word, counts):
    codec = PdoCodec((ObjectRef(0x6041, 0, "u16"), ObjectRef(0x6301, 1, "i16")))
    assert codec.pack(word, counts) == struct.pack("<H", word) + struct.pack("<h", counts)
    assert codec.unpack(codec.pack(word, counts)) == (word, counts)


@given(st.lists(refs, max_size=4), st.binary(max_size=8))
def test_frames_of_another_length_hold_no_values(objects, data):
    size = sum(ref.size for ref in objects)
    if size > 8:
        with pytest.raises(ValueError, match="do not fit"):
            PdoCodec(objects)
        return
    values = PdoCodec(objects).unpack(data)
    assert (values is None) is (len(data) != size)


@given(st.floats(1.0, 1000.0), st.integers(100, 32767), st.floats(0.0, 1.0))
def test_scaling_is_exact_to_half_a_count(full_scale, full_counts, share):
    scaling = Scaling(full_scale, full_counts)
    value = share * full_scale
    counts = scaling.to_counts(value, "pressure")
    assert 0 <= counts <= full_counts
    assert abs(scaling.to_value(counts) - value) <= 0.5001 * full_scale / full_counts


@given(st.integers(0, 16384))
def test_counts_come_back(counts):
    scaling = Scaling(50.0, 16384)
    assert scaling.to_counts(scaling.to_value(counts), "pressure") == counts


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, -1e-9, 50.0000001])
def test_set_points_outside_are_refused(value):
    with pytest.raises(DeviceError, match="between 0 and 50"):
        Scaling(50.0, 16384).to_counts(value, "pressure")
