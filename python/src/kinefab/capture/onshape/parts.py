"""Onshape's parts: mesh, look and mass, asked once for all their instances."""

from __future__ import annotations

import struct
from dataclasses import dataclass, field
from typing import Any, cast

from ..draft import BodyMesh, Draft, Numbers, Record
from ..looks import look
from ..masses import mass_record
from .answers import Answers, look_question, mass_question, mesh_question

STL_HEAD, STL_FACET = 84, 50
FULL = 255.0


@dataclass(slots=True)
class Parts:
    """definitions: bodies and mass of each part that was read, by its definition."""

    answers: Answers
    draft: Draft
    definitions: dict[str, Record] = field(default_factory=dict[str, Record])

    def read(self, definition: str, name: str, instance: dict[str, Any]) -> Record:
        """``bodies`` and ``mass`` of an instance's part; without a program only what was saved.  name: the instance's."""
        if definition not in self.definitions:
            found: Record = {}
            if self._answered(question := mesh_question(instance)):
                with self.draft.safely(f"mesh of {name}"):
                    mesh = stl(name, self.answers.bytes_of(question))
                    self.draft.meshes[definition] = [mesh]
                    found["bodies"] = [{"id": mesh.name, "meshKey": mesh.name}]
            if "bodies" in found and self._answered(question := look_question(instance)):
                with self.draft.safely(f"look of {name}"):
                    self._look(name, str(instance.get("partId")), self.answers.ask(question), found)
            if self._answered(question := mass_question(instance)):
                with self.draft.safely(f"mass of {name}"):
                    self._mass(definition, name, self.answers.ask(question), found)
            self.definitions[definition] = found
        return self.definitions[definition]

    def _answered(self, question: str) -> bool:
        return self.answers.fetch is not None or question in self.answers.answers

    def _look(self, name: str, part: str, listed: Any, found: Record) -> None:
        entry = next((e for e in listed if e.get("partId") == part), None)
        if entry is None:
            return
        shown: dict[str, Any] = entry.get("appearance") or {}
        material: dict[str, Any] = entry.get("material") or {}
        color: Numbers | None = None
        if rgb := shown.get("color"):
            color = [rgb[key] / FULL for key in ("red", "green", "blue")] + [
                shown.get("opacity", FULL) / FULL
            ]
        if made := look(self.draft, str(material.get("displayName") or ""), color, name):
            found["bodies"][0]["material"] = made

    def _mass(self, definition: str, name: str, answer: Any, found: Record) -> None:
        """Three of each: as computed, least, most; a part without a material has none."""
        bodies = cast("dict[str, Any]", answer["bodies"])
        body = next(iter(bodies.values()), None)
        if not body or not body.get("hasMass") or float(body["mass"][0]) <= 0.0:
            return
        m = [float(v) for v in body["inertia"][:9]]
        moments, principal = (
            [m[0], m[4], m[8], m[1], m[5], m[2]],
            [float(v) for v in body["principalInertia"][:3]],
        )
        meshes = self.draft.meshes.get(definition, ())
        found["mass"] = mass_record(
            self.draft,
            name,
            float(body["mass"][0]),
            body["centroid"][:3],
            moments,
            principal,
            "centre",
            meshes,
        )


def stl(name: str, content: bytes) -> BodyMesh:
    """A binary STL.  Raises ValueError where it is none."""
    count = struct.unpack_from("<I", content, STL_HEAD - 4)[0] if len(content) >= STL_HEAD else -1
    if len(content) != STL_HEAD + STL_FACET * count:
        raise ValueError("no binary STL")
    points: list[float] = []
    for facet in range(count):
        numbers = struct.unpack_from("<12f", content, STL_HEAD + STL_FACET * facet)
        points += cast("tuple[float, ...]", numbers)[3:]
    return BodyMesh(" ".join(name.split()), points, list(range(3 * count)))
