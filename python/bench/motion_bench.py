"""Times ``kinefab.motion``: 100 frames of the lever, and of 80 bars in 40 loops.

    python python/bench/motion_bench.py

The least of five runs each, without reading and analysing; with the closing error of the loops.
"""

from __future__ import annotations

import math
import time
from pathlib import Path

import kinefab

LEVER = Path(__file__).parents[2] / "fixtures" / "lever" / "lever.bundle.json"


def ladder(loops: int) -> kinefab.Scene:
    """Cranks a metre apart, their tips joined by rods: one freedom, as many loops as rods."""
    scene = kinefab.Scene()
    base = scene.add_part("Base", grounded=True)
    x, y = 0.8 * math.cos(math.radians(50.0)), 0.8 * math.sin(math.radians(50.0))
    cranks = [scene.add_part(f"Crank{i}", translation=(i, 0, 0)) for i in range(loops + 1)]
    for i, crank in enumerate(cranks):
        scene.add_hinge(base, crank, point=(i, 0, 0), axis=(0, 0, 1), name=f"Pivot{i}")
    for i in range(loops):
        rod = scene.add_part(f"Rod{i}", translation=(i + x, y, 0))
        for end in (i, i + 1):
            scene.add_hinge(cranks[end], rod, point=(end + x, y, 0), axis=(0, 0, 1), name=f"Pin{i}.{end}")
    return scene


def main() -> None:
    for name, source, joint, stop in (
        ("lever", LEVER, "Shaft", 360.0),
        ("81 cranks and rods, 40 loops", ladder(40), "Pivot0", 60.0),
    ):
        mechanism = kinefab.motion(source)
        times: list[float] = []
        for _ in range(5):
            start = time.perf_counter()
            motion = mechanism.sweep(joint, 0.0, stop, frames=100)
            times.append(time.perf_counter() - start)
        print(f"{name}: {len(motion)} frames in {1000 * min(times):.0f} ms, loops closed to {motion.gap:.1e}")


if __name__ == "__main__":
    main()
