"""A large generated assembly to a ``.unitypackage`` against trimesh alone loading the same meshes and writing a GLB.

    python python/bench/unitypackage_bench.py [--parts 10000] [--triangles 10000000] [--definitions 500] [--format glb|obj]

The source is that of ``export_bench.py``, so that reading, finding copies, weighing and hulls are in both figures.  Each side runs in a
process of its own; the ratios are of one run on one machine: of seconds of the processor from the import on, and of what one waits for
the whole processes, which pack beside.  The arrays are what trimesh holds of the loaded meshes: vertices
as float64 and faces as int64.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path

from export_bench import generate, run
from usd_bench import PEAK

TRIMESH = """
import sys, time
start = time.process_time()
import trimesh
scene = trimesh.load(sys.argv[1], force="scene", process=False)
loaded = time.process_time()
scene.export(sys.argv[2])
arrays = sum(m.vertices.nbytes + m.faces.nbytes for m in scene.geometry.values())
print(loaded - start, time.process_time() - loaded, arrays)
"""

EXPORT = """
import sys, time
start = time.process_time()
import kinefab
stages = {}
def progress(stage, fraction):
    stages[stage] = time.process_time() - start
kinefab.export(sys.argv[1], sys.argv[2], kinefab.ExportOptions(colliders=sys.argv[3]), progress)
print(time.process_time() - start, peak() * 1024, " ".join(f"{k} until {v:.1f}" for k, v in stages.items()))
"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--parts", type=int, default=10_000)
    parser.add_argument("--triangles", type=int, default=10_000_000)
    parser.add_argument("--definitions", type=int, default=500)
    parser.add_argument("--format", choices=("glb", "obj"), default="glb")
    parser.add_argument("--colliders", default="auto", help="as kinefab export takes it")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        bundle, mesh, count = generate(
            folder, options.parts, options.triangles, options.definitions, "." + options.format
        )
        print(f"{options.parts} parts, {options.definitions} definitions, {count} triangles")
        started = time.perf_counter()
        load, write, arrays = map(float, run(TRIMESH, mesh, folder / "again.glb"))
        alone = time.perf_counter() - started
        print(f"trimesh alone: load {load:.1f} s, write GLB {write:.1f} s, together {load + write:.1f} s")
        target = folder / "bench.unitypackage"
        started = time.perf_counter()
        total, peak, stages = run(PEAK + EXPORT, bundle, target, options.colliders)
        waited = time.perf_counter() - started
        print(
            f"kinefab export: {float(total):.1f} s ({stages.strip()}), {target.stat().st_size / 1e6:.0f} MB"
        )
        print(
            f"ratio: {float(total) / (load + write):.2f} (export / trimesh load and GLB), "
            f"{waited / alone:.2f} by the clock, "
            f"peak memory {float(peak) / 1e9:.2f} GB, {float(peak) / arrays:.1f} times the arrays of {arrays / 1e9:.2f} GB"
        )


if __name__ == "__main__":
    main()
