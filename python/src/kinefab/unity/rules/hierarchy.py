"""GameObjects: their ids and roles, what stands above each, and that nothing is on them twice."""

from __future__ import annotations

from collections.abc import Sequence

from .findings import Entry, Findings

ONCE = {
    "Rigidbody": "RIGIDBODY_DUPLICATE",
    "ArticulationBody": "COMPONENT_DUPLICATE",
    "MeshFilter": "COMPONENT_DUPLICATE",
    "MeshRenderer": "COMPONENT_DUPLICATE",
}
"""Of what Unity allows one on an object, and the finding about a second."""


class Hierarchy:
    """objects: of the scene.  parents: of each, None also of one whose parent does not stand before it.
    has_body, is_link: whether each has a Rigidbody or ArticulationBody, or the latter.
    bodies: the object whose body moves each: itself or the next one above it that has one.
    links_above: the next one above each that has a link."""

    def __init__(self, objects: Sequence[Entry]):
        self.objects = objects
        self.parents: list[int | None] = []
        self.has_body: list[bool] = []
        self.is_link: list[bool] = []
        self.bodies: list[int | None] = []
        self.links_above: list[int | None] = []
        for index, entry in enumerate(objects):
            self._add(index, entry)

    def _add(self, index: int, entry: Entry) -> None:
        parent: int | None = entry.get("parent")
        if parent is not None and not 0 <= parent < index:
            parent = None
        types = [component["type"] for component in entry.get("components", ())]
        is_link = "ArticulationBody" in types
        has_body = is_link or "Rigidbody" in types
        above = None
        if parent is not None:
            above = parent if self.is_link[parent] else self.links_above[parent]
        self.parents.append(parent)
        self.has_body.append(has_body)
        self.is_link.append(is_link)
        self.bodies.append(index if has_body else None if parent is None else self.bodies[parent])
        self.links_above.append(above)


def check_objects(places: Hierarchy, found: Findings) -> None:
    """All but what their components say of themselves."""
    first: dict[str, int] = {}
    ground: int | None = None
    for index, entry in enumerate(places.objects):
        id = entry["id"]
        if not id:
            found.add("ID_EMPTY", f"/gameObjects/{index}/id")
        elif first.setdefault(id, index) != index:
            found.add("ID_DUPLICATE", f"/gameObjects/{index}/id", id=id, first=first[id])
        parent, components = entry.get("parent"), entry.get("components", ())
        if parent is not None and places.parents[index] is None:
            found.add("PARENT_NOT_EARLIER", f"/gameObjects/{index}/parent", parent=parent, index=index)
        role = entry.get("role")
        if role == "site" and (components or parent is None):
            found.add("SITE_NOT_A_FRAME", f"/gameObjects/{index}/role")
        elif role == "ground" and ground is not None:
            found.add("GROUND_TWICE", f"/gameObjects/{index}/role", first=ground)
        elif role == "ground":
            ground = index
        types = [component["type"] for component in components]
        if len(set(types)) < len(types):
            _check_once(types, index, found)


def _check_once(types: Sequence[str], index: int, found: Findings) -> None:
    for component, kind in enumerate(types):
        if kind in ONCE and kind in types[:component]:
            found.add(ONCE[kind], f"/gameObjects/{index}/components/{component}", type=kind)
