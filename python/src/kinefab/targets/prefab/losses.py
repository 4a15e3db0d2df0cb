"""What a prefab cannot hold, told by name."""

from __future__ import annotations

from collections.abc import Iterable

from ...diagnostics import Report
from ...unity.assets.meshes import mesh_name
from ...unity.links.motions import RUNTIME
from ...unity.scene import (
    ArticulationBody,
    BoxCollider,
    CapsuleCollider,
    Collider,
    ConfigurableJoint,
    Coupling,
    HingeJoint,
    Joint,
    MeshFilter,
    Physics,
    Rigidbody,
    SphereCollider,
    UnityScene,
)
from .meshes import is_colored
from .options import PrefabOptions
from .text.dialects import Pipeline

TARGET = "a prefab"
SETTINGS = {"gravity", "fixedTimestep", "solverIterations", "solverVelocityIterations"}
"""Of the project: a prefab cannot change them."""


def tell_losses(scene: UnityScene, options: PrefabOptions, report: Report) -> None:
    """Tell what the scene holds and the prefab, with these options, has no field for."""
    for entry in scene.gameObjects:
        for component in entry.components:
            if isinstance(component, Rigidbody) and not component.isKinematic:
                _tell_rigidbody(component, entry.id, options, report)
            if isinstance(component, ArticulationBody):
                _tell_link(component, entry.id, options, report)
            if isinstance(component, Joint) and not options.dialect.mass_properties:
                _tell_joint_of_2021(component, entry.id, report)
    for name in sorted(SETTINGS):
        value = getattr(scene.physics, name)
        if value != getattr(Physics(), name):
            words = ", ".join(f"{x:g}" for x in (value if isinstance(value, tuple) else (value,)))
            report.dropped(f"project setting {name}", "TARGET_PROJECT_SETTING", setting=name, value=words)
    _tell_unshown(scene, options, report)


def _tell_unshown(scene: UnityScene, options: PrefabOptions, report: Report) -> None:
    """What the assets have and the pipelines' standard shaders do not look at."""
    if options.pipeline is Pipeline.BUILTIN:
        for material in scene.materials:
            if material.doubleSided:
                told = {"shader": "Unity's Standard shader"}
                report.approximated(f"other side of material {material.name}", "LOOK_NOT_SHOWN", **told)
    shown = {c.mesh for entry in scene.gameObjects for c in entry.components if isinstance(c, MeshFilter)}
    for index in sorted(shown):
        if is_colored(scene.meshes, index):
            feature = f"vertex colours of mesh {mesh_name(scene.meshes, index)}"
            report.approximated(feature, "LOOK_NOT_SHOWN", shader=f"the {options.pipeline.value} shader")


def _tell_rigidbody(body: Rigidbody, owner: str, options: PrefabOptions, report: Report) -> None:
    for name in RUNTIME:
        if getattr(body, name) is not None:
            report.field_dropped(f"Rigidbody of {owner}", name, TARGET)
    if not options.dialect.mass_properties:
        report.dropped(f"centre of mass and inertia of {owner}", "TARGET_MASS_DROPPED", object=owner)


def _tell_link(link: ArticulationBody, owner: str, options: PrefabOptions, report: Report) -> None:
    if link.maxJointVelocity is not None:  # which Unity takes from a script only
        report.field_dropped(f"link {owner}", "maxJointVelocity", TARGET)
    if options.dialect.mass_properties:
        return
    if not link.immovable:
        report.dropped(f"centre of mass and inertia of {owner}", "TARGET_MASS_DROPPED", object=owner)
    if any(drive.driveType != "Force" for drive in (link.xDrive, link.yDrive, link.zDrive)):
        report.field_dropped(f"link {owner}", "useAcceleration", f"{TARGET} of Unity 2021")


def _tell_joint_of_2021(joint: Joint, owner: str, report: Report) -> None:
    """What came with 2022.2."""
    accelerated = False
    if isinstance(joint, ConfigurableJoint):
        drives = (
            joint.xDrive,
            joint.yDrive,
            joint.zDrive,
            joint.angularXDrive,
            joint.angularYZDrive,
            joint.slerpDrive,
        )
        accelerated = any(drive.useAcceleration for drive in drives)
    stated = {"useAcceleration": accelerated}
    if isinstance(joint, HingeJoint):
        stated = {"extendedLimits": joint.extendedLimits, "useAcceleration": joint.useAcceleration}
    for name in (name for name, value in stated.items() if value):
        report.field_dropped(f"joint {joint.id or owner}", name, f"{TARGET} of Unity 2021")


def tell_couplings(couplings: Iterable[Coupling], report: Report) -> None:
    """Unity has no component for them."""
    for coupling in couplings:
        report.dropped(
            f"coupling {coupling.id}", "COUPLING_NOT_IN_PREFAB", coupling=coupling.id, kind=coupling.kind
        )


def empty_colliders(scene: UnityScene, report: Report) -> frozenset[tuple[int, int]]:
    """Colliders without size, by object and component: PhysX makes none of them."""
    found: set[tuple[int, int]] = set()
    for i, entry in enumerate(scene.gameObjects):
        for k, component in enumerate(entry.components):
            if isinstance(component, Collider) and _is_empty(component):
                told = f"{type(component).__name__} {component.id}".strip()
                report.dropped(f"{told} of {entry.id}", "COLLIDER_EMPTY", object=entry.id)
                found.add((i, k))
    return frozenset(found)


def _is_empty(collider: Collider) -> bool:
    if isinstance(collider, BoxCollider):
        # One side may be: Unity gives a quad such a box.
        return sorted(abs(x) for x in collider.size)[1] == 0.0
    return isinstance(collider, (SphereCollider, CapsuleCollider)) and collider.radius <= 0.0


def tell_names(scene: UnityScene, names: list[str], report: Report) -> None:
    """names: of the scene's objects in the prefab, whose root is called like the file."""
    for entry, name in zip(scene.gameObjects, names):
        if entry.name != name and entry.parent is not None:
            told = {"object": entry.id, "name": entry.name, "changed": name}
            report.approximated(f"name of {entry.id}", "TARGET_NAME_CHANGED", **told)
