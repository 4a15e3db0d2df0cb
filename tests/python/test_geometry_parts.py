"""Part files of every format: exact ones and those of assimp, alone, in a bundle, and by ``bundle init``."""

from __future__ import annotations

import io
import json
import os
import random
import struct
import sys
import zipfile

import kinefab
import numpy as np
import pytest
import trimesh
from command_line import runner
from kinefab.cli import app
from kinefab.diagnostics import KinefabError, Report
from kinefab.geometry.files import read_mesh_file
from kinefab.sources.parts.readers import part_readers
from source_bundles import FIXTURES, bundle, part
from test_sources_freecad_bad_input import damaged

sys.path.insert(0, str(FIXTURES))
READERS = dict(part_readers())
if ".fbx" in READERS:  # assimp's road of a format that trimesh reads where it can
    READERS[".3mf"] = READERS[".fbx"]
MUTATIONS = int(os.environ.get("KINEFAB_PART_MUTATIONS", "15"))
BOX = trimesh.creation.box((1.0, 2.0, 3.0))
BOX.apply_translation((0.0, 0.0, 10.0))
AT = (5.0, 0.0, 0.0)
"""Where the files' own transforms put the box, on top."""


def vrml() -> bytes:
    points = ", ".join("%g %g %g" % tuple(v) for v in BOX.vertices)
    faces = ", ".join("%d, %d, %d, -1" % tuple(f) for f in BOX.faces)
    shape = f"Shape {{ geometry IndexedFaceSet {{ coord Coordinate {{ point [ {points} ] }} coordIndex [ {faces} ] }} }}"
    return f"#VRML V2.0 utf8\nDEF Box Transform {{ translation 5 0 0 children [ {shape} ] }}\n".encode()


def x3d() -> bytes:
    points = " ".join("%g %g %g" % tuple(v) for v in BOX.vertices)
    faces = " ".join("%d %d %d -1" % tuple(f) for f in BOX.faces)
    shape = (
        f'<Shape><IndexedFaceSet coordIndex="{faces}"><Coordinate point="{points}"/></IndexedFaceSet></Shape>'
    )
    return f'<X3D version="3.0"><Scene><Transform DEF="Box" translation="5 0 0">{shape}</Transform></Scene></X3D>'.encode()


def tds() -> bytes:
    """3DS: chunks of an identifier, a length and what they hold; it has no transform of its own here."""

    def chunk(kind: int, content: bytes) -> bytes:
        return struct.pack("<HI", kind, 6 + len(content)) + content

    vertices = (BOX.vertices + AT).astype("<f4")
    corners = chunk(0x4110, struct.pack("<H", len(vertices)) + vertices.tobytes())
    faces = b"".join(struct.pack("<4H", *face, 7) for face in BOX.faces)
    mesh = chunk(0x4100, corners + chunk(0x4120, struct.pack("<H", len(BOX.faces)) + faces))
    return chunk(0x4D4D, chunk(0x0002, struct.pack("<I", 3)) + chunk(0x3D3D, chunk(0x4000, b"Box\0" + mesh)))


def fbx(unit: float = 100.0) -> bytes:
    """unit: centimetres in one unit of the file."""
    points = ",".join("%g" % v for v in BOX.vertices.ravel())
    faces = ",".join("%d,%d,%d" % (a, b, -c - 1) for a, b, c in BOX.faces)
    return f"""; FBX 7.3.0 project file
FBXHeaderExtension:  {{
    FBXHeaderVersion: 1003
    FBXVersion: 7300
}}
GlobalSettings:  {{
    Properties70:  {{
        P: "UnitScaleFactor", "double", "Number", "",{unit:g}
    }}
}}
Objects:  {{
    Geometry: 1000, "Geometry::Box", "Mesh" {{
        Vertices: *{BOX.vertices.size} {{
            a: {points}
        }}
        PolygonVertexIndex: *{BOX.faces.size} {{
            a: {faces}
        }}
        GeometryVersion: 124
    }}
    Model: 2000, "Model::Box", "Mesh" {{
        Properties70:  {{
            P: "Lcl Translation", "Lcl Translation", "", "A",5,0,0
        }}
    }}
}}
Connections:  {{
    C: "OO",2000,0
    C: "OO",1000,2000
}}
""".encode()


def three_mf(unit: str = "millimeter") -> bytes:
    """The box as an object, placed by a component of the one that is built."""
    points = "".join('<vertex x="%g" y="%g" z="%g"/>' % tuple(v) for v in BOX.vertices)
    faces = "".join('<triangle v1="%d" v2="%d" v3="%d"/>' % tuple(f) for f in BOX.faces)
    mesh = f"<mesh><vertices>{points}</vertices><triangles>{faces}</triangles></mesh>"
    moved = '<components><component objectid="1" transform="1 0 0 0 1 0 0 0 1 5 0 0"/></components>'
    schemas = "http://schemas.microsoft.com/3dmanufacturing"
    package = "http://schemas.openxmlformats.org/package/2006"
    members = {
        "[Content_Types].xml": f'<Types xmlns="{package}/content-types">'
        f'<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
        f'<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>',
        "_rels/.rels": f'<Relationships xmlns="{package}/relationships"><Relationship Target="/3D/3dmodel.model" Id="r0"'
        f' Type="{schemas}/2013/01/3dmodel"/></Relationships>',
        "3D/3dmodel.model": f'<?xml version="1.0"?><model unit="{unit}" xmlns="{schemas}/core/2015/02"><resources>'
        f'<object id="1" type="model" name="Box">{mesh}</object><object id="2" type="model" name="Whole">{moved}</object>'
        f'</resources><build><item objectid="2"/></build></model>',
    }
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        for name, text in members.items():
            archive.writestr(name, text)
    return file.getvalue()


WRITERS = {".3mf": three_mf, ".wrl": vrml, ".x3d": x3d, ".3ds": tds, ".fbx": fbx}


def needs(suffix: str) -> None:
    if suffix not in READERS:
        pytest.skip(f"nothing that reads {suffix} is installed: pip install cadquery-ocp-novtk assimp-py")


def load(path):
    report = Report()
    file = READERS[path.suffix](path, report, "here")
    return file, [d.code for d in report.diagnostics]


@pytest.mark.parametrize("suffix", WRITERS)
def test_every_format_gives_the_same_solid_in_the_axes_of_the_file(tmp_path, suffix):
    needs(suffix)
    path = tmp_path / f"a{suffix}"
    path.write_bytes(WRITERS[suffix]())
    file, codes = load(path)
    (piece,) = file.pieces
    assert codes == []
    np.testing.assert_allclose(piece.vertices.min(axis=0), BOX.bounds[0] + AT, atol=1e-6)
    np.testing.assert_allclose(piece.vertices.max(axis=0), BOX.bounds[1] + AT, atol=1e-6)
    assert trimesh.Trimesh(piece.vertices, piece.faces).volume == pytest.approx(6.0, rel=1e-6)


def exported(path, tmp_path, units="mm"):
    """The one part of a bundle of that file, mesh units as told."""
    values = bundle(part("P", grounded=True, file=path.name))
    values["meta"]["mesh"] = {"units": units, "layout": "per_part", "coordinates": "part"}
    (tmp_path / "b.bundle.json").write_text(json.dumps(values), "utf-8")
    return kinefab.export(tmp_path / "b.bundle.json", tmp_path / "b.kinefab").analysed.scene


@pytest.mark.parametrize("unit", [100.0, 1.0])
def test_an_fbx_has_the_unit_that_it_states(tmp_path, unit):
    needs(".fbx")
    (tmp_path / "a.fbx").write_bytes(fbx(unit))
    (mesh,) = exported(tmp_path / "a.fbx", tmp_path).meshes
    np.testing.assert_allclose(
        np.ptp(mesh.vertices, axis=0), np.array([1.0, 2.0, 3.0]) * unit / 100, rtol=1e-6
    )


@pytest.mark.parametrize("unit, metres", [("millimeter", 1e-3), ("inch", 0.0254), ("meter", 1.0)])
def test_a_3mf_has_the_unit_that_it_states(tmp_path, unit, metres):
    """Whichever of trimesh and assimp reads it, and whatever the bundle says of its meshes."""
    if ".3mf" not in READERS:
        pytest.importorskip("lxml")
        pytest.importorskip("networkx")
    (tmp_path / "a.3mf").write_bytes(three_mf(unit))
    (mesh,) = exported(tmp_path / "a.3mf", tmp_path, "cm").meshes
    np.testing.assert_allclose(np.ptp(mesh.vertices, axis=0), np.array([1.0, 2.0, 3.0]) * metres, rtol=1e-6)


@pytest.mark.parametrize("suffix", [".step", ".iges"])
def test_exact_files_have_the_unit_that_they_state(tmp_path, suffix):
    """Two plates in inches, whatever the bundle says of its meshes; every solid stands where the file has it."""
    needs(suffix)
    from step.linkages import two_plates
    from step.writer import write_iges, write_step

    path = tmp_path / f"plates{suffix}"
    (write_step if suffix == ".step" else write_iges)(two_plates(), path)
    scene = exported(path, tmp_path, "mm")
    points = np.concatenate([scene.meshes[body.mesh].vertices for body in scene.nodes[0].bodies])
    np.testing.assert_allclose(np.ptp(points, axis=0), [0.1, 0.0708, 0.015], atol=1e-6)


def test_an_exact_file_that_is_none_is_an_error_of_the_part(tmp_path):
    needs(".step")
    (tmp_path / "a.step").write_bytes(b"no step")
    assert load(tmp_path / "a.step") == (None, ["GEOMETRY_UNREADABLE"])


@pytest.mark.parametrize("suffix", [".wrl", ".x3d"])
def test_other_files_are_not_followed(tmp_path, suffix):
    needs(suffix)
    inline = b'Inline { url "/etc/passwd" }' if suffix == ".wrl" else b'<Inline url="/etc/passwd"/>'
    (tmp_path / f"a{suffix}").write_bytes(
        WRITERS[suffix]()
        .replace(b"children [", b"children [ " + inline)
        .replace(b"<Scene>", b"<Scene>" + inline)
    )
    assert load(tmp_path / f"a{suffix}") == (None, ["GEOMETRY_UNREADABLE"])


@pytest.mark.parametrize("suffix", WRITERS)
def test_damaged_files_end_in_findings(tmp_path, suffix):
    """Native libraries may crash over them, in a process of their own."""
    needs(suffix)
    given, chance = WRITERS[suffix](), random.Random(suffix)
    for _ in range(MUTATIONS):
        (tmp_path / f"a{suffix}").write_bytes(damaged(given, chance))
        file, codes = load(tmp_path / f"a{suffix}")
        assert (file is None) == bool(codes)


@pytest.mark.parametrize(
    "name, words",
    [("a.sldprt", "export STEP"), ("a.x_t", "export STEP"), ("a.blend", "export glTF"), ("a.usdz", "Export glTF"),
     ("a.fbx", "pip install assimp-py"), ("a.step", "pip install cadquery-ocp-novtk"),
     ("a.wrl", "pip install cadquery-ocp-novtk"), ("a.xyz", ".obj")],
)  # fmt: skip
def test_what_none_reads_is_refused_with_the_conversion_that_works(tmp_path, name, words):
    (tmp_path / name).write_bytes(b"x")
    report = Report()
    assert read_mesh_file(tmp_path / name, report, "here") is None
    (found,) = report.diagnostics
    assert found.code == "GEOMETRY_FORMAT_UNKNOWN" and words in found.remedy and name in found.message


def test_init_takes_every_format_that_is_read(tmp_path):
    needs(".step")
    folder = tmp_path / "parts"
    folder.mkdir()
    (folder / "Plate.step").write_bytes((FIXTURES / "step" / "two_plates_inch_ap242.step").read_bytes())
    (folder / "Box.wrl").write_bytes(vrml())
    BOX.export(folder / "Cube.stl")
    done = runner().invoke(
        app, ["bundle", "init", str(folder), "--units", "mm", "-o", str(folder / "m.bundle.json")]
    )
    assert done.exit_code == 0, done.output
    values = json.loads((folder / "m.bundle.json").read_text("utf-8"))
    assert [c["id"] for c in values["components"]] == ["Box", "Cube", "Plate"]
    checked = runner().invoke(app, ["bundle", "check", str(folder / "m.bundle.json")])
    assert checked.exit_code == 0, checked.output


def test_a_bundle_of_a_file_that_crashes_its_reader_is_refused(tmp_path):
    needs(".fbx")
    (tmp_path / "a.fbx").write_bytes(fbx()[:700])
    with pytest.raises(KinefabError) as caught:
        exported(tmp_path / "a.fbx", tmp_path)
    assert {d.code for d in caught.value.diagnostics} <= {"GEOMETRY_UNREADABLE", "GEOMETRY_EMPTY"}
