"""A prefab as somebody else's importer reads it: Unidot Importer, which brings Unity's packages into Godot.

The environment names where it is: KINEFAB_UNIDOT the folder of its sources (github.com/V-Sekai/unidot_importer, MIT), and
``godot`` (4.3 or later) is on the PATH, or KINEFAB_GODOT names it.  Unidot knows no joints; what stands where is compared.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections import defaultdict
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import kinefab
import numpy as np
import pytest
from golden import FIXTURES, golden_pairs
from kinefab.unity.scene import MeshFilter, MeshRenderer, Rigidbody, UnityScene
from unity_world import world_of

GODOT = os.environ.get("KINEFAB_GODOT") or shutil.which("godot")
UNIDOT = os.environ.get("KINEFAB_UNIDOT")
PLUGIN = Path(__file__).parents[1] / "reference" / "godot"
PROJECT = """config_version=5
[application]
config/name="Kinefab"
[editor_plugins]
enabled=PackedStringArray("res://addons/unidot/plugin.cfg", "res://addons/kinefab/plugin.cfg")
"""
TURNED = np.array([-1.0, 1.0, 1.0])
"""Unity's coordinates to Godot's, as Unidot has it."""

pytestmark = pytest.mark.skipif(
    GODOT is None or UNIDOT is None,
    reason="godot is not installed, or KINEFAB_UNIDOT names no Unidot Importer",
)


def imported(prefabs: Path, project: Path) -> dict[str, list[dict[str, Any]]]:
    """What Godot has of each prefab of a folder, by its name."""
    for name, source in (("unidot", Path(str(UNIDOT))), ("kinefab", PLUGIN)):
        shutil.copytree(source, project / "addons" / name)
    (project / "project.godot").write_text(PROJECT)
    run = subprocess.run(
        [str(GODOT), "--headless", "--editor", "--path", str(project)],
        env={**os.environ, "KINEFAB_PREFABS": str(prefabs)},
        capture_output=True,
        text=True,
        errors="replace",
        timeout=600,
    )
    found: dict[str, list[dict[str, Any]]] = defaultdict(list)
    name = ""
    for line in run.stdout.splitlines():
        kind, _, said = line.partition(" ")
        if kind == "SCENE":
            found[name := said] = []
        elif kind == "NODE":
            found[name].append(json.loads(said))
    return found


def expected(scene: UnityScene) -> list[dict[str, Any]]:
    """The same of a scene."""
    told: list[dict[str, Any]] = []
    for entry, (linear, at) in zip(scene.gameObjects, world_of(scene)):
        looks = next((c.materials for c in entry.components if isinstance(c, MeshRenderer)), ())
        for component in entry.components:
            one: dict[str, Any] = {"at": TURNED * at}
            if isinstance(component, Rigidbody):
                one |= {"kind": "body", "mass": component.mass, "kinematic": component.isKinematic}
            elif isinstance(component, MeshFilter):
                mesh = scene.meshes[component.mesh]
                points = TURNED * (np.array(mesh.vertices) @ linear.T + at)
                a, b, c = (points[np.array(mesh.triangles)[:, k]] for k in range(3))
                one |= {
                    "kind": "mesh",
                    "low": points.min(axis=0),
                    "high": points.max(axis=0),
                    "volume": float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0),
                    "colors": [scene.materials[m].color[:3] for m in looks],
                }
            elif type(component).__name__.endswith("Collider"):
                one |= {"kind": "collider"}
            else:
                continue
            told.append(one)
    return told


def ranked(nodes: list[dict[str, Any]], kind: str) -> list[dict[str, Any]]:
    """Those of a kind, in an order that rounding does not change."""
    keys = ("low", "high", "at")
    return sorted(
        (node for node in nodes if node["kind"] == kind),
        key=lambda node: [round(float(x), 3) + 0.0 for key in keys if key in node for x in node[key]],
    )


def test_every_fixture_stands_in_godot_as_in_the_scene(tmp_path):
    """Meshes by their corners, what they enclose and their colours, Rigidbodies, and how many colliders there are."""
    prefabs = tmp_path / "Assets"
    prefabs.mkdir()
    scenes = {}
    sources = [source for source, _ in golden_pairs()]
    if find_spec("pxr") is not None:
        sources += sorted(FIXTURES.rglob("*.usda"))
    for number, source in enumerate(sources):
        name = f"{number:03d}"
        exported = kinefab.export(source, prefabs / f"{name}.prefab")
        scenes[name] = (source.relative_to(FIXTURES), exported.unity)
    found = imported(prefabs, tmp_path / "project")
    assert sorted(found) == sorted(scenes)
    for name, (source, scene) in scenes.items():
        wanted = expected(scene)
        for kind in ("body", "mesh", "collider"):
            ours, theirs = ranked(wanted, kind), ranked(found[name], kind)
            assert len(ours) == len(theirs), f"{source}: {kind}"
            for one, other in zip(ours, theirs):
                for key in one.keys() - ({"at"} if kind != "body" else set()) - {"kind"}:
                    near = pytest.approx(np.array(one[key], dtype=float), rel=1e-4, abs=1e-5)
                    assert np.array(other[key], dtype=float) == near, f"{source}: {key} of a {kind}"
