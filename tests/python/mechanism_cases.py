"""The written-down pairs and mechanisms, as scenes, and their independently computed values."""

from __future__ import annotations

import csv
import json
import tempfile
from functools import cache
from pathlib import Path

import numpy as np
from kinefab.analysis import Analysis, AnalysisOptions, Closures, analyse
from kinefab.diagnostics import Report
from kinefab.model import Scene
from kinefab.sources import read

ROOT = Path(__file__).parents[2]
DATA = Path(__file__).parent / "data" / "mechanisms"
MINIMAL = AnalysisOptions(closures=Closures.MINIMAL)
"""Closing joints with the fewest rows: what most can go wrong with, as the analysis chooses them."""
FOLDERS = {"P": "pairs", "M": "mechanisms"}


@cache
def scene(id: str) -> Scene:
    """The scene of a fixture, read from its bundle.  Treat as read-only."""
    report = Report()
    found = read(ROOT / "fixtures" / FOLDERS[id[0]] / f"{id}.bundle.json", report)
    report.raise_for_errors()
    return found


def scene_written(id: str, up: str, mirrored: bool = False) -> Scene:
    """The fixture as a program with another up axis writes it and the reader brings it back.

    mirrored: the parts but ground's have left-handed axes, as mirrored parts do in a CAD assembly.
    """
    # columns: where the fixture's own X, Y (up) and Z (forward) lie in the other program's axes
    to = {
        "X": np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]),
        "Y": np.eye(3),
        "Z": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]),
    }[up]
    path = ROOT / "fixtures" / FOLDERS[id[0]] / f"{id}.bundle.json"
    bundle = json.loads(path.read_text("utf-8"))
    bundle["meta"]["up"] = up
    for component in bundle["components"]:
        pose = component["pose"]
        own = to @ np.column_stack([pose[k] for k in "xyz"]) @ to.T
        if mirrored and not component.get("grounded"):
            own[:, 0] *= -1.0
        component["pose"] = {"o": (to @ pose["o"]).tolist()}
        component["pose"] |= {k: own[:, i].tolist() for i, k in enumerate("xyz")}
    for constraint in bundle["constraints"]:
        for feature in (constraint[side] for side in "abc" if side in constraint):
            feature.update({k: (to @ feature[k]).tolist() for k in "pdx" if k in feature})
    with tempfile.TemporaryDirectory() as folder:
        written = Path(folder) / path.name
        written.write_text(json.dumps(bundle), "utf-8")
        report = Report()
        found = read(written, report)
    report.raise_for_errors()
    return found


@cache
def analysed(id: str) -> Analysis:
    """With the fewest rows of its closing joints."""
    return analyse(scene(id), MINIMAL)


def all_ids() -> list[str]:
    return [row["id"] for row in table("mobility")]


def table(name: str) -> list[dict[str, str]]:
    with open(DATA / f"{name}.csv", encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def node(scene: Scene, name: str) -> int:
    return next(i for i, n in enumerate(scene.nodes) if n.name == name)
