"""What speaks against a calibration, in the language of the window.

Job: the list of the sentences of `rigctl.calibration`, and `fault_said`. Not its job: judging, showing
(`parts`).
"""

from __future__ import annotations

from PySide6.QtCore import QT_TRANSLATE_NOOP

from rigctl.gui.rig.patterns import Patterns

FAULTS = Patterns("calibrations", (
    # torque
    QT_TRANSLATE_NOOP("calibrations", "largest residual {0} % of full scale, allowed {1} %"),
    QT_TRANSLATE_NOOP("calibrations", "Repeat the point that stands out; check lever length and masses."),
    QT_TRANSLATE_NOOP("calibrations", "hysteresis {0} % of full scale, allowed {1} %"),
    QT_TRANSLATE_NOOP(
        "calibrations", "Something rubs or is loose: check lever bearing and sensor mounting."
    ),
    QT_TRANSLATE_NOOP(
        "calibrations", "the zero does not come back; it differs by {0} % of full scale, allowed {1} %"
    ),
    QT_TRANSLATE_NOOP("calibrations", "Let the chain warm up; check that the lever hangs free."),
    QT_TRANSLATE_NOOP("calibrations", "scatter of a reading {0} % of full scale, allowed {1} %"),
    QT_TRANSLATE_NOOP("calibrations", "Wait until the weights hang still; switch the ventilator off."),
    QT_TRANSLATE_NOOP("calibrations", "only one direction of rotation was measured"),
    QT_TRANSLATE_NOOP("calibrations", "Load the other side too."),
    QT_TRANSLATE_NOOP("calibrations", "the two directions differ by {0} %, allowed {1} %"),
    QT_TRANSLATE_NOOP(
        "calibrations", "Check that the lever is level on both sides and its length the same."
    ),
    QT_TRANSLATE_NOOP("calibrations", "the gain {0} is more than {1} % off"),
    QT_TRANSLATE_NOOP(
        "calibrations", "Check lever length and masses; then the scale of the channel in the rig file."
    ),
    QT_TRANSLATE_NOOP("calibrations", "the largest load is only {0} % of full scale"),
    QT_TRANSLATE_NOOP("calibrations", "Load to {0} % at least, better to the torque of the tests."),
    QT_TRANSLATE_NOOP("calibrations", "the shaft turns with {0} 1/min: bring the rig to rest"),
    QT_TRANSLATE_NOOP("calibrations", "the brake is pressed with {0} bar: release it"),
    # microphone
    QT_TRANSLATE_NOOP("calibrations", "the levels disagree by {0} dB, allowed {1} dB"),
    QT_TRANSLATE_NOOP("calibrations", "Seat the calibrator again; check the gain of the amplifier."),
    QT_TRANSLATE_NOOP(
        "calibrations", "the sensitivity has changed by {0} dB since the last calibration"
    ),
    QT_TRANSLATE_NOOP(
        "calibrations", "Seat the calibrator again; when it stays so, the microphone may be damaged."
    ),
    QT_TRANSLATE_NOOP("calibrations", "the chain is {0} dB off its nominal sensitivity"),
    QT_TRANSLATE_NOOP(
        "calibrations", "Check the level set at the calibrator and the gain of the amplifier."
    ),
    QT_TRANSLATE_NOOP("calibrations", "at {0} dB: the converter is at its limit"),
    QT_TRANSLATE_NOOP("calibrations", "Lower the gain, or use 94 dB."),
    QT_TRANSLATE_NOOP("calibrations", "at {0} dB: the loudest tone is at {1} Hz, not at 1 kHz"),
    QT_TRANSLATE_NOOP("calibrations", "Switch the calibrator on and push it on to its stop."),
    QT_TRANSLATE_NOOP("calibrations", "at {0} dB: the tone is only {1} dB above the rest"),
    QT_TRANSLATE_NOOP("calibrations", "Push the calibrator on to its stop; switch the ventilator off."),
    QT_TRANSLATE_NOOP("calibrations", "at {0} dB: the level moves by {1} dB"),
    QT_TRANSLATE_NOOP(
        "calibrations", "Wait until the tone is steady; check the battery of the calibrator."
    ),
    # emissivity
    QT_TRANSLATE_NOOP("calibrations", "an emissivity of {0} is not likely"),
    QT_TRANSLATE_NOOP(
        "calibrations", "Both must look at the same place; wait until the contact thermometer is steady."
    ),
    QT_TRANSLATE_NOOP("calibrations", "the pairs disagree by {0} K after correction"),
    QT_TRANSLATE_NOOP("calibrations", "Repeat the pair that stands out, with a steady temperature."),
    QT_TRANSLATE_NOOP("calibrations", "there is one pair only"),
    QT_TRANSLATE_NOOP("calibrations", "A second one, 100 K higher, shows errors."),
    # no result at all
    QT_TRANSLATE_NOOP(
        "calibrations",
        "the disc must be {0} K warmer than its surroundings: the emissivity cannot be seen below",
    ),
    QT_TRANSLATE_NOOP(
        "calibrations", "the masses must rise and be above zero: give them from light to heavy"
    ),
    QT_TRANSLATE_NOOP("calibrations", "three different loads are needed for a line and its residuals"),
    QT_TRANSLATE_NOOP(
        "calibrations", "the reading does not rise with the torque: check the sign of the channel"
    ),
    QT_TRANSLATE_NOOP("calibrations", "no recording of a calibrator yet"),
))  # fmt: skip


def fault_said(text: str) -> str:
    """A sentence against a calibration in the language of the window; as it came when it is not known."""
    return FAULTS.say(text)
