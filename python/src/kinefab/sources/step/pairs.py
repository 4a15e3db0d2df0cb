"""Kinematic pairs of a STEP AP242 file: which links they join, their placements on these, their freedoms and ranges.

OpenCASCADE's binding has no classes for them, so they are read from the text.  A pair's flags say along and about which axes
of its placements it moves; names of pairs only say which range stands where.  Source: ISO 10303-105, by the attributes that
OpenCASCADE's readers give each entity and the files that build123d writes.  Of a gear pair rotation 2 is - rotation 1 * ratio,
of a rack and pinion the rotation is - displacement / radius (``gear_pair_value``, ``rack_and_pinion_pair_value``).
"""

from __future__ import annotations

import math
import re
from collections import defaultdict
from dataclasses import dataclass, field

import numpy as np

from ...spatial import Pose
from .entities import EntityError, Value, Word, entity, number, ref, text_of
from .part21 import Part21

FREEDOMS = ("tx", "ty", "tz", "rx", "ry", "rz")
OF_PAIR = {
    "REVOLUTE_PAIR": ("rz",), "PRISMATIC_PAIR": ("tz",), "CYLINDRICAL_PAIR": ("tz", "rz"), "SPHERICAL_PAIR": ("rx", "ry", "rz"),
    "PLANAR_PAIR": ("tx", "ty", "rz"), "FULLY_CONSTRAINED_PAIR": (), "UNIVERSAL_PAIR": ("rx", "rz"), "SCREW_PAIR": ("tz", "rz"),
    "SPHERICAL_PAIR_WITH_PIN": ("ry", "rz"), "UNCONSTRAINED_PAIR": FREEDOMS, "HOMOKINETIC_PAIR": ("rx", "rz"),
}  # fmt: skip
"""Where the file leaves the flags to be derived."""
COUPLED = ("GEAR_PAIR", "RACK_AND_PINION_PAIR")
"""They tie the motions of two links that other pairs carry, and hold nothing else."""
WITHOUT_FLAGS = (*COUPLED, "SCREW_PAIR")
_KINDS = sorted((*OF_PAIR, *COUPLED, "LOW_ORDER_KINEMATIC_PAIR"), key=len, reverse=True)
_PAIR = re.compile(r"^(\w+?_PAIR)(?:_WITH_(RANGE|PIN|PIN_AND_RANGE|MOTION_COUPLING))?$")
_HEADS = (
    b"(",
    b"KINEMATIC",
    b"CONTEXT_DEPENDENT_KIN",
    b"PRODUCT",
    b"NEXT_ASSEMBLY",
    b"SHAPE_DEF",
    b"RIGID_LINK",
)
"""How entities begin that pairs, their links or their usages are made of."""
PARALLEL = 1e-9


@dataclass(slots=True, eq=False)
class Pair:
    """One pair.  links: instances of its first and second link.  frames: its placement in each, in the file's unit.
    free: of FREEDOMS.  ranges: by freedom, radians and the file's unit.  pitch: of a screw.
    ratio: of a gear pair the ratio, of a rack the pinion's radius in the file's unit.
    lost: what of it cannot be kept, in words."""

    number: int
    name: str
    kind: str
    links: tuple[int, int]
    frames: tuple[Pose, Pose]
    free: tuple[str, ...]
    ranges: dict[str, tuple[float, float]] = field(default_factory=dict[str, tuple[float, float]])
    pitch: float = 0.0
    ratio: float = 0.0
    lost: str = ""


@dataclass(slots=True, eq=False)
class Link:
    """What a link is the shape of.  name: its own.  usage: instance of the assembly usage that it stands for, None where the
    file does not say.  product: name of its product, "" where unknown."""

    name: str = ""
    usage: int | None = None
    product: str = ""


@dataclass(slots=True, eq=False)
class Usage:
    """A NEXT_ASSEMBLY_USAGE_OCCURRENCE: its id and name, the products of the assembly and the component."""

    names: tuple[str, str]
    parent: str
    child: str


@dataclass(slots=True, eq=False)
class Mechanism:
    """pairs; faults: name of each pair that is damaged, and why.  links, usages: by instance.  bases: links that stand still."""

    pairs: list[Pair] = field(default_factory=list[Pair])
    faults: list[tuple[str, str]] = field(default_factory=list[tuple[str, str]])
    links: dict[int, Link] = field(default_factory=dict[int, Link])
    usages: dict[int, Usage] = field(default_factory=dict[int, Usage])
    bases: set[int] = field(default_factory=set[int])


def mechanism_of(text: Part21) -> Mechanism:
    """The pairs and links that a file states; what is damaged is among the faults."""
    known = _kinematics(text)
    found = Mechanism()
    for instance, given in known["damaged"].items():
        found.faults.append((f"#{instance}", text_of(given[""], 0)))
    turn = text.radians()
    seen: set[int] = set()
    for name, instances in known.items():
        if _PAIR.match(name) is None:
            continue
        for instance, given in instances.items():
            if instance in seen:
                continue
            seen.add(instance)
            try:
                found.pairs.append(_pair(text, instance, given, turn))
            except EntityError as error:
                label = text_of(given[""], 0) or f"#{instance}"
                found.faults.append((label, str(error)))
    found.pairs.sort(key=lambda pair: pair.number)
    _links(known, found)
    return found


def _kinematics(text: Part21) -> defaultdict[str, dict[int, dict[str, list[Value]]]]:
    """For each word the entities that are one, by number: their arguments by word, and under "" those of this word.  Pairs that
    no entity can be made of are ``damaged``, with what is wrong."""
    known: dict[str, dict[int, dict[str, list[Value]]]] = defaultdict(dict)
    for instance in text.instances:
        head = text.text(instance)[:40].lstrip().upper()
        if not head.startswith(_HEADS) and b"_PAIR" not in head:
            continue
        try:
            for name, arguments in (given := entity(text, instance)).items():
                known[name][instance] = {**given, "": arguments}
        except EntityError as error:
            if b"_PAIR" in head:
                known["damaged"][instance] = {"": [str(error)]}
    return known


def _pair(text: Part21, instance: int, given: dict[str, list[Value]], turn: float) -> Pair:
    """turn: radians in the file's unit of angle."""
    names = [name for name in given if name and _PAIR.match(name)]
    kind = max((k for k in _KINDS if any(n.startswith(k) for n in names)), key=_told, default="")
    if not kind:
        raise EntityError(f"{names[0].lower().replace('_', ' ')}s are not read")
    if len([name for name in given if name]) == 1:  # internal mapping: all arguments in a row
        row = given[names[0]]
        label, items, joint, flags, rest = text_of(row, 0), row[3:5], ref(row, 5), row[6:12], row[12:]
        if kind in WITHOUT_FLAGS:
            flags, rest = list[Value](), row[6:]
    else:
        label = text_of(given.get("REPRESENTATION_ITEM", []), 0)
        items = given.get("ITEM_DEFINED_TRANSFORMATION", [None] * 4)[2:4]
        joint = ref(given.get("KINEMATIC_PAIR", []), 0)
        flags = given.get("LOW_ORDER_KINEMATIC_PAIR", [])
        own = [] if kind == "LOW_ORDER_KINEMATIC_PAIR" else given.get(kind, [])
        own = given.get("UNIVERSAL_PAIR", []) if kind == "HOMOKINETIC_PAIR" else own
        ranged = "_AND_RANGE" if kind.endswith("_PIN") else "_WITH_RANGE"
        rest = [*own, *given.get(f"{kind}{ranged}", [])]
    frames = tuple(_placement(text, ref(items, side)) for side in (0, 1))
    edge = entity(text, joint).get("KINEMATIC_JOINT")
    if edge is None:
        raise EntityError("its joint is none")
    found = Pair(
        instance,
        label or f"#{instance}",
        kind,
        (ref(edge, 1), ref(edge, 2)),
        (frames[0], frames[1]),
        _free(kind, flags),
    )
    if kind == "SCREW_PAIR":
        pitch = number(rest, 0)
        if not pitch:
            raise EntityError("it has no pitch")
        found.pitch, rest = pitch, rest[1:]
    if kind in COUPLED:
        place, word = (4, "ratio") if kind == "GEAR_PAIR" else (0, "pinion radius")
        found.ratio = number(rest, place) or 0.0
        if not found.ratio:
            raise EntityError(f"it has no {word}")
        ranges = any(value is not None for value in rest[place + 1 :])
        found.lost = f"the range of a {'gear' if kind == 'GEAR_PAIR' else 'rack'}" if ranges else ""
        return found
    if kind in ("UNIVERSAL_PAIR", "HOMOKINETIC_PAIR"):
        if number(rest, 0):
            raise EntityError("its axes are not square")
        rest = rest[1:]
    _set_ranges(found, rest, turn)
    return found


def _told(kind: str) -> tuple[bool, bool, int]:
    """How much a name says of a pair that has several: a universal pair that is homokinetic is that."""
    return kind != "LOW_ORDER_KINEMATIC_PAIR", kind == "HOMOKINETIC_PAIR", len(kind)


def _free(kind: str, flags: list[Value]) -> tuple[str, ...]:
    stated = [isinstance(flag, Word) for flag in flags]
    if len(flags) == 6 and all(stated):
        return tuple(
            word for word, flag in zip(FREEDOMS, flags) if isinstance(flag, Word) and flag.text == "T"
        )
    if kind in COUPLED:
        return ()
    if kind not in OF_PAIR:
        raise EntityError("it does not state its freedoms")
    return OF_PAIR[kind]


def _set_ranges(pair: Pair, rest: list[Value], turn: float) -> None:
    """In the order of each kind's attributes: a cylinder's translation first, a plane's rotation first."""
    slides = [word for word in pair.free if word[0] == "t"]
    turns = [word for word in pair.free if word[0] == "r"]
    order = {
        "CYLINDRICAL_PAIR": (*slides, *turns), "PLANAR_PAIR": (*turns, *slides), "SCREW_PAIR": turns,
        "LOW_ORDER_KINEMATIC_PAIR": ("rx", "ry", "rz", "tx", "ty", "tz"),
    }.get(pair.kind, pair.free)  # fmt: skip
    if pair.kind.startswith(("SPHERICAL_PAIR", "HOMOKINETIC_PAIR")):
        word = "a ball" if pair.kind.startswith("S") else "a joint of constant velocity"
        pair.lost = f"the range of {word}" if any(value is not None for value in rest) else ""
        return
    for place, word in enumerate(order):
        low, high = number(rest, 2 * place), number(rest, 2 * place + 1)
        if low is None and high is None:
            continue
        unit = turn if word[0] == "r" else 1.0
        ends = (-math.inf if low is None else low * unit, math.inf if high is None else high * unit)
        if ends[0] > ends[1]:
            raise EntityError("its range ends before it begins")
        if word in pair.free:
            pair.ranges[word] = ends


def _placement(text: Part21, instance: int) -> Pose:
    """An AXIS2_PLACEMENT_3D, z its axis.  Raises EntityError."""
    row = entity(text, instance).get("AXIS2_PLACEMENT_3D")
    if row is None:
        raise EntityError("its placement is no AXIS2_PLACEMENT_3D")
    point = _three(text, ref(row, 1), "CARTESIAN_POINT")
    z = (
        _three(text, ref(row, 2), "DIRECTION")
        if len(row) > 2 and row[2] is not None
        else np.array([0.0, 0.0, 1.0])
    )
    given = len(row) > 3 and row[3] is not None
    x = _three(text, ref(row, 3), "DIRECTION") if given else np.eye(3)[int(np.argmin(np.abs(z)))]
    z = z / max(float(np.linalg.norm(z)), 1e-300)
    x = x - z * float(x @ z)
    length = float(np.linalg.norm(x))
    if not length > PARALLEL or not abs(float(z @ z) - 1.0) < PARALLEL:
        raise EntityError("the axes of its placement span nothing")
    x = x / length
    return Pose(np.column_stack([x, np.cross(z, x), z]), point)


def _three(text: Part21, instance: int, name: str) -> np.ndarray:
    row = entity(text, instance).get(name)
    values = row[1] if row is not None and len(row) > 1 else None
    if not isinstance(values, list) or len(values) != 3:
        raise EntityError(f"a {name} of its placement is none")
    found = [value for value in values if isinstance(value, float)]
    if len(found) != 3:
        raise EntityError(f"a {name} of its placement is none")
    return np.array(found)


def _links(known: dict[str, dict[int, dict[str, list[Value]]]], found: Mechanism) -> None:
    """What each link is the shape of, the usages, and which links stand still; what is damaged here is left unknown."""

    def rows(name: str) -> dict[int, list[Value]]:
        return {instance: given[name] for instance, given in known[name].items()}

    def follow(row: list[Value], index: int) -> int:
        try:
            return ref(row, index)
        except EntityError:
            return -1

    products = {i: text_of(row, 1) or text_of(row, 0) for i, row in rows("PRODUCT").items()}
    formations = {
        i: products.get(follow(row, 2), "")
        for name in ("PRODUCT_DEFINITION_FORMATION", "PRODUCT_DEFINITION_FORMATION_WITH_SPECIFIED_SOURCE")
        for i, row in rows(name).items()
    }
    definitions = {i: formations.get(follow(row, 2), "") for i, row in rows("PRODUCT_DEFINITION").items()}
    shapes = {i: definitions.get(follow(row, 2), "") for i, row in rows("PRODUCT_DEFINITION_SHAPE").items()}
    of_shape = {
        follow(row, 1): shapes.get(follow(row, 0), "")
        for row in rows("SHAPE_DEFINITION_REPRESENTATION").values()
    }
    for i, row in rows("NEXT_ASSEMBLY_USAGE_OCCURRENCE").items():
        ends = definitions.get(follow(row, 3), ""), definitions.get(follow(row, 4), "")
        found.usages[i] = Usage((text_of(row, 0), text_of(row, 1)), *ends)
    for i, row in rows("KINEMATIC_LINK").items():
        found.links[i] = Link(text_of(row, 0))
    link_of = {i: follow(row, 3) for i, row in rows("RIGID_LINK_REPRESENTATION").items()}
    associated: dict[int, Link] = {}
    for i, row in rows("KINEMATIC_LINK_REPRESENTATION_ASSOCIATION").items():
        link = found.links.get(link_of.get(follow(row, 2), -1))
        if link is not None:
            link.product, associated[i] = of_shape.get(follow(row, 3), ""), link
    usage_of = {i: follow(row, 2) for i, row in rows("PRODUCT_DEFINITION_RELATIONSHIP_KINEMATICS").items()}
    for row in rows("CONTEXT_DEPENDENT_KINEMATIC_LINK_REPRESENTATION").values():
        link = associated.get(follow(row, 0))
        if link is not None:
            link.usage = usage_of.get(follow(row, 1))
    for row in rows("KINEMATIC_PROPERTY_MECHANISM_REPRESENTATION").values():
        found.bases.add(link_of.get(follow(row, 2), -1))
