"""Copies are decided alike: patterned bolts of which one has a hole of its own size, arms that are mirrored but not quite."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from kinefab.diagnostics import Report
from kinefab.mates.find import find_mates
from kinefab.mates.mate import AUTO
from kinefab.sources import read

pytest.importorskip("OCP", reason="OpenCASCADE is not installed: pip install cadquery-ocp-novtk")

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
sys.path[:0] = [str(FIXTURES), str(FIXTURES.parent / "python" / "bench")]

from mates_bench import Variant, score, variants, written  # noqa: E402
from step.fastened import bolt, washer  # noqa: E402
from step.machine import Machine  # noqa: E402
from step.solids import Y, box, chamfered, cut, fuse, mirrored, rod, split_round  # noqa: E402
from step.writer import write_step  # noqa: E402

TURN = np.array([[1.0, 0.0, 0.0], [0.0, 0.8, -0.6], [0.0, 0.6, 0.8]])


def found_in(machine: Machine, folder: Path):
    for part in machine.parts:  # not along the axes of the file
        part.pose[:3] = TURN @ part.pose[:3]
    machine.joints = [
        type(j)(j.kind, j.a, j.b, tuple(TURN @ np.array(j.point)), tuple(TURN @ np.array(j.axis)))
        for j in machine.joints
    ]
    write_step(machine, folder / "machine.step")
    scene = read(folder / "machine.step", Report())
    return scene, find_mates(scene, machine.ground)


def fixed_to(scene, mates) -> dict[str, list[tuple[str, str, float]]]:
    """For each part: what it is fixed to, the reason, how sure."""
    found: dict[str, list[tuple[str, str, float]]] = {}
    for mate in mates.mates:
        a, b = (scene.nodes[side.node].name for side in mate.sides[:2])
        if mate.joint == "fixed":
            found.setdefault(a, []).append((b, mate.reason, mate.confidence))
            found.setdefault(b, []).append((a, mate.reason, mate.confidence))
    return found


def lid(wide: float, loose: tuple[int, ...] = (2,), lone: bool = False) -> Machine:
    """A lid bolted on a box at four places of an oblong; ``wide``: radius of the holes of the bolts ``loose``."""
    places = [(-60.0, -35.0), (60.0, -35.0), (60.0, 35.0), (-60.0, 35.0)]
    radii = [wide if i in loose else 4.2 for i in range(4)]
    m = Machine("Lid", ground="Box", mobility=0)
    drills = [rod(r, 60.0, (x, y, -50.0)) for r, (x, y) in zip(radii, places, strict=True)]
    m.add("Box", cut(box((-75.0, -50.0, -30.0), (75.0, 50.0, 0.0)), *drills))
    m.add("Lid", cut(box((-75.0, -50.0, 0.0), (75.0, 50.0, 6.0)), *drills))
    names = ["Box", "Lid"]
    for i, (x, y) in enumerate(places):
        if lone and i not in loose:
            continue
        names.append(m.add(f"W{i}", washer(8.0), (x, y, 6.0), product="Washer"))
        names.append(m.add(f"B{i}", bolt(8.0, 30.0), (x, y, 7.6), product="Bolt"))
    m.fix(*names)
    return m


@pytest.mark.parametrize("loose", [(2,), (0, 3)])
def test_a_bolt_in_a_hole_drawn_too_wide_is_fixed_as_the_others_are(loose: tuple[int, ...], tmp_path: Path):
    machine = lid(5.5, loose)
    scene, mates = found_in(machine, tmp_path)
    result = score(machine, scene)
    assert (result.missed, result.wrong, result.mobility, result.locks) == (0, 0, 1, [])
    told = [mate for mate in mates.mates if "as its twin" in mate.reason]
    assert len(told) == len(loose) and all(AUTO <= mate.confidence < 0.9 for mate in told)
    for mate in told:  # the twin, what it is fixed to, and the faces of both
        twin = mate.reason.partition("as its twin: ")[2]
        assert " with " in twin and twin.count("/") >= 4


def test_without_a_twin_it_only_lies_there(tmp_path: Path):
    """The same bolt alone: nothing says that it is fixed, and nothing is invented."""
    scene, mates = found_in(lid(5.5, (2,), lone=True), tmp_path)
    assert [m for m in mates.mates if "as its twin" in m.reason] == []
    assert [m.joint for m in mates.mates if {scene.nodes[s.node].name for s in m.sides} == {"W2", "Lid"}] == [
        "planar"
    ]


def test_a_slider_is_no_twin_of_a_bolt(tmp_path: Path):
    """A disc that lies on the lid as the washers do, but is of another definition, stays free."""
    machine = lid(4.2)
    machine.add("Disc", rod(8.0, 2.0), (10.0, 5.0, 6.0))
    scene, mates = found_in(machine, tmp_path)
    assert [m.joint for m in mates.mates if "Disc" in {scene.nodes[s.node].name for s in m.sides}] == [
        "planar"
    ]


def arms(right, gap: float) -> Machine:
    """Two arms on pins of a base, mirrored in x.  The left pin has play in the base and none in its arm; at the right, where
    ``right`` changes the arm, the play is the same in both."""
    m = Machine("Arms", ground="Base", mobility=2)

    def bracket(x: float, bore: float):
        walls = [box((x - 14.0, y, 0.0), (x + 14.0, y + 8.0, 40.0)) for y in (-22.0, 14.0)]
        return cut(
            fuse(*walls, box((x - 14.0, -22.0, -10.0), (x + 14.0, 22.0, 0.0))),
            rod(bore, 60.0, (x, -30.0, 25.0), Y),
        )

    base = fuse(
        bracket(-50.0, 5.1), bracket(50.0, 5.0 + gap), box((-70.0, -30.0, -20.0), (70.0, 30.0, -10.0))
    )
    m.add("Base", base)
    arm = fuse(rod(11.0, 27.0, (-50.0, -13.5, 25.0), Y), box((-120.0, -9.0, 20.0), (-50.0, 9.0, 30.0)))
    m.add("ArmL", cut(arm, rod(5.0, 60.0, (-50.0, -30.0, 25.0), Y)))
    m.add("ArmR", right(cut(mirrored(arm, (1.0, 0.0, 0.0)), rod(5.0 + gap, 60.0, (50.0, -30.0, 25.0), Y))))
    for name, x in (("PinL", -50.0), ("PinR", 50.0)):
        m.add(name, rod(5.0, 44.0, (0.0, -22.0, 25.0), Y), (x, 0.0, 0.0), product="Pin")
    m.joint("revolute", "Base", "ArmL", (-50.0, 0.0, 25.0), Y)
    m.joint("revolute", "Base", "ArmR", (50.0, 0.0, 25.0), Y)
    m.fix("ArmL", "PinL")
    m.fix("ArmR", "PinR")
    return m


CHANGES = {
    "as mirrored": lambda arm: arm,
    "a bore split in four": split_round,
    "chamfered": lambda arm: chamfered(arm, 0.4),
}


@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("gap", [0.05, 0.08])
def test_a_pin_turns_with_the_part_that_its_twin_turns_with(change: str, gap: float, tmp_path: Path):
    machine = arms(CHANGES[change], gap)
    scene, mates = found_in(machine, tmp_path)
    fixed = fixed_to(scene, mates)
    assert fixed["PinL"][0][:2] == ("ArmL", "pressed")
    (other, reason, confidence) = fixed["PinR"][0]
    assert other == "ArmR" and reason.startswith("pin, as its twin: Arms/") and confidence == 0.7
    assert "Arms/PinL" in reason and "Arms/ArmL" in reason
    result = score(machine, scene)
    assert (result.missed, result.wrong, result.mobility, result.locks) == (0, 0, 1, [])


DOUBTFUL = {
    "copied_rollers": "revolute",
    "copied_studs": "spherical",
    "copied_saddles": "revolute",
    "copied_covers": "fixed",
    "copied_slots": "pin_slot",
    "copied_plungers": "cylindrical",
    "copied_gears": "revolute",
}
"""The joint that a copy takes from its twin: its own is not found, or another, where its twin's is sure."""


@pytest.mark.parametrize("number, name", list(enumerate(DOUBTFUL)))
def test_any_joint_of_a_copy_in_doubt_is_its_twins(number: int, name: str, tmp_path: Path):
    """As drawn and placed anyhow without names that mean something; the twin and its faces are told."""
    for variant in (Variant(), variants(len(DOUBTFUL), seed=5)[number]):
        machine = written(name, variant, tmp_path / "machine.step")
        scene = read(tmp_path / "machine.step", Report())
        result = score(machine, scene)
        assert (result.missed, result.wrong, result.mobility, result.locks) == (0, 0, 1, [])
        told = [mate for mate in find_mates(scene, machine.ground).mates if "as its twin" in mate.reason]
        assert [(mate.joint, mate.confidence) for mate in told] == [(DOUBTFUL[name], 0.7)]
        assert told[0].reason.partition("as its twin: ")[2].count("/") >= 3


def guided(second) -> Machine:
    """A block in a slot of a base, held on all sides, and its copy at another place, which ``second`` makes."""
    m = Machine("Guided", ground="Base", mobility=0)
    slot = fuse(box((-60.0, -10.0, -12.0), (60.0, 10.0, -4.0)), box((-60.0, -6.0, -5.0), (60.0, 6.0, 1.0)))
    m.add("Base", second(cut(box((-60.0, -30.0, -30.0), (60.0, 130.0, 0.0)), slot)))
    block = fuse(
        box((-15.0, -9.9, -11.9), (15.0, 9.9, -4.1)), box((-15.0, -5.9, -4.2), (15.0, 5.9, 4.0)), box((-15.0, -5.0, 4.0), (9.0, 5.0, 9.0))
    )  # fmt: skip
    m.add("BlockA", block, product="Block")
    m.add("BlockB", block, (5.0, 70.0, 11.9), product="Block")
    return m


def test_what_guides_the_twin_must_be_there(tmp_path: Path):
    """The copy lies on the plain base, where nothing guides it: it stays free on its plane."""
    scene, mates = found_in(guided(lambda base: base), tmp_path)
    joints = {scene.nodes[m.sides[1].node].name: m.joint for m in mates.mates}
    assert joints == {"BlockA": "prismatic", "BlockB": "planar"}
    assert not any("as its twin" in mate.reason for mate in mates.mates)


def test_what_a_copy_surely_does_is_not_taken_from_a_twin(tmp_path: Path):
    """One pin is bolted fast by its flange, its copy turns in a bore with shoulders: neither says anything of the other."""
    m = Machine("Pins", ground="Base", mobility=1)
    bore = rod(5.05, 60.0, (60.0, 0.0, -30.0))
    base = fuse(box((-30.0, -30.0, -20.0), (30.0, 30.0, 0.0)), box((45.0, -30.0, -20.0), (75.0, 30.0, 0.0)), box((30.0, -30.0, -20.0), (45.0, 30.0, -10.0)))  # fmt: skip
    m.add("Base", cut(base, bore, rod(5.0, 60.0, (0.0, 0.0, -30.0)), rod(2.1, 40.0, (0.0, 14.0, -30.0)), rod(2.1, 40.0, (0.0, -14.0, -30.0))))  # fmt: skip
    pin = fuse(rod(5.0, 30.0, (0.0, 0.0, -25.0)), rod(20.0, 4.0))
    pin = cut(pin, rod(2.1, 20.0, (0.0, 14.0, -5.0)), rod(2.1, 20.0, (0.0, -14.0, -5.0)))
    m.add("PinA", pin, product="Pin")
    m.add("PinB", pin, (60.0, 0.0, 0.05), product="Pin")
    m.add("Ring", cut(rod(9.0, 3.0, (60.0, 0.0, -23.1)), rod(4.99, 30.0, (60.0, 0.0, -30.0))))
    for i, y in enumerate((14.0, -14.0)):
        m.add(f"Bolt:{i}", bolt(4.0, 20.0), (0.0, y, 4.0), product="Bolt")
    scene, mates = found_in(m, tmp_path)
    joints = {
        frozenset(scene.nodes[s.node].name for s in mate.sides): (mate.joint, "twin" in mate.reason)
        for mate in mates.mates
    }
    assert joints[frozenset(("Base", "PinA"))] == ("fixed", False)
    assert joints[frozenset(("Base", "PinB"))] == ("revolute", False)
