"""A written scene tells its joints' coordinates as its source does: the same zero, sense and ends."""

from __future__ import annotations

from pathlib import Path

import kinefab
import numpy as np
import pytest
import trimesh

ENDS = (-0.2, 0.05)
AXES = ((1, 0, 0), (0, 0, 1), (0.6, 0.0, -0.8))


def machine(axis: tuple[float, float, float], kind: str, turned: bool = False) -> kinefab.Scene:
    """A block on a base that is itself not grounded at the origin; the slide's range is not symmetric.

    turned: the source names the block first, so that it counts the base's slide against the block.
    """
    scene = kinefab.Scene()
    base = scene.add_part(
        "Base",
        translation=(0.3, 0.1, -0.2),
        rotation=("XYZ", (10, 20, 30)),
        grounded=True,
    )
    block = scene.add_part(
        "Block",
        trimesh.creation.box((0.04, 0.03, 0.02)),
        translation=(0.23, 0.05, 0.01),
    )
    joint = {"point": (0.2, 0.05, 0.03), "axis": axis, "name": "Slide"}
    sides = (block, base) if turned else (base, block)
    if kind == "slider":
        scene.add_slider(*sides, limits=ENDS, **joint)
    else:
        scene.add_joint(kind, *sides, tx=ENDS, **joint)
    return scene


@pytest.mark.parametrize("kind", ["slider", "cylindrical"])
@pytest.mark.parametrize("axis", AXES)
@pytest.mark.parametrize("turned", [False, True])
def test_a_slide_reads_as_in_the_source(
    kind: str, axis: tuple[float, float, float], turned: bool, tmp_path: Path
):
    """Of an asymmetric range Unity's component keeps the middle and counts the connected body; neither is shown."""
    scene = machine(axis, kind, turned)
    kinefab.export(scene, tmp_path / "m.kinefab")
    given, written = kinefab.motion(scene), kinefab.motion(tmp_path / "m.kinefab")
    pairs = list(zip(given.coordinates, written.coordinates, strict=True))
    for own in pairs[0]:
        assert (own.value, own.lower, own.upper) == pytest.approx((0.0, *ENDS), abs=1e-9)
    first, second = (m.sweep(own.name, 0, -0.15, frames=4) for m, own in zip((given, written), pairs[0]))
    assert np.allclose(first["Block"], second["Block"], atol=1e-9)
    for here, there in pairs:
        assert np.allclose(first[here.name], second[there.name], atol=1e-6)


@pytest.mark.parametrize("axis", AXES)
@pytest.mark.parametrize("turned", [False, True])
def test_a_rack_that_is_written_follows_its_pinion_the_same_way(
    axis: tuple[float, float, float], turned: bool, tmp_path: Path
):
    """A coupling of the slide is read back in the sense of the slide."""
    scene = machine(axis, "slider", turned)
    pinion = scene.add_part("Pinion", trimesh.creation.box((0.03, 0.02, 0.05)), translation=(0.1, 0.2, 0.3))
    turn = scene.add_hinge(None, pinion, point=(0.1, 0.2, 0.3), axis=(0, 0.6, 0.8), name="Pinion")
    scene.add_coupling(turn, scene.joints[0], ratio=-0.001)
    kinefab.export(scene, tmp_path / "m.kinefab")
    for mechanism in (kinefab.motion(scene), kinefab.motion(tmp_path / "m.kinefab")):
        motion = mechanism.sweep("Pinion", 0, 90, frames=4)
        assert np.allclose(motion["Slide"], [0, -0.03, -0.06, -0.09], atol=1e-9)
