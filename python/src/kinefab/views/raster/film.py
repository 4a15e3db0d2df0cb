"""A moving scene as pictures: what stands still is drawn once, the rest frame by frame."""

from __future__ import annotations

import base64
from collections.abc import Callable, Mapping, Sequence
from html import escape
from typing import Any

import numpy as np

from ...diagnostics import printable
from ...spatial import Array, Pose
from ..bars import bars
from ..camera import View, looking
from ..freedoms import Placement
from ..picture import COLOURS, DrawnJoint, drawn_joints, hinge_axes, strokes_of, tied
from ..seen import shapes
from .image import Canvas, png
from .solid import Solid, solid

WIDTH, HEIGHT, MARGIN = 640, 440, 26
SECONDS = 4.0
"""Of the whole film."""
MOST_TRIANGLES = 1_000_000
"""Two kilobytes of memory each; of a scene with more each body is drawn as the box around it."""
COUPLED = (0.53, 0.18, 0.61)
Entry = Mapping[str, Any]
Writer = Callable[[Sequence[np.ndarray], str], bytes]


def pictures(
    document: Entry,
    buffers: Sequence[bytes],
    frames: Sequence[Sequence[Placement]],
    progress: Callable[[float], None] = lambda fraction: None,
) -> list[np.ndarray]:
    """The pixels of each frame, shape (height, width, 3).  frames: the placement of every GameObject, in Unity's world.

    progress: called with the part of the frames that is drawn, 0 to 1.
    """
    objects: Sequence[Entry] = document["gameObjects"]
    # At their scales, which no motion changes.
    seen = shapes(document, buffers, frames[0], MOST_TRIANGLES)
    solids = {shape.index: solid(shape.corners, shape.faces, shape.colours) for shape in seen}
    sticks = bars(objects)
    joints = [drawn_joints(objects, placements) for placements in frames]
    view = _camera(solids, frames, joints)
    moving = {i for i in solids if any(_moved(frames[0][i], placements[i]) for placements in frames)}
    ground = Canvas(view, WIDTH, HEIGHT)
    for i, shape in solids.items():
        if i not in moving:
            ground.surfaces(_placed(shape, frames[0][i]))
    found: list[np.ndarray] = []
    for placements, drawn in zip(frames, joints):
        canvas = ground.copy()
        placed = {i: _placed(shape, placements[i]) for i, shape in solids.items()}
        for i in sorted(moving):
            canvas.surfaces(placed[i])
        for shape in placed.values():
            canvas.edges(shape)
        for i, colour, ends in sticks:
            turn, place, _ = placements[i]
            canvas.stroke(ends @ turn.T + place, _rgb(colour), 7.0)
        for ends in tied(document, placements):
            canvas.stroke(ends, COUPLED)
        for joint in drawn:
            for stroke in strokes_of(joint, (WIDTH - 60) / view.scale):
                canvas.stroke(stroke, _rgb(COLOURS[joint.kind]))
        found.append(canvas.pixels())
        progress(len(found) / len(frames))
    return found


def _placed(shape: Solid, placement: Placement) -> Solid:
    turn, place, _ = placement
    return shape.placed(Pose(turn, place))


def _moved(one: Placement, other: Placement) -> bool:
    return bool(np.abs(one[0] - other[0]).max() > 1e-9 or np.abs(one[1] - other[1]).max() > 1e-9)


def _camera(
    solids: Mapping[int, Solid],
    frames: Sequence[Sequence[Placement]],
    joints: Sequence[Sequence[DrawnJoint]],
) -> View:
    """One for all frames."""
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    points: list[Array] = [np.zeros((0, 3))]
    for i, shape in solids.items():
        low, high = shape.corners.min(axis=(0, 1)), shape.corners.max(axis=(0, 1))
        box = (low + high) / 2 + signs * (high - low) / 2
        points += [box @ placements[i][0].T + placements[i][1] for placements in frames]
    points += [joint.pose.translation[None] for drawn in joints for joint in drawn]
    cloud = np.concatenate(points)
    return looking(cloud if len(cloud) else np.zeros((1, 3)), hinge_axes(joints[0]), WIDTH, HEIGHT, MARGIN)


def _rgb(colour: str) -> tuple[float, float, float]:
    red, green, blue = (int(colour[i : i + 2], 16) / 255.0 for i in (1, 3, 5))
    return red, green, blue


def animated_svg(images: Sequence[np.ndarray], title: str) -> bytes:
    """Every frame as a picture in the file, shown in turn; the title above them."""
    count = len(images)
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT + 30}" font-family="system-ui, sans-serif">',
        f'<rect width="{WIDTH}" height="{HEIGHT + 30}" fill="#ffffff"/>',
        f'<text x="14" y="22" font-size="15" font-weight="600" fill="#1d242c">{escape(printable(title))}</text>',
    ]
    for i, image in enumerate(images):
        data = base64.b64encode(png(image)).decode("ascii")
        times = sorted({0.0, i / count, (i + 1) / count} - {1.0})
        values = ";".join("inline" if t == i / count else "none" for t in times)
        animate = (
            f'<animate attributeName="display" calcMode="discrete" dur="{SECONDS:g}s" repeatCount="indefinite" '
            f'keyTimes="{";".join(f"{t:.6g}" for t in times)}" values="{values}"/>'
        )
        shown = "inline" if i == 0 else "none"
        lines.append(
            f'<image y="30" width="{WIDTH}" height="{HEIGHT}" display="{shown}" href="data:image/png;base64,{data}">'
            f"{animate if count > 1 else ''}</image>"
        )
    return ("\n".join([*lines, "</svg>"]) + "\n").encode("utf-8")


def by_pillow(kind: str) -> Writer:
    """A writer of ``gif``, ``webp`` or ``png`` (its first frame).  Raises ImportError without Pillow."""
    from PIL import Image, ImageDraw, ImageFont

    def write(images: Sequence[np.ndarray], title: str) -> bytes:
        from io import BytesIO

        titled: list[Image.Image] = []
        try:
            font = ImageFont.load_default(15)
        except TypeError:  # before Pillow 10.1 it has one size
            font = ImageFont.load_default()
        for pixels in images:
            whole = Image.new("RGB", (WIDTH, HEIGHT + 30), "white")
            whole.paste(Image.fromarray(pixels), (0, 30))
            # All that the small font has.
            text = printable(title).encode("latin-1", "replace").decode("latin-1")
            ImageDraw.Draw(whole).text((14, 8), text, fill=(29, 36, 44), font=font)
            titled.append(whole)
        out = BytesIO()
        if kind == "png":
            titled[0].save(out, "PNG", optimize=True)
            return out.getvalue()
        step = round(1000.0 * SECONDS / len(titled))
        if kind == "gif":
            palette = titled[0].quantize(128)
            titled = [image.quantize(palette=palette, dither=Image.Dither.NONE) for image in titled]
            titled[0].save(
                out, "GIF", save_all=True, append_images=titled[1:], duration=step, loop=0, optimize=True
            )
        else:
            titled[0].save(
                out,
                "WEBP",
                save_all=True,
                append_images=titled[1:],
                duration=step,
                loop=0,
                quality=82,
                method=4,
            )
        return out.getvalue()

    return write
