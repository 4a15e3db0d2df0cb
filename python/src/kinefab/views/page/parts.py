"""The GameObjects of a scene for the page: what is drawn of each, and the shapes of its colliders."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ...spatial import Array, Pose, rotation_about
from ...unity import frames
from ..freedoms import BODIES

Entry = Mapping[str, Any]
_AXES = {"X": (2, -0.5 * np.pi), "Y": (2, 0.0), "Z": (0, 0.5 * np.pi)}
"""By a capsule's direction the turn (axis, angle) that takes Y to it."""


def rows(pose: Pose, scale: Array | None = None) -> list[float]:
    """A pose as twelve numbers, rows of 3 x 4; the scale along the part's own axes."""
    turn = pose.rotation if scale is None else pose.rotation * scale
    return np.column_stack([turn, pose.translation]).ravel().tolist()


def part_entry(
    entry: Entry, body: int, place: list[float], seen: bool, meshes: Sequence[Entry]
) -> dict[str, Any]:
    """place: the object's world pose as ``rows`` has it.  body: the number of what it moves with.  seen: whether Unity shows it."""
    components: Sequence[Entry] = entry.get("components", ())
    by_type = {c["type"]: c for c in components}
    renderer = by_type.get("MeshRenderer", {})
    mesh = by_type.get("MeshFilter", {}).get("mesh")
    return {
        "id": entry["id"],
        "name": entry["name"],
        "parent": entry.get("parent"),
        "body": body,
        "pose": place,
        "mesh": mesh,
        "materials": list(renderer.get("materials", ())),
        "shown": seen,
        "colliders": [shape for c in components if (shape := collider(c)) is not None],
        "facts": _facts(components, meshes),
    }


def _facts(components: Sequence[Entry], meshes: Sequence[Entry]) -> list[tuple[str, str]]:
    facts: list[tuple[str, str]] = []
    for c in components:
        if c["type"] in BODIES:
            facts.append(("mass", f"{c.get('mass', 1):g} kg"))
            if c.get("isKinematic", False):
                facts.append(("kinematic", "yes"))
        elif c["type"] == "MeshFilter":
            mesh = meshes[int(c["mesh"])]
            count = sum(int(s["indexCount"]) for s in mesh["submeshes"]) // 3
            facts.append(("mesh", f"{mesh['name']}, {count} triangles"))
        elif c["type"] not in ("MeshRenderer", "Transform"):
            facts.append(("has", c["type"]))
    return facts or [("has", "no component of its own")]


def collider(component: Entry) -> dict[str, Any] | None:
    """A collider's shape in its object's frame, right-handed, or None where the component is none."""
    kind = component["type"]
    center: Array = frames.point(np.array(component.get("center", (0, 0, 0)), dtype=np.float64))
    if kind == "BoxCollider":
        return {
            "kind": "box",
            "size": list(component.get("size", (1, 1, 1))),
            "at": rows(Pose(np.eye(3), center)),
        }
    if kind == "SphereCollider":
        shape = {"kind": "sphere", "radius": component.get("radius", 0.5)}
        return shape | {"at": rows(Pose(np.eye(3), center))}
    if kind == "CapsuleCollider":
        axis, angle = _AXES[component.get("direction", "Y")]
        shape = {
            "kind": "capsule",
            "radius": component.get("radius", 0.5),
            "height": component.get("height", 2),
        }
        return shape | {"at": rows(Pose(rotation_about(np.eye(3)[axis], angle), center))}
    if kind == "MeshCollider" and component.get("mesh") is not None:
        return {"kind": "mesh", "mesh": component["mesh"], "at": rows(Pose())}
    return None


def material_entry(material: Entry) -> dict[str, Any]:
    color = [float(x) for x in material.get("color", (1, 1, 1, 1))]
    return {"color": (color + [1.0])[:4], "smoothness": float(material.get("smoothness", 0.5))}
