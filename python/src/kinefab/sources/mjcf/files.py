"""The XML files of a model, looked through before MuJoCo opens them: what they include, where each name stands, and
whether they ask for more than any model needs."""

from __future__ import annotations

import hashlib
import os
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from ...diagnostics import KinefabError, Report
from ...model import SourceFile
from ..reading.file import read_bytes
from ..robots.packages import Packages
from ..robots.xml_elements import Element, parse_xml, without_comments

MOST_FILES = 1000
MOST_COPIES = 100_000
"""Of what one element makes: ``replicate``, ``composite``, ``flexcomp``."""
MOST_CELLS = 2**24
"""Of a heightfield or a made texture: pixels or points."""
_CROWDED = re.compile(rb"(=\s*(?:\"[^\"<]*\"|'[^'<]*'))(?=[A-Za-z_])")
COUNTED = {
    "replicate": (("count",), MOST_COPIES),
    "composite": (("count",), MOST_COPIES),
    "flexcomp": (("count",), MOST_COPIES),
    "texture": (("width", "height"), MOST_CELLS),
    "hfield": (("nrow", "ncol"), MOST_CELLS),
}
SECTIONS = ("actuator", "equality", "tendon", "contact", "sensor")
"""Elements whose children, whatever they are called, share one space of names."""


@dataclass(slots=True)
class Files:
    """root: of the main file.  read: every other file, as the scene's source names them."""

    path: Path
    root: Element
    sha256: str
    read: list[SourceFile] = field(default_factory=list[SourceFile])
    _places: dict[tuple[str, str], str] = field(default_factory=dict[tuple[str, str], str])
    _elements: list[Element] = field(default_factory=list[Element])
    _sections: dict[str, list[str]] = field(default_factory=dict[str, list[str]])

    def where(self, kind: str, name: str) -> str:
        """``file:line`` of a named element; of a name that MuJoCo made (a copy, a prefix) only the main file."""
        return self._places.get((kind, name), self.path.name)

    def nth(self, section: str, index: int, count: int) -> str:
        """The place of the ``index``-th of a section's elements, named or not, of which MuJoCo has ``count``; the main file
        where it made some that no file states."""
        places = self._sections.get(section, [])
        return places[index] if len(places) == count else self.path.name

    def all(self, *tags: str) -> Iterator[Element]:
        """Elements of these names, in all files."""
        return (element for element in self._elements if element.tag in tags)

    def note(self, element: Element, parent: str) -> None:
        self._elements.append(element)
        kind = parent if parent in SECTIONS else "joint" if element.tag == "freejoint" else element.tag
        if parent in SECTIONS:
            self._sections.setdefault(parent, []).append(element.where)
        if name := element.attributes.get("name", ""):
            self._places.setdefault((kind, name), element.where)


def scan(path: Path, packages: Packages, report: Report) -> Files:
    """Raises KinefabError for what is no MJCF, for includes that are not there, out of the folder or of themselves, and
    for counts beyond all reason."""
    data = read_bytes(path, report)
    root = _parsed(data, path.name, report)
    if root.tag != "mujoco":
        report.add("XML_ROOT", root.where, found=root.tag, wanted="mujoco", format="MJCF")
        report.raise_for_errors()
    files = Files(path, root, hashlib.sha256(data).hexdigest())
    _visit(files, root, (Path(os.path.abspath(path)),), packages, report)
    _check_soft(files, packages)
    report.raise_for_errors()
    return files


def _visit(files: Files, root: Element, line: tuple[Path, ...], packages: Packages, report: Report) -> None:
    """line: the files that were opened to come here, from the first."""
    waiting = [("", root)]
    while waiting:
        parent, element = waiting.pop()
        files.note(element, parent)
        _check_counts(element)
        waiting += [(element.tag, child) for child in reversed(element.children)]
        if element.tag == "include" or (element.tag == "model" and "file" in element.attributes):
            _include(files, element, line, packages, report)


def _include(
    files: Files, element: Element, line: tuple[Path, ...], packages: Packages, report: Report
) -> None:
    name = element.name("file")
    if not name:
        return
    found = packages.find(name)
    if found.path is None:  # MuJoCo counts from the first file; models that are attached from their own
        found = packages.of(line[-1].parent).find(name)
    problem = ""
    if found.path is None:
        problem = "leads out of the model's folder" if found.outside else "is not there"
    elif Path(os.path.abspath(found.path)) in line:
        problem = "includes itself"
    elif len(files.read) >= MOST_FILES:
        problem = f"is one of more than {MOST_FILES}"
    if problem or found.path is None:
        element.fault("MJCF_INCLUDE", file=name, problem=problem)
        return
    data = read_bytes(found.path, report)
    files.read.append(
        SourceFile(
            Path(os.path.relpath(found.path, files.path.parent)).as_posix(), hashlib.sha256(data).hexdigest()
        )
    )
    inner = _parsed(data, found.path.name, report)
    _visit(files, inner, (*line, Path(os.path.abspath(found.path))), packages, report)


def _check_soft(files: Files, packages: Packages) -> None:
    """The meshes of soft bodies, which MuJoCo opens while it parses: they too lie where a mesh may lie."""
    stated = (e.attributes.get(key, "") for e in files.all("compiler") for key in ("meshdir", "assetdir"))
    folders = dict.fromkeys(("", *stated))
    for element in files.all("flexcomp"):
        name = element.attributes.get("file", "").strip()
        places = (os.path.join(folder, name) for folder in folders if name)
        if any(packages.find(p).outside and (files.path.parent / p).is_file() for p in places):
            element.fault("MJCF_INCLUDE", file=name, problem="leads out of the model's folder")


def _parsed(data: bytes, name: str, report: Report) -> Element:
    """MuJoCo's parser minds neither a blank that is missing between attributes nor ``--`` in a comment, and takes every
    file for UTF-8 whatever it declares."""
    text, tried = without_comments(data), Report()
    try:
        root = parse_xml(data, name, tried)
    except KinefabError as error:
        if any(d.code != "XML_SYNTAX" for d in error.diagnostics):
            report.extend(tried)
            raise
        try:
            root = parse_xml(_CROWDED.sub(rb"\1 ", text), name, Report())
        except KinefabError:
            report.extend(tried)
            raise error from None
    else:
        report.extend(tried)
    try:
        text.decode("utf-8")
    except UnicodeDecodeError as error:
        line = text.count(b"\n", 0, error.start) + 1
        report.add(
            "MJCF_REFUSED", f"{name}:{line}", detail="the file is no UTF-8, and MuJoCo reads nothing else"
        )
        report.raise_for_errors()
    for element in _walk(root):
        element.report = report
    return root


def _walk(root: Element) -> Iterator[Element]:
    waiting = [root]
    while waiting:
        element = waiting.pop()
        yield element
        waiting += element.children


def _check_counts(element: Element) -> None:
    """MuJoCo makes as many as it is asked for, until no memory is left."""
    if element.tag not in COUNTED:
        return
    keys, most = COUNTED[element.tag]
    product = 1.0
    for key in keys:
        for word in element.attributes.get(key, "").split():
            try:
                product *= abs(float(word))
            except ValueError:
                return  # MuJoCo says what is wrong with it
    if not product <= most:
        element.fault("MJCF_TOO_LARGE", element=element.tag, count=f"{product:g}", limit=most)
