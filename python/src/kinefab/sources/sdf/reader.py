"""An SDF file as a scene.

A model stands free, as in Gazebo, unless it is static or a fixed joint ties it to the world.  Of a world all models are
read, with its gravity.  Every coordinate is zero at the exported pose.
"""

from __future__ import annotations

import hashlib
from pathlib import Path

from ...diagnostics import Report
from ...model import Physics, Scene, Source
from ..reading.file import read_bytes
from ..reading.request import Request
from ..reading.xml_text import root_name
from ..robots.packages import packages_of
from ..robots.robot_frame import direction
from ..robots.xml_elements import Element, parse_xml
from .includes import read_models, version_of
from .scene import fill_scene
from .scopes import Scope
from .unread import unread_of


def sniff(head: bytes) -> bool:
    """Whether the first bytes are XML's: ``.world`` is also the ending of programs that write otherwise."""
    return head.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"<") or root_name(head) == "sdf"


def read(path: Path, report: Report, request: Request = Request()) -> Scene:
    """The scene of a ``.sdf`` or ``.world``.  Raises KinefabError with every error found."""
    data = read_bytes(path, report)
    root = parse_xml(data, path.name, report)
    if root.tag != "sdf":
        report.add("XML_ROOT", root.where, found=root.tag, wanted="sdf", format="SDF")
        report.raise_for_errors()
    version = version_of(root)
    packages = packages_of(path, request, report)
    scene = Scene(source=Source(path.name, "Z", 1.0, hashlib.sha256(data).hexdigest()))
    worlds = list(root.all("world"))
    holder = worlds[0] if worlds else root
    unread = unread_of(bool(worlds), report)
    unread.look_through(root, "")
    if not worlds:
        models = list(root.all("model", "include"))
        holder = Element(root.tag, root.attributes, root.path, root.line, report, models)
    scope = Scope("world", "", holder, None, version, packages, report, holder, unread)
    read_models(scope, (path.resolve(),))
    unread.tell_rest()
    if not scope.all_entries("link"):
        report.add("LINKS_NONE", root.where)
    report.raise_for_errors()
    if (gravity := holder.child("gravity")) is not None:
        x, y, z = direction(gravity.values(3, (0.0, 0.0, -9.81))).tolist()
        scene.physics = Physics((x, y, z))
    fill_scene(scene, scope, report)
    report.raise_for_errors()
    return scene
