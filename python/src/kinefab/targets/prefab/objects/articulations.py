"""ArticulationBodies: links in reduced coordinates, whose locked freedoms cannot drift."""

from __future__ import annotations

import math
from dataclasses import replace

from ....unity.scene import ArticulationBody, ArticulationDrive
from ..text.dialects import Dialect
from ..text.documents import component_head, layers, version
from ..text.yaml import Fields, placed, vector
from .bodies import DETECTION, LEAST_INERTIA

CLASS = (171741748, "ArticulationBody")
TYPES = {"Fixed": 0, "Prismatic": 1, "Revolute": 2, "Spherical": 3}
DRIVES = {"Force": 0, "Acceleration": 1, "Target": 2, "Velocity": 3}
LOCKS = {"Locked": 0, "Limited": 1, "Free": 2}
UNLIMITED_FORCE = 3.4028235e38
"""What the editor writes for a link's drive without a largest force; of a joint's it is the float below."""
BACKWARDS = ("Prismatic",)
"""Links that run against their drive's ``targetVelocity``: PhysX 4.1 negates it for slides (NVIDIAGameWorks/PhysX#411).  6000.0.68 and
6000.3.9 mended that (UUM-113920) with version 6 of the class, so in the versions that we write the number has the other sign."""


def articulation_fields(body: ArticulationBody, owner: int, dialect: Dialect) -> Fields:
    mass: Fields = {}
    if dialect.mass_properties:
        mass = {
            "m_CenterOfMass": placed(body.centerOfMass),
            "m_InertiaTensor": vector([m if m > 0.0 else LEAST_INERTIA for m in body.inertiaTensor]),
            "m_InertiaRotation": placed(body.inertiaTensorRotation),
            **layers(True),
            "m_ImplicitCom": 0,
            "m_ImplicitTensor": 0,
        }
    along_x = body.xDrive
    if body.jointType in BACKWARDS:
        along_x = replace(along_x, targetVelocity=-along_x.targetVelocity)
    return {
        **component_head(owner),
        "m_Enabled": 1,
        **version(dialect.articulation),
        "m_Mass": float(body.mass),
        "m_ParentAnchorPosition": placed(body.parentAnchorPosition),
        "m_ParentAnchorRotation": placed(body.parentAnchorRotation),
        "m_AnchorPosition": placed(body.anchorPosition),
        "m_AnchorRotation": placed(body.anchorRotation),
        "m_MatchAnchors": 1,
        "m_ArticulationJointType": TYPES[body.jointType],
        "m_LinearX": LOCKS[body.linearLock],
        "m_LinearY": 0,
        "m_LinearZ": 0,
        "m_SwingY": LOCKS[body.swingYLock],
        "m_SwingZ": LOCKS[body.swingZLock],
        "m_Twist": LOCKS[body.twistLock],
        "m_XDrive": _drive(along_x, dialect),
        "m_YDrive": _drive(body.yDrive, dialect),
        "m_ZDrive": _drive(body.zDrive, dialect),
        "m_LinearDamping": float(body.linearDamping),
        "m_AngularDamping": float(body.angularDamping),
        "m_JointFriction": float(body.jointFriction),
        **mass,
        "m_Immovable": body.immovable,
        "m_UseGravity": body.useGravity,
        "m_CollisionDetectionMode": DETECTION[body.collisionDetectionMode],
    }


def _drive(drive: ArticulationDrive, dialect: Dialect) -> Fields:
    force = UNLIMITED_FORCE if math.isinf(drive.forceLimit) else drive.forceLimit
    kind: Fields = {"driveType": DRIVES[drive.driveType]} if dialect.mass_properties else {}
    return {
        "lowerLimit": round(float(drive.lowerLimit), 12),
        "upperLimit": round(float(drive.upperLimit), 12),
        "stiffness": float(drive.stiffness),
        "damping": float(drive.damping),
        "forceLimit": float(force),
        "target": round(float(drive.target), 12),
        "targetVelocity": float(drive.targetVelocity),
        **kind,
    }
