"""Readers: one room for each source format, behind one small registry.

A reader turns a file into a ``Scene`` (right-handed, +Y up, +Z forward, metres, radians) and says in the
report what it found wrong, approximated or dropped.  Where the geometry is in files of its own it names them
(``MeshReference``) and never loads them; where it is in the source itself it fills ``Scene.meshes``.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

from ..diagnostics import Report, is_encodable
from ..extras import install
from ..geometry.whole.lfs import is_pointer
from ..options import FormatOption
from .mjcf.options import KEYFRAME
from .occ.options import TOLERANCE
from .roads import road_of
from .robots.packages import PACKAGE_PATH
from .step.options import ASKED as STEP_OPTIONS
from .step.options import UP
from .urdf.options import FLOATING_BASE, XACRO_ARG

if TYPE_CHECKING:  # the command line asks for the endings alone, and should not wait for numpy
    from ..model import Scene
    from .reading.request import Vertices


@dataclass(frozen=True, slots=True)
class Format:
    """A source format.

    suffixes: lower case.  module: below this package, or with a dot before it below ``kinefab``, for a reader that stands
    on a higher floor; it has ``read(path, report, request)`` and, where formats share a suffix (``sniffed``),
    ``sniff(head)`` that tells by the first bytes.
    options: what a user may ask of it.  An option that several formats have is one object.
    requires: modules without which it cannot be read at all.  extra: of the package, that installs them ("" for none), see
    ``kinefab.extras``.
    """

    name: str
    suffixes: tuple[str, ...]
    module: str
    sniffed: bool = False
    options: tuple[FormatOption, ...] = ()
    requires: tuple[str, ...] = ()
    extra: str = ""


FORMATS = (
    Format("CAD bundle", (".bundle.json",), "bundle.reader"),
    Format("CAD bundle", (".json",), "bundle.reader", sniffed=True),
    Format("Onshape's saved answers", (".json",), ".capture.onshape.source", sniffed=True, options=(UP,)),
    Format("Fusion 360 Gallery assembly", (".json",), "gallery.reader", sniffed=True, options=(UP,)),
    Format("CAD bundle as tagged CSV", (".csv", ".txt"), "bundle.tagged_csv", sniffed=True),
    Format("CSV of Braun et al. (2020)", (".csv", ".txt"), "paper.reader"),
    Format("STEP", (".step", ".stp"), "step.reader", options=STEP_OPTIONS, requires=("OCP",), extra="cad"),
    Format("IGES", (".iges", ".igs"), "step.reader", options=STEP_OPTIONS, requires=("OCP",), extra="cad"),
    Format("FreeCAD document", (".fcstd",), "freecad.reader", options=(TOLERANCE,)),
    Format("OndselSolver assembly", (".asmt",), "asmt.reader"),
    Format(
        "USD stage",
        (".usd", ".usda", ".usdc", ".usdz"),
        "usd.reader",
        options=(
            FormatOption("root", "USD: read this prim and what is below it.", metavar="PRIM"),
            FormatOption(
                "variant",
                "USD: choose a variant: set=name, or /Prim:set=name.",
                repeated=True,
                metavar="SET=NAME",
                chooses=True,
            ),
            FormatOption("load", "USD: load payloads or leave them out.", words=("all", "none")),
            FormatOption(
                "purpose",
                "USD: draw geometry of this purpose too, beside default and render.",
                repeated=True,
                words=("proxy", "guide"),
            ),
        ),
        requires=("pxr",),
        extra="usd",
    ),
    Format("URDF", (".urdf", ".xacro"), "urdf.reader", options=(PACKAGE_PATH, XACRO_ARG, FLOATING_BASE)),
    Format("SDF", (".sdf", ".world"), "sdf.reader", sniffed=True, options=(PACKAGE_PATH,)),
    Format("Simscape Multibody XML", (".xml",), "simscape.reader", sniffed=True, options=(UP,)),
    Format(
        "MJCF",
        (".xml", ".mjcf"),
        "mjcf.reader",
        sniffed=True,
        options=(PACKAGE_PATH, KEYFRAME),
        requires=("mujoco",),
        extra="mujoco",
    ),
    Format("Kinefab scene", (".kinefab",), ".unity.back.source"),
)
"""In the order of preference."""

HEAD_BYTES = 65536


def read(
    path: Path | str,
    report: Report,
    vertices: Vertices | None = None,
    options: Mapping[str, Any] | None = None,
    progress: Callable[[float], None] = lambda fraction: None,
) -> Scene:
    """Read a source by whichever reader knows it.

    report: receives every finding.  vertices, progress: see ``Request``.  options: by name; one that the format does not have
    is a warning.  Raises KinefabError with every error found, ValueError or TypeError for a value that an option cannot have.
    """
    from .reading.request import Request

    path = Path(path)
    if is_pointer(path):  # before anything is missed that would read the file itself
        report.add("SOURCE_LFS_POINTER", path.name, path=path.name)
        report.raise_for_errors()
    found = format_of(path)
    if found is None:
        _tell_unknown(path, report)
        report.raise_for_errors()
        raise AssertionError("an unknown format is an error")
    missing = [name for name in found.requires if find_spec(name) is None]
    if missing and not _tell_no_file(path, report):  # nobody installs a library for a path that is misspelt
        needed = {"format": found.name, "install": install(found.extra)}
        for name in missing:
            report.add("SOURCE_LIBRARY_MISSING", path.name, library=name, **needed)
    if found.requires and not is_encodable(os.path.abspath(path)):
        library = found.requires[0]
        report.add("SOURCE_PATH_NOT_UTF8", path.name, path=path, library=library, format=found.name)
    report.raise_for_errors()
    asked = dict(options or {})
    for name in sorted(asked.keys() - {option.name for option in found.options}):
        value, option = asked.pop(name), name.replace("_", "-")
        told = f"{option} {value}" if isinstance(value, str) else option
        report.add("SOURCE_OPTION_UNUSED", path.name, option=told, format=found.name)
    for option in found.options:
        option.check(asked.get(option.name))
    reader = import_module(f".{found.module}", __name__)
    request = Request(asked, vertices, progress)
    scene: Scene = reader.read(path, report, request)
    chosen = [
        value if "=" in value else f"{option.name}={value}"
        for option in found.options
        if option.chooses
        for value in request.texts(option.name)
    ]
    if chosen:
        scene.source = replace(scene.source, configuration="; ".join(chosen))
    return scene


def _tell_unknown(path: Path, report: Report) -> None:
    """Why no reader takes a file; of a known ending it is the content that is of none of its formats, if there is any."""
    road = road_of(path.name)
    road = f"{road} " if road else ""
    if formats := [entry.name for entry in FORMATS if path.name.lower().endswith(entry.suffixes)]:
        from .reading.file import read_bytes

        read_bytes(path, report)  # missing, a folder, unreadable, empty: as every reader tells it
        content = f": its content is none of {', '.join(formats)}"
        advice = "Check that it is the file that was meant, or export it again."
        report.add("SOURCE_FORMAT_UNKNOWN", path.name, path=path, content=content, road=road, advice=advice)
    elif (road and not os.path.lexists(path)) or not _tell_no_file(path, report):
        advice = f"Give one of: {', '.join(sorted(known_suffixes()))}."
        report.add("SOURCE_FORMAT_UNKNOWN", path.name, path=path, content="", road=road, advice=advice)


def _tell_no_file(path: Path, report: Report) -> bool:
    """Whether nothing is there, or a folder, which is told then."""
    if not os.path.lexists(path):
        report.add("SOURCE_NOT_FOUND", path.name, path=path)
    elif path.is_dir():
        report.add("SOURCE_IS_FOLDER", path.name, path=path)
    else:
        return False
    return True


@runtime_checkable
class Stage(Protocol):
    """A ``pxr.Usd.Stage`` that a program has open, as far as it takes to know one without importing pxr."""

    def GetRootLayer(self) -> Any: ...
    def GetPseudoRoot(self) -> Any: ...


def read_stage(stage: Stage, report: Report, options: Mapping[str, Any] | None = None) -> Scene:
    """Read an open stage as it is; what is not saved counts too.  report, options: as in ``read``."""
    from .reading.request import Request

    for option in next(entry.options for entry in FORMATS if entry.module == "usd.reader"):
        option.check((options or {}).get(option.name))
    reader = import_module(".usd.reader", __name__)
    scene: Scene = reader.read_stage(stage, report, Request(dict(options or {})))
    return scene


def known_suffixes() -> set[str]:
    """Of all formats, lower case."""
    return {suffix for entry in FORMATS for suffix in entry.suffixes}


def source_options(beside: str = "") -> Iterator[FormatOption]:
    """The options of all formats, each once, in the order of the formats.

    beside: the name of an option; then the others of the formats that have it.
    """
    for option in dict.fromkeys(option for entry in FORMATS for option in entry.options):
        having = (entry.options for entry in FORMATS if any(own.name == beside for own in entry.options))
        if not beside or option.name != beside and any(option in options for options in having):
            yield option


def format_of(path: Path) -> Format | None:
    """The format of a file, by its name and, where that leaves a choice, by its first bytes."""
    candidates = [entry for entry in FORMATS if path.name.lower().endswith(entry.suffixes)]
    for entry in candidates:
        if not entry.sniffed or import_module(f".{entry.module}", __name__).sniff(_head(path)):
            return entry
    return None


def _head(path: Path) -> bytes:
    try:
        if not path.is_file():  # a pipe would be waited for
            return b""
        with path.open("rb") as stream:
            return stream.read(HEAD_BYTES)
    except (OSError, ValueError):
        return b""  # the reader that is chosen says what is wrong with the file
