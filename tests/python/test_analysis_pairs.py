"""Every common way to constrain a pair: class, axis, anchor, rank and redundancy."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from kinefab.analysis import analyse
from kinefab.model import Constraint, Feature, Node, Scene
from kinefab.model import ConstraintKind as C
from kinefab.model import FeatureKind as F
from kinefab.model import JointKind as K
from mechanism_cases import analysed, scene

C0 = np.array([0.1, -0.2, 0.3])
X, Y, Z = np.eye(3)
FREE = slice(None)

# id: (class, axis of X or None, anchor with None for what is free, rows, rank, redundant)
PAIRS = {
    "P01": (K.FIXED, None, None, 9, 6, 3),
    "P02": (K.CYLINDRICAL, Z, (0.1, -0.2, None), 4, 4, 0),
    "P03": (K.REVOLUTE, Z, (0.1, -0.2, None), 5, 5, 0),
    "P04": (K.REVOLUTE, Z, (0.1, -0.2, None), 7, 5, 2),
    "P05": (K.PLANAR, Z, None, 3, 3, 0),
    "P06": (K.PLANAR, Z, None, 6, 3, 3),
    "P07": (K.PRISMATIC, X, None, 6, 5, 1),
    "P08": (K.PRISMATIC, Z, None, 8, 5, 3),
    "P09": (K.REVOLUTE, Z, (0.1, -0.2, None), 10, 5, 5),
    "P10": (K.REVOLUTE, Z, (0.1, -0.2, None), 9, 5, 4),
    "P11": (K.SPHERICAL, None, tuple(C0), 3, 3, 0),
    "P12": (K.REVOLUTE, Z, (0.1, -0.2, None), 6, 5, 1),
    "P13": (K.FIXED, None, None, 9, 6, 3),
    "P14": (K.POINT_ON_LINE, Z, tuple(C0), 2, 2, 0),
    "P15": (K.POINT_ON_PLANE, None, tuple(C0), 1, 1, 0),
    "P16": (K.PLANAR, Z, None, 3, 3, 0),
    "P17": (K.FIXED, None, None, 6, 6, 0),
    "P18": (K.PRISMATIC, Z, None, 5, 5, 0),
    "P19": (K.REVOLUTE, Z, (0.1, -0.2, None), 5, 5, 0),
    "P20": (K.PIN_SLOT, Z, (0.1, -0.2, None), 5, 4, 1),
    "P21": (K.UNIVERSAL, X, tuple(C0), 4, 4, 0),
    "P22": (K.SCREW, Z, (0.1, -0.2, None), 5, 5, 0),
    "P23": (K.PARALLEL_PLANES, Z, None, 2, 2, 0),
    "P24": (K.TRANSLATE_3, None, None, 3, 3, 0),
    "P25": (K.TRANSLATE_2, Z, None, 6, 4, 2),
    "P26": (K.SPHERICAL, None, tuple(C0), 3, 3, 0),
    "P27": (K.CYLINDRICAL, X, (None, -0.2, 0.3), 4, 4, 0),
    "P28": (K.SPHERICAL, None, (0.1, -0.2, 0.0), 2, 1, 1),
    "P29": (K.SPHERICAL, None, (0.0, 0.0, 0.0), 3, 2, 1),
    "P34": (K.PARALLEL_PLANES, X, None, 2, 2, 0),
    "P35": (K.FIXED, None, None, 6, 6, 0),
}


def world(found, joint):
    return found.scene(solved=True).pose(joint.a) @ joint.frame_a


@pytest.mark.parametrize("id", PAIRS)
def test_pair_has_its_class_axis_anchor_and_rank(id):
    """The joint of the pair is the one that a designer would name, in the right place."""
    kind, axis, anchor, rows, rank, redundant = PAIRS[id]
    found = analysed(id)
    assert (found.rows, found.rank, found.redundant) == (rows, rank, redundant)
    if kind is K.FIXED:
        assert found.joints == [] and found.groups.together(0, 1)
        return
    (joint,) = found.joints
    assert joint.kind is kind
    frame = world(found, joint)
    if axis is not None:
        assert np.linalg.norm(np.cross(frame.rotation[:, 0], axis)) < 1e-9
    if anchor is not None:
        off = [value - wanted for value, wanted in zip(frame.translation, anchor) if wanted is not None]
        assert np.abs(off).max() < 1e-9
    b = found.scene(solved=True).pose(joint.b) @ joint.frame_b
    assert (
        np.abs(b.rotation - frame.rotation).max() < 1e-12
        and np.abs(b.translation - frame.translation).max() < 1e-12
    )


def test_a_rod_is_not_a_point_on_a_plane():
    """P30: first order cannot tell a rod from a point on a plane; it becomes a body between two joints."""
    found = analysed("P30")
    assert (found.rows, found.rank, found.mobility) == (1, 1, 5)
    assert sorted(j.kind.value for j in found.joints) == ["spherical", "universal"]
    ends = sorted(world(found, j).translation.tolist() for j in found.joints)
    assert np.allclose(ends, sorted([C0.tolist(), (C0 + [0.3, 0.0, 0.4]).tolist()]), atol=1e-12)
    assert len(found.nodes) == 1


@pytest.mark.parametrize(
    ("id", "kinds"),
    [
        ("P31", ["planar", "revolute"]),
        ("P32", ["line_in_plane", "revolute"]),
        ("P33", ["spherical", "universal"]),
    ],
)
def test_relations_by_a_middle_body_have_one(id, kinds):
    """Cone and circle edge on a plane, and a rod that is stated twice: two joints and one light body."""
    found = analysed(id)
    assert sorted(j.kind.value for j in found.joints) == kinds and len(found.nodes) == 1
    assert {name for j in found.joints for name in j.because} == {c.id for c in found.source.constraints}


def test_rods_in_their_own_plane_hold_a_platform_by_their_stress():
    """P36: rank 3 at the pose, yet six rods that pull against each other leave no motion: a fixed joint."""
    found = analysed("P36")
    assert (found.rows, found.rank, found.mobility) == (6, 3, 0)
    assert [j.kind for j in found.joints] == [K.FIXED]


@pytest.mark.parametrize(("id", "left"), [("P28", (0, 3)), ("P29", (0, 3)), ("P36", (0, 0))])
def test_a_part_at_a_singular_pose_keeps_the_freedoms_of_its_joint(id, left):
    """The twists promise two translations, one, or three freedoms that no motion has."""
    part = analysed(id).freedoms[1]
    assert (len(part.translations), len(part.rotations)) == left


@pytest.mark.parametrize("hung", [0, 1])
@pytest.mark.parametrize(
    ("id", "kind", "left"), [("P28", K.SPHERICAL, 3), ("P29", K.SPHERICAL, 3), ("P36", K.FIXED, 0)]
)
def test_a_pair_at_a_singular_pose_is_the_same_from_either_part(id, kind, left, hung):
    """Its motions are known from the search of its block, in which either part may be the one at rest."""
    alone = scene(id)
    nodes = [*(replace(n, grounded=False) for n in alone.nodes), Node("wall", "wall", grounded=True)]
    world = alone.nodes[hung].pose.inverse()
    own = Feature(hung, F.LINE, world.point(np.array([1.5, 0.2, -0.7])), world.direction(X))
    hinge = Constraint("pin", C.INSERT, (own, Feature(2, F.LINE, np.array([1.5, 0.2, -0.7]), X)))
    found = analyse(Scene(nodes=nodes, constraints=[*alone.constraints, hinge]))
    assert sorted(j.kind for j in found.joints) == sorted([kind, K.REVOLUTE])
    assert found.mobility == left + 1


def test_screw_keeps_its_lead_and_hand():
    """P22: 0.05 m a turn, right-handed; a negative lead stays negative whatever way the axis points."""
    (joint,) = analysed("P22").joints
    assert joint.lead == pytest.approx(0.05, abs=1e-12)


def test_slot_carries_the_translation():
    """P20: the slot along X is on the grounded part, so it is the joint's body a and its Y axis."""
    found = analysed("P20")
    (joint,) = found.joints
    assert found.source.nodes[joint.a].name == "A"
    assert np.linalg.norm(np.cross(world(found, joint).rotation[:, 1], X)) < 1e-9


def test_universal_puts_each_axis_on_its_body():
    """P21: Z is fixed in A and X in B, as the constraint's two lines are."""
    found = analysed("P21")
    (joint,) = found.joints
    frame = world(found, joint)
    on_z, on_x = (Z, X) if found.source.nodes[joint.a].name == "A" else (X, Z)
    assert np.linalg.norm(np.cross(frame.rotation[:, 2], on_z)) < 1e-9
    assert np.linalg.norm(np.cross(frame.rotation[:, 0], on_x)) < 1e-9


def test_every_joint_names_its_constraints():
    """``because`` of a joint holds every constraint of its pair, and nothing else."""
    assert analysed("P09").joints[0].because == ("insert:1", "insert:2")
    assert {name for j in analysed("M09").joints for name in j.because} == {
        "insert:1",
        "insert:6",
        "insert:7",
        "coincident:8",
        "coincident:9",
    }


def test_two_rods_in_line_hold_a_part_that_cannot_turn():
    """First order leaves two translations across the rods; the spheres touch in one point, so nothing moves."""
    x = np.array([1.0, 0.0, 0.0])
    nodes = [Node("base", "base", grounded=True), Node("part", "part")]

    def rod(id, foot):
        return Constraint(
            id, C.DISTANCE, (Feature(0, F.POINT, foot), Feature(1, F.POINT, np.zeros(3))), value=1.0
        )

    square = Constraint(
        "square", C.LOCK_ORIENTATION, (Feature(0, F.BODY, np.zeros(3)), Feature(1, F.BODY, np.zeros(3)))
    )
    found = analyse(Scene(nodes=nodes, constraints=[square, rod("left", -x), rod("right", x)]))
    assert (found.first_order, found.mobility) == (2, 0)
    assert [j.kind for j in found.joints] == [K.FIXED]
    assert [d.code for d in found.report.diagnostics] == ["MECHANISM_SINGULAR", "NOTHING_MOVES"]
