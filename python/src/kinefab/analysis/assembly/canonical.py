"""The order in which everything is taken: by where it lies, so that neither names nor the source's order,
nor the place of the assembly or its unit, decide anything.

Everything is seen from one part: a grounded one where there is one, so that even parts that are exactly alike
(the arms of a Delta) are told apart by where they stand on it.  What then still ties is the same seen from
either side, and either choice gives the same assembly.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from ...model import Constraint, Joint, Scene
from ...spatial import Array, IntArray, Pose

Stated = TypeVar("Stated", Constraint, Joint)
APART = 1e-6
"""Difference, as a fraction of the assembly's size (or of a direction), by which two places are told apart."""


@dataclass(frozen=True, slots=True, eq=False)
class Canonical:
    """frame: that of the part everything is seen from, WORLD.  body: shape (nodes + 1,), the body of each
    node, numbered by place (entry 0: ground, body 0).  scene: as given, its statements ordered by place."""

    frame: Pose
    body: IntArray
    scene: Scene


def canonical(scene: Scene, body: IntArray) -> Canonical:
    """Number the bodies (``body``: shape (nodes + 1,), in any order but ground first) and order the statements."""
    places = _Places(scene)
    frame, size = places.viewpoint(body)
    number = places.numbered(body, frame, size)
    body = number[body]
    constraints = _ordered(scene.constraints, lambda c: c.kind.value, places, body, frame, size, 0)
    joints = _ordered(scene.joints, lambda j: j.kind.value, places, body, frame, size, len(scene.constraints))
    rank = {joint.id: i for i, joint in enumerate(joints)}
    couplings = sorted(
        scene.couplings,
        key=lambda c: (c.kind.value, [rank.get(t.joint, -1) for t in c.terms], rank.get(c.joint, -1)),
    )
    ordered = replace(scene, constraints=constraints, joints=joints, couplings=couplings)
    return Canonical(frame, body, ordered)


class _Places:
    """Points and directions of a scene's statements, WORLD, and whose they are.

    statement: shape (n,), number of the constraint, or after those of the joint.  node: shape (n,), counted
    from 1, 0 for ground.  point, direction: shape (n, 3), zero where there is none or no number.
    """

    def __init__(self, scene: Scene):
        nodes = scene.nodes
        self.rotation = np.array([np.eye(3)] + [n.pose.rotation for n in nodes])
        self.origin = np.array([np.zeros(3)] + [n.pose.translation for n in nodes])
        statement: list[int] = []
        node: list[int] = []
        point: list[Array] = []
        direction: list[Array] = []
        value: list[float] = []

        def side(i: int, owner: int | None, at: Array, along: Array | None, number: float) -> None:
            statement.append(i)
            node.append(0 if owner is None or not 0 <= owner < len(nodes) else owner + 1)
            point.append(at)
            direction.append(np.zeros(3) if along is None else along)
            value.append(number)

        for i, constraint in enumerate(scene.constraints):
            for f in constraint.features:
                side(i, f.node, f.point, f.direction, constraint.value)
        for i, joint in enumerate(scene.joints, start=len(scene.constraints)):
            for owner, frame in ((joint.a, joint.frame_a), (joint.b, joint.frame_b)):
                side(i, owner, frame.translation, frame.rotation[:, 0], joint.lead)
        self.statement, self.node = np.array(statement, dtype=np.int64), np.array(node, dtype=np.int64)
        self.value = np.nan_to_num(np.array(value, dtype=float), posinf=0.0, neginf=0.0)
        vectors = np.nan_to_num(
            np.array([point, direction], dtype=float).reshape(2, -1, 3), posinf=0.0, neginf=0.0
        )
        turned = np.einsum("nij,snj->sni", self.rotation[self.node], vectors)
        self.point, self.direction = turned[0] + self.origin[self.node], turned[1]

    def viewpoint(self, body: IntArray) -> tuple[Pose, float]:
        """The frame to look from and the size of everything, metres.

        A part is known by where the middle of everything and its spread lie in its own frame.
        """
        points = np.concatenate([self.origin[1:], self.point])
        if not len(points):
            return Pose(), 1.0
        middle = points.mean(axis=0)
        arms = points - middle
        size = float(np.linalg.norm(arms, axis=1).max()) or 1.0
        spread = arms.T @ arms / (len(points) * size * size)
        nodes = np.flatnonzero(body[1:] == 0) + 1
        if not len(nodes):
            on_world = bool((self.node == 0).any())
            nodes = np.zeros(1, dtype=np.int64) if on_world else np.arange(1, len(body))
        turn = np.swapaxes(self.rotation[nodes], 1, 2)
        there = np.einsum("nij,nj->ni", turn, middle - self.origin[nodes]) / size
        seen = (turn @ spread @ self.rotation[nodes]).reshape(-1, 9)
        first = int(nodes[_by([*there.T, *seen.T])[0]])
        return Pose(self.rotation[first], self.origin[first]), size

    def numbered(self, body: IntArray, frame: Pose, size: float) -> IntArray:
        """New numbers of the bodies by the mean of their points and of their nodes' axes, ground first."""
        count = int(body.max()) + 1
        owner = np.concatenate([body[1:], body[self.node]])
        points = frame.inverse().point(np.concatenate([self.origin[1:], self.point])) / size
        mean = _means(owner, points, count)
        axes = frame.rotation.T @ self.rotation[1:]
        turns = _means(body[1:], axes.reshape(-1, 9), count)
        stated = np.bincount(body[self.node], minlength=count)
        order = _by([np.arange(count) > 0, *mean.T, *turns.T, stated])
        number = np.empty(count, dtype=np.int64)
        number[order] = np.arange(count)
        return number


def _ordered(
    statements: list[Stated],
    kind: Callable[[Stated], str],
    places: _Places,
    body: IntArray,
    frame: Pose,
    size: float,
    offset: int,
) -> list[Stated]:
    """Constraints or joints by the bodies they join, their kind and where their geometry lies."""
    count = len(statements)
    own = (places.statement >= offset) & (places.statement < offset + count)
    if not own.any():
        return list(statements)
    number, bodies = places.statement[own] - offset, body[places.node[own]]
    low, high = np.full(count, len(body)), np.zeros(count, dtype=np.int64)
    np.minimum.at(low, number, bodies)
    np.maximum.at(high, number, bodies)
    names = sorted({kind(s) for s in statements})
    kinds = np.array([names.index(kind(s)) for s in statements])
    points = frame.inverse().point(places.point[own]) / size
    along = places.direction[own] @ frame.rotation
    along = along / np.maximum(np.linalg.norm(along, axis=1), 1e-300)[:, None]
    squares = np.einsum("ni,nj->nij", along, along).reshape(-1, 9)
    columns = _means(number, np.concatenate([points, along, squares], axis=1), count)
    values = _means(number, places.value[own][:, None], count)[:, 0]
    largest = np.zeros(len(names))
    np.maximum.at(largest, kinds, np.abs(values))  # within a kind all have one unit
    order = _by([low, high, kinds, *columns.T, values / np.maximum(largest, 1e-300)[kinds]])
    return [statements[i] for i in order.tolist()]


def _means(owner: IntArray, values: Array, count: int) -> Array:
    total = np.zeros((count, values.shape[1]))
    np.add.at(total, owner, values)
    return total / np.maximum(np.bincount(owner, minlength=count), 1)[:, None]


def _by(columns: Sequence[ArrayLike]) -> IntArray:
    """The order by these columns, the first one first; values that are not ``APART`` count as one."""
    return np.lexsort([_ranks(np.asarray(c, dtype=float)) for c in reversed(columns)])


def _ranks(column: Array) -> IntArray:
    order = np.argsort(column, kind="stable")
    step = np.diff(column[order], prepend=column[order[:1]]) > APART
    rank = np.empty(len(column), dtype=np.int64)
    rank[order] = np.cumsum(step)
    return rank
