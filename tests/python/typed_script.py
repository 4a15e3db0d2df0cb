"""What a script writes, checked by pyright, strict, as it stands (``test_gates.py``); the values are as they come: arrays,
lists, words."""

from __future__ import annotations

import math
from pathlib import Path

import kinefab
import numpy as np


def gripper(width: float) -> kinefab.Scene:
    scene = kinefab.Scene()
    palm = scene.add_part("Palm", "palm.stl", grounded=True, translation=np.array([0.0, 0.1, 0.0]), unit="mm")
    axes = np.eye(3)
    fingers: list[kinefab.Joint] = []
    for side in (-1, 1):
        finger = scene.add_part(
            f"Finger{side}",
            "finger.stl",
            translation=[side * width, 0.2, 0],
            rotation=("XYZ", (0, 0, 90)),
            color=np.array([51, 77, 102]) / 255,
            material=[kinefab.Surface("steel"), kinefab.PhysicsMaterial("rubber", 0.9, 1.0)],
            collider=kinefab.Collider(kinefab.ColliderKind.BOX, size=(0.1, 0.1, 0.2)),
            mass=0.3,
        )
        limits = [0, width]
        fingers.append(scene.add_slider(palm, finger, point=axes[0], axis=side * axes[0], limits=limits))
    lock = scene.add_part("Lock", collider="box")
    scene.add_hinge(
        palm, lock, point=(0, 0, 0), axis=np.array([0, 1, 0]), limits=(-math.inf, 10), spring=(3.0, 10)
    )
    scene.add_joint(
        "pin_slot", palm, lock, point=[0, 0, 0], axis=(0, 0, 1), secondary=axes[0], ty=[-0.01, 0.08], rx=True
    )
    scene.add_ball(
        None, lock, point=(0, 0, 0), limits={"rx": (-10, 80)}, drive={"rx": {"target": 5, "stiffness": 10}}
    )
    seat: kinefab.Feature = scene.plane(palm, point=(0, 0, 0), normal=np.array([0, 0, 1]))
    face = scene.plane(lock, point=[0, 0, 0.005], normal=(0, 0, -1), coordinates="part")
    mate: kinefab.Constraint = scene.add_constraint("distance", seat, face, limits=(0, 0.005), sense="opposed")
    scene.add_constraint(kinefab.ConstraintKind.LOCK, palm, lock, name=mate.id)
    coupling: kinefab.Coupling = scene.add_coupling(fingers[0], (fingers[1], "tx"), ratio=-1)
    print(coupling.terms[0].ratio, fingers[0].freedoms[0].upper)
    return scene


def told(stage: str, done: float) -> None:
    print(stage, f"{done:.0%}")


def counted(done: int, total: int, record: kinefab.Record) -> None:
    print(f"{done} of {total}", record.source, record.outcome.value, record.codes.get("MASS_UNKNOWN", 0))


def stopped(stop: kinefab.Stop) -> str:
    return f"{stop.reason} of {stop.coordinate} at {stop.value} {stop.unit}"


def main() -> None:
    scene = gripper(0.03)
    options = kinefab.ExportOptions(
        "box", density=7850, closures="minimal", ground="world", reading={"up": "Z"}, writing={"unity": 6}
    )
    same = kinefab.ExportOptions(kinefab.ColliderShape.BOX, ground=kinefab.Ground.WORLD, smooth=None)
    try:
        result = kinefab.export(scene, Path("gripper.prefab"), options, told)
    except kinefab.KinefabError as error:
        print(*(f"{found.where} {found.code} {found.remedy}" for found in error.diagnostics), sep="\n")
        return
    lost = [each.feature for each in result.report.outcomes if each.outcome is not kinefab.Outcome.KEPT]
    print(lost, [path.name for path in result.files], result.report.of(kinefab.Severity.WARNING))
    motion = kinefab.motion(scene).sweep("Lock", 0, 120, frames=61)
    print(motion["Lock"].max(), motion.part("Palm")[:, :3].mean(axis=0))
    if motion.stop is not None:
        print(stopped(motion.stop), [branching.value for branching in motion.branchings])
    kinefab.motion(scene).follow({"Lock": [1, 2, 3], "Slide": np.linspace(0, 1, 3)})
    done = kinefab.batch("robots", "out", "glb", same, jobs=2, progress=counted)
    kinefab.batch(["robots", Path("plant")], Path("out"))
    print(
        done.counts,
        [record.outcome.good for record in done.records],
        kinefab.view(scene, "gripper.html", same).name,
    )


if __name__ == "__main__":
    main()
