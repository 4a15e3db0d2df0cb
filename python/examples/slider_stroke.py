"""Plots how the lever's slider follows its crank: python python/examples/slider_stroke.py [PICTURE.png]"""

import sys

import kinefab
import matplotlib.pyplot as plt

mechanism = kinefab.motion("fixtures/lever/lever.bundle.json")
motion = mechanism.sweep("Shaft", 0, 360)
plt.plot(motion["Shaft"], 1000 * motion["Slide"])
plt.xlabel("crank, degrees")
plt.ylabel("slider, mm")
plt.savefig(sys.argv[1]) if sys.argv[1:] else plt.show()
