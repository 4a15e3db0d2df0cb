"""STEP and IGES: the tree, names, instances, colours, units and exact faces; damaged files end in findings."""

from __future__ import annotations

import os
import pickle
import random
import re
import signal
import subprocess
import sys
from pathlib import Path

import kinefab
import numpy as np
import pytest
from kinefab.diagnostics import KinefabError, Report
from kinefab.geometry.closure import is_closed, welded
from kinefab.geometry.mass import solid_properties
from kinefab.model import FaceKind, NodeKind, Scene
from kinefab.sources import read
from kinefab.sources.guard import GuardedCrash, GuardedError, command, end_idle, guarded
from kinefab.sources.step import reader
from kinefab.sources.step.iges.unit import metres_of
from kinefab.sources.step.part21 import Part21
from kinefab.sources.step.records import Begun

pytest.importorskip("OCP", reason="OpenCASCADE is not installed: pip install cadquery-ocp-novtk")

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
sys.path.insert(0, str(FIXTURES))

from kinefab.sources.occ.sewing import sewn  # noqa: E402
from kinefab.sources.occ.tessellation import faces_of  # noqa: E402
from kinefab.sources.step.xcaf import _children, _name  # noqa: E402
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut  # noqa: E402
from OCP.Quantity import Quantity_Color, Quantity_TOC_sRGB  # noqa: E402
from OCP.XCAFDoc import XCAFDoc_ColorType, XCAFDoc_DocumentTool  # noqa: E402
from step.linkages import two_plates  # noqa: E402
from step.machine import Machine  # noqa: E402
from step.solids import box  # noqa: E402
from step.tessellated import triangles_alone, write_tessellated  # noqa: E402
from step.writer import (  # noqa: E402
    document_of,
    write_document,
    write_external,
    write_iges,
    write_iges_document,
    write_step,
)

LEVER = FIXTURES / "lever" / "lever.step"
PLATES = FIXTURES / "step" / "two_plates_inch_ap242.step"
MUTATIONS = int(os.environ.get("KINEFAB_STEP_MUTATIONS", "25"))
IGES_MUTATIONS = int(os.environ.get("KINEFAB_IGES_MUTATIONS", "15"))
"""Damaged files to try; 5000 for the long run."""


def read_whole(path: Path, **options: object):
    report = Report()
    return read(path, report, options=options), report


def codes(path: Path, **options: object) -> list[str]:
    report = Report()
    with pytest.raises(KinefabError):
        read(path, report, options=options)
    return [d.code for d in report.diagnostics]


def test_the_tree_has_the_names_and_poses_of_the_file():
    scene, report = read_whole(PLATES)
    assert not report.diagnostics
    assert [(n.id, n.kind, n.parent) for n in scene.nodes] == [
        ("Plates", NodeKind.ASSEMBLY, None),
        ("Plates/Plate:1", NodeKind.PART, 0),
        ("Plates/Upper", NodeKind.ASSEMBLY, 0),
        ("Plates/Upper/Plate:2", NodeKind.PART, 2),
    ]
    # Z up becomes Y up: (100, 20, 5) mm is (0.1, 0.005, -0.02) m; a turn about Z is one about Y
    np.testing.assert_allclose(scene.nodes[3].pose.translation, [0.1, 0.005, -0.02], atol=1e-9)
    np.testing.assert_allclose(scene.nodes[3].pose.rotation @ [1.0, 0.0, 0.0], [0.0, 0.0, -1.0], atol=1e-12)


def test_occurrences_of_a_product_share_mesh_and_faces():
    scene, _ = read_whole(PLATES)
    first, second = (scene.nodes[i].bodies[0] for i in (1, 3))
    assert first.mesh == second.mesh and first.boundary is second.boundary
    assert scene.nodes[1].definition == scene.nodes[3].definition
    assert len(scene.meshes) == 1


def test_an_inch_file_is_read_in_metres():
    scene, _ = read_whole(PLATES)
    assert scene.source.meters_per_unit == 0.0254
    np.testing.assert_allclose(np.ptp(scene.meshes[0].vertices, axis=0), [0.0508, 0.01, 0.0254], atol=1e-9)


def test_colours_are_linear():
    scene, _ = read_whole(PLATES)
    (surface,) = scene.surfaces
    assert surface.name == "#FF8000"
    np.testing.assert_allclose(surface.color, (1.0, 0.2140, 0.0, 1.0), atol=1e-3)
    assert scene.nodes[1].bodies[0].surfaces == (0,)


def test_what_has_no_colour_has_that_of_the_assembly_round_it(tmp_path: Path):
    """Of two occurrences of one product the one in a red sub-assembly is red; what is green there stays green."""
    machine = Machine("Top")
    machine.add("Loose", box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)), product="Plain")
    machine.add(
        "Inside", box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)), (5.0, 0.0, 0.0), product="Plain", group="Red"
    )
    green = box((0.0, 0.0, 0.0), (2.0, 1.0, 1.0))
    machine.add("Green", green, (9.0, 0.0, 0.0), color=(0.0, 1.0, 0.0), group="Red")
    document = document_of(machine)
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    (group,) = [
        child
        for label in _children(shapes.BaseLabel())
        for child in _children(label)
        if _name(child) == "Red"
    ]
    red = Quantity_Color(1.0, 0.0, 0.0, Quantity_TOC_sRGB)
    XCAFDoc_DocumentTool.ColorTool_s(document.Main()).SetColor(
        group, red, XCAFDoc_ColorType.XCAFDoc_ColorSurf
    )
    write_document(document, tmp_path / "red.step")
    scene, report = read_whole(tmp_path / "red.step")
    assert not report.diagnostics
    seen = {
        node.name: [scene.surfaces[i].name for b in node.bodies for i in b.surfaces] for node in scene.nodes
    }
    assert seen == {"Top": [], "Loose": [], "Red": [], "Inside": ["#FF0000"], "Green": ["#00FF00"]}


@pytest.mark.parametrize("schema", ["AP203", "AP214IS", "AP242DIS"])
def test_every_application_protocol_gives_the_same_solid(tmp_path: Path, schema: str):
    write_step(two_plates(), tmp_path / "plates.stp", schema=schema)
    scene, report = read_whole(tmp_path / "plates.stp", tolerance="0.001,5")
    mesh = scene.meshes[0]
    assert not report.diagnostics
    assert is_closed(welded(mesh.vertices, mesh.faces))
    volume = solid_properties(mesh.vertices, mesh.faces, 1.0).mass
    assert volume == pytest.approx((50.8 * 25.4 - np.pi * 25.0) * 10.0 * 1e-9, rel=1e-4)


def test_iges_gives_the_same_faces(tmp_path: Path):
    """IGES of this kernel writes no tree that names can be held against; the geometry is the same."""
    write_iges(two_plates(), tmp_path / "plates.igs")
    scene, _ = read_whole(tmp_path / "plates.igs")
    vertices = np.concatenate(
        [n.pose.point(scene.meshes[b.mesh].vertices) for n in scene.nodes for b in n.bodies]
    )
    np.testing.assert_allclose(vertices.min(axis=0), [0.0, 0.0, -0.0708], atol=1e-6)
    np.testing.assert_allclose(vertices.max(axis=0), [0.1, 0.015, 0.0], atol=1e-6)
    assert scene.source.meters_per_unit == 1e-3


def test_trimmed_surfaces_of_iges_enclose_the_solids_that_they_are_of(tmp_path: Path):
    """Bores and hollows too, each face turned to the side that it has in the solid, in its colour."""
    machine = two_plates()
    hollow = BRepAlgoAPI_Cut(
        box((0.0, 0.0, 0.0), (30.0, 30.0, 30.0)), box((5.0, 6.0, 7.0), (10.0, 10.0, 10.0))
    ).Shape()
    machine.add("Hollow", hollow, (200.0, 0.0, 0.0), color=(0.0, 0.0, 1.0))
    found = []
    for solids in (True, False):
        write_iges(machine, tmp_path / "plates.igs", solids)
        scene, report = read_whole(tmp_path / "plates.igs", tolerance="0.001,5")
        assert not report.diagnostics
        meshes = [scene.meshes[b.mesh] for n in scene.nodes for b in n.bodies]
        assert len(meshes) == 3 and all(is_closed(welded(m.vertices, m.faces)) for m in meshes)
        found.append([solid_properties(m.vertices, m.faces, 1.0).mass for m in meshes])
        assert "#0000FF" in {surface.name for surface in scene.surfaces}
    plate = (50.8 * 25.4 - np.pi * 25.0) * 10.0 * 1e-9
    assert sorted(found[0]) == pytest.approx([plate, plate, (27000 - 60) * 1e-9], rel=1e-4)
    assert sorted(found[1]) == pytest.approx(sorted(found[0]), rel=1e-4)


def test_surfaces_of_iges_in_no_group_are_one_part(tmp_path: Path):
    """Most programs write each face of a part on its own, with a colour of its own."""
    document = document_of(Machine("Loose"))
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    colors = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
    for i, face in enumerate(faces_of(box((0.0, 0.0, 0.0), (10.0, 20.0, 30.0)))):
        color = Quantity_Color(0.0, 0.0, 1.0 if i else 0.0, Quantity_TOC_sRGB)
        colors.SetColor(shapes.AddShape(face, False), color, XCAFDoc_ColorType.XCAFDoc_ColorSurf)
    write_iges_document(document, tmp_path / "loose.igs", solids=False)
    scene, report = read_whole(tmp_path / "loose.igs")
    assert not report.diagnostics
    (node,) = scene.nodes
    (body,) = node.bodies
    mesh = scene.meshes[body.mesh]
    assert is_closed(welded(mesh.vertices, mesh.faces))
    assert solid_properties(mesh.vertices, mesh.faces, 1.0).mass == pytest.approx(6e-6)
    assert mesh.face_counts == (2, 10)
    assert [scene.surfaces[i].name for i in body.surfaces] == ["#000000", "#0000FF"]


def test_surfaces_that_enclose_nothing_stay_as_they_are(tmp_path: Path):
    """A box without its lid."""
    faces = faces_of(box((0.0, 0.0, 0.0), (10.0, 20.0, 30.0)))[:5]
    enclosed, rest, _ = sewn(faces)
    assert not enclosed and len(rest) == 5 and all(a.IsSame(b) for a, b in zip(rest, faces))


@pytest.mark.parametrize(
    "stated, metres",
    [
        ("2,2HMM", 1e-3),
        ("²,²HMM", 0.0254),
        ("1,4HINCH", 0.0254),
        ("6,1HM", 1.0),
        ("3,2HCM", 1e-2),
        (",", 0.0254),
    ],
)
def test_the_unit_of_an_iges_file_is_told(stated: str, metres: float):
    """Texts are counted: what parts parameters may stand in one, before the unit."""
    named = "1H,,1H;,7Ha,b;2,c,1Hf,1Hs,1Hv"
    text = f"{named},32,38,6,308,15,1Hi,1.,{stated},1,0.01;"
    rows = [text[i : i + 72].ljust(72) + f"G{i // 72 + 1:7d}" for i in range(0, len(text), 72)]
    assert metres_of("\n".join(["start".ljust(72) + "S      1", *rows]).encode()) == metres


def test_a_tessellated_file_gives_its_triangles(tmp_path: Path):
    """AP242 without exact geometry: closed, outward, and no face is taken for an exact one."""
    machine = Machine("Tessellated")
    machine.add("Plate", triangles_alone(box((0.0, 0.0, 0.0), (50.0, 40.0, 10.0))), (0.0, 0.0, 100.0))
    write_tessellated(machine, tmp_path / "plate.step")
    assert b"TRIANGULATED_FACE" in (tmp_path / "plate.step").read_bytes()
    scene, report = read_whole(tmp_path / "plate.step")
    (mesh,) = scene.meshes
    assert not report.diagnostics and is_closed(welded(mesh.vertices, mesh.faces))
    assert solid_properties(mesh.vertices, mesh.faces, 1.0).mass == pytest.approx(50 * 40 * 10 * 1e-9)
    np.testing.assert_allclose(scene.nodes[1].pose.translation, [0.0, 0.1, 0.0], atol=1e-12)


def test_exact_faces_say_what_they_are():
    scene, _ = read_whole(PLATES)
    faces = scene.nodes[1].bodies[0].boundary
    (bore,) = [face for face in faces if face.kind is FaceKind.CYLINDER]
    assert bore.hollow and bore.radius == pytest.approx(0.005, abs=1e-12)
    assert abs(bore.direction[1]) == pytest.approx(1.0)
    assert bore.along[1] - bore.along[0] == pytest.approx(0.01)
    assert bore.around[1] - bore.around[0] == pytest.approx(2.0 * np.pi)
    np.testing.assert_allclose(bore.point[[0, 2]], [0.01, -0.01], atol=1e-12)
    planes = [face for face in faces if face.kind is FaceKind.PLANE]
    middle = np.mean([face.triangles.mean(axis=(0, 1)) for face in planes], axis=0)
    assert all((face.triangles.mean(axis=(0, 1)) - middle) @ face.direction > 0.0 for face in planes)


def test_a_finer_tolerance_gives_more_triangles():
    coarse, _ = read_whole(LEVER, tolerance="1,45")
    fine, _ = read_whole(LEVER, tolerance="0.01,5")
    assert sum(len(m.faces) for m in fine.meshes) > 3 * sum(len(m.faces) for m in coarse.meshes)


def test_up_axis_can_be_told():
    scene, _ = read_whole(PLATES, up="Y")
    np.testing.assert_allclose(scene.nodes[3].pose.translation, [0.1, 0.02, 0.005], atol=1e-9)


def test_export_tells_how_far_the_reading_is(tmp_path: Path):
    """Shapes of an assembly take most of the time: each is a step."""
    told: list[float] = []
    kinefab.export(
        LEVER,
        tmp_path / "lever.kinefab",
        progress=lambda stage, done: told.append(done) if stage == "read" else None,
    )
    assert told[0] == 0.0 and told[-1] == 1.0 and told == sorted(told)
    assert sum(0.0 < done < 1.0 for done in told) > 2


def test_reading_twice_gives_the_same(tmp_path: Path):
    first, second = (read_whole(LEVER)[0] for _ in range(2))
    for a, b in zip(first.meshes, second.meshes, strict=True):
        np.testing.assert_array_equal(a.vertices, b.vertices)
        np.testing.assert_array_equal(a.faces, b.faces)


@pytest.mark.parametrize(
    "text, code",
    [
        (b"solid of another kind", "STEP_SYNTAX"),
        (LEVER.read_bytes()[:60000], "STEP_SYNTAX"),
        (b"ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n", "STEP_EMPTY"),
        (LEVER.read_bytes().replace(b"DATA;", b"DATA;\n#999999=DOCUMENT_FILE('../secret.step','',$,$,'','');", 1), "STEP_FILE_OUTSIDE"),
        (LEVER.read_bytes().replace(b"MANIFOLD_SOLID_BREP(", b"MANIFOLD_NOTHING("), "STEP_EMPTY"),
    ],
)  # fmt: skip
def test_a_file_that_is_none_is_refused(tmp_path: Path, text: bytes, code: str):
    path = tmp_path / "odd.step"
    path.write_bytes(text)
    assert code in codes(path)


def external(folder: Path, prefix: str = "p_") -> Path:
    """An assembly in inches whose parts lie in files of their own, in millimetres."""
    machine = Machine("Top")
    machine.add("Base", box((0.0, 0.0, 0.0), (50.0, 50.0, 10.0)))
    machine.add("Arm", box((0.0, 0.0, 0.0), (20.0, 5.0, 5.0)), (100.0, 0.0, 0.0))
    write_external(machine, folder / "top.step")
    text = (folder / "top.step").read_bytes().replace(b"'p_", b"'" + prefix.encode())
    (folder / "top.step").write_bytes(text)
    return folder / "top.step"


def sizes(scene: Scene) -> dict[str, list[float]]:
    """Cubic centimetres of each part's bodies."""
    meshes = [
        [scene.meshes[body.mesh] for body in node.bodies if body.mesh is not None] for node in scene.nodes
    ]
    return {
        node.id: [round(1e6 * solid_properties(m.vertices, m.faces, 1.0).mass, 6) for m in own]
        for node, own in zip(scene.nodes, meshes, strict=True)
    }


@pytest.mark.parametrize("folder", ["", "parts"])
def test_parts_in_other_files_are_read_from_wherever_one_stands(tmp_path, monkeypatch, folder):
    """By a relative path too, and though the process that reads was begun in another folder."""
    external(tmp_path, f"{folder}/p_" if folder else "p_")
    (tmp_path / folder).mkdir(exist_ok=True)
    for part in tmp_path.glob("p_*"):
        part.rename(tmp_path / folder / part.name)
    for stand, path in ((tmp_path, "top.step"), (tmp_path.parent, f"{tmp_path.name}/top.step")):
        monkeypatch.chdir(stand)
        scene, report = read_whole(Path(path))
        assert not report.diagnostics
        assert sizes(scene) == {"Top": [], "Top/Base": [25.0], "Top/Arm": [0.5]}
        np.testing.assert_allclose(scene.nodes[2].pose.translation, [0.1, 0.0, 0.0], atol=1e-9)


def test_a_part_whose_file_is_not_there_is_told_by_its_file(tmp_path):
    path = external(tmp_path)
    (tmp_path / "p_Arm.stp").unlink()
    scene, report = read_whole(path)
    assert sizes(scene) == {"Top": [], "Top/Base": [25.0], "Top/Arm": []}
    assert [d.code for d in report.diagnostics] == ["STEP_FILE_MISSING", "STEP_SHAPE_FAILED"]
    assert "p_Arm.stp" in report.diagnostics[0].message


def test_a_file_that_a_part_names_may_not_lie_outside_either(tmp_path):
    """Files name others in turn, each from its own folder; two that name each other end OpenCASCADE, which is told."""
    (tmp_path / "inner" / "sub").mkdir(parents=True)
    path = external(tmp_path / "inner")
    deeper = path.read_bytes().replace(b"'p_", b"'../p_")
    (tmp_path / "inner" / "sub" / "mid.step").write_bytes(deeper)
    path.write_bytes(path.read_bytes().replace(b"'p_Arm.stp", b"'sub/mid.step"))
    scene, report = read_whole(path)
    assert not report.diagnostics
    assert [v for own in sizes(scene).values() for v in own] == [25.0, 25.0, 0.5]
    (tmp_path / "inner" / "sub" / "mid.step").write_bytes(deeper.replace(b"'../p_", b"'../../p_"))
    assert codes(path) == ["STEP_FILE_OUTSIDE"] * 2
    (tmp_path / "inner" / "sub" / "mid.step").write_bytes(deeper.replace(b"'../p_Arm.stp", b"'../top.step"))
    assert codes(path) == ["STEP_UNREADABLE"]


@pytest.mark.parametrize("complex_instance", [False, True])
@pytest.mark.parametrize("x, told", [(1, []), (-1, ["STEP_MIRROR_TURNED"])])
def test_an_operator_that_mirrors_is_told(tmp_path: Path, complex_instance: bool, x: int, told: list[str]):
    """OpenCASCADE makes a turn by 180 degrees about Z of it."""
    machine = Machine("Top")
    machine.add("Arm", box((0.0, 0.0, 0.0), (20.0, 5.0, 5.0)))
    write_step(machine, tmp_path / "mirror.step")
    axes = "#9001,#9002,#9003,1."
    operator = f"CARTESIAN_TRANSFORMATION_OPERATOR_3D('','','',{axes},#9004);"
    if complex_instance:
        operator = (
            f"( CARTESIAN_TRANSFORMATION_OPERATOR({axes}) CARTESIAN_TRANSFORMATION_OPERATOR_3D(#9004) "
            "FUNCTIONALLY_DEFINED_TRANSFORMATION('','') GEOMETRIC_REPRESENTATION_ITEM() REPRESENTATION_ITEM('') );"
        )
    points = f"#9001=DIRECTION('',({x}.,0.,0.));\n#9002=DIRECTION('',(0.,1.,0.));\n"
    points += "#9003=CARTESIAN_POINT('',(100.,20.,0.));\n#9004=DIRECTION('',(0.,0.,1.));"
    text, count = re.subn(
        r"ITEM_DEFINED_TRANSFORMATION\([^)]*\);",
        f"{operator}\n{points}",
        (tmp_path / "mirror.step").read_text("utf-8"),
    )
    assert count == 1
    (tmp_path / "mirror.step").write_text(text, "utf-8")
    _, report = read_whole(tmp_path / "mirror.step")
    assert [d.code for d in report.diagnostics] == told
    assert [o.outcome.value for o in report.outcomes] == ["approximated" for _ in told]


def with_drawings(text: str) -> str:
    """``machine_of_two`` as NX and Creo write it: beside the solid of its base a curve, of its arm a curve alone, and the arm's
    solid as the assembly's own."""
    bodies = re.findall(
        r"(#\d+) = ADVANCED_BREP_SHAPE_REPRESENTATION\('[^']*',\((#\d+),(#\d+)\),(#\d+)\);", text
    )
    (base, _, _, context), (arm, axes, solid, _) = bodies
    top = next(
        one
        for one in re.findall(r"SHAPE_DEFINITION_REPRESENTATION\(#\d+,(#\d+)\)", text)
        if one not in (base, arm)
    )
    added = f"""#90001 = CARTESIAN_POINT('',(0.,0.,0.));
#90002 = CARTESIAN_POINT('',(30.,0.,0.));
#90003 = DIRECTION('',(1.,0.,0.));
#90004 = VECTOR('',#90003,1.);
#90005 = LINE('',#90001,#90004);
#90006 = TRIMMED_CURVE('',#90005,(#90001),(#90002),.T.,.CARTESIAN.);
#90007 = GEOMETRIC_CURVE_SET('',(#90006));
#90012 = TRIMMED_CURVE('',#90005,(#90001),(#90002),.T.,.CARTESIAN.);
#90013 = GEOMETRIC_CURVE_SET('',(#90012));
#90008 = GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION('',(#90007),{context});
#90009 = SHAPE_REPRESENTATION_RELATIONSHIP('','',{base},#90008);
#90010 = ADVANCED_BREP_SHAPE_REPRESENTATION('',({axes},{solid}),{context});
#90011 = SHAPE_REPRESENTATION_RELATIONSHIP('','',{top},#90010);
ENDSEC;
END-ISO"""
    text = re.sub(
        rf"{arm} = ADVANCED_BREP_SHAPE_REPRESENTATION\('[^']*',\({axes},{solid}\)",
        f"{arm} = GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION('',({axes},#90013)",
        text,
    )
    return re.sub(r"ENDSEC;\s*END-ISO", added, text)


def test_curves_beside_solids_are_no_bodies(tmp_path: Path):
    """The shapes of one product are one part, whatever else an assembly is of; what is curves alone does not fall."""
    machine = Machine("Top")
    machine.add("Base", box((0.0, 0.0, 0.0), (50.0, 50.0, 10.0)))
    machine.add("Arm", box((0.0, 0.0, 0.0), (20.0, 5.0, 5.0)), (100.0, 0.0, 0.0))
    path = tmp_path / "drawn.step"
    write_step(machine, path)
    path.write_text(with_drawings(path.read_text(encoding="utf-8")), encoding="utf-8")
    scene, report = read_whole(path)
    assert sizes(scene) == {"Top": [], "Top/Base": [25.0], "Top/Arm": [], "Top/Top": [0.5]}
    parts = [node.id for node in scene.nodes if node.kind is NodeKind.PART]
    assert parts == ["Top/Base", "Top/Top"]
    assert [(d.code, d.where) for d in report.diagnostics] == [("STEP_CURVES_ALONE", "drawn.step#Top/Arm")]


@pytest.mark.parametrize(
    "instead, codes", [("", []), (",#90020", ["STEP_SHAPE_FAILED"])], ids=["nothing", "what is not read"]
)
def test_a_component_without_a_shape_is_no_body(instead: str, codes: list[str], tmp_path: Path):
    """Fusion writes components of sketches alone with a placement and nothing else; they are empty, and did not fail."""
    machine = Machine("Top")
    machine.add("Base", box((0.0, 0.0, 0.0), (50.0, 50.0, 10.0)))
    machine.add("Arm", box((0.0, 0.0, 0.0), (20.0, 5.0, 5.0)), (100.0, 0.0, 0.0))
    path = tmp_path / "empty.step"
    write_step(machine, path)
    text = path.read_text(encoding="utf-8")
    shapes = re.findall(r"ADVANCED_BREP_SHAPE_REPRESENTATION\('[^']*',\(#\d+(,#\d+)\)", text)
    assert len(shapes) == 2
    text = text.replace(f"{shapes[1]})", f"{instead})", 1)
    unread = "#90020 = HALF_SPACE_SOLID('',#90021,.T.);\n#90021 = PLANE('',$);\nENDSEC;\nEND-ISO"
    path.write_text(re.sub(r"ENDSEC;\s*END-ISO", unread, text), encoding="utf-8")
    scene, report = read_whole(path)
    assert sizes(scene) == {"Top": [], "Top/Base": [25.0], "Top/Arm": []}
    assert [d.code for d in report.diagnostics] == codes
    assert (scene.nodes[2].kind is NodeKind.PART) is bool(codes)


COUNTERSINK = """#3=MANIFOLD_SURFACE_SHAPE_REPRESENTATION('',(#10),#11);
#10=SHELL_BASED_SURFACE_MODEL('',(#15));
#15=OPEN_SHELL('',(#16));
#16=ADVANCED_FACE('',(#17),#18,.F.);
#17=FACE_OUTER_BOUND('',#19,.T.);
#19=EDGE_LOOP('',(#20,#21,#22,#23));
#20=ORIENTED_EDGE('',*,*,#24,.F.);
#21=ORIENTED_EDGE('',*,*,#25,.T.);
#22=ORIENTED_EDGE('',*,*,#26,.T.);
#23=ORIENTED_EDGE('',*,*,#25,.F.);
#24=EDGE_CURVE('',#27,#27,#28,.T.);
#25=EDGE_CURVE('',#27,#29,#30,.T.);
#26=EDGE_CURVE('',#29,#29,#31,.T.);
#27=VERTEX_POINT('',#32);
#29=VERTEX_POINT('',#33);
#32=CARTESIAN_POINT('',(-17.,2.,5.));
#33=CARTESIAN_POINT('',(-20.,5.,5.));
#28=CIRCLE('',#34,2.);
#31=CIRCLE('',#35,5.);
#30=LINE('',#33,#36);
#36=VECTOR('',#37,1.);
#37=DIRECTION('',(-0.707106781186547,0.707106781186548,-7.49314599887035E-15));
#34=AXIS2_PLACEMENT_3D('',#38,#40,#41);
#35=AXIS2_PLACEMENT_3D('',#39,#40,#41);
#38=CARTESIAN_POINT('',(-17.,0.,5.));
#39=CARTESIAN_POINT('',(-20.,0.,5.));
#40=DIRECTION('',(-1.,0.,0.));
#41=DIRECTION('',(0.,-1.,0.));
#18=CONICAL_SURFACE('',#35,5.,0.785398163397449);"""


def test_a_seam_that_leans_by_a_rounding_costs_no_face(tmp_path: Path):
    """A cone as Inventor and Fusion write one: it begins opposite to its seam, whose direction has an error of 1e-14."""
    head = """#1=SHAPE_DEFINITION_REPRESENTATION(#2,#3);
#2=PRODUCT_DEFINITION_SHAPE('','',#4);
#4=PRODUCT_DEFINITION('','',#5,#6);
#5=PRODUCT_DEFINITION_FORMATION('','',#7);
#6=PRODUCT_DEFINITION_CONTEXT('part definition',#8,'design');
#7=PRODUCT('Cone','Cone','',(#9));
#8=APPLICATION_CONTEXT('automotive design');
#9=PRODUCT_CONTEXT('',#8,'mechanical');
#11=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((#12,#13))REPRESENTATION_CONTEXT('',''));
#12=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));
#13=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));"""
    text = f"""ISO-10303-21;
HEADER;
FILE_DESCRIPTION((''),'2;1');
FILE_NAME('','',(''),(''),'','','');
FILE_SCHEMA(('AUTOMOTIVE_DESIGN {{ 1 0 10303 214 1 1 1 1 }}'));
ENDSEC;
DATA;
{head}
{COUNTERSINK}
ENDSEC;
END-ISO-10303-21;
"""
    (tmp_path / "cone.step").write_text(text, encoding="utf-8")
    scene, report = read_whole(tmp_path / "cone.step")
    assert not report.diagnostics
    (mesh,) = scene.meshes
    sides = mesh.vertices[mesh.faces]
    areas = 0.5 * np.linalg.norm(np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0]), axis=1)
    assert areas.sum() == pytest.approx(np.pi * (5.0**2 - 2.0**2) * np.sqrt(2.0) * 1e-6, rel=0.03)


def test_an_operator_that_places_nothing_is_not_told(tmp_path: Path):
    machine = Machine("Top")
    machine.add("Arm", box((0.0, 0.0, 0.0), (20.0, 5.0, 5.0)))
    write_step(machine, tmp_path / "loose.step")
    points = "#9001=DIRECTION('',(-1.,0.,0.));\n#9002=DIRECTION('',(0.,1.,0.));\n#9003=CARTESIAN_POINT('',(1.,2.,3.));\n"
    operator = "#9010=CARTESIAN_TRANSFORMATION_OPERATOR_3D('','','',#9001,#9002,#9003,1.,#9004);\n"
    text = (tmp_path / "loose.step").read_text("utf-8")
    text = text.replace("DATA;\n", f"DATA;\n{points}#9004=DIRECTION('',(0.,0.,1.));\n{operator}", 1)
    (tmp_path / "loose.step").write_text(text, "utf-8")
    _, report = read_whole(tmp_path / "loose.step")
    assert not report.diagnostics


def test_a_tolerance_that_is_none_is_refused():
    assert codes(PLATES, tolerance="fine") == ["STEP_TOLERANCE"]
    assert codes(PLATES, tolerance="-1") == ["STEP_TOLERANCE"]


def test_an_iges_file_that_is_cut_off_is_refused(tmp_path: Path):
    whole = (FIXTURES / "lever" / "lever.iges").read_bytes()
    (tmp_path / "cut.iges").write_bytes(whole[: len(whole) // 2])
    assert codes(tmp_path / "cut.iges") == ["STEP_SYNTAX"]


def test_undefined_references_are_told(tmp_path: Path):
    path = tmp_path / "dangling.step"
    text = PLATES.read_bytes()
    path.write_bytes(text.replace(b"DATA;", b"DATA;\n#999999=PRODUCT_CONTEXT('',#888888,'');", 1))
    _, report = read_whole(path)
    assert [d.code for d in report.diagnostics] == ["STEP_DANGLING"]


def test_kinematic_pairs_are_told_as_left_out(tmp_path: Path):
    path = tmp_path / "moving.step"
    pair = b"DATA;\n#999999=REVOLUTE_PAIR_WITH_RANGE('hinge','',$,$,$,-0.17,1.4);"
    path.write_bytes(PLATES.read_bytes().replace(b"DATA;", pair, 1))
    _, report = read_whole(path)
    assert [(o.outcome.value, o.code) for o in report.outcomes] == [("dropped", "STEP_PAIRS_DROPPED")]


def test_a_damaged_file_ends_in_findings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Bytes flipped, lines dropped or doubled, numbers changed: read, or refused; never a traceback, never for ever."""
    monkeypatch.setattr(reader, "SECONDS", 2.0)
    monkeypatch.setattr(reader, "SECONDS_PER_MEGABYTE", 0.0)
    random_source = random.Random(7)
    path = tmp_path / "mutated.step"
    for _ in range(MUTATIONS):
        path.write_bytes(
            mutated((LEVER if random_source.random() < 0.3 else PLATES).read_bytes(), random_source)
        )
        try:
            read(path, Report())
        except KinefabError as error:
            assert error.diagnostics


def test_a_damaged_iges_file_ends_in_findings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """As of STEP: the sections' lines flipped, dropped, doubled, numbers changed."""
    monkeypatch.setattr(reader, "SECONDS", 2.0)
    monkeypatch.setattr(reader, "SECONDS_PER_MEGABYTE", 0.0)
    write_iges(two_plates(), tmp_path / "whole.igs")
    whole, random_source = (tmp_path / "whole.igs").read_bytes(), random.Random(11)
    path = tmp_path / "mutated.igs"
    for _ in range(IGES_MUTATIONS):
        path.write_bytes(mutated(whole, random_source))
        try:
            read(path, Report())
        except KinefabError as error:
            assert error.diagnostics


def test_a_shape_that_ends_the_process_is_left_out_and_the_rest_is_read(monkeypatch: pytest.MonkeyPatch):
    """The process dies at the first shape; asked again without it, it gives the others."""
    real = reader.guarded
    asked = []

    def dying(
        module: str,
        function: str,
        path: str,
        iges: bool,
        tolerance: object,
        skip: frozenset[int],
        seconds: float,
    ):
        asked.append(skip)
        for answer in real(module, function, path, iges, tolerance, skip, seconds=seconds):
            yield answer
            if isinstance(answer, Begun) and answer.shape == 0:
                raise GuardedCrash("it ended with code -11")

    monkeypatch.setattr(reader, "guarded", dying)
    scene, report = read_whole(LEVER)
    assert asked == [frozenset(), frozenset({0})]
    assert [(d.code, d.where) for d in report.diagnostics] == [
        ("STEP_SHAPE_FAILED", "lever.step#Lever/Base:1")
    ]
    assert [len(node.bodies) for node in scene.nodes] == [0, 0, 0, 1, 1, 1, 1, 1]


def test_a_process_that_dies_at_once_is_told(monkeypatch: pytest.MonkeyPatch):
    def dying(*arguments: object, **more: object):
        raise GuardedCrash("it ended with code -11")
        yield

    monkeypatch.setattr(reader, "guarded", dying)
    assert codes(LEVER) == ["STEP_UNREADABLE"]


def test_faces_without_triangles_are_told(tmp_path: Path):
    """A plate whose bore has a radius that its edges do not have: the face cannot be meshed, the others are."""
    path = tmp_path / "torn.step"
    text = PLATES.read_bytes()
    assert b"CYLINDRICAL_SURFACE" in text
    path.write_bytes(re.sub(rb"(CYLINDRICAL_SURFACE\('',#\d+),[^)]*\)", rb"\1,1.E-12)", text))
    _, report = read_whole(path)
    assert [d.code for d in report.diagnostics] == ["STEP_FACES_FAILED"]


def mutated(data: bytes, source: random.Random) -> bytes:
    lines = data.splitlines(keepends=True)
    for _ in range(source.choice([1, 1, 2, 5, 20])):
        i = source.randrange(len(lines))
        what = source.randrange(6)
        if what == 0:
            line = bytearray(lines[i])
            line[source.randrange(len(line))] = source.randrange(256)
            lines[i] = bytes(line)
        elif what == 1:
            del lines[i]
        elif what == 2:
            lines.insert(i, lines[source.randrange(len(lines))])
        elif what == 3:
            lines[i] = lines[i].replace(b"1", source.choice([b"0", b"-1", b"1E300", b"NAN", b"7"]))
        elif what == 4:
            lines[i] = lines[i].replace(b"#", source.choice([b"#1", b"#0", b"$", b"*"]))
        else:
            j = source.randrange(len(lines))
            lines[i], lines[j] = lines[j], lines[i]
    return b"".join(lines)


def crash():
    """Ends its process as a fault in a native library does."""
    yield "before"
    os.abort()


def endless():
    while True:
        pass
    yield


def failing():
    yield "before"
    raise ValueError("of its own")


def test_a_crash_is_told_and_the_next_question_answered():
    """What a reader itself refuses is a sentence, without the name of an exception."""
    found = []
    with pytest.raises(GuardedCrash):
        for value in guarded(__name__, "crash", seconds=60.0):
            found.append(value)
    assert found == ["before"]
    with pytest.raises(GuardedError, match="^of its own$"):
        list(guarded(__name__, "failing", seconds=60.0))


def test_what_never_ends_is_ended():
    with pytest.raises(GuardedCrash, match="longer than"):
        list(guarded(__name__, "endless", seconds=1.5))


def test_a_library_that_loads_slowly_takes_nothing_of_the_files_time(tmp_path, monkeypatch):
    """On a busy machine OpenCASCADE is longer on its way than a small file may be read."""
    (tmp_path / "slow_to_load.py").write_text("import time\ntime.sleep(2.0)\ndef read():\n    yield 'read'\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    end_idle()  # the next child has the path
    assert list(guarded("slow_to_load", "read", seconds=1.5)) == ["read"]
    end_idle()


@pytest.mark.posix
def test_what_is_busy_ends_when_nobody_asks_any_more():
    """Whoever asked may have been killed, as by a container's end; the process that reads would have gone on for ever."""
    guard = command("kinefab.sources.guard", "serve")
    with subprocess.Popen(guard, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as child:
        pickle.dump((0.1, "time", "sleep", (600,)), child.stdin)
        child.stdin.flush()
        assert child.wait(timeout=120) == -signal.SIGALRM


def test_part21_sees_through_strings_and_comments():
    text = Part21(b"ISO-10303-21;\n/* #7=NOT('x'); */\n#1=A('#9;''',#2);\n#2=B();\nEND-ISO-10303-21;")
    assert text.starts and text.ends
    assert set(text.instances) == {1, 2}
    assert text.dangling() == 0
    assert text.text(1) == b"A('#9;''',#2)"
