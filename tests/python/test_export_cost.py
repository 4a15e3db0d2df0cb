"""What makes an export of many parts cheap: no pair of parts is compared twice over, nothing is walked or worked out again."""

from __future__ import annotations

import gc
import json
import subprocess
import sys
from pathlib import Path

import kinefab
import numpy as np
import pytest
import trimesh
from kinefab import pipeline
from kinefab.analysis.collector import collector_paused
from kinefab.diagnostics import Report
from kinefab.geometry import closure, hulls, loading, mass, weighing
from kinefab.geometry.contact import cuts, decomposition
from kinefab.geometry.looks import shading
from kinefab.model import Mesh
from kinefab.targets.prefab.text import ids, yaml


def plates_in_one_file(tmp_path, lengths, **stated):
    """A bundle of plates with one corner at the origin: all of one topology, told apart by their length alone.

    stated: of every part.
    """
    scene = trimesh.Scene()
    for i, length in enumerate(lengths):
        plate = trimesh.creation.box((length, 0.2, 0.05))
        plate.apply_translation(plate.extents / 2)
        scene.add_geometry(plate, node_name=f"P{i}", geom_name=f"P{i}")
    scene.export(tmp_path / "a.glb")
    parts = [
        {"id": f"P{i}", "name": f"P{i}", "kind": "part", "bodies": [{"id": "b", "meshKey": f"P{i}"}]}
        | {"pose": {"o": [10.0 * i, 0, 0], "x": [1, 0, 0], "y": [0, 1, 0], "z": [0, 0, 1]}, **stated}
        for i in range(len(lengths))
    ]
    mesh = {"files": ["a.glb"], "layout": "single", "coordinates": "part", "key": "object", "units": "m"}
    meta = {"format": "kinefab.bundle", "version": "1.0", "handed": "right", "up": "Y", "mesh": mesh}
    meta["units"] = {"length": "m", "angle": "deg", "mass": "kg"}
    path = tmp_path / "a.bundle.json"
    path.write_text(json.dumps({"meta": meta, "components": parts}))
    return path


def test_parts_of_one_topology_are_compared_with_those_alone_that_may_be_equal(tmp_path, monkeypatch):
    """Sixty plates of thirty lengths, all with the same first corner: one comparison for each copy, none for others."""
    compared = []
    deviation = loading._deviation
    monkeypatch.setattr(loading, "_deviation", lambda a, b: compared.append(1) or deviation(a, b))
    lengths = [0.3 + 0.01 * (i % 30) for i in range(60)]
    result = kinefab.export(plates_in_one_file(tmp_path, lengths), tmp_path / "a.kinefab")
    assert len(result.analysed.scene.meshes) == 30
    assert [n.bodies[0].mesh for n in result.analysed.scene.nodes if n.bodies] == [*range(30), *range(30)]
    assert len(compared) == 30


def test_a_copy_of_a_definition_is_held_against_its_first_part_alone(tmp_path, monkeypatch):
    """Of twelve parts of one definition ten are its shape; the two that are not are looked for among all, and told."""
    searched = []
    share = loading._Loading._share
    monkeypatch.setattr(
        loading._Loading, "_share", lambda self, *given: searched.append(1) or share(self, *given)
    )
    lengths = [0.3] * 6 + [0.4] + [0.3] * 4 + [0.4]
    source = plates_in_one_file(tmp_path, lengths, definition="plate.ipt")
    result = kinefab.export(source, tmp_path / "a.kinefab")
    assert [n.bodies[0].mesh for n in result.analysed.scene.nodes if n.bodies] == [
        *map(int, np.array(lengths) > 0.35)
    ]
    assert len(searched) == 3
    assert [d.code for d in result.report.diagnostics].count("BODY_SHAPE_DIFFERS") == 2


@pytest.mark.parametrize("noise", [0.9, -0.9])
def test_a_mesh_is_found_again_within_its_tolerance(tmp_path, noise):
    """What a vertex may differ by, all of them may: also when their mean does."""
    size = 0.3
    stretched = size * (1 + noise * loading.SAME_SHAPE)
    result = kinefab.export(plates_in_one_file(tmp_path, [size, stretched]), tmp_path / "a.kinefab")
    assert len(result.analysed.scene.meshes) == 1


def test_copies_are_weighed_together(tmp_path, monkeypatch):
    """Twelve plates of three lengths: three masses, which their copies have too; what stands elsewhere in its part has its own."""
    combined = []
    monkeypatch.setattr(weighing, "combined", lambda known: combined.append(1) or mass.combined(known))
    lengths = [0.3 + 0.1 * (i % 3) for i in range(12)]
    result = kinefab.export(plates_in_one_file(tmp_path, lengths), tmp_path / "a.kinefab")
    found = [node.mass.mass for node in result.analysed.scene.nodes if node.mass is not None]
    assert found == pytest.approx([1000.0 * length * 0.2 * 0.05 for length in lengths])
    assert len(combined) == 3
    scene = kinefab.Scene()
    for i in range(2):
        plate = trimesh.creation.box((0.3, 0.2, 0.05)).apply_translation((0.1 * i, 0, 0))
        scene.add_part(f"P{i}", plate)
    centers = [
        node.mass.center[0] for node in kinefab.export(scene, tmp_path / "b.kinefab").analysed.scene.nodes
    ]
    assert centers == pytest.approx([0.0, 0.1])


@pytest.mark.parametrize("fails", [False, True])
def test_the_collector_waits_for_an_export_and_runs_again(tmp_path, monkeypatch, fails):
    seen = []
    weigh = pipeline.weigh

    def watched(*arguments):
        seen.append(gc.isenabled())
        if fails:
            raise kinefab.KinefabError([])
        return weigh(*arguments)

    monkeypatch.setattr(pipeline, "weigh", watched)
    source = plates_in_one_file(tmp_path, [0.3])
    try:
        kinefab.export(source, tmp_path / "a.kinefab")
    except kinefab.KinefabError:
        assert fails
    assert seen == [False]
    assert gc.isenabled()


def test_colliders_are_made_of_the_source_s_vertices(tmp_path, monkeypatch):
    """A box of 8 corners is drawn with 24 for its hard edges; its hull needs 8, and nothing is welded that was one."""
    points, welded = [], []
    small_hull, joined = hulls._small_hull, closure.joined_vertices
    monkeypatch.setattr(hulls, "_small_hull", lambda p: points.append(len(p)) or small_hull(p))
    monkeypatch.setattr(closure, "joined_vertices", lambda *a: welded.append(1) or joined(*a))
    options = kinefab.ExportOptions(colliders="hull")
    result = kinefab.export(plates_in_one_file(tmp_path, [0.3]), tmp_path / "a.kinefab", options)
    source = result.analysed.scene.meshes[0]
    assert points == [len(source.vertices)] and welded == []
    assert len(result.unity.meshes[0].vertices) == 24


def test_edges_between_three_faces_are_hard():
    """An edge that two faces leave the same way, or three share, joins none of them."""
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, -1, 0.1], [0, -1, -0.1]], dtype=float)
    faces = np.array([[0, 1, 2], [1, 0, 3], [1, 0, 4], [0, 1, 2]])
    found = shading.shaded(Mesh("fin", vertices, faces), 10.0)
    assert len({tuple(corners) for corners in found.faces[:, :2].tolist()}) == 4


def test_ids_of_like_components_are_hashed_once_each(monkeypatch):
    """Sixteen pieces of one part's collider are sixteen hashes, not a hundred and thirty-six; the ids are as before."""
    hashed = []
    each = ids.xxh64_each
    monkeypatch.setattr(ids, "xxh64_each", lambda texts: hashed.extend(texts) or each(texts))
    found = ids.FileIds().each([("MeshCollider", "Ring")] * 16)
    names = ["Ring", *(f"Ring#{k}" for k in range(2, 17))]
    assert hashed == [f"Kinefab:MeshCollider->{name}".encode() for name in names]
    assert found == [value & (2**63 - 1) for value in each(hashed)]


def test_a_plane_is_tried_once():
    """A plate along the frame's axes spreads along them too: three middles, not six; turned, it has six."""
    plate = np.array(trimesh.creation.box((0.3, 0.2, 0.05)).vertices)
    assert len(cuts._middles(plate)) == 3
    turned = plate @ trimesh.transformations.euler_matrix(0.3, 0.5, 0.7)[:3, :3].T
    assert len(cuts._middles(turned)) == 6


def test_floats_beyond_those_of_unity_are_infinite():
    """The largest float32 is written as itself, and what is rounded to none as Unity says it, both without a warning."""
    largest = float(np.finfo(np.float32).max)
    half = largest + 2.0**102
    assert yaml.number(largest) == yaml.number(half) == "3.4028235e+38"
    assert yaml.number(largest + 2.0**103) == "Infinity" and yaml.number(-1e300) == "-Infinity"


def test_what_a_mesh_file_leaves_behind_is_freed_while_the_collector_waits(tmp_path):
    """A trimesh scene refers to itself in circles; of a thousand files none stays beside the pieces that were read."""

    def scenes() -> int:
        return sum(isinstance(thing, trimesh.Trimesh) for thing in gc.get_objects())

    paths = [tmp_path / f"{i}.stl" for i in range(5)]
    for path in paths:
        trimesh.creation.box((0.3, 0.2, 0.05)).export(path)
    gc.collect()
    before = scenes()
    with collector_paused():
        files = loading.MeshFiles(Report())
        assert all(files.get(path, "here") is not None for path in paths)
        assert scenes() <= before


def test_an_obj_is_exported_without_trimesh(tmp_path):
    """Its import is a quarter of what a small export costs."""
    lever = Path(__file__).parents[2] / "fixtures" / "lever" / "lever.bundle.json"
    code = "import kinefab, sys; kinefab.export(*sys.argv[1:]); print('trimesh' in sys.modules)"
    command = [sys.executable, "-c", code, str(lever), str(tmp_path / "lever.kinefab")]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False"]


def test_a_mesh_that_was_weighed_is_not_measured_again(tmp_path, monkeypatch):
    """Whether it is hollow follows from the volume found when it was weighed; an open one has none, one wound inwards its own."""
    tube = trimesh.creation.annulus(0.08, 0.1, 0.3)
    turned, lid = tube.copy(), tube.copy()
    turned.invert()
    lid.update_faces(np.arange(len(lid.faces)) > 3)
    scene = kinefab.Scene()
    for i, shape in enumerate((tube, turned, lid)):
        scene.add_part(f"P{i}", shape, translation=(i, 0, 0))
    measured = []
    volume = decomposition.solid_volume
    monkeypatch.setattr(decomposition, "solid_volume", lambda v, f: measured.append(len(f)) or volume(v, f))
    result = kinefab.export(scene, tmp_path / "a.kinefab")
    first, second, third = (mesh.volume for mesh in result.analysed.scene.meshes)
    assert first == pytest.approx(tube.volume) == second and third is None
    assert measured.count(len(tube.faces)) == 0 and measured.count(len(lid.faces)) == 1
