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


def placed(component: dict, values):
    """The pose of actor 1's frame in actor 0's at six coordinates x y z, angular x y z; locked ones are not used."""
    free = freedoms(component)
    a = np.where(free[3:], values[3:], 0.0)
    turning = [i for i in range(3) if free[3 + i]]
    if turning == [0, 2]:
        turn = about(2, a[2]) @ about(0, a[0])
    elif turning == [0, 1]:
        turn = about(1, a[1]) @ about(0, a[0])
    else:
        turn = any_turn(a)
    return turn, np.where(free[:3], values[:3], 0.0)


def violation(component: dict, turn, shift):
    """What the component forbids of a pose of actor 1's frame in actor 0's: zeros where it allows the pose."""
    free = freedoms(component)
    locked = [i for i in range(3) if not free[3 + i]]
    if len(locked) == 3:
        angular = turn - np.eye(3)
    elif len(locked) == 2:
        axis = next(i for i in range(3) if free[3 + i])
        angular = turn[:, axis] - np.eye(3)[axis]
    elif locked == [0]:
        angular = turn[2, 1] - turn[1, 2]
    elif locked == [1]:
        angular = turn[2, 0]
    elif locked == [2]:
        angular = turn[1, 0]
    else:
        angular = np.zeros(0)
    return np.concatenate([shift[~np.array(free[:3])], np.ravel(angular)])


def actors(component: dict, own, connected):
    """The joint's frame in actor 0 and in actor 1 at start-up, and whether the own body is actor 1.

    own, connected: (rotation, translation) of the two Rigidbodies (connected: the identity for the world).
    The frames are returned in the world; the connected one copies the own one's axes.
    """
    j, anchor = frame(component)
    own_r, own_t = own
    f_own = own_r @ j, own_r @ anchor + own_t
    other = np.asarray(component["connectedAnchor"], dtype=float) if "connectedAnchor" in component else None
    at = f_own[1] if other is None else connected[0] @ other + connected[1]
    f_other = f_own[0], at
    swapped = bool(component.get("swapBodies", False))
    return (f_other, f_own, True) if swapped else (f_own, f_other, False)


def moved_by(component: dict, own, connected, values):
    """The displacement of the own body in the world at these coordinates, the connected body at rest."""
    first, second, own_is_second = actors(component, own, connected)
    turn, shift = placed(component, values)
    if own_is_second:
        old, new = second, (first[0] @ turn, first[0] @ shift + first[1])
    else:
        old, new = first, (second[0] @ turn.T, second[1] - second[0] @ turn.T @ shift)
    rotation = new[0] @ old[0].T
    return rotation, new[1] - rotation @ old[1]


def displaced(component: dict, own, connected, rng: np.random.Generator, reach: float):
    """A random displacement of the own body in the world, the connected body at rest."""
    values = np.concatenate([rng.uniform(-reach, reach, 3), rng.uniform(-0.7, 0.7, 3)])
    return moved_by(component, own, connected, values)


def broken(component: dict, own, connected, own_moved, connected_moved):
    """``violation`` after both bodies are displaced by (rotation, translation) in the world."""
    first, second, own_is_second = actors(component, own, connected)
    by = (connected_moved, own_moved) if own_is_second else (own_moved, connected_moved)
    (r0, p0), (r1, p1) = ((d[0] @ f[0], d[0] @ f[1] + d[1]) for d, f in zip(by, (first, second)))
    return violation(component, r0.T @ r1, r0.T @ (p1 - p0))
