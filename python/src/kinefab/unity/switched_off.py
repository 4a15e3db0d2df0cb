"""Joints that the source switches off: components that hold nothing, of which a ``.kinefab`` alone has a kind."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from ..diagnostics import Outcome, Report
from ..model import Joint as ModelJoint
from ..model import Scene
from ..rigid import RigidGroups
from .contact.overlaps import bodies_of
from .joints.mapping import map_joint, with_source
from .joints.passive import with_passive_drives
from .scene import Component, Coupling, Joint, JointCoordinate, UnityScene


def with_switched_off(mapped: UnityScene, scene: Scene, groups: RigidGroups, report: Report) -> UnityScene:
    """The scene with a component, last of its object's, for each joint that is switched off.

    Made when all else is: nothing is counted, kept apart or welded by them.
    """
    if not scene.switched_off:
        return mapped
    bodies, index_of = bodies_of(mapped), {entry.id: i for i, entry in enumerate(mapped.gameObjects)}
    node_of = {index_of[node.id]: number for number, node in enumerate(scene.nodes)}

    def carrier(node: int) -> int | None:
        body = bodies[index_of[scene.nodes[node].id]]
        return None if body is None else node_of.get(body)

    added: dict[int, list[Component]] = {}
    ground = next((i for i, entry in enumerate(mapped.gameObjects) if entry.role == "ground"), None)
    for number, joint in enumerate(scene.switched_off, len(scene.joints)):
        found = _component(joint, number, scene, groups, carrier, report)
        if found is not None:
            owner, connected, component = found
            other = ground if connected is None else index_of[scene.nodes[connected].id]
            added.setdefault(index_of[scene.nodes[owner].id], []).append(replace(component, connectedBody=other))
    objects = tuple(
        replace(entry, components=(*entry.components, *added.get(i, ()))) for i, entry in enumerate(mapped.gameObjects)
    )
    return replace(mapped, gameObjects=objects)


def _component(
    joint: ModelJoint, number: int, scene: Scene, groups: RigidGroups, carrier: Callable[[int], int | None], report: Report
) -> tuple[int, int | None, Joint] | None:
    """Owner, connected node and component; None, and the report says why, where there is none."""
    feature, made = f"joint {joint.id}", Report()
    if groups.without_body(joint) is None and groups.together(joint.a, joint.b):
        told = {"joint": joint.id, "target": "one rigid body"}
        report.dropped(feature, "JOINT_DISABLED_DROPPED", joint.where, **told)
        return None

    def moving(node: int) -> int:
        found = carrier(node)
        assert found is not None, "what is not on the ground has a Rigidbody"
        return found

    mapped = map_joint(with_passive_drives(joint, Report()), scene, groups, moving, made, base=carrier)
    lost = [outcome for outcome in made.outcomes if outcome.outcome is not Outcome.KEPT]
    report.outcomes.extend(lost)
    report.diagnostics.extend(made.diagnostics)
    if mapped is None:
        return None
    component = replace(mapped.component, enabled=False, **mapped.beside(scene))
    component = with_source(component, mapped, joint, number)
    if not lost:
        report.kept(feature, joint.where, "JOINT_DISABLED", joint=joint.id)
    return mapped.owner, mapped.connected, component


def without_switched_off(scene: UnityScene, target: str, report: Report) -> UnityScene:
    """The scene without them, and without couplings that count by them, for a target that has no such joints."""
    left = {
        (i, k): component
        for i, entry in enumerate(scene.gameObjects)
        for k, component in enumerate(entry.components)
        if isinstance(component, Joint) and not component.enabled
    }
    if not left:
        return scene
    for (i, _), component in left.items():
        name = component.id or scene.gameObjects[i].id
        report.withdraw(f"joint {name}", "JOINT_DISABLED")
        report.dropped(f"joint {name}", "JOINT_DISABLED_DROPPED", joint=name, target=target)

    def now(at: JointCoordinate) -> JointCoordinate:
        gone = sum(owner == at.gameObject and number < at.component for owner, number in left)
        return replace(at, component=at.component - gone)

    couplings: list[Coupling] = []
    for coupling in scene.couplings:
        ends = (coupling.coordinate, *(term.coordinate for term in coupling.terms))
        off = [left[place] for end in ends if (place := (end.gameObject, end.component)) in left]
        if off:
            told = {"coupling": coupling.id, "joint": off[0].id or scene.gameObjects[ends[0].gameObject].id}
            report.dropped(f"coupling {coupling.id}", "COUPLING_WITHOUT_JOINT", **told)
            continue
        terms = tuple(replace(term, coordinate=now(term.coordinate)) for term in coupling.terms)
        couplings.append(replace(coupling, coordinate=now(coupling.coordinate), terms=terms))
    objects = tuple(
        replace(entry, components=tuple(c for k, c in enumerate(entry.components) if (i, k) not in left))
        for i, entry in enumerate(scene.gameObjects)
    )
    return replace(scene, gameObjects=objects, couplings=tuple(couplings))
