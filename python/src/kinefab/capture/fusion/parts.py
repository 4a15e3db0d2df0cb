"""Fusion's components: meshes, looks and mass of their bodies, read once for all their occurrences.

Standard library only: it runs in Fusion's own Python.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import cast

from ..channel import MemberFailed
from ..draft import BodyMesh, Draft, Numbers, Record
from ..looks import look, painted
from ..masses import mass_record, together
from .api import Appearance, Body, Component, Face, PhysicalProperties, RootComponent

NORMAL_QUALITY = 11
HIGH_ACCURACY = 2
"""CalculationAccuracy; what a component is asked by default may be off by a hundredth."""
OF_THE_FACE = frozenset({3, 4})
"""AppearanceSourceTypes: assigned to the face, an override."""
FULL = 255.0
COLORS = (
    "opaque_albedo",
    "generic_diffuse",
    "metal_f0",
    "layered_diffuse",
    "transparent_color",
    "surface_albedo",
)
"""Key names of the colour in the schemas of Autodesk's appearances; they are the same in all languages."""


@dataclass(slots=True)
class Parts:
    """definitions: bodies and mass of each component that was read, by its name."""

    draft: Draft
    definitions: dict[str, Record] = field(default_factory=dict[str, Record])

    def read(self, name: str, component: Component) -> Record:
        """``bodies`` and ``mass`` of a component."""
        if name not in self.definitions:
            found: Record = {}
            with self.draft.safely(f"meshes of {name}"):
                self._bodies(name, component, found)
            with self.draft.safely(f"mass of {name}"):
                properties = component.getPhysicalProperties(HIGH_ACCURACY)
                if mass := self._mass(name, properties, self.draft.meshes.get(name, ())):
                    found["mass"] = mass
            self.definitions[name] = found
        return self.definitions[name]

    def read_bodies(self, name: str, component: Component | RootComponent) -> Record:
        """The same of a component's own bodies alone, without its children's: its mass would have theirs in it."""
        if name not in self.definitions:
            found: Record = {}
            with self.draft.safely(f"meshes of {name}"):
                self._bodies(name, component, found)
            with self.draft.safely(f"mass of {name}"):
                meshes = self.draft.meshes.get(name, [])
                masses = [
                    mass
                    for i, body in enumerate(_listed(component))
                    if (
                        mass := self._mass(name, body.getPhysicalProperties(HIGH_ACCURACY), meshes[i : i + 1])
                    )
                ]
                if masses:
                    found["mass"] = together(masses)
            self.definitions[name] = found
        return self.definitions[name]

    def _bodies(self, name: str, component: Component | RootComponent, found: Record) -> None:
        listed = _listed(component)
        meshes = [_mesh(body) for body in listed]
        if not meshes:
            return
        self.draft.meshes[name] = meshes
        found["bodies"] = [{"id": mesh.name, "meshKey": mesh.name} for mesh in meshes]
        with self.draft.safely(f"colours of faces of {name}"):
            painted(self.draft, name, sum(map(_painted, listed)))
        for body, record in zip(listed, found["bodies"]):
            with self.draft.safely(f"appearance of {name}/{record['id']}"):
                material, shown = body.material, body.appearance
                color = None if shown is None else _color(shown)
                if shown is not None and color is None:
                    self.draft.report.approximated(
                        f"appearance {shown.name} of {name}", "CAPTURE_NO_COLOR", program=self.draft.program
                    )
                if made := look(self.draft, "" if material is None else material.name, color, name):
                    record["material"] = made

    def _mass(
        self, name: str, properties: PhysicalProperties | None, meshes: Sequence[BodyMesh]
    ) -> Record | None:
        """The moments are documented about the origin."""
        if properties is None or (mass := float(properties.mass)) <= 0.0:
            return None
        _, *moments = properties.getXYZMomentsOfInertia()
        _, *principal = properties.getPrincipalMomentsOfInertia()
        center = list(properties.centerOfMass.asArray())
        return mass_record(
            self.draft, name, mass, center, moments, [float(v) for v in principal], "origin", meshes
        )


def _listed(component: Component | RootComponent) -> list[Body]:
    bodies = component.bRepBodies
    return [cast(Body, bodies.item(i)) for i in range(bodies.count)]


def _painted(body: Body) -> int:
    """How many of its faces have an appearance of their own."""
    faces = body.faces
    listed = [cast(Face, faces.item(i)) for i in range(faces.count)]
    return sum(face.appearanceSourceType in OF_THE_FACE for face in listed)


def _mesh(body: Body) -> BodyMesh:
    calculator = body.meshManager.createMeshCalculator()
    calculator.setQuality(NORMAL_QUALITY)
    mesh = calculator.calculate()
    points = [float(v) for v in mesh.nodeCoordinatesAsDouble]
    return BodyMesh(" ".join(body.name.split()), points, [int(i) for i in mesh.nodeIndices])


def _color(appearance: Appearance) -> Numbers | None:
    """Red green blue and opacity, 0 to 1, of the first key that an appearance has; None where it has none."""
    for key in COLORS:
        try:
            held = appearance.appearanceProperties.itemById(key)
            color = None if held is None else held.value
            if color is not None:
                return [v / FULL for v in (color.red, color.green, color.blue, color.opacity)]
        except (MemberFailed, AttributeError):
            continue
    return None
