"""Export of a large generated stage against usd-core alone, which walks the same prims and reads the same arrays.

    python python/bench/usd_bench.py [--parts 10000] [--prototypes 500] [--triangles 10000000] [--unique]

Each part is an instance of one of the prototypes, with a rigid body, mass and a pose of its own.  ``triangles`` counts what
is drawn; with ``--unique`` the prototypes together have as many.  Each side runs in a process of its own; seconds are
those of the processor without the start of Python, memory is the highest of the process less what it has with its
libraries loaded.  ``bare MB`` is what the open stage takes by itself, ``beyond bare MB`` what the export adds to that.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

PEAK = """
import resource
def peak():  # kB; ru_maxrss starts with what the parent had, VmHWM with nothing
    try:
        return next(int(line.split()[1]) for line in open("/proc/self/status") if line.startswith("VmHWM"))
    except OSError:
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
"""

BARE = """
import sys, time
import numpy as np
from pxr import Usd, UsdGeom, UsdPhysics
base = peak()
start = time.process_time()
stage = Usd.Stage.Open(sys.argv[1])
cache = UsdGeom.XformCache()
sizes = {}
for prim in Usd.PrimRange.Stage(stage, Usd.TraverseInstanceProxies()):
    if prim.IsA(UsdGeom.Xformable):
        cache.GetLocalToWorldTransform(prim)
    if prim.IsA(UsdGeom.Mesh):
        mesh = UsdGeom.Mesh(prim)
        arrays = [np.asarray(a.Get()) for a in (mesh.GetPointsAttr(), mesh.GetFaceVertexCountsAttr(),
                                                mesh.GetFaceVertexIndicesAttr(), mesh.GetNormalsAttr())]
        key = str(prim.GetPrimInPrototype().GetPath()) if prim.IsInstanceProxy() else str(prim.GetPath())
        sizes[key] = sum(a.nbytes for a in arrays)
print(time.process_time() - start, peak() - base, sum(sizes.values()))
"""

EXPORT = """
import sys, time
import numpy as np, scipy.spatial, trimesh
from pxr import Usd, UsdGeom, UsdPhysics
import kinefab.pipeline, kinefab.sources.usd.reader, kinefab.targets.kinefab_file
from kinefab import export
base = peak()
start = time.process_time()
stages = {}
result = export(sys.argv[1], sys.argv[2],
                progress=lambda stage, fraction: stages.setdefault(stage, time.process_time() - start))
print(time.process_time() - start, peak() - base,
      " ".join(f"{k}@{v:.2f}" for k, v in stages.items()))
"""


def generate(path: Path, parts: int, prototypes: int, triangles: int) -> int:
    """Write the stage; returns the triangles of the prototypes together.  triangles: of each prototype."""
    from pxr import Gf, Sdf, Usd, UsdGeom, UsdPhysics, Vt

    rng = np.random.default_rng(1)
    stage = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageUpAxis(stage, "Z")
    UsdGeom.SetStageMetersPerUnit(stage, 0.001)
    UsdGeom.Xform.Define(stage, "/World")
    stage.SetDefaultPrim(stage.GetPrimAtPath("/World"))
    UsdPhysics.Scene.Define(stage, "/World/Scene")
    written = 0
    for i in range(prototypes):
        stage.CreateClassPrim(f"/Prototype{i}")
        mesh = UsdGeom.Mesh.Define(stage, f"/Prototype{i}/Mesh")
        points, normals, faces = ring(rng, triangles)
        written += len(faces)
        mesh.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(points.astype(np.float32)))
        mesh.CreateNormalsAttr(Vt.Vec3fArray.FromNumpy(normals.astype(np.float32)))
        mesh.SetNormalsInterpolation("vertex")
        mesh.CreateFaceVertexCountsAttr(Vt.IntArray.FromNumpy(np.full(len(faces), 3, dtype=np.int32)))
        mesh.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(faces.astype(np.int32).ravel()))
        mesh.CreateSubdivisionSchemeAttr("none")
    with Sdf.ChangeBlock():
        layer = stage.GetRootLayer()
        world = layer.GetPrimAtPath("/World")
        for i in range(parts):
            part = Sdf.PrimSpec(world, f"Part{i}", Sdf.SpecifierDef, "Xform")
            part.referenceList.prependedItems = [Sdf.Reference("", f"/Prototype{i % prototypes}")]
            part.instanceable = True
            part.SetInfo("apiSchemas", Sdf.TokenListOp.Create(["PhysicsRigidBodyAPI", "PhysicsMassAPI"]))
            q = rng.normal(size=4)
            q /= np.linalg.norm(q)
            at = Gf.Matrix4d(
                Gf.Rotation(Gf.Quatd(*q.tolist())), Gf.Vec3d(*rng.uniform(-2000, 2000, 3).tolist())
            )
            for name, kind, value in (
                ("xformOp:transform", Sdf.ValueTypeNames.Matrix4d, at),
                ("xformOpOrder", Sdf.ValueTypeNames.TokenArray, ["xformOp:transform"]),
                ("physics:mass", Sdf.ValueTypeNames.Float, 1.5),
                ("physics:centerOfMass", Sdf.ValueTypeNames.Point3f, Gf.Vec3f(0, 0, 1)),
                ("physics:diagonalInertia", Sdf.ValueTypeNames.Float3, Gf.Vec3f(400, 500, 600)),
            ):
                Sdf.AttributeSpec(part, name, kind).default = value
    stage.Save()
    return written


def ring(rng: np.random.Generator, triangles: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A torus of about so many triangles, millimetres."""
    n = max(3, round((triangles / 2) ** 0.5))
    m = max(3, round(triangles / 2 / n))
    u, v = np.meshgrid(np.arange(n), np.arange(m), indexing="ij")
    a, b = 2 * np.pi * u / n, 2 * np.pi * v / m
    large, small = rng.uniform(20, 40), rng.uniform(4, 9)
    normals = np.stack([np.cos(b) * np.cos(a), np.cos(b) * np.sin(a), np.sin(b)], axis=-1).reshape(-1, 3)
    points = np.stack([large * np.cos(a), large * np.sin(a), 0 * a], axis=-1).reshape(-1, 3) + small * normals

    def at(i, j):
        return (i % n) * m + j % m

    quads = [at(u, v), at(u + 1, v), at(u + 1, v + 1), at(u, v + 1)]
    halves = [np.stack([quads[k] for k in ks], axis=-1).reshape(-1, 3) for ks in ((0, 1, 2), (0, 2, 3))]
    return points, normals, np.concatenate(halves)


def run(script: str, *arguments: str) -> list[str]:
    done = subprocess.run(
        [sys.executable, "-c", PEAK + script, *arguments], capture_output=True, text=True, check=True
    )
    return done.stdout.split()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--parts", type=int, default=10_000)
    parser.add_argument("--prototypes", type=int, default=500)
    parser.add_argument("--triangles", type=int, default=10_000_000)
    parser.add_argument(
        "--unique", action="store_true", help="the prototypes have the triangles, not the parts"
    )
    asked = parser.parse_args()
    each = asked.triangles // (asked.prototypes if asked.unique else asked.parts)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "stage.usdc"
        written = generate(path, asked.parts, asked.prototypes, each)
        bare = run(BARE, str(path))
        export = run(EXPORT, str(path), str(Path(folder) / "stage.kinefab"))
    seconds, bare_memory, arrays = float(bare[0]), int(bare[1]) / 1024, int(bare[2]) / 2**20
    print(json.dumps({
        "parts": asked.parts, "prototypes": asked.prototypes, "triangles drawn": each * asked.parts,
        "triangles stored": written, "arrays MB": round(arrays, 1),
        "bare s": round(seconds, 2), "export s": round(float(export[0]), 2),
        "ratio": round(float(export[0]) / seconds, 2),
        "bare MB": round(bare_memory, 1), "export MB": round(int(export[1]) / 1024, 1),
        "memory / arrays": round(int(export[1]) / 1024 / arrays, 2),
        "beyond bare MB": round(int(export[1]) / 1024 - bare_memory, 1), "stages": export[2:],
    }, indent=1))  # fmt: skip


if __name__ == "__main__":
    main()
