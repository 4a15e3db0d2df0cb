"""A kill at any moment of writing leaves the old pair or the new pair, readable."""

from __future__ import annotations

import json
import os
import re
import threading

import kinefab
import libraries
import numpy as np
import pytest
import trimesh
from kinefab.diagnostics import KinefabError
from kinefab.targets import kinefab_file as writer
from kinefab.targets.kinefab_file import canonical_json
from scenes import lid_scene, mesh_arrays, read


class Killed(BaseException):
    """Stands for SIGKILL: nothing of the writer may run after it, so clean-up is disarmed too."""


def box_scene(size: float) -> kinefab.Scene:
    scene = kinefab.Scene()
    scene.add_part("Box", trimesh.creation.box((size, 0.2, 0.3)))
    return scene


def size_in(path) -> float:
    return round(2 * read(path)["meshes"][0]["bounds"]["extents"][0], 6)


POINTS = ("write", "fsync", "replace", "unlink")


def armed(monkeypatch, at: int):
    """Let the process die at its ``at``-th touch of the file system (before or after it took place)."""
    touched = []

    def dying(name, real):
        def call(*args, **kwargs):
            if touched and touched[-1] == "dead":
                return None  # a dead process cleans nothing up
            touched.append(name)
            if len(touched) == 2 * at + 1:
                touched.append("dead")
                raise Killed
            result = real(*args, **kwargs)
            touched.append(name + " done")
            if len(touched) == 2 * at + 2:
                touched.append("dead")
                raise Killed
            return result

        return call

    monkeypatch.setattr(writer.os, "fsync", dying("fsync", os.fsync))
    monkeypatch.setattr(writer.os, "replace", dying("replace", os.replace))
    monkeypatch.setattr(writer.Path, "unlink", dying("unlink", writer.Path.unlink))
    monkeypatch.setattr(writer.SceneBuffer, "append", dying("append", writer.SceneBuffer.append))
    monkeypatch.setattr(writer, "canonical_json", dying("json", canonical_json))
    return touched


def test_kill_at_any_moment_leaves_a_readable_pair(tmp_path, monkeypatch):
    """Killed before or after each file operation, the target reads as the old scene or as the new one."""
    target = tmp_path / "box.kinefab"
    kinefab.export(box_scene(0.1), target)
    seen, deaths = set(), 0
    for at in range(40):
        kinefab.export(box_scene(0.1), target)
        with monkeypatch.context() as patch:
            touched = armed(patch, at)
            try:
                kinefab.export(box_scene(0.7), target)
            except Killed:
                deaths += 1
            died = "dead" in touched
        seen.add(size_in(target))
        assert size_in(target) in (0.1, 0.7)
        if not died:
            break
    assert deaths >= 10 and seen == {0.1, 0.7}
    assert sorted(p.suffix for p in tmp_path.iterdir()) == [".bin", ".kinefab"], (
        "nothing is left over after success"
    )


def test_failed_write_is_a_diagnostic_and_leaves_nothing(tmp_path, monkeypatch):
    """A full disk gives TARGET_UNWRITABLE; the old pair stands and no temporary file stays."""
    target = tmp_path / "box.kinefab"
    kinefab.export(box_scene(0.1), target)

    def full(descriptor):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(writer.os, "fsync", full)
    with pytest.raises(KinefabError) as caught:
        kinefab.export(box_scene(0.7), target)
    monkeypatch.undo()
    assert caught.value.diagnostics[0].code == "TARGET_UNWRITABLE"
    assert size_in(target) == 0.1 and len(list(tmp_path.iterdir())) == 2


@pytest.mark.parametrize("ending", [".kinefab", ".glb", pytest.param(".usda", marks=libraries.usd)])
def test_a_name_too_long_is_said_to_be(tmp_path, ending):
    """249 bytes, of which 120 letters take two: a file system's 255 leave no room for what stands beside it meanwhile."""
    name = "ü" * 120 + "x" * (249 - 240 - len(ending)) + ending
    with pytest.raises(KinefabError) as caught:
        kinefab.export(box_scene(0.1), tmp_path / name)
    (found,) = caught.value.diagnostics
    assert found.code == "TARGET_UNWRITABLE"
    assert "249 bytes" in found.message and "shorter" in found.message
    assert list(tmp_path.iterdir()) == []


def test_missing_folder_is_a_diagnostic(tmp_path):
    """A target in a folder that is not there is refused by name."""
    with pytest.raises(KinefabError) as caught:
        kinefab.export(box_scene(0.1), tmp_path / "none" / "box.kinefab")
    assert caught.value.diagnostics[0].code == "TARGET_UNWRITABLE"


def test_buffers_of_other_scenes_are_left_alone(tmp_path):
    """Clean-up takes the target's old buffers only, not a neighbour's whose name begins alike."""
    kinefab.export(box_scene(0.1), tmp_path / "box.kinefab")
    kinefab.export(box_scene(0.2), tmp_path / "box.kinefab.kinefab")
    kinefab.export(box_scene(0.3), tmp_path / "box.kinefab")
    assert size_in(tmp_path / "box.kinefab.kinefab") == 0.2
    assert len(list(tmp_path.iterdir())) == 4


def test_scene_without_meshes_has_no_buffer(tmp_path):
    """An assembly of frames alone is one file."""
    scene = kinefab.Scene()
    scene.add_assembly("Empty")
    result = kinefab.export(scene, tmp_path / "empty.kinefab")
    assert len(result.files) == 1 and "buffers" not in read(result.path)
    assert [p.name for p in tmp_path.iterdir()] == ["empty.kinefab"]


def test_large_meshes_use_32_bit_indices(tmp_path):
    """Above 65,535 vertices the index format is uint32, and indices survive."""
    shape = trimesh.creation.box()
    for _ in range(7):
        shape = shape.subdivide()
    scene = kinefab.Scene()
    scene.add_part("Cube", shape)
    options = kinefab.ExportOptions(smooth=None)  # normals of hard edges would split its vertices
    result = kinefab.export(scene, tmp_path / "cube.kinefab", options)
    content = read(result.path)
    assert content["meshes"][0]["vertexCount"] > 65535 and content["meshes"][0]["indexFormat"] == "uint32"
    positions, faces = mesh_arrays(result.path, content, 0)
    assert np.array_equal(faces, shape.faces[:, [0, 2, 1]])


def test_json_is_plain_and_exact():
    """Floats read back the same, zero has no sign, and what is no number is refused."""
    values = [0.1, 1 / 3, 1e-9, 123456.789, 1e22]
    assert json.loads("".join(canonical_json({"x": values})))["x"] == values
    with pytest.raises(ValueError):
        "".join(canonical_json({"x": float("nan")}))


def test_file_has_one_line_for_each_component(tmp_path):
    """A reader of a diff sees one component change at a time."""
    text = kinefab.export(lid_scene(), tmp_path / "lid.kinefab").path.read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if '"type": ' in line]
    components = sum(len(entry.get("components", ())) for entry in json.loads(text)["gameObjects"])
    assert len(lines) == components > 5 and all(line.count('"type": ') == 1 for line in lines)
    assert not re.search(r"-0(\.0*)?[],} ]", text)


@pytest.mark.posix  # needs named pipes
def test_target_that_is_no_regular_file_stays_what_it_is(tmp_path):
    """A rename would put a file in a device's place: /dev/null must survive an export by root."""
    target = tmp_path / "pipe.kinefab"
    os.mkfifo(target)
    with pytest.raises(KinefabError) as refused:
        kinefab.export(lid_scene(), target)
    assert [found.code for found in refused.value.diagnostics] == ["TARGET_UNWRITABLE"]
    assert not target.is_file() and list(tmp_path.iterdir()) == [target]


@pytest.mark.posix  # Windows cannot lock a folder
def test_two_exports_to_one_target_leave_a_whole_pair(tmp_path, monkeypatch):
    """A second export that comes between the first one's buffer and scene neither takes nor loses a buffer."""
    target = tmp_path / "box.kinefab"
    second = threading.Thread(target=lambda: kinefab.export(box_scene(0.7), target))
    rename = os.replace

    def interrupted(source, destination):
        if os.fspath(destination) == os.fspath(target) and second.ident is None:
            second.start()
            second.join(1.0)  # time enough to do harm; with a lock it waits
        rename(source, destination)

    monkeypatch.setattr(writer.os, "replace", interrupted)
    kinefab.export(box_scene(0.4), target)
    second.join()
    assert size_in(target) == 0.7
    assert len(list(tmp_path.iterdir())) == 2


def test_a_document_that_no_json_can_hold_leaves_nothing(tmp_path):
    """The text is made before the buffer takes its place: what refuses it leaves the old pair alone."""
    target = tmp_path / "box.kinefab"
    kinefab.export(box_scene(0.1), target)
    names = sorted(tmp_path.iterdir())
    broken = box_scene(0.7)
    broken.extras = {"x": float("nan")}
    with pytest.raises(ValueError):
        kinefab.export(broken, target)
    assert sorted(tmp_path.iterdir()) == names and size_in(target) == 0.1


def test_a_disk_that_is_full_at_the_scene_leaves_no_buffer(tmp_path, monkeypatch):
    """The buffer takes its place only once the scene is on the disk too."""
    target, fsync, seen = tmp_path / "box.kinefab", os.fsync, []

    def full(descriptor):
        seen.append(descriptor)
        if len(seen) == 2:
            raise OSError(28, "No space left on device")
        fsync(descriptor)

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(KinefabError):
        kinefab.export(box_scene(0.7), target)
    assert len(seen) == 2 and list(tmp_path.iterdir()) == []
