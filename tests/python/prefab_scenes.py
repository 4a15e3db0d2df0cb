"""A scene with one of everything that a prefab can hold."""

from __future__ import annotations

import struct
import zlib
from dataclasses import replace
from math import radians
from pathlib import Path

import numpy as np
from kinefab import model
from kinefab.model import RX, TX, ColliderKind, Freedom, JointKind, Motion, NodeKind
from kinefab.spatial import Pose

HINGE_LIMITS = (-10.0, 80.0)
"""Degrees; asymmetric, so that no sign can be wrong unseen."""


def png(path: Path, pixels: np.ndarray) -> Path:
    """An image of 8-bit RGBA, shape (height, width, 4)."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    height, width, _ = pixels.shape
    rows = b"".join(b"\0" + row.astype(np.uint8).tobytes() for row in pixels)
    head = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    path.write_bytes(
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", head)
        + chunk(b"IDAT", zlib.compress(rows))
        + chunk(b"IEND", b"")
    )
    return path


def turned(axis, degrees: float, at=(0.0, 0.0, 0.0)) -> Pose:
    x, y, z = np.asarray(axis, dtype=float) / np.linalg.norm(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    a = radians(degrees)
    return Pose(np.eye(3) + np.sin(a) * k + (1 - np.cos(a)) * k @ k, np.asarray(at, dtype=float))


def block(name: str, size, two: bool = False, uvs: bool = False) -> model.Mesh:
    """A box whose centre is the origin, flat shaded; two: of two submeshes."""
    x, y, z = 0.5 * np.asarray(size, dtype=float)
    corners, normals, uv, faces = [], [], [], []
    for axis in range(3):
        for side in (-1.0, 1.0):
            u, v = [(axis + 1) % 3, (axis + 2) % 3]
            quad = []
            for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                p = np.zeros(3)
                p[axis], p[u], p[v] = side, side * s, t
                quad.append(len(corners))
                corners.append(p * (x, y, z))
                normals.append(np.eye(3)[axis] * side)
                uv.append((0.5 + 0.5 * s, 0.5 + 0.5 * t))
            faces += [(quad[0], quad[1], quad[2]), (quad[0], quad[2], quad[3])]
    return model.Mesh(
        name,
        np.array(corners),
        np.array(faces, dtype=np.int64),
        np.array(normals),
        (np.array(uv),) if uvs else (),
        face_counts=(4, 8) if two else (),
    )


def ball(name: str, count: int) -> model.Mesh:
    """A sphere of ``2 * count * (count - 1)`` triangles: more than a convex collider may have."""
    i, j = np.meshgrid(np.arange(1, count), np.arange(count), indexing="ij")
    a, b = np.pi * i / count, 2 * np.pi * j / count
    ring = 0.04 * np.stack([np.sin(a) * np.cos(b), np.sin(a) * np.sin(b), np.cos(a)], axis=-1).reshape(-1, 3)
    vertices = np.vstack([ring, [[0, 0, 0.04], [0, 0, -0.04]]])
    top, bottom = len(ring), len(ring) + 1
    faces = []
    for k in range(count):
        n = (k + 1) % count
        faces += [(top, k, n), (bottom, (count - 2) * count + n, (count - 2) * count + k)]
        for r in range(count - 2):
            p, q = r * count, (r + 1) * count
            faces += [(p + k, q + k, q + n), (p + k, q + n, p + n)]
    return model.Mesh(name, vertices, np.array(faces, dtype=np.int64))


def rich_scene(folder: Path) -> model.Scene:
    """folder: where its textures go."""
    rng = np.random.default_rng(3)
    images = {
        n: png(folder / f"{n}.png", rng.integers(0, 256, (4, 4, 4)))
        for n in ("Wood", "Bumps", "Rough", "Glow")
    }
    texture = {n: model.Texture(n, path) for n, path in images.items()}
    surfaces = [
        model.Surface("Steel", (0.5, 0.25, 0.1, 1.0), 0.9, 0.6),
        model.Surface("Glass", (0.2, 0.4, 0.6, 0.3), alpha_mode=model.AlphaMode.BLEND, double_sided=True),
        model.Surface(
            "Mesh", alpha_mode=model.AlphaMode.MASK, alpha_cutoff=0.4, color_texture=texture["Wood"]
        ),
        model.Surface(
            "Lamp",
            emission=(2.0, 1.0, 0.0),
            color_texture=replace(
                texture["Wood"], scale=(2.0, 3.0), offset=(0.25, 0.5), wrap=model.Wrap.CLAMP
            ),
            normal_texture=texture["Bumps"],
            metallic_roughness_texture=texture["Rough"],
            occlusion_texture=texture["Rough"],
            emission_texture=texture["Glow"],
        ),
    ]
    meshes = [
        block("Plate", (0.4, 0.02, 0.3), two=True),
        block("Arm", (0.3, 0.05, 0.04), uvs=True),
        ball("Ball", 16),
        model.Mesh("Vane", np.array([[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]], dtype=float),
                   np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]), colors=rng.random((4, 4))),
    ]  # fmt: skip
    rubber = model.PhysicsMaterial("Rubber", 0.7, 0.9, 0.25, model.Combine.MAXIMUM, model.Combine.MULTIPLY)
    mass = model.MassProperties(1.5, np.array([0.01, -0.02, 0.03]), np.diag([0.02, 0.03, 0.04]))

    def shape(kind: ColliderKind, pose: Pose = Pose(), **given) -> model.Collider:
        return model.Collider(kind, pose, **given)

    nodes = [
        model.Node("Top", "Top", NodeKind.ASSEMBLY, flexible=True, pose=turned((1, 2, 3), 25, (0.1, 0.2, -0.3))),
        model.Node("Top/Base", "Base", parent=0, pose=turned((1, 2, 3), 25, (0.1, 0.2, -0.3)), grounded=True,
                   bodies=(model.Body("Plate", 0, (0, 1)),), layer="Scenery", tag="Ground"),
        model.Node("Top/Arm:1", "Arm", parent=0, pose=turned((0, 1, 0), 40, (0.2, 0.3, 0.1)), mass=mass, bodies=(model.Body("Arm", 1, (3,)),),
                   colliders=(
                       shape(ColliderKind.BOX, Pose(np.eye(3), np.array([0.01, 0, 0])), size=(0.3, 0.05, 0.04), material=rubber),
                       shape(ColliderKind.BOX, turned((1, 1, 0), 30, (0.1, 0, 0)), size=(0.1, 0.2, 0.3), name="tilted", trigger=True),
                       shape(ColliderKind.SPHERE, Pose(np.eye(3), np.array([-0.1, 0.02, 0.03])), radius=0.03),
                       shape(ColliderKind.CAPSULE, turned((0, 1, 0), 90, (0.1, 0.0, 0.05)), radius=0.02, length=0.1, enabled=False),
                       shape(ColliderKind.CYLINDER, radius=0.02, length=0.1),
                       shape(ColliderKind.HULL, mesh=2, scale=(1.0, 2.0, 1.0)),
                   )),
        model.Node("Top/Arm:2", "Arm", parent=0, pose=turned((0, 1, 1), -70, (-0.2, 0.3, 0.1)), bodies=(model.Body("Arm", 1, (2,)),)),
        model.Node("Top/Slider", "Slider / 50 %", parent=0, pose=turned((1, 0, 1), 33, (0.0, 0.5, 0.2)), bodies=(model.Body("Ball", 2, (1,)),)),
        model.Node("Top/Lid", "Lid", parent=0, pose=turned((0, 0, 1), 12, (0.4, 0.3, 0.2)),
                   bodies=(model.Body("Vane", 3), model.Body("Other", 3, pose=Pose(np.eye(3), np.array([0.0, 0.2, 0.0])), scale=(1.0, 1.0, 2.0), visible=False)),
                   sites=(model.Site("Tip", Pose(np.eye(3), np.array([0.0, 0.0, 0.4]))),)),
        model.Node("Top/Fan", "Fan", parent=0, pose=Pose(np.eye(3), np.array([1.0, 0.0, 0.0])), suppressed=True),
    ]  # fmt: skip

    def joint(id: str, kind: JointKind, a: int | None, b: int, frame: Pose, **given) -> model.Joint:
        freedoms = model.freedoms_of(kind, **{k: v for k, v in given.items() if isinstance(v, Freedom)})
        rest = {k: v for k, v in given.items() if not isinstance(v, Freedom)}
        of = [Pose() if n is None else nodes[n].pose for n in (a, b)]
        return model.Joint(id, kind, a, b, of[0].inverse() @ frame, of[1].inverse() @ frame, freedoms, **rest)

    low, high = map(radians, HINGE_LIMITS)
    hinge = Freedom(
        Motion.LIMITED, low, high, drive=model.Drive(radians(30), 0.0, 12.0, 0.5), restitution=0.2
    )
    motor = Freedom(Motion.FREE, drive=model.Drive(target_velocity=radians(45), max_force=7.0, motor=True))
    slide = Freedom(
        Motion.LIMITED,
        -0.02,
        0.1,
        drive=model.Drive(0.05, 0.0, 300.0, 20.0, 50.0),
        stiffness=1000.0,
        damping=2.0,
    )
    joints = [
        joint("Shoulder", JointKind.REVOLUTE, 1, 2, turned((1, 0, 0), 20, (0.2, 0.3, 0.1)), rx=hinge, name="shoulder", collide=True),
        joint("Wheel", JointKind.REVOLUTE, None, 3, turned((0, 1, 0), 50, (-0.2, 0.3, 0.1)), rx=motor),
        joint("Rail", JointKind.PRISMATIC, 2, 4, turned((1, 0, 1), 15, (0.0, 0.5, 0.2)), tx=slide),
        joint("Snap", JointKind.FIXED, 2, 5, Pose(np.eye(3), np.array([0.4, 0.3, 0.2])), break_force=120.0, break_torque=8.0),
    ]  # fmt: skip
    gear = model.Coupling(
        "Gear", model.CouplingKind.GEAR, "Wheel", RX, (model.Term("Shoulder", RX, -2.5),), 0.1
    )
    rack = model.Coupling("Rack", model.CouplingKind.RACK, "Rail", TX, (model.Term("Shoulder", RX, 0.03),))
    times = np.array([0.0, 0.5, 1.25])
    turns = np.array([[0, 0, 0, 1], [0, np.sin(0.3), 0, np.cos(0.3)], [0, np.sin(0.7), 0, np.cos(0.7)]])
    moves = np.array([[0.0, 0.0, 0.0], [0.1, 0.2, 0.3], [0.4, 0.1, -0.2]])
    clips = [
        model.AnimationClip(
            "Open", times, (model.Track(5, moves, turns), model.Track(6, moves)), model.Repeat.LOOP
        )
    ]
    return model.Scene(
        nodes=nodes, meshes=meshes, surfaces=surfaces, joints=joints, couplings=[gear, rack], animations=clips
    )
