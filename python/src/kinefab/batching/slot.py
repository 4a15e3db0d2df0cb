"""The asking side of a converting process; a worker has one for each of its threads."""

from __future__ import annotations

import json
import os
import subprocess
import threading
from collections.abc import Generator
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager, suppress

from ..diagnostics import diagnostic
from ..sources.guard import command
from .job import Job, Outcome, Record, unmade

GRACE_SECONDS = 10.0
"""After a job's timeout the process itself is given up."""
TRIES = 2
STOP_SECONDS = 1.0
"""Within which a process that nobody asks any more ends its job and itself."""


class Slot:
    """A process that converts one file at a time, started when it is first asked and again when it was lost."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None
        self._stopped = False

    def convert(self, job: Job) -> Record:
        """Do a job, once more where the process was lost; a record of the crash where it was lost again."""
        for _ in range(TRIES):
            if self._stopped:
                break
            answer = self._asked(job)
            if answer is not None:
                return Record.of_json(json.loads(answer))
        found = diagnostic("BATCH_CRASHED", detail="it said nothing, twice")
        return unmade(job.source, job.target, Outcome.CRASHED, found)

    def _asked(self, job: Job) -> bytes | None:
        """The line that answers, None where the process is gone."""
        process = self._running()
        assert process.stdin is not None and process.stdout is not None
        timer = threading.Timer((job.timeout or 0.0) + GRACE_SECONDS, process.kill)
        if job.timeout is not None:
            timer.start()
        try:
            process.stdin.write(json.dumps(job.as_json()).encode() + b"\n")
            process.stdin.flush()
            line = process.stdout.readline()
        except (OSError, ValueError):  # gone, or stopped meanwhile
            line = b""
        finally:
            timer.cancel()
        if not line:
            self.close()
        return line or None

    def _running(self) -> subprocess.Popen[bytes]:
        if self._process is None or self._process.poll() is not None:
            one = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")}
            self._process = subprocess.Popen(
                command(f"{__package__}.child", "serve"),
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                env={**one, **os.environ},  # the files are what runs side by side
                start_new_session=True,  # Ctrl+C is for whoever asks: it stops them
            )
        return self._process

    def stop(self) -> None:
        """From another thread: what is under way is given up, and nothing is begun any more."""
        self._stopped = True
        if (process := self._process) is not None and process.stdin is not None:
            with suppress(OSError, ValueError):
                process.stdin.close()  # which tells it that nobody asks any more: it ends the job, then itself
            with suppress(subprocess.TimeoutExpired):
                process.wait(STOP_SECONDS)
                return
            process.kill()  # it was still importing

    def close(self) -> None:
        if self._process is not None:
            self._process.kill()
            self._process.wait()
            for stream in (self._process.stdin, self._process.stdout):
                if stream is not None:
                    stream.close()
            self._process = None

    def __del__(self) -> None:
        self.close()  # with the thread that had it


_local = threading.local()


def convert(job: Job) -> Record:
    """Do a job in this thread's own process.  What an executor is given: it and its argument can be pickled."""
    if not hasattr(_local, "slot"):
        _local.slot = Slot()
    slot: Slot = _local.slot
    return slot.convert(job)


@contextmanager
def crew(jobs: int) -> Generator[Executor, None, None]:
    """So many threads, each with a slot.  Where the work is broken off by an exception, what is under way is given up."""
    slots: list[Slot] = []

    def begin() -> None:
        _local.slot = Slot()
        slots.append(_local.slot)

    pool = ThreadPoolExecutor(jobs, initializer=begin)
    try:
        yield pool
    except BaseException:
        pool.shutdown(wait=False, cancel_futures=True)
        for slot in slots:
            slot.stop()
        raise
    finally:
        pool.shutdown()
        for slot in slots:
            slot.close()
