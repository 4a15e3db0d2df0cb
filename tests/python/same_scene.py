"""Exported scenes of one mechanism in several formats, held against each other number by number."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import kinefab
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

CLOSE = 1e-9
UNMOVING = {
    *("extras", "secondaryAxis", "closure", "because", "id", "name", "part", "connectedPart"),
    *("effort", "speed", "friction", "armature", "stated"),  # URDF asks for them, the others do without
}


def exported(path: Path, folder: Path) -> dict:
    target = kinefab.export(path, folder / f"{path.name}.kinefab").path
    return json.loads(target.read_text(encoding="utf-8"))


def plain(document: dict, without: set[str]) -> dict[str, object]:
    """What a scene says by the object's id: its place, its body, its joints by the source's name of them."""
    found: dict[str, object] = {}
    objects = document["gameObjects"]
    for entry in objects:
        found[entry["id"]] = entry.get("transform", {})
        parent = entry.get("parent")
        found[f"{entry['id']} parent"] = None if parent is None else objects[parent]["id"]
        for component in entry.get("components", ()):
            if not without.intersection(component.get("because", ())):
                name = "".join(component.get("because", ()))
                found[f"{entry['id']} {component['type']} {name}"] = stripped(component, objects)
    for coupling in document.get("couplings", ()):
        name = coupling["id"].rpartition(":")[2].rpartition("/")[2]  # SDF's ids name the model too
        ratios = [term["ratio"] for term in coupling["terms"]] if "terms" in coupling else [coupling["ratio"]]
        found[f"coupling of {name}"] = {"ratios": ratios, "offset": coupling.get("offset", 0.0)}
    return found


def stripped(component: dict, objects: list[dict]) -> dict[str, object]:
    """Without what no motion depends on: the source's own words, and where a slide's second axis points to."""
    kept = {k: v for k, v in component.items() if k not in UNMOVING}
    if "connectedBody" in kept:
        kept["connectedBody"] = objects[kept["connectedBody"]]["id"]
    return kept


def compare(one: object, other: object, where: str, close: float = CLOSE) -> None:
    if isinstance(one, dict) and isinstance(other, dict):
        assert one.keys() == other.keys(), where
        for key, value in one.items():
            compare(value, other[key], f"{where}/{key}", close)
    elif isinstance(one, (list, tuple)) and isinstance(other, (list, tuple)):
        assert np.allclose(one, other, rtol=close, atol=close), f"{where}: {one}, {other}"
    elif isinstance(one, float) or isinstance(other, float):
        assert one == pytest.approx(other, rel=close, abs=close), where
    else:
        assert one == other, where


def undrawn(document: dict) -> dict[str, object]:
    """As ``plain``, without what is drawn and touched; inertias as tensors, whose axes may be any where moments are equal."""
    left = {"MeshFilter", "MeshRenderer", "MeshCollider"}
    found = {key: value for key, value in plain(document, set()).items() if not left & set(key.split())}
    for value in found.values():
        if isinstance(value, dict) and "inertiaTensor" in value:
            moments, turn = (
                value.pop("inertiaTensor"),
                value.pop("inertiaTensorRotation", [0.0, 0.0, 0.0, 1.0]),
            )
            axes = Rotation.from_quat(turn).as_matrix()
            value["relative tensor"] = (axes @ np.diag(moments) @ axes.T / max(moments)).ravel().tolist()
            value["largest moment"] = float(np.log(max(moments)))
    return found


def value_paths(value: object, place: tuple = ()) -> Iterator[tuple]:
    """The keys that lead to every value within a JSON value."""
    if place:
        yield place
    entries = (
        value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    )
    for key, inner in entries:
        yield from value_paths(inner, (*place, key))
