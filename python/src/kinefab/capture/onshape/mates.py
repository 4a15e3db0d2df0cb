"""Onshape's mates, relations and groups as joints, couplings and constraints of a bundle."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import Any

from ..draft import Draft, Record, frame, freedom
from .answers import limits_question
from .definition import Definition, Json

TYPES: Mapping[str, tuple[str, dict[str, str]]] = {
    "FASTENED": ("rigid", {}),
    "REVOLUTE": ("revolute", {"rz": "rotationZ"}),
    "SLIDER": ("slider", {"tz": "translationZ"}),
    "CYLINDRICAL": ("cylindrical", {"tz": "translationZ", "rz": "rotationZ"}),
    "PIN_SLOT": ("pin_slot", {"tx": "translationX", "rz": "rotationZ"}),
    "PLANAR": ("planar", {"tx": "translationX", "ty": "translationY", "rz": "rotationZ"}),
    "BALL": ("ball", {}),
}
"""Mate type: word of the bundle, and the field of the mate values that shows each coordinate."""
LIMITS = {
    "tz": ("limitZMin", "limitZMax"),
    "rz": ("limitAxialZMin", "limitAxialZMax"),
    "tx": ("limitXMin", "limitXMax"),
    "ty": ("limitYMin", "limitYMax"),
}
CONE = "limitEulerConeAngleMax"
RELATIONS = {"GEAR": "gear", "RACK_AND_PINION": "rack", "SCREW": "screw", "LINEAR": "linear"}
COORDINATE = {
    "GEAR": ("rz", "rz"),
    "RACK_AND_PINION": ("rz", "tz"),
    "SCREW": ("rz", "tz"),
    "LINEAR": ("tz", "tz"),
}
UNITS = {
    "": 1.0, "m": 1.0, "meter": 1.0, "mm": 0.001, "millimeter": 0.001, "cm": 0.01, "centimeter": 0.01, "in": 0.0254,
    "inch": 0.0254, "ft": 0.3048, "foot": 0.3048, "yd": 0.9144, "yard": 0.9144, "deg": math.pi / 180.0,
    "degree": math.pi / 180.0, "rad": 1.0, "radian": 1.0,
}  # fmt: skip
CHOSEN = "what the configuration chooses"
"""Stands for a parameter that has a value for each configuration."""
EXPRESSION = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*\*?\s*([a-z]*)\s*")


def quantity(expression: str) -> float:
    """Metres or radians of an expression: a number and a unit.  Raises ValueError for a formula or a variable."""
    found = EXPRESSION.fullmatch(expression)
    if found is None or found[2] not in UNITS:
        raise ValueError(f"the expression {expression!r} is no number with a unit")
    return float(found[1]) * UNITS[found[2]]


def limits_of(features: Any) -> dict[str, Json]:
    """Of each mate, by its id, the parameters that its feature states, by theirs."""
    found: dict[str, Json] = {}
    for entry in features.get("features", []):
        feature = entry.get("message", entry)
        parameters: Json = {}
        for parameter in feature.get("parameters", []):
            held = parameter.get("message", parameter)
            if held.get("isNull"):
                continue
            parameters[held.get("parameterId", "")] = held.get("expression", held.get("value", CHOSEN))
        found[feature.get("featureId", "")] = parameters
    return found


Limits = dict[str, dict[str, Json]]
"""Parameters of the mates by id, of each assembly by its question; of the root by none."""


class Mates:
    """features: parameters of each mate; values: what those of the root show, by id.  joints: id of each made joint by the
    owner's path and its feature."""

    def __init__(self, definition: Definition, features: Limits, values: dict[str, Json]) -> None:
        self.definition, self.features, self.values = definition, features, values
        self.draft: Draft = definition.draft
        self.joints: dict[tuple[tuple[str, ...], str], tuple[str, str]] = {}

    def read(self) -> None:
        kinds = {"mate": self._mate, "mateGroup": self._group, "mateRelation": self._relation}
        for wanted, build in kinds.items():  # relations name mates
            for path, assembly in self.definition.owners.items():
                for feature in assembly.get("features", []):
                    if feature.get("featureType") == wanted:
                        data = feature.get("featureData", {})
                        with self.draft.safely(f"{wanted} {data.get('name', feature.get('id'))}"):
                            build(path, feature, data)

    def _id(self, path: tuple[str, ...], name: str) -> str:
        return self.draft.unique(f"{self.definition.ids[path]}/{name}" if path else name)

    def _mate(self, path: tuple[str, ...], feature: Json, data: Json) -> None:
        """The first entity moves against the second: it is b."""
        assembly = self.definition.owners[path]
        name, kind = str(data.get("name", feature["id"])), data["mateType"]
        own = self._id(path, name)
        sides = [self._side(path, entity) for entity in data["matedEntities"]]
        if kind not in TYPES:
            self._other(own, name, kind, sides, feature)
            return
        word, coordinates = TYPES[kind]
        (b, frame_b), (a, frame_a) = sides[0], sides[1]
        turned = False
        if b == "ground":  # counted the other way, unless about an axis that points the other way
            (a, frame_a), (b, frame_b) = (b, frame_b), (a, frame_a)
            turned = self._cosine(sides) > 0.0
        record: Record = {
            "id": own,
            "name": name,
            "type": word,
            "a": a,
            "b": b,
            "frameA": frame_a,
            "frameB": frame_b,
        }
        stated = self.features.get(limits_question(assembly) if path else "", {}).get(feature["id"], {})
        shown = {} if path else self.values.get(feature["id"], {})
        dofs: list[Record] = []
        for coordinate, shown_as in coordinates.items():
            value = shown.get(shown_as)
            low, high = self._limits(own, coordinate, stated)
            if turned:
                value, low, high = (None if v is None else -v for v in (value, high, low))
                self.draft.turned.add((own, coordinate))
            dofs.append(freedom(coordinate, value, low, high))
        if kind == "BALL" and stated.get("limitsEnabled") and stated.get(CONE) is not None:
            self.draft.report.approximated(
                f"range of mate {own}", "CAPTURE_KIND_RAW", kind="range of a ball", program=self.draft.program
            )
        if dofs:
            record["dof"] = dofs
        if feature.get("suppressed"):
            record["suppressed"] = True
        self.joints[path, feature["id"]] = own, word
        self.draft.owners[own] = self.definition.ids[path] if path else "world"
        self.draft.joints.append(record)

    def _side(self, path: tuple[str, ...], entity: Json) -> tuple[str, Record]:
        component, inside = self.definition.component(path, entity["matedOccurrence"])
        cs = entity["matedCS"]
        return component, frame(inside, cs["origin"], cs["zAxis"], cs["xAxis"])

    def _cosine(self, sides: list[tuple[str, Record]]) -> float:
        """Of the two z axes in the world."""
        poses = {component["id"]: component["pose"] for component in self.draft.components}
        axes: list[list[float]] = []
        for component, at in sides:
            pose = poses.get(component if at["in"] == "part" else at["in"])
            rows = (
                [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)]
                if pose is None
                else [pose[k] for k in "xyz"]
            )
            axes.append([sum(z * row[n] for z, row in zip(at["z"], rows)) for n in range(3)])
        return sum(p * q for p, q in zip(*axes))

    def _limits(self, own: str, coordinate: str, stated: Json) -> tuple[float | None, float | None]:
        if not stated.get("limitsEnabled"):
            return None, None
        ends: list[float | None] = []
        for key in LIMITS[coordinate]:
            end = None
            if isinstance(expression := stated.get(key), (int, float)):
                end = float(expression)
            elif expression is not None:
                with self.draft.safely(f"limit {key} of {own}"):
                    end = quantity(str(expression))
            ends.append(end)
        return ends[0], ends[1]

    def _other(self, own: str, name: str, kind: str, sides: list[tuple[str, Record]], feature: Json) -> None:
        """A parallel mate is a constraint; what is neither is written down as it stands."""
        record: Record = {
            "id": own,
            "name": name,
            "kind": "parallel" if kind == "PARALLEL" else "other",
            "rawKind": kind,
        }
        for key, (component, at) in zip("ab", sides):
            record[key] = {
                "component": component,
                "geometry": "line",
                "in": at["in"],
                "p": at["o"],
                "d": at["z"],
            }
        if feature.get("suppressed"):
            record["suppressed"] = True
        elif kind != "PARALLEL":
            self.draft.report.approximated(
                f"mate {own}", "CAPTURE_KIND_RAW", kind=kind, program=self.draft.program
            )
        self.draft.constraints.append(record)

    def _group(self, path: tuple[str, ...], feature: Json, data: Json) -> None:
        entries = [entry.get("occurrence", entry) for entry in data["occurrences"]]
        members = list(dict.fromkeys(self.definition.component(path, entry)[0] for entry in entries))
        for member in members[1:]:
            own = self._id(path, f"{data.get('name', feature['id'])}: {member.rpartition('/')[2]}")
            record: Record = {"id": own, "type": "rigid", "a": members[0], "b": member}
            self.draft.joints.append(record | ({"suppressed": True} if feature.get("suppressed") else {}))

    def _joint_of(self, path: tuple[str, ...], mate: Json) -> tuple[str, str]:
        """Id and type of a mate that a relation names, its own or one of a sub-assembly.  Raises KeyError."""
        inside = (*path, *mate.get("occurrence", []))
        found = self.joints.get((inside, mate["featureId"]))
        return self.joints[path, mate["featureId"]] if found is None else found

    def _relation(self, path: tuple[str, ...], feature: Json, data: Json) -> None:
        """A ratio is of the first mate's travel to the second's."""
        kind = data["relationType"]
        own = self._id(path, str(data.get("name", feature["id"])))
        ends: list[Record] = []
        for mate, coordinate in zip(data["mates"], COORDINATE[kind]):
            joint, word = self._joint_of(path, mate)
            turns = word == "revolute"
            ends.append({"joint": joint, "dof": "rz" if turns else "tz" if word == "slider" else coordinate})
        if kind == "GEAR":
            ratio = -float(data["relationRatio"])
        elif kind == "LINEAR":
            ratio = float(data["relationRatio"])
        else:
            ratio = float(data["relationLength"]) / math.tau
        if ends[0]["dof"] == "tz" and ends[1]["dof"] == "rz":
            ratio = 1.0 / ratio
        record: Record = {"id": own, "kind": RELATIONS[kind], "a": ends[0], "b": ends[1], "ratio": ratio}
        record |= {"reversed": bool(data.get("reverseDirection", False))}
        self.draft.couplings.append(record | ({"suppressed": True} if feature.get("suppressed") else {}))
