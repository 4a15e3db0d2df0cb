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

pytest.importorskip("OCP", reason="OpenCASCADE is not installed: pip install kinefab[cad]")

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
sys.path[:0] = [str(FIXTURES), str(FIXTURES.parent / "python" / "bench")]

from mates_bench import score  # noqa: E402
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
