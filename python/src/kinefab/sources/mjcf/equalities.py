"""Equality constraints: connect and weld as joints that close loops, joints and fixed tendons as couplings."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ...diagnostics import Report
from ...model import (
    Coupling,
    CouplingKind,
    Joint,
    JointKind,
    Motion,
    Scene,
    Term,
    freedoms_of,
)
from ...spatial import Array, Pose, frame_from_axes, rotation_log
from ..robots.rigid_links import Carrier, unique
from ..robots.robot_frame import shape_placed
from .engine import Compiled, pose_of
from .joints import Made

APART = 1e-6
"""Metres between two anchors that hold an axis together."""


@dataclass(slots=True, eq=False)
class Equalities:
    """carriers: by MuJoCo's id of a body; None for the world where nothing of it is a node.
    apart: pairs of bodies that do not collide.  Its own: the index in the scene of each joint by its id, names that are
    taken, and the coordinates that couplings give."""

    compiled: Compiled
    carriers: Sequence[Carrier | None]
    made: Made
    scene: Scene
    report: Report
    apart: frozenset[frozenset[int]] = frozenset()
    _places: dict[str, int] = field(default_factory=dict[str, int])
    _called: dict[str, None] = field(default_factory=dict[str, None])
    _given: set[tuple[str, int]] = field(default_factory=set[tuple[str, int]])

    def read(self) -> None:
        m, kinds = self.compiled.model, self.compiled.mujoco.mjtEq
        self._places |= {joint.id: i for i, joint in enumerate(self.scene.joints)}
        anchored: dict[tuple[int, int, bool], list[tuple[str, str, Array, Array]]] = {}
        without: dict[tuple[int, int, bool], str] = {}  # names of connects of two bodies that state none
        self._called |= dict.fromkeys(filter(None, (self.compiled.name("eq", i) for i in range(m.neq))))
        for i in range(m.neq):
            kind = int(m.eq_type[i])
            word = str(kinds(kind).name).removeprefix("mjEQ_").lower()
            name = self.compiled.name("eq", i) or unique(self._called, self._called_like(i, word))
            self._called[name] = None
            where = self.compiled.files.nth("equality", i, m.neq)
            active = bool(m.eq_active0[i])
            if kind == int(kinds.mjEQ_CONNECT):
                a, b, frame_a, frame_b = self._ends(i, False)
                point = (self.compiled.name("eq", i), where, frame_a.translation, frame_b.translation)
                anchored.setdefault((a, b, active), []).append(point)
                without.setdefault((a, b, active), name)
            elif kind == int(kinds.mjEQ_WELD):
                a, b, frame_a, frame_b = self._ends(i, True)
                fixed = float(m.eq_data[i][10]) != 0.0  # its torquescale: without torques it holds a point
                if fixed:
                    frame_b = self._met(name, where, a, b, frame_a, frame_b)
                held = JointKind.FIXED if fixed else JointKind.SPHERICAL
                self._close((name,), where, held, a, b, frame_a, frame_b, active)
            elif kind == int(kinds.mjEQ_JOINT):
                self._joints(i, name, where, active)
            elif kind == int(kinds.mjEQ_TENDON):
                self._tendons(i, name, where, active)
            else:
                feature = f"equality {name}"
                self.report.dropped(f"{feature} ({word})", "MJCF_LEFT_OUT", where)
        for (a, b, active), points in anchored.items():
            self._connect(a, b, active, points, without[a, b, active])

    def _called_like(self, i: int, word: str) -> str:
        """What an equality without a name is called: by its kind and what it holds together."""
        m, kinds = self.compiled.model, self.compiled.mujoco.mjtObj
        owners: dict[int, Callable[[int], str]] = {
            int(kinds.mjOBJ_BODY): lambda k: self.compiled.bodies[k],
            int(kinds.mjOBJ_SITE): lambda k: self.compiled.bodies[int(m.site_bodyid[k])],
            int(kinds.mjOBJ_JOINT): lambda k: self.compiled.joints[k],
            int(kinds.mjOBJ_TENDON): lambda k: self.compiled.name("tendon", k) or str(k),
        }
        called = owners.get(int(m.eq_objtype[i]), str)
        ends = (int(m.eq_obj1id[i]), int(m.eq_obj2id[i]))
        return " ".join([word, *(called(k) for k in ends if k >= 0)])

    # Loops ..............................................................................................................

    def _ends(self, i: int, weld: bool) -> tuple[int, int, Pose, Pose]:
        """Bodies, and the frames in them that meet."""
        m = self.compiled.model
        first, second, data = int(m.eq_obj1id[i]), int(m.eq_obj2id[i]), m.eq_data[i]
        if int(m.eq_objtype[i]) == int(self.compiled.mujoco.mjtObj.mjOBJ_SITE):
            frames = [pose_of(m.site_pos[s], m.site_quat[s]) for s in (first, second)]
            return int(m.site_bodyid[first]), int(m.site_bodyid[second]), frames[0], frames[1]
        if weld:
            return first, second, pose_of(data[3:6], data[6:10]), Pose(translation=np.array(data[0:3]))
        return first, second, Pose(translation=np.array(data[0:3])), Pose(translation=np.array(data[3:6]))

    def _met(self, name: str, where: str, a: int, b: int, frame_a: Pose, frame_b: Pose) -> Pose:
        """b's frame, or where the exported pose does not keep the weld the one that meets a's: Unity's fixed joint holds
        what it finds."""
        seen = self.compiled.body_pose(b).inverse() @ self.compiled.body_pose(a) @ frame_a
        gap = frame_b.inverse() @ seen
        metres, radians = (
            float(np.linalg.norm(gap.translation)),
            float(np.linalg.norm(rotation_log(gap.rotation))),
        )
        if metres <= APART and radians <= APART:
            return frame_b
        self.report.approximated(
            f"equality {name}", "MJCF_WELD_APART", where, name=name, metres=f"{metres:.3g}",
            degrees=f"{np.degrees(radians):.3g}",
        )  # fmt: skip
        return seen

    def _connect(
        self, a: int, b: int, active: bool, points: list[tuple[str, str, Array, Array]], without: str
    ) -> None:
        """One point is a ball; two hold an axis; three that are not in line hold all.  MuJoCo has no other hinge here.
        without: name of the joint where none of them has one."""
        where = points[0][1]
        names = tuple(p[0] for p in points if p[0])  # further points of one joint need no names
        on_a, on_b = (np.array([p[i] for p in points]) for i in (2, 3))
        along_a, along_b = on_a - on_a[0], on_b - on_b[0]
        far = int(np.argmax(np.linalg.norm(along_a, axis=1)))
        if not np.linalg.norm(along_a[far]) > APART or not np.linalg.norm(along_b[far]) > APART:
            for name, at, p, q in points:
                names, ends = (name or without,), (Pose(translation=p), Pose(translation=q))
                self._close(names, at, JointKind.SPHERICAL, a, b, *ends, active)
            return
        off = [_off(along_a[far], v) for v in along_a]
        third = int(np.argmax([np.linalg.norm(v) for v in off]))
        planar = np.linalg.norm(off[third]) <= APART
        side_a, side_b = (None, None) if planar else (along_a[third], along_b[third])
        kind = JointKind.REVOLUTE if planar else JointKind.FIXED
        frame_a = Pose(frame_from_axes(along_a[far], side_a), on_a[0] + 0.5 * along_a[far])
        frame_b = Pose(frame_from_axes(along_b[far], side_b), on_b[0] + 0.5 * along_b[far])
        if planar:
            frame_b = self._turned_alike(a, b, frame_a, frame_b)
        self._close(names or (without,), where, kind, a, b, frame_a, frame_b, active)

    def _turned_alike(self, a: int, b: int, frame_a: Pose, frame_b: Pose) -> Pose:
        """b's frame turned about its X so that the angle is zero at the exported pose."""
        seen = self.compiled.body_pose(b).inverse() @ self.compiled.body_pose(a) @ frame_a
        return Pose(frame_from_axes(frame_b.rotation[:, 0], seen.rotation[:, 1]), frame_b.translation)

    def _close(
        self,
        names: tuple[str, ...],
        where: str,
        kind: JointKind,
        a: int,
        b: int,
        frame_a: Pose,
        frame_b: Pose,
        active: bool,
    ) -> None:
        ends = [self.carriers[a], self.carriers[b]]
        frames = [shape_placed(frame_a), shape_placed(frame_b)]
        frames = [f if c is None else c.pose @ f for c, f in zip(ends, frames)]
        nodes = [None if c is None else c.node for c in ends]
        ident = unique(self._places, "+".join(names))
        if nodes[0] == nodes[1]:
            self.report.dropped(f"equality {ident} (within one body)", "MJCF_LEFT_OUT", where)
            return
        self._places[ident] = len(self.scene.joints)
        self.scene.joints.append(
            Joint(
                ident,
                kind,
                nodes[0],
                nodes[1],
                frames[0],
                frames[1],
                freedoms_of(kind),
                name="+".join(names),
                enabled=active,
                collide=frozenset((a, b)) not in self.apart,
                closes=True,
                because=names,
                where=where,
                extras={
                    "mjcf": {"type": "weld" if kind is JointKind.FIXED and len(names) == 1 else "connect"}
                },
            )
        )

    # Couplings ..........................................................................................................

    def _joints(self, i: int, name: str, where: str, active: bool) -> None:
        m = self.compiled.model
        first, second = int(m.eq_obj1id[i]), int(m.eq_obj2id[i])
        if self._inactive(name, where, active):
            return
        if first not in self.made.coordinate or (second >= 0 and second not in self.made.coordinate):
            self.report.dropped(f"equality {name}", "MJCF_LEFT_OUT", where)
            return
        zero = float(m.qpos0[m.jnt_qposadr[first]])
        coefficients = [float(v) for v in m.eq_data[i][:5]]
        if second < 0:
            self._hold(first, zero + coefficients[0])
            return
        other = float(m.qpos0[m.jnt_qposadr[second]])
        at = float(self.compiled.data.qpos[m.jnt_qposadr[second]])
        ratio, offset = self._line(coefficients, at - other, f"equality {name}", where)
        self._couple(name, where, {first: 1.0, second: -ratio}, zero + offset - ratio * other)

    def _tendons(self, i: int, name: str, where: str, active: bool) -> None:
        m = self.compiled.model
        first, second = int(m.eq_obj1id[i]), int(m.eq_obj2id[i])
        if self._inactive(name, where, active):
            return
        sums = [self.fixed_terms(t) for t in (first, second) if t >= 0]
        if any(s is None for s in sums):
            self.report.dropped(f"equality {name} (of spatial tendons)", "MJCF_LEFT_OUT", where)
            return
        terms = dict(sums[0] or {})
        zero = float(m.tendon_length0[first])
        coefficients = [float(v) for v in m.eq_data[i][:5]]
        constant = zero + coefficients[0]
        if second >= 0:
            other = float(m.tendon_length0[second])
            length = sum(
                c * float(self.compiled.data.qpos[m.jnt_qposadr[j]]) for j, c in (sums[1] or {}).items()
            )
            ratio, offset = self._line(coefficients, length - other, f"equality {name}", where)
            constant = zero + offset - ratio * other
            for j, c in (sums[1] or {}).items():
                terms[j] = terms.get(j, 0.0) - ratio * c
        self._couple(name, where, terms, constant)

    def _inactive(self, name: str, where: str, active: bool) -> bool:
        if not active:
            self.report.dropped(f"equality {name} (not active)", "MJCF_LEFT_OUT", where)
        return not active

    def _line(self, coefficients: list[float], x: float, feature: str, where: str) -> tuple[float, float]:
        """Slope and value at zero of the tangent of a polynomial at x; of a line the line itself."""
        if not any(coefficients[2:]):
            return coefficients[1], coefficients[0]
        slope = sum(k * c * x ** (k - 1) for k, c in enumerate(coefficients) if k)
        value = sum(c * x**k for k, c in enumerate(coefficients))
        said = " ".join(f"{c:g}" for c in coefficients)
        self.report.approximated(feature, "MJCF_POLYNOMIAL", where, numbers=said)
        return slope, value - slope * x

    def fixed_terms(self, tendon: int) -> dict[int, float] | None:
        """Of a fixed tendon: its length is the sum of these times MuJoCo's joints; None of a spatial one."""
        m = self.compiled.model
        start, count = int(m.tendon_adr[tendon]), int(m.tendon_num[tendon])
        terms: dict[int, float] = {}
        for k in range(start, start + count):
            if int(m.wrap_type[k]) != int(self.compiled.mujoco.mjtWrap.mjWRAP_JOINT):
                return None
            j = int(m.wrap_objid[k])
            terms[j] = terms.get(j, 0.0) + float(m.wrap_prm[k])
        return terms if all(j in self.made.coordinate for j in terms) else None

    def _couple(self, name: str, where: str, terms: dict[int, float], constant: float) -> None:
        """sum of factor * coordinate = constant, as the first coordinate that no other coupling gives."""
        terms = {j: c for j, c in terms.items() if c != 0.0}
        free = [j for j in terms if self.made.coordinate[j] not in self._given]
        if not free:
            self.report.dropped(f"equality {name} (nothing follows)", "MJCF_LEFT_OUT", where)
            return
        leader = free[0]
        factor = terms.pop(leader)
        if not terms:
            self._hold(leader, constant / factor)
            return
        joint, freedom = self.made.coordinate[leader]
        self._given.add((joint, freedom))
        self.scene.couplings.append(
            Coupling(
                name,
                CouplingKind.LINEAR,
                joint,
                freedom,
                tuple(Term(*self.made.coordinate[j], -c / factor) for j, c in terms.items()),
                constant / factor,
                where,
            )
        )

    def _hold(self, j: int, value: float) -> None:
        """A coordinate that never moves: a range of one value."""
        ident, index = self.made.coordinate[j]
        joint = self.scene.joints[self._places[ident]]
        freedoms = list(joint.freedoms)
        freedoms[index] = replace(freedoms[index], motion=Motion.LIMITED, lower=value, upper=value)
        self.scene.joints[self._places[ident]] = replace(joint, freedoms=tuple(freedoms))


def _off(axis: Array, v: Array) -> Array:
    unit = axis / np.linalg.norm(axis)
    return v - unit * float(unit @ v)
