"""Checkpoint of a study: torn and damaged lines, other studies, two processes."""

import json
import subprocess
import sys

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rigctl.core.errors import ConfigError
from rigctl.model.runner import run_study
from rigctl.model.runner_checkpoint import RESULTS, Checkpoint, identity

STUDY = identity("m:f", {"spread": 0.05}, list(range(10)), {"rigctl": "1"})


def _filled(folder):
    checkpoint = Checkpoint(folder, STUDY)
    checkpoint.append([0, 1], [0.1, {"x": None}])
    checkpoint.append([5], [[1, 2]])
    checkpoint.close()
    return folder / RESULTS


@settings(max_examples=40, deadline=None)
@given(cut=st.integers(min_value=0, max_value=200))
def test_a_torn_file_gives_whole_lines_and_can_be_continued(tmp_path_factory, cut):
    folder = tmp_path_factory.mktemp("torn")
    path = _filled(folder)
    data = path.read_bytes()[:cut]
    path.write_bytes(data)
    checkpoint = Checkpoint(folder, STUDY)
    whole = data.count(b"\n")
    assert set(checkpoint.results) == [set(), {0, 1}, {0, 1, 5}][whole]
    assert checkpoint.damaged == 0
    checkpoint.append([7], [3.5])
    checkpoint.close()
    again = Checkpoint(folder, STUDY)
    assert again.results[7] == 3.5
    assert again.damaged == 0
    again.close()


def test_a_damaged_line_is_left_out_and_counted(tmp_path):
    path = _filled(tmp_path)
    path.write_bytes(path.read_bytes().replace(b"0.1", b"0.2"))
    checkpoint = Checkpoint(tmp_path, STUDY)
    assert set(checkpoint.results) == {5}
    assert checkpoint.damaged == 1
    checkpoint.close()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"setting": {"spread": 0.1}}, r"spread is 0.05 there and 0.1 here"),
        ({"setting": {"spread": 0.05, "model": "x" * 200}}, r"model is nothing there and sha256 "),
        ({"code": {"rigctl": "2"}}, r"code.rigctl is 1 there and 2 here"),
        ({"tasks": {"count": 9, "digest": "0"}}, r"tasks.count is 10 there and 9 here"),
    ],
)
def test_another_study_is_refused(tmp_path, change, words):
    _filled(tmp_path)
    other = {**STUDY, **change}
    if "setting" in change:
        other = identity("m:f", change["setting"], list(range(10)), {"rigctl": "1"})
    with pytest.raises(ConfigError, match=words):
        Checkpoint(tmp_path, other)


def test_results_without_manifest_and_broken_manifests_are_refused(tmp_path):
    _filled(tmp_path)
    (tmp_path / "study.json").write_text("{")
    with pytest.raises(ConfigError, match="not the manifest"):
        Checkpoint(tmp_path, STUDY)
    (tmp_path / "study.json").unlink()
    with pytest.raises(ConfigError, match=r"no study\.json"):
        Checkpoint(tmp_path, STUDY)


def test_two_processes_cannot_share_a_folder(tmp_path):
    held = Checkpoint(tmp_path, STUDY)
    code = (
        f"import json, pathlib\nfrom rigctl.model.runner_checkpoint import Checkpoint\n"
        f"Checkpoint(pathlib.Path({str(tmp_path)!r}), json.loads({json.dumps(STUDY)!r}))"
    )
    other = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    held.close()
    assert "another process is computing this study" in other.stderr


def test_a_file_in_the_way_is_refused(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(ConfigError, match="cannot keep the study here"):
        Checkpoint(tmp_path / "file" / "study", STUDY)


def test_going_on_with_other_settings_is_refused_by_the_runner(tmp_path):
    tasks = [{"number": n} for n in (3, 4, 5)]
    run_study(tasks, "runner_tasks:fails", setting={"spread": 0.05}, folder=tmp_path / "study")
    with pytest.raises(ConfigError, match=r"another study: spread is 0.05 there and 0.1 here.*Name another"):
        run_study(tasks, "runner_tasks:fails", setting={"spread": 0.1}, folder=tmp_path / "study")
