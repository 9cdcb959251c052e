"""The tutorials are run: every shell and Python block, in order, in a copy of what they need."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TUTORIALS = sorted((ROOT / "docs" / "tutorials").glob("*.md"))
WITH_CODE = [*TUTORIALS, ROOT / "docs" / "reference" / "model-studies.md"]
BLOCK = re.compile(r"^```(sh|python)\n(.*?)^```", re.MULTILINE | re.DOTALL)


@pytest.mark.timeout(600)  # the first run on a machine compiles
@pytest.mark.parametrize("path", WITH_CODE, ids=lambda path: path.stem)
def test_tutorial_runs_as_written(path: Path, tmp_path: Path):
    (tmp_path / "configs").symlink_to(ROOT / "configs")
    (tmp_path / "data").mkdir()
    environment = {**os.environ, "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
    blocks = BLOCK.findall(path.read_text())
    assert blocks
    printed = ""
    for language, code in blocks:
        command = ["sh", "-ec", code] if language == "sh" else [sys.executable, "-c", code]
        result = subprocess.run(
            command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=170, check=False
        )
        assert result.returncode == 0, f"{code}\n{result.stdout}\n{result.stderr}"
        printed += result.stdout
    if path.stem == "first-campaign":
        frequencies = re.findall(r"squeal frequency is (\d+) Hz", printed)
        onsets = re.findall(r"Onset of squeal: [\d.]+ bar, ([\d.]+) Hz", printed)
        assert len(frequencies) == len(onsets) == 2
        for measured, predicted in zip(frequencies, onsets, strict=True):
            assert float(measured) == pytest.approx(float(predicted), abs=15)
        assert abs(float(onsets[0]) - float(onsets[1])) > 20
