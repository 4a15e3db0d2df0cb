"""The way into a written scene: its JSON and its buffers; checking it is ``dotnet kinefab validate``'s task."""

from __future__ import annotations

import errno
import hashlib
import json
import math
import re
from collections.abc import Generator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, cast

from ...diagnostics import KinefabError, Report, diagnostic
from ..container import Damaged, chunks_of, is_container


_HALF = re.compile(rb"\\u[dD][89a-fA-F]")


def read_scene_file(path: Path) -> Mapping[str, Any]:
    """The JSON of a scene.  Raises KinefabError when it is missing, broken, of another major version, or when an index
    in it leads nowhere: Python would count a negative one from the list's end."""
    try:
        text = _content(Path(path))
        if is_container(text):
            text = bytes(chunks_of(text)[0])
        content: Any = json.loads(text, parse_float=_number, parse_constant=_number)
        if _HALF.search(text):  # half of a surrogate pair is no text
            json.dumps(content, ensure_ascii=False).encode("utf-8")
    except FileNotFoundError:
        raise KinefabError([diagnostic("SOURCE_NOT_FOUND", path=path)]) from None
    except OSError as error:
        raise _unreadable(path, error.strerror) from error
    except RecursionError:
        raise _unreadable(path, "it is nested too deeply") from None
    except ValueError as error:
        raise _unreadable(path, error) from error
    if not isinstance(content, dict) or cast("dict[str, Any]", content).get("format") != "kinefab.scene":
        raise _unreadable(path, "it does not say it is a kinefab.scene")
    scene = cast("dict[str, Any]", content)
    version = str(scene.get("version", ""))
    if version.partition(".")[0] != "1":
        raise _unreadable(path, f"its version is {version}, not 1.x")
    with unsound_as_finding(path):
        _demand_references(scene, path)
    return scene


def _content(path: Path) -> bytes:
    """Of a regular file: a pipe may never end.  Raises OSError."""
    if path.exists() and not path.is_file():
        raise OSError(errno.EINVAL, "it is no regular file")
    return path.read_bytes()


def _number(text: str) -> float:
    """A number as JSON has it, where 0.0 is an index too, and NaN, Infinity and 1e999 are nothing."""
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"{text} is not a finite number")
    return int(value) if value.is_integer() and abs(value) < 2**31 else value


def _demand_references(scene: Mapping[str, Any], path: Path) -> None:
    """Raises KinefabError with every index that leads nowhere."""
    found = Report()
    objects = scene.get("gameObjects", [])

    def demand(index: object, name: str, pointer: str) -> None:
        count = len(scene.get(name, []))
        if index is not None and (type(index) is not int or not 0 <= index < count):
            found.add("REFERENCE_UNRESOLVED", f"{path}#{pointer}", list=name, index=index, count=count)

    for i, entry in enumerate(objects):
        parent = entry.get("parent")
        if parent is not None and (type(parent) is not int or not 0 <= parent < i):
            found.add("PARENT_NOT_EARLIER", f"{path}#/gameObjects/{i}/parent", parent=parent, index=i)
        for j, component in enumerate(entry.get("components", [])):
            place = f"/gameObjects/{i}/components/{j}"
            demand(component.get("connectedBody"), "gameObjects", f"{place}/connectedBody")
            demand(component.get("mesh"), "meshes", f"{place}/mesh")
            demand(component.get("material"), "physicsMaterials", f"{place}/material")
            for k, material in enumerate(component.get("materials", [])):
                demand(material, "materials", f"{place}/materials/{k}")
    for i, mesh in enumerate(scene.get("meshes", [])):
        for name, value in mesh.items():
            if isinstance(value, dict) and "buffer" in value:
                demand(value["buffer"], "buffers", f"/meshes/{i}/{name}/buffer")
    for i, image in enumerate(scene.get("images", [])):
        demand(image.get("data", {}).get("buffer"), "buffers", f"/images/{i}/data/buffer")
    for i, material in enumerate(scene.get("materials", [])):
        for name, value in material.items():
            if isinstance(value, dict) and "image" in value:
                demand(value["image"], "images", f"/materials/{i}/{name}/image")
    found.raise_for_errors()


def read_buffers(path: Path, scene: Mapping[str, Any]) -> list[bytes]:
    """The bytes of a scene's buffers, in order; they stand beside it, or in it.

    Raises KinefabError when one is missing or not the one that the scene was written with.
    """
    buffers: list[bytes] = []
    for entry in scene.get("buffers", []):
        if "uri" not in entry:
            buffers.append(_held_buffer(Path(path), entry))
            continue
        uri = str(entry["uri"])
        try:
            content = _content(Path(path).parent / Path(uri).name)
        except OSError as error:
            raise KinefabError(
                [diagnostic("BUFFER_MISSING", str(path), uri=uri, detail=error.strerror)]
            ) from error
        if hashlib.sha256(content).hexdigest() != entry["sha256"]:
            raise _unreadable(path, f"{uri} is another buffer")
        buffers.append(content)
    return buffers


def _held_buffer(path: Path, entry: Mapping[str, Any]) -> bytes:
    """The buffer that stands in the scene's own file.  Raises KinefabError when there is none or another."""
    try:
        content = _content(path)
        held = chunks_of(content)[1] if is_container(content) else None
    except (OSError, Damaged) as error:
        raise _unreadable(path, error) from error
    length: object = entry.get("byteLength")
    if held is None or type(length) is not int or not 0 <= len(held) - length < 4:
        raise _unreadable(path, "it holds no buffer of the length that it states")
    buffer = bytes(held[:length])
    if hashlib.sha256(buffer).hexdigest() != entry.get("sha256"):
        raise _unreadable(path, "it holds another buffer")
    return buffer


@contextmanager
def unsound_as_finding(path: Path) -> Generator[None, None, None]:
    """A scene that is JSON and yet no scene is refused; where it is wrong is the validator's to say."""
    try:
        yield
    except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as error:
        raise _unreadable(path, "it is not a sound scene; dotnet kinefab validate says where") from error


def _unreadable(path: Path, detail: object) -> KinefabError:
    return KinefabError([diagnostic("SCENE_UNREADABLE", str(path), detail=detail)])
