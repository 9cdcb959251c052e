"""The main job as a user runs it: a program on the simulated rig, from the command line to the report."""

import csv
import json
import re
from pathlib import Path

import h5py
import numpy as np
import pytest

from rigctl.core.journal import verify_journal
from sim_hardware.brake_model import load_brake
from sim_hardware.brake_model.stability import onset_pressure


def datasets(path: Path) -> dict[str, bytes]:
    """Every data set of a file as bytes."""
    found: dict[str, bytes] = {}

    def take(name: str, item: object) -> None:
        if isinstance(item, h5py.Dataset):
            found[name] = np.asarray(item[()]).tobytes() if item.dtype.kind != "O" else str(item[()]).encode()

    with h5py.File(path) as file:
        file.visititems(take)
    return found


def brakings(campaign: Path) -> list[Path]:
    return sorted((campaign / "brakings").glob("*.h5"))


def test_campaign_is_complete_safe_and_reported(cli):
    program = cli.program(pressures=[6, 24], temperatures=[60], duration_s=2.5)
    code, text = cli.run("run", program, "--rig", cli.rig, "--out", cli.folder, "--name", "a", "--seed", 3)
    assert code == 0, text + cli.logs("a")
    campaign = cli.folder / "a"
    assert f"Report: {campaign}/report/report.html" in text
    assert "× real time" in text
    # 24 bar squeals where the plant's eigenvalue says, 6 bar does not
    with (campaign / "report" / "events.csv").open() as file:
        events = list(csv.DictReader(file))
    assert {event["braking"] for event in events} == {"2"}
    onset = onset_pressure(load_brake(cli.configs / "brakes" / "plant.toml"))
    assert onset is not None
    assert float(events[0]["frequency_hz"]) == pytest.approx(onset.frequency_hz, abs=10)
    assert float(events[0]["level_db"]) > 70
    # everything was journaled, by every process, without gaps
    kinds = {(record.source, record.kind) for record in cli.records("a")}
    for expected in [
        ("supervisor", "run_started"), ("watchdog", "armed"), ("controller", "armed"),
        ("controller", "braking_started"), ("recorder", "BRAKING_COMMITTED"), ("watchdog", "disarmed"),
        ("controller", "ended"), ("supervisor", "run_ended"),
    ]:  # fmt: skip
        assert expected in kinds
    assert verify_journal(campaign / "journal.jsonl") == []
    # the campaign is self-contained and nothing is left over
    assert not list((campaign / "spool").iterdir())
    assert (campaign / "config" / "devices-acquisition-brake.toml").exists()
    html = (campaign / "report" / "report.html").read_text()
    assert not re.search(r'(src|href)="https?://', html)


def test_same_seed_same_data_other_seed_other_data(cli):
    program = cli.program(pressures=[20], temperatures=[40], duration_s=1.0)
    for name, seed in (("a", 5), ("b", 5), ("c", 6)):
        code, text = cli.run(
            "run", program, "--rig", cli.rig, "--out", cli.folder, "--name", name, "--seed", seed,
            "--no-report",
        )  # fmt: skip
        assert code == 0, text + cli.logs(name)
    a, b, c = (datasets(brakings(cli.folder / name)[0]) for name in "abc")
    assert a.keys() == b.keys() == c.keys()
    assert [name for name in a if a[name] != b[name]] == []
    assert a["entry/microphone/counts"] != c["entry/microphone/counts"]
    assert a["entry/torque/value"] != c["entry/torque/value"]


def test_stiffness_of_the_plant_moves_the_squeal_as_the_eigenvalue_says(cli):
    """A softer trailing abutment in the TOML: a lower frequency in the next run."""
    brake = cli.folder / "plant.toml"
    text = (cli.configs / "brakes" / "plant.toml").read_text()
    changed, hits = re.subn(r"(?m)^(c_abu_t = \{ value = )[0-9.e+]+", r"\g<1>7.7e7", text)
    assert hits == 1
    brake.write_text(changed)
    before = onset_pressure(load_brake(cli.configs / "brakes" / "plant.toml"))
    after = onset_pressure(load_brake(brake))
    assert before is not None and after is not None
    assert abs(before.frequency_hz - after.frequency_hz) > 20
    rig = cli.edited_config("rigs/simulated.toml", (r'^brake = "../brakes/plant.toml"', f'brake = "{brake}"'))
    program = cli.program(pressures=[28], temperatures=[100], duration_s=2.5)
    code, text = cli.run("run", program, "--rig", rig, "--out", cli.folder, "--name", "a", "--seed", 1)
    assert code == 0, text + cli.logs("a")
    with (cli.folder / "a" / "report" / "events.csv").open() as file:
        frequencies = [float(event["frequency_hz"]) for event in csv.DictReader(file)]
    assert frequencies
    assert frequencies[0] == pytest.approx(after.frequency_hz, abs=12)


def test_resume_of_a_complete_campaign_says_so(cli):
    program = cli.program(pressures=[10], temperatures=[40], duration_s=0.5)
    code, text = cli.run(
        "run", program, "--rig", cli.rig, "--out", cli.folder, "--name", "a", "--seed", 1, "--no-report"
    )
    assert code == 0, text
    code, text = cli.run("resume", cli.folder / "a")
    assert code == 0
    assert "complete already" in text
    code, text = cli.run("report", cli.folder / "a")
    assert code == 0
    assert "report.html" in text


def test_braking_in_real_time_takes_its_time(cli):
    program = cli.program(pressures=[10], temperatures=[28], duration_s=1.0)
    limits = cli.edited_config(  # on a busy machine nobody keeps windows of 80 ms
        "limits/a_class.toml",
        (r"^heartbeat_s = .*", "heartbeat_s = 2.0"),
        (r"^sample_s = .*", "sample_s = 2.0"),
    )
    rig = cli.edited_config(
        "rigs/simulated.toml",
        (r'^limits = "../limits/a_class.toml"', f'limits = "{limits}"'),
        (
            r'^\[devices.safety\]\nkind = "simulated"',
            '[devices.safety]\nkind = "simulated"\nrelay_timeout_s = 2.0',
        ),
    )
    code, text = cli.run(
        "run", program, "--rig", rig, "--out", cli.folder, "--name", "a", "--seed", 1, "--time", "real",
        "--no-report",
    )  # fmt: skip
    assert code == 0, text + cli.logs("a")
    started, ended = (
        next(r for r in cli.records("a") if (r.source, r.kind) == ("controller", kind))
        for kind in ("armed", "ended")
    )
    rig_s = (ended.rig_s or 0) - (started.rig_s or 0)
    wall_s = (ended.mono_ns - started.mono_ns) * 1e-9
    assert rig_s == pytest.approx(wall_s, rel=0.2, abs=1.5)
    with h5py.File(brakings(cli.folder / "a")[0]) as file:
        specification = json.loads(file["entry/braking/specification"][()])
        n = len(file["entry/microphone/counts"])
    assert specification["pressure_bar"] == 10
    assert n == round((0.5 + 1.0 + 0.5) * 40000)
