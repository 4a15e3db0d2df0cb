"""The process that converts: it imports everything once and then, on each line of its input, a job as JSON, forks one
process for that job alone, watches it and answers with a line.

A job that crashes, hangs or eats memory costs only itself.  When the input ends, because whoever asked is gone, the job
under way is ended too.  Where the system cannot fork (Windows) the job is done here, and the asker starts a new process
when this one does not answer.
"""

from __future__ import annotations

import json
import os
import select
import signal
import sys
import time
from collections.abc import Iterator
from contextlib import suppress
from importlib import import_module

from ..diagnostics import Diagnostic, diagnostic
from .job import Job, Outcome, Record, unmade
from .ledger import Reading
from .work import work

Why = tuple[Outcome, Diagnostic]
THREADLESS = sys.stdlib_module_names | {"kinefab", "numpy", "scipy", "trimesh"}
LOOK_SECONDS = 0.02
"""Between two looks at a job's memory."""


def serve() -> None:
    """Answer jobs until the input ends."""
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # what a library prints does not stand among the answers
    reading = Reading()
    for line in _lines():
        job = Job(**json.loads(line))
        record = _watched(job, reading) if hasattr(os, "fork") else _done(job, reading)
        try:
            answers.write(json.dumps(record.as_json()) + "\n")
            answers.flush()
        except BrokenPipeError:  # nobody asks any more
            os._exit(1)


def _lines() -> Iterator[bytes]:
    """Lines of the input, read without a buffer, so that ``select`` tells what is there."""
    rest = b""
    while chunk := os.read(0, 65536):
        *lines, rest = (rest + chunk).split(b"\n")
        yield from lines


def _done(job: Job, reading: Reading) -> Record:
    try:
        return work(job, reading)
    except MemoryError:
        return _lost(job, _no_memory("there was no more memory"))
    except Exception as error:  # a defect of ours or of a library: told, and the rest goes on
        return _lost(job, _crashed(f"{type(error).__name__}: {error}"))


def _watched(job: Job, reading: Reading) -> Record:
    """A job in a process of its own."""
    start = time.monotonic()
    inlet, outlet = os.pipe()
    pid = os.fork()
    if pid == 0:
        try:
            _lead(0)
            os.close(inlet)
            before = set(sys.modules)
            record = _done(job, reading).as_json()
            content = json.dumps([record, [name for name in sys.modules if name not in before]]).encode()
            while content:
                content = content[os.write(outlet, content) :]
        finally:
            os._exit(0)
    _lead(pid)  # on both sides, as either may be the first
    os.close(outlet)
    answer, why = _answer(pid, inlet, job, start)
    os.close(inlet)
    _, status, usage = os.wait4(pid, 0)
    memory = usage.ru_maxrss * (1 if sys.platform == "darwin" else 1024)
    seconds = time.monotonic() - start
    if answer:
        values, imported = json.loads(answer)
        _import_early(imported)
        return Record.of_json(values | {"memory": memory, "seconds": seconds})
    if why is None:
        number = os.WTERMSIG(status) if os.WIFSIGNALED(status) else os.WEXITSTATUS(status)
        kind = f"signal {signal.Signals(number).name}" if os.WIFSIGNALED(status) else f"status {number}"
        why = _crashed(kind)
    return _lost(job, why, seconds, memory)


def _import_early(names: list[str]) -> None:
    """Import what a job had to import, so that the next one finds it there: it took more time than the rest of a small one.

    Only where all of it is known to start no threads, which a fork would not take along.
    """
    if all(name.partition(".")[0] in THREADLESS for name in names):
        for name in names:
            with suppress(Exception):
                import_module(name)


def _answer(pid: int, inlet: int, job: Job, start: float) -> tuple[bytes, Why | None]:
    """What the process wrote, or why it was ended."""
    content, asked = b"", True
    while True:
        ready, _, _ = select.select([inlet, *([0] if asked else [])], [], [], LOOK_SECONDS)
        if inlet in ready:
            chunk = os.read(inlet, 65536)
            if not chunk:
                return content, None
            content += chunk
        if 0 in ready and not os.read(0, 1):  # nobody asks any more
            os.killpg(pid, signal.SIGKILL)
            os._exit(1)
        why = None
        if job.timeout is not None and time.monotonic() - start > job.timeout:
            why = (Outcome.TIMEOUT, diagnostic("BATCH_TIMEOUT", seconds=f"{job.timeout:g}"))
        elif job.memory is not None and _held(pid) > job.memory:
            why = _no_memory(f"it held more than {job.memory / 2**20:.0f} MiB")
        if why is not None:
            os.killpg(pid, signal.SIGKILL)
            return b"", why


def _lead(pid: int) -> None:
    """Put a job at the head of a group of its own, so that what it starts to read a file ends with it.  0: this process."""
    with suppress(OSError):  # of a job that has ended already
        os.setpgid(pid, pid)


def _held(pid: int) -> int:
    """Bytes of memory that a process holds, with those that it started; 0 where the system does not tell."""
    held = 0
    with suppress(OSError, IndexError, ValueError):
        with open(f"/proc/{pid}/statm", "rb") as file:
            held = int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
        with open(f"/proc/{pid}/task/{pid}/children", "rb") as file:
            held += sum(_held(int(child)) for child in file.read().split())
    return held


def _no_memory(detail: str) -> Why:
    return Outcome.MEMORY, diagnostic("BATCH_MEMORY", detail=detail)


def _crashed(detail: str) -> Why:
    return Outcome.CRASHED, diagnostic("BATCH_CRASHED", detail=detail)


def _lost(job: Job, why: Why, seconds: float = 0.0, memory: int = 0) -> Record:
    return unmade(job.source, job.target, *why, seconds, memory)
