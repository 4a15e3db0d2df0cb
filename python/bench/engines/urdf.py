"""Pinocchio on URDF: the base is fixed to the world, floating and planar joints move as they are.

A xacro is expanded by the xacro package, with the arguments that it states itself; its packages are found by the name in
their ``package.xml``, below the folders given or the nearest folder above that has any.
"""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, redirect_stderr
from io import StringIO
from pathlib import Path

import numpy as np

from . import EngineJoint, Mass, Pose, Refused, without_prefixes

NAME = "pinocchio"
FORMATS = ("URDF",)
ROS = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])


class PinocchioModel:
    """A URDF file in Pinocchio.  Mimics are applied here: Pinocchio's own reader takes them or not by version."""

    turn, length = ROS, 1.0
    slack = (0.0, 0.0)

    def __init__(self, path: Path, packages: tuple[Path, ...] = ()) -> None:
        import pinocchio

        self.pin = pinocchio
        text = path.read_text(encoding="utf-8", errors="replace")
        if path.suffix == ".xacro" or "xmlns:xacro" in text and "<xacro:" in text:
            text = expanded(path, packages)
        try:
            self.model = pinocchio.buildModelFromXML(
                re.sub(r"<mimic\b[^>]*?(/>|>.*?</mimic>)", "", text, flags=re.S)
            )
        except Exception as error:
            raise Refused(str(error)) from None
        if self.model.njoints == 1 and self.model.nframes <= 1:
            raise Refused("no links")
        self.mimics, self.joined = _mimics(text), _joined(text)
        held = [i for i in range(1, self.model.njoints) if self._is_held(i)]
        if held:  # a range of one value is no motion: what it holds moves as one
            at = self._configuration({})
            try:
                self.model = pinocchio.buildReducedModel(self.model, held, at)
            except ValueError as error:  # a link and a joint of one name
                raise Refused(str(error)) from None
            self.mimics = {k: v for k, v in self.mimics.items() if self.model.existJointName(k)}
        self.data = self.model.createData()
        self.start = self._configuration({})
        self.joints = [j for i in range(1, self.model.njoints) for j in self._coordinates(i)]
        self.mobility = self.model.nv - len(self.mimics)

    def _coordinates(self, index: int) -> list[EngineJoint]:
        joint, name = self.model.joints[index], self.model.names[index]
        if name in self.mimics or joint.nv != 1:
            return []
        pin = self.pin
        pin.computeJointJacobians(self.model, self.data, self.start)
        jacobian = pin.getJointJacobian(self.model, self.data, index, pin.LOCAL_WORLD_ALIGNED)
        column = jacobian.reshape(6, -1)[:, joint.idx_v]  # one column comes as a vector
        is_angle = np.linalg.norm(column[3:]) > 0.5
        low, high = self._limits(joint)
        axis = column[3:] if is_angle else column[:3]
        start = self._resting(name)
        return [EngineJoint(name, name, self._child(index), bool(is_angle), axis, low, high, start)]

    def _is_held(self, index: int) -> bool:
        joint, name = self.model.joints[index], self.model.names[index]
        while name in self.mimics:
            if self.mimics[name][1] == 0.0 or not self.model.existJointName(self.mimics[name][0]):
                return True
            name = self.mimics[name][0]
            joint = self.model.joints[self.model.getJointId(name)]
        return joint.nq == 1 and self._limits(joint)[0] == self._limits(joint)[1]

    def _limits(self, joint) -> tuple[float, float]:
        if joint.nq != 1:
            return -math.inf, math.inf
        low = float(self.model.lowerPositionLimit[joint.idx_q])
        high = float(self.model.upperPositionLimit[joint.idx_q])
        # Pinocchio keeps a reversed range as it stands, in which no coordinate is: Bullet's word for none.
        return (low, high) if low <= high else (-math.inf, math.inf)

    def _resting(self, name: str) -> float:
        """Zero, or the end of the range next to it."""
        if not self.model.existJointName(name):
            return 0.0
        joint = self.model.joints[self.model.getJointId(name)]
        if joint.nq == 1 and name not in self.mimics:
            low, high = self._limits(joint)
            return min(max(0.0, low), high)
        return 0.0

    def _child(self, index: int) -> str:
        return next(f.name for f in self.model.frames if f.parentJoint == index and f.type == self.pin.BODY)

    def _configuration(self, values: Mapping[str, float]) -> np.ndarray:
        known = {name: self._resting(name) for name in self.model.names[1:]} | dict(values)
        for name in self.mimics:
            known[name] = _followed(name, self.mimics, known)
        q = self.pin.neutral(self.model)
        for name, value in known.items():
            joint = self.model.joints[self.model.getJointId(name)]
            if joint.nq == 1:
                q[joint.idx_q] = value
            elif joint.nq == 2:
                q[joint.idx_q : joint.idx_q + 2] = math.cos(value), math.sin(value)
        return q

    def poses(self, values: Mapping[str, float]) -> dict[str, Pose]:
        self.pin.framesForwardKinematics(self.model, self.data, self._configuration(values))
        return {
            frame.name: (self.data.oMf[i].rotation.copy(), self.data.oMf[i].translation.copy())
            for i, frame in enumerate(self.model.frames)
            if frame.type == self.pin.BODY
        }

    def passing(self) -> set[frozenset[str]]:
        """URDF's own rule: what a joint connects."""
        return self.joined

    def masses(self) -> dict[str, Mass]:
        self.pin.forwardKinematics(self.model, self.data, self._configuration({}))
        found = {}
        for index in range(1, self.model.njoints):
            inertia, place = self.model.inertias[index], self.data.oMi[index]
            turned = place.rotation @ inertia.inertia @ place.rotation.T
            center = place.rotation @ inertia.lever + place.translation
            found[self._child(index)] = Mass(inertia.mass, center, turned)
        return found


def _joined(text: str) -> set[frozenset[str]]:
    """Pairs of links with collisions that a joint connects."""
    root = ElementTree.fromstring(without_prefixes(text))
    shaped = {link.get("name", "") for link in root.iter("link") if link.find("collision") is not None}
    ends = [[joint.find(end) for end in ("parent", "child")] for joint in root.findall("joint")]
    pairs = {frozenset(end.get("link", "") for end in pair if end is not None) for pair in ends}
    return {pair for pair in pairs if len(pair) == 2 and pair <= shaped}


def _mimics(text: str) -> dict[str, tuple[str, float, float]]:
    """Joint to the one that it follows, multiplier and offset."""
    found = {}
    bare = re.sub(r"^\s*<\?xml.*?\?>", "", without_prefixes(text), flags=re.S)  # Pinocchio takes any
    joints = list(ElementTree.fromstring(bare.encode("utf-8", "replace")).iter("joint"))
    names = {joint.get("name") for joint in joints}
    for joint in joints:
        mimic = joint.find("mimic")
        if mimic is not None and mimic.get("joint") not in names:
            continue  # follows nothing: free, which the report tells
        if mimic is not None and joint.get("type") in ("revolute", "continuous", "prismatic"):
            numbers = (float(mimic.get("multiplier", 1.0)), float(mimic.get("offset", 0.0)))
            found[joint.get("name", "")] = (mimic.get("joint", ""), *numbers)
    return found


def _followed(name: str, mimics: Mapping[str, tuple[str, float, float]], known: Mapping[str, float]) -> float:
    leader, multiplier, offset = mimics[name]
    value = _followed(leader, mimics, known) if leader in mimics else known.get(leader, 0.0)
    return multiplier * value + offset


def expanded(path: Path, packages: tuple[Path, ...]) -> str:
    """The URDF that a xacro makes.  Raises Refused where it makes none, ImportError without the xacro package."""
    import xacro
    import xacro.substitution_args as substitution

    try:
        with _finding(substitution, path, packages), redirect_stderr(StringIO()):
            return str(xacro.process_file(str(path)).toprettyxml())
    except Exception as error:  # xacro evaluates Python in the file, which may raise anything
        raise Refused(f"xacro: {error}") from None


@contextmanager
def _finding(substitution, path: Path, packages: tuple[Path, ...]) -> Iterator[None]:
    """``$(find NAME)`` without a ROS that could be asked."""

    def find(name: str) -> str:
        for root in (*packages, *path.parents[:4]):
            for stated in root.rglob("package.xml"):
                if re.search(rf"<name>\s*{re.escape(name)}\s*</name>", stated.read_text(errors="replace")):
                    return str(stated.parent)
        raise LookupError(f"no package {name}")

    before = substitution._eval_find
    substitution._eval_find = find
    try:
        yield
    finally:
        substitution._eval_find = before


def load(path: Path, packages: tuple[Path, ...]) -> PinocchioModel:
    return PinocchioModel(path, packages)
