"""pxr itself on USD: the joints' frames as UsdPhysics' documentation has them, applied to the prims' transforms, and
``UsdGeom.XformCache`` and ``ComputeMassProperties`` asked for the rest.  Shares nothing with Kinefab's reader."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from . import EngineJoint, Mass, Pose, Refused

NAME = "usd-core"
FORMATS = ("USD stage",)
TURNS = {
    "Y": np.diag([-1.0, 1.0, 1.0]),
    "Z": np.array([[0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]),
}
"""Right-handed worlds to Unity's: where Z is up, X looks forward, as robots have it."""
DOFS = ("transX", "transY", "transZ", "rotX", "rotY", "rotZ")


@dataclass
class _Joint:
    """path; bodies: path or None for the world; frames: 4 x 4, in the bodies without their scale; free: of DOFS."""

    path: str
    bodies: list[str | None]
    frames: list[np.ndarray]
    free: list[int]
    ranges: dict[int, tuple[float, float]]
    start: np.ndarray | None = None


ROUNDED = 1e-4
"""Metres or radians that numbers of single precision leave between a joint's two sides."""


class Stage:
    """A stage whose bodies are moved in its session layer."""

    def __init__(self, path: Path) -> None:
        from pxr import Tf, Usd, UsdGeom, UsdPhysics

        self.usd, self.geom, self.physics = Usd, UsdGeom, UsdPhysics
        try:
            self.stage = Usd.Stage.Open(str(path))
        except Tf.ErrorException as error:
            raise Refused(str(error).splitlines()[-1]) from None
        self.length = float(UsdGeom.GetStageMetersPerUnit(self.stage))
        self.kilograms = float(UsdPhysics.GetStageKilogramsPerUnit(self.stage))
        up = str(UsdGeom.GetStageUpAxis(self.stage))
        if up not in TURNS:
            raise Refused(f"{up} is no axis that points up")
        self.turn = TURNS[up]
        cache = UsdGeom.XformCache()
        prims, walked = [], iter(Usd.PrimRange.Stage(self.stage, Usd.TraverseInstanceProxies()))
        for prim in walked:
            prims.append(prim)
            if prim.IsA(UsdGeom.PointInstancer):  # below it are prototypes, no bodies that stand anywhere
                walked.PruneChildren()
        instanced = any(p.IsA(UsdGeom.PointInstancer) for p in prims)
        self.bodies = {}
        for prim in prims:
            api = UsdPhysics.RigidBodyAPI(prim)
            if prim.HasAPI(UsdPhysics.RigidBodyAPI) and api.GetRigidBodyEnabledAttr().Get() is not False:
                self.bodies[str(prim.GetPath())] = _columns(cache.GetLocalToWorldTransform(prim))
        self.rigid = {path: _rigid(matrix) for path, matrix in self.bodies.items()}
        self.read = [j for p in prims if p.IsA(UsdPhysics.Joint) and (j := self._joint(p, cache)) is not None]
        self.added = self._stacks()
        self.at: dict[str | None, list[_Joint]] = {body: [] for body in [None, *self.bodies]}
        for joint in self.read:
            for body in joint.bodies:
                self.at[body].append(joint)
        self.joints = [found for joint in self._bridges() for found in self._coordinates(joint)]
        self.mobility = None if instanced else self._mobility()
        self.slack = self._slack()

    def _stacks(self) -> int:
        """Joints that MuJoCo's and Newton's schemas let add up: held at their zero here, their freedoms counted."""
        groups: dict[tuple[str | None, ...], list[_Joint]] = {}
        for joint in self.read:
            words = str(self.stage.GetPrimAtPath(joint.path).GetMetadata("apiSchemas") or "")
            closing = (
                self.stage.GetPrimAtPath(joint.path).GetAttribute("physics:excludeFromArticulation").Get()
            )
            if len(joint.free) == 1 and ("MjcJointAPI" in words or "NewtonJointAPI" in words) and not closing:
                groups.setdefault(tuple(joint.bodies), []).append(joint)
        stacks = [group for group in groups.values() if len(group) > 1]
        for first, *others in stacks:
            first.free = []
            self.read = [joint for joint in self.read if joint not in others]
        return sum(len(group) for group in stacks)

    def _slack(self) -> tuple[float, float]:
        """Of files in single precision; wider gaps are faults of the file, and excuse nothing."""
        metres = radians = 0.0
        for joint in self.read:
            gap = np.linalg.inv(_moved(joint, {})) @ joint.start
            turn = math.acos(max(-1.0, min(1.0, 0.5 * (np.trace(gap[:3, :3]) - 1.0))))
            metres = max(metres, float(np.linalg.norm(gap[:3, 3])) * self.length)
            radians = max(radians, turn if turn > 1e-7 else 0.0)
        widest = max(metres, radians) if max(metres, radians) < ROUNDED else 0.0
        return widest, widest

    def _body(self, path) -> str | None:
        while path and str(path) != "/":
            if str(path) in self.bodies:
                return str(path)
            prim = self.stage.GetPrimAtPath(path)
            if prim and prim.HasAPI(self.physics.RigidBodyAPI):
                return None  # switched off
            path = path.GetParentPath()
        return None

    def _joint(self, prim, cache) -> _Joint | None:
        api = self.physics.Joint(prim)
        if not api.GetJointEnabledAttr().Get():
            return None
        bodies, frames = [], []
        for rel, pos, rot in (
            (api.GetBody0Rel(), api.GetLocalPos0Attr().Get(), api.GetLocalRot0Attr().Get()),
            (api.GetBody1Rel(), api.GetLocalPos1Attr().Get(), api.GetLocalRot1Attr().Get()),
        ):
            targets = rel.GetForwardedTargets()
            target = self.stage.GetPrimAtPath(targets[0]) if targets else None
            if targets and not target:
                return None
            world = _columns(cache.GetLocalToWorldTransform(target)) if target else np.eye(4)
            body = self._body(targets[0]) if targets else None
            frame = np.eye(4)
            frame[:3, :3] = _rigid(world)[:3, :3] @ _turn(rot)
            frame[:3, 3] = (world @ [*pos, 1.0])[:3]
            frames.append(frame if body is None else np.linalg.inv(self.rigid[body]) @ frame)
            bodies.append(body)
        if bodies[0] == bodies[1]:
            return None
        free, ranges = self._free(prim)
        joint = _Joint(str(prim.GetPath()), bodies, frames, free, ranges)
        joint.start = self._relative(joint, self.rigid)
        return joint

    def _free(self, prim) -> tuple[list[int], dict[int, tuple[float, float]]]:
        """Freedoms in the order of DOFS, and their ranges in the stage's units and radians."""
        p = self.physics
        axis = "XYZ".index(str(prim.GetAttribute("physics:axis").Get() or "X"))
        if prim.IsA(p.FixedJoint):
            return [], {}
        for schema, first in ((p.RevoluteJoint, 3), (p.PrismaticJoint, 0)):
            if prim.IsA(schema):
                low, high = schema(prim).GetLowerLimitAttr().Get(), schema(prim).GetUpperLimitAttr().Get()
                return self._ranged({first + axis: (low, high)})
        if prim.IsA(p.SphericalJoint):
            return [3, 4, 5], {}
        if prim.IsA(p.DistanceJoint):
            return [0, 1, 2, 3, 4, 5], {}
        limits = {}
        for i, name in enumerate(DOFS):
            api = p.LimitAPI.Get(prim, name)
            limits[i] = (-math.inf, math.inf)
            if prim.HasAPI(p.LimitAPI, name):
                limits[i] = (api.GetLowAttr().Get(), api.GetHighAttr().Get())
        return self._ranged(limits)

    def _ranged(self, limits) -> tuple[list[int], dict[int, tuple[float, float]]]:
        free, ranges = [], {}
        for i, (low, high) in limits.items():
            low, high = (math.copysign(math.inf, v) if abs(v) > 0.5e38 else v for v in (low, high))
            if low < high:
                unit = math.radians(1.0) if i >= 3 else 1.0
                free.append(i)
                ranges[i] = (low * unit, high * unit)
        return free, ranges

    def _relative(self, joint: _Joint, worlds: Mapping[str, np.ndarray]) -> np.ndarray:
        first, second = (
            (np.eye(4) if body is None else worlds[body]) @ frame
            for body, frame in zip(joint.bodies, joint.frames)
        )
        return np.linalg.inv(first) @ second

    def _coordinates(self, joint: _Joint) -> list[EngineJoint]:
        turns = [i for i in joint.free if i >= 3]
        if len(turns) > 1:
            return []  # their angles have no order that all agree on; they stay as exported
        found = []
        child = joint.bodies[1] or joint.bodies[0]
        world = np.eye(4) if joint.bodies[0] is None else self.rigid[joint.bodies[0]]
        for i in joint.free:
            axis = (world @ joint.frames[0])[:3, i % 3]
            if joint.bodies[1] is None:
                axis = -axis  # body 0 moves against the world: the other way
            low, high = joint.ranges[i]
            found.append(
                EngineJoint(
                    joint.path[1:],
                    f"{joint.path}:{i}",
                    child[1:],
                    i >= 3,
                    axis,
                    low,
                    high,
                    _reading(joint.start, i),
                )
            )
        return found

    def _bridges(self) -> list[_Joint]:
        """Joints that are in no loop: all others stay as exported."""
        return [j for j in self.read if j.free and not self._joined(*j.bodies, without=j)]

    def _joined(self, a, b, without: _Joint | None = None) -> bool:
        seen, pending = {a}, [a]
        while pending and b not in seen:
            here = pending.pop()
            for joint in self.at[here]:
                if joint is not without:
                    other = joint.bodies[0] if joint.bodies[1] == here else joint.bodies[1]
                    if other not in seen:
                        seen.add(other)
                        pending.append(other)
        return b in seen

    def _mobility(self) -> int:
        """6 a body less the rank of what the joints lock, at the exported pose."""
        driven = {
            path
            for path in self.bodies
            if self.physics.RigidBodyAPI(self.stage.GetPrimAtPath(path)).GetKinematicEnabledAttr().Get()
        }
        number = {path: i for i, path in enumerate(path for path in self.bodies if path not in driven)}
        rows = []
        for joint in self.read:
            world = (np.eye(4) if joint.bodies[0] is None else self.rigid[joint.bodies[0]]) @ joint.frames[0]
            turns = [i for i in joint.free if i >= 3]
            axes = world[:3, :3].copy()
            if len(turns) == 2 and joint.start is not None:  # the first of two turns is fixed in body 1
                other = world[:3, :3] @ joint.start[:3, :3]
                axes[:, turns[0] - 3] = other[:, turns[0] - 3]
                locked = 3 + 4 + 5 - sum(turns)
                axes[:, locked - 3] = np.cross(axes[:, turns[0] - 3], axes[:, turns[1] - 3])
            for i in range(6):
                if i in joint.free:
                    continue
                row = np.zeros((len(number), 6))
                for body, sign in zip(joint.bodies, (-1.0, 1.0)):
                    if body is None or body in driven:
                        continue
                    if i >= 3:
                        row[number[body], 3:] += sign * axes[:, i - 3]
                    else:
                        axis = world[:3, i]
                        row[number[body], :3] += sign * axis
                        row[number[body], 3:] += sign * np.cross(world[:3, 3], axis)
                rows.append(row.ravel())
        return (
            self.added
            + 6 * len(number)
            - (int(np.linalg.matrix_rank(np.array(rows), tol=1e-6)) if rows else 0)
        )

    def poses(self, values: Mapping[str, float]) -> dict[str, Pose]:
        worlds: dict[str, np.ndarray] = {}
        by_joint: dict[str, dict[int, float]] = {}
        for key, value in values.items():
            path, _, freedom = key.rpartition(":")
            by_joint.setdefault(path, {})[int(freedom)] = value
        for start in [None, *self.bodies]:
            if start is not None and start not in worlds:
                worlds[start] = self.rigid[start]
            pending = [start]
            while pending:
                here = pending.pop()
                for joint in self.at[here]:
                    side = joint.bodies.index(here)
                    other = joint.bodies[1 - side]
                    if other is None or other in worlds:
                        continue
                    step = _moved(joint, by_joint.get(joint.path, {}))
                    step = step if side == 0 else np.linalg.inv(step)
                    own = np.eye(4) if here is None else worlds[here]
                    worlds[other] = own @ joint.frames[side] @ step @ np.linalg.inv(joint.frames[1 - side])
                    pending.append(other)
        return self._through_pxr(worlds)

    def _through_pxr(self, worlds: Mapping[str, np.ndarray]) -> dict[str, Pose]:
        """The poses written into the stage, and read back from it."""
        from pxr import Gf

        session = self.stage.GetSessionLayer()
        session.Clear()
        with self.usd.EditContext(self.stage, session):
            for path, world in worlds.items():
                prim = self.stage.GetPrimAtPath(path)
                if prim.IsInstanceProxy():
                    continue
                scaled = world @ np.linalg.inv(self.rigid[path]) @ self.bodies[path]
                xform = self.geom.Xformable(prim)
                op = xform.MakeMatrixXform()
                op.Set(Gf.Matrix4d(*scaled.T.ravel().tolist()))
                xform.SetResetXformStack(True)
        cache = self.geom.XformCache()
        found = {}
        for path in self.bodies:
            prim = self.stage.GetPrimAtPath(path)
            matrix = (
                worlds[path]
                if prim.IsInstanceProxy()
                else _rigid(_columns(cache.GetLocalToWorldTransform(prim)))
            )
            found[path[1:]] = (matrix[:3, :3], matrix[:3, 3])
        session.Clear()
        return found

    def passing(self) -> None:
        """What collides is not asked here."""

    def masses(self) -> dict[str, Mass]:
        leader = {path: path for path in self.bodies} | {None: None}

        def find(path):
            while leader[path] != path:
                path = leader[path]
            return path

        for joint in self.read:
            if not joint.free:
                a, b = (find(body) for body in joint.bodies)
                if a != b:
                    leader[a if b is None else b] = b if b is None else a
        groups: dict[str, list[Mass]] = {}
        for path in self.bodies:
            if (top := find(path)) is not None and (mass := self._mass(path)) is not None:
                groups.setdefault(top, []).append(mass)
        # Bodies that are fixed to each other may stay two in the scene; those that are alone are compared.
        alone = [top for top in groups if sum(find(path) == top for path in self.bodies) == 1]
        return {top[1:]: groups[top][0] for top in alone}

    def _mass(self, path: str) -> Mass | None:
        """None where pxr needs the volume of something that has no formula."""
        prim = self.stage.GetPrimAtPath(path)
        known = [True]

        def told(collider):
            info = self.physics.RigidBodyAPI.MassInformation()
            solid = _solid(
                collider, self.geom, _columns(self.geom.XformCache().GetLocalToWorldTransform(collider))
            )
            if solid is None:
                known[0] = False
                info.volume = -1.0
                return info
            volume, moments, turned = solid
            from pxr import Gf

            cache = self.geom.XformCache()
            world = _columns(cache.GetLocalToWorldTransform(collider))
            local = np.linalg.inv(self.rigid[path]) @ _rigid(world)
            inertia = turned @ np.diag(moments) @ turned.T
            info.volume = volume
            info.inertia = Gf.Matrix3f(*inertia.ravel().tolist())
            info.centerOfMass = Gf.Vec3f(0.0)
            info.localPos = Gf.Vec3f(*local[:3, 3].tolist())
            turn = Gf.Matrix3d(*local[:3, :3].T.ravel().tolist()).ExtractRotation().GetQuat()
            info.localRot = Gf.Quatf(turn)
            return info

        mass, inertia, center, axes = self.physics.RigidBodyAPI(prim).ComputeMassProperties(told)
        if not known[0] or not mass > 0.0:
            return None
        turn = self.rigid[path][:3, :3] @ _turn(axes)
        return Mass(
            mass * self.kilograms,
            (self.rigid[path] @ [*center, 1.0])[:3],
            turn @ np.diag(np.array(inertia, dtype=float)) @ turn.T * self.kilograms * self.length**2,
        )


def _solid(prim, geom, world) -> tuple[float, np.ndarray, np.ndarray] | None:
    """Volume, principal moments at density 1 and their axes of a gprim, in its own scaled axes."""
    scale = np.linalg.norm(world[:3, :3], axis=0)
    if prim.IsA(geom.Cube):
        a = geom.Cube(prim).GetSizeAttr().Get() * scale
        return float(a.prod()), a.prod() / 12.0 * (a @ a - a * a), np.eye(3)
    if prim.IsA(geom.Sphere):
        r = geom.Sphere(prim).GetRadiusAttr().Get() * scale.max()
        volume = 4.0 / 3.0 * math.pi * r**3
        return volume, np.full(3, 0.4 * volume * r * r), np.eye(3)
    for schema, round_ends in ((geom.Cylinder, False), (geom.Capsule, True)):
        if not prim.IsA(schema):
            continue
        axis = "XYZ".index(schema(prim).GetAxisAttr().Get())
        r = schema(prim).GetRadiusAttr().Get() * np.delete(scale, axis).max()
        h = schema(prim).GetHeightAttr().Get() * scale[axis]
        tube = math.pi * r * r * h
        along, across = tube * r * r / 2.0, tube * (r * r / 4.0 + h * h / 12.0)
        volume = tube
        if round_ends:
            half = 2.0 / 3.0 * math.pi * r**3  # each cap
            volume += 2.0 * half
            along += 2.0 * half * 0.4 * r * r
            # A half ball about its own centre of mass, which is 3/8 r from its flat side.
            across += 2.0 * half * (0.4 * r * r - (0.375 * r) ** 2 + (0.5 * h + 0.375 * r) ** 2)
        moments = np.full(3, across)
        moments[axis] = along
        return volume, moments, np.eye(3)
    return None


def _moved(joint: _Joint, values: Mapping[int, float]) -> np.ndarray:
    """Pose of the second frame in the first, at coordinates; what is not given is as exported.

    Locked freedoms are met exactly, as a solver would, but for what is fixed and for turns about several axes.
    """
    turns = [i for i in joint.free if i >= 3]
    if not joint.free:
        return joint.start.copy()
    step = np.eye(4)
    if len(turns) > 1:
        step[:3, :3] = (
            _two_turns(joint.start[:3, :3], *(i - 3 for i in turns))
            if len(turns) == 2
            else joint.start[:3, :3]
        )
        turns = []
    for i in joint.free:
        value = values.get(i, _reading(joint.start, i))
        if i < 3:
            step[i, 3] = value
        if i not in turns:
            continue
        j, k = (i - 3 + 1) % 3, (i - 3 + 2) % 3
        step[j, j] = step[k, k] = math.cos(value)
        step[k, j], step[j, k] = math.sin(value), -math.sin(value)
    return step


def _two_turns(r: np.ndarray, i: int, j: int) -> np.ndarray:
    """The nearest R_j(b) R_i(a), which locks the third axis."""

    def turn(axis: int, cosine: float, sine: float) -> np.ndarray:
        p, q, found = (axis + 1) % 3, (axis + 2) % 3, np.eye(3)
        size = math.hypot(cosine, sine)
        found[p, p] = found[q, q] = cosine / size
        found[q, p], found[p, q] = sine / size, -sine / size
        return found

    p, q = (j + 1) % 3, (j + 2) % 3
    outer = turn(j, r[p, p], r[q, p]) if i == p else turn(j, r[q, q], -r[p, q])
    p, q = (i + 1) % 3, (i + 2) % 3
    return outer @ (turn(i, r[p, p], -r[p, q]) if j == p else turn(i, r[q, q], r[q, p]))


def _reading(start: np.ndarray, i: int) -> float:
    if i < 3:
        return float(start[i, 3])
    j, k = (i - 3 + 1) % 3, (i - 3 + 2) % 3
    return math.atan2(start[k, j], start[j, j])


def _columns(matrix) -> np.ndarray:
    return np.array(matrix, dtype=float).T


def _rigid(matrix: np.ndarray) -> np.ndarray:
    """Without scale and shear, as Gf factors it."""
    from pxr import Gf

    return _columns(Gf.Matrix4d(*matrix.T.ravel().tolist()).RemoveScaleShear())


def _turn(quaternion) -> np.ndarray:
    w, (x, y, z) = float(quaternion.GetReal()), (float(v) for v in quaternion.GetImaginary())
    n = math.sqrt(w * w + x * x + y * y + z * z)
    w, x, y, z = w / n, x / n, y / n, z / n
    k = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + 2.0 * (w * k + k @ k)


def load(path: Path, packages: tuple[Path, ...]) -> Stage:
    return Stage(path)
