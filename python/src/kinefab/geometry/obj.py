"""Wavefront OBJ with its bodies kept apart.

The file is first written out as triangles with plain indices, so that numpy takes its numbers as tables; the whole is one mesh,
which is cut up into bodies by counting faces.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..diagnostics import Report
from ..model import MeshKey, Surface
from ..spatial import Array, IntArray
from .looks.libraries import library_statements, library_textures
from .looks.visuals import WHITE, from_screen, linear_colors, phong_smoothness
from .pieces import MeshFile, Piece, cut
from .references import read_reference

# A literal beginning lets the engine skip from hit to hit through hundreds of megabytes.
_STATEMENTS = {
    word: re.compile(rb"\n" + word + rb"(?: +([^\n]*?))? *(?=\n)") for word in (b"o", b"g", b"usemtl")
}
_INDENT = re.compile(rb"^[ \t]+", re.MULTILINE)
_CORNER = rb" +[1-9][0-9]*(?:/[0-9]*){0,2}"
_UNUSUAL_FACE = re.compile(rb"^f(?!(?:" + _CORNER + rb"){3} *$)", re.MULTILINE)
_ALIKE = {
    named: re.compile(rb"^(?!(?:" + names + rb"(?: +|$)){3}$)", re.MULTILINE)
    for named, names in {
        (0,): rb"[0-9]+",
        (0, 1): rb"[0-9]+/[0-9]+",
        (0, 2): rb"[0-9]+//[0-9]+",
        (0, 1, 2): rb"[0-9]+/[0-9]+/[0-9]+",
    }.items()
}
"""What all corners of a file name, of vertex, texture coordinates and normal, and what finds a face of which one does not."""
MOST_LIBRARY_BYTES = 16 * 2**20
"""Of one material library."""
_LIBRARY = re.compile(rb"\nmtllib +([^\n]*?) *(?=\n)")

_VERTEX = re.compile(rb"\nv +([^\n]*)")
COLORED = (6, 7)
"""Numbers of a vertex that has a colour: place, red, green, blue, and opacity of some."""
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
    unnamed = "" if whole.colors is None else WHITE.name
    pieces: list[Piece] = []
    named: dict[MeshKey, dict[str, list[tuple[int, ...]]]] = {key: {} for key in MeshKey}
    opened: dict[tuple[MeshKey, int, str], list[int]] = {}
    start = 0
    for number, section in enumerate(sections):
        stop = start + section.faces
        runs = [run for run in section.runs if run[1]]
        counts, surfaces = tuple(n for _, n in runs), tuple(name or unnamed for name, _ in runs)
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
    surfaces = _surfaces(text, path, report)
    return MeshFile(path, pieces, named, surfaces if not unnamed else {WHITE.name: WHITE, **surfaces})


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
    """The text with every face a fan of triangles whose indices count from 1, without comments.  Line by line, so slow."""
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
        corners = [_absolute(corner, [counts[k] for k in order]) for corner in rest.split(b"#")[0].split()]
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
    """The whole text as one piece; face order is kept.  A vertex is repeated for each texture coordinate and normal it is used with."""
    corners = _corners(re.findall(rb"\nf +([^\n]*)", text))
    vertices = _numbers(text, b"v", 3)
    if corners[..., 0].max(initial=0) > len(vertices):
        raise ObjError("its vertices and faces do not fit together; it may be cut short")
    colors = _vertex_colors(text, len(vertices))
    uv, normals = (
        _whole(corners[..., k], _numbers(text, word, n)) for k, word, n in ((1, b"vt", 2), (2, b"vn", 3))
    )
    if uv is None and normals is None:
        return Piece(vertices, corners[..., 0] - 1, colors=colors)
    named = corners.reshape(-1, 3)[:, [True, uv is not None, normals is not None]] - 1
    key = named[:, -1]
    for column in named.T[-2::-1]:
        _, key = np.unique(key, return_inverse=True)
        key = np.reshape(key, -1) * (int(column.max()) + 1) + column
    _, first, faces = np.unique(key, return_index=True, return_inverse=True)
    vertex, texture, normal = corners.reshape(-1, 3)[first].T - 1
    return Piece(
        vertices[vertex],
        np.reshape(faces, (-1, 3)),
        None if normals is None else normals[normal],
        None if uv is None else uv[texture],
        colors=None if colors is None else colors[vertex],
    )


def _vertex_colors(text: bytes, count: int) -> Array | None:
    """Linear RGBA behind the places of so many vertices, shape (n, 4), None where there are none, or white alone."""
    first = _VERTEX.search(text)
    if first is None or len(first[1].split()) not in COLORED:
        return None
    try:
        found = np.loadtxt(_VERTEX.findall(text), comments=None, usecols=(3, 4, 5), ndmin=2)
    except ValueError:  # not all have one
        return None
    if (
        len(found) != count
        or not np.isfinite(found).all()
        or (found == found.max()).all()
        and found[0, 0] >= 1.0
    ):
        return None
    return linear_colors(found / (255.0 if found.max() > 1.0 else 1.0), False)


def _corners(faces: Sequence[bytes]) -> IntArray:
    """Vertex, texture coordinates and normal of each corner, counted from 1, 0 where it names none, shape (m, 3, 3)."""
    found = np.zeros((len(faces), 3, 3), dtype=np.int64)
    text = b"\n".join(faces)
    for named, other in _ALIKE.items():
        if other.search(text) is None:
            rows = text.replace(b"/", b" ").split(b"\n")
            found[:, :, named] = np.loadtxt(rows, np.int64, comments=None, ndmin=2).reshape(-1, 3, len(named))
            return found
    for face, corners in enumerate(faces):
        for corner, names in enumerate(corners.split()):
            for k, name in enumerate(names.split(b"/")):
                found[face, corner, k] = int(name or 0)
    return found


def _numbers(text: bytes, word: bytes, columns: int) -> Array:
    """The first numbers of each line of a kind, shape (n, columns).  Raises ObjError where one is missing or none."""
    rows: list[bytes] = re.findall(rb"\n" + word + rb" +([^\n]*)", text)
    if not rows:
        return np.zeros((0, columns))
    if word == b"vt":  # it may state u alone
        rows = [row + b" 0" for row in rows]
    try:
        found = np.loadtxt(rows, comments=None, usecols=range(columns), ndmin=2)
        if len(found) != len(rows):
            raise ValueError("one is empty")
    except ValueError as error:
        raise ObjError(f"of its {word.decode()} lines: {error}; it may be cut short") from error
    return found


def _whole(numbers: IntArray, values: Array) -> Array | None:
    """The values, or None where a corner names none or one that is not there."""
    return values if numbers.min(initial=1) > 0 and 0 < numbers.max(initial=0) <= len(values) else None


def _surfaces(text: bytes, path: Path, report: Report) -> dict[str, Surface]:
    """The surfaces of every ``mtllib`` that is there; a warning for one that is not."""
    surfaces: dict[str, Surface] = {}
    for match in _LIBRARY.finditer(text):
        library = match[1].decode("utf-8", "replace")
        try:
            content = read_reference(path.parent, library, MOST_LIBRARY_BYTES)
        except (OSError, ValueError):  # ValueError: a NUL in the name
            report.add("MATERIALS_MISSING", str(path), library=Path(library).name, path=path.name)
            continue
        for name, statements in library_statements(content).items():
            textures = library_textures(statements, path, report)
            surfaces[name] = replace(_surface(name, statements, bool(textures)), **textures)
    return surfaces


def _surface(name: str, statements: Mapping[str, str], textured: bool) -> Surface:
    """Unity's terms for a Phong material: Kd, Ke, d (or Tr) and Ns, and Pm and Pr of those that state a physical one.
    textured: it has images, which Kd multiplies."""
    entry = {word: rest.split() for word, rest in statements.items()}
    absent = ["1", "1", "1"] if textured else ["0.8", "0.8", "0.8"]
    try:
        red, green, blue = (min(1.0, max(0.0, float(c))) for c in entry.get("kd", absent)[:3])
        opacity = float(entry["d"][0]) if "d" in entry else 1.0 - float(entry.get("tr", ["0"])[0])
        smoothness = phong_smoothness(max(0.0, float(entry.get("ns", ["0"])[0])))
        if "pr" in entry:
            smoothness = 1.0 - min(1.0, max(0.0, float(entry["pr"][0])))
        metallic = min(1.0, max(0.0, float(entry.get("pm", ["0"])[0])))
        glow = [max(0.0, float(c)) for c in entry.get("ke", ["0", "0", "0"])]
        emission = from_screen((glow[0], glow[1], glow[2]))
        color = (*from_screen((red, green, blue)), min(1.0, max(0.0, opacity)))
        return Surface(name, color, metallic, smoothness, emission=emission)
    except (ValueError, IndexError):
        return Surface(name)
