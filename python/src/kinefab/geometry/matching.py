"""Which pieces of a mesh file each named body means: by exact name, by a freer reading of it, or by order."""

from __future__ import annotations

import re
import unicodedata
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from difflib import get_close_matches

from ..diagnostics import Report, named
from ..model import MeshKey, MeshReference
from .pieces import MeshFile

_SEPARATORS = re.compile(r"[\s:/\\|]+")
_EXTENSION = re.compile(r"\.(ipt|iam|sldprt|sldasm|par|asm|prt|f3d|stp|step)(?=_|$)")

_Pieces = tuple[int, ...] | None


@dataclass(frozen=True, slots=True)
class Wanted:
    """A body that refers to a mesh file.  label: what to call it in the report."""

    label: str
    reference: MeshReference

    @property
    def name(self) -> str:
        """The body's name in the file; "" where the whole file is meant."""
        return self.reference.key or ""


def match_bodies(file: MeshFile, wanted: Sequence[Wanted], report: Report) -> list[tuple[int, ...] | None]:
    """For each wanted body the numbers of its pieces, or None with an error in the report.

    A name may be wanted several times: by copies of one part whose mesh stands in the file once, or by as
    many bodies as the file has of that name, which are then taken in order.
    """
    found: list[tuple[int, ...] | None] = [None] * len(wanted)
    open_ones: list[int] = []
    for i, body in enumerate(wanted):
        if body.reference.key is None:
            found[i] = tuple(range(len(file.pieces)))
        else:
            open_ones.append(i)
    open_ones = _by_name(file, wanted, open_ones, found, report)
    open_ones = _by_order(file, wanted, open_ones, found, report)
    names = sorted({name for kind in file.named.values() for name in kind})
    for i in open_ones:
        body = wanted[i]
        close = get_close_matches(body.name, names, n=3)
        near = f" Near: {', '.join(close)}." if close else ""
        report.add("BODY_NOT_IN_FILE", body.reference.where, body=body.label, path=file.path.name, near=near)
    _report_unused(file, found, report)
    return found


def _by_name(
    file: MeshFile, wanted: Sequence[Wanted], open_ones: list[int], found: list[_Pieces], report: Report
) -> list[int]:
    """Exact names first, then the file's other kind of name, then names alike but for spelling."""
    times = Counter((wanted[i].name, wanted[i].reference.keyed_by) for i in open_ones)
    served: Counter[tuple[str, MeshKey]] = Counter()
    loose = {kind: _spelled_alike(names) for kind, names in file.named.items()}
    left: list[int] = []
    for i in open_ones:
        body, reference = wanted[i], wanted[i].reference
        other = MeshKey.GROUP if reference.keyed_by is MeshKey.OBJECT else MeshKey.OBJECT
        name = how = None
        for kind, reading in ((reference.keyed_by, ""), (other, f"as the name of a {other.value}")):
            if body.name in file.named[kind]:
                name, how = body.name, reading
            elif (alike := loose[kind].get(_spelling(body.name))) is not None and name is None:
                name, how = alike, "the names differ in spelling"
            if name is not None:
                break
        if name is None:
            left.append(i)
            continue
        occurrences = file.named[kind][name]
        again = (body.name, reference.keyed_by)
        place = {"body": body.label, "path": file.path.name}
        if len(occurrences) == 1:
            found[i] = occurrences[0]
        elif times[again] == len(occurrences):
            found[i] = occurrences[served[again]]
            how = f"the {served[again] + 1}. of {len(occurrences)} of that name"
        elif times[again] == 1:
            found[i] = tuple(number for occurrence in occurrences for number in occurrence)
            how = f"{len(occurrences)} of that name, taken together"
        else:
            report.add(
                "BODY_NAME_AMBIGUOUS", reference.where, **place, wanted=times[again], found=len(occurrences)
            )
            found[i] = ()
        served[again] += 1
        if how and found[i]:
            report.add("BODY_MATCHED_LOOSELY", reference.where, **place, found=name, how=how)
    return left


def _by_order(
    file: MeshFile, wanted: Sequence[Wanted], open_ones: list[int], found: list[_Pieces], report: Report
) -> list[int]:
    """Bodies left over pair with pieces left over where there are as many of either."""
    taken = {number for numbers in found if numbers for number in numbers}
    for kind in MeshKey:
        free = [
            (name, occurrence)
            for name, occurrences in file.named[kind].items()
            for occurrence in occurrences
            if not taken.intersection(occurrence)
        ]
        if (
            not open_ones
            or len(free) != len(open_ones)
            or len({wanted[i].reference.key for i in open_ones}) != len(open_ones)
        ):
            continue
        for i, (name, occurrence) in zip(open_ones, sorted(free, key=lambda item: item[1])):
            found[i] = occurrence
            place = {"body": wanted[i].label, "path": file.path.name}
            report.add(
                "BODY_MATCHED_LOOSELY",
                wanted[i].reference.where,
                **place,
                found=name,
                how="the only guess left was the order in the file",
            )
        return []
    return open_ones


def _spelling(name: str) -> str:
    """A name without what exporters change: case, Unicode form, separators and file extensions."""
    plain = _SEPARATORS.sub("_", unicodedata.normalize("NFC", name).casefold().strip())
    return _EXTENSION.sub("", plain)


def _spelled_alike(names: Iterable[str]) -> dict[str, str]:
    """Spelling to name, for spellings that only one name has."""
    alike: dict[str, list[str]] = {}
    for name in names:
        alike.setdefault(_spelling(name), []).append(name)
    return {spelling: same[0] for spelling, same in alike.items() if len(same) == 1}


def _report_unused(file: MeshFile, found: Sequence[tuple[int, ...] | None], report: Report) -> None:
    if any(numbers is None for numbers in found):
        return  # the bodies that were not found say more
    taken = {number for numbers in found for number in numbers or ()}
    unused = [n for n in range(len(file.pieces)) if n not in taken]
    if not unused:
        return
    name_of = {
        number: name for kind in MeshKey for name, os in file.named[kind].items() for o in os for number in o
    }
    names = named(name_of.get(n, "(no name)") for n in unused)
    report.add("BODY_UNUSED", file.path.name, count=len(unused), path=file.path.name, names=names)
