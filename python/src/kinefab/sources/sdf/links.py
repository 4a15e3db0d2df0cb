"""Links of an SDF model: inertial, visuals, collisions."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...diagnostics import Report
from ...spatial import Pose, frame_from_axes
from ..robots.inertial import Inertial, tensor
from ..robots.rigid_links import Link, Part, Solid, unique
from ..robots.shapes import PLANE_EXTENT, Shape, mesh_shape
from ..robots.xml_elements import Element, truth
from .materials import Materials, physics_material
from .scopes import Entry, Scope, entry_world_pose, frame_pose, pose_of, relative_to

WATER = 1000.0
"""kg/m^3 of a collision for which nothing else is stated."""
ROUND = {
    "sphere": ("radius",),
    "cylinder": ("radius", "length"),
    "capsule": ("radius", "length"),
    "cone": ("radius", "length"),
}


@dataclass(slots=True)
class Links:
    """Makes links; report: of what is left out."""

    materials: Materials
    report: Report
    _taken: dict[str, object] = field(default_factory=dict[str, object])

    def link(self, entry: Entry, parent: int | None) -> Link:
        """parent: index of the node that stands for its model."""
        element, scope = entry.element, entry.owner
        link = Link(f"{scope.path}/{entry.name}", entry.name, entry_world_pose(entry), element.where)
        link.parent, link.grounded = parent, scope.static
        label, before = f"link {link.id}", len(self.report.diagnostics)
        link.inertial = None if scope.static else _inertial(element, entry.name)
        link.solid = _solid(element, entry.name) if _is_solid(element) and not scope.static else None
        # A model stands and moves without it.
        if self.report.forgive(before, f"inertial of {label}", "VALUE_UNREADABLE"):
            link.inertial = None
        link.drawn = self._parts(element, "visual", scope, label)
        link.touched = self._parts(element, "collision", scope, label)
        link.gravity = truth(element.content("gravity"), True)
        link.kinematic = truth(element.content("kinematic"))
        return link

    def _parts(self, link: Element, tag: str, scope: Scope, label: str) -> list[Part]:
        found: dict[str, Part] = {}
        for element in link.all(tag):
            given = element.attributes.get("name", "").strip()
            name = unique(found, given or tag)
            feature = f"{tag} {name} of {label}"
            geometry = element.child("geometry")
            shaped = None if geometry is None else self._shape(geometry, feature, scope, tag)
            if geometry is None:
                self.report.dropped(feature, "SHAPE_EMPTY", element.where, shape=tag)
            if shaped is None:
                continue
            shape, turn = shaped
            base = relative_to(element, scope)
            pose = pose_of(element)
            if base:  # counted from another frame: by way of the model's
                own = frame_pose(link.attributes.get("name", "").strip(), scope, element, feature)
                pose = own.inverse() @ frame_pose(base, scope, element, feature) @ pose
            surfaces = self.materials.of(element, scope.packages, feature) if tag == "visual" else ()
            material = (
                physics_material(element, f"{link.attributes.get('name', '')}/{name}", feature)
                if tag == "collision"
                else None
            )
            density = _density(element, link) if tag == "collision" and _is_solid(link) else WATER
            found[name] = Part(name, shape, pose @ turn, surfaces, material, density=density, counted=not given)
        return list(found.values())

    def _shape(self, geometry: Element, feature: str, scope: Scope, tag: str) -> tuple[Shape, Pose] | None:
        """The shape, and how it lies in the frame of its visual or collision."""
        for child in geometry.children:
            if child.tag == "empty":
                return None
            if child.tag == "mesh":
                shape = self._mesh(child, feature, scope)
                return None if shape is None else (shape, Pose())
            if child.tag == "plane":
                return _plane(child, tag)
            size = _size(child)
            if size is None:
                code = (
                    "ELEMENT_DROPPED"
                    if child.tag in ("heightmap", "image", "polyline")
                    else "ELEMENT_UNKNOWN"
                )
                values = {"element": child.tag, "inside": geometry.tag} if code == "ELEMENT_UNKNOWN" else {}
                self.report.dropped(f"{child.tag} of {feature}", code, child.where, **values)
                return None
            if not all(v > 0.0 for v in size):
                self.report.dropped(feature, "SHAPE_EMPTY", child.where, shape=child.tag)
                return None
            return Shape(child.tag, size, where=child.where), Pose()
        return None

    def _mesh(self, element: Element, feature: str, scope: Scope) -> Shape | None:
        uri = element.content("uri")
        if not uri:
            element.fault("XML_MISSING", element="mesh", field="uri")
            return None
        scale = element.child("scale")
        factors = (1.0, 1.0, 1.0) if scale is None else scale.values(3, (1.0, 1.0, 1.0))
        submesh = element.child("submesh")
        key = None if submesh is None else submesh.content("name") or None
        if submesh is not None and truth(submesh.content("center")):
            self.report.dropped(f"centring of {feature}", "ELEMENT_DROPPED", submesh.where)
        return mesh_shape(uri, factors, scope.packages, feature, element.where, self.report, key)


def _size(element: Element) -> tuple[float, ...] | None:
    """Metres; None for a shape that is not known here."""
    if element.tag in ("box", "ellipsoid"):
        child = element.child("size" if element.tag == "box" else "radii")
        return (1.0, 1.0, 1.0) if child is None else child.values(3, (1.0, 1.0, 1.0))
    if element.tag in ROUND:
        children = [element.child(key) for key in ROUND[element.tag]]
        return tuple(1.0 if child is None else child.value(1.0) for child in children)
    return None


def _plane(element: Element, tag: str) -> tuple[Shape, Pose] | None:
    """A rectangle across its normal; one that is touched has no end."""
    normal_element, size_element = element.child("normal"), element.child("size")
    normal = np.array(
        (0.0, 0.0, 1.0) if normal_element is None else normal_element.values(3, (0.0, 0.0, 1.0))
    )
    if not np.linalg.norm(normal) > 1e-9:
        element.fault("AXIS_ZERO", field="normal")
        return None
    size = (1.0, 1.0) if size_element is None else size_element.values(2, (1.0, 1.0))
    if tag == "collision":
        size = (PLANE_EXTENT, PLANE_EXTENT)
    if not all(v > 0.0 for v in size):
        return None
    upright = normal / np.linalg.norm(normal)
    turn = np.eye(3) if upright[2] > 1.0 - 1e-12 else frame_from_axes(upright)[:, [1, 2, 0]]
    return Shape("plane", tuple(size), where=element.where), Pose(turn)


def _is_solid(link: Element) -> bool:
    """Whether its collisions say how a link's mass is spread, and how large it is where the link states none."""
    element = link.child("inertial")
    return element is not None and truth(element.attributes.get("auto", ""))


def _solid(link: Element, name: str) -> Solid:
    element = link.child("inertial")
    stated = element is not None and element.child("mass") is not None
    return Solid(_mass(element, name) or None if element is not None and stated else None)


def _density(part: Element, link: Element) -> float:
    """kg/m^3 of a collision: its own, else its link's, else water's."""
    inertial = link.child("inertial")
    for holder in (part, inertial):
        child = None if holder is None else holder.child("density")
        if child is None:
            continue
        density = child.value(WATER)
        if density > 0.0:
            return density
        child.wrong("density", "a number above zero", child.text.strip())
    return WATER


def _mass(inertial: Element, name: str) -> float:
    """kg; zero after a fault."""
    child = inertial.child("mass")
    mass = 1.0 if child is None else child.value(1.0)
    if mass < 0.0:
        inertial.fault("MASS_IMPOSSIBLE", node=name, detail=f"the mass is {mass:g} kg")
        return 0.0
    return mass


def _inertial(link: Element, name: str) -> Inertial | None:
    """As stated; SDF's own default is 1 kg and 1 kg m^2.  None where it is to be had from the geometry, or none."""
    element = link.child("inertial")
    if element is None:
        return Inertial(1.0, Pose(), np.eye(3))
    if _is_solid(link):
        return None
    mass, inertia = _mass(element, name), element.child("inertia")
    if mass == 0.0:  # what models that were made for a fixed base say of it
        return None
    values = {"ixx": 1.0, "iyy": 1.0, "izz": 1.0, "ixy": 0.0, "ixz": 0.0, "iyz": 0.0}
    for key in values:
        child = None if inertia is None else inertia.child(key)
        if child is not None:
            values[key] = child.value(values[key])
    return Inertial(mass, pose_of(element), tensor(*values.values()))
