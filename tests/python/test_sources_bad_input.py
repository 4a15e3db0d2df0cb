"""Wrong data of any kind gives diagnostics: no traceback, no hang, no scene."""

from __future__ import annotations

import copy
import json
import time

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from kinefab import sources
from kinefab.diagnostics import KinefabError, Report
from kinefab.sources.reading import file, json_text
from source_bundles import FIXTURES, codes

LEVER = json.loads((FIXTURES / "lever" / "lever.bundle.json").read_text(encoding="utf-8"))
PAPER = (FIXTURES / "lever" / "lever_paper.csv").read_bytes()
TAGGED = (FIXTURES / "lever" / "lever.csv").read_bytes()

WRONG = [None, True, 0, -1, 2.5, 1e300, 10**400, "", "x", "\ud800", "a\0b", {}, {"o": 1}]
WRONG += [[], [None], [1, 2], [1, 2, "3"]]


def places(value, path=()):
    """Every path into a JSON value."""
    yield path
    for key, inner in (
        value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    ):
        yield from places(inner, (*path, key))


COUPLING = {"id": "C", "kind": "gear", "ratio": 2}
COUPLING |= {"a": {"joint": "Joint:Pin", "dof": "rz"}, "b": {"joint": "Joint:Shaft", "dof": "rz"}}
WHOLE = {**LEVER, "couplings": [COUPLING]}
PLACES = list(places(WHOLE))


def replaced(place, wrong):
    values = copy.deepcopy(WHOLE)
    if not place:
        return wrong
    at = values
    for key in place[:-1]:
        at = at[key]
    at[place[-1]] = wrong
    return values


def refused(path) -> Report:
    """The report of a source that must be refused."""
    report = Report()
    with pytest.raises(KinefabError):
        sources.read(path, report)
    return report


@settings(max_examples=250, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(place=st.sampled_from(PLACES), wrong=st.sampled_from(WRONG))
def test_any_value_of_any_type_gives_diagnostics_only(tmp_path, place, wrong):
    """Whatever stands in whatever place, the reader reads or refuses; it never throws anything else."""
    path = tmp_path / "case.bundle.json"
    path.write_text(json.dumps(replaced(place, wrong)), encoding="utf-8")
    report = Report()
    try:
        sources.read(path, report)
    except KinefabError as error:
        assert error.diagnostics
    str(report.diagnostics)


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data(), content=st.sampled_from([TAGGED, PAPER]))
def test_any_damaged_csv_gives_diagnostics_only(tmp_path, data, content):
    """Bytes changed, cut out or put in anywhere never make the CSV readers throw."""
    at = data.draw(st.integers(0, len(content) - 1))
    cut = data.draw(st.integers(0, 40))
    path = tmp_path / "case.csv"
    path.write_bytes(content[:at] + data.draw(st.binary(max_size=12)) + content[at + cut :])
    try:
        sources.read(path, Report())
    except KinefabError as error:
        assert error.diagnostics


@pytest.mark.parametrize(
    "content",
    [b'{"meta": 1', b"[" * 3_000_000, b'{"a":' * 2_000_000, b"[],", b"\xff\xfe", b"\0" * 64],
    ids=["cut", "arrays", "objects", "trailing", "utf-16", "zeros"],
)
def test_broken_json_is_refused(tmp_path, content):
    """Cut off, nested without end, not UTF-8: refused with a place."""
    path = tmp_path / "case.bundle.json"
    path.write_bytes(content)
    assert all(found.where.startswith("case.bundle.json") for found in refused(path).diagnostics)


def test_two_gigabytes_are_refused_unread(tmp_path):
    """A sparse file of 2 GB is refused by its size, at once."""
    path = tmp_path / "case.bundle.json"
    with path.open("wb") as stream:
        stream.truncate(2 * 2**30)
    started = time.process_time()
    assert codes(refused(path)) == ["SOURCE_TOO_LARGE"]
    assert time.process_time() - started < 5.0  # reading it would take longer and 2 GB


def test_many_brackets_are_refused(tmp_path, monkeypatch):
    """A short text of brackets must not become gigabytes of lists."""
    monkeypatch.setattr(json_text, "MAX_CONTAINERS", 1000)
    path = tmp_path / "case.bundle.json"
    path.write_text('{"meta": [' + "[]," * 1000 + "[]]}", encoding="utf-8")
    assert codes(refused(path)) == ["SOURCE_TOO_MANY_BRACKETS"]


def test_unreadable_path_is_refused(tmp_path):
    """A path that the system refuses is a finding about the path."""
    assert codes(refused(tmp_path / "a\0b.bundle.json")) == ["SOURCE_UNREADABLE"]


def test_stream_larger_than_its_size_says_is_refused(tmp_path, monkeypatch):
    """A file that grows while it is read still meets the limit."""
    path = tmp_path / "case.bundle.json"
    path.write_text(json.dumps(LEVER), encoding="utf-8")
    monkeypatch.setattr(file, "MAX_BYTES", 100)
    with pytest.raises(KinefabError, match="SOURCE_TOO_LARGE"):
        file.read_bytes(path, Report(), limit=100)


def test_every_fault_is_reported_at_once(tmp_path):
    """Three faults in three places are three findings of one run."""
    values = copy.deepcopy(LEVER)
    values["components"][3]["pose"]["x"] = [1, 2]
    values["joints"][0]["b"] = "Nowhere"
    values["constraints"][2]["value"] = "ninety"
    path = tmp_path / "case.bundle.json"
    path.write_text(json.dumps(values), encoding="utf-8")
    wheres = [found.where.partition("#")[2] for found in refused(path).diagnostics]
    assert wheres == ["/components/3/pose/x", "/joints/0/b", "/constraints/2/value"]


def test_findings_hold_no_unprintable_text(tmp_path):
    """A name of control characters comes out escaped, so that a report can go to any terminal."""
    values = copy.deepcopy(LEVER)
    values["meta"]["up"] = "\x1b[2J\n"
    path = tmp_path / "case.bundle.json"
    path.write_text(json.dumps(values), encoding="utf-8")
    assert str(refused(path).diagnostics[0]).isprintable()


def test_half_a_surrogate_pair_as_a_key_of_a_reading_is_left_out(tmp_path):
    """Keys of readings go into the scene, so they must be text that a file can hold."""
    constraint = {"id": "C", "kind": "other", "reading": {"a\ud800": "b", "c": "d"}}
    path = tmp_path / "case.bundle.json"
    path.write_text(json.dumps({**LEVER, "constraints": [constraint]}), encoding="utf-8")
    report = Report()
    scene = sources.read(path, report)
    assert dict(scene.constraints[0].reading) == {"c": "d"}
    assert "BUNDLE_FIELD_UNKNOWN" in codes(report)


@pytest.mark.parametrize(
    "cut", [slice(2, None), slice(None, -1)], ids=["no byte order mark", "half a letter"]
)
def test_utf16_table_is_refused_by_its_encoding(tmp_path, cut):
    """UTF-16 that does not say so, or breaks off: one finding that says so, not one for each cell."""
    path = tmp_path / "case.csv"
    path.write_bytes(TAGGED.decode("utf-8-sig").encode("utf-16")[cut])
    with pytest.raises(KinefabError) as refused:
        sources.read(path, Report())
    assert [found.code for found in refused.value.diagnostics] == ["CSV_ENCODING"]
