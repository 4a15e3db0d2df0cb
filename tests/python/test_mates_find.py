"""Mates found in machines that were built with known ones; ``python/bench/mates_bench.py`` tries many more variants."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from kinefab.analysis import analyse
from kinefab.diagnostics import Report
from kinefab.mates.apply import with_found
from kinefab.mates.find import find_mates
from kinefab.model import RX
from kinefab.sources import read
from kinefab.spatial import rotation_log

pytest.importorskip("OCP", reason="OpenCASCADE is not installed: pip install cadquery-ocp-novtk")

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "fixtures"), str(ROOT / "python" / "bench")]

from mates_bench import Variant, score, variants, written  # noqa: E402
from step.machine import Machine  # noqa: E402
from step.solids import X, box, cut, fuse, rod  # noqa: E402
from step.writer import write_step  # noqa: E402

FEW = (
    "lever",
    "four_bar",
    "slider_crank",
    "hinge",
    "closed_drawer",
    "ball_joint",
    "pin_slot",
    "bolted_frame",
    "vice",
    "gears",
    "turntable",
    "idler",
    "turrets",
    "folding_chair",
    "gimbal",
    "bearing_blocks",
    "standoffs",
    "roller_yoke",
    "butterfly",
    "louvre",
    "antenna",
    "lead_screw",
    "spindle",
    "screw_cap",
    "modelled_threads",
    "set_collars",
    "dog_screws",
    "keyed_hub",
    "inserts",
)
"""What the suite tries as drawn: a machine for each rule."""
TURNED = ("split_hinge", "pillow_block", "bearing", "pipe_clamp", "bolted_linkage", "motor_pulley", "runner")
"""And with another size, place, clearance, unit, and names without meaning."""


def judged(name: str, variant: Variant, folder: Path):
    path = folder / f"{name}.step"
    machine = written(name, variant, path)
    return score(machine, read(path, Report()))


@pytest.mark.parametrize("name", FEW)
def test_a_machine_is_found_as_it_was_built(name: str, tmp_path: Path):
    found = judged(name, Variant(), tmp_path)
    assert (found.missed, found.wrong, found.mobility, found.locks) == (0, 0, 1, [])
    assert found.hits > 0


@pytest.mark.parametrize("number, name", list(enumerate(TURNED, 1)))
def test_size_place_and_names_change_nothing(number: int, name: str, tmp_path: Path):
    found = judged(name, variants(len(TURNED), seed=3)[number], tmp_path)
    assert (found.missed, found.wrong, found.mobility, found.locks) == (0, 0, 1, [])


@pytest.mark.parametrize("name", ["roller_bearing", "needle_bearing"])
@pytest.mark.parametrize("clearance", [0.0, 0.08])
def test_rings_turn_on_the_rollers_between_them(name: str, clearance: float, tmp_path: Path):
    found = judged(name, Variant(clearance), tmp_path)
    assert (found.hits, found.missed, found.wrong, found.mobility, found.locks) == (10, 0, 0, 1, [])


def test_screws_with_a_cross_and_rectangular_nuts_are_known_by_their_names(tmp_path: Path):
    """Their faces do not all go round an axis; a block that is called after its nut is still none."""
    machine = Machine("Bracket", ground="Base", mobility=1)
    places = (-20.0, 20.0)
    holes = [rod(2.0, 30.0, (x, 0.0, -20.0)) for x in places]
    machine.add("Base", cut(box((-40.0, -20.0, -10.0), (40.0, 20.0, 0.0)), *holes))
    cheeks = fuse(*(box((x, -15.0, 0.0), (x + 6.0, 15.0, 40.0)) for x in (-40.0, 34.0)))
    bracket = fuse(box((-40.0, -15.0, 0.0), (40.0, 15.0, 4.0)), cheeks)
    machine.add("Bracket", cut(bracket, *holes, rod(4.0, 100.0, (-50.0, 0.0, 28.0), X)))
    cross = [box((-2.5, -0.6, 1.0), (2.5, 0.6, 5.0)), box((-0.6, -2.5, 1.0), (0.6, 2.5, 5.0))]
    screw = cut(fuse(rod(4.0, 3.0), rod(2.0, 20.0, (0.0, 0.0, -20.0))), *cross)
    nut = cut(box((-4.5, -3.5, -3.0), (4.5, 3.5, 0.0)), rod(2.0, 10.0, (0.0, 0.0, -5.0)))
    for number, x in enumerate(places, 1):
        machine.add(f"Screw{number}", screw, (x, 0.0, 4.0), product="Pan head screw M4x20")
        machine.add(f"Nut{number}", nut, (x, 0.0, -10.0), product="Nut M4")
    machine.add("Bar", rod(4.0, 120.0, (-60.0, 0.0, 28.0), X))
    block = cut(box((-10.0, -15.0, 15.0), (10.0, 15.0, 45.0)), rod(4.0, 40.0, (-20.0, 0.0, 28.0), X))
    machine.add("Slider", block, product="Nut block")
    machine.fix("Base", "Bracket", "Screw1", "Screw2", "Nut1", "Nut2")
    path = tmp_path / "bracket.step"
    write_step(machine, path)
    scene = read(path, Report())
    found = analyse(with_found(scene, find_mates(scene, "Base"), Report()))
    index = {node.name: i for i, node in enumerate(scene.nodes)}
    bodies = {name: found.groups.group_of[index[name]] for name in (part.name for part in machine.parts)}
    assert len({bodies[name] for name in machine.fixed[0]}) == 1
    assert bodies["Slider"] not in (bodies["Bar"], bodies["Base"])


def test_a_contact_over_a_clearance_holds_where_it_was_drawn(tmp_path: Path):
    """A rod between two walls, 0.3 mm from either: no lower pair, so its contacts are stated one by one."""
    machine = Machine("Between", ground="Walls")
    machine.add(
        "Walls",
        cut(box((-40.0, -30.0, 0.0), (40.0, 30.0, 20.0)), box((-8.0, -25.0, -1.0), (8.0, 25.0, 21.0))),
    )
    machine.add("Rod", rod(7.7, 60.0, (0.0, 3.0, -20.0)))
    write_step(machine, tmp_path / "between.step")
    scene = read(tmp_path / "between.step", Report())
    mates = find_mates(scene, "Walls")
    assert [mate.joint for mate in mates.mates] == ["line"]
    found = analyse(with_found(scene, mates, Report()))
    assert not [d for d in found.report.diagnostics if d.code in ("CONSTRAINT_GAP", "CONSTRAINTS_CONTRADICT")]
    assert found.mobility == 4


def test_wheels_in_mesh_turn_as_their_teeth_do(tmp_path: Path):
    """20 teeth in 30 turn the other way by two thirds; a sun of 18 in a ring of 54 that stands still turns the carrier by a
    quarter (Willis), the same way."""
    for name, driver, follower, ratio in (
        ("gears", "GearA", "GearB", -20 / 30),
        ("planetary", "Sun", "Carrier", 18 / (18 + 54)),
    ):
        machine = written(name, Variant(), tmp_path / f"{name}.step")
        scene = read(tmp_path / f"{name}.step", Report())
        found = analyse(with_found(scene, find_mates(scene, machine.ground), Report()))
        names = [node.name.partition(":")[0] for node in found.source.nodes]
        a, b = names.index(driver), names.index(follower)
        hinge = next(
            j for j in found.joints if {j.a, j.b} & {a} and j.kind.value in ("revolute", "cylindrical")
        )
        drive = found.drive((hinge.id, RX))
        drive.to([0.3])
        axis = (found.source.pose(hinge.a) @ hinge.frame_a).rotation[:, 0]
        turns = (drive.poses()[i].rotation @ found.source.nodes[i].pose.rotation.T for i in (a, b))
        angles = [float(rotation_log(turn) @ axis) for turn in turns]
        assert abs(angles[0]) > 0.05 and angles[1] / angles[0] == pytest.approx(ratio)
