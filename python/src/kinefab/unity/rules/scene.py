"""A whole scene against all rules: first what it says by itself, then what lies in its buffers."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from .animations import check_animations
from .bodies import check_body
from .buffers import check_buffer, is_hash
from .couplings import check_couplings
from .findings import Entry, Findings
from .hierarchy import Hierarchy, check_objects
from .joints import check_joint
from .links import LINK, check_link
from .looks import check_image, check_materials
from .meshes import check_mesh
from .shape import check_shape

FORMAT = "kinefab.scene"
MAJOR = "1"
EVERY = ("format", "version", "gameObjects")
"""Fields of every scene; what has none of them is another format's file."""
INDICES = (("mesh", "meshes"), ("material", "physicsMaterials"))
"""Fields of mesh filters and colliders, and what they are indices of."""
_VERSION = re.compile(r"(0|[1-9][0-9]*)\.(0|[1-9][0-9]*)", re.ASCII)


def check_document(document: Any, found: Findings) -> None:
    """Everything but what lies in the buffers.  Raises KinefabError where it is no scene at all."""
    _demand_known(document, found)
    check_shape(document, found)
    scene: Entry = document
    places = Hierarchy(scene["gameObjects"])
    check_objects(places, found)
    _check_components(scene, places, found)
    check_couplings(scene.get("couplings", ()), places, found)
    check_materials(scene.get("materials", ()), len(scene.get("images", ())), found)
    check_animations(scene.get("animations", ()), len(places.objects), found)
    _check_pairs(scene.get("ignoredCollisions", ()), len(places.objects), found)
    _check_told(scene, len(places.objects), found)


def check_contents(scene: Entry, read: Callable[[int, Entry], bytes | None], found: Findings) -> list[bytes]:
    """All that lies in the buffers, and those that are sound.  read: the bytes of one, as long as it says, or None, and says
    why."""
    buffers: list[Entry] = list(scene.get("buffers", ()))
    contents = [
        check_buffer(buffer, f"/buffers/{index}", partial(read, index, buffer), found)
        for index, buffer in enumerate(buffers)
    ]
    for index, mesh in enumerate(scene.get("meshes", ())):
        check_mesh(mesh, f"/meshes/{index}", buffers, contents, found)
    for index, image in enumerate(scene.get("images", ())):
        check_image(image, f"/images/{index}", buffers, contents, found)
    return [content for content in contents if content is not None]


def _demand_known(document: Any, found: Findings) -> None:
    """Of another format or a later version nothing else is told: it may mean another thing there."""
    entry: Any = document if isinstance(document, dict) else {}
    if isinstance(document, dict) and entry.keys().isdisjoint(EVERY):
        found.refuse_for("FORMAT_MISSING")
    version = entry.get("version", "")
    known = _VERSION.fullmatch(version) if isinstance(version, str) else None
    if entry.get("format", FORMAT) != FORMAT:
        found.refuse_for("FORMAT_UNKNOWN", "/format", format=str(entry["format"])[:60])
    elif known is not None and known[1] != MAJOR:
        found.refuse_for("VERSION_UNSUPPORTED", "/version", version=version)
    elif known is None and "version" in entry:
        found.add("VERSION_INVALID", "/version", version=str(version)[:60])


def _check_components(scene: Entry, places: Hierarchy, found: Findings) -> None:
    counts = {into: len(scene.get(into, ())) for into in ("materials", "meshes", "physicsMaterials")}
    for index, entry in enumerate(places.objects):
        for number, component in enumerate(entry.get("components", ())):
            kind: str = component["type"]
            at = f"/gameObjects/{index}/components/{number}"
            if kind.endswith("Joint"):
                check_joint(component, index, at, places, found)
            elif kind in ("Rigidbody", LINK):
                check_body(component, at, found)
                if kind == LINK:
                    check_link(component, index, at, places, found)
            elif kind == "MeshRenderer":
                for place, material in enumerate(component["materials"]):
                    found.reference(material, "materials", counts["materials"], f"{at}/materials/{place}")
            else:
                for field, into in INDICES:
                    if field in component:
                        found.reference(component[field], into, counts[into], f"{at}/{field}")


def _check_pairs(pairs: Sequence[Entry], objects: int, found: Findings) -> None:
    for index, pair in enumerate(pairs):
        at = f"/ignoredCollisions/{index}"
        there = [found.reference(pair[side], "gameObjects", objects, f"{at}/{side}") for side in "ab"]
        if all(there) and pair["a"] == pair["b"]:
            found.add("IGNORED_COLLISION_ITSELF", f"{at}/b")


def _check_told(scene: Entry, objects: int, found: Findings) -> None:
    """What describes the scene without acting in it."""
    if "sha256" in (source := scene.get("source", {})) and not is_hash(source["sha256"]):
        found.add("SHA256_INVALID", "/source/sha256")
    for index, constraint in enumerate(scene.get("constraints", ())):
        for number, feature in enumerate(constraint["features"]):
            at = f"/constraints/{index}/features/{number}/gameObject"
            found.reference(feature.get("gameObject"), "gameObjects", objects, at)
    analysis: Entry = scene.get("analysis", {})
    for index, island in enumerate(analysis.get("islands", ())):
        for number, at in enumerate(island["gameObjects"]):
            found.reference(at, "gameObjects", objects, f"/analysis/islands/{index}/gameObjects/{number}")
    for index, body in enumerate(analysis.get("bodies", ())):
        found.reference(body["gameObject"], "gameObjects", objects, f"/analysis/bodies/{index}/gameObject")
