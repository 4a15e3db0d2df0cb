"""Joints that hold nothing: how Unity is told, without a script, which two bodies do not collide."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from .scene import Component, ConfigurableJoint, UnityScene
from .scene.joints.configurable_joint import APART


def apart_id(own: str, other: str) -> str:
    """What such a joint is called between two objects, by their ids."""
    return f"apart:{own} - {other}"


def apart_joint(id: str, other: int, reason: str) -> ConfigurableJoint:
    """Of one body to another, by its object's index: six Free motions.  reason: the source's rule."""
    return ConfigurableJoint(
        connectedBody=other, autoConfigureConnectedAnchor=False, closure=True, id=id, extras={APART: reason}
    )


def with_apart(scene: UnityScene, pairs: Mapping[tuple[int, int], str]) -> UnityScene:
    """The scene with a joint for each pair of bodies, which stands on the first: by their objects' indices, with the reason."""
    if not pairs:
        return scene
    added: dict[int, list[Component]] = {}
    for (own, other), reason in pairs.items():
        id = apart_id(scene.gameObjects[own].id, scene.gameObjects[other].id)
        added.setdefault(own, []).append(apart_joint(id, other, reason))
    objects = tuple(
        replace(entry, components=(*entry.components, *added.get(i, ()))) for i, entry in enumerate(scene.gameObjects)
    )
    return replace(scene, gameObjects=objects)
