"""A lid on a box: one hinge with limits."""

import sys

import kinefab
import trimesh

scene = kinefab.Scene()
box = scene.add_part("Box", trimesh.creation.box((0.4, 0.2, 0.3)), translation=(0, 0.10, 0), grounded=True)
lid = scene.add_part("Lid", trimesh.creation.box((0.4, 0.02, 0.3)), translation=(0, 0.21, 0), density=700)
scene.add_hinge(box, lid, point=(0, 0.20, -0.15), axis=(-1, 0, 0), limits=(0, 110), name="Hinge")

result = kinefab.export(scene, sys.argv[1] if len(sys.argv) > 1 else "lid.kinefab")
print(f"{result.path}: mobility {result.analysed.analysis.mobility}")
