"""Relations that no single joint expresses, as two joints with a light body between the parts."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from ...model import FREE, LOCKED, RX, RZ, TZ, JointKind
from ...spatial import Array, BoolArray, IntArray, cross, perpendicular
from ..equations.atoms import Atom
from ..equations.system import System
from ..freedom.finite import Candidate
from .candidates import Geometry
from .relations import Relation

CARRIED = tuple(FREE if i in (TZ, RX, RZ) else LOCKED for i in range(6))


def middle_body(
    system: System, rows: IntArray | BoolArray, relation: Relation
) -> tuple[Candidate, Candidate] | None:
    """(first body to middle, middle to second body) for one constraint's rows, or None.

    The pair of joints has exactly the freedoms of the rows, without an idle spin of the middle body.
    """
    atoms = np.flatnonzero(np.isin(system.row, rows))
    kinds = tuple(sorted(Atom(k) for k in system.kind[atoms]))
    recipe = _RECIPES.get(kinds)
    if recipe is None:
        return None
    last = atoms[np.argmax(system.kind[atoms])]
    first_is_a = system.body_a[last] == relation.first
    a, b = system.a[last], system.b[last]
    side_a, side_b = (system.p_a[last], a), (system.p_b[last], b if b.any() else a)
    if recipe not in _SIDED and not first_is_a:  # the same from either side
        side_a, side_b, first_is_a = side_b, side_a, True
    with np.errstate(divide="ignore", invalid="ignore"):
        on_a, on_b = recipe(*side_a, *side_b, relation.geometry)
    near, far = (on_a, on_b) if first_is_a else (on_b, on_a)
    if not all(np.isfinite(c.axes).all() and np.isfinite(c.origin).all() for c in (near, far)):
        return None  # a rod between points that other constraints hold together has no direction
    return near, replace(far, first_is_a=not far.first_is_a)  # there the middle body comes first


def _rod(p_a: Array, a: Array, p_b: Array, b: Array, geometry: Geometry) -> tuple[Candidate, Candidate]:
    along = (p_b - p_a) / np.linalg.norm(p_b - p_a)
    z = perpendicular(along, geometry.axes)
    axes = np.column_stack([cross(along, z), along, z])  # Y, the rod's own axis, is the locked one
    return Candidate(JointKind.UNIVERSAL, axes, p_a), Candidate(
        JointKind.SPHERICAL, geometry.axes, p_b, first_is_a=False
    )


def _point_round_line(
    p_a: Array, a: Array, p_b: Array, b: Array, geometry: Geometry
) -> tuple[Candidate, Candidate]:
    foot = p_a + a * (a @ (p_b - p_a))
    return Candidate(JointKind.CYLINDRICAL, geometry.frame(a), foot), Candidate(
        JointKind.SPHERICAL, geometry.axes, p_b, first_is_a=False
    )


def _line_round_line(
    p_a: Array, a: Array, p_b: Array, b: Array, geometry: Geometry
) -> tuple[Candidate, Candidate]:
    foot = p_a + a * (a @ (p_b - p_a))
    return Candidate(JointKind.REVOLUTE, geometry.frame(a), foot), Candidate(
        JointKind.CYLINDRICAL, geometry.frame(a), p_b, first_is_a=False
    )


def _skew_lines(
    p_a: Array, a: Array, p_b: Array, b: Array, geometry: Geometry
) -> tuple[Candidate, Candidate]:
    normal = cross(a, b)
    size = normal @ normal
    offset = p_b - p_a
    foot_a = p_a + a * (cross(offset, b) @ normal / size)
    foot_b = p_b + b * (cross(offset, a) @ normal / size)
    z, x = b, normal / np.sqrt(size)
    carried = np.column_stack([x, cross(z, x), z])  # slides along b and turns about b, all swinging about n
    return (
        Candidate(JointKind.CYLINDRICAL, geometry.frame(a), foot_a),
        Candidate(JointKind.GENERAL, carried, foot_b, freedoms=CARRIED),
    )


def _angled(p_a: Array, a: Array, p_b: Array, b: Array, geometry: Geometry) -> tuple[Candidate, Candidate]:
    return Candidate(JointKind.PARALLEL_PLANES, geometry.frame(a), p_b), Candidate(
        JointKind.REVOLUTE, geometry.frame(b), p_b, first_is_a=False
    )


def _cone_on_plane(
    p_a: Array, a: Array, p_b: Array, b: Array, geometry: Geometry
) -> tuple[Candidate, Candidate]:
    """The middle body slides and turns on the plane under the apex; the cone turns in it about its own axis."""
    return Candidate(JointKind.PLANAR, geometry.frame(a), p_b), Candidate(
        JointKind.REVOLUTE, geometry.frame(b), p_b, first_is_a=False
    )


def _edge_on_plane(
    p_a: Array, a: Array, p_b: Array, b: Array, geometry: Geometry
) -> tuple[Candidate, Candidate]:
    """The middle body turns in the circle and carries the tangent at its lowest point, which lies in the plane."""
    down = b * (b @ a) - a
    size = np.linalg.norm(down)
    touching = p_b + down * ((a @ (p_b - p_a)) / size**2)
    along = cross(a, b) / size
    in_plane = np.column_stack([along, cross(a, along), a])
    return (
        Candidate(JointKind.LINE_IN_PLANE, in_plane, touching),
        Candidate(JointKind.REVOLUTE, geometry.frame(b), p_b, first_is_a=False),
    )


_Recipe = Callable[[Array, Array, Array, Array, Geometry], tuple[Candidate, Candidate]]
_RECIPES: Mapping[tuple[Atom, ...], _Recipe] = {
    (Atom.DIST,): _rod,
    (Atom.PLD,): _point_round_line,
    (Atom.DOT, Atom.DOT, Atom.PLD): _line_round_line,
    (Atom.LLD,): _skew_lines,
    (Atom.DOT,): _angled,
    (Atom.PIP, Atom.DOT): _cone_on_plane,
    (Atom.CPT,): _edge_on_plane,
}
"""By the kinds of a constraint's atoms.  Each takes a point and the direction of the sides a and b of the last of them,
WORLD, metres, and returns the joints on a and on b, each with the outer body first and the middle one second."""

_SIDED = (_point_round_line, _cone_on_plane, _edge_on_plane)
"""Those whose side a is another kind of thing than b."""
