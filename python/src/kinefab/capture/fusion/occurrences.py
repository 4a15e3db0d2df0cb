"""Fusion's occurrences as components of a bundle, and what stands for each as a body.

A component of Fusion may have bodies and children at once, the root too.  A bundle's flexible assembly is no body: such bodies are
a part of their own below it, and that part is what joints of the occurrence act on.  Standard library only: it runs in
Fusion's own Python.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field
from typing import cast

from ..channel import MemberFailed
from ..draft import Draft, Record, pose_of_rows
from .api import Collection, Component, Occurrence, RootComponent
from .parts import Parts

OWN = "own bodies"
"""Last word of the part's id; Fusion's own names end with the number of the copy, after a colon."""
IDENTITY = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0)


@dataclass(slots=True)
class Occurrences:
    """root: id of the root component.  bodies: of an assembly, by id, the part that moves as its occurrence does.
    homes: of each component that has children, by its definition, the component and the ids of its occurrences.
    """

    draft: Draft
    root: str
    parts: Parts
    bodies: dict[str, str] = field(default_factory=dict[str, str])
    homes: dict[str, tuple[Component, list[str]]] = field(
        default_factory=dict[str, tuple[Component, list[str]]]
    )
    records: dict[str, Record] = field(default_factory=dict[str, Record])

    def read(self, root: RootComponent) -> None:
        """Add the root and everything below it.  What is fixed to the root is grounded."""
        pose = pose_of_rows(IDENTITY)
        self._add({"id": self.root, "name": self.root, "kind": "assembly", "flexible": True, "pose": pose})
        with self.draft.safely(f"bodies of {self.root}"):
            self._own_bodies(self.root, self.root, root, {"pose": pose, "grounded": True, "visible": True})
        self._level(root.occurrences, self.root)

    def component(self, occurrence: Occurrence | None) -> str:
        """What a joint of the occurrence acts on; of none, which is the root, the ground."""
        return "ground" if occurrence is None else self.body(self.named(occurrence))

    def named(self, occurrence: Occurrence) -> str:
        return f"{self.root}/{path_of(occurrence)}"

    def body(self, own: str) -> str:
        """The part that moves as an occurrence does."""
        return self.bodies.get(own, own)

    def _add(self, record: Record) -> None:
        self.draft.component(record)
        self.records[record["id"]] = record

    def _level(self, occurrences: Collection, parent: str) -> None:
        for feature, found in self.draft.each(occurrences.count, occurrences.item, "occurrence", parent, 0):
            with self.draft.safely(feature):
                self._occurrence(cast(Occurrence, found), parent)

    def _occurrence(self, occurrence: Occurrence, parent: str) -> None:
        own, children, definition = self.named(occurrence), occurrence.childOccurrences, occurrence.component
        name = self._definition(definition)
        held = _held(occurrence)
        where: Record = {
            "pose": pose_of_rows([float(v) for v in occurrence.transform2.asArray()]),
            "grounded": bool(occurrence.isGrounded) or (held and parent == self.root),
            "visible": bool(occurrence.isLightBulbOn),
        }
        if children.count > 0:
            plain: Record = {"id": own, "name": occurrence.name, "kind": "assembly", "parent": parent}
            self._add({**plain, "definition": name, **where, "flexible": True})
            self.homes.setdefault(name, (definition, []))[1].append(own)
            with self.draft.safely(f"bodies of {own}"):
                self._own_bodies(own, name, definition, where)
            self._level(children, own)
            if where["grounded"] and own in self.bodies:
                self.records[self.bodies[own]]["grounded"] = True
        else:
            plain = {"id": own, "name": occurrence.name, "kind": "part", "parent": parent}
            self._add({**plain, "definition": name, **where, **self.parts.read(name, definition)})
        if held and parent != self.root:
            self._hold(own, parent)

    def _definition(self, component: Component) -> str:
        own = ""
        with suppress(MemberFailed, AttributeError):
            own = component.id
        return self.draft.definition(component.name, own)

    def _own_bodies(self, own: str, name: str, component: Component | RootComponent, where: Record) -> None:
        if component.bRepBodies.count:
            definition = f"{name} ({OWN})"
            found = self.parts.read_bodies(definition, component)
            part: Record = {"id": f"{own}/{OWN}", "name": name, "kind": "part", "parent": own}
            self._add({**part, "definition": definition, **where, **found})
            self.bodies[own] = part["id"]

    def _hold(self, own: str, parent: str) -> None:
        """Fix an occurrence to its parent; of a parent without bodies the first that is fixed to it stands for it."""
        body = self.body(own)
        if body in self.records and self.records[body]["kind"] == "part":
            if (of_parent := self.bodies.setdefault(parent, body)) != body:
                record: Record = {"id": self.draft.unique(f"{own}: ground to parent"), "type": "rigid"}
                self.draft.joints.append({**record, "a": of_parent, "b": body})


def path_of(occurrence: Occurrence) -> str:
    return occurrence.fullPathName.replace("/", "_").replace("+", "/")


def _held(occurrence: Occurrence) -> bool:
    """Whether it is fixed to its parent; before May 2024 none could be."""
    with suppress(MemberFailed, AttributeError):
        return bool(occurrence.isGroundToParent)
    return False
