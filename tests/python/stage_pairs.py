"""Which parts of a stage pass through each other, read from the text of a ``.usda`` file alone."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from itertools import combinations, product
from pathlib import Path

PRIM = re.compile(r'\s*(?:def|class) (?:(\w+) )?"([^"]+)"')
RELATION = re.compile(r"\s*(?:prepend )?rel (physics:\w+) =")


@dataclass
class StagePrim:
    """id: what it is in the source, "" for nothing."""

    path: str
    kind: str
    id: str = ""
    schemas: set[str] = field(default_factory=set)
    relations: dict[str, list[str]] = field(default_factory=dict)
    collides: bool = False


def prims_of(text: str) -> list[StagePrim]:
    """Prims with their API schemas and physics relations; each opens a brace on a line of its own and closes it so."""
    found: list[StagePrim] = []
    open_prims: list[StagePrim | None] = []
    relation: list[str] | None = None
    for line in text.splitlines():
        if made := PRIM.match(line):
            above = next((prim.path for prim in reversed(open_prims) if prim is not None), "")
            found.append(StagePrim(f"{above}/{made[2]}", made[1] or ""))
        elif line.strip() == "{":
            open_prims.append(found[-1])
        elif line.rstrip().endswith("{"):
            open_prims.append(None)
        elif line.strip() == "}":
            open_prims.pop()
        elif told := re.match(r'\s*string id = "(.*)"', line):
            found[-1].id = told[1]
        elif "apiSchemas" in line:
            found[-1].schemas |= set(re.findall(r'"([\w:]+)"', line))
        elif re.match(r"\s*bool physics:collisionEnabled = (1|true)", line):
            found[-1].collides = True
        if named := RELATION.match(line):
            relation = found[-1].relations.setdefault(named[1], [])
        if relation is not None:
            relation += re.findall(r"<([^>]+)>", line)
            relation = relation if "[" in line or (relation and "]" not in line and "," in line) else None
    return found


class StagePairs:
    """bodies: paths of rigid bodies.  still: those that a script leads, or fixed joints hold to the world."""

    def __init__(self, stage: Path):
        self.prims = {prim.path: prim for prim in prims_of(stage.read_text(encoding="utf-8"))}
        self.bodies = {path for path, prim in self.prims.items() if "PhysicsRigidBodyAPI" in prim.schemas}
        self.joints = [prim for prim in self.prims.values() if prim.kind.startswith("Physics") and "physics:body0" in prim.relations]
        self.welded = {path: {path} for path in self.bodies}
        self.still: set[str | None] = {None}
        fixed = [self.ends(joint) for joint in self.joints if joint.kind == "PhysicsFixedJoint"]
        for _ in fixed:
            self.still |= {end for pair in fixed if self.still & set(pair) for end in pair}
        for a, b in fixed:
            if a not in self.still and b not in self.still:
                both = self.welded[a] | self.welded[b]  # pyright: ignore
                self.welded |= dict.fromkeys(both, both)
        self.apart = {frozenset(self.ends(joint)) for joint in self.joints if not joint.collides}
        self.apart |= {
            frozenset((prim.path, other))
            for prim in self.prims.values()
            for other in prim.relations.get("physics:filteredPairs", ())
        }

    def ends(self, joint: StagePrim) -> tuple[str | None, str | None]:
        """The joint's bodies, None for the world."""
        return tuple(self.body(joint.relations[f"physics:body{i}"][0]) for i in (0, 1))  # pyright: ignore

    def body(self, path: str) -> str | None:
        """The body that a prim is part of."""
        while path and path not in self.bodies:
            path = path.rpartition("/")[0]
        return path or None

    def colliders(self, path: str) -> set[str]:
        """Paths below a part that stands and is no body, as far as they are no other part's."""
        inner = [p for p, prim in self.prims.items() if p.startswith(f"{path}/") and prim.id]
        return {p for p in self.prims if p.startswith(f"{path}/") and not any(f"{p}/".startswith(f"{own}/") for own in inner)}

    def passing(self, parts: set[str]) -> set[frozenset[str]]:
        """Pairs of parts, by their ids in the source, of which one moves and which do not collide."""
        at = {prim.id: path for path, prim in self.prims.items() if prim.id in parts}
        found = set[frozenset[str]]()
        for one, other in combinations(sorted(at), 2):
            bodies = self.body(at[one]), self.body(at[other])
            if bodies[0] == bodies[1] or set(bodies) <= self.still or self.welded.get(bodies[0] or "") is self.welded.get(bodies[1] or ""):  # fmt: skip
                continue
            sides = [
                self.welded[body] if body is not None else self.colliders(at[part])
                for body, part in zip(bodies, (one, other))
            ]
            if any(frozenset(pair) in self.apart for pair in product(*sides)):
                found.add(frozenset((one, other)))
        return found
