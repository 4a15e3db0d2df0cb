"""A source's own joint from which other statements take freedoms keeps its name, its ranges, its drives and its place."""

from __future__ import annotations

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
    Freedom,
    Joint,
    JointKind,
    Motion,
    Node,
    Scene,
    Term,
    freedoms_of,
)
from kinefab.spatial import Array, Pose, matrix_from_quaternion, rotation_exp, rotation_log

COINCIDENT, PARALLEL = ConstraintKind.COINCIDENT, ConstraintKind.PARALLEL
PLANE, LINE = FeatureKind.PLANE, FeatureKind.LINE

TURN, SLIDE = np.radians(20.0), 0.007
"""Where the parts stand: asymmetric in the ranges below."""
TURNED = (np.radians(-10.0), np.radians(80.0))
SLID = (-0.010, 0.050)
AXIS = np.array([2.0, -3.0, 6.0]) / 7.0
PLACE = np.array([0.3, -0.2, 0.5])


def frame() -> Pose:
    """Joint frame of ground, WORLD: X along AXIS."""
    across = np.cross(AXIS, [0.0, 0.0, 1.0])
    across /= np.linalg.norm(across)
    return Pose(np.column_stack([AXIS, across, np.cross(AXIS, across)]), PLACE)


def machine(kind: str, swapped: bool, **freedoms: Freedom) -> Scene:
    """A part on the ground at TURN and SLIDE of a joint "own", whose b (or, swapped, a) it is."""
    sense = -1.0 if swapped else 1.0
    turned = rotation_exp(sense * TURN * np.array([1.0, 0.0, 0.0]))
    own = frame() @ Pose(turned, np.array([sense * SLIDE, 0.0, 0.0]))
    part = Pose(rotation_exp(np.array([0.4, -0.7, 0.2])), np.array([0.1, 0.9, -0.3]))
    ends = [(None, frame()), (0, part.inverse() @ own)]
    (a, frame_a), (b, frame_b) = ends[::-1] if swapped else ends
    named = JointKind(kind)
    joint = Joint("own", named, a, b, frame_a, frame_b, freedoms_of(named, **freedoms), name="Spindle")
    return Scene(nodes=[Node("part", "part", pose=part)], joints=[joint])


def limited(ends: tuple[float, float]) -> Freedom:
    return Freedom(Motion.LIMITED, *ends)


def beside(scene: Scene, kind: ConstraintKind, feature: FeatureKind, direction: Array) -> Scene:
    """The scene with a constraint between the ground and the part that the present pose fulfils."""
    part = scene.nodes[0].pose
    at = scene.pose(scene.joints[0].b) @ scene.joints[0].frame_b
    own = part.inverse()
    features = (
        Feature(None, feature, at.translation, direction),
        Feature(0, feature, own.point(at.translation), own.rotation @ direction),
    )
    scene.constraints.append(Constraint("other", kind, features))
    return scene


def displaced(slide: float, turn: float, scene: Scene) -> Pose:
    """The part, WORLD, where the joint's coordinates along and about AXIS are these, metres and radians."""
    sense = 1.0 if scene.joints[0].a is None else -1.0  # of b against a
    on = Pose(
        rotation_exp(np.array([sense * (turn - TURN), 0.0, 0.0])),
        np.array([sense * (slide - SLIDE), 0.0, 0.0]),
    )
    return frame() @ on @ frame().inverse() @ scene.nodes[0].pose


def ends_of(scene: Scene, name: str) -> list[Pose]:
    """Where the part stands, WORLD, at both ends of a coordinate's range."""
    mechanism = kinefab.motion(scene)
    coordinate = mechanism.coordinate(name)
    found: list[Pose] = []
    for end in (coordinate.lower, coordinate.upper):
        path = mechanism.sweep(name, None, end, frames=40)
        assert path.stop is None
        last = path.poses[-1, 0]
        found.append(Pose(matrix_from_quaternion(last[3:]), last[:3]))
    return found


def codes(scene: Scene) -> list[str]:
    return [d.code for d in analyse(scene).report.diagnostics]


def same(found: Pose, expected: Pose) -> bool:
    return bool(
        np.allclose(found.translation, expected.translation, atol=1e-9)
        and np.allclose(found.rotation, expected.rotation, atol=1e-9)
    )


@pytest.mark.parametrize("swapped", [False, True])
def test_a_joint_beside_its_own_coupling_stays_what_it_is(swapped: bool) -> None:
    """A spindle between -10 and 50 mm, at 7 mm and 20 degrees, whose slide follows its turn: all counts as before."""
    scene = machine("cylindrical", swapped, tx=limited(SLID))
    ratio = 0.004 / (2 * np.pi)
    offset = SLIDE - ratio * TURN
    scene.couplings.append(
        Coupling("pitch", CouplingKind.SCREW, "own", TX, (Term("own", RX, ratio),), offset)
    )
    assert codes(scene) == []
    joint = analyse(scene).joints[0]
    assert (joint.name, joint.kind.value, joint.freedoms) == (
        "Spindle",
        "cylindrical",
        scene.joints[0].freedoms,
    )
    slide = kinefab.motion(scene).coordinate("Spindle.tx")
    assert np.allclose([slide.value, slide.lower, slide.upper], [SLIDE, *SLID], atol=1e-12)
    for end, found in zip(SLID, ends_of(scene, "Spindle.tx")):
        assert same(found, displaced(end, TURN + (end - SLIDE) / ratio, scene))


@pytest.mark.parametrize("swapped", [False, True])
def test_a_cylindrical_joint_beside_a_screw_is_a_screw_of_its_range_and_name(swapped: bool) -> None:
    """The screw's lead counts from the exported pose, the joint's slide from elsewhere: what is left of it does not change."""
    scene = beside(machine("cylindrical", swapped, tx=limited(SLID)), ConstraintKind.SCREW, LINE, AXIS)
    scene.constraints[0] = replace(scene.constraints[0], value=0.004)
    assert codes(scene) == ["JOINT_CONSTRAINTS_DISAGREE"]
    screw = analyse(scene).joints[0]
    assert (screw.name, screw.kind.value, round(screw.lead, 12)) == ("Spindle", "screw", 0.004)
    here = (scene.pose(screw.a) @ screw.frame_a).inverse() @ scene.pose(screw.b) @ screw.frame_b
    travel = here.translation[0] - screw.lead * rotation_log(here.rotation)[0] / (2 * np.pi)
    assert np.remainder(travel + 1e-6, screw.lead) == pytest.approx(
        1e-6, abs=1e-9
    )  # whole turns, nothing between
    for end, found in zip(SLID, ends_of(scene, "Spindle.tx")):
        assert same(found, displaced(end, TURN + (end - SLIDE) * 2 * np.pi / 0.004, scene))


@pytest.mark.parametrize("swapped", [False, True])
def test_a_cylindrical_joint_whose_slide_is_held_turns_on_in_its_range(swapped: bool) -> None:
    """Planes across the axis that coincide hold its slide; -10..80 degrees at 20 degrees stay what they are."""
    scene = beside(machine("cylindrical", swapped, rx=limited(TURNED)), COINCIDENT, PLANE, AXIS)
    assert codes(scene) == ["JOINT_CONSTRAINTS_DISAGREE"]
    assert [(j.name, j.kind.value) for j in analyse(scene).joints] == [("Spindle", "revolute")]
    for end, found in zip(TURNED, ends_of(scene, "Spindle")):
        assert same(found, displaced(SLIDE, end, scene))


@pytest.mark.parametrize("kind", ["cylindrical", "planar_as_slide"])
@pytest.mark.parametrize("swapped", [False, True])
def test_a_joint_whose_turn_is_held_slides_on_in_its_range(kind: str, swapped: bool) -> None:
    """Planes along the axis that stay parallel hold its turn; -10..50 mm at 7 mm stay, also of another axis of the frame."""
    scene = machine("cylindrical", swapped, tx=limited(SLID))
    across = frame().rotation[:, 1]
    if kind == "planar_as_slide":  # Y of the plane's frame is AXIS, and the two others are held
        joint, order = scene.joints[0], [2, 0, 1]
        turned = [Pose(f.rotation[:, order], f.translation) for f in (joint.frame_a, joint.frame_b)]
        part, moving = scene.nodes[0].pose, 0 if swapped else 1  # turned by nothing against the ground's
        held = frame().rotation[:, order]
        turned[moving] = part.inverse() @ Pose(held, part.point(turned[moving].translation))
        named = JointKind.PLANAR
        scene.joints[0] = replace(
            joint,
            kind=named,
            frame_a=turned[0],
            frame_b=turned[1],
            freedoms=freedoms_of(named, ty=limited(SLID)),
        )
        beside(scene, COINCIDENT, PLANE, across)
    else:
        beside(scene, PARALLEL, PLANE, across)
    assert codes(scene) == ["JOINT_CONSTRAINTS_DISAGREE"]
    assert [(j.name, j.kind.value) for j in analyse(scene).joints] == [("Spindle", "prismatic")]
    for end, found in zip(SLID, ends_of(scene, "Spindle")):
        assert same(found, displaced(end, TURN, scene))


def test_a_planar_joint_pinned_elsewhere_turns_about_the_pin_in_its_range() -> None:
    """The pin is not where the plane's frames are; its angle counts as the plane's does."""
    scene = machine("cylindrical", False, rx=limited(TURNED))
    joint, named = scene.joints[0], JointKind.PLANAR
    own = scene.nodes[0].pose @ joint.frame_b
    joint = replace(
        joint,
        kind=named,
        frame_a=frame() @ Pose(np.eye(3), np.array([SLIDE, 0.2, -0.1])),
        frame_b=scene.nodes[0].pose.inverse() @ Pose(own.rotation, own.translation),
        freedoms=freedoms_of(named, rx=limited(TURNED)),
    )
    scene.joints[0] = joint
    pin = frame().point(np.array([0.0, 0.03, 0.04]))
    inner = scene.nodes[0].pose.inverse()
    scene.constraints.append(
        Constraint(
            "pin",
            ConstraintKind.COINCIDENT,
            (Feature(None, LINE, pin, AXIS), Feature(0, LINE, inner.point(pin), inner.rotation @ AXIS)),
        )
    )
    assert codes(scene) == ["JOINT_CONSTRAINTS_DISAGREE"]
    for end, found in zip(TURNED, ends_of(scene, "Spindle")):
        about = Pose(rotation_exp((end - TURN) * AXIS))
        expected = Pose(np.eye(3), pin) @ about @ Pose(np.eye(3), -pin) @ scene.nodes[0].pose
        assert same(found, expected)


def test_a_joint_with_other_freedoms_than_are_left_is_given_up_and_told() -> None:
    """A hinge across the axis has nothing of a ball's range to go on with."""
    scene = beside(machine("spherical", False), COINCIDENT, LINE, AXIS)
    scene = replace(
        scene,
        joints=[replace(scene.joints[0], freedoms=freedoms_of(JointKind.SPHERICAL, rx=limited(TURNED)))],
    )
    assert "JOINT_SUPERSEDED" in codes(scene)


def test_what_stops_a_joint_at_its_dead_centre_counts_though_it_removes_nothing_there() -> None:
    """A crank's pin on the plane that touches its circle: no velocity breaks that, and no motion keeps it."""
    scene = machine("revolute", False)
    pin, outwards = frame().point(np.array([0.0, 0.3, 0.0])), frame().rotation[:, 1]
    scene.nodes[0] = replace(scene.nodes[0], pose=frame() @ scene.joints[0].frame_b.inverse())
    on_part = scene.nodes[0].pose.inverse().point(pin)
    features = (Feature(None, PLANE, pin, outwards), Feature(0, FeatureKind.POINT, on_part))
    scene.constraints.append(Constraint("stop", COINCIDENT, features))
    assert (analyse(scene).first_order, analyse(scene).mobility) == (1, 0)
    assert "JOINT_SUPERSEDED" in codes(scene)
    across = (replace(features[0], direction=AXIS), features[1])
    scene.constraints[0] = replace(scene.constraints[0], features=across)
    assert (analyse(scene).mobility, analyse(scene).joints[0].because, codes(scene)) == (1, ("stop",), [])
