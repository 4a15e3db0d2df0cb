"""What a person sees while a batch runs: a bar with rate and time left, or one JSON line a file."""

from __future__ import annotations

import json
import sys
from collections.abc import Generator, Iterable
from contextlib import contextmanager

from ..diagnostics import printable
from .job import Outcome, Record
from .run import Progress

SHOWN = 50
"""Files whose failure is told on the way; the index tells all."""


def summary(records: Iterable[Record]) -> list[str]:
    """A line an outcome: how many, seconds a file, and the most memory that one took."""
    lines: list[str] = []
    for outcome in Outcome:
        group = [record for record in records if record.outcome is outcome]
        if group:
            seconds = sum(record.seconds for record in group) / len(group)
            memory = max(record.memory for record in group) / 2**20
            word = outcome.value.replace("_", " ")
            lines.append(f"{len(group):8} {word:<10} {seconds:9.2f} s a file {memory:8.0f} MiB at most")
    return lines


@contextmanager
def watched(as_json: bool, quiet: bool) -> Generator[Progress, None, None]:
    """A progress that writes to stdout (JSON) and stderr (bar and failures)."""
    failures = 0

    def tell(record: Record) -> None:
        nonlocal failures
        if as_json:
            text = json.dumps(record.as_json(), ensure_ascii=False)
            print(text.encode("utf-8", "backslashreplace").decode("utf-8"), flush=True)
        if not record.outcome.good:
            failures += 1
            if failures <= SHOWN and not quiet:
                why = record.messages[0] if record.messages else " ".join(record.codes)
                print(printable(f"{record.outcome.value}: {record.source}: {why}"), file=sys.stderr)

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
