"""Meshes that are a box, a ball or a capsule: found wherever they lie, in metres and millimetres; and nothing else is."""

from __future__ import annotations

import json
from dataclasses import replace
from math import sqrt

import kinefab
import numpy as np
import pytest
import trimesh
from kinefab.geometry import primitives
from kinefab.geometry.recognition import recognised
from kinefab.model import ColliderKind, Mesh
from kinefab.spatial import matrix_from_quaternion, rotation_exp
from scipy.spatial import ConvexHull
from trimesh import creation

TURN = rotation_exp(np.array([0.4, -1.1, 0.7]))
SHIFT = np.array([0.3, -2.0, 0.9])


def mesh_of(shape, scale: float = 1.0, turned: bool = True, single: bool = False) -> Mesh:
    vertices = np.asarray(shape.vertices, dtype=np.float64)
    vertices = scale * (vertices @ TURN.T + SHIFT) if turned else scale * vertices
    if single:
        vertices = vertices.astype(np.float32).astype(np.float64)
    return Mesh("m", vertices, np.asarray(shape.faces))


def hull(points: np.ndarray) -> Mesh:
    """Wound outwards."""
    faces = ConvexHull(points).simplices
    a, b, c = (points[faces[:, i]] for i in range(3))
    inwards = np.einsum("ij,ij->i", np.cross(b - a, c - a), a - points.mean(axis=0)) < 0.0
    faces = np.where(inwards[:, None], faces[:, ::-1], faces)
    used, numbers = np.unique(faces, return_inverse=True)
    return Mesh("m", points[used], numbers.reshape(faces.shape))


def cut(shape, normal, height: float) -> Mesh:
    """What of a convex shape lies below a plane, closed by a flat face."""
    vertices, faces = np.asarray(shape.vertices), np.asarray(shape.faces)
    above = vertices @ (np.asarray(normal) / np.linalg.norm(normal)) - height
    points = [vertices[above <= 0.0]]
    for i, j in ((0, 1), (1, 2), (2, 0)):
        a, b = faces[:, i], faces[:, j]
        crossed = (above[a] < 0.0) != (above[b] < 0.0)
        a, b = a[crossed], b[crossed]
        share = (above[a] / (above[a] - above[b]))[:, None]
        points.append(vertices[a] + share * (vertices[b] - vertices[a]))
    return hull(np.unique(np.vstack(points).round(12), axis=0))


def cells(filled: np.ndarray) -> Mesh:
    """The skin of the filled cells of a grid: a box with whatever is left out of it."""
    padded = np.pad(filled, 1)
    quads: list[np.ndarray] = []
    for cell in np.argwhere(padded):
        for axis in range(3):
            for side in (0, 1):
                beside = cell.copy()
                beside[axis] += 2 * side - 1
                if padded[tuple(beside)]:
                    continue
                u, v = np.eye(3)[(axis + 1) % 3], np.eye(3)[(axis + 2) % 3]
                corner = cell + side * np.eye(3)[axis]
                quad = np.array([corner, corner + u, corner + u + v, corner + v])
                quads.append(quad if side else quad[::-1])
    faces = [[4 * i + k for k in three] for i in range(len(quads)) for three in ((0, 1, 2), (0, 2, 3))]
    return Mesh("m", np.vstack(quads).astype(float), np.array(faces))


def grid(*empty: tuple[int, int, int]) -> Mesh:
    filled = np.ones((3, 3, 3), dtype=bool)
    for cell in empty:
        filled[cell] = False
    return cells(filled)


@pytest.mark.parametrize("single", [False, True], ids=["64 bits", "32 bits"])
@pytest.mark.parametrize("scale", [1.0, 1000.0], ids=["m", "mm"])
@pytest.mark.parametrize("turned", [False, True], ids=["home", "turned"])
def test_a_box_a_ball_and_a_capsule_are_found_where_they_lie(scale, turned, single):
    place = {"scale": scale, "turned": turned, "single": single}
    centre = scale * SHIFT if turned else np.zeros(3)
    for shape in (primitives.box((0.1, 0.2, 0.3)), creation.box((0.1, 0.2, 0.3)).subdivide().subdivide(), grid()):
        size = (3, 3, 3) if np.ptp(shape.vertices) > 2 else (0.1, 0.2, 0.3)
        found = recognised(mesh_of(shape, **place))
        assert found is not None and found.kind is ColliderKind.BOX
        middle = centre if np.ptp(shape.vertices) < 2 else scale * ((TURN if turned else np.eye(3)) @ np.full(3, 2.5) + (SHIFT if turned else 0))
        assert np.allclose(found.pose.translation, middle, atol=1e-5 * scale)
        corners = found.pose.translation + (np.array(np.meshgrid(*[[-0.5, 0.5]] * 3)).reshape(3, -1).T * found.size) @ found.pose.rotation.T
        apart = np.linalg.norm(corners[:, None] - np.asarray(mesh_of(shape, **place).vertices)[None], axis=2)
        assert apart.min(axis=1).max() < 1e-4 * min(size) * scale
        assert np.linalg.det(found.pose.rotation) == pytest.approx(1.0)
    for shape in (primitives.sphere(0.3), creation.icosphere(3, 0.3), creation.uv_sphere(0.3, count=[16, 16])):
        found = recognised(mesh_of(shape, **place))
        assert found is not None and found.kind is ColliderKind.SPHERE
        assert found.radius == pytest.approx(0.3 * scale, rel=1e-5)
        assert np.allclose(found.pose.translation, centre, atol=1e-5 * scale)
    for shape, length in ((primitives.capsule(0.1, 0.3), 0.3), (primitives.capsule(0.1, 5.0), 5.0)):
        found = recognised(mesh_of(shape, **place))
        assert found is not None and found.kind is ColliderKind.CAPSULE
        assert (found.radius, found.length) == pytest.approx((0.1 * scale, length * scale), rel=1e-4)
        axis = (TURN if turned else np.eye(3))[:, 2]
        assert abs(found.pose.rotation[:, 2] @ axis) == pytest.approx(1.0, abs=1e-9)
        assert np.allclose(found.pose.translation, centre, atol=1e-5 * scale)


BOX, BALL, CAPSULE = creation.box((1, 1, 1)), creation.uv_sphere(1.0, count=[48, 48]), creation.capsule(3, 1.0, count=[48, 48])
HALF = trimesh.transformations.translation_matrix((3, 0, 0))
NOT_ONE = {
    "a hole through": grid((1, 1, 0), (1, 1, 1), (1, 1, 2)),
    "a blind hole": grid((1, 1, 2)),
    "a hollow": grid((1, 1, 1)),
    "a corner left out": grid((0, 0, 0)),
    "an edge left out": grid((0, 0, 0), (0, 0, 1), (0, 0, 2)),
    **{f"a chamfer of {d}": cut(BOX, (1, 1, 0), (1 - d) / sqrt(2)) for d in (0.3, 0.01, 0.001)},
    **{f"a corner cut by {d}": cut(BOX, (1, 1, 1), (1.5 - d) / sqrt(3)) for d in (0.3, 0.01, 0.001)},
    **{f"a ball cut by {d}": cut(BALL, (1, 0.3, 0.2), 1 - d) for d in (1.0, 0.1, 0.01, 0.003, 0.001)},
    **{f"a ball without {k} rings": hull(BALL.vertices[BALL.vertices[:, 2] < np.cos((k - 0.5) * np.pi / 48)]) for k in (1, 2, 5)},
    **{f"a capsule cut by {d}": cut(CAPSULE, (1, 0, 0), 1 - d) for d in (0.3, 0.01, 0.003)},
    **{f"a capsule's end cut by {d}": cut(CAPSULE, (0, 0, 1), CAPSULE.vertices[:, 2].max() - d) for d in (1.0, 0.01, 0.003)},
    "an open box": Mesh("m", BOX.vertices, BOX.faces[2:]),
    "a box without a triangle": Mesh("m", BOX.vertices, BOX.faces[1:]),
    "a ball without a triangle": Mesh("m", BALL.vertices, BALL.faces[1:]),
    "a capsule without a triangle": Mesh("m", CAPSULE.vertices, CAPSULE.faces[1:]),
    "a box turned inside out": Mesh("m", BOX.vertices, BOX.faces[:, ::-1]),
    "a triangle turned round": Mesh("m", BOX.vertices, np.vstack([BOX.faces[:1, ::-1], BOX.faces[1:]])),
    "two boxes": trimesh.util.concatenate([BOX, creation.box((1, 1, 1), transform=HALF)]),
    "two balls in one place": trimesh.util.concatenate([BALL, BALL]),
    "a ball within a ball": trimesh.util.concatenate([BALL, creation.icosphere(3, 0.5)]),
    "a box with a wall in it": trimesh.util.concatenate([BOX, trimesh.Trimesh(primitives.plane(1, 1).vertices, primitives.plane(1, 1).faces)]),
    "a cylinder": primitives.cylinder(0.1, 0.3),
    "a cone": primitives.cone(0.1, 0.3),
    "a torus": creation.torus(1, 0.2),
    "a ring": creation.annulus(0.1, 0.2, 0.1),
    "a square frame": creation.annulus(0.1, 0.2, 0.1, sections=4),
    "a prism of six sides": creation.cylinder(1, 1, sections=6),
    "a leaning box": hull(np.asarray(BOX.vertices) @ np.array([[1, 0.002, 0], [0, 1, 0], [0, 0, 1.0]])),
    "a wedge": hull(np.asarray(BOX.vertices) * np.where(np.asarray(BOX.vertices)[:, 2:] > 0, [0.99, 1, 1], [1, 1, 1])),
    "an ellipsoid": primitives.ellipsoid((0.1, 0.1, 0.1005)),
    "an icosahedron": creation.icosahedron(),
    "a sheet": primitives.plane(1, 1),
    "a folded sheet": Mesh("m", np.vstack([primitives.plane(1, 1).vertices] * 2), np.vstack([[[0, 1, 2], [0, 2, 3]], [[4, 6, 5], [4, 7, 6]]])),
}  # fmt: skip


@pytest.mark.parametrize("turned", [False, True], ids=["home", "turned"])
@pytest.mark.parametrize("name", NOT_ONE)
def test_nothing_else_is_taken_for_one(name, turned):
    assert recognised(mesh_of(NOT_ONE[name], turned=turned)) is None


@pytest.mark.parametrize("scale", [None, (2.0, 2.0, 2.0), (2.0, 1.0, 0.5)], ids=["as it is", "evenly", "unevenly"])
@pytest.mark.parametrize("grounded", [False, True])
def test_an_export_has_unitys_own_colliders_where_the_mesh_stands(tmp_path, grounded, scale):
    """Its corners, poles and ends in the world are those of the mesh; an uneven scale leaves a ball none."""
    shapes = {
        "Block": (mesh_of(primitives.box((0.1, 0.2, 0.3)), turned=False), "BoxCollider"),
        "Leaning": (mesh_of(primitives.box((0.1, 0.2, 0.3))), "BoxCollider"),
        "Ball": (mesh_of(primitives.sphere(0.3)), "SphereCollider"),
        "Pill": (mesh_of(primitives.capsule(0.1, 0.3)), "CapsuleCollider"),
        "Rod": (mesh_of(primitives.capsule(0.1, 0.3), turned=False), "CapsuleCollider"),
    }
    scene = kinefab.Scene()
    for i, (name, (mesh, _)) in enumerate(shapes.items()):
        made = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
        scene.add_part(name, made, translation=(i, 0.2, 0.3), rotation=rotation_exp(np.array([0.2, 0.3 * i, 0.1])), grounded=grounded)
        if scale is not None:
            (body,) = scene.nodes[-1].bodies
            scene.nodes[-1] = replace(scene.nodes[-1], bodies=(replace(body, scale=scale),))
    result = kinefab.export(scene, tmp_path / "a.kinefab", kinefab.ExportOptions(colliders="auto", ground="world"))
    objects = json.loads((tmp_path / "a.kinefab").read_text("utf-8"))["gameObjects"]
    told = {o.feature for o in result.report.outcomes if o.code == "COLLIDER_RECOGNISED"}
    uneven = scale is not None and len(set(scale)) > 1
    for name, (mesh, kind) in shapes.items():
        own = [(o, c) for o in objects for c in o.get("components", ()) if o["id"].split("/")[0] == name and c["type"].endswith("Collider")]
        if uneven and name != "Block":
            assert [c["type"] for _, c in own] == ["MeshCollider"] and f"collider {name}/{name}" not in told
            continue
        ((entry, collider),) = own
        assert collider["type"] == kind and f"collider {name}/{name}" in told
        points = np.asarray(mesh.vertices) * [-1, 1, 1]  # of Unity's hand
        if scale is not None:
            points = points * scale
        at = next(o for o in objects if o["id"] == name)
        assert np.abs(signed_distance(collider, objects, entry, to_world(objects, at, points))).max() < 1e-4 * 0.1 * (2.0 if scale else 1.0)


def pose_of(entry: dict) -> tuple[np.ndarray, np.ndarray]:
    t = entry.get("transform", {})
    turn = matrix_from_quaternion(np.array(t.get("localRotation", [0, 0, 0, 1])))
    return turn * np.array(t.get("localScale", [1, 1, 1])), np.array(t.get("localPosition", [0, 0, 0]))


def to_world(objects: list[dict], entry: dict, points: np.ndarray) -> np.ndarray:
    linear, offset = pose_of(entry)
    points = points @ linear.T + offset
    return points if entry.get("parent") is None else to_world(objects, objects[entry["parent"]], points)


def signed_distance(collider: dict, objects: list[dict], entry: dict, world: np.ndarray) -> np.ndarray:
    """From the collider's surface, in its own frame."""
    frame = to_world(objects, entry, np.vstack([np.zeros(3), np.eye(3)]))
    local = (world - frame[0]) @ np.linalg.inv(frame[1:] - frame[0]) - np.array(collider.get("center", [0, 0, 0]))
    if collider["type"] == "BoxCollider":
        return (np.abs(local) - 0.5 * np.array(collider["size"])).max(axis=1)
    radius = collider["radius"]
    half = max(0.0, 0.5 * collider.get("height", 0.0) - radius)
    axis = np.eye(3)["XYZ".index(collider.get("direction", "Y"))]
    near = np.clip(local @ axis, -half, half)[:, None] * axis
    return np.linalg.norm(local - near, axis=1) - radius
