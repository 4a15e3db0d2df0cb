"""What sources of robots state beside joints: colliders, dynamics, scaled bodies, sites, clips, passive springs; each in
Unity's terms, and told where the format has no place for it."""

from __future__ import annotations

import json
import math
import shutil
import subprocess
from dataclasses import replace

import kinefab
import numpy as np
import pytest
from kinefab.diagnostics import Outcome
from kinefab.model import (
    RX,
    RZ,
    TX,
    AnimationClip,
    Body,
    Collider,
    ColliderKind,
    Coupling,
    CouplingKind,
    Drive,
    Dynamics,
    Freedom,
    Joint,
    JointKind,
    MassProperties,
    Mesh,
    Motion,
    Node,
    Passive,
    PhysicsMaterial,
    Repeat,
    Scene,
    Site,
    SphericalDrive,
    Surface,
    Term,
    Texture,
    Wrap,
    Track,
    freedoms_of,
)
from kinefab.spatial import Pose, quaternion_from_matrix, rotation_about, rotation_exp
from kinefab.unity.back.scene_file import read_scene
from prefab_scenes import png

X, Y, Z = np.eye(3)
WEIGHT = MassProperties(2.0, np.array([0.1, 0.0, 0.0]), np.diag([0.01, 0.02, 0.02]))
CUBE = Mesh(
    "cube",
    np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)]) * 0.05,
    np.array(
        [
            [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
            [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3],
        ]
    ),
)  # fmt: skip


def arm(freedom: Freedom | None = None, **fields) -> Scene:
    """A part on a hinge to the world about +Z through its origin, at (1, 2, 3)."""
    at = Pose(np.eye(3), np.array([1.0, 2.0, 3.0]))
    frame = Pose(np.column_stack([Z, X, Y]), np.zeros(3))
    joint = Joint(
        "Hinge", JointKind.REVOLUTE, None, 0, at @ frame, frame,
        freedoms_of(JointKind.REVOLUTE, rx=freedom or Freedom(Motion.FREE)),
    )  # fmt: skip
    return Scene([Node("Arm", "Arm", pose=at, mass=WEIGHT, **fields)], [CUBE], joints=[joint])


def written(scene: Scene, tmp_path) -> tuple[dict, kinefab.ExportResult]:
    result = kinefab.export(scene, tmp_path / "scene.kinefab", kinefab.ExportOptions(ground="world"))
    if tool := shutil.which("dotnet-kinefab"):
        done = subprocess.run([tool, "validate", str(result.path), "--json"], capture_output=True, text=True)
        errors = [d for d in json.loads(done.stdout)["diagnostics"] if d["severity"] == "error"]
        assert errors == []
    return json.loads(result.path.read_text("utf-8")), result


def outcomes(result: kinefab.ExportResult, outcome: Outcome) -> set[str]:
    return {o.code for o in result.report.outcomes if o.outcome is outcome}


def component(content: dict, name: str, kind: str) -> dict:
    (found,) = [
        c for o in content["gameObjects"] if o["name"] == name for c in o["components"] if c["type"] == kind
    ]
    return found


def test_primitive_colliders_along_the_axes_need_no_object_of_their_own(tmp_path):
    """A box turned by 90 degrees about Z has its extents swapped; a capsule lies along the axis it is turned to."""
    shapes = (
        Collider(ColliderKind.BOX, Pose(rotation_about(Z, math.pi / 2), 0.1 * X), size=(0.1, 0.2, 0.3)),
        Collider(ColliderKind.SPHERE, Pose(np.eye(3), 0.2 * X + 0.3 * Z), radius=0.07),
        Collider(ColliderKind.CAPSULE, Pose(rotation_about(Y, math.pi / 2)), radius=0.01, length=0.2),
    )
    content, result = written(arm(colliders=shapes), tmp_path)
    assert len(content["gameObjects"]) == 1
    box = component(content, "Arm", "BoxCollider")
    assert box["center"] == [-0.1, 0, 0] and np.allclose(box["size"], [0.2, 0.1, 0.3])
    assert component(content, "Arm", "SphereCollider") == {
        "type": "SphereCollider", "center": [-0.2, 0, 0.3], "radius": 0.07,
    }  # fmt: skip
    capsule = component(content, "Arm", "CapsuleCollider")
    assert (capsule["direction"], capsule["height"], capsule["radius"]) == ("X", pytest.approx(0.22), 0.01)
    assert outcomes(result, Outcome.DROPPED) == set()


def test_turned_and_meshed_colliders_are_children_in_their_own_frames(tmp_path):
    turn = rotation_exp(np.array([0.3, -0.2, 0.5]))
    shapes = (
        Collider(ColliderKind.BOX, Pose(turn, 0.1 * X), size=(0.1, 0.2, 0.3), name="block"),
        Collider(ColliderKind.CYLINDER, Pose(turn, 0.2 * Y), radius=0.03, length=0.1, name="drum"),
        Collider(ColliderKind.MESH, Pose(turn, 0.3 * Z), mesh=0, scale=(1.0, 2.0, 3.0), name="net"),
    )
    content, result = written(arm(colliders=shapes), tmp_path)
    by_name = {o["name"]: o for o in content["gameObjects"]}
    mirrored = quaternion_from_matrix(turn) * [1, -1, -1, 1]
    for name, place in (("block", [-0.1, 0, 0]), ("drum", [0, 0.2, 0]), ("net", [0, 0, 0.3])):
        assert by_name[name]["parent"] == 0 and by_name[name]["id"] == f"Arm/collider:{name}"
        assert by_name[name]["transform"]["localPosition"] == place
        assert np.allclose(by_name[name]["transform"]["localRotation"], mirrored)
    assert by_name["net"]["transform"]["localScale"] == [1, 2, 3]
    drum = content["meshes"][component(content, "drum", "MeshCollider")["mesh"]]
    assert component(content, "drum", "MeshCollider")["convex"] is True
    assert np.allclose(drum["bounds"]["extents"], [0.03, 0.03, 0.05], atol=2e-4)
    assert outcomes(result, Outcome.APPROXIMATED) == {"COLLIDER_CYLINDER_AS_MESH", "COLLIDER_MESH_AS_HULL"}


def test_a_part_that_states_no_collider_at_all_has_none(tmp_path):
    body = Body("b", 0)
    assert any(
        "Collider" in c["type"]
        for c in written(arm(bodies=(body,)), tmp_path)[0]["gameObjects"][0]["components"]
    )
    content, _ = written(arm(bodies=(body,), colliders=()), tmp_path)
    assert not any("Collider" in c["type"] for c in content["gameObjects"][0]["components"])


def test_a_mesh_collider_stays_hollow_where_nothing_moves_it_by_force(tmp_path):
    shapes = (Collider(ColliderKind.MESH, mesh=0),)
    content, result = written(arm(colliders=shapes, dynamics=Dynamics(kinematic=True)), tmp_path)
    assert "convex" not in component(content, "Arm", "MeshCollider")
    assert component(content, "Arm", "Rigidbody")["isKinematic"] is True
    assert outcomes(result, Outcome.APPROXIMATED) == set()


@pytest.mark.parametrize("kind", [ColliderKind.HULL, ColliderKind.MESH, ColliderKind.PIECES])
def test_a_flat_collision_mesh_collides_as_the_box_about_it(tmp_path, kind):
    """As one does that the export chooses: a sheet that collides with nothing falls through the floor."""
    flat = replace(CUBE, vertices=CUBE.vertices * [1, 2, 0] + [0.3, 0, 0])
    shape = Collider(kind, mesh=0, name="sheet", trigger=True)
    content, result = written(replace(arm(colliders=(shape,)), meshes=[flat]), tmp_path)
    box = component(content, "Arm", "BoxCollider")
    low, high = flat.vertices.min(axis=0), flat.vertices.max(axis=0)
    assert box["size"] == pytest.approx(list(high - low)) and box["isTrigger"] is True
    assert box["center"] == pytest.approx([-0.5 * (low + high)[0], *(0.5 * (low + high))[1:]])
    assert outcomes(result, Outcome.APPROXIMATED) == {"COLLIDER_FLAT_AS_BOX"}
    assert outcomes(result, Outcome.DROPPED) == set()


def test_dynamics_of_a_body(tmp_path):
    dynamics = Dynamics(gravity=False, linear_damping=0.3, angular_damping=0.0, velocity=X)
    content, result = written(arm(dynamics=dynamics), tmp_path)
    body = component(content, "Arm", "Rigidbody")
    assert (body["useGravity"], body["linearDamping"], body["angularDamping"]) == (False, 0.3, 0)
    assert "BODY_VELOCITY_DROPPED" in outcomes(result, Outcome.DROPPED)


def test_scaled_and_placed_bodies_sites_and_layers(tmp_path):
    """A body away from its node's frame is a child with its pose and scale; a site is a child with nothing on it."""
    turn = rotation_about(Y, 0.4)
    body = Body("b", 0, pose=Pose(turn, 0.1 * X + 0.2 * Y), scale=(1.0, -2.0, 3.0), visible=False)
    site = Site("tip", Pose(np.eye(3), 0.5 * X))
    content, result = written(arm(bodies=(body,), sites=(site,), layer="robots", tag="arm"), tmp_path)
    child, tip = content["gameObjects"][1:]
    assert child["transform"]["localPosition"] == [-0.1, 0.2, 0]
    assert child["transform"]["localScale"] == [1, -2, 3]
    assert component(content, "b", "MeshRenderer")["enabled"] is False
    assert tip["id"] == "Arm/site:tip" and tip["transform"] == {"localPosition": [-0.5, 0, 0]}
    own = next(entry for entry in content["gameObjects"] if entry["id"] == "Arm")
    assert (own["layer"], own["tag"], content["version"]) == ("robots", "arm", "1.1")
    assert not any(o.code == "TARGET_FIELD_DROPPED" for o in result.report.outcomes)


def test_a_scaled_body_weighs_what_it_is(tmp_path):
    """A cube of 0.1 m stretched to 0.1 x 0.2 x 0.3 and turned, away from the origin."""
    body = Body(
        "b", 0, density=1000.0, pose=Pose(rotation_about(Z, math.pi / 2), 0.4 * X), scale=(1.0, 2.0, 3.0)
    )
    scene = arm(bodies=(body,))
    scene.nodes[0] = replace(scene.nodes[0], mass=None)
    content, _ = written(scene, tmp_path)
    rigid = component(content, "Arm", "Rigidbody")
    assert rigid["mass"] == pytest.approx(6.0) and np.allclose(rigid["centerOfMass"], [-0.4, 0, 0])
    squares = [0.5 * (0.04 + 0.09), 0.5 * (0.01 + 0.09), 0.5 * (0.04 + 0.01)]  # m / 12 = 0.5
    assert sorted(rigid["inertiaTensor"]) == pytest.approx(sorted(squares))


def test_passive_springs_join_the_drive_and_the_rest_is_told(tmp_path):
    """k (t - q) of both: 30 at 0.2 and 10 at -0.2 rad are 40 at 0.1 rad, and their dampers add up."""
    passive = Passive(10.0, -0.2, 1.5, friction=0.3, armature=0.01)
    freedom = Freedom(Motion.FREE, drive=Drive(0.2, 0.0, 30.0, 2.0), passive=passive)
    content, result = written(arm(freedom), tmp_path)
    spring = component(content, "Arm", "HingeJoint")["spring"]
    assert spring == {"spring": 40, "damper": 3.5, "targetPosition": pytest.approx(math.degrees(0.1))}
    hinge = component(content, "Arm", "HingeJoint")
    assert (hinge["friction"], hinge["armature"]) == (0.3, 0.01)
    assert outcomes(result, Outcome.DROPPED) == set()
    turning = Freedom(Motion.FREE, drive=Drive(0.0, 1.4, 0.0, 2.0), passive=passive)
    joint = component(written(arm(turning), tmp_path)[0], "Arm", "ConfigurableJoint")
    assert joint["angularXDrive"]["positionDamper"] == 3.5  # 2 at 1.4 rad/s and 1.5 at rest are 3.5 at 0.8
    assert abs(joint["targetAngularVelocity"][0]) == pytest.approx(0.8)


def test_what_cannot_be_added_to_a_motor_is_told(tmp_path):
    motor = Drive(target_velocity=1.0, max_force=5.0, motor=True)
    freedom = Freedom(Motion.FREE, drive=motor, passive=Passive(damping=1.0))
    assert "JOINT_PASSIVE_DROPPED" in outcomes(written(arm(freedom), tmp_path)[1], Outcome.DROPPED)
    limited = Freedom(Motion.FREE, drive=Drive(0.2, 0.0, 30.0), passive=Passive(speed=3.0))
    assert component(written(arm(limited), tmp_path)[0], "Arm", "HingeJoint")["speed"] == pytest.approx(math.degrees(3.0))
    limited = Freedom(Motion.FREE, passive=Passive(effort=20.0, speed=3.0))
    content, result = written(arm(limited), tmp_path)
    assert component(content, "Arm", "HingeJoint")["effort"] == 20
    assert "JOINT_EFFORT_DROPPED" not in outcomes(result, Outcome.DROPPED)


def test_a_joint_that_is_switched_off_or_collides(tmp_path):
    scene = arm()
    scene.joints[0] = replace(scene.joints[0], collide=True)
    assert component(written(scene, tmp_path)[0], "Arm", "HingeJoint")["enableCollision"] is True
    scene.joints[0] = replace(scene.joints[0], enabled=False)
    content, result = written(scene, tmp_path)
    assert component(content, "Arm", "HingeJoint")["enabled"] is False
    assert "JOINT_DISABLED" in outcomes(result, Outcome.KEPT)


def test_clips_are_mirrored_key_by_key(tmp_path):
    turns = np.array([[0.0, 0.0, 0.0, 1.0], [math.sin(0.4), 0.0, 0.0, math.cos(0.4)]])
    track = Track(0, np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]), turns)
    scene = arm()
    scene.animations.append(AnimationClip("wave", np.array([0.0, 0.5]), (track,), Repeat.PING_PONG))
    (clip,) = written(scene, tmp_path)[0]["animations"]
    assert (clip["name"], clip["times"], clip["wrapMode"]) == ("wave", [0, 0.5], "PingPong")
    assert clip["tracks"][0]["localPosition"] == [[-1, 2, 3], [-4, 5, 6]]
    assert np.allclose(clip["tracks"][0]["localRotation"][1], [math.sin(0.4), 0, 0, math.cos(0.4)])


def test_textures_physics_materials_and_sums_are_carried(tmp_path):
    """An image once for each colour space, byte for byte; a coupling of several terms is one."""
    rubber = PhysicsMaterial("rubber", 0.9, 1.0)
    scene = arm(
        bodies=(Body("b", 0, (0,)),),
        colliders=(Collider(ColliderKind.BOX, size=(0.1, 0.1, 0.1), material=rubber),),
    )
    image = png(tmp_path / "paint.png", np.zeros((2, 2, 4), np.uint8)).read_bytes()
    texture = Texture("paint.png", data=image, wrap=Wrap.CLAMP, uv_set=1, scale=(2.0, 3.0), rotation=math.pi / 6)
    plain = Texture("paint.png", data=image)
    shown = {"color_texture": texture, "emission_texture": plain, "occlusion_texture": plain}
    scene.surfaces.append(Surface("paint", (1.0, 1.0, 1.0, 0.5), emission=(0.0, 0.5, 2.0), **shown))
    slide = Joint("Slide", JointKind.PRISMATIC, None, 1, Pose(), Pose(), freedoms_of(JointKind.PRISMATIC))
    scene.nodes.append(Node("Cart", "Cart", mass=WEIGHT))
    swing = replace(scene.joints[0], id="Swing", b=2)
    scene.nodes.append(replace(scene.nodes[0], id="Arm2", name="Arm2", colliders=()))
    scene.joints += [slide, swing]
    terms = (Term("Hinge", RX, 0.1), Term("Swing", RX, -0.2))
    scene.couplings.append(Coupling("Sum", CouplingKind.LINEAR, "Slide", TX, terms))
    content, result = written(scene, tmp_path)
    stated = content["couplings"][0]["terms"]
    assert [content["gameObjects"][term["coordinate"]["gameObject"]]["id"] for term in stated] == ["Arm", "Arm2"]
    assert [term["ratio"] for term in stated] == pytest.approx([0.1 * math.pi / 180, -0.2 * math.pi / 180])
    assert content["analysis"]["mobility"] == 2
    (coupling,) = result.unity.couplings
    assert [t.ratio for t in coupling.terms] == pytest.approx([0.1 * math.pi / 180, -0.2 * math.pi / 180])
    assert outcomes(result, Outcome.DROPPED) == set()
    assert content["physicsMaterials"] == [{"name": "rubber", "dynamicFriction": 0.9, "staticFriction": 1}]
    assert component(content, "Arm", "BoxCollider")["material"] == 0
    shown = content["materials"][-1]
    assert shown["colorTexture"] == {"image": 0, "uvSet": 1, "wrap": "clamp", "scale": [2, 3], "rotation": 30}
    assert (shown["emissionTexture"], shown["occlusionTexture"]) == ({"image": 0}, {"image": 1})
    assert shown["emission"] == [0, 0.5, 2] and "alphaMode" not in shown
    assert [i.get("colorSpace", "sRGB") for i in content["images"]] == ["sRGB", "linear"]
    _, (buffer,) = read_scene(result.path)
    for entry in content["images"]:
        assert buffer[entry["data"]["offset"] :][: entry["byteLength"]] == image


@pytest.mark.parametrize("on_b", [True, False])
def test_a_slerp_drive_turns_to_its_target(tmp_path, on_b):
    """The drive's target, seen in the C# solver: after five seconds b's frame stands in a's as asked."""
    target = rotation_exp(np.array([0.4, -0.7, 0.3]))
    frame_a = Pose(rotation_exp(np.array([0.2, 0.1, -0.4])), np.array([1.0, 2.0, 3.0]))
    start = rotation_exp(np.array([-0.2, 0.3, 0.1]))
    frame_b = Pose(rotation_exp(np.array([0.5, 0.6, -0.1])), np.zeros(3))
    world_b = frame_a @ Pose(start, np.zeros(3)) @ frame_b.inverse()
    drive = SphericalDrive(target, np.zeros(3), 400.0, 60.0)
    weight = MassProperties(1.0, np.zeros(3), np.eye(3) * 0.1)
    ball = freedoms_of(JointKind.SPHERICAL)
    base = Node("Base", "Base", grounded=True)
    node = Node("Ball", "Ball", pose=world_b, mass=weight, dynamics=Dynamics(gravity=False))
    sides = (None, 1, frame_a, frame_b) if on_b else (1, 0, frame_b, frame_a)
    wanted = drive if on_b else replace(drive, target=target.T)
    scene = Scene([base, node], joints=[Joint("J", JointKind.SPHERICAL, *sides, ball, slerp=wanted)])
    content, _ = written(scene, tmp_path)
    joint = component(content, "Ball", "ConfigurableJoint")
    assert joint["rotationDriveMode"] == "Slerp" and joint["slerpDrive"]["positionSpring"] == 400
    if (tool := shutil.which("dotnet-kinefab")) is None:
        pytest.skip("dotnet-kinefab is not on the PATH")
    out = tmp_path / "motion.json"
    command = [
        tool,
        "simulate",
        str(tmp_path / "scene.kinefab"),
        "--seconds",
        "5",
        "--solver",
        "unity",
        "-o",
        str(out),
    ]
    subprocess.run(command, check=True, capture_output=True)
    reached = np.array(last_rotation(json.loads(out.read_text("utf-8")), "Ball"))
    expected = quaternion_from_matrix((frame_a @ Pose(target, np.zeros(3)) @ frame_b.inverse()).rotation)
    assert abs(abs(reached @ (expected * [1, -1, -1, 1])) - 1.0) < 1e-6


def last_rotation(motion: dict, name: str) -> list[float]:
    """The rotation of a body at the end of a run of the C# tool."""
    number = next(i for i, body in enumerate(motion["bodies"]) if body["id"].endswith(name))
    return motion["bodies"][number]["poses"][-1][3:]


def test_a_slerp_drive_on_less_than_a_ball_is_told(tmp_path):
    freedoms = tuple(Freedom(Motion.FREE) if i in (RX, RZ) else Freedom() for i in range(6))
    scene = arm()
    drive = SphericalDrive(np.eye(3), np.zeros(3), 1.0)
    scene.joints[0] = replace(scene.joints[0], kind=JointKind.UNIVERSAL, freedoms=freedoms, slerp=drive)
    assert "JOINT_SLERP_LOCKED" in outcomes(written(scene, tmp_path)[1], Outcome.APPROXIMATED)


def test_a_target_that_needs_a_library_and_options_of_others_are_told(tmp_path, monkeypatch):
    import kinefab.targets as targets

    made = targets.Target("Toy", (".toy",), "kinefab_file", requires=("no_such_library",), extra="usd")
    monkeypatch.setattr(targets, "TARGETS", (*targets.TARGETS, made))
    with pytest.raises(kinefab.KinefabError) as caught:
        kinefab.export(arm(), tmp_path / "x.toy")
    assert caught.value.diagnostics[0].code == "TARGET_LIBRARY_MISSING"
    options = kinefab.ExportOptions(writing={"pipeline": "urp"})
    found = kinefab.export(arm(), tmp_path / "x.kinefab", options).report
    assert [d.code for d in found.diagnostics].count("TARGET_OPTION_UNUSED") == 1
