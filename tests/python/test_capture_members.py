"""The interfaces that captures are written against are exactly the documented members of ``cad/members.csv``; every one of them is
asked of a double, and nothing else is."""

from __future__ import annotations

import copy
import inspect
import re
from importlib import import_module

import numpy as np
import pytest
from cad.captures import Program, call, capture
from cad.described import described, mechanism
from cad.documented import KIND, TOUCHED, Answers, Refused, members
from cad.fusion import Fusion
from cad.gltf import exported
from cad.inventor import Inventor
from cad.onshape import answers, boxes, masses, of_each_part
from cad.solidworks import SolidWorks
from cad.tetrahedron import FACES, POINTS, fusion_bodies, inventor_bodies, solidworks_bodies
from kinefab.capture.channel import Live
from test_capture_fusion import every_motion
from test_capture_fusion_tree import nested as inside
from test_capture_fusion_tree import only_own
from test_capture_kinds import BOTH, SOLIDWORKS, machine, pair, side
from test_capture_matter import machine as block
from test_capture_onshape import nested, only_joints
from test_capture_patterns import BOLTS, as_mates, rigid
from test_capture_patterns import machine as patterned
from test_capture_rigid_bodies import GROUPS, JOINTS

PROGRAMS = ("inventor", "solidworks", "fusion")
MEMBER = re.compile(r"    (?:def )?(\w+)(\(|:).*?  # (.*?) \| (.*?) \| (.+)")


def declared(program: str) -> dict[tuple[str, str], dict[str, str]]:
    """The members of a program's interface file, with what stands behind each."""
    found, kind = {}, ""
    for line in inspect.getsource(import_module(f"kinefab.capture.{program}.api")).splitlines():
        if opened := re.match(r"class (\w+)\(Protocol\)", line):
            kind = opened[1]
        elif match := MEMBER.fullmatch(line):
            name, bracket, unit, frame, page = match.groups()
            word = "method" if bracket == "(" else "property"
            found[kind, name] = {"kind": word, "unit": unit, "frame": frame, "page": page}
        elif kind and re.match(r"    (?:def )?\w+[(:]", line):
            raise AssertionError(f"without its unit, frame and page: {line}")
    return found


@pytest.mark.parametrize("program", PROGRAMS)
def test_the_interface_is_the_documented_list(program):
    stated = {
        key: {word: row[word] for word in ("kind", "unit", "frame", "page")}
        for key, row in members(program).items()
    }
    assert declared(program) == stated


@pytest.mark.parametrize("program", PROGRAMS)
def test_a_name_is_a_method_in_all_classes_or_in_none(program):
    """The way to the program tells calls from reads by the name alone."""
    kinds: dict[str, set[str]] = {}
    for (_, name), row in members(program).items():
        kinds.setdefault(name, set()).add(row["kind"])
    assert [name for name, found in kinds.items() if len(found) > 1] == []


NOT_ASKED: dict[tuple[str, str, str], str] = {
    ("onshape", "Element", "id"): "asked of the answer as it comes in, before it is kept",
}
"""Members of the table that no case asks for, each with why not."""


def cases(program: str) -> list:
    """Records that together hold everything that a capture of the program can meet."""
    row = ["Row", [["M/Bolt-2"], ["M/Bolt-3"]]]
    rows = patterned(*BOLTS, patterns=[row], joints=[rigid("Base", "Bolt-1"), rigid("Arm", "Bolt-2")])
    if program == "inventor":
        lever = mechanism("lever/lever.bundle.json") | {"rigidBodies": {"groups": GROUPS, "joints": JOINTS}}
        reference = {**BOTH["angle"], "c": side("Base", "line"), "solution": 78595}
        spheres = pair("coincident", side("Base", "sphere", r=0.02), side("Sub/Arm", "sphere", r=0.02))
        flush = {**BOTH["distance in a range"], "inventor": "flush"}
        kinds = machine(*BOTH.values(), flush, reference, spheres)
        kinds["joints"] = [{**rigid("Base", "Sub/Arm"), "type": "ball"}]  # on a work point
        return [
            Inventor(described(lever)).record(states=2), Inventor(described(lever), order="columns").record(),
            Inventor(described(kinds)).record(), Inventor(described(rows)).record(),
            Inventor(described(block("mm", "Z")), facets=inventor_bodies).record(),
        ]  # fmt: skip
    if program == "onshape":
        return onshape_cases()
    if program == "solidworks":
        ranges = [{**BOTH["angle"], "min": -0.1, "max": 0.9}, BOTH["distance in a range"]]
        hinge = {**BOTH["insert, aligned"], "min": -0.2, "max": 1.4}
        hinge["across"] = {"a": np.array([1.0, 0.0, 0.0]), "b": np.array([0.0, 1.0, 0.0])}
        held = pair("parallel", side("Base", "line"), {**side("Base", "line"), "component": "ground"})
        kinds = machine(*BOTH.values(), *SOLIDWORKS.values(), *ranges, hinge, held)
        return [
            SolidWorks(described(kinds)).record(), SolidWorks(described(as_mates(rows))).record(GetConfigurationCount=2),
            SolidWorks(described(block("mm", "Z")), solidworks_bodies).record(),
        ]  # fmt: skip
    rows["assemblyConstraints"] = [["Constraint1", "M/Arm", "M/Base"]]
    bodies = Fusion(described(block("mm", "Z")), bodies=fusion_bodies).record()
    odd = copy.deepcopy(bodies)
    for entry in odd:
        if 'itemById("opaque_albedo")' in entry:
            entry['itemById("odd_color")'] = entry.pop('itemById("opaque_albedo")')
    grouped = Fusion(described(rows)).record(groups=(("Group", ["M/Arm", "M/Bolt-1"]),), configurations=2)
    nested = Fusion(described(inside("mm", "Z")), bodies=only_own).record()
    return [grouped, *every_motion(), bodies, odd, nested]


def onshape_cases() -> list:
    """Mates of every type with limits, relations of both sizes, a group, a pattern, a part with all that is said of it."""
    row = ["Row", [["M/Bolt-2"], ["M/Bolt-3"]]]
    rows = patterned(*BOLTS, patterns=[row], joints=[rigid("Base", "Bolt-1")])
    rows["groups"] = [["Group", ["M/Arm", "M/Bolt-2"]]]
    described_block = described(block("mm", "Z"))
    drawn = exported(POINTS, FACES, [{"baseColorFactor": [0.5, 0.5, 0.5, 1.0]}] * 4)
    matter = answers(described_block) | masses(described_block) | boxes(described_block, POINTS)
    matter |= of_each_part(described_block, "gltf", drawn)
    mates = only_joints("gears")
    hinge = mates["joints"][0]
    for word, names in (
        ("cylindrical", ("tz", "rz")),
        ("pin_slot", ("tx", "rz")),
        ("planar", ("tx", "ty", "rz")),
    ):
        dofs = [{"name": name, "value": 0.1, "min": -0.2, "minEnabled": True} for name in names]
        frames = {key: dict(hinge[key]) for key in ("frameA", "frameB")}
        mates["joints"].append({**hinge, **frames, "id": word, "name": word, "type": word, "dof": dofs})
    screw = {"id": "Screw", "kind": "screw", "a": {"joint": "cylindrical", "dof": "rz"}, "ratio": 0.003}
    mates["couplings"].append({**screw, "b": {"joint": "cylindrical", "dof": "tz"}})
    lever = only_joints("lever/lever.bundle.json")
    return [
        matter,
        nested(answers(described(mates))),
        *(answers(described(values)) for values in (rows, mates, lever)),
    ]


@pytest.mark.parametrize("program", (*PROGRAMS, "onshape"))
def test_every_documented_member_is_asked_for(program, tmp_path):
    TOUCHED.clear()
    for record in cases(program):
        capture(program, record, tmp_path, "Z")
    asked = {(kind, name) for of, kind, name in TOUCHED if of == program}
    excused = {(kind, name) for of, kind, name in NOT_ASKED if of == program}
    assert members(program).keys() - asked == excused


def test_a_double_refuses_what_its_table_does_not_list(tmp_path):
    """Whoever asks, and by which road: no capture can catch it and go on."""
    answers = Answers("inventor")
    answers.application("Application", ActiveDocument=answers.made("Document", DisplayName="X"))
    live = Live(Program(answers.objects), frozenset(), call)
    with pytest.raises(Refused, match=r"Document\.Caption"):
        _ = live.root.ActiveDocument.Caption
    with pytest.raises(KeyError):
        answers.made("Document", Caption="X")
    record = Inventor(described(mechanism("lever/lever.bundle.json"))).record()
    next(entry for entry in record if entry.get("Name") == "BarC:1")[KIND] = "inventor.Parameter"
    with pytest.raises(Refused, match=r"Parameter\.\w+"):
        capture("inventor", record, tmp_path, "Z")


def test_a_field_of_onshape_that_the_table_does_not_list_is_refused(tmp_path):
    found = answers(described(only_joints("gears")))
    first = found["definition"]["rootAssembly"]["occurrences"][0]
    first[KIND] = "onshape.Color"
    with pytest.raises(Refused, match=r"Color\.path"):
        capture("onshape", found, tmp_path, "Z")
