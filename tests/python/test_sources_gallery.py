"""Assemblies of the Fusion 360 Gallery: the lever is the bundle's lever, axes are read as they fit, damage ends in findings."""

from __future__ import annotations

import copy
import json
import math
import os
import random
import shutil
import sys

import kinefab
import numpy as np
import pytest
from kinefab import sources
from kinefab.diagnostics import KinefabError, Report
from kinefab.model import RX, JointKind, Motion
from kinefab.sources.gallery.reader import sniff
from same_scene import compare, exported, undrawn, value_paths
from source_bundles import FIXTURES, coordinates
from test_sources_freecad_bad_input import damaged

LEVER = FIXTURES / "lever"
ASSEMBLY = LEVER / "gallery" / "assembly.json"
MUTATIONS = int(os.environ.get("KINEFAB_GALLERY_MUTATIONS", "60"))
sys.path.insert(0, str(LEVER))

from onshape_form import as_mates  # noqa: E402

STILL = {
    "origin": (0, 0, 0),
    "x_axis": (1, 0, 0),
    "y_axis": (0, 1, 0),
    "z_axis": (0, 0, 1),
}
TURNED = {
    "origin": (2, 0, 0),
    "x_axis": (0, 1, 0),
    "y_axis": (-1, 0, 0),
    "z_axis": (0, 0, 1),
}
DENSITIES = {"Cast iron": 7200.0, "Steel": 7850.0, "Brass": 8500.0, "Rubber": 1200.0}


def read(values: dict, folder):
    (folder / "assembly.json").write_text(json.dumps(values), "utf-8")
    report = Report()
    return sources.read(folder / "assembly.json", report), [d.code for d in report.diagnostics]


def xyz(values) -> dict:
    return dict(zip("xyz", map(float, values)))


def geometry(origin, z, x, occurrence=None, box=None) -> dict:
    """A joint geometry; y is what is left."""
    entity = {"occurrence": occurrence} if occurrence else {}
    if box:
        entity["bounding_box"] = {"min_point": xyz(box[0]), "max_point": xyz(box[1])}
    axes = {"primary": z, "secondary": x, "tertiary": np.cross(z, x)}
    return {
        "origin": xyz(origin),
        **{f"{word}_axis_vector": xyz(axis) for word, axis in axes.items()},
        "entity_one": entity,
    }


def assembly(**more) -> dict:
    """A grounded base at the root and an arm at (2, 0, 0) cm, turned by 90 degrees about Z."""

    def occurrence(name, transform, **flags):
        placed = {key: xyz(value) for key, value in transform.items()}
        return {
            "name": name,
            "component": name,
            "transform": placed,
            "bodies": {},
            **flags,
        }

    return {
        "tree": {"root": {"base": {}, "arm": {}}},
        "root": {"component": "r", "bodies": {}},
        "occurrences": {
            "base": occurrence("Base:1", STILL, is_grounded=True),
            "arm": occurrence("Arm:1", TURNED),
        },
        "components": {"r": {"name": "Two"}},
        "bodies": {},
        "joints": {},
        "as_built_joints": {},
        **more,
    }


def joint(one: dict, two: dict, kind="RevoluteJointType", motion=None, **more) -> dict:
    axes = {
        "rotation_axis": "ZAxisJointDirection",
        "slide_direction": "ZAxisJointDirection",
    }
    return {
        "name": "Hinge",
        "occurrence_one": "arm",
        "occurrence_two": "base",
        "joint_motion": {"joint_type": kind, **axes, **(motion or {})},
        "geometry_or_origin_one": one,
        "geometry_or_origin_two": two,
        **more,
    }


def limits(low: float | None, high: float | None) -> dict:
    found = {}
    for end, value in (("minimum", low), ("maximum", high)):
        found[f"{end}_value"] = 9.0 if value is None else value
        found[f"is_{end}_value_enabled"] = value is not None
    return found


def test_the_lever_is_the_bundles_lever(tmp_path):
    """Everything of the scene but the looks, against the bundle of the same joints and bodies."""
    values = as_mates(json.loads((LEVER / "lever.bundle.json").read_text("utf-8")))
    values.pop("materials")
    for record in values["joints"]:
        for dof in record.get("dof", []):
            dof.pop("value")
    for component in values["components"]:
        for body in component.get("bodies", []):
            body["density"] = DENSITIES[body.pop("material")]
    shutil.copy(LEVER / "lever.obj", tmp_path / "lever.obj")
    (tmp_path / "lever.mtl").write_text("")
    bundle = tmp_path / "lever.bundle.json"
    bundle.write_text(json.dumps(values), "utf-8")
    expected, found = (undrawn(exported(path, tmp_path)) for path in (bundle, ASSEMBLY))
    assert sum("Joint" in key for key in expected) == 4
    assert any("limited" in str(value).lower() for value in expected.values())  # the slide's range
    compare(expected, found, "lever", 2e-6)


def test_bodies_have_the_shapes_of_the_bundle(tmp_path):
    def boxes(path):
        scene = kinefab.export(path, tmp_path / f"{path.stem}.kinefab").analysed.scene
        found = {}
        for node in scene.nodes:
            for body in node.bodies:
                points = node.pose.point(scene.meshes[body.mesh].vertices)
                found[node.id, body.name] = [*points.min(axis=0), *points.max(axis=0)]
        return found

    expected, found = boxes(LEVER / "lever.bundle.json"), boxes(ASSEMBLY)
    assert expected.keys() == found.keys() and len(found) == 10
    for key, box in expected.items():
        np.testing.assert_allclose(found[key], box, atol=2e-8, err_msg=str(key))


@pytest.mark.parametrize("local", [True, False])
def test_axes_are_read_in_the_frame_in_which_they_fit(tmp_path, local):
    """The hinge's axis is the world's Y: the arm says X of its own, or Y of the root."""
    one = geometry((2, 0, 0), (1, 0, 0) if local else (0, 1, 0), (0, 0, 1), "arm")
    two = geometry((2, 0, 0), (0, 1, 0), (0, 0, 1), "base")
    found, codes = read(assembly(joints={"j": joint(one, two)}), tmp_path)
    (hinge,) = found.joints
    assert codes == [] and hinge.kind is JointKind.REVOLUTE
    a, b = found.pose(hinge.a) @ hinge.frame_a, found.pose(hinge.b) @ hinge.frame_b
    np.testing.assert_allclose(a.rotation[:, 0], [0.0, 0.0, -1.0], atol=1e-12)  # Z up: y becomes -z
    np.testing.assert_allclose(a.rotation, b.rotation, atol=1e-12)
    np.testing.assert_allclose(a.translation, [0.02, 0.0, 0.0], atol=1e-12)


@pytest.mark.parametrize("flipped", [False, True])
def test_the_angle_is_the_coordinates_zero(tmp_path, flipped):
    """About the second side's axis from its x to the first side's: what is turned by more than the angle has moved."""
    z = (0, 0, -1) if flipped else (0, 0, 1)
    one = geometry((2, 0, 0), z, (1, 0, 0), "arm")  # in the root: x along y, 90 degrees from the base's x
    two = geometry((2, 0, 0), (0, 0, 1), (1, 0, 0), "base")
    more = {"is_flipped": flipped, "angle": {"value": math.radians(60)}}
    record = joint(one, two, motion={"rotation_limits": limits(-0.5, None)}, **more)
    found, codes = read(assembly(joints={"j": record}), tmp_path)
    (hinge,) = found.joints
    assert codes == [] and coordinates(found, hinge)[1] == pytest.approx(math.radians(30))
    freedom = hinge.freedoms[RX]
    assert (freedom.motion, freedom.lower, freedom.upper) == (
        Motion.LIMITED,
        -0.5,
        math.inf,
    )


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_an_offset_is_taken_the_way_it_closes(tmp_path, sign):
    one = geometry((2, 0, 3 * sign), (0, 0, 1), (1, 0, 0), "arm")
    two = geometry((2, 0, 0), (0, 0, 1), (1, 0, 0), "base")
    found, _ = read(assembly(joints={"j": joint(one, two, offset={"value": 3.0})}), tmp_path)
    np.testing.assert_allclose(coordinates(found, found.joints[0])[0], 0.0, atol=1e-12)


def test_a_joint_to_the_root_is_one_to_the_ground_and_counts_the_other_way(tmp_path):
    arm = geometry((2, 0, 0), (0, 0, 1), (1, 0, 0), "arm")
    root = geometry((2, 0, 0), (0, 0, 1), (0, 1, 0))
    record = joint(root, arm, motion={"rotation_limits": limits(-0.5, 2.0)})
    record["occurrence_one"], record["occurrence_two"] = None, "arm"
    found, codes = read(assembly(joints={"j": record}), tmp_path)
    (hinge,) = found.joints
    assert codes == [] and (hinge.a, hinge.b) == (None, 2)
    assert (hinge.freedoms[RX].lower, hinge.freedoms[RX].upper) == (-2.0, 0.5)


@pytest.mark.parametrize("local", [True, False])
def test_an_as_built_joint_has_its_axis_across_its_flat_entity(tmp_path, local):
    """The entity's box is flat along the root's Y: that is the axis, whichever frame it is written in."""
    axis = (1, 0, 0) if local else (0, 1, 0)
    shape = geometry((2, 0, 0), axis, (0, 0, 1), "arm", ((1, 0, -1), (3, 0, 1)))
    record = {k: v for k, v in joint({}, {}).items() if not k.startswith("geometry")}
    found, codes = read(assembly(as_built_joints={"j": record | {"joint_geometry": shape}}), tmp_path)
    (hinge,) = found.joints
    frame = found.pose(hinge.a) @ hinge.frame_a
    assert codes == []
    np.testing.assert_allclose(np.abs(frame.rotation[:, 0]), [0.0, 0.0, 1.0], atol=1e-12)


@pytest.mark.parametrize(
    "word, axes, kind, axis",
    [
        ("Slider", {"slide_direction": "X"}, JointKind.PRISMATIC, [1, 0, 0]),
        ("Cylindrical", {"rotation_axis": "Y"}, JointKind.CYLINDRICAL, [0, 0, -1]),
        ("Planar", {"normal_direction": "Z"}, JointKind.PLANAR, [0, 1, 0]),
        ("Ball", {}, JointKind.SPHERICAL, [0, 1, 0]),
        (
            "PinSlot",
            {"rotation_axis": "Z", "slide_direction": "X"},
            JointKind.PIN_SLOT,
            [0, 1, 0],
        ),
    ],
)
def test_motions_along_other_axes(tmp_path, word, axes, kind, axis):
    one = geometry((2, 0, 0), (0, 0, 1), (0, -1, 0), "arm")
    two = geometry((2, 0, 0), (0, 0, 1), (1, 0, 0), "base")
    motion = {key: f"{value}AxisJointDirection" for key, value in axes.items()}
    found, codes = read(assembly(joints={"j": joint(one, two, f"{word}JointType", motion)}), tmp_path)
    (made,) = found.joints
    assert codes == [] and made.kind is kind
    np.testing.assert_allclose((found.pose(made.a) @ made.frame_a).rotation[:, 0], axis, atol=1e-12)


def test_what_cannot_be_kept_is_told_by_name(tmp_path):
    good = geometry((2, 0, 0), (0, 0, 1), (0, -1, 0), "arm")
    two = geometry((2, 0, 0), (0, 0, 1), (1, 0, 0), "base")
    joints = {
        "custom": joint(good, two, motion={"rotation_axis": "CustomJointDirection"}),
        "lost": joint(good, two) | {"occurrence_one": "gone"},
        "type": joint(good, two, "InferredJointType"),
        "number": joint(good | {"origin": {"x": "one"}}, two),
    }
    found, codes = read(assembly(joints=joints, contacts=[{}, {}]), tmp_path)
    assert found.joints == [] and codes == ["GALLERY_LEFT_OUT"] * 5


NAMED = {
    "lever.bundle.json": "CAD bundle",
    "gallery/assembly.json": "Fusion 360 Gallery assembly",
    "onshape/definition.json": "Onshape's saved answers",
}


@pytest.mark.parametrize("path", NAMED)
def test_formats_of_one_ending_are_told_apart_by_their_content(tmp_path, path):
    """Under any name, and with the keys in another order."""
    shutil.copy(LEVER / path, tmp_path / "any.json")
    assert sources.format_of(tmp_path / "any.json").name == NAMED[path]
    values = json.loads((tmp_path / "any.json").read_text("utf-8"))
    (tmp_path / "any.json").write_text(json.dumps(dict(sorted(values.items()))), "utf-8")
    assert sources.format_of(tmp_path / "any.json").name == NAMED[path]


def test_what_is_no_assembly_is_not_taken_for_one():
    for answer in ("features", "matevalues", "name"):
        assert sources.format_of(LEVER / "onshape" / f"{answer}.json") is None
    assert not sniff(b'{"meta": {"a": "{", "tree": {}}, "components": [')
    assert not sniff(b"")


def test_bodies_of_the_root_and_of_assemblies_are_parts_of_their_own(tmp_path):
    """The root's stand still; an assembly's own are what its joints are on."""
    values = assembly()
    values["tree"]["root"] = {"base": {}, "arm": {"hand": {}}}
    values["occurrences"]["hand"] = copy.deepcopy(values["occurrences"]["arm"]) | {"name": "Hand:1"}
    values["bodies"] = {"b": {"name": "Body1", "obj": "b.obj"}}
    values["root"]["bodies"] = {"b": {"is_visible": True}}
    values["occurrences"]["arm"]["bodies"] = {"b": {"is_visible": False}}
    (tmp_path / "b.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
    )
    one = geometry((2, 0, 0), (0, 0, 1), (0, -1, 0), "arm")
    values["joints"] = {"j": joint(one, geometry((2, 0, 0), (0, 0, 1), (1, 0, 0), "base"))}
    found, codes = read(values, tmp_path)
    assert codes == []
    held = {n.id: (n.grounded, [body.visible for body in n.bodies]) for n in found.nodes if n.bodies}
    assert held == {"Two/Bodies": (True, [True]), "Two/Arm:1/Bodies": (False, [False])}
    assert found.name(found.joints[0].b) == "Two/Arm:1/Bodies"
    hand = next(node for node in found.nodes if node.name == "Hand:1")
    np.testing.assert_allclose(hand.pose.translation, [0.02, 0.0, -0.02], atol=1e-12)  # x once, then along y


def test_a_tree_that_names_an_occurrence_twice_is_cut(tmp_path):
    values = assembly()
    values["tree"]["root"] = {"arm": {"base": {"arm": {}}}, "gone": {}}
    found, codes = read(values, tmp_path)
    assert codes == ["GALLERY_LEFT_OUT"] * 2 and len(found.nodes) == 3


@pytest.mark.parametrize("file", ["../far.obj", "/etc/passwd", "..\\far.obj", "link.obj"])
def test_files_outside_of_the_folder_are_not_opened(tmp_path, file):
    inside = tmp_path / "inside"
    inside.mkdir()
    (tmp_path / "far.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    (inside / "link.obj").symlink_to(tmp_path / "far.obj")
    values = assembly(bodies={"b": {"name": "Body1", "obj": file}})
    values["occurrences"]["arm"]["bodies"] = {"b": {}}
    found, codes = read(values, inside)
    assert codes == ["GALLERY_LEFT_OUT"] and all(not node.bodies for node in found.nodes)


def test_a_damaged_file_ends_in_findings(tmp_path):
    given, chance = ASSEMBLY.read_bytes(), random.Random(6)
    for path in ASSEMBLY.parent.glob("*.obj"):
        shutil.copy(path, tmp_path / path.name)
    for _ in range(MUTATIONS):
        (tmp_path / "assembly.json").write_bytes(damaged(given, chance))
        try:
            sources.read(tmp_path / "assembly.json", Report())
        except KinefabError as error:
            assert error.diagnostics


def test_every_value_may_be_something_else(tmp_path):
    """Values replaced by another type: read, or refused in words."""
    given, chance = json.loads(ASSEMBLY.read_text("utf-8")), random.Random(7)
    places = [place for place in value_paths(given) if chance.random() < 0.12]
    assert len(places) > 100
    for place in places:
        values = copy.deepcopy(given)
        holder = values
        for key in place[:-1]:
            holder = holder[key]
        holder[place[-1]] = chance.choice([None, [], {}, "x", -1, 1e300, True, [1, 2, 3]])
        (tmp_path / "assembly.json").write_text(json.dumps(values), "utf-8")
        try:
            sources.read(tmp_path / "assembly.json", Report())
        except KinefabError as error:
            assert error.diagnostics
