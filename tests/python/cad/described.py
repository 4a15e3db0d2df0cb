"""One description of an assembly, from which every program's double is made: metres, radians, world vectors."""

from __future__ import annotations

import copy
import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

FIXTURES = Path(__file__).parents[3] / "fixtures"
LENGTH = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254}
ANGLE = {"rad": 1.0, "deg": np.pi / 180.0}


@dataclass
class Part:
    """mass: ``mass`` kg, ``center`` and the 3 x 3 tensor ``inertia`` about it, metres, the part's axes.
    look: ``material`` and ``srgb``, red green blue and opacity as bytes."""

    id: str
    name: str
    parent: str
    assembly: bool
    rotation: np.ndarray
    origin: np.ndarray
    flags: dict[str, bool]
    definition: str
    mass: dict[str, Any] | None = None
    look: dict[str, Any] | None = None

    def local(self, p: np.ndarray) -> np.ndarray:
        return np.linalg.solve(self.rotation, p - self.origin)

    def turned(self, d: np.ndarray) -> np.ndarray:
        return np.linalg.solve(self.rotation, d)


@dataclass
class Described:
    """root: id of the document's assembly.  joints, constraints: as a bundle's, all vectors in the world, metres, radians."""

    root: str
    up: str
    parts: dict[str, Part]
    joints: list[dict[str, Any]]
    constraints: list[dict[str, Any]]
    couplings: list[dict[str, Any]]
    dof: list[dict[str, Any]]
    values: dict[str, Any] = field(default_factory=dict)

    def children(self, parent: str) -> list[Part]:
        return [part for part in self.parts.values() if part.parent == parent]

    def owner(self, *components: str) -> str:
        """The flexible assembly that holds all of the components: the one that a program would state a mate in."""
        return self.root


def mechanism(name: str) -> dict[str, Any]:
    """A bundle of the fixtures without geometry and looks, under a root assembly."""
    path = FIXTURES / name
    values = json.loads(path.read_text("utf-8"))
    values["meta"].pop("mesh", None)
    values.pop("materials", None)
    for component in values["components"]:
        component.pop("bodies", None)
        component.pop("mass", None)
    if not any(c["kind"] == "assembly" and "parent" not in c for c in values["components"]):
        identity = {"o": [0.0, 0.0, 0.0], "x": [1.0, 0.0, 0.0], "y": [0.0, 1.0, 0.0], "z": [0.0, 0.0, 1.0]}
        root = {"id": "Machine", "kind": "assembly", "flexible": True, "pose": identity}
        for component in values["components"]:
            component["parent"] = component.get("parent", "Machine")
        values = json.loads(_renamed(json.dumps(values), [c["id"] for c in values["components"]]))
        values["components"].insert(0, root)
    for joint in values.get("joints", []):
        joint["name"] = joint["id"]  # a program has one name for it
    values["components"] = depth_first(values["components"])
    return values


def depth_first(components: list[dict[str, Any]], parent: str = "") -> list[dict[str, Any]]:
    """In the order in which a program lists its tree."""
    found: list[dict[str, Any]] = []
    for component in components:
        if component.get("parent", "") == parent:
            found += [component, *depth_first(components, component["id"])]
    return found


def _renamed(text: str, ids: list[str]) -> str:
    for name in ids:
        for key in ("id", "component", "parent", "a", "b"):
            text = text.replace(f'"{key}": "{name}"', f'"{key}": "Machine/{name}"')
    return text


def described(values: dict[str, Any]) -> Described:
    values = copy.deepcopy(values)
    unit = LENGTH[values["meta"]["units"]["length"]]
    angle = ANGLE[values["meta"]["units"]["angle"]]
    parts: dict[str, Part] = {}
    root = next(c["id"] for c in values["components"] if "parent" not in c)
    for c in values["components"]:
        pose = c["pose"]
        parts[c["id"]] = Part(
            c["id"],
            c.get("name", c["id"].rpartition("/")[2]),
            c.get("parent", ""),
            c["kind"] == "assembly",
            np.array([pose["x"], pose["y"], pose["z"]]).T,
            np.array(pose["o"]) * unit,
            {k: c.get(k, False) for k in ("grounded", "flexible", "suppressed")}
            | {"visible": c.get("visible", True)},
            c.get("definition", c["id"].rpartition("/")[2]),
            _mass(c.get("mass"), unit),
            c.get("look"),
        )

    def world(record: dict[str, Any], component: str) -> None:
        inside = record.pop("in", "world")
        base = parts.get(component if inside == "part" else inside)
        for key in ("p", "o"):
            if key in record:
                v = np.array(record[key]) * unit
                record[key] = v if base is None else base.rotation @ v + base.origin
        for key in ("d", "x", "z"):
            if key in record:
                v = np.array(record[key]) / np.linalg.norm(record[key])
                record[key] = v if base is None else base.rotation @ v
        if "r" in record:
            record["r"] *= unit

    for joint in values.get("joints", []):
        for key in ("frameA", "frameB"):
            if key in joint:
                world(joint[key], joint[key[-1].lower()])
        for dof in joint.get("dof", []):
            scale = unit if dof["name"][0] == "t" else angle
            for key in ("value", "min", "max"):
                if key in dof:
                    dof[key] *= scale
    for c in values.get("constraints", []):
        for key in "abc":
            if key in c:
                world(c[key], c[key]["component"])
        scale = angle if c["kind"] == "angle" else 1.0 if c["kind"] in ("gear", "linear", "belt") else unit
        for key in ("value", "min", "max"):
            if key in c:
                c[key] *= scale
    for record in values.get("dof", []):
        if "center" in record:
            record["center"] = np.array(record["center"]) * unit
    return Described(
        root, values["meta"]["up"], parts, values.get("joints", []), values.get("constraints", []),
        values.get("couplings", []), values.get("dof", []), values,
    )  # fmt: skip


def _mass(record: dict[str, Any] | None, unit: float) -> dict[str, Any] | None:
    if record is None:
        return None
    xx, yy, zz, xy, yz, xz = np.array(record["inertia"]) * unit**2
    tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    return {"mass": record["mass"], "center": np.array(record["center"]) * unit, "inertia": tensor}


def owned(assembly: Described, owner: str) -> list[dict[str, Any]]:
    """The constraints that a program states in an assembly: of parts below it, or of its own planes, not all of them below a
    flexible one in it; of what is inside a rigid one nobody is told."""
    below = {
        p.id: p.flags["flexible"] for p in assembly.parts.values() if p.assembly and p.id != assembly.root
    }
    found = []
    for c in assembly.constraints:
        ends = [c[k]["component"] for k in "abc" if k in c]
        homes = [p for p in below if all(e == p or e.startswith(p + "/") for e in ends)]
        home = max(homes, key=len, default=assembly.root)
        if home == owner and all(below[p] for p in homes):
            found.append(c)
    return found
