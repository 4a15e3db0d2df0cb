"""Readers: one module for each source format, behind one small registry.

A reader turns a file into a ``Scene`` (right-handed, +Y up, +Z forward, metres, radians) and says in the
report what it found wrong, approximated or dropped.  It names the mesh files (``MeshReference``) and never
loads them.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Callable

from ..diagnostics import Report
from ..model import MeshReference, Scene
from ..spatial import Array

Vertices = Callable[[MeshReference], Array]
"""Loads the vertices of a mesh, shape (n, 3), through its ``to_node``; for a reader that must look at
geometry."""


@dataclass(frozen=True, slots=True)
class Format:
    """A source format.  suffixes: lower case.  module: beside this file; it has ``read(path, report,
    vertices)`` and, where formats share a suffix, ``sniff(head)`` that tells by the first bytes."""

    name: str
    suffixes: tuple[str, ...]
    module: str
    sniffed: bool = False


FORMATS = (
    Format("CAD bundle", (".bundle.json", ".json"), "bundle"),
    Format("CAD bundle as tagged CSV", (".csv", ".txt"), "bundle_csv", sniffed=True),
    Format("CSV of Braun et al. (2020)", (".csv", ".txt"), "paper_csv"),
)
"""In the order of preference."""

HEAD_BYTES = 4096


def read(path: Path | str, report: Report, vertices: Vertices | None = None) -> Scene:
    """Read a source by whichever reader knows it.

    report: receives every finding.  vertices: loads a mesh's vertices, for formats that leave a point to be
    found in the geometry (None: that step is left out).  Raises KinefabError with every error found.
    """
    path = Path(path)
    found = format_of(path)
    if found is None:
        known = ", ".join(sorted({suffix for entry in FORMATS for suffix in entry.suffixes}))
        report.add("SOURCE_FORMAT_UNKNOWN", path.name, path=path, known=known)
        report.raise_for_errors()
    return import_module(f".{found.module}", __name__).read(path, report, vertices)


def format_of(path: Path) -> Format | None:
    """The format of a file, by its name and, where that leaves a choice, by its first bytes."""
    candidates = [entry for entry in FORMATS if path.name.lower().endswith(entry.suffixes)]
    for entry in candidates:
        if not entry.sniffed or import_module(f".{entry.module}", __name__).sniff(_head(path)):
            return entry
    return None


def _head(path: Path) -> bytes:
    try:
        with path.open("rb") as stream:
            return stream.read(HEAD_BYTES)
    except (OSError, ValueError):
        return b""  # the reader that is chosen says what is wrong with the file
