"""What a mesh, a material or a clip is in the source, whatever else is there and in whatever order."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from ....model import Scene
from ....unity.scene import MeshCollider, MeshFilter, UnityScene


def mesh_identities(scene: UnityScene, model: Scene) -> dict[int, str]:
    """Of each mesh that is used: the definition of the parts that use it, or the first of their ids, and which of theirs it is.

    A definition stays when one of its parts goes; where the source has none, a part's own id has to do.
    """
    definitions = {node.id: node.definition for node in model.nodes if node.definition}
    found: dict[int, str] = {}
    for entry in scene.gameObjects:
        owner, rest = entry.id, ""
        if entry.parent is not None and entry.id.startswith(
            above := scene.gameObjects[entry.parent].id + "/"
        ):
            if entry.id[len(above) :].startswith(("body:", "collider:")):
                owner, rest = above[:-1], entry.id[len(above) :]
        owner = f"definition {definitions[owner]}" if owner in definitions else f"part {owner}"
        for component in entry.components:
            if isinstance(component, MeshFilter):
                told = f"{owner}|{rest}|drawn"
            elif isinstance(component, MeshCollider):
                told = f"{owner}|{rest}|collider {component.id}"
            else:
                continue
            found[component.mesh] = min(found.get(component.mesh, told), told)
    return _each_once(found)


def _each_once(told: Mapping[int, str]) -> dict[int, str]:
    """Two meshes of one part that are told alike get numbers, in the scene's order: nothing else tells them apart."""
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
    return list(_each_once(dict(enumerate(found))).values())


def _digest(noun: Any) -> str:
    return hashlib.md5(repr(noun).encode("utf-8", "surrogatepass"), usedforsecurity=False).hexdigest()
