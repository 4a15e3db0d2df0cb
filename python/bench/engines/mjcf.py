"""MuJoCo on MJCF: what the compiled model says of its bodies, joints and equalities."""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np

from . import EngineJoint, Mass, Pose, Refused

NAME = "mujoco"
FORMATS = ("MJCF",)
ROS = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
SMALL = 1e-9
"""Singular values of the equalities' Jacobian below this share of the largest are zero."""


class MujocoModel:
    """An MJCF file in MuJoCo, at its reference pose or that of a keyframe."""

    turn, length = ROS, 1.0
    slack = (0.0, 0.0)

    def __init__(self, path: Path, keyframe: str = "") -> None:
        import mujoco

        self.mujoco: Any = mujoco
        try:
            self.model: Any = mujoco.MjModel.from_xml_path(str(path))
        except Exception as error:
            raise Refused(str(error)) from None
        self.data: Any = mujoco.MjData(self.model)
        if keyframe:
            mujoco.mj_resetDataKeyframe(self.model, self.data, self.model.key(keyframe).id)
        self.random = np.random.default_rng(14)
        self.start = np.array(self.data.qpos)
        self.body_names = self._body_names()
        owners = [self.body_names[int(b)] for b in self.model.jnt_bodyid]
        self.joint_names = _named(
            [self.model.joint(i).name for i in range(self.model.njnt)], [f"{o} joint" for o in owners]
        )
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_comPos(self.model, self.data)
        self.joints = [j for i in range(self.model.njnt) if (j := self._coordinate(i)) is not None]
        self.bent = self._bent()
        self.adrift = self._adrift()
        self.mobility = self._mobility()

    def _body_names(self) -> list[str]:
        """Bodies without a name are called after the nearest one above that has one."""
        given = [self.model.body(i).name for i in range(self.model.nbody)]
        instead = []
        for i in range(self.model.nbody):
            above = int(self.model.body_parentid[i])
            while above and not given[above]:
                above = int(self.model.body_parentid[above])
            instead.append(f"{given[above]} body" if above else "body")
        return _named(given, instead)

    def _coordinate(self, i: int) -> EngineJoint | None:
        m, kinds = self.model, self.mujoco.mjtJoint
        kind = int(m.jnt_type[i])
        if kind not in (int(kinds.mjJNT_HINGE), int(kinds.mjJNT_SLIDE)) or i in self._led():
            return None
        name, low, high = self.joint_names[i], -math.inf, math.inf
        if m.jnt_limited[i]:
            low, high = (float(v) for v in m.jnt_range[i])
        start = float(self.start[m.jnt_qposadr[i]])
        child = self.body_names[int(m.jnt_bodyid[i])]
        axis, is_angle = np.array(self.data.xaxis[i]), kind == int(kinds.mjJNT_HINGE)
        return EngineJoint(name, name, child, is_angle, axis, low, high, start)

    def _led(self) -> set[int]:
        """Joints that an equality gives: not to be chosen."""
        m = self.model
        of_joints = int(self.mujoco.mjtEq.mjEQ_JOINT)
        return {
            int(m.eq_obj1id[i]) for i in range(m.neq) if int(m.eq_type[i]) == of_joints and m.eq_active0[i]
        }

    def _mobility(self) -> int:
        """nv less the rank of the equalities' Jacobian at the exported pose."""
        m, d, mujoco = self.model, self.data, self.mujoco
        m.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
        mujoco.mj_fwdPosition(m, d)
        kinds = np.array(d.efc_type[: d.nefc])
        rows = np.array(d.efc_J).reshape(-1, m.nv)[: d.nefc] if d.nefc else np.zeros((0, m.nv))
        equal = rows[kinds == int(mujoco.mjtConstraint.mjCNSTR_EQUALITY)]
        # What keeps cloth together is left out with it.
        asked = [
            int(m.eq_type[i]) not in self._soft()
            for i in np.array(d.efc_id[: d.nefc])[kinds == int(mujoco.mjtConstraint.mjCNSTR_EQUALITY)]
        ]
        equal = equal[np.array(asked, dtype=bool)]
        if not len(equal):
            return int(m.nv)
        sizes = np.linalg.svd(equal, compute_uv=False)
        return int(m.nv) - int((sizes > SMALL * max(float(sizes[0]), 1.0)).sum())

    def _soft(self) -> set[int]:
        kinds = self.mujoco.mjtEq
        return {int(kind) for kind in (getattr(kinds, n) for n in dir(kinds) if n.startswith("mjEQ_FLEX"))}

    def _bent(self) -> set[int]:
        """Bodies that a polynomial moves: the scene has its tangent, and says so."""
        m = self.model
        moved = {
            int(m.jnt_bodyid[int(m.eq_obj1id[i])])
            for i in range(m.neq)
            if int(m.eq_type[i]) == int(self.mujoco.mjtEq.mjEQ_JOINT) and np.any(m.eq_data[i][2:5])
        }
        for i in range(1, m.nbody):
            if int(m.body_parentid[i]) in moved:
                moved.add(i)
        return moved

    def _adrift(self) -> set[int]:
        """Bodies of free trees that an equality holds to another: the scene carries them along where that one is moved,
        while MuJoCo's kinematics leave them where their coordinates say."""
        m, free = self.model, int(self.mujoco.mjtJoint.mjJNT_FREE)
        held = {
            root for root in self._held() if m.body_jntnum[root] and m.jnt_type[m.body_jntadr[root]] == free
        }
        return {i for i in range(1, m.nbody) if int(m.body_rootid[i]) in held}

    def residual(self) -> float:
        """Largest violation of an equality at the data's pose, metres or radians."""
        m, d = self.model, self.data
        self.mujoco.mj_fwdPosition(m, d)
        equal = np.array(d.efc_type[: d.nefc]) == int(self.mujoco.mjtConstraint.mjCNSTR_EQUALITY)
        return float(np.abs(np.array(d.efc_pos[: d.nefc])[equal]).max(initial=0.0))

    def _place(self, values: Mapping[str, float]) -> None:
        m, d = self.model, self.data
        d.qpos[:] = self.start
        if values:
            self._scatter()
        for name, value in values.items():
            d.qpos[m.jnt_qposadr[self.joint_names.index(name)]] = value
        of_joints = int(self.mujoco.mjtEq.mjEQ_JOINT)
        following = [i for i in range(m.neq) if int(m.eq_type[i]) == of_joints and m.eq_active0[i]]
        for _ in following if values else ():  # as often as a chain of them may be long, whatever their order
            before = d.qpos.copy()
            for i in following:
                self._follow(i)
            if np.array_equal(before, d.qpos):
                break
        self.mujoco.mj_kinematics(m, d)

    def _scatter(self) -> None:
        """Free bodies and balls stand anywhere, since nobody chooses their coordinates; not what an equality holds to
        something that is not its own."""
        kinds, held = self.mujoco.mjtJoint, self._held()
        for i in range(self.model.njnt):
            body = int(self.model.jnt_bodyid[i])
            if int(self.model.body_rootid[body]) in held or int(self.model.body_jntnum[body]) > 1:
                continue  # a ball that is one of several joints stays: where it stands between them is not asked
            at, kind = int(self.model.jnt_qposadr[i]), int(self.model.jnt_type[i])
            if kind == int(kinds.mjJNT_FREE):
                self.data.qpos[at : at + 3] = self.random.uniform(-1.0, 1.0, 3)
            if kind in (int(kinds.mjJNT_FREE), int(kinds.mjJNT_BALL)):
                turn = self.random.normal(size=4)
                first = at + 3 if kind == int(kinds.mjJNT_FREE) else at
                self.data.qpos[first : first + 4] = turn / np.linalg.norm(turn)

    def _held(self) -> set[int]:
        """Roots of the trees that a connect or weld holds to another tree or the world."""
        m, kinds = self.model, self.mujoco.mjtEq
        found: set[int] = set()
        for i in range(m.neq):
            if int(m.eq_type[i]) not in (int(kinds.mjEQ_CONNECT), int(kinds.mjEQ_WELD)):
                continue
            ends = [int(m.eq_obj1id[i]), int(m.eq_obj2id[i])]
            if int(m.eq_objtype[i]) == int(self.mujoco.mjtObj.mjOBJ_SITE):
                ends = [int(m.site_bodyid[s]) for s in ends]
            roots = {int(m.body_rootid[b]) for b in ends}
            if len(roots) > 1:
                found |= roots
        return found

    def _follow(self, i: int) -> None:
        m, d = self.model, self.data
        first, second = int(m.eq_obj1id[i]), int(m.eq_obj2id[i])
        at = int(m.jnt_qposadr[first])
        x = 0.0
        if second >= 0:
            other = int(m.jnt_qposadr[second])
            x = float(d.qpos[other]) - float(m.qpos0[other])
        d.qpos[at] = m.qpos0[at] + sum(float(c) * x**k for k, c in enumerate(m.eq_data[i][:5]))

    def poses(self, values: Mapping[str, float]) -> dict[str, Pose]:
        self._place(values)
        d = self.data
        return {
            name: (np.array(d.xmat[i]).reshape(3, 3), np.array(d.xpos[i]))
            for i, name in enumerate(self.body_names)
            if i and not (values and (i in self.bent or i in self.adrift))
        }

    def masses(self) -> dict[str, Mass]:
        """Of bodies that are welded together, as one."""
        m, d = self.model, self.data
        self._place({})
        d.qpos[:] = self.start
        self.mujoco.mj_kinematics(m, d)
        groups: dict[int, list[int]] = {}
        for i in range(1, m.nbody):
            if int(m.body_weldid[i]) and int(m.body_mocapid[m.body_rootid[i]]) < 0:
                groups.setdefault(int(m.body_weldid[i]), []).append(i)
        return {self.body_names[group]: self._together(members) for group, members in groups.items()}

    def passing(self) -> set[frozenset[str]]:
        """As MuJoCo's ``mj_collision`` has it: bodies welded together are one, parents pass but for the world, then excludes, then the
        masks of geoms; a pair that is stated collides whatever these say."""
        m = self.model
        weld = [int(b) for b in m.body_weldid]
        above = [weld[int(m.body_parentid[b])] for b in weld]
        excluded = {frozenset((int(s) >> 16, int(s) & 0xFFFF)) for s in m.exclude_signature}
        of_parents = not int(m.opt.disableflags) & int(self.mujoco.mjtDisableBit.mjDSBL_FILTERPARENT)
        stated = {
            frozenset((int(m.geom_bodyid[a]), int(m.geom_bodyid[b])))
            for a, b in zip(m.pair_geom1, m.pair_geom2)
        }
        paired = {int(geom) for geom in (*m.pair_geom1, *m.pair_geom2)}
        geoms: dict[int, set[tuple[int, int]]] = {}
        for i in range(m.ngeom):
            masks = (int(m.geom_contype[i]), int(m.geom_conaffinity[i]))
            if any(masks) or i in paired:
                geoms.setdefault(int(m.geom_bodyid[i]), set()).add(masks)
        found: set[frozenset[str]] = set()
        for a, b in combinations(sorted(geoms), 2):
            ends = (weld[a], weld[b])
            if ends[0] == ends[1] or frozenset((a, b)) in stated:
                continue
            parents = of_parents and all(ends) and (ends[0] == above[b] or ends[1] == above[a])
            meet = any(t & f or u & e for t, e in geoms[a] for u, f in geoms[b])
            if parents or frozenset((a, b)) in excluded or not meet:
                found.add(frozenset((self.body_names[a], self.body_names[b])))
        return found

    def _together(self, members: list[int]) -> Mass:
        m, d = self.model, self.data
        mass = float(sum(m.body_mass[i] for i in members))
        if not mass > 0.0:
            return Mass(0.0, np.zeros(3), np.eye(3))
        center = sum(m.body_mass[i] * d.xipos[i] for i in members) / mass
        inertia = np.zeros((3, 3))
        for i in members:
            axes, arm = np.array(d.ximat[i]).reshape(3, 3), d.xipos[i] - center
            inertia += axes @ np.diag(m.body_inertia[i]) @ axes.T
            inertia += m.body_mass[i] * ((arm @ arm) * np.eye(3) - np.outer(arm, arm))
        return Mass(mass, np.array(center), inertia)


def _named(given: list[str], instead: list[str]) -> list[str]:
    """Each with a name of its own, as the scene has them."""
    taken, found = {name for name in given if name}, []
    for name, wanted in zip(given, instead):
        unique, count = name or wanted, 1
        while not name and unique in taken:
            count += 1
            unique = f"{wanted}_{count}"
        taken.add(unique)
        found.append(unique)
    return found


def load(path: Path, packages: tuple[Path, ...]) -> MujocoModel:
    return MujocoModel(path)
