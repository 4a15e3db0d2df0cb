"""A STEP or IGES file through OpenCASCADE's document: the assembly tree, then shape after shape.

Runs in the guarded process (``sources.guard``); nothing else imports it.
"""

# OCP is a binding of C++ that need not be installed, and its stubs are not those of every version.
# pyright: reportMissingImports=false, reportMissingModuleSource=false, reportMissingTypeStubs=false
# pyright: reportUnknownVariableType=false, reportUnknownMemberType=false, reportUnknownArgumentType=false
# pyright: reportAttributeAccessIssue=false, reportUnknownParameterType=false

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np
from OCP.BRep import BRep_Builder
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.IGESCAFControl import IGESCAFControl_Reader
from OCP.Quantity import Quantity_ColorRGBA
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_AsciiString, TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_ChildIterator, TDF_Label, TDF_Tool
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import (
    TopAbs_COMPOUND,
    TopAbs_COMPSOLID,
    TopAbs_FACE,
    TopAbs_SHELL,
    TopAbs_SOLID,
    TopAbs_VERTEX,
)
from OCP.TopExp import TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Compound, TopoDS_Iterator
from OCP.XCAFApp import XCAFApp_Application
from OCP.XCAFDoc import XCAFDoc_ColorTool, XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

from ..occ.faces import trsf_matrix
from ..occ.triangles import Tolerance
from .meshing import KINDS, Colors, linear, meshed_shape
from .records import Begun, Color, Occurrence, Shape, Tree

try:
    from OCP.TDF import TDF_LabelSequence as Labels
except ImportError:  # OCP 8
    from OCP.collections import Sequence_TDF_Label as Labels

MOST_OCCURRENCES = 1_000_000
"""Occurrences of a tree: a small file can nest assemblies so that they multiply without end."""
MOST_LEVELS = 200


def load(path: str, iges: bool, tolerance: Tolerance, skip: frozenset[int]) -> Iterator[Tree | Begun | Shape]:
    """The tree; then for every shape that it began and what came of it.

    skip: shapes to be left out.
    Raises ValueError for a file that OpenCASCADE does not take.
    """
    document = TDocStd_Document(TCollection_ExtendedString("BinXCAF"))
    XCAFApp_Application.GetApplication_s().InitDocument(document)
    reader = IGESCAFControl_Reader() if iges else STEPCAFControl_Reader()
    reader.SetNameMode(True)
    reader.SetColorMode(True)
    reader.SetLayerMode(True)
    if not iges:
        reader.SetSHUOMode(True)
    if reader.ReadFile(path) != IFSelect_ReturnStatus.IFSelect_RetDone:
        raise ValueError("OpenCASCADE cannot parse it")
    # Names that OpenCASCADE makes up would hide which components are the file's: its reader names these.
    XCAFDoc_ShapeTool.SetAutoNaming_s(iges)
    transferred = reader.Transfer(document)
    XCAFDoc_ShapeTool.SetAutoNaming_s(True)
    if not transferred:
        raise ValueError("OpenCASCADE finds no shape in it")
    walk = _Walk(document, iges, step=not iges)
    yield walk.tree
    for number, (label, shape) in enumerate(walk.shapes):
        if number in skip:
            continue
        yield Begun(number)
        try:
            whole, names = (None, []) if label is None else (_label_color(label), _subshape_names(label))
            colors = Colors(walk.colors, whole, names)
            pieces = meshed_shape(shape, walk.tree.shapes[number], colors, tolerance)
            lines = not pieces and TopExp_Explorer(shape, TopAbs_VERTEX).More()
            yield Shape(number, pieces, lines=lines)
        except Exception as error:  # Standard_Failure in all its forms: this shape alone is lost
            yield Shape(number, [], f"{type(error).__name__}: {error}".splitlines()[0][:200])


def walked(document: Any) -> tuple[Tree, list[Any]]:
    """The tree of a document, and the shapes that it shows."""
    walk = _Walk(document, iges=False, step=False)
    return walk.tree, [shape for _, shape in walk.shapes]


class _Walk:
    """The document's labels as a tree of occurrences, and the labels of the shapes they show."""

    def __init__(self, document: Any, iges: bool, step: bool) -> None:
        main = document.Main()
        self._layers = XCAFDoc_DocumentTool.LayerTool_s(main)
        self.colors = XCAFDoc_DocumentTool.ColorTool_s(main)
        self.shapes: list[tuple[Any, Any]] = []
        self._iges, self._step = iges, step
        self._numbers: dict[str, int] = {}
        self.tree = Tree([], [])
        shapes = XCAFDoc_DocumentTool.ShapeTool_s(main)
        faces: list[Any] = []
        for label in _children(shapes.BaseLabel()):
            if XCAFDoc_ShapeTool.IsShape_s(label) and XCAFDoc_ShapeTool.IsFree_s(label):
                referred = TDF_Label()  # an instance of an IGES subfigure is in no assembly
                is_instance = XCAFDoc_ShapeTool.GetReferredShape_s(label, referred)
                if (
                    iges
                    and not is_instance
                    and XCAFDoc_ShapeTool.GetShape_s(label).ShapeType() == TopAbs_FACE
                ):
                    faces.append(label)
                else:
                    self._add(label, referred if is_instance else label, None, 0, {})
        if faces:
            self._add_faces(faces)

    def _add_faces(self, labels: list[Any]) -> None:
        """The surfaces that an IGES file states one by one, in no group, as the one part that they bound."""
        name = names.pop() if len(names := {_name(label) for label in labels}) == 1 else ""
        key = _entry(labels[0])
        part = Occurrence(
            name, None, np.eye(3, 4), name, key, len(self.shapes), layers=self._layers_of_each(labels)
        )
        self.tree.occurrences.append(part)
        self.shapes.append((None, _compound(map(XCAFDoc_ShapeTool.GetShape_s, labels))))
        self.tree.shapes.append(name)

    def _add(
        self, occurrence: Any, product: Any, parent: int | None, level: int, usages: Mapping[str, Any]
    ) -> None:
        """usages: labels of styles that the assemblies above give to an occurrence within them, by the entries of the usages
        that lead on from here."""
        if level > MOST_LEVELS or len(self.tree.occurrences) >= MOST_OCCURRENCES:
            raise ValueError("its assemblies nest too deep or multiply too often")
        matrix = np.eye(3, 4)
        if parent is not None or occurrence is not product:
            matrix = trsf_matrix(XCAFDoc_ShapeTool.GetLocation_s(occurrence).Transformation())
        elif not (location := XCAFDoc_ShapeTool.GetShape_s(product).Location()).IsIdentity():
            matrix = trsf_matrix(location.Transformation())
        components, pieces = _components(product, self._step)
        is_assembly = bool(components) or XCAFDoc_ShapeTool.IsAssembly_s(product) and not pieces
        own, below = self._usages(occurrence, usages)
        loose = [] if is_assembly or not self._iges else _loose_parts(XCAFDoc_ShapeTool.GetShape_s(product))
        record = Occurrence(
            name=_name(occurrence),
            parent=parent,
            matrix=matrix,
            product=_name(product),
            key=_entry(product),
            shape=None if is_assembly or loose else self._shape(product),
            color=next(filter(None, map(_label_color, own)), None)
            or self._color(occurrence, product, is_assembly),
            layers=self._layers_of(occurrence)
            or self._layers_of(product)
            or self._layers_of_each(map(_referred, pieces)),
            visible=all(map(self.colors.IsVisible_s, (occurrence, *own)))
            if hasattr(self.colors, "IsVisible_s")
            else True,
        )
        self.tree.occurrences.append(record)
        place = len(self.tree.occurrences) - 1
        for number, shape in enumerate(loose, 1):
            name = f"{record.product or 'Part'}:{number}"
            own = Occurrence(
                name,
                place,
                trsf_matrix(shape.Location().Transformation()),
                name,
                f"{record.key}:{number}",
                len(self.shapes),
            )
            self.tree.occurrences.append(own)
            self.shapes.append((product, shape))
            self.tree.shapes.append(name)
        for component, referred in components:
            self._add(component, referred, place, level + 1, below)
        if components and pieces:
            name = record.product or "Part"
            part = Occurrence(
                name, place, np.eye(3, 4), name, f"{record.key}:own", self._own(product, pieces)
            )
            part.layers = self._layers_of_each(map(_referred, pieces))
            self.tree.occurrences.append(part)

    def _usages(self, occurrence: Any, usages: Mapping[str, Any]) -> tuple[list[Any], dict[str, Any]]:
        """Styles that a specified higher usage gives to this very occurrence, outermost first; and those for what is in it."""
        own: list[Any] = []
        below: dict[str, Any] = {}
        for label in _children(occurrence):
            style = usages.get(_entry(label))
            if style is None and not _linked(XCAFDoc_ShapeTool.GetSHUOUpperUsage_s, label):
                style = label
            if style is not None:
                nexts = _linked(XCAFDoc_ShapeTool.GetSHUONextUsage_s, label)
                below.update((_entry(one), style) for one in nexts)
                if not nexts and style is not label:
                    own.append(style)
        return own, below

    def _shape(self, product: Any) -> int:
        entry = _entry(product)
        if entry not in self._numbers:
            self._numbers[entry] = len(self.shapes)
            self.shapes.append((product, XCAFDoc_ShapeTool.GetShape_s(product)))
            self.tree.shapes.append(_name(product))
        return self._numbers[entry]

    def _own(self, product: Any, pieces: list[Any]) -> int:
        """The shape of an assembly itself, beside its components."""
        entry = f"{_entry(product)}:own"
        if entry not in self._numbers:
            self._numbers[entry] = len(self.shapes)
            self.shapes.append((product, _compound(map(XCAFDoc_ShapeTool.GetShape_s, pieces))))
            self.tree.shapes.append(_name(product))
        return self._numbers[entry]

    def _color(self, occurrence: Any, product: Any, is_assembly: bool) -> Color | None:
        """Given to the occurrence; to an assembly also by its product, which a shape's own faces have already."""
        own = None if occurrence is product else _label_color(occurrence)
        return own or (_label_color(product) if is_assembly else None)

    def _layers_of(self, label: Any) -> tuple[str, ...]:
        names = self._layers.GetLayers(label)
        if names is None:
            return ()
        return tuple(names.Value(i).ToExtString() for i in range(1, names.Length() + 1))

    def _layers_of_each(self, labels: Iterable[Any]) -> tuple[str, ...]:
        """Layers of what is one part, each once."""
        return tuple(dict.fromkeys(layer for label in labels for layer in self._layers_of(label)))


def _compound(shapes: Iterable[Any]) -> Any:
    whole, builder = TopoDS_Compound(), BRep_Builder()
    builder.MakeCompound(whole)
    for shape in shapes:
        builder.Add(whole, shape)
    return whole


def _components(product: Any, step: bool) -> tuple[list[tuple[Any, Any]], list[Any]]:
    """What an assembly is made of, each with its product; and, in a STEP file, the pieces of its own shape.

    A product of it may state several shapes, a solid and beside it curves or surfaces: they are one rigid part, and
    OpenCASCADE makes components of them.  Those that the file states have the names that it gives them.
    """
    components: list[tuple[Any, Any]] = []
    pieces: list[Any] = []
    for child in _children(product) if XCAFDoc_ShapeTool.IsAssembly_s(product) else ():
        if not XCAFDoc_ShapeTool.IsComponent_s(child) or (referred := _referred(child)) is None:
            continue
        if not step or _is_named(child) or _is_named(referred):
            components.append((child, referred))
        else:
            pieces.append(child)
    return components, pieces


def _referred(component: Any) -> Any:
    """The label of what a component is an instance of, or None."""
    referred = TDF_Label()
    return referred if XCAFDoc_ShapeTool.GetReferredShape_s(component, referred) else None


def _children(label: Any) -> Iterator[Any]:
    children = TDF_ChildIterator(label, False)
    while children.More():
        yield children.Value()
        children.Next()


def _linked(ask: Any, label: Any) -> list[Any]:
    """The labels that a usage leads to, on the level above or below."""
    found = Labels()
    ask(label, found)
    return [found.Value(i) for i in range(1, found.Length() + 1)]


def _is_named(label: Any) -> bool:
    return bool(label.IsAttribute(TDataStd_Name.GetID_s()))


def _name(label: Any) -> str:
    # The binding crashes where FindAttribute finds nothing.
    if not _is_named(label):
        return ""
    name = TDataStd_Name()
    label.FindAttribute(TDataStd_Name.GetID_s(), name)
    return name.Get().ToExtString()


def _loose_parts(shape: Any) -> list[Any]:
    """The parts of an IGES file, which knows no assemblies: what a compound holds, several levels down where it holds
    one thing alone; none where it is one part."""
    while shape.ShapeType() == TopAbs_COMPOUND:
        inside = TopoDS_Iterator(shape)
        held: list[Any] = []
        while inside.More():
            held.append(inside.Value())
            inside.Next()
        solids = [
            part
            for part in held
            if part.ShapeType() in (TopAbs_COMPOUND, TopAbs_COMPSOLID, TopAbs_SOLID, TopAbs_SHELL)
        ]
        if len(held) == 1:
            shape = held[0]
            continue
        return solids if len(solids) == len(held) else []
    return []


def _entry(label: Any) -> str:
    entry = TCollection_AsciiString()
    TDF_Tool.Entry_s(label, entry)
    return entry.ToCString()


def _label_color(label: Any) -> Color | None:
    """The colour of a label: of its surfaces, else its general one."""
    color = Quantity_ColorRGBA()
    for kind in KINDS:
        if XCAFDoc_ColorTool.GetColor_s(label, kind, color):
            return linear(color)
    return None


def _subshape_names(label: Any) -> list[tuple[Any, str]]:
    """Shapes within a part that have a name of their own: its solids."""
    found = []
    for child in _children(label):
        if XCAFDoc_ShapeTool.IsSubShape_s(child) and (name := _name(child)):
            found.append((XCAFDoc_ShapeTool.GetShape_s(child).Located(TopLoc_Location()), name))
    return found
