"""Bodies, colliders and joints in KHR_physics_rigid_bodies (draft), shapes in KHR_implicit_shapes.

A joint stands on a node at a's joint frame and names a node at b's: its limits and drives are of b in a, along and about a's
axes, as the model has them.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...diagnostics import Report
from ...geometry.mass import principal
from ...model import (
    MOTOR_DAMPING,
    RX,
    Collider,
    ColliderKind,
    Drive,
    Freedom,
    Joint,
    MassProperties,
    Mesh,
    Motion,
    PhysicsMaterial,
)
from ...spatial import Pose, bounds, quaternion_from_matrix, rotation_about

BODIES, SHAPES = "KHR_physics_rigid_bodies", "KHR_implicit_shapes"
ALONG_Y = rotation_about(np.array([1.0, 0.0, 0.0]), math.pi / 2)
"""Turns Y, along which glTF's round shapes lie, to Z, along which the model's do."""


class PhysicsEntries:
    """The document's shapes, physics materials, joint descriptions and collision filters, each once."""

    def __init__(self, report: Report):
        self._report = report
        self.shapes: list[dict[str, Any]] = []
        self.materials: list[dict[str, Any]] = []
        self.joints: list[dict[str, Any]] = []
        self.filters: list[dict[str, Any]] = []

    def used(self) -> dict[str, Any]:
        """The document's ``extensions``."""
        found: dict[str, Any] = {}
        lists = {
            "physicsMaterials": self.materials,
            "physicsJoints": self.joints,
            "collisionFilters": self.filters,
        }
        if bodies := {key: value for key, value in lists.items() if value}:
            found[BODIES] = bodies
        if self.shapes:
            found[SHAPES] = {"shapes": self.shapes}
        return found

    def geometry(self, collider: Collider) -> dict[str, Any]:
        """Of an implicit shape."""
        radii = {"radiusTop": collider.radius, "radiusBottom": collider.radius}
        sizes: dict[ColliderKind, dict[str, Any]] = {
            ColliderKind.BOX: {"size": list(collider.size)},
            ColliderKind.SPHERE: {"radius": collider.radius},
            ColliderKind.CAPSULE: {"height": collider.length, **radii},
            ColliderKind.CYLINDER: {"height": collider.length, **radii},
        }
        kind = collider.kind.value
        return {"shape": _index(self.shapes, {"type": kind, kind: sizes[collider.kind]})}

    def material(self, material: PhysicsMaterial) -> int:
        return _index(
            self.materials,
            {
                "staticFriction": material.static_friction,
                "dynamicFriction": material.dynamic_friction,
                "restitution": material.restitution,
                "frictionCombine": material.friction_combine.value,
                "restitutionCombine": material.restitution_combine.value,
            },
        )

    def joint(self, joint: Joint) -> int:
        """The description of a joint's limits and drives; the report tells what it has no field for.  joint: its drives as
        ``with_passive_drives`` leaves them."""
        feature = f"joint {joint.id}"
        limits = [limit for i, f in enumerate(joint.freedoms) if (limit := _limit(i, f)) is not None]
        limits = _merged(limits)
        drives = [_drive(i, f.drive) for i, f in enumerate(joint.freedoms) if f.drive is not None]
        told: list[tuple[str, bool]] = [
            ("friction", any(f.passive is not None and f.passive.friction for f in joint.freedoms)),
            ("armature", any(f.passive is not None and f.passive.armature for f in joint.freedoms)),
            ("restitution", any(f.restitution for f in joint.freedoms)),
            ("break force", math.isfinite(joint.break_force) or math.isfinite(joint.break_torque)),
            ("spherical drive", joint.slerp is not None),
        ]
        for field, there in told:
            if there:
                self._report.field_dropped(feature, field, ".glb", joint.where)
        self._report.kept(feature, joint.where)
        entry: dict[str, Any] = {"limits": limits}  # some readers want the list where it is empty, too
        if drives:
            entry["drives"] = drives
        self.joints.append(entry)
        return len(self.joints) - 1


def motion(mass: MassProperties, *, kinematic: bool, gravity: bool) -> dict[str, Any]:
    """A body's motion, in its node's frame."""
    moments, axes = principal(mass.inertia)
    entry: dict[str, Any] = {
        "mass": mass.mass,
        "centerOfMass": mass.center.tolist(),
        "inertiaDiagonal": moments.tolist(),
        "inertiaOrientation": quaternion_from_matrix(axes).tolist(),
    }
    if kinematic:
        entry["isKinematic"] = True
    if not gravity:
        entry["gravityFactor"] = 0.0
    return entry


def bounding_box(mesh: Mesh) -> Collider:
    """About a mesh, in its own frame."""
    low, high = bounds(mesh.vertices)
    x, y, z = (high - low).tolist()
    return Collider(ColliderKind.BOX, Pose(np.eye(3), 0.5 * (low + high)), size=(x, y, z))


def shape_pose(collider: Collider) -> Pose:
    """Where glTF's shape stands in the node's frame."""
    if collider.kind in (ColliderKind.CAPSULE, ColliderKind.CYLINDER):
        return Pose(collider.pose.rotation @ ALONG_Y, collider.pose.translation)
    return Pose(translation=collider.pose.translation) if collider.kind is ColliderKind.SPHERE else collider.pose


def _index(entries: list[dict[str, Any]], entry: dict[str, Any]) -> int:
    if entry not in entries:
        entries.append(entry)
    return entries.index(entry)


def _limit(index: int, freedom: Freedom) -> dict[str, Any] | None:
    axes = {"angularAxes" if index >= RX else "linearAxes": [index % 3]}
    if freedom.motion is Motion.LOCKED:
        return axes | {"min": 0.0, "max": 0.0}
    if freedom.motion is Motion.FREE:
        return None
    entry: dict[str, Any] = dict(axes)
    if math.isfinite(freedom.lower):
        entry["min"] = freedom.lower
    if math.isfinite(freedom.upper):
        entry["max"] = freedom.upper
    if freedom.stiffness:
        entry["stiffness"] = freedom.stiffness
    if freedom.damping:
        entry["damping"] = freedom.damping
    return entry if len(entry) > 1 else None


def _merged(limits: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Locked axes of one kind in one limit: what is 0 in each is 0 together."""
    found: list[dict[str, Any]] = []
    for kind in ("linearAxes", "angularAxes"):
        own = [limit for limit in limits if kind in limit]
        locked = [
            limit for limit in own if (limit.get("min"), limit.get("max")) == (0.0, 0.0) and len(limit) == 3
        ]
        if locked:
            found.append({kind: [limit[kind][0] for limit in locked], "min": 0.0, "max": 0.0})
        found += [limit for limit in own if limit not in locked]
    return found


def _drive(index: int, drive: Drive) -> dict[str, Any]:
    entry: dict[str, Any] = {
        "type": "angular" if index >= RX else "linear",
        "mode": "acceleration" if drive.acceleration else "force",
        "axis": index % 3,
        "positionTarget": drive.target,
        "velocityTarget": drive.target_velocity,
        "stiffness": 0.0 if drive.motor else drive.stiffness,
        "damping": MOTOR_DAMPING if drive.motor else drive.damping,
    }
    if math.isfinite(drive.max_force):
        entry["maxForce"] = drive.max_force
    return entry
