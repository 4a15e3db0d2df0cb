"""Links: inertial frames, what is drawn and what is touched."""

from __future__ import annotations

import numpy as np

from ...diagnostics import Report
from ...spatial import Pose
from ..reading.record import shown
from ..robots.inertial import Inertial, tensor
from ..robots.packages import Packages
from ..robots.rigid_links import Link, Part, unique
from ..robots.robot_frame import rotation_rpy
from ..robots.shapes import Shape, mesh_shape
from ..robots.xml_elements import Element
from .materials import Materials
from .robot import Robot

SHAPES = {
    "box": ("size",),
    "sphere": ("radius",),
    "cylinder": ("radius", "length"),
    "capsule": ("radius", "length"),
}


def read_links(robot: Robot, packages: Packages, materials: Materials, report: Report) -> None:
    """Fill ``robot.links``."""
    materials.collect(robot.element)
    for element in robot.element.all("link"):
        name = element.name()
        if not name:
            continue
        if name in robot.links:
            element.fault("SOURCE_ID_DUPLICATE", id=name, first=robot.links[name].where)
            continue
        link = Link(f"{robot.name}/{name}", name, Pose(), element.where)
        link.inertial = _inertial(element, name, report)
        link.drawn = _parts(element, "visual", name, packages, materials, report)
        link.touched = _parts(element, "collision", name, packages, None, report)
        robot.links[name] = link


def origin(element: Element) -> Pose:
    """The pose of the ``<origin>`` in an element; without one the identity."""
    child = element.child("origin")
    if child is None:
        return Pose()
    xyz = child.numbers("xyz", 3, (0.0, 0.0, 0.0))
    if "quat_xyzw" in child.attributes:
        from ...spatial import matrix_from_quaternion

        q = np.array(child.numbers("quat_xyzw", 4, (0.0, 0.0, 0.0, 1.0)))
        if q @ q > 0.0:
            return Pose(matrix_from_quaternion(q), np.array(xyz))
        child.fault("AXIS_ZERO", field="quat_xyzw")
    return Pose(rotation_rpy(*child.numbers("rpy", 3, (0.0, 0.0, 0.0))), np.array(xyz))


def _inertial(link: Element, name: str, report: Report) -> Inertial | None:
    """None where it is not stated, or, told, no number or no mass: a robot stands and moves without it, and ROS and
    Pinocchio leave it out too."""
    element = link.child("inertial")
    if element is None:
        return None
    before = len(report.diagnostics)
    mass_element, inertia = element.child("mass"), element.child("inertia")
    mass = 0.0 if mass_element is None else mass_element.number("value")
    if mass < 0.0:
        element.fault("MASS_IMPOSSIBLE", node=name, detail=f"the mass is {mass:g} kg")
    keys = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
    numbers = [0.0 if inertia is None else inertia.number(key) for key in keys]
    found = Inertial(mass, origin(element), tensor(*numbers))
    return None if report.forgive(before, f"inertial of link {name}", "VALUE_UNREADABLE") else found


def _parts(
    link: Element, tag: str, name: str, packages: Packages, materials: Materials | None, report: Report
) -> list[Part]:
    found: dict[str, Part] = {}
    for element in link.all(tag):
        own = element.attributes.get("name", "").strip()
        label = unique(found, own or tag)
        feature = f"{tag} {name}/{label}"
        before = len(report.diagnostics)
        shape, pose = _shape(element, feature, packages, report), origin(element)
        # A link stands and moves without it, and the programs that read robots leave it out.
        if report.forgive(before, feature, "SHAPE_UNREADABLE") or shape is None:
            continue
        surfaces = () if materials is None else materials.of(element, feature)
        found[label] = Part(label, shape, pose, surfaces, counted=not own)
    return list(found.values())


def _shape(part: Element, feature: str, packages: Packages, report: Report) -> Shape | None:
    """The shape of a visual or collision; None, after a report, where there is none that can be made."""
    geometry = part.child("geometry")
    if geometry is None:
        part.fault("XML_MISSING", element=part.tag, field="geometry")
        return None
    for other in geometry.children[1:]:
        code, values = "ELEMENT_REPEATED", {"element": shown(other.tag), "inside": "geometry"}
        report.dropped(f"{shown(other.tag)} of {feature}", code, other.where, **values)
    for child in geometry.children:
        if child.tag == "mesh":
            uri = child.name("filename")
            scale = _scale(child)
            return mesh_shape(uri, scale, packages, feature, child.where, report) if uri else None
        if child.tag in SHAPES:
            count = 3 if child.tag == "box" else 1
            before = len(report.diagnostics)
            keys = SHAPES[child.tag]
            for key in keys:
                child.name(key)
            size = tuple(v for key in keys for v in child.numbers(key, count, (0.0,) * count))
            if len(report.diagnostics) > before:
                return None
            if not all(v > 0.0 for v in size):
                report.dropped(feature, "SHAPE_EMPTY", child.where, shape=child.tag)
                return None
            return Shape(child.tag, size, where=child.where)
        code = "ELEMENT_DROPPED" if ":" in child.tag else "ELEMENT_UNKNOWN"
        report.dropped(feature, code, child.where, element=shown(child.tag), inside="geometry")
        return None
    geometry.fault("XML_MISSING", element="geometry", field="shape")
    return None


def _scale(mesh: Element) -> tuple[float, ...]:
    text = mesh.attributes.get("scale", "1 1 1")
    if len(text.split()) == 1:  # against the format, and understood by everybody
        return (mesh.number("scale", 1.0),) * 3
    return mesh.numbers("scale", 3, (1.0, 1.0, 1.0))
