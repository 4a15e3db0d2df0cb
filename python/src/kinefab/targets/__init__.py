"""Targets: one file or room for each output, behind one small registry.

A target has ``write(content, path)``: it tells the report what it cannot say, calls ``content.refuse_losses()`` and writes
so that a kill at any moment leaves the old files or the new ones.  It returns the paths written, the named one first, and
raises OSError as the file system does.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..extras import install
from ..options import FormatOption

if TYPE_CHECKING:  # the command line asks for the endings alone, and should not wait for numpy
    from ..diagnostics import Report
    from .content import Content


@dataclass(frozen=True, slots=True)
class Target:
    """An output.  endings: lower case, of the file that is named.  module: below this package.
    options: what a user may ask of it; one that several targets have is one object.
    requires: modules without which it cannot be written.  extra: of the package, that installs them ("" for none), see
    ``kinefab.extras``."""

    name: str
    endings: tuple[str, ...]
    module: str
    options: tuple[FormatOption, ...] = ()
    requires: tuple[str, ...] = ()
    extra: str = ""


UNITY = FormatOption(
    "unity",
    "Editor that the files are for, 2022 unless said; newer ones upgrade them.",
    words=("2021", "2022", "6"),
)
PIPELINE = FormatOption(
    "pipeline", "Render pipeline of the materials, builtin unless said.", words=("builtin", "urp", "hdrp")
)
SCRIPTS = FormatOption("scripts", "Add a script that keeps the couplings (gears, racks, screws).", bool)
PHYSICS = FormatOption(
    "physics", "What moves the bodies, rigidbody unless said.", words=("rigidbody", "articulation")
)
CONTAINER = FormatOption(
    "container",
    "A .kinefab as text with its buffer beside it, as unless said, or as one binary file.",
    words=("text", "binary"),
)
PREFAB_OPTIONS = (UNITY, PIPELINE, SCRIPTS, PHYSICS)

TARGETS = (
    Target("Kinefab scene", (".kinefab",), "kinefab_file", (PHYSICS, CONTAINER)),
    Target("Unity prefab", (".prefab",), "prefab", PREFAB_OPTIONS),
    Target("glTF 2.0", (".glb",), "gltf"),
    Target("USD", (".usda", ".usdc", ".usdz"), "usd", requires=("pxr",), extra="usd"),
    Target("Unity package", (".unitypackage",), "unitypackage", PREFAB_OPTIONS),
)


def target_of(path: Path) -> Target | None:
    """The target of a file, by its name."""
    return next((entry for entry in TARGETS if path.name.lower().endswith(entry.endings)), None)


def known_endings() -> tuple[str, ...]:
    """Of all targets, lower case."""
    return tuple(ending for entry in TARGETS for ending in entry.endings)


def target_options() -> Iterator[FormatOption]:
    """The options of all targets, each once."""
    yield from dict.fromkeys(option for entry in TARGETS for option in entry.options)


def check_target(target: Target, options: Mapping[str, Any], report: Report) -> dict[str, Any]:
    """The options that the target has; a warning for each other, an error for each library that is not there.

    Raises ValueError or TypeError for a value that an option cannot have.
    """
    for name in target.requires:
        if find_spec(name) is None:
            report.add("TARGET_LIBRARY_MISSING", target=target.name, library=name, install=install(target.extra))
    asked = dict(options)
    for name in sorted(asked.keys() - {option.name for option in target.options}):
        report.add("TARGET_OPTION_UNUSED", option=name.replace("_", "-"), target=target.name)
        del asked[name]
    for option in target.options:
        option.check(asked.get(option.name))
    return asked


def write(target: Target, content: Content, path: Path) -> tuple[Path, ...]:
    """Write by whichever module knows the target."""
    paths: tuple[Path, ...] = import_module(f".{target.module}", __name__).write(content, path)
    return paths
