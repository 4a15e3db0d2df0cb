"""Couplings of several terms: as they are in a scene; in a stage, whose mimics follow one coordinate, by light bodies whose motions add up."""

from __future__ import annotations

import json
import math
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import kinefab
import numpy as np
import pytest
from kinefab.diagnostics import Outcome
from kinefab.model import RX, TX, Coupling, CouplingKind, JointKind, Term
from kinefab.spatial import Pose, rotation_about
from scenes import BOX, read

TOOL = "dotnet-kinefab"
FOLLOWS = {
    "Slide": {"Left": 0.2, "Right": -0.1},
    "Left": {"Right": 0.5, "Slide": 5.0},
    "Right": {"Left": 2.0, "Slide": -10.0},
}
"""The same relation, solved for each of its coordinates; metres and radians."""


def machine(follower: str, moved: bool) -> kinefab.Scene:
    """Two hinges and a slide on a base; one of them follows the two others.

    moved: the base itself turns, and the hinges' axes stand askew; the follower's sum counts against the base.
    """
    scene = kinefab.Scene()
    base = scene.add_part("Base", BOX, density=1000, translation=(0, -0.5, 0.2), grounded=not moved)
    if moved:
        scene.add_hinge(None, base, point=(0, -0.5, 0), axis=(0, 3, 4), name="Swivel")
    parts = [
        scene.add_part(name, BOX, density=1000, translation=(i, 0.1, 0)) for i, name in enumerate("ABC", 1)
    ]
    a = scene.add_hinge(base, parts[0], point=(1, 0, 0), axis=(2, 3, 6), limits=(-50, 90), name="Left")
    b = scene.add_hinge(parts[1], base, point=(2, 0, 0), axis=(0, 0, -1), limits=(-30, 80), name="Right")
    c = scene.add_slider(base, parts[2], point=(3, 0, 0), axis=(1, 0, 0), limits=(-0.2, 0.5), name="Slide")
    freedom = {"Left": (a.id, RX), "Right": (b.id, RX), "Slide": (c.id, TX)}
    terms = tuple(Term(*freedom[name], ratio) for name, ratio in FOLLOWS[follower].items())
    scene.couplings.append(Coupling("sum", CouplingKind.LINEAR, *freedom[follower], terms))
    return scene


def moves_as_stated(written: kinefab.Mechanism, share: float) -> bool:
    """Whether the Slide follows 0.2 m a radian of Left less 0.1 m a radian of Right.  share: metres that it may be off."""
    off: list[float] = []
    for values in ({"Left": [0, 30], "Right": [0, 70]}, {"Left": [0, -20], "Right": [0, 25]}):
        reached = written.follow({name: np.linspace(*ends, 8) for name, ends in values.items()})
        assert reached.stop is None
        slide = 0.2 * math.radians(values["Left"][1]) - 0.1 * math.radians(values["Right"][1])
        off.append(abs(reached["Slide"][-1] - slide))
    return max(off) < share


def tool(*arguments: object) -> dict[str, Any]:
    done = subprocess.run([TOOL, *map(str, arguments), "--json"], capture_output=True, text=True, timeout=120)
    return json.loads(done.stdout)


@pytest.mark.parametrize("moved", [False, True])
@pytest.mark.parametrize("follower", ["Left", "Right", "Slide"])
def test_a_sum_moves_as_in_the_source(follower: str, moved: bool, tmp_path: Path):
    """0.2 m a radian of Left less 0.1 m a radian of Right is the Slide, whichever of them is said to follow."""
    scene = machine(follower, moved)
    result = kinefab.export(scene, tmp_path / "m.kinefab")
    content = read(result.path)
    assert not result.report.diagnostics
    (coupling,) = content["couplings"]
    assert content["version"] == "1.1" and len(coupling["terms"]) == 2 and not {"a", "ratio"} & coupling.keys()
    assert len(content["gameObjects"]) == 5  # and the ground
    written = kinefab.motion(result.path)
    assert written.mobility == kinefab.motion(scene).mobility == 2 + moved
    assert moves_as_stated(written, 1e-6)


@pytest.mark.parametrize("follower", ["Left", "Slide"])
def test_the_tool_counts_and_moves_a_sum_as_the_source_does(follower: str, tmp_path: Path):
    if shutil.which(TOOL) is None:
        pytest.skip(f"{TOOL} is not on the PATH")
    target = kinefab.export(machine(follower, moved=True), tmp_path / "m.kinefab").path
    said = tool("validate", target, "--strict")
    assert said["valid"] and said["diagnostics"] == []
    counted = tool("mobility", target)
    assert counted["mobility"]["mobility"] == 3 and counted["diagnostics"] == []
    swept = tool("sweep", target, "--joint", "Right", "--from", "0", "--to", "40", "--steps", "5")
    assert swept["sweep"]["last"] == pytest.approx(40.0) and swept["sweep"]["worstGap"] < 1e-9


def test_joints_of_more_than_one_sum(tmp_path: Path):
    """Two sums of the same joints, read again and written for a prefab."""
    scene = machine("Slide", moved=False)
    extra = scene.add_part("Extra", BOX, density=1000, translation=(4, 0, 0))
    hinge = scene.add_joint(JointKind.REVOLUTE, None, extra, point=(4, 0, 0), axis=(0, 1, 0), name="Fourth")
    ids = {joint.name: joint.id for joint in scene.joints}
    terms = (Term(ids["Left"], RX, 3.0), Term(ids["Right"], RX, 0.5))
    scene.couplings.append(Coupling("again", CouplingKind.LINEAR, hinge.id, RX, terms))
    content = read(kinefab.export(scene, tmp_path / "m.kinefab").path)
    again = read(kinefab.export(tmp_path / "m.kinefab", tmp_path / "again.kinefab").path)
    assert again["couplings"] == content["couplings"] and len(content["couplings"]) == 2
    written = kinefab.motion(tmp_path / "m.kinefab")
    reached = written.follow({"Left": np.linspace(0, 20, 5), "Right": np.linspace(0, -10, 5)})
    assert written.mobility == 2 and reached["Fourth"][-1] == pytest.approx(55.0, abs=1e-6)


@pytest.mark.parametrize("moved", [False, True])
@pytest.mark.parametrize("follower", ["Left", "Right", "Slide"])
def test_a_stage_has_light_links_with_a_mimic_each(follower: str, moved: bool, tmp_path: Path):
    """Read back it moves as the source does, and what closes the loop is the joint that follows."""
    Usd = pytest.importorskip("pxr.Usd", reason="usd-core is not installed")
    scene = machine(follower, moved)
    result = kinefab.export(scene, tmp_path / "m.usda")
    assert [d.code for d in result.report.diagnostics] == ["COUPLING_BY_MIDDLE_BODIES"]
    assert {o.outcome for o in result.report.outcomes} == {Outcome.KEPT}
    stage = Usd.Stage.Open(str(result.path))
    joints = {p.GetName(): p for p in stage.Traverse() if p.GetTypeName().endswith("Joint")}
    follows = [name for name, prim in joints.items() if prim.HasRelationship("newton:mimicJoint")]
    outside = [n for n, p in joints.items() if p.GetAttribute("physics:excludeFromArticulation").Get()]
    assert follows == ["sum_1", "sum_2"] and outside == [follower]
    (light,) = [p for p in stage.Traverse() if p.GetName() == "sum_1" and p.GetTypeName() == "Xform"]
    volume = float(np.prod(BOX.extents))
    assert light.GetAttribute("physics:mass").Get() == pytest.approx(0.1 * 1000.0 * volume)
    assert light.GetAttribute("physxRigidBody:disableGravity").Get() is True
    again = kinefab.export(result.path, tmp_path / "back.kinefab")
    assert not again.report.diagnostics
    back = kinefab.motion(again.path)
    assert back.mobility == kinefab.motion(scene).mobility == 2 + moved
    assert moves_as_stated(back, 1e-6)
    if shutil.which(TOOL) is not None:
        assert tool("validate", again.path, "--strict")["diagnostics"] == []
        assert tool("mobility", again.path)["mobility"]["mobility"] == 2 + moved


def test_three_terms_on_a_cylinder_that_does_not_stand_at_zero(tmp_path: Path):
    """Turn and slide of one joint each follow a sum, of turns and slides that have moved from their zero."""
    pytest.importorskip("pxr", reason="usd-core is not installed")
    scene = kinefab.Scene()
    base = scene.add_part("Base", BOX, density=1000, grounded=True)
    parts = [scene.add_part(n, BOX, density=1000, translation=(i, 0.1, 0)) for i, n in enumerate("ABCD", 1)]
    first = scene.add_hinge(base, parts[0], point=(1, 0, 0), axis=(2, 3, 6), limits=(-10, 80), name="First")
    other = scene.add_hinge(parts[1], base, point=(2, 0, 0), axis=(0, 0, 1), name="Other")
    slide = scene.add_slider(
        parts[1], parts[2], point=(3, 0, 0), axis=(0, 1, 0), limits=(-0.1, 0.2), name="Slide"
    )
    rod = scene.add_joint(JointKind.CYLINDRICAL, base, parts[3], point=(4, 0, 0), axis=(1, 0, 2), name="Rod")
    turned = Pose(rotation_about(np.array([1.0, 0.0, 0.0]), -0.3))  # so that First stands at 0.3 rad
    scene.joints[scene.joints.index(first)] = replace(first, frame_a=first.frame_a @ turned)
    terms = (Term(first.id, RX, 2.0), Term(other.id, RX, -0.5), Term(slide.id, TX, 7.0))
    scene.couplings.append(Coupling("turn", CouplingKind.LINEAR, rod.id, RX, terms, -0.6))
    terms = (Term(first.id, RX, 0.02), Term(other.id, RX, 0.03))
    scene.couplings.append(Coupling("shift", CouplingKind.LINEAR, rod.id, TX, terms, -0.006))
    stage = kinefab.export(scene, tmp_path / "m.usda").path
    back = kinefab.export(stage, tmp_path / "back.kinefab")
    assert not back.report.diagnostics  # the pose misses no coupling
    written = kinefab.motion(back.path)
    assert written.mobility == kinefab.motion(scene).mobility == 3
    at = {coordinate.name: coordinate.value for coordinate in written.coordinates}
    ends = {"First": 15.0, "Other": -25.0, "Slide": 0.08}
    reached = written.follow({n: np.linspace(at[n], at[n] + e, 8) for n, e in ends.items()})
    turns = [math.radians(ends[name]) for name in ("First", "Other")]
    turned = math.radians(reached["Rod.rx"][-1] - at["Rod.rx"])
    assert turned == pytest.approx(2.0 * turns[0] - 0.5 * turns[1] + 0.56, abs=1e-6)
    shifted = reached["Rod.tx"][-1] - at["Rod.tx"]
    assert shifted == pytest.approx(0.02 * turns[0] + 0.03 * turns[1], abs=1e-6)
