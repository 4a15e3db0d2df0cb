"""A source or a written scene as a picture: one that moves (animated SVG, GIF or WebP), one PNG; a source also as a still SVG."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path

import numpy as np

from .analysis import analyse
from .diagnostics import KinefabError, Report, diagnostic
from .extras import install
from .mechanism import Mechanism, Trajectory, mechanism_of
from .model import Scene
from .options import ExportOptions
from .pipeline import Progress, silent
from .showing import read_document, title_of
from .spatial import Array, Pose, matrix_from_quaternion
from .unity import frames
from .unity.back.restored import Restored, restored
from .unity.back.scene_file import unsound_as_finding
from .views.extent import span_of
from .views.freedoms import Placement
from .views.picture import draw
from .views.raster.film import Writer, animated_svg, by_pillow, pictures

FRAMES = 40
ENDINGS = (".svg", ".gif", ".webp", ".png")


def film(
    source: str | Path | Scene,
    ending: str,
    joint: str | None = None,
    options: ExportOptions = ExportOptions(),
    found: Report | None = None,
    progress: Progress = silent,
) -> bytes:
    """The picture's file.  ending: one of ``ENDINGS``; a ``.png`` is still.  joint: what is driven; the first freedom.
    options: what the source is exported with.  found: takes what that found.  progress: told how far the drawing is.

    Raises KinefabError when the data is wrong or a library is missing, ValueError for a joint that is none.
    """
    writer = _writer(ending)
    with unsound_as_finding(Path("a scene" if isinstance(source, Scene) else source)):
        document, buffers = read_document(source, options, found)
        back = restored(document)
        mechanism = mechanism_of(analyse(back.scene))
    still = ending == ".png" or not mechanism.freedoms
    motion = None
    if not still:
        progress("moving", 0.0)
        motion = there_and_back(mechanism, joint or mechanism.freedoms[0].name, span_of(document))
        progress("moving", 1.0)
    with unsound_as_finding(Path("a scene" if isinstance(source, Scene) else source)):
        drawing = partial(progress, "drawing")
        images = pictures(document, buffers, _placements(back, motion), drawing)
    return writer(images, title_of(document, source))


def still(source: str | Path, options: ExportOptions = ExportOptions(), found: Report | None = None) -> bytes:
    """A source as the SVG of the scene that would be written of it: its bodies, its joints and how far they move.

    options, found: as of ``film``.  Raises KinefabError when the data is wrong.
    """
    with unsound_as_finding(Path(source)):
        document, buffers = read_document(source, options, found)
        return draw(document, buffers).encode("utf-8")


def _writer(ending: str) -> Writer:
    if ending == ".svg":
        return animated_svg
    try:
        return by_pillow(ending[1:])
    except ImportError as error:
        values = {"target": ending[1:].upper(), "library": "Pillow", "install": install("picture")}
        raise KinefabError([diagnostic("TARGET_LIBRARY_MISSING", **values)]) from error


def there_and_back(mechanism: Mechanism, name: str, span: float) -> Trajectory:
    """A motion that ends where it began: round, where the mechanism comes round, else to both ends of what it reaches.

    span: of what is seen, metres; a slide goes half of it to each side at most.
    """
    coordinate = mechanism.coordinate(name)
    turns = coordinate.unit == "deg"
    far = 360.0 if turns else 0.5 * span
    low, high = max(coordinate.lower, coordinate.value - far), min(coordinate.upper, coordinate.value + far)
    if turns and high - low >= 720.0 - 1e-9:
        whole = mechanism.sweep(name, coordinate.value, coordinate.value + 360.0, frames=FRAMES + 1)
        if whole.stop is None:
            return whole
    ends: list[float] = []
    for end in (low, high):
        reached = mechanism.sweep(name, coordinate.value, end, frames=61)
        ends.append(end if reached.stop is None else float(reached[name][-1]))
    phase = np.linspace(0.0, 2.0 * np.pi, FRAMES + 1)
    return mechanism.follow({name: ends[0] + (ends[1] - ends[0]) * 0.5 * (1.0 - np.cos(phase))})


def _placements(back: Restored, motion: Trajectory | None) -> list[list[Placement]]:
    """The GameObjects of each frame in Unity's world."""
    start = [node.pose for node in back.scene.nodes]
    if motion is None:
        return [_mirrored(back.poses, back.scales)]
    found: list[list[Placement]] = []
    for frame in motion.poses[:-1] if len(motion) > 1 else motion.poses:
        moved = [Pose(matrix_from_quaternion(p[3:]), p[:3]) @ at.inverse() for p, at in zip(frame, start)]
        found.append(_mirrored([moved[n] @ pose for n, pose in zip(back.node_of, back.poses)], back.scales))
    return found


def _mirrored(poses: Sequence[Pose], scales: Sequence[Array]) -> list[Placement]:
    return [
        (frames.rotation(pose.rotation), frames.point(pose.translation), scale)
        for pose, scale in zip(poses, scales)
    ]
