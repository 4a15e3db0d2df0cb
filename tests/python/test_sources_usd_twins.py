"""The twins of ``fixtures/twins`` as USD stages, against the CAD bundles; then moved, weighed and counted against pxr."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import kinefab
import pytest
from test_sources_twins import TWINS, compare, exported, plain

pytest.importorskip("pxr", reason="usd-core is not installed")
sys.path.append(str(Path(__file__).resolve().parents[2] / "python" / "bench"))

ROUNDED = 2e-7
"""USD keeps masses, inertias and limits in 32 bits."""


@pytest.mark.parametrize("name", ["lever", "arm", "fourbar"])
def test_a_stage_is_its_twin(tmp_path, name):
    document = exported(TWINS / f"{name}.usda", tmp_path)
    titles = {joint.id: joint.name for joint in kinefab_joints(TWINS / f"{name}.usda", tmp_path)}
    for entry in document["gameObjects"]:
        for component in entry.get("components", ()):
            if "because" in component:
                component["because"] = [titles.get(word, word) for word in component["because"]]
    given = {key: value for key, value in plain(document, set()).items() if "/site:" not in key}
    compare(plain(exported(TWINS / f"{name}.bundle.json", tmp_path), set()), given, name, ROUNDED)


def kinefab_joints(path: Path, folder: Path):
    return kinefab.export(path, folder / "again.kinefab").analysed.scene.joints


@pytest.mark.parametrize("name", ["twins/lever", "twins/arm", "twins/fourbar", "lever/lever"])
def test_a_stage_moves_weighs_and_counts_as_pxr_has_it(tmp_path, name):
    """50 random configurations within the limits, every body to 1e-6; masses to 1e-6; limits; mobility by rank."""
    import numpy as np
    from engines import usd
    from scene_kinematics import SceneKinematics
    from scoring import compared

    source = TWINS.parent / f"{name}.usda"
    result = kinefab.export(source, tmp_path / "scene.kinefab")
    engine = usd.load(source, ())
    motion = SceneKinematics.load(result.path)
    wrong: list[str] = []
    found = compared(motion, engine, 50, set(), wrong)
    assert not wrong and max(found["fk"]) < 1e-6
    analysis = json.loads(result.path.read_text("utf-8"))["analysis"]
    couplings = len(result.analysed.scene.couplings)
    assert analysis["mobility"] == engine.mobility - couplings
    assert np.isfinite(found["mass_error"])
