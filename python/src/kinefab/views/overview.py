"""What is in a written scene, for people: its hierarchy, joints, freedoms and losses in words, and as a picture."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from ..diagnostics import diagnostic_table, printable
from ..unity.back.scene_file import read_scene, unsound_as_finding


def picture(path: Path) -> str:
    """A scene file as an SVG.  Raises KinefabError when it or its buffer cannot be read."""
    from .picture import draw

    scene, buffers = read_scene(path)
    with unsound_as_finding(path):
        return draw(scene, buffers, path.name.split(".")[0])


def overview(path: Path, as_json: bool) -> str:
    """What is in a scene file, for people or as JSON.  Raises KinefabError when it cannot be read."""
    scene, _ = read_scene(path)
    with unsound_as_finding(path):
        description = describe(scene)
        text = json.dumps(description, indent=2, ensure_ascii=False) if as_json else render(description)
        text.encode("utf-8")  # half of a surrogate pair is no text
        return text


def describe(scene: Mapping[str, Any]) -> dict[str, Any]:
    """The scene in brief: objects, joints with their freedoms, couplings, and what became of each feature."""
    from .freedoms import BODIES, freedoms_of_component, joint_name, link_above, world_placements

    objects = scene.get("gameObjects", [])
    placements = world_placements(objects)
    joints: list[dict[str, Any]] = []
    for index, entry in enumerate(objects):
        for component in entry.get("components", []):
            linked = link_above(objects, index) if component["type"] == "ArticulationBody" else None
            if component["type"].endswith("Joint") or linked is not None:
                connected = component.get("connectedBody", linked)
                joints.append(
                    {
                        "name": joint_name(component),
                        "type": component["type"],
                        "object": entry["id"],
                        "connected": None if connected is None else objects[connected]["id"],
                        "freedoms": freedoms_of_component(component, index, placements),
                        "closure": component.get("closure", False),
                        "exact": component.get("exact", True),
                        "enabled": component.get("enabled", True),
                        "because": component.get("because", []),
                    }
                )
    return {
        "generator": scene.get("generator", {}),
        "source": scene.get("source", {}),
        "objects": [
            {
                "id": entry["id"],
                "name": entry["name"],
                "parent": entry.get("parent"),
                "mass": next(
                    (c.get("mass", 1) for c in entry.get("components", []) if c["type"] in BODIES), None
                ),
                "components": [component["type"] for component in entry.get("components", [])],
            }
            for entry in objects
        ],
        "joints": joints,
        "couplings": [coupling.get("id", coupling["kind"]) for coupling in scene.get("couplings", [])],
        "mobility": scene.get("analysis", {}).get("mobility"),
        "report": list(scene.get("report", [])),
    }


def _by_hierarchy(objects: Sequence[Mapping[str, Any]]) -> Iterator[tuple[int, Mapping[str, Any]]]:
    """Objects with their depth, children under their parent; the file only has parents before children."""
    children: dict[int | None, list[int]] = {}
    for index, entry in enumerate(objects):
        children.setdefault(entry["parent"], []).append(index)
    waiting = [(0, index) for index in reversed(children.get(None, []))]
    while waiting:
        depth, index = waiting.pop()
        yield depth, objects[index]
        waiting += [(depth + 1, child) for child in reversed(children.get(index, []))]


def _losses(report: Sequence[Mapping[str, Any]]) -> Iterator[str]:
    """What is not as the source has it, each reason once, with its code and remedy; what shares one stands below it."""
    alike: dict[tuple[str, str, str], list[str]] = {}
    for entry in report:
        if entry["outcome"] != "kept":
            reason = entry["outcome"], entry.get("code", ""), entry.get("message", "")
            alike.setdefault(reason, []).append(entry["feature"])
    for (outcome, code, message), features in alike.items():
        several = len(features) > 1
        head = " ".join(filter(None, [outcome, f"{len(features)} features" if several else features[0], code]))
        said = " ".join(filter(None, [message, _remedy(code)]))
        yield f"  {head}: {said}".rstrip(": ")
        if several:
            yield from (f"    {feature}" for feature in features)


def _remedy(code: str) -> str:
    """Of a code of which no more is known; none where it takes values, which a scene does not hold, or is of another version."""
    try:
        return diagnostic_table()[code]["remedy"].format_map({})
    except KeyError:
        return ""


def render(description: Mapping[str, Any]) -> str:
    """The description as text for a terminal or a log."""
    lines: list[str] = []
    for depth, entry in _by_hierarchy(description["objects"]):
        mass = "" if entry["mass"] is None else f"  {entry['mass']:.4g} kg"
        lines.append("  " * depth + entry["name"] + mass)
    joints = len(description["joints"])
    lines += ["", f"{joints} joint{'' if joints == 1 else 's'}"]
    for joint in description["joints"]:
        freedoms = ", ".join(joint["freedoms"]) or "fixed"
        marks = (", closes a loop" if joint["closure"] else "") + ("" if joint["exact"] else ", approximated")
        marks += "" if joint["enabled"] else ", switched off"
        name = f"{joint['name']}: " if joint["name"] else ""
        lines.append(
            f"  {name}{joint['object']} -> {joint['connected'] or 'world'}: {joint['type']}, {freedoms}{marks}"
        )
    if description["couplings"]:
        lines.append("couplings: " + ", ".join(description["couplings"]))
    if description["mobility"] is not None:
        lines.append(f"mobility: {description['mobility']}")
    lines.append("")
    words = ("kept", "approximated", "dropped")
    counts = [sum(entry["outcome"] == word for entry in description["report"]) for word in words]
    lines.append(", ".join(f"{count} {word}" for count, word in zip(counts, words)))
    lines += _losses(description["report"])
    return "\n".join(map(printable, lines))
