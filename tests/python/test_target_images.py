"""An image that cannot be used is told by every target, and its material stays."""

from __future__ import annotations

import os

import kinefab
import numpy as np
import pytest
import trimesh
from kinefab.model import Surface, Texture
from prefab_scenes import png

pytest.importorskip("PIL")  # by which older trimesh holds textures

ENDINGS = (".prefab", ".glb", ".usda", ".usdz")


def exported(path, folder, ending: str) -> kinefab.ExportResult:
    if ending.startswith(".usd"):
        pytest.importorskip("pxr")
    scene = kinefab.Scene()
    box = trimesh.creation.box((0.2, 0.3, 0.4))
    box.visual = trimesh.visual.TextureVisuals(uv=np.abs(box.vertices[:, :2]))
    paint = Surface("paint", (1.0, 0.5, 0.25, 1.0), color_texture=Texture("wood", path))
    scene.add_part("Plate", box, material=paint, grounded=True)
    return kinefab.export(scene, folder / f"plate{ending}")


@pytest.mark.parametrize("ending", ENDINGS)
@pytest.mark.parametrize("fault", ["broken off", "folder", "pipe", "gone"])
def test_an_image_that_cannot_be_used_is_told(tmp_path, ending, fault):
    image = tmp_path / "wood.png"
    if fault == "broken off":
        whole = png(image, np.full((4, 6, 4), 90)).read_bytes()
        image.write_bytes(whole[:-30])
    elif fault == "folder":
        image.mkdir()
    elif fault == "pipe":
        os.mkfifo(image)
    told = [o for o in exported(image, tmp_path, ending).report.outcomes if "TEXTURE" in o.code]
    assert [o.outcome.value for o in told] == ["dropped"] and "wood" in told[0].message


@pytest.mark.parametrize("ending", ENDINGS)
def test_an_image_that_can_be_used_is_not(tmp_path, ending):
    image = png(tmp_path / "wood.png", np.full((4, 6, 4), 90))
    assert not [o for o in exported(image, tmp_path, ending).report.outcomes if "TEXTURE" in o.code]
