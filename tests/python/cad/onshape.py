"""Onshape's answers for a described assembly, as its API documents them: metres, radians, row-major transforms in the root's
frame, mate coordinate systems in the frame of the mated occurrence, limits as expressions with units."""

from __future__ import annotations

import base64
import struct
from typing import Any

import numpy as np
from cad.described import Described

MATES = {
    "rigid": "FASTENED", "revolute": "REVOLUTE", "slider": "SLIDER", "cylindrical": "CYLINDRICAL",
    "pin_slot": "PIN_SLOT", "planar": "PLANAR", "ball": "BALL",
}  # fmt: skip
LIMITS = {"tz": ("limitZMin", "limitZMax"), "rz": ("limitAxialZMin", "limitAxialZMax")}
VALUES = {"tz": "translationZ", "rz": "rotationZ", "tx": "translationX", "ty": "translationY"}
RELATIONS = {"gear": "GEAR", "rack": "RACK_AND_PINION", "screw": "SCREW", "linear": "LINEAR"}
OF = {"documentId": "d" * 24, "documentMicroversion": "m" * 24, "configuration": "default"}


def answers(assembly: Described, unit: str = "mm") -> dict[str, Any]:
    """definition, features and matevalues.  unit: of the limits' lengths; angles are in degrees."""
    keys: dict[str, str] = {}
    inside: dict[tuple[str, str], str] = {}
    for number, part in enumerate(
        assembly.parts.values()
    ):  # all occurrences of an assembly hold the same instances
        owner = part.parent if part.parent in ("", assembly.root) else assembly.parts[part.parent].definition
        keys[part.id] = inside.setdefault((owner, part.name), f"I{number:03d}")

    def path(component: str) -> list[str]:
        found: list[str] = []
        while component != assembly.root:
            found.insert(0, keys[component])
            component = assembly.parts[component].parent
        return found

    def instances(parent: str) -> list[dict[str, Any]]:
        return [
            {
                "id": keys[part.id], "name": part.name, "type": "Assembly" if part.assembly else "Part",
                "suppressed": part.flags["suppressed"], "elementId": f"E{part.definition}", "partId": "JHD", **OF,
            }
            for part in assembly.children(parent)
        ]  # fmt: skip

    occurrences = []
    for part in assembly.parts.values():
        if part.id == assembly.root:
            continue
        m = np.eye(4)
        m[:3, :3], m[:3, 3] = part.rotation, part.origin
        occurrences.append(
            {
                "path": path(part.id),
                "transform": m.ravel().tolist(),
                "fixed": part.flags["grounded"],
                "hidden": not part.flags["visible"],
            }
        )
    features, parameters, values = [], [], []
    for number, joint in enumerate(assembly.joints):
        own = f"F{number:03d}"
        entities = []
        for end, key in (("b", "frameB"), ("a", "frameA")):  # the first selected moves against the second
            at, base = joint.get(key, joint["frameA"]), assembly.parts[joint[end]]
            x, z = base.turned(at["x"]), base.turned(at["z"])
            cs = {
                "origin": base.local(at["o"]).tolist(),
                "xAxis": x.tolist(),
                "yAxis": np.cross(z, x).tolist(),
                "zAxis": z.tolist(),
            }
            entities.append({"matedOccurrence": path(joint[end]), "matedCS": cs})
        data = {"name": joint["id"], "mateType": MATES[joint["type"]], "matedEntities": entities}
        features.append({"id": own, "suppressed": False, "featureType": "mate", "featureData": data})
        stated: list[tuple[str, Any]] = []
        shown: dict[str, Any] = {"featureId": own, "mateName": joint["id"]}
        for dof in joint.get("dof", []):
            if "value" in dof:
                shown[VALUES[dof["name"]]] = dof["value"]
            if dof["name"] in LIMITS:
                scale, word = (
                    ({"mm": 1000.0, "in": 1 / 0.0254}[unit], unit)
                    if dof["name"][0] == "t"
                    else (180.0 / np.pi, "deg")
                )
                for end, key in zip(("min", "max"), LIMITS[dof["name"]]):
                    if end in dof:
                        stated.append((key, f"{dof[end] * scale!r} {word}"))
                if "min" in dof or "max" in dof:
                    stated.append(("limitsEnabled", bool(dof.get("minEnabled") or dof.get("maxEnabled"))))
        values.append(shown)
        parameters.append({"typeName": "BTMMate", "message": {"featureId": own, "parameters": [
            {"message": {"parameterId": key, **({"value": value} if isinstance(value, bool) else {"expression": value})}} for key, value in stated
        ]}})  # fmt: skip
    numbers = {joint["id"]: f"F{number:03d}" for number, joint in enumerate(assembly.joints)}
    for number, coupling in enumerate(assembly.couplings):
        kind, ratio = RELATIONS[coupling["kind"]], coupling["ratio"]
        data = {
            "name": coupling["id"],
            "relationType": kind,
            "reverseDirection": (ratio > 0.0) == (kind == "GEAR"),
        }
        key, size = (
            ("relationRatio", abs(ratio))
            if kind in ("GEAR", "LINEAR")
            else ("relationLength", abs(ratio) * 2.0 * np.pi)
        )
        data[key] = size
        data["mates"] = [{"featureId": numbers[coupling[end]["joint"]], "occurrence": []} for end in "ab"]
        features.append(
            {"id": f"R{number}", "suppressed": False, "featureType": "mateRelation", "featureData": data}
        )

    def patterns(owner: str) -> list[dict[str, Any]]:
        return [
            {
                "id": f"P{number}", "name": name, "type": "LINEAR", "suppressed": False,
                "seedToPatternInstances": {
                    keys[seed]: [keys[element[i]] for element in copies] for i, seed in enumerate(seeds)
                },
            }
            for number, (name, (seeds, *copies), *_) in enumerate(assembly.values.get("patterns", {}).get(owner, []))
        ]  # fmt: skip

    subs = [
        {
            "patterns": patterns(part.id),
            "instances": instances(part.id),
            "features": [],
            "elementId": f"E{part.definition}",
            **OF,
        }
        for part in assembly.parts.values()
        if part.assembly and part.id != assembly.root
    ]
    return {
        "definition": {
            "rootAssembly": {"instances": instances(assembly.root), "occurrences": occurrences, "features": features,
                             "patterns": patterns(assembly.root)},
            "subAssemblies": subs, "parts": [],
        },
        "features": {"features": parameters},
        "matevalues": {"mateValues": values},
        "name": [{"id": "e", "name": assembly.root}],
    }  # fmt: skip


def masses(assembly: Described) -> dict[str, Any]:
    """What is answered for the parts: looks of each Part Studio, mass of each part; moments SI, about the centroid."""
    found: dict[str, Any] = {}
    for part in assembly.parts.values():
        where = f"{OF['documentId']} {OF['documentMicroversion']} E{part.definition}"
        if part.mass is not None:
            tensor = part.mass["inertia"]
            body = {
                "hasMass": True, "mass": [part.mass["mass"]] * 3, "centroid": part.mass["center"].tolist() * 3,
                "inertia": tensor.ravel().tolist() * 3, "principalInertia": np.linalg.eigvalsh(tensor).tolist(),
            }  # fmt: skip
            found[f"mass {where} JHD default"] = {"bodies": {"JHD": body}}
        if part.look is not None:
            red, green, blue, opacity = part.look["srgb"]
            shown = {"color": {"red": red, "green": green, "blue": blue}, "opacity": opacity}
            entry = {"partId": "JHD", "appearance": shown, "material": {"displayName": part.look["material"]}}
            found[f"parts {where} - default"] = [entry]
    return found


def stl(assembly: Described, points: np.ndarray, faces: list[list[int]]) -> dict[str, Any]:
    """A binary STL in metres for every part."""
    facets = b"".join(
        struct.pack("<12fH", 0.0, 0.0, 0.0, *points[face].ravel().tolist(), 0) for face in faces
    )
    content = base64.b64encode(b" " * 80 + struct.pack("<I", len(faces)) + facets).decode()
    where = f"{OF['documentId']} {OF['documentMicroversion']}"
    parts = [part for part in assembly.parts.values() if not part.assembly]
    return {f"stl {where} E{part.definition} JHD default": {"base64": content} for part in parts}
