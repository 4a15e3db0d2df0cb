"""What is welded to a body that a clip or a script moves goes with it."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import kinefab
import pytest
import trimesh


def crate_and_platform(first: str) -> kinefab.Scene:
    scene = kinefab.Scene()
    places = {"Platform": (0, 0, 0), "Crate": (0, 0.7, 0)}
    nodes = {
        name: scene.add_part(name, trimesh.creation.box((0.4, 0.4, 0.4)), translation=places[name])
        for name in sorted(places, key=lambda name: name != first)
    }
    led = nodes["Platform"]
    dynamics = replace(scene.nodes[led].dynamics, kinematic=True)
    scene.nodes[led] = replace(scene.nodes[led], dynamics=dynamics)
    scene.add_fixed(nodes["Platform"], nodes["Crate"])
    return scene


def test_the_crate_stands_below_the_platform_that_moves(tmp_path: Path):
    kinefab.export(crate_and_platform("Platform"), tmp_path / "p.kinefab")
    objects = json.loads((tmp_path / "p.kinefab").read_text(encoding="utf-8"))["gameObjects"]
    crate = next(o for o in objects if o["id"] == "Crate")
    assert objects[crate["parent"]]["id"] == "Platform"
    assert crate["transform"]["localPosition"] == pytest.approx([0, 0.7, 0])


def test_a_crate_that_cannot_stand_below_is_told(tmp_path: Path):
    result = kinefab.export(crate_and_platform("Crate"), tmp_path / "p.kinefab")
    assert [d.code for d in result.report.diagnostics if d.code == "WELD_STAYS"] == ["WELD_STAYS"]
