"""Onshape's answers for a described assembly, as its API documents them: metres, radians, row-major transforms in the root's
frame, mate coordinate systems in the frame of the mated occurrence, limits as expressions with units."""

from __future__ import annotations

import base64
import struct
from typing import Any

import numpy as np
from cad.described import Described
from cad.documented import of_onshape

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
            of_onshape(
                "Instance", id=keys[part.id], name=part.name, type="Assembly" if part.assembly else "Part",
                suppressed=part.flags["suppressed"], elementId=f"E{part.definition}", partId="JHD", **OF,
            )
            for part in assembly.children(parent)
        ]  # fmt: skip

    occurrences = []
    for part in assembly.parts.values():
        if part.id == assembly.root:
            continue
        m = np.eye(4)
        m[:3, :3], m[:3, 3] = part.rotation, part.origin
        flags = {"fixed": part.flags["grounded"], "hidden": not part.flags["visible"]}
        occurrences.append(
            of_onshape("Occurrence", path=path(part.id), transform=m.ravel().tolist(), **flags)
        )
    features, parameters, values = [], [], []
    for number, joint in enumerate(assembly.joints):
        own = f"F{number:03d}"
        entities = []
        for end, key in (("b", "frameB"), ("a", "frameA")):  # the first selected moves against the second
            component = assembly.root if joint[end] == "ground" else joint[end]
            at, base = joint.get(key, joint["frameA"]), assembly.parts[component]
            x, z = base.turned(at["x"]), base.turned(at["z"])
            cs = of_onshape(
                "MatedCS", origin=base.local(at["o"]).tolist(), xAxis=x.tolist(), yAxis=np.cross(z, x).tolist(),
                zAxis=z.tolist(),
            )  # fmt: skip
            entities.append(of_onshape("MatedEntity", matedOccurrence=path(component), matedCS=cs))
        data = of_onshape("Mate", name=joint["id"], mateType=MATES[joint["type"]], matedEntities=entities)
        features.append(_feature(own, "mate", data))
        stated: list[tuple[str, Any]] = []
        shown = of_onshape("MateValue", featureId=own, mateName=joint["id"])
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
        listed = [
            {"parameterId": key, **({"value": value} if isinstance(value, bool) else {"expression": value})}
            for key, value in stated
        ]
        if listed:  # a field that is empty
            listed.append({"parameterId": "limitYMax", "isNull": True, "expression": ""})
        entries = [
            of_onshape("ListedParameter", message=of_onshape("Parameter", **entry)) for entry in listed
        ]
        message = of_onshape("FeatureMessage", featureId=own, parameters=entries)
        parameters.append(of_onshape("ListedFeature", typeName="BTMMate", message=message))
    numbers = {joint["id"]: f"F{number:03d}" for number, joint in enumerate(assembly.joints)}
    for number, coupling in enumerate(assembly.couplings):
        kind, ratio = RELATIONS[coupling["kind"]], coupling["ratio"]
        reverse = (ratio > 0.0) == (kind == "GEAR")
        data = of_onshape("Relation", name=coupling["id"], relationType=kind, reverseDirection=reverse)
        key, size = (
            ("relationRatio", abs(ratio))
            if kind in ("GEAR", "LINEAR")
            else ("relationLength", abs(ratio) * 2.0 * np.pi)
        )
        data[key] = size
        data["mates"] = [
            of_onshape("RelatedMate", featureId=numbers[coupling[end]["joint"]], occurrence=[])
            for end in "ab"
        ]
        features.append(_feature(f"R{number}", "mateRelation", data))
    for number, (name, members) in enumerate(assembly.values.get("groups", [])):
        held = [of_onshape("GroupMember", occurrence=path(member)) for member in members]
        features.append(_feature(f"G{number}", "mateGroup", of_onshape("Group", name=name, occurrences=held)))

    def patterns(owner: str) -> list[dict[str, Any]]:
        return [
            of_onshape(
                "Pattern", id=f"P{number}", name=name, type="LINEAR", suppressed=False,
                seedToPatternInstances={
                    keys[seed]: [keys[element[i]] for element in copies] for i, seed in enumerate(seeds)
                },
            )
            for number, (name, (seeds, *copies), *_) in enumerate(assembly.values.get("patterns", {}).get(owner, []))
        ]  # fmt: skip

    subs = [
        of_onshape(
            "Assembly", patterns=patterns(part.id), instances=instances(part.id), features=[],
            elementId=f"E{part.definition}", **OF,
        )
        for part in assembly.parts.values()
        if part.assembly and part.id != assembly.root
    ]  # fmt: skip
    root = of_onshape(
        "Assembly", instances=instances(assembly.root), occurrences=occurrences, features=features,
        patterns=patterns(assembly.root),
    )  # fmt: skip
    return {
        "definition": of_onshape("Definition", rootAssembly=root, subAssemblies=subs, parts=[]),
        "features": of_onshape("Features", features=parameters),
        "matevalues": of_onshape("MateValues", mateValues=values),
        "name": [of_onshape("Element", id="e", name=assembly.root)],
    }


def _feature(own: str, kind: str, data: dict[str, Any]) -> dict[str, Any]:
    return of_onshape("Feature", id=own, suppressed=False, featureType=kind, featureData=data)


def masses(assembly: Described, volume: float = 0.0) -> dict[str, Any]:
    """What is answered for the parts: looks of each Part Studio, mass of each part; moments SI, about the centroid."""
    found: dict[str, Any] = {}
    for part in assembly.parts.values():
        where = f"{OF['documentId']} {OF['documentMicroversion']} E{part.definition}"
        if part.mass is not None:
            found[f"mass {where} JHD default"] = weighed(
                part.mass["mass"], part.mass["center"], part.mass["inertia"], volume
            )
        if part.look is not None:
            red, green, blue, opacity = part.look["srgb"]
            color = of_onshape("Color", red=red, green=green, blue=blue)
            shown = of_onshape("Appearance", color=color, opacity=opacity)
            material = of_onshape("Material", displayName=part.look["material"])
            found[f"parts {where} - default"] = [
                of_onshape("Part", partId="JHD", appearance=shown, material=material)
            ]
    return found


def weighed(mass: float, center: np.ndarray, tensor: np.ndarray, volume: float) -> dict[str, Any]:
    """The answer on one part's mass, without a material on its volume alone."""
    body = of_onshape(
        "MassBody", hasMass=mass > 0.0, mass=[mass] * 3, volume=[volume] * 3, centroid=center.tolist() * 3,
        inertia=tensor.ravel().tolist() * 3, principalInertia=np.linalg.eigvalsh(tensor).tolist(),
    )  # fmt: skip
    return of_onshape("MassProperties", bodies={"JHD": body})


def boxed(points: np.ndarray) -> dict[str, Any]:
    """The answer on one part's bounding box."""
    ends = {"low": points.min(axis=0), "high": points.max(axis=0)}
    return of_onshape(
        "Box", **{f"{end}{axis}": float(p[i]) for end, p in ends.items() for i, axis in enumerate("XYZ")}
    )


def of_each_part(assembly: Described, kind: str, content: bytes) -> dict[str, Any]:
    """One file as the answer for every part."""
    where = f"{OF['documentId']} {OF['documentMicroversion']}"
    held = {"base64": base64.b64encode(content).decode()}
    return {
        f"{kind} {where} E{part.definition} JHD default": held
        for part in assembly.parts.values()
        if not part.assembly
    }


def boxes(assembly: Described, points: np.ndarray) -> dict[str, Any]:
    """The same box as the answer for every part."""
    where = f"{OF['documentId']} {OF['documentMicroversion']}"
    parts = [part for part in assembly.parts.values() if not part.assembly]
    return {f"box {where} E{part.definition} JHD default": boxed(points) for part in parts}


def stl(assembly: Described, points: np.ndarray, faces: list[list[int]]) -> dict[str, Any]:
    """A binary STL in metres for every part."""
    facets = b"".join(
        struct.pack("<12fH", 0.0, 0.0, 0.0, *points[face].ravel().tolist(), 0) for face in faces
    )
    return of_each_part(assembly, "stl", b" " * 80 + struct.pack("<I", len(faces)) + facets)
