"""The meshes of named shapes: closed, wound outwards, as large as they say."""

from __future__ import annotations

import math

import numpy as np
import pytest
from kinefab.geometry.closure import is_closed, welded
from kinefab.geometry.collision import prism
from kinefab.geometry.mass import solid_properties
from kinefab.geometry.primitives import box, capsule, cone, cylinder, ellipsoid, plane, sphere

SHAPES = {
    "box": (box((0.2, 0.5, 1.1)), 0.2 * 0.5 * 1.1, (0.2, 0.5, 1.1)),
    "sphere": (sphere(0.3), 4.0 / 3.0 * math.pi * 0.3**3, (0.6, 0.6, 0.6)),
    "ellipsoid": (ellipsoid((0.1, 0.2, 0.3)), 4.0 / 3.0 * math.pi * 0.006, (0.2, 0.4, 0.6)),
    "cylinder": (cylinder(0.2, 1.1), math.pi * 0.04 * 1.1, (0.4, 0.4, 1.1)),
    "capsule": (capsule(0.2, 0.7), math.pi * 0.04 * 0.7 + 4.0 / 3.0 * math.pi * 0.008, (0.4, 0.4, 1.1)),
    "cone": (cone(0.2, 0.9), math.pi * 0.04 * 0.3, (0.4, 0.4, 0.9)),
}


@pytest.mark.parametrize("name", SHAPES)
def test_a_shape_is_closed_wound_outwards_and_of_its_size(name):
    mesh, volume, size = SHAPES[name]
    assert is_closed(welded(mesh.vertices, mesh.faces))
    assert solid_properties(mesh.vertices, mesh.faces, 1.0).mass == pytest.approx(volume, rel=0.012)
    assert np.ptp(mesh.vertices, axis=0) == pytest.approx(size, rel=1e-12)
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    outward = np.cross(b - a, c - a)
    assert (np.linalg.norm(outward, axis=1) > 0.0).all()
    assert np.linalg.norm(mesh.normals, axis=1) == pytest.approx(1.0)
    for i in range(3):
        assert (np.einsum("ni,ni->n", outward, mesh.normals[mesh.faces[:, i]]) > 0.0).all()
    assert mesh.uvs[0].min() >= 0.0 and mesh.uvs[0].max() <= 1.0


def test_the_prism_of_a_cylinder_is_closed_wound_outwards_and_as_far_out_as_in():
    mesh = prism(0.2, 1.1)
    assert is_closed(welded(mesh.vertices, mesh.faces))
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    assert (
        np.einsum("ni,ni->n", np.cross(b - a, c - a), a + b + c) > 0.0
    ).all()  # it is convex and about the origin
    out = np.hypot(*mesh.vertices[:, :2].T).max()
    assert out - 0.2 == pytest.approx(0.2 - out * math.cos(math.pi / 32), rel=0.01)
    assert np.ptp(mesh.vertices[:, 2]) == pytest.approx(1.1) and mesh.vertices[:, 2].max() == pytest.approx(
        0.55
    )


def test_normals_of_what_is_round_are_those_of_the_round_surface():
    """An ellipsoid's along its gradient; a cone's across the lines from its base to its tip, which is 0.45 up."""
    mesh = SHAPES["ellipsoid"][0]
    gradient = mesh.vertices / np.square((0.1, 0.2, 0.3))
    assert np.allclose(mesh.normals, gradient / np.linalg.norm(gradient, axis=1)[:, None])
    mesh = SHAPES["cone"][0]
    side = (mesh.normals[:, 2] > 0.0) & (mesh.vertices[:, 2] < 0.0)
    assert side.sum() > 40
    lines = np.array([0.0, 0.0, 0.45]) - mesh.vertices[side]
    assert np.allclose(np.einsum("ni,ni->n", lines, mesh.normals[side]), 0.0)


def test_a_plane_faces_upwards():
    mesh = plane(2.0, 3.0)
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    assert (np.cross(b - a, c - a)[:, 2] > 0.0).all()
    assert np.ptp(mesh.vertices, axis=0) == pytest.approx((2.0, 3.0, 0.0))  # width, length


def test_a_cone_stands_on_its_base():
    mesh, _, _ = SHAPES["cone"]
    assert np.hypot(*mesh.vertices[mesh.vertices[:, 2] > 0.4][:, :2].T).max() < 1e-12
