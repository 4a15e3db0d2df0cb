"""A URDF or xacro file as a scene.

The base is fixed to the world, as MuJoCo, PyBullet's and Pinocchio's readers have it, unless ``--floating-base`` says
otherwise; every coordinate is zero at the exported pose, but for mimics with an offset.
"""

from __future__ import annotations

import hashlib
from pathlib import Path

from ...diagnostics import Report
from ...model import Scene, Source
from ..reading.file import read_bytes
from ..reading.request import Request
from ..robots.packages import packages_of
from ..robots.xml_elements import parse_xml
from .expansion import expanded, expanded_leftovers, is_xacro
from .joints import read_joints
from .links import read_links
from .materials import Materials
from .robot import Robot
from .scene import fill_scene
from .unread import tell_unread


def read(path: Path, report: Report, request: Request = Request()) -> Scene:
    """The scene of a ``.urdf`` or ``.xacro``.  Raises KinefabError with every error found."""
    data = read_bytes(path, report)
    packages = packages_of(path, request, report)
    root = parse_xml(data, path.name, report)
    arguments = request.texts("xacro_arg")
    if is_xacro(path):
        root = expanded(path, packages, arguments, report)
    elif whole := expanded_leftovers(path, root, packages, arguments, report):
        root = whole
    elif arguments:
        form = "a URDF that xacro does not expand"
        report.add("SOURCE_OPTION_UNUSED", path.name, option="xacro-arg", format=form)
    if root.tag != "robot":
        report.add("XML_ROOT", root.where, found=root.tag, wanted="robot", format="URDF")
        report.raise_for_errors()
    scene = Scene(source=Source(path.name, "Z", 1.0, hashlib.sha256(data).hexdigest()))
    robot = Robot(root.attributes.get("name", "").strip() or path.name.split(".")[0], root)
    read_links(robot, packages, Materials(scene.surfaces, packages, report), report)
    read_joints(robot, report)
    if not robot.links:
        report.add("LINKS_NONE", root.where)
    tell_unread(root, report)
    report.raise_for_errors()
    fill_scene(scene, robot, request.flag("floating_base"), report)
    report.raise_for_errors()
    return scene
