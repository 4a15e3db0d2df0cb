"""Everything that the page shows of a scene and its motion, as plain data."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...model import FREEDOM_NAMES, Joint
from ...spatial import Array, Pose
from ...unity.back.terms import terms_of
from ..extent import ends_in_sight, span_of
from ..freedoms import counted, world_placements
from ..seen import shown
from .blob import Blob
from .joints import coordinate_labels, joint_entry
from .meshes import packed_meshes
from .parts import material_entry, part_entry, rows

Entry = Mapping[str, Any]
_ARRAYS = {"values": "f8", "rotations": "f4", "shifts": "f8", "center": "f8", "length": "f8"}
_ATOMS = {"kind": "i4", "row": "i4", "body_a": "i4", "body_b": "i4"}


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """What moves, as plain data, right-handed, metres and radians.

    bodies: how many, 0 being the world.  body_of: of each GameObject.  poses: of the GameObjects in the closed pose;
    scales: their sizes.  joints: of the components, by (GameObject, component), with their ends' bodies and world frames.
    coordinates: name, (joint id, freedom, value, lower, upper).  blocks: roots first (``analysis/driving/baking.py``).
    """

    bodies: int
    body_of: Sequence[int]
    poses: Sequence[Pose]
    scales: Sequence[Array]
    joints: Mapping[tuple[int, int], tuple[Joint, tuple[int, int], tuple[Pose, Pose]]]
    coordinates: Mapping[str, tuple[str, int, float, float, float]]
    blocks: Sequence[Entry]
    mobility: int


def description(
    document: Entry, buffers: Sequence[bytes], motion: Motion, title: str, blob: Blob
) -> dict[str, Any]:
    """What ``app.js`` reads.  document: a parsed ``.kinefab``; buffers: the bytes of its buffers."""
    objects: Sequence[Entry] = document["gameObjects"]
    meshes: Sequence[Entry] = document.get("meshes", ())
    placed = zip(objects, motion.body_of, motion.poses, motion.scales, shown(objects))
    parts = [part_entry(o, body, rows(pose, scale), seen, meshes) for o, body, pose, scale, seen in placed]
    used = [p["mesh"] for p in parts if p["mesh"] is not None]
    used += [shape["mesh"] for p in parts for shape in p["colliders"] if shape["kind"] == "mesh"]
    packed, (total, kept) = packed_meshes(document, buffers, used, blob)
    names = {(joint, freedom): name for name, (joint, freedom, *_) in motion.coordinates.items()}
    placements = world_placements(objects)
    joints: list[dict[str, Any]] = []
    place: dict[tuple[int, int], int] = {}
    by_joint: dict[str, int] = {}
    labels: dict[str, str] = {}
    for (index, i), (joint, ends, world) in motion.joints.items():
        place[index, i] = by_joint[joint.id] = len(joints)
        component = objects[index]["components"][i]
        entry = joint_entry(component, index, joint, ends, world, names, document, placements)
        joints.append(entry)
        carriers = (objects[index]["name"], dict(entry["fields"])["connectedBody"])
        carriers = carriers if motion.body_of[index] == ends[0] else carriers[::-1]
        labels |= coordinate_labels(joint, entry["label"], carriers, names)
    notices: list[str] = []
    if kept < total:
        notices.append(f"Thinned out: {kept:,} of {total:,} triangles are shown.")
    if not parts:
        notices.append("This scene is empty.")
    elif not used:
        notices.append("This scene has no meshes: parts are drawn as bars between their joints.")
    islands, island_of = _islands(document, motion)
    return {
        "title": title,
        "subtitle": _subtitle(document, joints, motion),
        "mobility": f"– {motion.mobility} in all" if motion.mobility else "",
        "notices": notices,
        "parts": parts,
        "meshes": packed,
        "materials": [material_entry(m) for m in document.get("materials", ())],
        "bodyCount": motion.bodies,
        "joints": joints,
        "couplings": _couplings(document, place, joints),
        "coordinates": _coordinates(motion, labels, by_joint, span_of(document)),
        "blocks": [_block(block, blob) for block in motion.blocks],
        "islands": islands,
        "islandOf": island_of,
        "facts": _facts(document, joints, motion),
        "report": _report(document, joints),
        "look": _look(motion),
    }


def _subtitle(document: Entry, joints: Sequence[Entry], motion: Motion) -> str:
    uri = document.get("source", {}).get("uri", "")
    words = [*counted(document["gameObjects"], joints), f"mobility {_mobility(document, motion)}"]
    return " · ".join([uri, *words] if uri else words)


def _mobility(document: Entry, motion: Motion) -> Any:
    """As the file counts it, with bodies that no joint holds; else what the joints leave."""
    return document.get("analysis", {}).get("mobility", motion.mobility)


def _coordinates(
    motion: Motion, labels: Mapping[str, str], by_joint: Mapping[str, int], span: float
) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name, (joint, freedom, value, lower, upper) in motion.coordinates.items():
        turns = FREEDOM_NAMES[freedom].startswith("r")
        if not turns:
            lower, upper = ends_in_sight(value, lower, upper, span)
        found[name] = {
            "label": labels.get(name, name),
            "unit": "deg" if turns else "m",
            "value": value,
            "lower": lower if math.isfinite(lower) else None,
            "upper": upper if math.isfinite(upper) else None,
            "joint": by_joint.get(joint),
            "size": 0.5 * span,
        }
    return found


def _block(block: Entry, blob: Blob) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name, value in block.items():
        if name in ("system", "probe"):
            found[name] = {
                key: v if key == "rows" else blob.add(v, _ATOMS.get(key, "f8")) for key, v in value.items()
            }
        else:
            found[name] = blob.add(value, _ARRAYS[name]) if name in _ARRAYS else value
    return found


def _couplings(
    document: Entry, place: Mapping[tuple[int, int], int], joints: Sequence[Entry]
) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = []
    for coupling in document.get("couplings", ()):
        terms = terms_of(coupling)
        sides = [*(end for end, _ in terms), coupling["b"]]
        ends = [place[at] for end in sides if (at := (end["gameObject"], end["component"])) in place]
        if len(ends) < len(sides):
            continue
        *names, driven = [joints[i]["label"].split(" – ")[0] for i in ends]
        text = f"{driven} = " + " + ".join(f"{ratio:g} × {name}" for (_, ratio), name in zip(terms, names))
        found.append({"kind": coupling.get("kind", "coupling"), "text": text, "joints": ends})
    return found


def _islands(document: Entry, motion: Motion) -> tuple[list[Entry], list[int | None]]:
    """The analysis' islands, and the one that each body is in."""
    islands: list[Entry] = [
        {k: island.get(k) for k in ("mobility", "redundant", "loops")} | {"objects": island["gameObjects"]}
        for island in document.get("analysis", {}).get("islands", ())
    ]
    of: list[int | None] = [None] * motion.bodies
    for i, island in enumerate(islands):
        for index in island["objects"]:
            of[motion.body_of[index]] = i
    of[0] = None
    return islands, of


def _facts(document: Entry, joints: Sequence[Entry], motion: Motion) -> list[tuple[str, str]]:
    analysis = document.get("analysis", {})
    islands: Sequence[Entry] = analysis.get("islands", ())
    closing = sum(j["closure"] for j in joints)
    facts = [
        ("objects", str(len(document["gameObjects"]))),
        ("joints", f"{len(joints)}, {closing} of them closing loops" if closing else str(len(joints))),
        ("mobility", str(_mobility(document, motion))),
    ]
    if analysis:
        facts.append(("redundant rows", str(analysis.get("redundant", 0))))
        if analysis.get("idle"):
            facts.append(("idle spins", str(analysis["idle"])))
    if islands:
        counts = (
            f"{i.get('mobility')} free"
            + (f", {n} loop{'s' if n > 1 else ''}" if (n := i.get("loops", 0)) else "")
            for i in islands
        )
        facts.append(("islands", "; ".join(counts) if len(islands) <= 8 else str(len(islands))))
    if document.get("couplings"):
        facts.append(("couplings", str(len(document["couplings"]))))
    return facts


def _report(document: Entry, joints: Sequence[Entry]) -> list[dict[str, Any]]:
    """The loss report, each entry with the parts and joints that it speaks of."""
    objects: Sequence[Entry] = document["gameObjects"]
    part_of = {o["id"]: i for i, o in enumerate(objects)}
    joints_of: dict[str, list[int]] = {}
    for i, joint in enumerate(joints):
        for reason in joint["because"]:
            joints_of.setdefault(reason["id"], []).append(i)
    features = {c.get("id"): c.get("features", ()) for c in document.get("constraints", ())}
    found: list[dict[str, Any]] = []
    for entry in document.get("report", ()):
        feature = str(entry.get("feature", ""))
        ids = _subjects(feature)
        owners = (name for id in ids for name in (id, id.rpartition("/")[0]))
        parts = {part_of[name] for name in owners if name in part_of}
        sides = (f.get("gameObject") for id in ids for f in features.get(id, ()))
        parts |= {side for side in sides if side is not None}
        of_joints = sorted({i for id in ids for i in joints_of.get(id, ())})
        keys = ("outcome", "severity", "code", "message", "source")
        told = {key: str(entry[key]) for key in keys if key in entry}
        found.append(told | {"feature": feature, "parts": sorted(parts), "joints": of_joints})
    return found


def _subjects(feature: str) -> set[str]:
    """The ids that a feature may speak of: ``joint Knee``, ``name of Top/Base``, ``friction of joint Knee, rx``."""
    owner = feature.rpartition(" of ")[2]
    ids = {feature, feature.partition(" ")[2], owner, owner.partition(" ")[2]}
    return ids | {id.rpartition(", ")[0] for id in ids} - {""}


def _look(motion: Motion) -> list[float]:
    """Towards the eye: mostly along the axis that most turns share, tilted, so that planar linkages lie open."""
    axes = [
        world[0].rotation[:, joint.unlocked[0] % 3]
        for joint, _, world in motion.joints.values()
        if len(joint.unlocked) == 1 and joint.unlocked[0] >= 3
    ]
    up = np.array([0.0, 1.0, 0.0])
    main = np.linalg.svd(np.array(axes))[2][0] if axes else np.array([0.25, 0.45, 1.0])
    main = main / np.linalg.norm(main)
    if main @ np.array([0.3, 1.0, 0.6]) < 0:
        main = -main
    lift = up if abs(main[1]) < 0.9 else np.array([0.0, 0.0, 1.0])
    lift = lift - main * (main @ lift)
    lift = lift / np.linalg.norm(lift)
    return (main + 0.62 * lift + 0.45 * np.cross(lift, main)).tolist()
