"""Dynamics from end to end: one USD stage in PhysX 5 itself (ovphysx, on the CPU), and through Kinefab in the C# ``unity``
solver, which is PhysX 4.1 as Unity has it; 1 s under gravity.

Found: where PhysX 5 is told to use PGS with 6 iterations, as Unity does, a pendulum and a chain of three are within 1e-5 m of it all the way, at
steps of 1/60, 1/240 and 1/1000 s.  With its own default, TGS, a pendulum at 1/60 s is 0.11 m away after 1 s: TGS loses no
energy there, and PGS does.  Unity's bodies turn no faster than 7 rad/s unless the stage says more, as here; without that
the chain is 0.12 m away.

``KINEFAB_OVPHYSX`` names the interpreter of an environment with ovphysx, physx-usd-schemas and newton-usd-schemas, else this one is asked.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import kinefab
import numpy as np
import pytest
from scene_kinematics import unity_point
from usd_stages import body, joint, stage

pytest.importorskip("pxr", reason="usd-core is not installed")
PYTHON = os.environ.get("KINEFAB_OVPHYSX") or (sys.executable if find_spec("ovphysx") else None)
TOOL = shutil.which("dotnet-kinefab")
pytestmark = [
    pytest.mark.skipif(
        PYTHON is None, reason="ovphysx is not installed, and KINEFAB_OVPHYSX names no Python that has it"
    ),
    pytest.mark.skipif(TOOL is None, reason="dotnet-kinefab is not on the PATH"),
]

SCENE = (
    'def PhysicsScene "Scene" (prepend apiSchemas = ["PhysxSceneAPI"]) { uniform token physxScene:solverType = "PGS"\n'
    " vector3f physics:gravityDirection = (0, 0, -1)\n float physics:gravityMagnitude = 9.81\n}\n"
)
MASS = (
    "float physics:mass = 2; point3f physics:centerOfMass = (0, 0, 0); float3 physics:diagonalInertia = (0.02, 0.03, 0.04);"
    " float physxRigidBody:angularDamping = 0; float physxRigidBody:sleepThreshold = 0;"
    " float physxRigidBody:maxAngularVelocity = 100000; int physxRigidBody:solverPositionIterationCount = 6;"
    " int physxRigidBody:solverVelocityIterationCount = 1"
)


def chain(count: int) -> str:
    """Bars of 1 m along X, hinged end to end about Y, the first to the world."""
    content = SCENE
    for i in range(count):
        content += body(f"B{i}", at=(0.5 + i, 0, 2), mass=MASS).replace(
            '"PhysicsMassAPI"', '"PhysicsMassAPI", "PhysxRigidBodyAPI"'
        )
        before = "(0.5, 0, 0)" if i else "(0, 0, 2)"
        frames = f"point3f physics:localPos0 = {before}\n point3f physics:localPos1 = (-0.5, 0, 0)"
        hinge = f'uniform token physics:axis = "Y"\n {frames}'
        content += joint("PhysicsRevoluteJoint", f"J{i}", hinge, f"/B{i - 1}" if i else "", f"/B{i}")
    return stage(content)


def physx5(path: Path, seconds: float, step: float, prims: list[str]) -> np.ndarray:
    """Positions in Unity's frame, shape (steps, bodies, 3)."""
    script = Path(__file__).with_name("physx5_run.py")
    command = [str(PYTHON), str(script), str(path), str(seconds), str(step), *prims]
    bare = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, env=bare)
    lines = [line for line in done.stdout.splitlines() if line.startswith("poses ")]
    assert lines and "PhysX error" not in done.stdout + done.stderr, done.stderr[-1000:]
    return np.array(
        [[unity_point(p) for p in frame] for frame in json.loads(lines[0].removeprefix("poses "))]
    )


def unity(path: Path, folder: Path, seconds: float, step: float, names: list[str]) -> np.ndarray:
    target = kinefab.export(path, folder / "scene.kinefab").path
    written = folder / "moved.json"
    command = [
        str(TOOL),
        "simulate",
        str(target),
        "--seconds",
        str(seconds),
        "--step",
        str(step),
        "-o",
        str(written),
    ]
    subprocess.run([*command, "--solver", "unity"], check=True, capture_output=True, timeout=300)
    bodies = {entry["id"]: entry["poses"] for entry in json.loads(written.read_text("utf-8"))["bodies"]}
    return np.array([bodies[name] for name in names])[:, 1:, :3].swapaxes(0, 1)


@pytest.mark.parametrize("count", [1, 3])
def test_it_falls_as_physx_5_lets_it_fall(tmp_path, count):
    path = tmp_path / "stage.usda"
    path.write_text(chain(count), encoding="utf-8")
    names = [f"B{i}" for i in range(count)]
    seconds, step = 1.0, 1.0 / 240.0
    expected = physx5(path, seconds, step, [f"/{name}" for name in names])
    found = unity(path, tmp_path, seconds, step, names)
    assert float(np.abs(expected[-1] - expected[0]).max()) > 0.3
    assert float(np.linalg.norm(found[: len(expected)] - expected, axis=2).max()) < 1e-5
