"""What a mesh, a material or a clip is in the source, whatever else is there and in whatever order."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, replace
from typing import Any, NamedTuple

from ....model import Node, Scene, Texture
from ....unity.scene import GameObject, MeshCollider, MeshFilter, UnityScene
from ..text.lasting import lasting
from .images import content_of


def mesh_identities(scene: UnityScene, model: Scene, origin: Callable[[int], str]) -> dict[int, str]:
    """Of each mesh that is used: the definition of the parts that show it, else what it is in the source, else the first id of
    those parts; and which of theirs it is.  One that is only touched is the collider of what its object shows.

    A definition, and a file's mesh, stay when one of the parts goes.  origin: of a mesh by its index, see ``model.Mesh``.
    """
    parts = {node.id: node for node in model.nodes}
    drawn: dict[int, _Told] = {}
    touched: dict[int, _Told] = {}
    for entry in scene.gameObjects:
        owner, body = _owner(entry, scene, parts, model.identities)
        for component in entry.components:
            if isinstance(component, MeshFilter):
                one = _told(owner, f"{body}|drawn", origin(component.mesh), parts, model.identities)
                drawn[component.mesh] = min(drawn.get(component.mesh, one), one)
    found = _each_once(drawn)
    for entry in scene.gameObjects:
        owner, body = _owner(entry, scene, parts, model.identities)
        shows = next((found[c.mesh] for c in entry.components if isinstance(c, MeshFilter)), None)
        for component in entry.components:
            if isinstance(component, MeshCollider) and component.mesh not in drawn:
                use = f"collider {component.id}"
                one = _told(owner, f"{body}|{use}", origin(component.mesh), parts, model.identities)
                if shows is not None:
                    one = _Told(0, f"{shows}|{use}", one.user)
                touched[component.mesh] = min(touched.get(component.mesh, one), one)
    return {**found, **_each_once(touched)}


class _Told(NamedTuple):
    """What a mesh is by one of its uses; the least counts.  rank: of the kind of identity.
    user: the part and which of its meshes, for those that are told alike."""

    rank: int
    identity: str
    user: str


def _owner(
    entry: GameObject, scene: UnityScene, parts: Mapping[str, Node], identities: Mapping[str, str]
) -> tuple[str, str]:
    """The id of the part that an object is or belongs to, and the name of its body where the part has several."""
    if entry.parent is None or not entry.id.startswith(above := scene.gameObjects[entry.parent].id + "/"):
        return entry.id, ""
    kind, _, name = lasting(entry.id, identities)[len(lasting(above, identities)) :].partition(":")
    if kind not in ("body", "collider"):
        return entry.id, ""
    part = parts.get(above[:-1])
    several = part is None or sum(body.mesh is not None for body in part.bodies) > 1
    return above[:-1], name if kind == "body" and several else ""


def _told(
    owner: str, use: str, origin: str, parts: Mapping[str, Node], identities: Mapping[str, str]
) -> _Told:
    user = f"part {lasting(owner, identities)}|{use}"
    if owner in parts and parts[owner].definition:
        return _Told(0, f"definition {parts[owner].definition}|{use}", user)
    return _Told(1, f"source {origin}", user) if origin else _Told(2, user, user)


def _each_once(told: Mapping[int, _Told]) -> dict[int, str]:
    """Meshes that are told alike are those of their users; what still is alike gets numbers, in the scene's order."""
    counts = Counter(one.identity for one in told.values())
    return _numbered(
        {
            i: one.identity if counts[one.identity] == 1 else f"{one.identity}|{one.user}"
            for i, one in told.items()
        }
    )


def _numbered(told: Mapping[int, str]) -> dict[int, str]:
    seen: Counter[str] = Counter()
    found: dict[int, str] = {}
    for index in sorted(told):
        seen[told[index]] += 1
        count = seen[told[index]]
        found[index] = told[index] if count == 1 else f"{told[index]}#{count}"
    return found


def named_identities(nouns: Sequence[Any]) -> list[str]:
    """Of materials and clips: their names; of several alike also what they hold."""
    names = Counter(noun.name for noun in nouns)
    found = [noun.name if names[noun.name] == 1 else f"{noun.name}|{_digest(noun)}" for noun in nouns]
    return list(_numbered(dict(enumerate(found))).values())


def _digest(noun: Any) -> str:
    """What it holds, wherever the images of its textures lie."""
    told = [
        (field.name, _bare(value) if isinstance(value := getattr(noun, field.name), Texture) else value)
        for field in fields(noun)
    ]
    return hashlib.md5(repr(told).encode("utf-8", "surrogatepass"), usedforsecurity=False).hexdigest()


def _bare(texture: Texture) -> tuple[Texture, str]:
    return replace(texture, path=None, data=None), content_of(texture)
