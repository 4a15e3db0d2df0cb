"""The joint components of a scene for the page: where they are, what they leave free, what they came from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, cast

import numpy as np

from ...model import FREEDOM_NAMES, RX, Joint, JointKind, Motion
from ...spatial import Pose
from ..freedoms import Placement, freedoms_of_component
from .parts import rows

Entry = Mapping[str, Any]
_HIDDEN = ("type", "because", "closure", "connectedBody")


def joint_entry(
    component: Entry,
    index: int,
    joint: Joint,
    bodies: tuple[int, int],
    world: tuple[Pose, Pose],
    names: Mapping[tuple[str, int], str],
    document: Entry,
    placements: Sequence[Placement],
) -> dict[str, Any]:
    """index: of the object that carries the component.  bodies, world: of a's and b's side, numbers and joint frames.

    names: of the mechanism's coordinates, by joint id and freedom.
    """
    objects = document["gameObjects"]
    other = component.get("connectedBody")
    connected = "the world" if other is None else objects[other]["name"]
    ends = f"{objects[index]['name']} – {connected}"
    words = ", ".join(freedoms_of_component(component, index, placements)) or "nothing moves"
    return {
        "type": component["type"],
        "label": f"{joint.name}: {ends}" if joint.name else ends,
        "words": words[0].upper() + words[1:] + ".",
        "kind": joint.kind.value.replace("_", " "),
        "a": bodies[0],
        "b": bodies[1],
        "at": rows(world[0]),
        "atB": rows(world[1]),
        "freedoms": [_freedom(joint, i, names) for i in joint.unlocked]
        if joint.kind is not JointKind.FREE
        else [],
        "closure": bool(component.get("closure", False)),
        "because": [_reason(str(source), document) for source in component.get("because", ())],
        "fields": [("on", objects[index]["id"]), ("connectedBody", connected)]
        + [(name, shown(value)) for name, value in component.items() if name not in _HIDDEN],
    }


def _freedom(joint: Joint, i: int, names: Mapping[tuple[str, int], str]) -> dict[str, Any]:
    own = joint.freedoms[i]
    limited = own.motion is Motion.LIMITED and np.isfinite([own.lower, own.upper]).all()
    return {
        "index": i,
        "name": names.get((joint.id, i)),
        "lower": own.lower if limited else None,
        "upper": own.upper if limited else None,
    }


def _reason(source: str, document: Entry) -> dict[str, str]:
    """A constraint or joint of the source, in words."""
    for constraint in document.get("constraints", ()):
        if constraint.get("id") == source:
            sides = (
                "ground" if f.get("gameObject") is None else document["gameObjects"][f["gameObject"]]["name"]
                for f in constraint.get("features", ())
            )
            what = str(constraint.get("kind", "constraint")).replace("_", " ")
            return {"id": source, "text": f"{what} of {' and '.join(sides)}"}
    return {"id": source, "text": "a joint of the source"}


def shown(value: Any) -> str:
    """A field's value as one would type it."""
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, (int, float)):
        return f"{value:.6g}"
    if isinstance(value, list):
        return "(" + ", ".join(shown(v) for v in cast("list[Any]", value)) + ")"
    if isinstance(value, dict):
        return ", ".join(f"{k} {shown(v)}" for k, v in cast("dict[str, Any]", value).items())
    return str(value)


def coordinate_labels(
    joint: Joint, label: str, carriers: tuple[str, str], names: Mapping[tuple[str, int], str]
) -> dict[str, str]:
    """What the sliders of a joint are called, by the names of its coordinates.

    label: the joint's.  carriers: names of a and b.  Of two turns one is about an axis that b carries and one about one that
    a carries, as a universal joint has them (``model.JointKind``).
    """
    moving = [i for i in joint.unlocked if (joint.id, i) in names]
    found: dict[str, str] = {}
    for i in moving:
        alike = [k for k in joint.unlocked if (k >= RX) == (i >= RX)]
        word = "turn" if i >= RX else "slide"
        if i >= RX and len(alike) == 2:
            word += f" about {carriers[1] if i == alike[0] else carriers[0]}'s axis"
        elif len(alike) > 1:
            word += f" {FREEDOM_NAMES[i][1].upper()}"
        found[names[joint.id, i]] = label if len(moving) == 1 else f"{label}, {word}"
    return found
