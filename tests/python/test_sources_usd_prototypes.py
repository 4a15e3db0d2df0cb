"""Instances of a prototype: read once, and each as if it stood there written out."""

from __future__ import annotations

import json
from pathlib import Path

import kinefab
import pytest
from usd_stages import BODY, body, joint, scene_of, stage

pytest.importorskip("pxr", reason="usd-core is not installed")

COLLIDES = '(prepend apiSchemas = ["PhysicsCollisionAPI"])'
ARM = joint(
    "PhysicsRevoluteJoint", "J", ' uniform token physics:axis = "Z"\n point3f physics:localPos0 = (0.5, 0, 0)', "/Arm/A", "/Arm/B"
)  # fmt: skip
PROTOTYPES = (
    'class Xform "Bolt" {\n def Cube "Head" ' + COLLIDES + " { double size = 2\n }\n"
    ' def Xform "Shaft" {\n double3 xformOp:translate = (0, 0, 3)\n uniform token[] xformOpOrder = ["xformOp:translate"]\n'
    ' def Cylinder "C" ' + COLLIDES + " { double radius = 0.5\n }\n"
    ' def Sphere "Hidden" { token visibility = "invisible"\n }\n def Sphere "Aid" { uniform token purpose = "guide"\n }\n'
    ' def Xform "Site" {\n }\n }\n def SphereLight "Lamp" {\n }\n}\n'
    'class Xform "Arm" {\n' + body("A", inside='def Cube "G" {\n }') + body("B", at=(0.5, 0, 0)) + ARM + "}\n"
    'class Xform "Tray" {\n'
    + "".join(f' def Xform "Bolt{i}" (references = </Bolt>; INSTANCED) {{\n }}\n' for i in (0, 1))
    + "}\n"
)


def copy(name: str, of: str, at: int, schemas: str = "", more: str = "") -> str:
    applied = f"; prepend apiSchemas = [{schemas}]" if schemas else ""
    return (
        f'def Xform "{name}" (references = </{of}>; INSTANCED{applied}) {{\n double3 xformOp:translate = ({at}, 0, 0)\n'
        f' uniform token[] xformOpOrder = ["xformOp:translate"]\n {more}\n}}\n'
    )


RIGID = '"PhysicsRigidBodyAPI"'
COPIES = (
    copy("Free", "Bolt", 0, RIGID) + copy("Still", "Bolt", 10)
    + copy("Unseen", "Bolt", 20, RIGID, 'token visibility = "invisible"')
    + copy("Red", "Bolt", 30, RIGID, "color3f[] primvars:displayColor = [(1, 0, 0)]")
    + copy("Wide", "Bolt", 40, RIGID).replace("translate", "scale").replace("(40, 0, 0)", "(1, 2, 3)")
    + copy("Guide", "Bolt", 50, RIGID, 'uniform token purpose = "guide"')
    + copy("Arm0", "Arm", 60) + copy("Arm1", "Arm", 70) + copy("Tray0", "Tray", 80, RIGID) + copy("Tray1", "Tray", 90)
    + f'def Xform "Holder" {BODY} {{\n{copy("In", "Bolt", 100)}\n}}\n'
    + joint("PhysicsFixedJoint", "Weld", "", "/Free", "/Arm1/A")
    + 'def PhysicsCollisionGroup "Group" { prepend rel collection:colliders:includes = [</Red>]\n }\n'
)  # fmt: skip


def written(folder: Path, instanced: bool) -> dict[str, object]:
    """The exported scene, without what says which file it is of."""
    word = "instanceable = true" if instanced else "instanceable = false"
    path = folder / f"{'shared' if instanced else 'whole'}.usda"
    path.write_text(stage((PROTOTYPES + COPIES).replace("INSTANCED", word)), encoding="utf-8")
    target = kinefab.export(path, folder / "out" / "scene.kinefab").path
    text = target.read_text(encoding="utf-8").replace(path.name, "stage.usda")
    return {key: value for key, value in json.loads(text).items() if key != "source"}


def test_an_instance_is_what_it_would_be_written_out(tmp_path):
    """Ids, poses, looks, colliders, joints and findings: those of the stage whose copies are no instances."""
    (tmp_path / "out").mkdir()
    whole, shared = written(tmp_path, False), written(tmp_path, True)
    ids = {entry["id"] for entry in shared["gameObjects"]}
    assert {"Free", "Arm0/A", "Arm1/B", "Tray0", "Tray1/Bolt1/Head"} <= ids
    assert shared == whole


def test_a_prototype_is_looked_at_once(tmp_path, monkeypatch):
    from kinefab.sources.usd.prims import Prims

    looked: list[str] = []
    look = Prims.seen
    monkeypatch.setattr(
        Prims, "seen", lambda self, prim: looked.append(str(prim.GetPath())) or look(self, prim)
    )
    copies = "".join(copy(f"B{i}", "Tray", i, RIGID) for i in range(20))
    text = stage((PROTOTYPES + copies).replace("INSTANCED", "instanceable = true"))
    scene, _ = scene_of(tmp_path, text)
    assert scene is not None and sum(len(node.bodies) for node in scene.nodes) == 20 * 2 * 3
    assert len([path for path in looked if path.startswith("/B")]) == 20
    assert len(looked) == len(set(looked)) < 20 + 15
