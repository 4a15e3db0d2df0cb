"""Assemblies of the Fusion 360 Gallery dataset; they become a bundle's records.  Lengths are centimetres, angles radians.

Source: the dataset's page on assemblies, and the sample in its repository; the words are those of Fusion's API.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from ...diagnostics import Report
from ...model import IN_BRACKETS, Body, FreeIds, Scene
from ..bundle.reader import scene_from_values
from ..reading.file import read_bytes
from ..reading.json_text import parse_json, top_keys
from ..reading.record import is_array, is_object, shown
from ..reading.request import Request
from .joints import joint_record
from .tree import Record, Tree
from .values import BadValueError, needed, objects

TOLD = {"contacts": "faces in contact", "holes": "hole features"}
"""Lists that state no motion."""


def sniff(head: bytes) -> bool:
    """Whether a JSON begins as such an assembly: a bundle has lists where this has objects by uuid."""
    keys = top_keys(head)
    return any(
        keys.get(key) == "{" for key in ("tree", "occurrences", "as_built_joints", "bodies", "components")
    )


def read(path: Path, report: Report, request: Request = Request()) -> Scene:
    """The scene of an ``assembly.json``.  request: ``up``.  Raises KinefabError with every error found."""
    data = read_bytes(path, report)
    values = parse_json(data, path.name, report)
    tree = Tree(values if is_object(values) else {}, path, report)
    joints, places = _joints(tree)
    for key, words in TOLD.items():
        listed = tree.values.get(key)
        if is_array(listed) and listed:
            told = f"{len(listed)} {words}"
            report.dropped(told, "GALLERY_LEFT_OUT", f"{path.name}#/{key}", reason="they state no motion")
    bundle: dict[str, object] = {
        "meta": {
            "format": "kinefab.bundle",
            "version": "1.0",
            "units": {"length": "cm", "angle": "rad", "mass": "kg"},
            "up": request.text("up", "Z"),
            "mesh": {"units": "cm", "layout": "per_body", "coordinates": "part"},
        },
        "components": tree.components,
        "joints": joints,
    }
    scene = scene_from_values(bundle, path, data, report, {**tree.places, **places})
    for index, node in enumerate(scene.nodes):
        scene.nodes[index] = replace(
            node, bodies=tuple(_settled(body, node.id, tree) for body in node.bodies)
        )
    return scene


def _settled(body: Body, node: str, tree: Tree) -> Body:
    """A body whose file is bad is told, and the part moves without it."""
    reference = None if body.reference is None else replace(body.reference, needed=False)
    return replace(body, reference=reference, visible=(node, body.name) not in tree.hidden)


def _joints(tree: Tree) -> tuple[list[Record], dict[str, str]]:
    """Records with ids of their own, and where each stands."""
    found: list[Record] = []
    places: dict[str, str] = {}
    free_ids = FreeIds(form=IN_BRACKETS)
    for group in ("joints", "as_built_joints"):
        for key, value in objects(tree.values.get(group)).items():
            place = f"/{group}/{shown(key)}"
            try:
                record = joint_record(tree, needed(value, "record"), group != "joints")
            except BadValueError as error:
                feature = f"joint {shown(str(objects(value).get('name', key)))}"
                where = f"{tree.path.name}#{place}"
                tree.report.dropped(feature, "GALLERY_LEFT_OUT", where, reason=str(error))
                continue
            places[f"/joints/{len(found)}"] = place
            found.append({"id": free_ids.take(record["name"]), **record})
    return found, places
