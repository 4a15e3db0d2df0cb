"""What is done: for each target a record of everything that was read for it, so that the next run can skip it."""

from __future__ import annotations

import hashlib
import json
import os
import site
import sys
import sysconfig
from collections.abc import Generator, Iterable
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, cast

from ..diagnostics import schema_directory
from . import places
from .job import Job, Record

LEDGER = ".kinefab-batch"
"""Folder of the records, in the target folder."""


AWAITED = frozenset(
    "FREECAD_LINK_BROKEN INCLUDE_NOT_FOUND MESH_NOT_FOUND MESH_OUTSIDE MESH_UNREADABLE PACKAGE_PATH_NOT_FOUND"
    " STEP_FILE_MISSING TEXTURE_NOT_FOUND TEXTURE_UNREADABLE USD_COMPOSITION USD_TEXTURE_MISSING".split()
)
"""Findings of files that were not where a source looks for them, and that were looked for without being opened.  Nothing
of those was heard, so nothing tells that they have come since: the source is read again."""

ABSENT = ""
"""Digest of a file that is not there."""


def record_place(job: Job) -> str:
    """Of a job's record: by the target's name within the target folder, which does not change when the folder moves."""
    folder = places.join(job.ledger, "")[: -len(places.join(LEDGER, ""))]
    inner = job.target[len(folder) :] if job.target.startswith(folder) else job.target
    return places.join(
        job.ledger, "records", hashlib.sha256(inner.encode("utf-8", "replace")).hexdigest()[:32] + ".json"
    )


def done(job: Job, version: str) -> Record | None:
    """The record of a job that is up to date: same source, target, options and version, everything that was read
    unchanged, nothing that it had to do without, every file that was written still there."""
    known = _known(job)
    if known is None or known.get("version") != version or known["options"] != job.options:
        return None
    record = Record.of_json(known["record"])
    if (record.source, record.target) != (job.source, job.target) or AWAITED.intersection(record.codes):
        return None
    if any(_size(file) != size for file, size in known["files"].items()):
        return None
    if any(_digest(path) != digest for path, digest in known["read"].items()):
        return None
    return record


def is_ours(job: Job) -> bool:
    """Whether an earlier run wrote the target, or had begun to."""
    return places.exists(record_place(job))


def begin(job: Job) -> None:
    """Remember that the target is ours from here on, and that nothing is known of what is in it."""
    places.write_bytes(record_place(job), b"{}\n", lasting=False)


def forget(job: Job) -> None:
    """Of a target that was begun and is not there."""
    places.remove(record_place(job))


def note(job: Job, version: str, record: Record, read: dict[str, str], files: list[str]) -> None:
    """Remember what was done.  read: digest of each file that was read, by path, ABSENT of one that was missed."""
    content = {
        "version": version,
        "options": job.options,
        "record": record.as_json(),
        "read": dict(sorted(read.items())),
        "files": {file: _size(file) for file in files},
    }
    places.write_bytes(record_place(job), (json.dumps(content, indent=1) + "\n").encode(), lasting=False)


def _known(job: Job) -> dict[str, Any] | None:
    try:
        content = places.read_bytes(record_place(job))
        return None if content is None else json.loads(content)
    except (OSError, ValueError):
        return None  # half of one, from another program: the job is done again


def _size(place: str) -> int | None:
    """Bytes of a file that was written, None where it is gone; of a URL only whether it is there."""
    if places.is_url(place):
        return 0 if places.exists(place) else None
    try:
        return os.stat(place).st_size
    except OSError:
        return None


def _digest(path: str) -> str:
    try:
        content = places.read_bytes(path)
    except OSError:
        return ABSENT
    return ABSENT if content is None else hashlib.sha256(content).hexdigest()


CODE = (".py", ".pyc", ".so", ".pyd")
"""What an import reads, wherever it stands: the folder that a batch is started in is a place of modules too."""


def _programs() -> tuple[str, ...]:
    """Folders of Python, of what is installed in it, of Kinefab and of the running system: no sources stand there."""
    paths = sysconfig.get_paths()
    folders = {paths[name] for name in ("stdlib", "platstdlib", "purelib", "platlib")}
    folders |= {*site.getsitepackages(), site.getusersitepackages(), str(schema_directory())}
    folders |= {str(Path(__file__).parents[1]), "/proc", "/sys", "/dev"}
    return tuple(sorted(os.path.realpath(folder) + os.sep for folder in folders))


class Reading:
    """Files that this process opens for reading, by Python's own audit events; libraries' own are named beside it.

    Those that it wanted to open and that were not there count too: what was made without them is to be made anew when they come.
    """

    def __init__(self) -> None:
        self.paths: dict[str, tuple[int, int]] = {}
        self.absent: set[str] = set()
        self._on = False
        self._apart = _programs()
        sys.addaudithook(self._heard)

    @contextmanager
    def listening(self) -> Generator[None, None, None]:
        self._on = True
        try:
            yield
        finally:
            self._on = False

    def clear(self) -> None:
        """Forget; for the next job."""
        self.paths.clear()
        self.absent.clear()

    def add(self, path: str | Path) -> None:
        with suppress(OSError, ValueError):
            real = os.path.realpath(path)
            if real.startswith(self._apart) or real.endswith(CODE):
                return
            try:
                found = os.stat(real)
            except (FileNotFoundError, NotADirectoryError):
                self.absent.add(real)
                return
            if os.path.isfile(real):
                self.paths.setdefault(real, (found.st_mtime_ns, found.st_size))

    def leave_out(self, files: Iterable[Path], target: Path) -> None:
        """What the target's own writer reads of what it wrote: the files, a folder of the target's name beside them, and
        the hidden ones that it writes into first."""
        own = {os.path.realpath(path) for path in files}
        folder = os.path.realpath(target.parent)
        heads = (os.path.join(folder, target.stem, ""), os.path.join(folder, f".{target.stem}."))
        for path in [path for path in self.paths if path in own or path.startswith(heads)]:
            del self.paths[path]
        beside = (*heads, os.path.join(folder, target.name))  # with Unity's .meta, looked for before it is written
        self.absent = {path for path in self.absent if path not in own and not path.startswith(beside)}

    def changed(self) -> list[str]:
        """Those that are not as they were when they were first opened."""
        return [path for path, seen in self.paths.items() if _stamp(path) != seen]

    def digests(self) -> dict[str, str]:
        """Of one that came only while the source was read: that it was absent, so that the next run reads it."""
        return {path: _digest(path) for path in self.paths} | dict.fromkeys(self.absent, ABSENT)

    def _heard(self, event: str, args: tuple[Any, ...]) -> None:
        if self._on and event == "open" and isinstance(args[0], (str, bytes, os.PathLike)):
            mode, flags = args[1], args[2]
            access = getattr(os, "O_ACCMODE", 3)  # which Windows does not name
            if not (any(word in mode for word in "wax") if isinstance(mode, str) else flags & access):
                self._on = False  # what is asked here is not heard
                self.add(os.fsdecode(cast("str | bytes | os.PathLike[str]", args[0])))
                self._on = True


def _stamp(path: str) -> tuple[int, int] | None:
    try:
        found = os.stat(path)
    except OSError:
        return None
    return (found.st_mtime_ns, found.st_size)


@contextmanager
def claimed(job: Job) -> Generator[None, None, None]:
    """Nobody else works on the same target meanwhile: whoever comes second waits, and finds it done.

    Held by this process alone and gone with it.  On Windows and for URLs there is no such lock.
    """
    if places.is_url(job.ledger) or os.name == "nt":
        yield
        return
    import fcntl

    lock = Path(record_place(job) + ".lock")
    lock.parent.mkdir(parents=True, exist_ok=True)
    while True:
        with lock.open("w") as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            if not _is_at(file.fileno(), lock):
                continue  # whoever had it took it away while this one waited
            try:
                yield
            finally:
                lock.unlink(missing_ok=True)
            return


def _is_at(descriptor: int, path: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(descriptor), os.stat(path))
    except FileNotFoundError:
        return False
