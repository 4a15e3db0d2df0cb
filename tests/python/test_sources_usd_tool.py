"""Every USD stage of the fixtures through the C# tool: valid to the letter, and as mobile as pxr's joints leave it."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import kinefab
import pytest
from test_sources_usd_stacks import two_hinges
from usd_stages import body, joint, stage

pytest.importorskip("pxr", reason="usd-core is not installed")
sys.path.append(str(Path(__file__).resolve().parents[2] / "python" / "bench"))

TOOL = "dotnet-kinefab"
FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
STAGES = sorted([*FIXTURES.glob("twins/*.usda"), *FIXTURES.glob("lever/*.usda")])
CONE = "float physics:coneAngle0Limit = 30; float physics:coneAngle1Limit = 20"
AXES = '"PhysicsLimitAPI:transX", "PhysicsLimitAPI:transY", "PhysicsLimitAPI:transZ"'
LOCKED = "; ".join(
    f"float limit:trans{axis}:physics:low = 1; float limit:trans{axis}:physics:high = -1" for axis in "XYZ"
)
WRITTEN = {
    "fixed": (0, body("A") + joint("PhysicsFixedJoint", body1="/A")),
    "slide": (1, body("B") + joint("PhysicsPrismaticJoint", inside="float physics:lowerLimit = -1")),
    "cone": (3, body("B") + joint("PhysicsSphericalJoint", inside=CONE)),
    "generic": (9, body("A") + body("B") + joint("PhysicsJoint", body0="/A", inside=LOCKED, schemas=AXES)),
    "free": (6, body("B")),
}
"""Stages by their mobility, counted by hand."""


def run(*arguments: object) -> dict:
    done = subprocess.run([TOOL, *map(str, arguments), "--json"], capture_output=True, text=True, timeout=120)
    return json.loads(done.stdout)


def checked(target: Path, mobility: int) -> None:
    said = run("validate", target, "--strict")
    assert said["valid"] and said["diagnostics"] == []
    counted = run("mobility", target)
    assert counted["mobility"]["mobility"] == mobility
    assert [d for d in counted["diagnostics"] if d["severity"] == "error"] == []


needs_tool = pytest.mark.skipif(shutil.which(TOOL) is None, reason=f"{TOOL} is not on the PATH")


@needs_tool
def test_fixtures_are_valid_and_as_mobile_as_pxr_has_them(tmp_path):
    from engines import usd

    assert len(STAGES) > 3
    for path in STAGES:
        result = kinefab.export(path, tmp_path / f"{path.stem}.kinefab")
        couplings = len(result.analysed.scene.couplings)
        checked(result.path, usd.load(path, ()).mobility - couplings)


@needs_tool
@pytest.mark.parametrize("name", [*WRITTEN, "stack"])
def test_each_kind_of_joint_is_valid_and_as_mobile_as_stated(tmp_path, name):
    mobility, content = WRITTEN.get(name, (8, ""))
    path = tmp_path / "stage.usda"
    path.write_text(stage(content) if content else two_hinges(), encoding="utf-8")
    checked(kinefab.export(path, tmp_path / "scene.kinefab").path, mobility)
