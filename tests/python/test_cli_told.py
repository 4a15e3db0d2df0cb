"""What a newcomer is told: where the hidden remarks are, which folder is missing, what a command is for."""

from __future__ import annotations

import json
import os
import shlex
from pathlib import Path

import kinefab
import pytest
import trimesh
from command_line import LEVER, runner
from command_line import run as run_apart
from kinefab.cli import app

FIXTURES = Path(__file__).parents[2] / "fixtures"
ARM = FIXTURES / "twins" / "arm.urdf"


def run(*arguments: object):
    return runner().invoke(app, [str(a) for a in arguments])


def test_the_summary_says_how_to_see_what_is_hidden(tmp_path: Path):
    """Eight efforts are dropped with a remark each, and remarks are not shown."""
    told = run("export", ARM, "-o", tmp_path / "a.prefab", "--scripts").stderr
    assert "8 dropped. 'kinefab -v export' names each." in told
    told = run("-v", "export", ARM, "-o", tmp_path / "a.prefab", "--scripts").stderr
    assert "JOINT_EFFORT_DROPPED" in told and "names each" not in told
    pytest.importorskip("coal")  # without it, that overlaps were not looked for is a remark
    told = run("export", FIXTURES / "lever" / "lever.bundle.json", "-o", tmp_path / "b.kinefab").stderr
    assert "names each" not in told


def test_a_missing_folder_is_named(tmp_path: Path):
    """The system says "No such file or directory" of the file that is to be made."""
    done = run("export", ARM, "-o", tmp_path / "Assets" / "a.kinefab")
    assert done.exit_code == 1 and f"there is no folder {tmp_path / 'Assets'}" in done.stderr
    done = run("view", ARM, "-o", tmp_path / "pages" / "a.html")
    assert done.exit_code == 1 and f"there is no folder {tmp_path / 'pages'}" in done.stderr


def test_a_coupling_without_a_component_is_named_as_one(tmp_path: Path):
    told = run("export", ARM, "-o", tmp_path / "a.prefab").stderr
    assert "Unity has no component for a linear coupling." in told


def test_inspect_reads_scenes_and_says_so(tmp_path: Path):
    """A package is bytes to it: not "byte 0x8b in position 1"."""
    target = tmp_path / "a.unitypackage"
    assert run("export", ARM, "-o", target).exit_code == 0
    done = run("inspect", target)
    assert done.exit_code == 2 and "is no NAME.kinefab" in done.stderr
    done = run("inspect", ARM)
    assert done.exit_code == 2 and "'kinefab analyse'" in done.stderr, "a source, not a broken scene"


def test_mates_asks_for_what_it_uses():
    """Of the options of all formats those of STEP and IGES, and not --mates, which it makes."""
    told = run("mates", "--help").stdout
    assert all(option in told for option in ("--up", "--tolerance", "--ground"))
    assert not any(
        option in told for option in ("--mates auto|FILE", "--xacro-arg", "--keyframe", "--variant")
    )


def test_mates_of_a_file_with_joints_of_its_own(tmp_path: Path):
    """One finding, and no word of an option that nobody gave."""
    done = run("mates", FIXTURES / "freecad" / "four_bar.FCStd", "-o", tmp_path / "a.mates.json")
    assert done.exit_code == 1 and "SOURCE_OPTION_UNUSED" not in done.stderr
    assert "states its own joints or mates needs none found" in done.stderr


def test_mates_say_what_comes_next(tmp_path: Path):
    pytest.importorskip("OCP", reason="OCP is not installed: pip install cadquery-ocp-novtk")
    target = tmp_path / "lever.mates.json"
    done = run("mates", FIXTURES / "lever" / "lever.step", "-o", target)
    assert done.stdout.split("\n")[0].split() == ["no", "conf", "joint", "parts", "seen"]
    assert f"--mates {target} -o NAME.kinefab" in done.stderr


def test_what_a_script_prints_is_a_line(tmp_path: Path):
    """Trajectories and results hold arrays of thousands of numbers."""
    scene = kinefab.Scene()
    scene.add_hinge(
        None, scene.add_part("Door"), point=(0, 1, 0), axis=(0, 1, 0), limits=(-10, 80), name="Hinge"
    )
    mechanism = kinefab.motion(scene)
    result = kinefab.export(scene, tmp_path / "a.kinefab")
    assert repr(mechanism) == "<Mechanism: mobility 1; Hinge>"
    assert repr(mechanism.sweep("Hinge", 0, 90, frames=10)) == (
        "<Trajectory: 9 frames; Hinge; Hinge is at its limit at 80 deg>"
    )
    counts = "0 error, 1 warning, 0 info, 1 kept, 1 approximated, 0 dropped"
    assert repr(result) == f"<ExportResult: {tmp_path / 'a.kinefab'}; <Report: {counts}>>"
    assert repr(scene) == "<Scene: 1 nodes, 0 meshes, 1 joints, 0 couplings>"
    assert repr(scene.joints[0]) == "<Joint Hinge: revolute; a None, b 0>"
    out = tmp_path / "out"
    batch = kinefab.batch([tmp_path / "gone.urdf"], out, jobs=1)
    assert repr(batch) == f"<BatchResult: 1 refused; {out / 'index.html'}>"
    assert repr(kinefab.batch([], out)) == f"<BatchResult: no files; {out / 'index.html'}>"


def test_arguments_in_the_wrong_order_are_told_in_a_line():
    """The scene stood in the message whole, with all its arrays."""
    scene = kinefab.Scene()
    scene.add_hinge(None, scene.add_part("Door"), point=(0, 1, 0), axis=(0, 1, 0))
    with pytest.raises(TypeError) as refused:
        kinefab.export("door.kinefab", scene)
    assert str(refused.value).startswith(
        "the target is <Scene: 1 nodes, 0 meshes, 1 joints, 0 couplings>; pass"
    )


@pytest.mark.parametrize("command", ["view", "report", "draw"])
def test_what_is_looked_at_tells_what_was_found_and_where_it_is(command: str, tmp_path: Path):
    """A page of a robot whose mesh is missing shows no mesh: as with export, a warning says why."""
    robot = tmp_path / "robot.urdf"
    mesh = '<visual><geometry><mesh filename="nope.stl"/></geometry></visual>'
    robot.write_text(f'<robot name="r"><link name="base">{mesh}</link></robot>', encoding="utf-8")
    target = tmp_path / ("shown.svg" if command == "draw" else "shown.html")
    done = run(command, robot, "-o", target)
    assert done.exit_code == 0, done.stderr
    assert done.stdout.strip() == str(target)
    assert "MESH_NOT_FOUND" in done.stderr
    told = json.loads(run(command, robot, "-o", target, "--json").stdout)
    assert [d["code"] for d in told["diagnostics"] if d["severity"] == "warning"] == ["MESH_NOT_FOUND"]


@pytest.mark.linux  # where xdg-open is what opens pages
@pytest.mark.parametrize("status", [0, 3])
def test_what_opens_a_page_says_nothing_here_and_where_nothing_does_that_is_told(tmp_path: Path, status: int):
    """Without a browser, or with one that complains, a terminal was full of xdg-open's lines, also after the command's end."""
    opener = tmp_path / "bin" / "xdg-open"
    opener.parent.mkdir()
    opener.write_text(f'#!/bin/sh\necho "$1" > {tmp_path}/asked\necho noise; echo noise >&2\nexit {status}\n')
    opener.chmod(0o755)
    path = f"{opener.parent}{os.pathsep}{os.environ['PATH']}"
    done = run_apart("view", LEVER, "-o", "-lever.html", "--open", cwd=tmp_path, PATH=path)
    assert done.returncode == 0 and done.stdout == "-lever.html\n"
    assert (tmp_path / "asked").read_text() == f"{tmp_path / '-lever.html'}\n"
    assert done.stderr == ("No browser could be started; open -lever.html in one.\n" if status else "")


@pytest.mark.posix  # whose shell this is
def test_what_comes_next_is_told_as_it_is_typed(tmp_path: Path):
    folder = tmp_path / "my parts"
    folder.mkdir()
    trimesh.creation.box((1, 2, 3)).export(folder / "arm 1.stl")
    told = run("bundle", "init", folder, "--units", "mm").stderr
    command = told.partition("then: ")[2]
    assert shlex.split(command) == ["kinefab", "bundle", "check", str(folder / "my parts.bundle.json")]
