"""Endings in capitals are the same endings: of what is written, of what is read, of what is looked at."""

from __future__ import annotations

import shutil

import pytest
from command_line import LEVER, run

pytest.importorskip("pxr", reason="usd-core is not installed")


@pytest.mark.parametrize(
    "name, written",
    [
        ("Robot.KINEFAB", "Robot.KINEFAB"),
        ("Robot.GLB", "Robot.GLB"),
        ("Robot.USDA", "Robot.USDA"),
        ("Robot.UsdZ", "Robot.UsdZ"),
        ("Robot.UnityPackage", "Robot.UnityPackage"),
        ("Robot.PREFAB", "Robot.prefab"),  # Unity's own writing, beside which the metas stand
    ],
)
def test_a_target_in_capitals(tmp_path, name, written):
    done = run("export", str(LEVER), "-o", str(tmp_path / name))
    assert done.returncode == 0, done.stdout + done.stderr
    assert (tmp_path / written).is_file() and written in (done.stdout + done.stderr)
    assert (tmp_path / "Robot").is_dir() is (written == "Robot.prefab")


def test_sources_and_pictures_in_capitals(tmp_path):
    """The same scene, whatever the capitals; a USD stage too, which the library opens by its ending."""
    folder = tmp_path / "in"
    shutil.copytree(LEVER.parent, folder)
    (folder / LEVER.name).rename(folder / "LEVER.BUNDLE.JSON")
    for source in ("LEVER.BUNDLE.JSON", "LEVER.USDC"):
        scene = tmp_path / "Lever.KINEFAB"
        if source.endswith("USDC"):
            assert run("export", str(LEVER), "-o", str(folder / source)).returncode == 0
        done = run("export", str(folder / source), "-o", str(scene))
        assert done.returncode == 0, done.stdout + done.stderr
        assert run("inspect", str(scene)).returncode == 0
        for command, page in (("draw", "L.SVG"), ("view", "L.HTML")):
            done = run(command, str(scene), "-o", str(tmp_path / page))
            assert done.returncode == 0 and (tmp_path / page).stat().st_size > 1000, done.stdout + done.stderr
