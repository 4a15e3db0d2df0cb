"""STEP and IGES files: the assembly tree, names, instances, colours, layers and exact geometry.

OpenCASCADE reads them in a process of its own (``sources.guard``).  Neither format states mates; the pairs of an
AP242 file's kinematic mechanism are read from its text.  Z is taken to be up, as CAD programs have it.
"""

from __future__ import annotations

import hashlib
from dataclasses import replace
from pathlib import Path

from ...diagnostics import Report
from ...model import NodeKind, Scene, Source
from ..guard import GuardedCrash, GuardedError, guarded
from ..occ.asked import tolerance_of
from ..occ.triangles import Tolerance
from ..reading.file import read_bytes
from ..reading.request import Request
from ..reading.source_frame import DIRECTIONS, FORWARD, SourceFrame, turn_to_scene
from .external import check_external
from .iges.unit import metres_of
from .iges.untranslated import tell_untranslated
from .mechanism import add_pairs
from .part21 import Part21
from .records import Begun, Shape, Tree
from .scene import Shapes, scene_nodes
from .stated.materials import add_densities
from .stated.operators import tell_mirrors
from .stated.products import shapeless

MAX_BYTES = 512 * 2**20
"""Largest file that is read."""
SECONDS, SECONDS_PER_MEGABYTE = 20.0, 60.0
"""How long OpenCASCADE may take."""
MOST_CRASHES = 5
"""Shapes that may take the reading process along before the file is given up."""
CONTEXT_COLOR = b"CONTEXT_DEPENDENT_OVER_RIDING_STYLED_ITEM"
"""A colour for some occurrences alone, which OpenCASCADE reads only where a specified higher usage says of which."""
MILLIMETRE = 1e-3
"""OpenCASCADE's own unit: it brings every file into it."""


def read(path: Path, report: Report, request: Request = Request()) -> Scene:
    """The scene of a ``.step``, ``.stp``, ``.iges`` or ``.igs`` file.  Raises KinefabError with every error found.

    request: ``tolerance`` and ``up``.  A shape whose geometry fails is reported and left out.
    """
    iges = path.suffix.lower() in (".iges", ".igs")
    data = read_bytes(path, report, MAX_BYTES)
    text = Part21(b"" if iges else data)
    if iges:
        _check_iges(data, path, report)
        tell_untranslated(data, path.name, report)
        length = metres_of(data)
    else:
        length = _check_step(text, path, report)
    size = len(data) + check_external(text, path, MAX_BYTES, report)
    tolerance = tolerance_of(request, path, report)
    report.raise_for_errors()
    up = request.text("up", "Z")
    frame = SourceFrame(turn_to_scene(DIRECTIONS[up], DIRECTIONS[FORWARD[up]]), MILLIMETRE)
    scene = Scene(source=Source(path.name, up, length, hashlib.sha256(data).hexdigest()))
    drawn, bare = _fill(scene, path, iges, tolerance, size, frame, report, request)
    empty = shapeless(text) if bare else frozenset[str]()
    for name, nodes in bare:
        if name in empty:
            drawn += nodes
        else:
            _tell_failed(name, "it holds no faces", scene.nodes[nodes[0]].where, report)
    tell_mirrors(text, path.name, report)
    add_densities(scene, text, report)
    if count := text.plain.count(CONTEXT_COLOR):
        report.dropped("colours of occurrences", "STEP_COLOR_CONTEXT", path.name, count=count)
    if text.kinematic_pairs():
        add_pairs(scene, text, frame.turn, length, report)
    _set_aside(scene, drawn)
    report.raise_for_errors()
    return scene


def _fill(
    scene: Scene, path: Path, iges: bool, tolerance: Tolerance, size: int,
    frame: SourceFrame, report: Report, request: Request,
) -> tuple[list[int], list[tuple[str, list[int]]]]:  # fmt: skip
    """Read the file into the scene; where a shape takes the process along, once more without it.

    Returns the nodes that are curves and points alone; and of each shape in which nothing is its name and its nodes.
    """
    drawn: list[int] = []
    bare: list[tuple[str, list[int]]] = []
    tree: Tree | None = None
    shapes: Shapes | None = None
    done: set[int] = set()
    begun: int | None = None
    seconds = SECONDS + SECONDS_PER_MEGABYTE * size / 2**20
    # By a relative path OpenCASCADE finds no external file; and the process may have been begun in another folder.
    file = str(path.absolute())
    for _ in range(MOST_CRASHES + 1):
        try:
            module = f"{__package__}.xcaf"
            for found in guarded(module, "load", file, iges, tolerance, frozenset(done), seconds=seconds):
                if isinstance(found, Tree) and shapes is None:
                    tree = found
                    scene.nodes, placement, scales, scene.counted = scene_nodes(found, frame, path.name, iges, report)
                    shapes = Shapes(scene, found, placement, scales)
                elif isinstance(found, Begun):
                    begun = found.shape
                elif isinstance(found, Shape) and shapes is not None and tree is not None:
                    done.add(found.number)
                    begun = None
                    shapes.add(found)
                    _report_losses(found, shapes, tree, scene, report)
                    if found.lines:
                        drawn += shapes.users(found.number)
                    elif not found.pieces and not found.failure:
                        bare.append((tree.shapes[found.number], shapes.users(found.number)))
                    request.progress(len(done) / len(tree.shapes))
            if not any(node.bodies for node in scene.nodes):
                report.add("STEP_EMPTY", path.name, path=path.name)
            return drawn, bare
        except GuardedError as error:
            report.add("STEP_UNREADABLE", path.name, path=path.name, detail=error)
            return drawn, bare
        except GuardedCrash as crash:
            if begun is None or shapes is None or tree is None:
                report.add(
                    "STEP_UNREADABLE", path.name, path=path.name, detail=f"OpenCASCADE gave up: {crash}"
                )
                return drawn, bare
            done.add(begun)
            failed = Shape(begun, [], f"OpenCASCADE gave up: {crash}")
            begun = None
            _report_losses(failed, shapes, tree, scene, report)
    report.add(
        "STEP_UNREADABLE",
        path.name,
        path=path.name,
        detail=f"more than {MOST_CRASHES} of its shapes end OpenCASCADE",
    )
    return drawn, bare


def _set_aside(scene: Scene, drawn: list[int]) -> None:
    """What is curves and points alone, the skeleton of an assembly, or nothing, is no body that could fall, unless a pair moves
    it."""
    named = {node for joint in scene.joints for node in (joint.a, joint.b)}
    named |= {feature.node for constraint in scene.constraints for feature in constraint.features}
    for i in drawn:
        if i not in named:
            scene.nodes[i] = replace(scene.nodes[i], kind=NodeKind.ASSEMBLY, flexible=True)


def _report_losses(shape: Shape, shapes: Shapes, tree: Tree, scene: Scene, report: Report) -> None:
    name = tree.shapes[shape.number]
    for node in shapes.users(shape.number)[:1]:
        where = scene.nodes[node].where
        if shape.lines:
            report.dropped(f"curves of {name}", "STEP_CURVES_ALONE", where, name=name)
        if shape.failure:
            _tell_failed(name, shape.failure, where, report)
        for piece in shape.pieces:
            if piece.mesh.missing:
                report.approximated(
                    f"shape {name}", "STEP_FACES_FAILED", where, name=name, count=piece.mesh.missing
                )


def _tell_failed(name: str, detail: str, where: str, report: Report) -> None:
    report.dropped(f"shape {name}", "STEP_SHAPE_FAILED", where, name=name, detail=detail)


def _check_step(text: Part21, path: Path, report: Report) -> float:
    """What the text itself shows to be wrong; metres in its unit."""
    if not text.starts:
        report.add("STEP_SYNTAX", path.name, path=path.name, detail="it does not start with ISO-10303-21")
    elif not text.ends:
        report.add("STEP_SYNTAX", path.name, path=path.name, detail="its end is missing (END-ISO-10303-21)")
    elif not text.instances:
        report.add("STEP_EMPTY", path.name, path=path.name)
    elif dangling := text.dangling():
        report.add("STEP_DANGLING", path.name, path=path.name, count=dangling)
    return text.metres()


def _check_iges(data: bytes, path: Path, report: Report) -> None:
    """An IGES file has lines of 80 columns whose 73rd names the section."""
    lines = data.splitlines()
    sections = {line[72:73] for line in lines if len(line) >= 73}
    if not {b"S", b"G", b"D", b"P"} <= sections:
        report.add("STEP_SYNTAX", path.name, path=path.name, detail="sections of an IGES file are missing")
    elif b"T" not in sections:
        report.add("STEP_SYNTAX", path.name, path=path.name, detail="its end is missing (section T)")
