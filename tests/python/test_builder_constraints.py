"""Constraints as a script states them: by features in world or part coordinates, in metres and degrees, refused at once."""

from __future__ import annotations

import json
import math

import kinefab
import numpy as np
import pytest
from kinefab.analysis import analyse
from kinefab.spatial import matrix_from_quaternion
from scenes import BOX

AT = np.array([0.3, -0.2, 0.7])
Z = np.array([2.0, -1.0, 2.0]) / 3.0
X = np.array([2.0, 2.0, -1.0]) / 3.0
Y = np.cross(Z, X)
KINDS = {kind.value for kind in kinefab.ConstraintKind}


def pair() -> tuple[kinefab.Scene, int, int]:
    """A grounded base and an arm, both turned and moved."""
    scene = kinefab.Scene()
    turn = ("XYZ", (20, -50, 70))
    base = scene.add_part("Base", BOX, translation=(0.4, 0.1, -0.3), rotation=turn, grounded=True)
    arm = scene.add_part("Arm", BOX, translation=(-0.2, 0.6, 0.1), rotation=("XYZ", (-35, 15, 5)))
    return scene, base, arm


def feature(scene: kinefab.Scene, kind: str, part: int | None, at=AT, along=Z) -> kinefab.Feature:
    """One at ``at`` along ``along``, world."""
    if kind == "point":
        return scene.point(part, at)
    if kind in ("axis", "plane"):
        return getattr(scene, kind)(part, point=at, **{"direction" if kind == "axis" else "normal": along})
    if kind == "circle":
        return scene.circle(part, center=at, axis=along, radius=0.03)
    if kind == "cylinder":
        return scene.cylinder(part, point=at, axis=along, radius=0.02)
    if kind == "sphere":
        return scene.sphere(part, center=at, radius=0.05)
    if kind == "cone":
        return scene.cone(part, apex=at, axis=along, half_angle=30)
    return scene.frame(part, origin=at, axis=along, secondary=X)


PARALLEL = {"reading": {"line_line_distance": "parallel"}}
LEFT = [  # kind, a, b, freedoms left, place and direction of b, options
    ("coincident", "point", "point", 3, AT, Z, {}),
    ("coincident", "axis", "point", 4, AT, Z, {}),
    ("coincident", "plane", "point", 5, AT, Z, {}),
    ("coincident", "axis", "axis", 2, AT, Z, {}),
    ("coincident", "plane", "axis", 4, AT, X, {}),
    ("coincident", "plane", "plane", 3, AT, Z, {}),
    ("coincident", "frame", "frame", 0, AT, Z, {}),
    ("coincident", "plane", "plane", 3, AT + 0.005 * Z, -Z, {"value": 0.005}),
    ("concentric", "cylinder", "circle", 2, AT + 0.1 * Z, Z, {}),
    ("concentric", "cylinder", "cylinder", 1, AT, Z, {"lock_rotation": True}),
    ("concentric", "sphere", "sphere", 3, AT, Z, {}),
    ("parallel", "axis", "axis", 4, AT + X, Z, {}),
    ("parallel", "plane", "axis", 5, AT + X, Y, {}),
    ("perpendicular", "plane", "plane", 5, AT, X, {}),
    ("perpendicular", "plane", "axis", 4, AT, Z, {}),
    ("angle", "plane", "plane", 5, AT, 0.5 * Z + math.sqrt(0.75) * X, {"value": 60}),
    ("distance", "point", "point", 5, AT + 0.25 * X, Z, {"value": 0.25}),
    ("distance", "plane", "sphere", 5, AT - 0.25 * Z, Z, {"value": 0.25}),
    ("distance", "axis", "axis", 3, AT + 0.25 * X, Z, {"value": 0.25}),
    ("distance", "axis", "axis", 5, AT + 0.25 * Y, X, {"value": 0.25}),
    ("distance", "axis", "axis", 3, AT + 0.25 * X, Z, {"value": 0.25} | PARALLEL),
    ("tangent", "plane", "sphere", 5, AT + 0.05 * Z, Z, {}),
    ("tangent", "plane", "cylinder", 4, AT + 0.02 * Z, X, {}),
    ("tangent", "cylinder", "sphere", 5, AT + 0.07 * X, Z, {"side": "outside"}),
    ("tangent", "cylinder", "sphere", 5, AT + 0.03 * X, Z, {"side": "inside"}),
    ("insert", "circle", "circle", 1, AT, -Z, {"sense": "opposed"}),
    ("insert", "circle", "circle", 1, AT + 0.004 * Z, Z, {"value": 0.004}),
    ("insert", "circle", "circle", 0, AT, Z, {"lock_rotation": True}),
    ("lock", "point", "point", 0, AT + X, Z, {}),
    ("lock_orientation", "frame", "frame", 3, AT + X, Z, {}),
    ("slider", "axis", "axis", 1, AT, Z, {}),
    ("pin_slot", "axis", "axis", 2, AT, X, {}),
    ("universal", "axis", "axis", 2, AT, X, {}),
    ("screw", "axis", "axis", 1, AT, Z, {"value": -0.002}),
]


@pytest.mark.parametrize("kind, a, b, left, at, along, options", LEFT)
def test_a_constraint_leaves_what_it_leaves_in_a_bundle(kind, a, b, left, at, along, options):
    """Right where the parts stand: no gap, and as many freedoms as ``schemas/SPEC.md`` says."""
    scene, base, arm = pair()
    scene.add_constraint(kind, feature(scene, a, base), feature(scene, b, arm, at, along), **options)
    found = analyse(scene)
    assert found.first_order == left
    told = {d.code for d in found.report.diagnostics if d.severity is not kinefab.Severity.INFO}
    assert told <= ({"NOTHING_MOVES"} if left == 0 else set())
    assert max(found.worst_gap) < 1e-9


def test_every_kind_of_the_bundle_has_its_case():
    assert KINDS == {case[0] for case in LEFT} | {"gear", "belt", "rack", "linear", "symmetry", "ground", "other"}


@pytest.mark.parametrize("kind", ["point", "axis", "plane", "circle", "cylinder", "sphere", "cone", "frame"])
def test_a_feature_in_its_part_s_coordinates_is_the_one_in_the_world(kind):
    """Also of the world itself, whose coordinates are its own."""
    scene, base, arm = pair()
    pose = scene.pose(arm)
    back = pose.rotation.T
    own = {
        "point": {"point": AT},
        "axis": {"point": AT, "direction": Z},
        "plane": {"point": AT, "normal": Z},
        "circle": {"center": AT, "axis": Z, "radius": 0.03},
        "cylinder": {"point": AT, "axis": Z, "radius": 0.02},
        "sphere": {"center": AT, "radius": 0.05},
        "cone": {"apex": AT, "axis": Z, "half_angle": 30},
        "frame": {"origin": AT, "axis": Z, "secondary": X},
    }[kind]
    inside = {
        name: value if np.isscalar(value) else back @ (value - pose.translation if value is AT else value)
        for name, value in own.items()
    }
    world = getattr(scene, kind)(arm, **own)
    part = getattr(scene, kind)(arm, **inside, coordinates="part")
    assert world.kind is part.kind and (world.radius, world.half_angle) == (part.radius, part.half_angle)
    for name in ("point", "direction", "secondary"):
        one, other = getattr(world, name), getattr(part, name)
        assert (one is None) == (other is None) and (one is None or np.abs(one - other).max() < 1e-12)
    assert np.abs(pose.point(world.point) - AT).max() < 1e-12
    assert np.array_equal(getattr(scene, kind)(None, **own).point, AT)


def test_symmetry_and_ground_and_what_is_not_interpreted():
    scene, base, arm = pair()
    middle = scene.plane(None, point=AT, normal=Z)
    scene.add_constraint(
        "symmetry", scene.point(base, AT + 0.2 * Z), scene.point(arm, AT - 0.2 * Z), c=middle
    )
    assert analyse(scene).first_order == 3
    scene.add_constraint("ground", arm)
    assert analyse(scene).first_order == 0
    scene.add_constraint("other", feature(scene, "cone", base), name="Cam")
    codes = [d.code for d in analyse(scene).report.diagnostics]
    assert "CONSTRAINT_NOT_INTERPRETED" in codes


def wheels(kind: str, value: float, slides: str, **options) -> kinefab.Mechanism:
    """Two shafts side by side on a carrier that a hinge holds, coupled; ``slides``: those of "ab" that slide instead."""
    scene = kinefab.Scene()
    base = scene.add_part("Base", BOX, grounded=True)
    shafts = []
    for name, at in (("a", AT), ("b", AT + 0.1 * X)):
        part = scene.add_part(name, BOX, translation=at)
        axes = [scene.axis(each, point=at, direction=Z) for each in (base, part)]
        if name in slides:
            scene.add_constraint("slider", *axes)
        else:
            circles = [scene.circle(each, center=at, axis=Z) for each in (base, part)]
            scene.add_constraint("insert", *circles)
        shafts.append(axes[1])
    scene.add_constraint(kind, *shafts, value=value, **options)
    return kinefab.motion(scene)


@pytest.mark.parametrize(
    "kind, value, slides, goal, expected",
    [
        ("gear", -0.5, "", 40.0, -20.0),
        ("belt", 3.0, "", 10.0, 30.0),
        ("rack", 0.02, "b", 90.0, 0.02 * math.pi / 2),
        ("linear", -2.0, "ab", 0.03, -0.06),
    ],
)
def test_a_coupling_s_value_is_how_far_b_goes(kind, value, slides, goal, expected):
    mechanism = wheels(kind, value, slides)
    assert mechanism.mobility == 1
    way = mechanism.sweep("Base - a", 0, goal, frames=3)
    assert way["Base - b"][-1] == pytest.approx(expected, abs=1e-9)


def test_a_screw_s_value_is_its_lead():
    scene, base, arm = pair()
    start = scene.pose(arm).translation
    scene.add_constraint("screw", feature(scene, "axis", base), feature(scene, "axis", arm), value=-0.006)
    mechanism = kinefab.motion(scene)
    turning = next(c.name for c in mechanism.coordinates if c.unit == "deg")
    pose = mechanism.sweep(turning, 0, 120, frames=2)["Arm"][-1]
    turn = matrix_from_quaternion(pose[3:]) @ scene.pose(arm).rotation.T
    moved = turn @ (AT - start) + pose[:3] - AT
    right = math.copysign(1.0, float(np.trace(turn @ np.cross(np.eye(3), -Z))))
    assert moved @ Z == pytest.approx(-0.002 * right, abs=1e-9) and np.linalg.norm(moved) == pytest.approx(0.002)


def test_a_range_of_an_angle_is_the_joint_s_limits_in_degrees():
    """Counted about the hinge's own axis, from -10 to 80 where the planes stand at 30 now."""
    scene, base, arm = pair()
    scene.add_constraint("insert", feature(scene, "circle", base), feature(scene, "circle", arm))
    here = math.cos(math.radians(30)) * X + math.sin(math.radians(30)) * Y
    scene.add_constraint(
        "angle",
        feature(scene, "plane", base, AT, X),
        feature(scene, "plane", arm, AT, here),
        c=feature(scene, "axis", base),
        limits=(-10, 80),
    )
    (coordinate,) = kinefab.motion(scene).coordinates
    room = sorted((coordinate.lower - coordinate.value, coordinate.upper - coordinate.value), key=abs)
    assert np.abs(room) == pytest.approx([40.0, 50.0], abs=1e-6)


def test_a_range_of_a_distance_is_the_joint_s_limits_in_metres():
    scene, base, arm = pair()
    scene.add_constraint("slider", feature(scene, "axis", base), feature(scene, "axis", arm))
    scene.add_constraint(
        "distance",
        feature(scene, "plane", base),
        feature(scene, "plane", arm, AT + 0.1 * Z),
        limits=(0.05, 0.4),
    )
    (coordinate,) = kinefab.motion(scene).coordinates
    room = sorted((coordinate.lower - coordinate.value, coordinate.upper - coordinate.value), key=abs)
    assert np.abs(room) == pytest.approx([0.05, 0.3], abs=1e-9)


def test_parts_that_stand_elsewhere_are_brought_there(tmp_path):
    """A wheel drawn beside its hub: told as it is exported, and moved where that is asked for."""
    scene = kinefab.Scene()
    frame = scene.add_part("Frame", BOX, grounded=True)
    wheel = scene.add_part("Wheel", BOX, translation=(0.02, 0.31, 0.01))
    hub = scene.circle(frame, center=(0, 0.3, 0), axis=(0, 0, 1))
    bore = scene.circle(wheel, center=(0, 0, 0), axis=(0, 0, 1), coordinates="part")
    scene.add_constraint("insert", hub, bore, name="Bearing")
    told = kinefab.export(scene, tmp_path / "told.kinefab")
    assert "CONSTRAINT_GAP" in {d.code for d in told.report.diagnostics}
    moved = kinefab.export(scene, tmp_path / "moved.kinefab", kinefab.ExportOptions(solve=True)).path
    objects = json.loads(moved.read_text("utf-8"))["gameObjects"]
    place = next(o for o in objects if o["name"] == "Wheel")["transform"]["localPosition"]
    assert np.abs(np.abs(place) - [0, 0.3, 0]).max() < 1e-9


def test_the_scene_file_has_the_constraint_as_stated(tmp_path):
    scene, base, arm = pair()
    scene.add_constraint("insert", feature(scene, "circle", base), feature(scene, "circle", arm), name="Pin")
    content = json.loads(kinefab.export(scene, tmp_path / "pin.kinefab").path.read_text("utf-8"))
    (stated,) = content["constraints"]
    assert (stated["id"], stated["name"], stated["kind"], stated["rawKind"]) == ("Pin", "Pin", "insert", "insert")
    assert [f["radius"] for f in stated["features"]] == [0.03, 0.03]


@pytest.mark.parametrize(
    "kind, a, b, options, error, says",
    [
        ("glued", "axis", "axis", {}, ValueError, "the kind is 'glued'; pass one of: coincident, concentric,"),
        ("concentric", "axis", "plane", {}, ValueError, "concentric says nothing between line and plane; it takes axes,"),
        ("parallel", "point", "axis", {}, ValueError, "parallel says nothing between point and line; it takes axes and"),
        ("tangent", "cone", "cone", {}, ValueError, "tangent says nothing between cone and cone; it takes a plane with"),
        ("insert", "point", "circle", {}, ValueError, "it takes two circles"),
        ("universal", "point", "axis", {}, ValueError, "it takes geometry with a direction"),
        ("concentric", "axis", "axis", {"value": 0.1}, ValueError, "concentric has no value; pass none"),
        ("distance", "plane", "plane", {}, ValueError, "distance needs a value: metres; pass value=, or limits="),
        ("gear", "axis", "axis", {}, ValueError, "gear needs a value: how far b moves for one of a; pass value="),
        ("screw", "axis", "axis", {"value": 0}, ValueError, "the value of screw is 0; pass the lead, metres a turn"),
        ("distance", "plane", "plane", {"value": math.nan}, ValueError, "pass a finite number"),
        ("distance", "plane", "plane", {"value": "5 mm"}, TypeError, "the value is '5 mm'; pass a number"),
        ("distance", "plane", "plane", {"value": 1, "limits": (0, 1)}, ValueError, "a value and limits; pass one"),
        ("distance", "plane", "plane", {"limits": (2, 1)}, ValueError, "lower not above upper"),
        ("distance", "plane", "plane", {"limits": (-math.inf, math.inf)}, ValueError, "one end at least"),
        ("distance", "point", "point", {"limits": (0, 1)}, ValueError, "can have no limits, as no joint counts it"),
        ("parallel", "axis", "axis", {"limits": (0, 1)}, ValueError, "only distance, angle, insert have"),
        ("insert", "circle", "circle", {"sense": "same"}, ValueError, "the sense is 'same'; pass one of: aligned, opp"),
        ("insert", "circle", "circle", {"side": "inside"}, ValueError, "insert has no side; only tangent has"),
        ("slider", "axis", "axis", {"lock_rotation": True}, ValueError, "only insert and concentric have"),
        ("insert", "circle", "circle", {"lock_rotation": 1}, TypeError, "pass True or False"),
        ("insert", "circle", None, {}, ValueError, "insert stands between two features; pass b"),
        ("ground", "point", "point", {}, ValueError, "ground fixes one part to the world; pass no b"),
        ("symmetry", "point", "point", {}, ValueError, "symmetry needs the plane between a and b; pass it as c"),
        ("insert", "circle", "circle", {"c": "plane"}, ValueError, "insert stands between two features; pass no c"),
        ("distance", "axis", "axis", {"value": 1, "reading": {"offset": "sideways"}}, ValueError, "known are line_"),
        ("distance", "axis", "axis", {"value": 1, "reading": "skew"}, TypeError, "pass a dict"),
        ("insert", "circle", "circle", {"name": 5}, TypeError, "pass a string"),
        ("insert", "index", "circle", {}, TypeError, "a is 0; pass a feature, such as scene.plane(0, point="),
        ("insert", "circle", "itself", {}, ValueError, "insert joins Base to itself; pass features of two parts"),
    ],
)
def test_a_wrong_constraint_says_what_to_pass(kind, a, b, options, error, says):
    scene, base, arm = pair()
    given = {"index": base, "itself": feature(scene, "circle", base), None: None}
    sides = [given[s] if s in given else feature(scene, s, part) for s, part in ((a, base), (b, arm))]
    options = {name: feature(scene, value, None) if name == "c" else value for name, value in options.items()}
    with pytest.raises(error) as raised:
        scene.add_constraint(kind, *sides, **options)
    assert says in str(raised.value) and scene.constraints == []


@pytest.mark.parametrize(
    "kind, options, error, says",
    [
        ("plane", {"point": AT, "normal": (0, 0, 0)}, ValueError, "the direction of the plane is (0, 0, 0); pass"),
        ("axis", {"point": "here", "direction": Z}, ValueError, "the place of the line is 'here'; pass three"),
        ("circle", {"center": AT, "axis": Z, "radius": -1}, ValueError, "not below 0"),
        ("cone", {"apex": AT, "axis": Z, "half_angle": 90}, ValueError, "pass degrees below 90, or a plane"),
        ("frame", {"origin": AT, "axis": Z, "secondary": Z}, ValueError, "span no plane"),
        ("point", {"point": AT, "coordinates": "local"}, ValueError, "coordinates is 'local'; pass world or part"),
    ],
)
def test_a_wrong_feature_says_what_to_pass(kind, options, error, says):
    scene, base, arm = pair()
    with pytest.raises(error) as raised:
        getattr(scene, kind)(base, **options)
    assert says in str(raised.value)


def test_a_feature_of_another_scene_is_refused():
    scene, base, arm = pair()
    other, _, foreign = pair()
    with pytest.raises(ValueError, match="the part of b is 1 of another scene"):
        scene.add_constraint("insert", feature(scene, "circle", base), feature(other, "circle", foreign))
    with pytest.raises(TypeError, match="part is 'Arm'; pass the index"):
        scene.point("Arm", AT)
    without = feature(scene, "cylinder", base), scene.cylinder(arm, point=AT, axis=Z)
    with pytest.raises(ValueError, match="tangent of cylinder and cylinder: the cylinder has no radius"):
        scene.add_constraint("tangent", *without)
