"""The command line, run as a program of its own."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from inspect import signature
from pathlib import Path

import jsonschema
import kinefab
import pytest
from kinefab.diagnostics import schema_directory
from scenes import lid_scene
from typer.testing import CliRunner

LEVER = Path(__file__).parents[2] / "fixtures" / "lever" / "lever.bundle.json"


def runner() -> CliRunner:
    """In this process.  click before 8.2 puts both streams into one unless it is told not to."""
    apart = {"mix_stderr": False} if "mix_stderr" in signature(CliRunner).parameters else {}
    return CliRunner(**apart)


def run(*arguments, cwd=None, **environment):
    return subprocess.run(
        [sys.executable, "-m", "kinefab", *map(str, arguments)],
        cwd=cwd,
        capture_output=True,
        text=True,
        timeout=60,
        env={**os.environ, **environment},
    )


def checked_report(path: Path) -> dict:
    schema = json.loads((schema_directory() / "export_report.schema.json").read_text(encoding="utf-8"))
    report = json.loads(path.read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator(schema).validate(report)
    return report


@pytest.fixture()
def lid(tmp_path) -> Path:
    return kinefab.export(lid_scene(), tmp_path / "lid.kinefab", kinefab.ExportOptions(ground="world")).path
