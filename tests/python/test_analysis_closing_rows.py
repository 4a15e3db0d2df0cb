"""Which rows of a loop-closing joint were left free, and what holds them instead: told in every place, by name."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from kinefab.analysis import Closures, analyse
from kinefab.analysis.findings.summary import document
from kinefab.analysis.findings.table import table
from kinefab.model import Constraint, Feature, FeatureKind, Node, Scene
from kinefab.model import ConstraintKind as C
from kinefab.model import JointKind as K
from mechanism_cases import MINIMAL, scene
from scenes import exported

FIELDS = {"xMotion": "X Motion", "yMotion": "Y Motion", "zMotion": "Z Motion"}
FIELDS |= {f"angular{axis}Motion": f"Angular {axis} Motion" for axis in "XYZ"}
REDUCED = ["M01", "M07", "M09", "M10", "M11", "M12", "M13", "M21", "M23", "M30", "M32", "M33", "M38"]


def closing(found):
    """The joints that the loops hold in part, each with what was found of it."""
    return [(j, found.findings[j.id]) for j in found.joints if found.findings[j.id].freed]


def joints_of(content):
    return [c for o in content["gameObjects"] for c in o.get("components", ()) if c["type"].endswith("Joint")]


def by_reason(content):
    return {tuple(c["because"]): c for c in joints_of(content)}


def locked(component) -> int:
    return 5 if component["type"] == "HingeJoint" else sum(component.get(f) == "Locked" for f in FIELDS)


@pytest.mark.parametrize("id", REDUCED)
def test_freed_rows_are_what_the_whole_joint_locks_besides(id):
    """Against the export with whole closures: kind, locked freedoms and loop of each closing joint."""
    found, whole = analyse(scene(id), MINIMAL), analyse(scene(id))
    exact = {j.id: j for j in whole.joints}
    assert closing(found)
    for joint, finding in closing(found):
        before = exact[joint.id]
        changed = [i for i in range(6) if joint.freedoms[i].motion is not before.freedoms[i].motion]
        assert list(finding.freed) == changed and finding.whole_kind(joint) is before.kind
        assert finding.loop == whole.findings[joint.id].loop
    assert not closing(whole)


@pytest.mark.parametrize("id", REDUCED)
def test_a_loop_is_a_closed_way_along_other_joints(id):
    """From a to b each part is joined to the next by a joint of the tree, and no part comes twice."""
    found = analyse(scene(id), MINIMAL)
    closes = [(j, found.findings[j.id].loop) for j in found.joints if found.findings[j.id].closure]
    tree = [{j.a, j.b} for j in found.joints if not found.findings[j.id].closure]
    together = lambda n: found.groups.members[found.groups.group_of[n]]  # noqa: E731
    for joint, loop in closes:
        assert loop[0] == joint.a and loop[-1] == joint.b
        assert len(set(loop)) == len(loop) >= 3
        for one, other in zip(loop, loop[1:]):
            assert any({m, n} in tree for m in together(one) for n in together(other))
    assert all(f.loop == () for f in found.findings.values() if not f.closure)


@pytest.mark.parametrize("id", REDUCED)
def test_the_report_names_what_unity_shows_as_free(id, tmp_path):
    """For each closing joint the inspector's names of just those motions that are Free and would be Locked."""
    content, result = exported(scene(id), tmp_path, closures=Closures.MINIMAL)
    whole, _ = exported(scene(id), tmp_path)
    remarks = [e for e in content["report"] if e.get("code") == "CLOSURE_AXES_FREE"]
    assert remarks and all(e["outcome"] == "kept" for e in remarks)
    assert len(remarks) == len([d for d in result.report.diagnostics if d.code == "CLOSURE_AXES_FREE"])
    parts, before = by_reason(content), by_reason(whole)
    assert len(remarks) == len(closing(analyse(scene(id), MINIMAL)))
    for joint, finding in closing(analyse(scene(id), MINIMAL)):
        (message,) = (e["message"] for e in remarks if e["feature"] == f"joint {joint.id}")
        part, full = parts[joint.because], before[joint.because]
        named = re.findall(r"(?:Angular )?[XYZ] Motion", message.split(" of the ")[0])
        assert all(part.get(field, "Free") == "Free" for field, title in FIELDS.items() if title in named)
        assert len(named) == len(set(named)) == locked(full) - locked(part)
        assert " - ".join(scene(id).name(n) for n in finding.loop) in message


def test_the_lever_says_which_motions_of_its_gudgeon_are_free(tmp_path):
    """The bar's hinge on the slider: out of the plane nothing can move, since the crank and the slide hold the plane."""
    source = scene("M09")
    content, _ = exported(source, tmp_path, closures=Closures.MINIMAL)
    (remark,) = (e["message"] for e in content["report"] if e.get("code") == "CLOSURE_AXES_FREE")
    assert remark.startswith("X Motion, Angular Y Motion, Angular Z Motion of the ConfigurableJoint on ")
    assert "the rest of the loop barC - panelB - base - sliderD already prevents these motions" in remark
    found = analyse(source, MINIMAL)
    (said,) = (d.message for d in found.report.diagnostics if d.code == "CLOSURE_ROWS_FREED")
    assert (
        "closes the loop barC - panelB - base - sliderD; of its 5 equations 2 are exported and tx, ry, rz left free"
        in said
    )
    assert "the other joints of the loop hold them" in said
    (entry,) = (j for j in document(found)["joints"] if j["closesLoop"])
    assert (entry["kind"], entry["wholeKind"], entry["heldByLoop"]) == (
        "point_on_line",
        "revolute",
        ["tx", "ry", "rz"],
    )
    assert entry["loop"] == ["barC", "panelB", "base", "sliderD"]
    assert "revolute (closes a loop that holds tx ry rz)" in table(found)


def coaxial() -> Scene:
    """Three parts on one axis, each hinged to both others: the last hinge has nothing to add."""
    nodes = [Node("base", "base", grounded=True), Node("a", "a"), Node("b", "b")]
    axis = np.array([0.0, 0.0, 1.0])

    def insert(name: str, one: int, other: int) -> Constraint:
        circles = (
            Feature(n, FeatureKind.CIRCLE, np.array([0.1, 0.2, 0.3]), axis, radius=0.1) for n in (one, other)
        )
        return Constraint(name, C.INSERT, tuple(circles))

    return Scene(nodes=nodes, constraints=[insert("i", 0, 1), insert("j", 1, 2), insert("k", 0, 2)])


def test_a_closing_joint_that_the_loop_holds_whole_still_keeps_its_parts_from_colliding(tmp_path):
    """Unity lets no two bodies collide that a joint connects: it is there, removes nothing, and is counted as a loop."""
    found = analyse(coaxial(), MINIMAL)
    ((joint, finding),) = closing(found)
    assert (joint.kind, finding.whole_kind(joint), finding.freed) == (K.FREE, K.REVOLUTE, (0, 1, 2, 4, 5))
    content, _ = exported(coaxial(), tmp_path, closures=Closures.MINIMAL)
    (part,) = (c for c in joints_of(content) if c.get("closure"))
    assert (
        part["type"] == "ConfigurableJoint" and part["because"] == ["j"] and not part.get("enableCollision")
    )
    assert all(part.get(field, "Free") == "Free" for field in FIELDS)
    assert [(i.mobility, i.loops) for i in found.islands] == [(2, 1)]
    assert content["analysis"]["islands"][0]["loops"] == 1
    (remark,) = (e for e in content["report"] if e.get("code") == "CLOSURE_ALL_FREE")
    assert remark["outcome"] == "kept" and "Unity lets no two bodies collide" in remark["message"]


def test_a_closing_joint_to_the_ground_that_the_loop_holds_whole_has_no_component(tmp_path):
    """It keeps nothing from colliding, since only two bodies are told apart; the report says that the loop is why."""
    source = coaxial()
    source.constraints[2] = replace(
        source.constraints[2], kind=C.CONCENTRIC
    )  # looser, so the tree goes by the others
    found = analyse(source, MINIMAL)
    ((joint, finding),) = closing(found)
    assert (joint.a, joint.kind, finding.whole_kind(joint)) == (0, K.FREE, K.CYLINDRICAL)
    content, _ = exported(source, tmp_path, closures=Closures.MINIMAL)
    assert len(joints_of(content)) == 2 and [i.loops for i in found.islands] == [0]
    assert [e["outcome"] for e in content["report"] if e.get("code") == "CLOSURE_NOT_NEEDED"] == ["kept"]
