"""Components of Fusion that have bodies and children at once, what is fixed to its parent, patterns below the root."""

from __future__ import annotations

import json

import numpy as np
import pytest
from cad.captures import capture, scene_differences
from cad.described import depth_first, described
from cad.fusion import Fusion
from cad.tetrahedron import FACES, POINTS, fusion_bodies
from kinefab.analysis import analyse
from kinefab.capture.draft import BodyMesh
from kinefab.capture.masses import mesh_tensor, together
from kinefab.diagnostics import Report
from test_capture_patterns import HIGH, LOW, TYPES, UNIT, component, machine, mechanism, rigid
from test_capture_patterns import together as one_body

OWN = "own bodies"
METRES = {"mm": 0.001, "m": 1.0, "in": 0.0254}


def weighed(unit: str, kg: float) -> dict:
    size = METRES[unit]
    center, inertia = (
        np.array([0.006, 0.003, 0.011]) / size,
        np.array([31e-4, 52e-4, 60e-4, 4e-4, 7e-4, -2e-4]),
    )
    return {"in": "part", "mass": kg, "center": center.tolist(), "inertia": (inertia * kg / size**2).tolist()}


def hinge(name: str, one: str, two: str, o: list[float]) -> dict:
    at = {"in": "world", "o": o, "z": UNIT[1], "x": UNIT[2]}
    dof = {"name": "rz", "value": 0.0, "min": LOW, "max": HIGH, "minEnabled": True, "maxEnabled": True}
    ends = {"type": "revolute", "a": one, "b": two, "frameA": at, "frameB": {**at}, "dof": [dof]}
    return {"id": name, "name": name, **ends}


def nested(unit: str, up: str) -> dict:
    """A lid on a box that is a component with bodies and children, on a hinge; the root has bodies too."""
    here = [70.0, -30.0, 20.0]
    box = component("Box:1", here, "Box", kind="assembly", flexible=True)
    own = component(f"Box:1/{OWN}", here, f"Box ({OWN})", mass=weighed(unit, 2.5)) | {"name": "Box"}
    lid = component("Box:1/Lid:1", [75.0, -30.0, 60.0], "Lid", mass=weighed(unit, 0.5))
    floor = component(OWN, [0.0, 0.0, 0.0], f"M ({OWN})", grounded=True, mass=weighed(unit, 7.0)) | {
        "name": "M"
    }
    joints = [
        hinge("Door", "M/Base", own["id"], [70.0, 5.0, 20.0]), hinge("Lift", own["id"], lid["id"], [75.0, 6.0, 60.0])
    ]  # fmt: skip
    values = machine(box, own, lid, floor, patterns=[], joints=joints, unit=unit, up=up)
    for joint in values["joints"]:
        joint["name"] = joint["id"]
    values["components"] = depth_first(values["components"])
    names = [c["id"] for c in values["components"]]
    floor = values["components"].pop(names.index(f"M/{OWN}"))
    values["components"].insert(1, floor)
    return values


def only_own(double: Fusion, part) -> list:
    return fusion_bodies(double, part) if part.name in ("Box", "M") else []


def without_meshes(path):
    values = json.loads(path.read_text("utf-8"))
    values.pop("materials", None)
    values["meta"].pop("mesh", None)
    for c in values["components"]:
        c.pop("bodies", None)
        c.pop("file", None)
    made = path.with_name("plain.bundle.json")
    made.write_text(json.dumps(values), "utf-8")
    return made


@pytest.mark.parametrize(("unit", "up"), [("mm", "Z"), ("m", "Y"), ("in", "Z")])
def test_bodies_beside_children_are_a_part_that_joints_act_on(unit, up, tmp_path):
    values, report = nested(unit, up), Report()
    found = capture("fusion", Fusion(described(values), bodies=only_own).record(), tmp_path, up, report)
    assert scene_differences(values, without_meshes(found.path), tmp_path) == []
    assert report.diagnostics == []
    assert analyse(mechanism(found.path)).mobility == 3  # the arm, the box, its lid
    files = {c["id"]: c.get("file") for c in json.loads(found.path.read_text("utf-8"))["components"]}
    assert {name for name, file in files.items() if file} == {f"M/{OWN}", f"M/Box:1/{OWN}"}
    assert all((tmp_path / file).exists() for file in files.values() if file)


def test_a_pinned_occurrence_holds_its_bodies(tmp_path):
    values = nested("mm", "Z")
    values["components"] = [
        {**c, "grounded": True} if c["id"] == "M/Box:1" else c for c in values["components"]
    ]
    values["joints"] = [joint for joint in values["joints"] if joint["id"] != "Door"]
    found = capture("fusion", Fusion(described(values), bodies=only_own).record(), tmp_path, "Z")
    assert one_body(found, "M/Base", f"M/Box:1/{OWN}") and analyse(mechanism(found.path)).mobility == 2


def test_bodies_that_cannot_be_read_are_told(tmp_path):
    answers, report = Fusion(described(nested("mm", "Z")), bodies=only_own).record(), Report()
    box = next(e for e in answers if e.get("#kind") == "fusion.Component" and e["name"] == "Box")
    box["bRepBodies"] = {"failed": "RuntimeError: 2"}
    found = capture("fusion", answers, tmp_path, "Z", report)
    told = [d.message for d in report.diagnostics if d.code == "CAPTURE_MEMBER_FAILED"]
    assert any("bodies of M/Box:1" in message for message in told)
    assert "M/Box:1/Lid:1" in {c["id"] for c in found.draft.components}


def test_what_is_fixed_to_its_parent_moves_with_it(tmp_path):
    """Below a component with bodies, below one without, below the root."""
    crate = component("Crate:1", [5.0, 6.0, 7.0], "Crate", kind="assembly", flexible=True)
    inside = [component(f"Crate:1/Slat:{i}", [5.0, 6.0, 7.0 * i], "Slat") for i in (1, 2, 3)]
    values = nested("mm", "Z")
    values["components"] += [crate, *inside, component("Post:1", [1.0, 2.0, 3.0], "Post")]
    values["joints"].append(hinge("Tilt", "M/Base", "M/Crate:1/Slat:3", [5.0, 6.0, 7.0]))
    held = ["M/Box:1/Lid:1", "M/Crate:1/Slat:1", "M/Crate:1/Slat:3", "M/Post:1"]
    values["joints"] = [joint for joint in values["joints"] if joint["id"] != "Lift"]
    values["groundToParent"] = held
    found = capture("fusion", Fusion(described(values), bodies=only_own).record(), tmp_path, "Z")
    assert one_body(found, f"M/Box:1/{OWN}", "M/Box:1/Lid:1")
    assert one_body(found, "M/Crate:1/Slat:1", "M/Crate:1/Slat:3") and one_body(found, "M/Base", "M/Post:1")
    assert not one_body(found, "M/Crate:1/Slat:1", "M/Crate:1/Slat:2")
    assert analyse(mechanism(found.path)).mobility == 3 + 6  # arm, box, crate; a slat that nothing holds


def test_a_joint_of_one_body_with_itself_is_told(tmp_path):
    """Of a component without bodies a child that is fixed to it stands for it; Fusion may have a joint between the two."""
    values = nested("mm", "Z")
    values["groundToParent"] = ["M/Box:1/Lid:1"]
    report, groups = Report(), (("Group", ["M/Box:1", "M/Box:1/Lid:1", "M/Arm"]),)
    found = capture("fusion", Fusion(described(values)).record(groups=groups), tmp_path, "Z", report)
    assert [d.message for d in report.diagnostics if "joint Lift was left out" in d.message]
    assert one_body(found, "M/Arm", "M/Box:1/Lid:1")


def test_an_older_fusion_knows_no_fixing_to_the_parent(tmp_path):
    answers = Fusion(described(nested("mm", "Z")), bodies=only_own).record()
    for entry in answers:
        if entry.get("#kind") == "fusion.Occurrence" and "isGroundToParent" in entry:
            del entry["isGroundToParent"]
    report = Report()
    capture("fusion", answers, tmp_path, "Z", report)
    assert report.diagnostics == []


def test_patterns_inside_of_components_are_looked_at(tmp_path):
    """Each component once, its copies in every occurrence of it."""
    boxes, bolts = [], []
    for n in (1, 2):
        boxes.append(component(f"Box:{n}", [100.0 * n, 0.0, 0.0], "Box", kind="assembly", flexible=True))
        bolts += [component(f"Box:{n}/Bolt:{i}", [100.0 * n, 9.0 * i, 0.0], "Bolt") for i in (1, 2, 3)]
    values = machine(*boxes, *bolts, patterns=[], joints=[rigid("Arm", f"Box:1/Bolt:{i}") for i in (1, 2)])
    values["components"] = depth_first(values["components"])
    for n in (1, 2):
        values["patterns"][f"M/Box:{n}"] = [["Row", [[f"M/Box:{n}/Bolt:{i}"] for i in (1, 2, 3)]]]
    report = Report()
    capture("fusion", Fusion(described(values)).record(), tmp_path, "Z", report)
    (told,) = [d for d in report.diagnostics if d.code in TYPES]
    assert (
        told.code == "CAPTURE_PATTERN_FREE" and "4 copies" in told.message
    )  # Bolt:3 in the first, all in the second


def test_bodies_weighed_apart_are_one_mass():
    """Two solids of different density: as the sum of the integrals over both."""
    corners = [i for face in FACES for i in face]
    one = BodyMesh("A", (POINTS + [0.1, -0.2, 0.3]).ravel().tolist(), corners)
    two = BodyMesh("B", (POINTS @ np.diag([2.0, 1.0, 0.5]) - [0.4, 0.1, 0.0]).ravel().tolist(), corners)
    given, about = [], np.zeros((3, 3))
    for mesh, mass in ((one, 2.0), (two, 0.7)):
        center = np.reshape(mesh.points, (-1, 3)).mean(axis=0)
        tensor = mesh_tensor([mesh], mass)
        assert tensor is not None
        given.append({"mass": mass, "center": center.tolist(), "inertia": tensor, "extras": {"reading": "r"}})
        xx, yy, zz, xy, yz, xz = tensor
        about += [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
        about += mass * (center @ center * np.eye(3) - np.outer(center, center))
    found = together(given)
    center = np.array(found["center"])
    expected = about - 2.7 * (center @ center * np.eye(3) - np.outer(center, center))
    xx, yy, zz, xy, yz, xz = found["inertia"]
    assert np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) == pytest.approx(expected, abs=1e-12)
    assert found["mass"] == pytest.approx(2.7)
    assert center == pytest.approx(sum(g["mass"] * np.array(g["center"]) for g in given) / 2.7)
