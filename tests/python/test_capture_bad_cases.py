"""What is in a capture's way: a sentence and a remedy, and the rest is not lost."""

from __future__ import annotations

import copy
import json
import sys
from types import ModuleType, SimpleNamespace

import pytest
from cad.captures import capture
from cad.described import described, mechanism
from cad.fusion import Fusion
from cad.inventor import Inventor
from cad.solidworks import SolidWorks
from command_line import run
from kinefab.capture.com import Late, attached, patient
from kinefab.capture.inventor.capture import HANDED, NUMBERS
from kinefab.capture.run import replay
from kinefab.diagnostics import KinefabError, Report
from test_capture_kinds import BOTH, machine
from test_capture_onshape import only_joints


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


class Answered:
    """An object as late binding hands it out: it may be called, which asks for its own default member."""

    _oleobj_ = None

    def __call__(self, *arguments: object) -> None:
        raise AssertionError("its default member was asked for")


def test_a_method_without_arguments_may_have_been_answered_already():
    """Late bound, it is asked as a property is; what comes back is its answer and not to be called."""

    class Feature:
        GetNextFeature = Answered()
        GetBodies = (Answered(),)

        def GetTypeName2(self) -> str:
            return "MateGroup"

    call = patient(Busy, lambda seconds: None)
    assert call(Feature, "GetNextFeature", ()) is Feature.GetNextFeature
    assert call(Feature, "GetBodies", ()) is Feature.GetBodies
    assert call(Feature(), "GetTypeName2", ()) == "MateGroup"


class Held:
    """The raw object behind a late bound one.  named: DISPIDs that its type information has; none: it has no information."""

    def __init__(self, answers: dict[int, object], named: dict[str, int] | None) -> None:
        self.answers, self.named = answers, named

    def GetTypeInfo(self) -> Held:
        if self.named is None:
            raise Busy("no type information")
        return self

    def GetTypeAttr(self) -> SimpleNamespace:
        return SimpleNamespace(cFuncs=len(self.named or {}))

    def GetFuncDesc(self, index: int) -> SimpleNamespace:
        return SimpleNamespace(memid=list((self.named or {}).values())[index], invkind=2)

    def GetNames(self, memid: int) -> tuple[str, ...]:
        return tuple(name for name, number in (self.named or {}).items() if number == memid)

    def Invoke(self, number: int, locale: int, kind: int, wanted: bool) -> object:
        assert (locale, kind, wanted) == (0, 2, True)
        return self.answers[number]


@pytest.mark.parametrize("named", [None, {"Type": 7, "Geometry": 67119422}])
def test_a_member_that_is_not_named_is_asked_by_its_number(named):
    face = SimpleNamespace(_oleobj_=Held({67119422: 3.5}, named))
    late = Late(numbers=NUMBERS)
    assert patient(Busy, lambda seconds: None, late)(face, "Geometry", None) == 3.5
    with pytest.raises(AttributeError):
        patient(Busy, lambda seconds: None, late)(face, "Plane", None)


@pytest.mark.parametrize("typed", [True, False])
def test_arrays_are_handed_over_to_be_filled(typed, monkeypatch):
    """With type information empty ones do, and the answer comes back; without, variants by reference are filled."""

    class Variant:
        def __init__(self, kind: int, value: object) -> None:
            self.kind, self.value = kind, value

    class Matrix:
        def GetMatrixData(self, cells):
            if typed:
                assert cells == []
                return tuple(range(16))
            if not isinstance(cells, Variant):
                raise TypeError("type mismatch")
            assert cells.kind == 0x4000 | 0x2000 | 5
            cells.value = tuple(range(16))
            return None

        def CalculateFacets(self, tolerance, vertices, facets, points, normals, corners):
            if typed:
                assert (tolerance, vertices, facets, points) == (0.005, "missing", "missing", [])
                return 3, 1, (0.0,) * 9, (0.0,) * 9, (1, 2, 3)
            if not isinstance(corners, Variant):
                raise TypeError("type mismatch")
            assert [v.kind for v in (vertices, points, corners)] == [0x4003, 0x6005, 0x6003]
            vertices.value, points.value, corners.value = 3, (0.0,) * 9, (1, 2, 3)
            return None

    client = ModuleType("win32com.client")
    client.VARIANT = Variant
    monkeypatch.setitem(sys.modules, "win32com", ModuleType("win32com"))
    monkeypatch.setitem(sys.modules, "win32com.client", client)
    call = patient(Busy, lambda seconds: None, Late(com=SimpleNamespace(Missing="missing"), handed=HANDED))
    assert call(Matrix(), "GetMatrixData", ()) == tuple(range(16))
    found = call(Matrix(), "CalculateFacets", (0.005,))
    assert (found[0], len(found[2]), found[4]) == (3, 9, (1, 2, 3))


def test_a_program_under_another_name_in_the_table_of_running_objects(monkeypatch):
    class ComError(Exception):
        hresult = -2147221021

    def absent(identifier: str) -> None:
        raise ComError(identifier)

    class Running:
        def QueryInterface(self, interface: int) -> str:
            return "the program"

    class Table:
        def EnumRunning(self):
            return [
                SimpleNamespace(GetDisplayName=lambda context, left, n=n: n)
                for n in ("!{A}", "SolidWorks_PID_7")
            ]

        def GetObject(self, moniker) -> Running:
            assert moniker.GetDisplayName(None, None) == "SolidWorks_PID_7"
            return Running()

    com, dynamic = ModuleType("pythoncom"), ModuleType("win32com.client.dynamic")
    vars(com).update(
        CoInitialize=lambda: None, com_error=ComError, GetActiveObject=absent, IID_IDispatch=0,
        GetRunningObjectTable=Table, CreateBindCtx=lambda reserved: None,
    )  # fmt: skip
    dynamic.Dispatch = lambda found: found
    for name, module in (("pythoncom", com), ("win32com", ModuleType("win32com")),
                         ("win32com.client", ModuleType("win32com.client")), ("win32com.client.dynamic", dynamic)):  # fmt: skip
        monkeypatch.setitem(sys.modules, name, module)
    live = attached("SolidWorks", "SldWorks.Application", frozenset(), Report(), "SolidWorks_PID_")
    assert live._objects == ["the program"]
    with pytest.raises(KinefabError):
        attached("SolidWorks", "SldWorks.Application", frozenset(), Report(), "Other_PID_")


def test_a_program_that_does_not_run(monkeypatch):
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


def huge(answers, kind: str, count: str):
    """The record with every collection of a class that is not empty claiming a billion entries more."""
    for entry in answers:
        if entry.get("#kind") == kind and entry.get(count):
            entry[count] += 10**9
    return answers


@pytest.mark.parametrize("program", ["inventor", "fusion"])
def test_a_collection_that_claims_more_than_is_recorded_ends_where_the_record_does(program, tmp_path):
    values = mechanism("lever/lever.bundle.json")
    double = Inventor(described(values)) if program == "inventor" else Fusion(described(only_joints("gears")))
    count = "Count" if program == "inventor" else "count"
    answers = huge(double.record(), f"{program}.Collection", count)
    report = Report()
    found = capture(program, answers, tmp_path, "Z", report)
    told = [d.message for d in report.diagnostics if "and all after it" in d.message]
    assert told and len(found.draft.components) > 2 and found.draft.joints + found.draft.constraints


def test_what_leads_back_to_itself_ends(tmp_path):
    """A feature after itself, an occurrence that is its own parent."""
    answers = lever()
    for number, entry in enumerate(answers):
        if entry.get("#kind") == "inventor.Occurrence":
            entry["ParentOccurrence"] = {"object": number}
    report = Report()
    capture("inventor", answers, tmp_path, "Z", report)
    assert any("its own parent" in d.message for d in report.diagnostics)
    answers = SolidWorks(described(machine(*BOTH.values()))).record()
    for number, entry in enumerate(answers):
        for member in ("GetNextFeature()", "GetNextSubFeature()"):
            if member in entry:
                entry[member] = {"object": number}
    report = Report()
    capture("solidworks", answers, tmp_path, "Z", report)
    assert any("after itself" in d.message for d in report.diagnostics)


def test_an_output_asked_of_fusion_leads_to_the_add_in_and_its_record(tmp_path):
    """Every other program takes -o."""
    done = run("capture", "fusion", "-o", tmp_path / "x.bundle.json")
    assert done.returncode == 2 and list(tmp_path.iterdir()) == []
    for words in ("--install FOLDER", "capture --replay RECORD -o", "x.bundle.json"):
        assert words in " ".join(done.stderr.split()), done.stderr


@pytest.mark.parametrize(
    "before", [("--replay", "r.json"), ("-o", "x.bundle.json"), ("--up", "Z"), ("--json",)]
)
def test_options_before_a_programs_name_are_not_passed_over(tmp_path, before):
    done = run("capture", *before, "fusion", "--install", tmp_path)
    assert done.returncode == 2 and list(tmp_path.iterdir()) == []
    assert "--replay stands without a program" in " ".join(done.stderr.split()), done.stderr
