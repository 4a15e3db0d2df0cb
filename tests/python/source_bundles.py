"""Bundles in code, and the pose a joint takes by formulas of its own."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
from kinefab import sources
from kinefab.diagnostics import Report
from kinefab.model import Joint, Scene

FIXTURES = Path(__file__).parents[2] / "fixtures"

IDENTITY = {"x": [1, 0, 0], "y": [0, 1, 0], "z": [0, 0, 1]}


def part(name: str, o=(0, 0, 0), **more) -> dict:
    """A component at ``o`` with the world's axes."""
    return {"id": name, "kind": "part", "pose": {"o": list(o), **IDENTITY}, **more}


def bundle(*components: dict, up: str = "Y", length: str = "m", angle: str = "rad", **more) -> dict:
    """A bundle of these components, Y up and in metres and radians unless said."""
    meta = {
        "format": "kinefab.bundle",
        "version": "1.0",
        "units": {"length": length, "angle": angle},
        "up": up,
    }
    return {"meta": meta, "components": list(components), **more}


def frame(o, z, x=None, inside: str = "world") -> dict:
    """A joint frame of a bundle."""
    return {"in": inside, "o": list(o), "z": list(z), **({} if x is None else {"x": list(x)})}


def read(values: dict, folder: Path) -> tuple[Scene, Report]:
    """The scene of a bundle, read from a file in ``folder``."""
    path = folder / "case.bundle.json"
    path.write_text(json.dumps(values), encoding="utf-8")
    report = Report()
    return sources.read(path, report), report


def codes(report: Report) -> list[str]:
    return [found.code for found in report.diagnostics]


def coordinates(scene: Scene, joint: Joint) -> tuple[np.ndarray, float]:
    """Translation of b's joint frame in a's, metres, and its angle about X, radians, at the exported pose."""
    a, b = scene.pose(joint.a) @ joint.frame_a, scene.pose(joint.b) @ joint.frame_b
    relative = a.inverse() @ b
    return relative.translation, math.atan2(relative.rotation[2, 1], relative.rotation[1, 1])
