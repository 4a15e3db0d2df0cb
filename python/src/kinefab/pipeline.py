"""The export, read like a sentence: read, load the geometry, weigh, analyse, map to Unity, write."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Callable

from .analysis import AnalysisOptions, analyse
from .analysis.dof_records import joints_of_dof_records
from .analysis.reasons import holding
from .analysis.summary import scene_entry
from .diagnostics import KinefabError, Outcome, Report, Severity
from .geometry.hulls import collision_hulls
from .geometry.loading import MeshFiles, load_geometry
from .geometry.weighing import weigh
from .model import Scene
from .options import ColliderShape, ExportOptions
from .rigid import RigidGroups, rigid_groups
from .unity.colliders import Colliders
from .unity.document import Document, build_document
from .unity.writer import write_scene

Progress = Callable[[str, float], None]
"""Called with a stage's name and how much of it is done, 0 to 1."""


@dataclass(frozen=True, slots=True, eq=False)
class ExportResult:
    """path: the scene file.  buffer: the binary beside it, or None.  document: what was written."""

    path: Path
    buffer: Path | None
    document: Document
    report: Report


def export(
    source: str | Path | Scene,
    target: str | Path,
    options: ExportOptions = ExportOptions(),
    progress: Progress = lambda stage, fraction: None,
) -> ExportResult:
    """Export ``source`` to ``target`` (``NAME.kinefab``) and its buffer beside it.

    source: a file that a reader of ``kinefab.sources`` knows, or a Scene made in code.
    Raises KinefabError, with every error found, when the data is wrong (or lossy, if strict) or the target
    cannot be written; then the target is as it was.  Raises ValueError for a target of another ending: Unity
    imports by it.
    """
    if Path(target).suffix != ".kinefab":
        raise ValueError(f"the target is {os.fspath(target)!r}; its name must end in .kinefab")
    report = Report()
    try:
        files = MeshFiles(report)
        scene = _read(source, files, report, progress)
        if not scene.nodes:
            report.add("SCENE_WITHOUT_PARTS")
        scene = load_geometry(scene, files, report, progress)
        scene = weigh(scene, options.density, report)
        report.raise_for_errors()
        progress("analyse", 0.0)
        scene = replace(scene, joints=[*scene.joints, *joints_of_dof_records(scene, rigid_groups(scene), report)])
        found = analyse(
            scene, AnalysisOptions(options.closures, options.limits), lambda done: progress("limits", done)
        )
        report.extend(found.report)
        report.raise_for_errors()
        scene = found.scene(options.solve)
        groups = rigid_groups(scene, found.fixed)
        progress("analyse", 1.0)
        colliders = _colliders(scene, groups, options.colliders, report)
        document = build_document(scene, groups, colliders, report, scene_entry(found), holding(found))
        _refuse_losses(report, options.strict)
        buffer = _write(document, Path(target), report, progress)
    except KinefabError as error:
        error.report = report
        raise
    return ExportResult(Path(target), buffer, document, report)


def _read(source: str | Path | Scene, files: MeshFiles, report: Report, progress: Progress) -> Scene:
    if isinstance(source, Scene):
        return source
    from .sources import read

    progress("read", 0.0)
    scene = read(Path(source), report, files.vertices)
    progress("read", 1.0)
    return scene


def _colliders(scene: Scene, groups: RigidGroups, shape: ColliderShape, report: Report) -> Colliders:
    """The hulls that the asked-for colliders need, placed behind the scene's own meshes."""
    bodies = []
    for i, node in enumerate(scene.nodes):
        moves = groups.group_of[i] is not None and not groups.is_ground(i)
        if shape is ColliderShape.HULL or (shape is ColliderShape.MESH and moves):
            bodies += [(b.mesh, f"{node.id}/{b.name}") for b in node.bodies if b.mesh is not None]
    if shape is ColliderShape.MESH:
        for _, body in bodies:
            report.approximated(f"collider {body}", "COLLIDER_NOT_CONVEX", body=body)
    hulls = collision_hulls(scene, bodies, report)
    first = len(scene.meshes)
    return Colliders(shape, {mesh: first + i for i, mesh in enumerate(hulls)}, tuple(hulls.values()))


def _refuse_losses(report: Report, strict: bool) -> None:
    """Raise for errors; if strict, also for every loss that is worth a warning."""
    errors = report.of(Severity.ERROR)
    if strict:
        lossy = {o.code for o in report.outcomes if o.outcome is not Outcome.KEPT}
        errors += [d for d in report.of(Severity.WARNING) if d.code in lossy]
    if errors:
        raise KinefabError(errors)


def _write(document: Document, target: Path, report: Report, progress: Progress) -> Path | None:
    detail = ""
    if os.path.lexists(target) and not os.path.isfile(target):  # a rename would put a file in a device's place
        detail = "it is no regular file"
    elif any("\ud800" <= character <= "\udfff" for character in target.name):
        detail = "its name is not UTF-8, and the scene names its buffer"
    if detail:
        raise KinefabError([report.add("TARGET_UNWRITABLE", path=target, detail=detail)])
    try:
        return write_scene(document, target, lambda fraction: progress("write", fraction))
    except OSError as error:
        detail = error.strerror or str(error)
        raise KinefabError([report.add("TARGET_UNWRITABLE", path=target, detail=detail)]) from error
