"""Thousands of findings that are alike: the first ones, and how many more."""

from __future__ import annotations

import json

import pytest
from command_line import run
from kinefab.diagnostics import MOST_ALIKE, KinefabError, diagnostic, listed
from source_bundles import bundle, part, read

COUNT = 3000


def repeated() -> dict:
    """Every component has one id."""
    return bundle(*(part("same") for _ in range(COUNT + 1)))


def test_findings_of_one_code_are_listed_up_to_a_hundred():
    """Each code by itself, in order, the rest counted at its severity."""
    found = [diagnostic("SCENE_WITHOUT_PARTS", f"file:{i}") for i in range(MOST_ALIKE + 7)]
    other = diagnostic("TARGET_UNWRITABLE", path="x", detail="y")
    shown = listed([*found, other])
    assert shown[:MOST_ALIKE] == found[:MOST_ALIKE] and shown[MOST_ALIKE] == other
    (left,) = shown[MOST_ALIKE + 1 :]
    assert (left.code, left.where, left.severity) == ("FINDINGS_OMITTED", found[0].code, found[0].severity)
    assert left.message.startswith("7 more ")
    assert listed(found[:MOST_ALIKE]) == found[:MOST_ALIKE]


def test_an_error_lists_the_first_and_holds_all(tmp_path):
    """The text is short; a script finds every diagnostic."""
    with pytest.raises(KinefabError) as raised:
        read(repeated(), tmp_path)[1].raise_for_errors()
    assert len(raised.value.diagnostics) == COUNT
    assert str(raised.value).count("SOURCE_ID_DUPLICATE:") == MOST_ALIKE + 1
    assert f"{COUNT - MOST_ALIKE} more findings" in str(raised.value)


def test_the_command_line_prints_the_first_and_reports_all(tmp_path):
    source, report = tmp_path / "same.bundle.json", tmp_path / "report.json"
    source.write_text(json.dumps(repeated()), "utf-8")
    done = run("export", source, "-o", tmp_path / "same.kinefab", "--report", report)
    assert done.returncode == 1
    assert len(done.stderr.splitlines()) < MOST_ALIKE + 10
    assert f"{COUNT - MOST_ALIKE} more findings are not listed" in done.stderr
    assert json.loads(report.read_text("utf-8"))["errors"] == COUNT
