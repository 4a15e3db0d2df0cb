"""``NAME.mates.json``: the mates as bundle constraints, for a person to read, edit, and switch on and off.

Vectors are in the scene's own frame: metres, +Y up, +Z forward, right-handed, in the world.
"""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import cast

import numpy as np

from ..diagnostics import KinefabError, Report, Severity
from ..model import Scene
from ..sources.bundle.components import Components
from ..sources.bundle.constraints import read_constraints
from ..sources.reading.file import read_bytes
from ..sources.reading.json_text import parse_json
from ..sources.reading.placement import Placement
from ..sources.reading.record import Log, Record, is_array, is_object
from ..sources.reading.source_frame import SourceFrame
from ..spatial import Array
from .apply import grounded
from .mate import AUTO, Mate, Mates, MateSide

FORMAT, VERSION = "kinefab.mates", "1.0"
TOP = frozenset("format version source sha256 frame ground groundReason threshold constraints".split())
OWN = ("number", "enabled", "confidence", "joint", "faces")
"""Fields of a mate beside those of a bundle's constraint."""


def document(scene: Scene, found: Mates, threshold: float = AUTO) -> dict[str, object]:
    """The file's values.  A mate below the threshold is written switched off."""
    return {
        "format": FORMAT,
        "version": VERSION,
        "source": scene.source.uri,
        "sha256": scene.source.sha256,
        "frame": "the scene's: metres, +Y up, +Z forward, right-handed, world",
        **(
            {}
            if found.ground is None
            else {"ground": scene.nodes[found.ground].id, "groundReason": found.ground_reason}
        ),
        "threshold": threshold,
        "constraints": [_record(scene, mate, threshold) for mate in found.mates],
    }


def text(scene: Scene, found: Mates, threshold: float = AUTO) -> str:
    """One mate a line, so that a change shows as one line."""
    values = document(scene, found, threshold)
    constraints = cast(list[object], values.pop("constraints"))
    head = json.dumps(values, indent=2, ensure_ascii=False).rstrip("}\n").rstrip()
    lines = ",\n".join("    " + json.dumps(record, ensure_ascii=False) for record in constraints)
    return (
        f'{head},\n  "constraints": [\n{lines}\n  ]\n}}\n'
        if constraints
        else f'{head},\n  "constraints": []\n}}\n'
    )


def _record(scene: Scene, mate: Mate, threshold: float) -> dict[str, object]:
    return {
        "number": mate.number,
        "enabled": mate.confidence >= threshold,
        "id": f"Mate:{mate.number}",
        "joint": mate.joint,
        "confidence": round(mate.confidence, 3),
        "rawKind": f"found: {mate.reason}",
        "kind": mate.kind.value,
        **{key: _side(scene, side) for key, side in zip("abc", mate.sides)},
        **({"value": mate.value} if mate.value else {}),
        "faces": {key: list(side.faces) for key, side in zip("abc", mate.sides)},
    }


def _side(scene: Scene, side: MateSide) -> dict[str, object]:
    values: dict[str, object] = {
        "component": scene.nodes[side.node].id,
        "geometry": side.kind.value,
        "in": "world",
    }
    values["p"] = _numbers(side.point)
    if side.direction is not None:
        values["d"] = _numbers(side.direction)
    if side.secondary is not None:
        values["x"] = _numbers(side.secondary)
    if side.radius:
        values["r"] = round(side.radius, 12)
    return values


def _numbers(vector: Array) -> list[float]:
    return [round(float(v), 12) + 0.0 for v in vector]


def opened(path: Path, report: Report) -> Record:
    """The values of a mates file, its head looked over.  Raises KinefabError where there is none, or another file."""
    if not path.exists():
        raise KinefabError([report.add("MATES_NOT_FOUND", asked=path)])
    values = parse_json(read_bytes(path, report), path.name, report)
    log = Log(report, path.name)
    if not is_object(values):
        log.add("BUNDLE_NOT_OBJECT", "")
        raise KinefabError(report.of(Severity.ERROR))
    record = Record(values, "", log, TOP)
    if (name := record.text("format")) != FORMAT and name:
        record.fault("BUNDLE_FORMAT", "format", found=name, wanted=FORMAT)
    version = record.text("version")
    if version and re.fullmatch(r"1\.\d{1,6}", version) is None:
        record.fault("BUNDLE_VERSION", "version", found=version[:20], known="1.x")
    if not record.has("constraints"):
        record.fault("BUNDLE_FIELD_MISSING", field="constraints")
    report.raise_for_errors()
    return record


def listed(path: Path, report: Report) -> dict[str, object]:
    """The values of a mates file, each mate with a number to be listed by.  Raises KinefabError where that is not so."""
    record = opened(path, report)
    mates = record.values["constraints"]
    if not (is_array(mates) and all(is_object(mate) and type(mate.get("number")) is int for mate in mates)):
        record.wrong("constraints", "an array of mates with their numbers", mates)
    report.raise_for_errors()
    return record.values


def with_file(scene: Scene, path: Path, report: Report) -> Scene:
    """The scene with the enabled mates of a file.  Raises KinefabError with every error found in it."""
    record = opened(path, report)
    log, digest = record.log, record.text("sha256", "")
    if digest and scene.source.sha256 and digest != scene.source.sha256:
        log.add("MATES_OF_OTHER_SOURCE", "/sha256", source=record.text("source", ""))
    components = _components(scene)
    ground = components.find(record, "ground", "the ground") if record.has("ground") else -1
    threshold = record.number("threshold", AUTO)
    constraints = _plain(record.values["constraints"], threshold, log)
    bundle = Record({"constraints": constraints}, "", log, frozenset({"constraints"}))
    constraints = read_constraints(bundle, components, SourceFrame(), log)
    report.raise_for_errors()
    for constraint in constraints:
        if not constraint.suppressed:
            report.approximated(
                f"mate {constraint.id}",
                "MATE_FROM_FILE",
                constraint.where,
                id=constraint.id,
                reason=constraint.raw_kind,
            )
    scene = replace(scene, constraints=[*scene.constraints, *constraints])
    return grounded(scene, None if ground < 0 else ground, (), report, "named in the mates")


def _plain(constraints: object, threshold: float, log: Log) -> object:
    """The constraints without the fields that a bundle does not know; what is not enabled is suppressed, and where that is not
    said, what is less sure than the threshold."""
    if not is_array(constraints):
        return constraints
    found: list[object] = []
    for number, entry in enumerate(constraints):
        if is_object(entry):
            own = {key: value for key, value in entry.items() if key in OWN}
            record = Record(own, f"/constraints/{number}", log, frozenset(OWN))
            confidence = record.number("confidence", 1.0)
            enabled = record.flag("enabled", confidence >= threshold)
            kept = {key: value for key, value in entry.items() if key not in OWN}
            entry = kept if enabled else {**kept, "suppressed": True}
        found.append(entry)
    return found


def _components(scene: Scene) -> Components:
    """The scene's nodes as the bundle's reader has components, in the scene's own frame."""
    count = len(scene.nodes)
    eye = np.eye(3)
    placement = Placement(
        rotations=np.array([*(node.pose.rotation for node in scene.nodes), eye]),
        translations=np.array([*(node.pose.translation for node in scene.nodes), np.zeros(3)]),
        local=np.repeat(eye[None], count + 1, axis=0),
        deviation=np.zeros(count),
        mirrored=np.zeros(count, dtype=bool),
        length=1.0,
    )
    return Components(scene.nodes, {node.id: i for i, node in enumerate(scene.nodes)}, placement)
