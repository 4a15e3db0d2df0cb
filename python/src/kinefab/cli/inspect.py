"""``kinefab inspect``."""

from __future__ import annotations

from pathlib import Path

import typer

from ..diagnostics import KinefabError
from ..sources import format_of
from ..targets import known_endings
from .console import fail
from .declared import AS_JSON


def inspect(
    file: Path = typer.Argument(..., help="A NAME.kinefab scene.", show_default=False),
    as_json: bool = AS_JSON,
) -> None:
    """Show a scene's objects, joints, freedoms and losses."""
    exported = file.name.endswith(tuple(ending for ending in known_endings() if ending != ".kinefab"))
    kind = format_of(file)
    if exported or (kind is not None and ".kinefab" not in kind.suffixes):
        told = f"{file} is no NAME.kinefab; export to one, or read the source by 'kinefab analyse'"
        raise typer.BadParameter(told, param_hint="FILE")
    from ..views.overview import overview

    try:
        text = overview(file, as_json)
    except KinefabError as error:
        fail(error, file, as_json)
    typer.echo(text)
