"""Wavefront OBJ with its bodies kept apart.

trimesh parses vertices and faces; which faces make a body is read here, because it merges objects that share
a material or a name, passes a ``g`` on to the next ``o``, counts negative indices from the end of the file,
and spends time on every vertex of the file for each object.  So it gets the file as one mesh of triangles
with plain indices, and the mesh is cut up again by counting faces.
"""

from __future__ import annotations

import inspect
import io
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, cast

import numpy as np

from ..diagnostics import Report
from ..model import MeshKey, Surface
from .looks.libraries import library_textures
from .looks.visuals import phong_smoothness
from .pieces import MeshFile, Piece, cut
from .references import read_reference

# A literal beginning lets the engine skip from hit to hit through hundreds of megabytes.
_STATEMENTS = {
    word: re.compile(rb"\n" + word + rb"(?: +([^\n]*?))? *(?=\n)") for word in (b"o", b"g", b"usemtl")
}
_INDENT = re.compile(rb"^[ \t]+", re.MULTILINE)
_CORNER = rb" +[1-9][0-9]*(?:/[0-9]*){0,2}"
_UNUSUAL_FACE = re.compile(rb"^f(?!(?:" + _CORNER + rb"){3} *$)", re.MULTILINE)
MOST_LIBRARY_BYTES = 16 * 2**20
"""Of one material library."""
_LIBRARY = re.compile(rb"\nmtllib +([^\n]*?) *(?=\n)")

NOTHING = Piece(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64))


class ObjError(ValueError):
    """The text is no usable OBJ; the message says why."""


@dataclass(slots=True)
class _Section:
    """Faces between two ``o`` or ``g`` statements.  object, group: (number of the statement, name).
    runs: (material, faces) in order."""

    object: tuple[int, str]
    group: tuple[int, str]
    runs: list[tuple[str, int]]

    @property
    def faces(self) -> int:
        return sum(count for _, count in self.runs)


def read_obj(path: Path, report: Report) -> MeshFile:
    """Read bodies and surfaces of an OBJ file.  Raises ObjError or OSError."""
    text = _plain_text(path.read_bytes())
    if _UNUSUAL_FACE.search(text):
        text = _with_plain_faces(text)
    statements = _statements(text)
    sections = [s for s in _sections(text, statements) if s.faces]
    whole = _parse(_without(text, statements)) if sections else NOTHING
    pieces: list[Piece] = []
    named: dict[MeshKey, dict[str, list[tuple[int, ...]]]] = {key: {} for key in MeshKey}
    opened: dict[tuple[MeshKey, int, str], list[int]] = {}
    start = 0
    for number, section in enumerate(sections):
        stop = start + section.faces
        runs = [run for run in section.runs if run[1]]
        counts, surfaces = tuple(n for _, n in runs), tuple(name for name, _ in runs)
        pieces.append(cut(whole, start, stop, counts, surfaces))
        start = stop
        for key, (statement, name) in ((MeshKey.OBJECT, section.object), (MeshKey.GROUP, section.group)):
            for word in dict.fromkeys([name, *name.split()]) if key is MeshKey.GROUP else [name]:
                if word:
                    opened.setdefault((key, statement, word), []).append(number)
    for (key, _, name), numbers in opened.items():
        named[key].setdefault(name, []).append(tuple(numbers))
    if start != len(whole.faces):
        raise ObjError(f"{len(whole.faces)} faces were read where {start} were counted")
    return MeshFile(path, pieces, named, _surfaces(text, path, report))


def _plain_text(data: bytes) -> bytes:
    """LF line ends, no continuations, no tabs or indents, and a line end at both ends."""
    data = data.removeprefix(b"\xef\xbb\xbf").replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    data = data.replace(b"\\\n", b" ").replace(b"\t", b" ")
    return b"\n" + (_INDENT.sub(b"", data) if b"\n " in data else data).strip() + b"\n"


@dataclass(frozen=True, slots=True)
class _Statement:
    """An ``o``, ``g`` or ``usemtl`` line: where it stands (from the line end before it), its word and its name."""

    start: int
    stop: int
    word: bytes
    name: str


def _statements(text: bytes) -> list[_Statement]:
    """The statements in file order."""
    found = [
        _Statement(match.start(), match.end(), word, (match[1] or b"").decode("utf-8", "replace").strip())
        for word, pattern in _STATEMENTS.items()
        for match in pattern.finditer(text)
    ]
    return sorted(found, key=lambda statement: statement.start)


def _without(text: bytes, statements: list[_Statement]) -> bytes:
    """The text less its statements."""
    starts = [0, *(s.stop for s in statements)]
    stops = [*(s.start for s in statements), len(text)]
    return b"".join(text[start:stop] for start, stop in zip(starts, stops))


def _sections(text: bytes, statements: list[_Statement]) -> list[_Section]:
    """The sections in file order, each with its runs of one material."""
    current_object, current_group, material = (0, ""), (0, ""), ""
    sections = [_Section(current_object, current_group, [])]
    stops = [*(s.start for s in statements), len(text)]
    sections[-1].runs.append((material, text.count(b"\nf ", 0, stops[0])))
    for number, statement in enumerate(statements, 1):
        if statement.word == b"usemtl":
            material = statement.name
        elif statement.word == b"o":
            current_object, current_group = (number, statement.name), (0, "")
            sections.append(_Section(current_object, current_group, []))
        else:
            current_group = (number, statement.name)
            sections.append(_Section(current_object, current_group, []))
        sections[-1].runs.append((material, text.count(b"\nf ", statement.stop, stops[number])))
    return sections


def _with_plain_faces(text: bytes) -> bytes:
    """The text with every face a fan of triangles whose indices count from 1.  Line by line, so slow."""
    counts = {b"v": 0, b"vt": 0, b"vn": 0}
    order = (b"v", b"vt", b"vn")
    lines: list[bytes] = []
    for line in text.split(b"\n"):
        head, _, rest = line.partition(b" ")
        if head in counts:
            counts[head] += 1
        if head != b"f":
            lines.append(line)
            continue
        corners = [_absolute(corner, [counts[k] for k in order]) for corner in rest.split()]
        for i in range(1, len(corners) - 1):
            lines.append(b"f " + b" ".join((corners[0], corners[i], corners[i + 1])))
    return b"\n".join(lines)


def _absolute(corner: bytes, counts: list[int]) -> bytes:
    indices: list[bytes] = []
    for text, count in zip(corner.split(b"/"), counts):
        try:
            index = int(text) if text else None
        except ValueError:
            raise ObjError(f"a face names {corner.decode('ascii', 'replace')!r}") from None
        if index is not None and index < 0:
            index += count + 1
        if index is not None and index < 1:
            raise ObjError(f"a face names vertex {text.decode()}, before the first")
        indices.append(b"" if index is None else b"%d" % index)
    return b"/".join(indices)


def _parse(text: bytes) -> Piece:
    """The whole text as one piece, by trimesh; face order is kept."""
    from trimesh.exchange import obj

    load_obj = cast(Any, obj).load_obj  # trimesh states no types
    wanted = {"skip_materials": True, "split_objects": False, "split_object": False, "split_groups": False}
    known = inspect.signature(load_obj).parameters
    options = {name: value for name, value in wanted.items() if name in known}
    try:
        loaded: Any = load_obj(io.BytesIO(text), **options)
        if "geometry" in loaded:
            # trimesh 5 leaves out what has no vertices
            loaded = cast(Any, next(iter(loaded["geometry"].values()), None))
        faces = np.asarray(loaded["faces"], dtype=np.int64).reshape(-1, 3)
        vertices = np.asarray(loaded["vertices"], dtype=np.float64)
        if vertices.shape[1:] != (3,) or faces.min(initial=0) < 0 or faces.max(initial=-1) >= len(vertices):
            raise IndexError  # trimesh 5 hands out what earlier ones stumbled over
    except (IndexError, ValueError, KeyError, TypeError, AttributeError) as error:
        # A ValueError names the text that is no number; the others say what trimesh stumbled over in its own code.
        torn = "its vertices and faces do not fit together; it may be cut short"
        raise ObjError(str(error) if isinstance(error, ValueError) else torn) from error
    normals, uv = loaded.get("vertex_normals"), getattr(loaded.get("visual"), "uv", None)

    def fits(values: Any) -> bool:
        return values is not None and len(values) == len(vertices)

    return Piece(vertices, faces, normals if fits(normals) else None, np.asarray(uv) if fits(uv) else None)


def _surfaces(text: bytes, path: Path, report: Report) -> dict[str, Surface]:
    """The surfaces of every ``mtllib`` that is there; a warning for one that is not."""
    from trimesh.exchange import obj

    surfaces: dict[str, Surface] = {}
    for match in _LIBRARY.finditer(text):
        library = match[1].decode("utf-8", "replace")
        try:
            content = read_reference(path.parent, library, MOST_LIBRARY_BYTES)
        except (OSError, ValueError):  # ValueError: a NUL in the name
            report.add("MATERIALS_MISSING", str(path), library=Path(library).name, path=path.name)
            continue
        textures = library_textures(content, path, report)
        for name, entry in cast(Any, obj).parse_mtl(content).items():
            surfaces[name] = replace(_surface(name, entry, name in textures), **textures.get(name, {}))
    return surfaces


def _surface(name: str, entry: Mapping[str, Any], textured: bool) -> Surface:
    """Unity's terms for a Phong material: Kd, d (or Tr) and Ns.  textured: it has images, which Kd multiplies."""
    absent = (1.0, 1.0, 1.0) if textured else (0.8, 0.8, 0.8)
    try:
        red, green, blue = (min(1.0, max(0.0, float(c))) for c in entry.get("diffuse", absent)[:3])
        opacity = float(entry["d"][0]) if "d" in entry else 1.0 - float(entry.get("tr", ["0"])[0])
        shininess = max(0.0, float(entry.get("glossiness", 0.0)))
    except (TypeError, ValueError, IndexError):
        return Surface(name)
    color = (red, green, blue, min(1.0, max(0.0, opacity)))
    return Surface(name, color, 0.0, phong_smoothness(shininess))
