"""The road of a scene, read like a sentence: prepared, analysed, written.

``prepared`` reads a source, loads its geometry and weighs it; ``analysed`` finds the mechanism; ``export`` hands it to a
target.  It, ``analyse`` and everything else that asks about a mechanism share the first two.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, cast

from .analysis import Analysis, AnalysisOptions, analyse
from .analysis.collector import collector_paused
from .analysis.findings.reasons import holding
from .analysis.findings.summary import scene_entry
from .analysis.joints.dof_records import joints_of_dof_records
from .analysis.joints.stated_limits import check_limits
from .diagnostics import KinefabError, Report, named
from .geometry.collision import collision_meshes
from .geometry.contact.helping import with_helpers
from .geometry.loading import MeshFiles, load_geometry
from .geometry.looks.shading import with_normals
from .geometry.looks.soundness import with_sound_meshes
from .geometry.plausibility import check_plausible
from .geometry.weighing import weigh
from .mates import Mates
from .mates.asked import found_mates, mated
from .model import Scene
from .options import ExportOptions, check_options
from .replacing import why_unwritable
from .rigid import RigidGroups, rigid_groups
from .sources import Stage, read, read_stage
from .sources.parts.readers import part_readers
from .targets import check_target, known_endings, target_of, write
from .targets.content import Content
from .unity.back.source import WrittenScene
from .unity.bodies.colliders import Colliders
from .unity.contact.grouped import with_groups_apart
from .unity.contact.mated import with_mated_apart
from .unity.contact.overlaps import check_overlaps
from .unity.contact.welded import with_welded_apart
from .unity.joints.breaking import with_sound_breaks
from .unity.mapping import map_scene
from .unity.scene import Joint as UnityJoint
from .unity.scene import UnityScene
from .unity.switched_off import with_switched_off

Progress = Callable[[str, float], None]
"""Called with a stage's name and how much of it is done, 0 to 1."""


def silent(stage: str, fraction: float) -> None:
    """Progress that nobody watches."""


@dataclass(frozen=True, slots=True, eq=False)
class Analysed:
    """scene: with the found joints, as it is to be exported.  groups: its rigid groups, with what constraints fix."""

    analysis: Analysis
    scene: Scene
    groups: RigidGroups


@dataclass(frozen=True, slots=True, eq=False)
class ExportResult:
    """path: the file that was named, its ending as the target writes it.  files: everything that was written, that one first.
    report: every finding, and what became of each feature.

    >>> import kinefab, trimesh
    >>> scene = kinefab.Scene()
    >>> part = scene.add_part("Part", trimesh.creation.box((0.8, 2.0, 0.04)), grounded=True)
    >>> result = kinefab.export(scene, "part.kinefab")
    >>> result.path.name, result.numbers  # objects, joints, meshes
    ('part.kinefab', (2, 0, 1))
    """

    path: Path
    files: tuple[Path, ...]
    analysed: Analysed
    content: Content
    report: Report

    def __repr__(self) -> str:
        """In one line: the whole scene is in it."""
        return f"<ExportResult: {self.path}; {self.report!r}>"

    @property
    def numbers(self) -> tuple[int, int, int]:
        """Objects, joints and meshes: in Unity's terms where the target asked for them, else of the model.

        >>> scene = kinefab.Scene()
        >>> hinge = scene.add_hinge(None, scene.add_part("Door"), point=(0, 0, 0), axis=(0, 1, 0))
        >>> kinefab.export(scene, "door.kinefab").numbers
        (2, 1, 0)
        """
        mapped, scene = self.content.in_unity, self.analysed.scene
        if mapped is None:
            return len(scene.nodes), len(scene.joints), len(scene.meshes)
        components = (component for entry in mapped.gameObjects for component in entry.components)
        return len(mapped.gameObjects), sum(isinstance(c, UnityJoint) for c in components), len(mapped.meshes)

    @property
    def unity(self) -> UnityScene:
        """What was exported, in Unity's terms.

        >>> scene = kinefab.Scene()
        >>> hinge = scene.add_hinge(None, scene.add_part("Door"), point=(0, 0, 0), axis=(0, 1, 0))
        >>> [entry.name for entry in kinefab.export(scene, "door.kinefab").unity.gameObjects]
        ['Ground', 'Door']
        """
        return self.content.unity()


def prepared(
    source: str | Path | Scene | Stage, options: ExportOptions, report: Report, progress: Progress = silent
) -> Scene:
    """The scene of a source with geometry loaded, masses weighed, freedom records turned into joints.

    source: a file that a reader of ``kinefab.sources`` knows, an open ``pxr.Usd.Stage``, or a Scene made in code.
    Raises KinefabError with every error found.
    """
    files = MeshFiles(report, part_readers())
    scene = source if isinstance(source, Scene) else _read(source, options.reading, files, report, progress)
    if isinstance(scene, WrittenScene):
        scene.tell_unused(options, report)
    if not scene.nodes:
        report.add("SCENE_WITHOUT_PARTS")
    scene = with_sound_breaks(mated(scene.with_disabled_apart(), options.reading, report), report)
    check_limits(scene, report)
    scene = with_sound_meshes(load_geometry(scene, files, report, progress), report)
    report.raise_for_errors()
    scene, read_scene = weigh(scene, options.density, report), scene
    check_plausible(scene, read_scene, options.density, report)
    report.raise_for_errors()
    return replace(scene, joints=[*scene.joints, *joints_of_dof_records(scene, rigid_groups(scene), report)])


def mates_of(
    source: str | Path, reading: Mapping[str, object], report: Report, progress: Progress = silent
) -> tuple[Scene, Mates]:
    """A source as it is read, and the mates found in its geometry.  Raises KinefabError with every error found."""
    files = MeshFiles(report, part_readers())
    own = {name: value for name, value in reading.items() if name != "mates"}
    scene = _read(Path(source), own, files, report, progress)
    progress("mates", 0.0)
    found = found_mates(scene, str(reading.get("ground", "")), report)
    if found.ground is None:
        report.add("MATES_WITHOUT_FACES", scene.source.uri)
    report.raise_for_errors()
    progress("mates", 1.0)
    return scene, found


def analysed(scene: Scene, options: ExportOptions, report: Report, progress: Progress = silent) -> Analysed:
    """What may move in a prepared scene; what is wrong with it is in the report."""
    progress("analyse", 0.0)
    found = analyse(
        scene, AnalysisOptions(options.closures, options.limits), lambda done: progress("limits", done)
    )
    report.extend(_untold(found.report, report))
    _tell_unjoined(found, report)
    exported = with_helpers(found.scene(options.solve))
    together = [*found.fixed, *found.built]
    if isinstance(scene, WrittenScene):
        exported = scene.in_its_order(exported)
        together += scene.pieces
    groups = rigid_groups(exported, together)
    exported = with_mated_apart(exported, groups)
    progress("analyse", 1.0)
    return Analysed(found, exported, groups)


UNREAD = frozenset("CONSTRAINT_KIND_UNKNOWN CONSTRAINT_GEOMETRY_UNKNOWN".split())
"""What a reader tells of a constraint that it does not understand."""


def _untold(found: Report, report: Report) -> Report:
    """What an analysis found, without that it does not interpret a constraint of which the reader said why."""
    unread = {o.feature for o in report.outcomes if o.code in UNREAD}
    told = {o.message for o in found.outcomes if o.code == "CONSTRAINT_NOT_INTERPRETED" and o.feature in unread}
    return Report(
        [d for d in found.diagnostics if d.message not in told],
        [o for o in found.outcomes if o.message not in told or not o.message],
    )


def _tell_unjoined(found: Analysis, report: Report) -> None:
    """That all of an assembly falls apart: nothing is joined, fixed or grounded.

    One part alone is a thing that falls, and a loose one beside a mechanism, or on a floor, mostly is meant to; but of parts that are to
    be an assembly somebody expects that they hold.  A file of exact shapes has been told of by what it needs, its mates.
    """
    if found.joints or any(found.groups.grounded) or len(found.groups.members) < 2:
        return
    if any(node.dynamics.kinematic for node in found.source.nodes):
        return
    if not any(told.code == "MATES_NOT_ASKED" for told in report.diagnostics):
        first = [found.source.nodes[members[0]].id for members in found.groups.members]
        report.add("NOTHING_JOINED", count=len(first), parts=named(first, 3))


@collector_paused()
def export(
    source: str | Path | Scene | Stage,
    target: str | Path,
    options: ExportOptions = ExportOptions(),
    progress: Progress = silent,
) -> ExportResult:
    """Export ``source`` to ``target``, by whose ending the kind of output is chosen (``NAME.kinefab`` ...).

    source: a file that a reader of ``kinefab.sources`` knows, an open ``pxr.Usd.Stage``, or a Scene made in code.
    progress: called with a stage's name (``read``, ``meshes`` ...) and how much of it is done, 0 to 1.
    Raises KinefabError, with every error found, when the data is wrong (or lossy, if strict) or the target
    cannot be written; then the target is as it was.  Raises ValueError for a target of an ending that no target has and
    for a word that an option has not, TypeError for a source, a target or options that are none.

    >>> import kinefab, trimesh
    >>> scene = kinefab.Scene()
    >>> door = scene.add_part("Door", trimesh.creation.box((0.8, 2.0, 0.04)), translation=(0.4, 1.0, 0.0))
    >>> hinge = scene.add_hinge(None, door, point=(0, 1, 0), axis=(0, 1, 0), limits=(0, 110), name="Hinge")
    >>> result = kinefab.export(scene, "door.kinefab")
    >>> [(outcome.feature, outcome.outcome.value) for outcome in result.report.outcomes]
    [('collider Door/Door', 'kept'), ('joint Hinge', 'kept')]
    """
    if not isinstance(cast(object, target), (str, os.PathLike)):
        raise TypeError(f"the target is {target!r}; pass a path that ends in {' or '.join(known_endings())}")
    path = Path(target)
    kind = target_of(path)
    if kind is None:
        known = " or ".join(known_endings())
        raise ValueError(f"the target is {os.fspath(target)!r}; its name must end in {known}")
    check_options(options)
    if not (isinstance(source, (str, Path, Scene)) or hasattr(source, "GetRootLayer")):
        raise TypeError(
            f"the source is {source!r}; pass a file's path, a kinefab.Scene or an open pxr.Usd.Stage"
        )
    report = Report()
    try:
        asked = check_target(kind, options.writing, report)
        report.raise_for_errors()
        found = analysed(prepared(source, options, report, progress), options, report, progress)
        report.raise_for_errors()
        content = Content(
            found.scene,
            found.groups,
            found.analysis.findings,
            partial(_mapped, found, options, report=report),
            report,
            asked,
            options.strict,
            partial(progress, "write"),
            options.colliders,
            options.smooth,
        )
        # A rename would put a file in a device's place.
        if os.path.lexists(path) and not os.path.isfile(path):
            detail = "it is no regular file"
            raise KinefabError([report.add("TARGET_UNWRITABLE", path=path, detail=detail)])
        try:
            files = write(kind, content, path)
        except OSError as error:
            detail = why_unwritable(path, error)
            raise KinefabError([report.add("TARGET_UNWRITABLE", path=path, detail=detail)]) from error
    except KinefabError as error:
        error.report = report
        raise
    report.settle()
    return ExportResult(files[0], files, found, content, report)


def _read(
    source: str | Path | Stage,
    options: Mapping[str, Any],
    files: MeshFiles,
    report: Report,
    progress: Progress,
) -> Scene:
    progress("read", 0.0)
    if isinstance(source, (str, Path)):
        scene = read(source, report, files.vertices, options, lambda done: progress("read", done))
    else:
        scene = read_stage(source, report, options)
    progress("read", 1.0)
    return scene


def _mapped(found: Analysed, options: ExportOptions, links: bool, report: Report) -> UnityScene:
    """links: whether joints make links of the bodies that they join."""
    if isinstance(found.scene, WrittenScene) and (as_written := found.scene.as_written(links, options, report)):
        return as_written
    scene, groups = with_normals(found.scene, options.smooth), found.groups
    made = collision_meshes(found.scene, groups, options.colliders, options.ground, report)
    colliders = Colliders.behind(len(scene.meshes), made, options.colliders, options.ground)
    entry, held = scene_entry(found.analysis), holding(found.analysis)
    mapped = map_scene(scene, groups, colliders, report, entry, held, found.analysis.findings)
    mapped = with_groups_apart(with_welded_apart(mapped), found.scene, report)
    if not links:  # of links the target that makes them tells
        check_overlaps(mapped, report)
    mapped = with_switched_off(mapped, found.scene, groups, report)
    report.settle()
    return mapped
