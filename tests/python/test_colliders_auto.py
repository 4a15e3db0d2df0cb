"""Colliders that are chosen: hollow where Unity allows it, in pieces where it does not; what overlaps at the start is told."""

from __future__ import annotations

import json
from importlib.util import find_spec

import kinefab
import numpy as np
import pytest
import trimesh
from kinefab.geometry.contact import decomposition
from kinefab.geometry.mass import solid_properties

COACD = pytest.mark.skipif(find_spec("coacd") is None, reason="coacd is not installed")
COAL = pytest.mark.skipif(find_spec("coal") is None, reason="coal is not installed")
RING = trimesh.creation.annulus(0.1, 0.2, 0.1, sections=16)


def exported(tmp_path, *parts, joints=(), **options):
    """parts: (name, mesh, translation, grounded, collider)."""
    scene = kinefab.Scene()
    for name, mesh, at, grounded, collider in parts:
        scene.add_part(name, mesh, translation=at, grounded=grounded, collider=collider)
    for a, b in joints:
        scene.add_hinge(a, b, point=(0, 0, 0), axis=(0, 0, 1))
    result = kinefab.export(scene, tmp_path / "c.kinefab", kinefab.ExportOptions(**options))
    return json.loads(result.path.read_text("utf-8")), result


def colliders(content: dict, name: str) -> list[dict]:
    (entry,) = (e for e in content["gameObjects"] if e["id"] == name)
    return [c for c in entry["components"] if c["type"].endswith("Collider")]


@COACD
@pytest.mark.parametrize("asked", ["auto", "decompose"])
def test_a_hollow_moving_part_is_in_convex_pieces(asked, tmp_path):
    """Together they fill the ring, not its hole: 3 % of the volume, where the hull has a third too much."""
    content, result = exported(tmp_path, ("Ring", RING, (0, 0, 0), False, None), colliders=asked)
    found = colliders(content, "Ring")
    assert len(found) > 3 and all(c["convex"] for c in found)
    volumes = []
    for c in found:
        mesh = result.unity.meshes[c["mesh"]]
        assert len(mesh.triangles) <= 255
        volumes.append(solid_properties(mesh.vertices.astype(float), mesh.triangles, 1.0).mass)
        assert np.linalg.norm(mesh.vertices[:, :2].mean(axis=0)) > 0.05
    assert sum(volumes) == pytest.approx(RING.volume, rel=0.1)


def test_without_the_library_hulls_collide_and_it_is_told_once(tmp_path, monkeypatch):
    """Each collider is a feature of its own; the reason is one finding, with the count and the names."""
    monkeypatch.setattr(decomposition, "find_spec", lambda name: None)
    parts = [(name, RING, (at, 0, 0), False, None) for at, name in enumerate(("Ring", "Washer", "Tube"))]
    content, result = exported(tmp_path, *parts)
    for name, *_ in parts:
        (collider,) = colliders(content, name)
        assert collider["convex"] is True
    (told,) = (d for d in result.report.diagnostics if d.code == "COLLIDERS_NOT_CUT")
    assert "3 in all: Ring/Ring, Washer/Washer, Tube/Tube." in told.message
    lost = [o for o in result.report.outcomes if o.code == "COLLIDERS_NOT_CUT"]
    assert [o.feature for o in lost] == ["collider Ring/Ring", "collider Washer/Washer", "collider Tube/Tube"]
    assert {o.outcome for o in lost} == {kinefab.Outcome.APPROXIMATED}


def test_a_grounded_part_keeps_its_hole_and_a_solid_one_its_hull(tmp_path):
    solid = trimesh.creation.cylinder(0.1, 0.1)
    content, _ = exported(
        tmp_path, ("Guide", RING, (0, 0, 0), True, None), ("Block", solid, (1, 0, 0), False, None),
        ("Own", RING, (2, 0, 0), False, "hull"),
    )  # fmt: skip
    (guide,), (block,), (own,) = (colliders(content, name) for name in ("Guide", "Block", "Own"))
    assert not guide.get("convex", False) and block["convex"] and own["convex"]


def overlaps(result) -> list[str]:
    return [d.message for d in result.report.diagnostics if d.code == "COLLIDERS_OVERLAP"]


@COAL
@pytest.mark.parametrize("gap, depth", [(-0.03, "0.03"), (-0.015, "0.015"), (-0.001, None), (0.01, None)])
def test_parts_that_overlap_are_told_with_their_depth(gap, depth, tmp_path):
    box = trimesh.creation.box((0.4, 0.2, 0.3))
    content, result = exported(
        tmp_path, ("A", box, (0, 0, 0), False, None), ("B", box, (0, 0.2 + gap, 0), False, None)
    )
    told = overlaps(result)
    assert len(told) == (depth is not None)
    assert depth is None or f"of A and B overlap by {depth} m" in told[0]


@COAL
def test_joined_parts_do_not_collide_and_a_pin_fits_its_hole(tmp_path):
    box = trimesh.creation.box((0.4, 0.2, 0.3))
    pin = trimesh.creation.cylinder(0.08, 0.2, sections=16)
    _, result = exported(
        tmp_path, ("A", box, (0, 0, 0), False, None), ("B", box, (0, 0.1, 0), False, None),
        ("Hole", RING, (2, 0, 0), True, None), ("Pin", pin, (2, 0, 0), False, None), joints=[(0, 1)],
    )  # fmt: skip
    assert overlaps(result) == []
    _, result = exported(
        tmp_path, ("Hole", RING, (2, 0, 0), True, "hull"), ("Pin", pin, (2, 0, 0), False, None)
    )
    (told,) = overlaps(result)
    assert "Hole and Pin" in told or "Pin and Hole" in told


def test_without_the_library_the_check_is_told_to_be_missing(tmp_path, monkeypatch):
    monkeypatch.setattr("kinefab.unity.contact.overlaps.is_available", lambda: False)
    box = trimesh.creation.box((1, 1, 1))
    for apart, told in (
        (0.9, ["OVERLAPS_NOT_CHECKED"]),
        (0.995, []),
        (2.0, []),
    ):  # boxes that stand clear need no check
        _, result = exported(
            tmp_path, ("A", box, (0, 0, 0), False, None), ("B", box, (apart, 0, 0), False, None)
        )
        assert [d.code for d in result.report.diagnostics if "OVERLAP" in d.code] == told
