"""The packed stream of a package: any gzip reads it, and threads change nothing in it."""

from __future__ import annotations

import gzip
import io
import random
import subprocess
import tarfile
import zlib

import kinefab
import pytest
import trimesh
from kinefab.targets import packing
from kinefab.targets.packing import BLOCK, GzipStream


def packed(pieces: list[bytes], threads: int, monkeypatch: pytest.MonkeyPatch) -> bytes:
    monkeypatch.setattr(packing.os, "cpu_count", lambda: threads)
    out = io.BytesIO()
    with GzipStream(out, "archtemp.tar") as stream:
        for piece in pieces:
            stream.write(piece)
        stream.finish()
    return out.getvalue()


def noise(size: int) -> bytes:
    return random.Random(7).randbytes(size // 2).hex().encode()


@pytest.mark.parametrize(
    "pieces",
    [
        [],
        [b""],
        [b"short"],
        [b"x" * BLOCK],
        [b"ab" * BLOCK, b"c"],
        [noise(3 * BLOCK), b"m_Name: x\n" * BLOCK, noise(100)],
    ],
    ids=["nothing", "empty", "short", "one block", "blocks and a rest", "noise and text"],
)
def test_one_member_that_holds_what_was_appended(pieces, monkeypatch):
    found = packed(pieces, 1, monkeypatch)
    whole = b"".join(pieces)
    assert gzip.decompress(found) == whole
    one = zlib.decompressobj(31)
    assert one.decompress(found) == whole and one.eof and not one.unused_data
    assert packed(pieces, 7, monkeypatch) == found
    assert packed([whole[i : i + 12345] for i in range(0, len(whole), 12345)], 2, monkeypatch) == found


def test_hexadecimal_noise_takes_half_and_text_far_less(monkeypatch):
    """Four bits for a digit, where no repeat can be found; and where there are repeats they are searched for."""
    assert len(packed([noise(2 * BLOCK)], 2, monkeypatch)) < 1.1 * BLOCK
    assert (
        len(packed([b"  m_LocalScale: {x: 1, y: 1, z: 1}\n" * (BLOCK // 20)], 2, monkeypatch)) < BLOCK // 50
    )


def test_gzip_and_tar_themselves_read_a_package(tmp_path):
    """A package of several blocks: GNU's tools find no fault, and its tar ends as tars end."""
    scene = kinefab.Scene()
    scene.add_part("Ball", trimesh.creation.icosphere(6))
    path = tmp_path / "Ball.unitypackage"
    kinefab.export(scene, path)
    inner = gzip.decompress(path.read_bytes())
    assert len(inner) > 2 * BLOCK and len(inner) % tarfile.RECORDSIZE == 0 and not any(inner[-1024:])
    listed = subprocess.run(["tar", "-tzf", str(path)], capture_output=True, text=True)
    assert listed.returncode == 0 and listed.stderr == ""
    with tarfile.open(path) as tar:
        assert sorted(name.rstrip("/") for name in listed.stdout.split()) == sorted(tar.getnames())
        assert all(entry.mtime == 0 for entry in tar)
