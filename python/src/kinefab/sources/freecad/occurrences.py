"""What stands where: the tree of a document with its links followed.  Poses are FreeCAD's own, millimetres, Z up."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from ...spatial import Pose, matrix_from_quaternion
from ..reading.record import MAX_NUMBER
from .archive import ArchiveError
from .document import Target, Thing
from .frames import Frame
from .links import Documents

ASSEMBLY, SUB_ASSEMBLY, LINK, ELEMENT, LINK_GROUP = (
    "Assembly::AssemblyObject", "Assembly::AssemblyLink", "App::Link", "App::LinkElement", "App::LinkGroup",
)  # fmt: skip
LINKS = frozenset({LINK, ELEMENT})
GROUPS = frozenset({"App::DocumentObjectGroup", "App::DocumentObjectGroupPython"})
"""Folders in the tree: they have no place of their own."""
PARTS = frozenset({"App::Part", ASSEMBLY, SUB_ASSEMBLY, LINK_GROUP})
"""Containers with a place of their own."""
NO_PART = (
    "App::Origin", "App::Line", "App::Plane", "App::Point", "App::LocalCoordinateSystem", "App::Datum",
    "App::FeaturePython", "App::Annotation", "App::Text", "App::Variable", "App::VarSet", "App::Property",
    "Assembly::JointGroup", "Assembly::ViewGroup", "Assembly::BomGroup", "Assembly::BomObject",
    "Assembly::SimulationGroup", "PartDesign::CoordinateSystem", "PartDesign::Plane", "PartDesign::Line",
    "PartDesign::Point", "PartDesign::ShapeBinder", "PartDesign::SubShapeBinder", "Part::Datum", "Part::LocalCoordinateSystem",
    "Sketcher::", "Spreadsheet::", "TechDraw::", "Image::", "Path::", "Fem::", "Measure::", "Material::",
)  # fmt: skip
"""Beginnings of the types that show no body: datums, sketches, sheets, drawings."""
MAX_OCCURRENCES = 200_000
"""Most objects of a tree: links to links to links make a small file large."""
MAX_LEVELS = 60


class TooManyError(Exception):
    """The tree is larger than any assembly."""


@dataclass(slots=True, eq=False)
class Occurrence:
    """An object at a place.

    thing: what stands in the tree.  target: what it shows, its links followed; None where they lead nowhere.
    name: by which a path in the document goes through it.  pose: its frame in the world.
    inner: the frame that its target's insides stand in, scaled as its links say; at another place than ``pose`` only
    through a link that keeps its target's place.
    jcs: its frame as joints have it: FreeCAD multiplies the placements of a path, no link's target's and no scale.
    visible: by itself.  shown: whether it and everything above it is.
    array: an array of links, its elements below it.  movable: whether its elements can move apart.
    """

    thing: Thing
    target: Thing | None
    name: str
    pose: Pose
    inner: Frame
    jcs: Pose
    parent: Occurrence | None = None
    children: list[Occurrence] = field(default_factory=list["Occurrence"])
    visible: bool = True
    shown: bool = True
    array: bool = False
    movable: bool = True
    label: str = ""

    @property
    def type(self) -> str:
        return "" if self.target is None else self.target.type

    @property
    def is_group(self) -> bool:
        return self.thing.type in GROUPS

    @property
    def is_container(self) -> bool:
        return self.type in PARTS or self.array

    def walk(self) -> Iterator[Occurrence]:
        """This one and everything below, parents first."""
        waiting: list[Occurrence] = [self]
        while waiting:
            found = waiting.pop()
            yield found
            waiting += reversed(found.children)


class Tree:
    """Builds occurrences.  Raises TooManyError."""

    def __init__(self, documents: Documents):
        self._documents = documents
        self._count = 0

    def occurrence(self, thing: Thing, parent: Occurrence | None) -> Occurrence:
        """An object of a container, and everything below it."""
        return self._build(
            thing, parent, thing.placement(), thing.name, thing.label, thing.flag("Visibility", True), ()
        )

    def _build(
        self,
        thing: Thing,
        parent: Occurrence | None,
        placed: Pose,
        name: str,
        label: str,
        visible: bool,
        above: tuple[tuple[object, str], ...],
    ) -> Occurrence:
        self._count += 1
        if self._count > MAX_OCCURRENCES or len(above) > MAX_LEVELS:
            raise TooManyError
        frame = Frame() if parent is None else parent.inner
        jcs = Pose() if parent is None else parent.jcs
        if thing.type not in GROUPS:
            frame, jcs = _scaled(frame.at(placed), thing), jcs @ placed
        target, inner = self._resolved(thing, frame)
        here = Occurrence(
            thing, target, name, frame.pose, inner, jcs, parent,
            label=label, visible=visible, shown=visible and (parent is None or parent.shown),
        )  # fmt: skip
        if target is None:
            return here
        if (target.key in above) or (thing.key in above):
            self._documents.broken(thing, Target(target.name), "which holds it itself")
            here.target = None
            return here
        path = (*above, target.key)
        array, base = self._array(thing, frame)
        if array is not None and array.key not in above:
            here.movable = array is thing  # a link to an array shows its elements as they stand there
            self._elements(here, array, base, (*above, array.key, target.key))
        elif target.type in PARTS or target.type in GROUPS:
            self._children(here, target, path)
        return here

    def _resolved(self, thing: Thing, frame: Frame) -> tuple[Thing | None, Frame]:
        """What an object that stands in a frame shows, and the frame of its insides."""
        inner, seen = frame, {thing.key}
        shown: Thing | None = thing
        while shown is not None and shown.type in LINKS:
            target = shown.target("LinkedObject")
            below = None if target is None else self._documents.follow(shown, target)
            if below is not None:
                inner = _through(shown, below, inner)
            if below is not None and below.key in seen:
                assert target is not None
                self._documents.broken(thing, target, "which leads back to it")
                return None, inner
            if below is not None:
                seen.add(below.key)
            shown = below
        return shown, inner

    def _children(self, here: Occurrence, target: Thing, path: tuple[tuple[object, str], ...]) -> None:
        grouped = target.type == LINK_GROUP  # which says itself what it shows
        seen = target.flags("VisibilityList")
        elsewhere = _listed_above(here)
        for number, entry in enumerate(target.targets("ElementList" if grouped else "Group")):
            child = self._documents.follow(target, entry)
            if child is None or child.type.startswith(NO_PART) or child.key in elsewhere:
                continue
            visible = seen[number : number + 1] != "0" if grouped else child.flag("Visibility", True)
            here.children.append(
                self._build(child, here, child.placement(), child.name, child.label, visible, path)
            )

    def _array(self, thing: Thing, frame: Frame) -> tuple[Thing | None, Frame]:
        """The array that an object is or shows through links, and the frame of its elements; None where it is none."""
        inner, seen = frame, set[tuple[object, str]]()
        shown: Thing | None = thing
        while shown is not None and shown.type in LINKS and shown.key not in seen:
            if shown.type == LINK and shown.count("ElementCount") > 0:
                return shown, inner
            seen.add(shown.key)
            target = shown.target("LinkedObject")
            below = None if target is None else self._documents.follow(shown, target)
            if below is not None:
                inner = _through(shown, below, inner)
            shown = below
        return None, frame

    def _elements(
        self, here: Occurrence, thing: Thing, base: Frame, path: tuple[tuple[object, str], ...]
    ) -> None:
        """The elements of an array: objects of their own, or a list of places.  base: the frame that they stand in."""
        here.array = True
        seen = thing.flags("VisibilityList")
        elements = [self._documents.follow(thing, entry) for entry in thing.targets("ElementList")]
        here.inner = base
        for number, element in enumerate(elements):
            if element is not None:
                visible = element.flag("Visibility", True) and seen[number : number + 1] != "0"
                child = self._build(
                    element, here, element.placement(), element.name, element.label, visible, path[:-1]
                )
                here.children.append(child)
        if elements:
            return
        here.movable = False
        count = thing.count("ElementCount")
        if count > MAX_OCCURRENCES:
            raise TooManyError
        places, scales = placement_list(thing, count), scale_list(thing, count)
        for number in range(count):
            self._count += 1
            if self._count > MAX_OCCURRENCES:
                raise TooManyError
            frame = base.at(places[number]).scaled(*scales[number])
            target, inner = self._resolved(thing, frame)
            visible = seen[number : number + 1] != "0"
            child = Occurrence(
                thing, target, str(number), frame.pose, inner, here.jcs @ places[number], here,
                label=f"{thing.label}:{number}", visible=visible, shown=here.shown and visible,
            )  # fmt: skip
            here.children.append(child)
            if target is not None and target.type in PARTS:
                self._children(child, target, path)


def _listed_above(here: Occurrence) -> set[tuple[object, str]]:
    """Of what a folder holds that which stands in its container: FreeCAD lists in a part what is in the part's folders too."""
    listed: set[tuple[object, str]] = set()
    folder = here
    while folder.is_group and folder.parent is not None:
        folder = folder.parent
        if folder.target is not None:
            document = folder.target.document
            names = (entry.name for entry in folder.target.targets("Group") if not entry.file)
            listed |= {document.things[name].key for name in names if name in document.things}
    return listed


def _through(link: Thing, below: Thing, frame: Frame) -> Frame:
    """The frame of what a link shows: it keeps the scale of a link that it shows, and the place only where it says so."""
    return _scaled(frame.at(below.placement()) if link.flag("LinkTransform") else frame, below)


def _scaled(frame: Frame, thing: Thing) -> Frame:
    if thing.type not in LINKS or not thing.has("ScaleVector"):
        return frame
    value = thing.values["ScaleVector"]
    return frame.scaled(*(_positive(value.get(f"value{axis}", "1")) for axis in "XYZ"))


def _positive(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        return 1.0
    return number if 1e-9 < abs(number) < 1e9 else 1.0


def placement_list(thing: Thing, count: int) -> list[Pose]:
    """The places of an array's elements, ``count`` of them; the identity where fewer are saved."""
    found: list[Pose] = []
    for x, y, z, *q in _rows(thing, "PlacementList", 7, count):
        turn = np.array(q)
        rotation = matrix_from_quaternion(turn) if 1e-6 < float(np.linalg.norm(turn)) < 1e6 else np.eye(3)
        found.append(Pose(rotation, np.array([x, y, z])))
    return found + [Pose()] * (count - len(found))


def scale_list(thing: Thing, count: int) -> list[tuple[float, float, float]]:
    """The scales of an array's elements, along their axes."""
    found = [
        (x, y, z) if min(abs(x), abs(y), abs(z)) > 1e-9 else (1.0, 1.0, 1.0)
        for x, y, z in _rows(thing, "ScaleList", 3, count)
    ]
    return found + [(1.0, 1.0, 1.0)] * (count - len(found))


def _rows(thing: Thing, name: str, width: int, most: int) -> list[tuple[float, ...]]:
    """A list that is saved in a member of its own: a count, and as many rows of doubles, little-endian."""
    file = thing.file(name)
    if not file:
        return []
    try:
        content = thing.document.archive.read(file)
    except ArchiveError as error:
        thing.document.fault(thing, name, str(error))
        return []
    count = min(most, (len(content) - 4) // (8 * width))
    if count <= 0:
        return []
    numbers = struct.unpack_from(f"<{count * width}d", content, 4)
    if not all(abs(number) <= MAX_NUMBER for number in numbers):
        thing.document.fault(thing, name, "a number in it is not in range")
        return []
    return [numbers[i : i + width] for i in range(0, len(numbers), width)]
