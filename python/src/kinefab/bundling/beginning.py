"""A folder of meshes, one part a file, as the beginning of a CAD bundle that a person goes on with.

JSON has no comments; they stand in ``extras``, which readers keep and never interpret.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

from ..diagnostics import KinefabError, Report, diagnostic, is_encodable
from ..geometry.files import FORMATS, GLTF
from ..sources.parts.readers import part_readers
from ..sources.reading.record import is_array, is_object

COMMENT = (
    "Written by kinefab bundle init. Every text called comment may go; it is never read.",
    "units.length holds for every number here; mesh.units for the coordinates in the mesh files.",
    "up is the source's up axis, X, Y or Z. A part's pose: o is its origin, x y z its axes, all in the world.",
    "mesh.coordinates part: a mesh is moved by its part's pose. Meshes exported in place keep the pose as it is.",
    "grounded true: the part does not move. Ground at least one.",
    "Copy example into joints, and correct it: a and b are ids of components (or ground); o lies on the axis, z is",
    "the axis; a limit counts only with its minEnabled or maxEnabled. Types: revolute, slider, cylindrical, ball, rigid.",
    "Then: kinefab bundle check NAME.bundle.json. All fields: schemas/BUNDLE.md, schemas/bundle.schema.json.",
)


def _no_beginning(detail: str, remedy: str) -> KinefabError:
    return KinefabError([diagnostic("BEGINNING_IMPOSSIBLE", detail=detail, remedy=remedy)])


def meshes_in(folder: Path) -> list[Path]:
    """The mesh files of a folder, by name.  Raises KinefabError where there are none."""
    try:
        there = sorted(folder.iterdir(), key=lambda path: path.name)
    except OSError as error:
        raise _no_beginning(
            f"{folder} cannot be listed: {error.strerror or error}",
            "Give a folder of mesh files that can be read.",
        ) from None
    known = known_suffixes()
    found = [path for path in there if _is_mesh(path, known)]
    if not found:
        raise _no_beginning(
            f"{folder} holds no mesh file ({', '.join(known)})", "Export one file for each part into it."
        )
    for path in found:
        if not is_encodable(path.name):
            raise _no_beginning(f"the name of {path!a} is not UTF-8", "Rename the file.")
    return found


def known_suffixes() -> tuple[str, ...]:
    """Of the files that may be a part, lower case."""
    return (*FORMATS, *(suffix for suffix in part_readers() if suffix not in FORMATS))


def _is_mesh(path: Path, known: tuple[str, ...]) -> bool:
    return path.suffix.lower() in known and not path.name.startswith(".") and path.is_file()


def are_gltf(files: Sequence[Path]) -> bool | None:
    """Whether all files are glTF, which is in metres and Y up by its definition (glTF 2.0, 3.4); None where only some are."""
    found = {path.suffix.lower() in GLTF for path in files}
    return found.pop() if len(found) == 1 else None


def tell_folders(folder: Path, report: Report) -> None:
    """Tell of the mesh files in the folders inside, which ``meshes_in`` does not take: they may be an export or a copy."""
    known = known_suffixes()
    for inner in sorted(path for path in folder.iterdir() if path.is_dir() and not path.name.startswith(".")):
        try:
            count = sum(_is_mesh(path, known) for path in inner.iterdir())
        except OSError:
            continue
        if count:
            report.add("BEGINNING_FOLDER", str(folder), folder=inner.name, count=count)


def begin(files: Sequence[Path], target: Path, units: str, up: str) -> str:
    """The text of a bundle with one part for each mesh file.

    files: at least one.  target: the bundle; the files are named relative to its folder.  units: of the files and of
    the bundle, a word of the schema.  up: "X", "Y" or "Z".  Raises KinefabError where a file is not below that folder.
    """
    names = _names(files)
    first, last = names[0], names[-1] if len(names) > 1 else "ground"
    meta = {
        "format": "kinefab.bundle",
        "version": "1.0",
        "generator": {"name": "kinefab bundle init"},
        "units": {"length": units, "angle": "deg", "mass": "kg"},
        "up": up,
        "mesh": {"units": units, "layout": "per_part", "coordinates": "part"},
        "extras": {"comment": list(COMMENT), "example": _example(first, last)},
    }
    components = [
        {
            "id": name,
            "kind": "part",
            "pose": {"o": [0, 0, 0], "x": [1, 0, 0], "y": [0, 1, 0], "z": [0, 0, 1]},
            "grounded": False,
            "file": _relative(file, target),
            "bodies": [{"id": name}],
        }
        for name, file in zip(names, files)
    ]
    return _laid_out({"meta": meta, "components": components, "joints": []})


def _example(a: str, b: str) -> dict[str, object]:
    frame: dict[str, object] = {"in": "world", "o": [0, 0, 0], "z": [0, 0, 1], "x": [1, 0, 0]}
    turn = {"name": "rz", "value": 0, "min": -10, "max": 80, "minEnabled": True, "maxEnabled": True}
    if b == "ground":
        a, b = b, a
    return {
        "id": "Hinge:1",
        "type": "revolute",
        "a": a,
        "b": b,
        "frameA": frame,
        "frameB": frame,
        "dof": [turn],
    }


def _names(files: Sequence[Path]) -> list[str]:
    """Unique ids: the name without its ending, with it where two would be the same or it is a reserved word."""
    stems = [file.stem for file in files]
    return [file.name if stems.count(file.stem) > 1 or file.stem == "ground" else file.stem for file in files]


def _relative(file: Path, target: Path) -> str:
    try:
        return file.resolve().relative_to(target.parent.resolve()).as_posix()
    except ValueError:
        raise _no_beginning(
            f"{file} does not lie below the folder of the bundle, {target.parent.resolve()}",
            "Write the bundle beside the meshes or above them.",
        ) from None


def _laid_out(values: dict[str, object]) -> str:
    """JSON to be edited by hand: numbers that belong together stay on one line."""

    def text(value: object, indent: str) -> str:
        flat = json.dumps(value, ensure_ascii=False)
        if len(flat) + len(indent) <= 100:
            return flat
        inner = indent + "  "
        if is_object(value):
            lines = [
                f"{inner}{json.dumps(k, ensure_ascii=False)}: {text(v, inner)}" for k, v in value.items()
            ]
            return "{\n" + ",\n".join(lines) + f"\n{indent}}}"
        if not is_array(value):
            return flat
        return "[\n" + ",\n".join(inner + text(v, inner) for v in value) + f"\n{indent}]"

    return text(values, "") + "\n"
