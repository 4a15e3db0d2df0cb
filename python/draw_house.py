"""Draws ``python/house.svg``: the package's rooms on their floors, and the road of a file through them.

Floors are those that ``tests/python/test_floors.py`` holds, the words each room's own first line, formats and outputs what
the registries list.  ``python python/draw_house.py`` writes it anew.
"""

from __future__ import annotations

import ast
import html
import sys
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "python" / "src" / "kinefab"
PICTURE = ROOT / "python" / "house.svg"
sys.path[:0] = [str(ROOT / "tests" / "python"), str(PACKAGE.parent)]

from kinefab.sources import FORMATS  # noqa: E402
from kinefab.targets import TARGETS  # noqa: E402
from test_floors import FLOORS  # noqa: E402

WIDTH, GAP, LEFT, TOP = 1240, 10, 20, 112
ROAD = {"sources": 1, "model": 2, "geometry": 3, "analysis": 4, "unity": 5, "targets": 6}
"""The rooms that a file passes, in order."""
STYLE = """
text { font: 12px system-ui, sans-serif; fill: #1f2933 } .title { font-size: 22px; font-weight: 600 }
.name { font-weight: 600; font-size: 13px } .small { fill: #52606d; font-size: 11px } .number { fill: #fff; font-weight: 700 }
rect { fill: #f5f7fa; stroke: #9aa5b1 } .road { fill: #e3f0ff; stroke: #2f6fb5 } .inner { fill: #fff; stroke: #cbd2d9 }
circle { fill: #2f6fb5 } @media (prefers-color-scheme: dark) { svg { background: #fff } }
"""


def first_line(path: Path) -> str:
    told = ast.get_docstring(ast.parse(path.read_text("utf-8"))) or ""
    head, _, tail = told.split("\n\n")[0].replace("\n", " ").partition(": ")
    line = tail if tail and " " not in head else head
    line = line.split(";")[0].split(". ")[0].rstrip(".")
    return line[0].upper() + line[1:]


def words(name: str) -> str:
    path = PACKAGE / name
    return first_line(path / "__init__.py" if path.is_dir() else path.with_suffix(".py"))


def inside(name: str) -> list[str]:
    """The rooms of a room, from the ground up."""
    folder = PACKAGE / name
    if name in FLOORS:
        return [room for floor in FLOORS[name] for room in sorted(floor) if room != "__init__"]
    return (
        sorted(p.name for p in folder.iterdir() if (p / "__init__.py").is_file()) if folder.is_dir() else []
    )


def text(x: float, y: float, content: str, kind: str = "") -> str:
    return f'<text x="{x:.0f}" y="{y:.0f}" class="{kind}">{html.escape(content)}</text>'


def room(name: str, x: float, y: float, width: float, height: float) -> list[str]:
    kind = "road" if name in ROAD else ""
    drawn = [
        f'<rect x="{x:.0f}" y="{y:.0f}" width="{width:.0f}" height="{height:.0f}" rx="6" class="{kind}"/>'
    ]
    if name in ROAD:
        drawn += [
            f'<circle cx="{x + 16:.0f}" cy="{y + 16:.0f}" r="9"/>',
            text(x + 12.5, y + 20, str(ROAD[name]), "number"),
        ]
    label = name if (PACKAGE / name).is_dir() else f"{name}.py"
    drawn.append(text(x + (32 if name in ROAD else 8), y + 20, label, "name"))
    lines = textwrap.wrap(words(name), max(10, int((width - 12) / 5.9)))
    for line in lines[:3]:
        drawn.append(text(x + 8, y + 36 + 14 * lines.index(line), line, "small"))
    at, row = x + 8, y + 44 + 14 * min(3, len(lines))
    for inner in inside(name):
        size = 6.6 * len(inner) + 12
        if at + size > x + width - 6:
            at, row = x + 8, row + 24
        drawn.append(
            f'<rect x="{at:.0f}" y="{row - 4:.0f}" width="{size:.0f}" height="20" rx="4" class="inner"/>'
        )
        drawn.append(text(at + 6, row + 10, inner, "small"))
        at += size + 5
    return drawn


def height_of(name: str, width: float) -> float:
    lines = min(3, len(textwrap.wrap(words(name), max(10, int((width - 12) / 5.9)))))
    rows, at = (1, 0.0) if inside(name) else (0, 0.0)
    for inner in inside(name):
        size = 6.6 * len(inner) + 17
        if at + size > width - 14:
            rows, at = rows + 1, 0.0
        at += size
    return 34 + 14 * lines + 24 * rows + (10 if rows else 0)


def picture() -> str:
    formats = ", ".join(sorted({suffix for entry in FORMATS for suffix in entry.suffixes}))
    outputs = ", ".join(ending for entry in TARGETS for ending in entry.endings)
    drawn = [
        text(LEFT, 34, "kinefab: the rooms of the package, and the road of a file", "title"),
        text(LEFT, 58, f"in: {formats}"),
        text(LEFT, 76, f"out: {outputs}"),
        text(
            LEFT,
            94,
            "A room imports only what stands below it. The numbers are the road: read, hold, weigh, analyse, map, write.",
            "small",
        ),
    ]
    y = float(TOP)
    for floor in reversed(FLOORS[""]):
        names = sorted(floor - {"__init__", "__main__"}, key=lambda n: (-len(inside(n)), n))
        if not names:
            continue
        shares = [1.0 + 0.35 * len(inside(name)) for name in names]
        total = WIDTH - 2 * LEFT - GAP * (len(names) - 1)
        widths = [max(120.0, total * share / sum(shares)) for share in shares]
        widths = [w * total / sum(widths) for w in widths]
        height = max(height_of(name, w) for name, w in zip(names, widths))
        x = float(LEFT)
        for name, w in zip(names, widths):
            drawn += room(name, x, y, w, height)
            x += w + GAP
        y += height + GAP + 6
    size = f'viewBox="0 0 {WIDTH} {y:.0f}" width="{WIDTH}" height="{y:.0f}"'
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" {size}>\n<style>{STYLE}</style>\n'
        + "\n".join(drawn)
        + "\n</svg>\n"
    )


if __name__ == "__main__":
    PICTURE.write_text(picture(), encoding="utf-8")
