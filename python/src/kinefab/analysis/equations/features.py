"""Features of all constraints brought into the world at the exported pose."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...model import Feature, FeatureKind, Scene
from ...spatial import ROUNDING, Array, BoolArray, IntArray, cross
from .rows import NOWHERE, Side, has_direction

NO_NODE = -2
"""Stands for a number below those that nodes have."""
LEAST_LENGTH = 1e-12
"""Length above which a direction is one."""


@dataclass(frozen=True, slots=True, eq=False)
class Numbers:
    """Features as arrays, one row each, in their nodes' frames.

    node: -1 for ground.  point, direction, secondary: shape (n, 3), zeros where there is none.
    size: shape (n, 2), radius and half angle.
    """

    features: Sequence[Feature]
    node: IntArray
    point: Array
    direction: Array
    secondary: Array
    size: Array

    def kept(self, which: IntArray) -> Numbers:
        """These features alone, in this order."""
        own = self.node[which], self.point[which], self.direction[which], self.secondary[which]
        places: list[int] = which.tolist()
        return Numbers([self.features[i] for i in places], *own, self.size[which])

    def sound(self) -> BoolArray:
        """Those whose numbers are finite and whose direction is one, where the kind needs it."""
        finite = np.isfinite(np.concatenate([self.point, self.direction, self.secondary, self.size], axis=1))
        undirected = np.array([not has_direction(f.kind) for f in self.features], dtype=bool)
        return finite.all(axis=1) & (undirected | (np.linalg.norm(self.direction, axis=1) > LEAST_LENGTH))


def numbers_of(features: Sequence[Feature]) -> Numbers:
    """The features' numbers, gathered once for all that is done with them."""
    node = [-1 if f.node is None else f.node if f.node >= 0 else NO_NODE for f in features]
    vectors = (
        [f.point for f in features],
        [NOWHERE if f.direction is None else f.direction for f in features],
        [NOWHERE if f.secondary is None else f.secondary for f in features],
    )
    point, direction, secondary = (np.array(own, dtype=float).reshape(-1, 3) for own in vectors)
    size = np.array([[f.radius for f in features], [f.half_angle for f in features]], dtype=float).T
    return Numbers(features, np.array(node, dtype=np.int64), point, direction, secondary, size)


@dataclass(frozen=True, slots=True, eq=False)
class Sides:
    """Many features, see ``Side``.  body, framed: shape (n,).  p, z, x, y: shape (n, 3)."""

    features: Sequence[Feature]
    body: IntArray
    p: Array
    z: Array
    x: Array
    y: Array
    framed: BoolArray

    def one(self, i: int) -> Side:
        """The i-th feature as a side by itself."""
        f = self.features[i]
        own = self.p[i], self.z[i], self.x[i], self.y[i]
        return Side(int(self.body[i]), *own, f.kind, f.radius, f.half_angle, bool(self.framed[i]))

    def stack(self, which: IntArray) -> Side:
        """Features that are alike but for their places."""
        own = self.p[which], self.z[which], self.x[which], self.y[which]
        first = int(which[0])
        return Side(self.body[which], *own, self.features[first].kind, framed=bool(self.framed[first]))


def sides_of(scene: Scene, given: Numbers, axes: Array) -> Sides:
    """All features as sides; body = node + 1, or 0 for ground.

    Directions are made unit vectors here; one of no length stays zero (``constraints`` refuses it).
    axes: see ``System.axes``.
    """
    body = given.node + 1
    rotation = np.array([np.eye(3)] + [n.pose.rotation for n in scene.nodes])[body]
    translation = np.array([NOWHERE] + [n.pose.translation for n in scene.nodes])[body]

    def world(vectors: Array) -> Array:
        return np.einsum("nij,nj->ni", rotation, vectors)

    p, z = world(given.point) + translation, _unit(world(given.direction))
    x, framed = _beside(z, world(given.secondary), axes)
    return Sides(given.features, body, p, z, x, cross(z, x), framed)


def _unit(v: Array) -> Array:
    size = np.linalg.norm(v, axis=1, keepdims=True)
    return np.divide(v, size, out=np.zeros_like(v), where=size > 0.0)


def _beside(z: Array, given: Array, axes: Array) -> tuple[Array, BoolArray]:
    """Unit vectors at right angles to z, towards ``given`` where it has a part across z."""
    across = given - z * np.einsum("ni,ni->n", given, z)[:, None]
    framed = np.linalg.norm(across, axis=1) > 1e-9
    helper = axes.T[np.argmin(np.abs(z @ axes).round(ROUNDING), axis=1)]
    beside: Array = helper - z * np.einsum("ni,ni->n", helper, z)[:, None]
    return _unit(np.where(framed[:, None], across, beside)), framed


_FAMILY = {
    FeatureKind.POINT: "point",
    FeatureKind.SPHERE: "point",
    FeatureKind.BODY: "point",
    FeatureKind.LINE: "line",
    FeatureKind.CIRCLE: "line",
    FeatureKind.CYLINDER: "line",
    FeatureKind.CONE: "line",
    FeatureKind.FRAME: "line",
    FeatureKind.PLANE: "plane",
}


def plain_family(side: Side) -> str:
    """What a feature is for a constraint: a sphere is its centre, a cylinder, circle or frame its axis."""
    return _FAMILY[side.kind]


class UnknownPairing(Exception):
    """There are no equations for this verb between these features."""


def need_directions(*sides: Side) -> None:
    """Raise UnknownPairing when one of the sides is a point."""
    if any(plain_family(s) == "point" for s in sides):
        raise UnknownPairing
