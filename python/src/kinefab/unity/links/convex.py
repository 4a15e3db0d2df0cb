"""True meshes on what becomes a link: Unity takes convex ones alone of a link, however it is held."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

from ...diagnostics import Report
from ...geometry.contact.decomposition import convex_pieces
from ...geometry.contact.neighbours import meshes_near_others
from ...geometry.hulls import collision_hulls
from ...model import Scene
from ...options import Ground
from ...rigid import RigidGroups
from ..assets.meshes import mesh_name, unmapped_mesh, with_meshes_behind
from ..bodies.colliders import box_about
from ..contact.overlaps import bodies_of
from ..scene import BoxCollider, GameObject, MeshCollider, UnityScene

Place = tuple[int, int]
"""A component: its object, and its place among the object's components."""


def with_convex_colliders(
    scene: UnityScene, links: Collection[int], model: Scene, groups: RigidGroups, report: Report
) -> UnityScene:
    """The scene in which a true mesh on a link is convex pieces, for something may run in its hollows.

    links: objects whose bodies become links.  model: what the scene was made of, whose meshes are the first of its own.  The further
    pieces of a mesh stand behind an object's components, so that those keep their places.
    """
    asked = _true_meshes(scene, links)
    if not asked:
        return scene
    named = list(asked.values())
    model = _as_written(model, scene, {mesh for mesh, _ in named})
    hulls = collision_hulls(model, named, report)
    near = meshes_near_others(model, groups, Ground.BODY, hulls)
    pieces = convex_pieces(model, named, hulls, near, report)
    made = {mesh: pieces.get(mesh, (hull,)) for mesh, hull in hulls.items()}
    numbers = itertools.count(len(scene.meshes))
    number_of = {mesh: [next(numbers) for _ in parts] for mesh, parts in made.items()}
    objects = list(scene.gameObjects)
    for (i, k), (mesh, name) in asked.items():
        own = objects[i].components[k]
        assert isinstance(own, MeshCollider)
        if mesh in made:
            parts = [replace(own, mesh=number, convex=True) for number in number_of[mesh]]
        else:
            feature = f"collider {name}"
            report.approximated(feature, "COLLIDER_FLAT_AS_BOX", collider=feature)
            common = {"isTrigger": own.isTrigger, "enabled": own.enabled, "material": own.material, "group": own.group, "id": own.id}
            parts = [box_about(model.meshes[mesh], **common)]
        objects[i] = _with(objects[i], k, parts)
    behind = [part for parts in made.values() for part in parts]
    return replace(scene, gameObjects=tuple(objects), meshes=with_meshes_behind(scene.meshes, behind))


def _true_meshes(scene: UnityScene, links: Collection[int]) -> Mapping[Place, tuple[int, str]]:
    """The mesh of each such collider, and what the report calls it."""
    bodies = bodies_of(scene)
    return {
        (i, k): (c.mesh, f"{entry.id}/{c.id or mesh_name(scene.meshes, c.mesh)}")
        for i, entry in enumerate(scene.gameObjects)
        for k, c in enumerate(entry.components)
        if bodies[i] in links and isinstance(c, MeshCollider) and not c.convex
    }


def _as_written(model: Scene, scene: UnityScene, meshes: Collection[int]) -> Scene:
    """With those meshes as a file has them: hulls and cuts hang on the order of vertices and on their last digits."""
    found = list(model.meshes)
    for index in meshes:
        found[index] = replace(unmapped_mesh(scene.meshes[index]), origin=found[index].origin)
    return replace(model, meshes=found)


def _with(entry: GameObject, place: int, parts: Sequence[MeshCollider | BoxCollider]) -> GameObject:
    components = entry.components
    return replace(entry, components=(*components[:place], parts[0], *components[place + 1 :], *parts[1:]))
