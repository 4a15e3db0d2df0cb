"""``kinefab inspect``."""

from __future__ import annotations

from pathlib import Path

import typer

from ..diagnostics import KinefabError, Report
from .console import log


def inspect(
    file: Path = typer.Argument(..., help="A NAME.kinefab scene.", show_default=False),
    as_json: bool = typer.Option(False, "--json", help="Print the same as JSON."),
) -> None:
    """Show what is in a scene: objects, joints, freedoms and what was lost on the way."""
    from ..views.overview import overview

    try:
        text = overview(file, as_json)
    except KinefabError as error:
        log(Report(list(error.diagnostics)))
        raise typer.Exit(1) from None
    typer.echo(text)
