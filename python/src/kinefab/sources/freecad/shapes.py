"""The B-reps of a document as meshes.  OpenCASCADE reads them where it is installed; without it parts stay bare."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from ...diagnostics import Report
from ...extras import install
from ...model import Body, Scene
from ..guard import GuardedCrash, GuardedError, guarded
from ..occ import EXTRA, available
from ..occ.triangles import Tessellation, Tolerance, mesh_of
from ..reading.record import shown
from .archive import ArchiveError
from .document import UNIT, Thing
from .looks import Looks
from .parts import ShownShape, scene_matrix

NO_LIBRARY = f"OpenCASCADE is not installed: {install(EXTRA)}"
BREP = "kinefab.sources.occ.brep"
SECONDS, SECONDS_PER_MEGABYTE = 120.0, 20.0
"""For the shapes of a document together: two minutes, and more for large ones."""
MOST_CRASHES = 20
"""Shapes that may end OpenCASCADE before the rest is given up."""


class Shapes:
    """Shapes as they are asked for, each read and tessellated once, in a process that a damaged one may take along."""

    def __init__(self, report: Report, tolerance: Tolerance):
        self._report = report
        self._tolerance = tolerance
        self._bytes: dict[tuple[object, str], bytes | None] = {}
        self._cut: dict[tuple[object, str], Tessellation | None] = {}
        self._without = 0

    def _content(self, owner: Thing) -> bytes | None:
        """The bytes of an object's shape; None for an empty one, and after a report."""
        if owner.key not in self._bytes:
            self._bytes[owner.key] = None
            file = owner.file("Shape")
            if file:  # an empty shape has none
                try:
                    self._bytes[owner.key] = owner.document.archive.read(file)
                except ArchiveError as error:
                    self._lost(owner, str(error))
        return self._bytes[owner.key]

    def element(self, owner: Thing, kind: str, number: int) -> tuple[str, float] | None:
        """The word for a numbered ``Edge`` or ``Face`` and its radius in millimetres; None where it cannot be told."""
        content = self._content(owner)
        if content is None or not available():
            return None
        try:
            file = owner.file("Shape")
            answers: list[tuple[str, float] | None] = list(
                guarded(BREP, "element", file, content, kind, number, seconds=SECONDS)
            )
            return answers[0]
        except (GuardedError, GuardedCrash):
            return None

    def _tessellate(self, owners: list[Thing], progress: Callable[[float], None]) -> None:
        """Fill in the triangles of all owners, those of a shape that ends the kernel left out."""
        waiting: dict[int, tuple[Thing, bytes]] = {}
        for number, owner in enumerate(owners):
            self._cut[owner.key] = None
            content = self._content(owner)
            if content is not None and not available():
                self._without += 1
            elif content is not None:
                waiting[number] = owner, content
        total = max(1, len(waiting))
        for _ in range(MOST_CRASHES):
            if not waiting:
                return
            asked = [(number, owner.file("Shape"), content) for number, (owner, content) in waiting.items()]
            seconds = SECONDS + SECONDS_PER_MEGABYTE * sum(len(content) for *_, content in asked) / 2**20
            try:
                for number, found in guarded(
                    BREP, "tessellations", asked, self._tolerance, UNIT, seconds=seconds
                ):
                    owner, _ = waiting.pop(number)
                    self._answered(owner, found)
                    progress(1.0 - len(waiting) / total)
            except (GuardedError, GuardedCrash) as error:
                owner, _ = waiting.pop(next(iter(waiting)))
                self._lost(owner, f"OpenCASCADE gave up: {error}")
        for owner, _ in waiting.values():
            self._lost(owner, "too many shapes before it ended OpenCASCADE")

    def _answered(self, owner: Thing, found: Tessellation | str) -> None:
        if isinstance(found, str):
            self._lost(owner, found)
            return
        self._cut[owner.key] = found
        if found.missing:
            self._lost(owner, f"{found.missing} of its {len(found.counts)} faces could not be meshed")

    def _lost(self, owner: Thing, detail: str) -> None:
        label = shown(owner.label)
        self._report.dropped(f"shape of {label}", "SHAPE_NOT_READ", owner.where, object=label, detail=detail)

    def load(
        self, scene: Scene, wanted: list[ShownShape], looks: Looks, progress: Callable[[float], None]
    ) -> None:
        """Gives the nodes of the scene their bodies, equal ones one mesh."""
        meshes: dict[tuple[object, ...], int] = {}
        self._tessellate(list({one.owner.key: one.owner for one in wanted}.values()), progress)
        for one in wanted:
            node = scene.nodes[one.node]
            cut = self._cut[one.owner.key]
            if cut is None or not len(cut.triangles):
                if one.owner.file("Shape") and (cut is None):
                    body = Body(one.name, density=looks.density(one), visible=one.visible)
                    scene.nodes[one.node] = replace(node, bodies=(*node.bodies, body))
                continue
            colours = looks.of(one, len(cut.counts))
            to_node = scene_matrix(one.at)
            mesh, order = mesh_of(one.name, cut, to_node, colours)
            key = (
                one.owner.key,
                to_node.tobytes(),
                mesh.face_counts,
                tuple(colours) if len(order) > 1 else (),
            )
            if key not in meshes:
                meshes[key] = len(scene.meshes)
                origin = f"{one.owner.document.path.name}#{one.owner.name}"
                scene.meshes.append(replace(mesh, origin=origin))
            body = Body(one.name, meshes[key], tuple(order), looks.density(one), visible=one.visible)
            scene.nodes[one.node] = replace(node, bodies=(*node.bodies, body))
        if self._without:
            self._report.dropped(
                f"{self._without} shapes",
                "SHAPE_NOT_READ",
                "",
                object=f"{self._without} parts",
                detail=NO_LIBRARY,
            )
