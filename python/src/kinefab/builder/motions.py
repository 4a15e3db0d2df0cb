"""What a script says of a joint's freedoms, in degrees and metres, as the model's freedoms."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, Union, cast

import numpy as np

from ..model import (
    FREE,
    FREEDOM_NAMES,
    LOCKED,
    RX,
    UNLOCKED,
    Drive,
    Freedom,
    JointKind,
    Motion,
    Passive,
    freedoms_of,
)
from .arguments import LARGEST, Vector, checked_flag, checked_number, numbers_in, shown

Range = Vector
"""(lower, upper)."""
FreedomLike = Union[Freedom, Range, bool]
"""A range in degrees or metres, True for free, False for locked, or the model's own (radians)."""

DRIVE_WORDS = frozenset(
    {"target", "target_velocity", "stiffness", "damping", "max_force", "acceleration", "motor"}
)


KINDS_BY_WORD = {
    "hinge": JointKind.REVOLUTE,
    "slider": JointKind.PRISMATIC,
    "ball": JointKind.SPHERICAL,
    **{member.value: member for member in JointKind},
}
"""The words of ``add_hinge``, ``add_slider`` and ``add_ball``, as Unity's and CAD's users have them, beside the model's."""


def kind_of_word(kind: Any) -> JointKind:
    """A joint kind, or its word (``revolute``, ``hinge``)."""
    if isinstance(kind, JointKind):
        return kind
    if isinstance(kind, str) and kind in KINDS_BY_WORD:
        return KINDS_BY_WORD[kind]
    raise ValueError(f"the kind is {shown(kind)}; pass one of: {', '.join(KINDS_BY_WORD)}")


def checked_lead(kind: JointKind, lead: Any) -> float:
    """A screw's travel, metres a turn; 0 of any other joint."""
    pitch = checked_number("the lead", lead)
    if kind is JointKind.SCREW and pitch == 0.0:
        raise ValueError("a screw moves by its lead; pass lead=, metres a turn")
    if kind is not JointKind.SCREW and pitch != 0.0:
        raise ValueError(f"the lead of a {kind.value} joint is {lead}; only a screw has one")
    return pitch


def freedoms_asked(
    kind: JointKind,
    stated: Mapping[str, Any],
    limits: Any,
    drive: Any,
    spring: Any,
    damping: Any,
) -> tuple[Freedom, ...]:
    """The six freedoms of a joint of this kind.

    stated: by ``tx`` .. ``rz``.  limits, drive, spring, damping: of the one freedom that the kind leaves, or by the names
    of several.
    """
    given: dict[str, Freedom] = {}
    for name, asked in stated.items():
        stays = asked is False or (isinstance(asked, Freedom) and asked.motion is Motion.LOCKED)
        # What stays locked is no other kind of joint.
        _checked_name(JointKind.GENERAL if stays else kind, name)
        given[name] = _freedom(name, asked)
    freedoms = list(freedoms_of(kind, **given))
    for name, value in _by_name(kind, "limits", limits).items():
        if name in given and given[name].motion is not Motion.FREE:
            raise ValueError(f"{name} is stated twice, by limits and by {name}=; pass one of them")
        _set(freedoms, name, partial(_limited, name=name, limits=value))
    for name, value in _by_name(kind, "drive", drive).items():
        _set(freedoms, name, partial(replace, drive=_drive(name, value)))
    springs, dampers = _by_name(kind, "spring", spring), _by_name(kind, "damping", damping)
    for name in dict.fromkeys([*springs, *dampers]):
        passive = _passive(name, springs.get(name), dampers.get(name))
        _set(freedoms, name, partial(replace, passive=passive))
    # The joint's frames meet where the parts stand now.
    return tuple(f if f.at is not None or f.motion is Motion.LOCKED else replace(f, at=0.0) for f in freedoms)


def angular(name: str) -> bool:
    return FREEDOM_NAMES.index(name) >= RX


def _set(freedoms: list[Freedom], name: str, change: Callable[[Freedom], Freedom]) -> None:
    index = FREEDOM_NAMES.index(name)
    freedoms[index] = change(freedoms[index])
    if freedoms[index].motion is Motion.LOCKED:
        raise ValueError(
            f"{name} is locked; a drive, a spring or a damper needs it free: pass {name}=True or a range"
        )


def _checked_name(kind: JointKind, name: str) -> str:
    if name not in FREEDOM_NAMES:
        raise TypeError(f"{shown(name)} is no freedom; pass one of: {', '.join(FREEDOM_NAMES)}")
    free = [FREEDOM_NAMES[i] for i in UNLOCKED.get(kind, range(6))]
    if name not in free:
        left = " and ".join(free) or "none"
        what = f"turns about its axis, which is {free[0]}" if kind is JointKind.REVOLUTE else f"leaves {left}"
        what = f"slides along its axis, which is {free[0]}" if kind is JointKind.PRISMATIC else what
        raise ValueError(
            f"a {kind.value} joint {what}; {name} is locked in it: pass {free[0] if free else 'none'}="
        )
    return name


def _by_name(kind: JointKind, what: str, value: Any) -> dict[str, Any]:
    """A value for each freedom that it is stated for."""
    if value is None:
        return {}
    if isinstance(value, Mapping) and (what != "drive" or set(FREEDOM_NAMES) & value.keys()):
        stated = cast("Mapping[Any, Any]", value)
        return {_checked_name(kind, str(name)): each for name, each in stated.items()}
    free = UNLOCKED.get(kind, ())
    if not free and kind is not JointKind.GENERAL:
        raise ValueError(f"a {kind.value} joint leaves nothing free; it takes no {what}")
    if len(free) != 1:
        names = ", ".join(FREEDOM_NAMES[i] for i in free) or "none"
        raise ValueError(
            f"a {kind.value} joint leaves {names}; pass {what} by name, such as {what}={{'{FREEDOM_NAMES[(free or (0,))[0]]}': ...}}"
        )
    return {FREEDOM_NAMES[free[0]]: value}


def _freedom(name: str, asked: Any) -> Freedom:
    if isinstance(asked, bool):
        return FREE if asked else LOCKED
    if isinstance(asked, Freedom):
        _check_freedom(name, asked)
        return asked
    return _limited(FREE, name, asked)


def _limited(freedom: Freedom, name: str, limits: Any) -> Freedom:
    """limits: (lower, upper), degrees or metres; an end may be infinite."""
    lower, upper = checked_range(limits)
    unit = math.radians(1.0) if angular(name) else 1.0
    return replace(freedom, motion=Motion.LIMITED, lower=lower * unit, upper=upper * unit)


def checked_range(limits: Any) -> tuple[float, float]:
    """(lower, upper); an end may be infinite."""
    ends = numbers_in(limits)
    if ends is None or ends.shape != (2,):
        raise TypeError(
            f"limits are {shown(limits)}; pass two numbers, (lower, upper), math.inf for an open end, or None"
        )
    lower, upper = ends.tolist()
    if any(math.isfinite(end) and abs(end) > LARGEST for end in (lower, upper)):
        raise ValueError(
            f"limits are {shown(limits)}; pass two numbers, none but infinity beyond {LARGEST:g}"
        )
    if not lower <= upper or lower == math.inf or upper == -math.inf:
        raise ValueError(f"limits are {shown(limits)}; pass (lower, upper) with lower not above upper")
    return lower, upper


def _drive(name: str, drive: Any) -> Drive:
    """drive: a mapping with ``target`` (degrees or metres), ``target_velocity`` (a second), ``stiffness``, ``damping``
    (newtons, metres, radians), ``max_force``, ``acceleration``, ``motor``; or the model's own (radians)."""
    if isinstance(drive, Drive):
        _check_freedom(name, Freedom(drive=drive))
        return drive
    if not isinstance(drive, Mapping):
        raise TypeError(
            f"the drive of {name} is {shown(drive)}; pass a dict such as {{'target_velocity': 90, 'motor': True}}"
        )
    stated = cast("Mapping[str, Any]", drive)
    if unknown := stated.keys() - DRIVE_WORDS:
        raise TypeError(f"a drive has no {shown(sorted(unknown)[0])}; pass {', '.join(sorted(DRIVE_WORDS))}")
    unit = math.radians(1.0) if angular(name) else 1.0
    number = {
        word: checked_number(f"the drive's {word}", stated[word], least=least, infinite=word == "max_force")
        for word, least in (
            ("target", -math.inf),
            ("target_velocity", -math.inf),
            ("stiffness", 0.0),
            ("damping", 0.0),
            ("max_force", 0.0),
        )
        if word in stated
    }
    for word in ("acceleration", "motor"):
        checked_flag(f"the drive's {word}", stated.get(word, False))
    return Drive(
        number.get("target", 0.0) * unit,
        number.get("target_velocity", 0.0) * unit,
        number.get("stiffness", 0.0),
        number.get("damping", 0.0),
        number.get("max_force", math.inf),
        bool(stated.get("acceleration", False)),
        bool(stated.get("motor", False)),
    )


def _passive(name: str, spring: Any, damping: Any) -> Passive:
    """spring: stiffness (N/m or N m/rad), or (stiffness, rest) with the rest in degrees or metres.  damping: N s/m or
    N m s/rad."""
    rest = 0.0
    if isinstance(spring, np.ndarray):
        spring = spring.tolist()
    if isinstance(spring, Sequence) and not isinstance(spring, str):
        pair = cast("Sequence[Any]", spring)
        if len(pair) != 2:
            raise TypeError(
                f"the spring of {name} is {shown(pair)}; pass its stiffness, or (stiffness, rest)"
            )
        spring, rest = pair[0], checked_number(f"the rest of {name}'s spring", pair[1])
    stiffness = 0.0 if spring is None else checked_number(f"the spring of {name}", spring, least=0.0)
    loss = 0.0 if damping is None else checked_number(f"the damping of {name}", damping, least=0.0)
    return Passive(stiffness, rest * (math.radians(1.0) if angular(name) else 1.0), loss)


def _check_freedom(key: str, freedom: Freedom) -> None:
    """A range and a largest force may be infinite, nothing else, and nothing may be NaN."""
    open_ended = [freedom.lower, freedom.upper]
    finite = [freedom.stiffness, freedom.damping, freedom.restitution]
    if (drive := freedom.drive) is not None:
        open_ended.append(drive.max_force)
        finite += [drive.target, drive.target_velocity, drive.stiffness, drive.damping]
    if any(map(math.isnan, open_ended)) or not all(map(math.isfinite, finite)):
        raise ValueError(
            f"{key} is {shown(freedom)}; only a range and a largest force may be infinite, and none NaN"
        )
    gains = [freedom.stiffness, freedom.damping]
    gains += [] if drive is None else [drive.stiffness, drive.damping, drive.max_force]
    if min(gains) < 0.0 or not 0.0 <= freedom.restitution <= 1.0:
        raise ValueError(
            f"{key} is {shown(freedom)}; no stiffness, damping or force is below 0, no restitution outside 0..1"
        )
