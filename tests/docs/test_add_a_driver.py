"""docs/how-to/add-a-driver.md is followed literally: its files are written, its commands run, its tests pass.

Only `pip install` is replaced, by what it would leave behind (the package and its metadata, read from the
page's pyproject.toml), so that nothing is fetched and the environment of the other tests stays as it is.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "how-to" / "add-a-driver.md"
BLOCK = re.compile(r"(?:`([\w./-]+)`:\n\n)?^```(sh|python|toml)\n(.*?)^```", re.MULTILINE | re.DOTALL)
PIP = """#!{python}
import pathlib, shutil, sys, tomllib
assert sys.argv[1:] == ["install", "-e", "."], sys.argv
project = tomllib.loads(pathlib.Path("pyproject.toml").read_text())["project"]
module = project["name"].replace("-", "_")
site = pathlib.Path("{site}")
info = site / f"{{module}}-{{project['version']}}.dist-info"
info.mkdir(parents=True)
(site / f"{{module}}").symlink_to(pathlib.Path(module).resolve())
about = f"Name: {{project['name']}}\\nVersion: {{project['version']}}\\n"
(info / "METADATA").write_text("Metadata-Version: 2.1\\n" + about)
lines = [f"[{{group}}]\\n" + "".join(f"{{name}} = {{target}}\\n" for name, target in points.items())
         for group, points in project["entry-points"].items()]
(info / "entry_points.txt").write_text("\\n".join(lines))
"""
RIGCTL = """#!{python}
import sys
from rigctl.app.cli import app, main
if not any(group.name == "devices" for group in app.registered_groups):
    from rigctl.app.devices import register
    register(app)
main()
"""


def program(path: Path, text: str) -> None:
    path.parent.mkdir(exist_ok=True)
    path.write_text(text)
    path.chmod(0o755)


@pytest.mark.slow
def test_the_page_followed_literally_adds_a_device(tmp_path: Path):
    work, site, tools = tmp_path / "work", tmp_path / "site", tmp_path / "tools"
    work.mkdir()
    shutil.copytree(ROOT / "configs", work / "configs")
    program(tools / "pip", PIP.format(python=sys.executable, site=site))
    program(tools / "rigctl", RIGCTL.format(python=sys.executable))
    environment = {
        **os.environ,
        "PATH": f"{tools}:{Path(sys.executable).parent}:{os.environ['PATH']}",
        "PYTHONPATH": f"{site}:{work}",
        "RIGCTL_BENCH_DIR": str(tmp_path / "ports"),
        "COLUMNS": "200",
    }
    printed: list[str] = []
    files = 0
    for name, language, text in BLOCK.findall(PAGE.read_text()):
        if name:
            (work / name).write_text(text)
            files += 1
            continue
        assert language == "sh", f"a block without the name of its file: {text}"
        done = subprocess.run(
            ["sh", "-ec", text],
            cwd=work,
            env=environment,
            capture_output=True,
            text=True,
            timeout=150,
            check=False,
        )
        assert done.returncode == 0, f"{text}\n{done.stdout}\n{done.stderr}"
        printed.append(done.stdout)
    assert files == 5
    everything = "\n".join(printed)
    assert re.search(r"\d+ passed", printed[1])
    assert re.search(
        r"source +acme-t100 +acme_thermometer.driver:Thermometer +acme-thermometer 0.1.0", everything
    )
    tested = printed[-1]
    assert "acquisition (live): ok" in tested
    assert "room: model ACME T100 SN4711" in tested
    assert re.search(r"disc_temperature +23.4 °C", tested)
    assert "100 round trips" in tested
    assert re.search(r"acquisition \(live\) +disc_temperature +23.4 °C", tested)
    assert re.search(r"> 54 2a 35 34 0d +\|T\*54\.\|", tested)  # the wire log
    assert "< 54 2b 30 30 32 33 2e 34 2a 36 34 0d" in tested
