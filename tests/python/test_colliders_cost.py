"""What makes colliders cheap: cuts by planes, decomposition where it is needed, hulls from extreme vertices."""

from __future__ import annotations

import itertools
import json
from importlib.util import find_spec

import kinefab
import numpy as np
import pytest
import trimesh
from golden import FIXTURES
from kinefab.diagnostics import Report
from kinefab.geometry import hulls
from kinefab.geometry.contact import cuts, decomposition, nearness
from kinefab.geometry.contact.nearness import close_pairs, extents, placed_extents
from kinefab.geometry.hulls import UNITY_TRIANGLES, collision_hulls, hull_of_points
from kinefab.geometry.mass import solid_volume
from kinefab.model import Mesh, Scene
from kinefab.spatial import matrix_from_quaternion
from kinefab.unity.scene import BoxCollider, GameObject, SphereCollider, Transform, UnityScene
from kinefab.unity.contact.placed import placed_colliders

MANIFOLD = pytest.mark.skipif(find_spec("manifold3d") is None, reason="manifold3d is not installed")
COAL = pytest.mark.skipif(find_spec("coal") is None, reason="coal is not installed")


def mesh_of(shape: trimesh.Trimesh) -> Mesh:
    return Mesh("m", np.array(shape.vertices), np.array(shape.faces))


def ring(number: int) -> trimesh.Trimesh:
    return trimesh.creation.annulus(0.1, 0.2 + 0.001 * number, 0.1, sections=12)


def hollow_scene(count: int, apart: float) -> kinefab.Scene:
    scene = kinefab.Scene()
    for i in range(count):
        scene.add_part(f"R{i}", ring(i), translation=(apart * i, 0, 0))
    return scene


def pieces_of(result, name: str) -> int:
    (entry,) = (g for g in result.unity.gameObjects if g.id == name)
    return sum(type(c).__name__ == "MeshCollider" for c in entry.components)


@MANIFOLD
@pytest.mark.parametrize(
    "shape, most, air",
    [
        (trimesh.creation.annulus(0.1, 0.2, 0.1, sections=16), 16, 0.05),
        (trimesh.creation.annulus(0.09, 0.1, 1.0, sections=32), 16, 0.10),
        (trimesh.creation.torus(0.2, 0.05), 16, 0.20),
        (trimesh.util.concatenate([ring(0), ring(0).apply_translation((0, 0, 1))]), 16, 0.06),
    ],
    ids=["ring", "tube", "torus", "two rings"],
)
def test_pieces_fill_the_solid_and_not_its_hole(shape, most, air, monkeypatch):
    """Together they have the solid's volume and little more, and none reaches to the axis, which is in the hole."""
    monkeypatch.setattr(decomposition, "find_spec", lambda name: name == "manifold3d" or None)
    pieces = decomposition._decomposed(mesh_of(shape))
    assert 2 <= len(pieces) <= most
    assert sum(solid_volume(p.vertices, p.faces) for p in pieces) == pytest.approx(
        shape.volume * (1 + air / 2), rel=air
    )
    axis = np.column_stack([np.zeros((9, 2)), np.linspace(*shape.bounds[:, 2], 9)])
    for piece in pieces:
        normals = np.cross(
            *(piece.vertices[piece.faces[:, k]] - piece.vertices[piece.faces[:, 0]] for k in (1, 2))
        )
        heights = axis @ normals.T - np.einsum("ij,ij->i", normals, piece.vertices[piece.faces[:, 0]])
        assert (heights.max(axis=1) > 0).all()  # outside


@MANIFOLD
def test_a_stepped_shaft_falls_into_its_cylinders(monkeypatch):
    """Cuts along the faces at its inner edges leave next to no air; its hull has twice the volume."""
    monkeypatch.setattr(decomposition, "find_spec", lambda name: name == "manifold3d" or None)
    thick = trimesh.creation.cylinder(0.1, 0.1, sections=24)
    thin = trimesh.creation.cylinder(0.03, 0.37, sections=24).apply_translation((0, 0, 0.2))
    shaft = trimesh.boolean.union([thick, thin], engine="manifold")
    pieces = decomposition._decomposed(mesh_of(shaft))
    assert sum(solid_volume(p.vertices, p.faces) for p in pieces) == pytest.approx(shaft.volume, rel=0.04)


@MANIFOLD
def test_the_first_plane_that_opens_a_frame_is_taken(monkeypatch):
    """Three cuts make four pieces.  The first gains nothing by any plane, so all are tried and then the next cut, in the two
    halves of one plane; each of the others is good at once."""
    searches = []
    best = cuts._best
    monkeypatch.setattr(cuts, "_best", lambda *given: searches.append(1) or best(*given))
    shape = trimesh.creation.annulus(0.1, 0.2, 0.1, sections=4)
    pieces = cuts.nearly_convex_parts(np.array(shape.vertices) / 0.4, np.array(shape.faces), 16)
    assert len(pieces) == 4 and len(searches) == 2 + 2 + 2


def turned(shape: trimesh.Trimesh) -> trimesh.Trimesh:
    return shape.apply_transform(trimesh.transformations.euler_matrix(0.35, 0.58, 0.82))


@MANIFOLD
@pytest.mark.parametrize(
    "shape, count, air",
    [
        (trimesh.creation.annulus(0.1, 0.2, 0.1, sections=48), 8, 0.04),
        (turned(trimesh.creation.annulus(0.1, 0.2, 0.1, sections=48)), 8, 0.04),
        (turned(trimesh.creation.annulus(0.09, 0.1, 0.4, sections=47)), 16, 0.12),
        (trimesh.creation.torus(0.2, 0.05), 12, 0.04),
    ],
    ids=["washer", "turned washer", "turned tube", "torus"],
)
def test_a_ring_is_cut_into_equal_sectors_however_it_lies(shape, count, air):
    pieces = decomposition._decomposed(mesh_of(shape))
    volumes = np.array([solid_volume(p.vertices, p.faces) for p in pieces])
    assert len(pieces) == count
    assert np.ptp(volumes) < 0.05 * volumes.mean()
    assert shape.volume < volumes.sum() < (1 + air) * shape.volume


@MANIFOLD
@pytest.mark.parametrize(
    "shape, most",
    [
        (turned(trimesh.creation.annulus(0.1, 0.2, 0.1, sections=4)), 12),
        (turned(trimesh.creation.annulus(0.1, 0.2, 0.1, sections=6)), 14),
        (turned(trimesh.creation.revolve([(0.1, -0.1), (0.4, -0.1), (0.2, 0), (0.4, 0.1), (0.1, 0.1), (0.1, -0.1)])), 16),
    ],
    ids=["square frame", "hexagonal frame", "pulley"],
)  # fmt: skip
def test_no_ring_that_is_not_round_or_has_a_groove_is_cut_into_sectors(shape, most):
    """By planes it takes fewer pieces, and leaves less air."""
    pieces = decomposition._decomposed(mesh_of(shape))
    assert len(pieces) <= most
    assert sum(solid_volume(p.vertices, p.faces) for p in pieces) < 1.04 * shape.volume


@MANIFOLD
def test_the_same_mesh_gives_the_same_pieces():
    mesh = mesh_of(trimesh.creation.torus(0.2, 0.05))
    first, second = decomposition._decomposed(mesh), decomposition._decomposed(mesh)
    assert [p.vertices.tobytes() for p in first] == [p.vertices.tobytes() for p in second]


@pytest.mark.skipif(find_spec("coacd") is None, reason="coacd is not installed")
def test_coacd_takes_what_no_plane_can_cut(monkeypatch):
    """Where the cuts find no manifold skin, the other library decomposes."""
    monkeypatch.setattr(decomposition, "nearly_convex_parts", lambda *given: [])
    assert len(decomposition._decomposed(mesh_of(ring(0)))) > 3


@MANIFOLD
def test_of_many_hollow_shapes_those_that_may_collide_are_decomposed_first(tmp_path):
    """Ten rings stand free; the last two stand in each other's hulls.  What is left as its hull says why."""
    scene = hollow_scene(decomposition.MOST_FREE + 4, apart=2.0)
    last = f"R{decomposition.MOST_FREE + 3}"
    scene.add_part(
        "Pin",
        trimesh.creation.cylinder(0.05, 0.3, sections=12),
        translation=(2.0 * (decomposition.MOST_FREE + 3), 0, 0),
    )
    result = kinefab.export(scene, tmp_path / "many.kinefab")
    assert pieces_of(result, last) > 3
    told = [o for o in result.report.outcomes if o.code == "COLLIDER_HOLLOW_AS_HULL"]
    assert len(told) == 3 and all("nothing that it may collide with is near" in o.message for o in told)
    assert all(o.outcome is kinefab.Outcome.APPROXIMATED for o in told)


@MANIFOLD
def test_joined_parts_do_not_count_as_near(tmp_path):
    scene = hollow_scene(decomposition.MOST_FREE + 1, apart=2.0)
    number = decomposition.MOST_FREE
    pin = scene.add_part(
        "Pin", trimesh.creation.cylinder(0.05, 0.3, sections=12), translation=(2.0 * number, 0, 0)
    )
    scene.add_hinge(number, pin, point=(2.0 * number, 0, 0), axis=(0, 0, 1))
    result = kinefab.export(scene, tmp_path / "joined.kinefab")
    (told,) = (o for o in result.report.outcomes if o.code == "COLLIDER_HOLLOW_AS_HULL")
    assert f"R{number}" in told.message


@pytest.mark.parametrize("at_once", [1, nearness.AT_ONCE])
def test_close_pairs_are_those_of_every_pair(at_once, monkeypatch):
    monkeypatch.setattr(nearness, "AT_ONCE", at_once)
    rng = np.random.default_rng(4)
    shapes = [rng.normal(size=(6, 3)) * 0.3 + rng.uniform(-2, 2, 3) for _ in range(60)]
    low, high = (np.array(ends) for ends in zip(*map(extents, shapes)))
    expected = [
        (a, b)
        for a, b in itertools.combinations(range(60), 2)
        if (low[a] <= high[b]).all() and (low[b] <= high[a]).all()
    ]
    assert len(expected) > 10 and [tuple(pair) for pair in close_pairs(low, high).tolist()] == expected


@pytest.mark.parametrize("at_once", [1, nearness.AT_ONCE])
def test_a_shape_in_many_places_reaches_as_far_as_its_points(at_once, monkeypatch):
    monkeypatch.setattr(nearness, "AT_ONCE", at_once)
    rng = np.random.default_rng(5)
    points, linear, at = rng.normal(size=(20, 3)), rng.normal(size=(7, 3, 3)), rng.normal(size=(7, 3))
    low, high = placed_extents(points, linear, at)
    for k in range(7):
        expected = extents(points @ linear[k].T + at[k])
        assert np.allclose(low[k], expected[0]) and np.allclose(high[k], expected[1])


def test_colliders_stand_where_the_objects_above_put_them():
    """A box in a turned and stretched object, in one that is moved; one in an object that is switched off is not there."""
    half = np.sqrt(0.5)
    boxed = (BoxCollider(center=(1.0, 0.0, 0.0), size=(2.0, 4.0, 6.0)), SphereCollider(radius=0.0))
    objects = [
        GameObject(
            "A", "A", None, True, Transform((0.0, 10.0, 0.0), (0.0, 0.0, half, half), (1.0, 1.0, 2.0))
        ),
        GameObject("B", "B", 0, True, Transform((5.0, 0.0, 0.0)), boxed),
        GameObject("C", "C", 0, False),
        GameObject("D", "D", 2, True, components=boxed),
        GameObject("E", "E", None, True, Transform((0.0, 0.0, 9.0)), boxed),
    ]
    found = placed_colliders(UnityScene(gameObjects=tuple(objects)))
    assert found.owners == [1, 4]
    assert np.allclose(found.low, [(-2, 15, -6), (0, -2, 6)]) and np.allclose(
        found.high, [(2, 17, 6), (2, 2, 12)]
    )
    assert np.allclose(found.solid(0).vertices.max(axis=0), found.high[0])


@pytest.mark.parametrize(
    "shape",
    [
        trimesh.creation.icosphere(4),
        trimesh.creation.torus(0.3, 0.1),
        trimesh.creation.cylinder(0.1, 0.4, sections=500),
        trimesh.creation.cone(1.0, 0.001, sections=400),  # so flat that Manifold leaves out vertices of it
    ],
    ids=["ball", "torus", "cylinder", "flat cone"],
)
def test_the_hull_of_a_fine_mesh_is_as_far_inside_as_it_says(shape):
    """The deviation told is that of the farthest vertex, and no more than 2 % of the size."""
    mesh, report = mesh_of(shape), Report()
    hull = collision_hulls(Scene(meshes=[mesh]), [(0, "P/b")], report)[0]
    assert len(hull.faces) <= UNITY_TRIANGLES
    (told,) = report.diagnostics
    a, b, c = (hull.vertices[hull.faces[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    farthest = (mesh.vertices @ normals.T - np.einsum("ij,ij->i", normals, a)).max()
    assert f"up to {farthest:.3g} m inside" in told.message
    assert farthest <= 0.02 * np.ptp(mesh.vertices, axis=0).max()


def test_the_hull_of_a_fine_mesh_with_few_corners_is_exact_and_says_nothing():
    """A chamfered block of thousands of vertices has the hull that all of them have."""
    block = trimesh.creation.box((1, 2, 3))
    corners = np.array(block.vertices)
    points = np.concatenate([corners * s for s in ((1, 0.99, 0.99), (0.99, 1, 0.99), (0.99, 0.99, 1))])
    inside = np.random.default_rng(2).uniform(-0.9, 0.9, (3000, 3)) * corners.max(axis=0)
    mesh, report = Mesh("m", np.vstack([inside, points]), np.arange(3000).reshape(-1, 3)), Report()
    hull = collision_hulls(Scene(meshes=[mesh]), [(0, "P/b")], report)[0]
    whole = hull_of_points(mesh.vertices)
    assert report.diagnostics == [] and len(hull.vertices) == 24
    assert solid_volume(hull.vertices, hull.faces) == pytest.approx(solid_volume(*whole), rel=1e-12)


@MANIFOLD
@pytest.mark.parametrize(
    "shape", [ring(2), trimesh.creation.capsule(0.3, 0.1), trimesh.creation.icosphere(4)]
)
def test_the_hull_of_a_fine_mesh_is_the_same_without_manifold(shape, monkeypatch):
    """The same vertices in the same places and as far inside, only flat faces may be cut otherwise."""
    mesh = Mesh("m", np.array(shape.vertices) + 7.0, np.array(shape.faces))

    def made() -> tuple[np.ndarray, float, list[str]]:
        report = Report()
        hull = collision_hulls(Scene(meshes=[mesh]), [(0, "P/b")], report)[0]
        ordered = hull.vertices[np.lexsort(hull.vertices.T)]
        return ordered, solid_volume(hull.vertices, hull.faces), [d.message for d in report.diagnostics]

    by_manifold = made()
    monkeypatch.setattr(hulls, "_manifold", lambda: None)
    by_qhull = made()
    assert np.array_equal(by_manifold[0], by_qhull[0]) and by_manifold[2] == by_qhull[2]
    assert by_manifold[1] == pytest.approx(by_qhull[1], rel=1e-9)


def placed_solids(content: dict, buffer: bytes) -> list[tuple[str, int | None, object]]:
    """Each collider of a scene file as a solid in the world: its object, the object whose Rigidbody moves it, the solid."""
    import manifold3d

    poses: list[tuple[np.ndarray, np.ndarray]] = []
    movers: list[int | None] = []
    found = []
    for i, entry in enumerate(content["gameObjects"]):
        t = entry.get("transform", {})
        turn = matrix_from_quaternion(np.array(t.get("localRotation", (0, 0, 0, 1.0))))
        at = np.array(t.get("localPosition", (0, 0, 0.0)))
        above, over = (np.eye(3), np.zeros(3)) if entry.get("parent") is None else poses[entry["parent"]]
        poses.append((above @ turn, above @ at + over))
        components = entry.get("components", [])
        own = any(c["type"] == "Rigidbody" for c in components)
        movers.append(i if own else None if entry.get("parent") is None else movers[entry["parent"]])
        for c in components:
            if c["type"] == "MeshCollider":
                mesh = content["meshes"][c["mesh"]]
                points = np.frombuffer(
                    buffer, "<f4", 3 * mesh["vertexCount"], mesh["positions"]["offset"]
                ).reshape(-1, 3)
                count = sum(s["indexCount"] for s in mesh["submeshes"])
                kind = "<u2" if mesh["indexFormat"] == "uint16" else "<u4"
                faces = np.frombuffer(buffer, kind, count, mesh["indices"]["offset"]).reshape(-1, 3)
                points, numbers = np.unique(points, axis=0, return_inverse=True)
                world = points.astype(float) @ poses[i][0].T + poses[i][1]
                faces = numbers.reshape(-1)[faces][:, ::-1]  # Unity winds clockwise
                solid = manifold3d.Manifold(manifold3d.Mesh64(world, faces.astype(np.uint64)))
                found.append((entry["id"], movers[i], solid))
    return found


def overlapping(content: dict, buffer: bytes) -> set[tuple[str, str]]:
    """Pairs of objects whose colliders share a volume thicker than Unity's contact offset and that no joint keeps apart."""
    solids = placed_solids(content, buffer)
    joined = {
        frozenset((mover_of, c["connectedBody"]))
        for mover_of, entry in enumerate(content["gameObjects"])
        for c in entry.get("components", [])
        if c["type"].endswith("Joint") and "connectedBody" in c
    }
    found = set()
    for (a, first, x), (b, second, y) in itertools.combinations(solids, 2):
        if first == second or frozenset((first, second)) in joined:
            continue
        assert not x.is_empty() and not y.is_empty()
        if not (shared := x ^ y).is_empty():
            low, high = np.reshape(shared.bounding_box(), (2, 3))
            if (high - low).min() > 0.009:
                found.add((a, b))
    return found


@MANIFOLD
@COAL
@pytest.mark.parametrize("options, expected", [({}, 0), ({"colliders": "hull", "ground": "world"}, 2)])
def test_no_overlap_of_the_lever_stays_untold(options, expected, tmp_path):
    """By default none is left; with hulls on a static ground the slider in its guide and the shaft in its boss are told,
    as an independent intersection of the written colliders finds them."""
    result = kinefab.export(
        FIXTURES / "lever/lever.bundle.json", tmp_path / "l.kinefab", kinefab.ExportOptions(**options)
    )
    scene, buffer = (path.read_bytes() for path in result.files)
    pairs = overlapping(json.loads(scene), buffer)
    told = [d.message for d in result.report.diagnostics if d.code == "COLLIDERS_OVERLAP"]
    assert len(told) == len(pairs) == expected
    assert all(any(f"{a} and {b}" in m or f"{b} and {a}" in m for m in told) for a, b in pairs)
