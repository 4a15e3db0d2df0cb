"""Files that mean harm: references that lead elsewhere, names that are links, archives that grow, pipes that never end."""

from __future__ import annotations

import base64
import json
import os
import struct
import subprocess
import sys
import zipfile
from dataclasses import replace
from pathlib import Path

import kinefab
import pytest
from kinefab import replacing
from kinefab.diagnostics import Report
from kinefab.geometry.files import read_mesh_file
from kinefab.geometry.references import UnsafeReference, demand_honest_archive, read_reference
from scenes import lid_scene

TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
SECRET = "newmtl secret\nKd 0.25 0.5 0.75\n"
posix = pytest.mark.skipif(os.name == "nt", reason="links and pipes of Unix")


def colors(path: Path) -> tuple[list, set[str]]:
    report = Report()
    found = read_mesh_file(path, report, "here")
    assert found is not None
    return [s.color for s in found.surfaces.values()], {d.code for d in report.diagnostics}


def test_modules_beside_a_user_s_files_are_not_run(tmp_path):
    """What reads and what converts starts in the working folder, where modules may lie that came with somebody's files."""
    folder, program = tmp_path / "files", tmp_path / "program" / "asks.py"
    folder.mkdir()
    program.parent.mkdir()
    for name in ("numpy", "json", "pickle"):
        (folder / f"{name}.py").write_text("open('was run', 'w').close()\n")
    program.write_text(
        "import kinefab\n"
        "from kinefab.sources.guard import guarded\n"
        "print(*guarded('os', 'listdir', '.', seconds=60))\n"
        "print(kinefab.batch(['one.urdf'], 'out', jobs=1).counts)\n"
    )
    (folder / "one.urdf").write_text("<robot name='one'><link name='base'/></robot>")
    done = subprocess.run([sys.executable, program], cwd=folder, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert "one.urdf" in done.stdout and "{'written': 1}" in done.stdout
    assert not (folder / "was run").exists()


@posix
@pytest.mark.parametrize(
    "way", ["../secret.mtl", "{folder}/secret.mtl", "link.mtl", "%2e%2e/secret.mtl", "..\\secret.mtl"]
)
def test_a_material_library_out_of_the_folder_is_not_read(tmp_path, way):
    (tmp_path / "secret.mtl").write_text(SECRET)
    inside = tmp_path / "meshes"
    inside.mkdir()
    (inside / "link.mtl").symlink_to(tmp_path / "secret.mtl")
    (inside / "part.obj").write_text(f"mtllib {way.format(folder=tmp_path)}\nusemtl secret\n{TRIANGLE}")
    found, codes = colors(inside / "part.obj")
    assert found == [] and "MATERIALS_MISSING" in codes
    (inside / "own.mtl").write_text(SECRET)
    (inside / "part.obj").write_text(f"\nmtllib own.mtl\nusemtl secret\n{TRIANGLE}")
    assert colors(inside / "part.obj")[0] == [pytest.approx((0.05088, 0.21404, 0.52252, 1.0), abs=1e-5)]


@posix
@pytest.mark.parametrize("what", ["pipe", "device"])
def test_a_library_that_never_ends_is_not_waited_for(tmp_path, what):
    if what == "pipe":
        os.mkfifo(tmp_path / "lib.mtl")
    else:
        (tmp_path / "lib.mtl").symlink_to("/dev/zero")
    (tmp_path / "part.obj").write_text(f"\nmtllib lib.mtl\n{TRIANGLE}")
    assert "MATERIALS_MISSING" in colors(tmp_path / "part.obj")[1]


def gltf(uri: str, size: int) -> dict:
    """A triangle whose vertices stand in a buffer of their own."""
    return {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 4}]}],
        "buffers": [{"uri": uri, "byteLength": size}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
    }


@posix
def test_a_buffer_of_a_gltf_stays_in_its_folder(tmp_path):
    """A uri that names a file elsewhere would copy it into the scene's own buffer."""
    import numpy as np

    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], dtype="<f4").tobytes()
    (tmp_path / "secret.bin").write_bytes(points)
    inside = tmp_path / "meshes"
    inside.mkdir()
    (inside / "own.bin").write_bytes(points)
    for uri, expected in (
        ("own.bin", True),
        ("data:application/octet-stream;base64," + base64.b64encode(points).decode(), True),
        (str(tmp_path / "secret.bin"), False),
        ("../secret.bin", False),
        ("/dev/zero", False),
    ):
        (inside / "part.gltf").write_text(json.dumps(gltf(uri, len(points))))
        report = Report()
        found = read_mesh_file(inside / "part.gltf", report, "here")
        assert (found is not None) == expected, uri
        assert [d.code for d in report.diagnostics] == ([] if expected else ["GEOMETRY_UNREADABLE"])


@pytest.mark.parametrize("binary", [False, True])
@pytest.mark.parametrize(
    "change, says",
    [
        ({"accessors": [{"componentType": 5126, "count": 3_000_000_000, "type": "VEC3"}]}, "zeros without a buffer"),
        ({"nodes": [{"mesh": 0, "children": [1]}, {"mesh": 0, "children": [0]}]}, "stand in a circle"),
    ],
)  # fmt: skip
def test_a_small_gltf_takes_no_endless_memory_or_time(tmp_path, change, says, binary):
    points = b"\0" * 36
    uri = "data:application/octet-stream;base64," + base64.b64encode(points).decode()
    text = json.dumps(gltf(uri, 36) | change).encode()
    text += b" " * (-len(text) % 4)
    path = tmp_path / ("part.glb" if binary else "part.gltf")
    head = struct.pack("<4sIIII", b"glTF", 2, 20 + len(text), len(text), 0x4E4F534A)
    path.write_bytes(head + text if binary else text)
    report = Report()
    assert read_mesh_file(path, report, "here") is None
    assert [d.code for d in report.diagnostics] == ["GEOMETRY_UNREADABLE"]
    assert says in report.diagnostics[0].message


def test_an_archive_that_grows_beyond_measure_is_refused(tmp_path):
    with zipfile.ZipFile(tmp_path / "bomb.3mf", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("3D/3dmodel.model", b"\0" * 30_000_000)
    with pytest.raises(UnsafeReference, match="unpacks to 30000000 bytes"):
        demand_honest_archive(tmp_path / "bomb.3mf")
    report = Report()
    assert read_mesh_file(tmp_path / "bomb.3mf", report, "here") is None
    assert "unpacks to" in report.diagnostics[0].message


def test_a_large_reference_is_told_by_its_size(tmp_path):
    (tmp_path / "big.bin").write_bytes(b"x" * 100)
    assert len(read_reference(tmp_path, "big.bin", 100)) == 100
    with pytest.raises(UnsafeReference, match="at most 99"):
        read_reference(tmp_path, "big.bin", 99)


@posix
def test_a_link_where_a_temporary_file_would_stand_leads_nowhere(tmp_path, monkeypatch):
    """Even when its name is guessed: the file is made only where nothing stands."""
    victim = tmp_path / "victim"
    victim.write_text("mine")
    for name in (".x.kinefab.bin.tmp", ".x.kinefab.scene.tmp"):
        (tmp_path / name).symlink_to(victim)
    kinefab.export(lid_scene(), tmp_path / "x.kinefab")
    assert victim.read_text() == "mine"
    monkeypatch.setattr(replacing.secrets, "token_hex", lambda count: "0" * 16)
    (tmp_path / ".y.kinefab.scene.0000000000000000.tmp").symlink_to(victim)
    with pytest.raises(kinefab.KinefabError):
        kinefab.export(lid_scene(), tmp_path / "y.kinefab")
    assert victim.read_text() == "mine" and not (tmp_path / "y.kinefab").exists()


def test_what_killed_runs_left_goes_with_the_next_export(tmp_path):
    left = tmp_path / ".x.kinefab.bin.0123456789abcdef.tmp"
    other = tmp_path / ".x.kinefab.bin.tmp"
    left.write_text("half")
    other.write_text("not ours")
    kinefab.export(lid_scene(), tmp_path / "x.kinefab")
    assert not left.exists() and other.exists()


@posix
@pytest.mark.parametrize(
    "name, says", [("a:b", "':'"), ("a\\b", "'\\\\'"), ("a\tb", "control"), ("a\x85b", "control")]
)
def test_a_name_that_the_reader_would_refuse_is_not_written(tmp_path, name, says):
    with pytest.raises(kinefab.KinefabError) as caught:
        kinefab.export(lid_scene(), tmp_path / f"{name}.kinefab")
    assert caught.value.diagnostics[0].code == "TARGET_UNWRITABLE"
    assert says in caught.value.diagnostics[0].message and list(tmp_path.iterdir()) == []


@posix
@pytest.mark.parametrize(
    "command, ending",
    [
        *(("analyse", ending) for ending in (".csv", ".json", ".bundle.json", ".obj")),
        *(
            (command, ".kinefab")
            for command in ("inspect", "draw -o x.svg", "view -o x.html", "report -o x.html")
        ),
        ("capture --replay", ".json"),
    ],
)
def test_a_pipe_as_a_source_is_not_waited_for(tmp_path, command, ending):
    os.mkfifo(tmp_path / f"pipe{ending}")
    command = [sys.executable, "-m", "kinefab", *command.split(), str(tmp_path / f"pipe{ending}")]
    if "--replay" in command:
        command += ["-o", str(tmp_path / "r.bundle.json")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert done.returncode == 1 and "Traceback" not in done.stderr
    assert "regular file" in done.stderr or "FORMAT_UNKNOWN" in done.stderr


@posix
def test_a_pipe_in_the_place_of_a_scene_s_buffer_is_not_waited_for(tmp_path):
    path, buffer = kinefab.export(lid_scene(), tmp_path / "lid.kinefab").files
    buffer.unlink()
    os.mkfifo(buffer)
    command = [sys.executable, "-m", "kinefab", "draw", str(path), "-o", str(tmp_path / "lid.svg")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert done.returncode == 1 and "BUFFER_MISSING" in done.stderr and "regular file" in done.stderr


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no /dev/full here")
def test_a_full_disk_behind_stdout_is_a_sentence(tmp_path):
    path = kinefab.export(lid_scene(), tmp_path / "lid.kinefab").path
    with open("/dev/full", "w") as full:
        command = [sys.executable, "-m", "kinefab", "inspect", str(path)]
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, timeout=60)
    assert done.returncode == 1 and "Traceback" not in done.stderr and "Exception" not in done.stderr
    assert "No space left on device" in done.stderr


@posix
@pytest.mark.parametrize("closed", ["<&-", ">&-", "2>&-", "<&- >&- 2>&-"])
def test_closed_streams_end_in_no_traceback(tmp_path, closed):
    """As cron jobs and services start programs; what is written goes to the file that it is meant for."""
    path = kinefab.export(lid_scene(), tmp_path / "lid.kinefab").path
    kept, picture = path.read_bytes(), tmp_path / "lid.svg"
    for command in (f"inspect {path}", f"draw {path} -o {picture}"):
        done = subprocess.run(
            f"{sys.executable} -m kinefab {command} {closed}",
            shell=True,
            capture_output=True,
            text=True,
            timeout=60,
        )
        assert done.returncode == 0 and "Traceback" not in done.stderr + done.stdout
    assert path.read_bytes() == kept and picture.read_text("utf-8").rstrip().endswith("</svg>")


@posix
def test_a_reader_that_has_enough_ends_the_program_quietly(tmp_path):
    path = kinefab.export(lid_scene(), tmp_path / "lid.kinefab").path
    command = f"{sys.executable} -m kinefab inspect {path} | true"
    done = subprocess.run(command, shell=True, capture_output=True, text=True, timeout=60)
    assert "Traceback" not in done.stderr and "Exception" not in done.stderr


@pytest.mark.parametrize("given", [True, False])
@pytest.mark.parametrize(
    "mass, moment, density", [(1e-46, 1e-47, 1e-46), (3e42, 2e41, 2e43), (2.0, 5e39, 2e43)]
)
def test_a_mass_that_single_precision_has_no_number_for_is_refused(tmp_path, given, mass, moment, density):
    import numpy as np
    from kinefab.model import MassProperties

    scene = lid_scene()
    stated = MassProperties(mass, np.zeros(3), np.eye(3) * moment)
    bodies = tuple(replace(body, density=density) for body in scene.nodes[1].bodies)
    scene.nodes[1] = replace(scene.nodes[1], mass=stated if given else None, bodies=bodies)
    with pytest.raises(kinefab.KinefabError) as caught:
        kinefab.export(scene, tmp_path / "light.kinefab")
    assert {d.code for d in caught.value.diagnostics} == {"MASS_IMPOSSIBLE"}
