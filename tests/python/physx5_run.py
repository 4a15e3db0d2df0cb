"""Simulates a USD stage with ovphysx (PhysX 5, on the CPU) and prints where bodies went.

    python tests/python/physx5_run.py STAGE SECONDS STEP PRIM...

Run by an interpreter whose environment has ovphysx, physx-usd-schemas and newton-usd-schemas: it brings a USD of its own, which usd-core cannot
stand beside.  Prints one JSON line: for each step a list of the bodies' positions, metres, in the stage's frame.
"""

from __future__ import annotations

import json
import sys

import numpy as np


def main(path: str, seconds: float, step: float, prims: list[str]) -> None:
    import ovphysx
    import ovstage
    from ovphysx.samples.python_samples.schema_support import physx_schema_paths

    ovphysx.PhysX.set_cpu_mode(True)
    physx = ovphysx.PhysX()
    schemas = [*map(str, physx_schema_paths()), str(ovphysx.newton_schema_root())]
    ovstage.population.register_usd_schemas(schemas)
    stage = ovstage.Stage("kinefab")
    ovstage.population.open_usd(stage, path, ordinal=1, domains=ovstage.PopulationDomain.ALL)
    stage.advance_write_floor(ordinal=1).wait()
    physx.wait_task(physx.attach_ovstage(stage, read_ordinal=1))
    poses = physx.create_tensor_binding(prim_paths=prims, tensor_type=ovphysx.TensorType.RIGID_BODY_POSE)
    found = []
    for _ in range(round(seconds / step)):
        physx.step_sync(step)
        out = np.zeros(poses.shape, dtype=np.float32)
        poses.read(out)
        found.append(out[:, :3].astype(float).tolist())
    print("poses", json.dumps(found), flush=True)
    physx.wait_task(physx.detach_ovstage())
    physx.destroy()
    stage.destroy()


if __name__ == "__main__":
    main(sys.argv[1], float(sys.argv[2]), float(sys.argv[3]), sys.argv[4:])
