"""Every robot of the tests through the C# tool: valid to the letter, and as mobile as the engine that owns the format says."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import kinefab
import pytest
from test_sources_sdf import ZOO
from test_sources_urdf import zoo

sys.path.append(str(Path(__file__).parents[2] / "python" / "bench"))

__all__ = ["zoo"]
TOOL = "dotnet-kinefab"
TWINS = Path(__file__).parents[2] / "fixtures" / "twins"
MOBILITY = {"lever.urdf": 3, "lever.sdf": 1, "fourbar.urdf": 3, "fourbar.sdf": 1, "arm.urdf": 7, "arm.sdf": 7}
"""Of the twins, counted by hand: an open tree has its joints, a slider-crank and a four-bar one, the arm six and a grip."""


def run(*arguments: object) -> dict:
    done = subprocess.run([TOOL, *map(str, arguments), "--json"], capture_output=True, text=True, timeout=120)
    return json.loads(done.stdout)


def test_robots_are_valid_and_as_mobile_as_their_engines_say(tmp_path, zoo):
    if shutil.which(TOOL) is None:
        pytest.skip(f"{TOOL} is not on the PATH")
    sdf = tmp_path / "zoo.sdf"
    sdf.write_text(ZOO, encoding="utf-8")
    # URDF: revolute, continuous, slide, planar (3), floating (6), two that follow; SDF: five that do not follow.
    for path, mobility in [*((TWINS / name, n) for name, n in MOBILITY.items()), (zoo, 12), (sdf, 4)]:
        target = kinefab.export(path, tmp_path / f"{path.name}.kinefab").path
        said = run("validate", target, "--strict")
        told = {d["code"] for d in said["diagnostics"]} - {"JOINT_STATED_UNFOLLOWED"}  # URDF asks for effort and speed
        assert said["valid"] and not told, path.name
        counted = run("mobility", target)
        assert counted["mobility"]["mobility"] == mobility, path.name
        assert [d for d in counted["diagnostics"] if d["severity"] == "error"] == [], path.name
