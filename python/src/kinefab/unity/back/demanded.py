"""What a written scene must be for targets to take it as it is; ``scene_file`` looked at the indices of its plain text."""

from __future__ import annotations

from collections.abc import Iterable

from ..scene import ArticulationBody, GameObject, Joint, JointCoordinate, Rigidbody, UnityScene


def demand_sound(scene: UnityScene) -> None:
    """Raises ValueError where an index leads nowhere, a joint joins no body, or a coupling counts by none."""
    objects, meshes = scene.gameObjects, len(scene.meshes)
    for entry in objects:
        for component in entry.components:
            _demand_within([getattr(component, "mesh", None)], meshes)
            if isinstance(component, Joint):
                connected = component.connectedBody
                if connected is not None and not (_carries(objects[connected]) and _carries(entry)):
                    raise ValueError("a joint without a body")
    for coupling in scene.couplings:
        for at in (coupling.coordinate, *(term.coordinate for term in coupling.terms)):
            _demand_joint(at, objects)
    _demand_within((index for pair in scene.ignoredCollisions for index in (pair.a, pair.b)), len(objects))
    for clip in scene.animations:
        _demand_within((track.gameObject for track in clip.tracks), len(objects))
        for track in clip.tracks:
            if any(keys and len(keys) != len(clip.times) for keys in (track.localPosition, track.localRotation)):
                raise ValueError("a track of another length than its clip")
    for constraint in scene.constraints:
        _demand_within((feature.gameObject for feature in constraint.features), len(objects))
    if scene.analysis is not None:
        found = scene.analysis
        _demand_within((i for island in found.islands for i in island.gameObjects), len(objects))
        _demand_within((body.gameObject for body in found.bodies), len(objects))


def _demand_within(indices: Iterable[int | None], count: int) -> None:
    if any(index is not None and not 0 <= index < count for index in indices):
        raise ValueError("an index that leads nowhere")


def _demand_joint(at: JointCoordinate, objects: tuple[GameObject, ...]) -> None:
    _demand_within([at.gameObject], len(objects))
    components = objects[at.gameObject].components
    _demand_within([at.component], len(components))
    if not isinstance(components[at.component], (Joint, ArticulationBody)):
        raise ValueError("a coupling that counts by no joint")


def _carries(entry: GameObject) -> bool:
    return any(isinstance(component, (Rigidbody, ArticulationBody)) for component in entry.components)

