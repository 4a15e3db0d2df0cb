"""A capture from end to end: the program's answers, the self check, the bundle, the record."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

from ..diagnostics import KinefabError, Report
from ..replacing import write_whole
from .channel import MemberFailed, RecordBroken, Replay, opened, record
from .checking import check
from .comparing import compare
from .draft import WRONG_ANSWER, Draft
from .writing import mesh_files, write_files


@dataclass(frozen=True, slots=True)
class Program:
    """A program that can be captured.  module: below this package; it has ``capture(root, draft)`` and ``METHODS``.
    length: unit of its API.  up: axis that is up in its documents unless they are told otherwise.
    identifier: ProgID, of a program that is attached to over COM; moniker: what its name in the table of running objects begins
    with, where it may be in it under that alone.
    """

    name: str
    module: str
    length: str
    up: str
    identifier: str = ""
    moniker: str = ""


PROGRAMS = {
    "inventor": Program("Inventor", "inventor.capture", "cm", "Y", "Inventor.Application"),
    "solidworks": Program(
        "SolidWorks", "solidworks.capture", "m", "Y", "SldWorks.Application", "SolidWorks_PID_"
    ),
    "fusion": Program("Fusion", "fusion.capture", "cm", "Z"),
    "onshape": Program("Onshape", "onshape.capture", "m", "Z"),
}


@dataclass(frozen=True, slots=True)
class Captured:
    """path: the bundle.  files: everything that was written.  calls: questions that the program answered."""

    path: Path
    files: tuple[Path, ...]
    draft: Draft
    calls: int


def capture(
    program: str,
    target: Path,
    report: Report,
    record_to: Path | None = None,
    blank: bool = False,
    up: str = "",
) -> Captured:
    """Capture the open assembly of a running program.  Raises KinefabError with what is in the way, OSError."""
    from .com import attached

    entry = PROGRAMS[program]
    module = import_module(f".{entry.module}", __package__)
    live = attached(
        entry.name, entry.identifier, module.METHODS, report, entry.moniker,
        getattr(module, "HANDED", None), getattr(module, "NUMBERS", None),
    )  # fmt: skip
    return captured(program, live, target, report, record_to, blank, up)


def capture_onshape(
    source: str, environment: Mapping[str, str], target: Path, report: Report,
    record_to: Path | None = None, blank: bool = False, up: str = "",
) -> Captured:  # fmt: skip
    """Capture an assembly of Onshape.  source: its address, or a folder of saved answers.  Raises KinefabError, OSError."""
    from .onshape.answers import opened as answers_of

    return captured("onshape", answers_of(source, environment, report), target, report, record_to, blank, up)


def replay(source: Path, target: Path, report: Report, up: str = "") -> Captured:
    """Capture from a record, without the program.  Raises KinefabError, OSError."""
    if source.exists() and not source.is_file():  # a pipe may never end
        raise KinefabError([report.add("CAPTURE_RECORD", source.name, detail="it is no regular file")])
    try:
        program, answers = opened(json.loads(source.read_text(encoding="utf-8")))
        if program not in PROGRAMS:
            raise RecordBroken(f"no program {program!r} is known")
        module = import_module(f".{PROGRAMS[program].module}", __package__)
        channel = module.replayed(answers) if hasattr(module, "replayed") else Replay(answers, module.METHODS)
    except FileNotFoundError:
        raise KinefabError([report.add("SOURCE_NOT_FOUND", source.name, path=source)]) from None
    except (OSError, UnicodeDecodeError, json.JSONDecodeError, RecursionError, RecordBroken) as error:
        raise KinefabError([report.add("CAPTURE_RECORD", source.name, detail=str(error))]) from None
    try:
        return captured(program, channel, target, report, None, False, up)
    except (RecordBroken, RecursionError) as error:
        raise KinefabError([report.add("CAPTURE_RECORD", source.name, detail=str(error))]) from None


def captured(
    program: str, channel: Any, target: Path, report: Report, record_to: Path | None, blank: bool, up: str
) -> Captured:
    """Fill, check and write.  channel: ``Live`` or ``Replay``, or what a program has of its own."""
    draft = drafted(program, channel, report, up, record_to, blank)
    values, files = mesh_files(draft, f"{stem(target)}.parts")
    write_files(values, files, target, write_whole)
    return Captured(target, (target, *(target.parent / name for name in files)), draft, channel.calls)


def drafted(
    program: str,
    channel: Any,
    report: Report,
    up: str = "",
    record_to: Path | None = None,
    blank: bool = False,
) -> Draft:
    """What a program says of its assembly, checked at the captured pose.  Raises KinefabError."""
    entry = PROGRAMS[program]
    module = import_module(f".{entry.module}", __package__)
    draft = Draft(entry.name, entry.length, up or entry.up, report)
    try:
        module.capture(channel.root, draft)
    except MemberFailed as error:
        detail = error.detail
        report.add("CAPTURE_STOPPED", program=entry.name, member=error.member, detail=detail)
    except WRONG_ANSWER as error:
        detail = f"{type(error).__name__}: {error}"
        report.add("CAPTURE_STOPPED", program=entry.name, member="an answer", detail=detail)
    if record_to is not None:  # of a capture that failed too: it is what shows why
        answers = module.unnamed(channel.answers) if blank and hasattr(module, "unnamed") else channel.answers
        text = json.dumps(record(program, answers, blank), ensure_ascii=True, separators=(",", ":"))
        write_whole(record_to, text.encode("ascii") + b"\n")
    report.raise_for_errors()
    draft.settle()
    check(draft)
    compare(draft)
    return draft


def stem(target: Path) -> str:
    """The bundle's name without its endings."""
    return target.name.removesuffix(".json").removesuffix(".bundle")
