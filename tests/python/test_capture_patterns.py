"""Patterned and mirrored parts without constraints of their own: they follow what they repeat, and it is said how."""

from __future__ import annotations

import json
from copy import deepcopy
from pathlib import Path

import numpy as np
import pytest
from cad.captures import capture
from cad.described import described
from cad.fusion import Fusion
from cad.inventor import Inventor
from cad.onshape import answers as onshape
from cad.solidworks import SolidWorks
from kinefab.analysis import analyse
from kinefab.capture.comparing import compare
from kinefab.diagnostics import Report
from kinefab.model import Scene
from kinefab.sources.bundle.reader import scene_from_values

UNIT = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
LOW, HIGH = np.radians(-10.0), np.radians(80.0)
PROGRAMS = {
    "inventor": lambda a: Inventor(a).record(),
    "solidworks": lambda a: SolidWorks(a).record(),
    "onshape": onshape,
}
TYPES = {"CAPTURE_PATTERN", "CAPTURE_PATTERN_MOVES", "CAPTURE_PATTERN_FREE"}


def component(name: str, o: list[float], definition: str = "", **more) -> dict:
    pose = {"o": o, **dict(zip("xyz", UNIT))}
    found = {
        "id": f"M/{name}" if name else "M",
        "kind": "part",
        "definition": definition or name,
        "pose": pose,
    }
    return found | ({"parent": found["id"].rpartition("/")[0]} if name else {}) | more


def machine(*parts: dict, patterns: list, joints: list = (), unit: str = "mm", up: str = "Z") -> dict:
    """A grounded base and an arm on a hinge along z at its own origin, -10 to 80 degrees; ``parts`` and their patterns beside."""
    root = component("", [0.0, 0.0, 0.0], kind="assembly", flexible=True)
    base, arm = component("Base", [10.0, 20.0, 30.0], grounded=True), component("Arm", [300.0, -200.0, 50.0])
    at = {"in": "world", "o": [300.0, -200.0, 50.0], "z": UNIT[2], "x": UNIT[0]}
    dof = {"name": "rz", "value": 0.0, "min": LOW, "max": HIGH, "minEnabled": True, "maxEnabled": True}
    ends = {"type": "revolute", "a": "M/Base", "b": "M/Arm", "frameA": at, "frameB": {**at}, "dof": [dof]}
    meta = {"format": "kinefab.bundle", "version": "1.0", "units": {"length": unit, "angle": "rad"}, "up": up}
    return {
        "meta": meta, "components": [root, base, arm, *deepcopy(parts)], "joints": [{"id": "Hinge", **ends}, *joints],
        "patterns": {"M": patterns},
    }  # fmt: skip


def rigid(one: str, two: str) -> dict:
    at = {"in": "world", "o": [0.0, 0.0, 0.0], "z": UNIT[2], "x": UNIT[0]}
    return {
        "id": f"{one} {two}",
        "type": "rigid",
        "a": f"M/{one}",
        "b": f"M/{two}",
        "frameA": at,
        "frameB": {**at},
    }


def as_mates(values: dict) -> dict:
    """SolidWorks has no joints: the same as mates."""
    constraints = []
    for joint in values["joints"]:
        at = joint["frameA"]
        kind, shape = ("lock", "point") if joint["type"] == "rigid" else ("insert", "circle")
        side = {"geometry": shape, "in": "world", "p": at["o"]} | (
            {"d": at["z"], "r": 5.0} if kind == "insert" else {}
        )
        a, b = ({"component": joint[end], **side} for end in "ab")
        constraints.append(
            {"id": joint["id"], "kind": kind, "a": a, "b": b}
            | ({"sense": "aligned"} if kind == "insert" else {})
        )
    return {**values, "joints": [], "constraints": constraints}


def captured(program: str, values: dict, folder) -> tuple:
    report = Report()
    given = as_mates(values) if program == "solidworks" else values
    found = capture(program, PROGRAMS[program](described(given)), folder, values["meta"]["up"], report)
    return found, [entry.code for entry in report.diagnostics if entry.code in TYPES]


def mechanism(path: Path) -> Scene:
    data = path.read_bytes()
    return scene_from_values(json.loads(data), path, data, Report())


def together(found, *parts: str) -> bool:
    """Whether the exported mechanism has the parts in one rigid body."""
    scene = mechanism(found.path)
    analysis = analyse(scene)
    numbers = {node.id: i for i, node in enumerate(scene.nodes)}
    bodies = {analysis.assembly.body_of(numbers[part]) for part in parts}
    return len(bodies) == 1


BOLTS = [component(f"Bolt-{i}", [310.0 + 20.0 * i, -200.0, 50.0], "Bolt") for i in range(1, 4)]
ROW = ["Row", [["M/Bolt-1"], ["M/Bolt-2"], ["M/Bolt-3"]]]


@pytest.mark.parametrize("program", PROGRAMS)
@pytest.mark.parametrize(("unit", "up"), [("mm", "Z"), ("m", "Y"), ("in", "Y")])
def test_a_pattern_moves_with_its_seed(program, unit, up, tmp_path):
    """A row of bolts, the first of them fixed to an arm: without the pattern two would be free bodies."""
    values = machine(*BOLTS, patterns=[ROW], joints=[rigid("Arm", "Bolt-1")], unit=unit, up=up)
    found, codes = captured(program, values, tmp_path)
    assert together(found, "M/Arm", "M/Bolt-1", "M/Bolt-2", "M/Bolt-3")
    assert analyse(mechanism(found.path)).mobility == 1
    assert codes == [
        "CAPTURE_PATTERN_MOVES"
    ]  # the arm turns: a fixed direction of the pattern would not turn along


@pytest.mark.parametrize("program", PROGRAMS)
def test_a_pattern_of_what_stands_still_is_said_to_be_right(program, tmp_path):
    values = machine(*BOLTS, patterns=[ROW], joints=[rigid("Base", "Bolt-1")])
    found, codes = captured(program, values, tmp_path)
    assert together(found, "M/Base", "M/Bolt-2", "M/Bolt-3") and codes == ["CAPTURE_PATTERN"]
    outcome = next(o for o in found.draft.report.outcomes if o.feature.startswith("pattern"))
    assert outcome.outcome.value == "kept"


@pytest.mark.parametrize("program", PROGRAMS)
def test_a_circle_about_the_axis_of_its_motion_is_exact(program, tmp_path):
    """Three blades about the arm's own axis: what the seed does is what each copy does."""
    turned = []
    for i, angle in enumerate(np.radians([25.0, 145.0, 265.0]), start=1):
        c, s = np.cos(angle), np.sin(angle)
        blade = component(f"Blade-{i}", [300.0 + 40.0 * c, -200.0 + 40.0 * s, 70.0], "Blade")
        turned.append({**blade, "pose": {**blade["pose"], "x": [c, s, 0.0], "y": [-s, c, 0.0]}})
    pattern = ["Circle", [[f"M/Blade-{i}"] for i in (1, 2, 3)]]
    values = machine(*turned, patterns=[pattern], joints=[rigid("Arm", "Blade-1")])
    found, codes = captured(program, values, tmp_path)
    assert together(found, "M/Arm", "M/Blade-2", "M/Blade-3") and codes == ["CAPTURE_PATTERN"]


@pytest.mark.parametrize("program", PROGRAMS)
def test_two_seeds_in_one_pattern_each_have_their_own_copies(program, tmp_path):
    nuts = [component(f"Nut-{i}", [310.0 + 20.0 * i, -200.0, 80.0], "Nut") for i in range(1, 4)]
    pairs = ["Pairs", [[f"M/Bolt-{i}", f"M/Nut-{i}"] for i in (1, 2, 3)]]
    joints = [rigid("Arm", "Bolt-1"), rigid("Base", "Nut-1")]
    found, _ = captured(program, machine(*BOLTS, *nuts, patterns=[pairs], joints=joints), tmp_path)
    assert together(found, "M/Arm", "M/Bolt-3") and together(found, "M/Base", "M/Nut-3")
    assert not together(found, "M/Bolt-2", "M/Nut-2")


@pytest.mark.parametrize("program", PROGRAMS)
def test_of_two_alike_the_one_that_the_pattern_names_is_the_seed(program, tmp_path):
    """Two bolts with constraints of their own; the copies are of the second."""
    pattern = ["Row", [["M/Bolt-2"], ["M/Bolt-3"]]]
    joints = [rigid("Base", "Bolt-1"), rigid("Arm", "Bolt-2")]
    found, _ = captured(program, machine(*BOLTS, patterns=[pattern], joints=joints), tmp_path)
    assert together(found, "M/Arm", "M/Bolt-2", "M/Bolt-3") and not together(found, "M/Bolt-1", "M/Bolt-3")


@pytest.mark.parametrize("program", PROGRAMS)
def test_a_pattern_of_a_patterns_copy_leads_to_the_seed_of_that(program, tmp_path):
    """A row of the arm's bolt, its copy repeated in a column; another such bolt is on the base."""
    four = [*BOLTS, component("Bolt-4", [330.0, -150.0, 50.0], "Bolt")]
    patterns = [["Row", [["M/Bolt-2"], ["M/Bolt-3"]]], ["Column", [["M/Bolt-3"], ["M/Bolt-4"]]]]
    joints = [rigid("Base", "Bolt-1"), rigid("Arm", "Bolt-2")]
    found, codes = captured(program, machine(*four, patterns=patterns, joints=joints), tmp_path)
    assert together(found, "M/Arm", "M/Bolt-2", "M/Bolt-3", "M/Bolt-4")
    assert not together(found, "M/Arm", "M/Bolt-1") and "CAPTURE_PATTERN_FREE" not in codes


@pytest.mark.parametrize("program", PROGRAMS)
def test_a_patterned_assembly_whose_parts_move_follows_part_by_part(program, tmp_path):
    subs = []
    for i in (1, 2):
        sub = component(f"Sub-{i}", [100.0 * i, 0.0, 0.0], "Sub", kind="assembly", flexible=True)
        subs += [sub, component(f"Sub-{i}/Cap", [100.0 * i, 5.0, 7.0], "Cap")]
    joints = [rigid("Arm", "Sub-1/Cap")]
    values = machine(*subs, patterns=[["Row", [["M/Sub-1"], ["M/Sub-2"]]]], joints=joints)
    found, codes = captured(program, values, tmp_path)
    assert together(found, "M/Arm", "M/Sub-2/Cap") and codes == ["CAPTURE_PATTERN_MOVES"]


@pytest.mark.parametrize("state", ["suppressed", "independent"])
def test_elements_of_inventor_that_do_not_follow(state, tmp_path):
    values = machine(*BOLTS, patterns=[[*ROW, {2: state}]], joints=[rigid("Arm", "Bolt-1")])
    if state == "suppressed":
        values["components"][-1] = {**values["components"][-1], "suppressed": True}
    found, codes = captured("inventor", values, tmp_path)
    ends = {joint["b"] for joint in found.draft.joints if joint["name"] == "Row"}
    assert ends == {"M/Bolt-2"} and codes == ["CAPTURE_PATTERN_MOVES"]


def test_a_copy_that_no_element_lists_is_told(tmp_path):
    values = machine(*BOLTS, patterns=[ROW], joints=[rigid("Arm", "Bolt-1")])
    answers = Inventor(described(values)).record()
    elements = [entry for entry in answers if entry.get("#kind") == "inventor.PatternElement"]
    elements[2]["Occurrences"] = {"failed": "com_error: E_FAIL"}
    report = Report()
    found = capture("inventor", answers, tmp_path, "Z", report)
    codes = [entry.code for entry in report.diagnostics]
    assert "CAPTURE_MEMBER_FAILED" in codes and "CAPTURE_PATTERN_FREE" in codes
    assert not together(found, "M/Arm", "M/Bolt-3")


def test_a_mirrored_part_of_solidworks_follows_and_is_said_to(tmp_path):
    values = machine(*BOLTS[:2], patterns=[], joints=[rigid("Arm", "Bolt-1")])
    values["components"][-1]["pose"] = {**values["components"][-1]["pose"], "x": [-1.0, 0.0, 0.0]}
    found, codes = captured("solidworks", values, tmp_path)
    assert together(found, "M/Arm", "M/Bolt-2") and codes == ["CAPTURE_PATTERN_MOVES"]
    assert "mirrored" in next(c for c in found.draft.components if c["id"] == "M/Bolt-2")["extras"]


def test_of_a_mirror_onto_a_file_of_its_own_nothing_is_known(tmp_path):
    values = machine(
        component("Left-1", [1.0, 2.0, 3.0], "Left"), patterns=[["Row", [["M/Arm"], ["M/Left-1"]]]]
    )
    found, codes = captured("solidworks", values, tmp_path)
    assert codes == ["CAPTURE_PATTERN_FREE"] and not together(found, "M/Arm", "M/Left-1")


def test_copies_of_fusion_are_occurrences_and_the_free_ones_are_told(tmp_path):
    values = machine(*BOLTS, patterns=[ROW], joints=[rigid("Arm", "Bolt-1"), rigid("Arm", "Bolt-2")])
    report = Report()
    found = capture("fusion", Fusion(described(values)).record(), tmp_path, "Z", report)
    told = [entry for entry in report.diagnostics if entry.code in TYPES]
    assert [entry.code for entry in told] == ["CAPTURE_PATTERN_FREE"]
    assert "1 copies" in told[0].message and "M/Bolt-3" in told[0].message
    assert together(found, "M/Arm", "M/Bolt-2") and not together(found, "M/Arm", "M/Bolt-3")


def test_a_suppressed_pattern_of_onshape_ties_nothing(tmp_path):
    values = machine(*BOLTS, patterns=[ROW], joints=[rigid("Arm", "Bolt-1")])
    answers = onshape(described(values))
    answers["definition"]["rootAssembly"]["patterns"][0]["suppressed"] = True
    found = capture("onshape", answers, tmp_path, "Z")
    assert not together(found, "M/Arm", "M/Bolt-3")


def test_what_nobody_says_is_not_compared(tmp_path):
    found, _ = captured("onshape", machine(patterns=[]), tmp_path)
    before = len(found.draft.report.diagnostics)
    compare(found.draft)
    assert len(found.draft.report.diagnostics) == before
