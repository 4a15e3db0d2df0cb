"""The exact faces of a body, where the source has them: what a boundary representation says and triangles do not."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from ..spatial import Array


class FaceKind(str, Enum):
    PLANE = "plane"
    CYLINDER = "cylinder"
    CONE = "cone"
    SPHERE = "sphere"
    TORUS = "torus"
    OTHER = "other"


@dataclass(frozen=True, slots=True, eq=False)
class Face:
    """One face of a body, in the frame of the node that uses it, metres and radians.

    number: of the face in the source's own order, from 1.
    point: on the plane; on the axis of a cylinder; apex of a cone; centre of a sphere or torus; shape (3,).
    direction: outward normal of a plane, axis of the others, unit.  secondary: zero of ``around``, unit.
    radius: of a cylinder, a sphere, a torus's great circle.  minor: radius of a torus's small circle.
    half_angle: of a cone, which opens along ``direction``.
    hollow: the material lies outside the surface, as in a bore.
    along: extent from ``point`` along ``direction``, metres, (lower, upper).
    around: extent about ``direction`` from ``secondary``, radians, (lower, upper); 2 pi apart where it is whole.
    triangles: an approximation of the face within the chord tolerance, outward side counter-clockwise, shape (n, 3, 3).
    """

    kind: FaceKind
    number: int
    point: Array
    direction: Array
    secondary: Array
    radius: float
    minor: float
    half_angle: float
    hollow: bool
    along: tuple[float, float]
    around: tuple[float, float]
    triangles: Array
