from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Union

from .articulation_body import ArticulationBody
from .colliders.collider import Collider
from .joints.joint import Joint
from .mesh_filter import MeshFilter
from .mesh_renderer import MeshRenderer
from .rigidbody import Rigidbody
from .transform import Transform

Component = Union[MeshFilter, MeshRenderer, Rigidbody, ArticulationBody, Collider, Joint]
"""Colliders and joints by their subclasses."""


@dataclass(frozen=True, slots=True)
class GameObject:
    """id: stable path in the source, unique; never made from order.  parent: index of an earlier object, or None.
    layer, tag: the source's words; Unity's own lists are the project's, so targets leave them at default and tell.
    definition: of the part, shared by its occurrences; "" for none.  role: ``ground`` of what stands for it, ``site`` of a named frame of
    the object above; "" of all others."""

    id: str
    name: str
    parent: int | None = None
    active: bool = True
    transform: Transform = Transform()
    components: tuple[Component, ...] = ()
    layer: str = ""
    tag: str = ""
    definition: str = ""
    role: str = ""
    extras: Mapping[str, object] = field(default_factory=dict[str, object])
