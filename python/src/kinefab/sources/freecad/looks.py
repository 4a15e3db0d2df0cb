"""Colours of GuiDocument.xml, face by face, and the densities of materials that a document holds.

FreeCAD's colours are those of the screen, the scene's are linear.  Its numbers are 0xRRGGBBAA; transparency is a number
of its own.  Without GuiDocument.xml (a document saved without a window) parts take the exporter's own look.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Callable
from xml.etree.ElementTree import Element

from ...color import linear
from ...diagnostics import KinefabError, Report
from ...model import AlphaMode, Scene, Surface
from ..reading.record import shown
from ..reading.xml_text import parse_xml
from .archive import ArchiveError
from .document import Document, Target, Thing
from .parts import ShownShape

Look = tuple[int, int, int, float, float]
"""Red, green, blue 0..255, opacity and shininess 0..1."""

DENSITY = re.compile(r"\s*([0-9.]+(?:[eE][-+]?[0-9]+)?)\s*([a-z]*)\s*/\s*(mm|cm|dm|m)\^?3\s*$")
DEFAULT_MATERIAL = "7f9fd73b-50c9-41d8-b7b2-575a030c1eeb"
"""What FreeCAD writes where nobody chose a material."""
LIBRARY = {
    "90bbd8ef-8623-4d78-b3bf-e0bdb9b74dd3": ("Steel-Generic", 7900.0),
    "4a96627d-6518-458c-8ccf-846f69fd8a50": ("Steel-S235JR", 7800.0),
    "1826c364-d26a-43fb-8f61-288281236836": ("Iron-Generic", 7874.0),
    "27745e16-2a10-4c8e-bd22-59971806909c": ("Invar-Generic", 8150.0),
    "6c03899d-496e-4c60-a41b-3d66f2337fb9": ("Copper-Generic", 8960.0),
    "9bf060e9-1663-44a2-88e2-2ff6ee858efe": ("Aluminum-Generic", 2700.0),
    "68b152b2-fd5e-4f10-8db0-1a2df3fe0fda": ("Aluminum-6061-T6", 2700.0),
    "f8013463-8008-4063-818c-ab6884cfa015": ("Ti-6Al-4V", 4430.0),
    "73371529-2983-47dd-b988-6739a2e20029": ("ABS-Generic", 1060.0),
    "f255cd82-91d5-4e97-9032-1843128a2eaa": ("Acrylic-Glass-Generic", 1160.0),
    "9d59dc3b-ce66-4bec-82c9-b962082e7c9e": ("PA6-Generic", 1150.0),
    "f73004e3-6fb4-4591-8be7-89d1370be312": ("PET-Generic", 1380.0),
    "93861244-fbbe-41a9-a7e0-aeed53abd782": ("PLA-Generic", 1240.0),
    "0e669f57-de27-4915-9a02-124f36047972": ("PP-Generic", 916.0),
    "8ce226db-43ef-4471-93f1-07e7276aa276": ("PTFE-Generic", 2070.0),
    "758cfc44-f4ad-4605-8645-75e9e6b053ab": ("PVC-Generic", 1380.0),
    "3e3a3e13-04a4-410e-8e36-bbd83ca66847": ("Glass-Generic", 2520.0),
    "26042aa5-56e6-4d99-8b63-dd8b9ea5a37a": ("Concrete-Generic", 2400.0),
    "b588224e-e8d6-47ad-ba1f-a058333fd1c6": ("Wood-Generic", 700.0),
}
"""Common materials by the number that a document has of them: name, and kg/m^3 as FreeCAD 1.0 weighs them.  A user may have
changed a card of that number, so each is told as taken."""
KILOGRAMS = {"kg": 1.0, "g": 1e-3, "t": 1e3}
CUBIC_METRES = {"mm": 1e-9, "cm": 1e-6, "dm": 1e-3, "m": 1.0}


class Looks:
    """Finds looks; adds each to the scene's surfaces once.  follow: a link's target."""

    def __init__(self, scene: Scene, report: Report, follow: Callable[[Thing, Target], Thing | None]):
        self._scene, self._report, self._follow = scene, report, follow
        self._views: dict[int, dict[str, dict[str, Element]]] = {}
        self._surfaces: dict[Look, int] = {}
        self._told: set[str] = set()

    def of(self, shape: ShownShape, faces: int) -> list[int]:
        """Surfaces of a shape's faces: one for each, one for all, or none where no look is saved."""
        by = shape.by.thing
        override = self._view(by)
        if (
            by is not shape.owner
            and (flag := override.get("OverrideMaterial")) is not None
            and flag.get("value") == "true"
        ):
            found = self._material(override.get("ShapeMaterial"))
        else:
            found = self._looks(shape.owner)
        if len(found) != faces:
            found = found[:1]
        return [self._surface(look) for look in found]

    def density(self, shape: ShownShape) -> float | None:
        """kg/m^3 of the material object that the shape's owner, or a container above, links to, else of its material of
        FreeCAD's library where that is a common one."""
        holders = [shape.owner]
        above = shape.by
        while above is not None:
            holders += [above.thing, *([above.target] if above.target is not None else [])]
            above = above.parent
        for holder in holders:
            target = holder.target("Material")
            material = None if target is None else self._follow(holder, target)
            if material is not None and material.has("Material"):
                for item in material.values["Material"].iter("Item"):
                    if item.get("key") == "Density" and (match := DENSITY.match(item.get("value", ""))):
                        density = float(match[1]) * KILOGRAMS.get(match[2], 0.0) / CUBIC_METRES[match[3]]
                        if 0.0 < density < 1e9:
                            return density
        given = shape.owner.values.get("ShapeMaterial")
        material = "" if given is None else given.get("uuid", "")
        name, density = LIBRARY.get(material, (shown(material), None))
        if material not in ("", DEFAULT_MATERIAL) and material not in self._told:
            self._told.add(material)
            where, values = shape.owner.where, {"object": shown(shape.owner.label), "material": name}
            if density is None:
                self._report.add("FREECAD_MATERIAL", where, **values)
            else:
                feature = f"density of {name}"
                self._report.approximated(feature, "FREECAD_DENSITY", where, **values, density=f"{density:g}")
        return density

    def _view(self, thing: Thing) -> dict[str, Element]:
        """The view properties of an object, by name."""
        document = thing.document
        if id(document) not in self._views:
            self._views[id(document)] = self._read(document)
        return self._views[id(document)].get(thing.name, {})

    def _read(self, document: Document) -> dict[str, dict[str, Element]]:
        if "GuiDocument.xml" not in document.archive:
            return {}
        own = Report()
        try:
            content = document.archive.read("GuiDocument.xml")
            root = parse_xml(content, f"{document.path.name}/GuiDocument.xml", own)
        except (ArchiveError, KinefabError) as error:
            where = f"{document.path.name}/GuiDocument.xml"
            self._report.add(
                "FREECAD_VALUE", where, object=document.path.name, property="colours", detail=str(error)
            )
            return {}
        found: dict[str, dict[str, Element]] = {}
        for provider in root.iter("ViewProvider"):
            properties = found.setdefault(provider.get("name", ""), {})
            for entry in provider.iterfind("Properties/Property"):
                if (value := next(iter(entry), None)) is not None:
                    properties[entry.get("name", "")] = value
        return found

    def _looks(self, owner: Thing) -> list[Look]:
        view = self._view(owner)
        if (listed := view.get("ShapeAppearance")) is not None:
            return self._appearance(owner, listed)
        opacity = 1.0 - _share(view.get("Transparency")) / 100.0
        if (listed := view.get("DiffuseColor")) is not None and listed.get("file"):
            content = self._member(owner, listed.get("file", ""))
            count = min((len(content) - 4) // 4, 10_000_000)
            colours = struct.unpack_from(f"<{count}I", content, 4) if count > 0 else ()
            if colours:
                return [(*_rgb(colour), opacity, 0.5) for colour in colours]
        if (colour := view.get("ShapeColor")) is not None:
            return [(*_rgb(_packed(colour.get("value", ""))), opacity, 0.5)]
        return self._material(view.get("ShapeMaterial"))

    def _material(self, value: Element | None) -> list[Look]:
        if value is None or not value.get("diffuseColor"):
            return []
        opacity = 1.0 - min(1.0, max(0.0, _number(value.get("transparency", "0"))))
        shine = min(1.0, max(0.0, _number(value.get("shininess", "0.5"))))
        return [(*_rgb(_packed(value.get("diffuseColor", ""))), opacity, shine)]

    def _appearance(self, owner: Thing, listed: Element) -> list[Look]:
        """FreeCAD 1.0's list: a count, then for each face four colours, shininess and transparency; texts stand behind."""
        content = self._member(owner, listed.get("file", ""))
        found: list[Look] = []
        try:
            (count,) = struct.unpack_from("<I", content, 0)
            at = 4
            for _ in range(min(count, 10_000_000)):
                _, diffuse, _, _, shine, transparency = struct.unpack_from("<4I2f", content, at)
                at += 24
                if not (0.0 <= shine <= 1.0 and 0.0 <= transparency <= 1.0):
                    break
                found.append((*_rgb(diffuse), 1.0 - round(transparency, 4), round(shine, 4)))
        except struct.error:
            self._report.add(
                "FREECAD_VALUE",
                owner.where,
                object=owner.label,
                property="ShapeAppearance",
                detail="its list is cut short",
            )
        return found

    def _member(self, owner: Thing, name: str) -> bytes:
        try:
            return owner.document.archive.read(name) if name else b""
        except ArchiveError as error:
            self._report.add(
                "FREECAD_VALUE", owner.where, object=owner.label, property="colours", detail=str(error)
            )
            return b""

    def _surface(self, look: Look) -> int:
        if look not in self._surfaces:
            red, green, blue, opacity, shine = look
            self._surfaces[look] = len(self._scene.surfaces)
            name = f"#{red:02X}{green:02X}{blue:02X}" + (f" {opacity:.0%}" if opacity < 1.0 else "")
            alpha = AlphaMode.BLEND if opacity < 1.0 else AlphaMode.OPAQUE
            color = (linear(red / 255.0), linear(green / 255.0), linear(blue / 255.0), opacity)
            self._scene.surfaces.append(Surface(name, color, smoothness=shine, alpha_mode=alpha))
        return self._surfaces[look]


def _rgb(packed: int) -> tuple[int, int, int]:
    return packed >> 24 & 255, packed >> 16 & 255, packed >> 8 & 255


def _packed(text: str) -> int:
    return int(text) & 0xFFFFFFFF if text.isdecimal() and len(text) < 12 else 0xCCCCCC00


def _number(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        return 0.0
    return number if abs(number) < 1e9 else 0.0


def _share(value: Element | None) -> float:
    return 0.0 if value is None else min(100.0, max(0.0, _number(value.get("value", "0"))))
