"""A scene and its buffer in one file: the same scene as two files, and every damage of it said."""

from __future__ import annotations

import json
import random
import struct
from pathlib import Path

import kinefab
import pytest
from golden import golden_pairs
from kinefab.unity.container import JSON, chunks_of, write_container
from kinefab.diagnostics import KinefabError
from kinefab.unity.back.scene_file import read_scene
from kinefab.views.overview import overview, picture

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
LEVER = FIXTURES / "lever" / "lever.bundle.json"
BOX = FIXTURES / "hinge_slider_zup" / "hinge_slider.bundle.json"


def exported(source: Path, folder: Path, container: str, name: str = "scene") -> Path:
    folder.mkdir(exist_ok=True)
    options = kinefab.ExportOptions(writing={"container": container})
    return kinefab.export(source, folder / f"{name}.kinefab", options).path


def read(path: Path) -> tuple[dict, list[bytes]]:
    document, buffers = read_scene(path)
    return dict(document), buffers


def text_of(path: Path) -> bytes:
    return bytes(chunks_of(path.read_bytes())[0])


def test_header_and_chunks_stand_as_the_specification_says(tmp_path):
    path = exported(LEVER, tmp_path, "binary")
    content = path.read_bytes()
    magic, version, length, size, kind = struct.unpack_from("<4sIII4s", content)
    assert (magic, version, length, kind) == (b"KFAB", 1, len(content), b"JSON")
    assert size % 4 == 0 and content[20 + size - 4 : 20 + size].rstrip(b" ").endswith(b"\n")
    document = json.loads(content[20 : 20 + size])
    assert document["version"] == "1.1" and "uri" not in document["buffers"][0]
    held, kind = struct.unpack_from("<I4s", content, 20 + size)
    assert kind == b"BIN\0" and 28 + size + held == length
    assert 0 <= held - document["buffers"][0]["byteLength"] < 4
    assert sorted(path.parent.iterdir()) == [path]


@pytest.mark.parametrize("source", [bundle for bundle, _ in golden_pairs()][::7] + [LEVER], ids=lambda p: p.name)
def test_one_file_holds_what_two_files_hold(source, tmp_path):
    two, one = (read(exported(source, tmp_path / kind, kind)) for kind in ("text", "binary"))
    assert two[1] == one[1]
    for document in (two[0], one[0]):
        document.pop("version")
        for buffer in document.get("buffers", ()):
            buffer.pop("uri", None)
    assert two[0] == one[0]


def test_every_reader_takes_both(tmp_path):
    text, binary = (exported(LEVER, tmp_path / kind, kind) for kind in ("text", "binary"))
    assert overview(text, False) == overview(binary, False)
    assert picture(text) == picture(binary)
    pages = [kinefab.view(path, tmp_path / "page.html").read_text("utf-8") for path in (text, binary)]
    assert pages[0] == pages[1]
    assert kinefab.motion(text).parts == kinefab.motion(binary).parts
    again = [exported(path, tmp_path / "again", "text") for path in (text, binary)]
    assert again[0].read_bytes() == again[1].read_bytes() == text.read_bytes()
    back = exported(text, tmp_path / "back", "binary")
    assert back.read_bytes() == binary.read_bytes()


def test_one_file_in_the_place_of_two_leaves_no_buffer_behind(tmp_path):
    exported(LEVER, tmp_path, "text")
    assert len(list(tmp_path.iterdir())) == 2
    path = exported(LEVER, tmp_path, "binary")
    assert list(tmp_path.iterdir()) == [path]
    exported(LEVER, tmp_path, "text")
    assert len(list(tmp_path.iterdir())) == 2 and not path.read_bytes().startswith(b"KFAB")


def demand_refused(path: Path, content: bytes, *codes: str) -> None:
    """With one finding, whose code is one of these."""
    path.write_bytes(content)
    with pytest.raises(KinefabError) as error:
        read(path)
    (found,) = error.value.diagnostics
    assert found.code in codes


def test_cut_off_at_every_byte_it_is_refused(tmp_path):
    content = exported(BOX, tmp_path, "binary").read_bytes()
    path = tmp_path / "cut.kinefab"
    for length in range(len(content)):
        codes = ("CONTAINER_INVALID",) if length >= 4 else ("SCENE_EMPTY", "FORMAT_MISSING")
        demand_refused(path, content[:length], *codes)
    demand_refused(path, content + b"\0", "CONTAINER_INVALID")


def chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack("<I4s", len(data), kind) + data


def container(*chunks: bytes, version: int = 1) -> bytes:
    body = b"".join(chunks)
    return struct.pack("<4sII", b"KFAB", version, 12 + len(body)) + body


SCENE = b'{"format": "kinefab.scene", "version": "1.1", "gameObjects": [{"id": "A", "name": "A"}]}    '
BUFFER = b'{"byteLength": 4, "sha256": "%s"}' % (b"0" * 64)
PADDING = b" " * (-len(BUFFER + b', "buffers": []') % 4)


@pytest.mark.parametrize(
    "content, code",
    [
        (container(chunk(JSON, SCENE), version=2), "CONTAINER_VERSION_UNSUPPORTED"),
        (container(chunk(JSON, SCENE[:-1])), "CONTAINER_INVALID"),
        (container(chunk(b"BIN\0", b"1234"), chunk(JSON, SCENE)), "CONTAINER_INVALID"),
        (container(chunk(JSON, SCENE), chunk(JSON, SCENE)), "CONTAINER_INVALID"),
        (container(chunk(JSON, SCENE), chunk(b"BIN\0", b""), chunk(b"BIN\0", b"")), "CONTAINER_INVALID"),
        (container(), "CONTAINER_INVALID"),
        (container(chunk(JSON, SCENE), b"\0\0\0\0"), "CONTAINER_INVALID"),
        (container(struct.pack("<I4s", 0xFFFFFFFC, JSON) + SCENE), "CONTAINER_INVALID"),
        (container(chunk(JSON, SCENE.replace(b'"1.1"', b'"1.1", "buffers": [%s]' % BUFFER) + PADDING)), "BUFFER_MISSING"),
    ],
    ids=["version", "unaligned", "order", "text twice", "buffer twice", "empty", "half a head", "too long", "no buffer"],
)  # fmt: skip
def test_each_damage_of_a_container_is_told(content, code, tmp_path):
    demand_refused(tmp_path / "scene.kinefab", content, code)


def test_chunks_of_a_later_version_are_stepped_over(tmp_path):
    path = tmp_path / "scene.kinefab"
    path.write_bytes(container(chunk(JSON, SCENE), chunk(b"NEWS", b"1234"), chunk(b"NEWS", b"5678")))
    assert read(path)[0]["gameObjects"] == [{"id": "A", "name": "A"}]


def test_a_buffer_without_a_name_beside_a_text_is_refused(tmp_path):
    content = text_of(exported(BOX, tmp_path, "binary"))
    demand_refused(tmp_path / "text.kinefab", content, "BUFFER_MISSING")


def test_bytes_turned_at_random_are_refused_or_read_never_an_exception(tmp_path):
    content, path = exported(BOX, tmp_path, "binary").read_bytes(), tmp_path / "bad.kinefab"
    dice = random.Random(37)
    for _ in range(400):
        bad = bytearray(content)
        for _ in range(dice.randint(1, 4)):
            bad[dice.randrange(len(bad) if dice.random() < 0.7 else 40)] = dice.randrange(256)
        path.write_bytes(bad)
        for reading in (read, overview_of):
            try:
                reading(path)
            except KinefabError as error:
                assert error.diagnostics


def overview_of(path: Path) -> str:
    return overview(path, True)


def test_a_file_that_its_header_cannot_count_is_not_written(tmp_path, monkeypatch):
    monkeypatch.setattr("kinefab.unity.container.MOST_BYTES", 1000)
    with pytest.raises(KinefabError) as error:
        exported(LEVER, tmp_path, "binary")
    assert error.value.diagnostics[0].code == "TARGET_UNWRITABLE"
    assert list(tmp_path.iterdir()) == []


def test_a_text_of_four_bytes_more_needs_no_padding(tmp_path):
    with (tmp_path / "file").open("w+b") as file:
        write_container(file, [b"{}", b"\n "], None)
    assert chunks_of((tmp_path / "file").read_bytes()) == (b"{}\n ", None)
