"""What the Makefile and ``python/bootstrap.sh`` do where something is missing: a sentence, and nothing of ours is lost."""

from __future__ import annotations

import os
import re
import runpy
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
NEEDED = ("bash", "dirname", "cat", "cut", "rm", "env")

pytestmark = pytest.mark.posix


def checkout(tmp_path: Path, *tools: str) -> tuple[Path, dict[str, str]]:
    """What ``make setup`` reads of a checkout, and an environment whose PATH holds only these tools."""
    (tmp_path / "python").mkdir()
    for name in ("bootstrap.sh", "pyproject.toml"):
        shutil.copy(ROOT / "python" / name, tmp_path / "python")
    programs = tmp_path / "programs"
    programs.mkdir()
    for name in (*NEEDED, *tools):
        (programs / name).symlink_to(shutil.which(name))
    return tmp_path, {"PATH": str(programs)}


def set_up(place: Path, environment: dict[str, str]) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        ["bash", str(place / "python" / "bootstrap.sh")], env=environment, capture_output=True, text=True
    )


def test_help_lists_every_target_that_says_what_it_is():
    makefile = (ROOT / "Makefile").read_text("utf-8")
    told = {line.partition(":")[0] for line in makefile.splitlines() if ":" in line and " ## " in line}
    done = subprocess.run(["make", "--no-print-directory", "help"], cwd=ROOT, capture_output=True, text=True)
    assert {line.split()[0] for line in done.stdout.splitlines()} == told >= {"demo", "tester-kit"}


def test_the_program_that_setup_makes_on_debian_starts_as_the_one_that_pip_makes():
    """Else Ctrl+C in its first tenths of a second, while all is imported, ends in a traceback."""
    module, function = re.search(r'^kinefab = "(.*):(.*)"$', (ROOT / "python/pyproject.toml").read_text("utf-8"), re.M).groups()
    assert f"from {module} import {function}\\n{function}()" in (ROOT / "python/bootstrap.sh").read_text("utf-8")


def test_setup_without_sha256sum_says_so(tmp_path):
    place, environment = checkout(tmp_path)
    done = set_up(place, environment)
    assert done.returncode != 0 and "sha256sum is not on the PATH" in done.stderr


def test_setup_with_an_old_python_says_so(tmp_path):
    place, environment = checkout(tmp_path, "sha256sum")
    old = tmp_path / "programs" / "python3"
    old.write_text('#!/usr/bin/env bash\ncase "$2" in *exit*) exit 1;; *) echo Python 3.9;; esac\n')
    old.chmod(0o755)
    done = set_up(place, environment)
    assert done.returncode != 0 and not (place / ".venv").exists()
    assert "Python 3.9 is on the PATH; kinefab needs Python 3.10 or newer" in done.stderr


def test_setup_leaves_a_foreign_environment_alone(tmp_path):
    place, environment = checkout(tmp_path, "sha256sum")
    mine = place / ".venv" / "mine.txt"
    mine.parent.mkdir()
    mine.write_text("mine")
    done = set_up(place, environment)
    assert done.returncode != 0 and mine.read_text() == "mine" and os.listdir(place / ".venv") == ["mine.txt"]
    assert "was not made here" in done.stderr and "Move it away" in done.stderr


@pytest.mark.skipif(shutil.which("make") is None, reason="no make on the PATH")
def test_setup_compiles_the_checkout_where_python_itself_writes_no_bytecode(tmp_path):
    shutil.copy(ROOT / "Makefile", tmp_path)
    (tmp_path / "python" / "src").mkdir(parents=True)
    (tmp_path / "python" / "bootstrap.sh").write_text("")
    (tmp_path / "python" / "src" / "module.py").write_text("x = 1\n")
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}
    environment.pop("PYTHONPYCACHEPREFIX", None)
    command = ["make", "setup", f"PYTHON={sys.executable}"]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert list((tmp_path / "python" / "src").glob("__pycache__/module.*.pyc"))


def demo(tmp_path: Path, *tools: str, **stubs: str) -> subprocess.CompletedProcess[str]:
    """``make demo`` with this interpreter, into ``tmp_path/out``, where the PATH holds these tools and stubs alone."""
    programs = tmp_path / "programs"
    programs.mkdir()
    for name in ("bash", "sh", "grep", "mkdir", "make", *tools):
        (programs / name).symlink_to(shutil.which(name))
    for name, text in stubs.items():
        (programs / name.replace("_", "-")).write_text(text)
        (programs / name.replace("_", "-")).chmod(0o755)
    variables = (f"PYTHON={sys.executable}", f"OUT={tmp_path / 'out'}", "TOOL=nowhere")
    command = ["make", "-o", "setup", "demo", *variables]
    made_by_make = {
        "MAKEFLAGS",
        "MFLAGS",
        "MAKELEVEL",
        "MAKEOVERRIDES",
    }  # `make test` runs this: no level below its own
    environment = {
        **{name: value for name, value in os.environ.items() if name not in made_by_make},
        "PATH": str(programs),
        "DISPLAY": "",
        "WAYLAND_DISPLAY": "",
    }  # opens no browser
    return subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)


@pytest.mark.skipif(shutil.which("make") is None, reason="no make on the PATH")
def test_the_demo_without_dotnet_does_the_python_half_and_says_what_is_left_out(tmp_path):
    done = demo(tmp_path)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out" / "lever.kinefab").is_file() and (tmp_path / "out" / "lever.svg").is_file()
    assert "mobility 1" in done.stdout and "it needs the .NET 10 SDK" in done.stdout
    assert Path(done.stdout.splitlines()[-1]) == tmp_path / "out" / "lever.html"  # the page, to be looked at
    assert (tmp_path / "out" / "lever.html").is_file()


@pytest.mark.skipif(shutil.which("make") is None, reason="no make on the PATH")
def test_the_demo_uses_a_tool_that_is_installed(tmp_path):
    """``dotnet-kinefab`` on the PATH, as a global tool is, does the other half without an SDK; its refusal counts."""
    done = demo(tmp_path, dotnet_kinefab='#!/usr/bin/env bash\necho "asked to $1"\nexit 3\n')
    assert done.returncode != 0 and "asked to validate" in done.stdout and "left out" not in done.stdout


@pytest.mark.parametrize(
    "cores, found, options", [(2, True, ["-n", "2"]), (64, True, ["-n", "8"]), (1, True, []), (2, False, [])]
)
def test_the_tests_run_on_every_core_where_xdist_is_there(monkeypatch, cores, found, options):
    """A file on one core; in one process where there is one core, or no pytest-xdist, as on a Debian without an index."""
    run = runpy.run_path(str(ROOT / "tests" / "run.py"))["side_by_side"]
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: range(cores), raising=False)
    monkeypatch.setitem(run.__globals__, "find_spec", lambda name: object() if found else None)
    assert run() == ([*options, "--dist", "loadfile"] if options else [])


def test_what_is_missing_is_one_skip_however_many_tests_want_it(tmp_path):
    outcomes = [
        "<skipped message='no tool'/>",
        "",
        "<skipped message='no tool'/>",
        "<failure/>",
        "<skipped message='no disk'/>",
    ]
    cases = (f"<testcase classname='t' name='{i}'>{inner}</testcase>" for i, inner in enumerate(outcomes))
    (tmp_path / "junit.xml").write_text(f"<testsuites><testsuite>{''.join(cases)}</testsuite></testsuites>")
    run = runpy.run_path(str(ROOT / "tests" / "run.py"))
    counts = run["Counts"]()
    run["count"](counts, tmp_path / "junit.xml")
    assert (counts.passed, counts.failed) == (1, ["t.3"])
    assert counts.skipped == ["no tool: t.0 and 1 more", "no disk: t.4"]
