"""Motion in Python: against closed forms, against the C# sweep, and what is said where a motion ends."""

from __future__ import annotations

import importlib.util
import json
import math
import runpy
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import kinefab
import numpy as np
import pytest
from kinefab.model import Constraint, ConstraintKind, Feature, FeatureKind, JointKind
from kinefab.spatial import matrix_from_quaternion, quaternions_from_matrices, rotation_about
from kinefab.unity import frames
from kinefab.unity.mapping import GROUND_ID
from linkages import five_bar, ring
from mechanism_cases import scene, table

ROOT = Path(__file__).parents[2]
LEVER = ROOT / "fixtures" / "lever" / "lever.bundle.json"
TOOL = shutil.which("dotnet-kinefab")


@pytest.fixture(scope="module")
def lever():
    return kinefab.motion(LEVER)


def slider(degrees):
    q = np.radians(degrees)
    return 0.025 * np.cos(q) + np.sqrt(0.09**2 - (0.025 * np.sin(q)) ** 2)


def bar_angle(degrees):
    return -np.arcsin(0.025 * np.sin(np.radians(degrees)) / 0.09)


def in_plane(poses):
    """Angles of parts' x axes about the world's z, radians; poses: (frames, 7)."""
    return np.array([math.atan2(*matrix_from_quaternion(p[3:])[1::-1, 0]) for p in poses])


def closed_form(id, quantity):
    return {
        float(r["driver"]): float(r["value"])
        for r in table("closed_forms")
        if (r["id"], r["quantity"]) == (id, quantity)
    }


def test_lever_has_one_freedom_named_as_in_cad(lever):
    (freedom,) = lever.freedoms
    assert (freedom.name, freedom.joint, freedom.unit) == ("Shaft", "Joint:Shaft", "deg")
    assert freedom.value == pytest.approx(30.0, abs=1e-8) and math.isinf(freedom.upper)
    slide = next(c for c in lever.coordinates if c.name == "Slide")
    assert (slide.unit, slide.lower, slide.upper) == ("m", pytest.approx(0.065), pytest.approx(0.115))


def test_lever_over_two_turns_is_its_closed_form(lever):
    """All frames, all parts, both ways round; angles go on past a turn."""
    for start, stop in ((0.0, 720.0), (30.0, -330.0)):
        motion = lever.sweep("Shaft", start, stop, frames=101)
        assert motion.stop is None and motion.poses.shape == (101, 8, 7) and motion.gap < 1e-10
        assert np.abs(motion["Shaft"] - np.linspace(start, stop, 101)).max() < 1e-8
        assert np.abs(motion["Slide"] - slider(motion["Shaft"])).max() < 1e-9
        place = motion["Lever/SliderD:1"][:, 0]  # CAD's X is the scene's, Z up turned to Y up
        assert np.abs(place - slider(motion["Shaft"])).max() < 1e-9
        pin = np.diff(motion["Eccentric pin"])
        assert np.abs(pin - np.diff(np.degrees(bar_angle(motion["Shaft"])) - motion["Shaft"])).max() < 1e-7


def test_frames_asked_for_at_random_are_the_sweep_s(lever):
    """A path of any values is walked frame by frame, a sweep in one go: the same poses."""
    angles = 30.0 + 100.0 * np.sin(np.linspace(0.0, 7.0, 60))
    motion = lever.follow({"Shaft": angles})
    assert np.abs(motion["Slide"] - slider(angles)).max() < 1e-9


CASES = [
    ("M01", "base - crank", 60.0, "rocker", "rocker angle deg", in_plane),
    ("M01", "base - crank", 60.0, "coupler", "coupler angle deg", in_plane),
    ("M02", "base - crank", 60.0, "rocker", "rocker angle deg", in_plane),
    ("M07", "base - crank", 40.0, "slider", "slider x", lambda p: p[:, 0]),
    ("M08", "base - crank", 40.0, "slider", "slider x", lambda p: p[:, 0]),
    ("M10", "base - crank", 40.0, "yoke", "yoke x", lambda p: p[:, 0]),
    ("M23", "base - in", 25.0, "disc", "disc centre x = e cos^2", lambda p: p[:, 0]),
    ("M26", "base - pinion", 0.0, "rack", "rack x = rp*theta", lambda p: p[:, 0]),
    ("M25", "base - g1", 0.0, "g2", "driven gear deg (20:50)", in_plane),
]


@pytest.mark.parametrize(("id", "joint", "start", "part", "quantity", "measure"), CASES)
def test_motion_is_that_of_the_closed_form(id, joint, start, part, quantity, measure):
    """The drivers' values of the table, one sweep through each, within 1e-9."""
    mechanism = kinefab.motion(scene(id))
    for driver, value in closed_form(id, quantity).items():
        motion = mechanism.sweep(joint, 0.0, driver - start, frames=9)
        found = measure(motion[part])[-1]
        off = math.remainder(found - math.radians(value), math.tau) if "deg" in quantity else found - value
        assert motion.stop is None and motion.gap < 1e-10
        assert abs(off) < 1e-9


def test_couplings_are_obeyed_at_every_frame():
    """A planetary: the planet turns on its carrier by -60/18 of the carrier's turn, the sun by 84/24 in the world."""
    motion = kinefab.motion(scene("M27")).sweep("base - carrier", 0.0, 360.0, frames=41)
    assert np.abs(motion["carrier - planet"] + 60 / 18 * motion["base - carrier"]).max() < 1e-7
    sun = np.unwrap(in_plane(motion["sun"]))
    assert np.abs(np.degrees(sun) - 84 / 24 * motion["base - carrier"]).max() < 1e-7


def test_a_crank_that_cannot_go_round_stops_at_its_dead_point():
    """M03 is a triple rocker: its crank goes to +-94.0960437582 degrees."""
    mechanism = kinefab.motion(scene("M03"))
    limit = closed_form("M03", "crank limit +- deg")[0.0]
    start = math.degrees(in_plane(mechanism.sweep("base - crank", 0.0, 0.0, frames=2)["crank"])[0])
    motion = mechanism.sweep("base - crank", 0.0, 180.0, frames=181)
    assert motion.stop.reason == "dead point" and motion.stop.frames == len(motion)
    assert math.radians(abs(motion.stop.value + start - limit)) < 1e-8
    assert motion["base - crank"][-1] <= motion.stop.value < motion["base - crank"][-1] + 1.0
    assert "dead point at" in str(motion.stop)


def four_bar(crank, coupler, rocker, ground, degrees):
    """Lying in x and y, the crank at this angle; of the two ways to close it, the one above."""
    angle = math.radians(degrees)
    tip = crank * np.array([math.cos(angle), math.sin(angle)])
    across = np.array([ground, 0.0]) - tip
    far = float(np.linalg.norm(across))
    along = (coupler**2 - rocker**2 + far**2) / (2.0 * far)
    up = math.sqrt(coupler**2 - along**2) * np.array([-across[1], across[0]]) / far
    pins = [np.zeros(2), tip, tip + along * across / far + up, np.array([ground, 0.0])]
    return ring([np.array([*pin, 0.0]) for pin in pins], ["base", "crank", "coupler", "rocker"])


BRANCHING = [  # crank, coupler, rocker, ground; at which angles of the crank all of it lies in one line
    ((0.1, 0.25, 0.1, 0.25), [180.0, 360.0]),  # a parallelogram
    ((0.1, 0.1, 0.25, 0.25), [180.0, 360.0]),  # a kite, crank and coupler alike
    ((0.1, 0.25, 0.25, 0.1), [360.0]),  # a kite, crank and ground alike
    ((0.1, 0.25, 0.18, 0.22), []),  # Grashof's: never flat
    ((0.1, 0.25, 0.1001, 0.25), []),  # nearly a parallelogram
]


@pytest.mark.parametrize(("lengths", "flat"), BRANCHING)
def test_where_a_linkage_lies_flat_another_motion_branches_off(lengths, flat):
    """All the way round, straight and frame by frame, and both ways; never where it does not lie flat."""
    mechanism = kinefab.motion(four_bar(*lengths, 57.0))
    name = mechanism.freedoms[0].name
    turn = mechanism.coordinate(name).value - 57.0  # from the crank's angle to the hinge's
    for path in (np.linspace(57.0, 417.0, 101), 57.0 + 360.0 * np.linspace(0.0, 1.0, 40) ** 1.1):
        motion = mechanism.follow({name: path + turn})
        assert [b.value - turn for b in motion.branchings] == pytest.approx(flat, abs=1e-3)
        assert all(path[b.frames - 1] < b.value - turn + 1e-3 for b in motion.branchings)
    back = mechanism.sweep(name, 57.0 + turn, -10.0 + turn, frames=30)
    assert [b.value - turn for b in back.branchings] == pytest.approx([0.0] * bool(flat), abs=1e-3)
    assert all(f"another motion branches off where {name} is at" in str(b) for b in back.branchings)


def test_a_dead_point_is_no_branching():
    """Neither where a motion ends at it nor where it passes one of what is not driven: a slider-crank's both ends."""
    motion = kinefab.motion(scene("M07")).sweep("base - crank", 0.0, 360.0, frames=50)
    assert motion.stop is None and motion.branchings == ()
    slid = kinefab.motion(scene("M07"))
    slide = next(c.name for c in slid.coordinates if c.unit == "m")
    for end in (-10.0, 10.0):
        ended = slid.sweep(slide, slid.coordinate(slide).value, end, frames=50)
        assert ended.stop.reason == "dead point" and ended.branchings == ()


def lid(limits=(-10.0, 80.0)):
    built = kinefab.Scene()
    box = built.add_part("Box", grounded=True)
    door = built.add_part("Lid", translation=(0, 0.2, 0))
    built.add_hinge(box, door, point=(0, 0.2, -0.15), axis=(-1, 0, 0), limits=limits, name="Hinge")
    return built


def test_a_motion_ends_at_a_limit_and_says_whose():
    mechanism = kinefab.motion(lid())
    motion = mechanism.sweep("Hinge", -20.0, 120.0, frames=15)
    assert (
        len(motion) == 0
        and motion.stop.reason == "limit"
        and motion.stop.value == pytest.approx(-10.0, abs=1e-9)
    )
    motion = mechanism.sweep("Hinge", 0.0, 120.0, frames=13)
    assert motion["Hinge"].tolist() == pytest.approx([10.0 * i for i in range(9)], abs=1e-9)
    assert (motion.stop.coordinate, motion.stop.value) == ("Hinge", pytest.approx(80.0, abs=1e-9))
    whole = mechanism.sweep("Hinge")
    assert whole["Hinge"][[0, -1]].tolist() == pytest.approx([-10.0, 80.0], abs=1e-9) and whole.stop is None


def test_another_joint_s_limit_ends_the_motion():
    """The slider may go to 95 mm only: the crank stops where the closed form puts it."""
    built = kinefab.Scene()
    base = built.add_part("Base", grounded=True)
    crank = built.add_part("Crank")
    rod = built.add_part("Rod", translation=(0.025, 0, 0))
    block = built.add_part("Block", translation=(0.115, 0, 0))
    built.add_hinge(base, crank, point=(0, 0, 0), axis=(0, 0, 1), name="Crank")
    built.add_hinge(crank, rod, point=(0.025, 0, 0), axis=(0, 0, 1), name="Pin")
    built.add_hinge(rod, block, point=(0.115, 0, 0), axis=(0, 0, 1), name="Gudgeon")
    built.add_slider(base, block, point=(0, 0, 0), axis=(1, 0, 0), limits=(-0.02, 0.01), name="Slide")
    motion = kinefab.motion(built).sweep("Crank", 1.0, 180.0)
    assert (motion.stop.reason, motion.stop.coordinate) == ("limit", "Slide")
    assert motion.stop.value == pytest.approx(-0.02, abs=1e-10)
    assert np.abs(motion["Slide"] + 0.115 - slider(motion["Crank"])).max() < 1e-9
    assert slider(motion["Crank"][-1]) >= 0.095 > slider(motion["Crank"][-1] + 179.0 / 99.0)


def test_two_freedoms_at_once():
    """A five-bar: two cranks, each driven; the elbow is where two circles meet."""
    from linkages import elbow, tip, tip_2

    one, two = math.radians(60.0), math.radians(120.0)
    mechanism = kinefab.motion(five_bar(one, two))
    assert len(mechanism.freedoms) == mechanism.mobility == 2
    turn = np.linspace(0.0, 30.0, 21)
    motion = mechanism.follow({"base - crank": turn, "base - crank2": 0.5 * turn * 0.9})
    sign = [math.copysign(1.0, np.unwrap(in_plane(motion[name]))[-1]) for name in ("crank", "crank2")]
    for i in (5, 20):
        a = tip(one + sign[0] * math.radians(turn[i]))
        b = tip_2(two + sign[1] * math.radians(0.45 * turn[i]))
        start = elbow(tip(one), tip_2(two), 1.0)
        pose = motion["rod"][i]
        found = matrix_from_quaternion(pose[3:]) @ start + pose[:3]
        assert np.abs(found - elbow(a, b, 1.0)).max() < 1e-9
    alone = mechanism.sweep("base - crank", 0.0, 30.0, frames=3)
    assert np.abs(alone["base - crank2"]).max() < 1e-9


def test_two_axes_of_a_universal_are_the_angles_of_its_rings():
    """X fixed in b, Z fixed in a: R = Rz Rx, exactly, far from the start."""
    built = kinefab.Scene()
    base = built.add_part("Base", grounded=True)
    shaft = built.add_part("Shaft")
    built.add_joint(
        JointKind.UNIVERSAL, base, shaft, point=(0, 0, 0), axis=(1, 0, 0), secondary=(0, 0, 1), name="U"
    )
    motion = kinefab.motion(built).follow({"U.rx": [0.0, 20.0, 70.0], "U.rz": [0.0, -30.0, 110.0]})
    x, y, z = np.eye(3)
    expected = rotation_about(z, math.radians(110.0)) @ rotation_about(x, math.radians(70.0))
    assert np.abs(matrix_from_quaternion(motion["Shaft"][2, 3:]) - expected).max() < 1e-9


def test_coordinates_that_move_each_other_are_refused_together(lever):
    with pytest.raises(ValueError, match="move together"):
        lever.follow({"Shaft": [30.0, 40.0], "Slide": [0.1, 0.1]})


@pytest.mark.parametrize(
    ("values", "says"),
    [
        ({"Nothing": [1.0]}, "no coordinate 'Nothing'"),
        ({"Shaft": [math.nan]}, "finite"),
        ({"Shaft": []}, "finite"),
        ({"Shaft": 3.0}, "finite"),
        ({}, "at least"),
    ],
)
def test_wrong_calls_say_what_to_pass(lever, values, says):
    with pytest.raises(ValueError, match=says):
        lever.follow(values)


def test_a_joint_stands_for_its_coordinate():
    """As the builder returns it; two of one name are told apart by it."""
    scene = kinefab.Scene()
    doors = [scene.add_part(f"Door{i}", translation=(i, 1, 0)) for i in range(2)]
    hinges = [
        scene.add_hinge(None, d, point=(0, 1, 0), axis=(0, 1, 0), limits=(-10, 80), name="Hinge")
        for d in doors
    ]
    motion = kinefab.motion(scene)
    assert motion.coordinate(hinges[1]).joint == hinges[1].id != hinges[0].id
    moved = motion.sweep(hinges[1], 0, 70, frames=2)
    assert moved[motion.coordinate(hinges[1]).name].tolist() == pytest.approx([0.0, 70.0])
    with pytest.raises(ValueError, match="there is no coordinate 'Elsewhere'"):
        motion.sweep(replace(hinges[0], id="Elsewhere"))


@pytest.mark.parametrize(
    ("asked", "error"),
    [
        ({"start": "0", "stop": 90}, TypeError),
        ({"stop": 90, "frames": 2.5}, TypeError),
        ({"stop": 90, "frames": 10**9}, ValueError),
        ({"stop": 90, "frames": 1}, ValueError),
    ],
)
def test_a_sweep_takes_numbers_in_bounds(lever, asked, error):
    """Words, halves of frames and more frames than a memory holds are refused at once."""
    with pytest.raises(error):
        lever.sweep(lever.coordinates[0].name, **asked)


def test_parts_that_constraints_fix_move_together_beside_a_rod():
    """P30, a rod for which a body stands, with a part locked to the one that it holds and one that is stated to stand
    on the ground: the mechanism of the joints keeps both."""
    source = scene("P30")
    nodes = [*source.nodes, *(replace(source.nodes[1], id=name, name=name) for name in ("C", "D"))]
    at = np.zeros(3)
    constraints = [
        *source.constraints,
        Constraint(
            "lock",
            ConstraintKind.LOCK,
            (Feature(1, FeatureKind.POINT, at), Feature(2, FeatureKind.POINT, at)),
        ),
        Constraint("ground", ConstraintKind.GROUND, (Feature(3, FeatureKind.BODY, at),)),
    ]
    mechanism = kinefab.motion(replace(source, nodes=nodes, constraints=constraints))
    assert mechanism.mobility == 5
    moved = mechanism.sweep(mechanism.coordinates[0].name, 0, 30, frames=3)
    assert np.abs(moved["B"][-1] - moved["B"][0]).max() > 0.01
    assert np.allclose(moved["B"], moved["C"]) and np.allclose(moved["D"], moved["D"][0])


def test_a_slide_without_limits_needs_an_end():
    built = kinefab.Scene()
    block = built.add_part("Block")
    built.add_slider(None, block, point=(0, 0, 0), axis=(0, 0, 1), name="Slide")
    mechanism = kinefab.motion(built)
    with pytest.raises(ValueError, match="say how far"):
        mechanism.sweep("Slide")
    assert mechanism.sweep("Slide", 0.0, -0.25, frames=2)["Block"][1, 2] == pytest.approx(-0.25, abs=1e-12)


def test_quaternions_of_many_matrices_turn_as_they_do():
    draw = np.random.default_rng(4)
    axes = draw.standard_normal((40, 3))
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    angles = np.concatenate([draw.uniform(-math.pi, math.pi, 36), [0.0, math.pi, -math.pi, math.pi]])
    turns = np.array([rotation_about(axis, angle) for axis, angle in zip(axes, angles)])
    found = quaternions_from_matrices(turns.reshape(4, 10, 3, 3)).reshape(40, 4)
    assert (found[:, 3] >= 0.0).all()
    for q, turn in zip(found, turns):
        assert np.abs(matrix_from_quaternion(q) - turn).max() < 1e-14


@pytest.mark.parametrize(
    "id", ["M01", "M09", "M11", "M14", "M18", "M24", "M27", "M30", "M36", "M41", "M43", "M48"]
)
def test_a_written_scene_moves_as_its_source(id):
    """The golden scene, read back through the mirror, against the bundle it was exported from: one of its freedoms, set by
    the position of the part that it moves, puts all parts where the bundle's motion has them."""
    path = ROOT / "fixtures" / "mechanisms" / f"{id}.kinefab"
    source, written = kinefab.motion(scene(id)), kinefab.motion(path)
    assert written.mobility == source.mobility
    name = source.freedoms[0].name
    step = 20.0 if source.freedoms[0].unit == "deg" else 0.03
    goal = source.sweep(name, source.freedoms[0].value, source.freedoms[0].value + step, frames=4)
    assert goal.stop is None
    best = np.inf
    for freedom in written.freedoms:
        for sign in (1.0, -1.0):
            found = written.sweep(freedom.name, freedom.value, freedom.value + sign * step, frames=4)
            if found.stop is None and freedom.unit == source.freedoms[0].unit:
                parts = [part for part in written.parts if part in source.parts]
                off = max(np.abs(found.part(p)[:, :3] - goal.part(p)[:, :3]).max() for p in parts)
                best = min(best, off)
    assert best < 1e-9


def hinge_on_ground(path, part):
    """How ``sweep`` is told a part's hinge to the world: by its component, as an object may carry several joints."""
    objects = json.loads(path.read_text("utf-8"))["gameObjects"]
    ground = next(i for i, o in enumerate(objects) if o["id"] == GROUND_ID)
    components = next(o["components"] for o in objects if o["id"] == part)
    hinges = [i for i, c in enumerate(components) if c["type"] == "HingeJoint"]
    return f"{part}[{next(i for i in hinges if components[i].get('connectedBody') == ground)}]"


@pytest.mark.skipif(TOOL is None, reason="dotnet-kinefab is not on the PATH")
def test_motion_is_that_of_the_c_sharp_sweep(tmp_path):
    """The exported scene, swept by the other program from its own joints: every body within 1e-9."""
    sources = [
        (LEVER, "Lever/Crank:1", "Shaft"),
        (ROOT / "fixtures/mechanisms/M01.bundle.json", "crank", "base - crank"),
        (ROOT / "fixtures/mechanisms/M27.bundle.json", "carrier", "base - carrier"),
        (ROOT / "fixtures/mechanisms/M46.bundle.json", "crank", "base - crank"),
    ]
    for source, part, name in sources:
        kinefab.export(source, tmp_path / "scene.kinefab")
        joint = hinge_on_ground(tmp_path / "scene.kinefab", part)
        command = [
            TOOL,
            "sweep",
            "scene.kinefab",
            "--joint",
            joint,
            "--from",
            "-20",
            "--to",
            "25",
            "--steps",
            "9",
        ]
        subprocess.run([*command, "-o", "swept.json"], cwd=tmp_path, check=True, capture_output=True)
        swept = json.loads((tmp_path / "swept.json").read_text("utf-8"))
        mechanism = kinefab.motion(source)
        zero = next(c.value for c in mechanism.coordinates if c.name == name)
        motion = mechanism.sweep(name, zero - 20.0, zero + 25.0, frames=10)
        assert len(swept["bodies"]) > 1 and len(motion) == 10
        for body in (b for b in swept["bodies"] if b["id"] != GROUND_ID):
            theirs, own = np.array(body["poses"]), motion[body["id"]]
            assert np.abs(frames.point(own[:, :3]) - theirs[:, :3]).max() < 1e-9
            turned = frames.quaternion(own[:, 3:])
            assert (np.abs(np.sum(turned * theirs[:, 3:], axis=1)) > 1.0 - 1e-12).all()


@pytest.mark.skipif(
    importlib.util.find_spec("matplotlib") is None, reason="no matplotlib: the example that plots is not run"
)
def test_the_example_plots_the_slider_s_stroke(tmp_path, monkeypatch):
    monkeypatch.setenv("MPLBACKEND", "Agg")
    monkeypatch.setenv("MPLCONFIGDIR", str(tmp_path))
    monkeypatch.chdir(ROOT)
    monkeypatch.setattr(sys, "argv", ["slider_stroke.py", str(tmp_path / "stroke.png")])
    drawn = runpy.run_path(str(ROOT / "python" / "examples" / "slider_stroke.py"))
    assert (tmp_path / "stroke.png").stat().st_size > 5_000
    ((line,),) = [[axes.lines[0] for axes in drawn["plt"].gcf().axes]]
    assert np.ptp(line.get_ydata()) == pytest.approx(50.0, abs=0.05)  # mm: twice the eccentricity
    drawn["plt"].close("all")
