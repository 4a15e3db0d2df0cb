"""The geometry of parts that a script's constraints stand on: points, axes, planes and round surfaces."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..model import Feature, FeatureKind
from ..spatial import Array, Pose, frame_from_axes
from .arguments import Vector, checked_axes, checked_number, checked_positive, checked_vector, shown
from .parts import Parts


class Features(Parts):
    """What ``Scene`` knows of its parts' geometry.  A feature belongs to one part and moves with it.

    Every method takes a part (None: the world) and ``coordinates``: ``world``, where the part stands now, or ``part``, its own
    frame; metres.  Raises TypeError for a part that is no index, ValueError for one that the scene has not, for a direction
    without length, a number that is not finite and a size that is not above zero.
    """

    __slots__ = ()

    def point(self, part: int | None, point: Vector, *, coordinates: str = "world") -> Feature:
        """A point of a part: a corner, the centre of a hole's edge.

        >>> scene = kinefab.Scene()
        >>> lid = scene.add_part("Lid", translation=(0, 0.2, 0))
        >>> scene.point(lid, (0, 0.2, 0.1)).point.tolist()  # in the part's frame
        [0.0, 0.0, 0.1]
        """
        return self._feature(FeatureKind.POINT, part, point, coordinates)

    def axis(self, part: int | None, *, point: Vector, direction: Vector, coordinates: str = "world") -> Feature:
        """A straight line of a part, through ``point``: an axis, an edge.

        >>> scene = kinefab.Scene()
        >>> scene.axis(scene.add_part("Lid"), point=(0, 0.2, 0), direction=(2, 0, 0)).direction.tolist()
        [1.0, 0.0, 0.0]
        """
        return self._feature(FeatureKind.LINE, part, point, coordinates, direction)

    def plane(self, part: int | None, *, point: Vector, normal: Vector, coordinates: str = "world") -> Feature:
        """A plane or flat face of a part, through ``point``; its normal points out of the part.

        >>> scene = kinefab.Scene()
        >>> scene.plane(None, point=(0, 0, 0), normal=(0, 1, 0)).kind.value  # the floor
        'plane'
        """
        return self._feature(FeatureKind.PLANE, part, point, coordinates, normal)

    def circle(
        self, part: int | None, *, center: Vector, axis: Vector, radius: float = 0.0, coordinates: str = "world"
    ) -> Feature:
        """A round edge of a part: a hole's, a shaft's.  radius: only a tangency needs it.

        >>> scene = kinefab.Scene()
        >>> scene.circle(scene.add_part("Bolt"), center=(0, 0.01, 0), axis=(0, 1, 0), radius=0.004).radius
        0.004
        """
        return self._feature(FeatureKind.CIRCLE, part, center, coordinates, axis, radius=radius)

    def cylinder(
        self, part: int | None, *, point: Vector, axis: Vector, radius: float = 0.0, coordinates: str = "world"
    ) -> Feature:
        """A cylinder of a part: a shaft, a bore; ``point`` anywhere on its axis.  radius: only a tangency needs it.

        >>> scene = kinefab.Scene()
        >>> scene.cylinder(scene.add_part("Roller"), point=(0, 0, 0), axis=(0, 0, 1), radius=0.02).kind.value
        'cylinder'
        """
        return self._feature(FeatureKind.CYLINDER, part, point, coordinates, axis, radius=radius)

    def sphere(
        self, part: int | None, *, center: Vector, radius: float = 0.0, coordinates: str = "world"
    ) -> Feature:
        """A sphere of a part: a ball, a socket.  radius: only a tangency needs it.

        >>> scene = kinefab.Scene()
        >>> scene.sphere(scene.add_part("Ball"), center=(0, 0.02, 0), radius=0.02).kind.value
        'sphere'
        """
        return self._feature(FeatureKind.SPHERE, part, center, coordinates, radius=radius)

    def cone(
        self, part: int | None, *, apex: Vector, axis: Vector, half_angle: float, coordinates: str = "world"
    ) -> Feature:
        """A cone of a part.  axis: from the apex into it.  half_angle: between axis and surface, degrees.

        >>> scene = kinefab.Scene()
        >>> scene.cone(scene.add_part("Tip"), apex=(0, 0, 0), axis=(0, 1, 0), half_angle=30).kind.value
        'cone'
        """
        half = checked_positive("the half_angle", half_angle)
        if half >= 90.0:
            raise ValueError(f"the half_angle is {half_angle}; pass degrees below 90, or a plane")
        return self._feature(FeatureKind.CONE, part, apex, coordinates, axis, half_angle=math.radians(half))

    def frame(
        self,
        part: int | None,
        *,
        origin: Vector,
        axis: Vector,
        secondary: Vector,
        coordinates: str = "world",
    ) -> Feature:
        """A whole frame of a part, as a CAD program's coordinate system: its Z along ``axis``, its X near ``secondary``.

        >>> scene = kinefab.Scene()
        >>> frame = scene.frame(scene.add_part("Hand"), origin=(0, 0, 0), axis=(0, 0, 1), secondary=(1, 0, 0))
        >>> frame.direction.tolist(), frame.secondary.tolist()
        ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0])
        """
        z, x, _ = frame_from_axes(*checked_axes(axis, secondary)).T
        return self._feature(FeatureKind.FRAME, part, origin, coordinates, z, x)

    def _feature(
        self,
        kind: FeatureKind,
        part: int | None,
        point: Any,
        coordinates: str,
        direction: Any = None,
        secondary: Array | None = None,
        radius: float = 0.0,
        half_angle: float = 0.0,
    ) -> Feature:
        """The feature in its part's frame."""
        if part is not None:
            self._check_index(part, "part")
        if coordinates not in ("world", "part"):
            raise ValueError(f"coordinates is {shown(coordinates)}; pass world or part")
        size = checked_number(f"the radius of the {kind.value}", radius, least=0.0)
        inside = Pose() if coordinates == "part" else self.pose(part).inverse()
        at = inside.point(checked_vector(f"the place of the {kind.value}", point))
        turned = None if direction is None else inside.direction(_unit(kind, direction))
        beside = None if secondary is None else inside.direction(secondary)
        return Feature(part, kind, at, turned, beside, size, half_angle)


def _unit(kind: FeatureKind, direction: Any) -> Array:
    vector = checked_vector(f"the direction of the {kind.value}", direction)
    length = float(np.linalg.norm(vector))
    if not length > 0.0:
        raise ValueError(f"the direction of the {kind.value} is {shown(direction)}; pass one of some length")
    return vector / length
