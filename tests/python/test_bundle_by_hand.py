"""A bundle by hand: begun from a folder, checked at once, and the example of BUNDLE.md."""

from __future__ import annotations

import json
import os
import re
import shutil
from pathlib import Path

import kinefab
import numpy as np
import pytest
import trimesh
from command_line import runner
from golden import FIXTURES
from jsonschema import Draft202012Validator
from kinefab import sources
from kinefab.bundling.checking import check
from kinefab.cli import app
from kinefab.diagnostics import KinefabError, Report, schema_directory
from kinefab.model import Dynamics, JointKind, Node, Scene
from kinefab.options import ExportOptions
from kinefab.pipeline import analysed, prepared
from source_bundles import bundle, codes, frame, part, read
from typer.testing import CliRunner

ROOT = Path(__file__).parents[2]
CASES = int(os.environ.get("KINEFAB_BUNDLE_CASES", "60"))


def box(path: Path, *size: float) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    trimesh.creation.box(size).export(path)


def run(*arguments: object):
    return CliRunner().invoke(app, [str(a) for a in arguments])


def by_schema(values: object) -> list:
    schema = json.loads((schema_directory() / "bundle.schema.json").read_text(encoding="utf-8"))
    return list(Draft202012Validator(schema).iter_errors(values))


def test_init_writes_a_bundle_that_exports(tmp_path):
    """Valid by the schema, with the remarks that mesh files state no density and that nothing is joined yet; a 10 x 20 x 30 mm box
    with Z up is 10 x 30 x 20 mm with Y up."""
    folder = tmp_path / "my parts"
    box(folder / "Base.stl", 10, 20, 30)
    box(folder / "Ärm.obj", 1, 2, 3)
    (folder / "notes.txt").write_text("no mesh")
    target = folder / "m.bundle.json"
    assert run("bundle", "init", folder, "-o", target, "--units", "mm").exit_code == 0
    values = json.loads(target.read_text(encoding="utf-8"))
    assert by_schema(values) == []
    assert [c["id"] for c in values["components"]] == ["Base", "Ärm"]
    assert [d.code for d in check(target)[0].diagnostics] == ["DENSITY_ASSUMED", "NOTHING_JOINED"]
    told = run("bundle", "check", target).stdout
    assert "2 parts, none of them grounded; 0 joints; mobility 12." in told
    meshes = prepared(target, ExportOptions(), Report()).meshes
    sizes = sorted(tuple(np.ptp(mesh.vertices, axis=0).round(9)) for mesh in meshes)
    assert sizes == [(0.001, 0.003, 0.002), (0.01, 0.03, 0.02)]


def test_init_takes_unit_and_up_axis_of_gltf_from_its_definition(tmp_path):
    """A GLB of Blender or Rhino stands as it stood there: in metres, Y up, unless the user says otherwise."""
    box(tmp_path / "Base.glb", 0.1, 0.3, 0.2)
    target = tmp_path / "m.bundle.json"
    done = run("bundle", "init", tmp_path, "-o", target)
    assert done.exit_code == 0 and "in m, Y up" in done.output
    (mesh,) = prepared(target, ExportOptions(), Report()).meshes
    assert np.ptp(mesh.vertices, axis=0).round(7).tolist() == [0.1, 0.3, 0.2]
    run("bundle", "init", tmp_path, "-o", target, "--units", "dm", "--up", "z", "--force")
    (mesh,) = prepared(target, ExportOptions(), Report()).meshes
    assert sorted(np.ptp(mesh.vertices, axis=0).round(7).tolist()) == [0.01, 0.02, 0.03]
    assert np.ptp(mesh.vertices, axis=0)[1].round(7) == 0.02


def test_init_into_another_folder_says_which_folder_it_is(tmp_path, monkeypatch):
    """Also where the bundle's name has none: the meshes are not below the folder that one stands in."""
    box(tmp_path / "parts" / "Base.stl", 10, 20, 30)
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    done = run("bundle", "init", tmp_path / "parts", "--units", "mm", "-o", "m.bundle.json")
    assert done.exit_code == 1
    assert f"Base.stl does not lie below the folder of the bundle, {tmp_path / 'here'}." in done.output


def test_init_asks_for_the_up_axis_of_gltf_among_others(tmp_path):
    box(tmp_path / "a.glb", 1, 1, 1)
    box(tmp_path / "b.stl", 1, 1, 1)
    done = run("bundle", "init", tmp_path, "--units", "m")
    assert done.exit_code == 2 and "glTF is Y up" in done.output and list(tmp_path.glob("*.json")) == []
    assert run("bundle", "init", tmp_path, "--units", "m", "--up", "Y").exit_code == 0


def test_the_example_in_the_comment_is_a_joint(tmp_path):
    """What a person is told to copy into ``joints`` is read without remark."""
    for name, size in (("Base", 10), ("Arm", 5)):
        box(tmp_path / f"{name}.stl", size, size, size)
    target = tmp_path / "m.bundle.json"
    run("bundle", "init", tmp_path, "-o", target, "--units", "cm")
    values = json.loads(target.read_text(encoding="utf-8"))
    values["joints"] = [values["meta"]["extras"]["example"]]
    values["components"][1]["grounded"] = True
    target.write_text(json.dumps(values), encoding="utf-8")
    report = Report()
    scene = sources.read(target, report)
    assert report.diagnostics == [] and [j.kind for j in scene.joints] == [JointKind.REVOLUTE]


@pytest.mark.parametrize("arguments", [(), ("--units", "furlong"), ("--units", "mm", "--up", "W")])
def test_init_refuses_what_is_not_stated(tmp_path, arguments):
    box(tmp_path / "a.stl", 1, 1, 1)
    done = run("bundle", "init", tmp_path, *arguments)
    assert done.exit_code == 2 and list(tmp_path.glob("*.json")) == []


def test_init_says_what_it_wrote_unless_errors_alone_are_wanted(tmp_path):
    """As every command; one part is one."""
    box(tmp_path / "Base.stl", 10, 20, 30)
    init = ("bundle", "init", tmp_path, "-o", tmp_path / "m.bundle.json", "--units", "mm", "--force")
    quiet, told = run("-q", *init), run(*init)
    assert quiet.exit_code == told.exit_code == 0
    assert quiet.output == "" and "m.bundle.json: 1 part in mm, Z up" in told.output


def test_init_leaves_a_bundle_that_is_there(tmp_path):
    """Somebody's work by hand is not overwritten unasked."""
    box(tmp_path / "a.stl", 1, 1, 1)
    target = tmp_path / "m.bundle.json"
    target.write_text("mine")
    assert run("bundle", "init", tmp_path, "-o", target, "--units", "mm").exit_code == 2
    assert target.read_text() == "mine"
    assert run("bundle", "init", tmp_path, "-o", target, "--units", "mm", "--force").exit_code == 0


def test_init_refuses_a_folder_without_meshes_and_a_bundle_beside_the_way(tmp_path):
    (tmp_path / "empty").mkdir()
    done = run("bundle", "init", tmp_path / "empty", "--units", "mm")
    assert done.exit_code == 1 and "no mesh file" in done.output
    box(tmp_path / "in" / "a.stl", 1, 1, 1)
    done = run("bundle", "init", tmp_path / "in", "-o", tmp_path / "empty" / "m.bundle.json", "--units", "mm")
    assert done.exit_code == 1 and "beside the meshes" in done.output
    assert not (tmp_path / "empty" / "m.bundle.json").exists()


def test_init_tells_of_meshes_in_folders_inside(tmp_path):
    """Rhino's layers or Blender's collections exported as folders: they are no parts, and that is no secret."""
    folder = tmp_path / "parts"
    box(folder / "Base.stl", 10, 20, 30)
    for name in ("Layer 1", "empty", ".trash"):
        (folder / name).mkdir()
    (folder / "Layer 1" / "Pin.STL").write_bytes(b"")
    (folder / ".trash" / "Old.stl").write_bytes(b"")
    done = runner().invoke(app, ["bundle", "init", str(folder), "--units", "mm", "--json"])
    found = json.loads(done.stdout)["diagnostics"]
    assert [(entry["code"], entry["severity"]) for entry in found] == [("BEGINNING_FOLDER", "warning")]
    assert "1 mesh file(s) in the folder Layer 1" in found[0]["message"]


def test_check_tells_every_layer_at_once(tmp_path):
    """Header, components, joints and mesh files in one run."""
    values = bundle(
        {**part("A"), "file": "gone.stl", "parent": "Nobody"},
        {"kind": "part"},
        joints=[{"id": "J", "type": "turn", "a": "A", "b": "Nobody"}],
    )
    values["meta"] = {"format": "kinefab.bundle", "units": {"length": "furlong"}}
    path = tmp_path / "bad.bundle.json"
    path.write_text(json.dumps(values))
    places = {(d.code, d.where.partition("#")[2]) for d in check(path)[0].diagnostics}
    assert {
        ("UNIT_UNKNOWN", "/meta/units/length"),
        ("BUNDLE_FIELD_MISSING", "/meta"),
        ("BUNDLE_FIELD_MISSING", "/meta/units"),
        ("PARENT_UNKNOWN", "/components/0/parent"),
        ("BUNDLE_FIELD_MISSING", "/components/1"),
        ("JOINT_TYPE_UNKNOWN", "/joints/0/type"),
        ("COMPONENT_UNKNOWN", "/joints/0/b"),
        ("GEOMETRY_UNREADABLE", "/components/0"),
    } <= places
    assert run("bundle", "check", path).exit_code == 1


@pytest.mark.parametrize("joints", [1, 2, 7])
def test_a_misspelt_component_is_told_once_and_of_how_many_more_places(tmp_path, joints):
    turns = [{"id": f"J{i}", "type": "revolute", "a": "A", "b": "Crnk"} for i in range(joints)]
    values = bundle(part("A"), part("Crank"), joints=[*turns, {"id": "Other", "type": "revolute", "a": "A", "b": "Bar"}])
    path = tmp_path / "bad.bundle.json"
    path.write_text(json.dumps(values))
    told = [d for d in check(path)[0].diagnostics if d.code == "COMPONENT_UNKNOWN"]
    assert [d.where.partition("#")[2] for d in told] == ["/joints/0/b", f"/joints/{joints}/b"]
    more = {1: "", 2: " and 1 more place", 7: " and 6 more places"}[joints]
    assert [d.message for d in told] == [
        f"'Crnk', named by joint J0{more}, is no component. Near matches: Crank.",
        "'Bar', named by joint Other, is no component. Near matches: none.",
    ]


@pytest.mark.parametrize(
    "change, near",
    [
        (lambda v: v["constraints"][0].update(kind="Concentic"), "concentric, coincident"),
        (lambda v: v["constraints"][0]["a"].update(geometry="cylindre"), "cylinder, line"),
        (lambda v: v["constraints"][0]["a"].update(component="Crnk"), "Crank"),
        (lambda v: v["constraints"][0]["a"].update({"in": "wrld"}), "world"),
        (lambda v: v["components"][1].update(parent="Bsae"), "Base"),
        (lambda v: v["components"][1].update(bodies=[{"name": "b", "material": "stel"}]), "Steel"),
        (lambda v: v["couplings"][0]["a"].update(joint="shaft"), "Shaft"),
        (lambda v: v.update(joint=v.pop("joints"), couplings=[]), "joints"),
    ],
)
def test_a_misspelt_word_is_told_with_what_is_near(tmp_path, change, near):
    """Whoever writes by hand misses letters; a list of twenty words is no answer to that."""
    line = {"geometry": "line", "in": "world", "p": [0, 0, 0], "d": [0, 0, 1]}
    turning = {"joint": "Shaft", "dof": "rz"}
    shaft = {"type": "revolute", "a": "Base", "b": "Crank", "frameA": frame((0, 0, 0), (0, 0, 1))}
    values = bundle(
        part("Base", grounded=True),
        part("Crank"),
        materials=[{"name": "Steel", "density": 7850}],
        joints=[{"id": "Shaft", **shaft}],
        couplings=[{"id": "C", "kind": "gear", "a": dict(turning), "b": dict(turning), "ratio": 2}],
        constraints=[
            {
                "id": "I",
                "kind": "concentric",
                "a": {"component": "Base", **line},
                "b": {"component": "Crank", **line},
            }
        ],
    )
    change(values)
    path = tmp_path / "misspelt.bundle.json"
    path.write_text(json.dumps(values))
    assert any(f"Near matches: {near}." in d.message for d in check(path)[0].diagnostics)


def test_a_bundle_without_components_is_told_once(tmp_path):
    """And not again by all that names one: the lever's said it thirty times."""
    values = json.loads((FIXTURES / "lever" / "lever.bundle.json").read_text("utf-8"))
    values["component"] = values.pop("components")
    path = tmp_path / "none.bundle.json"
    path.write_text(json.dumps(values))
    found = check(path)[0].diagnostics
    assert [d.code for d in found] == ["BUNDLE_FIELD_UNKNOWN", "BUNDLE_WITHOUT_COMPONENTS"]
    assert "Near matches: components." in found[0].message and "'components'" in found[1].remedy


@pytest.mark.parametrize("layout", [{}, {"layout": "per_part"}, {"layout": "single"}])
@pytest.mark.parametrize("files", [[], ["a.stl", "b.stl"]])
def test_a_file_needs_no_layout_and_no_bodies(tmp_path, layout, files):
    """A part's ``file`` is its body; only two files that are called one are refused."""
    values = bundle({**part("A"), "file": "a.stl"}, {**part("B"), "file": "b.stl"})
    values["meta"]["mesh"] = {"units": "m", "coordinates": "part", "files": files, **layout}
    if layout.get("layout") == "single" and files:
        with pytest.raises(KinefabError, match="MESH_LAYOUT"):
            read(values, tmp_path)
        return
    scene, report = read(values, tmp_path)
    assert codes(report) == []
    references = [body.reference for node in scene.nodes for body in node.bodies]
    assert [(r.path.name, r.key) for r in references] == [("a.stl", None), ("b.stl", None)]


def test_files_without_unit_and_frame_are_refused(tmp_path):
    with pytest.raises(KinefabError, match="'mesh' is missing"):
        read(bundle({**part("A"), "file": "a.stl"}), tmp_path)


def test_the_example_of_the_bundle_page(tmp_path):
    """It begins with a bundle that exports without loss: a hinge about the vertical's cross axis, -10 to 80 degrees."""
    text = (schema_directory() / "BUNDLE.md").read_text(encoding="utf-8")
    block = re.search(r"```json\n(.*?)```", text, re.DOTALL).group(1)
    assert text.index(block) < text.index("## Units")
    assert by_schema(json.loads(block)) == []
    path = tmp_path / "two.bundle.json"
    path.write_text(block, encoding="utf-8")
    box(tmp_path / "base.stl", 60, 40, 20)
    box(tmp_path / "arm.stl", 10, 10, 30)
    assert [d.code for d in check(path)[0].diagnostics] == ["DENSITY_ASSUMED"]
    result = kinefab.export(path, tmp_path / "two.kinefab")
    assert [(o.feature, o.outcome.value) for o in result.report.outcomes if o.code != "COLLIDER_RECOGNISED"] == [("joint Hinge:1", "kept")]


@pytest.mark.parametrize(
    ("name", "word"),
    [
        ("a.iam", "capture inventor"),
        ("A.SLDASM", "capture solidworks"),
        ("a.f3z", "Fusion"),
        ("a.asm.7", "Creo"),
        ("a.prt", "NX"),
        ("a.prt.3", "Simscape Multibody Link"),
        ("a.smt", "Fusion"),
        ("a.stpz", "unpack"),
        ("a.FCStd1", "FreeCAD"),
        ("a.CATProduct", "CATIA"),
        ("a.3dm", "Rhino"),
        ("a.blend", "Blender"),
        ("a.fbx", "bundle init"),
        ("a.jt", "STEP"),
        ("a.stl", "bundle init"),
        ("a.prefab", "the source"),
    ],
)
def test_an_unknown_ending_names_its_road(name, word):
    with pytest.raises(KinefabError) as refused:
        sources.read(Path(name), Report())
    (found,) = refused.value.diagnostics
    assert found.code == "SOURCE_FORMAT_UNKNOWN" and word in found.remedy and ".step" in found.remedy


def test_a_name_without_a_file_is_told_as_that(tmp_path):
    with pytest.raises(KinefabError) as refused:
        sources.read(tmp_path / "robotz", Report())
    assert [found.code for found in refused.value.diagnostics] == ["SOURCE_NOT_FOUND"]


def test_a_folder_is_told_as_that(tmp_path):
    with pytest.raises(KinefabError) as refused:
        sources.read(tmp_path, Report())
    assert [found.code for found in refused.value.diagnostics] == ["SOURCE_IS_FOLDER"]


@pytest.mark.skipif(os.name != "posix", reason="paths are bytes on POSIX alone")
@pytest.mark.parametrize(
    "library, source", [("pxr", "lever.usda"), ("OCP", "lever.step")], ids=["usd", "step"]
)
@pytest.mark.parametrize("within", [False, True], ids=["named", "stood in"])
def test_a_path_that_a_library_cannot_open_is_told_as_that(library, source, within, tmp_path, monkeypatch):
    """A folder's name in Latin-1: pxr raised UnicodeEncodeError, and OCP told of its arguments."""
    pytest.importorskip(library)
    folder = tmp_path / os.fsdecode(b"lat\xfcn")
    folder.mkdir()
    shutil.copy(FIXTURES / "lever" / source, folder)
    if within:
        monkeypatch.chdir(folder)
    with pytest.raises(KinefabError) as refused:
        sources.read(source if within else folder / source, Report())
    assert [found.code for found in refused.value.diagnostics] == ["SOURCE_PATH_NOT_UTF8"]


def test_the_page_of_cad_programs_is_short():
    """Every program has its road, in five lines at most."""
    text = (ROOT / "python" / "README.md").read_text(encoding="utf-8")
    page = text.partition("## From my CAD program\n")[2].partition("\n## ")[0]
    roads = {
        name: [line for line in lines.splitlines() if line]
        for name, lines in re.findall(
            r"^\*\*([^*]+)\*\*[^\n]*\n(.*?)(?=^\*\*|\Z)", page, re.DOTALL | re.MULTILINE
        )
    }
    programs = "Inventor SolidWorks Fusion Onshape FreeCAD Creo NX CATIA Rhino Blender".split()
    assert {*programs, "Only STEP", "Only meshes"} == roads.keys()
    assert all(1 <= len(lines) <= 5 for lines in roads.values())


def test_a_missing_mesh_does_not_hide_what_the_analysis_finds(tmp_path):
    """A mate whose two sides stand a millimetre apart, and a part whose file is not there: both are told."""
    sides = {
        key: {"component": name, "geometry": "point", "in": "world", "p": [x, 0, 0]}
        for key, name, x in (("a", "Base", 0.0), ("b", "Arm", 0.001))
    }
    mate = {"id": "Mate:1", "kind": "coincident", **sides}
    values = bundle(part("Base", grounded=True, file="gone.stl"), part("Arm"), constraints=[mate])
    values["meta"]["mesh"] = {"units": "m", "layout": "per_part", "coordinates": "part"}
    path = tmp_path / "case.bundle.json"
    path.write_text(json.dumps(values), encoding="utf-8")
    found = codes(check(path)[0])
    assert "GEOMETRY_UNREADABLE" in found and "CONSTRAINT_GAP" in found


def test_a_wrong_field_does_not_hide_what_the_analysis_finds(tmp_path):
    """A joint of no known type, a file that is not there, and two mates that contradict each other; but not that nothing is
    grounded, which the joint might have mended."""
    mates = []
    for number, x in enumerate((0.0, 0.25), 1):
        side = {"component": "Base", "geometry": "point", "in": "part", "p": [x, 0, 0]}
        other = {"component": "Arm", "geometry": "point", "in": "part", "p": [0, 0, 0]}
        mates.append({"id": f"Mate:{number}", "kind": "coincident", "a": side, "b": other})
    values = bundle(
        part("Base"), part("Arm"), part("Tip", file="gone.stl"),
        joints=[{"id": "J", "type": "turn", "a": "Arm", "b": "Tip"}], constraints=mates,
    )  # fmt: skip
    values["meta"]["mesh"] = {"units": "m", "layout": "per_part", "coordinates": "part"}
    path = tmp_path / "case.bundle.json"
    path.write_text(json.dumps(values), encoding="utf-8")
    found = codes(check(path)[0])
    assert {"JOINT_TYPE_UNKNOWN", "GEOMETRY_UNREADABLE", "CONSTRAINTS_CONTRADICT"} <= set(found)
    assert "NOTHING_GROUNDED" not in found
    values["meta"]["units"]["length"] = "furlong"  # then no length says anything
    path.write_text(json.dumps(values), encoding="utf-8")
    assert "CONSTRAINTS_CONTRADICT" not in codes(check(path)[0])


def unjoined(path: Path, values: object) -> list[str]:
    """What ``bundle check`` says of nothing being joined, which ``export`` says too."""
    path.write_text(json.dumps(values), encoding="utf-8")
    checked = [d.message for d in check(path)[0].diagnostics if d.code == "NOTHING_JOINED"]
    exported = kinefab.export(path, path.with_suffix(".kinefab")).report.diagnostics
    assert checked == [d.message for d in exported if d.code == "NOTHING_JOINED"]
    return checked


def test_an_assembly_in_which_nothing_is_joined_is_told_of_once(tmp_path):
    """In Unity all of it falls, and no file says so."""
    path = tmp_path / "case.bundle.json"
    parts = [part(name) for name in ("Base", "Arm", "Tip", "Cap", "Nut")]
    (told,) = unjoined(path, bundle(*parts))
    assert "5 parts" in told and "Base, Arm, Tip and 2 more" in told


def test_loose_parts_that_are_meant_are_not_told_of(tmp_path):
    """One part alone; what lies on a floor, or beside a mechanism; what is fixed to each other, or led by scripts."""
    path = tmp_path / "case.bundle.json"
    parts = part("Base"), part("Arm")
    at = frame([0, 0, 0], [0, 0, 1])
    sides = {"a": "Base", "b": "Arm", "frameA": at, "frameB": at}
    hinge, weld = ({"id": "J", "type": kind, **sides} for kind in ("revolute", "rigid"))
    assert unjoined(path, bundle(part("Base"))) == []
    assert unjoined(path, bundle(part("Floor", grounded=True), *parts)) == []
    assert unjoined(path, bundle(*parts, part("Loose"), joints=[hinge])) == []
    assert unjoined(path, bundle(*parts, joints=[weld])) == []
    led, own = Node("a", "a", dynamics=Dynamics(kinematic=True)), Node("b", "b")
    asked = Report()  # a file of shapes, of which it was told already that nothing holds its parts
    asked.add("MATES_NOT_ASKED", count=2)
    for scene, report in ((Scene([led, own]), Report()), (Scene([own, Node("c", "c")]), asked)):
        analysed(scene, ExportOptions(), report)
        assert "NOTHING_JOINED" not in codes(report)


def test_what_is_left_of_a_damaged_bundle_is_checked_without_a_crash(tmp_path):
    """Every field in turn is gone, or of another type."""
    whole = (ROOT / "fixtures" / "lever" / "lever.bundle.json").read_text("utf-8")
    (tmp_path / "lever.obj").write_bytes((ROOT / "fixtures" / "lever" / "lever.obj").read_bytes())
    path = tmp_path / "case.bundle.json"

    def places(value: object, place: tuple = ()):
        items = (
            value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
        )
        for key, own in items:
            yield (*place, key)
            yield from places(own, (*place, key))

    chosen = [place for place in places(json.loads(whole)) if place[0] != "meta"]
    for number, place in enumerate(chosen[:: max(1, len(chosen) // CASES)]):
        values = json.loads(whole)
        holder = values
        for key in place[:-1]:
            holder = holder[key]
        if number % 2:
            del holder[place[-1]]
        else:
            holder[place[-1]] = (None, "x", -7, [], {}, [1, 2, 3])[number // 2 % 6]
        path.write_text(json.dumps(values), encoding="utf-8")
        check(path)
