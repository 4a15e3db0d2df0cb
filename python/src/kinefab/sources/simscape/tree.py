"""The instances of a Simscape Multibody assembly as a bundle's components, its parts with mass, colour and file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...color import linear
from ...diagnostics import Report, is_encodable
from ...spatial import Pose
from ..robots.xml_elements import Element

Record = dict[str, Any]
IDENTITY = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
GROUNDED = "grounded"


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """file: of its geometry, "" for none.  length: word for the unit in which the program models it.  color: sRGB, or None."""

    file: str
    length: str
    mass: Record | None
    color: tuple[float, ...] | None


class Tree:
    """components, materials: records of a bundle.  ids: component by the uids that lead to it.  poses: in the world, by id,
    in the file's unit.  owners: uid paths of the root (empty) and of every instance of a sub-assembly, with its element.
    groups: ids of the members of each rigid group, and of what is grounded in a sub-assembly that may move, by path and name.
    loose: uid paths of the flexible assemblies, which are no bodies; still: of those of them that stand still in the root.
    lines: of each record, by pointer."""

    def __init__(self, root: Element, assembly: Element, report: Report) -> None:
        self.report = report
        self.components: list[Record] = []
        self.materials: list[Record] = []
        self.lines: dict[str, int] = {}
        self.ids: dict[tuple[str, ...], str] = {}
        self.poses: dict[str, Pose] = {}
        self.groups: dict[tuple[tuple[str, ...], str], list[str]] = {}
        self.owners: list[tuple[tuple[str, ...], Element]] = [((), assembly)]
        self.loose: set[tuple[str, ...]] = {()}
        self.still: set[tuple[str, ...]] = {()}
        self._uids: dict[tuple[str, ...], str] = {(): assembly.attributes.get("uid", "")}
        self._assemblies = _by_uid(root, "Assemblies", "Assembly")
        units = root.child("ModelUnits")
        length = "meter" if units is None else units.attributes.get("length", "meter")
        self.parts = {uid: _part(part, length) for uid, part in _by_uid(root, "Parts", "Part").items()}
        name = _plain(assembly.attributes.get("name", "")) or "Assembly"
        self._add(assembly, (), {"id": name, "name": name, "kind": "assembly", "flexible": True}, Pose())
        instances = assembly.child("InstanceTree")
        self._level(instances, (), name, Pose(), {})

    def _level(
        self, above: Element | None, path: tuple[str, ...], parent: str, pose: Pose, names: dict[str, int]
    ) -> None:
        for instance in above.all("Instance") if above is not None else ():
            uid = instance.name("uid")
            name = _plain(instance.attributes.get("name", "")) or uid
            names[name] = names.get(name, 0) + 1
            name = name if names[name] == 1 else f"{name} ({names[name]})"
            own = f"{parent}/{name}"
            definition = instance.attributes.get("entityUid", "")
            world = pose @ self.transform(instance)
            held = any(True for _ in instance.all("Instance")) or definition in self._assemblies
            record: Record = {
                "id": own,
                "name": name,
                "kind": "assembly" if held else "part",
                "parent": parent,
            }
            if definition:
                record["definition"] = definition
            fixed = _true(instance, GROUNDED)  # to its own assembly, which may move
            record["grounded"] = fixed and path in self.still
            if held:
                record["flexible"] = not _true(instance, "rigid")
            self._add(instance, (*path, uid), record, world)
            groups = [instance.attributes.get("rigidGroup", "")]
            groups += [GROUNDED] if fixed and path in self.loose - self.still else []
            for group in filter(None, groups):
                self.groups.setdefault((path, group), []).append(own)
            if held:
                self._uids[(*path, uid)] = definition
                if record["flexible"]:
                    self.loose.add((*path, uid))
                    if record["grounded"]:
                        self.still.add((*path, uid))
                if (assembly := self._assemblies.get(definition)) is not None:
                    self.owners.append(((*path, uid), assembly))
                self._level(instance, (*path, uid), own, world, {})
            elif (part := self.parts.get(definition)) is not None:
                self._geometry(record, part)

    def _add(self, element: Element, path: tuple[str, ...], record: Record, pose: Pose) -> None:
        if path in self.ids and path:
            element.fault("SOURCE_ID_DUPLICATE", id="/".join(path), first=self.ids[path])
        x, y, z = pose.rotation.T.tolist()
        record["pose"] = {"o": pose.translation.tolist(), "x": x, "y": y, "z": z}
        self.lines[f"/components/{len(self.components)}"] = element.line
        self.ids[path], self.poses[record["id"]] = record["id"], pose
        self.components.append(record)

    def _geometry(self, record: Record, part: Part) -> None:
        if part.mass is not None:
            record["mass"] = part.mass
        if not part.file:
            return
        body: Record = {"id": record["name"]}
        if part.color is not None:
            body["material"] = self._material(part.color)
        record["file"], record["bodies"] = "geometry", [body]  # which file is settled once the scene is there

    def _material(self, color: tuple[float, ...]) -> str:
        """Diffuse colours are those of a screen; a bundle's are linear."""
        name = "#" + "".join(f"{round(255 * c):02X}" for c in color[:3])
        name += f" {color[3]:g}" if color[3] < 1.0 else ""
        if all(material["name"] != name for material in self.materials):
            self.materials.append({"name": name, "color": [*map(linear, color[:3]), color[3]]})
        return name

    def transform(self, element: Element) -> Pose:
        """The pose that an element's ``Transform`` states; rows of the rotation follow each other."""
        found = element.child("Transform")
        if found is None:
            return Pose()
        rotation, translation = found.child("Rotation"), found.child("Translation")
        rows = IDENTITY if rotation is None else rotation.values(9, IDENTITY)
        origin = (0.0,) * 3 if translation is None else translation.values(3, (0.0,) * 3)
        return Pose(np.reshape(rows, (3, 3)), np.array(origin))

    def inside(self, owner: tuple[str, ...], element: Element) -> tuple[str, str]:
        """Ids of what moves as what an element's ``InstancePath`` names does, and of what its numbers are stated in.

        An assembly's own planes and origin are named by its own uid, or by no path at all; for a flexible one, which is no
        body, stands the ground where it stands still in the root, else what is grounded in it.  Raises KeyError.
        """
        found = element.child("InstancePath")
        uids = [] if found is None else [uid.text.strip() for uid in found.all("Uid")]
        path = (*owner, *filter(None, uids))
        if path not in self.ids and path == (*owner, self._uids.get(owner, "")):
            path = owner
        own = self.ids[path]
        if path not in self.loose:
            return own, own
        held = self.groups.get((path, GROUNDED), [own])[0]
        return ("ground" if path in self.still else held), own


def _by_uid(root: Element, group: str, tag: str) -> dict[str, Element]:
    above = root.child(group)
    return {} if above is None else {entry.attributes.get("uid", ""): entry for entry in above.all(tag)}


def _true(element: Element, key: str) -> bool:
    return element.attributes.get(key, "").strip().lower() in ("true", "1")


def _plain(name: str) -> str:
    name = name if is_encodable(name) else ""
    return "".join(c if c.isprintable() else " " for c in name).strip().replace("/", "_")


def _part(part: Element, length: str) -> Part:
    units, file = part.child("ModelUnits"), part.child("GeometryFile")
    return Part(
        "" if file is None else file.attributes.get("name", "").strip(),
        (length if units is None else units.attributes.get("length", length)).lower(),
        _mass(part.child("MassProperties")),
        _color(part.child("VisualProperties")),
    )


def _mass(found: Element | None) -> Record | None:
    """Mass, centre and the tensor about it, in the part's axes; the file's order is xx yy zz yz zx xy.  A part without a
    mass (sketches, surfaces) states none."""
    if found is None or (mass := found.child("Mass")) is None or not (value := mass.value()) > 0.0:
        return None
    center, inertia = found.child("CenterOfMass"), found.child("Inertia")
    xx, yy, zz, yz, zx, xy = (0.0,) * 6 if inertia is None else inertia.values(6, (0.0,) * 6)
    at = (0.0,) * 3 if center is None else center.values(3, (0.0,) * 3)
    return {"in": "part", "mass": value, "center": list(at), "inertia": [xx, yy, zz, xy, yz, zx]}


def _color(found: Element | None) -> tuple[float, ...] | None:
    diffuse = None if found is None else found.child("Diffuse")
    if diffuse is None:
        return None
    return tuple(min(max(diffuse.number(key, 1.0), 0.0), 1.0) for key in "rgba")
