"""A planetary gear with a fixed ring: the carrier turns once while the sun turns 1 + ring / sun times.

Teeth are couplings between hinges.  Against the carrier, a planet turns -sun / planet times as far as the sun.
"""

import math
import sys

import kinefab
import trimesh

SUN, PLANET = 24, 18
RING = SUN + 2 * PLANET
MODULE = 0.002
Z = (0, 0, 1)


def wheel(teeth: int) -> trimesh.Trimesh:
    return trimesh.creation.cylinder(0.5 * MODULE * teeth, 0.01)


scene = kinefab.Scene()
housing = scene.add_part("Housing", grounded=True)
sun = scene.add_part("Sun", wheel(SUN), density=7850, collider="none")
carrier = scene.add_part("Carrier", wheel(SUN), translation=(0, 0, 0.02), density=7850, collider="none")
scene.add_hinge(housing, sun, point=(0, 0, 0), axis=Z, name="Input")
output = scene.add_hinge(housing, carrier, point=(0, 0, 0), axis=Z, name="Output")
scene.add_coupling(output, "Input", 1 + RING / SUN)
radius = 0.5 * MODULE * (SUN + PLANET)
for k in range(3):
    angle = 2 * math.pi * k / 3
    center = (radius * math.cos(angle), radius * math.sin(angle), 0)
    planet = scene.add_part(
        f"Planet{k + 1}", wheel(PLANET), translation=center, density=7850, collider="none"
    )
    pin = scene.add_hinge(carrier, planet, point=center, axis=Z, name=f"Pin{k + 1}")
    scene.add_coupling(output, pin, -RING / PLANET)

result = kinefab.export(scene, sys.argv[1] if len(sys.argv) > 1 else "planetary_gear.kinefab")
print(f"{result.path}: mobility {result.analysed.analysis.mobility}")
