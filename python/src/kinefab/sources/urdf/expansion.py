"""Xacro files, expanded by the xacro package where it is installed.

Xacro evaluates Python that stands in the file: ``${9**9**9}`` never ends, ``${[0]*10**10}`` takes all memory, and no look
at an expression tells which do.  So it works in the guarded process (``sources.guard``), within limits of time and
memory; the second one only where the system knows such limits (not on Windows, and macOS heeds none).
"""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Generator, Iterator, Mapping, Sequence
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import IO, Any, cast

from ...diagnostics import Report
from ...extras import install
from ..guard import GuardedCrash, GuardedError, guarded
from ..robots.packages import Packages, is_inside
from ..robots.xml_elements import Element, parse_xml

MOST_CALLS = 20_000
"""Of macros in one file: a few that call each other twice are soon more than any machine ends."""
MOST_SECONDS = 30.0
MOST_BYTES = 2**30


class ExpansionFailed(Exception):
    """The text says why."""


def is_xacro(path: Path) -> bool:
    return path.suffix.lower() == ".xacro"


def expanded_leftovers(
    path: Path, root: Element, packages: Packages, arguments: Sequence[str], report: Report
) -> Element | None:
    """What xacro makes of a ``.urdf`` in which elements of it stand; None where there are none, or it makes nothing of
    them: then they are left over from an expansion, and told like other elements that have no place."""
    if not any(child.tag.startswith("xacro:") for child in root.children) or find_spec("xacro") is None:
        return None
    _tell_malformed(arguments, path, report)
    try:
        text = _expand(path, packages, arguments)
    except ExpansionFailed:
        return None
    return parse_xml(text, f"{path.name} (expanded)", report)


def expanded(path: Path, packages: Packages, arguments: Sequence[str], report: Report) -> Element:
    """The robot that a xacro file makes; places in it name the xacro file, with lines of the expanded text.

    arguments: ``name:=value``.  Raises KinefabError.
    """
    if find_spec("xacro") is None:
        needed = {"library": "xacro", "install": install("urdf")}
        report.add("SOURCE_LIBRARY_MISSING", path.name, format="xacro", **needed)
        report.raise_for_errors()
    _tell_malformed(arguments, path, report)
    text = b""
    try:
        text = _expand(path, packages, arguments)
    except ExpansionFailed as failed:
        report.add("XACRO_FAILED", path.name, detail=failed)
    report.raise_for_errors()
    return parse_xml(text, f"{path.name} (expanded)", report)


def _tell_malformed(arguments: Sequence[str], path: Path, report: Report) -> None:
    for argument in arguments:
        if not argument.partition(":=")[0].strip() or ":=" not in argument:
            report.add("XACRO_ARGUMENT", path.name, argument=argument)


def _mappings(arguments: Sequence[str]) -> dict[str, str]:
    return {name: value for name, given, value in (a.partition(":=") for a in arguments) if given}


def _expand(path: Path, packages: Packages, arguments: Sequence[str]) -> bytes:
    here = (os.getcwd(), dict(os.environ))  # the process may have been started elsewhere
    asked = (*here, path, packages.folder, packages.given, _mappings(arguments), MOST_BYTES, MOST_SECONDS)
    try:
        ((text, detail),) = guarded(__name__, "expansion", *asked, seconds=MOST_SECONDS)
    except (GuardedCrash, GuardedError) as error:
        text, detail = b"", str(error)
    if detail:
        raise ExpansionFailed(detail)
    return text


def expansion(
    directory: str,
    environment: Mapping[str, str],
    path: Path,
    folder: Path,
    given: tuple[Path, ...],
    mappings: dict[str, str],
    most_bytes: int,
    most_seconds: float,
) -> Iterator[tuple[bytes, str]]:
    """What xacro makes of a file, or why it makes nothing; to be run by ``guard.guarded``."""
    os.chdir(directory)
    os.environ.clear()
    os.environ.update(environment)
    library: Any = import_module("xacro")
    packages = Packages(folder, given)
    substitution: Any = import_module("xacro.substitution_args")
    text, detail = b"", ""
    try:
        staying = _staying(library, substitution, packages)
        with _limited(most_bytes, most_seconds), staying, _counting(library):
            document = library.process_file(str(path), mappings=mappings)
            text = document.toprettyxml(indent="  ", encoding="utf-8")
        if len(text) > most_bytes // 8:
            text, detail = b"", f"it makes more than {most_bytes / 8 / 2**20:.0f} MiB of text"
    except RecursionError:
        detail = "macros or includes that hold themselves"
    except Exception as error:  # xacro evaluates Python in the file, which may raise anything
        cause = getattr(error, "exc", None)
        told = cause if isinstance(cause, ExpansionFailed) else error
        detail = " ".join(str(told)[:3000].split())[:300] or type(error).__name__
        if isinstance(error, MemoryError) or isinstance(cause, MemoryError):
            detail = f"it takes more than {most_bytes / 2**20:.0f} MiB of memory"
    yield text, detail


@contextlib.contextmanager
def _limited(most_bytes: int, most_seconds: float) -> Generator[None, None, None]:
    """Memory and, should nobody be left who ends the process, its own time."""
    try:
        resource: Any = import_module("resource")
    except ImportError:  # Windows
        yield
        return
    held = 0  # what earlier questions left in the process counts too
    with contextlib.suppress(OSError):
        held = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    wanted = {
        resource.RLIMIT_AS: held + most_bytes,
        resource.RLIMIT_CPU: int(time.process_time() + most_seconds) + 1,
    }
    before = {kind: resource.getrlimit(kind) for kind in wanted}
    try:
        for kind, limit in wanted.items():
            with contextlib.suppress(OSError, ValueError):  # beyond what the user or the system allows
                resource.setrlimit(kind, (limit, before[kind][1]))
        yield
    finally:
        for kind, limits in before.items():
            with contextlib.suppress(OSError, ValueError):
                resource.setrlimit(kind, limits)


@contextlib.contextmanager
def _staying(library: Any, substitution: Any, packages: Packages) -> Generator[None, None, None]:
    """Lets ``$(find NAME)`` look where meshes are looked for (without ROS the package has nothing to ask), and opens what
    is included or loaded only where a mesh may lie, or in a package so found."""
    before = substitution._eval_find
    named: list[Path] = []

    def find(name: str) -> str:
        folder = packages.package(name)
        if folder is None:
            try:
                folder = Path(before(name))
            except ImportError:
                raise ExpansionFailed(f"there is no package '{name}'") from None
        named.append(Path(os.path.abspath(folder)))
        return str(named[-1])

    def opened(name: str, *arguments: Any) -> IO[Any]:
        path = os.path.abspath(name)
        if packages.find(path).outside and not any(is_inside(Path(path), root) for root in named):
            raise ValueError(f"{name} leads out of the package")
        return cast("IO[Any]", open(path, *arguments))

    substitution._eval_find, library.open = find, opened
    try:
        yield
    finally:
        substitution._eval_find = before
        del library.open


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
