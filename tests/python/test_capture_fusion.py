"""Fusion's capture against its documented double, and the add-in in a Python without anything else."""

from __future__ import annotations

import json
import subprocess
import sys
import textwrap

import pytest
from cad.captures import capture, scene_differences
from cad.described import described
from cad.fusion import Fusion
from cad.gears import held_by_the_world
from command_line import run
from kinefab.capture.channel import question
from kinefab.capture.fusion.inside import capture_to
from kinefab.capture.fusion.install import install
from kinefab.diagnostics import Report
from kinefab.sources import read
from test_capture_onshape import only_joints, rigid_crank


@pytest.mark.parametrize("name", ["lever/lever.bundle.json", "gears"])
def test_joints_give_the_scene_of_the_bundle(name, tmp_path):
    """The frames' own X is the axis here, as a user may choose."""
    values = only_joints(name)
    values = rigid_crank(values) if "lever" in name else values
    for coupling in values.get("couplings", []):
        coupling["kind"] = "linear"  # Fusion's motion links do not say what they are
    report = Report()
    found = capture("fusion", Fusion(described(values)).record(), tmp_path, values["meta"]["up"], report)
    assert scene_differences(values, found.path, tmp_path) == []
    assert report.diagnostics == []


def test_a_link_of_a_joint_whose_first_side_is_the_root_turns_as_there(tmp_path):
    """The joint's sides change places and its angle its sign, which the link's ratio goes with."""
    scene, stated = held_by_the_world(opposed=False)
    for values in (scene, stated):
        values["couplings"][0]["kind"] = "linear"
    found = capture("fusion", Fusion(described(stated)).record(), tmp_path, "Y")
    assert scene_differences(scene, found.path, tmp_path) == []
    assert found.draft.report.diagnostics == []


def every_motion() -> list[list[dict]]:
    """A record with joints of every type, links between them and as-built ones."""
    values = only_joints("gears")
    hinge = values["joints"][0]
    at = {k: dict(hinge[k]) for k in ("frameA", "frameB")}
    for word, names in (
        ("cylindrical", ("tz", "rz")),
        ("pin_slot", ("tx", "rz")),
        ("planar", ("tx", "ty", "rz")),
        ("ball", ()),
    ):
        dofs = [
            {"name": name, "value": 0.1, "min": -0.2, "max": 0.3, "minEnabled": True, "maxEnabled": True}
            for name in names
        ]
        frames = {key: dict(frame) for key, frame in at.items()}
        values["joints"].append({**hinge, **frames, "id": word, "name": word, "type": word, "dof": dofs})
    return [
        Fusion(described(values)).record(),
        Fusion(described(values), tuple(j["id"] for j in values["joints"])).record(),
    ]


class Vector:
    """An array as Fusion's Python hands it out: no list, and no collection of its API."""

    def __init__(self, entries: list) -> None:
        self.entries = entries

    def __len__(self) -> int:
        return len(self.entries)

    def __getitem__(self, index: int) -> object:
        return self.entries[index]


class Answering:
    """An object of Fusion that answers as a record says."""

    def __init__(self, answers: list[dict], own: int = 0) -> None:
        self.answers, self.own = answers, own

    def seen(self, value: object) -> object:
        if isinstance(value, list):
            return Vector([self.seen(entry) for entry in value])
        return Answering(self.answers, value["object"]) if isinstance(value, dict) else value

    def __getattr__(self, name: str) -> object:
        held = self.answers[self.own]
        if name in held:
            return self.seen(held[name])
        if any(key.startswith(f"{name}(") for key in held):
            return lambda *given: self.seen(held[question(name, given)])
        raise AttributeError(name)


def test_arrays_of_fusions_python_are_read(tmp_path):
    """``allJoints``, ``motionLinks``, ``asArray`` and the like are no lists."""
    answers = every_motion()[0]
    told = capture_to(Answering(answers), str(tmp_path / "x.bundle.json"))
    assert "CAPTURE" not in told
    again = capture("fusion", answers, tmp_path, "Z")
    written = json.loads((tmp_path / "x.bundle.json").read_text("utf-8"))
    assert written["joints"] == again.draft.joints and len(written["couplings"]) == 1


def test_ranges_of_a_ball_are_told(tmp_path):
    values = only_joints("gears")
    values["joints"][0] |= {"type": "ball", "dof": [], "range": {"min": -0.5, "minEnabled": True}}
    values.pop("couplings")
    report = Report()
    capture("fusion", Fusion(described(values)).record(), tmp_path, "Z", report)
    assert [d.code for d in report.diagnostics if "range of a ball" in d.message] == ["CAPTURE_KIND_RAW"]


def test_joints_of_one_name_are_told_apart_by_what_they_hold(tmp_path):
    """Each component numbers its own: a link names the joint, not its name."""
    values = only_joints("gears")
    for coupling in values["couplings"]:
        coupling["kind"] = "linear"
    answers = Fusion(described(values)).record()
    for entry in answers:
        if entry.get("#kind") == "fusion.Joint":
            entry["name"] = "Rev1"
    found = capture("fusion", answers, tmp_path, values["meta"]["up"])
    (coupling,) = found.draft.couplings
    assert [coupling[end]["joint"] for end in "ab"] == ["Rev1", "Rev1 (2)"]


def test_joints_of_every_type_are_captured(tmp_path):
    for number, answers in enumerate(every_motion()):
        report = Report()
        found = capture("fusion", answers, tmp_path, "Z", report)
        kinds = [joint["type"] for joint in found.draft.joints]
        assert kinds == ["revolute", "revolute", "cylindrical", "pin_slot", "planar", "ball"], number
        names = [dof["name"] for dof in found.draft.joints[4]["dof"]]
        assert names == ["tx", "ty", "rz"]
        assert "CAPTURE_MEMBER_FAILED" not in [entry.code for entry in report.diagnostics]


def test_as_built_joints_are_placed_by_their_values(tmp_path):
    values = only_joints("gears")
    for coupling in values["couplings"]:
        coupling["kind"] = "linear"
    names = tuple(joint["id"] for joint in values["joints"])
    answers = Fusion(described(values), names).record()
    for joint in values["joints"]:
        joint.pop("frameB")
    found = capture("fusion", answers, tmp_path, values["meta"]["up"])
    assert scene_differences(values, found.path, tmp_path) == []


def test_rigid_groups_and_contact_sets(tmp_path):
    values = only_joints("lever/lever.bundle.json")
    members = [c["id"] for c in values["components"] if c.get("parent") == "Lever/Crank:1"]
    for joint in values["joints"]:
        joint["a"], joint["b"] = (members[0] if j == "Lever/Crank:1" else j for j in (joint["a"], joint["b"]))
    report = Report()
    answers = Fusion(described(values)).record(groups=(("Group", members),), contacts=2)
    found = capture("fusion", answers, tmp_path, "Z", report)
    held = [j for j in found.draft.joints if j["type"] == "rigid"]
    assert [(j["a"], j["b"]) for j in held] == [(members[0], m) for m in members[1:]]
    assert [entry.code for entry in report.diagnostics] == ["CAPTURE_KIND_RAW"]


@pytest.mark.parametrize(
    ("changes", "code"), [({"isSaved": False}, "CAPTURE_UNSAVED"), ({"isModified": True}, "CAPTURE_UNSAVED")]
)
def test_unsaved(changes, code, tmp_path):
    report = Report()
    capture("fusion", Fusion(described(only_joints("gears"))).record(**changes), tmp_path, report=report)
    assert [entry.code for entry in report.diagnostics] == [code]


@pytest.mark.parametrize(("configurations", "told"), [(0, None), (1, None), (3, "Reclined")])
def test_one_of_several_configurations_is_named(tmp_path, configurations, told):
    record = Fusion(described(only_joints("gears"))).record(configurations=configurations)
    found = capture("fusion", record, tmp_path)
    assert json.loads(found.path.read_text("utf-8"))["meta"].get("configuration") == told
    assert read(found.path, Report()).source.configuration == (told or "")


def test_a_release_without_configurations_is_read(tmp_path):
    asked = Fusion(described(only_joints("gears"))).record(configurations=3)
    record = [{k: v for k, v in own.items() if k != "configurationTopTable"} for own in asked]
    found = capture("fusion", record, tmp_path)
    assert "configuration" not in json.loads(found.path.read_text("utf-8"))["meta"]


def test_an_add_in_goes_into_no_folder_that_is_not_there(tmp_path):
    """A mistyped path was made a folder, into which Fusion does not look."""
    typo, file = tmp_path / "AddIn", tmp_path / "file"
    file.write_text("")
    for folder, detail in ((typo, f"there is no folder {typo}"), (file, "Not a directory")):
        done = run("capture", "fusion", "--install", folder)
        assert done.returncode == 1 and "Traceback" not in done.stderr
        said = "".join(done.stderr.split())
        assert "errorTARGET_UNWRITABLE" in said and "".join(detail.split()) in said, done.stderr
    assert list(tmp_path.iterdir()) == [file]


def test_the_add_in_runs_in_a_python_of_its_own(tmp_path):
    """Isolated, without site packages: nothing but the standard library and what was installed."""
    made = install(tmp_path)
    values = only_joints("gears")
    answers = Fusion(described(values)).record()
    (tmp_path / "answers.json").write_text(json.dumps(answers), "utf-8")
    program = f"""
        import json, sys, types
        sys.path.insert(0, {str(made)!r})

        class Thing:
            def __init__(self, answers, own):
                self._answers, self._own = answers, own
            def _see(self, value):
                if isinstance(value, dict):
                    return Thing(self._answers, value["object"])
                return [self._see(v) for v in value] if isinstance(value, list) else value
            def __getattr__(self, name):
                answers = self._answers[self._own]
                if name in answers:
                    return self._see(answers[name])
                if any(key.startswith(name + "(") for key in answers):
                    return lambda *a: self._see(answers[name + "(" + ", ".join(map(json.dumps, a)) + ")"])
                raise AttributeError(name)

        answers = json.load(open({str(tmp_path / "answers.json")!r}))
        core = types.ModuleType("adsk.core")
        shown = []
        class Dialog:
            filename = {str(tmp_path / "robot.bundle.json")!r}
            def showSave(self): return 0
        class Window:
            def createFileDialog(self): return Dialog()
            def messageBox(self, text): shown.append(text)
        application = Thing(answers, 0)
        application.userInterface = Window()
        core.Application = types.SimpleNamespace(get=lambda: application)
        core.DialogResults = types.SimpleNamespace(DialogOK=0)
        adsk = types.ModuleType("adsk")
        adsk.core, adsk.fusion = core, types.ModuleType("adsk.fusion")
        sys.modules.update({{"adsk": adsk, "adsk.core": core, "adsk.fusion": adsk.fusion}})
        import KinefabCapture
        KinefabCapture.run(None)
        print(shown[0])
    """
    done = subprocess.run(
        [sys.executable, "-I", "-S", "-c", textwrap.dedent(program)],
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 0, done.stderr
    assert "kinefab capture --replay robot.record.json" in done.stdout, done.stdout
    inside = json.loads((tmp_path / "robot.bundle.json").read_text("utf-8"))
    from kinefab.capture.run import replay

    replay(tmp_path / "robot.record.json", tmp_path / "again.bundle.json", Report())
    outside = json.loads((tmp_path / "again.bundle.json").read_text("utf-8"))
    assert inside == outside
