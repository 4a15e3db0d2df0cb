"""Wavefront OBJ with its bodies kept apart: the whole is one mesh, which is cut up into bodies by counting faces."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ...diagnostics import Report
from ...model import MeshKey, Surface
from ...spatial import Array, IntArray
from ..looks.libraries import library_statements, library_textures
from ..looks.visuals import WHITE, from_screen, linear_colors, phong_smoothness
from ..pieces import MeshFile, Piece, cut
from ..references import read_reference
from .tables import Faces, Lines, faces_of, numbers_of

_STATEMENTS = {
    word: re.compile(rb"\n" + word + rb"(?: +([^\n]*?))? *(?=\n)") for word in (b"o", b"g", b"usemtl")
}
_INDENT = re.compile(rb"^[ \t]+", re.MULTILINE)
MOST_LIBRARY_BYTES = 16 * 2**20
"""Of one material library."""
_LIBRARY = re.compile(rb"\nmtllib +([^\n]*?) *(?=\n)")

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
    lines = Lines(_plain_text(path.read_bytes()))
    faces = faces_of(lines)
    uneven = None
    if faces is None:
        lines = Lines(_with_plain_faces(lines.text))
        faces = faces_of(lines)
    if faces is None:
        faces = uneven = _uneven_faces(lines.of(b"f"))
    sections = [s for s in _sections(lines, faces) if s.faces]
    looks = _surfaces(lines, path, report)
    whole = _parse(lines, faces) if sections else NOTHING
    del lines, faces  # hundreds of megabytes
    unnamed = "" if whole.colors is None else WHITE.name
    pieces: list[Piece] = []
    named: dict[MeshKey, dict[str, list[tuple[int, ...]]]] = {key: {} for key in MeshKey}
    opened: dict[tuple[MeshKey, int, str], list[int]] = {}
    start = 0
    for number, section in enumerate(sections):
        stop = start + section.faces
        runs = [run for run in section.runs if run[1]]
        counts, surfaces = tuple(n for _, n in runs), tuple(name or unnamed for name, _ in runs)
        piece = cut(whole, start, stop, counts, surfaces)
        pieces.append(piece if uneven is None else _with_named(piece, uneven.corners[start:stop]))
        start = stop
        for key, (statement, name) in ((MeshKey.OBJECT, section.object), (MeshKey.GROUP, section.group)):
            for word in dict.fromkeys([name, *name.split()]) if key is MeshKey.GROUP else [name]:
                if word:
                    opened.setdefault((key, statement, word), []).append(number)
    for (key, _, name), numbers in opened.items():
        named[key].setdefault(name, []).append(tuple(numbers))
    if start != len(whole.faces):
        raise ObjError(f"{len(whole.faces)} faces were read where {start} were counted")
    return MeshFile(path, pieces, named, looks if not unnamed else {WHITE.name: WHITE, **looks})


def _plain_text(data: bytes) -> bytes:
    """LF line ends, no continuations, no tabs or indents, and a line end at both ends."""
    data = data.removeprefix(b"\xef\xbb\xbf").replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    data = data.replace(b"\\\n", b" ").replace(b"\t", b" ")
    text = b"".join((b"\n", data, b"\n"))
    return _INDENT.sub(b"", text) if b"\n " in text else text


@dataclass(frozen=True, slots=True)
class _Statement:
    """An ``o``, ``g`` or ``usemtl`` line: where the line end before it is, its word and its name."""

    start: int
    word: bytes
    name: str


def _statements(lines: Lines) -> list[_Statement]:
    """The statements in file order."""
    found: list[_Statement] = []
    for word, pattern in _STATEMENTS.items():
        for start in lines.starts[lines.which(word[:3])].tolist():
            if match := pattern.match(lines.text, start):
                name = (match[1] or b"").decode("utf-8", "replace").strip()
                found.append(_Statement(start, word, name))
    return sorted(found, key=lambda statement: statement.start)


def _sections(lines: Lines, faces: Faces) -> list[_Section]:
    """The sections in file order, each with its runs of one material."""
    statements = _statements(lines)
    stops = [*(s.start for s in statements), len(lines.text)]
    counts = np.searchsorted(lines.starts[lines.which(b"f ")], stops).tolist()
    total = np.cumsum(faces.triangles)
    until = [int(total[count - 1]) if count else 0 for count in counts]
    current_object, current_group, material = (0, ""), (0, ""), ""
    sections = [_Section(current_object, current_group, [(material, until[0])])]
    for number, statement in enumerate(statements, 1):
        if statement.word == b"usemtl":
            material = statement.name
        elif statement.word == b"o":
            current_object, current_group = (number, statement.name), (0, "")
            sections.append(_Section(current_object, current_group, []))
        else:
            current_group = (number, statement.name)
            sections.append(_Section(current_object, current_group, []))
        sections[-1].runs.append((material, until[number] - until[number - 1]))
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


def _parse(lines: Lines, faces: Faces) -> Piece:
    """The whole text as one piece; face order is kept.  A vertex is repeated for each texture coordinate and normal it is used with."""
    numbers = _numbers(lines, b"v", 3)
    vertices, colors = np.ascontiguousarray(numbers[:, :3]), _vertex_colors(numbers)
    corner = faces.of(0)
    assert corner is not None
    if corner.max(initial=0) > len(vertices):
        raise ObjError("its vertices and faces do not fit together; it may be cut short")
    texture, normal = faces.of(1), faces.of(2)
    uv, normals = _values(texture, lines, b"vt", 2), _values(normal, lines, b"vn", 3)
    if uv is None and normals is None:
        corner -= 1  # hundreds of megabytes, which nobody asks for again
        return Piece(vertices, np.ascontiguousarray(corner), colors=colors)
    columns = [corner, texture if uv is not None else None, normal if normals is not None else None]
    named: IntArray = np.stack([c.reshape(-1) for c in columns if c is not None], axis=1)
    key = named[:, -1]
    for column in named.T[-2::-1]:
        _, key = np.unique(key, return_inverse=True)
        key = np.reshape(key, -1) * (int(column.max()) + 1) + column
    _, first, numbered = np.unique(key, return_index=True, return_inverse=True)
    of_each: IntArray = named[first].T - 1  # what one does not name is the last of its list
    return Piece(
        vertices[of_each[0]],
        np.reshape(numbered, (-1, 3)),
        None if normals is None else normals[of_each[-1]],
        None if uv is None else uv[of_each[1]],
        colors=None if colors is None else colors[of_each[0]],
    )


def _with_named(piece: Piece, corners: IntArray) -> Piece:
    """A piece with the texture coordinates and normals that its own corners name: coordinates where one does, and 0 0 where it does
    not, as other programs have it; normals where all do.  corners: as ``Faces`` has them."""
    uv = piece.uv if corners[..., 1].any() else None
    return replace(piece, uv=uv, normals=piece.normals if corners[..., 2].all() else None)


def _vertex_colors(numbers: Array) -> Array | None:
    """Linear RGBA behind the places, shape (n, 4), None where there are none, or white alone.  numbers: of each vertex line."""
    if numbers.shape[1] not in COLORED:
        return None
    found = numbers[:, 3:6]
    if not np.isfinite(found).all() or (found == found.max()).all() and found[0, 0] >= 1.0:
        return None
    return linear_colors(found / (255.0 if found.max() > 1.0 else 1.0), False)


def _uneven_faces(lines: bytes) -> Faces:
    """As ``faces_of`` has triangles, where their corners do not all name the same; 0 for what one does not name.  Slow."""
    triangles = lines.split(b"\n")[1:]
    numbers = np.zeros((len(triangles), 3, 3), dtype=np.int64)
    for triangle, line in enumerate(triangles):
        for corner, names in enumerate(line.split()[1:]):
            for k, name in enumerate(names.split(b"/")):
                numbers[triangle, corner, k] = int(name or 0)
    return Faces(numbers, np.ones(len(triangles), dtype=np.int32), (0, 1, 2))


def _numbers(lines: Lines, word: bytes, columns: int) -> Array:
    """The numbers of each line of a word, at least the first columns, shape (n, columns) or wider.  Raises ObjError where one is missing
    or none."""
    found = numbers_of(lines, word)
    if found is not None and found.shape[1] >= columns:
        return found
    rows = [line[len(word) :] for line in lines.of(word).split(b"\n")[1:]]
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


def _values(named: IntArray | None, lines: Lines, word: bytes, columns: int) -> Array | None:
    """What corners name, shape (n, columns), behind it zeros where one names none; None where all do, or one that is not there."""
    if named is None or not named.any():
        return None
    values = _numbers(lines, word, columns)[:, :columns]
    if named.max() > len(values):
        return None
    return values if named.min() > 0 else np.vstack([values, np.zeros(columns)])


def _surfaces(lines: Lines, path: Path, report: Report) -> dict[str, Surface]:
    """The surfaces of every ``mtllib`` that is there; a warning for one that is not."""
    surfaces: dict[str, Surface] = {}
    for start in lines.starts[lines.which(b"mtl")].tolist():
        if (match := _LIBRARY.match(lines.text, start)) is None:
            continue
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
