"""The interfaces that captures are written against are exactly the documented members of ``cad/members.csv``."""

from __future__ import annotations

import inspect
import re
from importlib import import_module

import pytest
from cad.documented import members

PROGRAMS = ("inventor", "solidworks", "fusion")
MEMBER = re.compile(r"    (?:def )?(\w+)(\(|:).*?  # (.*?) \| (.*?) \| (.+)")


def declared(program: str) -> dict[tuple[str, str], dict[str, str]]:
    """The members of a program's interface file, with what stands behind each."""
    found, kind = {}, ""
    for line in inspect.getsource(import_module(f"kinefab.capture.{program}.api")).splitlines():
        if opened := re.match(r"class (\w+)\(Protocol\)", line):
            kind = opened[1]
        elif match := MEMBER.fullmatch(line):
            name, bracket, unit, frame, page = match.groups()
            word = "method" if bracket == "(" else "property"
            found[kind, name] = {"kind": word, "unit": unit, "frame": frame, "page": page}
        elif kind and re.match(r"    (?:def )?\w+[(:]", line):
            raise AssertionError(f"without its unit, frame and page: {line}")
    return found


@pytest.mark.parametrize("program", PROGRAMS)
def test_the_interface_is_the_documented_list(program):
    stated = {
        key: {word: row[word] for word in ("kind", "unit", "frame", "page")}
        for key, row in members(program).items()
    }
    assert declared(program) == stated


@pytest.mark.parametrize("program", PROGRAMS)
def test_a_name_is_a_method_in_all_classes_or_in_none(program):
    """The way to the program tells calls from reads by the name alone."""
    kinds: dict[str, set[str]] = {}
    for (_, name), row in members(program).items():
        kinds.setdefault(name, set()).add(row["kind"])
    assert [name for name, found in kinds.items() if len(found) > 1] == []
