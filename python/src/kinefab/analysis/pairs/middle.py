"""Relations that no single joint expresses, as two joints with a light body between the parts."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from ...model import FREE, LOCKED, RX, RZ, TZ, Freedom, JointKind
from ...spatial import Array, BoolArray, IntArray, cross, perpendicular
from ..equations.atoms import Atom
from ..equations.system import System
from ..freedom.finite import Candidate
from .candidates import Geometry
from .relations import Relation

Placing = Callable[[bool], Candidate]
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
    near, far = (on_a(True), on_b(True)) if first_is_a else (on_b(False), on_a(False))
    if not all(np.isfinite(c.axes).all() and np.isfinite(c.origin).all() for c in (near, far)):
        return None  # a rod between points that other constraints hold together has no direction
    return near, far


def _joint(
    kind: JointKind, axes: Array, origin: Array, outer_is_a: bool = True, freedoms: tuple[Freedom, ...] = ()
) -> Placing:
    """A candidate between an outer body and the middle one.

    outer_is_a: the outer body carries the joint's translations and Z axis.  The returned function takes
    whether the joint is the one at body a of the atom (its outer body then comes first, else last).
    """

    def place(outer_first: bool) -> Candidate:
        return Candidate(kind, axes, origin, outer_is_a == outer_first, freedoms=freedoms)

    return place


def _rod(p_a: Array, a: Array, p_b: Array, b: Array, geometry: Geometry) -> tuple[Placing, Placing]:
    along = (p_b - p_a) / np.linalg.norm(p_b - p_a)
    z = perpendicular(along, geometry.axes)
    axes = np.column_stack([cross(along, z), along, z])  # Y, the rod's own axis, is the locked one
    return _joint(JointKind.UNIVERSAL, axes, p_a), _far(JointKind.SPHERICAL, geometry.axes, p_b)


def _far(
    kind: JointKind, axes: Array, origin: Array, outer_is_a: bool = False, freedoms: tuple[Freedom, ...] = ()
) -> Placing:
    """As ``_joint``, for the joint at the atom's body b: there the middle body comes first."""

    def place(middle_first: bool) -> Candidate:
        return Candidate(kind, axes, origin, outer_is_a != middle_first, freedoms=freedoms)

    return place


def _point_round_line(
    p_a: Array, a: Array, p_b: Array, b: Array, geometry: Geometry
) -> tuple[Placing, Placing]:
    foot = p_a + a * (a @ (p_b - p_a))
    return _joint(JointKind.CYLINDRICAL, geometry.frame(a), foot), _far(
        JointKind.SPHERICAL, geometry.axes, p_b
    )


def _line_round_line(
    p_a: Array, a: Array, p_b: Array, b: Array, geometry: Geometry
) -> tuple[Placing, Placing]:
    foot = p_a + a * (a @ (p_b - p_a))
    return _joint(JointKind.REVOLUTE, geometry.frame(a), foot), _far(
        JointKind.CYLINDRICAL, geometry.frame(a), p_b
    )


def _skew_lines(p_a: Array, a: Array, p_b: Array, b: Array, geometry: Geometry) -> tuple[Placing, Placing]:
    normal = cross(a, b)
    size = normal @ normal
    offset = p_b - p_a
    foot_a = p_a + a * (cross(offset, b) @ normal / size)
    foot_b = p_b + b * (cross(offset, a) @ normal / size)
    z, x = b, normal / np.sqrt(size)
    carried = np.column_stack([x, cross(z, x), z])  # slides along b and turns about b, all swinging about n
    return (
        _joint(JointKind.CYLINDRICAL, geometry.frame(a), foot_a),
        _far(JointKind.GENERAL, carried, foot_b, outer_is_a=True, freedoms=CARRIED),
    )


def _angled(p_a: Array, a: Array, p_b: Array, b: Array, geometry: Geometry) -> tuple[Placing, Placing]:
    return _joint(JointKind.PARALLEL_PLANES, geometry.frame(a), p_b), _far(
        JointKind.REVOLUTE, geometry.frame(b), p_b
    )


def _cone_on_plane(p_a: Array, a: Array, p_b: Array, b: Array, geometry: Geometry) -> tuple[Placing, Placing]:
    """The middle body slides and turns on the plane under the apex; the cone turns in it about its own axis."""
    return _joint(JointKind.PLANAR, geometry.frame(a), p_b), _far(JointKind.REVOLUTE, geometry.frame(b), p_b)


def _edge_on_plane(p_a: Array, a: Array, p_b: Array, b: Array, geometry: Geometry) -> tuple[Placing, Placing]:
    """The middle body turns in the circle and carries the tangent at its lowest point, which lies in the plane."""
    down = b * (b @ a) - a
    size = np.linalg.norm(down)
    touching = p_b + down * ((a @ (p_b - p_a)) / size**2)
    along = cross(a, b) / size
    in_plane = np.column_stack([along, cross(a, along), a])
    return (
        _joint(JointKind.LINE_IN_PLANE, in_plane, touching),
        _far(JointKind.REVOLUTE, geometry.frame(b), p_b),
    )


_Recipe = Callable[[Array, Array, Array, Array, Geometry], tuple[Placing, Placing]]
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
WORLD, metres, and returns the joints on a and on b."""

_SIDED = (_point_round_line, _cone_on_plane, _edge_on_plane)
"""Those whose side a is another kind of thing than b."""
