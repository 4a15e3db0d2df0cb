"""Screws, gears and other couplings in the exported scene."""

from __future__ import annotations

import math
from dataclasses import replace

import kinefab
import numpy as np
import pytest
from kinefab.analysis import analyse
from kinefab.model import (
    RX,
    TX,
    Constraint,
    ConstraintKind,
    Coupling,
    CouplingKind,
    Feature,
    FeatureKind,
    JointKind,
    Term,
)
from kinefab.spatial import rotation_about
from scenes import BOX, exported, lid_scene


def test_screw_is_a_cylindrical_joint_and_a_coupling(tmp_path):
    """A right-handed lead of 3 mm a turn couples x to angularX with -3 mm a turn: the mirror turns the screw."""
    scene = kinefab.Scene()
    nut = scene.add_part("Nut", BOX)
    scene.add_joint(JointKind.SCREW, None, nut, point=(0, 0, 0), axis=(0, 1, 0), name="Screw", lead=0.003)
    scene.couplings.append(
        Coupling("S", CouplingKind.SCREW, "Screw", TX, (Term("Screw", RX, 0.003 / (2 * math.pi)),))
    )
    content, _ = exported(scene, tmp_path)
    (coupling,) = content["couplings"]
    assert coupling["a"]["coordinate"] == "angularX" and coupling["b"]["coordinate"] == "x"
    assert coupling["ratio"] == pytest.approx(-0.003 / 360)


def test_screw_without_a_stated_coupling_gets_one_from_its_lead(tmp_path):
    """A left-handed lead of 3 mm a turn becomes a coupling that is zero at the exported pose."""
    scene = kinefab.Scene()
    nut = scene.add_part("Nut", BOX)
    scene.add_joint(JointKind.SCREW, None, nut, point=(0, 0, 0), axis=(0, 1, 0), name="Screw", lead=-0.003)
    content, _ = exported(scene, tmp_path)
    (coupling,) = content["couplings"]
    assert (coupling["kind"], coupling["a"]["coordinate"], coupling["b"]["coordinate"]) == (
        "screw",
        "angularX",
        "x",
    )
    assert coupling["ratio"] == pytest.approx(0.003 / 360, rel=1e-11) and "offset" not in coupling


def test_small_coupling_ratio_keeps_its_digits(tmp_path):
    """A lead of 1 um a turn is 2.777...e-9 m a degree: no fixed number of decimals may cut it."""
    scene = kinefab.Scene()
    nut = scene.add_part("Nut", BOX)
    scene.add_joint(JointKind.SCREW, None, nut, point=(0, 0, 0), axis=(0, 1, 0), name="Screw", lead=1e-6)
    content, _ = exported(scene, tmp_path)
    assert content["couplings"][0]["ratio"] == pytest.approx(-1e-6 / 360, rel=1e-11)


def test_gear_between_hinges_keeps_its_ratio_in_degrees(tmp_path):
    """q_b = -2 q_a between two hinges stays -2, as hinge angles read CAD angles; a rack's unit is per degree."""
    scene = kinefab.Scene()
    parts = [scene.add_part(name, BOX, translation=(x, 0, 0)) for name, x in (("A", 0), ("B", 1), ("R", 2))]
    for part in parts[:2]:
        scene.add_hinge(None, part, point=(part, 0, 0), axis=(0, 0, 1), name=f"H{part}")
    scene.add_slider(None, parts[2], point=(2, 0, 0), axis=(1, 0, 0), name="S")
    scene.couplings.append(Coupling("G", CouplingKind.GEAR, "H1", RX, (Term("H0", RX, -2.0),)))
    scene.couplings.append(Coupling("K", CouplingKind.RACK, "S", TX, (Term("H1", RX, 0.05),)))
    content, _ = exported(scene, tmp_path)
    assert content["couplings"][0]["ratio"] == pytest.approx(-2.0)
    assert content["couplings"][1]["ratio"] == pytest.approx(0.05 * math.pi / 180)
    assert content["couplings"][1]["b"]["coordinate"] == "x"


def test_coupling_starts_from_the_angles_at_export(tmp_path):
    """With q_a = 20 and q_b = 10 degrees at export, q_b = -2 q_a + 50 holds there: no offset is left; 55 leaves 5."""
    for offset, left in ((50, 0), (55, 5)):
        scene = kinefab.Scene()
        for name, angle in (("A", 20), ("B", 10)):
            part = scene.add_part(
                name, BOX, rotation=rotation_about(np.array([0.0, 0, 1]), math.radians(angle))
            )
            joint = scene.add_hinge(None, part, point=(0, 0, 0), axis=(0, 0, 1), name=name)
            scene.joints[-1] = replace(joint, frame_b=joint.frame_a)  # zero where the part stands unturned
        scene.couplings.append(
            Coupling("G", CouplingKind.GEAR, "B", RX, (Term("A", RX, -2.0),), math.radians(offset))
        )
        content, _ = exported(scene, tmp_path)
        assert content["couplings"][0].get("offset", 0) == pytest.approx(left)


def test_coupling_on_a_missing_joint_is_dropped_with_a_report(tmp_path):
    """A coupling whose joint has no component is named in the report."""
    scene = lid_scene()
    scene.couplings.append(Coupling("G", CouplingKind.GEAR, "Nowhere", RX, (Term("Hinge", RX, 1.0),)))
    content, result = exported(scene, tmp_path)
    assert "couplings" not in content
    assert "COUPLING_WITHOUT_JOINT" in {o.code for o in result.report.outcomes}


@pytest.mark.parametrize("kind", ["hinge", "slider"])
def test_two_joints_that_a_coupling_keeps_in_step_stay_two(kind: str) -> None:
    """Two wheels on one axis, or two parallel slides, at a ratio of one: they move alike, and each in its own range."""
    scene = kinefab.Scene()
    first, second = (scene.add_part(name, BOX, density=1000) for name in "AB")
    add = scene.add_hinge if kind == "hinge" else scene.add_slider
    whole = 80.0 if kind == "hinge" else 0.08
    lead = add(None, first, point=(0, 0, 0), axis=(0, 3, 4), limits=(-0.1 * whole, whole), name="Lead")
    follow = add(
        None, second, point=(0, 0.3, 0.4), axis=(0, 3, 4), limits=(-whole, 0.5 * whole), name="Follow"
    )
    scene.add_coupling(lead, follow, ratio=1.0, name="belt")
    found = analyse(scene)
    assert found.mobility == 1 and not found.report.diagnostics
    assert [(j.name, len(j.unlocked)) for j in found.joints] == [("Lead", 1), ("Follow", 1)]
    assert [c.id for c in found.couplings] == ["belt"]
    mechanism = kinefab.motion(scene)
    assert [(c.lower, c.upper) for c in mechanism.coordinates] == [
        (-0.1 * whole, whole),
        (-whole, pytest.approx(0.5 * whole)),
    ]
    stop = mechanism.sweep("Lead", 0.0, whole).stop
    assert stop is not None and "Follow" in str(stop)


@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.parametrize("kind", [ConstraintKind.BELT, ConstraintKind.LINEAR])
def test_constraint_may_count_a_part_from_what_it_hangs_on_by_way_of_others(
    kind: ConstraintKind, sense: float, tmp_path
) -> None:
    """A pulley on an arm, or a table on a carriage, whose constraint counts it from the ground: what the arm or the carriage
    makes of its way is taken back by its own joint.  sense: of the direction that the constraint states for it."""
    axis, place = np.array([0.0, 0.6, 0.8]), np.array([[0.0, 0, 0], [0.2, 0, 0], [0.5, 0.1, 0]])
    scene = kinefab.Scene()
    lead, arm, last = (
        scene.add_part(n, BOX, density=1000, translation=p) for n, p in zip(("A", "B", "C"), place)
    )
    add = scene.add_hinge if kind is ConstraintKind.BELT else scene.add_slider
    for name, a, b in (("Lead", None, lead), ("Arm", None, arm), ("Last", arm, last)):
        add(a, b, point=place[b], axis=axis, name=name)
    ends = (
        Feature(lead, FeatureKind.LINE, np.zeros(3), axis),
        Feature(last, FeatureKind.LINE, np.zeros(3), sense * axis),
    )
    scene.constraints.append(Constraint("tie", kind, ends, value=0.5))
    content, result = exported(scene, tmp_path)
    assert [c.get("id", "tie") for c in content["couplings"]] == ["tie"]
    assert {o.outcome.value for o in result.report.outcomes if "tie" in o.feature} == {"kept"}
    unit = 1.0 if kind is ConstraintKind.BELT else 0.01
    for moving in (kinefab.motion(scene), kinefab.motion(result.path)):
        reached = moving.follow({"Lead": [0.0, 40.0 * unit], "Arm": [0.0, -30.0 * unit]})
        assert reached.stop is None
        assert reached["Last"][-1] == pytest.approx((sense * 20.0 + 30.0) * unit, abs=1e-6)


def test_constraints_may_count_a_part_along_two_directions(tmp_path) -> None:
    """A table on two slides over each other follows one slide along its first direction, another against its second."""
    along, across = np.array([0.0, 0.6, 0.8]), np.array([0.0, 0.8, -0.6])
    scene = kinefab.Scene()
    carriage, table, one, two = (scene.add_part(n, BOX, density=1000) for n in ("C", "T", "One", "Two"))
    for a, b, way in (
        (None, carriage, along),
        (carriage, table, across),
        (None, one, along),
        (None, two, across),
    ):
        scene.add_slider(a, b, point=(0, 0, 0), axis=way, name=scene.nodes[b].name)
    for part, way, ratio in ((one, along, 0.5), (two, across, -2.0)):
        ends = [Feature(node, FeatureKind.LINE, np.zeros(3), way) for node in (part, table)]
        scene.constraints.append(Constraint(f"tie {part}", ConstraintKind.LINEAR, tuple(ends), value=ratio))
    content, result = exported(scene, tmp_path)
    assert len(content["couplings"]) == 2
    for moving in (kinefab.motion(scene), kinefab.motion(result.path)):
        reached = moving.follow({"One": [0.0, 0.3], "Two": [0.0, 0.1]})
        assert (reached["C"][-1], reached["T"][-1]) == pytest.approx((0.15, -0.2), abs=1e-9)
