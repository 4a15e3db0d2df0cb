"""The batch: plan, hand out, gather."""

from __future__ import annotations

import json
import os
from collections import Counter
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import Executor, Future, as_completed
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from numbers import Real
from pathlib import Path
from typing import cast

from ..diagnostics import KinefabError, diagnostic
from ..options import ExportOptions, check_options
from ..replacing import demand_writable
from ..sources import source_options
from ..targets import known_endings, target_options
from . import places
from .index import index_page
from .job import Job, Outcome, Record, options_as_json, unmade
from .ledger import LEDGER
from .plan import planned
from .slot import convert, crew

Progress = Callable[[int, int, Record], None]
"""Called with how many are done, of how many, and what became of the last."""


def silent(done: int, total: int, record: Record) -> None:
    """Progress that nobody watches."""


@dataclass(frozen=True, slots=True)
class BatchResult:
    """What a batch did.  records: in the order of the plan, what is not even tried first.  index: the page that lists them.

    >>> import kinefab
    >>> kinefab.BatchResult((), "out/index.html").counts
    {}
    """

    records: tuple[Record, ...]
    index: str

    def __repr__(self) -> str:
        """In one line: it may have thousands of records."""
        counts = [f"{number} {outcome}" for outcome, number in self.counts.items()]
        return f"<BatchResult: {', '.join(counts) or 'no files'}; {self.index}>"

    @property
    def counts(self) -> dict[str, int]:
        """How many of each outcome.

        >>> kinefab.batch(["gone.urdf"], "out", jobs=1).counts
        {'refused': 1}
        """
        counted = Counter(record.outcome for record in self.records)
        return {outcome.value: counted[outcome] for outcome in Outcome if counted[outcome]}

    @property
    def worst(self) -> Outcome:
        """The worst outcome; UP_TO_DATE of an empty batch.

        >>> kinefab.batch([], "out").worst.value
        'up_to_date'
        """
        order = list(Outcome)
        return max((record.outcome for record in self.records), key=order.index, default=Outcome.UP_TO_DATE)


def batch(
    inputs: str | os.PathLike[str] | Iterable[str | os.PathLike[str]],
    out: str | os.PathLike[str],
    to: str = "kinefab",
    options: ExportOptions = ExportOptions(),
    *,
    jobs: int | None = None,
    executor: Executor | None = None,
    timeout: float | None = None,
    memory: int | None = None,
    force: bool = False,
    progress: Progress = silent,
) -> BatchResult:
    """Export every source in ``inputs`` into the folder ``out``.

    inputs: a file, a folder or a pattern, or several; paths, or URLs that fsspec knows.  out: folder or URL.
    to: kind of target, an ending without its dot.  jobs: files at once, None for one a processor.
    executor: who does the work instead, any of ``concurrent.futures`` or ``distributed.Client.get_executor()``; Kinefab is
    installed where it works, and paths mean the same there.
    timeout: seconds a file.  memory: bytes a file.  force: convert what is up to date, overwrite what others wrote.
    progress: called with how many are done, of how many, and the last one's record.
    Raises ValueError for a kind that no target has, for a word that an option has not and for a number that is not above
    zero, TypeError for inputs, a folder, options or a number that are none, KinefabError where ``out`` cannot be written.
    What goes wrong with a file is in its record.

    >>> import kinefab
    >>> result = kinefab.batch(["gone.urdf"], "out", timeout=120)
    >>> result.counts, [*result.records[0].codes]
    ({'refused': 1}, ['SOURCE_NOT_FOUND'])
    """
    ending = f".{str(to).lstrip('.')}"
    if ending not in known_endings():
        raise ValueError(
            f"there is no output {to!r}; pass one of: {', '.join(e[1:] for e in known_endings())}"
        )
    _check_numbers(jobs=jobs, timeout=timeout, memory=memory)
    _check_options(options)
    if not isinstance(cast(object, out), (str, os.PathLike)):
        raise TypeError(f"out is {out!r}; pass a folder or a URL")
    folder = os.fspath(out)
    folder = folder if places.is_url(folder) else os.path.abspath(folder)
    ledger = places.join(folder, LEDGER)
    named = _named(inputs)
    absolute = [place if places.is_url(place) else os.path.abspath(place) for place in named]
    asked = options_as_json(options)
    with _unwritable_as_finding(folder):
        plan = planned(absolute, folder, ending)
        _demand_folder(ledger)
    work = [Job(source, target, ledger, asked, timeout, memory, force) for source, target in plan.work]
    total = len(work) + len(plan.refused)
    found: dict[str, Record] = {}
    lines: list[str] = []

    def took(record: Record) -> None:
        lines.append(json.dumps(record.as_json(), ensure_ascii=False))
        progress(len(lines), total, record)

    for record in plan.refused:
        took(record)
    with crew(jobs or os.cpu_count() or 1) if executor is None else nullcontext(executor) as pool:
        futures: dict[Future[Record], Job] = {pool.submit(convert, job): job for job in work}
        for future in as_completed(futures):
            record = _record(future, futures[future])
            found[record.target] = record
            took(record)
    records = (*plan.refused, *(found[job.target] for job in work))
    index = places.join(folder, "index.html")
    told = "".join(f"{line}\n" for line in lines).encode("utf-8", "backslashreplace")
    with _unwritable_as_finding(folder):
        places.write_bytes(places.join(folder, "batch.jsonl"), told)
        places.write_bytes(index, index_page(records, folder).encode("utf-8", "backslashreplace"))
    return BatchResult(records, index)


def _named(inputs: object) -> list[str]:
    """A single path is the only one; it would be taken letter by letter."""
    if isinstance(inputs, (str, os.PathLike)):
        return [os.fspath(cast("str | os.PathLike[str]", inputs))]
    if not isinstance(inputs, Iterable):
        raise TypeError(f"the inputs are {inputs!r}; pass files, folders or patterns")
    named: list[str] = []
    for place in cast("Iterable[object]", inputs):
        if not isinstance(place, (str, os.PathLike)):
            raise TypeError(f"{place!r} is among the inputs; pass files, folders or patterns")
        named.append(os.fspath(cast("str | os.PathLike[str]", place)))
    return named


def _check_numbers(**numbers: object) -> None:
    for name, number in numbers.items():
        if number is None:
            continue
        if isinstance(number, bool) or not isinstance(number, Real):
            raise TypeError(f"{name} is {number!r}; pass a number, or None")
        if not float(number) > 0:
            raise ValueError(f"{name} is {number}; it must be a number above zero, or None")


def _check_options(options: ExportOptions) -> None:
    """At once, not by each of ten thousand files."""
    check_options(options)
    for option in source_options():
        option.check(options.reading.get(option.name))
    for option in target_options():
        option.check(options.writing.get(option.name))


def _demand_folder(ledger: str) -> None:
    """Raises OSError where the records cannot be written: found out at once, not by ten thousand files."""
    if places.is_url(ledger):
        places.write_bytes(
            places.join(ledger, "README"), b"What kinefab batch has done; the next run skips it.\n"
        )
        return
    os.makedirs(ledger, exist_ok=True)
    demand_writable(Path(ledger, "records"))


@contextmanager
def _unwritable_as_finding(folder: str) -> Generator[None, None, None]:
    try:
        yield
    except (ImportError, ValueError) as error:  # ValueError: fsspec's, of a scheme that nothing knows
        raise KinefabError([diagnostic("BATCH_LIBRARY_MISSING", place=folder, detail=error)]) from error
    except OSError as error:
        detail = error.strerror or str(error)
        raise KinefabError([diagnostic("TARGET_UNWRITABLE", path=folder, detail=detail)]) from error


def _record(future: Future[Record], job: Job) -> Record:
    try:
        return future.result()
    except Exception as error:  # the worker is lost and nobody took its place
        lost = diagnostic("BATCH_WORKER_LOST", detail=f"{type(error).__name__}: {error}")
        return unmade(job.source, job.target, Outcome.CRASHED, lost)
