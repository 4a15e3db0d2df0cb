"""The written-down pairs and mechanisms, as scenes, and their independently computed values."""

from __future__ import annotations

import csv
from functools import lru_cache
from pathlib import Path

from kinefab.analysis import Analysis, analyse
from kinefab.diagnostics import Report
from kinefab.model import Scene
from kinefab.sources import read

ROOT = Path(__file__).parents[2]
DATA = Path(__file__).parent / "data" / "mechanisms"
FOLDERS = {"P": "pairs", "M": "mechanisms"}


@lru_cache(maxsize=None)
def scene(id: str) -> Scene:
    """The scene of a fixture, read from its bundle.  Treat as read-only."""
    report = Report()
    found = read(ROOT / "fixtures" / FOLDERS[id[0]] / f"{id}.bundle.json", report)
    report.raise_for_errors()
    return found


@lru_cache(maxsize=None)
def analysed(id: str) -> Analysis:
    return analyse(scene(id))


def all_ids() -> list[str]:
    return [row["id"] for row in table("mobility")]


def table(name: str) -> list[dict[str, str]]:
    with open(DATA / f"{name}.csv", encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def node(scene: Scene, name: str) -> int:
    return next(i for i, n in enumerate(scene.nodes) if n.name == name)
