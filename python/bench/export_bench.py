"""Export of a large generated assembly against trimesh alone loading the same meshes and writing a GLB.

    python python/bench/export_bench.py [--parts 10000] [--triangles 10000000] [--definitions 500] [--format glb|obj]

Every part stands in one mesh file in world coordinates, as CAD programs export them, so the export has to
find out by itself which parts are copies of one definition.  Both sides run in a process of their own; the
ratio is of one run on one machine, of seconds of the processor, which other programs disturb least.
"""

from __future__ import annotations

import argparse
import json
import math
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

TRIMESH = """
import sys, time
start = time.process_time()
import trimesh
scene = trimesh.load(sys.argv[1], force="scene", process=False)
loaded = time.process_time()
scene.export(sys.argv[2])
print(loaded - start, time.process_time() - loaded)
"""

EXPORT = """
import sys, time
start = time.process_time()
import kinefab
stages = {}
def progress(stage, fraction):
    stages.setdefault(stage, time.process_time() - start)
options = kinefab.ExportOptions(colliders=sys.argv[3])
result = kinefab.export(sys.argv[1], sys.argv[2], options, progress)
total = time.process_time() - start
print(total, len(result.unity.meshes), " ".join(f"{k}@{v:.1f}" for k, v in stages.items()))
"""


def torus(rng: np.random.Generator, triangles: int) -> tuple[np.ndarray, np.ndarray]:
    """A ring of an uneven section: vertices in millimetres and faces, closed and wound outwards."""
    side = math.sqrt(triangles / 2)
    n = max(3, round(side * rng.uniform(0.7, 1.4)))
    m = max(3, round(triangles / 2 / n))
    u, v = np.meshgrid(np.arange(n), np.arange(m), indexing="ij")
    a, b = 2 * np.pi * u / n, 2 * np.pi * v / m
    large, small = rng.uniform(20, 40), rng.uniform(4, 9)
    section = small * (1.0 + 0.2 * np.cos(rng.integers(2, 5) * b))
    ring = large + section * np.cos(b)
    vertices = np.stack([ring * np.cos(a), ring * np.sin(a), section * np.sin(b)], axis=-1).reshape(-1, 3)
    at = lambda i, j: (i % n) * m + j % m  # noqa: E731
    quads = [at(u, v), at(u + 1, v), at(u + 1, v + 1), at(u, v + 1)]
    first, second = (
        np.stack([quads[k] for k in ks], axis=-1).reshape(-1, 3) for ks in ((0, 1, 2), (0, 2, 3))
    )
    return vertices, np.concatenate([first, second])


def rotation(rng: np.random.Generator) -> np.ndarray:
    q, r = np.linalg.qr(rng.normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    return q if np.linalg.det(q) > 0 else q[:, [1, 0, 2]]


def generate(
    folder: Path, parts: int, triangles: int, definitions: int, suffix: str
) -> tuple[Path, Path, int]:
    """Write the bundle and its mesh file; returns both and the triangles written."""
    import trimesh

    rng = np.random.default_rng(1)
    shapes = [torus(rng, triangles // parts) for _ in range(definitions)]
    components, scene, count = [], trimesh.Scene(), 0
    components.append(
        {
            "id": "Top",
            "name": "Top",
            "kind": "assembly",
            "flexible": True,
            "pose": pose(np.eye(3), np.zeros(3)),
        }
    )
    for i in range(parts):
        vertices, faces = shapes[i % definitions]
        r, o = rotation(rng), rng.uniform(-5000, 5000, 3)
        name = f"Ring_{i}"
        scene.add_geometry(
            trimesh.Trimesh(vertices @ r.T + o, faces, process=False), node_name=name, geom_name=name
        )
        body = {"id": "b", "name": "b", "meshKey": name}
        definition = f"ring{i % definitions}.ipt"
        components.append(
            {
                "id": f"Top/{name}",
                "name": name,
                "kind": "part",
                "parent": "Top",
                "definition": definition,
                "pose": pose(r, o),
                "bodies": [body],
            }
        )
        count += len(faces)
    mesh = folder / f"bench{suffix}"
    scene.export(mesh)
    meta = {
        "format": "kinefab.bundle",
        "version": "1.0",
        "units": {"length": "mm", "angle": "deg", "mass": "kg"},
        "handed": "right",
        "up": "Z",
        "mesh": {
            "files": [mesh.name],
            "units": "mm",
            "layout": "single",
            "coordinates": "world",
            "key": "object",
        },
    }
    bundle = folder / "bench.bundle.json"
    bundle.write_text(json.dumps({"meta": meta, "components": components}))
    return bundle, mesh, count


def pose(r: np.ndarray, o: np.ndarray) -> dict:
    return {"o": o.tolist(), "x": r[:, 0].tolist(), "y": r[:, 1].tolist(), "z": r[:, 2].tolist()}


def run(code: str, *arguments: object) -> list[str]:
    done = subprocess.run([sys.executable, "-c", code, *map(str, arguments)], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr)
    return done.stdout.split(maxsplit=2)


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
        start = time.perf_counter()
        bundle, mesh, count = generate(
            folder, options.parts, options.triangles, options.definitions, "." + options.format
        )
        size = mesh.stat().st_size / 1e6
        print(
            f"{options.parts} parts, {options.definitions} definitions, {count} triangles, {options.format} of {size:.0f} MB"
        )
        print(f"generated in {time.perf_counter() - start:.1f} s")
        load, write = map(float, run(TRIMESH, mesh, folder / "again.glb"))
        print(f"trimesh alone: load {load:.1f} s, write GLB {write:.1f} s, together {load + write:.1f} s")
        total, meshes, stages = run(EXPORT, bundle, folder / "bench.kinefab", options.colliders)
        print(f"kinefab export: {float(total):.1f} s, {meshes} meshes written ({stages.strip()})")
        peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1e6
        print(
            f"ratio: {float(total) / (load + write):.2f} (export / trimesh load and GLB), peak memory {peak:.1f} GB"
        )


if __name__ == "__main__":
    main()
