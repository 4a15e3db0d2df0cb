"""Drake on SDF: bodies free unless something ties them to the world."""

from __future__ import annotations

import logging
import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from . import EngineJoint, Mass, Pose, Refused, without_prefixes

NAME = "drake"
FORMATS = ("SDF",)
ROS = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])


class DrakePlant:
    """An SDF file in Drake.  Mimics are followed here, as Drake only constrains its dynamics by them."""

    turn, length = ROS, 1.0
    slack = (0.0, 0.0)

    def __init__(self, path: Path, packages: tuple[Path, ...]) -> None:
        from pydrake.multibody.parsing import Parser
        from pydrake.multibody.plant import MultibodyPlant

        logging.getLogger("drake").setLevel(logging.CRITICAL)
        self.plant = MultibodyPlant(1e-3)
        parser = Parser(self.plant)
        for folder in packages:
            parser.package_map().PopulateFromFolder(str(folder))
        try:
            self.indices = parser.AddModels(str(path))
            self.plant.Finalize()
        except Exception as error:
            raise Refused(str(error)) from None
        if self.plant.num_bodies() <= 1:
            raise Refused("no bodies")
        self.context = self.plant.CreateDefaultContext()
        self.start = self.plant.GetPositions(self.context).copy()
        self.all = [self.plant.get_joint(i) for i in self.plant.GetJointIndices()]
        self.followers = self._followers(path)
        self.joints = [found for joint in self.all if (found := self._coordinate(joint)) is not None]
        self.held = [j for j in self.all if j.num_positions() == 1 and self._width(j) == 0.0]
        self.mobility = self.plant.num_velocities() - len(self.followers) - len(self.held)

    def _followers(self, path: Path) -> dict[str, tuple[str, float, float]]:
        import xml.etree.ElementTree as ElementTree

        found = {}
        text = path.read_text(encoding="utf-8", errors="replace").lstrip()
        try:
            root = ElementTree.fromstring(without_prefixes(text).encode())
        except ElementTree.ParseError:  # Drake minds less; mimics in such a file are not followed
            return found
        for joint in root.iter("joint"):
            mimic = joint.find("axis/mimic")
            if mimic is not None:
                factor, offset, reference = (
                    float(mimic.findtext(tag, default))
                    for tag, default in (("multiplier", "1"), ("offset", "0"), ("reference", "0"))
                )
                found[joint.get("name", "")] = (mimic.get("joint", ""), factor, offset - factor * reference)
        return found

    @staticmethod
    def _width(joint) -> float:
        return float(joint.position_upper_limits()[0]) - float(joint.position_lower_limits()[0])

    def name_of(self, body) -> str:
        model = self.plant.GetModelInstanceName(body.model_instance())
        return f"{model.replace('::', '/')}/{body.name()}"

    def _key(self, joint) -> str:
        return f"{self.plant.GetModelInstanceName(joint.model_instance())}::{joint.name()}"

    def _coordinate(self, joint) -> EngineJoint | None:
        if joint.num_velocities() != 1 or joint.name() in self.followers or self._width(joint) == 0.0:
            return None
        from pydrake.multibody.tree import JacobianWrtVariable

        world = self.plant.world_frame()
        child = joint.frame_on_child()
        jacobian = self.plant.CalcJacobianSpatialVelocity(
            self.context, JacobianWrtVariable.kV, child, np.zeros(3), world, world
        )
        column = jacobian[:, joint.velocity_start()]
        is_angle = bool(np.linalg.norm(column[:3]) > 1e-9)
        axis = column[:3] if is_angle else column[3:]
        low, high = joint.position_lower_limits()[0], joint.position_upper_limits()[0]
        # SDF's own default, which is written out too, is 1e16 for none.
        low, high = (math.copysign(math.inf, end) if abs(end) >= 1e16 else end for end in (low, high))
        return EngineJoint(
            joint.name(), self._key(joint), self.name_of(joint.child_body()), is_angle,
            axis / np.linalg.norm(axis), float(low), float(high),
        )  # fmt: skip

    def poses(self, values: Mapping[str, float]) -> dict[str, Pose]:
        known = dict(values)
        for joint in self.all if values else ():
            if joint.name() in self.followers:
                leader, factor, offset = self.followers[joint.name()]
                model, _, _ = self._key(joint).rpartition("::")
                known[self._key(joint)] = factor * known.get(f"{model}::{leader}", 0.0) + offset
        q = self.start.copy()
        for joint in self.all:
            if self._key(joint) in known and joint.num_positions() == 1:
                q[joint.position_start()] = known[self._key(joint)]
        self.plant.SetPositions(self.context, q)
        found = {}
        for body in self._bodies():
            pose = self.plant.EvalBodyPoseInWorld(self.context, body)
            found[self.name_of(body)] = (pose.rotation().matrix(), pose.translation())
        return found

    def _bodies(self):
        bodies = [self.plant.get_body(i) for m in self.indices for i in self._all_of(m)]
        return [body for body in bodies if body.name() != "world"]

    def _all_of(self, model):
        whole = self.plant.GetModelInstanceName(model)
        for index in range(self.plant.num_model_instances()):
            from pydrake.multibody.tree import ModelInstanceIndex

            name = self.plant.GetModelInstanceName(ModelInstanceIndex(index))
            if name == whole or name.startswith(f"{whole}::"):
                yield from self.plant.GetBodyIndices(ModelInstanceIndex(index))

    def passing(self) -> None:
        """What collides is not asked here."""

    def masses(self) -> dict[str, Mass]:
        if self.held:
            return {}  # what a range of one value holds together is one body there, and several here
        self.plant.SetPositions(self.context, self.start)
        found, done = {}, set()
        grounded = {b.index() for b in self.plant.GetBodiesWeldedTo(self.plant.world_body())}
        for body in self._bodies():
            if body.index() in done or body.index() in grounded:
                continue
            together = self.plant.GetBodiesWeldedTo(body)
            done |= {b.index() for b in together}
            parts = []
            for b in together:
                inertia = b.CalcSpatialInertiaInBodyFrame(self.context)
                pose = self.plant.EvalBodyPoseInWorld(self.context, b)
                r = pose.rotation().matrix()
                about = inertia.Shift(inertia.get_com()).CalcRotationalInertia().CopyToFullMatrix3()
                parts.append(
                    (inertia.get_mass(), pose.translation() + r @ inertia.get_com(), r @ about @ r.T)
                )
            mass = sum(p[0] for p in parts)
            center = sum(p[0] * p[1] for p in parts) / mass
            whole = sum(
                p[2] + p[0] * (np.dot(d := p[1] - center, d) * np.eye(3) - np.outer(d, d)) for p in parts
            )
            found[self.name_of(body)] = Mass(mass, center, whole)
        return found


def load(path: Path, packages: tuple[Path, ...]) -> DrakePlant:
    return DrakePlant(path, packages)
