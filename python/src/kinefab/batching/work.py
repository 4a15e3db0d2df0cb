"""One job, in the process that is there for it alone."""

from __future__ import annotations

import time
from collections import Counter
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from .. import __version__
from ..diagnostics import Diagnostic, KinefabError, Report, Severity, diagnostic
from ..pipeline import ExportResult, export
from ..targets import target_of, write
from ..views.overview import picture
from . import places
from .job import Job, Outcome, Record, options_of_json, unmade
from .ledger import Reading, begin, claimed, done, forget, is_ours, note, record_place

MOST_MESSAGES = 5
"""Errors of one file that a record tells in full."""


TRIES = 2
"""Of a source that changes while it is read."""


def work(job: Job, reading: Reading) -> Record:
    """Do a job, unless it is up to date; what is wrong with the data is in the record."""
    start = time.monotonic()
    try:
        record = _done(job, reading, start)
    except KinefabError as error:
        record = _refused(job, error.report or Report(list(error.diagnostics)), start)
    except ImportError as error:
        record = _failed(job, diagnostic("BATCH_LIBRARY_MISSING", place=job.source, detail=error), start)
    except OSError as error:
        record = _failed(job, diagnostic("BATCH_IO", detail=error), start)
    return record


def _done(job: Job, reading: Reading, start: float) -> Record:
    with claimed(job):
        if not job.force and (known := done(job, __version__)) is not None:
            return replace(known, outcome=Outcome.UP_TO_DATE, seconds=time.monotonic() - start)
        if not job.force and places.exists(job.target) and not is_ours(job):
            return _failed(job, diagnostic("BATCH_TARGET_FOREIGN", path=job.target), start)
        try:
            for _ in range(TRIES):
                if (record := _converted(job, reading, start)) is not None:
                    return record
        except (KinefabError, OSError, ImportError):
            if not places.exists(job.target):
                forget(job)
            raise
    changed = next(iter(reading.changed()), job.source)
    return _failed(job, diagnostic("BATCH_SOURCE_CHANGED", path=changed), start)


def _failed(job: Job, found: Diagnostic, start: float) -> Record:
    return unmade(job.source, job.target, Outcome.FAILED, found, time.monotonic() - start)


def _converted(job: Job, reading: Reading, start: float) -> Record | None:
    """None where a file changed while it was read; what was written then is of no version of it, and known as that."""
    reading.clear()
    with places.local(job.source) as source, TemporaryDirectory() as folder:
        remote = places.is_url(job.target)
        target = Path(folder) / places.name_of(job.target) if remote else Path(job.target)
        target.parent.mkdir(parents=True, exist_ok=True)
        begin(job)
        reading.add(source)
        with reading.listening():
            result = export(source, target, options_of_json(job.options))
        reading.leave_out(result.files, target)
        for file in result.analysed.scene.source.files:
            reading.add(source.parent / file.uri)
        files = [str(path) for path in result.files]
        if remote:
            files = [places.join(job.target.rpartition("/")[0], path.name) for path in result.files]
            for path, place in sorted(zip(result.files, files), key=lambda pair: pair[1] == job.target):
                places.write_bytes(place, path.read_bytes())  # the file that is named last
        thumbnail = _thumbnail(job, result, Path(folder))
        if reading.changed():
            return None
        read = reading.digests()
        if places.is_url(job.source):  # what was fetched is known by where it came from
            home, root = job.source.rpartition("/")[0], source.parent.resolve()
            read = {
                places.join(home, Path(path).relative_to(root).as_posix()): digest
                for path, digest in read.items()
                if Path(path).is_relative_to(root)
            }
    record = Record(
        job.source,
        job.target,
        Outcome.WRITTEN,
        _codes(result.report),
        (),
        time.monotonic() - start,
        0,
        result.analysed.analysis.mobility,
        thumbnail,
    )
    note(job, __version__, record, read, files)
    return record


def _refused(job: Job, report: Report, start: float) -> Record:
    errors = [str(d) for d in report.diagnostics if d.severity is Severity.ERROR]
    return Record(
        job.source,
        job.target,
        Outcome.REFUSED,
        _codes(report),
        tuple(errors[:MOST_MESSAGES]),
        time.monotonic() - start,
    )


def _thumbnail(job: Job, result: ExportResult, folder: Path) -> str:
    """A picture of the scene beside the records; "" where it cannot be drawn."""
    drawn = result.path
    if not result.path.name.lower().endswith(".kinefab"):
        drawn = folder / "thumbnail.kinefab"
        kind = target_of(drawn)
        assert kind is not None
        write(kind, result.content, drawn)
    try:
        svg = picture(drawn)
    except KinefabError:
        return ""
    place = places.join(
        job.ledger, "thumbnails", places.name_of(record_place(job)).removesuffix(".json") + ".svg"
    )
    places.write_bytes(place, svg.encode(), lasting=False)
    return place


def _codes(report: Report) -> dict[str, int]:
    return dict(sorted(Counter(d.code for d in report.diagnostics).items()))
