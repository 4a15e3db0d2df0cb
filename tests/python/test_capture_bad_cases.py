"""What is in a capture's way: a sentence and a remedy, and the rest is not lost."""

from __future__ import annotations

import copy
import json

import pytest
from cad.captures import capture
from cad.described import described, mechanism
from cad.inventor import Inventor
from command_line import run
from kinefab.capture.com import patient
from kinefab.capture.run import replay
from kinefab.diagnostics import KinefabError, Report


def lever(**changes):
    """The lever in Inventor, by a record; changes: of its document."""
    return Inventor(described(mechanism("lever/lever.bundle.json"))).record(**changes)


def stopped(answers, folder) -> list[str]:
    report = Report()
    with pytest.raises(KinefabError):
        capture("inventor", answers, folder, report=report)
    assert not (folder / "inventor.bundle.json").exists()
    return [found.code for found in report.diagnostics]


def captured(answers, folder):
    report = Report()
    found = capture("inventor", answers, folder, report=report)
    return found, [entry.code for entry in report.diagnostics]


def test_an_old_version(tmp_path):
    answers = Inventor(described(mechanism("lever/lever.bundle.json")), major=20).record()
    assert stopped(answers, tmp_path) == ["CAPTURE_VERSION"]


@pytest.mark.parametrize("document", ["none", "part"])
def test_no_open_assembly(document, tmp_path):
    answers = lever(**{"DocumentType": 12290} if document == "part" else {})
    if document == "none":
        answers[0]["ActiveDocument"] = None
    assert stopped(answers, tmp_path) == ["CAPTURE_NO_ASSEMBLY"]


@pytest.mark.parametrize("changes", [{"FullFileName": ""}, {"Dirty": True}])
def test_what_is_not_saved_is_captured_with_a_word(changes, tmp_path):
    found, codes = captured(lever(**changes), tmp_path)
    assert "CAPTURE_UNSAVED" in codes
    assert found.path.exists()


def test_a_document_that_wants_a_rebuild_is_a_dirty_pose(tmp_path):
    found, _ = captured(lever(RequiresUpdate=True), tmp_path)
    assert json.loads(found.path.read_text("utf-8"))["meta"]["poseState"] == "dirty"


def test_a_program_that_stops_answering(tmp_path):
    answers = lever()
    answers[0]["SoftwareVersion"] = {"failed": "com_error: RPC server is unavailable"}
    assert stopped(answers, tmp_path) == ["CAPTURE_STOPPED"]


@pytest.mark.parametrize("answer", ["failed", "null"])
def test_an_occurrence_that_fails_does_not_lose_the_rest(answer, tmp_path):
    answers = lever()
    whole, _ = captured(copy.deepcopy(answers), tmp_path)
    bar = next(entry for entry in answers if entry.get("Name") == "BarC:1")
    bar["Transformation"] = {"failed": "com_error: E_FAIL"} if answer == "failed" else None
    found, codes = captured(answers, tmp_path)
    lost = {c["id"] for c in whole.draft.components} - {c["id"] for c in found.draft.components}
    assert lost == {"Lever/BarC:1"}
    assert {"CAPTURE_MEMBER_FAILED", "CAPTURE_SIDE_LOST"} <= set(codes)
    named = {r["component"] for c in found.draft.constraints for k, r in c.items() if k in ("a", "b", "c")}
    assert "Lever/BarC:1" not in named
    assert "Lever/BarC:1" not in {joint[end] for joint in found.draft.joints for end in "ab"}


def test_a_sick_constraint_is_suppressed_and_told(tmp_path):
    values = mechanism("lever/lever.bundle.json")
    values["constraints"][-1]["health"] = 11786
    answers = Inventor(described(values)).record()
    found, codes = captured(answers, tmp_path)
    assert "CAPTURE_SICK" in codes
    assert found.draft.constraints[-1]["suppressed"] is True


def test_a_redundant_constraint_is_none(tmp_path):
    values = mechanism("lever/lever.bundle.json")
    values["constraints"][-1]["health"] = 11787
    found, codes = captured(Inventor(described(values)).record(), tmp_path)
    assert "CAPTURE_SICK" not in codes
    assert "suppressed" not in found.draft.constraints[-1]


def test_a_locked_joint_is_rigid(tmp_path):
    answers = lever()
    next(entry for entry in answers if entry.get("Name") == "Joint:Slide")["Locked"] = True
    found, codes = captured(answers, tmp_path)
    assert "CAPTURE_LOCKED" in codes
    assert {j["id"]: j["type"] for j in found.draft.joints}["Joint:Slide"] == "rigid"


def test_a_kind_without_equations_is_kept_raw(tmp_path):
    values = mechanism("lever/lever.bundle.json")
    values["constraints"][0] |= {"inventor": "transitional"}
    found, codes = captured(Inventor(described(values)).record(), tmp_path)
    assert "CAPTURE_KIND_RAW" in codes
    first = found.draft.constraints[0]
    assert (first["kind"], first["rawKind"]) == ("other", "Transitional")
    assert first["a"]["geometry"] == "circle"


@pytest.mark.parametrize(
    "content", ["", "[]", "{}", '{"format": "kinefab.capture", "version": "9.0"}', "\x00"]
)
def test_a_record_that_is_none(content, tmp_path):
    path = tmp_path / "x.json"
    path.write_text(content, "utf-8")
    report = Report()
    with pytest.raises(KinefabError):
        replay(path, tmp_path / "x.bundle.json", report)
    assert [entry.code for entry in report.diagnostics] == ["CAPTURE_RECORD"]


def test_without_the_library_a_sentence():
    done = run("capture", "inventor", "-o", "x.bundle.json")
    assert done.returncode == 1
    assert "CAPTURE_LIBRARY" in done.stderr and "pywin32" in done.stderr
    assert "Traceback" not in done.stderr


class Busy(Exception):
    hresult = -2147418111


class Door:
    """Rejects its first calls, as a program does while a command runs."""

    def __init__(self, times: int) -> None:
        self.left = times

    @property
    def Name(self) -> str:
        self.left -= 1
        if self.left >= 0:
            raise Busy
        return "open"


def test_a_busy_program_is_asked_again():
    slept: list[float] = []
    assert patient(Busy, slept.append)(Door(3), "Name", None) == "open"
    assert len(slept) == 3 and slept == sorted(slept)
    with pytest.raises(Busy):
        patient(Busy, slept.append)(Door(10**6), "Name", None)
    assert sum(slept) < 60.0


def test_a_program_that_does_not_run(monkeypatch):
    import sys
    from types import ModuleType

    class ComError(Exception):
        hresult = -2147221021

    com, dynamic = ModuleType("pythoncom"), ModuleType("win32com.client.dynamic")

    def absent(identifier: str) -> None:
        raise ComError(identifier)

    com.CoInitialize, com.com_error, com.GetActiveObject, com.IID_IDispatch = (
        lambda: None,
        ComError,
        absent,
        0,
    )
    for name, module in (("pythoncom", com), ("win32com", ModuleType("win32com")),
                         ("win32com.client", ModuleType("win32com.client")), ("win32com.client.dynamic", dynamic)):  # fmt: skip
        monkeypatch.setitem(sys.modules, name, module)
    from kinefab.capture.com import attached

    report = Report()
    with pytest.raises(KinefabError):
        attached("Inventor", "Inventor.Application", frozenset(), report)
    assert [entry.code for entry in report.diagnostics] == ["CAPTURE_NOT_RUNNING"]


def test_a_target_that_cannot_be_written_is_no_broken_record(tmp_path):
    record = tmp_path / "x.record.json"
    record.write_text(
        json.dumps({"format": "kinefab.capture", "version": "1.0", "program": "inventor", "answers": lever()})
    )
    done = run("capture", "--replay", record, "-o", tmp_path / "no folder" / "x.bundle.json")
    assert done.returncode == 1 and "TARGET_UNWRITABLE" in done.stderr
    assert "Traceback" not in done.stderr


def test_a_record_that_leads_nowhere(tmp_path):
    answers = lever()
    answers[0]["ActiveDocument"] = {"object": 10**9}
    assert stopped(answers, tmp_path) == ["CAPTURE_RECORD"]
