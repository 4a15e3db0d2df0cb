"""Records: what a running program answers is written, blanked where asked, and replayed to the same bundle; meshes; C#."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import kinefab
import numpy as np
import pytest
from cad.captures import Program, call, capture
from cad.described import described, mechanism
from cad.inventor import Inventor
from cad.solidworks import SolidWorks
from cad.tetrahedron import fusion_bodies, inventor_bodies, solidworks_bodies
from command_line import run
from kinefab.capture.channel import Live
from kinefab.capture.inventor.capture import METHODS
from kinefab.capture.run import captured, replay
from kinefab.diagnostics import Report
from test_capture_fusion import Fusion
from test_capture_kinds import BOTH, machine
from test_capture_onshape import answers as onshape_answers
from test_capture_onshape import only_joints


def recorded(folder: Path, blank: bool):
    values = mechanism("lever/lever.bundle.json")
    live = Live(Program(Inventor(described(values)).record()), METHODS, call)
    report, record = Report(), folder / "lever.record.json"
    return captured("inventor", live, folder / "live.bundle.json", report, record, blank, "Z"), record


def test_a_record_replays_to_the_same_bytes(tmp_path):
    live, record = recorded(tmp_path, blank=False)
    again = replay(record, tmp_path / "live2.bundle.json", Report(), "Z")
    assert again.path.read_bytes() == live.path.read_bytes()
    done = run("capture", "--replay", record, "-o", tmp_path / "cli.bundle.json", "--up", "z")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "cli.bundle.json").read_bytes() == live.path.read_bytes()


def test_a_blanked_record_has_no_names_and_the_same_mechanism(tmp_path):
    live, record = recorded(tmp_path, blank=True)
    text = record.read_text("ascii")
    assert not [word for word in ("Lever", "Crank", "Base", "Shaft", "Pin", "Work") if word in text]
    again = replay(record, tmp_path / "blank.bundle.json", Report(), "Z").draft
    assert len(again.components) == len(live.draft.components)
    assert [j["type"] for j in again.joints] == [j["type"] for j in live.draft.joints]
    assert [j["frameA"] for j in again.joints] == [j["frameA"] for j in live.draft.joints]


@pytest.mark.parametrize("program", ["inventor", "solidworks", "fusion"])
def test_meshes_stand_where_their_parts_are(program, tmp_path):
    """Part coordinates, one file a definition: the exported scene's boxes are those of the description, in metres."""
    assembly = described(machine(BOTH["points"]) | ({"constraints": []} if program == "fusion" else {}))
    if program == "inventor":
        record = Inventor(assembly, facets=inventor_bodies).record()
    elif program == "solidworks":
        record = SolidWorks(assembly, solidworks_bodies).record()
    else:
        record = Fusion(assembly, bodies=fusion_bodies).record()
    found = capture(program, record, tmp_path, "Z")
    parts = {c["definition"] for c in found.draft.components if c["kind"] == "part"}
    assert len(found.files) == 1 + len(parts)
    result = kinefab.export(found.path, tmp_path / "x.kinefab")
    scene = result.analysed.scene
    for node in scene.nodes:
        for body in node.bodies:
            mesh = scene.meshes[body.mesh]
            size = np.sort(np.ptp(np.asarray(mesh.vertices), axis=0))
            assert size == pytest.approx([0.02, 0.03, 0.05], abs=1e-6)
    assert sum(len(node.bodies) for node in scene.nodes) == 3


@pytest.mark.skipif(shutil.which("dotnet-kinefab") is None, reason="dotnet-kinefab is not on the PATH")
def test_the_scenes_of_captures_are_valid_in_csharp(tmp_path):
    lever, gears = (
        described(values) for values in (mechanism("lever/lever.bundle.json"), only_joints("gears"))
    )
    records = {
        "inventor": Inventor(lever).record(),
        "solidworks": SolidWorks(lever).record(),
        "fusion": Fusion(gears).record(),
        "onshape": onshape_answers(gears),
    }
    for program, record in records.items():
        found = capture(program, record, tmp_path)
        target = tmp_path / f"{program}.kinefab"
        kinefab.export(found.path, target)
        command = ["dotnet-kinefab", "validate", str(target), "--strict"]
        done = subprocess.run(command, capture_output=True, text=True, timeout=120)
        assert done.returncode == 0, program + done.stdout + done.stderr
