"""The occurrences of a Gallery assembly as a bundle's components, their bodies by the files that can be read."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...diagnostics import Report
from ...spatial import Pose
from ..reading.beside import beside
from ..reading.record import shown
from .values import BadValueError, Json, number, objects, segment, text, transform

Record = dict[str, Any]
FILES = ("obj", "step", "stl")
"""Forms of a body that are read, in the order of preference; smt is a closed format."""
PER_CUBIC_METRE = 1e6
"""Densities are in kilograms a cubic centimetre."""
OWN = "Bodies"
"""Part that stands for the bodies of an assembly itself."""
MOST_LEVELS = 60


@dataclass(frozen=True, slots=True, eq=False)
class Placed:
    """id: the component that a joint of the occurrence is on.  pose: in the root, centimetres."""

    id: str
    pose: Pose


class Tree:
    """components: records of a bundle.  placed: by the occurrence's uuid.  hidden: (component, body) that is not shown.
    places: of each record in the file, by pointer."""

    def __init__(self, values: Json, path: Path, report: Report) -> None:
        self.values, self.path, self.report = values, path, report
        self.components: list[Record] = []
        self.placed: dict[str, Placed] = {}
        self.hidden: set[tuple[str, str]] = set()
        self.places: dict[str, str] = {}
        self._occurrences = objects(values.get("occurrences"))
        self._kinds, self._bodies = objects(values.get("components")), objects(values.get("bodies"))
        root = objects(values.get("root"))
        name = segment(objects(self._kinds.get(str(root.get("component")))).get("name"), "Assembly")
        self._add({"id": name, "name": name, "kind": "assembly", "flexible": True}, Pose(), "/root")
        if bodies := objects(root.get("bodies")):
            record = {"id": f"{name}/{OWN}", "name": OWN, "kind": "part", "parent": name, "grounded": True}
            self._add(record, Pose(), "/root")
            self._geometry(record, bodies, {})
        self._level(objects(objects(values.get("tree")).get("root")), name, Pose(), 1)

    def _level(self, below: Json, parent: str, pose: Pose, level: int) -> None:
        names: dict[str, int] = {OWN: 1}
        for key, further in below.items():
            try:
                self._occurrence(key, objects(further), parent, pose, names, level)
            except BadValueError as error:
                self._left(f"occurrence {shown(key)}", f"/occurrences/{shown(key)}", str(error))

    def _occurrence(
        self, key: str, further: Json, parent: str, pose: Pose, names: dict[str, int], level: int
    ) -> None:
        if level > MOST_LEVELS:
            raise BadValueError(f"it is nested more than {MOST_LEVELS} levels deep")
        if key not in self._occurrences:
            raise BadValueError("the tree names it, and the file does not hold it")
        if key in self.placed:
            raise BadValueError("the tree names it twice")
        found, place = objects(self._occurrences[key]), f"/occurrences/{shown(key)}"
        world = pose @ transform(found.get("transform"))
        name = segment(found.get("name"), "Occurrence")
        names[name] = names.get(name, 0) + 1
        name = name if names[name] == 1 else f"{name} ({names[name]})"
        own, bodies = f"{parent}/{name}", objects(found.get("bodies"))
        record: Record = {
            "id": own,
            "name": name,
            "kind": "assembly" if further else "part",
            "parent": parent,
            "visible": found.get("is_visible") is not False,
            "grounded": found.get("is_grounded") is True,
        }
        if isinstance(found.get("component"), str):
            record["definition"] = text(found["component"])
        if further:
            record["flexible"] = True
        self._add(record, world, place)
        self.placed[key] = Placed(own, world)
        if further and bodies:
            record = {
                "id": f"{own}/{OWN}",
                "name": OWN,
                "kind": "part",
                "parent": own,
                "grounded": record["grounded"],
            }
            self._add(record, world, place)
            self.placed[key] = Placed(record["id"], world)
        if bodies:
            self._geometry(record, bodies, objects(found.get("physical_properties")))
        self._level(further, own, world, level + 1)

    def _add(self, record: Record, pose: Pose, place: str) -> None:
        x, y, z = pose.rotation.T.tolist()
        record["pose"] = {"o": pose.translation.tolist(), "x": x, "y": y, "z": z}
        self.places[f"/components/{len(self.components)}"] = place
        self.components.append(record)

    def _geometry(self, record: Record, bodies: Json, whole: Mapping[str, Any]) -> None:
        listed: list[Record] = []
        for key, shown_as in bodies.items():
            body = objects(self._bodies.get(key))
            file = self._file(body)
            place = f"/bodies/{shown(key)}"
            if file is None:
                words = ", ".join(word for word in FILES if isinstance(body.get(word), str))
                told = (
                    f"none of its files ({words}) lies beside the assembly"
                    if words
                    else "no obj, step or stl of it is named"
                )
                self._left(f"body {shown(key)} of {record['id']}", place, told)
                continue
            entry: Record = {"id": key, "name": text(body.get("name"), key), "file": file}
            density = objects(body.get("physical_properties")).get("density", whole.get("density"))
            try:
                value = number(density, "density") * PER_CUBIC_METRE
            except BadValueError:
                value = 0.0
            if value > 0.0:
                entry["density"] = value
            if objects(shown_as).get("is_visible") is False:
                self.hidden.add((record["id"], entry["name"]))
            listed.append(entry)
        if listed:
            record["bodies"] = listed

    def _file(self, body: Json) -> str | None:
        """The first form of a body that is there."""
        for word in FILES:
            name = body.get(word)
            if isinstance(name, str) and (path := beside(self.path, name)) is not None and path.is_file():
                return name
        return None

    def _left(self, feature: str, place: str, reason: str) -> None:
        self.report.dropped(feature, "GALLERY_LEFT_OUT", f"{self.path.name}#{place}", reason=reason)
