"""Shapes of OpenCASCADE as meshes: closed where the solid is, faces to submeshes, normals of the surfaces."""

from __future__ import annotations

import math

import numpy as np
import pytest
from kinefab.geometry.closure import is_closed, welded
from kinefab.geometry.mass import solid_properties
from kinefab.sources.occ.triangles import Tolerance, mesh_of

pytest.importorskip("OCP", reason="OpenCASCADE is not installed: pip install cadquery-ocp-novtk")

from kinefab.sources.occ.tessellation import faces_of, tessellate  # noqa: E402
from OCP.BRep import BRep_Builder  # noqa: E402
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut  # noqa: E402
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder, BRepPrimAPI_MakeSphere  # noqa: E402
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec  # noqa: E402
from OCP.TopLoc import TopLoc_Location  # noqa: E402
from OCP.TopoDS import TopoDS_Compound  # noqa: E402

MM = 1e-3
VOLUME = 10 * 20 * 30 - math.pi * 4 * 30


@pytest.fixture(scope="module")
def drilled():
    """A block of 10 x 20 x 30 with a hole of radius 2 along Z at (5, 5)."""
    block = BRepPrimAPI_MakeBox(10, 20, 30).Shape()
    drill = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(5, 5, -1), gp_Dir(0, 0, 1)), 2, 40).Shape()
    return BRepAlgoAPI_Cut(block, drill).Shape()


def moved(shape, trsf):
    return shape.Moved(TopLoc_Location(trsf), False)


def test_a_solid_gives_a_closed_mesh_of_its_volume(drilled):
    found = tessellate(drilled, Tolerance(chord=1e-6, angle=math.radians(5.0)), MM)
    assert is_closed(welded(found.vertices, found.triangles)) and found.missing == 0
    solid = solid_properties(found.vertices, found.triangles, 1.0)
    assert solid.mass == pytest.approx(VOLUME, rel=1e-4)
    assert solid.center[1] == pytest.approx((6000 * 10 - 120 * math.pi * 5) / VOLUME, rel=1e-4)


def test_a_finer_chord_comes_closer(drilled):
    missed = [
        abs(solid_properties(t.vertices, t.triangles, 1.0).mass - VOLUME)
        for t in (tessellate(drilled, Tolerance(chord, angle=1.5), MM) for chord in (1e-4, 1e-5, 1e-6))
    ]
    assert missed[0] > 5 * missed[1] > 25 * missed[2]


def test_a_chord_is_in_metres_whatever_the_unit_of_the_shape(drilled):
    in_mm, in_m = tessellate(drilled, Tolerance(1e-5), MM), tessellate(drilled, Tolerance(1e-2), 1.0)
    assert np.array_equal(in_mm.triangles, in_m.triangles)


def test_what_was_done_before_does_not_show(drilled):
    first = tessellate(drilled, Tolerance(), MM)
    tessellate(drilled, Tolerance(chord=1e-6), MM)
    again = tessellate(drilled, Tolerance(), MM)
    assert np.array_equal(first.vertices, again.vertices) and np.array_equal(first.triangles, again.triangles)


def test_normals_are_those_of_the_surface():
    found = tessellate(BRepPrimAPI_MakeSphere(gp_Pnt(1, 2, 3), 5).Shape(), Tolerance(), MM)
    outward = (found.vertices - [1, 2, 3]) / 5
    assert np.abs(found.normals - outward).max() < 1e-6  # not of the triangles, which lie some 10 degrees off


@pytest.mark.parametrize("case", ["as it is", "moved", "mirrored", "inside out"])
def test_winding_and_normals_agree(drilled, case):
    shift, mirror = gp_Trsf(), gp_Trsf()
    shift.SetTranslation(gp_Vec(7, -3, 11))
    mirror.SetMirror(gp_Ax2(gp_Pnt(1, 2, 3), gp_Dir(1, 0, 0)))
    shape = {
        "as it is": drilled, "moved": moved(drilled, shift), "mirrored": moved(drilled, mirror),
        "inside out": drilled.Reversed(),
    }[case]  # fmt: skip
    found = tessellate(shape, Tolerance(), MM)
    a, b, c = (found.vertices[found.triangles[:, k]] for k in range(3))
    for k in range(3):
        across = np.einsum("ni,ni->n", np.cross(b - a, c - a), found.normals[found.triangles[:, k]])
        assert (across > 0.0).all()
    volume = solid_properties(found.vertices, found.triangles, 1.0).mass
    assert volume == pytest.approx(-VOLUME if case == "inside out" else VOLUME, rel=1e-3)
    center = solid_properties(found.vertices, found.triangles, 1.0).center
    expected = {"moved": [12, 7.3334, 26], "mirrored": [-3, 10.3334, 15]}.get(case, [5, 10.3334, 15])
    assert center == pytest.approx(expected, abs=1e-3)


def test_faces_are_numbered_once():
    """A face that stands twice in a compound has one number, its twin elsewhere another."""
    face = faces_of(BRepPrimAPI_MakeBox(1, 2, 3).Shape())[0]
    shift = gp_Trsf()
    shift.SetTranslation(gp_Vec(5, 0, 0))
    builder, compound = BRep_Builder(), TopoDS_Compound()
    builder.MakeCompound(compound)
    for part in (face, face.Reversed(), moved(face, shift)):
        builder.Add(compound, part)
    assert len(faces_of(compound)) == 2


def test_looks_become_submeshes(drilled):
    """Faces of one look share a submesh, in the order of first use; the turn and the unit are those of the map."""
    found = tessellate(drilled, Tolerance(), MM)
    to_node = np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1000]]) * MM
    looks = ["red", "blue", "red", "blue", "green", "red", "blue"]
    mesh, order = mesh_of("block", found, to_node, looks)
    assert order == ("red", "blue", "green")
    expected = [sum(c for c, look in zip(found.counts, looks) if look == one) for one in order]
    assert mesh.face_counts == tuple(expected) and sum(expected) == len(mesh.faces)
    assert np.ptp(mesh.vertices, axis=0) == pytest.approx([0.01, 0.03, 0.02])
    assert solid_properties(mesh.vertices, mesh.faces, 1.0).mass == pytest.approx(VOLUME * 1e-9, rel=1e-3)
    mirrored, _ = mesh_of("block", found, to_node @ np.diag([-1.0, 1, 1, 1]), ())
    assert solid_properties(mirrored.vertices, mirrored.faces, 1.0).mass == pytest.approx(
        VOLUME * 1e-9, rel=1e-3
    )


def test_an_empty_shape_has_no_triangles():
    builder, compound = BRep_Builder(), TopoDS_Compound()
    builder.MakeCompound(compound)
    found = tessellate(compound, Tolerance(), MM)
    assert found.counts == () and len(found.vertices) == len(found.triangles) == 0
