"""One mechanism in several formats becomes the same scene, number by number (``fixtures/twins``)."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from same_scene import compare, exported, plain

TWINS = Path(__file__).parents[2] / "fixtures" / "twins"
TREES = ("urdf",)
"""Formats that hold no loop."""
LOOPS = ("sdf", "xml")
"""Formats that hold them."""


@pytest.mark.parametrize("ending", [*TREES, *LOOPS])
@pytest.mark.parametrize("name", ["lever", "arm", "fourbar"])
def test_a_twin_is_the_same_scene(tmp_path, name, ending):
    """Against the CAD bundle; what a tree leaves out, the joint that closes the loop, is left out of both."""
    if ending == "xml":
        pytest.importorskip("mujoco", reason="MuJoCo is not installed")
    bundle = TWINS / f"{name}.bundle.json"
    if ending in TREES:
        values = json.loads(bundle.read_text(encoding="utf-8"))
        values["joints"] = [j for j in values["joints"] if j["name"] not in ("Gudgeon", "Closing pin")]
        bundle = tmp_path / f"{name}.bundle.json"
        bundle.write_text(json.dumps(values), encoding="utf-8")
    expected = plain(exported(bundle, tmp_path), set())
    compare(expected, plain(exported(TWINS / f"{name}.{ending}", tmp_path), set()), name)


def test_the_folder_is_what_its_script_writes(tmp_path, monkeypatch):
    import runpy
    import shutil

    shutil.copytree(TWINS, tmp_path / "twins")
    (tmp_path / "lever").mkdir()
    monkeypatch.syspath_prepend(str(tmp_path / "twins"))
    runpy.run_path(str(tmp_path / "twins" / "make.py"), run_name="__main__")
    for path in sorted([*TWINS.glob("*.json"), *TWINS.glob("*.urdf"), *TWINS.glob("*.sdf")]):
        assert (tmp_path / "twins" / path.name).read_text("utf-8") == path.read_text("utf-8"), path.name
    written = sorted((tmp_path / "lever").iterdir())
    assert written and all(
        p.read_text("utf-8") == (TWINS.parent / "lever" / p.name).read_text("utf-8") for p in written
    )
