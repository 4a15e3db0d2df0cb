"""Joints of UsdPhysics: frames, senses, ranges, drives and units, held against numbers worked out by hand."""

from __future__ import annotations

import math

import kinefab
import numpy as np
import pytest
from kinefab.model import RX, RY, RZ, TX, TY, TZ, JointKind, Motion
from kinefab.unity.joints.coordinates import canonical, read_coordinates
from usd_stages import body, codes, joint, scene_of, stage

pytest.importorskip("pxr", reason="usd-core is not installed")

DEGREE = math.pi / 180.0
LIMITS = "float physics:lowerLimit = -10\nfloat physics:upperLimit = 80"


def joint_of(tmp_path, text: str, **units):
    scene, report = scene_of(tmp_path, stage(text, **units))
    assert scene is not None, report.diagnostics
    (found,) = scene.joints
    return found, scene, report


def coordinate(scene, found, freedom: int) -> float:
    """A joint's coordinate at the exported pose."""
    here = (scene.pose(found.a) @ found.frame_a).inverse() @ (scene.pose(found.b) @ found.frame_b)
    if freedom < RX:
        return float(here.translation[freedom])
    i, j = (freedom - RX + 1) % 3, (freedom - RX + 2) % 3
    return math.atan2(here.rotation[j, i], here.rotation[j, j])


def turned(name: str, degrees: float, about: str = "Z", at=(0, 0, 0), inside: str = "") -> str:
    """A body that is turned by ``degrees``."""
    text = body(name, at, inside)
    text = text.replace('["xformOp:translate"]', f'["xformOp:translate", "xformOp:rotate{about}"]')
    return text.replace("uniform token[]", f"double xformOp:rotate{about} = {degrees}\n uniform token[]", 1)


@pytest.mark.parametrize("up", ["Y", "Z"])
@pytest.mark.parametrize("axis", ["X", "Y", "Z"])
@pytest.mark.parametrize("world", [0, 1])
def test_a_hinge_reads_its_angle_by_the_right_hand_whichever_side_is_the_world(tmp_path, up, axis, world):
    """Body 1 against body 0: with the world as body 1 the body turns the other way for the same coordinate."""
    sides = {"body0": "/B", "body1": ""} if world else {"body0": "", "body1": "/B"}
    turn = -30.0 if world else 30.0
    text = turned("B", turn, axis) + joint(
        "PhysicsRevoluteJoint", inside=f'uniform token physics:axis = "{axis}"\n{LIMITS}', **sides
    )
    found, scene, _ = joint_of(tmp_path, text, up=up)
    assert found.kind is JointKind.REVOLUTE and found.a is None
    assert coordinate(scene, found, RX) == pytest.approx(30.0 * DEGREE, abs=1e-9)
    assert (found.freedoms[RX].lower, found.freedoms[RX].upper) == pytest.approx((-10 * DEGREE, 80 * DEGREE))


@pytest.mark.parametrize("world", [0, 1])
@pytest.mark.parametrize("metres", [1.0, 0.01, 0.001])
def test_a_slide_counts_in_metres(tmp_path, world, metres):
    sides = {"body0": "/B", "body1": ""} if world else {"body0": "", "body1": "/B"}
    text = body("B", at=(0, -3 if world else 3, 0)) + joint(
        "PhysicsPrismaticJoint", inside=f'uniform token physics:axis = "Y"\n{LIMITS}', **sides
    )
    found, scene, _ = joint_of(tmp_path, text, metres=metres)
    assert found.kind is JointKind.PRISMATIC
    assert coordinate(scene, found, TX) == pytest.approx(3 * metres)
    assert (found.freedoms[TX].lower, found.freedoms[TX].upper) == pytest.approx((-10 * metres, 80 * metres))


def test_frames_stand_in_scaled_bodies_with_their_scale(tmp_path):
    scaled = (
        body("B", at=(1, 0, 0))
        .replace('["xformOp:translate"]', '["xformOp:translate", "xformOp:scale"]')
        .replace("uniform token[]", "float3 xformOp:scale = (2, 3, 4)\n uniform token[]", 1)
    )
    text = scaled + joint(
        "PhysicsRevoluteJoint",
        inside="point3f physics:localPos1 = (0.5, 1, 0.25)\npoint3f physics:localPos0 = (2, 3, 1)",
    )
    found, scene, _ = joint_of(tmp_path, text, up="Y")
    assert np.allclose(found.frame_b.translation, [1.0, 3.0, 1.0])
    assert np.allclose(coordinate(scene, found, TX), 0.0)
    assert np.allclose(scene.pose(found.b).point(found.frame_b.translation), [2, 3, 1])


def test_a_target_below_a_body_is_the_body_and_one_below_none_the_world(tmp_path):
    site = 'def Xform "Site" { double3 xformOp:translate = (0, 0, 0.5)\n uniform token[] xformOpOrder = ["xformOp:translate"]\n }'
    text = (
        body("B", at=(0, 2, 0), inside=site)
        + 'def Xform "Hall" {}\n'
        + joint("PhysicsRevoluteJoint", body0="/Hall", body1="/B/Site")
    )
    found, scene, _ = joint_of(tmp_path, text, up="Y")
    assert found.a is None and scene.nodes[found.b].id == "B"
    assert np.allclose(found.frame_b.translation, [0, 0, 0.5])
    assert [site.name for site in scene.nodes[found.b].sites] == ["Site"]


@pytest.mark.parametrize("low, high, motion", [
    ("1", "-1", Motion.LOCKED), ("inf", "-inf", Motion.LOCKED), ("0", "0", Motion.LOCKED),
    ("-inf", "inf", Motion.FREE), ("-3.4e38", "3.4e38", Motion.FREE), ("-2", "3", Motion.LIMITED),
])  # fmt: skip
def test_ranges_of_a_generic_joint(tmp_path, low, high, motion):
    inside = f"float limit:rotY:physics:low = {low}\nfloat limit:rotY:physics:high = {high}"
    inside += "".join(
        f"\nfloat limit:trans{a}:physics:low = 1\nfloat limit:trans{a}:physics:high = -1" for a in "XYZ"
    )
    schemas = ", ".join(f'"PhysicsLimitAPI:{name}"' for name in ("rotY", "transX", "transY", "transZ"))
    found, _, _ = joint_of(tmp_path, body("B") + joint("PhysicsJoint", inside=inside, schemas=schemas))
    assert [found.freedoms[i].motion for i in (TX, TY, TZ)] == [Motion.LOCKED] * 3
    assert found.freedoms[RY].motion is motion
    assert found.freedoms[RX].motion is found.freedoms[RZ].motion is Motion.FREE
    if motion is Motion.LIMITED:
        assert (found.freedoms[RY].lower, found.freedoms[RY].upper) == pytest.approx(
            (-2 * DEGREE, 3 * DEGREE)
        )


def test_a_distance_bounds_the_slides_of_a_generic_joint_that_nothing_else_bounds(tmp_path):
    """With the drives that they have; its six freedoms stay six."""
    inside = "float limit:distance:physics:high = 70\nfloat limit:transY:physics:low = -20\nfloat limit:transY:physics:high = 30"
    inside += "\nfloat drive:transX:physics:stiffness = 8"
    schemas = '"PhysicsLimitAPI:distance", "PhysicsLimitAPI:transY", "PhysicsDriveAPI:transX"'
    text = body("B") + joint("PhysicsJoint", inside=inside, schemas=schemas)
    found, _, report = joint_of(tmp_path, text, metres=0.01)
    assert not report.diagnostics and len(found.freedoms) == 6
    ranges = [(f.motion, round(f.lower, 9), round(f.upper, 9)) for f in found.freedoms[:RX]]
    far = (Motion.LIMITED, -0.7, 0.7)
    assert ranges == [far, (Motion.LIMITED, -0.2, 0.3), far]
    assert [f.motion for f in found.freedoms[RX:]] == [Motion.FREE] * 3
    assert found.freedoms[TX].drive is not None and found.freedoms[TX].drive.stiffness == pytest.approx(8.0)


def test_a_locked_value_away_from_zero_moves_the_frame(tmp_path):
    locked = "".join(
        f"float limit:{n}:physics:low = {v}\nfloat limit:{n}:physics:high = {v}\n"
        for n, v in (("transX", 2), ("transY", 0), ("transZ", 0), ("rotX", 0), ("rotY", 30))
    )
    schemas = ", ".join(f'"PhysicsLimitAPI:{n}"' for n in ("transX", "transY", "transZ", "rotX", "rotY"))
    text = turned("B", 30.0, "Y", at=(2, 0, 0)) + joint("PhysicsJoint", inside=locked, schemas=schemas)
    found, scene, _ = joint_of(tmp_path, text, up="Y", metres=0.1)
    here = (scene.pose(found.a) @ found.frame_a).inverse() @ (scene.pose(found.b) @ found.frame_b)
    assert np.allclose(here.rotation, np.eye(3), atol=1e-7) and np.allclose(here.translation, 0, atol=1e-7)
    assert found.unlocked == (RZ,)


@pytest.mark.parametrize("world", [0, 1])
@pytest.mark.parametrize("other", ["", "/A"])
def test_a_fixed_joint_whose_frames_do_not_meet_holds_the_bodies_as_they_stand_and_says_so(
    tmp_path, world, other
):
    """As Unity's does; an engine of USD would pull them together at the first step."""
    bodies = {f"body{world}": other, f"body{1 - world}": "/B"}
    text = turned("B", 30.0, at=(0, 3, 4)) + (body("A") if other else "")
    found, scene, report = joint_of(tmp_path, text + joint("PhysicsFixedJoint", **bodies), metres=0.01)
    here = (scene.pose(found.a) @ found.frame_a).inverse() @ (scene.pose(found.b) @ found.frame_b)
    assert np.allclose(here.rotation, np.eye(3), atol=1e-12)
    assert np.allclose(here.translation, 0.0, atol=1e-12)
    apart = scene.pose(found.a).inverse() @ scene.pose(found.b)
    assert np.linalg.norm(apart.translation) == pytest.approx(0.05)
    (told,) = report.diagnostics
    assert told.code == "USD_FEATURE_APPROXIMATED" and told.where.endswith("</J>")
    assert "0.05 m and 30 degrees apart" in told.message


@pytest.mark.parametrize(
    "kind, force",
    [
        ("PhysicsRevoluteJoint", "force"),
        ("PhysicsRevoluteJoint", "acceleration"),
        ("PhysicsPrismaticJoint", "force"),
        ("PhysicsPrismaticJoint", "acceleration"),
    ],
)
def test_drives_and_breaking_in_centimetres_and_grams(tmp_path, kind, force):
    name = "angular" if "Revolute" in kind else "linear"
    p = f"drive:{name}:physics:"
    inside = f'uniform token {p}type = "{force}"\nfloat {p}stiffness = 6\nfloat {p}damping = 4\nfloat {p}maxForce = 5\nfloat {p}targetPosition = 20\nfloat {p}targetVelocity = -7\nfloat physics:breakForce = 8\nfloat physics:breakTorque = 9'
    text = stage(
        body("B") + joint(kind, inside=inside, schemas=f'"PhysicsDriveAPI:{name}"'),
        metres=0.01,
        more="kilogramsPerUnit = 0.001",
    )
    scene, _ = scene_of(tmp_path, text)
    found = scene.joints[0]
    drive = found.freedoms[RX if name == "angular" else TX].drive
    torque, newton = 0.001 * 0.01**2, 0.001 * 0.01
    per_degree = 180.0 / math.pi
    gain = {
        ("angular", "force"): torque * per_degree,
        ("angular", "acceleration"): per_degree,
        ("linear", "force"): 0.001,
        ("linear", "acceleration"): 1.0,
    }[name, force]
    unit = DEGREE if name == "angular" else 0.01
    assert (drive.stiffness, drive.damping) == pytest.approx((6 * gain, 4 * gain))
    assert (drive.target, drive.target_velocity) == pytest.approx((20 * unit, -7 * unit))
    assert drive.max_force == pytest.approx(5 * (torque if name == "angular" else newton))
    assert drive.acceleration == (force == "acceleration")
    assert (found.break_force, found.break_torque) == pytest.approx((8 * newton, 9 * torque))


def test_a_ball_has_the_cone_of_physx_and_a_rope_its_length(tmp_path):
    cone = 'uniform token physics:axis = "Z"\nfloat physics:coneAngle0Limit = 30\nfloat physics:coneAngle1Limit = 30'
    found, _, _ = joint_of(tmp_path, body("B") + joint("PhysicsSphericalJoint", inside=cone))
    assert found.kind is JointKind.SPHERICAL and found.freedoms[RX].motion is Motion.FREE
    assert [found.freedoms[i].upper for i in (RY, RZ)] == pytest.approx([30 * DEGREE] * 2)
    found, _, report = joint_of(
        tmp_path,
        body("B")
        + joint(
            "PhysicsDistanceJoint", inside="float physics:minDistance = 0.5\nfloat physics:maxDistance = 2"
        ),
        metres=0.01,
    )
    assert [found.freedoms[i].upper for i in (TX, TY, TZ)] == pytest.approx([0.02] * 3)
    assert codes(report) == {"USD_FEATURE_APPROXIMATED"}


def test_a_cone_of_two_angles_bounds_the_turns_that_physx_bounds_by_them(tmp_path):
    """Angle 0 the turn about the axis after the main one, angle 1 that about the next."""
    cone = 'uniform token physics:axis = "X"\nfloat physics:coneAngle0Limit = 30\nfloat physics:coneAngle1Limit = 20'
    found, _, _ = joint_of(tmp_path, body("B") + joint("PhysicsSphericalJoint", inside=cone))
    ends = [(found.freedoms[i].lower, found.freedoms[i].upper) for i in (RY, RZ)]
    assert np.allclose(ends, [(-30 * DEGREE, 30 * DEGREE), (-20 * DEGREE, 20 * DEGREE)])


def test_a_rope_is_the_radius_that_unity_has_and_a_box_of_slides_is_not(tmp_path):
    """Both are three slides of -2..2 m; the box reaches further at its corners, which is told."""
    axes = [f"trans{axis}" for axis in "XYZ"]
    ends = "".join(f"float limit:{a}:physics:low = -2\nfloat limit:{a}:physics:high = 2\n" for a in axes)
    schemas = ", ".join(f'"PhysicsLimitAPI:{a}"' for a in axes)
    rope, box = tmp_path / "rope.usda", tmp_path / "box.usda"
    rope.write_text(stage(body("B") + joint("PhysicsDistanceJoint", inside="float physics:maxDistance = 2")))
    box.write_text(stage(body("B") + joint("PhysicsJoint", inside=ends, schemas=schemas)))
    for source, told in ((rope, set()), (box, {"JOINT_LIMITS_SHARED"})):
        result = kinefab.export(source, source.with_suffix(".kinefab"))
        (found,) = [
            c
            for o in result.unity.gameObjects
            for c in o.components
            if type(c).__name__ == "ConfigurableJoint"
        ]
        assert found.linearLimit.limit == 2.0
        assert {d.code for d in result.report.diagnostics} & {"JOINT_LIMITS_SHARED"} == told


def test_what_is_switched_off_or_said_of_loops_and_contacts_is_kept(tmp_path):
    inside = "bool physics:jointEnabled = 0\nbool physics:collisionEnabled = 1\nuniform bool physics:excludeFromArticulation = 1"
    found, _, _ = joint_of(tmp_path, body("B") + joint("PhysicsRevoluteJoint", inside=inside))
    assert not found.enabled and found.collide and found.extras["excludeFromArticulation"] and found.closes
    # What breaks is outside of an articulation too, and closes nothing.
    inside += "\nfloat physics:breakForce = 5"
    assert not joint_of(tmp_path, body("B") + joint("PhysicsRevoluteJoint", inside=inside))[0].closes


def test_newton_s_and_physx_s_attributes_need_no_plug_in(tmp_path):
    inside = (
        "float newton:armature = 3\nfloat newton:friction = 2\nfloat newton:damping = 0.5\nfloat newton:velocityLimit = 90\nfloat physxLimit:angular:stiffness = 4\n"
        + LIMITS
    )
    found, _, _ = joint_of(
        tmp_path,
        body("B")
        + joint("PhysicsRevoluteJoint", inside=inside, schemas='"NewtonJointAPI", "PhysxLimitAPI:angular"'),
        metres=0.1,
    )
    passive = found.freedoms[RX].passive
    assert (passive.armature, passive.friction, passive.damping) == pytest.approx(
        (0.03, 0.02, 0.005 / DEGREE)
    )
    assert passive.speed == pytest.approx(90 * DEGREE)
    assert found.freedoms[RX].stiffness == pytest.approx(0.04 / DEGREE)


def driven(tmp_path, attributes: str, kind: str = "PhysicsRevoluteJoint", inside: str = "", scene: str = ""):
    """The joint that an MjcActuator with these attributes acts on, and the report; a stage of decimetres and grams."""
    schemas = '"MjcJointAPI", "PhysicsDriveAPI:angular"' if "drive:" in inside else '"MjcJointAPI"'
    text = body("B") + joint(kind, inside=inside, schemas=schemas)
    text += f'def MjcActuator "Motor" {{\nrel mjc:target = </J>\n{attributes}\n}}\n'
    text += f'def PhysicsScene "S" (prepend apiSchemas = ["MjcSceneAPI"]) {{\n{scene}\n}}\n'
    return joint_of(tmp_path, text, metres=0.1, more="kilogramsPerUnit = 0.001")


AFFINE = 'uniform token mjc:biasType = "affine"\n'
POSITION = AFFINE + "uniform double[] mjc:gainPrm = [6]\nuniform double[] mjc:biasPrm = [0, -6, -0.5]\n"
RADIANS = 'uniform token mjc:compiler:angle = "radian"'


def test_mujoco_s_springs_and_dampers_are_per_radian(tmp_path):
    """Its angles are degrees unless its settings say otherwise; the spring's rest is counted from the reference."""
    inside = (
        "double mjc:damping = 3\ndouble mjc:stiffness = 5\ndouble mjc:springref = 40\ndouble mjc:ref = 10\n"
    )
    for scene, unit in (("", DEGREE), (RADIANS, 1.0)):
        found, _, _ = driven(tmp_path, POSITION, inside=inside, scene=scene)
        passive, drive = found.freedoms[RX].passive, found.freedoms[RX].drive
        assert (passive.damping, passive.stiffness) == pytest.approx((3e-5, 5e-5))
        assert passive.rest == pytest.approx(30 * unit)
        assert drive.target == pytest.approx(-10 * unit)
    slide = "double mjc:damping = 3\ndouble mjc:armature = 2\n"
    found, _, _ = driven(tmp_path, POSITION, "PhysicsPrismaticJoint", slide)
    assert (found.freedoms[TX].passive.damping, found.freedoms[TX].passive.armature) == pytest.approx(
        (0.003, 0.002)
    )


@pytest.mark.parametrize(
    "attributes, expected",
    [
        (POSITION, (6, 0.5, 0, 0, math.inf)),
        (POSITION + "uniform double[] mjc:gear = [-2, 0, 0, 0, 0, 0]\n", (24, 2, 0, 0, math.inf)),
        (POSITION + "double mjc:ctrlRange:min = 0.25\ndouble mjc:ctrlRange:max = 1\n", (6, 0.5, 0.25, 0, math.inf)),
        (POSITION + "double mjc:forceRange:min = -4\ndouble mjc:forceRange:max = 4\n", (6, 0.5, 0, 0, 4)),
        (
            AFFINE + "uniform double[] mjc:gainPrm = [2]\nuniform double[] mjc:biasPrm = [3, 0, -2]\n",
            (0, 2, 0, 1.5, math.inf),
        ),
    ],
)  # fmt: skip
@pytest.mark.parametrize("kind", ["PhysicsRevoluteJoint", "PhysicsPrismaticJoint"])
def test_mujoco_s_actuators_are_drives_where_unity_s_law_is_theirs(tmp_path, attributes, expected, kind):
    """force = gear (gain u + b0 + b1 gear q + b2 gear qdot) in the stage's units, angles in radians."""
    found, _, told = driven(tmp_path, attributes, kind)
    turns = kind == "PhysicsRevoluteJoint"
    drive = found.freedoms[RX if turns else TX].drive
    force, unit = (1e-5, 1.0) if turns else (1e-4, 0.1)
    stiffness, damping, target, speed, most = expected
    assert (drive.stiffness, drive.damping) == pytest.approx(
        (stiffness * force / unit, damping * force / unit)
    )
    assert (drive.target, drive.target_velocity) == pytest.approx((target * unit, speed * unit))
    assert drive.max_force == pytest.approx(most * force) and "USD_FEATURE_DROPPED" not in codes(told)
    inside = "double mjc:actuatorfrcrange:min = -3\ndouble mjc:actuatorfrcrange:max = 3"
    drive = driven(tmp_path, attributes, kind, inside)[0].freedoms[RX if turns else TX].drive
    assert drive.max_force == pytest.approx(3 * force)


@pytest.mark.parametrize(
    "attributes, inside, word, effort",
    [
        ("double mjc:ctrlRange:min = -3\ndouble mjc:ctrlRange:max = 2\nuniform double[] mjc:gear = [4]", "", "force is no drive", 12e-5),
        ("", "double mjc:actuatorfrcrange:min = -7\ndouble mjc:actuatorfrcrange:max = 7", "force is no drive", 7e-5),
        ('uniform token mjc:dynType = "integrator"', "", "dynType is 'integrator'", None),
        (AFFINE + "uniform double[] mjc:gainPrm = [6]\nuniform double[] mjc:biasPrm = [0, -6, 1]", "", "ratio", None),
        (POSITION + "double mjc:forceRange:min = -4\ndouble mjc:forceRange:max = 5", "", "both sides", None),
        (POSITION + "uniform double[] mjc:gear = [0, 0, 0, 0, 0, 0]", "", "force is no drive", 0.0),
        (POSITION, "float drive:angular:physics:stiffness = 2", "DriveAPI", None),
        (POSITION + "rel mjc:target = [</J>, </B>]", "", "no joint", None),
    ],
)  # fmt: skip
def test_other_actuators_of_mujoco_are_told_with_their_numbers(tmp_path, attributes, inside, word, effort):
    if "rel mjc:target" in attributes:
        attributes = attributes.replace("rel mjc:target", "add rel mjc:target")
    found, _, told = driven(tmp_path, attributes, inside=inside)
    assert any(word in d.message and "gear" in d.message for d in told.diagnostics)
    if effort is not None:
        assert found.freedoms[RX].passive.effort == pytest.approx(effort)


TWO = body("A") + body("B") + joint("PhysicsRevoluteJoint", "J1", body1="/A")


@pytest.mark.parametrize("schema, inside, ratio, offset", [
    ("NewtonMimicAPI", "rel newton:mimicJoint = </J1>\nfloat newton:mimicCoef0 = 5\nfloat newton:mimicCoef1 = -2", -2.0, 5 * DEGREE),
    ("PhysxMimicJointAPI:rotX", "rel physxMimicJoint:rotX:referenceJoint = </J1>\nfloat physxMimicJoint:rotX:gearing = 2\nfloat physxMimicJoint:rotX:offset = -5", -2.0, 5 * DEGREE),
])  # fmt: skip
@pytest.mark.parametrize("slide", [False, True])
def test_mimics_of_newton_and_physx_say_the_same(tmp_path, schema, inside, ratio, offset, slide):
    kind = "PhysicsPrismaticJoint" if slide else "PhysicsRevoluteJoint"
    scene, report = scene_of(
        tmp_path, stage(TWO + joint(kind, "J2", inside=inside, schemas=f'"{schema}"'), metres=0.01)
    )
    (found,) = scene.couplings
    assert (found.joint, found.terms[0].joint) == ("J2", "J1")
    assert found.terms[0].ratio == pytest.approx(ratio * (0.01 / DEGREE if slide else 1.0))
    assert found.offset == pytest.approx(offset / DEGREE * 0.01 if slide else offset)


@pytest.mark.parametrize("named, sense", [("/B", -1.0), ("", 1.0)])
def test_a_gear_turns_its_wheels_against_each_other(tmp_path, named, sense):
    """PhysX: R w0 + w1 = 0 for the bodies that the gear names; named by the hinge's other body it turns round."""
    gear = (
        'def PhysxPhysicsGearJoint "G" { rel physics:body0 = </A>\n '
        + f"rel physics:body1 = <{named or '/C'}>"
        + "\n rel physics:hinge0 = </J1>\n rel physics:hinge1 = </J2>\n float physics:gearRatio = 3\n }"
    )
    hinge = joint("PhysicsRevoluteJoint", "J2", body0="" if named else "/C", body1="/B")
    scene, _ = scene_of(tmp_path, stage(body("C") + TWO + hinge + gear))
    (found,) = scene.couplings
    assert (found.joint, found.terms[0].joint, found.terms[0].ratio) == (
        "J2",
        "J1",
        pytest.approx(3.0 * sense),
    )


def test_a_rack_rolls_on_its_pinion(tmp_path):
    """Degrees for a centimetre; the rack lies below the pinion (seen along its axis) and so runs the other way."""
    rack = joint(
        "PhysicsPrismaticJoint",
        "J2",
        body1="/B",
        inside='point3f physics:localPos0 = (0, -2, 0)\npoint3f physics:localPos1 = (0, -2, 0)\nuniform token physics:axis = "X"',
    )
    pinion = (
        body("A")
        + body("B")
        + joint("PhysicsRevoluteJoint", "J1", body1="/A", inside='uniform token physics:axis = "Z"')
    )
    tie = 'def PhysxPhysicsRackAndPinionJoint "R" { rel physics:body0 = </A>\n rel physics:body1 = </B>\n rel physics:hinge = </J1>\n rel physics:prismatic = </J2>\n float physics:ratio = 30\n }'
    scene, _ = scene_of(tmp_path, stage(pinion + rack + tie, up="Y", metres=0.01))
    (found,) = scene.couplings
    # z x (0, -2, 0) = (2, 0, 0): the pinion's lowest point runs along +X as it turns by the right hand.
    assert (found.joint, found.terms[0].ratio) == ("J1", pytest.approx(30 * DEGREE / 0.01))


def test_a_coordinate_that_is_stated_is_counted_as_its_range_is(tmp_path):
    """Two slides of body 0 against the world, of which PhysX's JointStateAPI says where one stands; the scene counts them
    the other way round, as the world goes first there."""
    locked = "".join(
        f" float limit:{name}:physics:low = 1\n float limit:{name}:physics:high = -1\n"
        for name in ("transZ", "rotX", "rotY", "rotZ")
    )
    inside = (
        f"{locked} float limit:transX:physics:low = -0.1\n float limit:transX:physics:high = 0.8\n"
        " float state:transX:physics:position = 0.2\n"
    )
    schemas = ", ".join(f'"PhysicsLimitAPI:{n}"' for n in ("transX", "transZ", "rotX", "rotY", "rotZ"))
    text = stage(body("B", at=(-0.2, 0, 0)) + joint("PhysicsJoint", "J", inside, "/B", "", schemas))
    scene, _ = scene_of(tmp_path, text)
    assert scene is not None
    (freedom,) = (f for f in scene.joints[0].freedoms if f.at is not None)
    assert (freedom.lower, freedom.upper, freedom.at) == pytest.approx((-0.8, 0.1, -0.2))


def generic(ranges: dict[str, tuple[float, float]], more: str = "", also: str = "", **sides) -> str:
    """A joint that leaves these freedoms, each with its range, and no others.  also: further applied schemas, quoted."""
    locked = {name: (1.0, -1.0) for name in ("transX", "transY", "transZ", "rotX", "rotY", "rotZ")}
    ends = "".join(
        f" float limit:{name}:physics:low = {low}\n float limit:{name}:physics:high = {high}\n"
        for name, (low, high) in {**locked, **ranges}.items()
    )
    schemas = ", ".join([*(f'"PhysicsLimitAPI:{name}"' for name in locked), *([also] if also else [])])
    return joint("PhysicsJoint", "J2", ends + more, schemas=schemas, **sides)


def test_two_turns_whose_second_body_is_the_world_keep_their_ranges_and_senses(tmp_path):
    """The world's frame seen from the body's is Rz(35) Rx(20); with the world first the turns have each other's names."""
    standing = " double xformOp:rotateX = -20\n double xformOp:rotateZ = -35\n uniform token[]"
    order = '["xformOp:translate", "xformOp:rotateX", "xformOp:rotateZ"]'
    turned_body = body("B").replace('["xformOp:translate"]', order).replace("uniform token[]", standing, 1)
    text = generic({"rotX": (-10.0, 80.0), "rotZ": (-20.0, 50.0)}, body0="/B", body1="")
    mimic = (
        " rel physxMimicJoint:rotX:referenceJoint = </J2>\n"
        ' uniform token physxMimicJoint:rotX:referenceJointAxis = "rotX"\n'
    )
    text += joint("PhysicsRevoluteJoint", "J1", mimic, body1="/A", schemas='"PhysxMimicJointAPI:rotX"')
    scene, _ = scene_of(tmp_path, stage(body("A") + turned_body + text, up="Y"))
    (coupling,), found = scene.couplings, next(j for j in scene.joints if j.id == "J2")
    assert found.a is None and found.kind is JointKind.UNIVERSAL
    shape = canonical(found)
    here = read_coordinates(shape, found.frame_a.inverse() @ scene.pose(found.b) @ found.frame_b)
    known = {
        round(math.degrees(here.values[i])): np.degrees([shape.freedoms[i].lower, shape.freedoms[i].upper])
        .round(4)
        .tolist()
        for i in (RX, RZ)
    }
    assert here.gap_angle < 1e-9 and known == {20: [-10.0, 80.0], 35: [-20.0, 50.0]}
    led = found.freedoms[coupling.terms[0].freedom]
    assert (led.lower, led.upper) == pytest.approx((-10.0 * DEGREE, 80.0 * DEGREE))


def test_two_turns_that_are_held_away_from_zero_are_held_in_their_order(tmp_path):
    """R = Rz Ry Rx, as PhysX has it."""
    standing = " double xformOp:rotateZ = 35\n double xformOp:rotateX = 20\n uniform token[]"
    order = '["xformOp:translate", "xformOp:rotateZ", "xformOp:rotateX"]'
    turned_body = body("B").replace('["xformOp:translate"]', order).replace("uniform token[]", standing, 1)
    text = generic({"rotX": (20.0, 20.0), "rotZ": (35.0, 35.0), "transY": (-1.0, 2.0)})
    found, scene, _ = joint_of(tmp_path, turned_body + text, up="Y")
    here = found.frame_a.inverse() @ scene.pose(found.b) @ found.frame_b
    assert found.unlocked == (TY,) and np.allclose(here.rotation, np.eye(3), atol=1e-6)


@pytest.mark.parametrize("follows", [True, False])
def test_slides_whose_second_body_is_the_world_turn_their_drives_and_mimics_with_them(tmp_path, follows):
    """Two slides of body 0 along its own axes: with the world first they count the other way, and so does all that is said of
    them; here in centimetres."""
    mimic = {
        True: ("transY", "J1", "rotX"),  # q_slide + 2 q_hinge - 5 = 0
        False: ("rotX", "J2", "transY"),
    }[follows]
    own, leader, axis = mimic
    said = (
        f" rel physxMimicJoint:{own}:referenceJoint = </{leader}>\n"
        f' uniform token physxMimicJoint:{own}:referenceJointAxis = "{axis}"\n'
        f" float physxMimicJoint:{own}:gearing = 2\n float physxMimicJoint:{own}:offset = -5\n"
    )
    drive = " float drive:transY:physics:targetVelocity = 7\n float drive:transY:physics:targetPosition = 3\n float drive:transY:physics:damping = 4\n"
    schema = f'"PhysxMimicJointAPI:{own}"'
    hinge = joint(
        "PhysicsRevoluteJoint", "J1", "" if follows else said, body1="/A", schemas="" if follows else schema
    )
    slides = generic(
        {"transX": (-30.0, 40.0), "transY": (-10.0, 80.0)},
        drive + (said if follows else ""),
        ", ".join(['"PhysicsDriveAPI:transY"', *([schema] if follows else [])]),
        body0="/B",
        body1="",
    )
    scene, report = scene_of(tmp_path, stage(body("A") + body("B") + hinge + slides, metres=0.01))
    assert scene is not None, report.diagnostics
    moved = next(j for j in scene.joints if j.id == "J2")
    freedom = moved.freedoms[TY]
    assert (freedom.lower, freedom.upper) == pytest.approx((-0.8, 0.1))
    assert (freedom.drive.target_velocity, freedom.drive.target) == pytest.approx((-0.07, -0.03))
    (coupling,) = scene.couplings
    (term,) = coupling.terms
    if follows:  # -q = -2 q_hinge + 5
        assert (term.ratio, coupling.offset) == pytest.approx((2.0 * 0.01 / DEGREE, -0.05))
    else:  # q_hinge = -2 (-q) + 5
        assert (term.ratio, coupling.offset) == pytest.approx((2.0 * DEGREE / 0.01, 5.0 * DEGREE))


def test_a_slide_that_follows_its_own_turn_is_a_screw_of_so_much_a_turn(tmp_path):
    """-0.03 cm for a degree is -0.108 m for a turn."""
    said = (
        " rel physxMimicJoint:transX:referenceJoint = </J2>\n"
        ' uniform token physxMimicJoint:transX:referenceJointAxis = "rotX"\n'
        " float physxMimicJoint:transX:gearing = 0.03\n"
    )
    ranges = {"transX": (-30.0, 40.0), "rotX": (-10.0, 80.0)}
    text = body("B") + generic(ranges, said, '"PhysxMimicJointAPI:transX"')
    found, scene, _ = joint_of(tmp_path, text, metres=0.01)
    assert found.kind is JointKind.SCREW and scene.couplings == []
    assert found.lead == pytest.approx(-0.03 * 0.01 * 360.0)


@pytest.mark.parametrize("target", [0, 20])
def test_a_target_without_gains_is_told_at_the_export(tmp_path, target):
    """A stage that states where to and no stiffness; one that states nothing drives nothing, and nobody need hear of it."""
    drive = (
        f'float drive:angular:physics:targetPosition = {target}\nuniform token physics:axis = "Y"\n{LIMITS}'
    )
    text = body("B") + joint("PhysicsRevoluteJoint", inside=drive, schemas='"PhysicsDriveAPI:angular"')
    path = tmp_path / "drive.usda"
    path.write_text(stage(text))
    report = kinefab.export(path, tmp_path / "drive.kinefab").report
    assert ("JOINT_DRIVE_IDLE" in {d.code for d in report.diagnostics}) is bool(target)
