"""Draws ``csharp/house.svg``: the halls and rooms of the C# library on their floors, beside what they were.

Floors and rooms are those that ``FloorTests.cs`` holds, the numbers the files of each.  ``python csharp/draw_house.py``
writes it anew.
"""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LIBRARY = ROOT / "csharp" / "src" / "Kinefab"
FLOORS = ROOT / "tests" / "csharp" / "Kinefab.Tests" / "Architecture" / "FloorTests.cs"
PICTURE = ROOT / "csharp" / "house.svg"

BEFORE = {
    "Advice": 8, "Kinematics": 47, "Dynamics": 18, "Joints": 18, "Validation": 24, "Document": 59, "Json": 13,
    "Diagnostics": 8, "Numerics": 13,
}  # fmt: skip
"""Files in each hall on 26 November 2026; below Dynamics stood Exact with 40 and Pgs with 15."""
ROAD = {"Json": 1, "Reading": 2, "Document": 3, "Validation": 4, "Mechanisms": 5, "Dynamics": 6, "Kinematics": 6, "Advice": 7}
"""The halls that a file passes, in order."""
WIDTH, LEFT, TOP, ROW = 1290, 20, 86, 44
STYLE = """
text { font: 12px system-ui, sans-serif; fill: #1f2933 } .title { font-size: 20px; font-weight: 600 }
.name { font-weight: 600; font-size: 13px } .small { fill: #52606d; font-size: 11px } .number { fill: #fff; font-weight: 700 }
rect { fill: #f5f7fa; stroke: #9aa5b1 } .road { fill: #e3f0ff; stroke: #2f6fb5 } .inner { fill: #fff; stroke: #cbd2d9 }
circle { fill: #2f6fb5 } @media (prefers-color-scheme: dark) { svg { background: #fff } }
"""


def halls() -> list[str]:
    """From the ground up."""
    table = FLOORS.read_text("utf-8").partition("Below = new()")[2].partition("};")[0]
    return re.findall(r'^\s*\["(\w+)"\] =', table, re.MULTILINE)


def rooms() -> list[str]:
    """The rooms of halls that have several, from the ground up."""
    table = FLOORS.read_text("utf-8").partition("string[] Rooms =")[2].partition("];")[0]
    return re.findall(r'"([\w/]+)"', table)


def count(room: str) -> int:
    return len(list((LIBRARY / room).glob("*.cs")))


def text(x: float, y: float, content: str, kind: str = "") -> str:
    return f'<text x="{x:.0f}" y="{y:.0f}" class="{kind}">{content}</text>'


def box(x: float, y: float, width: float, height: float, kind: str = "") -> str:
    return f'<rect x="{x:.0f}" y="{y:.0f}" width="{width:.0f}" height="{height:.0f}" rx="5" class="{kind}"/>'


def picture() -> str:
    drawn = [
        text(LEFT, 32, "Kinefab: the rooms of the C# library", "title"),
        text(LEFT, 54, "A hall uses only what stands below it, a room only its hall's rooms before it. The numbers are the road of a file.", "small"),
        text(LEFT, 76, "before", "small"),
        text(300, 76, "now, with the files of each room", "small"),
    ]
    most = max(BEFORE.values())
    y = TOP
    for hall in reversed(halls()):
        if hall in BEFORE:
            drawn.append(box(LEFT, y, 72 + 170 * BEFORE[hall] / most, ROW - 10))
            drawn.append(text(LEFT + 8, y + 21, f"{hall} {BEFORE[hall]}", "small"))
        inner: list[str] = []
        at, line = 430.0, 0
        for room in [r for r in rooms() if r.split("/")[0] == hall] or [hall]:
            label = f"{room.partition('/')[2] or '·'} {count(room)}"
            size = 6.4 * len(label) + 12
            if at + size > WIDTH - LEFT - 6:
                at, line = 430.0, line + 1
            inner += [box(at, y + 8 + 24 * line, size, 20, "inner"), text(at + 6, y + 22 + 24 * line, label, "small")]
            at += size + 6
        drawn.append(box(300, y, WIDTH - 300 - LEFT, ROW - 8 + 24 * line, "road" if hall in ROAD else ""))
        if hall in ROAD:
            drawn += [f'<circle cx="316" cy="{y + 18}" r="9"/>', text(312.5, y + 22, str(ROAD[hall]), "number")]
        drawn += [text(332, y + 22, hall, "name"), *inner]
        y += ROW + 24 * line
    size = f'viewBox="0 0 {WIDTH} {y + 8}" width="{WIDTH}" height="{y + 8}"'
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size}>\n<style>{STYLE}</style>\n' + "\n".join(drawn) + "\n</svg>\n"


if __name__ == "__main__":
    PICTURE.write_text(picture(), encoding="utf-8")
