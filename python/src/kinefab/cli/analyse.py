"""``kinefab analyse``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import typer

from ..diagnostics import KinefabError, Report, Severity
from ..options import Closures, ExportOptions
from ..sources import source_options
from .asking import asking
from .console import log, progress_bar
from .declared import CLOSURES, DENSITY, SOURCE_HELP


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
    from ..analysis.findings.summary import document
    from ..analysis.findings.table import table
    from ..pipeline import analysed, prepared

    try:
        options = ExportOptions(density=density, closures=closures, limits=limits, reading=reading)
    except ValueError as error:
        raise typer.BadParameter(str(error), param_hint="--density") from None
    found = Report()
    try:
        with progress_bar() as progress:
            analysis = analysed(prepared(source, options, found, progress), options, found, progress).analysis
    except KinefabError:
        log(found)
        raise typer.Exit(1) from None
    log(found)
    typer.echo(json.dumps(document(analysis), indent=2, ensure_ascii=False) if as_json else table(analysis))
    if found.of(Severity.ERROR):
        raise typer.Exit(1)
