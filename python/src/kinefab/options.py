"""What a user may choose about an export; imports nothing heavy, as the command line needs it for --help."""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import Enum
from functools import partial
from numbers import Real
from typing import Any, TypeVar, cast

DEFAULT_DENSITY = 1000.0
"""kg/m^3, water: of bodies whose source and user say nothing."""


DEFAULT_SMOOTH = 30.0
"""Degrees: a cylinder of 12 or more sides is drawn round, a chamfer of 45 degrees is not."""


class ColliderShape(str, Enum):
    """AUTO: a box, ball or capsule where the mesh is one within 1e-4 of its size; else the mesh itself where nothing moves it by
    force, else its hull, or convex pieces where it is hollow.

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

    >>> import kinefab
    >>> kinefab.ExportOptions(ground="world").ground is kinefab.Ground.WORLD
    True
    """

    BODY = "body"
    WORLD = "world"

    @staticmethod
    def among(asked: dict[str, Any]) -> Ground:
        """What ``--ground`` says of the scene, taken out of what is asked of a source; a part's name stays there.

        >>> asked = {"ground": "world", "up": "Z"}
        >>> kinefab.Ground.among(asked).value, asked
        ('world', {'up': 'Z'})
        """
        words: dict[object, Ground] = {ground.value: ground for ground in Ground}
        return words[asked.pop("ground")] if asked.get("ground") in words else Ground.BODY


@dataclass(frozen=True, slots=True)
class FormatOption:
    """What a user may ask of a source format or a target; the command line makes ``--name`` of it.

    name: as Python has it, with underscores.  kind: str, float, int, bool or Path; several of it where ``repeated``.
    words: the values that it may have, () for any.  metavar: what the help calls the value.
    chooses: which of several states of the source is read; what is given is told as the scene's configuration.
    """

    name: str
    help: str
    kind: type = str
    repeated: bool = False
    words: tuple[str, ...] = ()
    metavar: str = ""
    chooses: bool = False

    def check(self, value: object) -> None:
        """Raises ValueError for a word that is none of ``words``, TypeError for a flag that is no bool and for what holds no
        several.  None is what nobody gave."""
        if value is None:
            return
        if self.kind is bool and not isinstance(value, bool):
            raise TypeError(f"{self.name} is {value!r}; pass True or False")
        given: Iterable[object] = (value,)
        if self.repeated and not isinstance(value, (str, os.PathLike)):
            if not isinstance(value, Iterable):
                raise TypeError(f"{self.name} is {value!r}; pass one of its values, or a list of them")
            given = cast("Iterable[object]", value)
        for each in given:
            if self.words and str(getattr(each, "value", each)) not in self.words:
                raise ValueError(f"{self.name} is {each!r}; pass one of: {', '.join(self.words)}")


@dataclass(frozen=True, slots=True, init=False)
class ExportOptions:
    """colliders: shape given to every body.  density: kg/m^3 of bodies that state none.
    strict: what would be approximated or dropped with a warning is an error, and nothing is written.
    closures: see ``Closures``.  solve: parts are moved to the nearest pose that satisfies the constraints.
    limits: mechanisms are swept and the ranges found written as joint limits.
    reading, writing: what is asked of the source's format and of the target, by the names of their options: those of
    ``kinefab export --help``, with underscores (``{"package_path": "src"}``).
    smooth: degrees between two faces up to which the edge between them is drawn smooth, where a mesh states no normals;
    None leaves such meshes without.
    ground: see ``Ground``.

    colliders, closures and ground may be given by their words ("box").  Raises ValueError for a word that is none and for a
    density or angle out of its range, TypeError for one that is no number, for a flag that is no bool and for what is asked
    without a name.

    >>> import kinefab
    >>> kinefab.ExportOptions(density=7850, ground="world").density
    7850
    >>> kinefab.ExportOptions(density=-1)
    Traceback (most recent call last):
    ValueError: the density is -1; it must be a number above zero
    """

    colliders: ColliderShape
    density: float
    strict: bool
    closures: Closures
    solve: bool
    limits: bool
    reading: Mapping[str, object]
    writing: Mapping[str, object]
    smooth: float | None
    ground: Ground

    def __init__(
        self,
        colliders: ColliderShape | str = ColliderShape.AUTO,
        density: float = DEFAULT_DENSITY,
        strict: bool = False,
        closures: Closures | str = Closures.EXACT,
        solve: bool = False,
        limits: bool = False,
        reading: Mapping[str, object] | None = None,
        writing: Mapping[str, object] | None = None,
        smooth: float | None = DEFAULT_SMOOTH,
        ground: Ground | str = Ground.BODY,
    ) -> None:
        put = partial(object.__setattr__, self)
        put("colliders", _of_word("colliders", ColliderShape, colliders))
        put("density", density)
        put("closures", _of_word("closures", Closures, closures))
        put("smooth", smooth)
        put("ground", _of_word("ground", Ground, ground))
        if isinstance(density, bool) or not isinstance(cast(object, density), Real):
            raise TypeError(f"the density is {density!r}; pass a number, kg/m^3")
        if not 0.0 < density < math.inf:
            raise ValueError(f"the density is {density}; it must be a number above zero")
        if smooth is not None:
            if isinstance(smooth, bool) or not isinstance(cast(object, smooth), Real):
                raise TypeError(f"smooth is {smooth!r}; pass an angle in degrees, or None")
            if not 0.0 <= smooth <= 180.0:
                raise ValueError(f"smooth is {smooth}; it must be an angle from 0 to 180 degrees")
        for name, flag in (("strict", strict), ("solve", solve), ("limits", limits)):
            if not isinstance(cast(object, flag), bool):
                raise TypeError(f"{name} is {flag!r}; pass True or False")
            put(name, flag)
        for name, asked in (("reading", reading), ("writing", writing)):
            if asked is not None and not isinstance(cast(object, asked), Mapping):
                raise TypeError(f"{name} is {asked!r}; pass a dict, values by the names of the options")
            put(name, asked or {})


def check_options(options: object) -> None:
    """Raises TypeError for what is none."""
    if not isinstance(options, ExportOptions):
        raise TypeError(f"the options are {options!r}; pass kinefab.ExportOptions(...)")


_Word = TypeVar("_Word", bound=Enum)


def _of_word(name: str, kind: type[_Word], value: object) -> _Word:
    try:
        return kind(value)
    except ValueError:
        words = ", ".join(str(member.value) for member in kind)
        raise ValueError(f"{name} is {value!r}; pass one of: {words}") from None
