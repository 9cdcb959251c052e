"""A calibration in force: frozen with the campaign, in its channel, in every braking file."""

import json
import tomllib
from datetime import UTC, datetime, timedelta

import h5py
import numpy as np

from rigctl.calibration.record import Calibration, Point, Quantity
from rigctl.calibration.store import rig_folder, save


def calibration(**changes) -> Calibration:
    values = {
        "quantity": Quantity.TORQUE, "channel": "torque", "unit": "N·m",
        "rig": "A-class front brake, simulated rig", "date": datetime.now(UTC) - timedelta(days=3),
        "operator": "Meier", "gain": 1.05, "offset": -2.0, "points": (Point(applied=0, measured=0),),
    }  # fmt: skip
    return Calibration.model_validate({**values, **changes})


def run(cli, name: str) -> dict:
    program = cli.program(pressures=[10], temperatures=[30], duration_s=1.0)
    code, text = cli.run("run", program, "--rig", cli.rig, "--out", cli.folder, "--name", name, "--seed", 2,
                         "--no-report")  # fmt: skip
    assert code == 0, text + cli.logs(name)
    with h5py.File(cli.folder / name / "brakings" / "00001.h5") as file:
        return {
            "torque": np.asarray(file["entry/torque/value"][()], np.float64),
            "counts": np.asarray(file["entry/microphone/counts"][()]),
            "factor": float(file["entry/microphone/counts_scaling_factor"][()]),
            "metadata": json.loads(file["entry/braking/metadata"][()]),
            "native": json.loads(file["entry/torque/chain/native"][()]),
        }


def test_what_holds_is_applied_frozen_and_told(cli):
    before = run(cli, "before")
    folder = rig_folder(cli.folder, "A-class front brake, simulated rig")
    save(folder, calibration())
    sound = {"channel": "microphone", "unit": "Pa", "gain": 1.1, "offset": 0.0, "nominal_scale": 20 / 32768}
    save(folder, calibration(quantity=Quantity.MICROPHONE, valid_days=1, **sound))
    after = run(cli, "after")
    assert np.allclose(after["torque"], 1.05 * before["torque"] - 2.0, atol=1e-3)
    assert (after["counts"] == before["counts"]).all()  # samples as acquired
    assert np.isclose(after["factor"], 1.1 * before["factor"])
    assert after["native"]["scale"] == 1.05
    assert [c["quantity"] for c in after["metadata"]["calibrations"]] == ["microphone", "torque"]
    assert after["metadata"]["calibrations"][1]["operator"] == "Meier"
    frozen = tomllib.loads((cli.folder / "after" / "campaign.toml").read_text())
    assert {entry["quantity"] for entry in frozen["calibrations"]} == {"torque", "microphone"}
    code, text = cli.run("calibrations", "list", cli.rig, "--out", cli.folder)
    assert code == 1  # the microphone's was good for a day
    assert "OVERDUE" in text and "never calibrated" in text and "gain 1.05" in text
