"""Materials: stated for the robot or in the first visual that names them, used by name anywhere."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import PurePosixPath

from ...color import linear
from ...diagnostics import Report
from ...model import Surface, Texture
from ..robots.colors import clamped
from ..robots.packages import Packages
from ..robots.xml_elements import Element

GREY = (0.8, 0.8, 0.8, 1.0)


@dataclass(slots=True)
class Materials:
    """surfaces: the scene's, which grow.  A material without a colour of its own is looked for among all stated ones, also
    those that come later in the file."""

    surfaces: list[Surface]
    packages: Packages
    report: Report
    _stated: dict[str, Element] = field(default_factory=dict[str, Element])
    _made: dict[tuple[str, str], int] = field(default_factory=dict[tuple[str, str], int])

    def collect(self, robot: Element) -> None:
        """Note where every material is stated: the robot's own first."""
        for element in [*robot.all("material"), *_in_visuals(robot)]:
            name = element.attributes.get("name", "")
            if name and name not in self._stated and (element.child("color") or element.child("texture")):
                self._stated[name] = element

    def of(self, visual: Element, feature: str) -> tuple[int, ...]:
        """The surface of a visual, none where it names no material."""
        element = visual.child("material")
        if element is None:
            return ()
        name = element.attributes.get("name", "")
        if not (element.child("color") or element.child("texture")):
            if name not in self._stated:
                if name:
                    element.fault("MATERIAL_NOT_STATED", material=name, feature=feature)
                return ()
            element = self._stated[name]
        key = (name, element.where)
        if key not in self._made:
            self._made[key] = len(self.surfaces)
            self.surfaces.append(self._surface(name or "Default", element))
        return (self._made[key],)

    def _surface(self, name: str, element: Element) -> Surface:
        color, texture = element.child("color"), element.child("texture")
        red, green, blue, alpha = GREY if color is None else self._color(color, name)
        if color is not None:
            red, green, blue = linear(red), linear(green), linear(blue)
        image = None if texture is None else self._texture(texture)
        if image is not None and color is None:
            red = green = blue = alpha = 1.0
        from ...model import AlphaMode

        mode = AlphaMode.BLEND if alpha < 1.0 else AlphaMode.OPAQUE
        return Surface(name, (red, green, blue, alpha), alpha_mode=mode, color_texture=image)

    def _color(self, element: Element, name: str) -> tuple[float, ...]:
        """RGBA; grey, told, where it is none: a robot moves without its colours, and programs that read it go on.  Three
        numbers are opaque, as everybody understands them."""
        count = 3 if len(element.attributes.get("rgba", "").replace(",", " ").split()) == 3 else 4
        before, feature = len(self.report.diagnostics), f"colour of material {name}"
        found = element.numbers("rgba", count, GREY[:count])
        if self.report.forgive(before, feature, "SHAPE_UNREADABLE"):
            return GREY
        return clamped((*found, 1.0)[:4], feature, element.where, self.report)

    def _texture(self, element: Element) -> Texture | None:
        uri = element.attributes.get("filename", "").strip()
        if not uri:
            return None
        found = self.packages.find(uri)
        if found.path is None:
            element.report.dropped(f"texture {uri}", "TEXTURE_NOT_FOUND", element.where, file=uri)
            return None
        return Texture(PurePosixPath(uri).name, found.path)


def _in_visuals(robot: Element) -> list[Element]:
    visuals = [visual for link in robot.all("link") for visual in link.all("visual")]
    return [m for visual in visuals for m in visual.all("material")]
