"""Candidates that were chosen become joints of the model, all of them in one stack (see ``freedom.stacks``)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...findings import JointFinding
from ...model import Feature, Joint, JointKind
from ...spatial import Array, BoolArray, IntArray, Pose
from ..assembly.assemble import Assembly
from ..freedom.finite import Candidate
from ..pairs.relations import Relation
from .links import ALONG, Link


@dataclass(frozen=True, slots=True, eq=False)
class Draft:
    """A candidate between bodies a and b, to be written as a joint between nodes of theirs (None: ground)."""

    id: str
    a: int
    b: int
    node_a: int | None
    node_b: int | None
    candidate: Candidate
    relation: Relation
    names: list[str]
    where: str


def written(drafts: list[Draft], assembly: Assembly, poses: list[Pose]) -> list[Link]:
    """The drafts' joints.  poses: of the scene's nodes and the middle bodies after them, WORLD, closed."""
    if not drafts:
        return []
    rotation = np.array([np.eye(3), *(p.rotation for p in poses)])
    place = np.array([np.zeros(3), *(p.translation for p in poses)])
    axes = np.array([d.candidate.axes for d in drafts])
    turned = _against_named_directions(drafts, assembly, rotation, axes[:, :, 0])
    axes[turned] = axes[turned] @ np.diag([-1.0, 1.0, -1.0])
    origin = np.array([d.candidate.origin for d in drafts])[..., None]
    frames: list[list[Pose]] = []
    for nodes in ([d.node_a for d in drafts], [d.node_b for d in drafts]):
        number = _numbers(nodes)
        back = np.swapaxes(rotation[number], 1, 2)
        there = back @ origin + -back @ place[number][..., None]
        frames.append([Pose(*own) for own in zip(back @ axes, there[..., 0])])
    return [
        Link(d.a, d.b, _joint(d, *own), JointFinding(d.id, misfit=d.relation.missed))
        for d, *own in zip(drafts, *frames)
    ]


def _joint(draft: Draft, frame_a: Pose, frame_b: Pose) -> Joint:
    found = draft.candidate
    return Joint(
        draft.id,
        found.kind,
        draft.node_a,
        draft.node_b,
        frame_a,
        frame_b,
        found.six,
        lead=found.lead,
        because=tuple(draft.names),
        where=draft.where,
    )


def _against_named_directions(
    drafts: list[Draft], assembly: Assembly, rotation: Array, x: Array
) -> BoolArray:
    """Drafts whose X stands against the first of the source's own directions that it is parallel to, body a's first.

    rotation: of ground and the nodes, shape (nodes + 1, 3, 3).  x: shape (drafts, 3), WORLD.
    """
    statements = assembly.equations.statements
    features: list[Feature] = []
    counts: list[int] = []
    for draft in drafts:
        before = len(features)
        if draft.candidate.kind is not JointKind.UNIVERSAL:
            for owner in draft.relation.owners:
                features += getattr(statements[owner], "features", ())
        counts.append(len(features) - before)
    of = np.repeat(np.arange(len(drafts)), counts)
    node = _numbers([f.node for f in features])
    stated = [np.zeros(3) if f.direction is None else f.direction for f in features]
    direction = np.einsum("nij,nj->ni", rotation[node], np.array(stated, dtype=float).reshape(-1, 3))
    cosine = np.einsum("ni,ni->n", direction, x[of])
    others = assembly.body[node] != np.array([d.a for d in drafts])[of]
    order = np.lexsort((others, of))
    order = order[np.abs(cosine[order]) > ALONG]
    which, first = np.unique(of[order], return_index=True)
    against = np.zeros(len(drafts), dtype=bool)
    against[which] = cosine[order[first]] < 0.0
    return against


def _numbers(nodes: list[int | None]) -> IntArray:
    """Of nodes after ground, which is 0."""
    return np.array([0 if node is None else node + 1 for node in nodes], dtype=np.int64)
