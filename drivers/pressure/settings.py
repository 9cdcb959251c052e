"""Settings of a CANopen pressure regulator; the defaults are those of CiA 408.

Not its job: talking to it (`drivers.pressure.canopen_regulator`).
"""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from drivers.can.node_settings import CobId, Frozen, NodeSettings, PdoSettings
from drivers.can.objects import ObjectRef, ObjectSetting

Word = Annotated[int, Field(ge=0, le=0xFFFF)]
Bit = Annotated[int, Field(ge=0, le=15)]


class RegulatorObjects(Frozen):
    """Objects of the dictionary. Defaults: CiA 408, first function block."""

    control_word: ObjectSetting = ObjectRef(0x6040, 0, "u16")
    status_word: ObjectSetting = ObjectRef(0x6041, 0, "u16")
    error_code: ObjectSetting = ObjectRef(0x604E, 0, "u16")
    set_point: ObjectSetting = ObjectRef(0x6300, 1, "i16")
    actual: ObjectSetting = ObjectRef(0x6301, 1, "i16")


class RegulatorWords(Frozen):
    """Control words, and what the status word says in the states. Defaults: CiA 408.

    Attributes
    ----------
    disable, hold, active : int
        Control words that ask for the state.
    mask : int
        Bits of the status word that tell the state.
    is_disabled, is_hold, is_active, is_fault : int
        Their value in the states.
    window_bit : int or None
        Bit of the status word: actual value within the target window; None: the device has none.
    """

    disable: Word = 0x0000
    hold: Word = 0x0001
    active: Word = 0x0007
    mask: Word = 0x000F
    is_disabled: Word = 0x0008
    is_hold: Word = 0x0009
    is_active: Word = 0x000F
    is_fault: Word = 0x0000
    window_bit: Bit | None = 8


class LossReaction(Frozen):
    """Object that says what the regulator does when our heartbeat is lost, and the value that vents.

    There is no default: CiA 408 leaves it to the maker, and devices come set to hold the pressure.
    """

    object: ObjectSetting
    vent: int


class VentLine(Frozen):
    """A vent valve on an output of another node, beside the regulator: sent with every vent.

    Attributes
    ----------
    cob_id : int
        RPDO of that node.
    vent, release : str
        Data in hex.
    """

    cob_id: CobId
    vent: Annotated[str, Field(pattern=r"^([0-9A-Fa-f]{2}){1,8}$")]
    release: Annotated[str, Field(pattern=r"^([0-9A-Fa-f]{2}){1,8}$")]


class RegulatorSettings(NodeSettings):
    """Table `[devices.pressure]` of kind "canopen".

    Attributes
    ----------
    range_bar, full_scale_counts : float, int
        Pressure of `full_scale_counts`, the same for set-point and actual value.
    profile : int
        Device profile in 1000h; 0: not compared.
    loss_reaction : LossReaction
    activate_s : float
        The regulator must be active within this time.
    """

    range_bar: Annotated[float, Field(gt=0, le=1000)]
    full_scale_counts: Annotated[int, Field(gt=0, le=32767)] = 16384
    profile: Annotated[int, Field(ge=0, le=0xFFFF)] = 408
    objects: RegulatorObjects = RegulatorObjects()
    words: RegulatorWords = RegulatorWords()
    rpdo: PdoSettings = PdoSettings()
    tpdo: PdoSettings = PdoSettings()
    loss_reaction: LossReaction
    vent_line: VentLine | None = None
    activate_s: Annotated[float, Field(ge=0.1, le=10)] = 1.0
