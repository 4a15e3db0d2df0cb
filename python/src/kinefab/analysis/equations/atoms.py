"""The scalar relations between two bodies that every constraint is built of.

Each atom is one equation g = 0 between body A (``p_a``, ``a``, ``k`` are fixed on it) and body B
(``p_b``, ``b``).  Its derivative is one wrench, written as a force ``f`` through the point ``c`` and a
free moment ``tau``; it acts on the relative twist xi_B - xi_A, and about any point o its six-row is

    W = [f, (c - o) x f + tau],     dg/dt = W . (xi_B - xi_A),   xi = (v of o, w), linear first.

So J_B = +W and J_A = -W.  Pairings: Haug, *Computer Aided Kinematics and Dynamics* (1989), ch. 9 (dot-1,
dot-2, distance); Lee-St.John & Sidman, *Combinatorics and the Rigidity of CAD Systems* (2013).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from enum import IntEnum

import numpy as np

from ...spatial import Array, cross

LEAST_SPAN = 1e-300
"""Guards a division; an atom is never built where its own gradient vanishes."""

Valued = tuple[Array, Array, Array, Array]
"""Of atoms of one kind: values, shape (atoms,); forces f, their points c and moments tau, shape (atoms, 3) each."""


class Atom(IntEnum):
    PIP = 0  # point p_b at height d over the plane (p_a, a)
    DOT = 1  # a . b = d
    ANG = 2  # angle from a to b about k = d (directed)
    DIST = 3  # |p_b - p_a| = d > 0
    PLD = 4  # distance of p_b from the line (p_a, a) = d > 0
    LLD = 5  # signed distance of the skew lines (p_a, a), (p_b, b) = d
    CPT = 6  # circle (p_b, axis b, radius |k|) touches the plane (p_a, a) from the side of sign(d)
    MOM = 7  # moment of the line (p_b, b) about the axis (p_a, a) = d


LENGTHS = (Atom.PIP, Atom.DIST, Atom.PLD, Atom.LLD, Atom.CPT, Atom.MOM)
"""Atoms whose residual is a length; the others' is an angle or its cosine."""


USED: Mapping[Atom, str] = {
    Atom.PIP: "p_a a p_b",
    Atom.DOT: "a b",
    Atom.ANG: "a k b",
    Atom.DIST: "p_a p_b",
    Atom.PLD: "p_a a p_b",
    Atom.LLD: "p_a a p_b b",
    Atom.CPT: "p_a a k p_b b",
    Atom.MOM: "p_a a p_b b",
}
"""What an atom's value and wrench depend on (where there is no force, not on its point); the rest need not be moved."""


def _dot(x: Array, y: Array) -> Array:
    return np.einsum("...i,...i->...", x, y)


def _unit(x: Array) -> tuple[Array, Array]:
    size = np.sqrt(_dot(x, x))
    return x / np.maximum(size, LEAST_SPAN)[..., None], size


def _pip(p_a: Array, a: Array, k: Array, p_b: Array, b: Array, d: Array) -> Valued:
    # C = a.(p_b - p_a) - d;  Cdot = a.(v_B - v_A) + ((p_b-o) x a).(w_B - w_A);  J = [a, (p_b-o) x a]
    return _dot(a, p_b - p_a) - d, a, p_b, np.zeros_like(a)


def _dot_product(p_a: Array, a: Array, k: Array, p_b: Array, b: Array, d: Array) -> Valued:
    # C = a.b - d;  Cdot = (b x a).(w_B - w_A);  J = [0, b x a]
    return _dot(a, b) - d, np.zeros_like(a), p_b, cross(b, a)


def _angle(p_a: Array, a: Array, k: Array, p_b: Array, b: Array, d: Array) -> Valued:
    # C = atan2(s, c) - d with s = k.(a x b), c = a.b (a at right angles to k)
    # J = [0, (c b x (k x a) - s b x a) / (s^2 + c^2)], which is [0, k] when b is at right angles to k
    across = cross(k, a)
    s, c = _dot(across, b), _dot(a, b)
    tau = (c[..., None] * cross(b, across) - s[..., None] * cross(b, a)) / (s * s + c * c)[..., None]
    return np.arctan2(s, c) - d, np.zeros_like(a), p_b, tau


def _distance(p_a: Array, a: Array, k: Array, p_b: Array, b: Array, d: Array) -> Valued:
    # C = |p_b - p_a| - d;  J = [u, (p_b-o) x u], u the unit vector from p_a to p_b
    u, size = _unit(p_b - p_a)
    return size - d, u, p_b, np.zeros_like(u)


def _line_distance(p_a: Array, a: Array, k: Array, p_b: Array, b: Array, d: Array) -> Valued:
    # C = |(I - aa')(p_b - p_a)| - d;  J = [u, (p_b-o) x u], u the unit vector from the line to p_b
    offset = p_b - p_a
    u, size = _unit(offset - a * _dot(a, offset)[..., None])
    return size - d, u, p_b, np.zeros_like(u)


def _skew_distance(p_a: Array, a: Array, k: Array, p_b: Array, b: Array, d: Array) -> Valued:
    # C = n.(p_b - p_a) - d, n = unit(a x b);  J = [n, (c_b-o) x n], c_b the foot of the common
    # perpendicular on B's line: there n's own turning changes nothing
    normal = cross(a, b)
    n, size = _unit(normal)
    offset = p_b - p_a
    along = _dot(cross(offset, a), normal) / np.maximum(size * size, LEAST_SPAN)
    return _dot(n, offset) - d, n, p_b + b * along[..., None], np.zeros_like(n)


def _circle_on_plane(p_a: Array, a: Array, k: Array, p_b: Array, b: Array, d: Array) -> Valued:
    # C = s n.(p_b - p_a) - r sqrt(1 - (n.b)^2), s = sign(d): the circle's nearest point is in the plane
    # J = [s n, (q-o) x s n], q = p_b - r unit(s n - b (b.s n)) the contact point
    radius = np.sqrt(_dot(k, k))
    n = a * np.sign(d)[..., None]
    u, span = _unit(n - b * _dot(b, n)[..., None])
    return _dot(n, p_b - p_a) - radius * span, n, p_b - u * radius[..., None], np.zeros_like(n)


def _line_moment(p_a: Array, a: Array, k: Array, p_b: Array, b: Array, d: Array) -> Valued:
    # C = a.((p_b - p_a) x b) - d, the Pluecker moment of B's line, whichever of its points p_b is
    # J = [b x a, (p_b-o) x (b x a) + b x (a x (p_b - p_a))]
    offset = p_b - p_a
    return _dot(a, cross(offset, b)) - d, cross(b, a), p_b, cross(b, cross(a, offset))


_KERNELS: Mapping[Atom, Callable[[Array, Array, Array, Array, Array, Array], Valued]] = {
    Atom.PIP: _pip,
    Atom.DOT: _dot_product,
    Atom.ANG: _angle,
    Atom.DIST: _distance,
    Atom.PLD: _line_distance,
    Atom.LLD: _skew_distance,
    Atom.CPT: _circle_on_plane,
    Atom.MOM: _line_moment,
}


def evaluate(atom: Atom, p_a: Array, a: Array, k: Array, p_b: Array, b: Array, d: Array) -> Valued:
    """Residual and wrench of many atoms of one kind, all in one frame.

    p_a, a, k, p_b, b: shape (..., 3): points in metres, directions as unit vectors (k of a CPT: of the
    circle's radius).  d: shape (...), metres, radians or a cosine.
    Returns residual (...), force f (..., 3), its point c (..., 3), free moment tau (..., 3).
    An ANG residual is in (-pi - d, pi - d]; whoever follows a motion unwraps it.
    """
    return _KERNELS[atom](p_a, a, k, p_b, b, d)
