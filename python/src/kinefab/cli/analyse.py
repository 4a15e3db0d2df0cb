"""``kinefab analyse``."""

from __future__ import annotations

from pathlib import Path

import typer

from ..diagnostics import KinefabError, Report, Severity
from ..options import ExportOptions
from .asking import taking
from .console import fail, json_text, log, progress_bar
from .declared import AS_JSON, SOURCE_HELP, analysis_options


@taking("options", analysis_options)
def analyse(
    options: ExportOptions,
    source: Path = typer.Argument(..., help=SOURCE_HELP, show_default=False),
    as_json: bool = AS_JSON,
) -> None:
    """Show what may move in an assembly, by which joint, and why."""
    from ..analysis.findings.summary import document
    from ..analysis.findings.table import table
    from ..pipeline import analysed, prepared

    found = Report()
    try:
        with progress_bar() as progress:
            analysis = analysed(prepared(source, options, found, progress), options, found, progress).analysis
    except KinefabError:
        fail(found, source, as_json)
    log(found)
    typer.echo(json_text(document(analysis)) if as_json else table(analysis))
    if found.of(Severity.ERROR):
        raise typer.Exit(1)
