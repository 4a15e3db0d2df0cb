"""Each part's remaining freedoms against ground, as a CAD program's DOF analysis lists them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...diagnostics import Report
from ...model import RX, NodeKind
from ...spatial import Array, cross
from ..assembly.assemble import Assembly
from ..freedom.finite import Candidate
from ..freedom.rank import spans
from ..freedom.stacks import alike
from ..freedom.twists import twist_spaces
from ..pairs.relations import Relation

LEAST = 1e-7
"""Share of a block's velocities, of length 1 altogether, up to which a body has no part in them."""
SAME_DIRECTION = 1e-4
"""Sine of the angle up to which directions of different joints are one: no CAD program leaves axes further off."""
OFF_DIRECTION = math.radians(0.5)
"""Angle from which a stated direction is another one: far above the rounding of a CAD program's list."""


@dataclass(frozen=True, slots=True, eq=False)
class NodeFreedom:
    """What is left of a node's six freedoms against ground, first order at the closed pose; of a part whose own
    joint had to be found from finite motions there, what that joint leaves.

    translations: shape (t, 3), unit, WORLD, pure translations.  rotations: shape (r, 3), unit, WORLD.
    center: WORLD, a point of the rotation axes, or None where they have none in common.
    """

    node: int
    translations: Array
    rotations: Array
    center: Array | None = None

    @property
    def dof(self) -> int:
        return len(self.translations) + len(self.rotations)


def singular_joints(assembly: Assembly, relations: Sequence[Relation]) -> dict[int, Candidate]:
    """The joints of bodies that hang by one alone, where twists promise more than its motions keep."""
    found: dict[int, Candidate] = {}
    for relation in relations:
        if relation.finite < 6 - relation.rank and relation.joint is not None:
            body = next((b for b in (relation.second, relation.first) if _hangs_alone(assembly, b)), None)
            if body is not None:
                found[body] = relation.joint
    return found


def _hangs_alone(assembly: Assembly, body: int) -> bool:
    """Whether the body is all of its block: nothing but one pair holds it."""
    block = int(assembly.blocks.block[body])
    return block >= 0 and int(np.sum(assembly.blocks.block == block)) == 1


def _joint_twists(joint: Candidate, center: Array, length: float) -> Array:
    """Scaled twists (v / length, w) that a joint allows where it stands, columns, shape (6, freedoms).

    center: WORLD, metres, the point whose velocity v is.
    """
    slides = joint.axes[:, [i for i in joint.unlocked if i < RX]]
    axes = joint.axes[:, [i - RX for i in joint.unlocked if i >= RX]]
    turns = np.concatenate([cross(axes.T, center - joint.origin).T / length, axes])
    return np.concatenate([np.concatenate([slides, 0.0 * slides]), turns], axis=1)


def body_twists(assembly: Assembly, singular: Mapping[int, Candidate]) -> list[Array]:
    """Scaled twists (v / the assembly's length, w) of every body about its own point, orthonormal columns, shape (6, d).

    Blocks move independently: a body's twists are those of its block's root, carried along, and its own.
    singular: see ``singular_joints``.
    """
    relative, blocks, length = assembly.relative, assembly.blocks, assembly.equations.length
    own: list[Array] = [np.zeros((6, 0))] * relative.bodies
    bodies: list[int] = []
    moving: list[Array] = []
    least: list[float] = []
    for freedom in assembly.freedoms:
        bodies += freedom.bodies.tolist()
        # what may be in a velocity without being in the motion is none: a parallelogram's link with axes off by a little does not turn
        none = max(LEAST, freedom.noise)
        moving += list(freedom.basis.reshape(len(freedom.bodies), 6, -1))
        least += [none] * len(freedom.bodies)
    for body, twists in zip(bodies, spans(moving, least=least)):
        own[body] = twists * np.repeat([relative.length[body] / length, 1.0], 3)[:, None]
    for body, joint in singular.items():
        own[body] = _joint_twists(joint, relative.center[body], length)
    found: list[Array] = [np.zeros((6, 0))] * relative.bodies
    for body in blocks.island_root[1:].tolist():  # the islands that float
        found[body] = np.eye(6)
    root = np.append(blocks.root, -1)[blocks.block]
    for bodies in blocks.generations():
        pairs: list[tuple[int, int]] = np.stack([bodies, root[bodies]], axis=1).tolist()
        for (k, _), part in alike((found[r].shape[1], own[b].shape[1]) for b, r in pairs):
            here = bodies[part]
            before = root[here]
            places: list[int] = part.tolist()
            mine = [pairs[i] for i in places]
            if k == 6:  # it is all free, as its root is
                for body, above in mine:
                    found[body] = found[above]
                continue
            carried = np.array([found[r] for _, r in mine])
            if k:
                arm = (relative.center[here] - relative.center[before])[:, None]
                turning = np.swapaxes(carried[:, 3:], 1, 2)
                v = carried[:, :3] + np.swapaxes(cross(turning, arm), 1, 2) / length
                carried = np.linalg.qr(np.concatenate([v, carried[:, 3:]], axis=1))[0]
            added = np.linalg.qr(np.array([own[b] for b, _ in mine]))[0]
            both = np.concatenate([carried, added], axis=2)
            for (body, _), twists in zip(mine, spans(list(both), SAME_DIRECTION)):
                found[body] = twists
    return found


def node_freedoms(assembly: Assembly, singular: Mapping[int, Candidate]) -> list[NodeFreedom]:
    """Of every part of the scene.  singular: see ``singular_joints``."""
    twists = body_twists(assembly, singular)
    relative = assembly.relative
    lengths = np.full(relative.bodies, assembly.equations.length)
    spaces = twist_spaces(twists, relative.center, lengths, relative.axes)
    found: list[NodeFreedom] = []
    for i, node in enumerate(assembly.scene.nodes):
        if node.kind is NodeKind.PART and not node.suppressed:
            space = spaces[int(assembly.body[i + 1])]
            found.append(NodeFreedom(i, space.translations, space.rotations, space.center))
    return found


def check_records(assembly: Assembly, freedoms: list[NodeFreedom], report: Report) -> None:
    """Warn where the source's own DOF records say otherwise."""
    by_node = {f.node: f for f in freedoms}
    for record in assembly.scene.dof_records:
        mine = by_node.get(record.node)
        if mine is None:
            continue
        stated = (len(record.translations), len(record.rotations))
        if stated != (len(mine.translations), len(mine.rotations)):
            report.add(
                "DOF_RECORD_DIFFERS",
                record.where,
                node=assembly.scene.nodes[record.node].id,
                stated_t=stated[0],
                stated_r=stated[1],
                found_t=len(mine.translations),
                found_r=len(mine.rotations),
            )
            continue
        for what, said, found in (
            ("translations", record.translations, mine.translations),
            ("rotation axes", record.rotations, mine.rotations),
        ):
            if (angle := _angle_between(said, found)) > OFF_DIRECTION:
                report.add(
                    "DOF_DIRECTION_DIFFERS", record.where, node=assembly.scene.nodes[record.node].id, what=what,
                    stated=_directions(said), found=_directions(found), angle=f"{math.degrees(angle):.3g}",
                )  # fmt: skip


def _angle_between(a: Array, b: Array) -> float:
    """Largest principal angle of two spans, radians; directions as rows, shape (n, 3).

    Bases of a span are many, so spans are compared, and no points: a rotation may be about a momentary pole.
    """
    if not len(a):
        return 0.0
    u, v = spans([a.T, b.T])
    outside = max(float(np.linalg.norm(p - q @ (q.T @ p), 2)) for p, q in ((u, v), (v, u)))
    return math.asin(min(1.0, outside))


def _directions(rows: Array) -> str:
    return ", ".join("(" + " ".join(f"{x + 0.0:.4g}" for x in row.round(4)) + ")" for row in rows)
