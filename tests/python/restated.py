"""The same assembly stated otherwise: other names, order, sides, place or unit; or with errors in its poses.

``told`` says what was found about it in terms of the original, so that two findings can be compared.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from kinefab.model import Constraint, ConstraintKind, Feature, Motion, Scene
from kinefab.spatial import Pose, rotation_exp

SENSITIVE = (ConstraintKind.PIN_SLOT, ConstraintKind.GEAR, ConstraintKind.RACK, ConstraintKind.LINEAR)
"""Constraints whose two sides play different roles; so do those of an angle about a stated axis."""


@dataclass
class Restated:
    """A scene and how it came from the original: p becomes ``by.point(scale * p)``, names are mapped back."""

    scene: Scene
    by: Pose = field(default_factory=Pose)
    scale: float = 1.0
    parts: list[str] = field(default_factory=list)
    constraints: dict[str, str] = field(default_factory=dict)


def as_given(source: Scene) -> Restated:
    names = {c.id: c.id for c in source.constraints}
    return Restated(source, parts=[n.id for n in source.nodes], constraints=names)


def placed(it: Restated, by: Pose, scale: float) -> Restated:
    """Moved by a pose and measured in another unit."""
    return replace(it, scene=transformed(it.scene, by, scale), by=by, scale=scale)


def turned_round(it: Restated) -> Restated:
    """The two sides of each constraint exchanged, where they mean the same."""
    return replace(it, scene=swapped(it.scene))


def shuffled(it: Restated, rng) -> Restated:
    """Parts and constraints in another order and under other names."""
    source = it.scene
    order = rng.permutation(len(source.nodes))
    number = {int(old): new for new, old in enumerate(order)}
    nodes = [replace(source.nodes[i], id=f"n{k}", name=f"n{k}") for k, i in enumerate(order)]
    constraints = [
        replace(c, id=f"c{k}", features=tuple(replace(f, node=number[f.node]) for f in c.features))
        for k, c in enumerate(source.constraints)
    ]
    back = {f"c{k}": it.constraints[c.id] for k, c in enumerate(source.constraints)}
    joints = [replace(j, id=f"j{k}", a=number.get(j.a), b=number[j.b]) for k, j in enumerate(source.joints)]
    scene = replace(
        source,
        nodes=nodes,
        constraints=[constraints[i] for i in rng.permutation(len(constraints))],
        joints=[joints[i] for i in rng.permutation(len(joints))],
    )
    return replace(it, scene=scene, parts=[it.parts[i] for i in order], constraints=back)


def told(found, it: Restated) -> tuple[list, list]:
    """What was found, in the original's terms: words that must be the same, and numbers beside them.

    Of each joint what it joins (all parts of both bodies), its kind, whether it closes a loop, which freedoms
    it leaves, its frame and lead; of each part the directions it may move in; the counts; the findings.
    """
    scene, count = found.scene(solved=True), len(found.source.nodes)
    back = it.by.inverse()

    def name(node) -> str:
        if node is None:
            return "ground"
        if node < count:
            return "+".join(sorted(it.parts[i] for i in range(count) if found.groups.together(i, node)))
        own = found.nodes[node - count].id.removeprefix("middle:")
        # What is stated twice stands behind one middle body; which of the two names it is the source's order.
        return "middle of " + min(
            it.constraints[c.id] for c in it.scene.constraints if _same(it.scene, c.id, own)
        )

    entries = []
    for joint in found.joints:
        frame = scene.pose(joint.a) @ joint.frame_a
        free = tuple(f.motion is not Motion.LOCKED for f in joint.freedoms)
        closure = found.findings[joint.id].closure
        words = (name(joint.a), name(joint.b), joint.kind.value, closure, free)
        origin = back.point(frame.translation) / it.scale
        numbers = [*origin, *(back.rotation @ frame.rotation).T.ravel(), joint.lead / it.scale]
        entries.append((words, numbers))
    for freedom in found.freedoms:
        words = (it.parts[freedom.node], len(freedom.translations), len(freedom.rotations))
        directions = [*freedom.translations, *freedom.rotations]
        entries.append((words, [x for d in directions for x in back.direction(d)]))
    entries.sort(key=lambda entry: str(entry[0]))
    counts = (found.mobility, found.first_order, found.rows, found.rank, len(found.islands))
    findings = sorted(d.code for d in found.report.diagnostics)
    return [counts, findings, *(words for words, _ in entries)], [numbers for _, numbers in entries]


def _same(scene: Scene, one: str, other: str) -> bool:
    """Whether two constraints say the same of the same points."""
    a, b = (next(c for c in scene.constraints if c.id == id) for id in (one, other))
    if one == other:
        return True
    sides = [
        sorted((f.node or -1, *scene.pose(f.node).point(f.point).round(9)) for f in c.features)
        for c in (a, b)
    ]
    return (
        a.kind is b.kind and abs(a.value - b.value) < 1e-9 and np.allclose(*map(np.array, sides), atol=1e-8)
    )


def transformed(source: Scene, by: Pose, scale: float = 1.0) -> Scene:
    """Everything moved by a pose and measured in another unit."""

    def feature(f: Feature) -> Feature:
        return replace(f, point=f.point * scale, radius=f.radius * scale)

    def constraint(c: Constraint) -> Constraint:
        length = c.kind in (
            ConstraintKind.DISTANCE,
            ConstraintKind.SCREW,
            ConstraintKind.RACK,
            ConstraintKind.INSERT,
        )
        return replace(
            c, features=tuple(map(feature, c.features)), value=c.value * (scale if length else 1.0)
        )

    def rescaled(frame: Pose) -> Pose:
        return Pose(frame.rotation, frame.translation * scale)

    joints = [
        replace(j, frame_a=rescaled(j.frame_a), frame_b=rescaled(j.frame_b), lead=j.lead * scale)
        for j in source.joints
    ]
    nodes = [replace(n, pose=by @ Pose(n.pose.rotation, n.pose.translation * scale)) for n in source.nodes]
    return replace(
        source, nodes=nodes, joints=joints, constraints=[constraint(c) for c in source.constraints]
    )


def swapped(source: Scene) -> Scene:
    """The two sides of each constraint exchanged, where they mean the same."""

    def turn(c: Constraint) -> Constraint:
        if c.kind in SENSITIVE or c.kind is ConstraintKind.ANGLE and len(c.features) > 2:
            return c
        return replace(c, features=(c.features[1], c.features[0], *c.features[2:]))

    return replace(source, constraints=[turn(c) for c in source.constraints])


def shaken(source: Scene, size: float, rng) -> Scene:
    """Every pose but ground's with an error of ``size`` (metres, radians)."""
    nodes = [
        n
        if n.grounded
        else replace(
            n,
            pose=Pose(
                rotation_exp(size * rng.uniform(-1, 1, 3)) @ n.pose.rotation,
                n.pose.translation + size * rng.uniform(-1, 1, 3),
            ),
        )
        for n in source.nodes
    ]
    return replace(source, nodes=nodes)
