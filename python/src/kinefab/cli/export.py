"""``kinefab export``."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Optional

import typer

from ..diagnostics import KinefabError, Report, Severity
from ..options import ExportOptions
from ..replacing import demand_writable
from ..targets import known_endings
from . import console
from .asking import taking
from .console import count, demand_ending, json_text, log, progress_bar, remark, unwritable_as_finding, write
from .declared import SOURCE_HELP, TARGET_HELP, export_options
from .findings import report_document

if TYPE_CHECKING:
    from ..pipeline import ExportResult


@taking("options", export_options)
def export(
    options: ExportOptions,
    source: Path = typer.Argument(..., help=SOURCE_HELP, show_default=False),
    output: Path = typer.Option(..., "--output", "-o", help=TARGET_HELP, show_default=False),
    report: Optional[Path] = typer.Option(None, "--report", help="Write every finding to this JSON file."),
    as_json: bool = typer.Option(False, "--json", help="Print every finding as JSON."),
) -> None:
    """Export an assembly or a robot as a Unity scene."""
    demand_ending(output, *known_endings())
    for path, hint, others in ((output, "--output", (source,)), (report, "--report", (source, output))):
        if path is not None and os.path.isdir(path):
            raise typer.BadParameter(f"{path} is a folder", param_hint=hint)
        if path is not None and any(os.path.realpath(path) == os.path.realpath(other) for other in others):
            raise typer.BadParameter(f"{path} is named twice; it would be overwritten", param_hint=hint)
    if report is not None:  # before the work: a scene whose losses nobody is told is not to be written
        with unwritable_as_finding(report, as_json):
            demand_writable(report)
    from ..pipeline import export as run

    result: Optional[ExportResult] = None
    reasons = 0
    try:
        with progress_bar() as progress:
            result = run(source, output, options, progress)
        found = result.report
    except KinefabError as error:
        found, reasons = error.report or Report(list(error.diagnostics)), len(error.diagnostics)
    log(found)
    if result is None:
        words = ("loss or error", "losses or errors") if options.strict else ("error", "errors")
        reason = count(reasons, *words)
        typer.echo(f"{output} was not written: {reason}.", err=True)
    else:
        remark(_summary(result))
    if as_json or report is not None:
        text = json_text(report_document(found, str(output), result is not None))
        if as_json:
            typer.echo(text)
        if report is not None:
            write(report, f"{text}\n".encode())
    if result is None:
        raise typer.Exit(1)


def _summary(result: ExportResult) -> str:
    outcomes = [outcome.outcome.value for outcome in result.report.outcomes]
    counts = ", ".join(f"{outcomes.count(word)} {word}" for word in ("kept", "approximated", "dropped"))
    numbers = result.numbers
    parts = (
        count(numbers[0], "object", "objects"),
        count(numbers[1], "joint", "joints"),
        count(numbers[2], "mesh", "meshes"),
    )
    lost = any(outcome.severity is Severity.INFO and outcome.code for outcome in result.report.outcomes)
    more = " 'kinefab -v export' names each." if lost and console.verbosity == 0 else ""
    return f"{result.path}: {', '.join(parts)}; features: {counts}.{more}"
