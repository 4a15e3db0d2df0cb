"""The axes that a script names are those that turn, slide and stand normal; a coordinate is called what its source calls it."""

from __future__ import annotations

import json
import math
import re

import kinefab
import numpy as np
import pytest
from kinefab.analysis import analyse
from kinefab.spatial import matrix_from_quaternion, rotation_about
from scenes import BOX

AXIS, SECOND = np.array([2.0, -1.0, 2.0]) / 3.0, np.array([2.0, 2.0, -1.0]) / 3.0
POINT = np.array([0.3, -0.2, 0.7])


def pair(kind: str, **options) -> kinefab.Mechanism:
    scene = kinefab.Scene()
    turn = ("XYZ", (20, -50, 70))
    base = scene.add_part("Base", BOX, translation=(0.4, 0.1, -0.3), rotation=turn, grounded=True)
    arm = scene.add_part("Arm", BOX, translation=(-0.2, 0.6, 0.1), rotation=("XYZ", (-35, 15, 5)))
    scene.add_joint(kind, base, arm, point=POINT, name="J", **options)
    return kinefab.motion(scene)


def moved(mechanism: kinefab.Mechanism, **values: float) -> tuple[np.ndarray, np.ndarray]:
    """How the arm turns, and where a point of it at POINT goes, from the pose it was built at."""
    way = mechanism.follow({f"J.{name}": [0.0, value] for name, value in values.items()})["Arm"]
    start, end = (matrix_from_quaternion(pose[3:]) for pose in way)
    turn = end @ start.T
    return turn, turn @ (POINT - way[0, :3]) + way[1, :3] - POINT


@pytest.mark.parametrize("rx, rz", [(70.0, 0.0), (0.0, -35.0), (70.0, -35.0)])
def test_a_universal_joint_turns_about_the_two_axes_it_is_given(rx, rz):
    """The first is carried by b, the second by a; the one across both does not turn."""
    mechanism = pair("universal", axis=3.0 * AXIS, secondary=0.5 * SECOND)
    turn, shift = moved(mechanism, rx=rx, rz=rz)
    expected = rotation_about(SECOND, math.radians(rz)) @ rotation_about(AXIS, math.radians(rx))
    assert np.abs(turn - expected).max() < 1e-9 and np.abs(shift).max() < 1e-9


def test_perpendicular_lines_turn_about_themselves():
    turn, _ = moved(pair("perpendicular", axis=AXIS, secondary=SECOND), rx=25.0, rz=-60.0)
    expected = rotation_about(SECOND, math.radians(-60.0)) @ rotation_about(AXIS, math.radians(25.0))
    assert np.abs(turn - expected).max() < 1e-9


def test_a_point_stays_in_the_plane_whose_normal_is_the_axis():
    _, shift = moved(pair("point_on_plane", axis=AXIS, secondary=SECOND), tx=0.3, ty=-0.1)
    assert shift == pytest.approx(0.3 * SECOND - 0.1 * np.cross(AXIS, SECOND), abs=1e-9)


def test_a_line_in_a_plane_is_the_axis_and_the_normal_the_secondary():
    turn, shift = moved(pair("line_in_plane", axis=AXIS, secondary=SECOND), tx=0.2, rz=30.0)
    assert abs(shift @ SECOND) < 1e-9 and abs((turn @ AXIS) @ SECOND) < 1e-9
    assert shift @ AXIS == pytest.approx(0.2)


def test_a_pin_slides_along_the_slot_it_is_given():
    turn, shift = moved(pair("pin_slot", axis=AXIS, secondary=SECOND), ty=0.05, rx=-10.0)
    assert shift == pytest.approx(0.05 * SECOND, abs=1e-9)
    assert np.abs(turn - rotation_about(AXIS, math.radians(-10.0))).max() < 1e-9


@pytest.mark.parametrize("kind", ["universal", "perpendicular", "line_in_plane", "pin_slot"])
def test_two_axes_that_have_to_be_square_are_checked(kind):
    """The nearest square direction would turn, which nobody named.  What digits are rounded to is let pass."""
    scene = kinefab.Scene()
    part = scene.add_part("Part")
    with pytest.raises(ValueError, match="axis and secondary stand at 78.69 degrees, and .* square") as raised:
        scene.add_joint(kind, None, part, point=POINT, axis=(1, 0, 0), secondary=(0.2, 1, 0))
    assert "on a" in str(raised.value) and scene.joints == []
    scene.add_joint(kind, None, part, point=POINT, axis=(1, 0, 0), secondary=(0.00003, 1, 0))


def test_a_leg_hung_on_the_axes_of_its_cross_does_not_spin():
    """A platform on six legs, each foot a cross whose two axes are square to the leg: six freedoms, all of the platform."""
    scene = kinefab.Scene()
    base = scene.add_part("Base", grounded=True)
    top = scene.add_part("Top", translation=(0, 0.6, 0))
    for i in range(6):
        side = 1 if i % 2 else -1
        foot, tip = (
            np.array([radius * np.cos(angle), height, radius * np.sin(angle)])
            for radius, angle, height in (
                (0.45, np.radians(60 * i + 10 * side), 0.05),
                (0.25, np.radians(60 * i - 20 * side), 0.55),
            )
        )
        lower, upper = scene.add_part(f"Lower{i}"), scene.add_part(f"Upper{i}")
        first = np.cross((0.2, 1.0, 0.1), tip - foot)
        second = np.cross(first, tip - foot)
        scene.add_joint("universal", base, lower, point=foot, axis=first, secondary=second)
        scene.add_slider(lower, upper, point=0.5 * (foot + tip), axis=tip - foot)
        scene.add_ball(upper, top, point=tip)
    found = analyse(scene)
    assert found.mobility == 6
    of_top = next(f for f in found.freedoms if f.node == top)
    assert (len(of_top.translations), len(of_top.rotations)) == (3, 3)


def test_coordinates_are_called_what_their_source_calls_them(tmp_path):
    """A bundle's cylinder slides along tz and turns by rz; a freedom with a name of its own is driven by that."""
    frame = {"in": "world", "o": [0, 0, 0], "z": [0, 1, 0], "x": [1, 0, 0]}
    still = {"o": [0, 0, 0], "x": [1, 0, 0], "y": [0, 1, 0], "z": [0, 0, 1]}
    bundle = {
        "meta": {
            "format": "kinefab.bundle",
            "version": "1.0",
            "units": {"length": "mm", "angle": "deg"},
            "up": "Z",
        },
        "components": [
            {"id": "Base", "kind": "part", "pose": still, "grounded": True},
            {"id": "Rod", "kind": "part", "pose": still},
        ],
        "joints": [{"id": "Sleeve", "type": "cylindrical", "a": "Base", "b": "Rod", "frameA": frame}],
    }
    path = tmp_path / "rod.bundle.json"
    path.write_text(json.dumps(bundle), "utf-8")
    mechanism = kinefab.motion(path)
    assert [c.name for c in mechanism.coordinates] == ["Sleeve.tz", "Sleeve.rz"]
    with pytest.raises(ValueError, match="no coordinate 'Sleeve.tx'; the mechanism has Sleeve.tz, Sleeve.rz"):
        mechanism.sweep("Sleeve.tx", 0, 0.1)
    scene = kinefab.Scene()
    named = {
        f: kinefab.Freedom(kinefab.Motion.FREE, name=name) for f, name in (("rx", "roll"), ("rz", "yaw"))
    }
    arm = scene.add_part("Arm")
    scene.add_joint("universal", None, arm, point=POINT, axis=AXIS, secondary=SECOND, **named)
    assert [c.name for c in kinefab.motion(scene).coordinates] == ["roll", "yaw"]


def test_the_page_calls_sliders_by_what_they_do(tmp_path):
    """Not by letters of a frame that nobody sees, where words tell them apart."""
    scene = kinefab.Scene()
    base, fork, rod, table = (scene.add_part(name, BOX) for name in ("Base", "Fork", "Rod", "Table"))
    scene.add_hinge(None, base, point=POINT, axis=SECOND, name="Stand")
    scene.add_joint("universal", base, fork, point=POINT, axis=AXIS, secondary=SECOND, name="Cross")
    scene.add_joint("cylindrical", fork, rod, point=POINT, axis=AXIS, name="Sleeve")
    scene.add_joint("planar", base, table, point=POINT, axis=AXIS, name="Bench")
    kinefab.export(scene, tmp_path / "cross.kinefab")
    text = kinefab.view(tmp_path / "cross.kinefab", tmp_path / "cross.html").read_text("utf-8")
    data = json.loads(
        re.search(r'<script id="data" type="application/json">(.*?)</script>', text, re.DOTALL)[1]
    )
    said = {name: c["label"].rpartition(", ")[2] for name, c in data["coordinates"].items()}
    assert said == {
        "Stand": "Stand: Base – Ground",
        "Cross.rx": "turn about Fork's axis",
        "Cross.rz": "turn about Base's axis",
        "Sleeve.tx": "slide",
        "Sleeve.rx": "turn",
        "Bench.ty": "slide Y",
        "Bench.tz": "slide Z",
        "Bench.rx": "turn",
    }
