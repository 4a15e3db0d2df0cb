"""Every valid scene of format 1.1 goes through every command that takes a scene, text and binary, and comes back as it was."""

from __future__ import annotations

import json
from pathlib import Path

import kinefab
import pytest
from command_line import runner
from kinefab.cli import app
from kinefab.views.freedoms import world_placements
from kinefab.views.picture import drawn_joints, strokes_of

CASES = Path(__file__).parents[1] / "conformance" / "valid"
NEWER = sorted(p for p in CASES.rglob("*.kinefab") if b'"version": "1.1"' in p.read_bytes())


@pytest.mark.parametrize("scene", NEWER, ids=lambda path: path.stem)
def test_the_views_take_it(scene: Path, tmp_path: Path):
    packed = tmp_path / "packed.kinefab"
    kinefab.export(scene, packed, kinefab.ExportOptions(writing={"container": "binary"}))
    for file in (scene, packed):
        for command, made in (("view", "a.html"), ("report", "b.html"), ("draw", "c.svg")):
            assert told(command, file, "-o", tmp_path / made) == ""
            assert (tmp_path / made).stat().st_size > 400
        assert told("inspect", file) == ""


def told(*arguments: object) -> str:
    """What a command says where it does not end well."""
    done = runner().invoke(app, [str(a) for a in arguments])
    return "" if done.exit_code == 0 else f"{done.output} {done.exception}"


@pytest.mark.parametrize("scene", NEWER, ids=lambda path: path.stem)
def test_it_comes_back_from_either_container(scene: Path, tmp_path: Path):
    """Text to binary to text: the same scene as text to text, whatever is written there."""
    found = []
    for container in ("text", "binary"):
        between, last = tmp_path / container / "a.kinefab", tmp_path / container / "again" / "a.kinefab"
        for folder in (between.parent, last.parent):
            folder.mkdir()
        kinefab.export(scene, between, kinefab.ExportOptions(writing={"container": container}))
        kinefab.export(between, last)
        document = json.loads(last.read_text("utf-8"))
        document["source"].pop("sha256", None)
        found.append(document)
    assert found[0] == found[1]


def test_links_are_drawn_as_the_joints_that_they_stand_for(tmp_path: Path):
    """A robot without meshes: else nothing of it was seen."""
    drawn = []
    for number, options in enumerate(({}, {"physics": "articulation"})):
        path = tmp_path / f"{number}.kinefab"
        source = Path(__file__).parents[2] / "fixtures" / "twins" / "arm.urdf"
        kinefab.export(source, path, kinefab.ExportOptions(writing=options))
        objects = json.loads(path.read_text("utf-8"))["gameObjects"]
        found = drawn_joints(objects, world_placements(objects))
        drawn.append({joint.name: joint for joint in found if joint.freedoms != "fixed"})
    joints, links = drawn
    assert list(joints) == list(links) and len(joints) == 8
    for name, joint in joints.items():
        link = links[name]
        assert link.freedoms == joint.freedoms
        assert link.pose.translation == pytest.approx(joint.pose.translation, abs=1e-6)
        assert link.pose.rotation[:, 0] == pytest.approx(joint.pose.rotation[:, 0], abs=1e-6)
        one, other = (stroke for own in (joint, link) for stroke in strokes_of(own, 1.0)[:1])
        assert other == pytest.approx(one, abs=1e-6)
        if "slide" in joint.freedoms:
            assert strokes_of(link, 1.0)[-1] == pytest.approx(strokes_of(joint, 1.0)[-1], abs=1e-6)
