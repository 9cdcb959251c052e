"""Program files: comments are noticed, writing is whole or not at all, the command line reads the same."""

import stat
import tomllib
from datetime import datetime
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rigctl.app.compose import read_program
from rigctl.core.errors import ConfigError
from rigctl.gui.pages.sequence.program_file import (
    has_comments,
    open_program,
    rigs_in,
    save_copy,
    save_program,
    shipped_programs,
    text_on_disk,
)
from sequences.program import dump_program

ROOT = Path(__file__).resolve().parents[3]
PROGRAMS = ROOT / "configs/programs"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a = 1", False),
        ("a = 1 # one", True),
        ("# x\na = 1", True),
        ('a = "# no"', False),
        ("a = '# no'", False),
        ('a = "\\" # no"', False),
        ('a = """\n# no\n"""', False),
        ("a = '''\n# no\n'''", False),
        ('a = """\n"""  # yes', True),
        ("a = 'it''s'", False),
        ('a = "x"\n#', True),
        ("", False),
    ],
)
def test_comments_are_told_from_strings(text: str, expected: bool) -> None:
    assert has_comments(text) is expected


@given(st.text(max_size=60))
def test_written_programs_have_no_comments_whatever_is_described(description: str) -> None:
    program = open_program(PROGRAMS / "quick_check.toml").program
    text = dump_program(program.model_copy(update={"description": description}))
    tomllib.loads(text)
    assert not has_comments(text)


def test_saved_here_is_the_same_for_the_command_line(tmp_path: Path) -> None:
    for path in PROGRAMS.glob("*.toml"):
        program = open_program(path).program
        saved = save_program(program, tmp_path / "new" / path.name)
        assert read_program(saved.path) == program
        assert saved.text == saved.path.read_text("utf-8")
        assert list((tmp_path / "new").glob(".*")) == []


def test_rights_of_a_file_stay(tmp_path: Path) -> None:
    program = open_program(PROGRAMS / "quick_check.toml").program
    path = save_program(program, tmp_path / "a.toml").path
    path.chmod(0o640)
    save_program(program, path)
    assert stat.S_IMODE(path.stat().st_mode) == 0o640


def test_what_cannot_be_written_is_said_and_nothing_is_lost(tmp_path: Path) -> None:
    program = open_program(PROGRAMS / "quick_check.toml").program
    blocked = tmp_path / "file"
    blocked.write_text("x")
    with pytest.raises(ConfigError, match="cannot be written"):
        save_program(program, blocked / "a.toml")
    assert blocked.read_text() == "x"


def test_copies_never_overwrite(tmp_path: Path) -> None:
    program = open_program(PROGRAMS / "quick_check.toml").program
    now = datetime(2026, 1, 2, 3, 4, 5)
    paths = [save_copy(program, tmp_path, now).path for _ in range(3)]
    assert [p.name for p in paths] == [
        "quick_check-20260102-030405.toml", "quick_check-20260102-030405-2.toml",
        "quick_check-20260102-030405-3.toml",
    ]  # fmt: skip


def test_broken_files_name_key_and_remedy(tmp_path: Path) -> None:
    path = tmp_path / "broken.toml"
    path.write_text('format = 1\nname = "x"\nsequence = []\n')
    with pytest.raises(ConfigError, match="sequence"):
        open_program(path)


def test_shipped_programs_and_rigs(tmp_path: Path) -> None:
    (tmp_path / "no.toml").write_text("x = ")
    assert shipped_programs(tmp_path) == ()
    assert "squeal_matrix" in [program.name for program in shipped_programs(PROGRAMS)]
    rigs, refused = rigs_in(ROOT / "configs/rigs")
    assert next(iter(rigs)).stem == "simulated"
    assert refused == ()
    assert len(rigs_in(tmp_path)[1]) == 1


def test_text_on_disk(tmp_path: Path) -> None:
    assert text_on_disk(tmp_path / "none") is None
    (tmp_path / "binary").write_bytes(b"\xff\xfe\x00")
    assert text_on_disk(tmp_path / "binary") is None
