"""Materials of visuals, and what collisions say of friction and bounce."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import PurePosixPath

from ...color import linear
from ...model import AlphaMode, PhysicsMaterial, Surface, Texture
from ..robots.colors import clamped
from ..robots.packages import Packages
from ..robots.xml_elements import Element, truth
from .gazebo_colors import GAZEBO_COLORS

GREY = (0.8, 0.8, 0.8, 1.0)
BLACK = (0.0, 0.0, 0.0, 1.0)


@dataclass(slots=True)
class Materials:
    """surfaces: the scene's, which grow; equal ones are one."""

    surfaces: list[Surface]
    _known: dict[tuple[object, ...], int] = field(default_factory=dict[tuple[object, ...], int])

    def of(self, visual: Element, packages: Packages, feature: str) -> tuple[int, ...]:
        """The surface of a visual, none where it states no material."""
        element = visual.child("material")
        if element is None:
            return ()
        script = element.child("script")
        own = GREY
        if script is not None and element.child("diffuse") is None and element.child("pbr") is None:
            name = script.content("name")
            if name not in GAZEBO_COLORS:
                element.report.dropped(
                    f"material script {name} of {feature}", "ELEMENT_DROPPED", script.where
                )
                return ()
            red, green, blue, alpha = GAZEBO_COLORS[name]
            own = (linear(red), linear(green), linear(blue), alpha)
        surface = _surface(element, visual, packages, own, feature)
        key = (*(getattr(surface, n) for n in ("color", "metallic", "smoothness", "emission", "double_sided")),
               surface.color_texture, surface.normal_texture, surface.emission_texture)  # fmt: skip
        if key not in self._known:
            self._known[key] = len(self.surfaces)
            self.surfaces.append(surface)
        return (self._known[key],)


def _surface(
    element: Element,
    visual: Element,
    packages: Packages,
    own: tuple[float, float, float, float],
    feature: str,
) -> Surface:
    """own: RGBA, linear, of one that states no diffuse colour."""
    red, green, blue, alpha = _color(element, "diffuse", own, feature)
    faint = visual.child("transparency")
    alpha *= 1.0 - min(1.0, max(0.0, 0.0 if faint is None else faint.value(0.0)))
    emissive = _color(element, "emissive", BLACK, feature)
    pbr = element.child("pbr")
    metal = None if pbr is None else pbr.child("metal") or pbr.child("specular")
    if metal is not None and element.child("diffuse") is None:
        red = green = blue = 1.0
    double = element.child("double_sided")
    return Surface(
        str(visual.attributes.get("name", "") or "Material"),
        (red, green, blue, alpha),
        0.0 if metal is None else _share(metal, "metalness", 0.5 if metal.tag == "metal" else 0.0),
        1.0 - _share(metal, "roughness", 0.5) if metal is not None else 0.5,
        AlphaMode.BLEND if alpha < 1.0 else AlphaMode.OPAQUE,
        double_sided=double is not None and truth(double.text),
        emission=emissive[:3],
        color_texture=_texture(metal, "albedo_map", packages),
        normal_texture=_texture(metal, "normal_map", packages),
        emission_texture=_texture(metal, "emissive_map", packages),
    )


def _color(
    element: Element, tag: str, default: tuple[float, float, float, float], feature: str
) -> tuple[float, float, float, float]:
    """RGBA, linear; three numbers have an alpha of 1."""
    child = element.child(tag)
    if child is None or not child.text.strip():
        return default
    count = 3 if len(child.text.split()) == 3 else 4
    found = (*child.values(count, default[:count]), 1.0)
    red, green, blue, alpha = clamped(found[:4], f"{tag} colour of {feature}", child.where, child.report)
    return linear(red), linear(green), linear(blue), alpha


def _share(element: Element, tag: str, default: float) -> float:
    child = element.child(tag)
    return min(1.0, max(0.0, default if child is None else child.value(default)))


def _texture(element: Element | None, tag: str, packages: Packages) -> Texture | None:
    child = None if element is None else element.child(tag)
    uri = "" if child is None else child.text.strip()
    if child is None or not uri:
        return None
    found = packages.find(uri)
    if found.path is None:
        child.report.dropped(f"texture {uri}", "TEXTURE_NOT_FOUND", child.where, file=uri)
        return None
    return Texture(PurePosixPath(uri).name, found.path)


def physics_material(collision: Element, name: str, feature: str) -> PhysicsMaterial | None:
    """Of ``<surface>``: Coulomb friction and restitution; None where it says nothing of them."""
    surface = collision.child("surface")
    friction = None if surface is None else surface.child("friction")
    ode = None if friction is None else friction.child("ode")
    bounce = None if surface is None else surface.child("bounce")
    mu = None if ode is None else ode.child("mu")
    restitution = None if bounce is None else bounce.child("restitution_coefficient")
    if mu is None and restitution is None:
        return None
    coefficient = 1.0 if mu is None else max(0.0, mu.value(1.0, infinite=True))
    across = (
        coefficient if ode is None or (mu2 := ode.child("mu2")) is None else mu2.value(1.0, infinite=True)
    )
    if across != coefficient:
        collision.report.dropped(f"second friction of {feature}", "ELEMENT_DROPPED", collision.where)
    rebound = 0.0 if restitution is None else min(1.0, max(0.0, restitution.value(0.0)))
    bounded = min(coefficient, 1e6)
    return PhysicsMaterial(name, bounded, bounded, rebound)
