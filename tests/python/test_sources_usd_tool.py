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
REACH = "; float limit:rotY:physics:low = -30; float limit:rotY:physics:high = 50"
LED = "bool physics:kinematicEnabled = 1"
BARS = {"A": (0.1, 0, 0.5), "B": (1.3, 0, 1.4), "C": (2.8, 0, 0.9)}


def at(first, second) -> str:
    return f"point3f physics:localPos0 = {tuple(first)}; point3f physics:localPos1 = {tuple(second)}"


def hinge(name: str, a: str, place_a, b: str, place_b, pin, axis: str) -> str:
    """Bodies without rotation, their joint where ``pin`` is in the world; a: "" for the world."""
    ends = ([round(p - o, 9) for p, o in zip(pin, place)] for place in (place_a, place_b))
    words = at(*ends) + f'; uniform token physics:axis = "{axis}"'
    limits = "; float physics:lowerLimit = -10; float physics:upperLimit = 80"
    return joint("PhysicsRevoluteJoint", name, words + limits, f"/{a}" if a else "", f"/{b}")


WRITTEN = {
    "fixed": (0, body("A") + joint("PhysicsFixedJoint", body1="/A")),
    "slide": (1, body("B") + joint("PhysicsPrismaticJoint", inside="float physics:lowerLimit = -1")),
    "cone": (3, body("B") + joint("PhysicsSphericalJoint", inside=CONE)),
    "generic": (9, body("A") + body("B") + joint("PhysicsJoint", body0="/A", inside=LOCKED, schemas=AXES)),
    "free": (6, body("B")),
    "hinge, with a range beside it": (
        1,
        body("B", (0.3, 1, 2))
        + hinge("One", "", (0, 0, 0), "B", (0.3, 1, 2), (0.1, 1, 2), "Y")
        + joint("PhysicsJoint", "Two", at((0.3, 1, 2), (0, 0, 0)) + REACH, schemas='"PhysicsLimitAPI:rotY"'),
    ),
    "led, with a chain": (
        4,
        body("K", (0, 0, 2), LED)
        + body("A", (1, 0, 2))
        + body("B", (2, 0, 2))
        + hinge("One", "K", (0, 0, 2), "A", (1, 0, 2), (0.4, 0, 2), "Y")
        + joint("PhysicsSphericalJoint", "Two", at((0.5, 0, 0), (-0.5, 0, 0)), "/A", "/B"),
    ),
    "led, in a loop": (
        1,
        body("K", (3, 0, 0), LED)
        + "".join(body(name, place) for name, place in BARS.items())
        + hinge("One", "", (0, 0, 0), "A", BARS["A"], (0, 0, 0), "Y")
        + hinge("Two", "A", BARS["A"], "B", BARS["B"], (0.2, 0, 1), "Y")
        + hinge("Three", "B", BARS["B"], "C", BARS["C"], (2.5, 0, 1.7), "Y")
        + hinge("Four", "C", BARS["C"], "K", (3, 0, 0), (3, 0, 0.1), "Y"),
    ),
}
"""Stages by their mobility, counted by hand."""


BETWEEN_LED = {
    "and the world": hinge("J", "", (0, 0, 0), "K", (0, 0, 2), (0.3, 0, 2), "Y"),
    "and the world, held": joint("PhysicsFixedJoint", "J", "point3f physics:localPos0 = (0, 0, 2)", "", "/K"),
    "and another, by a hinge": hinge("J", "K", (0, 0, 2), "L", (1, 0, 2), (0.4, 0, 2), "Y"),
    "and another, held": joint("PhysicsFixedJoint", "J", "point3f physics:localPos0 = (1, 0, 0)", "/K", "/L"),
}
"""Joints of which no solver moves a side: K and L are led by scripts."""


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


@needs_tool
@pytest.mark.parametrize("up, metres", [("Z", 1.0), ("Y", 0.01)])
@pytest.mark.parametrize("case", BETWEEN_LED)
def test_a_joint_between_what_scripts_lead_is_left_out_and_told(tmp_path, case, up, metres):
    path = tmp_path / "stage.usda"
    led = body("K", (0, 0, 2), LED) + body("L", (1, 0, 2), LED) + body("A", (1.3, 0, 2))
    arm = hinge("Arm", "K", (0, 0, 2), "A", (1.3, 0, 2), (0.4, 0, 2), "Y")
    path.write_text(stage(led + arm + BETWEEN_LED[case], up, metres), encoding="utf-8")
    result = kinefab.export(path, tmp_path / "scene.kinefab")
    checked(result.path, 1)
    (told,) = [o for o in result.report.outcomes if o.code]
    assert (told.feature, told.outcome.value, told.code) == ("joint J", "dropped", "JOINT_BETWEEN_LED")
    assert told.where == "stage.usda</J>"
    joints = [c for o in json.loads(result.path.read_text("utf-8"))["gameObjects"] for c in o["components"]]
    assert [c["type"] for c in joints if "Joint" in c["type"]] == ["HingeJoint"]


@needs_tool
def test_what_is_fixed_to_one_of_two_led_bodies_follows_that_one(tmp_path):
    """A fixed joint between K and L holds nothing, as scripts lead each for itself; A goes where L goes."""
    path = tmp_path / "stage.usda"
    led = body("K", (0, 0, 2), LED) + body("L", (1, 0, 2), LED) + body("A", (1.3, 0, 2))
    fixed = BETWEEN_LED["and another, held"]
    held = joint("PhysicsFixedJoint", "H", "point3f physics:localPos0 = (0.3, 0, 0)", "/L", "/A")
    path.write_text(stage(led + fixed + held), encoding="utf-8")
    result = kinefab.export(path, tmp_path / "scene.kinefab")
    checked(result.path, 0)
    objects = json.loads(result.path.read_text("utf-8"))["gameObjects"]
    (bond,) = [
        (o["name"], objects[c["connectedBody"]]["name"])
        for o in objects
        for c in o["components"]
        if c["type"] == "FixedJoint"
    ]
    assert sorted(bond) == ["A", "L"]


@needs_tool
def test_a_joint_between_what_scripts_lead_stays_where_a_coupling_counts_from_it(tmp_path):
    """What follows it follows the script; a light body carries the joint, as a joint between two led ones is a fault."""
    path = tmp_path / "stage.usda"
    lead = hinge("J", "", (0, 0, 0), "K", (0, 0, 2), (0, 0, 2), "Y")
    follow = hinge("F", "", (0, 0, 0), "A", (1, 0, 2), (1, 0, 2), "Y")
    follow = follow.replace('"F" ', '"F" (prepend apiSchemas = ["NewtonMimicAPI"])')
    follow = follow.replace("{\n", "{\nrel newton:mimicJoint = </J>\nfloat newton:mimicCoef1 = -2\n", 1)
    path.write_text(stage(body("K", (0, 0, 2), LED) + body("A", (1, 0, 2)) + lead + follow), encoding="utf-8")
    result = kinefab.export(path, tmp_path / "scene.kinefab")
    (told,) = result.report.diagnostics
    assert (told.code, told.where) == ("JOINT_BETWEEN_LED_COUNTED", "stage.usda</J>")
    assert "mimic:F" in told.message and len(result.analysed.scene.couplings) == 1
    checked(result.path, 0)
    objects = json.loads(result.path.read_text("utf-8"))["gameObjects"]
    (light,) = [o for o in objects if o["id"].startswith("K/counted")]
    assert [c["type"] for c in light["components"]] == ["Rigidbody", "FixedJoint", "ConfigurableJoint"]
    assert not any("Motion" in field for field in light["components"][2])  # all six free
    assert [c["type"] for o in objects if o["id"] == "K" for c in o["components"]] == ["Rigidbody"]
