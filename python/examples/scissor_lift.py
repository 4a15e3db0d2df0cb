"""A scissor lift of three crossed pairs on a carriage that is pushed along the base."""

import math
import sys

import kinefab
import numpy as np
import trimesh

STAGES, LENGTH, TILT = 3, 1.0, math.radians(35)
WIDTH, RISE = LENGTH * math.cos(TILT), LENGTH * math.sin(TILT)
Z = (0, 0, 1)


def bar(start: tuple[float, float, float], end: tuple[float, float, float]) -> trimesh.Trimesh:
    return trimesh.creation.cylinder(0.02, segment=np.array([start, end]))


scene = kinefab.Scene()
base = scene.add_part(
    "Base", trimesh.creation.box((1.2, 0.02, 0.4)), translation=(0.5, -0.05, 0), grounded=True
)
carriage = scene.add_part("Carriage", trimesh.creation.box((0.06, 0.04, 0.3)), translation=(WIDTH, 0, 0))
scene.add_slider(base, carriage, point=(WIDTH, 0, 0), axis=(1, 0, 0), limits=(-0.3, 0.1), name="Push")

left, right = base, carriage  # what the lower ends of the next pair hang on
for stage in range(STAGES):
    low, high = stage * RISE, (stage + 1) * RISE
    a = scene.add_part(
        f"Up{stage + 1}", bar((0, low, 0.1), (WIDTH, high, 0.1)), density=2700, collider="none"
    )
    b = scene.add_part(
        f"Down{stage + 1}", bar((0, high, -0.1), (WIDTH, low, -0.1)), density=2700, collider="none"
    )
    scene.add_hinge(left, a, point=(0, low, 0), axis=Z)
    scene.add_hinge(right, b, point=(WIDTH, low, 0), axis=Z)
    scene.add_hinge(a, b, point=(WIDTH / 2, low + RISE / 2, 0), axis=Z, name=f"Cross{stage + 1}")
    left, right = b, a
table = scene.add_part(
    "Table", trimesh.creation.box((1.2, 0.02, 0.4)), translation=(0.5, STAGES * RISE + 0.05, 0), density=600
)
scene.add_hinge(table, left, point=(0, STAGES * RISE, 0), axis=Z)
scene.add_joint("pin_slot", table, right, point=(WIDTH, STAGES * RISE, 0), axis=Z, secondary=(1, 0, 0))

result = kinefab.export(scene, sys.argv[1] if len(sys.argv) > 1 else "scissor_lift.kinefab")
print(f"{result.path}: mobility {result.analysed.analysis.mobility}")
