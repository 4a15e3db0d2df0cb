"""An export of a prefab killed before each call to the file system, one after the other: what is there then, and what comes after."""

from __future__ import annotations

import os
import re
import shutil
import signal
import sys
import unicodedata
from dataclasses import replace
from pathlib import Path

import kinefab
import pytest
import trimesh
from kinefab.targets.prefab import manifest, moment
from kinefab.targets.prefab.manifest import MANIFEST
from kinefab.targets.prefab.text.yaml import HEADER

pytestmark = pytest.mark.posix
CALLS = (
    "open",
    "os.rename",
    "os.remove",
    "os.mkdir",
    "os.rmdir",
    "os.link",
    "shutil.copyfile",
    "ctypes.dlsym",
)
"""Audit events of what changes files; the last stands before the exchange of two folders, which has none of its own."""
THEIRS = {"Robot/notes.txt": b"mine", "Robot/Own/deep/a.txt": b"too", "other.prefab": b"x"}


def machine(*names: str, length: float) -> kinefab.Scene:
    scene = kinefab.Scene()
    for i, name in enumerate(names):
        box = trimesh.creation.box((0.1, length * (i + 2), 0.3))
        scene.add_part(name, box, translation=(i * length, 0, 0), grounded=i == 0)
    return scene


def old_machine() -> kinefab.Scene:
    return machine("Base", "Arm", "Gone", length=0.1)


def new_machine() -> kinefab.Scene:
    return machine("Base", "Arm", "Came", length=0.2)


def kept(folder: Path) -> dict[str, bytes]:
    """What Unity sees, and what is somebody's."""
    found: dict[str, bytes] = {}
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder).as_posix()
        if path.is_file() and not any(part.startswith(".") for part in name.split("/")):
            found[name] = path.read_bytes()
    return found


def hidden(folder: Path) -> list[str]:
    found = [p.relative_to(folder).as_posix() for p in folder.rglob(".*")]
    return [name for name in found if name != f"Robot/{MANIFEST}"]


def changes(event: str, arguments: tuple, folder: Path) -> bool:
    if event not in CALLS:
        return False
    if event == "open" and not (
        isinstance(arguments[2], int) and arguments[2] & (os.O_WRONLY | os.O_RDWR | os.O_CREAT)
    ):
        return False
    if event == "ctypes.dlsym":
        return True
    return any(isinstance(a, (str, bytes, os.PathLike)) and str(folder) in os.fsdecode(a) for a in arguments)


def killed_before(
    number: int, scene: kinefab.Scene, folder: Path, exchanges: bool, interrupted: bool = False
) -> bool:
    """Export in a process that is killed before its call of that number; False where it had fewer and came to its end.

    interrupted: by Ctrl+C instead, after which it still runs what it has to run at its end.
    """
    child = os.fork()
    if child:
        _, status = os.waitpid(child, 0)
        assert os.WIFSIGNALED(status) or os.WEXITSTATUS(status) in (0, 130)
        return status != 0
    seen = 0

    def hook(event: str, arguments: tuple) -> None:
        nonlocal seen
        if changes(event, arguments, folder):
            seen += 1
            if seen == number and interrupted:
                raise KeyboardInterrupt
            if seen == number:
                os.kill(os.getpid(), signal.SIGKILL)

    try:
        if not exchanges:
            moment.exchanged = lambda first, second: False
        sys.addaudithook(hook)
        kinefab.export(scene, folder / "Robot.prefab")
    except KeyboardInterrupt:
        os._exit(130)
    except BaseException:
        os._exit(1)
    os._exit(0)


def assert_whole(files: dict[str, bytes]) -> None:
    """Each asset has its meta and each meta its asset, no guid is there twice, and the prefab refers to none that is not."""
    guids: dict[str, str] = {}
    for name, data in files.items():
        if name.endswith(".meta"):
            guid = re.search(r"^guid: ([0-9a-f]{32})$", data.decode(), re.MULTILINE)[1]
            assert guid not in guids, (name, guids[guid])
            guids[guid] = name
    own = {name for name in files if name not in THEIRS and not name.endswith(".meta")}
    assert {f"{name}.meta" for name in own} <= files.keys()
    prefab = files["Robot.prefab"].decode()
    assert prefab.startswith(HEADER)
    for guid, kind in re.findall(r"guid: ([0-9a-f]{32}), type: (\d)", prefab):
        assert kind != "2" or guid in guids, "it refers to an asset that is not there"


@pytest.fixture(scope="module")
def sets(tmp_path_factory) -> dict[str, Path]:
    """Folders with the old machine and with the new one, each beside files of somebody else's."""
    found = {}
    for name, scene in (("old", old_machine()), ("new", new_machine())):
        found[name] = folder = tmp_path_factory.mktemp(name)
        for path, data in THEIRS.items():
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_bytes(data)
        kinefab.export(scene, folder / "Robot.prefab")
    assert kept(found["old"])["Robot.prefab"] != kept(found["new"])["Robot.prefab"]
    assert "Robot/Meshes/Gone.asset" in kept(found["old"]) and "Robot/Meshes/Came.asset" in kept(found["new"])
    return found


@pytest.mark.parametrize("interrupted", [False, True], ids=["killed", "interrupted"])
@pytest.mark.parametrize("exchanges", [True, False])
def test_killed_before_any_call_nothing_dangles_and_the_next_export_ends_it(
    tmp_path, sets, exchanges, interrupted
):
    """Where the system exchanges folders there is the old set or the new one; between folder and prefab, which no system
    renames in one step, the old prefab over the assets of both."""
    old, new = kept(sets["old"]), kept(sets["new"])
    between, stages = 0, set()
    for number in range(1, 1000):
        folder = tmp_path / str(number)
        shutil.copytree(sets["old"], folder)
        alive = not killed_before(number, new_machine(), folder, exchanges, interrupted)
        files = kept(folder)
        assert all(files[name] == data for name, data in THEIRS.items())
        if files["Robot.prefab"] == old["Robot.prefab"] and files != old:
            between += 1
            assert_whole(files)
            assert old.keys() <= files.keys() <= old.keys() | new.keys()
            assert all(data in (old.get(n), new.get(n)) for n, data in files.items())
            if exchanges:
                assert files == {**old, **new, "Robot.prefab": old["Robot.prefab"]}
        elif files["Robot.prefab"] != old["Robot.prefab"]:
            assert_whole(files)
            assert {n: files.get(n) for n in new} == new
            assert files.keys() - new.keys() <= old.keys()  # that refer to nothing and go next
        stages.add((files["Robot.prefab"] == new["Robot.prefab"], files in (old, new)))
        if alive:
            assert files == new and hidden(folder) == []
            break
        # The next export, even one that fails, ends what was begun; one that succeeds is as if nothing had been.
        if files == old and number % 8:
            shutil.rmtree(folder)
            continue  # seldom: it is one moment, before anything is in place
        failing = shutil.copytree(folder, tmp_path / f"failing {number}")
        with pytest.MonkeyPatch.context() as patched:
            patched.setattr("kinefab.targets.prefab.folder._write_all", _full)
            with pytest.raises(kinefab.KinefabError):
                kinefab.export(old_machine(), failing / "Robot.prefab")
        assert kept(failing) in (old, new) and hidden(failing) == []
        kinefab.export(old_machine(), folder / "Robot.prefab")
        assert kept(folder) == old and hidden(folder) == []
        shutil.rmtree(folder), shutil.rmtree(failing)
    assert number >= 40 and between >= 1 and {(False, True), (True, True)} <= stages
    assert not exchanges or between == 1


def _full(*_):
    raise OSError(28, "No space left on device")


def test_killed_at_its_first_export_the_next_one_ends_it(tmp_path, sets):
    new = {n: d for n, d in kept(sets["new"]).items() if n not in THEIRS}
    for number in range(1, 1000):
        folder = tmp_path / str(number)
        folder.mkdir()
        alive = not killed_before(number, new_machine(), folder, True)
        files = kept(folder)
        assert all(files[n] == new[n] for n in files), "what is there is the new set's"
        assert "Robot.prefab" not in files or files == new
        kinefab.export(new_machine(), folder / "Robot.prefab")
        assert kept(folder) == new and hidden(folder) == []
        assert "Robot.meta" in manifest.read_manifest(folder / "Robot").files
        shutil.rmtree(folder)
        if alive:
            break
    assert number >= 30


@pytest.mark.parametrize(
    "pending",
    [
        {"staging": "../elsewhere", "leaving": ["../outside.txt", "/etc/none", "other.prefab", 5]},
        {"staging": ".", "leaving": ["Robot/../other.prefab"]},
        {"staging": 5, "leaving": None},
        [],
    ],
)
def test_a_manifest_that_was_edited_leads_nowhere_else(tmp_path, sets, pending):
    import json

    folder = shutil.copytree(sets["old"], tmp_path / "project")
    (tmp_path / "outside.txt").write_text("theirs")
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "Robot.prefab").write_text("theirs")
    path = folder / "Robot" / MANIFEST
    content = json.loads(path.read_text())
    path.write_text(json.dumps({**content, "pending": pending}))
    try:
        kinefab.export(new_machine(), folder / "Robot.prefab")
    except kinefab.KinefabError as refused:
        assert {d.code for d in refused.diagnostics} == {
            "TARGET_FILE_FOREIGN"
        }  # it does not say any more what is ours
    assert (tmp_path / "outside.txt").read_text() == "theirs"
    assert (tmp_path / "elsewhere" / "Robot.prefab").read_text() == "theirs"
    assert all((folder / n).read_bytes() == d for n, d in THEIRS.items())


def test_a_file_system_that_lists_accents_apart_loses_no_asset(tmp_path, monkeypatch):
    """HFS+, which cannot exchange folders either."""
    (tmp_path / "Robot").mkdir()
    (tmp_path / "Robot/notes.txt").write_text("mine")
    walk = os.walk

    def apart(top, *args, **options):
        for where, folders, names in walk(top, *args, **options):
            yield where, folders, [unicodedata.normalize("NFD", name) for name in names]

    monkeypatch.setattr(moment, "exchanged", lambda *_: False)
    monkeypatch.setattr(os, "walk", apart)
    kinefab.export(machine("Gerät", "Arm", length=0.1), tmp_path / "Robot.prefab")
    monkeypatch.undo()
    assert (tmp_path / "Robot/Meshes/Gerät.asset").is_file()
    assert_whole(kept(tmp_path))


def test_a_renamed_part_takes_its_guid_along(tmp_path):
    """Its mesh's file has another name and the same guid: at no moment are there two of that."""

    def scene(name: str) -> kinefab.Scene:
        found = machine("Base", "Arm", length=0.1)
        found.meshes[1] = replace(found.meshes[1], name=name)
        return found

    source = tmp_path / "first"
    source.mkdir()
    kinefab.export(scene("Arm"), source / "Robot.prefab")
    before = kept(source)
    for number in range(1, 1000):
        folder = shutil.copytree(source, tmp_path / str(number))
        alive = not killed_before(number, scene("Lever"), folder, True)
        files = kept(folder)
        assert_whole(files)
        if alive:
            break
    guid = lambda data: data.split(b"guid: ")[1][:32]  # noqa: E731
    assert guid(files["Robot/Meshes/Lever.asset.meta"]) == guid(before["Robot/Meshes/Arm.asset.meta"])
    assert "Robot/Meshes/Arm.asset" not in files
