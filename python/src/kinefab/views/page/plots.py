"""Curves over one driven coordinate, as an SVG that takes the page's colours."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

import numpy as np

from ...spatial import Array

WIDTH, HEIGHT = 880, 260
LEFT, RIGHT, TOP, BOTTOM = 92, 190, 12, 40
COLOURS = ("#e8590c", "#1c7ed6", "#2f9e44", "#9c36b5")
STEPS = 6
"""Lines of the grid each way, about."""
OF_A_TURN, LEAST_OF_A_TURN = (15, 30, 60, 90, 180, 360), 12.0
"""Degrees between two lines of the grid, and from which on they are not tens."""
FLAT, NOTHING = 1e-6, 1e-9
"""What is no curve but the last digits of a solution: of the largest value, and in metres or degrees."""


@dataclass(frozen=True, slots=True, eq=False)
class Curve:
    """name: as it is told beside the curve.  values: over the driven coordinate, shape (frames,)."""

    name: str
    values: Array


def plot(
    driven: Array, curves: Sequence[Curve], across: str, up: str, turns: tuple[bool, bool] = (False, False)
) -> str:
    """The SVG text.  driven: shape (frames,), ascending.  across, up: what the axes count, with the unit; turns: whether that
    is degrees, of either."""
    x0, x1 = float(driven[0]), float(driven[-1])
    everything = np.concatenate([c.values for c in curves])
    y0, y1 = _span(float(everything.min()), float(everything.max()))
    x1 = x1 if x1 > x0 else x0 + 1.0

    def at_x(x: float) -> float:
        return LEFT + (x - x0) / (x1 - x0) * (WIDTH - LEFT - RIGHT)

    def at_y(y: float) -> float:
        return HEIGHT - BOTTOM - (y - y0) / (y1 - y0) * (HEIGHT - TOP - BOTTOM)

    lines = [f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img" font-size="12" fill="currentColor">']
    for x in ticks(x0, x1, turns[0]):
        lines.append(_line(at_x(x), TOP, at_x(x), HEIGHT - BOTTOM))
        lines.append(f'<text x="{at_x(x):.1f}" y="{HEIGHT - BOTTOM + 16}" text-anchor="middle">{x:g}</text>')
    for y in ticks(y0, y1, turns[1]):
        lines.append(_line(LEFT, at_y(y), WIDTH - RIGHT, at_y(y)))
        lines.append(f'<text x="{LEFT - 6}" y="{at_y(y) + 4:.1f}" text-anchor="end">{y:g}</text>')
    for i, curve in enumerate(curves):
        points = " ".join(
            f"{at_x(x):.1f},{at_y(y):.1f}" for x, y in zip(driven.tolist(), curve.values.tolist())
        )
        colour = COLOURS[i % len(COLOURS)]
        lines.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"/>')
        y = TOP + 14 + 20 * i
        lines.append(f'<rect x="{WIDTH - RIGHT + 12}" y="{y - 8}" width="14" height="3" fill="{colour}"/>')
        name = curve.name if len(curve.name) <= 24 else curve.name[:23] + "…"
        lines.append(f'<text x="{WIDTH - RIGHT + 32}" y="{y - 2}">{escape(name)}</text>')
    middle = LEFT + (WIDTH - LEFT - RIGHT) / 2
    lines.append(f'<text x="{middle:.0f}" y="{HEIGHT - 6}" text-anchor="middle">{escape(across)}</text>')
    turned = f'transform="translate(14 {HEIGHT / 2 - 10:.0f}) rotate(-90)"'
    lines.append(f'<text {turned} text-anchor="middle">{escape(up)}</text></svg>')
    return "".join(lines)


def _span(low: float, high: float) -> tuple[float, float]:
    """What the axis shows of values between low and high: some room at either end, and a constant as a straight line."""
    most = max(abs(low), abs(high))
    if most <= NOTHING:
        return -1.0, 1.0
    room = 0.06 * (high - low) if high - low > max(FLAT * most, NOTHING) else 0.5 * most
    return low - room, high + room


def _line(x0: float, y0: float, x1: float, y1: float) -> str:
    ends = f'x1="{x0:.1f}" y1="{y0:.1f}" x2="{x1:.1f}" y2="{y1:.1f}"'
    return f'<line {ends} stroke="currentColor" stroke-opacity="0.15"/>'


def ticks(low: float, high: float, turns: bool = False) -> list[float]:
    """Round numbers between two ends, some six of them.  turns: of degrees, whose round numbers divide a turn or are turns."""
    rough = (high - low) / STEPS
    whole = 360.0 if turns and rough > 360.0 else 1.0
    power = 10.0 ** np.floor(np.log10(rough / whole))
    step = float(whole * power * min((1, 2, 5, 10), key=lambda m: abs(m * whole * power - rough)))
    if turns and LEAST_OF_A_TURN < rough <= 360.0:
        step = float(min(OF_A_TURN, key=lambda part: abs(part - rough)))
    first = int(np.ceil(low / step - 1e-9))
    last = int(np.floor(high / step + 1e-9))
    return [float(f"{k * step:.10g}") for k in range(first, last + 1)]
