"""Xacro files, expanded by the xacro package where it is installed."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Generator, Sequence
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from ...diagnostics import Report
from ..robots.packages import Packages
from ..robots.xml_elements import Element, parse_xml

MOST_CALLS = 20_000
"""Of macros in one file: a few that call each other twice are soon more than any machine ends."""


def is_xacro(path: Path) -> bool:
    return path.suffix.lower() == ".xacro"


def expanded_leftovers(
    path: Path, root: Element, packages: Packages, arguments: Sequence[str], report: Report
) -> Element | None:
    """What xacro makes of a ``.urdf`` in which elements of it stand; None where there are none, or it makes nothing of
    them: then they are left over from an expansion, and told like other elements that have no place."""
    if not any(child.tag.startswith("xacro:") for child in root.children) or find_spec("xacro") is None:
        return None
    try:
        text = _expand(path, packages, _mappings(arguments))
    except Exception:  # whatever the Python in it raises
        return None
    return parse_xml(text, f"{path.name} (expanded)", report)


def expanded(path: Path, packages: Packages, arguments: Sequence[str], report: Report) -> Element:
    """The robot that a xacro file makes; places in it name the xacro file, with lines of the expanded text.

    arguments: ``name:=value``.  Raises KinefabError.
    """
    if find_spec("xacro") is None:
        report.add("SOURCE_LIBRARY_MISSING", path.name, format="xacro", library="xacro", extra="urdf")
        report.raise_for_errors()
    text = b""
    try:
        text = _expand(path, packages, _mappings(arguments))
    except RecursionError:
        report.add("XACRO_FAILED", path.name, detail="macros or includes that hold themselves")
    except Exception as error:  # xacro evaluates Python in the file, which may raise anything
        detail = " ".join(str(error).split())[:300] or type(error).__name__
        report.add("XACRO_FAILED", path.name, detail=detail)
    report.raise_for_errors()
    return parse_xml(text, f"{path.name} (expanded)", report)


def _mappings(arguments: Sequence[str]) -> dict[str, str]:
    return {name: value for name, given, value in (a.partition(":=") for a in arguments) if given}


def _expand(path: Path, packages: Packages, mappings: dict[str, str]) -> bytes:
    library: Any = import_module("xacro")
    with (
        _finding(import_module("xacro.substitution_args"), packages),
        _counting(library),
        contextlib.redirect_stderr(io.StringIO()),
    ):
        document = library.process_file(str(path), mappings=mappings)
        return document.toprettyxml(indent="  ", encoding="utf-8")


@contextlib.contextmanager
def _finding(substitution: Any, packages: Packages) -> Generator[None, None, None]:
    """Lets ``$(find NAME)`` look where meshes are looked for; without ROS the package has nothing to ask."""
    before = substitution._eval_find

    def find(name: str) -> str:
        folder = packages.package(name)
        return before(name) if folder is None else str(folder)

    substitution._eval_find = find
    try:
        yield
    finally:
        substitution._eval_find = before


@contextlib.contextmanager
def _counting(library: Any) -> Generator[None, None, None]:
    """Ends an expansion that calls macros without end."""
    before, calls = library.handle_macro_call, 0

    def call(*arguments: Any) -> Any:
        nonlocal calls
        calls += 1
        if calls > MOST_CALLS:
            raise ValueError(f"it calls macros more than {MOST_CALLS} times")
        return before(*arguments)

    library.handle_macro_call = call
    try:
        yield
    finally:
        library.handle_macro_call = before
