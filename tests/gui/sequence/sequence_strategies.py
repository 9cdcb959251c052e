"""Programs that make sense, for hypothesis."""

from __future__ import annotations

import itertools

from hypothesis import strategies as st

from sequences.braking import AXES
from sequences.program import Program

NUMBER = st.floats(0.01, 200.0, allow_nan=False).map(lambda x: float(f"{x:.6g}"))
NAMES = st.from_regex(r"[A-Za-z][A-Za-z0-9_ -]{0,20}[A-Za-z0-9]", fullmatch=True).filter(
    lambda name: name.lower() not in ("con", "prn", "aux", "nul") and name[:3].lower() not in ("com", "lpt")
)


@st.composite
def profiles(draw: st.DrawFn) -> dict:
    speeds = draw(st.lists(NUMBER, min_size=2, max_size=4))
    return {
        "segments": [
            {"duration_s": draw(st.floats(1.0, 60.0)), "start_rpm": a, "end_rpm": b}
            for a, b in itertools.pairwise(speeds)
        ]
    }


FUNCTIONS = st.one_of(
    st.fixed_dictionaries({"kind": st.just("constant")}),
    st.fixed_dictionaries(
        {
            "kind": st.just("ramp"),
            "amplitude_bar": st.floats(0, 1),
            "direction": st.sampled_from(["rising", "falling"]),
        }
    ),
    st.fixed_dictionaries(
        {
            "kind": st.sampled_from(["sine", "triangle"]),
            "amplitude_bar": st.floats(0, 1),
            "frequency_hz": st.floats(0.01, 5),
        }
    ),
    st.fixed_dictionaries(
        {"kind": st.just("steps"), "steps_bar": st.lists(st.floats(-1, 5), min_size=1, max_size=5)}
    ),
)


@st.composite
def sequences(draw: st.DrawFn, name: str) -> dict:
    conditioned = draw(st.booleans())
    lists = draw(st.booleans())
    length = draw(st.integers(1, 4))
    of = st.lists if not lists else (lambda each, **_: st.lists(each, min_size=length, max_size=length))
    conditioning = {
        "enabled": conditioned, "mode": draw(st.sampled_from(["exact", "at_most"])),
        "tolerance_k": draw(st.floats(0.1, 20)), "soak_s": draw(st.floats(0, 50)),
    }  # fmt: skip
    if draw(st.booleans()):
        conditioning["drag_speed_rpm"] = draw(st.floats(1, 300))
    return {
        "name": name,
        "role": draw(st.sampled_from(["bedding", "matrix", "friction", "stop", "calibration", "check"])),
        "enabled": draw(st.booleans()),
        "repeat": draw(st.integers(1, 5)),
        "temperatures_degc": draw(of(st.floats(20.0, 450.0), min_size=1, max_size=4)) if conditioned else [],
        "speed_profiles": draw(of(profiles(), min_size=1, max_size=3)),
        "pressures_bar": draw(of(st.floats(1.0, 40.0), min_size=1, max_size=4)),
        "loop_order": list(draw(st.permutations(AXES))),
        "processing": "lists" if lists else "loops",
        "pressure_function": {**draw(FUNCTIONS), "rise_s": draw(st.sampled_from([0.0, 0.3]))},
        "conditioning": conditioning,
        "dwell_s": draw(st.floats(0, 30)),
        "ventilator": draw(st.booleans()),
        "recording": {
            "sampling_hz": draw(st.sampled_from([40000.0, 4000.0])),
            "channels": [
                {"name": channel, "decimation": draw(st.integers(1, 100))}
                for channel in draw(
                    st.lists(st.sampled_from(["microphone", "torque", "speed"]), min_size=1, unique=True)
                )
            ],
            "pre_s": draw(st.floats(0, 5)),
        },
    }


@st.composite
def programs(draw: st.DrawFn) -> Program:
    names = draw(st.lists(NAMES, min_size=1, max_size=3, unique_by=str.casefold))
    made = [draw(sequences(name)) for name in names]
    if not any(sequence["enabled"] for sequence in made):
        made[0]["enabled"] = True
    return Program.model_validate(
        {"name": draw(NAMES), "description": draw(st.text(max_size=40)), "sequences": made}
    )
