"""The written-down pairs and mechanisms, as scenes, and their independently computed values."""

from __future__ import annotations

import csv
import sys
from functools import lru_cache
from pathlib import Path

ROOT = Path(__file__).parents[2]
DATA = Path(__file__).parent / "data" / "mechanisms"
sys.path.insert(0, str(ROOT / "fixtures"))

from generator.case import Case  # noqa: E402
from generator.mechanisms import all_mechanisms  # noqa: E402
from generator.pairs import all_pairs  # noqa: E402
from generator.scene import scene_of  # noqa: E402

from kinefab.analysis import Analysis, analyse  # noqa: E402
from kinefab.model import Scene  # noqa: E402


@lru_cache(maxsize=1)
def cases() -> dict[str, Case]:
    return {case.id: case for case in [*all_pairs(), *all_mechanisms()]}


def scene(id: str) -> Scene:
    return scene_of(cases()[id])


@lru_cache(maxsize=None)
def analysed(id: str) -> Analysis:
    return analyse(scene(id))


def table(name: str) -> list[dict[str, str]]:
    with open(DATA / f"{name}.csv", encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def node(scene: Scene, name: str) -> int:
    return next(i for i, n in enumerate(scene.nodes) if n.name == name)
