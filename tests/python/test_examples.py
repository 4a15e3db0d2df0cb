"""The scripts of ``python/examples`` run as they stand there, and what they write is sound."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "python" / "examples"
MOBILITY = {"lid": 1, "four_bar": 1, "four_bar_mates": 1, "scissor_lift": 1, "planetary_gear": 1, "six_axis_arm": 6}
"""Of those that write a scene; by theory."""


@pytest.mark.parametrize("name", MOBILITY)
def test_example_writes_a_sound_scene(name, tmp_path):
    target = tmp_path / f"{name}.kinefab"
    done = subprocess.run(
        [sys.executable, str(EXAMPLES / f"{name}.py"), str(target)],
        capture_output=True,
        text=True,
        env=dict(os.environ),
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.rstrip().endswith(f"mobility {MOBILITY[name]}")
    content = json.loads(target.read_text("utf-8"))
    assert content["analysis"]["mobility"] == MOBILITY[name]
    # A servo with a largest torque has no hinge, whose stop near a half turn holds: told.
    told = [entry for entry in content["report"] if entry.get("code") != "JOINT_STOP_WRAPS"]
    assert {entry["outcome"] for entry in told} == {"kept"}
    if tool := shutil.which("dotnet-kinefab"):
        for command in (["validate", str(target), "--strict"], ["mobility", str(target)]):
            found = subprocess.run([tool, *command], capture_output=True, text=True)
            assert found.returncode == 0, found.stdout + found.stderr


def test_every_example_is_run():
    others = {"slider_stroke"}  # run by the tests of motion
    assert {path.stem for path in EXAMPLES.glob("*.py")} == MOBILITY.keys() | others
