"""How far this reader and its solver are from FreeCAD's own, over the documents of ``fixtures/freecad``.

PYTHONPATH=python/src python python/bench/freecad_bench.py
"""

from __future__ import annotations

import io
import json
import math
import tempfile
import zipfile
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
from kinefab import sources
from kinefab.analysis import analyse
from kinefab.diagnostics import Report
from kinefab.model import Scene
from kinefab.sources.freecad.document import UNIT
from kinefab.sources.freecad.parts import TURN, scene_pose
from kinefab.spatial import Pose, quaternion_from_matrix

FOLDER = Path(__file__).parents[2] / "fixtures" / "freecad"


def pose_of(numbers: list[float]) -> Pose:
    matrix = np.reshape(np.array(numbers), (4, 4))
    return Pose(matrix[:3, :3], matrix[:3, 3])


def between(a: Pose, b: Pose) -> float:
    """The larger of metres and entries of the rotation."""
    return max(
        float(np.abs(a.translation - b.translation).max()), float(np.abs(a.rotation - b.rotation).max())
    )


def paths(scene: Scene) -> dict[str, Pose]:
    """Poses by FreeCAD's path of names."""
    found: dict[str, Pose] = {}
    for index, node in enumerate(scene.nodes):
        names: list[str] = []
        at: int | None = index
        while at is not None and scene.nodes[at].parent is not None:
            names.insert(0, scene.nodes[at].where.partition("#")[2])
            at = scene.nodes[at].parent
        found[".".join(names)] = node.pose
    return found


def compared(name: str, told: dict[str, Any]) -> tuple[float, float, float, float]:
    """Poses, joint frames, coordinates, and how far solving moves what FreeCAD has solved."""
    scene = sources.read(FOLDER / f"{name}.FCStd", Report())
    here = paths(scene)
    poses = max(between(here[p], scene_pose(pose_of(m))) for p, m in told["parts"].items() if p in here)
    frames = coordinates = 0.0
    for joint in scene.joints:
        said = told["joints"].get(joint.name)
        if said is None:
            continue
        first, frame = pose_of(said["first"]), scene.pose(joint.a) @ joint.frame_a
        axes = (TURN @ first.rotation)[:, [2, 0, 1]]
        frames = max(frames, between(frame, Pose(axes, TURN @ first.translation * UNIT)))
        apart = frame.inverse() @ scene.pose(joint.b) @ joint.frame_b
        coordinates = max(coordinates, abs(float(apart.translation[0]) - said["length"] * UNIT))
        if joint.kind.value in ("revolute", "cylindrical"):
            angle = math.atan2(apart.rotation[2, 1], apart.rotation[1, 1])
            coordinates = max(coordinates, abs(math.remainder(angle - said["angle"], math.tau)))
    solved = analyse(scene).scene(True)
    moved = max(between(a.pose, b.pose) for a, b in zip(scene.nodes, solved.nodes))
    return poses, frames, coordinates, moved


def resolved(told: dict[str, Any]) -> float:
    """The four-bar at every angle that FreeCAD solved it for, each from the pose before."""
    path, worst, poses = FOLDER / "four_bar.FCStd", 0.0, None
    for step in told["steps"]:
        placed, out = pose_of(step["placement1"]), io.BytesIO()
        with zipfile.ZipFile(path) as old, zipfile.ZipFile(out, "w") as new:
            root = ElementTree.fromstring(old.read("Document.xml"))
            value = root.find(
                "ObjectData/Object[@name='Fixed']//Property[@name='Placement1']/PropertyPlacement"
            )
            assert value is not None
            numbers = [*placed.translation, *quaternion_from_matrix(placed.rotation)]
            for key, number in zip(("Px", "Py", "Pz", "Q0", "Q1", "Q2", "Q3"), numbers):
                value.set(key, repr(float(number)))
            new.writestr("Document.xml", ElementTree.tostring(root))
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "a.FCStd").write_bytes(out.getvalue())
            scene = sources.read(Path(folder) / "a.FCStd", Report())
        scene = scene if poses is None else scene.with_poses(poses)
        solved = analyse(scene).scene(True)
        poses = [node.pose for node in solved.nodes]
        here = paths(solved)
        worst = max(worst, *(between(here[p], scene_pose(pose_of(m))) for p, m in step["parts"].items()))
    return worst


def main() -> None:
    print(
        "| document | poses | joint frames | coordinates | solving what FreeCAD solved |\n|---|---|---|---|---|"
    )
    for file in sorted(FOLDER.glob("*.oracle.json")):
        name, told = file.name.removesuffix(".oracle.json"), json.loads(file.read_text(encoding="utf-8"))
        print(f"| {name} | " + " | ".join(f"{value:.1e}" for value in compared(name, told)) + " |")
        if "steps" in told:
            print(f"| {name}, re-solved at {len(told['steps'])} angles | {resolved(told):.1e} | | | |")


if __name__ == "__main__":
    main()
