"""Occurrences as the scene's nodes: what moves as one, what is an assembly, and which shapes show there."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from ...model import Node, NodeKind
from ...spatial import Array, Pose
from ..reading.source_frame import DIRECTIONS, FORWARD, turn_to_scene
from .document import UNIT, Document, Thing
from .frames import Frame
from .occurrences import ASSEMBLY, LINK_GROUP, LINKS, NO_PART, SUB_ASSEMBLY, Occurrence

TURN: Array = turn_to_scene(DIRECTIONS["Z"], DIRECTIONS[FORWARD["Z"]])
"""FreeCAD's axes to the scene's."""
LINK_KINDS = ("App::PropertyLink", "App::PropertyXLink")
"""Beginnings of the types of properties that name other objects."""
SHAPE_KIND = "Part::PropertyPartShape"


@dataclass(frozen=True, slots=True, eq=False)
class ShownShape:
    """A shape that a node shows.

    owner: the object whose shape it is.  at: the shape's own frame in the node's.  by: the occurrence, for its colours.
    """

    node: int
    name: str
    owner: Thing
    at: Frame
    by: Occurrence
    visible: bool


@dataclass(slots=True, eq=False)
class Parts:
    """nodes: of the scene.  shapes: to be loaded.  of: the node that an occurrence moves with, by its identity.
    identities: of nodes by their ids, see ``model.Scene``.  empty: containers in which nothing has a shape."""

    nodes: list[Node] = field(default_factory=list[Node])
    shapes: list[ShownShape] = field(default_factory=list[ShownShape])
    of: dict[int, int] = field(default_factory=dict[int, int])
    identities: dict[str, str] = field(default_factory=dict[str, str])
    empty: list[int] = field(default_factory=list[int])
    _labels: dict[tuple[int | None, str], int] = field(default_factory=dict[tuple[int | None, str], int])
    _hidden: dict[int, set[str]] = field(default_factory=dict[int, set[str]])

    def node(self, occurrence: Occurrence | None) -> int | None:
        """The node that an occurrence is, or moves with."""
        while occurrence is not None and id(occurrence) not in self.of:
            occurrence = occurrence.parent
        return None if occurrence is None else self.of[id(occurrence)]

    def add(
        self, here: Occurrence, parent: int | None = None, moves: bool = False, ground: bool = False
    ) -> None:
        """An occurrence and everything below it.

        moves: whether parts below ``parent`` move apart.  ground: they stand still, outside of any assembly.
        """
        if self.is_source_only(here):
            return
        if here.is_group:
            for child in here.children:
                self.add(child, parent, moves, ground)
        elif here.is_container:
            self._container(here, parent, moves, ground)
        elif here.target is None or has_shape(here.target) or here.thing.type in LINKS:
            node = self._node(here, parent, NodeKind.PART, grounded=ground)
            self._show(here, here, node)
        elif here.target.type.startswith("Mesh::"):
            self._node(here, parent, NodeKind.PART, grounded=ground)

    def _container(self, here: Occurrence, parent: int | None, moves: bool, ground: bool) -> None:
        grouped = here.type == LINK_GROUP
        inside = [child for child in flat(here) if grouped or not self.is_source_only(child)]
        assembly = here.type == ASSEMBLY and here.thing.type not in LINKS
        loose = assembly and (parent is None or ground)
        if here.type == SUB_ASSEMBLY and here.thing.type == SUB_ASSEMBLY:
            loose = moves and not here.thing.flag("Rigid", True)
        elif here.array:
            loose = moves and here.movable
        elif (
            here.type == "App::Part"
            and any(below.type == ASSEMBLY for below in here.walk())
            and (parent is None or ground)
        ):
            loose, assembly = True, True
        plain = (
            not assembly
            and here.type in ("App::Part", LINK_GROUP)
            and not any(child.is_container for child in inside)
        )
        if plain and not here.array:
            node = self._node(here, parent, NodeKind.PART, grounded=ground)
            if all(child.target is not None and child.target.type.startswith(NO_PART) for child in inside):
                self.empty.append(node)
            for child in inside:
                self.of[id(child)] = node
                if child.target is not None and has_shape(child.target):
                    self._show(child, here, node)
            return
        node = self._node(here, parent, NodeKind.ASSEMBLY, flexible=loose, grounded=ground and not assembly)
        outside = loose and here.type == "App::Part" and not here.array
        for child in inside:
            self.add(child, node, loose and not outside, ground=outside)

    def is_source_only(self, here: Occurrence) -> bool:
        """Whether an object is no part itself: hidden, and a shape of its document was made of it, or, where no Assembly
        stands in the document, links show it elsewhere."""
        thing = here.thing
        if thing.flag("Visibility", True) or thing.type in LINKS:
            return False
        document = thing.document
        if id(document) not in self._hidden:
            originals = set[str]() if has_assembly(document) else linked(document)
            self._hidden[id(document)] = inputs(document) | originals
        return thing.name in self._hidden[id(document)]

    def _node(
        self,
        here: Occurrence,
        parent: int | None,
        kind: NodeKind,
        grounded: bool = False,
        flexible: bool = False,
    ) -> int:
        index = len(self.nodes)
        label = here.label or here.name
        above = "" if parent is None else f"{self.nodes[parent].id}/"
        number = self._labels.get((parent, label), 0)
        self._labels[parent, label] = number + 1
        own = label if number == 0 else f"{label}#{here.name}"
        if number and (parent, own) in self._labels:
            own = f"{own}:{number}"
        self._labels.setdefault((parent, own), 1)
        definition = None
        if here.target is not None:
            source = here.target.target("LinkedObject") if here.target.type == SUB_ASSEMBLY else None
            file = here.target.document.path.name
            definition = (
                f"{file}#{here.target.name}" if source is None else f"{source.file or file}#{source.name}"
            )
        visible = (
            here.thing.flag("Visibility", True)
            if here.parent is None
            else here.shown or not here.parent.shown
        )
        # Users change labels; names stay as FreeCAD gave them.
        holder = "" if parent is None else f"{self.identities[self.nodes[parent].id]}/"
        self.identities[above + own] = holder + here.name
        self.nodes.append(
            Node(
                above + own, label, kind, parent, scene_pose(here.pose), definition,
                visible=visible, where=here.thing.where, grounded=grounded, flexible=flexible,
            )
        )  # fmt: skip
        self.of[id(here)] = index
        return index

    def _show(self, here: Occurrence, within: Occurrence, node: int) -> None:
        if here.target is None or not has_shape(here.target):
            return
        at = Frame(within.pose.inverse() @ here.inner.pose, here.inner.stretch)
        visible = here is within or here.visible
        own = self.nodes[node].id
        self.identities[f"{own}/body:{here.label or here.name}"] = f"{self.identities[own]}/body:{here.name}"
        self.shapes.append(ShownShape(node, here.label or here.name, here.target, at, here, visible))


def flat(here: Occurrence) -> Iterator[Occurrence]:
    """What stands in a container, folders opened."""
    for child in here.children:
        if child.is_group:
            yield from flat(child)
        else:
            yield child


def has_shape(thing: Thing) -> bool:
    return thing.kinds.get("Shape") == SHAPE_KIND and not thing.type.startswith(NO_PART)


def inputs(document: Document) -> set[str]:
    """Names of the objects that a shape of the document was made of, joints' and grounds' own left out."""
    made: set[str] = set()
    needed: set[str] = set()
    for thing in document.things.values():
        for name, kind in thing.kinds.items():
            if name in ("Reference1", "Reference2", "Object1", "Object2", "ObjectToGround", "LinkedObject"):
                target = thing.target(name)
                if target is not None:
                    needed |= {target.name, *(part for sub in target.subs for part in sub.split("."))}
            elif kind.startswith(LINK_KINDS) and thing.kinds.get("Shape") == SHAPE_KIND:
                target = thing.target(name)
                made |= {entry.name for entry in thing.targets(name)} | ({target.name} if target else set())
    return made - needed


def has_assembly(document: Document) -> bool:
    """Whether an assembly of the Assembly workbench stands in a document."""
    return any(thing.type == ASSEMBLY for thing in document.things.values())


def linked(document: Document) -> set[str]:
    """Names of the objects that links of the document itself show."""
    targets = (thing.target("LinkedObject") for thing in document.things.values())
    return {target.name for target in targets if target is not None and not target.file}


def scene_pose(pose: Pose) -> Pose:
    """A frame of FreeCAD, millimetres, in the scene's axes and metres."""
    return Pose(TURN @ pose.rotation @ TURN.T, TURN @ pose.translation * UNIT)


def scene_matrix(frame: Frame) -> Array:
    """What takes a point of a shape, millimetres, to the node's frame in metres, shape (4, 4)."""
    matrix = np.eye(4)
    matrix[:3, :3] = TURN @ frame.pose.rotation @ frame.stretch * UNIT
    matrix[:3, 3] = TURN @ frame.pose.translation * UNIT
    return matrix
