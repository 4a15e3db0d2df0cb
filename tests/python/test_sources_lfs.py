"""Git LFS: a text of three lines in place of a file, in every format, as source and as mesh."""

from __future__ import annotations

from pathlib import Path

import kinefab
import pytest
from kinefab.diagnostics import KinefabError, Report
from kinefab.geometry.loading import MeshFiles
from kinefab.sources import known_suffixes

POINTER = (
    "version https://git-lfs.github.com/spec/v1\n"
    "oid sha256:4d7a214614ab2935c943f9e0ff69d22eadbb8f32b1258daaa5e2ca24d17e2393\nsize 12345\n"
)


@pytest.mark.parametrize("suffix", sorted(known_suffixes()))
def test_a_pointer_in_place_of_a_source_says_what_to_run(suffix: str, tmp_path: Path):
    (tmp_path / f"robot{suffix}").write_text(POINTER, encoding="utf-8")
    with pytest.raises(KinefabError) as caught:
        kinefab.export(tmp_path / f"robot{suffix}", tmp_path / "out.kinefab")
    (found,) = caught.value.diagnostics
    assert found.code == "SOURCE_LFS_POINTER"
    assert "git lfs pull" in found.remedy
    assert not (tmp_path / "out.kinefab").exists()


@pytest.mark.parametrize("mesh", ["arm.stl", "arm.obj", "arm.dae", "arm.step", "arm.glb"])
def test_a_pointer_in_place_of_a_mesh_says_what_to_run(mesh: str, tmp_path: Path):
    (tmp_path / mesh).write_text(POINTER, encoding="utf-8")
    (tmp_path / "robot.urdf").write_text(
        f"<robot name='r'><link name='a'><visual><geometry><mesh filename='{mesh}'/></geometry></visual></link></robot>",
        encoding="utf-8",
    )
    try:
        found = kinefab.export(tmp_path / "robot.urdf", tmp_path / "out.kinefab").report.diagnostics
    except KinefabError as error:
        found = error.diagnostics
    assert any("run git lfs pull" in d.message for d in found), found


def test_a_pointer_in_place_of_a_mesh_is_a_finding_of_its_own(tmp_path: Path):
    (tmp_path / "arm.stl").write_text(POINTER, encoding="utf-8")
    report = Report()
    assert MeshFiles(report).get(tmp_path / "arm.stl", "here") is None
    assert [(d.code, d.where) for d in report.diagnostics] == [("GEOMETRY_LFS_POINTER", "here")]
