"""Couplings of several terms in a format whose couplings follow one coordinate: light bodies whose motions add up."""

from __future__ import annotations

import json
import math
import shutil
import subprocess
from pathlib import Path
from typing import Any

import kinefab
import numpy as np
import pytest
from kinefab.model import RX, TX, Coupling, CouplingKind, JointKind, Term
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
    codes = [d.code for d in result.report.diagnostics]
    assert codes == ["COUPLING_BY_MIDDLE_BODIES"]
    assert len(content["couplings"]) == 3
    written = kinefab.motion(result.path)
    assert written.mobility == kinefab.motion(scene).mobility == 2 + moved
    for values in ({"Left": [0, 30], "Right": [0, 70]}, {"Left": [0, -20], "Right": [0, 25]}):
        reached = written.follow({name: np.linspace(*ends, 8) for name, ends in values.items()})
        slide = 0.2 * math.radians(values["Left"][1]) - 0.1 * math.radians(values["Right"][1])
        assert reached.stop is None and reached["Slide"][-1] == pytest.approx(slide, abs=1e-6)


@pytest.mark.parametrize("follower", ["Left", "Slide"])
def test_the_tool_counts_and_moves_a_sum_as_the_source_does(follower: str, tmp_path: Path):
    if shutil.which(TOOL) is None:
        pytest.skip(f"{TOOL} is not on the PATH")
    target = kinefab.export(machine(follower, moved=True), tmp_path / "m.kinefab").path
    said = tool("validate", target, "--strict")
    assert said["valid"] and said["diagnostics"] == []
    counted = tool("mobility", target)
    assert counted["mobility"]["mobility"] == 3 and counted["diagnostics"] == []


def test_joints_of_more_than_one_sum_and_names_that_are_taken(tmp_path: Path):
    """Two sums of the same joints, one named as a part is."""
    scene = machine("Slide", moved=False)
    extra = scene.add_part("sum:1", BOX, density=1000, translation=(4, 0, 0))
    hinge = scene.add_joint(JointKind.REVOLUTE, None, extra, point=(4, 0, 0), axis=(0, 1, 0), name="Fourth")
    ids = {joint.name: joint.id for joint in scene.joints}
    terms = (Term(ids["Left"], RX, 3.0), Term(ids["Right"], RX, 0.5))
    scene.couplings.append(Coupling("again", CouplingKind.LINEAR, hinge.id, RX, terms))
    content = read(kinefab.export(scene, tmp_path / "m.kinefab").path)
    names = [entry["id"] for entry in content["gameObjects"]]
    assert len(set(names)) == len(names) and "sum:1#2" in names
    written = kinefab.motion(tmp_path / "m.kinefab")
    reached = written.follow({"Left": np.linspace(0, 20, 5), "Right": np.linspace(0, -10, 5)})
    assert written.mobility == 2 and reached["Fourth"][-1] == pytest.approx(55.0, abs=1e-6)
