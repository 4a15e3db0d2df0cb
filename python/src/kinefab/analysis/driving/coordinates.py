"""The coordinates of a mechanism's joints, block by block, and which of them stand for all its freedoms."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...findings import JointFinding
from ...model import FREEDOM_NAMES, RX, RY, RZ, Joint, Scene
from ...spatial import Array
from ..assembly.assemble import Assembly
from ..joints.links import Link
from ..ranges.measured import Measured

INDEPENDENT = (1e-3, 1e-8)
"""Share of a coordinate's rate that earlier ones must leave it to count as one more; the second where the first leaves
freedoms without any."""


def block_of(assembly: Assembly, joint: Joint) -> int | None:
    """Number among ``Assembly.freedoms`` of the block that a joint is in; None where it joins one body to itself."""
    a, b = (assembly.body_of(node) for node in (joint.a, joint.b))
    return None if a == b else assembly.part_of_block.get(assembly.blocks.of_pair(a, b))


def links_to(assembly: Assembly, coordinates: Sequence[tuple[Joint, int]]) -> list[tuple[Link, int]]:
    """The same coordinates (a joint and its freedom TX..RZ each), with the bodies of the assembly."""
    return [
        (Link(assembly.body_of(joint.a), assembly.body_of(joint.b), joint, JointFinding(joint.id)), freedom)
        for joint, freedom in coordinates
    ]


@dataclass(frozen=True, slots=True, eq=False)
class Driven:
    """A joint, which of its freedoms TX..RZ move, and whether it closes a loop."""

    joint: Joint
    moving: tuple[int, ...]
    closure: bool

    @staticmethod
    def of(joints: Sequence[Joint], findings: Mapping[str, JointFinding]) -> list[Driven]:
        """The joints with what they leave themselves, not what the rest of a loop holds instead of them."""
        found: list[Driven] = []
        for joint in joints:
            finding = findings.get(joint.id, JointFinding(joint.id))
            moving = tuple(i for i in joint.unlocked if i not in finding.freed)
            found.append(Driven(joint, moving, finding.closure))
        return found


@dataclass(slots=True, eq=False)
class DrivenBlock:
    """A block and the coordinates of all its joints.

    part: its number among ``Assembly.freedoms``.  joints: joint and TX..RZ of each coordinate of ``measured``.
    mobility: its finite freedoms.  rates: of the coordinates, radians or fractions of the length, for each of them,
    shape (k, mobility).
    """

    part: int
    joints: list[tuple[Driven, int]]
    measured: Measured
    mobility: int
    rates: Array

    def joint(self, i: int) -> tuple[Joint, int]:
        """The joint and freedom of a coordinate."""
        driven, freedom = self.joints[i]
        return driven.joint, freedom

    def independent(self, first: Sequence[int] = ()) -> list[int]:
        """Places of coordinates that can be held together, the ones given before all others, at most ``mobility``.

        The angles of a ball in a loop are none of them: they are what is left to a rod that spins idly.
        """
        chosen: list[int] = list(first)
        order = [i for i in self.order() if i not in chosen and not self._in_a_ball(i)]
        base = np.linalg.qr(self.rates[chosen].T)[0] if chosen else np.zeros((self.rates.shape[1], 0))
        for least in INDEPENDENT:
            for i in order:
                left = self.rates[i] - base @ (base.T @ self.rates[i])
                size = float(np.linalg.norm(left))
                if len(chosen) < self.mobility and i not in chosen and size > least:
                    chosen.append(i)
                    base = np.column_stack([base, left / size])
        return chosen

    def order(self) -> list[int]:
        """Driven coordinates first, then hinges and slides on the block's root, then the source's order."""

        def key(i: int) -> tuple[bool, bool, bool, bool, int]:
            driven, freedom = self.joints[i]
            passive = driven.joint.freedoms[freedom].drive is None
            return (passive, driven.closure, len(driven.moving) > 1, not self._on_root(i), i)

        return sorted(range(len(self.joints)), key=key)

    def _in_a_ball(self, i: int) -> bool:
        driven, freedom = self.joints[i]
        return len(self.measured.bodies) > 1 and freedom >= RX and {RX, RY, RZ} <= set(driven.moving)

    def _on_root(self, i: int) -> bool:
        atoms = self.measured.probe.row == i
        ends = (self.measured.probe.body_a[atoms], self.measured.probe.body_b[atoms])
        return any(bool((end == 0).all()) for end in ends)


def driven_blocks(assembly: Assembly, joints: Sequence[Driven], scene: Scene) -> list[DrivenBlock]:
    """All blocks that move.  scene: at the closed pose."""
    by_part: dict[int, list[tuple[Driven, int]]] = {}
    for driven in joints:
        part = block_of(assembly, driven.joint)
        if part is not None:
            by_part.setdefault(part, []).extend((driven, i) for i in driven.moving)
    found: list[DrivenBlock] = []
    for part, coordinates in sorted(by_part.items()):
        finite = assembly.finite[part]
        if finite.mobility:
            links = links_to(assembly, [(driven.joint, freedom) for driven, freedom in coordinates])
            measured = Measured(assembly, part, links, scene)
            unit = np.where(measured.rotary, 1.0, measured.length)
            rates = measured.read(measured.start, measured.turns)[1] @ finite.tangent / unit[:, None]
            found.append(DrivenBlock(part, coordinates, measured, finite.mobility, rates))
    return found


def coordinate_names(joints: Sequence[Driven]) -> dict[tuple[str, int], str]:
    """A name for each coordinate, by joint id and TX..RZ: the joint's own name, or its id where another has that too.

    Where the joint has several, the source's name of the freedom, or its id with ``.tx`` to ``.rz`` behind it, as the source
    has them, in the joint's own frame where the source has no words of its own.
    """
    names = [driven.joint.name for driven in joints]
    ids = {driven.joint.id for driven in joints}
    words = {id(driven): _words(driven) for driven in joints}
    everywhere = [word for own in words.values() for word in own.values()]
    found: dict[tuple[str, int], str] = {}
    for driven in joints:
        joint = driven.joint
        own = (
            joint.name and names.count(joint.name) == 1 and (joint.name not in ids or joint.name == joint.id)
        )
        name = joint.name if own else joint.id
        for i, word in words[id(driven)].items():
            alone = word and word not in FREEDOM_NAMES and word not in ids and word not in names
            known = alone and everywhere.count(word) == 1
            found[joint.id, i] = word if known else f"{name}.{word}" if word else name
    return found


def _words(driven: Driven) -> dict[int, str]:
    """What each of a joint's moving freedoms is called; nothing where there is one only."""
    if len(driven.moving) == 1:
        return {driven.moving[0]: ""}
    words = {i: driven.joint.freedom_name(i) for i in driven.moving}
    return words if len(set(words.values())) == len(words) else {i: FREEDOM_NAMES[i] for i in driven.moving}
