"""A six-axis arm from mesh files: each link a file in millimetres, each axis a hinge with limits, a servo and friction."""

import sys
import tempfile
from pathlib import Path

import kinefab
import trimesh

LINKS = (  # name, size of its box in millimetres, where its hinge stands and about what it turns, limits in degrees
    ("Turret", (240, 200, 240), (0, 0.20, 0), (0, 1, 0), (-170, 170)),
    ("Upper", (120, 500, 120), (0, 0.40, 0.10), (1, 0, 0), (-60, 120)),
    ("Elbow", (110, 160, 160), (0, 0.90, 0.10), (1, 0, 0), (-130, 70)),
    ("Forearm", (90, 90, 400), (0, 0.95, 0.20), (0, 0, 1), (-175, 175)),
    ("Wrist", (80, 80, 120), (0, 0.95, 0.62), (1, 0, 0), (-115, 115)),
    ("Flange", (70, 70, 30), (0, 0.95, 0.72), (0, 0, 1), (-175, 175)),
)

folder = Path(tempfile.mkdtemp())
scene = kinefab.Scene()
last = scene.add_part(
    "Pedestal", trimesh.creation.box((0.3, 0.2, 0.3)), translation=(0, 0.1, 0), grounded=True
)
for name, size, point, axis, limits in LINKS:
    trimesh.creation.box(size).export(folder / f"{name}.stl")  # stands for what a CAD program exports
    link = scene.add_part(
        name, folder / f"{name}.stl", unit="mm", translation=point, density=1500, collider="box"
    )
    servo = {"target": 0, "stiffness": 4000, "damping": 400, "max_force": 300}
    scene.add_hinge(last, link, point=point, axis=axis, limits=limits, drive=servo, name=f"{name} axis")
    last = link

result = kinefab.export(scene, sys.argv[1] if len(sys.argv) > 1 else "six_axis_arm.kinefab")
print(f"{result.path}: mobility {result.analysed.analysis.mobility}")
