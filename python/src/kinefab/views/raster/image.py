"""Solids in an orthographic view, to RGB: shaded surfaces, hidden by depth, with edges; and lines over them."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Sequence
from functools import reduce
from typing import cast

import numpy as np

from ...spatial import Array
from ..camera import View
from .fragments import fragments
from .solid import Solid

FINER = 2
"""Pixels a side that are averaged to one."""
EDGE = np.array([0.09, 0.11, 0.14])
GROUND = np.array([1.0, 1.0, 1.0])


class Canvas:
    """A picture in the making.  view: in pixels of the finished picture."""

    def __init__(self, view: View, width: int, height: int):
        self.view, self.width, self.height = view, width * FINER, height * FINER
        self.colour = np.tile(GROUND, (self.width * self.height, 1))
        self.depth = np.full(self.width * self.height, -np.inf)

    def copy(self) -> Canvas:
        """Another one that looks the same so far."""
        other = Canvas.__new__(Canvas)
        other.view, other.width, other.height = self.view, self.width, self.height
        other.colour, other.depth = self.colour.copy(), self.depth.copy()
        return other

    def surfaces(self, shape: Solid) -> None:
        """Draw the sides that face the viewer, where nothing nearer is."""
        front = shape.facing @ self.view.toward > 0.0
        corners = shape.corners[front]
        light = self.view.toward + 0.55 * self.view.up - 0.45 * self.view.right
        light = light / np.linalg.norm(light)
        shade = 0.42 + 0.58 * np.clip(shape.normals[front] @ light, 0.0, 1.0)
        tints = shape.colours[front]
        flat = FINER * self.view.project(corners.reshape(-1, 3)).reshape(-1, 3, 2)
        for found in fragments(flat, corners @ self.view.toward, self.width, self.height):
            order = np.argsort(found.depth, kind="stable")
            order = order[found.depth[order] > self.depth[found.pixel[order]]]
            pixel, of = found.pixel[order], found.triangle[order]
            bright = np.einsum("ni,ni->n", found.weight[order], shade[of])
            self.depth[pixel] = found.depth[order]
            self.colour[pixel] = np.clip(tints[of] * bright[:, None], 0.0, 1.0) ** (1.0 / 2.2)

    def edges(self, shape: Solid) -> None:
        """Draw sharp edges and outlines that nothing hides."""
        self._lines(shape.drawn(self.view.toward), EDGE, 1, 0.72, hidden=True)

    def seen(self, lines: Array) -> list[tuple[tuple[float, float], tuple[float, float]]]:
        """The pieces of world lines, shape (n, 2, 3), that no surface hides, in pixels of the finished picture."""
        found: list[tuple[tuple[float, float], tuple[float, float]]] = []
        flat = self.view.project(lines.reshape(-1, 3)).reshape(-1, 2, 2)
        near = lines @ self.view.toward
        bias = 3.0 / (self.view.scale * FINER)
        for (start, end), (first, last) in zip(flat, near):
            share = np.linspace(0.0, 1.0, int(np.abs(end - start).max()) + 2)[:, None]
            place = np.floor(FINER * (start + share * (end - start))).astype(np.int64)
            place = np.clip(place, 0, [self.width - 1, self.height - 1])
            depth = self.depth[place[:, 1] * self.width + place[:, 0]]
            open_ = first + share[:, 0] * (last - first) + bias >= depth
            turns = np.flatnonzero(np.diff(np.concatenate([[False], open_, [False]]).astype(np.int8)))
            for a, b in zip(turns[::2], turns[1::2]):
                if b - a > 1:
                    ends = start + share[[a, b - 1]] * (end - start)
                    found.append(
                        ((float(ends[0, 0]), float(ends[0, 1])), (float(ends[1, 0]), float(ends[1, 1])))
                    )
        return found

    def stroke(self, points: Array, colour: Sequence[float], width: float = 2.0) -> None:
        """A line through world points, over everything.  width: in pixels."""
        lines = np.stack([points[:-1], points[1:]], axis=1)
        self._lines(lines, np.array(colour), max(1, round(width * FINER / 2)), 1.0, hidden=False)

    def _lines(self, lines: Array, colour: Array, reach: int, alpha: float, hidden: bool) -> None:
        if not len(lines):
            return
        flat = FINER * self.view.project(lines.reshape(-1, 3)).reshape(-1, 2, 2)
        near = lines @ self.view.toward
        count = np.ceil(np.abs(flat[:, 1] - flat[:, 0]).max(axis=1)).astype(np.int64) + 1
        of = np.repeat(np.arange(len(lines)), count)
        share = (np.arange(len(of)) - np.repeat(np.cumsum(count) - count, count)) / np.maximum(count - 1, 1)[
            of
        ]
        place = np.floor(flat[of, 0] + share[:, None] * (flat[of, 1] - flat[of, 0])).astype(np.int64)
        depth = near[of, 0] + share * (near[of, 1] - near[of, 0])
        painted = np.zeros(self.width * self.height, dtype=bool)
        bias = 3.0 / (self.view.scale * FINER)
        for dx in range(-(reach // 2), (reach + 1) // 2 + 1):
            for dy in range(-(reach // 2), (reach + 1) // 2 + 1):
                x, y = place[:, 0] + dx, place[:, 1] + dy
                inside = (x >= 0) & (x < self.width) & (y >= 0) & (y < self.height)
                pixel = y[inside] * self.width + x[inside]
                if hidden:
                    pixel = pixel[depth[inside] + bias >= self.depth[pixel]]
                painted[pixel] = True
        at = np.flatnonzero(painted)
        self.colour[at] = (1.0 - alpha) * self.colour[at] + alpha * colour

    def pixels(self) -> np.ndarray:
        """The finished picture, shape (height, width, 3), 8 bits."""
        each = self.colour.reshape(self.height // FINER, FINER, self.width // FINER, FINER, 3)
        # Added one after the other: numpy's mean over two axes takes twice the time.
        parts = [each[:, row, :, column] for row in range(FINER) for column in range(FINER)]
        fine: Array = reduce(np.add, parts) / FINER**2
        whole = cast("Array", np.round(255.0 * np.clip(fine, 0.0, 1.0)))
        return whole.astype(np.uint8)


def png(pixels: np.ndarray) -> bytes:
    """A picture, shape (height, width, 3), as PNG (RFC 2083: filter Sub on each line)."""
    height, width, _ = pixels.shape
    lines = pixels.astype(np.int16)
    lines[:, 1:] -= pixels[:, :-1]
    rows = np.concatenate(
        [np.ones((height, 1), np.uint8), (lines & 255).astype(np.uint8).reshape(height, -1)], axis=1
    )

    def chunk(name: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    body = zlib.compress(rows.tobytes(), 9)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", body) + chunk(b"IEND", b"")
