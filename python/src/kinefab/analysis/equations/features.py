"""Features of all constraints brought into the world at the exported pose."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...model import Feature, FeatureKind, Scene
from ...spatial import ROUNDING, Array, BoolArray, cross
from .rows import NOWHERE, Side


def sides_of(scene: Scene, features: Sequence[Feature], axes: Array) -> list[Side]:
    """Every feature as a ``Side``, in order; body = node + 1, or 0 for ground.

    Directions are made unit vectors here; one of no length stays zero (``constraints`` refuses it).
    axes: see ``System.axes``.
    """
    if not features:
        return []
    node = np.array([-1 if f.node is None else f.node for f in features])
    rotation = np.array([np.eye(3)] + [n.pose.rotation for n in scene.nodes])[node + 1]
    translation = np.array([NOWHERE] + [n.pose.translation for n in scene.nodes])[node + 1]

    def world(vectors: Sequence[Array]) -> Array:
        return np.einsum("nij,nj->ni", rotation, np.array(vectors, dtype=float))

    p = world([f.point for f in features]) + translation
    z = _unit(world([NOWHERE if f.direction is None else f.direction for f in features]))
    given = world([NOWHERE if f.secondary is None else f.secondary for f in features])
    x, framed = _beside(z, given, axes)
    y = cross(z, x)
    return [
        Side(int(node[i]) + 1, p[i], z[i], x[i], y[i], f.kind, f.radius, f.half_angle, bool(framed[i]))
        for i, f in enumerate(features)
    ]


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


def family(kind: FeatureKind) -> str:
    """What a feature is for a constraint: a sphere is its centre, a cylinder or circle its axis."""
    return _FAMILY[kind]


_FAMILY = {
    FeatureKind.POINT: "point",
    FeatureKind.SPHERE: "point",
    FeatureKind.BODY: "point",
    FeatureKind.LINE: "line",
    FeatureKind.CIRCLE: "line",
    FeatureKind.CYLINDER: "line",
    FeatureKind.CONE: "line",
    FeatureKind.FRAME: "frame",
    FeatureKind.PLANE: "plane",
}


def plain_family(side: Side) -> str:
    """As ``family``, with a frame taken for its main axis."""
    name = family(side.kind)
    return "line" if name == "frame" else name


class UnknownPairing(Exception):
    """There are no equations for this verb between these features."""


def need_directions(*sides: Side) -> None:
    """Raise UnknownPairing when one of the sides is a point."""
    if any(plain_family(s) == "point" for s in sides):
        raise UnknownPairing
