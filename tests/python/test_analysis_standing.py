"""Couplings with coordinates that other statements hold still."""

from __future__ import annotations

import math
import shutil
import subprocess
from dataclasses import replace

import kinefab
import numpy as np
import pytest
from kinefab.analysis import analyse
from kinefab.model import RX, TX, Coupling, CouplingKind, JointKind, Motion, Term
from kinefab.spatial import Pose

TOOL = shutil.which("dotnet-kinefab")


def machine() -> kinefab.Scene:
    """A dial that two pins hold to the base, a rod that slides and turns, a wheel and a carriage."""
    scene = kinefab.Scene()
    base = scene.add_part("Base", grounded=True)
    dial, rod, wheel, carriage = (scene.add_part(name) for name in ("Dial", "Rod", "Wheel", "Carriage"))
    scene.add_hinge(base, dial, point=(0, 0, 0), axis=(0, 1, 0), name="Dial")
    scene.add_hinge(base, dial, point=(0.2, 0, 0), axis=(0, 1, 0), name="Second pin")
    limits = {"tx": (-0.1, 0.1), "rx": (-30, 60)}
    scene.add_joint("cylindrical", base, rod, point=(1, 0, 0), axis=(0, 0, 1), limits=limits, name="Rod")
    scene.add_hinge(base, wheel, point=(2, 0, 0), axis=(0, 1, 0), name="Wheel")
    scene.add_slider(base, carriage, point=(3, 0, 0), axis=(1, 0, 0), name="Carriage")
    return scene


def coupled(joint: str, freedom: int, *terms: Term) -> kinefab.Scene:
    scene = machine()
    ids = {j.name: j.id for j in scene.joints}
    named = tuple(replace(term, joint=ids[term.joint]) for term in terms)
    return replace(scene, couplings=[Coupling("C", CouplingKind.LINEAR, ids[joint], freedom, named)])


@pytest.mark.parametrize("rod_follows", [True, False])
def test_what_is_coupled_to_a_held_dial_is_held(tmp_path, rod_follows):
    """The rod's slide cannot move; its turn goes on under its own name and range.  C# counts the same."""
    ends = ("Rod", TX), ("Dial", RX)
    own, other = ends if rod_follows else ends[::-1]
    scene = coupled(*own, Term(*other, 0.4 if rod_follows else 2.5))
    found = analyse(scene)
    assert found.mobility == 3 and found.couplings == []
    rod = next(j for j in found.joints if j.name == "Rod")
    assert rod.kind is JointKind.REVOLUTE
    turn = rod.freedoms[RX]
    assert (turn.motion, math.degrees(turn.lower), math.degrees(turn.upper)) == (
        Motion.LIMITED,
        pytest.approx(-30),
        pytest.approx(60),
    )
    result = kinefab.export(scene, tmp_path / "held.kinefab")
    told = [(o.outcome.value, o.code) for o in result.report.outcomes if o.feature == "coupling C"]
    assert told == [("kept", "COUPLING_HELD")]
    if TOOL:
        subprocess.run([TOOL, "mobility", str(result.path)], check=True, capture_output=True)


def test_a_held_term_leaves_the_others_of_its_coupling():
    """Carriage = 0.3 wheel + 0.7 dial: the dial stands, the carriage follows the wheel."""
    found = analyse(coupled("Carriage", TX, Term("Wheel", RX, 0.3), Term("Dial", RX, 0.7)))
    (left,) = found.couplings
    ids = {j.name: j.id for j in found.joints}
    assert found.mobility == 3
    assert (left.joint, left.freedom, left.offset) == (ids["Carriage"], TX, 0.0)
    assert left.terms == (Term(ids["Wheel"], RX, 0.3),)


def test_what_follows_is_chosen_anew_where_it_is_held():
    """Dial = 0.5 wheel + 2 carriage: the wheel and the carriage keep each other's pace."""
    found = analyse(coupled("Dial", RX, Term("Wheel", RX, 0.5), Term("Carriage", TX, 2.0)))
    (left,) = found.couplings
    ids = {j.name: j.id for j in found.joints}
    assert (left.joint, left.freedom) == (ids["Wheel"], RX)
    assert left.terms == (Term(ids["Carriage"], TX, -4.0),)


def test_what_is_left_of_a_coupling_holds_where_the_joints_stand():
    """Carriage = 0.3 wheel + 0.7 dial + 0.05, and the carriage stands 0.05 m from where its frames meet."""
    scene = coupled("Carriage", TX, Term("Wheel", RX, 0.3), Term("Dial", RX, 0.7))
    index = next(i for i, node in enumerate(scene.nodes) if node.name == "Carriage")
    moved = replace(scene.nodes[index], pose=Pose(translation=np.array([0.05, 0.0, 0.0])))
    nodes = [*scene.nodes[:index], moved, *scene.nodes[index + 1 :]]
    found = analyse(replace(scene, nodes=nodes, couplings=[replace(scene.couplings[0], offset=0.05)]))
    (left,) = found.couplings
    assert left.offset == pytest.approx(0.05) and len(left.terms) == 1
