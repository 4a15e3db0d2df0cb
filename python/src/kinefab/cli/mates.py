"""``kinefab mates``."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Optional

import typer

from ..diagnostics import KinefabError, Report
from ..sources import source_options
from .asking import asking
from .console import demand_ending, fail, log, progress_bar, remark, typed, write


@asking(("reading", source_options(beside="mates")))
def mates(
    reading: dict[str, Any],
    source: Path = typer.Argument(
        ..., help="Assembly with exact geometry: STEP or IGES.", show_default=False
    ),
    output: Optional[Path] = typer.Option(
        None, "--output", "-o", help="File to write, NAME.mates.json; beside the source otherwise."
    ),
    as_json: bool = typer.Option(False, "--json", help="Print what is written instead of the list."),
) -> None:
    """Find the mates of an assembly that states none. Look them over, and give the file by --mates."""
    output = source.with_suffix(".mates.json") if output is None else output
    demand_ending(output, ".mates.json")
    from ..mates.listing import listing
    from ..mates.mates_file import text
    from ..pipeline import mates_of

    found = Report()
    try:
        with progress_bar() as progress:
            scene, mates = mates_of(source, reading, found, progress)
    except KinefabError:
        fail(found, source, as_json)
    log(found)
    content = text(scene, mates)
    if not as_json:
        typer.echo(listing(scene, mates))
    write(output, content.encode("utf-8"), as_json)
    remark(
        f"{output}: look it over, then: kinefab export {typed(source)} --mates {typed(output)} -o NAME.kinefab"
    )
    if as_json:
        typer.echo(content, nl=False)
