"""The command line: a thin layer over ``kinefab.export`` and ``kinefab.views.overview``.

Logs go to stderr, data to stdout; exit 0 done, 1 errors found, 2 wrong usage.  What takes long to import is
imported inside the commands.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Generator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional

import typer

from . import __version__
from .asking import asking
from .batching.command import batch
from .bundling.command import bundle_commands
from .capturing import commands
from .diagnostics import KinefabError, Report, Severity, diagnostic, listed, printable, report_document
from .options import DEFAULT_DENSITY, DEFAULT_SMOOTH, Closures, ColliderShape, ExportOptions, Ground
from .replacing import demand_writable, write_whole
from .sources import known_suffixes, source_options
from .targets import known_endings, target_options

if TYPE_CHECKING:
    from .pipeline import ExportResult

app = typer.Typer(
    name="kinefab",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,  # importing rich for the help alone takes longer than all the rest
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


SOURCE_HELP = f"Assembly to read: {', '.join(sorted(known_suffixes()))}."
DENSITY: Any = typer.Option(DEFAULT_DENSITY, "--density", help="kg/m^3 of bodies that state none.")
CLOSURES: Any = typer.Option(
    Closures.EXACT,
    "--closures",
    show_default="exact",
    help="Equations of loop-closing joints: all, as Unity needs them, or the fewest, for a direct solver.",
)
TARGET_HELP = f"File to write; its ending chooses the kind: {', '.join(known_endings())}."


@app.command()
@asking(("reading", source_options()), ("writing", target_options()))
def export(
    reading: dict[str, Any],
    writing: dict[str, Any],
    source: Path = typer.Argument(..., help=SOURCE_HELP, show_default=False),
    output: Path = typer.Option(..., "--output", "-o", help=TARGET_HELP, show_default=False),
    strict: bool = typer.Option(
        False, "--strict", help="Fail where anything would be approximated or dropped."
    ),
    report: Optional[Path] = typer.Option(None, "--report", help="Write every finding to this JSON file."),
    colliders: ColliderShape = typer.Option(
        ColliderShape.AUTO, "--colliders", show_default="auto", help="Collider of each body."
    ),
    density: float = DENSITY,
    closures: Closures = CLOSURES,
    solve: bool = typer.Option(
        False, "--solve", help="Move the parts to the nearest pose that fits the constraints."
    ),
    limits: bool = typer.Option(
        False, "--limits", help="Search how far joints can move and write it as limits."
    ),
    smooth: float = typer.Option(
        DEFAULT_SMOOTH,
        "--smooth",
        help="Degrees up to which an edge is drawn smooth, of meshes without normals.",
    ),
) -> None:
    """Export an assembly or a robot as a Unity scene."""
    _demand_ending(output, *known_endings())
    try:
        given = (colliders, density, strict, closures, solve, limits, reading, writing, smooth)
        options = ExportOptions(*given, ground=Ground.among(reading))
    except ValueError as error:
        hint = "--smooth" if str(error).startswith("smooth") else "--density"
        raise typer.BadParameter(str(error), param_hint=hint) from None
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
        words = ("loss or error", "losses or errors") if strict else ("error", "errors")
        reason = _count(reasons, *words)
        typer.echo(f"{output} was not written: {reason}.", err=True)
    elif _verbosity >= 0:
        typer.echo(_summary(result), err=True)
    if report is not None:
        told = report_document(found, str(output), result is not None)
        text = json.dumps(told, indent=2, ensure_ascii=False) + "\n"
        # A path's bytes may be no UTF-8; the escapes are JSON's.
        _write(report, text.encode("utf-8", "backslashreplace"))
    if result is None:
        raise typer.Exit(1)


@app.command()
@asking(("reading", source_options()))
def analyse(
    reading: dict[str, Any],
    source: Path = typer.Argument(..., help=SOURCE_HELP, show_default=False),
    as_json: bool = typer.Option(False, "--json", help="Print the same as JSON."),
    density: float = DENSITY,
    closures: Closures = CLOSURES,
    limits: bool = typer.Option(False, "--limits", help="Search how far joints can move."),
) -> None:
    """Show what an assembly's constraints leave free, and which joint connects what."""
    from .analysis.findings.summary import document
    from .analysis.findings.table import table
    from .pipeline import analysed, prepared

    try:
        options = ExportOptions(density=density, closures=closures, limits=limits, reading=reading)
    except ValueError as error:
        raise typer.BadParameter(str(error), param_hint="--density") from None
    found = Report()
    try:
        with _progress_bar() as progress:
            analysis = analysed(prepared(source, options, found, progress), options, found, progress).analysis
    except KinefabError:
        _log(found)
        raise typer.Exit(1) from None
    _log(found)
    typer.echo(json.dumps(document(analysis), indent=2, ensure_ascii=False) if as_json else table(analysis))
    if found.of(Severity.ERROR):
        raise typer.Exit(1)


@app.command()
@asking(("reading", source_options()))
def mates(
    reading: dict[str, Any],
    source: Path = typer.Argument(
        ..., help="Assembly with exact geometry: STEP or IGES.", show_default=False
    ),
    output: Optional[Path] = typer.Option(
        None, "--output", "-o", help="File to write, NAME.mates.json; beside the source otherwise."
    ),
) -> None:
    """Find the mates of an assembly that states none, for you to look over and to give by --mates."""
    output = source.with_suffix(".mates.json") if output is None else output
    _demand_ending(output, ".mates.json")
    from .mates.listing import listing
    from .mates.mates_file import text
    from .pipeline import mates_of

    found = Report()
    try:
        with _progress_bar() as progress:
            scene, mates = mates_of(source, reading, found, progress)
    except KinefabError:
        _log(found)
        raise typer.Exit(1) from None
    _log(found)
    typer.echo(listing(scene, mates))
    _write(output, text(scene, mates).encode("utf-8"))


@app.command()
def inspect(
    file: Path = typer.Argument(..., help="A NAME.kinefab scene.", show_default=False),
    as_json: bool = typer.Option(False, "--json", help="Print the same as JSON."),
) -> None:
    """Show what is in a scene: objects, joints, freedoms and what was lost on the way."""
    from .views.overview import overview

    try:
        text = overview(file, as_json)
    except KinefabError as error:
        _log(Report(list(error.diagnostics)))
        raise typer.Exit(1) from None
    typer.echo(text)


@app.command()
def draw(
    file: Path = typer.Argument(
        ..., help="Scene or assembly: NAME.kinefab or any source.", show_default=False
    ),
    output: Path = typer.Option(
        ..., "--output", "-o", help="Picture to write: NAME.svg, .png, .gif or .webp.", show_default=False
    ),
    motion: bool = typer.Option(False, "--motion", help="A moving SVG; .gif and .webp always move."),
    joint: Optional[str] = typer.Option(
        None, "--joint", help="What is driven; without it the first freedom."
    ),
) -> None:
    """Draw a scene: its bodies, its joints and how far they move."""
    _demand_ending(output, ".svg", ".png", ".gif", ".webp")
    try:
        if output.suffix == ".svg" and not motion and file.suffix == ".kinefab":
            from .views.overview import picture

            content = picture(file).encode("utf-8")
        else:
            from .filming import film

            content = film(file, output.suffix, joint)
    except ValueError as error:
        raise typer.BadParameter(str(error), param_hint="--joint") from None
    except KinefabError as error:
        _log(error.report or Report(list(error.diagnostics)))
        raise typer.Exit(1) from None
    _write(output, content)


@app.command()
def report(
    source: Path = typer.Argument(
        ..., help="Scene or assembly: NAME.kinefab or any source.", show_default=False
    ),
    output: Path = typer.Option(..., "--output", "-o", help="Page to write: NAME.html.", show_default=False),
) -> None:
    """Write the page of ``view`` with the analysis in words, plots of each freedom and what was lost."""
    _demand_ending(output, ".html")
    from .showing import report as run

    try:
        run(source, output)
    except KinefabError as error:
        _log(error.report or Report(list(error.diagnostics)))
        raise typer.Exit(1) from None


@app.command()
def view(
    source: Path = typer.Argument(
        ..., help="Scene or assembly: NAME.kinefab or any source.", show_default=False
    ),
    output: Optional[Path] = typer.Option(
        None,
        "--output",
        "-o",
        help="Page to write: NAME.html; without it, in this folder.",
        show_default=False,
    ),
    open_: bool = typer.Option(False, "--open", help="Open it in the browser."),
    mates: Optional[Path] = typer.Option(
        None, "--mates", help="NAME.mates.json: list its mates, to be switched."
    ),
) -> None:
    """Write one HTML file that plays the mechanism: every freedom on a slider, nothing fetched."""
    page = Path(source.name.split(".")[0] + ".html") if output is None else output
    _demand_ending(page, ".html")
    from .showing import view as run

    try:
        run(source, page, mates)
    except KinefabError as error:
        _log(error.report or Report(list(error.diagnostics)))
        raise typer.Exit(1) from None
    typer.echo(page)
    if open_:
        typer.launch(str(page))


app.command()(asking(("reading", source_options()), ("writing", target_options()))(batch))


def _demand_ending(output: Path, *endings: str) -> None:
    """A file of another name would not be found by the program that reads it (Unity imports by ending)."""
    if not output.name.endswith(endings):
        raise typer.BadParameter(f"{output} does not end in {' or '.join(endings)}", param_hint="--output")


def _count(number: int, word: str, words: str) -> str:
    return f"{number} {word if number == 1 else words}"


def _log(report: Report) -> None:
    """Findings on stderr, one a line, coloured on a terminal; of thousands that are alike the first ones."""
    from rich.console import Console
    from rich.text import Text

    least = {1: 0, 0: 1, -1: 2}[_verbosity]
    rank = {Severity.INFO: 0, Severity.WARNING: 1, Severity.ERROR: 2}
    style = {Severity.INFO: "dim", Severity.WARNING: "yellow", Severity.ERROR: "red"}
    console = Console(stderr=True, soft_wrap=True, highlight=False)
    for found in listed(report.diagnostics):
        if rank[found.severity] >= least:
            console.print(Text(printable(str(found)), style=style[found.severity]))


def _write(path: Path, content: bytes) -> None:
    """The file, whole; where that fails the old one stands, and the program ends."""
    with _unwritable_as_finding(path):
        write_whole(path, content)


@contextmanager
def _unwritable_as_finding(path: Path) -> Generator[None, None, None]:
    try:
        yield
    except OSError as error:
        detail = error.strerror or str(error)
        _log(Report([diagnostic("TARGET_UNWRITABLE", path=path, detail=detail)]))
        raise typer.Exit(1) from None


def _summary(result: ExportResult) -> str:
    outcomes = [outcome.outcome.value for outcome in result.report.outcomes]
    counts = ", ".join(f"{outcomes.count(word)} {word}" for word in ("kept", "approximated", "dropped"))
    numbers = result.numbers
    parts = (
        _count(numbers[0], "object", "objects"),
        _count(numbers[1], "joint", "joints"),
        _count(numbers[2], "mesh", "meshes"),
    )
    return f"{result.path}: {', '.join(parts)}; features: {counts}."


@contextmanager
def _progress_bar() -> Generator[Callable[[str, float], None], None, None]:
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


app.add_typer(commands(_log))
app.add_typer(bundle_commands(_log))


def main() -> None:
    """Entry point of the ``kinefab`` script."""
    try:
        try:
            app()
        finally:
            sys.stdout.flush()
    except BrokenPipeError:  # whoever reads has enough; nothing more is to be flushed at the end
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(1)
    except OSError as error:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        typer.echo(f"kinefab: the output cannot be written: {error.strerror or error}", err=True)
        sys.exit(1)
