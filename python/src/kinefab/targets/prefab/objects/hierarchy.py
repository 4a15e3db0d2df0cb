"""The tree of GameObjects: Transforms, components, and the order in which the editor writes them."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache, partial

from ....unity.scene import (
    ArticulationBody,
    Collider,
    Component,
    Coupling,
    FixedJoint,
    GameObject,
    Joint,
    MeshCollider,
    MeshFilter,
    MeshRenderer,
    Rigidbody,
    Transform,
    UnityScene,
)
from ..last import Document, LastExport
from ..layers import LayersAndTags
from ..names import sibling_names
from ..text.dialects import Dialect
from ..text.documents import COMPONENT, HEAD, version
from ..text.forms import BLANK, Form
from ..text.ids import FileIds
from ..text.lasting import lasting
from ..text.yaml import NULL, Fields, Plain, document, local, text, vector
from ..text.yaml import placed as rounded
from .articulations import CLASS as ARTICULATION_CLASS
from .articulations import articulation_fields
from .bodies import collider, rigidbody
from .couplings import coupling_fields
from .joints import joint_class, joint_fields
from .matching import Matched, NewComponent, NewObject, matched
from .rendering import animation_fields, mesh_filter, mesh_renderer

NUMBERED = re.compile(r"#\d+$")
"""At the end of the id of one of several that are called alike."""
ROOT = "kinefab:root"
"""What the prefab's own root is, where the scene has none that could be it."""


@dataclass(frozen=True, slots=True)
class References:
    """How the prefab refers to its assets, by their indices in the scene."""

    meshes: Mapping[int, Plain]
    materials: Mapping[int, Plain]
    physics_materials: Mapping[int, Plain]
    clips: Sequence[Plain]


@dataclass(slots=True)
class _Placed:
    """A GameObject with its numbers.  order: its place among its siblings.  components: each with its number; documents that the
    export adds are ready."""

    name: str
    file_id: int
    transform_id: int
    layer: int
    tag: str
    active: bool
    transform: Transform
    parent: int | None
    order: int = 0
    children: list[int] = field(default_factory=list[int])
    components: list[tuple[int, Component | str]] = field(default_factory=list[tuple[int, Component | str]])


class Hierarchy:
    """Gives every object its name and its numbers, then makes the documents.

    A scene with several roots, or whose root does not stand at the origin, gets one above them: a prefab has one, and the user
    places it.
    """

    def __init__(
        self,
        scene: UnityScene,
        name: str,
        dialect: Dialect,
        left_out: frozenset[tuple[int, int]],
        identities: Mapping[str, str],
        words: LayersAndTags,
    ):
        """left_out: components that are not written, by object and component.  identities: see ``model.Scene``.
        words: of the project."""
        self.scene, self.dialect, self.left_out = scene, dialect, left_out
        self._given = identities
        self.ids = FileIds()
        objects = scene.gameObjects
        roots = [o for o in objects if o.parent is None]
        self.own_root = len(roots) != 1 or roots[0].transform != Transform()
        shift = 1 if self.own_root else 0
        parents = [None] * shift + [
            (o.parent + shift if o.parent is not None else 0 if self.own_root else None) for o in objects
        ]
        names = [name] * shift + [o.name for o in objects]
        names[parents.index(None)] = name  # as an editor has it: the root is called like the file
        self._identities = [lasting(o.id, identities) for o in objects]
        ids = [ROOT] * shift + self._identities
        self.names = sibling_names(parents, names, ids)
        self.scene_names = self.names[shift:]
        self._first = shift
        self._placed: list[_Placed] = []
        file_ids = self.ids.each([("GameObject", identity) for identity in ids])
        transform_ids = self.ids.each([("Transform", identity) for identity in ids])
        for i, (file_id, transform_id) in enumerate(zip(file_ids, transform_ids)):
            own = objects[i - shift] if i >= shift else GameObject(ROOT, name)
            layer, tag = words.layer(own.layer), words.tag(own.tag)
            self._placed.append(
                _Placed(self.names[i], file_id, transform_id, layer, tag, own.active, own.transform, parents[i])
            )
        for i, parent in enumerate(parents):
            if parent is not None:
                self._placed[i].order = len(self._placed[parent].children)
                self._placed[parent].children.append(i)
        self.component_ids: dict[tuple[int, int], int] = {}
        self.bodies: dict[int, int] = {}
        self.links: dict[int, int] = {}
        self._number_components()

    def _number_components(self) -> None:
        """Each component's fileID, by the object's index in the scene and its own; Rigidbodies also by the object's alone."""
        objects = self.scene.gameObjects
        all_of_them = [(i, k, c) for i, entry in enumerate(objects) for k, c in enumerate(entry.components)]
        told = [(type(c).__name__, f"{self._identities[i]}{self._told(c)}") for i, _, c in all_of_them]
        for (i, k, _), found in zip(all_of_them, self.ids.each(told)):
            self.component_ids[i, k] = found
        self._list_bodies()

    def _list_bodies(self) -> None:
        for (i, k), number in self.component_ids.items():
            component = self.scene.gameObjects[i].components[k]
            if isinstance(component, Rigidbody):
                self.bodies[i] = number
            elif isinstance(component, ArticulationBody):
                self.links[i] = number

    def _told(self, component: Component) -> str:
        """What a component is beside its object and its class: several joints or colliders may stand on one object."""
        if isinstance(component, FixedJoint) and not component.id:
            other = component.connectedBody
            return f"->{self._identities[other]}" if other is not None else ""
        if isinstance(component, (Joint, Collider)):
            return f"->{lasting(component.id, self._given)}" if component.id else ""
        return ""

    def know_again(self, last: LastExport, counted: Collection[str], references: References) -> Matched:
        """Give what the last export had the numbers that it had there.  counted: see ``model.Scene``.  references: to this export's
        assets, as it would call them."""
        self._references = references
        found = matched(last, self._new_objects(counted))
        used = {number for pair in found.objects.values() for number in pair}
        used |= {document.file_id for document in found.components.values()}
        for i, placed in enumerate(self._placed):
            ids = found.objects.get(i)
            if ids is None:
                ids = self._unused(last, used, placed, i)
            placed.file_id, placed.transform_id = ids
        for (i, k), number in list(self.component_ids.items()):
            document = found.components.get((i + self._first, k))
            component = self.scene.gameObjects[i].components[k]
            kind, told = type(component).__name__, f"{self._identities[i]}{self._told(component)}"
            self.component_ids[i, k] = self._free_of(last, used, kind, told, number) if document is None else document.file_id
        self._list_bodies()
        return found

    def pairs(self, found: Matched) -> Iterator[tuple[str, Document]]:
        """Of what refers to assets the new document and the old one."""
        for (i, k), document in found.components.items():
            component = self.scene.gameObjects[i - self._first].components[k]
            if isinstance(component, (MeshFilter, MeshRenderer, MeshCollider)):
                yield self._fields(component), document

    def _fields(self, component: Component) -> str:
        """A component's document without its head."""
        return self._component(0, 0, component).split("\n", 2)[2]

    def _unused(self, last: LastExport, used: set[int], placed: _Placed, index: int) -> tuple[int, int]:
        """Numbers of an object that the last export had not."""
        identity = ROOT if index < self._first else self._identities[index - self._first]
        return (
            self._free_of(last, used, "GameObject", identity, placed.file_id),
            self._free_of(last, used, "Transform", identity, placed.transform_id),
        )

    def _free_of(self, last: LastExport, used: set[int], kind: str, identity: str, number: int) -> int:
        """A number that the last export gave to nothing: what is new is not taken for what has gone."""
        while number in last or number in used:
            number = self.ids.new(kind, identity)
        used.add(number)
        return number

    def _new_objects(self, counted: Collection[str]) -> list[NewObject]:
        found: list[NewObject] = []
        for i, placed in enumerate(self._placed):
            own = self.scene.gameObjects[i - self._first] if i >= self._first else None
            t = placed.transform
            components: list[NewComponent] = []
            for k, component in enumerate(own.components if own else ()):
                if own is None or (i - self._first, k) in self.left_out:
                    continue
                nameless = own.id in counted or f"{own.id}/collider:{_id_of(component)}" in counted or _id_of(component) in counted
                components.append(
                    NewComponent(
                        type(component).__name__,
                        self.component_ids[i - self._first, k],
                        isinstance(component, (Joint, Collider)) and (nameless or _is_counted(_id_of(component))),
                        partial(self._fields, component),
                    )
                )
            id = own.id if own else ROOT
            place = (*t.localPosition, *t.localRotation, *t.localScale)
            found.append(
                NewObject(
                    id, text(placed.name), placed.file_id, placed.transform_id, placed.parent,
                    id in counted or NUMBERED.search(id) is not None, place, components,
                )
            )  # fmt: skip
        return found

    def game_object_id(self, index: int) -> int:
        return self._placed[index + self._first].file_id

    def path(self, index: int) -> str:
        """Names from below the root to an object of the scene, slashes between: how clips name what they move."""
        found: list[str] = []
        at: int | None = index + self._first
        while at is not None and self._placed[at].parent is not None:
            found.append(self._placed[at].name)
            at = self._placed[at].parent
        return "/".join(reversed(found))

    def add(self, index: int | None, class_id: int, kind: str, file_id: int, fields: Fields) -> None:
        """A component of an object of the scene, None for the root, after those that it has."""
        at = 0 if index is None else index + self._first
        self._placed[at].components.append((file_id, document(class_id, kind, file_id, fields)))

    def add_components(self, references: References) -> None:
        """What the scene's objects hold; their documents are made when they are written."""
        self._references = references
        for i, entry in enumerate(self.scene.gameObjects):
            held = self._placed[i + self._first].components
            for k, component in enumerate(entry.components):
                if (i, k) not in self.left_out:
                    held.append((self.component_ids[i, k], component))

    def add_couplings(self, couplings: Sequence[Coupling]) -> None:
        """The script's components, each on the object whose joint follows."""
        for coupling in couplings:
            index = coupling.coordinate.gameObject
            fields = coupling_fields(coupling, self.game_object_id(index), self.component_ids, self.scene)
            own = self.ids.new("MonoBehaviour", f"coupling {lasting(coupling.id, self._given)}")
            self.add(index, 114, "MonoBehaviour", own, fields)

    def add_clips(self, clips: Sequence[Plain], plays: bool) -> None:
        """The Animation on the root.  plays: from the start."""
        fields = animation_fields(self._placed[0].file_id, clips, plays, self.dialect)
        self.add(None, 111, "Animation", self.ids.new("Animation", ROOT), fields)

    def documents(self) -> Iterator[str]:
        """GameObjects by rising fileID, each before its components, as the editor writes them."""
        for placed in sorted(self._placed, key=lambda p: p.file_id):
            yield self._game_object(placed)
            yield self._transform(placed)
            for file_id, component in placed.components:
                if isinstance(component, str):
                    yield component
                else:
                    yield self._component(file_id, placed.file_id, component)

    def _component(self, file_id: int, owner: int, component: Component) -> str:
        references, dialect = self._references, self.dialect
        if isinstance(component, MeshFilter):
            return mesh_filter(file_id, owner, references.meshes.get(component.mesh, NULL))
        if isinstance(component, MeshRenderer):
            materials = [references.materials[m] for m in component.materials]
            return mesh_renderer(file_id, owner, component.enabled, materials, dialect)
        if isinstance(component, Rigidbody):
            return rigidbody(component, file_id, owner, dialect)
        if isinstance(component, Collider):
            shape = component.mesh if isinstance(component, MeshCollider) else None
            mesh = NULL if shape is None else references.meshes.get(shape, NULL)
            rubbing = NULL if component.material is None else references.physics_materials[component.material]
            return collider(component, file_id, owner, rubbing, mesh, dialect)
        if isinstance(component, ArticulationBody):
            return document(*ARTICULATION_CLASS, file_id, articulation_fields(component, owner, dialect))
        other = component.connectedBody
        connected = NULL if other is None or other in self.links else local(self.bodies[other])
        link = local(self.links[other]) if other is not None and other in self.links else NULL
        fields = joint_fields(component, owner, connected, dialect, link)
        return document(*joint_class(component), file_id, fields)

    def _game_object(self, placed: _Placed) -> str:
        ids = [placed.transform_id, *(file_id for file_id, _ in placed.components)]
        form = _object_form(len(ids))
        words = placed.layer, text(placed.name), text(placed.tag), int(placed.active)
        return form.filled(placed.file_id, *map(local, ids), *words)

    def _transform(self, placed: _Placed) -> str:
        parent = None if placed.parent is None else self._placed[placed.parent]
        own = placed.transform
        order = (placed.order,) if self.dialect.root_order else ()
        return _transform_form(len(placed.children), self.dialect).filled(
            placed.transform_id,
            local(placed.file_id),
            rounded(own.localRotation),
            rounded(own.localPosition),
            rounded(own.localScale),
            *[local(self._placed[i].transform_id) for i in placed.children],
            local(0 if parent is None else parent.transform_id),
            *order,
        )


def _id_of(component: Component) -> str:
    return component.id if isinstance(component, (Joint, Collider)) else ""


def _is_counted(id: str) -> bool:
    """Whether a joint or a collider has no name, or one that several have."""
    return not id or NUMBERED.search(id) is not None


@lru_cache(maxsize=64)
def _object_form(components: int) -> Form:
    """components: how many, the Transform among them."""
    fields: Fields = {
        **HEAD,
        "serializedVersion": 6,
        "m_Component": [{"component": BLANK}] * components,
        "m_Layer": BLANK,
        "m_Name": BLANK,
        "m_TagString": BLANK,
        "m_Icon": NULL,
        "m_NavMeshLayer": 0,
        "m_StaticEditorFlags": 0,
        "m_IsActive": BLANK,
    }
    return Form(1, "GameObject", fields)


@lru_cache(maxsize=64)
def _transform_form(children: int, dialect: Dialect) -> Form:
    order: Fields = {"m_RootOrder": BLANK} if dialect.root_order else {}
    fields: Fields = {
        **COMPONENT,
        **version(dialect.transform),
        "m_LocalRotation": BLANK,
        "m_LocalPosition": BLANK,
        "m_LocalScale": BLANK,
        "m_ConstrainProportionsScale": 0,
        "m_Children": [BLANK] * children,
        "m_Father": BLANK,
        **order,
        "m_LocalEulerAnglesHint": vector((0.0, 0.0, 0.0)),
    }
    return Form(4, "Transform", fields)
