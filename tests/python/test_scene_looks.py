"""Textures in a scene file: the same bytes whoever writes it, and image files as they are."""

from __future__ import annotations

import importlib.util
import struct
import zlib
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import kinefab
from kinefab.model import Body, Surface, Texture
from kinefab.unity.back.scene_file import read_scene
from scenes import BOX

SCRIPT = Path(__file__).resolve().parents[2] / "fixtures" / "make_signboard.py"
ONE_FILE = kinefab.ExportOptions(writing={"container": "binary"})


def signboard() -> ModuleType:
    spec = importlib.util.spec_from_file_location(SCRIPT.stem, SCRIPT)
    assert spec is not None and spec.loader is not None
    made = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(made)
    return made


def undecodable(fill: int) -> bytes:
    """A PNG of 8-bit grey whose pixels are no deflate stream."""
    parts = ((b"IHDR", struct.pack(">IIBBBBB", 8, 8, 8, 0, 0, 0, 0)), (b"IDAT", bytes([fill]) * 1000), (b"IEND", b""))
    chunks = (struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)) for kind, data in parts)
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunks)


def test_a_scene_with_every_texture_has_the_bytes_that_stand_in_the_repository(tmp_path):
    """C# saves the same scene to the same bytes (``SceneSavingTests``); so does what it is read and written again."""
    maker = signboard()
    files = maker.write(tmp_path)
    assert [path.read_bytes() for path in files] == [(maker.FOLDER / path.name).read_bytes() for path in files]
    (tmp_path / "again").mkdir()
    again = kinefab.export(files[0], tmp_path / "again" / files[0].name).files
    assert [path.read_bytes() for path in again] == [path.read_bytes() for path in files]


def test_a_hundred_images_that_no_decoder_knows_are_carried_as_they_are(tmp_path):
    """Their chunks are sound, what is in them is not: nobody makes a picture of it."""
    scene = kinefab.Scene()
    part = scene.add_part("Part", BOX, density=1000)
    images = [undecodable(i) for i in range(100)]
    scene.surfaces[:] = [Surface(f"s{i}", color_texture=Texture(f"{i}.png", data=data)) for i, data in enumerate(images)]
    bodies = tuple(Body(f"b{i}", 0, (i,)) for i in range(100))
    scene.nodes[part] = replace(scene.nodes[part], bodies=bodies)
    first = kinefab.export(scene, tmp_path / "first.kinefab", ONE_FILE).path
    again = kinefab.export(first, tmp_path / "again.kinefab", ONE_FILE).path
    assert again.read_bytes() == first.read_bytes()
    document, (buffer,) = read_scene(first)
    places = [(entry["data"]["offset"], entry["byteLength"]) for entry in document["images"]]
    assert [bytes(buffer[at : at + length]) for at, length in places] == images
