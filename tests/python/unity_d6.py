"""What a Unity joint component lets its body do, read from the component alone.

Written from the PhysX 4.1 joint guide and Unity's scripting reference, independently of ``kinefab.unity``:
linear motion along actor 0's axes; two locked rotations leave a turn about the third axis; a locked swing
keeps actor 1's X at right angles to actor 0's Z (Y locked) or Y (Z locked); a locked twist alone is a
constant-velocity joint.  Everything here is left-handed, component by component.
"""

from __future__ import annotations

import numpy as np

MIRROR = np.diag([-1.0, 1.0, 1.0])


def mirrored(rotation, translation):
    """A pose or displacement from one handedness to the other."""
    return MIRROR @ rotation @ MIRROR, MIRROR @ translation


def freedoms(component: dict) -> list[bool]:
    """Which of x y z, angular x y z may change."""
    if component["type"] == "FixedJoint":
        return [False] * 6
    if component["type"] == "HingeJoint":
        return [False, False, False, True, False, False]
    names = ("xMotion", "yMotion", "zMotion", "angularXMotion", "angularYMotion", "angularZMotion")
    return [str(component.get(name, "Free")).lower() != "locked" for name in names]


def frame(component: dict):
    """The joint frame in the own body: rotation and anchor."""
    x = np.asarray(component.get("axis", (1.0, 0.0, 0.0)), dtype=float)
    x = x / np.linalg.norm(x)
    second = np.asarray(component.get("secondaryAxis", (0.0, 1.0, 0.0)), dtype=float)
    y = second - x * (x @ second)
    if component["type"] != "ConfigurableJoint" or np.linalg.norm(y) < 1e-9:
        y = np.eye(3)[np.argmin(np.abs(x))]
        y = y - x * (x @ y)
    y = y / np.linalg.norm(y)
    return np.column_stack([x, y, np.cross(x, y)]), np.asarray(
        component.get("anchor", (0, 0, 0)), dtype=float
    )


def about(axis: int, angle: float):
    i, j = (axis + 1) % 3, (axis + 2) % 3
    r = np.eye(3)
    r[i, i] = r[j, j] = np.cos(angle)
    r[j, i], r[i, j] = np.sin(angle), -np.sin(angle)
    return r


def any_turn(w):
    angle = np.linalg.norm(w)
    if angle == 0.0:
        return np.eye(3)
    x, y, z = w / angle
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def relative(component: dict, rng: np.random.Generator, reach: float):
    """A random pose of actor 1's frame in actor 0's that the component allows."""
    free = freedoms(component)
    shift = np.where(free[:3], rng.uniform(-reach, reach, 3), 0.0)
    a = rng.uniform(-0.7, 0.7, 3)
    turning = [i for i in range(3) if free[3 + i]]
    if turning == [0, 2]:
        turn = about(2, a[2]) @ about(0, a[0])
    elif turning == [0, 1]:
        turn = about(1, a[1]) @ about(0, a[0])
    else:
        turn = any_turn(np.where(free[3:], a, 0.0))
    return turn, shift


def displaced(component: dict, own, connected, rng: np.random.Generator, reach: float):
    """A random displacement of the own body in the world, the connected body at rest.

    own, connected: (rotation, translation) of the two Rigidbodies (connected: the identity for the world).
    """
    j, anchor = frame(component)
    own_r, own_t = own
    f_own = own_r @ j, own_r @ anchor + own_t
    other = np.asarray(component["connectedAnchor"], dtype=float) if "connectedAnchor" in component else None
    at = f_own[1] if other is None else connected[0] @ other + connected[1]
    f_other = f_own[0], at  # the connected frame copies the own one at start-up
    turn, shift = relative(component, rng, reach)
    if component.get("swapBodies", False):
        new = f_other[0] @ turn, f_other[0] @ shift + f_other[1]
    else:
        new = f_other[0] @ turn.T, f_other[1] - f_other[0] @ turn.T @ shift
    rotation = new[0] @ f_own[0].T
    return rotation, new[1] - rotation @ f_own[1]
