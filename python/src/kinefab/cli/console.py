"""What all commands say and write alike: findings, JSON, progress, files that cannot be written."""

from __future__ import annotations

import json
import os
import shlex
import subprocess
import sys
from collections.abc import Callable, Generator
from contextlib import contextmanager
from pathlib import Path
from typing import NoReturn

import typer

from ..diagnostics import MOST_ALIKE, KinefabError, Report, Severity, diagnostic, listed, printable
from ..replacing import why_unwritable, write_whole
from .findings import findings_document

verbosity = 0
"""1: remarks are shown too; 0: warnings and errors; -1: errors only.  Set by the program's own options."""


def demand_ending(output: Path, *endings: str) -> None:
    """A file of another name would not be found by the program that reads it (Unity imports by ending)."""
    if not output.name.lower().endswith(endings):
        raise typer.BadParameter(f"{output} does not end in {' or '.join(endings)}", param_hint="--output")


def demand_axis(up: str) -> str:
    """The axis that ``--up`` names, as a capital."""
    if up.upper() not in ("X", "Y", "Z"):
        raise typer.BadParameter(f"{up!r} is no axis: X, Y or Z", param_hint="--up")
    return up.upper()


def count(number: int, word: str, words: str) -> str:
    """``1 joint``, ``2 joints``."""
    return f"{number} {word if number == 1 else words}"


def typed(path: Path) -> str:
    """A path as it is typed, in a command that is to be copied."""
    return subprocess.list2cmdline([str(path)]) if os.name == "nt" else shlex.quote(str(path))


def remark(text: str) -> None:
    """Say on stderr what was made, or what comes next, unless errors alone are wanted."""
    if verbosity >= 0:
        typer.echo(text, err=True)


MOST_WARNINGS = 8
"""Warnings of one code that are listed unless remarks are asked for too: a robot has one for each of its links."""


def log(report: Report) -> None:
    """Findings on stderr, one a line, coloured on a terminal; of many that are alike the first ones, and how many more."""
    least = {1: 0, 0: 1, -1: 2}[verbosity]
    rank = {Severity.INFO: 0, Severity.WARNING: 1, Severity.ERROR: 2}
    style = {Severity.INFO: "dim", Severity.WARNING: "yellow", Severity.ERROR: "red"}
    most = MOST_ALIKE if verbosity > 0 else MOST_WARNINGS
    where = "--json lists all." if verbosity > 0 else f"--json lists all, kinefab -v the first {MOST_ALIKE}."
    shown = [found for found in listed(report.diagnostics, most, where) if rank[found.severity] >= least]
    if not shown:  # nor is there a reason to wait for rich
        return
    from rich.console import Console
    from rich.text import Text

    console = Console(stderr=True, soft_wrap=True, highlight=False)
    for found in shown:
        console.print(Text(printable(str(found)), style=style[found.severity]))


def json_text(values: object) -> str:
    """JSON as it is printed and written.  What UTF-8, or the terminal's own encoding, has no letters for (a path's bytes
    may be anything) is escaped as JSON does."""
    narrow = not sys.stdout.encoding.lower().startswith("utf")
    text = json.dumps(values, indent=2, ensure_ascii=narrow)
    return text.encode("utf-8", "backslashreplace").decode("utf-8")


def tell(report: Report, file: Path, as_json: bool, written: bool | None = None) -> None:
    """The findings, on stderr for people; as one JSON object on stdout too where that is asked for."""
    log(report)
    if as_json:
        typer.echo(json_text(findings_document(report, str(file), written)))


def fail(error: KinefabError | Report, file: Path, as_json: bool, written: bool | None = None) -> NoReturn:
    """Tell the findings and end the program."""
    found = error if isinstance(error, Report) else error.report or Report(list(error.diagnostics))
    tell(found, file, as_json, written)
    raise typer.Exit(1) from None


def write(path: Path, content: bytes, as_json: bool = False) -> None:
    """The file, whole; where that fails the old one stands, and the program ends."""
    with unwritable_as_finding(path, as_json):
        write_whole(path, content)


@contextmanager
def unwritable_as_finding(path: Path, as_json: bool = False) -> Generator[None, None, None]:
    """Where the file cannot be written: says so and ends the program."""
    try:
        yield
    except OSError as error:
        detail = why_unwritable(path, error)
        fail(Report([diagnostic("TARGET_UNWRITABLE", path=path, detail=detail)]), path, as_json, False)


@contextmanager
def progress_bar() -> Generator[Callable[[str, float], None], None, None]:
    """A bar on a terminal, nothing in a pipe.  Gives what advances it: a stage's name and its done part, 0 to 1."""
    if verbosity < 0 or not sys.stderr.isatty():
        yield lambda stage, fraction: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        tasks: dict[str, TaskID] = {}

        def advance(stage: str, fraction: float) -> None:
            if stage not in tasks:
                tasks[stage] = bar.add_task(stage, total=1.0)
            bar.update(tasks[stage], completed=fraction)

        yield advance
