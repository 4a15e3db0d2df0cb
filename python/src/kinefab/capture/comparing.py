"""What a program says of the whole mechanism, against what the analysis finds in the captured records: the freedoms of each
part, the rigid groups and the joints between them; and how far copies of a pattern move as the program moves them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..analysis import Analysis, NodeFreedom, analyse
from ..diagnostics import KinefabError, Report, named
from ..model import JointKind
from ..sources.bundle.reader import scene_from_values
from ..sources.reading.source_frame import DIRECTIONS, FORWARD, METRES, turn_to_scene
from ..spatial import Array
from .checking import plain
from .draft import Draft, Pattern, Record
from .readings import poses_of

PAIRS = {
    68136: JointKind.REVOLUTE, 68109: JointKind.REVOLUTE, 68104: JointKind.REVOLUTE, 68135: JointKind.PRISMATIC,
    68140: JointKind.FIXED, 68141: JointKind.UNIVERSAL, 68098: JointKind.SPHERICAL, 68102: JointKind.SPHERICAL,
    68100: JointKind.CYLINDRICAL, 68101: JointKind.CYLINDRICAL, 68115: JointKind.PLANAR,
}  # fmt: skip
"""RigidBodyJointTypeEnum of Inventor: the lower pair that one alone makes.  Others (angles, tangencies, gears) make none."""
FREEDOMS = {
    JointKind.FIXED: 0, JointKind.REVOLUTE: 1, JointKind.PRISMATIC: 1, JointKind.CYLINDRICAL: 2, JointKind.UNIVERSAL: 2,
    JointKind.SPHERICAL: 3, JointKind.PLANAR: 3,
}  # fmt: skip
GROUND = "ground"
ALONG = 1e-6
"""Difference of unit vectors, or of places by the size of the assembly, up to which a motion is its own image."""


def compare(draft: Draft) -> None:
    """Tell every difference."""
    if not draft.dof and "rigidBodies" not in draft.notes and not draft.patterns:
        return
    try:
        scene = scene_from_values(plain(draft), Path("capture.bundle.json"), b"", Report())
        found = analyse(scene)
    except KinefabError:
        return  # whoever exports the bundle is told why
    told = ("DOF_RECORD_DIFFERS", "DOF_DIRECTION_DIFFERS")
    draft.report.diagnostics += [d for d in found.report.diagnostics if d.code in told]
    numbers = {node.id: i for i, node in enumerate(scene.nodes)}
    if "rigidBodies" in draft.notes:
        _Bodies(draft, found, numbers, draft.notes["rigidBodies"]).compare()
    for pattern in draft.patterns:
        _copies(draft, found, numbers, pattern)


@dataclass(slots=True)
class _Bodies:
    """said: ``groups`` (id, grounded, components) and ``joints`` (type, one, two: ids of groups) of the program."""

    draft: Draft
    found: Analysis
    numbers: dict[str, int]
    said: Record

    def compare(self) -> None:
        groups = {group["id"]: list(self._members(group)) for group in self.said["groups"]}
        bodies = {key: [body for _, body in members] for key, members in groups.items()}
        self._split(groups)
        self._joined(groups)
        single = {key: own[0] for key, own in bodies.items() if len(set(own)) == 1}
        self._pairs(single, {key: members[0][0] for key, members in groups.items() if members})

    def _members(self, group: Record) -> Iterator[tuple[str, int]]:
        """The parts of a group with their bodies; the ground first, of a grounded one."""
        if group["grounded"]:
            yield GROUND, 0
        nodes, assembly = self.found.source.nodes, self.found.assembly
        for component in group["components"]:
            number = self.numbers.get(component)
            if number is None or nodes[number].suppressed:
                continue
            if self.found.groups.group_of[number] is not None:  # a flexible assembly is no body
                yield nodes[number].id, assembly.body_of(number)

    def _split(self, groups: dict[int, list[tuple[str, int]]]) -> None:
        for members in groups.values():
            first: dict[int, str] = {}
            for name, body in members:
                first.setdefault(body, name)
            if len(first) > 1:
                self.draft.report.add(
                    "CAPTURE_GROUP_SPLIT", program=self.draft.program, count=len(first), names=named(first.values())
                )  # fmt: skip

    def _joined(self, groups: dict[int, list[tuple[str, int]]]) -> None:
        by_body: dict[int, dict[int, str]] = {}
        for key, members in groups.items():
            for name, body in members:
                by_body.setdefault(body, {}).setdefault(key, name)
        for body in sorted(by_body):
            if len(by_body[body]) > 1:
                names = named(by_body[body].values())
                self.draft.report.add(
                    "CAPTURE_GROUP_JOINED", program=self.draft.program, count=len(by_body[body]), names=names
                )

    def _pairs(self, body_of: dict[int, int], names: dict[int, str]) -> None:
        """Between groups that are one body each: what the program lists, against the joints that were found."""
        theirs: dict[tuple[int, int], list[int]] = {}
        for joint in self.said["joints"]:
            one, two = (body_of.get(joint[key]) for key in ("one", "two"))
            if one is not None and two is not None and one != two:
                theirs.setdefault((min(one, two), max(one, two)), []).append(joint["type"])
        mine: dict[tuple[int, int], list[JointKind]] = {}
        count = len(self.found.source.nodes)
        for joint in self.found.joints:
            ends = [joint.a, joint.b]
            if all(end is None or end < count for end in ends):
                one, two = (self.found.assembly.body_of(end) for end in ends)
                kind = self.found.findings[joint.id].whole_kind(joint)
                mine.setdefault((min(one, two), max(one, two)), []).append(
                    joint.kind if kind is JointKind.GENERAL else kind
                )
        known = {body: names[key] for key, body in body_of.items()}
        for pair in sorted(theirs.keys() | mine.keys()):
            if pair[0] in known and pair[1] in known:
                self._pair(known[pair[0]], known[pair[1]], theirs.get(pair, []), mine.get(pair, []))

    def _pair(self, a: str, b: str, theirs: list[int], mine: list[JointKind]) -> None:
        stated = [PAIRS[kind] for kind in theirs if kind in PAIRS]
        differs = bool(mine) != bool(stated) if len(stated) == len(theirs) else bool(stated and not mine)
        if stated and len(mine) == 1:
            own = mine[0]
            alone = len(theirs) == 1
            differs = own is not stated[0] if alone else _more(own, stated)
        if differs:
            words = ", ".join(kind.value for kind in stated) or "nothing"
            self.draft.report.add(
                "CAPTURE_PAIR_DIFFERS", program=self.draft.program, a=a, b=b, stated=words,
                found=", ".join(kind.value for kind in mine) or "nothing",
            )  # fmt: skip


def _more(own: JointKind, stated: list[JointKind]) -> bool:
    """Whether a joint leaves more than one of those that hold the same two groups together would."""
    return own in FREEDOMS and FREEDOMS[own] > min(FREEDOMS[kind] for kind in stated)


def _copies(draft: Draft, found: Analysis, numbers: dict[str, int], pattern: Pattern) -> None:
    """Say of a pattern's copies that they are fixed to their seed, and whether that is how the program moves them."""
    poses = poses_of(draft.components)
    there = [copy for copy in pattern.copies if copy in numbers and pattern.seed in numbers]
    if not there:
        return
    free = next((f for f in found.freedoms if f.node == numbers[pattern.seed]), None)
    seed = poses[pattern.seed]
    motions = None if free is None else _in_source(free, draft)
    moved = [copy for copy in there if motions is not None and not _same(motions, seed, poses[copy])]
    feature = f"pattern {pattern.name}"
    listed = moved or there
    told: dict[str, Any] = {"count": len(listed), "first": listed[0], "seed": pattern.seed}
    if moved:
        draft.report.approximated(feature, "CAPTURE_PATTERN_MOVES", program=draft.program, **told)
    else:
        draft.report.kept(feature, code="CAPTURE_PATTERN", program=draft.program, **told)


Motions = tuple[Array, Array, Array | None]
"""Translations (t, 3), rotations (r, 3) and a point of their axes, in the axes and the unit of the draft."""


def _in_source(free: NodeFreedom, draft: Draft) -> Motions:
    turn = turn_to_scene(DIRECTIONS[draft.up], DIRECTIONS[FORWARD[draft.up]])
    center = None if free.center is None else free.center @ turn / METRES[draft.length]
    return free.translations @ turn, free.rotations @ turn, center


def _same(motions: Motions, seed: tuple[Array, Array], copy: tuple[Array, Array]) -> bool:
    """Whether the seed's motions are their own images under the transform that makes the copy of it."""
    translations, rotations, center = motions
    turn = copy[0] @ np.linalg.inv(seed[0])
    mirror = float(np.sign(np.linalg.det(turn)))
    if not np.allclose(translations @ turn.T, translations, atol=ALONG):
        return False
    if not len(rotations):
        return True
    if center is None or not np.allclose(mirror * rotations @ turn.T, rotations, atol=ALONG):
        return False
    shift = turn @ (center - seed[1]) + copy[1] - center
    across = np.linalg.norm(np.cross(rotations, shift), axis=1)
    return bool(np.all(across <= ALONG * (1.0 + np.linalg.norm(shift))))
