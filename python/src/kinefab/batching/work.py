"""One job, in the process that is there for it alone."""

from __future__ import annotations

import time
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory

from .. import __version__
from ..diagnostics import KinefabError, Report, Severity
from ..pipeline import ExportResult, export
from ..targets import target_of, write
from ..views.overview import picture
from . import places
from .job import Job, Outcome, Record, options_of_json
from .ledger import Reading, claimed, done, is_ours, note

MOST_MESSAGES = 5
"""Errors of one file that a record tells in full."""


def work(job: Job, reading: Reading) -> Record:
    """Do a job, unless it is up to date; what is wrong with the data is in the record."""
    start = time.monotonic()
    with claimed(job):
        if not job.force and (known := done(job, __version__)) is not None:
            return _changed(known, Outcome.UP_TO_DATE, start)
        if not job.force and places.exists(job.target) and not is_ours(job):
            message = f"{job.target} is there and no batch wrote it; it is left alone. Choose another folder, or pass --force."
            return Record(job.source, job.target, Outcome.FAILED, {"BATCH_TARGET_FOREIGN": 1}, (message,))
        return _converted(job, reading, start)


def _converted(job: Job, reading: Reading, start: float) -> Record:
    try:
        with places.local(job.source) as source, TemporaryDirectory() as folder:
            remote = places.is_url(job.target)
            target = Path(folder) / places.name_of(job.target) if remote else Path(job.target)
            target.parent.mkdir(parents=True, exist_ok=True)
            reading.add(source)
            with reading.listening():
                result = export(source, target, options_of_json(job.options))
            for file in result.analysed.scene.source.files:
                reading.add(source.parent / file.uri)
            files = [str(path) for path in result.files]
            if remote:
                files = [places.join(job.target.rpartition("/")[0], path.name) for path in result.files]
                for path, place in sorted(zip(result.files, files), key=lambda pair: pair[1] == job.target):
                    places.write_bytes(place, path.read_bytes())  # the file that is named last
            thumbnail = _thumbnail(job, result, Path(folder))
            if changed := reading.changed():
                message = f"{changed[0]} changed while it was read; run the batch again."
                return Record(job.source, job.target, Outcome.FAILED, {"BATCH_SOURCE_CHANGED": 1}, (message,))
            read = reading.digests()
            if places.is_url(job.source):  # what was fetched is known by where it came from
                read = {job.source: read[str(source.resolve())]} if str(source.resolve()) in read else {}
    except KinefabError as error:
        return _refused(job, error.report or Report(list(error.diagnostics)), start)
    except (OSError, ImportError) as error:
        return Record(
            job.source, job.target, Outcome.FAILED, {"BATCH_IO": 1}, (str(error),), time.monotonic() - start
        )
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
    if not result.path.name.endswith(".kinefab"):
        drawn = folder / "thumbnail.kinefab"
        kind = target_of(drawn)
        assert kind is not None
        write(kind, result.content, drawn)
    try:
        svg = picture(drawn)
    except KinefabError:
        return ""
    place = places.join(job.ledger, "thumbnails", places.name_of(_key(job)) + ".svg")
    places.write_bytes(place, svg.encode())
    return place


def _key(job: Job) -> str:
    from .ledger import record_place

    return record_place(job).removesuffix(".json")


def _codes(report: Report) -> dict[str, int]:
    return dict(sorted(Counter(d.code for d in report.diagnostics).items()))


def _changed(record: Record, outcome: Outcome, start: float) -> Record:
    values = record.as_json() | {"outcome": outcome.value, "seconds": time.monotonic() - start}
    return Record.of_json(values)
