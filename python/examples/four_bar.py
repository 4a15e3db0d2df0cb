"""A four-bar linkage whose crank is turned by a motor: a closed loop of four hinges."""

import sys

import kinefab
import numpy as np
import trimesh

PINS = {"A": (0.0, 0.0, 0.0), "B": (0.0, 0.1, 0.0), "C": (0.25, 0.2, 0.0), "D": (0.3, 0.0, 0.0)}


def bar(start: str, end: str) -> trimesh.Trimesh:
    """A bar between two pins, in the world's frame."""
    return trimesh.creation.cylinder(0.01, segment=np.array([PINS[start], PINS[end]]))


scene = kinefab.Scene()
frame = scene.add_part("Frame", bar("A", "D"), grounded=True)
crank, coupler, rocker = (
    scene.add_part(name, bar(*pins), density=7850, collider="none")
    for name, pins in (("Crank", "AB"), ("Coupler", "BC"), ("Rocker", "CD"))
)
motor = {"target_velocity": 180, "max_force": 20, "motor": True}  # degrees a second, newton metres
scene.add_hinge(frame, crank, point=PINS["A"], axis=(0, 0, 1), drive=motor, name="Motor")
scene.add_hinge(crank, coupler, point=PINS["B"], axis=(0, 0, 1))
scene.add_hinge(coupler, rocker, point=PINS["C"], axis=(0, 0, 1))
scene.add_hinge(frame, rocker, point=PINS["D"], axis=(0, 0, 1))

result = kinefab.export(scene, sys.argv[1] if len(sys.argv) > 1 else "four_bar.kinefab")
print(f"{result.path}: mobility {result.analysed.analysis.mobility}")
