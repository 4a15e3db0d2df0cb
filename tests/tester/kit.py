"""The files of ``schemas/TESTER.md``: ``python tests/tester/kit.py FOLDER`` (``make tester-kit``)."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import kinefab
import trimesh

HERE = Path(__file__).resolve().parent
BAR = trimesh.creation.box((0.05, 0.05, 0.4))
LOOSE = "Loose"


def links() -> kinefab.Scene:
    """A hinge that is to turn by 90 degrees a second and a slide that is to go at 0.1 m/s; nothing pulls at either."""
    scene = kinefab.Scene()
    base = scene.add_part("Stand", trimesh.creation.box((0.2, 0.2, 0.1)), grounded=True)
    turning = scene.add_part("Turning link", BAR, translation=(0.3, 0, 0))
    sliding = scene.add_part("Sliding link", BAR, translation=(-0.3, 0, 0))
    scene.add_hinge(turning, base, point=(0.3, 0, 0), axis=(0, 0, 1), drive={"target_velocity": 90, "damping": 100})
    scene.add_slider(base, sliding, point=(-0.3, 0, 0), axis=(1, 0, 0), drive={"target_velocity": 0.1, "damping": 1000})
    return scene


def hinges() -> kinefab.Scene:
    """Two bars that a motor turns into a stop at 180 degrees."""
    scene = kinefab.Scene()
    for i, name in enumerate(("Hinge plain", "Hinge extended")):
        bar = scene.add_part(name, BAR, translation=(0.5 * i, 0, 0.2))
        motor = {"target_velocity": 720, "max_force": 500, "motor": True}
        scene.add_hinge(None, bar, point=(0.5 * i, 0, 0), axis=(0, 1, 0), limits=(-180, 180), drive=motor)
    return scene


def plain(text: str, name: str) -> str:
    """A prefab whose hinge on this object has no extended limits."""
    documents = text.split("--- !u!")
    (owner,) = (d.split("&")[1].split("\n")[0] for d in documents if f"m_Name: {name}\n" in d)
    return "--- !u!".join(
        d.replace("m_ExtendedLimits: 1", "m_ExtendedLimits: 0") if f"m_GameObject: {{fileID: {owner}}}" in d else d
        for d in documents
    )


def make(folder: Path) -> None:
    shutil.rmtree(folder, ignore_errors=True)
    loose = folder / LOOSE
    loose.mkdir(parents=True)
    articulated = kinefab.ExportOptions(writing={"physics": "articulation"}, colliders="none")
    kinefab.export(links(), folder / "Tester.unitypackage", articulated)
    kinefab.export(hinges(), loose / "Hinges.prefab", kinefab.ExportOptions(colliders="none", ground="world"))
    prefab = loose / "Hinges.prefab"
    prefab.write_text(plain(prefab.read_text("ascii"), "Hinge plain"), "ascii")
    cube = kinefab.Scene()
    cube.add_part("Cube", trimesh.creation.box((0.3, 0.3, 0.3)), material=kinefab.Surface("Red", (1.0, 0.0, 0.0, 1.0), smoothness=0.5))
    kinefab.export(cube, loose / "Renamed.prefab")
    renamed = loose / "Renamed.prefab"
    renamed.write_text(renamed.read_text("ascii").replace("m_Name: Renamed\n", "m_Name: Other\n"), "ascii")
    kinefab.export(cube, loose / "HDRP.prefab", kinefab.ExportOptions(writing={"pipeline": "hdrp", "unity": "6"}))
    shutil.copy(HERE / "TesterLog.cs", loose)


if __name__ == "__main__":
    make(Path(sys.argv[1]))
