"""The kinematic pairs of an AP242 file put on the parts of the scene, as joints."""

from __future__ import annotations

import contextlib
import itertools
import math
from dataclasses import replace

import numpy as np

from ...diagnostics import Report, is_encodable
from ...model import (
    FREEDOM_NAMES,
    IN_BRACKETS,
    Freedom,
    FreeIds,
    Joint,
    JointKind,
    Motion,
    Scene,
    freedoms_of,
    kind_of,
)
from ...spatial import Array, Pose
from ..asmt.assembled import UNCARRIED, bodies_of
from ..asmt.constant_velocity import add_constant_velocity
from ..asmt.couplings import UncarriedError, coupling_of
from ..asmt.joints import TO_X_MAIN, Marker, Statement
from ..reading.record import shown
from .pairs import COUPLED, FREEDOMS, Link, Mechanism, Pair, mechanism_of
from .part21 import Part21


def add_pairs(scene: Scene, text: Part21, turn: Array, length: float, report: Report) -> None:
    """Add the file's pairs to the scene, whose nodes stand already; each is told as kept or left out.

    turn: source axes to the scene's, shape (3, 3).  length: metres in the file's unit.
    """
    found = mechanism_of(text)
    for name, reason in found.faults:
        _left(scene, name, reason, report)
    placed = _Parts(scene, found)
    for link in sorted(found.bases):
        node = placed.node(link)
        if node is not None:
            scene.nodes[node] = replace(scene.nodes[node], grounded=True)
    free_ids = FreeIds(form=IN_BRACKETS)
    coupled: list[tuple[Pair, Statement]] = []
    for pair in found.pairs:
        a, b = (placed.node(link) for link in pair.links)
        if a is None or b is None:
            _left(scene, pair.name, "the file does not say which part one of its links is", report)
        elif a == b:
            _left(scene, pair.name, "both links are the same part", report)
        elif len(pair.free) == len(FREEDOMS):
            continue  # it holds nothing
        else:
            name = free_ids.take(_plain(pair.name))
            where = f"{scene.source.uri}:#{pair.number}"
            if pair.kind in COUPLED:
                coupled.append((pair, _tie(pair, name, a, b, turn, length, where)))
                continue
            if pair.kind == "HOMOKINETIC_PAIR":
                ends = [(node, _shaft(frame, turn, length)) for node, frame in zip((a, b), pair.frames)]
                add_constant_velocity(scene, name, pair.name, (ends[0], ends[1]), where)
            else:
                scene.joints.append(_joint(pair, name, a, b, turn, length, where))
            report.kept(f"kinematic pair {name}", where)
            _tell_lost(pair, name, where, report)
    _add_coupled(scene, coupled, report)


def _tell_lost(pair: Pair, name: str, where: str, report: Report) -> None:
    if pair.lost:
        reason = f"{pair.lost} has no place in a joint"
        report.dropped(f"{pair.lost} {name}", "STEP_PAIRS_DROPPED", where, name=name, reason=reason)


def _tie(pair: Pair, name: str, a: int, b: int, turn: Array, length: float, where: str) -> Statement:
    """What ties the motions of two links that other pairs carry."""
    sides = [Marker(n, _in_scene(frame, turn, length)) for n, frame in zip((a, b), pair.frames)]
    if pair.kind == "GEAR_PAIR":  # rotation 2 + ratio * rotation 1 = constant, each about its own z
        return Statement(name, "GearJoint", sides[0], sides[1], pair.ratio, 1.0, name=pair.name, where=where)
    return Statement(
        name, "RackPinionJoint", sides[0], sides[1], pair.ratio * length, name=pair.name, where=where
    )


def _add_coupled(scene: Scene, coupled: list[tuple[Pair, Statement]], report: Report) -> None:
    """Add the couplings.  Either link of a rack and pinion may be the rack: it goes along its x as the pinion turns about z."""
    bodies, joints = bodies_of(scene), list(scene.joints)
    for pair, statement in coupled:
        other_way = replace(statement, i=statement.j, j=statement.i)
        for asked in (statement, other_way) if pair.kind == "RACK_AND_PINION_PAIR" else (statement,):
            with contextlib.suppress(UncarriedError):
                scene.couplings.append(coupling_of(asked, joints, bodies))
                break
        else:
            _left(scene, pair.name, UNCARRIED, report)
            continue
        report.kept(f"kinematic pair {statement.id}", statement.where)
        _tell_lost(pair, statement.id, statement.where, report)


def _in_scene(frame: Pose, turn: Array, length: float) -> Pose:
    """A placement in the scene's axes and metres."""
    return Pose(turn @ frame.rotation, turn @ frame.translation * length)


def _shaft(frame: Pose, turn: Array, length: float) -> Pose:
    """A homokinetic pair's placement with its shaft, which is along y, along z."""
    placed = _in_scene(frame, turn, length)
    return Pose(placed.rotation @ TO_X_MAIN, placed.translation)


def _left(scene: Scene, name: str, reason: str, report: Report) -> None:
    name = _plain(name)
    report.dropped(f"kinematic pair {name}", "STEP_PAIRS_DROPPED", scene.source.uri, name=name, reason=reason)


def _plain(name: str) -> str:
    return shown(name) if is_encodable(name) else "?"


class _Parts:
    """The nodes that links stand for."""

    def __init__(self, scene: Scene, found: Mechanism) -> None:
        self._scene, self._found = scene, found
        self._known: dict[int, int | None] = {}

    def node(self, link: int) -> int | None:
        """The node of a link; None where the file leaves it open."""
        if link not in self._known:
            entry = self._found.links.get(link)
            self._known[link] = None if entry is None else self._search(entry)
        return self._known[link]

    def _search(self, link: Link) -> int | None:
        nodes = self._scene.nodes
        usage = self._found.usages.get(link.usage) if link.usage is not None else None
        if usage is not None:
            wanted = [
                i for i, node in enumerate(nodes)
                if node.parent is not None and node.definition == usage.child and nodes[node.parent].definition == usage.parent
            ]  # fmt: skip
            named = [i for i in wanted if nodes[i].name in usage.names]
            if len(wanted) == 1 or len(named) == 1:
                return named[0] if len(named) == 1 else wanted[0]
            alike = [
                k
                for k, other in self._found.usages.items()
                if (other.parent, other.child) == (usage.parent, usage.child)
            ]
            # The usages of one product in one assembly, in the order of the file.
            if len(alike) == len(wanted):
                return wanted[sorted(alike).index(link.usage or 0)]
            return None
        for names in (link.product, link.name):
            wanted = [i for i, node in enumerate(nodes) if names and names in (node.definition, node.name)]
            if len(wanted) == 1:
                return wanted[0]
        return None


def _joint(pair: Pair, name: str, a: int, b: int, turn: Array, length: float, where: str) -> Joint:
    """The pair in the scene's terms: of the ways to name its axes the one under which its freedoms are a joint's own."""
    if pair.kind == "SCREW_PAIR":
        order, kind = (2, 0, 1), JointKind.SCREW
    else:
        order, kind = _named(pair.free)
    axes = np.eye(3)[:, list(order)]
    sign = [1.0, 1.0, float(np.linalg.det(axes))]
    given: dict[str, Freedom] = {}
    for freedom, word in enumerate(FREEDOM_NAMES):
        source = word[0] + "xyz"[order[freedom % 3]]
        if source not in pair.free or kind is JointKind.SCREW:
            continue
        low, high = pair.ranges.get(source, (-math.inf, math.inf))
        if sign[freedom % 3] < 0.0:
            low, high = -high, -low
        if word[0] == "t":
            low, high = low * length, high * length
        motion = Motion.FREE if math.isinf(low) and math.isinf(high) else Motion.LIMITED
        given[word] = Freedom(motion, low, high)
    frames = [
        Pose(turn @ frame.rotation @ (axes * sign), turn @ frame.translation * length)
        for frame in pair.frames
    ]
    return Joint(
        name, kind, a, b, frames[0], frames[1], freedoms_of(kind, **given), name=pair.name,
        lead=pair.pitch * length, where=where,
    )  # fmt: skip


def _named(free: tuple[str, ...]) -> tuple[tuple[int, int, int], JointKind]:
    """Which axis of the placement is which of the joint's, and the kind that the freedoms are then."""
    best: tuple[tuple[int, int, int], JointKind] = (2, 0, 1), JointKind.GENERAL
    for order in ((2, 0, 1), *itertools.permutations(range(3))):
        words = [word[0] + "xyz"[order.index("xyz".index(word[1]))] for word in free]
        kind = kind_of(tuple(sorted(FREEDOM_NAMES.index(word) for word in words)))
        if kind is not JointKind.GENERAL:
            return (order[0], order[1], order[2]), kind
    return best
