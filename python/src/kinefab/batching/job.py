"""What is asked for one file, and what became of it; both as plain JSON, since they travel between processes."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from enum import Enum
from typing import Any, cast

from ..diagnostics import Diagnostic
from ..options import ExportOptions


class Outcome(str, Enum):
    """From the best to the worst."""

    UP_TO_DATE = "up_to_date"
    WRITTEN = "written"
    REFUSED = "refused"  # its data is wrong, or lossy where that is not allowed
    FAILED = "failed"  # it could not be read or written here and now
    TIMEOUT = "timeout"
    MEMORY = "memory"
    CRASHED = "crashed"

    @property
    def good(self) -> bool:
        return self in (Outcome.UP_TO_DATE, Outcome.WRITTEN)


@dataclass(frozen=True, slots=True)
class Job:
    """One source and its target, paths or URLs.

    options: as ``options_as_json`` has them.  timeout: seconds, memory: bytes, None for no bound.
    ledger: folder or URL of the records of what is done.  force: also when it is up to date or the target somebody else's.
    """

    source: str
    target: str
    ledger: str
    options: dict[str, Any] = field(default_factory=dict[str, Any])
    timeout: float | None = None
    memory: int | None = None
    force: bool = False

    def as_json(self) -> dict[str, Any]:
        return asdict(self)


@dataclass(frozen=True, slots=True)
class Record:
    """What became of one job.

    codes: how often each diagnostic was found.  messages: of the errors, at most a few.  seconds: on the clock;
    memory: the most that the process held, bytes.  thumbnail: target of a picture, "" for none.

    >>> import kinefab
    >>> record = kinefab.batch("gone.urdf", "out").records[0]
    >>> record.outcome.value, record.outcome.good, record.codes
    ('refused', False, {'SOURCE_NOT_FOUND': 1})
    """

    source: str
    target: str
    outcome: Outcome
    codes: dict[str, int] = field(default_factory=dict[str, int])
    messages: tuple[str, ...] = ()
    seconds: float = 0.0
    memory: int = 0
    mobility: int | None = None
    thumbnail: str = ""

    def as_json(self) -> dict[str, Any]:
        """As ``batch.jsonl`` has it.

        >>> kinefab.batch("gone.urdf", "out").records[0].as_json()["outcome"]
        'refused'
        """
        return asdict(self) | {"outcome": self.outcome.value, "messages": list(self.messages)}

    @staticmethod
    def of_json(values: dict[str, Any]) -> Record:
        """What ``as_json`` undoes.

        >>> record = kinefab.batch("gone.urdf", "out").records[0]
        >>> kinefab.Record.of_json(record.as_json()) == record
        True
        """
        read: dict[str, Any] = {"outcome": Outcome(values["outcome"]), "messages": tuple(values["messages"])}
        return Record(**(values | read))


def unmade(
    source: str, target: str, outcome: Outcome, found: Diagnostic, seconds: float = 0.0, memory: int = 0
) -> Record:
    """The record of a file that nothing was made of, and why."""
    return Record(source, target, outcome, {found.code: 1}, (str(found),), seconds, memory)


def options_as_json(options: ExportOptions) -> dict[str, Any]:
    """The options as JSON values, in a fixed order; ``options_of_json`` reads them back."""
    values = asdict(options)
    plain = {key: getattr(value, "value", value) for key, value in values.items()}
    for key in ("reading", "writing"):
        plain[key] = {name: _plain(value) for name, value in sorted(plain[key].items())}
    return plain


def options_of_json(values: dict[str, Any]) -> ExportOptions:
    return ExportOptions(**values)


def _plain(value: Any) -> Any:
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in cast("Sequence[Any]", value)]
    if isinstance(value, os.PathLike):  # the worker stands in another folder
        return os.path.abspath(os.fsdecode(cast("os.PathLike[str]", value)))
    return value if isinstance(value, (str, int, float, bool, type(None))) else str(value)
