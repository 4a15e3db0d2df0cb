"""Thousands of findings that are alike: the first ones, and how many more."""

from __future__ import annotations

import json

import pytest
from command_line import run
from kinefab import export
from kinefab.cli.console import MOST_WARNINGS
from kinefab.diagnostics import (
    MOST_ALIKE,
    MOST_NAMES,
    KinefabError,
    Outcome,
    Report,
    chained,
    diagnostic,
    listed,
    named,
)
from kinefab.sources import read as read_source
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


def test_the_command_line_prints_eight_warnings_of_a_kind_unless_remarks_are_asked_for(tmp_path):
    """A robot has one of each kind for each of its links; errors are all wanted."""
    source, report = tmp_path / "odd.bundle.json", tmp_path / "report.json"
    cams = [{"id": f"Cam:{i}", "kind": "cam", "a": {"component": "A", "geometry": "body"}} for i in range(30)]
    source.write_text(json.dumps(bundle(part("A"), constraints=cams)), "utf-8")
    call = "export", source, "-o", tmp_path / "odd.kinefab", "--report", report
    done = run(*call)
    assert done.stderr.count("warning CONSTRAINT_KIND_UNKNOWN:") == MOST_WARNINGS
    left = "CONSTRAINT_KIND_UNKNOWN: warning FINDINGS_OMITTED: 22 more findings are not listed. --json lists all"
    assert left in done.stderr
    assert run("-v", *call).stderr.count("warning CONSTRAINT_KIND_UNKNOWN:") == 30
    told = [found["code"] for found in json.loads(report.read_text("utf-8"))["diagnostics"]]
    assert told.count("CONSTRAINT_KIND_UNKNOWN") == 30


def test_what_a_reader_does_not_understand_is_told_once(tmp_path):
    """The analysis, which cannot interpret it either, says nothing more."""
    source = tmp_path / "odd.bundle.json"
    cam = {"id": "Cam", "kind": "cam", "a": {"component": "A", "geometry": "body"}}
    side = {"component": "A", "geometry": "blob"}
    blob = {"id": "Blob", "kind": "coincident", "a": side, "b": {**side, "component": "B"}}
    other = {"id": "Other", "kind": "other", "a": {"component": "A", "geometry": "body"}}
    source.write_text(json.dumps(bundle(part("A"), part("B"), constraints=[cam, blob, other])), "utf-8")
    found = export(source, tmp_path / "odd.kinefab").report
    told = [(d.code, d.where.rpartition("#")[2]) for d in found.diagnostics if d.code.startswith("CONSTRAINT")]
    assert told == [
        ("CONSTRAINT_KIND_UNKNOWN", "/constraints/0/kind"),
        ("CONSTRAINT_GEOMETRY_UNKNOWN", "/constraints/1/a/geometry"),
        ("CONSTRAINT_GEOMETRY_UNKNOWN", "/constraints/1/b/geometry"),
        ("CONSTRAINT_NOT_INTERPRETED", "/constraints/2"),
    ]
    became = {o.feature: o.outcome for o in found.outcomes if o.feature.startswith("constraint")}
    assert set(became.values()) == {Outcome.DROPPED} and len(became) == 3


def test_a_message_lists_some_names_and_how_many_more():
    names = [f"part {i}" for i in range(MOST_NAMES + 3)]
    assert named(names[:MOST_NAMES]) == ", ".join(names[:MOST_NAMES])
    assert named(names) == ", ".join(names[:MOST_NAMES]) + " and 3 more"
    assert chained(names[:MOST_NAMES], " -> ").count(" -> ") == MOST_NAMES - 1
    assert chained(names, " -> ").split(" -> ")[5:8] == ["part 5", "(3 more)", "part 9"]


def test_a_cycle_and_the_roots_of_a_robot_are_told_by_some_of_their_links(tmp_path):
    """A message of a thousand names is none."""
    links = "".join(f"<link name='link{i}'/>" for i in range(1000))
    joint = "<joint name='j{0}' type='fixed'><parent link='link{0}'/><child link='link{1}'/></joint>"
    for name, joints in (
        ("cycle", "".join(joint.format(i, (i + 1) % 1000) for i in range(1000))),
        ("roots", ""),
    ):
        (tmp_path / f"{name}.urdf").write_text(f"<robot name='r'>{links}{joints}</robot>", "utf-8")
        with pytest.raises(KinefabError) as raised:
            read_source(tmp_path / f"{name}.urdf", Report())
        (found,) = raised.value.diagnostics
        assert len(found.message) < 300 and ("989 more" if name == "cycle" else "988 more") in found.message
