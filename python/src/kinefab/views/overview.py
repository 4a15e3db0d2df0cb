"""Reads a written scene back and tells what is in it; checking it is ``dotnet kinefab validate``'s task."""

from __future__ import annotations

import errno
import hashlib
import json
import math
from collections.abc import Generator, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, cast

from ..diagnostics import KinefabError, Report, diagnostic, printable


def read_scene_file(path: Path) -> Mapping[str, Any]:
    """The JSON of a scene.  Raises KinefabError when it is missing, broken, of another major version, or when an index
    in it leads nowhere: Python would count a negative one from the list's end."""
    try:
        content: Any = json.loads(_content(Path(path)), parse_float=_number, parse_constant=_number)
    except FileNotFoundError:
        raise KinefabError([diagnostic("SOURCE_NOT_FOUND", path=path)]) from None
    except OSError as error:
        raise KinefabError([diagnostic("SCENE_UNREADABLE", str(path), detail=error.strerror)]) from error
    except RecursionError:
        raise KinefabError(
            [diagnostic("SCENE_UNREADABLE", str(path), detail="it is nested too deeply")]
        ) from None
    except ValueError as error:
        raise KinefabError([diagnostic("SCENE_UNREADABLE", str(path), detail=error)]) from error
    if not isinstance(content, dict) or cast("dict[str, Any]", content).get("format") != "kinefab.scene":
        raise KinefabError(
            [diagnostic("SCENE_UNREADABLE", str(path), detail="it does not say it is a kinefab.scene")]
        )
    scene = cast("dict[str, Any]", content)
    version = str(scene.get("version", ""))
    if version.partition(".")[0] != "1":
        raise KinefabError(
            [diagnostic("SCENE_UNREADABLE", str(path), detail=f"its version is {version}, not 1.x")]
        )
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
            for k, material in enumerate(component.get("materials", [])):
                demand(material, "materials", f"{place}/materials/{k}")
    for i, mesh in enumerate(scene.get("meshes", [])):
        for name in ("positions", "normals", "uv", "indices"):
            demand(mesh.get(name, {}).get("buffer"), "buffers", f"/meshes/{i}/{name}/buffer")
    found.raise_for_errors()


def read_buffers(path: Path, scene: Mapping[str, Any]) -> list[bytes]:
    """The bytes of a scene's buffers, in order; they stand beside it.

    Raises KinefabError when one is missing or not the one that the scene was written with.
    """
    buffers: list[bytes] = []
    for entry in scene.get("buffers", []):
        uri = str(entry["uri"])
        try:
            content = _content(Path(path).parent / Path(uri).name)
        except OSError as error:
            raise KinefabError(
                [diagnostic("BUFFER_MISSING", str(path), uri=uri, detail=error.strerror)]
            ) from error
        if hashlib.sha256(content).hexdigest() != entry["sha256"]:
            raise KinefabError([diagnostic("SCENE_UNREADABLE", str(path), detail=f"{uri} is another buffer")])
        buffers.append(content)
    return buffers


def picture(path: Path) -> str:
    """A scene file as an SVG.  Raises KinefabError when it or its buffer cannot be read."""
    from .picture import draw

    scene = read_scene_file(path)
    with unsound_as_finding(path):
        return draw(scene, read_buffers(path, scene), path.name.split(".")[0])


def overview(path: Path, as_json: bool) -> str:
    """What is in a scene file, for people or as JSON.  Raises KinefabError when it cannot be read."""
    scene = read_scene_file(path)
    with unsound_as_finding(path):
        description = describe(scene)
        text = json.dumps(description, indent=2, ensure_ascii=False) if as_json else render(description)
        text.encode("utf-8")  # half of a surrogate pair is no text
        return text


@contextmanager
def unsound_as_finding(path: Path) -> Generator[None, None, None]:
    """A scene that is JSON and yet no scene is refused; where it is wrong is the validator's to say."""
    try:
        yield
    except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as error:
        detail = "it is not a sound scene; dotnet kinefab validate says where"
        raise KinefabError([diagnostic("SCENE_UNREADABLE", str(path), detail=detail)]) from error


def describe(scene: Mapping[str, Any]) -> dict[str, Any]:
    """The scene in brief: objects, joints with their freedoms, couplings, and what became of each feature."""
    from .freedoms import freedoms_of_component, joint_name, world_placements

    objects = scene.get("gameObjects", [])
    placements = world_placements(objects)
    joints: list[dict[str, Any]] = []
    for index, entry in enumerate(objects):
        for component in entry.get("components", []):
            if component["type"].endswith("Joint"):
                connected = component.get("connectedBody")
                joints.append(
                    {
                        "name": joint_name(component),
                        "type": component["type"],
                        "object": entry["id"],
                        "connected": None if connected is None else objects[connected]["id"],
                        "freedoms": freedoms_of_component(component, index, placements),
                        "closure": component.get("closure", False),
                        "exact": component.get("exact", True),
                        "because": component.get("because", []),
                    }
                )
    return {
        "generator": scene.get("generator", {}),
        "source": scene.get("source", {}),
        "objects": [
            {
                "id": entry["id"],
                "name": entry["name"],
                "parent": entry.get("parent"),
                "mass": next(
                    (c.get("mass", 1) for c in entry.get("components", []) if c["type"] == "Rigidbody"), None
                ),
                "components": [component["type"] for component in entry.get("components", [])],
            }
            for entry in objects
        ],
        "joints": joints,
        "couplings": [coupling.get("id", coupling["kind"]) for coupling in scene.get("couplings", [])],
        "mobility": scene.get("analysis", {}).get("mobility"),
        "report": list(scene.get("report", [])),
    }


def _by_hierarchy(objects: Sequence[Mapping[str, Any]]) -> Iterator[tuple[int, Mapping[str, Any]]]:
    """Objects with their depth, children under their parent; the file only has parents before children."""
    children: dict[int | None, list[int]] = {}
    for index, entry in enumerate(objects):
        children.setdefault(entry["parent"], []).append(index)
    waiting = [(0, index) for index in reversed(children.get(None, []))]
    while waiting:
        depth, index = waiting.pop()
        yield depth, objects[index]
        waiting += [(depth + 1, child) for child in reversed(children.get(index, []))]


def render(description: Mapping[str, Any]) -> str:
    """The description as text for a terminal or a log."""
    lines: list[str] = []
    for depth, entry in _by_hierarchy(description["objects"]):
        mass = "" if entry["mass"] is None else f"  {entry['mass']:.4g} kg"
        lines.append("  " * depth + entry["name"] + mass)
    joints = len(description["joints"])
    lines += ["", f"{joints} joint{'' if joints == 1 else 's'}"]
    for joint in description["joints"]:
        freedoms = ", ".join(joint["freedoms"]) or "fixed"
        marks = (" closes a loop" if joint["closure"] else "") + ("" if joint["exact"] else " approximated")
        name = f"{joint['name']}: " if joint["name"] else ""
        lines.append(
            f"  {name}{joint['object']} -> {joint['connected'] or 'world'}: {joint['type']}, {freedoms}{marks}"
        )
    if description["couplings"]:
        lines.append("couplings: " + ", ".join(description["couplings"]))
    if description["mobility"] is not None:
        lines.append(f"mobility: {description['mobility']}")
    lines.append("")
    words = ("kept", "approximated", "dropped")
    counts = [sum(entry["outcome"] == word for entry in description["report"]) for word in words]
    lines.append(", ".join(f"{count} {word}" for count, word in zip(counts, words)))
    lines += [
        f"  {entry['outcome']} {entry['feature']}: {entry.get('message', '')}".rstrip(": ")
        for entry in description["report"]
        if entry["outcome"] != "kept"
    ]
    return "\n".join(map(printable, lines))
