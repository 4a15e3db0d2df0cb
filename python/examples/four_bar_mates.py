"""The four-bar linkage as CAD states it: no joint, but axes on axes and faces on faces, in each bar's own coordinates."""

import math
import sys

import kinefab
import numpy as np
import trimesh

PINS = {"A": (0.0, 0.0), "B": (0.0, 0.1), "C": (0.25, 0.2), "D": (0.3, 0.0)}
THICK = 0.01

scene = kinefab.Scene()


def add_bar(name: str, start: str, end: str, layer: int, grounded: bool = False) -> tuple[int, float]:
    """A bar between two pins, drawn along its own X from its first hole; its index and its length."""
    (x, y), (to_x, to_y) = PINS[start], PINS[end]
    length = math.hypot(to_x - x, to_y - y)
    angle = math.degrees(math.atan2(to_y - y, to_x - x))
    mesh = trimesh.creation.box((length + 0.03, 0.02, THICK))
    mesh.apply_translation((0.5 * length, 0, 0))
    at, turn = (x, y, layer * THICK), ("XYZ", (0, 0, angle))
    return scene.add_part(
        name, mesh, translation=at, rotation=turn, density=7850, grounded=grounded, collider="none"
    ), length


def add_pin(lower: int, x_lower: float, upper: int, x_upper: float) -> None:
    """Hole on hole, and the upper bar's lower face on the lower one's upper face."""
    holes = (
        scene.axis(part, point=(x, 0, 0), direction=(0, 0, 1), coordinates="part")
        for part, x in ((lower, x_lower), (upper, x_upper))
    )
    scene.add_constraint("concentric", *holes)
    top = scene.plane(lower, point=(0, 0, THICK / 2), normal=(0, 0, 1), coordinates="part")
    bottom = scene.plane(upper, point=(0, 0, -THICK / 2), normal=(0, 0, -1), coordinates="part")
    scene.add_constraint("coincident", top, bottom)


frame, ground = add_bar("Frame", "A", "D", 0, grounded=True)
crank, radius = add_bar("Crank", "A", "B", 1)
rocker, swing = add_bar("Rocker", "D", "C", 1)
coupler, reach = add_bar("Coupler", "B", "C", 2)
add_pin(frame, 0, crank, 0)
add_pin(frame, ground, rocker, 0)
add_pin(crank, radius, coupler, 0)
add_pin(rocker, swing, coupler, reach)

turn = kinefab.motion(scene).sweep("Frame - Crank", 0, 360, frames=73)  # the joint that the analysis found
swung = np.degrees(2 * np.arcsin(np.abs(turn["Rocker"][:, 5])))
print(f"one turn of the crank swings the rocker between {swung.min():.1f} and {swung.max():.1f} degrees")

result = kinefab.export(scene, sys.argv[1] if len(sys.argv) > 1 else "four_bar_mates.kinefab")
print(f"{result.path}: mobility {result.analysed.analysis.mobility}")
