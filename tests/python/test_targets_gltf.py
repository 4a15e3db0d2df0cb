"""glTF: what an independent reader finds in the file is the model, right-handed and unmirrored; Khronos' validator agrees."""

from __future__ import annotations

import json
import math
import shutil
import struct
import subprocess
import zlib
from dataclasses import replace
from pathlib import Path

import kinefab
import numpy as np
import pytest
import trimesh
from golden import golden_pairs
from kinefab.diagnostics import Outcome
from kinefab.geometry.primitives import box, sphere
from kinefab.model import (
    RX,
    TX,
    AlphaMode,
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
    Motion,
    Node,
    PhysicsMaterial,
    Scene,
    Surface,
    Term,
    Texture,
    Track,
    freedoms_of,
)
from kinefab.spatial import Pose, matrix_from_quaternion, rotation_about, rotation_exp
from test_unity_mapping import CUBE

BODIES = "KHR_physics_rigid_bodies"


def png(size: int) -> bytes:
    """A grey square."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = (b"\0" + bytes([128]) * size) * size
    header = struct.pack(">IIBBBBB", size, size, 8, 0, 0, 0, 0)
    parts = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + parts


PNG = png(4)
VALIDATOR = Path(__file__).resolve().parents[1] / "reference" / "node_modules" / "gltf-validator"


def parsed(path: Path) -> tuple[dict, bytes]:
    data = path.read_bytes()
    magic, version, length, size, kind = struct.unpack_from("<IIIII", data)
    assert (magic, version, length, kind) == (0x46546C67, 2, len(data), 0x4E4F534A) and length % 4 == 0
    document = json.loads(data[20 : 20 + size])
    return document, data[28 + size :]


def world(document: dict, index: int) -> np.ndarray:
    """4 x 4 pose of a node, from the file alone."""
    parents = {child: i for i, node in enumerate(document["nodes"]) for child in node.get("children", ())}
    node = document["nodes"][index]
    own = np.eye(4)
    own[:3, :3] = matrix_from_quaternion(np.array(node.get("rotation", (0, 0, 0, 1)))) * node.get(
        "scale", (1, 1, 1)
    )
    own[:3, 3] = node.get("translation", (0, 0, 0))
    return own if index not in parents else world(document, parents[index]) @ own


def accessor(document: dict, binary: bytes, index: int) -> np.ndarray:
    entry = document["accessors"][index]
    view = document["bufferViews"][entry["bufferView"]]
    kind = {5126: "<f4", 5123: "<u2", 5125: "<u4"}[entry["componentType"]]
    columns = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[entry["type"]]
    return np.frombuffer(binary, kind, entry["count"] * columns, view["byteOffset"]).reshape(-1, columns)


_ASKEW = rotation_exp(np.array([0.2, 0.1, -0.3]))
INERTIA = _ASKEW @ np.diag([0.01, 0.02, 0.025]) @ _ASKEW.T
VELOCITY, SPIN = np.array([0.5, -1.0, 2.0]), np.array([-0.3, 0.4, 0.1])


def robot() -> Scene:
    """A cart on a rail with an arm: a slide with a motor, a hinge of -10..80 degrees with a servo, everything asymmetric."""
    turn = rotation_exp(np.array([0.3, -0.2, 0.5]))
    cart = Pose(turn, np.array([1.0, 2.0, 3.0]))
    arm = cart @ Pose(rotation_about(np.array([0.0, 0, 1]), 0.4), np.array([0.1, 0.2, 0.3]))
    weight = MassProperties(2.0, np.array([0.1, 0.0, -0.2]), INERTIA)
    paint = Surface(
        "paint", (0.5, 0.25, 0.125, 0.5), 0.25, 0.75, AlphaMode.MASK, 0.3, True, (2.0, 0.0, 1.0),
        color_texture=Texture("a.png", data=PNG, offset=(0.25, 0.5), scale=(2.0, 3.0), rotation=0.1),
        normal_texture=Texture("b.bmp", data=b"BM..."),
    )  # fmt: skip
    uv = np.linspace(0.0, 1.0, 16).reshape(8, 2)
    mesh = kinefab.model.Mesh("cube", CUBE.vertices, CUBE.faces, uvs=(uv,), face_counts=(4, 8))
    rubber = PhysicsMaterial("rubber", 0.9, 1.0, 0.1)
    shapes = (
        Collider(
            ColliderKind.CAPSULE,
            Pose(turn, np.array([0.0, 0.1, 0.0])),
            radius=0.02,
            length=0.3,
            material=rubber,
        ),
        Collider(ColliderKind.BOX, size=(0.1, 0.2, 0.3), trigger=True),
        Collider(ColliderKind.MESH, mesh=0, scale=(1.0, 2.0, 1.0)),
    )
    nodes = [
        Node("Rail", "Rail", grounded=True, bodies=(Body("b", 0),)),
        Node("Cart", "Cart", pose=cart, mass=weight, bodies=(Body("b", 0, (0, 0), scale=(1.0, -1.0, 2.0)),)),
        Node(
            "Arm",
            "Arm",
            parent=1,
            pose=arm,
            mass=weight,
            colliders=shapes,
            dynamics=Dynamics(gravity=False, velocity=VELOCITY, angular_velocity=SPIN),
        ),
    ]
    slide = Freedom(Motion.FREE, drive=Drive(target_velocity=0.3, max_force=5.0, motor=True))
    servo = Drive(0.2, 0.0, 30.0, 4.0, 7.0)
    hinge = Freedom(Motion.LIMITED, math.radians(-10), math.radians(80), servo, restitution=0.5)
    at = Pose(rotation_exp(np.array([-0.3, 0.1, 0.2])), np.array([0.05, 0.0, 0.1]))
    joints = [
        Joint(
            "Slide", JointKind.PRISMATIC, None, 1, cart @ at, at, freedoms_of(JointKind.PRISMATIC, tx=slide)
        ),
        Joint(
            "Hinge",
            JointKind.REVOLUTE,
            1,
            2,
            cart.inverse() @ arm @ at,
            at,
            freedoms_of(JointKind.REVOLUTE, rx=hinge),
            collide=True,
        ),
    ]
    track = Track(2, np.array([[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]]))
    clip = AnimationClip("wave", np.array([0.0, 0.5]), (track,))
    coupling = Coupling("C", CouplingKind.RACK, "Slide", TX, (Term("Hinge", RX, 0.1),))
    return Scene(nodes, [mesh], [paint], joints, [coupling], animations=[clip])


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    path = tmp_path_factory.mktemp("glb") / "robot.glb"
    result = kinefab.export(robot(), path)
    return (*parsed(path), result)


def test_nodes_stand_where_the_model_has_them(exported):
    document, _, result = exported
    for node in result.analysed.scene.nodes:
        index = next(i for i, n in enumerate(document["nodes"]) if n.get("extras", {}).get("id") == node.id)
        found = world(document, index)
        assert np.allclose(found[:3, :3], node.pose.rotation) and np.allclose(
            found[:3, 3], node.pose.translation
        )


def test_meshes_are_unmirrored_and_share_their_arrays(exported):
    document, binary, _ = exported
    primitives = [p for mesh in document["meshes"] for p in mesh["primitives"]]
    assert len({p["attributes"]["POSITION"] for p in primitives}) == 1
    first = next(m for m in document["meshes"] if len(m["primitives"]) == 2)
    points = accessor(document, binary, first["primitives"][0]["attributes"]["POSITION"])
    faces = [accessor(document, binary, p["indices"]).reshape(-1, 3) for p in first["primitives"]]
    corners = np.vstack(faces)
    assert [len(f) for f in faces] == [4, 8] and np.allclose(points[corners], CUBE.vertices[CUBE.faces])
    uv = accessor(document, binary, first["primitives"][0]["attributes"]["TEXCOORD_0"])
    assert np.allclose(uv[corners][..., 1], 1.0 - np.linspace(0.0, 1.0, 16).reshape(8, 2)[CUBE.faces][..., 1])


@pytest.mark.parametrize("smooth, hard", [(30.0, True), (None, False)])
def test_normals_are_made_where_the_source_has_none(tmp_path, smooth, hard):
    """A cube's corners have three each; without any, programs show a turned part faceted, or a box as a ball."""
    scene = kinefab.Scene()
    scene.add_part("Cube", trimesh.Trimesh(CUBE.vertices, CUBE.faces, process=False))
    kinefab.export(scene, tmp_path / "a.glb", kinefab.ExportOptions(smooth=smooth))
    document, binary = parsed(tmp_path / "a.glb")
    attributes = document["meshes"][0]["primitives"][0]["attributes"]
    assert ("NORMAL" in attributes) is hard
    if hard:
        normals = accessor(document, binary, attributes["NORMAL"])
        assert len(normals) == 24 and np.allclose(np.abs(normals).max(axis=1), 1.0)


def test_material_and_its_image(exported):
    document, binary, result = exported
    paint = next(m for m in document["materials"] if m["name"] == "paint")
    shading = paint["pbrMetallicRoughness"]
    assert shading["baseColorFactor"] == [0.5, 0.25, 0.125, 0.5]
    assert (shading["metallicFactor"], shading["roughnessFactor"]) == (0.25, 0.25)
    assert (paint["alphaMode"], paint["alphaCutoff"], paint["doubleSided"]) == ("MASK", 0.3, True)
    assert paint["emissiveFactor"] == [1.0, 0.0, 0.5]
    view = document["bufferViews"][document["images"][0]["bufferView"]]
    assert binary[view["byteOffset"] :][: view["byteLength"]] == PNG and len(document["images"]) == 1
    assert "TEXTURE_DROPPED" in {o.code for o in result.report.outcomes if o.outcome is Outcome.DROPPED}
    # A corner of the picture, by the model's rule and by glTF's, both seen with v downwards.
    moved = shading["baseColorTexture"]["extensions"]["KHR_texture_transform"]
    u, v = 0.3, 0.8
    s, c = math.sin(0.1), math.cos(0.1)
    model = np.array([c * 2 * u - s * 3 * v + 0.25, 1 - (s * 2 * u + c * 3 * v + 0.5)])
    s, c = math.sin(moved["rotation"]), math.cos(moved["rotation"])
    x, y = moved["scale"][0] * u, moved["scale"][1] * (1 - v)
    assert np.allclose(model, np.array([c * x + s * y, -s * x + c * y]) + moved["offset"])


def test_bodies_weigh_what_the_model_says(exported):
    document, _, _ = exported
    cart = next(n for n in document["nodes"] if n["name"] == "Cart")["extensions"][BODIES]["motion"]
    arm = next(n for n in document["nodes"] if n["name"] == "Arm")["extensions"][BODIES]["motion"]
    assert cart["mass"] == 2.0 and cart["centerOfMass"] == [0.1, 0.0, -0.2]
    turn = matrix_from_quaternion(np.array(cart["inertiaOrientation"]))
    assert np.allclose(turn @ np.diag(cart["inertiaDiagonal"]) @ turn.T, INERTIA)
    here = world(document, next(i for i, n in enumerate(document["nodes"]) if n["name"] == "Arm"))[:3, :3]
    assert np.allclose(here @ arm["linearVelocity"], VELOCITY) and np.allclose(
        here @ arm["angularVelocity"], SPIN
    )
    assert arm["gravityFactor"] == 0.0 and "gravityFactor" not in cart


def test_joint_frames_meet_and_limits_are_of_b_in_a(exported):
    """The joint's node is a's frame, the connected one b's; both are where the model has them in the world."""
    document, _, _ = exported
    joints = {
        n["name"]: (i, n["extensions"][BODIES]["joint"])
        for i, n in enumerate(document["nodes"])
        if "joint" in n.get("extensions", {}).get(BODIES, {})
    }
    described = document["extensions"][BODIES]["physicsJoints"]
    index, hinge = joints["Hinge a"]
    assert (
        np.allclose(world(document, index), world(document, hinge["connectedNode"]))
        and hinge["enableCollision"]
    )
    limits = described[hinge["joint"]]["limits"]
    assert {"linearAxes": [0, 1, 2], "min": 0.0, "max": 0.0} in limits
    assert {"angularAxes": [1, 2], "min": 0.0, "max": 0.0} in limits
    (own,) = (limit for limit in limits if limit.get("angularAxes") == [0])
    assert (own["min"], own["max"]) == pytest.approx((math.radians(-10), math.radians(80)))
    (servo,) = described[hinge["joint"]]["drives"]
    assert servo == {
        "type": "angular", "mode": "force", "axis": 0, "positionTarget": 0.2, "velocityTarget": 0.0,
        "stiffness": 30.0, "damping": 4.0, "maxForce": 7.0,
    }  # fmt: skip
    _, slide = joints["Slide a"]
    (motor,) = described[slide["joint"]]["drives"]
    assert (motor["type"], motor["velocityTarget"], motor["maxForce"]) == ("linear", 0.3, 5.0)


def test_the_ground_of_a_joint_is_a_kinematic_body(tmp_path):
    """A part or the world: Babylon.js with Havok, which joins bodies alone, loaded no file whose joint began at what has no motion."""
    scene = kinefab.Scene()
    base, arm, door, _ = (
        scene.add_part(name, trimesh.creation.box((1, 2, 3)), translation=at, grounded=grounded)
        for name, at, grounded in (
            ("Base", (0, 0, 0), True), ("Arm", (0, 3, 0), False), ("Door", (5, 0, 0), False), ("Rack", (9, 0, 0), True),
        )
    )  # fmt: skip
    scene.add_hinge(base, arm, point=(0, 1.5, 0), axis=(0, 0, 1), limits=(-10, 80))
    scene.add_hinge(None, door, point=(5, 0, 0), axis=(0, 1, 0))
    kinefab.export(scene, tmp_path / "a.glb")
    document, _ = parsed(tmp_path / "a.glb")
    motions = {
        n["name"]: n["extensions"][BODIES]["motion"].get("isKinematic", False)
        for n in document["nodes"]
        if "motion" in n.get("extensions", {}).get(BODIES, {})
    }
    world_side = next(
        n["name"] for n in document["nodes"] if n["name"].endswith(" a") and n["name"] in motions
    )
    assert motions == {"Base": True, "Arm": False, "Door": False, world_side: True}


def test_a_document_with_colliders_alone_says_that_it_has_physics(tmp_path):
    """Without joints, materials and shapes too: readers look at the document's own extensions first."""
    scene = kinefab.Scene()
    scene.add_part("Stone", trimesh.creation.box((1, 2, 3)))
    kinefab.export(scene, tmp_path / "a.glb")
    assert parsed(tmp_path / "a.glb")[0]["extensions"] == {BODIES: {}}


def test_a_joint_that_leaves_all_free_has_an_empty_list_of_limits(tmp_path):
    scene = Scene([Node(n, n, mass=MassProperties(1.0, np.zeros(3), INERTIA)) for n in "AB"])
    free = {name: Freedom(Motion.FREE) for name in ("tx", "ty", "tz", "rx", "ry", "rz")}
    of = freedoms_of(
        JointKind.GENERAL,
        **free | {"rz": Freedom(Motion.FREE, drive=Drive(0.2, 0.0, 30.0, 4.0))},
    )
    scene.joints = [Joint("J", JointKind.GENERAL, 0, 1, Pose(), Pose(), of)]
    kinefab.export(scene, tmp_path / "a.glb")
    (joint,) = parsed(tmp_path / "a.glb")[0]["extensions"][BODIES]["physicsJoints"]
    assert joint["limits"] == [] and len(joint["drives"]) == 1


def test_bodies_that_are_fixed_beside_each_other_meet_as_they_stand(tmp_path):
    scene = Scene(meshes=[box((1, 2, 3))])
    poses = [Pose(rotation_exp(np.array(turn)), np.array(at)) for turn, at in (
        ((0.3, -0.2, 0.5), (1.0, 2.0, 3.0)), ((-0.4, 0.6, 0.1), (4.0, 0.5, -1.0)),
    )]  # fmt: skip
    scene.nodes = [Node(name, name, pose=pose, bodies=(Body("b", 0),)) for name, pose in zip("AB", poses)]
    meets = poses[1].inverse() @ poses[0]
    scene.joints = [Joint("F", JointKind.FIXED, 0, 1, Pose(), meets, freedoms_of(JointKind.FIXED))]
    kinefab.export(scene, tmp_path / "a.glb")
    document, _ = parsed(tmp_path / "a.glb")
    (joint,) = (
        (i, n["extensions"][BODIES]["joint"])
        for i, n in enumerate(document["nodes"])
        if "joint" in n.get("extensions", {}).get(BODIES, {})
    )
    assert np.allclose(world(document, joint[0]), world(document, joint[1]["connectedNode"]))


def test_shapes_lie_along_y_and_are_turned_to_their_axis(exported):
    document, _, _ = exported
    shapes = document["extensions"]["KHR_implicit_shapes"]["shapes"]
    index, capsule = next((i, n) for i, n in enumerate(document["nodes"]) if n["name"] == "capsule")
    entry = capsule["extensions"][BODIES]["collider"]
    assert shapes[entry["geometry"]["shape"]] == {
        "type": "capsule",
        "capsule": {"height": 0.3, "radiusTop": 0.02, "radiusBottom": 0.02},
    }
    arm = next(i for i, n in enumerate(document["nodes"]) if n["name"] == "Arm")
    along = np.linalg.inv(world(document, arm)) @ world(document, index)
    assert np.allclose(along[:3, 1], rotation_exp(np.array([0.3, -0.2, 0.5]))[:, 2])
    assert "trigger" in next(n for n in document["nodes"] if n["name"] == "box")["extensions"][BODIES]
    mesh = next(n for n in document["nodes"] if n["name"] == "mesh")["extensions"][BODIES]["collider"][
        "geometry"
    ]
    assert mesh["convexHull"] is True and "mesh" in document["nodes"][mesh["node"]]


def test_clips_and_losses(exported):
    document, binary, result = exported
    (clip,) = document["animations"]
    assert accessor(document, binary, clip["samplers"][0]["output"]).tolist()[1] == pytest.approx(
        [0.4, 0.5, 0.6]
    )
    assert accessor(document, binary, clip["samplers"][0]["input"]).ravel().tolist() == [0.0, 0.5]
    dropped = {o.code for o in result.report.outcomes if o.outcome is Outcome.DROPPED}
    assert {"COUPLING_DROPPED", "TARGET_FIELD_DROPPED"} <= dropped


@pytest.mark.parametrize("gap", [0.0, 1e-9])
def test_a_step_between_two_keys_stays_one_in_32_bits(tmp_path, gap):
    """glTF's times rise; two keys that 32 bits hold at one time made a file that validators refuse."""
    slide = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [5.0, 0.0, 0.0], [6.0, 0.0, 0.0]])
    clip = AnimationClip("step", np.array([0.0, 100.0, 100.0 + gap, 200.0]), (Track(0, slide),))
    kinefab.export(Scene([Node("A", "A")], animations=[clip]), tmp_path / "a.glb")
    document, binary = parsed(tmp_path / "a.glb")
    times = accessor(document, binary, document["animations"][0]["samplers"][0]["input"]).ravel()
    assert (np.diff(times) > 0.0).all() and np.allclose(times, clip.times, rtol=1e-6)


def test_same_scene_same_bytes_and_a_reader_of_others_takes_it(tmp_path):
    first, second = (kinefab.export(robot(), tmp_path / name).path for name in ("a.glb", "b.glb"))
    assert first.read_bytes() == second.read_bytes()
    loaded = trimesh.load(str(first), force="scene")
    assert (
        np.allclose(loaded.bounds[0], trimesh.load(str(second), force="scene").bounds[0])
        and len(loaded.geometry) >= 2
    )


def test_a_suppressed_part_is_told(tmp_path):
    scene = robot()
    scene.nodes.append(Node("Spare", "Spare", suppressed=True, bodies=(Body("b", 0),)))
    result = kinefab.export(scene, tmp_path / "spare.glb")
    assert "COMPONENT_SUPPRESSED_DROPPED" in {o.code for o in result.report.outcomes}


CHECK = """
const fs = require("fs"), validator = require(process.argv[1]);
(async () => {
  for (const file of process.argv.slice(2)) {
    const found = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {maxIssues: 50});
    const bad = found.issues.messages.filter((issue) => issue.severity < 2);
    console.log(JSON.stringify({file, bad}));
  }
})();
"""


def awkward() -> Scene:
    """Places that are another mesh's normals, a normal map on a mesh without tangents, an image on one without coordinates."""
    image = Texture("Bumps", data=png(4))
    bumpy = Surface("Bumpy", normal_texture=image)
    rough = Surface("Rough", color_texture=image, metallic_roughness_texture=replace(image, uv_set=1))
    scene = Scene(surfaces=[bumpy, rough])
    for i, mesh in enumerate((sphere(2.0), sphere(1.0), box((1, 2, 3)), replace(box((1, 2, 3)), uvs=()))):
        scene.meshes.append(mesh)
        scene.nodes.append(Node(f"P{i}", f"P{i}", bodies=(Body("b", i, (i % 2,)),)))
    return scene


def test_what_a_mesh_lacks_its_material_does_not_show(tmp_path):
    result = kinefab.export(awkward(), tmp_path / "awkward.glb")
    document, _ = parsed(tmp_path / "awkward.glb")
    shown = [m["primitives"][0] for m in document["meshes"]]
    assert all("TANGENT" in one["attributes"] for one in (shown[0], shown[2]))
    rough, bare = (document["materials"][shown[i]["material"]] for i in (1, 3))
    assert "baseColorTexture" in rough["pbrMetallicRoughness"] and "pbrMetallicRoughness" in bare
    assert not any("Texture" in key for key in bare["pbrMetallicRoughness"])
    assert "metallicRoughnessTexture" not in rough["pbrMetallicRoughness"]
    assert {o.code for o in result.report.outcomes if o.outcome is Outcome.DROPPED} == {"TEXTURE_DROPPED"}


def test_tangents_run_along_u_and_their_sense_is_that_of_v(tmp_path):
    kinefab.export(awkward(), tmp_path / "awkward.glb")
    document, binary = parsed(tmp_path / "awkward.glb")
    primitive = document["meshes"][2]["primitives"][0]
    values = {key: accessor(document, binary, number) for key, number in primitive["attributes"].items()}
    corners = accessor(document, binary, primitive["indices"]).reshape(-1, 3)
    for a, b, c in corners:
        edges = values["POSITION"][[b, c]] - values["POSITION"][a]
        steps = values["TEXCOORD_0"][[b, c]] - values["TEXCOORD_0"][a]
        along_u, along_v = np.linalg.solve(steps * [1, -1], edges)  # v upwards, as the normal map's green is
        tangent = values["TANGENT"][a]
        assert np.allclose(tangent[:3], along_u / np.linalg.norm(along_u), atol=1e-6)
        bitangent = np.cross(values["NORMAL"][a], tangent[:3]) * tangent[3]
        assert np.allclose(bitangent, along_v / np.linalg.norm(along_v), atol=1e-6)


@pytest.mark.parametrize("shape", ["auto", "none", "hull", "box", "mesh"])
def test_colliders_are_those_that_were_asked_for(tmp_path, shape):
    middle = [0.3, -0.2, 0.5]
    scene = Scene(meshes=[replace(box((1, 2, 3)), vertices=box((1, 2, 3)).vertices + middle)])
    scene.nodes = [
        Node("P", "P", bodies=(Body("b", 0),)),
        Node("G", "G", grounded=True, bodies=(Body("b", 0),)),
    ]
    scene.nodes.append(
        Node(
            "E",
            "E",
            colliders=(Collider(ColliderKind.SPHERE, radius=0.0), Collider(ColliderKind.SPHERE, radius=1.0)),
        )
    )
    options = kinefab.ExportOptions(colliders=kinefab.ColliderShape(shape))
    result = kinefab.export(scene, tmp_path / "a.glb", options)
    document, _ = parsed(tmp_path / "a.glb")
    found = [
        n["extensions"][BODIES]["collider"]["geometry"]
        for n in document["nodes"]
        if "collider" in n.get("extensions", {}).get(BODIES, {})
    ]
    shapes = [s.get("box", s.get("sphere")) for s in document["extensions"]["KHR_implicit_shapes"]["shapes"]]
    hulls = {"auto": [True, False], "mesh": [True, False], "hull": [True, True]}.get(shape, [])
    assert [g.get("convexHull", False) for g in found if "node" in g] == hulls
    assert shapes == ([{"size": [1, 2, 3]}] if shape == "box" else []) + [{"radius": 1.0}]
    around = [n["translation"] for n in document["nodes"] if n["name"] == "box"]
    assert np.allclose(around, [middle] * 2 if shape == "box" else [])
    assert [o.code for o in result.report.outcomes if o.code == "COLLIDER_EMPTY"] == ["COLLIDER_EMPTY"]


@pytest.mark.parametrize("shape", ["auto", "box"])
def test_what_is_not_drawn_collides_all_the_same(tmp_path, shape):
    """As in a prefab, where its renderer alone is off; the mesh that collides is no node's of the scene."""
    scene = Scene(meshes=[box((1, 2, 3))])
    hidden = Body("b", 0, scale=(1.0, 2.0, 1.0), visible=False)
    scene.nodes = [
        Node("P", "P", bodies=(hidden,)),
        Node("G", "G", grounded=True, bodies=(hidden,), visible=False),
    ]
    options = kinefab.ExportOptions(colliders=kinefab.ColliderShape(shape))
    result = kinefab.export(scene, tmp_path / "a.glb", options)
    nodes = parsed(tmp_path / "a.glb")[0]["nodes"]
    held = {n["name"]: n for n in nodes if "collider" in n.get("extensions", {}).get(BODIES, {})}
    assert list(held) == (["b"] if shape == "auto" else ["box"]) and sum("scale" in n for n in nodes) == 2
    for node in (n for n in nodes if n["name"] in held):
        geometry = node["extensions"][BODIES]["collider"]["geometry"]
        assert "mesh" not in node and (shape == "box" or "mesh" in nodes[geometry["node"]])
    below = {child for n in nodes for child in n.get("children", ())}
    assert not any("mesh" in nodes[i] for i in below)
    assert sum(o.code == "TARGET_FIELD_DROPPED" for o in result.report.outcomes) == 2


def test_hulls_that_stand_for_meshes_and_what_is_off_are_told(tmp_path):
    """What a source states and a moving body cannot have; a collider that is switched off would collide in glTF, so it is left out."""
    kinds = (ColliderKind.MESH, ColliderKind.PIECES, ColliderKind.HULL)
    stated = [Collider(kind, mesh=0, name=kind.value) for kind in kinds]
    stated.append(Collider(ColliderKind.SPHERE, radius=1.0, name="off", enabled=False))
    nodes = [Node(n, n, colliders=tuple(stated), grounded=n == "G", bodies=(Body("b", 0),)) for n in "PG"]
    result = kinefab.export(Scene(nodes=nodes, meshes=[box((1, 2, 3))]), tmp_path / "a.glb")
    codes = ("TARGET_FEATURE_APPROXIMATED", "TARGET_FIELD_DROPPED")
    told = [{o.feature for o in result.report.outcomes if o.code == code} for code in codes]
    assert told[0] == {f"collider P/{ColliderKind.MESH.value}"}  # the pieces of a box are its hull
    assert told[1] == {"collider P/off", "collider G/off"}
    assert "KHR_implicit_shapes" not in json.dumps(parsed(tmp_path / "a.glb")[0])  # the ball


@pytest.mark.parametrize(("shape", "count"), [("decompose", 0), ("mesh", 1), ("hull", 0), ("auto", 0)])
def test_a_shape_that_was_asked_for_and_is_a_hull_is_told(tmp_path, shape, count):
    nodes = [Node(n, n, grounded=n == "G", bodies=(Body("b", 0),)) for n in "PG"]
    options = kinefab.ExportOptions(colliders=kinefab.ColliderShape(shape))
    result = kinefab.export(Scene(nodes=nodes, meshes=[box((1, 2, 3))]), tmp_path / "a.glb", options)
    told = [o.feature for o in result.report.outcomes if o.code == "TARGET_FEATURE_APPROXIMATED"]
    assert told == ["collider P/b"] * count


@pytest.mark.parametrize("stated", [False, True])
def test_a_hollow_moving_body_is_convex_pieces_below_its_motion(tmp_path, stated):
    """As in Unity: what lies in a bowl is not pushed out of it.  One hull stood for it, and nobody was told."""
    pytest.importorskip("manifold3d")
    bowl = trimesh.creation.box((0.4, 0.3, 0.2)).difference(
        trimesh.creation.box((0.36, 0.26, 0.2)).apply_translation((0.0, 0.0, 0.02))
    )
    mesh = kinefab.model.Mesh("bowl", np.array(bowl.vertices), np.array(bowl.faces))
    at, stretch = (
        Pose(rotation_about(np.array([0.0, 1, 0]), 0.3), np.array([0.1, -0.2, 0.3])),
        (1.0, 2.0, 1.0),
    )
    rubber = PhysicsMaterial("rubber", 0.9, 1.0, 0.1)
    piece = Collider(ColliderKind.PIECES, at, mesh=0, scale=stretch, name="c", material=rubber)
    nodes = [
        Node(
            name,
            name,
            grounded=name == "G",
            pose=Pose(np.eye(3), np.array([x, 0.0, 0.0])),
            bodies=(Body("b", 0, pose=at, scale=stretch),),
            colliders=(piece,) if stated else None,
        )
        for name, x in (("P", 0.0), ("G", 5.0))
    ]
    result = kinefab.export(Scene(nodes=nodes, meshes=[mesh]), tmp_path / "a.glb")
    assert not [o for o in result.report.outcomes if o.outcome is not Outcome.KEPT]
    document, binary = parsed(tmp_path / "a.glb")
    found: dict[str, list[trimesh.Trimesh]] = {"P": [], "G": []}
    parents = {child: i for i, node in enumerate(document["nodes"]) for child in node.get("children", ())}
    for index, node in enumerate(document["nodes"]):
        if (entry := node.get("extensions", {}).get(BODIES, {}).get("collider")) is None:
            continue
        shape = document["meshes"][document["nodes"][entry["geometry"]["node"]]["mesh"]]
        points = accessor(document, binary, shape["primitives"][0]["attributes"]["POSITION"])
        place, top = world(document, index), index
        while top in parents:
            top = parents[top]
        owner = document["nodes"][top]["name"]
        assert ("physicsMaterial" in entry) == stated
        hull = entry["geometry"].get("convexHull", False)
        assert hull == (owner == "P" or stated)
        if hull:
            found[owner].append(trimesh.convex.convex_hull(points @ place[:3, :3].T + place[:3, 3]))
    assert len(found["P"]) > 1 and len(found["G"]) == (len(found["P"]) if stated else 0)
    whole = bowl.copy().apply_scale(stretch)
    assert whole.volume * 0.999 < sum(p.volume for p in found["P"]) < 0.5 * whole.convex_hull.volume
    inside = at.point(np.array([[0.0, 0.0, 0.02]]))
    assert not any(p.contains(inside).any() for p in found["P"])
    kinefab.export(Scene(nodes=nodes, meshes=[mesh]), tmp_path / "b.glb")
    assert (tmp_path / "a.glb").read_bytes() == (tmp_path / "b.glb").read_bytes()


def test_what_is_grounded_below_what_moves_stands_beside_it(tmp_path):
    """In the source's tree only: readers gave its colliders to the body above, and it moved with that."""
    scene = Scene(meshes=[box((1, 2, 3))])
    at = [
        Pose(rotation_about(np.array([0.0, 1, 0]), 0.3 * k), np.array([5.0 * k, 1.0, 0.0])) for k in range(4)
    ]
    below = ((None, False), (0, True), (1, True), (0, False))
    for name, pose, (parent, grounded) in zip(("Arm", "Post", "Foot", "Hand"), at, below):
        body = (Body("b", 0),)
        scene.nodes.append(Node(name, name, parent=parent, pose=pose, grounded=grounded, bodies=body))
    kinefab.export(scene, tmp_path / "a.glb")
    document, _ = parsed(tmp_path / "a.glb")
    nodes = document["nodes"]
    names = {n["name"]: i for i, n in enumerate(nodes) if n["name"] in ("Arm", "Post", "Foot", "Hand")}
    parents = {child: i for i, node in enumerate(nodes) for child in node.get("children", ())}
    assert names["Post"] not in parents and parents[names["Foot"]] == names["Post"]
    assert parents[names["Hand"]] == names["Arm"]
    for name, pose in zip(names, at):
        assert np.allclose(world(document, names[name])[:3, 3], pose.translation, atol=1e-9)
        assert np.allclose(world(document, names[name])[:3, :3], pose.rotation, atol=1e-9)


def test_a_jpeg_of_inks_is_told(tmp_path):
    image = pytest.importorskip("PIL.Image")
    for mode in ("CMYK", "L", "RGB"):
        image.new(mode, (4, 4)).save(tmp_path / f"{mode}.jpg")
    surfaces = [Surface(m, color_texture=Texture(m, tmp_path / f"{m}.jpg")) for m in ("CMYK", "L", "RGB")]
    nodes = [Node(f"P{i}", f"P{i}", bodies=(Body("b", 0, (i,)),)) for i in range(3)]
    scene = Scene(nodes=nodes, meshes=[box((1, 1, 1))], surfaces=surfaces)
    result = kinefab.export(scene, tmp_path / "a.glb")
    assert [o.feature for o in result.report.outcomes if o.code == "TEXTURE_DROPPED"] == ["texture CMYK"]
    assert len(parsed(tmp_path / "a.glb")[0]["images"]) == 2


def test_khronos_validator_finds_no_error_and_no_warning(tmp_path):
    if shutil.which("node") is None or not VALIDATOR.is_dir():
        pytest.skip("Khronos' gltf-validator is not installed: npm ci in tests/reference")
    files = [kinefab.export(robot(), tmp_path / "robot.glb").path]
    lever = next(bundle for bundle, _ in golden_pairs() if bundle.name == "lever.bundle.json")
    files.append(kinefab.export(lever, tmp_path / "lever.glb").path)
    files.append(kinefab.export(awkward(), tmp_path / "awkward.glb").path)
    for bundle, _ in golden_pairs()[::12]:
        files.append(kinefab.export(bundle, tmp_path / f"{bundle.name}.glb").path)
    done = subprocess.run(
        ["node", "-e", CHECK, str(VALIDATOR), *map(str, files)], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    found = [json.loads(line) for line in done.stdout.splitlines()]
    assert len(found) == len(files) and [f for f in found if f["bad"]] == []


def colliding(document: dict, first: dict, second: dict) -> bool:
    """By the draft, read both ways: a system within the other's list, or any of its systems in it."""
    filters = document.get("extensions", {}).get(BODIES, {}).get("collisionFilters", [])

    def lets(one: dict, other: dict) -> bool:
        if "collisionFilter" not in one or "collisionFilter" not in other:
            return True
        own = set(filters[one["collisionFilter"]]["collisionSystems"])
        ignored = set(filters[other["collisionFilter"]]["notCollideWithSystems"])
        assert (own <= ignored) == bool(own & ignored)
        return not own & ignored

    return lets(first, second) and lets(second, first)


def test_what_does_not_collide_has_filters(tmp_path):
    """Groups, MuJoCo's masks and pairs of parts; a pair says nothing of the bodies that hang below its parts."""
    ball = Collider(ColliderKind.SPHERE, radius=0.1)
    weight = MassProperties(1.0, np.zeros(3), np.eye(3))

    def part(name: str, group: str = "", parent: int | None = None) -> Node:
        colliders = (replace(ball, group=group),)
        return Node(name, name[-1], parent=parent, mass=weight, colliders=colliders)

    nodes = [
        part("A"), part("B"), part("A/C", parent=0), part("D", "ghosts"), part("E", "stones"),
        part("F", "mask"), part("G", "ghosts"),
        Node("H", "H", mass=weight, bodies=(Body("b", 0),)),
    ]  # fmt: skip
    extras = {
        "ignoreCollision": [["A", "B"], ["E", "H"], ["A", "nobody"]],
        "collisionGroups": {"ghosts": ["stones", "ghosts", "of nobody"]},
        "collisionMasks": {"mask": [2, 2], "stones": [1, 3]},
    }
    mesh = kinefab.model.Mesh("cube", CUBE.vertices, CUBE.faces)
    scene = Scene(nodes, meshes=[mesh], extras=extras)
    result = kinefab.export(scene, tmp_path / "a.glb")
    assert "filtered pair A and nobody" in {o.feature for o in result.report.outcomes if o.code}
    document, _ = parsed(tmp_path / "a.glb")
    found: dict[str, dict] = {}
    names = {child: node["name"] for node in document["nodes"] for child in node.get("children", ())}
    for i, node in enumerate(document["nodes"]):
        if "collider" in node.get("extensions", {}).get(BODIES, {}):
            found[names[i]] = node["extensions"][BODIES]["collider"]
    apart = {"AB", "EH", "DE", "EG", "DG", "DD", "GG", "AF", "BF", "CF", "FH"}
    for first in "ABCDEFGH":
        for second in "ABCDEFGH":
            wanted = "".join(sorted(first + second)) not in apart
            assert colliding(document, found[first], found[second]) == wanted, first + second


def test_what_gltf_has_no_place_for_is_told(tmp_path):
    weight = MassProperties(1.0, np.zeros(3), np.eye(3))
    node = Node(
        "A", "A", mass=weight, layer="Robots", tag="Cart", dynamics=Dynamics(max_angular_velocity=3.0)
    )
    scene = Scene([node], physics=kinefab.model.Physics((0.0, -1.0, 0.0), 0.01))
    result = kinefab.export(scene, tmp_path / "a.glb")
    told = {o.feature for o in result.report.outcomes if o.code == "TARGET_FIELD_DROPPED"}
    assert told == {"project setting gravity", "project setting fixed_timestep", "the largest angular velocity of body A"}
    (own,) = parsed(tmp_path / "a.glb")[0]["nodes"]
    assert own["extras"] == {"id": "A", "layer": "Robots", "tag": "Cart"}
