"""What a motion is: the coordinates it goes by, the poses on the way, and why it ended.

Coordinates are as the source shows them: degrees and metres, counted from the joint's own zero.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ...spatial import Array


@dataclass(frozen=True, slots=True)
class Coordinate:
    """A joint's coordinate.

    name: by which it is driven.  joint: the joint's id.  unit: ``deg`` or ``m``.  value: at the exported pose.
    lower, upper: the joint's own limits, infinite where it has none.  All as the source shows them.

    >>> import kinefab
    >>> scene = kinefab.Scene()
    >>> hinge = scene.add_hinge(None, scene.add_part("Door"), point=(0, 1, 0), axis=(0, 1, 0), limits=(0, 110), name="Hinge")
    >>> coordinate = kinefab.motion(scene).coordinate("Hinge")
    >>> coordinate.unit, round(coordinate.upper)
    ('deg', 110)
    """

    name: str
    joint: str
    unit: str
    value: float
    lower: float
    upper: float


@dataclass(frozen=True, slots=True)
class Stop:
    """Why a motion ended before its last frame.

    reason: ``limit`` or ``dead point``.  coordinate: whose limit it is; at a dead point, the driven one that stops.
    value: of that coordinate there, in its ``unit``.  frames: those reached.

    >>> import kinefab
    >>> scene = kinefab.Scene()
    >>> hinge = scene.add_hinge(None, scene.add_part("Door"), point=(0, 1, 0), axis=(0, 1, 0), limits=(0, 110), name="Hinge")
    >>> stop = kinefab.motion(scene).sweep("Hinge", 0, 120, frames=61).stop
    >>> stop.reason, stop.coordinate, round(stop.value), stop.frames
    ('limit', 'Hinge', 110, 56)
    """

    reason: str
    coordinate: str
    value: float
    unit: str
    frames: int

    def __str__(self) -> str:
        what = "its limit" if self.reason == "limit" else "a dead point"
        return f"{self.coordinate} is at {what} at {self.value:.6g} {self.unit}"


@dataclass(frozen=True, slots=True)
class Branching:
    """Where another motion crosses the way (a folded parallelogram): it goes on straight, a built mechanism may not.

    coordinate: the driven one.  value: of it there, in its ``unit``.  frames: those that lie up to there.

    >>> import kinefab
    >>> print(kinefab.Branching("Crank", 180.0, "deg", 19))
    another motion branches off where Crank is at 180 deg
    """

    coordinate: str
    value: float
    unit: str
    frames: int

    def __str__(self) -> str:
        return f"another motion branches off where {self.coordinate} is at {self.value:.6g} {self.unit}"


@dataclass(frozen=True, slots=True, eq=False)
class Trajectory:
    """Poses of a mechanism, frame by frame.

    parts: ids.  poses: shape (frames, parts, 7), in the WORLD (right-handed, +Y up, +Z forward): position, metres, and
    quaternion (x, y, z, w).  coordinates: for each joint coordinate its values, shape (frames,), degrees or metres.
    stop: why there are fewer frames than asked for, or None.  branchings: where the mechanism could have gone another way.
    gap: how far the loops are from closed at most, radians or fractions of their size.

    >>> import kinefab, trimesh
    >>> scene = kinefab.Scene()
    >>> door = scene.add_part("Door", trimesh.creation.box((0.8, 2.0, 0.04)), translation=(0.4, 1.0, 0.0))
    >>> hinge = scene.add_hinge(None, door, point=(0, 1, 0), axis=(0, 1, 0), limits=(0, 110), name="Hinge")
    >>> motion = kinefab.motion(scene).sweep("Hinge", 0, 120, frames=61)
    >>> len(motion), motion["Hinge"].shape, motion["Door"].shape, motion.poses.shape
    (56, (56,), (56, 7), (56, 1, 7))
    >>> print(motion.stop)
    Hinge is at its limit at 110 deg
    """

    parts: tuple[str, ...]
    poses: Array
    coordinates: Mapping[str, Array]
    stop: Stop | None
    gap: float
    branchings: tuple[Branching, ...] = ()

    def __len__(self) -> int:
        return len(self.poses)

    def __repr__(self) -> str:
        """In one line: its arrays have thousands."""
        ended = f"; {self.stop}" if self.stop else ""
        return f"<Trajectory: {len(self)} frames; {', '.join(self.coordinates)}{ended}>"

    def __getitem__(self, name: str) -> Array:
        """The values of a coordinate, shape (frames,), or else the poses of a part.  Raises KeyError."""
        return self.coordinates[name] if name in self.coordinates else self.part(name)

    def part(self, id: str) -> Array:
        """The poses of a part, shape (frames, 7).  Raises KeyError.

        >>> scene = kinefab.Scene()
        >>> table = scene.add_part("Table")
        >>> slide = scene.add_slider(None, table, point=(0, 0, 0), axis=(1, 0, 0), name="Slide")
        >>> kinefab.motion(scene).sweep("Slide", 0, 0.4, frames=2).part("Table")[:, 0].round(9).tolist()
        [0.0, 0.4]
        """
        if id in self.parts:
            return self.poses[:, self.parts.index(id)]
        raise KeyError(f"{id!r} is neither a coordinate ({', '.join(self.coordinates)}) nor a part's id")
