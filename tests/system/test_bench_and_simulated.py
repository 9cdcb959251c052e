"""One program on two rigs: simulated by the clock, and on the bench through all real drivers; both agree."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from bench_rig import SEED, BenchProcess, bench_missing, free_port

from rigctl.recording.braking_file import read_braking

SOURCES = {"microphone", "amplifier", "encoder", "pyrometer"}


@pytest.fixture
def bench() -> Iterator[BenchProcess]:
    if missing := bench_missing():
        pytest.skip(f"the bench needs more: {missing}")
    with tempfile.TemporaryDirectory(prefix="rb-") as name:
        process = BenchProcess(Path(name) / "bench", free_port()).wait_ready()
        yield process
        process.end()


@pytest.mark.slow
@pytest.mark.timeout(300)
def test_simulated_rig_and_bench_agree(
    cli, configs: Path, bench: BenchProcess, monkeypatch, tmp_path
) -> None:
    """Both at the same time. With one seed friction scatters alike from stop to stop; all else is apart."""
    monkeypatch.setenv("RIGCTL_BENCH_DIR", str(bench.folder))
    program = configs / "programs" / "short_matrix.toml"
    options = ("--out", tmp_path, "--no-report")
    runs = {
        "simulated": cli.start(
            "run",
            program,
            "--rig",
            cli.rig,
            "--time",
            "real",
            "--seed",
            SEED,
            "--name",
            "simulated",
            *options,
        ),
        "bench": cli.start(
            "run", program, "--rig", bench.rig_file(tmp_path / "rig.toml"), "--name", "bench", *options
        ),
    }
    for name, run in runs.items():
        text, _ = run.communicate(timeout=200)
        assert run.returncode == 0, f"{name}: {text}\n{cli.logs(name)}"
        assert "6 of 6 brakings complete" in text
        armed = [record for record in cli.records(name) if record.kind == "armed"]
        assert {record.source for record in armed} == {"watchdog", "controller"}

    code, text = cli.run(
        "compare", tmp_path / "simulated", tmp_path / "bench", "--json",
        "--tolerances", configs / "tolerances" / "bench_and_simulated.toml",
    )  # fmt: skip
    found = json.loads(text)
    print(text)  # seen where it fails
    assert code == 0 and found["agree"] and found["pairs"] == 6
    squeal = next(entry for entry in found["quantities"] if entry["name"] == "squeal_frequency_hz")
    assert squeal["pairs"] == 4 and squeal["mean_a"] == pytest.approx(2350.0, abs=10.0)

    for path in sorted((tmp_path / "bench" / "brakings").glob("*.h5")):
        clocks = read_braking(path).clocks
        assert clocks.keys() == SOURCES
        assert "offset_ms" not in clocks["microphone"]
        for source in SOURCES - {"microphone"}:
            assert len(clocks[source]["offset_ms"]) >= 2  # once a second
            assert abs(clocks[source]["drift_ppm"][-1]) < 500.0
    assert not read_braking(tmp_path / "simulated" / "brakings" / "00001.h5").clocks  # it has one clock
