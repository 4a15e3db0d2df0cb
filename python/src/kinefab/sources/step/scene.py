"""From what the guarded reader sends back to the scene's nouns: nodes with stable ids, shared meshes, surfaces."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import replace

import numpy as np

from ...color import encoded
from ...diagnostics import Report
from ...model import Body, Face, Node, NodeKind, Scene, Surface
from ...spatial import Array
from ..occ.triangles import mesh_of
from ..reading.placement import SKEWED, Placement, place
from ..reading.source_frame import SourceFrame
from .records import Color, Occurrence, Piece, Shape, Tree

NUMBERED = re.compile(r"^(NAUO\d*|=>\[[\d:]*\](:\d+)?|\d*)$")
"""Names of occurrences that writers invent: those of the product say more."""


def scene_nodes(
    tree: Tree, frame: SourceFrame, file: str, scaled: bool, report: Report
) -> tuple[list[Node], Placement, Array, set[str]]:
    """The nodes, without bodies, by how much each is larger than its shape, and which ids are counted (``Scene.counted``).

    file: name of the source, for places.  scaled: whether placements may be so; OpenCASCADE reads the scale of an IGES file,
    and that of a STEP file's operator as its inverse.
    """
    axes, origins = _world(tree.occurrences)
    scales = np.cbrt(np.abs(np.linalg.det(axes))) if scaled else np.ones(len(axes))
    scales[(np.abs(scales - 1.0) <= SKEWED) | ~(scales > 0.0)] = 1.0
    placement = place(axes / scales[:, None, None], origins, frame)
    used: Counter[str] = Counter()
    ids: list[str] = []
    nodes: list[Node] = []
    counted: set[str] = set()
    for i, found in enumerate(tree.occurrences):
        name = _label(found)
        parent = found.parent
        path = name if parent is None else f"{ids[parent]}/{name}"
        used[path] += 1
        if again := used[path] > 1:  # a writer that names occurrences after their product alone
            name = f"{name}:{used[path]}"
            path = name if parent is None else f"{ids[parent]}/{name}"
            while used[path]:
                name += "'"
                path += "'"
            used[path] += 1
        ids.append(path)
        if again or NUMBERED.match(found.name) or found.name == found.product:
            counted.add(path)
        where = f"{file}#{path}"
        if placement.deviation[i] > SKEWED:
            report.add(
                "POSE_NOT_ORTHONORMAL",
                where,
                component=path,
                deviation=f"{placement.deviation[i]:.2g}",
                limit=SKEWED,
            )
        elif placement.mirrored[i]:
            report.add("POSE_MIRRORED", where, component=path)
        definition = found.product or found.key
        if scales[i] != 1.0:
            definition = f"{definition} (scaled {scales[i]:.6g})"
            if found.shape is not None:
                report.add("IGES_SCALED", where, component=path, scale=f"{scales[i]:.6g}")
        nodes.append(
            Node(
                id=path,
                name=name,
                kind=NodeKind.ASSEMBLY if found.shape is None else NodeKind.PART,
                parent=parent,
                pose=placement.pose(i),
                definition=f"{definition} (mirrored)" if placement.mirrored[i] else definition,
                flexible=found.shape is None,
                visible=found.visible,
                layer=", ".join(found.layers),
                where=where,
            )
        )
    return nodes, placement, scales, counted


def _label(found: Occurrence) -> str:
    given = found.name if not NUMBERED.match(found.name) else ""
    name = given or ("" if NUMBERED.match(found.product) else found.product) or "Part"
    return "".join(c if c.isprintable() else " " for c in name).strip().replace("/", "_") or "Part"


def _world(occurrences: list[Occurrence]) -> tuple[Array, Array]:
    """Axes (n, 3, 3) and origins (n, 3) in the source's world."""
    axes, origins = np.empty((len(occurrences), 3, 3)), np.empty((len(occurrences), 3))
    for i, found in enumerate(occurrences):
        own, origin = found.matrix[:, :3], found.matrix[:, 3]
        if found.parent is not None:
            origin = axes[found.parent] @ origin + origins[found.parent]
            own = axes[found.parent] @ own
        axes[i], origins[i] = own, origin
    return axes, origins


class Shapes:
    """Meshes and surfaces of the scene while shapes come in; every occurrence of a shape shares its meshes."""

    def __init__(self, scene: Scene, tree: Tree, placement: Placement, scales: Array) -> None:
        self._scene, self._placement, self._scales = scene, placement, scales
        self._users: dict[int, list[int]] = {}
        for i, found in enumerate(tree.occurrences):
            if found.shape is not None:
                self._users.setdefault(found.shape, []).append(i)
        self._tree = tree
        self._surfaces: dict[Color, int] = {}

    def users(self, shape: int) -> list[int]:
        """The nodes that show a shape."""
        return self._users.get(shape, [])

    def add(self, shape: Shape) -> None:
        """Put a meshed shape on every occurrence that shows it."""
        shared: dict[tuple[bool, float], list[tuple[int, tuple[Color | None, ...], tuple[Face, ...]]]] = {}
        for node in self.users(shape.number):
            kind = bool(self._placement.mirrored[node]), float(self._scales[node])
            if kind not in shared:
                local, length = self._placement.local[node], self._placement.length * kind[1]
                shared[kind] = [self._mesh(piece, local, length) for piece in shape.pieces]
            own, around = self._tree.occurrences[node].color, self._around(node)
            bodies = tuple(
                Body(piece.name, mesh, self._colored(looks, own, around), boundary=faces)
                for piece, (mesh, looks, faces) in zip(shape.pieces, shared[kind], strict=True)
            )
            self._scene.nodes[node] = replace(self._scene.nodes[node], bodies=bodies)

    def _mesh(
        self, piece: Piece, turn: Array, length: float
    ) -> tuple[int, tuple[Color | None, ...], tuple[Face, ...]]:
        """The piece's mesh in the scene, what its submeshes look like, and its exact faces.  length: metres in its unit."""
        to_node = np.eye(4)
        to_node[:3, :3] = turn * length
        mesh, looks = mesh_of(piece.name, piece.mesh, to_node, piece.looks)
        self._scene.meshes.append(mesh)
        return (
            len(self._scene.meshes) - 1,
            looks,
            tuple(_in_node(face, turn, length) for face in piece.boundary),
        )

    def _around(self, node: int) -> Color | None:
        """The colour of the nearest assembly round an occurrence that has one."""
        parent = self._tree.occurrences[node].parent
        while parent is not None and self._tree.occurrences[parent].color is None:
            parent = self._tree.occurrences[parent].parent
        return None if parent is None else self._tree.occurrences[parent].color

    def _colored(
        self, looks: tuple[Color | None, ...], own: Color | None, around: Color | None
    ) -> tuple[int, ...]:
        """A surface for each submesh: the occurrence's colour, else those of the shape, else that of the assembly round
        it; none where nothing is stated."""
        colors = [own or color or around for color in looks]
        if not any(colors):
            return ()
        return tuple(self._surface(color or DEFAULT_COLOR) for color in colors)

    def _surface(self, color: Color) -> int:
        if color not in self._surfaces:
            self._surfaces[color] = len(self._scene.surfaces)
            self._scene.surfaces.append(Surface(_color_name(color), color))
        return self._surfaces[color]


DEFAULT_COLOR: Color = Surface("").color


def _color_name(color: Color) -> str:
    """The colour as people write it: sRGB, in hexadecimals."""
    levels = [round(255.0 * min(max(c, 0.0), 1.0)) for c in (*map(encoded, color[:3]), color[3])]
    return "#" + "".join(f"{level:02X}" for level in (levels if levels[3] < 255 else levels[:3]))


def _in_node(face: Face, turn: Array, length: float) -> Face:
    """A face of a shape in the node's frame.  turn: orthogonal; a mirror turns angles about the axis round."""
    mirrored = float(np.linalg.det(turn)) < 0.0
    first, last = face.around
    corners = face.triangles @ turn.T * length
    return replace(
        face,
        point=turn @ face.point * length,
        direction=turn @ face.direction,
        secondary=turn @ face.secondary,
        radius=face.radius * length,
        minor=face.minor * length,
        along=(face.along[0] * length, face.along[1] * length),
        around=(-last, -first) if mirrored else (first, last),
        triangles=corners[:, ::-1] if mirrored else corners,
    )
