"""The gates: ruff finds nothing and changes nothing, and pyright, strict, finds nothing in the package."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
SETTINGS = "python/pyproject.toml"
CHECKED = ("python", "tests", "fixtures")

if find_spec("ruff") is None and find_spec("pyright") is None:  # one skip, not one for each
    pytest.skip("ruff and pyright are not installed (python[dev] has them)", allow_module_level=True)


def run(*command: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-m", *command], cwd=ROOT, capture_output=True, text=True)


@pytest.mark.parametrize("gate", [("check",), ("format", "--check")], ids=" ".join)
def test_ruff(gate: tuple[str, ...]):
    """Lint and format, settings in pyproject.toml."""
    pytest.importorskip("ruff", reason="ruff is not installed (python[dev] has it)")
    done = run("ruff", *gate, "--no-cache", "--config", SETTINGS, *CHECKED)
    assert done.returncode == 0, done.stdout + done.stderr


def errors_of(*arguments: str) -> tuple[int, list[str]]:
    """How many files pyright looked at, and its errors."""
    if find_spec("pyright") is None or find_spec("scipy-stubs") is None:
        pytest.skip("pyright and scipy-stubs are not installed (python[dev] has them)")
    if int(np.__version__.partition(".")[0]) < 2:
        pytest.skip("the types that numpy states before 2.0 are too coarse to check against")
    if run("pyright", "--version").returncode:  # it fetches itself where it is not cached yet
        pytest.skip("pyright cannot be had: npm's registry does not answer")
    done = run("pyright", *arguments, "--pythonpath", sys.executable, "--outputjson")
    report = json.loads(done.stdout)
    errors = [
        f"{os.path.relpath(e['file'], ROOT)}:{e['range']['start']['line'] + 1} {e['message']}"
        for e in report["generalDiagnostics"]
        if e["severity"] == "error"
    ]
    return report["summary"]["filesAnalyzed"], errors


def test_pyright():
    """Strict, by the settings in pyproject.toml: no error in the package."""
    files, errors = errors_of("-p", SETTINGS)
    assert files > 50
    assert not errors, "\n".join(errors)


def test_a_script_is_free_of_type_errors(tmp_path: Path):
    """Strict, with what the package says of itself: arrays and lists where numbers are wanted, words for options, a name for
    the type of each thing that it hands out."""
    shutil.copy(Path(__file__).with_name("typed_script.py"), tmp_path / "script.py")
    settings = {"include": ["script.py"], "typeCheckingMode": "strict"}
    settings["extraPaths"] = [str(ROOT / "python" / "src")]
    (tmp_path / "pyrightconfig.json").write_text(json.dumps(settings), encoding="utf-8")
    assert errors_of("-p", str(tmp_path / "pyrightconfig.json")) == (1, [])
