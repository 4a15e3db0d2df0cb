"""Simscape Multibody XML: the lever is the bundle's lever, kinds and joints are read, damaged files end in findings."""

from __future__ import annotations

import json
import os
import random
import sys
import xml.etree.ElementTree as ET

import kinefab
import numpy as np
import pytest
from kinefab import sources
from kinefab.analysis import analyse
from kinefab.diagnostics import KinefabError, Report
from kinefab.geometry.mass import is_possible
from kinefab.model import ConstraintKind, JointKind, NodeKind
from kinefab.sources.simscape.reader import sniff
from same_scene import compare, exported, undrawn
from source_bundles import FIXTURES
from test_sources_freecad_bad_input import damaged

LEVER = FIXTURES / "lever"
XML = LEVER / "simscape" / "lever.xml"
MUTATIONS = int(os.environ.get("KINEFAB_SIMSCAPE_MUTATIONS", "60"))
sys.path.insert(0, str(LEVER))

from simscape_form import as_mates  # noqa: E402

FLOAT32 = 2e-7
"""What an STL keeps of a coordinate."""


def read(path, **options):
    report = Report()
    return sources.read(path, report, options=options), [d.code for d in report.diagnostics]


def document(
    tmp_path,
    constraints: str = "",
    joints: str = "",
    instances: str = "",
    parts: str = "",
):
    """Two instances 2 m apart along X, the first grounded, in the frame of nothing else."""
    path = tmp_path / "two.xml"
    path.write_text(
        f"""<?xml version="1.0"?><SimscapeMultibodyImportXML version="2.0" xmlns="urn:mathworks:SimscapeMultibody:import">
<DataUnits mass="kilogram" length="meter"/><RootAssembly name="Two" uid="Two"><InstanceTree>
<Instance name="Base" uid="b" entityUid="Base*" grounded="true"/>
<Instance name="Arm" uid="a" entityUid="Arm*"><Transform><Rotation>0 -1 0 1 0 0 0 0 1</Rotation><Translation>2 0 0</Translation></Transform></Instance>
{instances}</InstanceTree><Constraints>{constraints}</Constraints><Joints>{joints}</Joints></RootAssembly>
<Parts>{parts}</Parts></SimscapeMultibodyImportXML>"""
    )
    return path


def side(uid: str, kind: str, position: str, axis: str = "") -> str:
    path = f"<InstancePath><Uid>{uid}</Uid></InstancePath>" if uid else "<InstancePath/>"
    axis = f"<Axis>{axis}</Axis>" if axis else ""
    return f'<ConstraintGeometry geomType="{kind}">{path}<Position>{position}</Position>{axis}</ConstraintGeometry>'


def frame(tag: str, uid: str, origin: str) -> str:
    path = f"<InstancePath><Uid>{uid}</Uid></InstancePath>" if uid else "<InstancePath/>"
    return f"<{tag}>{path}<Transform><Rotation>1 0 0 0 1 0 0 0 1</Rotation><Translation>{origin}</Translation></Transform></{tag}>"


def test_the_lever_is_the_bundles_lever(tmp_path):
    """Poses, joints, masses, against a bundle that says no more than the XML can: no limits, inserts as two mates."""
    values = json.loads((LEVER / "lever.bundle.json").read_text("utf-8"))
    values["constraints"] = as_mates(values)
    values.pop("dof")
    for joint in values["joints"]:
        joint.pop("because")
        joint["dof"] = [{"name": d["name"]} for d in joint["dof"]]
        for key in ("dof", "name"):
            joint.pop(key)
    (tmp_path / "lever.obj").write_bytes((LEVER / "lever.obj").read_bytes())
    (tmp_path / "lever.mtl").write_bytes((LEVER / "lever.mtl").read_bytes())
    bundle = tmp_path / "lever.bundle.json"
    bundle.write_text(json.dumps(values), "utf-8")
    expected, found = (mechanism(exported(path, tmp_path)) for path in (bundle, XML))
    assert sum("Joint" in key for key in expected) == 4
    compare(expected, found, "lever", 2e-6)


def mechanism(content: dict) -> dict[str, object]:
    """Parts and assemblies, without what is drawn and touched: a part's one STL cannot tell its bodies apart."""
    parts = {
        entry["id"]
        for entry in content["gameObjects"]
        if entry["id"].count("/") < 2 or "Crank:1/" in entry["id"]
    }
    parts -= {
        entry["id"] for entry in content["gameObjects"] if not entry["id"].endswith((":1", "Lever", "ground"))
    }
    return {key: value for key, value in undrawn(content).items() if key.split(" ")[0] in parts}


def test_parts_have_the_shapes_of_the_bundle(tmp_path):
    """Every part's STL stands where the bundle's bodies of it stand."""

    def boxes(path):
        scene = kinefab.export(path, tmp_path / f"{path.stem}.kinefab").analysed.scene
        points = {
            n.id: [n.pose.point(scene.meshes[b.mesh].vertices) for b in n.bodies]
            for n in scene.nodes
            if n.bodies
        }
        return {
            key: np.concatenate([np.concatenate(found).min(0), np.concatenate(found).max(0)][:])
            for key, found in points.items()
        }

    expected, found = boxes(LEVER / "lever.bundle.json"), boxes(XML)
    assert expected.keys() == found.keys()
    for key, box in expected.items():
        np.testing.assert_allclose(found[key], box, atol=FLOAT32, err_msg=key)


def test_the_constraints_alone_hold_the_lever(tmp_path):
    """Without the joints the analysis finds the four hinges and slides from the geometry of the constraints."""
    text = XML.read_text("utf-8")
    begin, end = text.index("<Joints>"), text.index("</Joints>")
    (tmp_path / "lever.xml").write_text(text[:begin] + text[end + 9 :], "utf-8")
    done = kinefab.export(tmp_path / "lever.xml", tmp_path / "lever.kinefab")
    assert (done.analysed.analysis.mobility, done.numbers[1]) == (1, 4)


def test_formats_of_one_ending_are_told_apart_by_the_root():
    assert sources.format_of(XML).name == "Simscape Multibody XML"
    assert sources.format_of(LEVER / "lever.xml").name == "MJCF"
    head = (
        "<?xml version='1.0' encoding='UTF-16'?><!-- <mujoco> --><s:SimscapeMultibodyImportXML xmlns:s='x'>"
    )
    assert sniff(head.encode("utf-16"))
    assert not sniff(b"<mujoco><!-- SimscapeMultibodyImportXML --></mujoco>")
    assert not sniff(b"no xml")


@pytest.mark.parametrize("name", ["a.xml", "a.json"])
def test_an_ending_of_several_formats_is_refused_with_what_is_read(tmp_path, name):
    (tmp_path / name).write_text("<urdf/>" if name.endswith("xml") else '{"features": []}')
    with pytest.raises(KinefabError) as caught:
        sources.read(tmp_path / name, Report())
    (found,) = caught.value.diagnostics
    assert found.code == "SOURCE_FORMAT_UNKNOWN"
    assert ("SimscapeMultibodyImportXML" if name.endswith("xml") else "definition.json") in found.remedy


def test_rotations_are_read_row_by_row(tmp_path):
    scene, codes = read(document(tmp_path))
    arm = scene.nodes[2]
    assert (arm.id, arm.kind, codes) == ("Two/Arm", NodeKind.PART, [])
    np.testing.assert_allclose(arm.pose.translation, [2.0, 0.0, 0.0])
    np.testing.assert_allclose(
        arm.pose.direction(np.array([1.0, 0.0, 0.0])), [0.0, 0.0, -1.0], atol=1e-12
    )  # x to y, Z up


@pytest.mark.parametrize(
    "tag, kind, a, b, value",
    [
        ("Concentric", ConstraintKind.CONCENTRIC, ("cylinder", "0 0 0", "1 0 0"), ("cylinder", "0 0 0", "0 -1 0"), 0.0),
        ("Coincident", ConstraintKind.COINCIDENT, ("plane", "2 0 0", "1 0 0"), ("plane", "0 0 0", "0 1 0"), 0.0),
        ("Parallel", ConstraintKind.PARALLEL, ("plane", "0 0 0", "0 0 1"), ("line", "0 0 0", "0 0 1"), 0.0),
        ("Angle", ConstraintKind.ANGLE, ("plane", "0 0 0", "1 0 0"), ("plane", "0 0 0", "1 0 0"), np.pi / 2),
        ("Distance", ConstraintKind.DISTANCE, ("plane", "0 0 0", "1 0 0"), ("plane", "0 0 0", "0 1 0"), 2.0),
        ("Distance", ConstraintKind.DISTANCE, ("line", "0 0 5", "0 0 1"), ("line", "0 0 0", "0 0 1"), 2.0),
        ("Distance", ConstraintKind.DISTANCE, ("line", "0 0 0", "1 0 0"), ("line", "0 0 7", "1 0 0"), 7.0),
        ("Distance", ConstraintKind.DISTANCE, ("point", "0 1 0", ""), ("point", "0 0 2", ""), 3.0),
    ],
)  # fmt: skip
def test_constraints_by_kind(tmp_path, tag, kind, a, b, value):
    """A value that the file does not state is that of the pose; the arm's y is the world's -x."""
    text = f'<{tag} name="c">{side("b", *a)}{side("a", *b)}</{tag}>'
    scene, codes = read(document(tmp_path, text))
    (found,) = scene.constraints
    assert found.kind is kind and found.value == pytest.approx(value)
    assert codes == (["SIMSCAPE_MEASURED"] if value else [])


@pytest.mark.parametrize(
    "tag, kind",
    [("Revolute", JointKind.REVOLUTE), ("Prismatic", JointKind.PRISMATIC), ("Weld", JointKind.FIXED),
     ("Spherical", JointKind.SPHERICAL), ("Cylindrical", JointKind.CYLINDRICAL), ("Planar", JointKind.PLANAR),
     ("PinSlot", JointKind.PIN_SLOT), ("UniversalJoint", JointKind.UNIVERSAL)],
)  # fmt: skip
def test_joints_by_type(tmp_path, tag, kind):
    text = f'<{tag} name="j">{frame("BaseFrame", "b", "2 0 0")}{frame("FollowerFrame", "a", "0 0 0")}</{tag}>'
    scene, _ = read(document(tmp_path, joints=text))
    (found,) = scene.joints
    assert (found.kind, found.a, found.b) == (kind, 1, 2)


def test_a_joint_to_the_assembly_itself_is_one_to_the_ground(tmp_path):
    text = f'<Revolute name="j">{frame("BaseFrame", "a", "0 0 0")}{frame("FollowerFrame", "", "2 0 0")}</Revolute>'
    scene, _ = read(document(tmp_path, joints=text))
    (joint,) = scene.joints
    assert (joint.a, joint.b) == (None, 2)
    at = joint.frame_a.translation
    assert np.allclose(at, (scene.pose(2) @ joint.frame_b).translation) and np.linalg.norm(
        at
    ) == pytest.approx(2.0)


def nested(tmp_path, inside: str, held: str = "", constraints: str = ""):
    """A sub-assembly of two parts, 3 m along X and turned about Z, on a hinge to the grounded base.  inside: attributes of its
    first part.  held: of the instance of the sub-assembly itself.  constraints: in the sub-assembly."""
    instances = f"""<Instance name="Sub" uid="s" entityUid="Sub" {held}><Transform><Rotation>0 -1 0 1 0 0 0 0 1</Rotation>
<Translation>3 0 0</Translation></Transform><Instance name="Frame" uid="f" entityUid="F*" {inside}/>
<Instance name="Foot" uid="g" entityUid="F*" grounded="true"><Transform><Translation>1 0 0</Translation></Transform></Instance></Instance>"""
    foot = "<InstancePath><Uid>s</Uid><Uid>g</Uid></InstancePath><Transform><Translation>0 0 0</Translation></Transform>"
    hinge = f'<Revolute name="h">{frame("BaseFrame", "b", "3 1 0")}<FollowerFrame>{foot}</FollowerFrame></Revolute>'
    path = document(tmp_path, joints=hinge, instances=instances)
    sub = f'<Assemblies><Assembly name="Sub" uid="Sub"><Constraints>{constraints}</Constraints></Assembly></Assemblies>'
    path.write_text(path.read_text().replace("<Parts>", sub + "<Parts>"))
    return path


@pytest.mark.parametrize(
    "inside, held, mobility, falls",
    [('grounded="true"', "", 1, 0), ("", "", 1, 6), ('grounded="true"', 'grounded="true"', 0, 0), ("", 'rigid="true"', 1, 0)],
)  # fmt: skip
def test_what_is_grounded_in_a_sub_assembly_goes_with_it(tmp_path, inside, held, mobility, falls):
    """The first part that somebody lays into an assembly is grounded in it, not in what the assembly is laid into.

    falls: freedoms of a part that nothing holds in the sub-assembly."""
    scene, codes = read(nested(tmp_path, inside, held))
    assert codes == []
    assert analyse(scene).mobility == 6 + mobility + falls  # the arm hangs on nothing


def test_an_assembly_names_itself_by_its_own_uid(tmp_path):
    """SolidWorks mates the first part to the planes of the assembly: of the root that is the ground, of one that moves what is
    grounded in it."""
    axes = ("1 0 0", "0 1 0", "0 0 1")
    mates = [
        (f"Coincident name='m{i}'", side("Two", "plane", "2 0 0", axis), side("a", "plane", "0 0 0", turned))
        for i, (axis, turned) in enumerate(zip(axes, ("0 -1 0", "1 0 0", "0 0 1"), strict=True))
    ]
    text = "".join(f"<{tag}>{a}{b}</Coincident>" for tag, a, b in mates)
    scene, codes = read(document(tmp_path, text))
    assert codes == [] and {c.features[0].node for c in scene.constraints} == {None}
    assert analyse(scene).mobility == 0

    inner = "".join(
        f'<Coincident name="n">{side("Sub", "plane", "0 0 0", axis)}{side("f", "plane", "0 0 0", axis)}</Coincident>'
        for axis in axes
    )
    scene, codes = read(nested(tmp_path, "", constraints=inner))
    assert codes == []
    foot, frame_, sub = (
        next(i for i, n in enumerate(scene.nodes) if n.name == name) for name in ("Foot", "Frame", "Sub")
    )
    assert {tuple(f.node for f in c.features) for c in scene.constraints} == {(foot, frame_)}
    for constraint in scene.constraints:  # stated in the sub-assembly's own frame
        at = scene.pose(foot).point(np.asarray(constraint.features[0].point))
        np.testing.assert_allclose(at, scene.pose(sub).translation, atol=1e-12)
    assert analyse(scene).mobility == 6 + 1


@pytest.mark.parametrize(
    "inertia",
    ["0.000000000 0.000000004 0.000000004 0 0 0", "0 0 0 0 0 0", "0.000000061 0.000000030 0.000000030 0 0 0"],
)
def test_an_inertia_that_was_rounded_is_mended(tmp_path, inertia):
    """Nine decimals, as Onshape's exporter writes them, leave a small pin a tensor that no body can have; its mass stands."""
    part = f"""<Part name="Arm" uid="Arm*"><MassProperties><Mass>0.0002</Mass><CenterOfMass>0.01 0.02 0.03</CenterOfMass>
<Inertia>{inertia}</Inertia></MassProperties></Part>"""
    twin = '<Instance name="Twin" uid="t" entityUid="Arm*"/>'
    scene, codes = read(document(tmp_path, parts=part, instances=twin))
    assert codes == ["INERTIA_MENDED"]  # once for both
    for node in scene.nodes[2:]:
        assert (
            node.mass is not None and node.mass.mass == pytest.approx(2e-4) and is_possible(node.mass.inertia)
        )
        np.testing.assert_allclose(node.mass.center, [0.01, 0.03, -0.02])


def test_what_cannot_be_kept_is_told_by_name(tmp_path):
    tangent = f'<Tangent name="t">{side("b", "plane", "0 0 0", "0 0 1")}{side("a", "cylinder", "0 0 0", "1 0 0")}</Tangent>'
    lost = f'<Coincident name="l">{side("b", "plane", "0 0 0", "0 0 1")}{side("gone", "plane", "0 0 0", "0 0 1")}</Coincident>'
    odd = f'<LeadScrewJoint name="s">{frame("BaseFrame", "b", "0 0 0")}{frame("FollowerFrame", "a", "0 0 0")}</LeadScrewJoint>'
    cam = f'<CamFollower name="c">{side("b", "plane", "0 0 0", "0 0 1")}{side("a", "plane", "0 0 0", "0 0 1")}</CamFollower>'
    scene, codes = read(document(tmp_path, tangent + lost + cam, odd))
    assert codes == ["SIMSCAPE_LEFT_OUT"] * 3 + ["CONSTRAINT_KIND_UNKNOWN"]
    assert [c.kind for c in scene.constraints] == [ConstraintKind.OTHER] and scene.joints == []


@pytest.mark.parametrize("file", ["../far.stl", "/etc/passwd", "..\\far.stl", "C:\\far.stl", "link.stl"])
def test_files_outside_of_the_folder_are_not_opened(tmp_path, file):
    """The part moves without its geometry."""
    inside = tmp_path / "inside"
    inside.mkdir()
    (tmp_path / "far.stl").write_bytes((LEVER / "simscape" / "Shaft.ipt.STL").read_bytes())
    (inside / "link.stl").symlink_to(tmp_path / "far.stl")
    part = f'<Part name="Arm" uid="Arm*"><GeometryFile name="{file}" type="STL"/></Part>'
    scene, codes = read(document(inside, parts=part))
    assert codes == ["SIMSCAPE_LEFT_OUT"] and scene.nodes[2].bodies == ()


def test_a_part_whose_file_is_bad_moves_without_it(tmp_path):
    (tmp_path / "bad.stl").write_bytes(b"solid nothing")
    part = '<Part name="Arm" uid="Arm*"><GeometryFile name="bad.stl" type="STL"/></Part>'
    joint = f'<Revolute name="j">{frame("BaseFrame", "b", "2 0 0")}{frame("FollowerFrame", "a", "0 0 0")}</Revolute>'
    done = kinefab.export(document(tmp_path, joints=joint, parts=part), tmp_path / "a.kinefab")
    assert "MESH_UNREADABLE" in [d.code for d in done.report.diagnostics]
    assert done.numbers[1] == 1


def test_the_words_of_the_writer_decide_units(tmp_path):
    path = document(tmp_path)
    path.write_text(path.read_text().replace('length="meter"', 'length="millimeter"'))
    assert read(path)[0].nodes[2].pose.translation == pytest.approx([0.002, 0.0, 0.0])
    path.write_text(path.read_text().replace('length="millimeter"', 'length="furlong"'))
    with pytest.raises(KinefabError) as caught:
        read(path)
    assert [d.code for d in caught.value.diagnostics] == ["UNIT_UNKNOWN"]


def test_a_step_file_of_a_part_has_its_own_unit(tmp_path):
    """An inch file, where the XML is in metres: the plate is two inches long."""
    pytest.importorskip("OCP", reason="OpenCASCADE is not installed: pip install cadquery-ocp-novtk")
    (tmp_path / "plate.step").write_bytes((FIXTURES / "step" / "two_plates_inch_ap242.step").read_bytes())
    part = '<Part name="Arm" uid="Arm*"><GeometryFile name="plate.step" type="STEP"/></Part>'
    scene = kinefab.export(document(tmp_path, parts=part), tmp_path / "a.kinefab").analysed.scene
    (mesh,) = scene.meshes
    np.testing.assert_allclose(np.ptp(mesh.vertices, axis=0), [0.1, 0.015, 0.0708], atol=1e-9)


def test_a_damaged_file_ends_in_findings(tmp_path):
    given, chance = XML.read_bytes(), random.Random(5)
    (tmp_path / "Base.ipt.STL").write_bytes(b"")
    for _ in range(MUTATIONS):
        (tmp_path / "a.xml").write_bytes(damaged(given, chance))
        try:
            sources.read(tmp_path / "a.xml", Report())
        except KinefabError as error:
            assert error.diagnostics


def test_every_element_may_be_missing(tmp_path):
    """Each element left out once: read, or refused in words."""
    for number in range(len(list(ET.parse(XML).iter()))):
        tree = ET.parse(XML)
        parents = {child: parent for parent in tree.iter() for child in parent}
        element = list(tree.iter())[number]
        if element not in parents:
            continue
        parents[element].remove(element)
        tree.write(tmp_path / "a.xml")
        try:
            sources.read(tmp_path / "a.xml", Report())
        except KinefabError as error:
            assert error.diagnostics
