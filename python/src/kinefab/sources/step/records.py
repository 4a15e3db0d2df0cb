"""What the guarded reader sends back of a STEP or IGES file: plain data, in the file's axes, millimetres."""

from __future__ import annotations

from dataclasses import dataclass, field

from ...model import Face
from ...spatial import Array
from ..occ.triangles import Tessellation

Color = tuple[float, float, float, float]
"""Linear red, green, blue, alpha."""


@dataclass(slots=True, eq=False)
class Occurrence:
    """A component of the tree.  parent: its place in the list, or None.  matrix: its frame in its parent's, (3, 4).

    shape: number of the shape that it shows, None for an assembly.  color: given to this occurrence, or None; that of an
    assembly is for what has none of its own in it.
    product: name of what it is an occurrence of; key: what tells that apart from others of the name.
    """

    name: str
    parent: int | None
    matrix: Array
    product: str
    key: str
    shape: int | None = None
    color: Color | None = None
    layers: tuple[str, ...] = ()
    visible: bool = True


@dataclass(slots=True, eq=False)
class Tree:
    """occurrences: parents first.  shapes: name of each shape.  messages: what the reader complained about."""

    occurrences: list[Occurrence]
    shapes: list[str]
    messages: list[str] = field(default_factory=list[str])


@dataclass(slots=True, eq=False)
class Begun:
    """The shape of this number is about to be meshed."""

    shape: int


@dataclass(slots=True, eq=False)
class Piece:
    """A solid, or the loose faces of a shape.  looks: colour of each face, None where nothing states one."""

    name: str
    mesh: Tessellation
    looks: tuple[Color | None, ...]
    boundary: tuple[Face, ...]


@dataclass(slots=True, eq=False)
class Shape:
    """A meshed shape.  pieces: its solids.  failure: why there are none, empty where there are or nothing is in it.
    lines: whether there are none since it is curves and points alone."""

    number: int
    pieces: list[Piece]
    failure: str = ""
    lines: bool = False
