"""What a user may choose about an export; imports nothing heavy, as the command line needs it for --help."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from numbers import Real
from typing import Any

DEFAULT_DENSITY = 1000.0
"""kg/m^3, water: of bodies whose source and user say nothing."""


DEFAULT_SMOOTH = 30.0
"""Degrees: a cylinder of 12 or more sides is drawn round, a chamfer of 45 degrees is not."""


class ColliderShape(str, Enum):
    """AUTO: the mesh itself where nothing moves it by force, else its hull, or convex pieces where it is hollow.

    >>> import kinefab
    >>> kinefab.ExportOptions(colliders="box").colliders is kinefab.ColliderShape.BOX
    True
    """

    AUTO = "auto"
    NONE = "none"
    BOX = "box"
    HULL = "hull"
    DECOMPOSE = "decompose"
    MESH = "mesh"


class Closures(str, Enum):
    """How a joint that closes a loop is written.

    EXACT: whole, as every other joint, so that the loop holds in Unity's solver under loads across its plane too.
    MINIMAL: with its independent equations only; right for a direct solver, which repeated equations make singular.

    >>> import kinefab
    >>> kinefab.ExportOptions(closures="minimal").closures is kinefab.Closures.MINIMAL
    True
    """

    EXACT = "exact"
    MINIMAL = "minimal"


class Ground(str, Enum):
    """What stands for the ground.

    BODY: one kinematic Rigidbody above everything, to which the joints connect, so that the whole can be placed and made many
    times.  WORLD: joints connect to nothing, which Unity takes for the world, and grounded parts are static colliders.
    """

    BODY = "body"
    WORLD = "world"

    @staticmethod
    def among(asked: dict[str, Any]) -> Ground:
        """What ``--ground`` says of the scene, taken out of what is asked of a source; a part's name stays there."""
        words: dict[object, Ground] = {ground.value: ground for ground in Ground}
        return words[asked.pop("ground")] if asked.get("ground") in words else Ground.BODY


@dataclass(frozen=True, slots=True)
class FormatOption:
    """What a user may ask of a source format or a target; the command line makes ``--name`` of it.

    name: as Python has it, with underscores.  kind: str, float, int, bool or Path; several of it where ``repeated``.
    words: the values that it may have, () for any.  metavar: what the help calls the value.
    """

    name: str
    help: str
    kind: type = str
    repeated: bool = False
    words: tuple[str, ...] = ()
    metavar: str = ""


@dataclass(frozen=True, slots=True)
class ExportOptions:
    """colliders: shape given to every body.  density: kg/m^3 of bodies that state none.
    strict: what would be approximated or dropped with a warning is an error, and nothing is written.
    closures: see ``Closures``.  solve: parts are moved to the nearest pose that satisfies the constraints.
    limits: mechanisms are swept and the ranges found written as joint limits.
    smooth: degrees between two faces up to which the edge between them is drawn smooth, where a mesh states no normals;
    None leaves such meshes without.
    reading, writing: what is asked of the source's format and of the target, by the names of their options.
    ground: see ``Ground``.

    colliders, closures and ground may be given by their words ("box").  Raises ValueError for a word that is none and for a
    density or angle out of its range, TypeError for one that is no number and for a flag that is no bool.

    >>> import kinefab
    >>> kinefab.ExportOptions(density=7850, ground="world").density
    7850
    >>> kinefab.ExportOptions(density=-1)
    Traceback (most recent call last):
    ValueError: the density is -1; it must be a number above zero
    """

    colliders: ColliderShape = ColliderShape.AUTO
    density: float = DEFAULT_DENSITY
    strict: bool = False
    closures: Closures = Closures.EXACT
    solve: bool = False
    limits: bool = False
    reading: Mapping[str, object] = field(default_factory=dict[str, object])
    writing: Mapping[str, object] = field(default_factory=dict[str, object])
    smooth: float | None = DEFAULT_SMOOTH
    ground: Ground = Ground.BODY

    def __post_init__(self) -> None:
        for name, kind in (("colliders", ColliderShape), ("closures", Closures), ("ground", Ground)):
            try:
                object.__setattr__(self, name, kind(getattr(self, name)))
            except ValueError:
                words = ", ".join(member.value for member in kind)
                raise ValueError(f"{name} is {getattr(self, name)!r}; pass one of: {words}") from None
        if isinstance(self.density, bool) or not isinstance(self.density, Real):
            raise TypeError(f"the density is {self.density!r}; pass a number, kg/m^3")
        if not 0.0 < self.density < math.inf:
            raise ValueError(f"the density is {self.density}; it must be a number above zero")
        if self.smooth is not None:
            if isinstance(self.smooth, bool) or not isinstance(self.smooth, Real):
                raise TypeError(f"smooth is {self.smooth!r}; pass an angle in degrees, or None")
            if not 0.0 <= self.smooth <= 180.0:
                raise ValueError(f"smooth is {self.smooth}; it must be an angle from 0 to 180 degrees")
        for name in ("strict", "solve", "limits"):
            if not isinstance(getattr(self, name), bool):
                raise TypeError(f"{name} is {getattr(self, name)!r}; pass True or False")
