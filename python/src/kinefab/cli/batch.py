"""``kinefab batch``; what takes long to import is imported inside."""

from __future__ import annotations

from typing import Any, Optional

import typer

from ..options import DEFAULT_DENSITY, ColliderShape, ExportOptions
from ..sources import source_options
from ..targets import known_endings, target_options
from .asking import asking


@asking(("reading", source_options()), ("writing", target_options()))
def batch(
    reading: dict[str, Any],
    writing: dict[str, Any],
    inputs: list[str] = typer.Argument(
        ...,
        metavar="IN...",
        help="Sources, folders or patterns; paths or URLs (s3://...).",
        show_default=False,
    ),
    output: str = typer.Option(..., "--output", "-o", help="Folder or URL to write to.", show_default=False),
    to: str = typer.Option(
        "kinefab", "--to", help=f"Kind of output: {', '.join(e[1:] for e in known_endings())}."
    ),
    jobs: Optional[int] = typer.Option(
        None, "--jobs", "-j", min=1, help="Files at once (default: one a processor)."
    ),
    scheduler: Optional[str] = typer.Option(
        None, "--scheduler", metavar="tcp://HOST:PORT", help="A Dask scheduler whose workers do the work."
    ),
    timeout: Optional[float] = typer.Option(
        None, "--timeout", min=0.001, help="Seconds that one file may take."
    ),
    memory: Optional[float] = typer.Option(None, "--memory", min=1.0, help="MiB that one file may take."),
    force: bool = typer.Option(
        False, "--force", help="Convert what is up to date, overwrite what others wrote."
    ),
    strict: bool = typer.Option(False, "--strict", help="A loss that is worth a warning is an error."),
    colliders: ColliderShape = typer.Option(
        ColliderShape.AUTO, "--colliders", show_default="auto", help="Collider of each body."
    ),
    density: float = typer.Option(DEFAULT_DENSITY, "--density", help="kg/m^3 of bodies that state none."),
    quiet: bool = typer.Option(False, "--quiet", "-q", help="Show no progress and no summary."),
    as_json: bool = typer.Option(False, "--json", help="Print one JSON line a file as it is done."),
) -> None:
    """Export many sources, each in a process of its own; what is up to date is skipped."""
    from ..batching.cluster import executor_of
    from ..batching.run import batch as run
    from ..batching.watching import watched
    from ..diagnostics import KinefabError

    if f".{to}" not in known_endings():
        raise typer.BadParameter(f"{to!r} is no output", param_hint="--to")
    try:
        options = ExportOptions(
            colliders=colliders, density=density, strict=strict, reading=reading, writing=writing
        )
    except ValueError as error:
        raise typer.BadParameter(str(error), param_hint="--density") from None
    bytes_allowed = None if memory is None else int(memory * 2**20)
    try:
        with executor_of(scheduler) as executor, watched(as_json, quiet) as progress:
            result = run(
                inputs,
                output,
                to,
                options,
                jobs=jobs,
                executor=executor,
                timeout=timeout,
                memory=bytes_allowed,
                force=force,
                progress=progress,
            )
    except KinefabError as error:
        for found in error.diagnostics:
            typer.echo(str(found), err=True)
        raise typer.Exit(1) from None
    except (OSError, ImportError) as error:
        reason = getattr(error, "strerror", None) or error
        typer.echo(
            f"{output} cannot be written: {reason}. Check the folder, or what its scheme needs installed.",
            err=True,
        )
        raise typer.Exit(1) from None
    if not quiet:
        counts = ", ".join(f"{count} {word.replace('_', ' ')}" for word, count in result.counts.items())
        typer.echo(f"{result.index}: {counts or 'no source was found'}.", err=True)
    if not result.worst.good:
        raise typer.Exit(1)
