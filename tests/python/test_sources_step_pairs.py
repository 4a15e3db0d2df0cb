"""Kinematic pairs of AP242: on the right parts, with their ranges, in both mappings; damaged ones are left out by name."""

from __future__ import annotations

import json
import math
import os
import random
import re
import sys
from pathlib import Path

import kinefab
import numpy as np
import pytest
from kinefab import sources
from kinefab.diagnostics import KinefabError, Report
from kinefab.model import RX, TX, JointKind, Motion
from kinefab.sources.step import reader
from kinefab.sources.step.entities import EntityError, Ref, Word, parsed
from kinefab.sources.step.part21 import Part21
from source_bundles import FIXTURES
from test_sources_freecad_bad_input import damaged

pytest.importorskip("OCP", reason="OpenCASCADE is not installed: pip install cadquery-ocp-novtk")
sys.path.insert(0, str(FIXTURES))

from step.kinematics import Link, Pair, with_mechanism  # noqa: E402
from step.linkages import lever, two_plates  # noqa: E402
from step.machine import Machine  # noqa: E402
from step.solids import box  # noqa: E402
from step.writer import write_step  # noqa: E402

LEVER = FIXTURES / "lever"
MUTATIONS = int(os.environ.get("KINEFAB_STEP_MUTATIONS", "25"))


def read(data: bytes, folder: Path, **options: object):
    (folder / "moving.step").write_bytes(data)
    report = Report()
    return sources.read(folder / "moving.step", report, options=options), report


def frame(o, z=(0, 0, 1), x=(1, 0, 0)) -> np.ndarray:
    found = np.eye(4)
    found[:3, :3] = np.column_stack([x, np.cross(z, x), z])
    found[:3, 3] = o
    return found


def boxes(folder: Path, unit: str = "MM") -> tuple[bytes, dict[str, Link]]:
    """A base and an arm at (100, 0, 0) mm, turned by 90 degrees about Z; its usages' poses in the file's unit."""
    machine = Machine("Two")
    machine.add("Base", box((0.0, 0.0, 0.0), (50.0, 50.0, 10.0)))
    turn = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    machine.add("Arm", box((0.0, 0.0, 0.0), (20.0, 5.0, 5.0)), (100.0, 0.0, 0.0), turn)
    write_step(machine, folder / "two.step", schema="AP242DIS", unit=unit)
    scale = {"MM": 1.0, "INCH": 1 / 25.4}[unit]
    links = {}
    for part in machine.parts:
        pose = np.array(part.pose)
        pose[:3, 3] *= scale
        links[part.name] = Link(part.name, "Two", pose)
    return (folder / "two.step").read_bytes(), links


@pytest.mark.parametrize("external", [False, True])
def test_the_levers_pairs_are_the_bundles_joints(tmp_path, external):
    """Frames in the world, limits, parts; and the mechanism moves as the bundle's does."""
    bundle = json.loads((LEVER / "lever.bundle.json").read_text("utf-8"))
    machine = lever()
    links = {part.name: Link(part.name, part.group or "Lever", part.pose) for part in machine.parts}
    poses = {
        c["id"]: frame(np.array(c["pose"]["o"]) * 10, c["pose"]["z"], c["pose"]["x"])
        for c in bundle["components"]
    }
    pairs = []
    for joint in bundle["joints"]:
        frames = []
        for side, key in (("a", "frameA"), ("b", "frameB")):
            own = frame(np.array(joint[key]["o"]) * 10, joint[key]["z"], joint[key]["x"])
            frames.append(poses[joint[side]] @ own if joint[key]["in"] == "part" else own)
        names = [joint[side].rpartition("/")[2].replace("Crank:1", "Shaft:1") for side in "ab"]
        kind = {"revolute": "revolute", "slider": "prismatic"}[joint["type"]]
        ranges = (65.0, 115.0) if kind == "prismatic" else ()
        pairs.append(Pair(joint["id"], kind, *names, (frames[0], frames[1]), ranges))
    for name in ("LeverA:1", "PanelB:1"):
        pairs.append(Pair(f"Held {name}", "fixed", "Shaft:1", name, (np.eye(4), np.eye(4))))
    data = with_mechanism((LEVER / "lever.step").read_bytes(), links, pairs, "Base:1", external)
    scene, report = read(data, tmp_path)
    assert [d.code for d in report.diagnostics] == [] and len(report.outcomes) == 6
    expected = {joint.name: joint for joint in sources.read(LEVER / "lever.bundle.json", Report()).joints}
    wanted = sources.read(LEVER / "lever.bundle.json", Report())
    by_id = {joint.id: joint for joint in wanted.joints}
    assert len(expected) == 4 and len(scene.joints) == 6
    for joint in scene.joints[:4]:
        other = by_id[joint.id]
        assert joint.kind is other.kind
        assert (
            scene.name(joint.b).rpartition("/")[2].replace("Shaft:1", "Crank:1")
            == wanted.name(other.b).rpartition("/")[2]
        )
        for own, of in ((scene.pose(joint.a) @ joint.frame_a, wanted.pose(other.a) @ other.frame_a),
                        (scene.pose(joint.b) @ joint.frame_b, wanted.pose(other.b) @ other.frame_b)):  # fmt: skip
            np.testing.assert_allclose(own.rotation, of.rotation, atol=1e-9)
            np.testing.assert_allclose(own.translation, of.translation, atol=1e-9)
        for a, b in zip(joint.freedoms, other.freedoms):
            assert (a.motion, a.lower, a.upper) == (b.motion, pytest.approx(b.lower), pytest.approx(b.upper))
    assert [node.id for node in scene.nodes if node.grounded] == ["Lever/Base:1"]
    done = kinefab.export(tmp_path / "moving.step", tmp_path / "moving.kinefab")
    assert done.analysed.analysis.mobility == 1


@pytest.mark.parametrize("unit, metres", [("MM", 1e-3), ("INCH", 0.0254)])
def test_placements_and_ranges_are_in_the_files_unit(tmp_path, unit, metres):
    data, links = boxes(tmp_path, unit)
    at = frame((3.0, 0.0, 0.0), z=(1, 0, 0), x=(0, 1, 0))
    data = with_mechanism(
        data, links, [Pair("p", "cylindrical", "Base", "Arm", (at, at), (-1.0, 2.0, -0.5, None))], "Base"
    )
    scene, report = read(data, tmp_path)
    (joint,) = scene.joints
    own = scene.pose(joint.b) @ joint.frame_b
    assert report.diagnostics == [] and joint.kind is JointKind.CYLINDRICAL
    np.testing.assert_allclose(own.translation, [3.0 * metres, 0.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(own.rotation[:, 0], [1.0, 0.0, 0.0], atol=1e-12)
    assert (joint.freedoms[TX].lower, joint.freedoms[TX].upper) == pytest.approx((-metres, 2.0 * metres))
    assert (joint.freedoms[RX].lower, joint.freedoms[RX].upper) == (-0.5, math.inf)


@pytest.mark.parametrize("external", [False, True])
@pytest.mark.parametrize(
    "kind, free, wanted, ranges",
    [
        ("revolute", (), JointKind.REVOLUTE, (-1.0, 2.0)),
        ("prismatic", (), JointKind.PRISMATIC, (-1.0, 2.0)),
        ("prismatic", ("tx",), JointKind.PRISMATIC, (-1.0, 2.0)),
        ("revolute", ("ry",), JointKind.REVOLUTE, ()),
        ("planar", (), JointKind.PLANAR, (-1.0, 1.0, None, None, 0.0, 5.0)),
        ("spherical", (), JointKind.SPHERICAL, ()),
        ("universal", (), JointKind.UNIVERSAL, (-0.5, 0.5, None, None)),
        ("fixed", (), JointKind.FIXED, ()),
        ("pinned", (), JointKind.UNIVERSAL, ()),
        ("free", ("tx", "rz"), JointKind.PIN_SLOT, (None, None, None, None, -0.5, 0.5, 0.0, 4.0, None, None, None, None)),
        ("free", ("tx", "ty", "tz", "rz"), JointKind.PARALLEL_PLANES, ()),
        ("free", ("tx", "ty", "rx", "ry"), JointKind.GENERAL, ()),
    ],
)  # fmt: skip
def test_freedoms_are_the_flags_of_the_pair(tmp_path, kind, free, wanted, ranges, external):
    """Whatever axes the kind's name would mean: the directions that may move are those of the flags."""
    data, links = boxes(tmp_path)
    at = frame((10.0, 20.0, 30.0), z=(0, 1, 0), x=(0, 0, 1))
    pair = Pair("p", kind, "Base", "Arm", (at, at), ranges, free)
    scene, report = read(with_mechanism(data, links, [pair], "Base", external), tmp_path)
    (joint,) = scene.joints
    assert report.diagnostics == [] and joint.kind is wanted
    axes = (scene.pose(joint.a) @ joint.frame_a).rotation
    turned = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]]) @ at[:3, :3]  # Z up becomes Y up
    named = {
        "revolute": "rz",
        "prismatic": "tz",
        "planar": "tx ty rz",
        "spherical": "rx ry rz",
        "universal": "rx rz",
        "pinned": "ry rz",
        "fixed": "",
    }
    for word in free or named[kind].split():
        direction = turned[:, "xyz".index(word[1])]
        moved = [
            i
            for i in joint.unlocked
            if (i < 3) == (word[0] == "t") and abs(axes[:, i % 3] @ direction) > 1 - 1e-9
        ]
        assert len(moved) == 1
    assert len(joint.unlocked) == len(free or named[kind].split())
    limited = sum(low is not None for low in ranges[::2])
    assert sum(f.motion is Motion.LIMITED for f in joint.freedoms) == limited


INCHES_AND_DEGREES = """#{0}=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));
#{1}=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#{0});
#{2}=DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);
#{3}=(CONVERSION_BASED_UNIT('INCH',#{1})LENGTH_UNIT()NAMED_UNIT(#{2}));
#{4}=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));
#{5}=PLANE_ANGLE_MEASURE_WITH_UNIT(PLANE_ANGLE_MEASURE(0.0174532925199433),#{4});
#{6}=DIMENSIONAL_EXPONENTS(0.,0.,0.,0.,0.,0.,0.);
#{7}=(CONVERSION_BASED_UNIT('DEGREE',#{5})NAMED_UNIT(#{6})PLANE_ANGLE_UNIT());
"""
CONTEXT_OF_THEM = "#{8}=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((#{3},#{7}))REPRESENTATION_CONTEXT('','3D'));\n"


@pytest.mark.parametrize("used, metre, radian", [(False, 1e-3, 1.0), (True, 0.0254, math.pi / 180.0)])
def test_ranges_are_in_the_units_of_the_mechanism(tmp_path, used, metre, radian):
    """A file may define units that it does not use, and give a mechanism others than its shapes."""
    data, links = boxes(tmp_path)
    pair = Pair("p", "cylindrical", "Base", "Arm", (np.eye(4), np.eye(4)), (-10.0, 80.0, -0.2, 1.4))
    whole = with_mechanism(data, links, [pair], "Base").decode("latin-1")
    numbers = range(first := 1 + max(int(n) for n in re.findall(r"#(\d+)\s*=", whole)), first + 9)
    units = INCHES_AND_DEGREES + CONTEXT_OF_THEM * used
    if used:
        whole = re.sub(r"(= *MECHANISM_REPRESENTATION\('',\([^)]*\)),#\d+", rf"\1,#{numbers[8]}", whole)
    head, _, tail = whole.rpartition("ENDSEC;")
    scene, report = read((head + units.format(*numbers) + "ENDSEC;" + tail).encode("latin-1"), tmp_path)
    (joint,) = scene.joints
    assert report.diagnostics == []
    assert (joint.freedoms[TX].lower, joint.freedoms[TX].upper) == pytest.approx((-10 * metre, 80 * metre))
    assert (joint.freedoms[RX].lower, joint.freedoms[RX].upper) == pytest.approx(
        (-0.2 * radian, 1.4 * radian)
    )


def test_a_screw_has_its_pitch(tmp_path):
    data, links = boxes(tmp_path)
    pair = Pair("p", "screw", "Base", "Arm", (np.eye(4), np.eye(4)), pitch=2.5)
    scene, _ = read(with_mechanism(data, links, [pair], "Base"), tmp_path)
    assert scene.joints[0].kind is JointKind.SCREW and scene.joints[0].lead == pytest.approx(0.0025)


LEANING = np.array([0.6, 0.8, 0.0])
"""The wheels' axis in the scene, whose Y is up: (0.6, 0, 0.8) in the file."""


def carried(
    folder: Path, unit: str = "MM"
) -> tuple[bytes, dict[str, Link], list[Pair], dict[str, np.ndarray]]:
    """A base with a wheel of 12 mm about an axis that leans, one of 30 mm about another, and a bar; each on its own pair."""
    machine = Machine("Three")
    scale = {"MM": 1.0, "INCH": 1 / 25.4}[unit]
    tilt = frame((0.0, 0.0, 0.0), z=(0.6, 0.0, 0.8), x=(0.8, 0.0, -0.6))
    at = {
        "Base": np.eye(4),
        "Small": tilt @ frame((5.0, 0, 0)),
        "Large": tilt @ frame((47.0, 0, 0)),
        "Bar": tilt @ frame((5.0, -12.0, 0)),
    }
    for name, pose in at.items():
        machine.add(name, box((0.0, 0.0, 0.0), (4.0, 5.0, 6.0)), tuple(pose[:3, 3]), pose[:3, :3].tolist())
    write_step(machine, folder / "three.step", schema="AP242DIS", unit=unit)
    links, frames = {}, {}
    for name, pose in at.items():
        pose = pose.copy()
        pose[:3, 3] *= scale
        links[name], frames[name] = Link(name, "Three", pose), pose
    bar = frames["Bar"] @ frame((0.0, 0.0, 0.0), z=(1, 0, 0), x=(0, 1, 0))
    pairs = [
        Pair("on small", "revolute", "Base", "Small", (frames["Small"],) * 2),
        Pair("on large", "revolute", "Large", "Base", (frames["Large"],) * 2),
        Pair("on bar", "prismatic", "Base", "Bar", (bar, bar)),
    ]
    return (folder / "three.step").read_bytes(), links, pairs, frames


def rates(scene) -> dict[str, np.ndarray]:
    """For each part how it moves at the exported pose, turn and then travel of its own origin, WORLD; the small wheel by 1 rad."""
    (coupling,) = scene.couplings
    (term,) = coupling.terms
    speeds = {term.joint: (term.freedom, 1.0), coupling.joint: (coupling.freedom, term.ratio)}
    found = {}
    for joint in scene.joints:
        if joint.id not in speeds:
            continue
        freedom, speed = speeds[joint.id]
        twist = np.zeros((2, 3))
        twist[1 if freedom < 3 else 0] = (scene.pose(joint.a) @ joint.frame_a).rotation[
            :, freedom % 3
        ] * speed
        moved, other = (joint.b, joint.a) if "Base" in scene.name(joint.a) else (joint.a, joint.b)
        found[scene.name(moved).rpartition("/")[2]] = twist if moved == joint.b else -twist
    own = found["Small"][0] @ LEANING
    return {name: twist / own for name, twist in found.items()}


@pytest.mark.parametrize("external", [False, True])
def test_a_gear_pair_couples_the_turns_of_its_links(tmp_path, external):
    """By the standard rotation 2 is - ratio * rotation 1, each about its own placement's z, whichever way the hinges are stated."""
    data, links, pairs, frames = carried(tmp_path)
    pairs.append(Pair("mesh", "gear", "Small", "Large", (frames["Small"], frames["Large"]), (), (), 0.4))
    scene, report = read(with_mechanism(data, links, pairs, "Base", external), tmp_path)
    assert report.diagnostics == [] and len(scene.joints) == 3 and len(report.outcomes) == 4
    np.testing.assert_allclose(rates(scene)["Large"][0], -0.4 * LEANING, atol=1e-12)
    done = kinefab.export(tmp_path / "moving.step", tmp_path / "moving.kinefab")
    assert done.analysed.analysis.mobility == 2


@pytest.mark.parametrize("external", [False, True])
@pytest.mark.parametrize("unit, metres", [("MM", 1e-3), ("INCH", 0.0254)])
@pytest.mark.parametrize("first, second", [("Bar", "Small"), ("Small", "Bar")])
def test_a_rack_follows_its_pinion(tmp_path, first, second, unit, metres, external):
    """The pinion's centre is on y of the rack, so that the rack goes along x as the pinion turns about z: it rolls."""
    data, links, pairs, frames = carried(tmp_path, unit)
    radius = 12e-3 / metres
    pairs.append(Pair("mesh", "rack", first, second, (frames[first], frames[second]), (), (), radius))
    scene, report = read(with_mechanism(data, links, pairs, "Base", external), tmp_path)
    assert report.diagnostics == []
    own = rates(scene)
    place = [n.name for n in scene.nodes]
    small, bar = (scene.nodes[place.index(name)].pose for name in ("Small", "Bar"))
    contact = np.cross(own["Small"][0], bar.translation - small.translation)
    np.testing.assert_allclose(own["Bar"][1], contact, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(contact), 0.012, atol=1e-12)


def test_what_carries_no_gear_and_its_ranges_are_told(tmp_path):
    data, links, pairs, frames = carried(tmp_path)
    ends = (frames["Small"], frames["Large"])
    told = [*pairs[:1], Pair("mesh", "gear", "Small", "Large", ends, (), (), 0.4)]
    scene, report = read(with_mechanism(data, links, told, "Base"), tmp_path)
    assert scene.couplings == [] and [d.code for d in report.diagnostics] == ["STEP_PAIRS_DROPPED"]
    pairs.append(Pair("mesh", "gear", "Small", "Large", ends, (-1.0, 1.0), (), 0.4))
    scene, report = read(with_mechanism(data, links, pairs, "Base"), tmp_path)
    (coupling,) = scene.couplings
    (lost,) = report.diagnostics
    assert coupling.id == "mesh" and "the range of a gear" in lost.message


@pytest.mark.parametrize("external", [False, True])
def test_a_homokinetic_pair_turns_both_shafts_alike(tmp_path, external):
    """Its shafts are along y; driven in one bearing, the other shaft turns in its own at every angle between them."""
    machine = Machine("Shafts")
    bent = frame((0.0, 0.0, 0.0), z=(0.0, 0.6, 0.8), x=(1, 0, 0))
    at = {"Base": np.eye(4), "In": np.eye(4), "Out": bent}
    for name, pose in at.items():
        machine.add(name, box((0.0, 0.0, 0.0), (4.0, 5.0, 6.0)), tuple(pose[:3, 3]), pose[:3, :3].tolist())
    write_step(machine, tmp_path / "shafts.step", schema="AP242DIS")
    links = {name: Link(name, "Shafts", pose) for name, pose in at.items()}
    along = frame((0.0, 0.0, 0.0), z=(0, 1, 0), x=(0, 0, 1))  # z along the shafts' y
    pairs = [
        Pair("first", "revolute", "Base", "In", (along, along)),
        Pair("second", "revolute", "Base", "Out", (bent @ along, bent @ along)),
        Pair("joint", "homokinetic", "In", "Out", (at["In"], at["Out"])),
    ]
    scene, report = read(
        with_mechanism((tmp_path / "shafts.step").read_bytes(), links, pairs, "Base", external), tmp_path
    )
    assert report.diagnostics == [] and len(scene.couplings) == 1
    done = kinefab.export(tmp_path / "moving.step", tmp_path / "moving.kinefab")
    assert done.analysed.analysis.mobility == 1


def test_occurrences_of_one_product_are_told_apart(tmp_path):
    """Plate:1 in the top, Plate:2 in a sub-assembly, and the pair between them the other way round."""
    write_step(two_plates(), tmp_path / "plates.step", schema="AP242DIS")
    plates = {part.name: part for part in two_plates().parts}
    links = {name: Link(name, part.group or "Plates", part.pose) for name, part in plates.items()}
    pair = Pair("p", "revolute", "Plate:2", "Plate:1", (np.eye(4), np.eye(4)))
    scene, report = read(
        with_mechanism((tmp_path / "plates.step").read_bytes(), links, [pair], "Plate:1"), tmp_path
    )
    (joint,) = scene.joints
    assert report.diagnostics == []
    assert (scene.name(joint.a), scene.name(joint.b)) == ("Plates/Upper/Plate:2", "Plates/Plate:1")
    assert [node.id for node in scene.nodes if node.grounded] == ["Plates/Plate:1"]


@pytest.mark.parametrize(
    "old, new, words",
    [
        (b"KINEMATIC_JOINT('p',#", b"KINEMATIC_JOINT('p',#9", "which part"),
        (b"AXIS2_PLACEMENT_3D('',#", b"AXIS2_PLACEMENT('',#", "placement"),
        (b"DIRECTION('',(0.,0.,1.))", b"DIRECTION('',(0.,0.,0.))", "span nothing"),
        (b",-1.,2.)", b",2.,-1.)", "ends before"),
        (b"REVOLUTE_PAIR_WITH_RANGE('p'", b"GEAR_PAIR('p'", "argument 5 is no number"),
        (b"REVOLUTE_PAIR_WITH_RANGE('p'", b"RACK_AND_PINION_PAIR('p'", "argument 1 is no number"),
        (b"REVOLUTE_PAIR_WITH_RANGE('p'", b"PLANAR_CURVE_PAIR('p'", "planar curve pairs are not read"),
    ],
)  # fmt: skip
def test_a_damaged_pair_is_left_out_by_name(tmp_path, old, new, words):
    data, links = boxes(tmp_path)
    whole = with_mechanism(
        data, links, [Pair("p", "revolute", "Base", "Arm", (np.eye(4), np.eye(4)), (-1.0, 2.0))], "Base"
    )
    head, _, own = whole.partition(b"KINEMATIC_LINK('Base')")
    assert old in own
    scene, report = read(head + b"KINEMATIC_LINK('Base')" + own.replace(old, new), tmp_path)
    assert scene.joints == []
    assert [(o.outcome.value, o.code) for o in report.outcomes] == [("dropped", "STEP_PAIRS_DROPPED")]
    assert words in next(d.message for d in report.diagnostics if d.code == "STEP_PAIRS_DROPPED")


def test_mutations_of_a_mechanism_end_in_findings(tmp_path, monkeypatch):
    monkeypatch.setattr(reader, "SECONDS", 2.0)
    monkeypatch.setattr(reader, "SECONDS_PER_MEGABYTE", 0.0)
    data, links = boxes(tmp_path)
    pairs = [
        Pair(k, k, "Base", "Arm", (np.eye(4), np.eye(4)))
        for k in ("revolute", "planar", "screw", "gear", "rack", "homokinetic")
    ]
    head, mark, own = with_mechanism(data, links, pairs, "Base", True).partition(b"KINEMATIC_LINK('Base')")
    chance = random.Random(12)
    for _ in range(MUTATIONS):
        try:
            read(head + mark + damaged(own, chance), tmp_path)
        except KinefabError as error:
            assert error.diagnostics


def test_entities_are_parsed_in_both_mappings():
    assert parsed(b"A('it''s',#12,.T.,-1.5E2,$,*,(1.,(#3)))") == {
        "A": ["it's", Ref(12), Word("T"), -150.0, None, None, [1.0, [Ref(3)]]]
    }
    assert parsed(b" ( A() B ( LENGTH_MEASURE(2.) ) /* note */ )") == {"A": [], "B": [2.0]}
    for broken in (b"", b"A", b"A(", b"A(#)", b"A(B)", b"(" * 100, b"A(1.E999)"):
        with pytest.raises(EntityError):
            parsed(broken)
    assert Part21(b"ISO-10303-21;#1=LOW_ORDER_KINEMATIC_PAIR_WITH_RANGE();").kinematic_pairs() == 1
