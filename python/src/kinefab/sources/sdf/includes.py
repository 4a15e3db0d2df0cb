"""Models that an SDF file holds or includes from others, as scopes."""

from __future__ import annotations

import re
from pathlib import Path

from ...diagnostics import KinefabError, Report
from ..reading.file import read_bytes
from ..reading.record import shown
from ..robots.packages import Packages, is_served
from ..robots.xml_elements import Element, parse_xml, truth
from .scopes import Entry, Scope

DEEPEST = 32
"""Files that include each other."""
NEWEST, OLDEST = (1, 12), (1, 4)


def version_of(root: Element) -> tuple[int, int]:
    """Of ``<sdf version="1.9">``; a warning for one outside the range that is known, an error for none."""
    text = root.attributes.get("version", "").strip()
    match = re.fullmatch(r"(\d{1,3})\.(\d{1,3})(?:\.\d+)?", text)
    if match is None:
        root.fault("XML_MISSING", element=root.tag, field="version") if not text else root.wrong(
            "version", "two numbers like 1.9", text
        )
        return NEWEST
    version = (int(match[1]), int(match[2]))
    if not OLDEST <= version <= NEWEST:
        root.fault("SDF_VERSION", version=text)
    return version


def read_models(scope: Scope, files: tuple[Path, ...]) -> None:
    """Fill a scope from its element: links, joints, frames, nested and included models.  files: that are open."""
    for child in scope.element.children:
        if child.tag in ("link", "joint", "frame"):
            name = child.name()
            if name and _allowed(name, child, scope.version):
                scope.add(Entry(child.tag, name, child, scope))
        elif child.tag == "model":
            _add_model(scope, child, child, child.name(), scope.version, scope.packages, files)
        elif child.tag == "include":
            _include(scope, child, files)


def _allowed(name: str, element: Element, version: tuple[int, int]) -> bool:
    """Whether a name is free to be given; until 1.7 nested models were written flat, with ``::`` in their names."""
    divided = "::" in name and version >= (1, 8)
    if name == "world" or divided or (name.startswith("__") and name.endswith("__")):
        element.wrong("name", "a name that means nothing else", name)
        return False
    return True


def _add_model(
    scope: Scope,
    element: Element,
    posed: Element,
    name: str,
    version: tuple[int, int],
    packages: Packages,
    files: tuple[Path, ...],
    merged: bool = False,
) -> None:
    if not name or not _allowed(name, element, version):
        return
    path = scope.path if merged else f"{scope.path}/{name}" if scope.path else name
    inner = Scope(name, path, element, scope, version, packages, scope.report, posed, scope.unread)
    inner.merged = merged
    own, given = element.attributes.get("placement_frame", ""), posed.content("placement_frame")
    inner.placement = (given if posed is not element and given else own).strip()
    says = (
        element.content("static")
        if posed is element or not posed.content("static")
        else posed.content("static")
    )
    inner.static = scope.static or truth(says)
    entry = Entry("model", f"__merged__{name}__" if merged else name, element, scope, inner)
    inner.entry = entry
    scope.add(entry)
    read_models(inner, files)


def _include(scope: Scope, element: Element, files: tuple[Path, ...]) -> None:
    uri = element.content("uri")
    if not uri:
        element.fault("XML_MISSING", element="include", field="uri")
        return
    path = _model_file(uri, scope.packages)
    # What asks for the server's model of its own name does not mean itself.
    if path is None or (path in files and is_served(uri)):
        scope.report.dropped(f"include {uri}", "INCLUDE_NOT_FOUND", element.where, uri=uri)
        return
    if path in files or len(files) >= DEEPEST:
        element.fault("INCLUDE_CYCLE", uri=uri)
        return
    root = _root(path, scope.report)
    if root is None:
        return
    if root.tag != "sdf":  # such as a URDF, which Gazebo converts by itself
        values = {"uri": uri, "file": path.name, "found": shown(root.tag)}
        scope.report.dropped(f"include {uri}", "INCLUDE_NOT_SDF", element.where, **values)
        return
    version = version_of(root)
    models = list(root.all("model"))
    if not models:
        others = next((child.tag for child in root.children), "nothing")
        scope.report.dropped(f"include {uri}", "ELEMENT_DROPPED", element.where) if others in (
            "light",
            "actor",
        ) else (element.fault("XML_MISSING", element="sdf", field="model"))
        return
    name = element.content("name") or models[0].name()
    merged = truth(element.attributes.get("merge", ""))
    posed = element if element.child("pose") is not None else models[0]
    packages = scope.packages.of(path.parent)
    holder = _Overlay(element, posed)
    above = f"{scope.path}/" if scope.path else ""
    label = f"model {above}{name}"
    scope.unread.look_through(models[0], label, f"{above}{name}/")
    _add_model(scope, models[0], holder.element, name, version, packages, (*files, path), merged)


class _Overlay:
    """An ``<include>`` as what places a model: its own pose, static and placement frame, else the model's pose."""

    def __init__(self, include: Element, posed: Element) -> None:
        pose = posed.child("pose")
        others = [child for child in include.children if child.tag != "pose"]
        self.element = Element(
            include.tag, include.attributes, include.path, include.line, include.report,
            [*([] if pose is None else [pose]), *others],
        )  # fmt: skip


def _root(path: Path, report: Report) -> Element | None:
    """The root of an included file; None where it is no XML, and then the report says so."""
    try:
        return parse_xml(read_bytes(path, report), path.name, report)
    except KinefabError:
        return None


def _model_file(uri: str, packages: Packages) -> Path | None:
    """The SDF file of a model's or a relative name, which may be that of a folder with a ``model.config``.  A name without
    ``model://`` is looked for beside the file, then among the models, as Gazebo does.
    """
    if (direct := packages.find(uri).path) is not None:
        return direct
    named = packages.named(uri)
    if named is not None and not named[1]:
        folder = named[0]
    else:
        files = (packages.find(f"{uri.rstrip('/')}/{name}").path for name in ("model.config", "model.sdf"))
        folder = next((file.parent for file in files if file is not None), None) or packages.package(uri)
    if folder is None:
        return None
    return configured(folder)


def configured(folder: Path) -> Path | None:
    """The newest SDF file that a model's ``model.config`` names and that is there; else ``model.sdf``."""
    names: list[tuple[tuple[int, ...], str]] = []
    try:
        config = parse_xml((folder / "model.config").read_bytes(), "model.config", Report())
    except (OSError, KinefabError):
        config = None
    for entry in () if config is None else config.all("sdf"):
        numbers = tuple(int(n) for n in re.findall(r"\d{1,4}", entry.attributes.get("version", "0")))
        names.append((numbers, entry.text.strip()))
    for numbers, name in [*sorted(names, reverse=True), ((), "model.sdf")]:
        path = folder / name
        if numbers <= NEWEST and name and "/" not in name and path.is_file():
            return path
    return None
