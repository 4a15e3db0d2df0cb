"""Symmetry about a plane on a third part."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from derivatives import check_derivative
from hypothesis import given, settings
from kinefab.analysis import analyse
from kinefab.analysis.equations.scene_equations import equations_of
from kinefab.diagnostics import Report
from kinefab.model import RX, TX, Constraint, Feature, Node, Scene
from kinefab.model import ConstraintKind as C
from kinefab.model import FeatureKind as F
from kinefab.spatial import Pose, rotation_about, rotation_exp
from mechanism_cases import ROOT, analysed, node, scene
from scenes import exported
from source_bundles import read
from strategies import random_direction, random_pose, seeds
from test_sources_left_handed import by_the_other_hand


def mirrored_planes(first, second, tilt=0.0):
    """Three parts: a middle plane on the ground and one plane on each of two parts, symmetric but for ``tilt``."""
    middle = Pose(np.eye(3), np.array([0.1, 0.2, 0.3]))
    a = middle @ Pose(rotation_about(np.array([0.0, 1.0, 0.0]), 0.4), np.array([0.2, 0.1, 0.5]))
    flip = np.diag([1.0, 1.0, -1.0])
    normal = flip @ a.rotation[:, 2]
    point = middle.translation + flip @ (a.translation - middle.translation)
    nodes = [
        Node("base", "base", grounded=True),
        Node("a", "a", pose=first),
        Node("b", "b", pose=second),
    ]
    features = (
        Feature(
            1, F.PLANE, first.inverse().point(a.translation), first.inverse().direction(a.rotation[:, 2])
        ),
        Feature(2, F.PLANE, second.inverse().point(point), second.inverse().direction(normal)),
        Feature(0, F.PLANE, middle.translation, middle.rotation[:, 2]),
    )
    return Scene(nodes=nodes, constraints=[Constraint("mirror", C.SYMMETRY, features)])


@settings(max_examples=10, deadline=None)
@given(seeds)
def test_symmetric_planes_are_three_equations_between_three_parts(seed):
    """Satisfied by a mirror image, with the right derivative away from it; nine freedoms of twelve stay."""
    rng = np.random.default_rng(seed)
    scene = mirrored_planes(random_pose(rng), random_pose(rng))
    found = analyse(scene)
    assert (found.rows, found.rank, found.mobility) == (3, 3, 9) and found.gaps == []
    assert [o.code for o in found.report.outcomes] == [
        "RELATION_DROPPED"
    ]  # no Unity joint joins three bodies
    check_derivative(scene, rng)


def mirrored_lines(first, second, slip=0.0):
    """As ``mirrored_planes`` with lines; b's is named by another of its points, the other way round."""
    middle = Pose(rotation_about(np.array([0.6, 0.0, 0.8]), 0.7), np.array([0.1, 0.2, 0.3]))
    normal = middle.rotation[:, 2]
    flip = np.eye(3) - 2.0 * np.outer(normal, normal)
    point, along = np.array([0.5, -0.3, 0.9]), np.array([2.0, 3.0, 6.0]) / 7.0
    image_along = -flip @ along
    aside = np.cross(image_along, normal)
    image = middle.translation + flip @ (point - middle.translation) + 0.8 * image_along + slip * aside
    nodes = [
        Node("base", "base", grounded=True),
        Node("a", "a", pose=first),
        Node("b", "b", pose=second),
    ]
    features = (
        Feature(1, F.LINE, first.inverse().point(point), first.inverse().direction(along)),
        Feature(2, F.LINE, second.inverse().point(image), second.inverse().direction(image_along)),
        Feature(0, F.PLANE, middle.translation, normal),
    )
    return Scene(nodes=nodes, constraints=[Constraint("mirror", C.SYMMETRY, features)])


@settings(max_examples=10, deadline=None)
@given(seeds)
def test_symmetric_lines_are_four_equations_between_three_parts(seed):
    """Satisfied by a mirror image, with the right derivative away from it; eight freedoms of twelve stay."""
    rng = np.random.default_rng(seed)
    scene = mirrored_lines(random_pose(rng), random_pose(rng))
    found = analyse(scene)
    assert (found.rows, found.rank, found.mobility) == (4, 4, 8) and found.gaps == []
    assert [o.code for o in found.report.outcomes] == ["RELATION_DROPPED"]
    check_derivative(scene, rng)


@settings(max_examples=10, deadline=None)
@given(seeds)
def test_symmetric_lines_hold_wherever_they_move(seed):
    """One line moved anywhere and slid along itself, the other to the image: nothing is violated."""
    rng = np.random.default_rng(seed)
    scene = mirrored_lines(random_pose(rng), random_pose(rng))
    a, b, plane = scene.constraints[0].features
    flip = np.eye(3) - 2.0 * np.outer(plane.direction, plane.direction)
    turn = rotation_exp(0.4 * rng.uniform(-1, 1, 3))
    shift = rng.uniform(-0.5, 0.5, 3)
    first, second = scene.nodes[1].pose, scene.nodes[2].pose
    moved_a = Pose(turn, shift) @ first
    at, along = moved_a.point(a.point), moved_a.direction(a.direction)
    goal = plane.point + flip @ (at - plane.point) + rng.uniform(-1, 1) * (flip @ along)
    rotation = flip @ turn @ flip @ second.rotation
    moved_b = Pose(rotation, goal - rotation @ b.point)
    system = equations_of(scene, Report()).system
    state = system.start()
    for body, old, new in ((2, first, moved_a), (3, second, moved_b)):
        step = new @ old.inverse()
        state.rotation[body] = step.rotation
        state.shift[body] = step.translation + step.rotation @ system.center[body] - system.center[body]
    assert np.abs(system.residual(state)).max() < 1e-12


def test_lines_that_miss_their_image_are_reported():
    """One line 0.05 m beside the mirror image of the other: both parts can move, so they are moved there."""
    at_rest = Pose(np.eye(3), np.zeros(3))
    found = analyse(mirrored_lines(at_rest, at_rest, slip=0.05))
    assert [gap.constraint for gap in found.gaps] == ["mirror"] and found.contradictory == []
    assert found.mobility == 8


def turned_jaws(rng, feature, carried, mirrored=True):
    """Two levers on hinges of a third part, which turns on the ground or is it; the hinges and the named geometry are
    each other's images in a plane of that part.  Without ``mirrored`` the second hinge stands askew."""
    palm, first, second = (random_pose(rng) for _ in range(3))
    middle, normal = palm.translation, palm.rotation[:, 0]
    flip = np.eye(3) - 2.0 * np.outer(normal, normal)

    def image(point):
        return middle + flip @ (point - middle)

    axis, pivot, point, along = (
        random_direction(rng),
        *(middle + rng.uniform(-0.5, 0.5, 3) for _ in range(2)),
        random_direction(rng),
    )
    other_axis = flip @ axis * rng.choice([-1.0, 1.0])
    if not mirrored:
        other_axis = rotation_exp(np.array([0.3, -0.2, 0.25])) @ other_axis
    nodes = [Node("base", "base", grounded=True), Node("a", "a", pose=first), Node("b", "b", pose=second)]
    if carried:
        nodes.append(Node("palm", "palm", pose=palm))
    hub = len(nodes) - 1 if carried else 0

    def on(node, kind, at, direction=None):
        inwards = nodes[node].pose.inverse()
        radius = 0.1 if kind is F.CIRCLE else 0.0
        return Feature(
            node,
            kind,
            inwards.point(at),
            None if direction is None else inwards.direction(direction),
            radius=radius,
        )

    def hinge(name, one, two, at, along):
        return Constraint(name, C.INSERT, (on(one, F.CIRCLE, at, along), on(two, F.CIRCLE, at, along)))

    directions = (None, None) if feature is F.POINT else (along, flip @ along)
    named = on(1, feature, point, directions[0]), on(2, feature, image(point), directions[1])
    constraints = [
        hinge("one", hub, 1, pivot, axis),
        hinge("two", hub, 2, image(pivot), other_axis),
        Constraint("mirror", C.SYMMETRY, (*named, on(hub, F.PLANE, middle, normal))),
    ]
    if carried:
        constraints.insert(
            0, hinge("wrist", 0, hub, middle + rng.uniform(-0.5, 0.5, 3), random_direction(rng))
        )
    return Scene(nodes=nodes, constraints=constraints)


@pytest.mark.parametrize("carried", [False, True])
@pytest.mark.parametrize("feature", [F.POINT, F.LINE, F.PLANE])
@settings(max_examples=5, deadline=None)
@given(seeds)
def test_levers_that_mirror_each_other_are_coupled(feature, carried, seed):
    """One freedom for both; the coupling is the constraint's, its sign as the axes stand, and it holds as they turn."""
    rng = np.random.default_rng(seed)
    scene = turned_jaws(rng, feature, carried)
    found = analyse(scene)
    assert found.mobility == 1 + carried and found.gaps == []
    (coupling,) = found.couplings
    assert coupling.id == "mirror" and {coupling.terms[0].freedom, coupling.freedom} == {RX}
    assert {o.outcome.value for o in found.report.outcomes} == {"kept"}
    joints = {j.id: j for j in found.joints}
    a, b = joints[coupling.terms[0].joint], joints[coupling.joint]
    assert (a.because, b.because) == (("one",), ("two",))
    system = equations_of(scene, Report()).system
    for turn in (-2.5, -0.4, 0.7, 3.0):
        state = system.start()
        for joint, by in ((a, turn), (b, coupling.terms[0].ratio * turn + coupling.offset)):
            frame = found.poses[joint.a if joint.a is not None else 0] @ joint.frame_a
            axis = frame.rotation[:, 0]
            body = (joint.b if joint.b in (1, 2) else joint.a) + 1
            rotation = rotation_about(axis, by if joint.b in (1, 2) else -by)
            state.rotation[body] = rotation
            center = system.center[body]
            state.shift[body] = rotation @ (center - frame.translation) + frame.translation - center
        assert np.abs(system.residual(state)).max() < 1e-8


def test_slides_at_different_slants_keep_their_ratio():
    """Planes beside the middle one: what the first moves along the normal, 60 degrees off its way, the second does too,
    30 degrees off its own."""
    x, y = np.eye(3)[:2]
    ways = (
        math.cos(math.radians(60)) * x + math.sin(math.radians(60)) * y,
        math.cos(math.radians(30)) * x - math.sin(math.radians(30)) * y,
    )
    nodes = [Node("base", "base", grounded=True), Node("a", "a"), Node("b", "b")]
    slides = [
        Constraint(
            f"slide:{n}",
            C.SLIDER,
            (Feature(0, F.LINE, np.zeros(3), way), Feature(n, F.LINE, np.zeros(3), way)),
        )
        for n, way in enumerate(ways, 1)
    ]
    planes = tuple(Feature(n, F.PLANE, at * x, x) for n, at in ((1, 0.3), (2, -0.3), (0, 0.0)))
    found = analyse(Scene(nodes=nodes, constraints=[*slides, Constraint("mirror", C.SYMMETRY, planes)]))
    (coupling,) = found.couplings
    first = math.sqrt(1.0 / 3.0) if coupling.terms[0].joint == "base - a" else math.sqrt(3.0)
    assert found.mobility == 1 and coupling.terms[0].ratio == pytest.approx(-first, abs=1e-12)


def test_what_keeps_step_for_a_moment_only_is_reported():
    """A lever's tip goes round a circle and its image with it, on a part that slides both ways: rates are in
    proportion at first, distances are not; the symmetry is dropped by name."""
    x, y, z = np.eye(3)
    nodes = [Node("base", "base", grounded=True), Node("a", "a"), Node("b", "b")]
    tip = np.array([0.2, 0.5, 0.0])
    circles = (Feature(n, F.CIRCLE, np.array([0.2, 0.1, 0.0]) - 0.3 * x, z, radius=0.1) for n in (0, 1))
    constraints = [
        Constraint("lever", C.INSERT, tuple(circles)),
        Constraint(
            "flat", C.COINCIDENT, (Feature(0, F.PLANE, np.zeros(3), z), Feature(2, F.PLANE, np.zeros(3), z))
        ),
        Constraint(
            "upright", C.LOCK_ORIENTATION, (Feature(0, F.BODY, np.zeros(3)), Feature(2, F.BODY, np.zeros(3)))
        ),
        Constraint(
            "mirror",
            C.SYMMETRY,
            (
                Feature(1, F.POINT, tip),
                Feature(2, F.POINT, tip * [-1, 1, 1]),
                Feature(0, F.PLANE, np.zeros(3), x),
            ),
        ),
    ]
    found = analyse(Scene(nodes=nodes, constraints=constraints))
    assert found.mobility == 1 and found.couplings == []
    assert [(o.feature, o.code) for o in found.report.outcomes if o.code] == [
        ("constraint mirror", "RELATION_DROPPED")
    ]


@pytest.mark.parametrize(
    ("value", "hand"), [(0.0, "right"), (35.0, "right"), (-200.0, "right"), (35.0, "left")]
)
def test_displayed_values_become_the_couplings_offset(tmp_path, value, hand):
    """Levers with hinges of the source's own: the coupling holds at the exported pose whatever their joints display."""
    bundle = json.loads((ROOT / "fixtures" / "mechanisms" / "M49.bundle.json").read_text("utf-8"))
    bundle["constraints"] = bundle["constraints"][2:]
    bundle["joints"] = [
        {"id": name, "type": "revolute", "a": "base", "b": name, "dof": [{"name": "rz", "value": math.radians(q)}],
         "frameA": {"in": "world", "o": [x, 0.0, 0.0], "z": [0.0, 0.0, 1.0], "x": [1.0, 0.0, 0.0]}}
        for name, x, q in (("left", 0.2, value), ("right", -0.2, 20.0))
    ]  # fmt: skip
    scene, _ = read(bundle if hand == "right" else by_the_other_hand(bundle), tmp_path)
    found = analyse(scene)
    (coupling,) = found.couplings
    assert (found.mobility, coupling.terms[0].ratio) == (1, -1.0)
    turns = math.remainder(coupling.offset - math.radians(value + 20.0), math.tau)
    assert turns == pytest.approx(0.0, abs=1e-9)
    content, _ = exported(scene, tmp_path)
    (written,) = content["couplings"]
    assert (written["id"], written["ratio"], written.get("offset", 0)) == ("symmetry:3", -1, 0)


def test_a_gripper_keeps_its_symmetry_wherever_its_plane_goes():
    """Jaws in a palm that turns, jaws on parallelograms: the symmetry is one coupling, of jaws or of cranks."""
    (slides,) = analysed("M48").couplings
    assert (slides.terms[0].freedom, slides.freedom, abs(slides.terms[0].ratio)) == (TX, TX, 1.0)
    (cranks,) = analysed("M50").couplings
    assert (cranks.terms[0].freedom, cranks.freedom, cranks.terms[0].ratio) == (RX, RX, -1.0)
    ends = {j.id: (j.a, j.b) for j in analysed("M50").joints}
    base = node(scene("M50"), "base")
    assert all(base in ends[name] for name in (cranks.terms[0].joint, cranks.joint))


def test_a_plane_that_slides_between_two_slides_is_reported():
    """q_a + q_b = 2 q_c ties three coordinates, which no coupling of two does."""
    x = np.array([1.0, 0.0, 0.0])
    nodes = [Node("base", "base", grounded=True), *(Node(n, n) for n in ("a", "b", "c"))]

    def line(n):
        return Feature(n, F.LINE, np.zeros(3), x)

    planes = tuple(Feature(n, F.PLANE, at * x, x) for n, at in ((1, 0.3), (2, -0.3), (3, 0.0)))
    slides = [Constraint(f"slide:{n}", C.SLIDER, (line(0), line(n))) for n in (1, 2, 3)]
    found = analyse(Scene(nodes=nodes, constraints=[*slides, Constraint("mirror", C.SYMMETRY, planes)]))
    assert found.mobility == 2 and found.couplings == []
    assert [o.code for o in found.report.outcomes if o.code] == ["RELATION_DROPPED"]


def test_a_symmetry_that_the_joints_keep_already_needs_no_coupling():
    """Both parts slide along the plane, each on a slide of its own, and nothing ties them: points stay images in height.

    Two planes at right angles to the middle one are symmetric wherever the parts slide along both.
    """
    x, y = np.eye(3)[:2]
    nodes = [Node("base", "base", grounded=True), Node("a", "a"), Node("b", "b")]
    slides = [
        Constraint(
            f"slide:{n}", C.SLIDER, (Feature(0, F.LINE, np.zeros(3), x), Feature(n, F.LINE, np.zeros(3), x))
        )
        for n in (1, 2)
    ]
    planes = (
        Feature(1, F.PLANE, np.zeros(3), y),
        Feature(2, F.PLANE, np.zeros(3), y),
        Feature(0, F.PLANE, np.zeros(3), x),
    )
    found = analyse(Scene(nodes=nodes, constraints=[*slides, Constraint("mirror", C.SYMMETRY, planes)]))
    assert found.mobility == 2 and found.couplings == []
    assert {o.outcome.value for o in found.report.outcomes} == {"kept"}
