"""What a capture gathers: the records of a bundle, meshes beside them, and what it found.

Standard library only: it also runs in a CAD program's own Python.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, cast

from ..diagnostics import Report
from .channel import MemberFailed, NotHeld, NotSaved

Record = dict[str, Any]
"""A record of ``schemas/bundle.schema.json``."""
Numbers = Sequence[float]

FLAT = 1e-6
"""Volume that three unit axes span at least."""
WRONG_ANSWER = (
    MemberFailed, AttributeError, TypeError, ValueError, KeyError, IndexError, ArithmeticError, struct.error,
)  # fmt: skip
"""What is raised where a program answers something else than its documentation says."""


@dataclass(slots=True)
class BodyMesh:
    """name: of the body.  points: x y z of each corner, in the part's frame, ``length`` of the draft.
    triangles: corners, from 0.  normals: x y z of each corner, where the program states them.
    runs: of faces with looks of their own how many have which material, in order.
    Raises TypeError or ValueError for what is no mesh."""

    name: str
    points: list[float]
    triangles: list[int]
    normals: list[float] | None = None
    runs: list[tuple[int, str]] = field(default_factory=list[tuple[int, str]])

    def __post_init__(self) -> None:
        if not isinstance(self.name, str):  # pyright: ignore[reportUnnecessaryIsInstance] (a program may answer anything)
            raise TypeError("a body's name is no text")
        whole = len(self.points) % 3 == 0 and len(self.triangles) % 3 == 0
        if not whole or not all(map(math.isfinite, self.points)):
            raise ValueError("a mesh whose numbers are no points")
        if self.triangles and not 0 <= min(self.triangles) <= max(self.triangles) < len(self.points) // 3:
            raise ValueError("a triangle of a mesh names a corner that is not there")
        if self.normals is not None and (
            len(self.normals) != len(self.points) or not all(map(math.isfinite, self.normals))
        ):
            self.normals = None
        if self.runs and 3 * sum(count for count, _ in self.runs) != len(self.triangles):
            raise ValueError("a mesh whose looks are not of its triangles")


@dataclass(frozen=True, slots=True)
class Pattern:
    """Copies that are fixed to their seed.  name: the program's.  seed, copies: components."""

    name: str
    seed: str
    copies: tuple[str, ...]


@dataclass(slots=True)
class Draft:
    """A bundle that is being captured; lengths in ``length``, angles in radians, masses in kilograms.

    definitions: of each name and identity that the program has for a part, what the bundle calls it.
    configuration: which of several of the assembly it is, "" for the only one.
    owners: of a joint or constraint, by its id, the assembly in whose frame the program states it: what the self check
    may try.  turned: the coordinates, by joint and name, that count the other way than the program shows them; ratios of
    couplings are the program's.  meshes: of a definition, by its name.  ids: of joints and constraints, called: what
    definitions are, each with the number that its next namesake may have.
    """

    program: str
    length: str
    up: str
    report: Report = field(default_factory=Report)
    version: str = ""
    source: str = ""
    configuration: str = ""
    dirty: bool = False
    materials: dict[str, Record] = field(default_factory=dict[str, Record])
    components: list[Record] = field(default_factory=list[Record])
    joints: list[Record] = field(default_factory=list[Record])
    couplings: list[Record] = field(default_factory=list[Record])
    constraints: list[Record] = field(default_factory=list[Record])
    dof: list[Record] = field(default_factory=list[Record])
    definitions: dict[tuple[str, str], str] = field(default_factory=dict[tuple[str, str], str])
    owners: dict[str, str] = field(default_factory=dict[str, str])
    turned: set[tuple[str, str]] = field(default_factory=set[tuple[str, str]])
    meshes: dict[str, list[BodyMesh]] = field(default_factory=dict[str, list[BodyMesh]])
    patterns: list[Pattern] = field(default_factory=list[Pattern])
    ids: dict[str, int] = field(default_factory=dict[str, int])
    called: dict[str, int] = field(default_factory=dict[str, int])
    parts: set[str] = field(default_factory=set[str])
    notes: Record = field(default_factory=dict[str, Any])

    @contextmanager
    def safely(self, feature: str) -> Generator[None, None, None]:
        """What fails inside is told, and only this feature is lost."""
        try:
            yield
        except WRONG_ANSWER as error:
            self.failed(feature, error)

    def each(
        self, count: int, item: Callable[[int], Any], word: str, owner: str, first: int = 1
    ) -> Iterator[tuple[str, Any]]:
        """The entries of a program's collection, each with what it is called in a report.

        item: of an index, from ``first``.  One that fails is told.  So is, once, where a record ends before the count that it
        states: whatever it says, nobody asked for more.
        """
        for index in range(count):
            feature = f"{word} {index + 1} of {owner}"
            try:
                found = item(index + first)
            except NotHeld as error:
                self.failed(f"{feature} and all after it", error)
                return
            except WRONG_ANSWER as error:
                self.failed(feature, error)
                continue
            yield feature, found

    def failed(self, feature: str, error: Exception) -> None:
        if isinstance(error, NotSaved):
            told = {"program": self.program, "member": error.member, "file": error.file}
            self.report.dropped(feature, "CAPTURE_NOT_SAVED", **told)
            return
        member = error.member if isinstance(error, MemberFailed) else "an answer"
        detail = error.detail if isinstance(error, MemberFailed) else f"{type(error).__name__}: {error}"
        self.report.dropped(
            feature, "CAPTURE_MEMBER_FAILED", program=self.program, member=member, detail=detail
        )

    def component(self, record: Record) -> None:
        """Add a component.  Raises TypeError or ValueError for one that no other record could name."""
        for key in ("id", "name", "definition"):
            if not isinstance(record.get(key, ""), str):
                raise TypeError(f"its {key} is no text")
        if not record["id"] or record["id"] in self.parts:
            raise ValueError(f"there are two components {record['id']!r:.60}")
        self.parts.add(record["id"])
        self.components.append(record)

    def definition(self, name: str, identity: str) -> str:
        """What a part is called by: its name; of several that the program calls alike, each has a number.  Raises TypeError."""
        if not isinstance(name, str):  # pyright: ignore[reportUnnecessaryIsInstance] (a program may answer anything)
            raise TypeError("the name of its definition is no text")
        if (name, identity) not in self.definitions:
            self.definitions[name, identity] = _numbered(name, self.called)
        return self.definitions[name, identity]

    def settle(self) -> None:
        """Leave out, and tell, what holds no finite numbers, stands on a component or joint that was lost, or ties one to itself."""
        self.version, self.source = _text(self.version), _text(self.source)
        self.configuration = _text(self.configuration)
        self.materials = {name: found for name, found in self.materials.items() if _finite(found)}
        self.notes = {key: found for key, found in self.notes.items() if _finite(found)}
        lists = (self.components, self.joints, self.couplings, self.constraints, self.dof)
        for records in lists:
            for record in [record for record in records if not _finite(record)]:
                records.remove(record)
                self.failed(
                    str(record.get("id", record.get("component"))), ValueError("a number is infinite")
                )
        there = {"ground", *(component["id"] for component in self.components)}
        for records, word in ((self.joints, "joint"), (self.constraints, "constraint")):
            for record in list(records):
                named = [record[key] for key in "abc" if key in record]
                ends = [end if isinstance(end, str) else end["component"] for end in named]
                if lost := [end for end in ends if end not in there]:
                    self._lost(records, record, word, lost[0])
        for record in [record for record in self.joints if record["a"] == record["b"]]:
            self.joints.remove(record)
            self.failed(f"joint {record['id']}", ValueError(f"both its sides are '{record['a']}'"))
        joints = {joint["id"] for joint in self.joints}
        for record in list(self.couplings):
            named = [str(record[key]["joint"]) for key in "ab"]
            if lost := [name for name in named if name not in joints]:
                self._lost(self.couplings, record, "coupling", lost[0])
        self.dof = [record for record in self.dof if record["component"] in there]

    def _lost(self, records: list[Record], record: Record, word: str, lost: str) -> None:
        records.remove(record)
        feature = f"{word} {record['id']}"
        self.report.dropped(feature, "CAPTURE_SIDE_LOST", lost=lost, program=self.program)

    def unique(self, name: str) -> str:
        """An id that no joint or constraint has yet."""
        if not isinstance(name, str):  # pyright: ignore[reportUnnecessaryIsInstance] (a program may answer anything)
            raise TypeError("its name is no text")
        return _numbered(name, self.ids)

    def _turned(self, coupling: Record) -> Record:
        """The coupling between the bundle's coordinates."""
        a, b = ((coupling[key]["joint"], coupling[key]["dof"]) in self.turned for key in "ab")
        return {**coupling, "ratio": -coupling["ratio"]} if a != b else coupling

    def values(self) -> Record:
        """The bundle as ``schemas/bundle.schema.json`` has it, without its mesh files."""
        lists: list[tuple[str, Iterable[Record]]] = [
            ("materials", self.materials.values()),
            ("components", self.components),
            ("joints", self.joints),
            ("couplings", map(self._turned, self.couplings)),
            ("constraints", self.constraints),
            ("dof", self.dof),
        ]
        meta: Record = {
            "format": "kinefab.bundle",
            "version": "1.0",
            "generator": {"name": self.program, "version": self.version, "macro": "kinefab capture"},
            "units": {"length": self.length, "angle": "rad", "mass": "kg"},
            "up": self.up,
            "poseState": "dirty" if self.dirty else "solved",
        }
        if self.source:
            meta["sourceFile"] = self.source
        if self.configuration:
            meta["configuration"] = self.configuration
        if self.notes:
            meta["extras"] = self.notes
        return {"meta": meta, **{key: list(records) for key, records in lists if records}}


def _text(value: Any) -> str:
    return value if isinstance(value, str) else ""


NUMBERS = frozenset({"value", "min", "max", "r", "ratio", "mass"})
"""Fields that hold a number wherever they hold no record."""


MOST = 1e15
"""Beyond, a bundle's reader takes a number for none."""


def _finite(value: Any) -> bool:
    """Whether a record can be written: all its numbers finite, and what has to be a number one."""
    if isinstance(value, dict):
        held = cast("dict[str, Any]", value)
        plain = [held[key] for key in NUMBERS & held.keys() if not isinstance(held[key], dict)]
        if any(isinstance(entry, bool) or not isinstance(entry, (int, float)) for entry in plain):
            return False
        return all(_finite(entry) for entry in held.values())
    if isinstance(value, list):
        return all(_finite(entry) for entry in cast("list[Any]", value))
    return value is None or isinstance(value, str) or (isinstance(value, (int, float)) and abs(value) <= MOST)


def reach(enabled: bool, value: float | None) -> float | None:
    """An end of a range: it counts only with its flag."""
    return float(value) if enabled and value is not None else None


def freedom(
    name: str, value: float | None = None, low: float | None = None, high: float | None = None
) -> Record:
    """A coordinate of a joint; ends that are None are no limits."""
    ends = (("min", low), ("max", high))
    return {
        "name": name,
        **({} if value is None else {"value": float(value)}),
        **{key: end for key, end in ends if end is not None},
        **{f"{key}Enabled": True for key, end in ends if end is not None},
    }


def exchanged(joint: Record) -> Record:
    """The joint seen from its other side: its coordinates change their signs, their ends their places.  A single frame is
    both sides'."""
    found = {**joint, "a": joint["b"], "b": joint["a"]}
    if "frameB" in joint:
        found |= {"frameA": joint["frameB"], "frameB": joint["frameA"]}
    if "dof" in joint:
        found["dof"] = [
            freedom(d["name"], *(None if key not in d else -d[key] for key in ("value", "max", "min")))
            for d in joint["dof"]
        ]
    return found


def frame(inside: str, o: Numbers, z: Numbers, x: Numbers | None = None) -> Record:
    """A joint frame.  Raises ValueError or TypeError for what is no vector."""
    return {"in": inside, "o": three(o), "z": three(z), **({} if x is None else {"x": three(x)})}


def pose(o: Numbers, x: Numbers, y: Numbers, z: Numbers) -> Record:
    """A component's pose.  Raises ValueError or TypeError for what is no vector, and for axes in one plane."""
    (a, b, c), (d, e, f), (g, h, i) = axes = three(x), three(y), three(z)
    if abs(a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)) < FLAT:
        raise ValueError("the axes of its pose lie in one plane")
    return {"o": three(o), **dict(zip("xyz", axes))}


def at_origin() -> Record:
    """The pose of what stands where its assembly does."""
    return pose([0.0] * 3, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0])


def three(values: Numbers) -> list[float]:
    """A vector as it is answered.  Raises ValueError or TypeError for what is none."""
    found = [float(value) for value in values]
    if len(found) != 3 or not all(abs(value) < math.inf for value in found):
        raise ValueError(f"{values!r:.60} is no vector")
    return found


def pose_of_rows(m: Numbers) -> Record:
    """Pose of a row-major 4 x 4 matrix, translation in its last column."""
    return pose(*([m[i], m[i + 4], m[i + 8]] for i in (3, 0, 1, 2)))


def _numbered(name: str, taken: dict[str, int]) -> str:
    """The name, or it with the first number from 2 on that makes it one of its own; taken from then on.

    taken: each name with the number that its next namesake may have.
    """
    found = name
    while found in taken:
        found, taken[name] = f"{name} ({taken[name]})", taken[name] + 1
    taken[found] = 2
    return found
