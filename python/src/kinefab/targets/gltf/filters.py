"""What does not collide with what: collision filters, each of one system that the file names.

A system is a group of the source together with the nodes above a collider, within its rigid body, that a filtered pair names:
all its colliders ignore the same others.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ...diagnostics import Report
from ...model import Scene, ignored_groups
from ...rigid import RigidGroups
from ...unity.bodies.standing import bases_of
from ..filtering import base_pairs, carried_with, ignored_pairs, tell_colliding

System = tuple[str, tuple[int, ...]]
"""Group, "" for none, and the nodes that pairs name."""
TARGET = ".glb"


class Filters:
    """Collects colliders, then gives each its filter."""

    def __init__(self, scene: Scene, groups: RigidGroups, report: Report):
        self._scene, self._groups = scene, groups
        self._bases = bases_of(scene, groups)
        tell_colliding(scene, report, TARGET)
        self._pairs, unknown = ignored_pairs(scene)
        self._pairs += base_pairs(scene, groups)
        self._named = {node for pair in self._pairs for node in pair}
        self._members: dict[System, list[dict[str, Any]]] = {}
        for told in unknown:
            field = {"field": "what does not collide", "target": TARGET}
            report.dropped(f"filtered pair {told}", "TARGET_FIELD_DROPPED", **field)

    def add(self, node: int, group: str, entry: dict[str, Any]) -> None:
        """entry: of a collider or trigger, which gets its filter by ``write``."""
        line = carried_with(self._scene, self._groups, self._bases, node)
        nodes = tuple(i for i in line if i in self._named)
        self._members.setdefault((group, nodes), []).append(entry)

    def written(self) -> list[dict[str, Any]]:
        """The document's filters; the collected entries refer to them."""
        ignored = self._ignored()
        found: list[dict[str, Any]] = []
        for system in sorted(ignored):
            for entry in self._members[system]:
                entry["collisionFilter"] = len(found)
            others = sorted(self._name(other) for other in ignored[system])
            found.append({"collisionSystems": [self._name(system)], "notCollideWithSystems": others})
        return found

    def _ignored(self) -> Mapping[System, set[System]]:
        """Systems that ignore any, and those."""
        groups = ignored_groups({group for group, _ in self._members}, self._scene.extras)
        systems: dict[int, list[System]] = {}
        by_group: dict[str, list[System]] = {}
        for system in self._members:
            by_group.setdefault(system[0], []).append(system)
            for node in system[1]:
                systems.setdefault(node, []).append(system)
        found: dict[System, set[System]] = {}
        apart = [
            (one, other)
            for group, others in groups.items()
            for one in by_group[group]
            for name in others
            for other in by_group[name]
        ]
        apart += [
            (one, other)
            for first, second in self._pairs
            for one in systems.get(first, ())
            for other in systems.get(second, ())
        ]
        for one, other in apart:
            found.setdefault(one, set()).add(other)
            found.setdefault(other, set()).add(one)
        return found

    def _name(self, system: System) -> str:
        group, nodes = system
        return " / ".join([*([group] if group else []), *(self._scene.nodes[i].id for i in nodes)]) or "none"
