"""The count from a source's statements against the count from the joints that were written, on random mechanisms.

KINEFAB_MOBILITY_MECHANISMS sets another number of them.
"""

import json
import math
import os
import shutil
import subprocess

import kinefab
import numpy as np
import pytest
from apart_once import APART_ONCE, BODIES_APART_ONCE, FEWEST_ROWS_APART_ONCE
from golden import golden_pairs
from kinefab.analysis import analyse
from linkages import flat_ladder
from linkages import hinged as hinged_bars
from random_mechanisms import mechanism

TOOL = shutil.which("dotnet-kinefab")
MECHANISMS = int(os.environ.get("KINEFAB_MOBILITY_MECHANISMS", "60"))
needs_tool = pytest.mark.skipif(TOOL is None, reason="dotnet-kinefab is not on the PATH")


def counted(folder) -> list[dict]:
    """What ``dotnet kinefab mobility`` says of the scenes in a folder."""
    scenes = sorted(str(path) for path in folder.glob("*.kinefab"))
    done = subprocess.run([str(TOOL), "mobility", "--json", *scenes], capture_output=True, text=True)
    said = json.loads(done.stdout)
    return said if isinstance(said, list) else [said]


def differences(said: dict) -> list[str]:
    return [d["message"] for d in said["diagnostics"] if d["code"] == "MOBILITY_DIFFERS"]


@needs_tool
def test_both_count_the_same_in_random_mechanisms(tmp_path):
    """But where the export says that a coupling could not be kept: then the joints do not move as the source does."""
    lost = 0
    for seed in range(MECHANISMS):
        target = tmp_path / f"{seed:05d}.kinefab"
        done = kinefab.export(mechanism(seed), target)
        if any(d.code == "COUPLING_WITHOUT_JOINT" for d in done.report.diagnostics):
            lost += 1
            target.unlink()
    assert lost <= MECHANISMS / 100
    found = {said["file"]: differences(said) for said in counted(tmp_path)}
    assert len(found) == MECHANISMS - lost
    assert {file: said for file, said in found.items() if said} == {}


@needs_tool
def test_every_closure_moves_as_the_golden_scenes(tmp_path):
    """These are exported with the fewest rows; with all rows, as is usual, mobility, islands and what the bodies may do are the same."""
    golden, usual = tmp_path / "golden", tmp_path / "usual"
    golden.mkdir()
    usual.mkdir()
    for i, (source, scene) in enumerate(golden_pairs()):
        kinefab.export(source, usual / f"{i:02d}.kinefab", kinefab.ExportOptions(colliders="none", ground="world"))
        kinefab.export(scene, golden / f"{i:02d}.kinefab")
    pairs = list(zip(counted(golden), counted(usual), strict=True))
    assert len(pairs) == len(golden_pairs())
    for few, all_rows in pairs:
        mobilities = [
            (m["mobility"], m["firstOrderMobility"], sorted((i["mobility"], i["loops"]) for i in m["islands"]),
             sorted((b["translations"], b["rotations"]) for b in m["bodies"]))
            for m in (few["mobility"], all_rows["mobility"])
        ]  # fmt: skip
        assert mobilities[0] == mobilities[1], all_rows["file"]
        codes = [[d["code"] for d in said["diagnostics"]] for said in (few, all_rows)]
        assert codes[0] == codes[1], all_rows["file"]


@pytest.mark.parametrize("seed", APART_ONCE)
def test_both_count_what_was_counted_differently(tmp_path, seed):
    kinefab.export(mechanism(seed), tmp_path / "scene.kinefab")
    stated = json.loads((tmp_path / "scene.kinefab").read_text())["analysis"]
    assert (stated["mobility"], stated["idle"]) == APART_ONCE[seed]
    if TOOL is not None:
        assert differences(counted(tmp_path)[0]) == []


@pytest.mark.parametrize("seed", FEWEST_ROWS_APART_ONCE)
def test_both_count_the_same_where_the_fewest_rows_are_written(tmp_path, seed):
    kinefab.export(mechanism(seed), tmp_path / "scene.kinefab", kinefab.ExportOptions(closures="minimal"))
    stated = json.loads((tmp_path / "scene.kinefab").read_text())["analysis"]
    assert (stated["mobility"], stated["idle"]) == FEWEST_ROWS_APART_ONCE[seed]
    if TOOL is not None:
        assert differences(counted(tmp_path)[0]) == []


@pytest.mark.parametrize("seed", BODIES_APART_ONCE)
def test_both_count_what_a_body_can_do_though_it_is_little(tmp_path, seed):
    name, translations, rotations = BODIES_APART_ONCE[seed]
    kinefab.export(mechanism(seed), tmp_path / "scene.kinefab")
    scene = json.loads((tmp_path / "scene.kinefab").read_text())
    bodies = {scene["gameObjects"][b["gameObject"]]["name"]: b for b in scene["analysis"]["bodies"]}
    assert (bodies[name]["translations"], bodies[name]["rotations"]) == (translations, rotations)
    if TOOL is not None:
        assert differences(counted(tmp_path)[0]) == []


@needs_tool
@pytest.mark.parametrize("seed", [11397, 13811])
def test_a_motion_held_by_a_hair_is_told_as_unsure(tmp_path, seed):
    """By the letter nothing moves; rows that a CAD program solved may be as far off.  The languages weigh rows in other units."""
    kinefab.export(mechanism(seed), tmp_path / "scene.kinefab")
    (said,) = counted(tmp_path)
    assert {d["code"] for d in said["diagnostics"]} <= {"MOBILITY_UNSURE", "MOBILITY_FIRST_ORDER_DIFFERS"}
    assert "MOBILITY_UNSURE" in {d["code"] for d in said["diagnostics"]}


@pytest.mark.parametrize("turned", [1.0, -1.0])
def test_a_coupling_stays_where_another_joint_takes_the_place_of_its_own(tmp_path, turned):
    """Two hinges of one pair on one axis, of which the second, maybe turned round, is coupled."""
    scene = kinefab.Scene()
    scene.add_part("Base", grounded=True)
    wheels = [scene.add_part(name, mass=1.0, translation=(x, 0, 0)) for name, x in (("A", 0.0), ("B", 1.0))]
    scene.add_hinge(0, wheels[0], point=(0, 0, 0), axis=(0, 0, 1), name="First")
    second = scene.add_hinge(0, wheels[0], point=(0, 0, 0.3), axis=(0, 0, turned), name="Second")
    other = scene.add_hinge(0, wheels[1], point=(1, 0, 0), axis=(0, 0, 1), name="Other")
    scene.add_coupling(second, other, ratio=2.0)
    done = kinefab.export(scene, tmp_path / "scene.kinefab")
    assert "COUPLING_WITHOUT_JOINT" not in {d.code for d in done.report.diagnostics}
    (coupling,) = json.loads(done.path.read_text())["couplings"]
    assert coupling["ratio"] == pytest.approx(2.0 * turned)
    if TOOL is not None:
        (said,) = counted(tmp_path)
        assert (said["mobility"]["mobility"], differences(said)) == (1, [])


def test_what_turns_in_step_with_another_part_is_not_idle(tmp_path):
    """A rod between two balls spins by itself, unless something that cannot turn with it hangs on it."""
    for handle, idle in ((None, 1), ("ball on the rod's line", 1), ("hinge", 0)):
        scene = rod_between_balls(handle)
        assert sum(one.count for one in analyse(scene).idle) == idle, handle
        if TOOL is not None:
            kinefab.export(scene, tmp_path / "scene.kinefab")
            assert differences(counted(tmp_path)[0]) == [], handle


def rod_between_balls(handle: str | None) -> kinefab.Scene:
    """Of a four-bar linkage in space; a handle on the rod by a joint."""
    scene = kinefab.Scene()
    base, crank, rod, rocker = (
        scene.add_part(name, grounded=name == "Base", mass=None if name == "Base" else 1.0)
        for name in ("Base", "Crank", "Rod", "Rocker")
    )
    low, high = np.array([0.2, 0.3, 0.0]), np.array([1.1, 0.7, 0.4])
    scene.add_hinge(base, crank, point=(0, 0, 0), axis=(0, 0, 1))
    scene.add_ball(crank, rod, point=tuple(low))
    scene.add_ball(rod, rocker, point=tuple(high))
    scene.add_hinge(base, rocker, point=(1, 0, 0), axis=(0.1, 0.2, 1))
    if handle is not None:
        own = scene.add_part("Handle", mass=0.1)
        if handle == "hinge":
            scene.add_hinge(rod, own, point=(0.5, 0.6, 0.2), axis=(0, 1, 0))
        else:
            scene.add_ball(rod, own, point=tuple(0.5 * (low + high)))
    return scene


@pytest.mark.parametrize("lead", [0.1, 0.002])
def test_spins_that_differ_by_a_small_lead_are_two(tmp_path, lead):
    """Four parts on one axis in a ring of two cylindrical joints, a hinge and a screw: of the two in the middle each turns or screws
    by itself, and so does each with the last.  The lead of one beside the mechanism's size was taken for what may be wrong in a motion,
    and three were counted."""
    scene, axis = kinefab.Scene(), {"point": (0, 0, 0), "axis": (0, 0, 1)}
    base, first, second, last = (
        scene.add_part(name, grounded=name == "Base", mass=None if name == "Base" else 1.0, translation=(0, 0, z))
        for name, z in (("Base", 0.0), ("First", 1.0), ("Second", 2.0), ("Last", 3.0))
    )
    scene.add_joint("cylindrical", base, first, **axis)
    scene.add_joint("cylindrical", base, second, **axis)
    scene.add_hinge(first, last, point=(0, 0, 1), axis=(0, 0, 1))
    scene.add_joint("screw", second, last, lead=lead, **axis)
    found = analyse(scene)
    assert (found.mobility, [one.count for one in found.idle]) == (4, [1] * 4)
    if TOOL is not None:
        kinefab.export(scene, tmp_path / "scene.kinefab")
        assert differences(counted(tmp_path)[0]) == []


def hinged(noise: float, *hinges: tuple[int, int, tuple[float, float, float]]) -> kinefab.Scene:
    """Parts on the ground, part 0, and hinges (part, part, point) along z, points and axes off by about ``noise``."""
    draw = np.random.default_rng(4)
    scene = kinefab.Scene()
    scene.add_part("base", grounded=True)
    for i in range(max(b for _, b, _ in hinges)):
        scene.add_part(f"part{i}", mass=1.0, translation=(0.3 * i, 0.1, 0.2))
    for a, b, point in hinges:
        axis = np.array([0.0, 0.0, 1.0]) + noise * draw.standard_normal(3)
        scene.add_hinge(a, b, point=tuple(point + noise * draw.standard_normal(3)), axis=tuple(axis))
    return scene


def schmidt(noise: float) -> kinefab.Scene:
    """Three discs, one behind the other, each joined to the next by three links alike: shafts out of line that turn alike."""
    centers = np.array([[0.0, 0.0, 0.0], [0.05, 0.03, 0.1], [0.02, 0.06, 0.2]])
    hinges = [(0, 1, centers[0]), (0, 3, centers[2])]
    for k in range(2):
        for i in range(3):
            turn = 2 * np.pi * i / 3 + 0.3 * k
            at = 0.2 * np.array([np.cos(turn), np.sin(turn), 0.0])
            link = 4 + 3 * k + i
            hinges += [(k + 1, link, centers[k] + at), (k + 2, link, centers[k + 1] + at)]
    return hinged(noise, *hinges)


COAXIAL = [(0, 1, (0, 0, 0)), (1, 2, (0, 0, 0.4)), (0, 2, (0, 0, 1))]
FOUR_BAR = [(0, 1, (0, 0, 0)), (1, 2, (0.2, 0.5, 0)), (2, 3, (1.1, 0.7, 0)), (0, 3, (1, 0, 0))]


ARM = [(0, 1, (0, 0, 0)), (1, 2, (1, 0, 0)), (2, 3, (2, 0.3, 0))]


@pytest.mark.parametrize("noise", [0, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5])
@pytest.mark.parametrize(
    ("make", "mobility"),
    [
        (lambda n: hinged(n, *COAXIAL), 2),
        (lambda n: hinged(n, *FOUR_BAR), 1),
        (schmidt, 1),
        (lambda n: hinged(n, *ARM), 3),
    ],
    ids=["three hinges on one axis", "four-bar", "Schmidt coupling", "arm in a plane"],
)
def test_hinges_as_exact_as_a_cad_program_solves_them_move(tmp_path, make, mobility, noise):
    """Parallel axes that are off by a rounding, or by what a CAD program leaves, would lock the mechanism by the letter."""
    done = kinefab.export(make(noise), tmp_path / "scene.kinefab")
    assert json.loads(done.path.read_text())["analysis"]["mobility"] == mobility
    if TOOL is not None:
        (said,) = counted(tmp_path)
        assert (said["mobility"]["mobility"], differences(said)) == (mobility, [])


def spinning_legs() -> kinefab.Scene:
    """A platform on six legs, each a universal joint that turns about the leg first, a slide and a ball."""
    scene = kinefab.Scene()
    base = scene.add_part("Base", grounded=True)
    top = scene.add_part("Top", mass=3.0, translation=(0, 0.8, 0))
    for i in range(6):
        turn = np.radians(60 * (i // 2 * 2) + np.array([12 + 96 * (i % 2), 72 - 24 * (i % 2 == 0)]))
        radius, height = np.array([0.55, 0.35]), [0.02, 0.78]
        foot, head = np.stack([radius * np.cos(turn), height, radius * np.sin(turn)], axis=1)
        along = (head - foot) / np.linalg.norm(head - foot)
        across = np.cross(along, [0, 1, 0])
        across /= np.linalg.norm(across)
        low = scene.add_part(f"Cylinder{i}", mass=2.0, translation=tuple(foot + 0.2 * along))
        high = scene.add_part(f"Rod{i}", mass=1.0, translation=tuple(head - 0.2 * along))
        scene.add_joint("universal", base, low, point=tuple(foot), axis=tuple(across), secondary=tuple(along))
        scene.add_slider(low, high, point=tuple(foot), axis=tuple(along))
        scene.add_ball(high, top, point=tuple(head))
    return scene


def test_legs_that_spin_are_idle_though_the_pose_is_singular(tmp_path):
    """From here each leg turns about itself while all else stands still; elsewhere the platform's motions need these
    joints."""
    scene = spinning_legs()
    found = analyse(scene)
    idle = [([found.source.nodes[n].name for n in one.nodes], one.count) for one in found.idle]
    assert idle == [([f"Cylinder{i}", f"Rod{i}"], 1) for i in range(6)]
    if TOOL is not None:
        kinefab.export(scene, tmp_path / "scene.kinefab")
        assert differences(counted(tmp_path)[0]) == []


def test_rods_that_hold_a_platform_spin(tmp_path):
    """Six rods between balls: the platform stands still, and each rod spins by itself."""
    draw, scene = np.random.default_rng(3), kinefab.Scene()
    base = scene.add_part("Base", grounded=True)
    top = scene.add_part("Top", mass=3.0, translation=(0, 0.8, 0))
    for i in range(6):
        foot, head = draw.uniform(-1, 1, 3), draw.uniform(-0.5, 0.5, 3) + (0, 1.2, 0)
        rod = scene.add_part(f"Rod{i}", mass=1.0, translation=tuple(0.5 * (foot + head)))
        scene.add_ball(base, rod, point=tuple(foot))
        scene.add_ball(rod, top, point=tuple(head))
    found = analyse(scene)
    assert (found.mobility, [one.count for one in found.idle]) == (6, [1] * 6)
    if TOOL is not None:
        kinefab.export(scene, tmp_path / "scene.kinefab")
        assert differences(counted(tmp_path)[0]) == []


@needs_tool
@pytest.mark.parametrize(("rods", "loose"), [(4, 0), (8, 0), (10, 0), (16, 0), (40, 0), (60, 0), (30, 5)])
def test_a_flat_ladder_has_one_motion(tmp_path, rods, loose):
    """At its pose every rod but one has a velocity that goes nowhere, in parts of few freedoms and of many: of 40 rods C# counted
    two.  loose: see ``flat_ladder``."""
    kinefab.export(flat_ladder(rods, loose), tmp_path / "scene.kinefab")
    (said,) = counted(tmp_path)
    assert (said["mobility"]["mobility"], differences(said)) == (1 + max(0, loose - 2), [])


def test_a_flat_ladder_that_a_middle_bar_holds_moves(tmp_path):
    """Cells of cranks of one length, all flat, and a bar as long beside one: all turn alike.  Python's steps along mixtures, of which
    all but one direction are obstructed, led back to where they began, and none was counted."""
    rods, length = 9, np.array([0.5, 0.0, 0.0])
    feet = [np.array([x, 0.0, 0.0]) for x in (0.0, 0.7, 1.4, 2.1, 3.4, 4.1, 5.1, 6.1, 6.8, 7.8)]
    hinges = [(0, 1 + i, foot) for i, foot in enumerate(feet)]
    hinges += [(1 + i + end, 2 + rods + i, feet[i + end] + length) for i in range(rods) for end in (0, 1)]
    middle, foot = 2 + 2 * rods, np.array([5.664, 0.0, 0.0])
    hinges += [(0, middle, foot), (middle, 2 + rods + 6, foot + length)]
    names = ["base", *(f"crank{i}" for i in range(rods + 1)), *(f"rod{i}" for i in range(rods)), "middle"]
    scene = hinged_bars(names, hinges)
    found = analyse(scene)
    assert (found.first_order, found.mobility) == (10, 1)
    if TOOL is not None:
        kinefab.export(scene, tmp_path / "scene.kinefab")
        assert differences(counted(tmp_path)[0]) == []


@pytest.mark.parametrize("legs", [4, 6, 7])
def test_a_platform_moves_whose_leg_hangs_on_what_is_obstructed(tmp_path, legs):
    """A bar hinged to a bar, both flat between two fixed hinges, stands, though not to first order; a coupling of it holds one leg.  Steps
    beside it close no better than the root of rounding, by which second order left nothing of six legs: none of five was counted."""
    scene = kinefab.Scene()
    base = scene.add_part("Base", grounded=True)
    top = scene.add_part("Top", mass=3.0, translation=(0, 0, 1))
    slides = []
    for i in range(legs):
        turn = math.tau * i / legs
        foot = np.array([math.cos(turn), math.sin(turn), 0.0])
        head = np.array([0.5 * math.cos(turn + 0.4), 0.5 * math.sin(turn + 0.4), 1.0])
        along = (head - foot) / np.linalg.norm(head - foot)
        across = np.cross(along, [0, 0, 1])
        across /= np.linalg.norm(across)
        low, high = (
            scene.add_part(f"{name}{i}", mass=1.0, translation=tuple(at)) for name, at in (("Low", foot), ("High", head))
        )
        secondary = tuple(np.cross(across, along))
        scene.add_joint("universal", base, low, point=tuple(foot), axis=tuple(across), secondary=secondary)
        slides.append(scene.add_slider(low, high, point=tuple(foot), axis=tuple(along)))
        scene.add_ball(high, top, point=tuple(head))
    one, two = (scene.add_part(name, mass=1.0, translation=(2, 0, 0)) for name in ("One", "Two"))
    pins = [(base, one), (one, two), (base, two)]
    hinges = [scene.add_hinge(a, b, point=(2 + 0.5 * i, 0, 0), axis=(0, 0, 1)) for i, (a, b) in enumerate(pins)]
    scene.add_coupling(hinges[0], slides[0], ratio=0.01)
    found = analyse(scene)
    assert (found.first_order, found.mobility) == (6, 5)
    if TOOL is not None:
        kinefab.export(scene, tmp_path / "scene.kinefab")
        assert differences(counted(tmp_path)[0]) == []


@pytest.mark.parametrize("seed", [9, 19, 50, 92, 134])
def test_loops_that_no_joint_closes_tell_no_idle_freedoms(tmp_path, seed):
    """Where the fewest rows are written, a closing joint may hold nothing; the others are counted alike."""
    done = kinefab.export(mechanism(seed), tmp_path / "scene.kinefab", kinefab.ExportOptions(closures="minimal"))
    kinefab.export(done.path, tmp_path / "again.kinefab")  # a file that does not tell them is read too
    if TOOL is not None:
        assert differences(counted(tmp_path)[0]) == []


def test_a_coupling_that_counts_from_inside_of_one_body_ties_that_body_to_nothing():
    """A slide that a hinge across locks: the coupling from it locks a cylindrical joint's slide, and what hangs on that is a
    chain's end, not idle."""
    scene = kinefab.Scene()
    base, arm, tool, inner = (
        scene.add_part(name, grounded=name == "Base", mass=None if name == "Base" else 1.0)
        for name in ("Base", "Arm", "Tool", "Inner")
    )
    first = scene.add_joint("cylindrical", base, arm, point=(0, 0, 0), axis=(0, 0, 1))
    scene.add_joint("cylindrical", arm, tool, point=(0, 0, 1), axis=(0, 0, 1))
    held = scene.add_slider(base, inner, point=(0, 1, 0), axis=(0, 0, 1))
    scene.add_hinge(base, inner, point=(0, 1, 0), axis=(1, 0, 0))
    scene.add_coupling((first, "tx"), held, ratio=2.0)
    found = analyse(scene)
    assert (found.mobility, found.idle) == (3, [])
