"""Plots how the lever's slider follows its crank: python python/examples/slider_stroke.py [PICTURE.png]"""

import sys
from pathlib import Path

import kinefab
import matplotlib.pyplot as plt

lever = Path(__file__).parents[2] / "fixtures" / "lever" / "lever.bundle.json"
mechanism = kinefab.motion(lever)
motion = mechanism.sweep("Shaft", 0, 360)
plt.plot(motion["Shaft"], 1000 * motion["Slide"])
plt.xlabel("crank, degrees")
plt.ylabel("slider, mm")
plt.savefig(sys.argv[1]) if sys.argv[1:] else plt.show()
