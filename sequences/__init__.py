"""What to run: brakings, sequences and programs as frozen, validated, serialisable data.

Nothing here knows a rig, a clock or a file other than a program's TOML; nothing of the project is imported.
"""

from sequences.braking import (
    Braking,
    Conditioning,
    LoopIndices,
    RecordedChannel,
    Recording,
    TemperatureLimits,
)
from sequences.matrix import Sequence, brakings
from sequences.pressure import (
    ConstantPressure,
    PressureFunction,
    RampPressure,
    SinePressure,
    StepsPressure,
    TrianglePressure,
)
from sequences.profiles import SpeedProfile, SpeedSegment
from sequences.program import Program, dump_program, load_program

__all__ = [
    "Braking",
    "Conditioning",
    "ConstantPressure",
    "LoopIndices",
    "PressureFunction",
    "Program",
    "RampPressure",
    "RecordedChannel",
    "Recording",
    "Sequence",
    "SinePressure",
    "SpeedProfile",
    "SpeedSegment",
    "StepsPressure",
    "TemperatureLimits",
    "TrianglePressure",
    "brakings",
    "dump_program",
    "load_program",
]
