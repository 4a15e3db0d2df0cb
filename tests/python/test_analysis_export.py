"""From constraints alone to a Unity scene, by the command line and by the library."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import jsonschema
import numpy as np
import pytest
from kinefab.analysis import AnalysisOptions, Closures, analyse
from kinefab.diagnostics import KinefabError, Report
from kinefab.model import JointKind as K
from kinefab.model import Motion
from kinefab.options import ExportOptions
from kinefab.pipeline import export
from kinefab.sources import read
from mechanism_cases import ROOT, analysed, scene

LEVER = ROOT / "fixtures" / "lever" / "lever.bundle.json"


def run(*arguments):
    return subprocess.run(
        [sys.executable, "-m", "kinefab", *map(str, arguments)], capture_output=True, text=True, timeout=60
    )


def exported(source, folder, options=ExportOptions()):
    target = Path(folder) / "scene.kinefab"
    export(source, target, options)
    content = json.loads(target.read_text("utf-8"))
    schema = json.loads((ROOT / "schemas" / "scene.schema.json").read_text("utf-8"))
    jsonschema.Draft202012Validator(schema).validate(content)
    return content


def components(content):
    return [
        (o, c) for o in content["gameObjects"] for c in o.get("components", []) if c["type"].endswith("Joint")
    ]


def constraints_only():
    source = read(LEVER, Report())
    return replace(source, joints=[], couplings=[])


def test_lever_from_constraints_alone_has_the_joints_a_designer_would_make(tmp_path):
    """Base static; lever, shaft and panel one body on a hinge about the shaft; bar on the eccentric pin; slider
    along X; bar to slider closes the loop with its two in-plane equations."""
    found = analyse(constraints_only(), AnalysisOptions(Closures.MINIMAL))
    assert found.mobility == 1
    names = [n.id for n in found.source.nodes]
    kinds = {(names[j.a], names[j.b]): (j.kind, found.findings[j.id].closure) for j in found.joints}
    assert kinds == {
        ("Lever/Base:1", "Lever/Crank:1/Shaft:1"): (K.REVOLUTE, False),
        ("Lever/Base:1", "Lever/SliderD:1"): (K.PRISMATIC, False),
        ("Lever/Crank:1/PanelB:1", "Lever/BarC:1"): (K.REVOLUTE, False),
        ("Lever/BarC:1", "Lever/SliderD:1"): (K.POINT_ON_LINE, True),
    }
    content = exported(constraints_only(), tmp_path, ExportOptions(closures="minimal", ground="world"))
    joints = components(content)
    assert sorted(c["type"] for _, c in joints) == ["ConfigurableJoint"] * 2 + ["HingeJoint"] * 2
    hinge = next(c for o, c in joints if c["type"] == "HingeJoint" and "connectedBody" not in c)
    # the source's +Z is Unity's +Y; an axial direction changes sign in the mirror, and Y is kept by it
    assert np.allclose(np.abs(hinge["axis"]), [0, 1, 0], atol=1e-6)
    assert hinge["because"] == ["Insert:1"]
    closure = next(c for _, c in joints if c.get("because") == ["Insert:5"])
    locked = [m for m in ("xMotion", "yMotion", "zMotion") if closure.get(m, "Free") == "Locked"]
    assert len(locked) == 2
    assert not [
        m for m in ("angularXMotion", "angularYMotion", "angularZMotion") if closure.get(m) == "Locked"
    ]
    assert content["analysis"]["mobility"] == 1 and content["analysis"]["redundant"] == 4


def test_exact_closures_keep_the_whole_hinge():
    """By default the loop-closing hinge is a hinge."""
    found = analyse(constraints_only())
    assert [j.kind for j in found.joints if found.findings[j.id].closure] == [K.REVOLUTE]


def test_analysis_of_the_file_speaks_of_game_objects(tmp_path):
    """Every freedom listed in the file points at its object and has as many directions as it counts."""
    content = exported(constraints_only(), tmp_path)
    by_id = {content["gameObjects"][b["gameObject"]]["id"]: b for b in content["analysis"]["bodies"]}
    assert (by_id["Lever/SliderD:1"]["translations"], by_id["Lever/SliderD:1"]["rotations"]) == (1, 0)
    assert np.allclose(np.abs(by_id["Lever/SliderD:1"]["directions"]), [[1, 0, 0]], atol=1e-6)
    assert by_id["Lever/BarC:1"]["rotations"] == 1


def test_middle_body_becomes_an_object_with_a_light_rigidbody(tmp_path):
    """A rod between two parts is exported as a body of its own, a tenth of the lighter part's mass."""
    content = exported(scene("P30"), tmp_path)
    middle = next(o for o in content["gameObjects"] if o["id"].startswith("middle:"))
    body = next(c for c in middle["components"] if c["type"] == "Rigidbody")
    assert 0.0 < body["mass"] <= 0.1 + 1e-6
    assert len(components(content)) == 2


def test_screw_is_a_tube_with_its_lead_as_a_coupling(tmp_path):
    """Unity has no screw: the jack's becomes a cylindrical joint and a coupling of 0.05 m a turn."""
    content = exported(scene("P22"), tmp_path)
    ((_, joint),) = components(content)
    assert joint["type"] == "ConfigurableJoint"
    (coupling,) = content["couplings"]
    assert coupling["kind"] == "screw"
    assert abs(coupling["ratio"]) == pytest.approx(0.05 / 360.0)


def test_contradictory_constraints_stop_the_export(tmp_path):
    """No file is written from constraints that cannot hold together."""
    source = scene("P09")
    second = source.constraints[1]
    a, b = second.features
    shifted = replace(second, features=(a, replace(b, point=b.point + [0.05, 0, 0])))
    with pytest.raises(KinefabError) as error:
        export(replace(source, constraints=[source.constraints[0], shifted]), tmp_path / "x.kinefab")
    assert {d.code for d in error.value.diagnostics} == {"CONSTRAINTS_CONTRADICT"}
    assert list(tmp_path.iterdir()) == []


def test_bounded_distance_becomes_limits_of_the_slide():
    """A distance between 0.1 and 0.4 along a slide is two limits, counted from the exported pose."""
    from kinefab.model import Constraint, ConstraintKind, Feature, FeatureKind

    source = scene("P08")  # two dowels along Z: a slide
    z = np.array([0.0, 0.0, 1.0])
    at = source.nodes[1].pose.inverse()
    sides = (
        Feature(0, FeatureKind.PLANE, np.zeros(3), z),
        Feature(1, FeatureKind.PLANE, at.point(np.array([0.0, 0.0, 0.15])), at.direction(z)),
    )
    bounded = Constraint("stroke", ConstraintKind.DISTANCE, sides, lower=0.1, upper=0.4)
    found = analyse(replace(source, constraints=[*source.constraints, bounded]))
    (joint,) = found.joints
    free = joint.freedoms[0]
    frame = found.source.pose(joint.a) @ joint.frame_a
    expected = (-0.05, 0.25) if frame.rotation[2, 0] > 0 else (-0.25, 0.05)
    assert free.motion is Motion.LIMITED and (free.lower, free.upper) == pytest.approx(expected)
    assert "stroke" in joint.because


def test_effective_joint_of_parts_that_nothing_joins_directly():
    """The slider against the base of M09 slides; lever against shaft is fixed; bar against base only has a pole."""
    found = analysed("M09")
    number = {n.name: i for i, n in enumerate(found.source.nodes)}
    assert found.between(number["base"], number["sliderD"]).kind is K.PRISMATIC
    assert found.between(number["leverA"], number["panelB"]).kind is K.FIXED
    assert found.between(number["base"], number["leverA"]).kind is K.REVOLUTE
    bar = found.between(number["base"], number["barC"])
    assert bar.instantaneous and bar.dof == 1


def test_pole_of_the_bar_is_where_the_closed_form_puts_it():
    """At 30 degrees the bar turns about (1.10778352, .63957919), where normal of slide and crank line meet."""
    found = analysed("M09")
    number = {n.name: i for i, n in enumerate(found.source.nodes)}
    freedom = next(f for f in found.freedoms if f.node == number["barC"])
    assert np.allclose(freedom.center[:2], [1.10778352, 0.63957919], atol=1e-8)


def test_dof_records_that_differ_are_warned_about():
    """The source's own DOF analysis is a check: a bar listed as sliding does not."""
    from kinefab.model import DofRecord

    source = scene("M09")
    number = {n.name: i for i, n in enumerate(source.nodes)}
    x, _, z = np.eye(3)
    good = DofRecord(number["sliderD"], np.array([x]), np.zeros((0, 3)))
    bad = DofRecord(number["barC"], np.array([x]), np.array([z]))
    found = analyse(replace(source, dof_records=[good, bad]))
    assert [d.code for d in found.report.diagnostics if d.code.startswith("DOF")] == ["DOF_RECORD_DIFFERS"]


def test_analyse_prints_a_table_that_ends_with_the_mobility():
    """One line a joint: part, group, freedoms, joint, to what, why; the mobility last."""
    done = run("analyse", LEVER)
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert lines[0].split() == ["part", "group", "freedoms", "joint", "to", "why"]
    assert lines[-1].startswith("mobility 1;") and lines[-1].endswith("; 1 mechanism, 1 loop")
    slider = next(line for line in lines if line.startswith("Lever/SliderD:1"))
    assert "prismatic" in slider and "Lever/Base:1" in slider and "Mate:1, Mate:2" in slider


def test_analyse_prints_the_same_as_json():
    """--json gives counts, parts, joints and findings."""
    done = run("analyse", ROOT / "fixtures" / "mechanisms" / "M18.bundle.json", "--json")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert (found["mobility"], found["rows"], found["redundant"]) == (3, 21, 0)
    assert len([j for j in found["joints"] if j["closesLoop"]]) == 5
    platform = next(p for p in found["parts"] if p["id"] == "platform")
    assert len(platform["translations"]) == 3 and platform["rotations"] == []


def test_analyse_of_contradictory_constraints_exits_1_and_names_them(tmp_path):
    """The table is printed, the finding is on stderr, the exit code says so."""
    bundle = json.loads((ROOT / "fixtures" / "pairs" / "P09.bundle.json").read_text("utf-8"))
    bundle["constraints"][1]["b"]["p"][0] += 0.05
    path = tmp_path / "bad.bundle.json"
    path.write_text(json.dumps(bundle), "utf-8")
    done = run("analyse", path)
    assert done.returncode == 1 and "insert:1, insert:2" in done.stderr and "Traceback" not in done.stderr
