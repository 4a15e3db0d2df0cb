"""The files of a prefab in a folder of somebody's: ours come and go whole, theirs stay as they are."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import tarfile
import threading
from dataclasses import replace
from itertools import count
from pathlib import Path

import kinefab
import pytest
import trimesh
from kinefab.targets.prefab.manifest import MANIFEST
from kinefab.targets.prefab.text.metas import guid_in
from prefab_reader import read_prefab
from prefab_scenes import rich_scene


def box_scene(*names: str, size: float = 0.1) -> kinefab.Scene:
    scene = kinefab.Scene()
    for i, name in enumerate(names):
        mesh = trimesh.creation.box((size, size * (i + 2), size))
        scene.add_part(name, mesh, translation=(i, 0, 0), grounded=i == 0)
    return scene


def files(folder: Path) -> dict[str, bytes]:
    """Everything in a folder but the manifest."""
    found = sorted(p for p in folder.rglob("*") if p.is_file() and p.name != MANIFEST)
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in found}


def hidden(folder: Path) -> list[str]:
    return [p.name for p in folder.iterdir() if p.name.startswith(".")]


def test_a_second_export_removes_only_what_the_first_wrote(tmp_path):
    target = tmp_path / "Robot.prefab"
    kinefab.export(box_scene("Base", "Arm", "Hand"), target)
    theirs = {
        "Robot/notes.txt": b"mine",
        "Robot/Meshes/mine.asset": b"too",
        "Robot/Own/deep/a.txt": b"",
        "other.prefab": b"x",
    }
    for name, data in theirs.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(data)
    (tmp_path / "Robot" / "Empty").mkdir()
    (tmp_path / "Robot" / "link").symlink_to("notes.txt")
    before = files(tmp_path)
    kinefab.export(box_scene("Base", "Hand"), target)
    after = files(tmp_path)
    assert all(after[name] == data for name, data in theirs.items())
    assert (tmp_path / "Robot" / "Empty").is_dir() and os.readlink(tmp_path / "Robot" / "link") == "notes.txt"
    gone = before.keys() - after.keys()
    assert gone and all("Arm" in name for name in gone)
    fresh = tmp_path / "fresh"
    fresh.mkdir()
    kinefab.export(box_scene("Base", "Hand"), fresh / "Robot.prefab")
    ours = files(fresh)
    assert {k: v for k, v in after.items() if k in ours} == ours
    assert after.keys() - ours.keys() - theirs.keys() - {k for k in after if k.startswith("fresh")} == {
        "Robot/link"
    }
    assert hidden(tmp_path) == []


@pytest.mark.parametrize(
    "name", ["Meshes/Base.asset", "Meshes/BASE.asset", "Meshes/Base.asset.meta", "Materials"]
)
def test_a_file_of_theirs_in_the_way_is_told_and_kept(tmp_path, name):
    theirs = tmp_path / "Robot" / name
    theirs.parent.mkdir(parents=True)
    theirs.write_bytes(b"theirs")
    with pytest.raises(kinefab.KinefabError) as caught:
        kinefab.export(box_scene("Base", "Arm"), tmp_path / "Robot.prefab")
    (found,) = caught.value.diagnostics
    assert found.code == "TARGET_FILE_FOREIGN" and name in found.message
    assert files(tmp_path) == {f"Robot/{name}": b"theirs"} and hidden(tmp_path) == []


def test_what_a_package_brought_is_updated_in_place(tmp_path):
    """It leaves no manifest, as hidden files of a project may be lost; guids are Kinefab's own."""
    target = tmp_path / "Robot.prefab"
    kinefab.export(box_scene("Base", "Arm"), target)
    (tmp_path / "Robot" / MANIFEST).unlink()
    settings = tmp_path / "Robot" / "Meshes" / "Base.asset.meta"
    settings.write_bytes(settings.read_bytes() + b"timeCreated: 7\n")
    before = files(tmp_path)
    kinefab.export(box_scene("Base", "Hand", size=0.2), target)
    after = files(tmp_path)
    changed = {name for name in before if after[name] != before[name]}
    assert changed == {"Robot.prefab", "Robot/Meshes/Base.asset"}
    assert any("Hand" in name for name in after.keys() - before.keys())
    kinefab.export(box_scene("Base", "Hand", size=0.2), target)
    assert files(tmp_path) == after


@pytest.mark.posix
def test_a_link_in_place_of_the_folder_is_refused(tmp_path):
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "Robot").symlink_to("elsewhere")
    with pytest.raises(kinefab.KinefabError) as caught:
        kinefab.export(box_scene("Base"), tmp_path / "Robot.prefab")
    assert [d.code for d in caught.value.diagnostics] == ["TARGET_UNWRITABLE"]
    assert list((tmp_path / "elsewhere").iterdir()) == [] and not (tmp_path / "Robot.prefab").exists()


def test_their_folder_keeps_its_guid(tmp_path):
    """A folder that Unity knew before has a meta of Unity's."""
    (tmp_path / "Robot").mkdir()
    (tmp_path / "Robot.meta").write_text("fileFormatVersion: 2\nguid: 00000000000000000000000000000001\n")
    kinefab.export(box_scene("Base"), tmp_path / "Robot.prefab")
    kinefab.export(box_scene("Base"), tmp_path / "Robot.prefab")
    assert "00000001" in (tmp_path / "Robot.meta").read_text()


def test_their_prefab_keeps_its_guid(tmp_path):
    """Its content is what the user asked to replace; scenes refer to it by its meta."""
    meta = "fileFormatVersion: 2\nguid: 00000000000000000000000000000001\n"
    (tmp_path / "Robot.prefab").write_text("theirs")
    (tmp_path / "Robot.prefab.meta").write_text(meta)
    for _ in range(2):
        kinefab.export(box_scene("Base"), tmp_path / "Robot.prefab")
        assert (tmp_path / "Robot.prefab.meta").read_text() == meta
        assert (tmp_path / "Robot.prefab").read_text().startswith("%YAML")


def test_import_settings_that_people_changed_stay_with_the_asset(tmp_path):
    """Also when it moves to another path: guids are the assets' own."""
    target = tmp_path / "Robot.prefab"
    scene = box_scene("Base", "Arm")
    kinefab.export(scene, target)
    before = files(tmp_path)
    (mesh,) = (name for name in before if name.endswith("Arm.asset.meta"))
    for name, text in (("Robot.prefab.meta", "labels:\n- arm\n"), (mesh, "timeCreated: 7\n")):
        (tmp_path / name).write_bytes(before[name] + text.encode())
    changed = files(tmp_path)
    kinefab.export(scene, target)
    assert files(tmp_path) == changed
    scene.meshes[1] = replace(scene.meshes[1], name="Boom")
    kinefab.export(scene, target)
    after = files(tmp_path)
    moved = [name for name, data in after.items() if data == changed[mesh]]
    assert after["Robot.prefab.meta"] == changed["Robot.prefab.meta"] and len(moved) == 1 and moved[0] != mesh
    (tmp_path / moved[0]).write_bytes(b"guid: 0123456789abcdef0123456789abcdef\n")
    kinefab.export(scene, target)
    assert files(tmp_path)[moved[0]] == before[mesh]


@pytest.mark.posix
def test_a_link_of_theirs_in_place_of_an_asset_folder_is_told_and_kept(tmp_path):
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "a.txt").write_text("theirs")
    (tmp_path / "Robot").mkdir()
    (tmp_path / "Robot" / "Meshes").symlink_to("../elsewhere")
    with pytest.raises(kinefab.KinefabError) as caught:
        kinefab.export(box_scene("Base"), tmp_path / "Robot.prefab")
    assert [d.code for d in caught.value.diagnostics] == ["TARGET_FILE_FOREIGN"]
    assert os.readlink(tmp_path / "Robot" / "Meshes") == "../elsewhere"
    assert files(tmp_path) == {"elsewhere/a.txt": b"theirs"}


@pytest.mark.parametrize("suffix", [".prefab", ".unitypackage"])
def test_the_same_scene_gives_the_same_bytes(tmp_path, suffix):
    found = []
    for folder in (tmp_path / "a", tmp_path / "b"):
        folder.mkdir()
        kinefab.export(box_scene("Base", "Arm"), folder / f"Robot{suffix}")
        found.append(files(folder))
    assert found[0] == found[1]


def test_a_failure_on_the_way_leaves_the_old_set(tmp_path, monkeypatch):
    target = tmp_path / "Robot.prefab"
    kinefab.export(box_scene("Base"), target)
    before = files(tmp_path)
    from kinefab.targets.prefab import exporting

    def fails(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(exporting, "mesh_asset", fails)
    with pytest.raises(kinefab.KinefabError) as caught:
        kinefab.export(box_scene("Base", "Arm"), target)
    assert [d.code for d in caught.value.diagnostics] == ["TARGET_UNWRITABLE"]
    assert files(tmp_path) == before and hidden(tmp_path) == []


WRITER = """
import os
import signal
import sys
sys.path.insert(0, {tests!r})
import kinefab, test_prefab_folder
scene = test_prefab_folder.box_scene("Base", *"AB", size=0.2)
kinefab.export(scene, {elsewhere!r})  # what is imported late is imported now
touches = "open", "os.mkdir", "os.rename", "os.link", "os.remove", "os.rmdir", "shutil.rmtree", "ctypes.dlopen"
for line in sys.stdin:
    left = int(line)
    child = os.fork()
    if child == 0:
        def strike(event, arguments):
            global left
            if event in touches:
                left -= 1
                if left < 0:
                    os.kill(os.getpid(), signal.SIGKILL)
        sys.addaudithook(strike)
        kinefab.export(scene, {target!r})
        os._exit(0)
    print(os.waitpid(child, 0)[1], flush=True)
"""
"""Exports once for each line, and is killed before it touches the file system as often as the line says and once more."""


@pytest.mark.posix
@pytest.mark.parametrize("suffix", [".prefab", ".unitypackage"])
def test_killed_at_any_moment_the_old_set_or_the_new_one_is_there(tmp_path, suffix):
    place, kept, elsewhere = (tmp_path / name for name in ("place", "kept", "elsewhere"))
    place.mkdir()
    elsewhere.mkdir()
    target = place / f"Robot{suffix}"
    kinefab.export(box_scene("Base", *"AB", size=0.2), target)
    new = files(place)
    kinefab.export(box_scene("Base"), target)
    old = files(place)
    assert old != new
    place.rename(kept)
    seen: set[str] = set()
    code = WRITER.format(
        tests=str(Path(__file__).parent), elsewhere=str(elsewhere / target.name), target=str(target)
    )
    command = [sys.executable, "-c", code]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as writer:
        for touch in count():
            shutil.copytree(kept, place)
            print(touch, file=writer.stdin, flush=True)
            status = int(writer.stdout.readline())
            there = {name: data for name, data in files(place).items() if "/." not in f"/{name}"}
            # Between the folder's exchange and the prefab's rename the old prefab stands over the assets of both.
            between = suffix == ".prefab" and there == {**new, "Robot.prefab": old["Robot.prefab"]}
            seen.add("old" if there == old else "new" if there == new else "between" if between else "neither")
            kinefab.export(box_scene("Base"), target)
            assert files(place) == old and hidden(place) == []
            shutil.rmtree(place)
            if status == 0:
                break
            assert os.WTERMSIG(status) == signal.SIGKILL
    assert seen == {"old", "new", "between"} - ({"between"} if suffix == ".unitypackage" else set())


@pytest.mark.parametrize(
    "name",
    ["", ".hidden", "Robot~", "cvs", "CVS", "old.tmp", "Editor", "StreamingAssets", "arm.bundle", "a.Plugin"],
)
def test_a_folder_that_unity_does_not_import_is_refused(tmp_path, name):
    """The prefab's meshes would be missing without a word; a package names its prefab itself."""
    with pytest.raises(kinefab.KinefabError) as caught:
        kinefab.export(box_scene("Base"), tmp_path / f"{name}.prefab")
    assert [d.code for d in caught.value.diagnostics] == ["TARGET_UNWRITABLE"]
    assert list(tmp_path.iterdir()) == []
    kinefab.export(box_scene("Base"), tmp_path / f"{name}.unitypackage")
    with tarfile.open(tmp_path / f"{name}.unitypackage") as packed:
        paths = [packed.extractfile(m).read().decode() for m in packed if m.name.endswith("/pathname")]
    parts = {part.casefold() for path in paths for part in path.split("/")}
    assert not parts & {"cvs", "editor", "streamingassets", ""}
    assert not any(
        part.startswith(".") or part.endswith(("~", ".tmp", ".bundle", ".plugin")) for part in parts
    )


@pytest.mark.parametrize("name", ["Mein Röbot v1.2", "日本語", "Q#[x]", " lead", "x" * 200])
def test_a_name_with_blanks_dots_or_letters_of_any_script(tmp_path, name):
    target = tmp_path / f"{name}.prefab"
    first = files(kinefab.export(box_scene("Base", "Arm"), target).path.parent)
    read_prefab(target)
    kinefab.export(box_scene("Base"), target)
    assert set(files(tmp_path)) < set(first) and hidden(tmp_path) == []


@pytest.mark.posix
def test_two_prefabs_in_one_folder_leave_each_other_alone(tmp_path):
    kinefab.export(box_scene("Base", "Arm"), tmp_path / "A.prefab")
    before = files(tmp_path)
    kinefab.export(box_scene("Base", "Hand", "Tool"), tmp_path / "B.prefab")
    assert {n: d for n, d in files(tmp_path).items() if n in before} == before
    kinefab.export(box_scene("Wheel"), tmp_path / "A.prefab")
    read_prefab(tmp_path / "B.prefab"), read_prefab(tmp_path / "A.prefab")


@pytest.mark.posix
def test_exports_into_one_project_take_turns(tmp_path):
    """Else two at the same time, as a batch makes them, have one another's guids and bring the script each."""
    assets, options = tmp_path / "Assets", kinefab.ExportOptions(writing={"scripts": True})
    (assets / "A").mkdir(parents=True), (assets / "B").mkdir()
    scenes = [rich_scene(tmp_path), rich_scene(tmp_path)]
    other = threading.Thread(target=kinefab.export, args=(scenes[1], assets / "B/Robot.prefab", options))

    def meanwhile(stage: str, _: float) -> None:
        if stage == "write" and other.ident is None:
            other.start()
            other.join(1.5)

    kinefab.export(scenes[0], assets / "A/Robot.prefab", options, meanwhile)
    other.join()
    guids = [guid_in(path) for path in assets.rglob("*.meta")]
    assert len(guids) == len(set(guids)) and len(list(assets.rglob("*.cs"))) == 1
    read_prefab(assets / "A/Robot.prefab"), read_prefab(assets / "B/Robot.prefab")


def test_what_a_yaml_parser_takes_for_a_word_of_its_own_is_quoted(tmp_path):
    yaml = pytest.importorskip("yaml", reason="PyYAML is not installed")
    names = ["=", "<<", "- [a]: {b} #c", "@x", "it's", "\ufeffbom", "a\u2028b", "%", "!tag", "&a", "? x"]
    kinefab.export(box_scene(*names), tmp_path / "Robot.prefab")
    text = (tmp_path / "Robot.prefab").read_text("utf-8").replace("%TAG !u! tag:unity3d.com,2011:\n", "")
    lines = ["---" if line.startswith("--- ") else line for line in text.splitlines()]
    found = {
        entry["GameObject"]["m_Name"]
        for entry in yaml.safe_load_all("\n".join(lines) + "\n")
        if "GameObject" in entry
    }
    assert {n.replace("\u2028", "_") for n in names} <= found


@pytest.mark.parametrize(
    "name",
    ["CON", "nul", "Aux.v2", "com1", "a:b", "what?", "Robot.", "Robot ", "COM²", "conin$.x", "lpt1 .b"],
)
def test_a_prefab_has_no_name_that_windows_refuses(tmp_path, name):
    """A project is shared between systems; in a package the prefab gets another name."""
    scene = kinefab.Scene()
    scene.add_part("Part", trimesh.creation.box((1, 1, 1)))
    with pytest.raises(kinefab.KinefabError, match="Windows"):
        kinefab.export(scene, tmp_path / f"{name}.prefab")
    assert not list(tmp_path.iterdir())
    kinefab.export(scene, tmp_path / f"{name}.unitypackage")
    with tarfile.open(tmp_path / f"{name}.unitypackage") as tar:
        paths = [tar.extractfile(e).read().decode() for e in tar if e.name.endswith("/pathname")]
    (prefab,) = [path for path in paths if path.endswith(".prefab")]
    assert prefab.removeprefix("Assets/Kinefab/").removesuffix(".prefab") != name


def test_each_meta_is_read_once(tmp_path, monkeypatch):
    """Also where assets come and go: whose guid is whose is asked before anything is written."""
    target = tmp_path / "Robot.prefab"
    kinefab.export(box_scene("Base", "Arm", "Hand"), target)
    read, once = [], Path.read_text
    monkeypatch.setattr(Path, "read_text", lambda path, *a, **k: read.append(path) or once(path, *a, **k))
    kinefab.export(box_scene("Base", "Hand", "Foot"), target)
    metas = [path for path in read if path.suffix == ".meta"]
    assert len(metas) == len(set(metas)) >= 8


@pytest.mark.parametrize("length", [5, 120])
def test_long_names_fit_into_a_path_of_windows(tmp_path, length):
    """260 characters with the project's own path; names that begin alike stay apart, and each is what its file's object is called."""
    scene = rich_scene(tmp_path)
    begin = "A part with a name that somebody's script has put together, " * 5
    surfaces = [replace(s, name=f"{begin}{i}") for i, s in enumerate(scene.surfaces)]
    kinefab.export(replace(scene, surfaces=surfaces), tmp_path / f"{'x' * length}.unitypackage")
    with tarfile.open(tmp_path / f"{'x' * length}.unitypackage") as tar:
        files = {m.name: tar.extractfile(m).read() for m in tar if m.isfile()}
    paths = {n.partition("/")[0]: d.decode() for n, d in files.items() if n.endswith("/pathname")}
    assert max(map(len, paths.values())) + len(".meta") <= 205
    materials = {guid: Path(path).stem for guid, path in paths.items() if path.endswith(".mat")}
    cut = {name for name in materials.values() if name.startswith("A part with a name")}
    assert len(cut) == len(surfaces)
    for guid, name in materials.items():
        assert f"  m_Name: {name}\n" in files[f"{guid}/asset"].decode()
