"""SolidWorks' capture against its documented double."""

from __future__ import annotations

import json

import numpy as np
import pytest
from cad.captures import capture, scene, scene_differences
from cad.described import described, mechanism
from cad.gears import gear_pair
from cad.inventor import Inventor
from cad.solidworks import SolidWorks
from kinefab.diagnostics import Report
from kinefab.sources import read

SLIDERS = ("M07", "M08", "M09")


@pytest.mark.parametrize("name", ["lever/lever.bundle.json", "mechanisms/M04.bundle.json"])
def test_mates_give_the_scene_of_the_constraints(name, tmp_path):
    """SolidWorks has no joints: its scene is that of the bundle's constraints."""
    values = mechanism(name)
    values.pop("joints", None)
    values.pop("dof", None)
    found = capture("solidworks", SolidWorks(described(values)).record(), tmp_path, values["meta"]["up"])
    assert scene_differences(values, found.path, tmp_path) == []


def geared() -> dict:
    """The gear pair as constraints: two inserts, and a gear whose axes the plate carries."""
    values = gear_pair()
    values.pop("couplings")
    ends = {}
    constraints = []
    for joint in values.pop("joints"):
        at = {"geometry": "circle", "in": "world", "p": joint["frameA"]["o"], "d": [0.0, 0.0, 1.0], "r": 0.5}
        a, b = ({"component": joint[end], **at} for end in "ab")
        constraints.append({"id": joint["id"], "kind": "insert", "a": a, "b": b, "sense": "aligned"})
        ends[joint["id"]] = {**b, "geometry": "cylinder"}
    gear = {"id": "Gear", "kind": "gear", "a": ends["Hinge A"], "b": ends["Hinge B"], "value": -2.5}
    return values | {"constraints": [*constraints, gear]}


@pytest.mark.parametrize("program", ["inventor", "solidworks"])
def test_a_gear_pair_gives_the_scene_of_its_constraints(program, tmp_path):
    values = geared()
    double = Inventor if program == "inventor" else SolidWorks
    found = capture(program, double(described(values)).record(), tmp_path, values["meta"]["up"])
    assert scene_differences(values, found.path, tmp_path) == []
    assert scene(found.path)["couplings"]


def on_two_planes(values: dict) -> dict:
    """A slide as neither program has it in one: two pairs of planes along it."""
    found = []
    for c in values["constraints"]:
        if c["kind"] != "slider":
            found.append(c)
            continue
        along = np.array(c["a"]["d"]) / np.linalg.norm(c["a"]["d"])
        first = np.cross(along, np.eye(3)[np.argmin(np.abs(along))])
        first /= np.linalg.norm(first)
        for i, normal in enumerate((first, np.cross(along, first))):
            d = normal.tolist()
            sides = {k: {**c[k], "geometry": "plane", "d": d, "p": c["a"]["p"]} for k in "ab"}
            found.append({"id": f"{c['id']} {i}", "kind": "coincident", **sides, "sense": "aligned"})
    return values | {"constraints": found}


@pytest.mark.parametrize("program", ["inventor", "solidworks"])
@pytest.mark.parametrize("name", SLIDERS)
def test_slider_cranks_give_the_scenes_of_their_constraints(program, name, tmp_path):
    values = on_two_planes(mechanism(f"mechanisms/{name}.bundle.json"))
    double = Inventor if program == "inventor" else SolidWorks
    found = capture(program, double(described(values)).record(), tmp_path, values["meta"]["up"])
    assert scene_differences(values, found.path, tmp_path) == []


@pytest.mark.parametrize("answer", [[], [0.1, 0.2], [0.1, 0.2, 0.3]])
def test_a_mate_without_its_numbers_is_told_and_left_out(answer, tmp_path):
    values = mechanism("lever/lever.bundle.json")
    values.pop("joints", None)
    answers, report = SolidWorks(described(values)).record(), Report()
    whole = capture("solidworks", answers, tmp_path, values["meta"]["up"]).draft.constraints
    entity = [e for e in answers if e.get("#kind") == "solidworks.MateEntity" and e["ReferenceType"] > 0][-1]
    entity["EntityParams"] = answer
    found = capture("solidworks", answers, tmp_path, values["meta"]["up"], report)
    assert len(found.draft.constraints) == len(whole) - 1
    assert "CAPTURE_MEMBER_FAILED" in [d.code for d in report.diagnostics]


def test_what_an_assembly_cuts_from_its_parts_is_told(tmp_path):
    values = mechanism("lever/lever.bundle.json")
    values.pop("joints", None)
    values["assemblyFeatures"] = [
        ["Cut-Extrude1", "ICE", False],
        ["Hole1", "HoleSeries", True],
        ["Plane1", "RefPlane", False],
    ]
    report = Report()
    found = capture(
        "solidworks", SolidWorks(described(values)).record(), tmp_path, values["meta"]["up"], report
    )
    told = [d.message for d in report.diagnostics if d.code == "CAPTURE_ASSEMBLY_FEATURE"]
    assert len(told) == 1 and "feature Cut-Extrude1 of Lever (ICE)" in told[0]
    assert found.draft.constraints


def test_an_entity_that_is_said_to_be_the_assemblys_is_its_faces_components(tmp_path):
    """Mates onto what is deep inside may name the assembly itself; its name ends with no number of a copy."""
    values = mechanism("lever/lever.bundle.json")
    values.pop("joints", None)
    answers = SolidWorks(described(values)).record()
    sound = capture("solidworks", answers, tmp_path, values["meta"]["up"]).draft.constraints
    entity = [e for e in answers if e.get("ReferenceComponent")][-1]
    answers.append({"#kind": "solidworks.Component", "Name2": "Lever assembly"})
    answers.append({"#kind": "solidworks.Entity", "GetComponent()": entity["ReferenceComponent"]})
    entity["ReferenceComponent"] = {"object": len(answers) - 2}
    entity["Reference"] = {"object": len(answers) - 1}
    assert capture("solidworks", answers, tmp_path, values["meta"]["up"]).draft.constraints == sound
    entity["Reference"] = {"failed": "com_error: a plane"}
    found = capture("solidworks", answers, tmp_path, values["meta"]["up"]).draft.constraints
    assert [c["id"] for c in found] == [c["id"] for c in sound] and found != sound


def test_mates_of_a_folder_that_are_listed_behind_it_too_are_read_once(tmp_path):
    values = mechanism("lever/lever.bundle.json")
    values.pop("joints", None)
    answers = SolidWorks(described(values)).record()
    sound = capture("solidworks", answers, tmp_path, values["meta"]["up"]).draft.constraints
    group = next(e for e in answers if e.get("GetTypeName2()") == "MateGroup")
    first = group["GetFirstSubFeature()"]
    folder = {"#kind": "solidworks.Feature", "Name": "dof", "GetTypeName2()": "FtrFolder"}
    answers.append({**folder, "GetFirstSubFeature()": first, "GetNextSubFeature()": first})
    group["GetFirstSubFeature()"] = {"object": len(answers) - 1}
    assert capture("solidworks", answers, tmp_path, values["meta"]["up"]).draft.constraints == sound


@pytest.mark.parametrize("what, answer, told", [
    ("a part", {"GetModelDoc2()": None}, True),
    ("a flexible sub-assembly", {"Solving": 1}, True),
    ("a rigid sub-assembly", {}, False),
])  # fmt: skip
def test_what_is_lightweight_is_told(what: str, answer: dict, told: bool, tmp_path):
    """Its document is not in memory: a part's mass and the mates within a flexible sub-assembly cannot be asked for."""
    values = mechanism("lever/lever.bundle.json")
    double, report = SolidWorks(described(values)).record(), Report()
    one = next(
        held for held in double if "Name2" in held and bool(held["GetModelDoc2()"]) == (what == "a part")
    )
    one |= answer
    capture("solidworks", double, tmp_path, values["meta"]["up"], report)
    found = [d.message for d in report.diagnostics if d.code == "CAPTURE_LIGHTWEIGHT"]
    assert len(found) == told
    assert all("1 components (" in message and one["Name2"] in message for message in found)
    assert sum(o.feature == "documents of components" for o in report.outcomes) == told


@pytest.mark.parametrize(("count", "told"), [(1, None), (3, "Reclined")])
def test_one_of_several_configurations_is_named(tmp_path, count, told):
    values = mechanism("lever/lever.bundle.json")
    double = SolidWorks(described(values))
    found = capture("solidworks", double.record(GetConfigurationCount=count), tmp_path, values["meta"]["up"])
    assert json.loads(found.path.read_text("utf-8"))["meta"].get("configuration") == told
    assert read(found.path, Report()).source.configuration == (told or "")


def test_a_record_without_that_question_is_read(tmp_path):
    values = mechanism("lever/lever.bundle.json")
    asked = SolidWorks(described(values)).record()
    record = [{k: v for k, v in own.items() if not k.startswith("GetConfigurationCount")} for own in asked]
    found = capture("solidworks", record, tmp_path, values["meta"]["up"])
    assert "configuration" not in json.loads(found.path.read_text("utf-8"))["meta"]
