"""``kinefab batch``; what takes long to import is imported inside."""

from __future__ import annotations

import json
from typing import Optional

import typer

from ..diagnostics import KinefabError, Report
from ..options import ExportOptions
from ..targets import known_endings
from . import console
from .asking import taking
from .console import log
from .declared import export_options
from .findings import findings_document


@taking("options", export_options)
def batch(
    options: ExportOptions,
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
    quiet: bool = typer.Option(False, "--quiet", "-q", help="Show no progress and no summary."),
    as_json: bool = typer.Option(False, "--json", help="Print one JSON line a file as it is done."),
) -> None:
    """Export many sources, each in a process of its own. What is up to date is skipped.

    Two batches may share a folder: each target is written by one at a time, and the other finds it done; index.html and
    batch.jsonl are those of whichever ends last. At a URL nothing keeps two batches apart, since stores have no locks.
    """
    from ..batching.cluster import executor_of
    from ..batching.run import batch as run
    from ..batching.watching import summary, watched

    if f".{to}" not in known_endings():
        kinds = ", ".join(ending[1:] for ending in known_endings())
        raise typer.BadParameter(f"{to!r} is no output; there are {kinds}", param_hint="--to")
    quiet = quiet or console.verbosity < 0
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
        log(Report(list(error.diagnostics)))
        if as_json:
            typer.echo(json.dumps(findings_document(Report(list(error.diagnostics)), output, False)))
        raise typer.Exit(1) from None
    if not quiet:
        for line in summary(result.records):
            typer.echo(line, err=True)
        typer.echo(result.index, err=True)
    if not result.worst.good:
        raise typer.Exit(1)
