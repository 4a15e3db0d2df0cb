"""What a script says of two parts' geometry, as CAD does: axis on axis, plane on plane, insert, tangent."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from typing import Any, TypeVar, Union

import numpy as np

from ..diagnostics import Report, Severity
from ..model import Constraint, ConstraintKind, Feature, FeatureKind, Node, Scene, Sense, Side
from .arguments import Vector, checked_flag, checked_name, checked_number, shown
from .features import Features
from .ids import Ids
from .motions import checked_range

FeatureLike = Union[Feature, int]
"""A feature, or a whole part by its index."""
Word = TypeVar("Word", bound=Enum)


@dataclass(frozen=True, slots=True)
class Value:
    """What a kind's number is.  unit: in scene units, one of the script's.  needed: it says nothing without.  nonzero: nor
    with 0.  ranged: ``limits`` may stand in its place."""

    meaning: str
    unit: float = 1.0
    needed: bool = True
    nonzero: bool = False
    ranged: bool = False


_RATIO = Value("how far b moves for one of a", nonzero=True)
VALUES = {
    ConstraintKind.DISTANCE: Value("metres", ranged=True),
    ConstraintKind.ANGLE: Value("degrees", math.radians(1.0), ranged=True),
    ConstraintKind.INSERT: Value("the offset along the axis, metres", needed=False, ranged=True),
    ConstraintKind.COINCIDENT: Value("the offset, metres", needed=False),
    ConstraintKind.SCREW: Value("the lead, metres a turn", nonzero=True),
    ConstraintKind.RACK: Value("the pitch radius, metres of travel a radian", nonzero=True),
    **dict.fromkeys((ConstraintKind.GEAR, ConstraintKind.BELT, ConstraintKind.LINEAR), _RATIO),
    ConstraintKind.OTHER: Value("any number", needed=False),
}
"""Of the kinds that have one."""

COUPLES = (ConstraintKind.GEAR, ConstraintKind.BELT, ConstraintKind.RACK, ConstraintKind.LINEAR)
THIRDS = {
    ConstraintKind.SYMMETRY: "the plane between a and b",
    ConstraintKind.ANGLE: "the axis that the angle is about",
    **dict.fromkeys(COUPLES, "the part that carries both axes"),
}
"""What the third side is, of the kinds that have one."""

WHOLE = (ConstraintKind.LOCK, ConstraintKind.LOCK_ORIENTATION, ConstraintKind.GROUND, ConstraintKind.OTHER)
"""Kinds that hold whole parts too."""
ALONE = (ConstraintKind.GROUND, ConstraintKind.OTHER)
"""Kinds that do without b."""
TURN_LOCKED = (ConstraintKind.INSERT, ConstraintKind.CONCENTRIC)
ROUND = (FeatureKind.CIRCLE, FeatureKind.CYLINDER, FeatureKind.SPHERE)

READINGS = {
    "line_line_distance": ("parallel", "skew"),
    "tangent_cylinders": ("parallel", "skew"),
    "offset": ("along_normal",),
    "angle": ("directed",),
}
"""As ``schemas/SPEC.md`` has them."""

TAKES = {
    ConstraintKind.CONCENTRIC: "axes, circles, cylinders, cones, points and spheres",
    ConstraintKind.PARALLEL: "axes and planes",
    ConstraintKind.PERPENDICULAR: "axes and planes",
    ConstraintKind.ANGLE: "axes and planes",
    ConstraintKind.TANGENT: "a plane with a sphere, cylinder, cone or circle, spheres and cylinders with each other",
    ConstraintKind.INSERT: "two circles, or other geometry with an axis",
    ConstraintKind.SYMMETRY: "two of a kind, points, axes or planes, and a plane as c",
}
"""Where it is not whatever has a direction."""


class Constraints(Features):
    """What ``Scene`` knows of constraints between its parts' geometry."""

    __slots__ = ("_constraint_ids",)

    def __init__(self, *args: Any, **fields: Any) -> None:
        super().__init__(*args, **fields)
        self._constraint_ids = Ids()

    def add_constraint(
        self,
        kind: ConstraintKind | str,
        a: FeatureLike,
        b: FeatureLike | None = None,
        *,
        c: FeatureLike | None = None,
        value: float | None = None,
        limits: Vector | None = None,
        sense: Sense | str = Sense.EITHER,
        side: Side | str = Side.EITHER,
        lock_rotation: bool = False,
        reading: Mapping[str, str] | None = None,
        name: str = "",
    ) -> Constraint:
        """Add a constraint between two parts' geometry, as CAD's mates are; the analysis finds the joints that it leaves.

        kind: a ConstraintKind or its word; ``help(kinefab.ConstraintKind)`` has what each holds.
        a, b: features: ``point``, ``axis``, ``plane``, ``circle``, ``cylinder``, ``sphere``, ``cone``, ``frame``; whole parts
        by their index for ``lock``, ``lock_orientation`` and, alone, ``ground``.
        c: of ``symmetry`` the plane between; of ``angle`` the axis that it is about; of ``gear``, ``belt``, ``rack`` and
        ``linear`` the part that carries both axes (without: the world).
        value: metres of ``distance``, ``insert`` and ``coincident`` (an offset), degrees of ``angle``, metres a turn of
        ``screw``, the pitch radius of ``rack``, the ratio (b for one of a) of ``gear``, ``belt`` and ``linear``.
        limits: (lower, upper) in place of the value of ``distance``, ``insert`` and ``angle``; an end may be infinite.
        sense: whether the two directions are ``aligned``, ``opposed``, or ``either``, as they stand now.
        side: of ``tangent``: ``inside``, ``outside``, or ``either``, as they stand now.
        lock_rotation: of ``insert`` and ``concentric``: that the parts do not turn either.
        reading: what CAD programs mean by the same words where they differ, such as ``{"offset": "along_normal"}``
        (``schemas/SPEC.md``, section 7).
        Where the parts do not stand so, ``motion`` closes the gap, and ``export`` with ``solve=True``; else it is told.
        Raises TypeError for what is no feature or number, ValueError for a part of another scene, one part with itself, a
        value that the kind has not or needs, and geometry between which the kind says nothing.

        >>> scene = kinefab.Scene()
        >>> frame = scene.add_part("Frame", grounded=True)
        >>> wheel = scene.add_part("Wheel", translation=(0, 0.3, 0))
        >>> hub = scene.circle(frame, center=(0, 0.3, 0.01), axis=(0, 0, 1), radius=0.01)
        >>> bore = scene.circle(wheel, center=(0, 0, 0.01), axis=(0, 0, 1), radius=0.01, coordinates="part")
        >>> scene.add_constraint("insert", hub, bore, name="Bearing").id
        'Bearing'
        >>> kinefab.motion(scene).mobility
        1
        """
        kind = _word(ConstraintKind, "kind", kind)
        checked_name(name)
        checked_flag("lock_rotation", lock_rotation)
        if lock_rotation and kind not in TURN_LOCKED:
            raise ValueError(f"{kind.value} has no lock_rotation; only insert and concentric have")
        stated, side = _word(Sense, "sense", sense), _word(Side, "side", side)
        if side is not Side.EITHER and kind is not ConstraintKind.TANGENT:
            raise ValueError(f"{kind.value} has no side; only tangent has")
        features = self._sides(kind, a, b, c)
        number, lower, upper = _measure(kind, value, limits)
        constraint = Constraint(
            self._constraint_ids.free(name or f"{kind.value} mate:{len(self.constraints) + 1}", self.constraints),
            # As a bundle's: plane on plane at 5 mm is what CAD calls both.
            ConstraintKind.DISTANCE if kind is ConstraintKind.COINCIDENT and number else kind,
            features,
            number,
            lower,
            upper,
            stated,
            side,
            bool(lock_rotation),
            name=name,
            raw_kind=kind.value,
            reading=_readings(reading),
        )
        _check_pairing(self.nodes, constraint)
        self.constraints.append(constraint)
        return constraint

    def _sides(
        self, kind: ConstraintKind, a: FeatureLike, b: FeatureLike | None, c: FeatureLike | None
    ) -> tuple[Feature, ...]:
        if b is None and kind not in ALONE:
            raise ValueError(f"{kind.value} stands between two features; pass b")
        if b is not None and kind is ConstraintKind.GROUND:
            raise ValueError("ground fixes one part to the world; pass no b")
        if c is not None and kind not in THIRDS:
            raise ValueError(f"{kind.value} stands between two features; pass no c")
        if c is None and kind is ConstraintKind.SYMMETRY:
            raise ValueError(f"symmetry needs {THIRDS[kind]}; pass it as c")
        found = [self._side("a", a, kind in WHOLE)]
        found += [] if b is None else [self._side("b", b, kind in WHOLE)]
        found += [] if c is None else [self._side("c", c, kind in COUPLES)]
        if kind is ConstraintKind.GROUND and found[0].node is None:
            raise ValueError("a is the world's, which stands still anyway; pass a part")
        # A slot is centred on another part's plane: of a symmetry a and b may be one part's.
        held = found if kind is ConstraintKind.SYMMETRY else found[:2]
        if len(held) > 1 and len({feature.node for feature in held}) == 1:
            raise ValueError(f"{kind.value} joins {self.name(found[0].node)} to itself; pass features of two parts")
        return tuple(found)

    def _side(self, argument: str, side: FeatureLike, whole: bool) -> Feature:
        """A feature, or a part as one; the index of its part looked at again, as it may be another scene's."""
        if isinstance(side, Feature):
            if side.node is not None:
                self._check_index(side.node, f"the part of {argument}")
            return replace(side, node=None if side.node is None else int(side.node))
        if whole:
            self._check_index(side, argument)
            return Feature(int(side), FeatureKind.BODY, np.zeros(3))
        known = isinstance(side, (int, np.integer)) and not isinstance(side, bool)
        raise TypeError(
            f"{argument} is {shown(side)}; pass a feature, such as scene.plane({side if known else 'part'}, point=..., normal=...)"
        )


def _word(words: type[Word], argument: str, given: Any) -> Word:
    """A member of an enum, or its word."""
    try:
        return words(given)
    except ValueError:
        known = ", ".join(str(member.value) for member in words)
        raise ValueError(f"the {argument} is {shown(given)}; pass one of: {known}") from None


def _measure(kind: ConstraintKind, value: Any, limits: Any) -> tuple[float, float | None, float | None]:
    """Value and range in metres and radians."""
    own = VALUES.get(kind)
    if value is not None and limits is not None:
        raise ValueError(f"{kind.value} is given a value and limits; pass one of them")
    if limits is not None:
        if own is None or not own.ranged:
            ranged = ", ".join(k.value for k, each in VALUES.items() if each.ranged)
            raise ValueError(f"{kind.value} has no limits; only {ranged} have")
        ends = checked_range(limits)
        if not any(map(math.isfinite, ends)):
            raise ValueError(f"limits are {shown(limits)}; pass one end at least that is finite")
        lower, upper = (end * own.unit if math.isfinite(end) else None for end in ends)
        return 0.0, lower, upper
    if value is None:
        if own is not None and own.needed:
            more = ", or limits=(lower, upper)" if own.ranged else ""
            raise ValueError(f"{kind.value} needs a value: {own.meaning}; pass value={more}")
        return 0.0, None, None
    if own is None:
        raise ValueError(f"{kind.value} has no value; pass none, or another kind, such as distance or angle")
    number = checked_number("the value", value)
    if own.nonzero and number == 0.0:
        raise ValueError(f"the value of {kind.value} is 0; pass {own.meaning}")
    return number * own.unit, None, None


def _readings(given: Mapping[str, str] | None) -> dict[str, str]:
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise TypeError(f"the reading is {shown(given)}; pass a dict, such as {{'offset': 'along_normal'}}")
    for key, word in given.items():
        if word not in READINGS.get(key, ()):
            known = "; ".join(f"{k}: {', '.join(words)}" for k, words in READINGS.items())
            raise ValueError(f"the reading {shown(key)} is {shown(word)}; known are {known}")
    return dict(given)


def _check_pairing(nodes: Sequence[Node], constraint: Constraint) -> None:
    """Raise ValueError where the analysis would have no equations for it, which is asked here, of its parts alone."""
    if constraint.kind in ALONE:
        return
    words = " and ".join(feature.kind.value for feature in constraint.features)
    bare = [f.kind.value for f in constraint.features if f.kind in ROUND and f.radius == 0.0]
    if constraint.kind is ConstraintKind.TANGENT and bare:
        raise ValueError(f"tangent of {words}: the {bare[0]} has no radius; pass one")
    from ..analysis.equations.scene_equations import equations_of

    numbers = sorted({f.node for f in constraint.features if f.node is not None})
    apart = replace(
        constraint,
        features=tuple(
            f if f.node is None else replace(f, node=numbers.index(f.node)) for f in constraint.features
        ),
    )
    report = Report()
    equations_of(Scene(nodes=[replace(nodes[i], parent=None) for i in numbers], constraints=[apart]), report)
    for wrong in report.of(Severity.ERROR):
        raise ValueError(f"{wrong.message} {wrong.remedy}")
    codes = {finding.code for finding in report.diagnostics}
    if "CONSTRAINT_PAIRING_UNKNOWN" in codes:
        takes = TAKES.get(constraint.kind, "geometry with a direction")
        raise ValueError(f"{constraint.kind.value} says nothing between {words}; it takes {takes}")
    # An angle's axis may be that of a constraint that comes later.
    if "CONSTRAINT_RANGE_DROPPED" in codes and constraint.kind is not ConstraintKind.ANGLE:
        raise ValueError(
            f"{constraint.kind.value} of {words} can have no limits, as no joint counts it; pass a plane and another feature"
        )
