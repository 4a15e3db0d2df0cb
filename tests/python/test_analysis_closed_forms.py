"""Mechanisms driven through the angles whose positions are known in closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest
from kinefab.analysis.equations.system import State
from kinefab.analysis.freedom.first_order import block_freedoms
from kinefab.model import RX, TX, JointKind
from mechanism_cases import analysed, node, table

TOLERANCE = 1e-9


def joint(found, a, b):
    """The joint between two parts, whichever way round."""
    names = {f"{a} - {b}", f"{b} - {a}"}
    return next(j for j in found.joints if j.id in names)


def turned(pose):
    """Angle of a part's x axis in the plane, degrees."""
    return math.degrees(math.atan2(pose.rotation[1, 0], pose.rotation[0, 0]))


def planar(id, part, start, measures):
    """A crank on the base: (case, joint's part, freedom, start value, name to measure)."""
    return id, part, RX, start, measures


def link_angle(name):
    return lambda found, poses: turned(poses[node(found.source, name)])


def place(name, axis):
    return lambda found, poses: float(poses[node(found.source, name)].translation[axis])


DRIVEN = {
    "M01": (
        "crank",
        60.0,
        {"coupler angle deg": link_angle("coupler"), "rocker angle deg": link_angle("rocker")},
    ),
    "M02": (
        "crank",
        60.0,
        {"coupler angle deg": link_angle("coupler"), "rocker angle deg": link_angle("rocker")},
    ),
    "M07": ("crank", 40.0, {"slider x": place("slider", 0)}),
    "M08": ("crank", 40.0, {"slider x": place("slider", 0)}),
    "M09": ("shaft", 30.0, {"slider D x": place("sliderD", 0), "bar C angle deg": link_angle("barC")}),
    "M10": ("crank", 40.0, {"yoke x": place("yoke", 0)}),
    "M13": ("rod1", 0.0, {f"P3 {axis}": place("rod3", i) for i, axis in enumerate("xyz")} | {}),
    "M23": (
        "in",
        25.0,
        {"disc centre x = e cos^2": place("disc", 0), "disc centre y = e sin cos": place("disc", 1)},
    ),
    "M24": (
        "screw",
        0.0,
        {"nut travel, lead .05, 2 turns": lambda f, p: float(p[node(f.source, "nut")].translation[2] - 0.4)},
    ),
    "M25": ("g1", 0.0, {"driven gear deg (20:50)": link_angle("g2")}),
    "M26": ("pinion", 0.0, {"rack x = rp*theta": place("rack", 0)}),
    "M32": ("arm1", 35.0, {"platform height L sin": place("platform", 1)}),
}
ROWS = [r for r in table("closed_forms") if r["id"] in DRIVEN and r["quantity"] in DRIVEN[r["id"]][2]]


@pytest.mark.parametrize(
    "row", ROWS, ids=[f"{r['id']}-{r['quantity'].split()[0]}-{r['driver']}" for r in ROWS]
)
def test_driven_position_is_that_of_the_closed_form(row):
    """Turning the crank to the stated angle puts every part where trigonometry puts it, within 1e-9."""
    part, start, measures = DRIVEN[row["id"]]
    found = analysed(row["id"])
    drive = found.drive((joint(found, "base", part).id, RX))
    drive.to([math.radians(float(row["driver"]) - start)])
    value, expected = measures[row["quantity"]](found, drive.poses()), float(row["value"])
    if "deg" in row["quantity"]:
        value = expected + math.remainder(value - expected, 360.0)
        assert math.radians(abs(value - expected)) < TOLERANCE
    else:
        assert abs(value - expected) < TOLERANCE


def test_planetary_gear_keeps_its_ratios():
    """Carrier at 60 degrees: sun at 24/84 of its turn's inverse (210), planet at (1 - 60/18) 60 = -140 degrees."""
    found = analysed("M27")
    expected = {
        r["quantity"].split()[0]: float(r["value"]) for r in table("closed_forms") if r["id"] == "M27"
    }
    sun = next(float(r["driver"]) for r in table("closed_forms") if r["id"] == "M27")
    drive = found.drive((joint(found, "base", "carrier").id, RX))
    drive.to([math.radians(expected["carrier"])])
    for name, angle in (("sun", sun), ("planet", expected["planet"])):
        assert (
            math.radians(abs(math.remainder(turned(drive.poses()[node(found.source, name)]) - angle, 360.0)))
            < TOLERANCE
        )


def test_couplings_of_a_planetary_count_against_its_carrier():
    """Both gears couple hinges on the carrier: the sun's is hung there, on the same axis."""
    found = analysed("M27")
    ratios = {(c.terms[0].joint, c.joint): c.terms[0].ratio for c in found.couplings}
    assert ratios == {
        ("carrier - sun", "carrier - planet"): pytest.approx(-24 / 18),
        ("base - carrier", "carrier - planet"): pytest.approx(-60 / 18),
    }


def test_two_planetary_stages_multiply_their_ratio():
    """M43: each carrier turns 24 / 84 as far as its sun; the second stage's sun is the first one's carrier."""
    found = analysed("M43")
    drive = found.drive((joint(found, "base", "carrier2").id, RX))
    drive.to([math.radians(20.0)])
    for name, angle in (("carrier1", 70.0), ("sun", 245.0)):
        got = turned(drive.poses()[node(found.source, name)])
        assert math.radians(abs(math.remainder(got - angle, 360.0))) < TOLERANCE


def test_every_coupling_of_a_planetary_train_has_its_joints():
    """The first carrier counts against the housing in one stage and against the second carrier in the other."""
    found = analysed("M43")
    assert len(found.couplings) == 12
    beside = next(
        j for j in found.joints if {j.a, j.b} == {node(found.source, f"carrier{i}") for i in (1, 2)}
    )
    assert beside.kind is JointKind.FREE and any(
        beside.id in (c.terms[0].joint, c.joint) for c in found.couplings
    )


@pytest.mark.parametrize("angle", [-40.0, 10.0, 40.0])
def test_peaucellier_draws_a_straight_line(angle):
    """M46: the inversion of a circle through its centre: x = (1.1^2 - 0.5^2) / (2 0.4), y = x tan(angle / 2)."""
    found = analysed("M46")
    drive = found.drive((joint(found, "base", "crank").id, RX))
    drive.to([math.radians(angle - 25.0)])
    end = drive.poses()[node(found.source, "ad")].translation
    assert np.abs(end - [1.2, 1.2 * math.tan(math.radians(angle / 2)), 0.0]).max() < TOLERANCE


def test_sarrus_platform_rises_as_twice_the_sine():
    """The platform of a Sarrus linkage is at 2 l sin(phi) when a lower link stands at phi."""
    found = analysed("M11")
    for row in (r for r in table("closed_forms") if r["id"] == "M11"):
        drive = found.drive((joint(found, "base", "lo_x").id, RX))
        drive.to([-math.radians(float(row["driver"]) - 50.0)])
        assert (
            abs(drive.poses()[node(found.source, "platform")].translation[2] - float(row["value"]))
            < TOLERANCE
        )


def test_bennett_output_follows_its_ratio_of_half_angle_tangents():
    """tan(t1/2) tan(t2/2) stays constant along the motion of the Bennett linkage."""
    found = analysed("M12")
    start, second = 80.0, None
    for row in (r for r in table("closed_forms") if r["id"] == "M12" and "theta2" in r["quantity"]):
        drive = found.drive((joint(found, "base", "link1").id, RX))
        drive.to([math.radians(float(row["driver"]) - start)])
        poses = drive.poses()
        one, two = (poses[node(found.source, name)].rotation for name in ("link1", "link2"))
        # link2's frame is link1's, twisted by alpha about x and turned by theta2 about the next axis
        alpha = math.radians(30.0)
        twist = np.array(
            [[1, 0, 0], [0, math.cos(alpha), -math.sin(alpha)], [0, math.sin(alpha), math.cos(alpha)]]
        )
        relative = (one @ twist).T @ two
        second = math.atan2(relative[1, 0], relative[0, 0])
        assert abs(math.remainder(second - math.radians(float(row["value"])), math.tau)) < TOLERANCE
    assert second is not None


def test_cardan_output_angle_and_speed():
    """tan(out) = tan(in) cos(beta); the speeds, from the exact Jacobian at the driven pose, are as the derivative of
    that: cos(beta) / (1 - sin(beta)^2 sin(in)^2), which the table has rounded."""
    found = analysed("M21")
    beta = math.radians(30.0)
    ratio = {
        r["driver"]: float(r["value"])
        for r in table("closed_forms")
        if r["id"] == "M21" and "ratio" in r["quantity"]
    }
    for row in (r for r in table("closed_forms") if r["id"] == "M21" and "angle" in r["quantity"]):
        drive = found.drive((joint(found, "base", "in").id, RX))
        output = found.drive((joint(found, "base", "out").id, RX))
        start = math.degrees(math.atan(math.tan(math.radians(20.0)) * math.cos(beta)))
        drive.to([math.radians(float(row["driver"]) - 20.0)])
        output.to([math.radians(float(row["value"]) - start)])
        for driven, followed in zip(drive.poses(), output.poses()):
            assert np.abs(driven.rotation - followed.rotation).max() < TOLERANCE
        turning = {name: spin(found, drive, name) for name in ("in", "out")}
        axes = {"in": np.array([1.0, 0.0, 0.0]), "out": np.array([math.cos(beta), math.sin(beta), 0.0])}
        speed = {name: axes[name] @ turning[name] for name in axes}
        for name in axes:  # each shaft turns about its own axis alone
            assert np.linalg.norm(turning[name] - speed[name] * axes[name]) < TOLERANCE
        angle = math.radians(float(row["driver"]))
        exact = math.cos(beta) / (1.0 - (math.sin(beta) * math.sin(angle)) ** 2)
        assert abs(speed["out"] / speed["in"] - exact) < TOLERANCE
        assert abs(exact - ratio[row["driver"]]) < TOLERANCE


def spin(found, drive, name):
    """Angular velocity of a part in the one motion that a mechanism has at the pose it is driven to."""
    assembly = found.assembly
    state = State(drive.state.rotation, drive.state.shift, assembly.start.angle)
    (freedom,) = block_freedoms(assembly.solver, state)
    (velocity,) = freedom.basis.T
    body = assembly.body[node(found.source, name) + 1]
    return velocity.reshape(-1, 6)[np.flatnonzero(freedom.bodies == body)[0], 3:]


def test_wedge_lowers_its_follower():
    """dx of the wedge lowers the follower by dx tan(20 deg)."""
    found = analysed("M30")
    row = next(r for r in table("closed_forms") if r["id"] == "M30")
    drive = found.drive((joint(found, "base", "wedge").id, TX))
    drive.to([float(row["driver"])])
    assert (
        abs(drive.poses()[node(found.source, "follower")].translation[1] - 0.3 - float(row["value"]))
        < TOLERANCE
    )


@pytest.mark.parametrize("arms", [(30, 30, 30), (10, 25, 40)])
def test_delta_platform_follows_its_three_arms(arms):
    """The angles of the three arms put the Delta's platform where three spheres meet."""
    found = analysed("M18")
    expected = [
        float(r["value"]) for r in table("closed_forms") if r["id"] == "M18" and str(arms) in r["quantity"]
    ]
    joints = [joint(found, "base", f"arm{k}") for k in range(3)]
    drive = found.drive(*[(j.id, RX) for j in joints])
    drive.to([math.radians(a - 30.0) for a in arms])
    assert np.abs(drive.poses()[node(found.source, "platform")].translation - expected).max() < TOLERANCE


def turn(axis, degrees):
    """Rotation matrix about a coordinate axis."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[i, i] = matrix[j, j] = c
    matrix[j, i], matrix[i, j] = s, -s
    return matrix


def stewart_legs(position, rotation):
    """Leg lengths of the Stewart platform: base joints on radius 1 at 120 k -+ 10 degrees, platform joints on radius
    0.6 at 120 k - 60 +- 10 degrees, in this order."""
    lengths = []
    for k in range(3):
        for base, platform in ((120 * k - 10, 120 * k - 50), (120 * k + 10, 120 * k + 50)):
            low = np.array([math.cos(math.radians(base)), math.sin(math.radians(base)), 0.0])
            high = np.array([math.cos(math.radians(platform)), math.sin(math.radians(platform)), 0.0])
            lengths.append(float(np.linalg.norm(position + rotation @ (0.6 * high) - low)))
    return lengths


def test_stewart_platform_follows_its_six_legs():
    """The six leg lengths of a pose, which the table has rounded to ten digits, bring the platform to that pose."""
    found = analysed("M14")
    position, rotation = np.array([0.08, -0.05, 1.25]), turn(2, 12.0) @ turn(1, -7.0) @ turn(0, 5.0)
    lengths = stewart_legs(position, rotation)
    stated = [float(r["value"]) for r in table("closed_forms") if r["id"] == "M14"]
    assert np.abs(np.subtract(lengths, stated)).max() < 1e-10
    home = stewart_legs(np.array([0.0, 0.0, 1.2]), np.eye(3))[0]
    legs = [joint(found, f"lo{i}", f"up{i}") for i in range(1, 7)]
    drive = found.drive(*[(j.id, TX) for j in legs])
    signs = []
    for i, leg in enumerate(legs, start=1):
        poses = found.poses
        out = (
            poses[node(found.source, f"up{i}")].translation - poses[node(found.source, f"lo{i}")].translation
        )
        axis = (found.scene(solved=True).pose(leg.a) @ leg.frame_a).rotation[:, 0]
        signs.append(
            math.copysign(1.0, axis @ out) * (1.0 if found.source.nodes[leg.b].name == f"up{i}" else -1.0)
        )
    drive.to([s * (length - home) for s, length in zip(signs, lengths)])
    pose = drive.poses()[node(found.source, "platform")]
    assert np.abs(pose.rotation - rotation).max() < TOLERANCE
    assert np.abs(pose.translation - position).max() < TOLERANCE
