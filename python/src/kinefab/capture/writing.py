"""A captured bundle as files: NAME.bundle.json, a folder of OBJ files, one for each part definition, and the record.

Standard library only: it also runs in a CAD program's own Python.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from itertools import islice
from pathlib import Path
from typing import Any, cast

from .draft import BodyMesh, Draft


def mesh_files(draft: Draft, folder: str) -> tuple[dict[str, Any], dict[str, bytes]]:
    """The bundle's values with its meshes named, and the files to write beside it, by relative path."""
    values = draft.values()
    files: dict[str, bytes] = {}
    named: dict[str, str] = {}
    for number, (definition, bodies) in enumerate(sorted(draft.meshes.items())):
        word = re.sub(r"[^A-Za-z0-9_-]+", "_", definition)[:40]
        named[definition] = f"{folder}/{number:04d}_{word}.obj"
        lines, first = ["# kinefab capture, part coordinates"], 1
        normals = any(body.normals is not None for body in bodies)
        for body in bodies:
            lines.append(f"o {' '.join(body.name.split()) or 'body'}")
            corners = zip(*(iter(body.points),) * 3)
            lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in corners]
            if normals:
                vectors = body.normals or [0.0] * len(body.points)
                lines += [f"vn {x:.6g} {y:.6g} {z:.6g}" for x, y, z in zip(*(iter(vectors),) * 3)]
            lines += _faces(body, first)
            first += len(body.points) // 3
        files[named[definition]] = ("\n".join(lines) + "\n").encode("utf-8")
    if named:
        values["meta"]["mesh"] = {"units": draft.length, "layout": "per_part", "coordinates": "part"}
    for component in values["components"]:
        if component.get("definition") in named and component["kind"] == "part":
            component["file"] = named[component["definition"]]
        else:
            component.pop("bodies", None)
    return values, files


def _faces(body: BodyMesh, first: int) -> list[str]:
    """Lines of a body's faces, with its normals, below the name of the material that a run of them has.  first: its first corner."""
    pattern = "f {0} {1} {2}" if body.normals is None else "f {0}//{0} {1}//{1} {2}//{2}"
    numbered = (
        pattern.format(a + first, b + first, c + first) for a, b, c in zip(*(iter(body.triangles),) * 3)
    )
    lines: list[str] = []
    for count, material in body.runs:
        lines += [f"usemtl {material}", *islice(numbered, count)]
    return [*lines, *numbered]


def bundle_text(values: dict[str, Any]) -> bytes:
    """One record a line: a person can read it, and a change of one joint is a change of one line."""
    parts: list[str] = []
    for key, value in values.items():
        if isinstance(value, list):
            entries = cast("list[Any]", value)
            rows = ",\n".join(f"    {json.dumps(entry, ensure_ascii=False)}" for entry in entries)
            parts.append(f"  {json.dumps(key)}: [\n{rows}\n  ]")
        else:
            parts.append(f"  {json.dumps(key)}: {json.dumps(value, ensure_ascii=False)}")
    return ("{\n" + ",\n".join(parts) + "\n}\n").encode("utf-8", "backslashreplace")


def write_files(
    values: dict[str, Any], files: dict[str, bytes], target: Path, write: Callable[[Path, bytes], None]
) -> None:
    """Meshes first, the bundle last: where it stands, what it names is there.  Raises OSError."""
    for name, content in files.items():
        path = target.parent / name
        path.parent.mkdir(parents=True, exist_ok=True)
        write(path, content)
    write(target, bundle_text(values))
