"""What people look at, of a source or a written scene: the page that plays it."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, cast

import numpy as np

from .analysis import analyse
from .analysis.driving.baking import baked
from .diagnostics import KinefabError, Report, diagnostic
from .mates.apply import with_found
from .mates.mates_file import document as mates_document
from .mates.mates_file import listed
from .mechanism import Mechanism, check_source, mechanism_of
from .model import Joint, Scene
from .options import ExportOptions, check_options
from .pipeline import export, mates_of
from .replacing import why_unwritable, write_whole
from .spatial import Array, Pose
from .unity.back.restored import Restored, restored
from .unity.back.scene_file import read_scene, unsound_as_finding
from .unity.mapping import GROUND_ID
from .views.extent import ends_in_sight, span_of
from .views.page.blob import Blob
from .views.page.describe import Motion, description
from .views.page.page import page
from .views.page.words import Stroke, report_words

Entry = Mapping[str, Any]
AUTO = "auto"
"""Of the reading option ``mates``: those found in the geometry."""
STROKE_FRAMES = 181
MOST_STROKES = 12
"""Freedoms that a report plots."""


def view(
    source: str | Path | Scene,
    target: str | Path,
    options: ExportOptions = ExportOptions(),
    found: Report | None = None,
) -> Path:
    """Write the page of a source, a written ``NAME.kinefab`` or a Scene made in code to ``target`` (``NAME.html``).

    What is shown is the scene as it is exported, and how its joints let it move.
    options: what the source is exported with.  Its reading option ``mates``, "auto" or a ``NAME.mates.json``, has those
    mates listed by number, to be switched and copied back; of a written scene they are listed only.
    found: takes what reading and exporting the source found.
    Raises KinefabError when the data is wrong or the target cannot be written; then the target is as it was.  Raises
    TypeError for a source, a target or options that are none.

    >>> import kinefab, trimesh
    >>> scene = kinefab.Scene()
    >>> door = scene.add_part("Door", trimesh.creation.box((0.8, 2.0, 0.04)), translation=(0.4, 1.0, 0.0))
    >>> hinge = scene.add_hinge(None, door, point=(0, 1, 0), axis=(0, 1, 0), limits=(0, 110), name="Hinge")
    >>> kinefab.view(scene, "door.html").name
    'door.html'
    """
    return _written(source, target, options, found, told=False)


def _written(
    source: str | Path | Scene, target: str | Path, options: ExportOptions, found: Report | None, told: bool
) -> Path:
    check_source(source)
    check_options(options)
    if not isinstance(cast(object, target), (str, os.PathLike)):
        raise TypeError(f"the target is {target!r}; pass the path of the page, NAME.html")
    target = Path(target)
    found = Report() if found is None else found
    mates, shown = _with_mates(source, options, found)
    with unsound_as_finding(Path("a scene" if isinstance(source, Scene) else source)):
        document, buffers = read_document(shown, options, found)
        text = page_of(document, buffers, title_of(document, source), told, mates)
    try:
        write_whole(target, text.encode("utf-8"))
    except OSError as error:
        detail = why_unwritable(target, error)
        raise KinefabError([diagnostic("TARGET_UNWRITABLE", path=target, detail=detail)]) from error
    return target


def _with_mates(
    source: str | Path | Scene, options: ExportOptions, report: Report
) -> tuple[Entry | None, str | Path | Scene]:
    """The mates that are asked for as their file has them, None for none; and the source, with those that were found in it."""
    asked = str(options.reading.get("mates", ""))
    if not asked:
        return None, source
    if asked != AUTO:
        return listed(Path(asked), report), source
    if isinstance(source, Scene) or is_written(source):
        raise ValueError("mates are found in an assembly file; pass a NAME.mates.json to list")
    scene, found = mates_of(source, options.reading, report)
    return mates_document(scene, found), with_found(scene, found, report)


def is_written(source: str | Path) -> bool:
    """Whether it is a scene file, and no source."""
    return Path(source).suffix.lower() == ".kinefab"


def read_document(
    source: str | Path | Scene, options: ExportOptions = ExportOptions(), found: Report | None = None
) -> tuple[Entry, list[bytes]]:
    """The scene file's content and its buffers; a source is exported first, beside nothing of the user's.

    found: takes what that found.
    """
    if not isinstance(source, Scene) and is_written(source):
        return read_scene(Path(source))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scene.kinefab"
        result = export(source, path, options)
        if found is not None:
            found.extend(result.report)
        return read_scene(path)


def title_of(document: Entry, source: str | Path | Scene) -> str:
    """The name of what was read: the only object at the top, else the source's file, without endings."""
    objects = document["gameObjects"]
    ground = next((i for i, o in enumerate(objects) if o.get("id") == GROUND_ID), None)
    tops = [o["name"] for i, o in enumerate(objects) if o.get("parent") in (None, ground) and i != ground]
    if len(tops) == 1:
        return str(tops[0])
    uri = str(document.get("source", {}).get("uri", ""))
    if uri:
        return Path(uri).name.split(".")[0]
    return "Scene" if isinstance(source, Scene) else os.path.basename(source).split(".")[0]


def page_of(
    document: Entry, buffers: Sequence[bytes], title: str, told: bool = False, mates: Entry | None = None
) -> str:
    """The HTML text of a scene's page.  told: with the report under it."""
    back = restored(document)
    mechanism = mechanism_of(analyse(back.scene))
    blob = Blob()
    shown = description(document, buffers, motion_of(back, mechanism), title, blob)
    if mates is not None:
        shown["mates"] = mates
    if not told:
        return page(shown, blob, "")
    span = span_of(document)
    strokes = [stroke_of(mechanism, freedom.name, span) for freedom in mechanism.freedoms[:MOST_STROKES]]
    return page(shown, blob, report_words(shown, strokes))


def stroke_of(mechanism: Mechanism, name: str, span: float) -> Stroke:
    """A freedom through its whole reach, and what moves with it.  span: see ``reach_of``."""
    coordinate = mechanism.coordinate(name)
    low, high, ends = reach_of(mechanism, name, span)
    motion = mechanism.sweep(name, low, high, frames=STROKE_FRAMES)
    moving: list[tuple[str, str, Array]] = []
    for other in mechanism.coordinates:
        values = motion[other.name]
        if other.name != name and len(motion) and float(np.ptp(values)) > 1e-6:
            moving.append((other.name, other.unit, values))
    branchings = [branching.value for branching in motion.branchings]
    return Stroke(name, coordinate.unit, motion[name], ends, moving, branchings)


def reach_of(mechanism: Mechanism, name: str, span: float) -> tuple[float, float, tuple[str, str]]:
    """How far a coordinate goes both ways, as the source shows it, and what ends it, in words.

    A turn without end is told over 360 degrees, a slide over ``span``, the scene's, metres.
    """
    coordinate = mechanism.coordinate(name)
    turns = coordinate.unit == "deg"
    far = 360.0 if turns else span
    limits = coordinate.lower, coordinate.upper
    if not turns:
        limits = ends_in_sight(coordinate.value, *limits, span)
    ends: list[float] = []
    words: list[str] = []
    for sign, limit in zip((-1.0, 1.0), limits):
        goal = limit if np.isfinite(limit) else coordinate.value + sign * far
        stop = mechanism.sweep(name, coordinate.value, goal, frames=61).stop
        if stop is None:
            ends.append(goal)
            words.append("its limit" if np.isfinite(limit) else "and on")
        elif stop.coordinate == name:
            ends.append(stop.value - sign * 1e-6 * far)
            words.append(f"a {stop.reason}" if stop.reason == "dead point" else "its limit")
        else:
            reached = mechanism.sweep(name, coordinate.value, goal, frames=721)
            ends.append(float(reached[name][-1]))
            words.append(f"the limit of {stop.coordinate}")
    if words == ["and on", "and on"] and turns:
        return coordinate.value, coordinate.value + 360.0, ("it turns all the way round", "a turn later")
    return ends[0], ends[1], (words[0], words[1])


def report(
    source: str | Path | Scene,
    target: str | Path,
    options: ExportOptions = ExportOptions(),
    found: Report | None = None,
) -> Path:
    """As ``view``, with the analysis in words, plots of the driven freedoms and the loss report under it.

    >>> import kinefab, trimesh
    >>> scene = kinefab.Scene()
    >>> door = scene.add_part("Door", trimesh.creation.box((0.8, 2.0, 0.04)), translation=(0.4, 1.0, 0.0))
    >>> hinge = scene.add_hinge(None, door, point=(0, 1, 0), axis=(0, 1, 0), limits=(0, 110), name="Hinge")
    >>> kinefab.report(scene, "door.html").name
    'door.html'
    """
    return _written(source, target, options, found, told=True)


def motion_of(back: Restored, mechanism: Mechanism) -> Motion:
    """A restored scene's motion as the page takes it."""
    scene, bodies = mechanism.scene, mechanism.body_of_part
    closing = [after.pose @ before.pose.inverse() for after, before in zip(scene.nodes, back.scene.nodes)]
    joints: dict[tuple[int, int], tuple[Joint, tuple[int, int], tuple[Pose, Pose]]] = {}
    for place, joint in back.joints.items():
        ends = [(joint.a or 0, joint.frame_a), (joint.b or 0, joint.frame_b)]
        at_a, at_b = (scene.pose(node) @ frame for node, frame in ends)
        joints[place] = joint, (bodies[joint.a or 0], bodies[joint.b or 0]), (at_a, at_b)
    coordinates = {
        c.name: (c.joint, mechanism.freedom_of(c.name), *mechanism.internal(c)) for c in mechanism.coordinates
    }
    return Motion(
        max(bodies, default=0) + 1,
        [bodies[node] for node in back.node_of],
        [closing[node] @ pose for node, pose in zip(back.node_of, back.poses)],
        back.scales,
        joints,
        coordinates,
        baked(mechanism),
        mechanism.mobility,
    )
