"""Couplings as mimics: Newton's for joints of one freedom, PhysX's by the name of an axis."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from ....diagnostics import Report
from ....model import RX, TX, Coupling, Joint, Scene
from ....partition import Partition
from ....unity.joints.coordinates import canonical, coordinates_in
from ....unity.joints.couplings import lead_coupling, uncoupled_screws
from .freedoms import UNBOUNDED, write_drive
from .joints import WrittenJoint

BOUNDS = {"physics:lowerLimit": -UNBOUNDED, "physics:upperLimit": UNBOUNDED}
"""Degrees or metres: PhysX couples hinges and slides of finite ranges only."""

_Slot = tuple[str, int]
"""A coordinate: id of its joint, and the freedom TX..RZ of it."""


@dataclass(frozen=True, slots=True)
class _Motion:
    """What a coordinate is of the one that leads: ratio * q + offset, metres and radians."""

    ratio: float = 1.0
    offset: float = 0.0

    def followed(self, coupling: Coupling, backwards: bool) -> _Motion:
        """Of what follows this one by a coupling of one term; backwards: of what the coupling's own coordinate follows."""
        ratio = coupling.terms[0].ratio
        if backwards:
            return _Motion(self.ratio / ratio, (self.offset - coupling.offset) / ratio)
        return _Motion(ratio * self.ratio, ratio * self.offset + coupling.offset)


def write_couplings(
    scene: Scene, joints: Mapping[str, WrittenJoint], trees: Mapping[Any, int], report: Report, ending: str
) -> None:
    """A mimic on the prim of each joint that follows; the report tells what no mimic is.

    Of what is coupled together all follow one, as Newton has no mimic of a mimic.
    trees: of what is in an articulation, as ``mark_articulations`` has it.
    """
    sound = [
        coupling
        for coupling in [*scene.couplings, *_screws(scene, joints)]
        if _is_writable(coupling, joints, report, ending)
    ]
    writer = _Writer({joint.id: joint for joint in scene.joints}, joints, trees, report, ending)
    for members in _together([c for c in sound if writer.kinds(_own(c), _led(c))]):
        writer.write_star(members)
    for coupling in sound:
        if not writer.kinds(_own(coupling), _led(coupling)):
            writer.write_apart(coupling)


def _is_writable(coupling: Coupling, joints: Mapping[str, WrittenJoint], report: Report, ending: str) -> bool:
    feature = f"coupling {coupling.id}"
    if len(coupling.terms) != 1:
        told = {"coupling": coupling.id, "terms": len(coupling.terms), "target": ending}
        report.dropped(feature, "COUPLING_TERMS_DROPPED", coupling.where, **told)
        return False
    for name, freedom in (_own(coupling), _led(coupling)):
        if name not in joints or freedom not in joints[name].instance_of:
            told = {"coupling": coupling.id, "joint": name}
            report.dropped(feature, "COUPLING_WITHOUT_JOINT", coupling.where, **told)
            return False
    return True


def _own(coupling: Coupling) -> _Slot:
    return coupling.joint, coupling.freedom


def _led(coupling: Coupling) -> _Slot:
    return coupling.terms[0].joint, coupling.terms[0].freedom


def _together(couplings: Sequence[Coupling]) -> list[list[Coupling]]:
    """The couplings by what they tie together, in their order."""
    slots = {
        slot: i for i, slot in enumerate(dict.fromkeys(s for c in couplings for s in (_own(c), _led(c))))
    }
    sets = Partition(len(slots))
    for coupling in couplings:
        sets.join(slots[_own(coupling)], slots[_led(coupling)])
    found: dict[int, list[Coupling]] = {}
    for coupling in couplings:
        found.setdefault(sets.find(slots[_own(coupling)]), []).append(coupling)
    return list(found.values())


@dataclass(frozen=True, slots=True, eq=False)
class _Writer:
    stated: Mapping[str, Joint]
    joints: Mapping[str, WrittenJoint]
    trees: Mapping[Any, int]
    report: Report
    ending: str
    apart: set[_Slot] = field(default_factory=set[_Slot])

    def kinds(self, own: _Slot, led: _Slot) -> tuple[str, ...]:
        """Whose mimic one coordinate can be of another: Newton's of hinges and slides, PhysX's of turns, both within one
        articulation."""
        joint, leader = self.joints[own[0]], self.joints[led[0]]
        tree = self.trees.get(joint.prim.path)
        if tree is None or tree != self.trees.get(leader.prim.path) or joint is leader:
            return ()
        return tuple(word for word in self._words(own) if word in self._words(led))

    def _words(self, slot: _Slot) -> tuple[str, ...]:
        """Whose mimics know a coordinate."""
        newton = ("newton",) if self.joints[slot[0]].typed else ()
        return (*newton, "physx") if slot[1] >= RX else newton

    def _root(self, slots: Sequence[_Slot], follows: Collection[_Slot]) -> _Slot:
        """Of coordinates of one articulation that which most others can follow; of several one that follows nothing by itself."""
        words = Counter(map(self._words, slots))
        beside = Counter((slot[0], self._words(slot)) for slot in slots)

        def able(slot: _Slot) -> int:
            own = set(self._words(slot))
            return sum(n - beside[slot[0], w] for w, n in words.items() if own.intersection(w))

        return min(slots, key=lambda slot: (-able(slot), slot in follows))

    def write_star(self, couplings: Sequence[Coupling]) -> None:
        """All that the couplings tie together as followers of one coordinate."""
        slots = list(dict.fromkeys(slot for c in couplings for slot in (_led(c), _own(c))))
        root = self._root(slots, {_own(c) for c in couplings})
        followers = {slot: self.kinds(slot, root) for slot in slots if slot != root}
        star = {root, *(slot for slot, kinds in followers.items() if kinds)}
        # What closes a circle is implied: the analysis holds what contradicts others.
        for coupling in couplings:
            if {_own(coupling), _led(coupling)} <= star:
                self.report.kept(f"coupling {coupling.id}", coupling.where)
            else:
                self.write_apart(coupling)
        motions = _motions(root, couplings)
        for slot, kinds in followers.items():
            if kinds:
                self._write_mimic(slot, root, kinds, motions[slot])
                if "physx" not in kinds:
                    self._write_drive(slot, root, motions[slot])

    def write_apart(self, coupling: Coupling) -> None:
        """In words of our own, as no engine's fit; turned round where its coordinate follows another so already."""
        own, led, motion = _own(coupling), _led(coupling), _Motion(coupling.terms[0].ratio, coupling.offset)
        if own in self.apart:
            own, led, motion = led, own, _Motion().followed(coupling, True)
        if own in self.apart:
            told = {"coupling": coupling.id, "target": self.ending}
            self.report.dropped(f"coupling {coupling.id}", "COUPLING_FOLLOWS_TWO", coupling.where, **told)
            return
        self.apart.add(own)
        prim, prefix = self.joints[own[0]].prim, f"kinefab:mimic:{self._instance(own)}"
        ratio, offset = _in_units(own, led, motion)
        prim.relation(f"{prefix}:joint", self.joints[led[0]].prim.path)
        prim.attribute(f"{prefix}:freedom", "Token", self._instance(led), uniform=True, custom=True)
        prim.attribute(f"{prefix}:ratio", "Double", ratio, custom=True)
        prim.attribute(f"{prefix}:offset", "Double", offset, custom=True)
        what = f"a mimic of {self._instance(own)} by {self._instance(led)}"
        self.report.approximated(
            f"coupling {coupling.id}", "TARGET_FEATURE_APPROXIMATED", coupling.where, target=self.ending,
            detail=f"{what} stands there that Kinefab alone reads; engines have mimics of hinges and slides, within one articulation",
        )  # fmt: skip

    def _write_mimic(self, own: _Slot, led: _Slot, kinds: Collection[str], motion: _Motion) -> None:
        joint, leader = self.joints[own[0]], self.joints[led[0]]
        prim = joint.prim
        ratio, offset = _in_units(own, led, motion)
        if "newton" in kinds:
            prim.apply("NewtonMimicAPI")
            prim.relation("newton:mimicJoint", leader.prim.path)
            prim.numbers({"newton:mimicCoef0": offset, "newton:mimicCoef1": ratio})
            for typed in (joint, leader):
                typed.prim.missing_numbers(BOUNDS)
        if "physx" in kinds:
            prefix = f"physxMimicJoint:{self._instance(own)}:"
            prim.apply(f"PhysxMimicJointAPI:{self._instance(own)}")
            prim.relation(f"{prefix}referenceJoint", leader.prim.path)
            prim.attribute(f"{prefix}referenceJointAxis", "Token", self._instance(led), uniform=True)
            prim.numbers({f"{prefix}gearing": -ratio, f"{prefix}offset": -offset})

    def _write_drive(self, own: _Slot, led: _Slot, motion: _Motion) -> None:
        """The leader's drive as the follower has it: PhysX's mimics are between turns alone, and where one slides nothing follows there."""
        (joint, freedom), prim, turns = own, self.joints[own[0]].prim, own[1] >= RX
        drive = self.stated[led[0]].freedoms[led[1]].drive
        detail = "PhysX has mimics between turns alone, and there the joint is loose: its leader has no drive that could be its own too"
        if self.stated[joint].freedoms[freedom].drive is not None:
            detail = "PhysX has mimics between turns alone; there the joint's own drive alone moves it"
        elif drive is not None and motion.ratio:
            gain = 1.0 if drive.acceleration else 1.0 / motion.ratio**2
            made = replace(
                drive,
                target=motion.ratio * drive.target + motion.offset,
                target_velocity=motion.ratio * drive.target_velocity,
                stiffness=gain * drive.stiffness,
                damping=gain * drive.damping,
                max_force=drive.max_force / abs(motion.ratio),
            )
            write_drive(prim, "angular" if turns else "linear", made, turns)
            prim.attribute("kinefab:mimic:drive", "Bool", True, custom=True)
            detail = "PhysX has mimics between turns alone; a drive stands beside it, whose target is to be set with its leader's"
        self.report.approximated(
            f"mimic of joint {joint}", "TARGET_FEATURE_APPROXIMATED", self.stated[joint].where, target=self.ending, detail=detail
        )

    def _instance(self, slot: _Slot) -> str:
        """What USD calls a coordinate's freedom."""
        return self.joints[slot[0]].instance_of[slot[1]]


def _motions(root: _Slot, couplings: Sequence[Coupling]) -> dict[_Slot, _Motion]:
    """How each coordinate follows the root."""
    ties: dict[_Slot, list[tuple[_Slot, Coupling, bool]]] = {}
    for coupling in couplings:
        ties.setdefault(_led(coupling), []).append((_own(coupling), coupling, False))
        ties.setdefault(_own(coupling), []).append((_led(coupling), coupling, True))
    motions, waiting = {root: _Motion()}, [root]
    for here in waiting:
        for there, coupling, backwards in ties[here]:
            if there not in motions:
                motions[there] = motions[here].followed(coupling, backwards)
                waiting.append(there)
    return motions


def _in_units(own: _Slot, led: _Slot, motion: _Motion) -> tuple[float, float]:
    """Ratio and offset in degrees and metres."""
    unit, led_unit = (math.degrees(1.0) if freedom >= RX else 1.0 for _, freedom in (own, led))
    return motion.ratio * unit / led_unit, motion.offset * unit


def _screws(scene: Scene, joints: Mapping[str, WrittenJoint]) -> list[Coupling]:
    """Couplings for screws that nothing couples yet: a generic joint leaves the slide free of the turn."""
    return [
        lead_coupling(joint, *(standing(scene, joint, freedom) for freedom in (TX, RX)))
        for joint in uncoupled_screws(scene.joints, scene.couplings)
        if joint.id in joints
    ]


def standing(scene: Scene, joint: Joint, freedom: int) -> float:
    """A joint's coordinate TX..RZ at the exported pose, metres or radians."""
    shape = canonical(joint)
    at = shape.name_of.index(freedom)
    value = float(coordinates_in(scene, joint, shape).values[at])
    return value if freedom < RX else float(shape.freedoms[at].nearest_turn(value))
