"""Mechanisms in minimal coordinates, and the scenes of the same mechanisms.

Every mechanism is a tree of links, each turning about (R) or sliding along (P) one axis of its parent; q = 0 is the
start. With the geometric Jacobians Jv, Jw of each body's centre of mass, the equations of motion are

    M(q) q'' = sum Jv^T (m (g - Jv' q') + F) - Jw^T (I Jw' q' + w x I w) + tau + G^T lambda,   G(q) q'' = gamma(q, q')

with M = sum m Jv^T Jv + Jw^T I Jw. G holds what closes the loops and what couples or prescribes coordinates; redundant
rows are met by the least-norm lambda. scipy's DOP853 integrates at a relative tolerance of 1e-12. Nothing here shares
a formula with the solvers under test, which take maximal coordinates and step by an implicit rule.
"""

import numpy as np
from scipy.integrate import solve_ivp

X, Y, Z = np.eye(3)
O = np.zeros(3)  # noqa: E741


def skew(a):
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def rot(axis, angle):
    k = skew(np.asarray(axis, float) / np.linalg.norm(axis))
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def quaternion(r):
    """(x, y, z, w) of a rotation matrix, by the largest component."""
    rows = np.array(
        [
            [1 + r[0, 0] - r[1, 1] - r[2, 2], r[0, 1] + r[1, 0], r[0, 2] + r[2, 0], r[2, 1] - r[1, 2]],
            [r[0, 1] + r[1, 0], 1 - r[0, 0] + r[1, 1] - r[2, 2], r[1, 2] + r[2, 1], r[0, 2] - r[2, 0]],
            [r[0, 2] + r[2, 0], r[1, 2] + r[2, 1], 1 - r[0, 0] - r[1, 1] + r[2, 2], r[1, 0] - r[0, 1]],
            [r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], 1 + r[0, 0] + r[1, 1] + r[2, 2]],
        ]
    )
    q = rows[int(np.argmax(np.diag(rows)))]
    return q / np.linalg.norm(q)


class Mechanism:
    """A tree of links with bodies on them, and the scene of the same mechanism."""

    def __init__(self):
        self.gravity = -9.81 * Y
        self.links, self.bodies, self.loops, self.forces, self.torques = [], [], [], [], []
        self.objects, self.couplings, self.kinematic = [], [], None

    def link(self, parent, kind, axis, point=O):
        """Adds a link to a parent (-1: the world); its coordinate has the index returned."""
        axis = np.asarray(axis, float)
        self.links.append((parent, kind, axis / np.linalg.norm(axis), np.asarray(point, float)))
        return len(self.links) - 1

    def body(self, name, link, mass, moments, centre, rotation=None, inert=False):
        """Adds a body to a link. An inert one is kinematic in the scene and without mass here."""
        rotation = np.eye(3) if rotation is None else rotation
        moments = np.asarray(moments, float)
        scale = 0 if inert else 1
        self.bodies.append((link, mass * scale, moments * scale, np.asarray(centre, float), rotation))
        rigidbody = {"type": "Rigidbody", "mass": mass, "inertiaTensor": numbers(moments)}
        rigidbody |= {"angularDamping": 0, "maxAngularVelocity": 1e6} | (
            {"isKinematic": True} if inert else {}
        )
        transform = {"localPosition": numbers(centre), "localRotation": numbers(quaternion(rotation))}
        self.objects.append(
            {"id": str(len(self.objects)), "name": name, "transform": transform, "components": [rigidbody]}
        )
        return len(self.bodies) - 1

    def rod(self, name, link, start, end, mass):
        """A thin rod between two points, its X along it; the moments across differ a little, as none is a cylinder."""
        start, end = np.asarray(start, float), np.asarray(end, float)
        length = np.linalg.norm(end - start)
        x = (end - start) / length
        y = np.cross(Z if abs(x[2]) < 0.9 else Y, x)
        y /= np.linalg.norm(y)
        across = mass * length**2 / 12
        moments = (across / 50, across, across * 1.01)
        return self.body(
            name, link, mass, moments, (start + end) / 2, np.column_stack([x, y, np.cross(x, y)])
        )

    def joint(self, own, other, kind, point, axis, secondary=None, free="", limited="", **fields):
        """Adds a joint to the scene at a world point and axis; `free` of x y z X Y Z (angular)."""
        _, _, _, centre, rotation = self.bodies[own]
        axis = np.asarray(axis, float) / np.linalg.norm(axis)
        component = {"type": kind} | ({} if other is None else {"connectedBody": other})
        component |= {"anchor": numbers(rotation.T @ (point - centre)), "axis": numbers(rotation.T @ axis)}
        if secondary is not None:
            component["secondaryAxis"] = numbers(rotation.T @ secondary)
        if kind == "ConfigurableJoint":
            for letter in "xyzXYZ":
                field = f"{letter}Motion" if letter.islower() else f"angular{letter}Motion"
                component[field] = "Free" if letter in free else "Limited" if letter in limited else "Locked"
        self.objects[own]["components"].append(component | fields)

    def hinge(self, own, other, point, axis, **fields):
        self.joint(own, other, "HingeJoint", point, axis, **fields)

    def couple(self, kind, a, b, ratio):
        """Adds a coupling to the scene; a and b are (body, coordinate) of each body's first joint."""
        ends = [{"gameObject": body, "component": 1, "coordinate": name} for body, name in (a, b)]
        self.couplings.append({"kind": kind, "a": ends[0], "b": ends[1], "ratio": ratio, "offset": 0})

    def close(self, link, other, point, along=None):
        """Keeps a point common to two links, or its parts along directions of the world."""
        self.loops.append(
            ("point", link, other, np.asarray(point, float), np.eye(3) if along is None else np.array(along))
        )

    def keep(self, **factors):
        """Keeps a sum of coordinates, each times its factor, at constant speed: q0=1, q1=-2."""
        row = {int(name[1:]): factor for name, factor in factors.items()}
        self.loops.append(("sum", row))

    def move(self, q, v):
        """Rotation, offset, velocity, velocity-dependent acceleration and Jacobian (angular, linear at the origin) of links."""
        n = len(self.links)
        out = []
        for i, (parent, kind, axis, point) in enumerate(self.links):
            r, t, velocity, bias, jacobian = (
                (np.eye(3), O, np.zeros(6), np.zeros(6), np.zeros((6, n))) if parent < 0 else out[parent]
            )
            a = r @ axis
            p = r @ point + t
            s = np.r_[a, np.cross(p, a)] if kind == "R" else np.r_[O, a]
            turn = rot(axis, q[i]) if kind == "R" else np.eye(3)
            shift = point - turn @ point if kind == "R" else axis * q[i]
            rate = np.r_[
                np.cross(velocity[:3], s[:3]), np.cross(velocity[:3], s[3:]) + np.cross(velocity[3:], s[:3])
            ]
            jacobian = jacobian.copy()
            jacobian[:, i] += s
            out.append((r @ turn, r @ shift + t, velocity + s * v[i], bias + rate * v[i], jacobian))
        return out

    def at(self, motion, link, point):
        """Position, velocity, velocity-dependent acceleration and Jacobian of a link's point, given where it starts."""
        if link < 0:
            return point, O, O, np.zeros((3, len(self.links)))
        r, t, velocity, bias, jacobian = motion[link]
        x = r @ point + t
        v = velocity[3:] + np.cross(velocity[:3], x)
        a = bias[3:] + np.cross(bias[:3], x) + np.cross(velocity[:3], v)
        return x, v, a, jacobian[3:] - skew(x) @ jacobian[:3]

    def rows(self, motion):
        """G and gamma of the loops."""
        g, gamma = [np.zeros((0, len(self.links)))], [np.zeros(0)]
        for kind, *loop in self.loops:
            if kind == "point":
                link, other, point, along = loop
                _, _, a, j = self.at(motion, link, point)
                _, _, a2, j2 = self.at(motion, other, point)
                g.append(along @ (j - j2))
                gamma.append(along @ (a2 - a))
            else:
                row = np.zeros(len(self.links))
                row[list(loop[0])] = list(loop[0].values())
                g.append(row[None])
                gamma.append(np.zeros(1))
        return np.vstack(g), np.concatenate(gamma)

    def acceleration(self, q, v):
        n = len(self.links)
        motion = self.move(q, v)
        mass, force = np.zeros((n, n)), np.zeros(n)
        for link, m, moments, centre, rotation in self.bodies:
            _, _, a, j = self.at(motion, link, centre)
            r, _, velocity, bias, jacobian = motion[link]
            w, jw = velocity[:3], jacobian[:3]
            inertia = r @ rotation @ np.diag(moments) @ rotation.T @ r.T
            mass += m * j.T @ j + jw.T @ inertia @ jw
            force += j.T @ (m * (self.gravity - a)) - jw.T @ (inertia @ bias[:3] + np.cross(w, inertia @ w))
        for link, point, law in self.forces:
            x, u, _, j = self.at(motion, link, point)
            force += j.T @ law(x, u)
        for i, law in self.torques:
            force[i] += law(q[i], v[i])
        g, gamma = self.rows(motion)
        if not len(g):
            return np.linalg.solve(mass, force)
        k = np.block([[mass, g.T], [g, np.zeros((len(g), len(g)))]])
        return np.linalg.lstsq(k, np.r_[force, gamma], rcond=1e-12)[0][:n]

    def consistent(self, v, given):
        """Speeds that keep the loops closed, from those of the given coordinates."""
        q = np.zeros(len(self.links))
        g, _ = self.rows(self.move(q, q))
        free = [i for i in range(len(v)) if i not in given]
        v = np.array(v, float)
        v[free] = np.linalg.lstsq(g[:, free], -g[:, given] @ v[given], rcond=None)[0]
        return v

    def states(self, q, v):
        """Position, rotation, velocity and angular velocity of every body."""
        motion = self.move(q, v)
        out = []
        for link, _, _, centre, rotation in self.bodies:
            x, u, _, _ = self.at(motion, link, centre)
            out.append((x, motion[link][0] @ rotation, u, motion[link][2][:3]))
        return out

    def solve(self, v, times):
        n = len(self.links)
        start = np.r_[np.zeros(n), v]

        def rate(_, y):
            return np.r_[y[n:], self.acceleration(y[:n], y[n:])]

        done = solve_ivp(rate, (0, times[-1]), start, method="DOP853", t_eval=times, rtol=1e-12, atol=1e-13)
        assert done.success, done.message
        return [self.states(y[:n], y[n:]) for y in done.y.T]


def numbers(values, digits=10):
    """The values rounded, whole ones without a point: the file stays small."""
    values = [round(float(v), digits) for v in values]
    return [int(v) if v == int(v) else v for v in values]
