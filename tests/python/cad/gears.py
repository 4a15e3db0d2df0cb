"""Two wheels on a plate, the second against the first at 2.5 times its speed; inches, Y up."""

from __future__ import annotations

import copy
import math
from typing import Any


def gear_pair() -> dict[str, Any]:
    """Hinges with limits and a gear between them; asymmetric angles, axes along Z."""

    def component(name: str, o: list[float], turn: float = 0.0, **more: Any) -> dict[str, Any]:
        c, s = math.cos(turn), math.sin(turn)
        pose = {"o": o, "x": [c, s, 0.0], "y": [-s, c, 0.0], "z": [0.0, 0.0, 1.0]}
        return {
            "id": f"Gears/{name}",
            "name": name,
            "kind": "part",
            "parent": "Gears",
            "definition": name,
            "pose": pose,
        } | more

    def hinge(name: str, part: str, o: list[float], value: float, low: float, high: float) -> dict[str, Any]:
        c, s = math.cos(value), math.sin(value)
        fixed = {"in": "world", "o": o, "z": [0.0, 0.0, 1.0], "x": [1.0, 0.0, 0.0]}
        dof = {"name": "rz", "value": value, "min": low, "max": high, "minEnabled": True, "maxEnabled": True}
        return {
            "id": name, "name": name, "type": "revolute", "a": "Gears/Plate", "b": f"Gears/{part}",
            "frameA": fixed, "frameB": {**fixed, "x": [c, s, 0.0]}, "dof": [dof],
        }  # fmt: skip

    root = {"id": "Gears", "kind": "assembly", "flexible": True} | {
        "pose": {"o": [0.0] * 3, "x": [1.0, 0.0, 0.0], "y": [0.0, 1.0, 0.0], "z": [0.0, 0.0, 1.0]}
    }
    small, big = [0.3, -0.2, 0.7], [7.3, -0.2, 0.7]
    return {
        "meta": {
            "format": "kinefab.bundle", "version": "1.0", "units": {"length": "in", "angle": "rad"}, "up": "Y",
            "generator": {"name": "test", "version": "1"}, "poseState": "solved",
        },
        "components": [
            root, component("Plate", [0.1, 0.0, 0.4], grounded=True), component("Big", big, 0.2), component("Small", small, 0.5),
        ],
        "joints": [
            hinge("Hinge A", "Big", big, 0.2, math.radians(-10), math.radians(80)),
            hinge("Hinge B", "Small", small, 0.5, math.radians(-200), math.radians(90)),
        ],
        "couplings": [
            {"id": "Gear", "kind": "gear", "a": {"joint": "Hinge A", "dof": "rz"}, "b": {"joint": "Hinge B", "dof": "rz"}, "ratio": -2.5}
        ],
    }  # fmt: skip


def held_by_the_world(opposed: bool) -> tuple[dict[str, Any], dict[str, Any]]:
    """The pair with its first hinge on the world: as a bundle has it, and as a user has it who selects the world first, so that
    it moves against the wheel.  opposed: the hinge's two axes point against each other."""
    scene = gear_pair()
    hinge, (coupling,) = scene["joints"][0], scene["couplings"]
    hinge["a"] = "ground"
    if opposed:
        hinge["frameA"]["z"] = [0.0, 0.0, -1.0]
        _count_back(hinge, coupling)
    stated = copy.deepcopy(scene)
    hinge, (coupling,) = stated["joints"][0], stated["couplings"]
    for one, other in (("a", "b"), ("frameA", "frameB")):
        hinge[one], hinge[other] = hinge[other], hinge[one]
    if not opposed:
        _count_back(hinge, coupling)
    return scene, stated


def _count_back(hinge: dict[str, Any], coupling: dict[str, Any]) -> None:
    """What is counted about the hinge, the other way."""
    (dof,) = hinge["dof"]
    dof |= {"value": -dof["value"], "min": -dof["max"], "max": -dof["min"]}
    coupling["ratio"] = -coupling["ratio"]
