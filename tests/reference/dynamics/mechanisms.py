"""Reference motions of 19 mechanisms in minimal coordinates: writes mechanisms.json (needs numpy and scipy).

    python mechanisms.py            writes the file
    python mechanisms.py --check    fails when the committed values are not those computed, within 1e-6

``minimal_coordinates`` states and solves the equations of motion.

The file holds, for each mechanism: a scene (bodies at their centres of mass and principal axes; SI), velocities at the
start, and at each time position (m) and rotation (x y z w) of every body.
"""

import json
import sys
from pathlib import Path

import numpy as np
from minimal_coordinates import Mechanism, O, X, Y, Z, numbers, quaternion, rot

FILE = Path(__file__).with_name("mechanisms.json")
CASES = []


def case(make):
    CASES.append(make)
    return make


@case
def heavy_top(m):
    """Three different moments, spin 12 rad/s and precession 3 rad/s at 1.1 rad from the vertical, on a ball joint."""
    tilt = rot(Z, 1.1)
    axis = tilt @ Y
    l0 = m.link(-1, "R", Y)
    l2 = m.link(m.link(l0, "R", Z), "R", axis)
    b = m.body("top", l2, 0.5, (0.002, 0.003, 0.004), 0.08 * axis, tilt)
    m.joint(b, None, "ConfigurableJoint", O, X, Z, free="XYZ")
    return [3, 0, 12], (0.5, 1)


@case
def moving_pivot(m):
    """A pendulum on a ball joint of a kinematic arm, whose end runs round a circle of 0.7 m at 2 rad/s."""
    arm = m.link(-1, "R", Y)
    p = 0.7 * X
    l2 = m.link(m.link(m.link(arm, "R", X, p), "R", Z, p), "R", Y, p)
    b = m.body("bob", l2, 0.8, (0.01, 0.012, 0.008), p + [0.4, -0.8, 0.02])
    k = m.body("arm", arm, 1, (1, 1, 1), O, inert=True)
    m.joint(b, k, "ConfigurableJoint", p, X, Y, free="XYZ")
    m.keep(q0=1)
    m.kinematic = {"body": k, "axis": [0, 1, 0], "rate": 2}
    return [2, 0.3, -0.5, 0.1], (1, 2)


@case
def bead_on_hoop(m):
    """A bead on a vertical hoop of 0.4 m that a motor turns at 5 rad/s."""
    hoop = m.link(-1, "R", Y)
    k = m.body("hoop", hoop, 1, (0.1, 0.1, 0.1), O)
    b = m.body("bead", m.link(hoop, "R", Z), 0.3, (1e-4, 2e-4, 3e-4), rot(Z, 0.5) @ (-0.4 * Y))
    m.hinge(k, None, O, Y, useMotor=True, motor={"targetVelocity": np.degrees(5), "force": 1000})
    m.hinge(b, k, O, Z)
    m.keep(q0=1)
    return [5, 0], (1, 2)


@case
def rott(m):
    """Rott's L-shaped pendulum with a second pendulum on its arm."""
    l0 = m.link(-1, "R", Z)
    p = 0.6 * X
    a = m.body("L", l0, 2, (0.05, 0.08, 0.12), [0.25, -0.1, 0], rot(Z, 0.3))
    b = m.body("pendulum", m.link(l0, "R", Z, p), 1, (0.01, 0.012, 0.02), p + [0.05, -0.35, 0])
    m.hinge(a, None, O, Z)
    m.hinge(b, a, p, Z)
    return [0, 0.4], (0.5, 2)


@case
def ladder(m):
    """A rod whose ends slide along a floor and a wall; the slides are the world's (swapBodies)."""
    a, b = np.sin(0.3) * X, np.cos(0.3) * Y
    rod = m.link(m.link(-1, "P", X), "R", Z, a)
    i = m.rod("ladder", rod, a, b, 2)
    m.close(rod, -1, b, [X])
    m.joint(i, None, "ConfigurableJoint", a, X, Y, free="xZ", swapBodies=True)
    m.joint(i, None, "ConfigurableJoint", b, Y, X, free="xZ", swapBodies=True)
    return [0, 0], (0.5, 1)


@case
def gimbals(m):
    """A rotor at 80 rad/s, off centre, in two gimbals."""
    spin = rot(X, 0.4) @ Z
    l0 = m.link(-1, "R", Y)
    l1 = m.link(l0, "R", X)
    a = m.body("outer", l0, 1, (0.02, 0.03, 0.025), O)
    b = m.body("inner", l1, 0.8, (0.01, 0.015, 0.012), 0.05 * Z)
    c = m.body("rotor", m.link(l1, "R", spin), 2, (0.004, 0.004, 0.007), 0.08 * spin, rot(X, 0.4))
    m.hinge(a, None, O, Y)
    m.hinge(b, a, O, X)
    m.hinge(c, b, O, spin)
    return [0.3, 0, 80], (0.5, 1)


@case
def furuta(m):
    """An arm turning about the vertical with a pendulum, let go near the top."""
    l0 = m.link(-1, "R", Y)
    p = 0.3 * X
    a = m.rod("arm", l0, O, p, 0.5)
    b = m.rod("pendulum", m.link(l0, "R", X, p), p, p + rot(X, 0.2) @ (0.4 * Y), 0.4)
    m.hinge(a, None, O, Y)
    m.hinge(b, a, p, X)
    return [1, 0], (0.5, 1)


@case
def watt(m):
    """Watt's straight-line linkage under gravity."""
    a, b, c, d = O, X, np.array([1.1, 0.4, 0]), np.array([2.1, 0.4, 0])
    l0, l2 = m.link(-1, "R", Z, a), m.link(-1, "R", Z, d)
    l1 = m.link(l0, "R", Z, b)
    crank, coupler, rocker = (
        m.rod("crank", l0, a, b, 1),
        m.rod("coupler", l1, b, c, 2),
        m.rod("rocker", l2, d, c, 1.5),
    )
    m.hinge(crank, None, a, Z)
    m.hinge(coupler, crank, b, Z)
    m.hinge(rocker, None, d, Z)
    m.hinge(coupler, rocker, c, Z)
    m.close(l1, l2, c)
    return m.consistent([0.3, 0, 0], [0]), (0.5, 1)


@case
def double_fourbar(m):
    """Two four-bars that share a rocker, seven hinges."""
    a, b, c, d = O, np.array([0.1, 0.5, 0]), np.array([0.9, 0.7, 0]), np.array([0.8, 0, 0])
    e, f = np.array([1.7, 0.6, 0]), np.array([1.6, -0.1, 0])
    l0, l2, l4 = m.link(-1, "R", Z, a), m.link(-1, "R", Z, d), m.link(-1, "R", Z, f)
    l1, l3 = m.link(l0, "R", Z, b), m.link(l2, "R", Z, c)
    rods = ((l0, a, b, 1), (l1, b, c, 1.2), (l2, d, c, 0.8), (l3, c, e, 1.1), (l4, f, e, 0.9))
    bar = [m.rod(f"bar{i}", *rod) for i, rod in enumerate(rods)]
    for own, other, p in (
        (0, None, a),
        (1, 0, b),
        (2, None, d),
        (1, 2, c),
        (3, 2, c),
        (4, None, f),
        (3, 4, e),
    ):
        m.hinge(bar[own], None if other is None else bar[other], p, Z)
    m.close(l1, l2, c)
    m.close(l3, l4, e)
    return [0] * 5, (0.5, 1)


@case
def bennett(m):
    """Bennett's spatial four-bar (1 m at 50 degrees, 0.7 m), moved by gravity: mobile against the count of freedoms."""
    sides, twists, turns = (1, 0.7), [np.radians(50)], [np.radians(70)]
    twists.append(np.arcsin(np.sin(twists[0]) * 0.7))
    ratio = np.sin(sum(twists) / 2) / np.sin((twists[1] - twists[0]) / 2)
    turns.append(2 * np.arctan(ratio / np.tan(turns[0] / 2)))
    points, axes, r = [O], [Z], np.eye(3)
    for i in range(4):
        r = r @ rot(Z, turns[i % 2] if i < 2 else 2 * np.pi - turns[i % 2])
        points.append(points[-1] + sides[i % 2] * r[:, 0])
        r = r @ rot(X, twists[i % 2])
        axes.append(r[:, 2])
    assert np.linalg.norm(points[4]) < 1e-12 and np.linalg.norm(axes[4] - Z) < 1e-12
    link, bar = -1, None
    for i in range(3):
        link = m.link(link, "R", axes[i], points[i])
        own = m.rod(f"bar{i}", link, points[i], points[i + 1], 1 + 0.2 * i)
        m.hinge(own, bar, points[i], axes[i])
        bar = own
    m.hinge(bar, None, points[3], axes[3])
    m.close(link, -1, points[3])
    m.close(link, -1, points[3] + axes[3])
    return [0] * 3, (0.3, 0.6)


@case
def governor(m):
    """A centrifugal governor: shaft at 6 rad/s, a fly-ball arm and a link to the sleeve on either side, free to speed up."""
    sleeve_y = 1 - 0.8 * np.cos(0.6)
    shaft = m.link(-1, "R", Y)
    sleeve = m.link(shaft, "P", Y)
    a = m.body("shaft", shaft, 1, (0.02, 0.01, 0.02), 0.5 * Y)
    b = m.body("sleeve", sleeve, 2, (0.01, 0.012, 0.01), sleeve_y * Y)
    m.hinge(a, None, O, Y)
    m.joint(b, a, "ConfigurableJoint", sleeve_y * Y, Y, X, free="x")
    for side, name in ((1, "right"), (-1, "left")):
        p = np.array([0.03 * side, 1, 0])
        q = p + [0.4 * side * np.sin(0.6), -0.4 * np.cos(0.6), 0]
        r = np.array([0.03 * side, sleeve_y, 0])
        arm = m.link(shaft, "R", Z, p)
        rod = m.link(arm, "R", Z, q)
        c = m.body(f"{name} ball", arm, 0.5, (0.02, 0.021, 0.022), q)
        d = m.rod(f"{name} link", rod, q, r, 0.1)
        m.close(rod, sleeve, r)
        m.hinge(c, a, p, Z)
        m.hinge(d, c, q, Z)
        m.hinge(d, b, r, Z)
    return [6] + [0] * 5, (0.3, 0.6)


@case
def slider_crank(m):
    """A crank that is let go at 3 rad/s, a rod and a slider."""
    a, b, c = O, 0.3 * Y, np.sqrt(0.55) * X
    l0, l2 = m.link(-1, "R", Z, a), m.link(-1, "P", X)
    l1 = m.link(l0, "R", Z, b)
    crank, rod = m.rod("crank", l0, a, b, 1), m.rod("rod", l1, b, c, 1.5)
    slider = m.body("slider", l2, 0.8, (0.01, 0.01, 0.01), c)
    m.hinge(crank, None, a, Z)
    m.hinge(rod, crank, b, Z)
    m.hinge(rod, slider, c, Z)
    m.joint(slider, None, "ConfigurableJoint", c, X, Y, free="x")
    m.close(l1, l2, c, [X, Y])
    return m.consistent([3, 0, 0], [0]), (0.5, 1)


@case
def cardan(m):
    """Two shafts on a universal joint (angular X of the connected body, Z of the own), the second otherwise free."""
    l0 = m.link(-1, "R", X, -X)
    l2 = m.link(m.link(l0, "R", X), "R", Z)
    a = m.body("first", l0, 1, (0.02, 0.05, 0.05), [-0.5, 0.1, 0])
    b = m.body("second", l2, 1.5, (0.03, 0.06, 0.05), [0.4, -0.1, 0.05])
    m.hinge(a, None, -X, X)
    m.joint(b, a, "ConfigurableJoint", O, X, Y, free="XZ")
    return [2, 1, 0.5], (0.5, 1)


@case
def planet_gear(m):
    """A planet rolling on a sun, both on an arm that swings; the ratio -2 is between their angles on the arm."""
    arm = m.link(-1, "R", Z)
    sun, planet = m.link(arm, "R", Z), m.link(arm, "R", Z, 0.5 * X)
    a = m.body("arm", arm, 2, (0.1, 0.2, 0.3), [0.3, -0.1, 0])
    b = m.body("sun", sun, 1, (0.02, 0.02, 0.04), 0.05 * Y)
    c = m.body("planet", planet, 1, (0.02, 0.02, 0.03), [0.5, 0.1, 0])
    m.hinge(a, None, O, Z)
    m.hinge(b, a, O, Z)
    m.hinge(c, a, 0.5 * X, Z)
    m.keep(q2=1, q1=2)
    m.couple("gear", (b, "angle"), (c, "angle"), -2.0)
    return [0, 2, -4], (0.5, 1)


@case
def screw(m):
    """A nut of 0.05 m per radian on an oblique spindle, its centre beside the axis."""
    axis = 0.3 * X + Y
    slide = m.link(-1, "P", axis)
    a = m.body("nut", m.link(slide, "R", axis), 2, (0.1, 0.2, 0.28), [0.02, 0.1, 0.03], rot(X + Z, 0.7))
    m.joint(a, None, "ConfigurableJoint", O, axis, free="xX")
    m.keep(q0=1, q1=-0.05)
    m.couple("screw", (a, "angularX"), (a, "x"), 0.05 * np.pi / 180)
    return [0.05, 1], (1, 2)


@case
def hinge_spring(m):
    """A double pendulum with crossed axes, a spring (12 N m/rad, 0.4 N m s/rad, target 0.5 rad) on the second hinge."""
    axis, p = Z + 0.3 * X, np.array([0.7, 0.1, 0])
    l0 = m.link(-1, "R", Z)
    l1 = m.link(l0, "R", axis, p)
    a = m.body("first", l0, 1.5, (0.03, 0.06, 0.05), [0.4, -0.1, 0.05])
    b = m.body("second", l1, 0.7, (0.03, 0.03, 0.05), p + [0.2, -0.2, 0.1], rot(X + Y, 1))
    m.torques.append((l1, lambda q, v: -12 * (q - 0.5) - 0.4 * v))
    m.hinge(a, None, O, Z)
    spring = {"spring": 12, "damper": 0.4, "targetPosition": np.degrees(0.5)}
    m.hinge(b, a, p, axis, useSpring=True, spring=spring)
    return [0, 0], (0.5, 1)


@case
def cart_and_pole(m):
    """A cart driven to x = 0.3 m at 0.2 m/s (40 N/m, 1.5 N s/m), a pole swinging from it."""
    slide = m.link(-1, "P", X)
    a = m.body("cart", slide, 2, (0.1, 0.1, 0.1), 0.1 * Y)
    b = m.rod("pole", m.link(slide, "R", Z), O, rot(Z, 2) @ Y, 1)
    m.torques.append((slide, lambda q, v: -40 * (q - 0.3) - 1.5 * (v - 0.2)))
    drive = {"xDrive": {"positionSpring": 40, "positionDamper": 1.5}}
    drive |= {"targetPosition": [-0.3, 0, 0], "targetVelocity": [-0.2, 0, 0]}
    m.joint(a, None, "ConfigurableJoint", O, X, Y, free="x", **drive)
    m.hinge(b, a, O, Z)
    return [0, 0], (0.5, 2)


@case
def elastic_pendulum(m):
    """A bob on a soft linear limit of 0.5 m (60 N/m, 0.2 N s/m), always taut: a rubber rope."""

    def pull(x, v):
        r = np.linalg.norm(x)
        assert r > 0.5, "the rope must stay taut"
        return -(60 * (r - 0.5) + 0.2 * (v @ x) / r) * x / r

    slide = m.link(m.link(m.link(-1, "P", X), "P", Y), "P", Z)
    p = 0.7 * np.array([np.sin(0.5), -np.cos(0.5), 0])
    m.forces.append((slide, p, pull))
    a = m.body("bob", slide, 1, (0.1, 0.1, 0.1), p)
    limit = {"linearLimit": {"limit": 0.5}, "linearLimitSpring": {"spring": 60, "damper": 0.2}}
    world = {"autoConfigureConnectedAnchor": False, "connectedAnchor": [0, 0, 0]}
    m.joint(a, None, "ConfigurableJoint", p, X, Y, free="XYZ", limited="xyz", **limit, **world)
    return [0.2, 0, 0.8], (0.5, 2)


@case
def chain_of_ten(m):
    """Ten rods of 0.2 m, the hinges' axes by turns across and upright, let go from the horizontal."""
    link, bar = -1, None
    for i in range(10):
        axis, p = (Y if i % 2 else Z), 0.2 * i * X
        link = m.link(link, "R", axis, p)
        own = m.rod(f"bar{i}", link, p, p + 0.2 * X, 1)
        m.hinge(own, bar, p, axis)
        bar = own
    return [0.5 * (i % 2) for i in range(10)], (0.3,)


def compute(make):
    m = Mechanism()
    speeds, times = make(m)
    q = np.zeros(len(m.links))
    out = {"name": make.__name__.replace("_", " ")}
    out["start"] = [numbers(np.r_[v, w]) for _, _, v, w in m.states(q, np.array(speeds, float))]
    out["times"] = list(times)
    out["states"] = [
        [numbers(np.r_[x, quaternion(r)], 7) for x, r, _, _ in row]
        for row in m.solve(np.array(speeds, float), times)
    ]
    if m.kinematic:
        out["kinematic"] = m.kinematic
    out["scene"] = {
        "format": "kinefab.scene",
        "version": "1.0",
        "gameObjects": m.objects,
        "couplings": m.couplings,
    }
    return out


def differs(a, b):
    """Whether two values differ, numbers by more than 1e-6."""
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() != b.keys() or any(differs(a[k], b[k]) for k in a)
    if isinstance(a, list) and isinstance(b, list):
        return len(a) != len(b) or any(map(differs, a, b))
    return a != b if isinstance(a, str) else abs(a - b) > 1e-6


def main():
    cases = [compute(make) for make in CASES]
    if "--check" in sys.argv:
        committed = json.loads(FILE.read_text())
        sys.exit("mechanisms.json is not what this script computes" if differs(committed, cases) else 0)
    FILE.write_text("[\n" + ",\n".join(json.dumps(c, separators=(",", ":")) for c in cases) + "\n]\n")


if __name__ == "__main__":
    main()
