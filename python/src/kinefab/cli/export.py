"""``kinefab export``."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional

import typer

from ..diagnostics import KinefabError, Report, report_document
from ..options import DEFAULT_SMOOTH, Closures, ColliderShape, ExportOptions, Ground
from ..replacing import demand_writable
from ..sources import source_options
from ..targets import known_endings, target_options
from . import console
from .asking import asking
from .console import count, demand_ending, log, progress_bar, unwritable_as_finding, write
from .declared import CLOSURES, DENSITY, SOURCE_HELP, TARGET_HELP

if TYPE_CHECKING:
    from ..pipeline import ExportResult


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
    demand_ending(output, *known_endings())
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
        with unwritable_as_finding(report):
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
        words = ("loss or error", "losses or errors") if strict else ("error", "errors")
        reason = count(reasons, *words)
        typer.echo(f"{output} was not written: {reason}.", err=True)
    elif console.verbosity >= 0:
        typer.echo(_summary(result), err=True)
    if report is not None:
        told = report_document(found, str(output), result is not None)
        text = json.dumps(told, indent=2, ensure_ascii=False) + "\n"
        # A path's bytes may be no UTF-8; the escapes are JSON's.
        write(report, text.encode("utf-8", "backslashreplace"))
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
    return f"{result.path}: {', '.join(parts)}; features: {counts}."
