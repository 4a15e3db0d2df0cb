"""What a person sees while a batch runs: a bar with rate and time left, or one JSON line a file."""

from __future__ import annotations

import json
import sys
from collections.abc import Generator
from contextlib import contextmanager

from .job import Record
from .run import Progress

SHOWN = 50
"""Files whose failure is told on the way; the index tells all."""


@contextmanager
def watched(as_json: bool, quiet: bool) -> Generator[Progress, None, None]:
    """A progress that writes to stdout (JSON) and stderr (bar and failures)."""
    failures = 0

    def tell(record: Record) -> None:
        nonlocal failures
        if as_json:
            print(json.dumps(record.as_json(), ensure_ascii=False), flush=True)
        if not record.outcome.good:
            failures += 1
            if failures <= SHOWN and not quiet:
                why = record.messages[0] if record.messages else " ".join(record.codes)
                print(f"{record.outcome.value}: {record.source}: {why}", file=sys.stderr)

    if quiet or not sys.stderr.isatty():
        yield lambda done, total, record: tell(record)
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (BarColumn(), MofNCompleteColumn(), TextColumn("{task.fields[rate]}"), TimeRemainingColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("", total=None, rate="")

        def advance(done: int, total: int, record: Record) -> None:
            tell(record)
            elapsed = bar.tasks[0].elapsed or 0.0
            rate = f"{done / elapsed:.1f} files/s" if elapsed else ""
            bar.update(task, completed=done, total=total, rate=rate)

        yield advance
