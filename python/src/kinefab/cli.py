"""The command line: a thin layer over ``kinefab.export`` and ``kinefab.inspection``.

Logs go to stderr, data to stdout; exit 0 done, 1 errors found, 2 wrong usage.  What takes long to import is
imported inside the commands.
"""

from __future__ import annotations

import json
import os
import sys
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Callable, Iterator, Optional

import typer

from . import __version__
from .diagnostics import KinefabError, Report, Severity, diagnostic, printable, report_document
from .options import DEFAULT_DENSITY, Closures, ColliderShape, ExportOptions
from .replacing import demand_writable, write_whole

if TYPE_CHECKING:
    from .pipeline import ExportResult

app = typer.Typer(
    name="kinefab",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
_verbosity = 0


def _show_version(asked: bool) -> None:
    if asked:
        typer.echo(f"kinefab {__version__}")
        raise typer.Exit()


@app.callback()
def _common(
    version: bool = typer.Option(
        False, "--version", callback=_show_version, is_eager=True, help="Show the version."
    ),
    verbose: bool = typer.Option(
        False, "--verbose", "-v", help="Show remarks too, not only warnings and errors."
    ),
    quiet: bool = typer.Option(False, "--quiet", "-q", help="Show errors only."),
) -> None:
    """Carry a mechanism out of CAD into Unity, moving as it moved in CAD."""
    global _verbosity
    _verbosity = 1 if verbose else -1 if quiet else 0


@app.command()
def export(
    source: Path = typer.Argument(..., help="Assembly to read: NAME.bundle.json or CSV.", show_default=False),
    output: Path = typer.Option(
        ..., "--output", "-o", help="Scene to write: NAME.kinefab.", show_default=False
    ),
    strict: bool = typer.Option(
        False, "--strict", help="Fail where anything would be approximated or dropped."
    ),
    report: Optional[Path] = typer.Option(None, "--report", help="Write every finding to this JSON file."),
    colliders: ColliderShape = typer.Option(ColliderShape.HULL, "--colliders", show_default="hull", help="Collider of each body."),
    density: float = typer.Option(DEFAULT_DENSITY, "--density", help="kg/m^3 of bodies that state none."),
    closures: Closures = typer.Option(Closures.MINIMAL, "--closures", show_default="minimal", help="Equations of loop-closing joints to write."),
    solve: bool = typer.Option(False, "--solve", help="Move the parts to the nearest pose that fits the constraints."),
    limits: bool = typer.Option(False, "--limits", help="Search how far joints can move and write it as limits."),
) -> None:
    """Export a CAD assembly as a Unity scene."""
    _demand_ending(output, ".kinefab")
    try:
        options = ExportOptions(colliders, density, strict, closures, solve, limits)
    except ValueError as error:
        raise typer.BadParameter(str(error), param_hint="--density") from None
    for path, hint, others in ((output, "--output", (source,)), (report, "--report", (source, output))):
        if path is not None and os.path.isdir(path):
            raise typer.BadParameter(f"{path} is a folder", param_hint=hint)
        if path is not None and any(os.path.realpath(path) == os.path.realpath(other) for other in others):
            raise typer.BadParameter(f"{path} is named twice; it would be overwritten", param_hint=hint)
    if report is not None:  # before the work: a scene whose losses nobody is told is not to be written
        with _unwritable_as_finding(report):
            demand_writable(report)
    from .pipeline import export as run

    result: Optional[ExportResult] = None
    reasons = 0
    try:
        with _progress_bar() as progress:
            result = run(source, output, options, progress)
        found = result.report
    except KinefabError as error:
        found, reasons = error.report or Report(list(error.diagnostics)), len(error.diagnostics)
    _log(found)
    if result is None:
        reason = _count(reasons, "loss or error", "losses or errors") if strict else _count(reasons, "error", "errors")
        typer.echo(f"{output} was not written: {reason}.", err=True)
    elif _verbosity >= 0:
        typer.echo(_summary(result), err=True)
    if report is not None:
        text = json.dumps(report_document(found, str(output), result is not None), indent=2, ensure_ascii=False) + "\n"
        _write(report, text.encode("utf-8", "backslashreplace"))  # a path's bytes may be no UTF-8; the escapes are JSON's
    if result is None:
        raise typer.Exit(1)


@app.command()
def analyse(
    source: Path = typer.Argument(..., help="Assembly to read: NAME.bundle.json or CSV.", show_default=False),
    as_json: bool = typer.Option(False, "--json", help="Print the same as JSON."),
    closures: Closures = typer.Option(Closures.MINIMAL, "--closures", show_default="minimal", help="Equations of loop-closing joints to keep."),
    limits: bool = typer.Option(False, "--limits", help="Search how far joints can move."),
) -> None:
    """Show what an assembly's constraints leave free, and which joint connects what."""
    from .analysis import AnalysisOptions
    from .analysis import analyse as run
    from .analysis.summary import document
    from .analysis.table import table
    from .sources import read

    found = Report()
    try:
        with _progress_bar() as progress:
            scene = read(source, found)
            analysis = run(scene, AnalysisOptions(closures, limits), lambda done: progress("limits", done))
    except KinefabError as error:
        _log(error.report or Report(list(error.diagnostics)))
        raise typer.Exit(1)
    found.extend(analysis.report)
    _log(found)
    typer.echo(json.dumps(document(analysis), indent=2, ensure_ascii=False) if as_json else table(analysis))
    if found.of(Severity.ERROR):
        raise typer.Exit(1)


@app.command()
def inspect(
    file: Path = typer.Argument(..., help="A NAME.kinefab scene.", show_default=False),
    as_json: bool = typer.Option(False, "--json", help="Print the same as JSON."),
) -> None:
    """Show what is in a scene: objects, joints, freedoms and what was lost on the way."""
    from .inspection import overview

    try:
        text = overview(file, as_json)
    except KinefabError as error:
        _log(Report(list(error.diagnostics)))
        raise typer.Exit(1) from None
    typer.echo(text)


@app.command()
def draw(
    file: Path = typer.Argument(..., help="A NAME.kinefab scene.", show_default=False),
    output: Path = typer.Option(..., "--output", "-o", help="Picture to write: NAME.svg.", show_default=False),
) -> None:
    """Draw a scene: its bodies, its joints and how far they move."""
    _demand_ending(output, ".svg")
    from .inspection import picture

    try:
        svg = picture(file)
    except KinefabError as error:
        _log(Report(list(error.diagnostics)))
        raise typer.Exit(1)
    _write(output, svg.encode("utf-8"))


def _demand_ending(output: Path, ending: str) -> None:
    """A file of another name would not be found by the program that reads it (Unity imports by ending)."""
    if output.suffix != ending:
        raise typer.BadParameter(f"{output} does not end in {ending}", param_hint="--output")


def _count(number: int, word: str, words: str) -> str:
    return f"{number} {word if number == 1 else words}"


def _log(report: Report) -> None:
    """Findings on stderr, one a line, coloured on a terminal."""
    from rich.console import Console
    from rich.text import Text

    least = {1: 0, 0: 1, -1: 2}[_verbosity]
    rank = {Severity.INFO: 0, Severity.WARNING: 1, Severity.ERROR: 2}
    style = {Severity.INFO: "dim", Severity.WARNING: "yellow", Severity.ERROR: "red"}
    console = Console(stderr=True, soft_wrap=True, highlight=False)
    for found in report.diagnostics:
        if rank[found.severity] >= least:
            console.print(Text(printable(str(found)), style=style[found.severity]))


def _write(path: Path, content: bytes) -> None:
    """The file, whole; where that fails the old one stands, and the program ends."""
    with _unwritable_as_finding(path):
        write_whole(path, content)


@contextmanager
def _unwritable_as_finding(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        detail = error.strerror or str(error)
        _log(Report([diagnostic("TARGET_UNWRITABLE", path=path, detail=detail)]))
        raise typer.Exit(1) from None


def _summary(result: ExportResult) -> str:
    outcomes = [outcome.outcome.value for outcome in result.report.outcomes]
    counts = ", ".join(f"{outcomes.count(word)} {word}" for word in ("kept", "approximated", "dropped"))
    objects = result.document.tail["gameObjects"]
    joints = sum(c["type"].endswith("Joint") for o in objects for c in o.get("components", ()))
    meshes = len(result.document.meshes)
    parts = _count(len(objects), "object", "objects"), _count(joints, "joint", "joints"), _count(meshes, "mesh", "meshes")
    return f"{result.path}: {', '.join(parts)}; features: {counts}."


@contextmanager
def _progress_bar() -> Iterator[Callable[[str, float], None]]:
    """A bar on a terminal, nothing in a pipe."""
    if _verbosity < 0 or not sys.stderr.isatty():
        yield lambda stage, fraction: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        tasks: dict[str, TaskID] = {}

        def advance(stage: str, fraction: float) -> None:
            if stage not in tasks:
                tasks[stage] = bar.add_task(stage, total=1.0)
            bar.update(tasks[stage], completed=fraction)

        yield advance


def main() -> None:
    """Entry point of the ``kinefab`` script."""
    app()
