"""Writes the samples of the Unity package by the exporter itself, and copies its script: ``python csharp/unity/samples.py``, then ``metas.py``.

Each has a ``.kinefab`` that the package imports, and in ``Prefab`` what ``kinefab export -o NAME.prefab`` writes, for physics alone.
"""

from __future__ import annotations

import shutil
import sys
from collections.abc import Mapping
from pathlib import Path

import kinefab
import numpy as np
import trimesh
from kinefab.targets.prefab.objects.couplings import FOLDER, SCRIPT, script_guid
from metas import guid_of

ROOT = Path(__file__).resolve().parents[2]
SAMPLES = Path(__file__).parent / "com.kinefab" / "Samples~"
STEEL, ALUMINIUM = 7850, 2700
RED, BLUE, GREY, BRASS = (0.75, 0.22, 0.17), (0.20, 0.42, 0.68), (0.55, 0.57, 0.60), (0.80, 0.62, 0.25)


def box(*size: float) -> trimesh.Trimesh:
    return trimesh.creation.box(size)


def bar(start: tuple[float, float, float], end: tuple[float, float, float], radius: float) -> trimesh.Trimesh:
    """Between two points of the world."""
    return trimesh.creation.cylinder(radius, segment=np.array([start, end]), sections=16)


def lever() -> str | kinefab.Scene:
    """A hand lever that pushes a slider: the crank of the paper, out of its CAD bundle."""
    return str(ROOT / "fixtures" / "lever" / "lever.bundle.json")


def four_bar() -> kinefab.Scene:
    """A crank-rocker; its motor turns the crank by half a turn a second."""
    pins = {"A": (0.0, 0.0, 0.0), "B": (0.0, 0.1, 0.0), "C": (0.25, 0.2, 0.0), "D": (0.3, 0.0, 0.0)}
    scene = kinefab.Scene()
    frame = scene.add_part("Frame", bar(pins["A"], pins["D"], 0.012), grounded=True, color=GREY)
    crank, coupler, rocker = (
        scene.add_part(name, bar(pins[a], pins[b], 0.01), density=STEEL, collider="none", color=color)
        for name, (a, b), color in (("Crank", "AB", RED), ("Coupler", "BC", BLUE), ("Rocker", "CD", BRASS))
    )
    motor = {"target_velocity": 180, "max_force": 20, "motor": True}
    scene.add_hinge(frame, crank, point=pins["A"], axis=(0, 0, 1), drive=motor, name="Motor")
    scene.add_hinge(crank, coupler, point=pins["B"], axis=(0, 0, 1), name="Crank pin")
    scene.add_hinge(coupler, rocker, point=pins["C"], axis=(0, 0, 1), name="Rocker pin")
    scene.add_hinge(frame, rocker, point=pins["D"], axis=(0, 0, 1), name="Rocker shaft")
    return scene


def gripper() -> kinefab.Scene:
    """Two jaws on one spindle: the left jaw goes 20 mm for each turn, the right one as far the other way."""
    scene = kinefab.Scene()
    palm = scene.add_part("Palm", box(0.16, 0.03, 0.06), grounded=True, color=GREY)
    spindle = scene.add_part(
        "Spindle",
        bar((-0.085, 0.03, 0), (0.085, 0.03, 0), 0.006),
        density=STEEL,
        collider="none",
        color=BRASS,
    )
    turning = scene.add_hinge(palm, spindle, point=(0, 0.03, 0), axis=(1, 0, 0), name="Spindle")
    jaws: list[kinefab.Joint] = []
    for name, side in (("Left jaw", -1), ("Right jaw", 1)):
        jaw = scene.add_part(
            name, box(0.02, 0.1, 0.03), translation=(0.05 * side, 0.08, 0), density=ALUMINIUM, color=BLUE
        )
        # The left jaw's stops are both jaws' and the spindle's: three turns from end to end.
        stops = (-0.02, 0.04) if side < 0 else None
        point = (0.05 * side, 0.03, 0)
        jaws.append(scene.add_slider(palm, jaw, point=point, axis=(1, 0, 0), limits=stops, name=name))
    scene.add_coupling(turning, jaws[0], ratio=-0.02 / 360, name="Left nut")
    scene.add_coupling(jaws[0], jaws[1], ratio=-1, name="Right nut")
    return scene


def arm() -> kinefab.Scene:
    """Six axes with servos, for an articulation."""
    links = (  # name, size of its box, where its hinge stands, about what it turns, limits in degrees
        ("Turret", (0.24, 0.20, 0.24), (0, 0.20, 0), (0, 1, 0), (-170, 170)),
        ("Upper", (0.12, 0.50, 0.12), (0, 0.40, 0.10), (1, 0, 0), (-60, 120)),
        ("Elbow", (0.11, 0.16, 0.16), (0, 0.90, 0.10), (1, 0, 0), (-130, 70)),
        ("Forearm", (0.09, 0.09, 0.40), (0, 0.95, 0.20), (0, 0, 1), (-180, 180)),
        ("Wrist", (0.08, 0.08, 0.12), (0, 0.95, 0.62), (1, 0, 0), (-115, 115)),
        ("Flange", (0.07, 0.07, 0.03), (0, 0.95, 0.72), (0, 0, 1), (-175, 175)),
    )
    scene = kinefab.Scene()
    last = scene.add_part("Pedestal", box(0.3, 0.2, 0.3), translation=(0, 0.1, 0), grounded=True, color=GREY)
    for number, (name, size, point, axis, limits) in enumerate(links):
        color = (RED, BRASS)[number % 2]
        link = scene.add_part(name, box(*size), translation=point, density=1500, collider="box", color=color)
        servo = {"target": 0, "stiffness": 4000, "damping": 400, "max_force": 300}
        scene.add_hinge(last, link, point=point, axis=axis, limits=limits, drive=servo, name=f"{name} axis")
        last = link
    return scene


MADE = {"Lever": lever, "FourBar": four_bar, "Gripper": gripper, "Arm": arm}
WRITING: Mapping[str, Mapping[str, object]] = {"Arm": {"physics": "articulation"}, "Gripper": {"scripts": True}}
"""Options of the target."""


def copy_script() -> None:
    """The script that prefabs bring, in the package's namespace."""
    text = (FOLDER / SCRIPT).read_text("utf-8").replace("namespace Kinefab\n", "namespace KinefabUnity\n")
    (SAMPLES.parent / "Runtime" / "Mechanism" / SCRIPT).write_text(text, encoding="utf-8", newline="\n")


def main() -> int:
    for name, make in MADE.items():
        folder = SAMPLES / name
        for old in folder.glob("*.kinefab*"):
            old.unlink()
        shutil.rmtree(folder / "Prefab", ignore_errors=True)
        (folder / "Prefab").mkdir(parents=True)
        asked = WRITING.get(name, {})
        scene = {key: value for key, value in asked.items() if key != "scripts"}
        kinefab.export(make(), folder / f"{name}.kinefab", kinefab.ExportOptions(writing=scene))
        kinefab.export(make(), folder / "Prefab" / f"{name}.prefab", kinefab.ExportOptions(writing=asked))
        # The package has a script of its own for couplings; the note of what was written is for a next export over it.
        prefab = folder / "Prefab" / f"{name}.prefab"
        own = prefab.read_text("utf-8").replace(script_guid(SCRIPT), guid_of(f"Runtime/Mechanism/{SCRIPT}"))
        prefab.write_text(own, encoding="utf-8", newline="\n")
        shutil.rmtree(folder / "Prefab" / name / "Scripts", ignore_errors=True)
        for left in ("Scripts.meta", ".kinefab.json"):
            (folder / "Prefab" / name / left).unlink(missing_ok=True)
    return 0


if __name__ == "__main__":
    copy_script()
    sys.exit(main())
