"""Which parts of a glTF file pass through each other, by its joints and collision filters alone."""

from __future__ import annotations

from itertools import combinations, product
from typing import Any

BODIES = "KHR_physics_rigid_bodies"


class GltfPairs:
    """above: for each node its parent.  parts: nodes by their ids in the source.  still: those with a kinematic motion, and None for
    what has none."""

    def __init__(self, document: dict[str, Any]):
        self.nodes: list[dict[str, Any]] = document["nodes"]
        self.filters = document.get("extensions", {}).get(BODIES, {}).get("collisionFilters", [])
        self.above = {child: i for i, node in enumerate(self.nodes) for child in node.get("children", ())}
        self.parts = {node["extras"]["id"]: i for i, node in enumerate(self.nodes) if "id" in node.get("extras", {})}
        self.still = {None, *(i for i in range(len(self.nodes)) if self.entry(i, "motion").get("isKinematic"))}
        self.joined = set[frozenset[int | None]]()
        self.welded = {i: {i} for i in range(len(self.nodes))}
        for i, node in enumerate(self.nodes):
            if joint := self.entry(i, "joint"):
                a, b = self.body(i), self.body(joint["connectedNode"])
                self.joined |= set() if joint.get("enableCollision") else {frozenset((a, b))}
                if node["name"] == "fixed":
                    both = self.welded[a] | self.welded[b]  # pyright: ignore
                    self.welded |= dict.fromkeys(both, both)
        self.colliders: dict[str, list[dict[str, Any]]] = {id: [] for id in self.parts}
        for i in range(len(self.nodes)):
            if collider := self.entry(i, "collider"):
                self.colliders[self.part(i)].append(collider)

    def entry(self, node: int, key: str) -> dict[str, Any]:
        return self.nodes[node].get("extensions", {}).get(BODIES, {}).get(key, {})

    def body(self, node: int | None) -> int | None:
        while node is not None and not self.entry(node, "motion"):
            node = self.above.get(node)
        return node

    def part(self, node: int) -> str:
        while "id" not in self.nodes[node].get("extras", {}):
            node = self.above[node]
        return self.nodes[node]["extras"]["id"]

    def filtered(self, one: dict[str, Any], other: dict[str, Any]) -> bool:
        """Whether a filter of one of two colliders names the other's system."""
        a, b = (self.filters[c["collisionFilter"]] if "collisionFilter" in c else {} for c in (one, other))
        return any(
            set(own.get("notCollideWithSystems", ())) & set(its.get("collisionSystems", ()))
            for own, its in ((a, b), (b, a))
        )

    def passing(self, parts: set[str]) -> set[frozenset[str]]:
        """Pairs of parts, by their ids, of which one moves and which do not collide; what is welded together counts as one."""
        found = set[frozenset[str]]()
        for one, other in combinations(sorted(parts & self.parts.keys()), 2):
            bodies = self.body(self.parts[one]), self.body(self.parts[other])
            together = [{None} if body is None else self.welded[body] for body in bodies]
            if bodies[0] == bodies[1] or set(bodies) <= self.still or (None not in bodies and together[0] is together[1]):
                continue
            members = [
                [id for id in parts & self.parts.keys() if id == own or self.body(self.parts[id]) in its - {None}]
                for own, its in zip((one, other), together)
            ]
            joined = None not in bodies and any(frozenset(pair) in self.joined for pair in product(*together))
            if joined or any(
                all(self.filtered(x, y) for x in self.colliders[a] for y in self.colliders[b])
                for a, b in product(*members)
                if self.colliders[a] and self.colliders[b]
            ):
                found.add(frozenset((one, other)))
        return found
