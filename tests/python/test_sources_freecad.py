"""FreeCAD's documents: the lever is the bundle's lever, and what an assembly holds."""

from __future__ import annotations

import math
import zipfile
from xml.sax.saxutils import quoteattr

import numpy as np
import pytest
from freecad_files import (
    assembly,
    document,
    flag,
    integer,
    joint,
    link,
    links,
    number,
    part,
    placement,
    shape,
    sub,
    text,
    word,
)
from kinefab import sources
from kinefab.analysis import analyse
from kinefab.diagnostics import Report, Severity
from kinefab.model import ConstraintKind, JointKind, Motion, NodeKind
from kinefab.sources.freecad.links import Documents
from kinefab.sources.freecad.occurrences import Tree
from source_bundles import FIXTURES

LEVER = FIXTURES / "lever"


def read(path):
    report = Report()
    return sources.read(path, report), report


@pytest.fixture(scope="module")
def levers():
    return read(LEVER / "lever.FCStd")[0], read(LEVER / "lever.bundle.json")[0]


def test_the_lever_has_the_parts_of_the_bundle(levers):
    """Names, hierarchy, what is rigid and what is ground, and where everything stands; FreeCAD solved to 1e-6 mm."""
    ours, theirs = ({node.id: node for node in scene.nodes} for scene in levers)
    assert ours.keys() == theirs.keys()
    for key, node in theirs.items():
        found = ours[key]
        assert (found.kind, found.grounded, found.flexible) == (node.kind, node.grounded, node.flexible)
        assert (found.parent is None) == (node.parent is None)
        assert np.abs(found.pose.rotation - node.pose.rotation).max() < 1e-6
        assert np.abs(found.pose.translation - node.pose.translation).max() < 1e-6
        assert [body.name for body in found.bodies] in ([body.name for body in node.bodies], [])


def test_the_lever_has_the_joints_of_the_bundle(levers):
    """Kinds, axes in the world, limits that are switched on, and the coordinate's zero and sense."""
    ours, theirs = ({joint.id: joint for joint in scene.joints} for scene in levers)
    assert ours.keys() == theirs.keys()
    for key, told in theirs.items():
        found = ours[key]
        assert found.kind is told.kind
        frames = [scene.pose(j.a) @ j.frame_a for scene, j in zip(levers, (found, told))]
        assert np.abs(frames[0].rotation[:, 0] - frames[1].rotation[:, 0]).max() < 1e-6
        apart = frames[0].translation - frames[1].translation
        assert np.abs(np.cross(apart, frames[1].rotation[:, 0])).max() < 1e-6
        ranges = [
            [(f.lower, f.upper) for f in j.freedoms if f.motion is Motion.LIMITED] for j in (found, told)
        ]
        assert np.allclose(*ranges, atol=1e-9)
        here = [
            (scene.pose(j.a) @ j.frame_a).inverse() @ scene.pose(j.b) @ j.frame_b
            for scene, j in zip(levers, (found, told))
        ]
        assert np.abs(here[0].rotation - here[1].rotation).max() < 1e-6
        assert abs(here[0].translation[0] - here[1].translation[0]) < 1e-6


def written(tmp_path, objects, version="1.0R", **members):
    (tmp_path / "a.FCStd").write_bytes(document(objects, version, **members))
    scene, report = read(tmp_path / "a.FCStd")
    return scene, [d.code for d in report.diagnostics]


TWO = {"Base": part(), "Arm": part(Placement=placement(x=30.0))}


def test_limits_need_their_flags(tmp_path):
    """Numbers without a flag are no limits; one end alone is; the wrong way round they change places, as in FreeCAD."""
    ends = {
        "AngleMin": number(80.0),
        "AngleMax": number(-10.0),
        "LengthMin": number(-41.0),
        "LengthMax": number(7.0),
    }
    on = {"EnableAngleMin": flag(True), "EnableAngleMax": flag(True), "EnableLengthMax": flag(True)}
    both = {
        "Off": joint("Cylindrical", "Base.", "Arm.", **ends),
        "On": joint("Cylindrical", "Base.", "Arm.", **ends, **on),
        "Other": joint("Slider", "Base.", "Arm.", **ends, EnableAngleMin=flag(True)),
    }
    scene, codes = written(tmp_path, assembly(TWO, both))
    off, on_, other = scene.joints
    assert not codes and {f.motion for f in off.freedoms} == {Motion.LOCKED, Motion.FREE}
    tx, rx = on_.freedoms[0], on_.freedoms[3]
    assert (tx.lower, tx.upper) == (-math.inf, pytest.approx(0.007))
    assert (rx.lower, rx.upper) == (pytest.approx(math.radians(-10)), pytest.approx(math.radians(80)))
    assert other.freedoms[0].motion is Motion.FREE  # an angle's limit means nothing to a slider


def test_version_1_1(tmp_path):
    """Its changes, written by hand: Suppressed for Activated, an Angle of its own, limits as angles and lengths."""
    angle = {"AngleMin": number(-10.0, "App::PropertyAngle"), "EnableAngleMin": flag(True)}
    given = {
        "Hinge": joint("Revolute", "Base.", "Arm.", Suppressed=flag(False), **angle),
        "Off": joint("Slider", "Base.", "Arm.", Suppressed=flag(True)),
        "Bend": joint(
            "Angle", "Base.", "Arm.", Angle=number(35.0, "App::PropertyAngle"), Distance=number(0.0)
        ),
        "Flat": joint("Angle", "Base.", "Arm.", Angle=number(360.0, "App::PropertyAngle")),
    }
    for name in ("Hinge", "Off"):
        del given[name][1]["Activated"]
    scene, codes = written(tmp_path, assembly(TWO, given), "1.1R")
    assert codes == ["FEATURE_SUPPRESSED"] and [j.id for j in scene.joints] == ["Hinge"]
    assert scene.joints[0].freedoms[3].lower == pytest.approx(math.radians(-10))
    assert [(c.kind, c.value) for c in scene.constraints] == [
        (ConstraintKind.ANGLE, pytest.approx(math.radians(35))),
        (ConstraintKind.PARALLEL, 0.0),
    ]


def test_before_version_1_0(tmp_path):
    """Object, part and element apart; another list of joint types, read by its words."""
    old = {
        "JointType": word("Slider", ["Slider", "Fixed", "Planar"]), "Activated": flag(True),
        "Part1": link("Base"), "Object1": text("Base"), "Element1": text("Face6"),
        "Part2": link("Arm"), "Object2": sub("Arm", "Face1"),
        "Placement1": placement(x=30.0), "Placement2": placement(),
    }  # fmt: skip
    old["Object1"] = link("Base")
    scene, codes = written(tmp_path, assembly(TWO, {"Old": ("App::FeaturePython", old)}), "0.22R")
    assert not codes and [j.kind for j in scene.joints] == [JointKind.PRISMATIC]
    assert [scene.name(n) for n in (scene.joints[0].a, scene.joints[0].b)] == [
        "Assembly/Base",
        "Assembly/Arm",
    ]


def test_z_axes_may_be_opposed(tmp_path):
    """J upside down: the angle still counts about I's z, from x to x."""
    c, s = math.cos(math.radians(20.0)), math.sin(math.radians(20.0))  # half of 40 degrees
    over = (c, s, 0.0, 0.0)  # half a turn about x, then 40 degrees about z
    given = {
        "Hinge": joint(
            "Revolute",
            "Base.",
            "Arm.",
            Placement1=placement(x=30.0, q=(0, 0, 0, 1)),
            Placement2=placement(q=over),
        )
    }
    scene, _ = written(tmp_path, assembly(TWO, given))
    hinge = scene.joints[0]
    between = (scene.pose(hinge.a) @ hinge.frame_a).inverse() @ scene.pose(hinge.b) @ hinge.frame_b
    assert between.rotation[0, 0] == pytest.approx(1.0)
    assert math.atan2(between.rotation[2, 1], between.rotation[1, 1]) == pytest.approx(math.radians(40.0))


def test_a_screw_without_a_slider_is_left_out(tmp_path):
    """FreeCAD's solver does not use it either."""
    scene, codes = written(
        tmp_path, assembly(TWO, {"Thread": joint("Screw", "Base.", "Arm.", Distance=number(5.0))})
    )
    assert codes == ["FREECAD_JOINT_DROPPED"] and not scene.couplings


def test_other_workbenches_are_told(tmp_path):
    """A2plus: parts and what is held; its constraints are named.  Assembly4: one rigid group; attachments are named."""
    solid = (
        "Part::FeaturePython",
        {"Placement": placement(), "fixedPosition": flag(True), "Shape": shape("")},
    )
    loose = (
        "Part::FeaturePython",
        {"Placement": placement(x=5.0), "fixedPosition": flag(False), "Shape": shape("")},
    )
    axial = (
        "App::FeaturePython",
        {"Type": text("axial"), "Object1": text("A"), "SubElement1": text("Face1"), "Object2": text("B")},
    )
    scene, codes = written(tmp_path, {"A": solid, "B": loose, "axial_001": axial})
    assert codes == ["FREECAD_JOINT_DROPPED"] and [node.grounded for node in scene.nodes] == [True, False]
    arm = (
        "App::Link",
        {
            "LinkedObject": link("Body"),
            "SolverId": text("Asm4EE"),
            "AttachedTo": text("Parent Assembly#LCS_0"),
        },
    )
    solid = ("Part::Feature", {"Shape": shape(""), "Placement": placement()})
    objects = {
        "Assembly": ("App::Part", {"Group": links("Arm")}),
        "Arm": arm,
        "Body": part(Group=links("Solid")),
        "Solid": solid,
    }
    scene, codes = written(tmp_path, objects)
    assert codes == ["FREECAD_ATTACHED"]
    older = {("AssemblyType" if name == "SolverId" else name): value for name, value in arm[1].items()}
    assert written(tmp_path, objects | {"Arm": ("App::Link", older)})[1] == ["FREECAD_ATTACHED"]
    assert [(n.id, n.flexible) for n in scene.nodes if n.kind is NodeKind.ASSEMBLY] == [("Assembly", False)]


def test_what_only_made_another_shape_or_is_shown_by_links_is_no_part(tmp_path):
    """A cut's hidden base and tool at the root, and a hidden original that links show; what is visible stays."""
    hidden = {"Visibility": flag(False), "Shape": shape(""), "Placement": placement()}
    objects = {
        "Block": ("Part::Box", hidden),
        "Drill": ("Part::Cylinder", hidden),
        "Plate": ("Part::Cut", {"Base": link("Block"), "Tool": link("Drill"), "Shape": shape("")}),
        "Bolt": ("Part::Feature", hidden),
        "Bolt001": ("App::Link", {"LinkedObject": link("Bolt"), "Placement": placement(x=20.0)}),
        "Spare": ("Part::Feature", hidden),
        "Nut": ("Part::Feature", {"Shape": shape(""), "Placement": placement()}),
        "Nut001": ("App::Link", {"LinkedObject": link("Nut"), "Placement": placement(x=30.0)}),
    }
    scene, codes = written(tmp_path, objects)
    assert not codes
    assert [node.id for node in scene.nodes] == ["Plate", "Bolt001", "Spare", "Nut", "Nut001"]
    folder = objects | {"Parts": ("App::DocumentObjectGroup", {"Group": links("Bolt", "Spare")})}
    scene, codes = written(tmp_path, folder)
    assert {node.id for node in scene.nodes} == {"Plate", "Bolt001", "Spare", "Nut", "Nut001"}


def test_a_container_without_a_shape_is_no_body(tmp_path):
    """Empty, or of a sketch alone; one that a joint names stays a part."""
    sketch = ("Sketcher::SketchObject", {"Shape": shape(""), "Placement": placement()})
    objects = {
        "Box": ("Part::Box", {"Shape": shape(""), "Placement": placement()}),
        "Empty": ("App::Part", {"Placement": placement()}),
        "Drawn": ("App::Part", {"Placement": placement(), "Group": links("Sketch")}),
        "Sketch": sketch,
    }
    scene, codes = written(tmp_path, objects)
    assert not codes
    assert {node.id: node.kind is NodeKind.PART for node in scene.nodes} == {
        "Box": True,
        "Empty": False,
        "Drawn": False,
    }
    frame = ("App::Part", {"Placement": placement(z=40.0)})
    scene, _ = written(
        tmp_path, assembly({"Base": part(), "Frame": frame}, {"M": joint("Revolute", "Base.", "Frame.")})
    )
    assert [node.id for node in scene.nodes if node.kind is NodeKind.PART] == [
        "Assembly/Base",
        "Assembly/Frame",
    ]


def test_a_linked_file_may_be_spelled_with_other_capitals(tmp_path):
    """As Windows takes it; not where two files differ in nothing else."""
    inner = ("Part::Feature", {"Shape": shape(""), "Placement": placement()})
    (tmp_path / "ARM.fcstd").write_bytes(document({"Arm": inner}))
    away = link("Arm", "Arm.FCStd")
    objects = {"Link": ("App::Link", {"LinkedObject": away, "Placement": placement(x=5.0)})}
    assert written(tmp_path, objects)[1] == []
    (tmp_path / "arm.FCSTD").write_bytes(document({"Arm": inner}))
    assert written(tmp_path, objects)[1] == ["FREECAD_LINK_BROKEN"]


def test_a_density_is_taken_where_the_document_holds_one(tmp_path):
    pytest.importorskip("OCP", reason="OpenCASCADE is not installed: pip install cadquery-ocp-novtk")
    with zipfile.ZipFile(FIXTURES / "freecad" / "revolute.FCStd") as file:
        brep = file.read("Base.Shape.brp")
    steel = (
        "App::MaterialObjectPython",
        {"Material": ("App::PropertyMap", '<Map count="1"><Item key="Density" value="7.85 g/cm^3"/></Map>')},
    )
    base = (
        "Part::Feature",
        {"Shape": shape("Base.Shape.brp"), "Placement": placement(), "Material": link("Steel")},
    )
    scene, codes = written(tmp_path, {"Base": base, "Steel": steel}, **{"Base.Shape.brp": brep})
    assert not codes and scene.nodes[0].bodies[0].density == pytest.approx(7850.0)


def test_colours_are_those_of_the_screen_in_linear_light(levers):
    """The lever's steel, 0.62 0.64 0.67 on the screen."""
    if not levers[0].surfaces:
        pytest.skip("OpenCASCADE is not installed: pip install cadquery-ocp-novtk")
    colours = {surface.name: surface.color for surface in levers[0].surfaces}
    assert colours.keys() == {"#404247", "#9EA3AB", "#C79E45", "#0D0D0D"}
    assert colours["#9EA3AB"][:3] == pytest.approx([0.342, 0.367, 0.407], abs=2e-3)


def test_without_opencascade_the_mechanism_is_read(monkeypatch):
    """Joints and poses are the same; the report names the extra."""
    from kinefab.sources.freecad import shapes

    monkeypatch.setattr(shapes, "available", lambda: False)
    scene, report = read(FIXTURES / "freecad" / "four_bar.FCStd")
    assert len(scene.joints) == 4 and not scene.meshes
    assert [d.code for d in report.diagnostics] == [
        "SHAPE_NOT_READ"
    ] and "pip install cadquery-ocp-novtk" in report.diagnostics[0].message
    scene, report = read(FIXTURES / "freecad" / "distance_cylinders.FCStd")
    assert "FREECAD_JOINT_DROPPED" in [d.code for d in report.diagnostics] and not scene.constraints


def test_a_tolerance_may_be_asked_for():
    """Finer by --tolerance, and another word is refused as with every B-rep format."""
    pytest.importorskip("OCP", reason="OpenCASCADE is not installed: pip install cadquery-ocp-novtk")
    path, counts = FIXTURES / "freecad" / "revolute.FCStd", []
    for asked in ("0.5", "0.01,5"):
        scene = sources.read(path, Report(), options={"tolerance": asked})
        counts.append(sum(len(mesh.faces) for mesh in scene.meshes))
    assert counts[1] > 2 * counts[0]


def test_the_levers_asmt_has_its_motion(levers):
    """FreeCAD's export for its solver: the bundle's joints without geometry, its parts on the ground by a fixed joint."""
    scene, report = read(LEVER / "lever.asmt")
    assert [d.code for d in report.diagnostics] == ["ASMT_ASSUMED"]
    kinds = sorted(joint.kind.value for joint in scene.joints)
    assert kinds == ["fixed", "prismatic", "revolute", "revolute", "revolute"]
    slide = next(joint for joint in scene.joints if joint.kind is JointKind.PRISMATIC)
    assert (slide.freedoms[0].lower, slide.freedoms[0].upper) == (pytest.approx(0.065), pytest.approx(0.115))
    told = {node.name: node.pose for node in levers[1].nodes}
    for node in scene.nodes[1:]:
        pose = told[node.name.replace("_1", ":1")]
        assert np.abs(node.pose.translation - pose.translation).max() < 1e-6
        assert np.abs(node.pose.rotation - pose.rotation).max() < 1e-6
    islands = [sum(island.mobility for island in analyse(one).islands) for one in (scene, *levers)]
    assert islands == [1, 1, 1]


def test_a_material_of_the_library_and_a_mesh_are_told(tmp_path):
    """The library's densities are not in the file: those of common materials are taken, and told; a mesh's points are in no
    form that is read.  A material is told once."""
    pytest.importorskip("OCP", reason="OpenCASCADE is not installed: pip install cadquery-ocp-novtk")
    with zipfile.ZipFile(FIXTURES / "freecad" / "revolute.FCStd") as file:
        brep = file.read("Base.Shape.brp")

    def made_of(uuid: str):
        material = ("Materials::PropertyMaterial", f'<PropertyMaterial uuid="{uuid}"/>')
        return "Part::Feature", {"Shape": shape("Base.Shape.brp"), "ShapeMaterial": material}

    special, default = "92589471-a6cb-4bbc-b748-d425a17dea7d", "7f9fd73b-50c9-41d8-b7b2-575a030c1eeb"
    steel, copper = "90bbd8ef-8623-4d78-b3bf-e0bdb9b74dd3", "6c03899d-496e-4c60-a41b-3d66f2337fb9"
    objects = {
        "Base": made_of(special),
        "Lid": made_of(special),
        "Box": made_of(default),
        "Bolt": made_of(steel),
        "Nut": made_of(steel),
        "Bus": made_of(copper),
        "Scan": ("Mesh::Feature", {}),
    }
    scene, codes = written(tmp_path, objects, **{"Base.Shape.brp": brep})
    assert sorted(codes) == ["FREECAD_DENSITY", "FREECAD_DENSITY", "FREECAD_MATERIAL", "SHAPE_NOT_READ"]
    densities = [body.density for node in scene.nodes for body in node.bodies]
    assert densities == [None, None, None, 7900.0, 7900.0, 8960.0]
    assert [node.name for node in scene.nodes] == ["Base", "Lid", "Box", "Bolt", "Nut", "Bus", "Scan"]


def test_a_plane_of_an_older_asmt_has_no_offset(tmp_path):
    """OndselSolver's first files leave the word out where it is zero."""
    lines = (FIXTURES / "freecad" / "distance_planes.asmt").read_text("utf-8").splitlines(keepends=True)
    at = next(i for i, line in enumerate(lines) if line.strip() == "offset")
    (tmp_path / "older.asmt").write_text("".join(lines[:at] + lines[at + 2 :]), "utf-8")
    scene, report = read(tmp_path / "older.asmt")
    assert not report.of(Severity.ERROR)
    assert [
        constraint.value for constraint in scene.constraints if constraint.kind is ConstraintKind.DISTANCE
    ] == [0.0]


def test_a_copied_joint_that_names_its_own_file_is_followed_to_the_copy(tmp_path):
    """Of a flexible sub-assembly that holds another one, FreeCAD 1.0 copies a joint with one side left in its own file."""
    inner = assembly({"Frame": part(), "Arm": part()}, {"M": joint("Revolute", "Frame.", "Arm.")})
    (tmp_path / "unit.FCStd").write_bytes(document(inner))
    sides = {
        f"Reference{n}": (
            "App::PropertyXLinkSubHidden",
            f'<XLink file={quoteattr(file)} stamp="" name="Assembly" count="1"><Sub value={quoteattr(path)}/></XLink>',
        )
        for n, file, path in ((1, "", "Unit.Frame."), (2, "unit.FCStd", "Arm."))
    }
    copied = ("App::FeaturePython", {**joint("Revolute", "", "")[1], **sides})
    below = {
        "UnitJoints": ("Assembly::JointGroup", {"Group": links("Copied")}),
        "Frame": ("App::Link", {"LinkedObject": link("Frame", "unit.FCStd"), "Placement": placement()}),
        "Arm": ("App::Link", {"LinkedObject": link("Arm", "unit.FCStd"), "Placement": placement()}),
        "Copied": copied,
    }
    unit = {"LinkedObject": link("Assembly", "unit.FCStd"), "Rigid": flag(False), "Group": links(*below)}
    outer = assembly(
        {"Base": part(), "Unit": ("Assembly::AssemblyLink", unit)},
        {"Held": joint("Fixed", "Base.", "Unit.Frame.")},
        **below,
    )
    (tmp_path / "whole.FCStd").write_bytes(document(outer))
    report = Report()
    scene = sources.read(tmp_path / "whole.FCStd", report)
    assert not report.of(Severity.ERROR) and "FREECAD_JOINT_DROPPED" not in [
        d.code for d in report.diagnostics
    ]
    ends = {(scene.name(j.a), scene.name(j.b)) for j in scene.joints if j.kind is JointKind.REVOLUTE}
    assert ends == {("Assembly/Unit/Frame", "Assembly/Unit/Arm")}


@pytest.mark.parametrize("kind", ["Assembly::AssemblyLink", "App::Link"])
def test_joints_of_a_rigid_sub_assembly_are_remarked_on_and_no_loss(tmp_path, kind):
    """FreeCAD keeps them in the sub-assembly's own file; they hold nothing here, a ground among them neither."""
    inner = assembly({"Frame": part(), "Arm": part(), "Tip": part()}, {
        "M": joint("Revolute", "Frame.", "Arm."), "N": joint("Slider", "Arm.", "Tip.")})  # fmt: skip
    (tmp_path / "unit.FCStd").write_bytes(document(inner))
    below = {
        name: ("App::Link", {"LinkedObject": link(name, "unit.FCStd"), "Placement": placement()})
        for name in (("Frame", "Arm", "Tip") if kind == "Assembly::AssemblyLink" else ())
    }
    unit = {"LinkedObject": link("Assembly", "unit.FCStd"), "Group": links(*below), "Placement": placement()}
    if below:
        unit["Rigid"] = flag(True)
    held = {"Held": joint("Revolute", "Base.", "Unit.Frame.")}
    (tmp_path / "whole.FCStd").write_bytes(
        document(assembly({"Base": part(), "Unit": (kind, unit)}, held, **below))
    )
    scene, report = read(tmp_path / "whole.FCStd")
    assert [j.id for j in scene.joints] == ["Held"]
    (told,) = [found for found in report.diagnostics if found.code == "FREECAD_RIGID"]
    assert (told.severity, told.where) == (Severity.INFO, "whole.FCStd#Unit")
    assert "Unit (2)" in told.message
    assert {entry.outcome.value for entry in report.outcomes} == {"kept"}


def test_of_a_flexible_sub_assembly_in_a_rigid_one_the_rigid_one_is_named(tmp_path):
    """That is the one to be made flexible."""
    inner = assembly({"Frame": part(), "Arm": part()}, {"M": joint("Revolute", "Frame.", "Arm.")})
    (tmp_path / "unit.FCStd").write_bytes(document(inner))
    at = {"Placement": placement()}
    parts = {
        name: ("App::Link", {"LinkedObject": link(name, "unit.FCStd"), **at}) for name in ("Frame", "Arm")
    }
    unit = {
        "LinkedObject": link("Assembly", "unit.FCStd"),
        "Group": links(*parts),
        "Rigid": flag(False),
        **at,
    }
    outer = {
        "LinkedObject": link("Assembly", "unit.FCStd"),
        "Group": links("Unit"),
        "Rigid": flag(True),
        **at,
    }
    below = {"Unit": ("Assembly::AssemblyLink", unit), **parts}
    objects = assembly({"Base": part(), "Outer": ("Assembly::AssemblyLink", outer)}, {}, **below)
    (tmp_path / "whole.FCStd").write_bytes(document(objects))
    _, report = read(tmp_path / "whole.FCStd")
    told = {d.where: d.message for d in report.diagnostics if d.code == "FREECAD_RIGID"}
    assert "joints of assembly Unit in rigid assembly Outer (1)" in told["whole.FCStd#Unit"]
    assert "joints of rigid assembly Outer (1)" in told["whole.FCStd#Outer"]


def grid(**more):
    """An assembly of a base and an array of two carriages, each of a plate and a post; the carriage stands 40 mm up."""
    at = {"Plate": placement(x=1.0), "Post": placement(y=2.0)}
    brep = shape("Base.Shape.brp")
    parts = {name: ("Part::Feature", {"Placement": place, "Shape": brep}) for name, place in at.items()}
    linked = {"LinkedObject": link("Carriage"), "LinkTransform": flag(True)}
    array = {**linked, "ElementCount": integer(2), "ElementList": links("E0", "E1"), "Placement": placement()}
    elements = {
        f"E{n}": ("App::LinkElement", {**linked, "Placement": placement(x=50.0 * n)}) for n in range(2)
    }
    carriage = ("App::Part", {"Placement": placement(z=40.0), "Group": links(*parts)})
    return {"Base": part(), "Row": ("App::Link", array), **more}, {**elements, **parts, "Carriage": carriage}


def with_brep(objects) -> bytes:
    with zipfile.ZipFile(FIXTURES / "freecad" / "revolute.FCStd") as file:
        return document(objects, **{"Base.Shape.brp": file.read("Base.Shape.brp")})


def test_elements_of_an_array_of_parts_move_and_their_joints_stand_where_freecad_has_them(tmp_path):
    """FreeCAD's solver multiplies the placements of a joint's path: that of the linked part, which LinkTransform shows, is none
    of them.  An element moves by itself; nothing of an array is on the ground."""
    inside, outside = grid()
    held = {"S": joint("Slider", "Base.", "Row.E1.Plate.Face6", Placement2=placement(x=3.0))}
    (tmp_path / "a.FCStd").write_bytes(with_brep(assembly(inside, held, **outside)))
    scene, report = read(tmp_path / "a.FCStd")
    assert not report.of(Severity.ERROR)
    assert {node.id for node in scene.nodes if node.grounded} == {"Assembly/Base"}
    (sliding,) = scene.joints
    frame = scene.pose(sliding.b) @ sliding.frame_b
    np.testing.assert_allclose(frame.translation, [0.054, 0.0, 0.0], atol=1e-12)
    assert scene.name(sliding.b) == "Assembly/Row/E1"


def test_a_link_to_an_array_shows_all_of_its_elements(tmp_path):
    pytest.importorskip("OCP", reason="OpenCASCADE is not installed: pip install cadquery-ocp-novtk")
    again = ("App::Link", {"LinkedObject": link("Row"), "Placement": placement(y=300.0)})
    inside, outside = grid(Again=again)
    (tmp_path / "a.FCStd").write_bytes(with_brep(assembly(inside, {}, **outside)))
    scene, _ = read(tmp_path / "a.FCStd")
    ids = [node.id for node in scene.nodes if node.bodies]
    assert ids == [f"Assembly/{name}/E{n}" for name in ("Row", "Again") for n in range(2)]
    ends = [node.pose.translation for node in scene.nodes if node.id.startswith("Assembly/Again/")]
    np.testing.assert_allclose(ends, [[0.0, 0.0, -0.3], [0.05, 0.0, -0.3]], atol=1e-12)


@pytest.mark.parametrize("folder", [False, True])
def test_an_assembly_within_a_part_moves_and_what_stands_beside_it_does_not(tmp_path, folder):
    """The part's place goes to all of them; a folder between them has none."""
    held = {"Swing": joint("Revolute", "Base.", "Arm.", Placement1=placement(x=5.0, y=7.0))}
    turned = placement(x=11.0, y=-3.0, q=(0.0, 0.0, 0.6, 0.8))
    group = links("Folder", "Stand") if folder else links("Assembly", "Stand")
    outside = {"Holder": ("App::Part", {"Placement": turned, "Group": group}), "Stand": part()}
    if folder:
        outside["Folder"] = ("App::DocumentObjectGroup", {"Group": links("Assembly")})
    (tmp_path / "a.FCStd").write_bytes(document(assembly({"Base": part(), "Arm": part()}, held, **outside)))
    scene, report = read(tmp_path / "a.FCStd")
    (swing,) = scene.joints
    assert (scene.name(swing.a), scene.name(swing.b)) == ("Holder/Assembly/Base", "Holder/Assembly/Arm")
    frame = scene.pose(swing.a) @ swing.frame_a
    x, y = 11.0 + 0.28 * 5.0 - 0.96 * 7.0, -3.0 + 0.96 * 5.0 + 0.28 * 7.0
    np.testing.assert_allclose(frame.translation, [x * 1e-3, 0.0, -y * 1e-3], atol=1e-12)
    grounded = {node.id for node in scene.nodes if node.grounded}
    assert grounded == {"Holder/Assembly/Base", "Holder/Stand"}
    assert analyse(scene).mobility == 1


def test_what_a_folder_holds_is_there_once(tmp_path):
    """A part lists what its folders hold, too, at any depth; the bolt fell a second time, of no joint."""
    held = {"Pin": joint("Revolute", "Base.", "Bolt.")}
    objects = assembly(
        {"Base": part(), "Bolts": ("App::DocumentObjectGroup", {"Group": links("Bolt", "Small")}), "Bolt": part(),
         "Screw": part(), "Plate": part(Group=links("Trim", "Box"))},
        held,
        Small=("App::DocumentObjectGroup", {"Group": links("Screw", "Stud")}),
        Stud=part(),
        Trim=("App::DocumentObjectGroup", {"Group": links("Box")}),
        Box=("Part::Box", {"Shape": shape(""), "Placement": placement()}),
    )  # fmt: skip
    scene, _ = written(tmp_path, objects)
    ids = ["Base", "Stud", "Bolt", "Screw", "Plate"]  # the stud is in its folder alone
    assert [node.id for node in scene.nodes] == ["Assembly", *(f"Assembly/{name}" for name in ids)]
    assert analyse(scene).mobility == 1 + 6  # the bolt turns, the plate falls, and empty parts are no bodies
    (path,) = tmp_path.glob("*.FCStd")
    root = Documents(path, Report())
    tree = Tree(root).occurrence(root.root.things["Assembly"], None)
    assert [below.name for below in tree.walk()].count("Box") == 1
