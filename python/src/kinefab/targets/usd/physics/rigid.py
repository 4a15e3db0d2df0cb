"""RigidBodyAPI and MassAPI of a body's prim."""

from __future__ import annotations

import math

import numpy as np

from ....diagnostics import Report
from ....geometry.mass import principal
from ....model import MassProperties, Scene
from ....spatial import quaternion_from_matrix
from ....unity.bodies.rigidbodies import body_dynamics, body_mass
from ..prims import Prim, quaternion32, vector3f


def write_moving(prim: Prim, scene: Scene, node: int, members: tuple[int, ...], report: Report) -> None:
    """A body that forces or scripts move; members: the nodes that it carries."""
    prim.apply("PhysicsRigidBodyAPI", "PhysicsMassAPI")
    dynamics = body_dynamics(scene, node, members)
    if dynamics.kinematic:
        prim.attribute("physics:kinematicEnabled", "Bool", True)
    to_body = scene.nodes[node].pose.rotation.T
    if dynamics.velocity is not None:
        prim.attribute("physics:velocity", "Vector3f", vector3f(to_body @ dynamics.velocity))
    if dynamics.angular_velocity is not None:
        spin = np.degrees(to_body @ dynamics.angular_velocity)
        prim.attribute("physics:angularVelocity", "Vector3f", vector3f(spin))
    damping = {"linearDamping": dynamics.linear_damping, "angularDamping": dynamics.angular_damping}
    stated = {f"physxRigidBody:{name}": value for name, value in damping.items() if value is not None}
    if dynamics.max_angular_velocity is not None:
        stated["physxRigidBody:maxAngularVelocity"] = math.degrees(dynamics.max_angular_velocity)
    if stated or not dynamics.gravity:
        prim.apply("PhysxRigidBodyAPI")
        prim.numbers(stated)
        if not dynamics.gravity:
            prim.attribute("physxRigidBody:disableGravity", "Bool", True)
    _write_mass(prim, body_mass(scene, node, members, report))


def write_grounded(prim: Prim, scene: Scene, node: int, members: tuple[int, ...], report: Report) -> None:
    """A body that a joint fixes to the world.  Its mass moves nothing; where none is known none is said."""
    prim.apply("PhysicsRigidBodyAPI")
    if any(scene.nodes[i].mass is not None for i in members):
        prim.apply("PhysicsMassAPI")
        _write_mass(prim, body_mass(scene, node, members, report))


def _write_mass(prim: Prim, mass: MassProperties) -> None:
    moments, axes = principal(mass.inertia)
    prim.numbers({"physics:mass": mass.mass})
    prim.attribute("physics:centerOfMass", "Point3f", vector3f(mass.center))
    prim.attribute("physics:diagonalInertia", "Float3", vector3f(moments))
    prim.attribute("physics:principalAxes", "Quatf", quaternion32(quaternion_from_matrix(axes)))
