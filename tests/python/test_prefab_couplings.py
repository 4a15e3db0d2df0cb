"""Couplings: told where nothing keeps them, in the prefab with their script where it is asked for."""

from __future__ import annotations

import json
import tarfile
from pathlib import Path

import kinefab
import pytest
import trimesh
from kinefab.targets.prefab.objects.couplings import SCRIPT
from prefab_reader import Project
from prefab_scenes import rich_scene
from unity_yaml import documents, mapping


def test_couplings_without_a_script_are_told(tmp_path):
    result = kinefab.export(rich_scene(tmp_path), tmp_path / "Rich.prefab")
    told = [o for o in result.report.outcomes if o.code == "COUPLING_NOT_IN_PREFAB"]
    assert [(o.feature, o.outcome.value) for o in told] == [
        ("coupling Gear", "dropped"),
        ("coupling Rack", "dropped"),
    ]
    assert "KinefabCoupling" not in (tmp_path / "Rich.prefab").read_text()
    assert not list(tmp_path.rglob("*.cs"))


def test_the_script_is_in_the_prefab_and_refers_to_the_joints(tmp_path):
    scene = rich_scene(tmp_path)
    options = kinefab.ExportOptions(writing={"scripts": True})
    (tmp_path / "out").mkdir()
    result = kinefab.export(scene, tmp_path / "out" / "Rich.prefab", options)
    assert not any(o.code == "COUPLING_NOT_IN_PREFAB" for o in result.report.outcomes)
    project = Project(tmp_path / "out")
    found = {str(d.file_id): d for d in documents((tmp_path / "out" / "Rich.prefab").read_text("utf-8"))}
    scripts = [d for d in found.values() if d.kind == "MonoBehaviour"]
    assert len(scripts) == 2
    for document, coupling in zip(
        sorted(scripts, key=lambda d: d.fields["driven"]["fileID"] in found), result.unity.couplings
    ):
        fields = document.fields
        assert project.paths[fields["m_Script"]["guid"]].name == SCRIPT
        assert fields["m_Script"]["fileID"] == "11500000" and fields["m_Script"]["type"] == "3"
        assert found[fields["driven"]["fileID"]].fields["m_GameObject"] == fields["m_GameObject"]
        assert all(found[t["joint"]["fileID"]].kind.endswith("Joint") for t in fields["terms"])
        del coupling
    by_offset = {float(d.fields["offset"]): d.fields for d in scripts}
    for coupling in result.unity.couplings:
        (fields,) = [
            f for o, f in by_offset.items() if o == pytest.approx(coupling.offset, rel=1e-6, abs=1e-9)
        ]
        assert float(fields["terms"][0]["ratio"]) == pytest.approx(coupling.terms[0].ratio, rel=1e-6)
    (assembly,) = (tmp_path / "out").rglob("*.asmdef")
    assert json.loads(assembly.read_text())["references"] == []
    assert "AssemblyDefinitionImporter" in mapping(Path(f"{assembly}.meta").read_text())


def test_a_project_has_the_script_once(tmp_path):
    """Two assemblies of one name would keep the project from compiling; a second export of the first keeps its own."""
    assets = tmp_path / "Assets"
    options = kinefab.ExportOptions(writing={"scripts": True})
    for name in ("One", "Two", "One", "Inner/Three"):
        (assets / name).parent.mkdir(parents=True, exist_ok=True)
        kinefab.export(rich_scene(tmp_path), assets / f"{name}.prefab", options)
    assert [p.relative_to(assets) for p in assets.rglob("*.cs")] == [Path("One/Scripts") / SCRIPT]
    project = Project(assets)
    for prefab in assets.rglob("*.prefab"):
        kept = [d for d in documents(prefab.read_text("utf-8")) if d.kind == "MonoBehaviour"]
        assert len(kept) == 2 and all(
            project.paths[d.fields["m_Script"]["guid"]].name == SCRIPT for d in kept
        )


def test_a_project_keeps_the_script_that_others_need(tmp_path):
    """The export that brought it is made again without it; outside a project it goes."""
    options = kinefab.ExportOptions(writing={"scripts": True})
    for assets, stays in ((tmp_path / "Assets", True), (tmp_path / "out", False)):
        assets.mkdir()
        for name, asked in (("One", options), ("Two", options), ("One", kinefab.ExportOptions())):
            kinefab.export(rich_scene(tmp_path), assets / f"{name}.prefab", asked)
        assert (assets / "One" / "Scripts" / SCRIPT).exists() is stays
        assert (assets / "Two" / "Scripts" / SCRIPT).exists() is not stays
        assert "MonoBehaviour" not in (assets / "One.prefab").read_text("utf-8")
        if stays:
            scripts = [
                d for d in documents((assets / "Two.prefab").read_text("utf-8")) if d.kind == "MonoBehaviour"
            ]
            project = Project(assets)
            assert {project.paths[d.fields["m_Script"]["guid"]].name for d in scripts} == {SCRIPT}


def test_every_package_has_the_same_script_at_the_same_place(tmp_path):
    """Two classes of one name would not compile."""
    entries = []
    for name in ("One", "Two"):
        options = kinefab.ExportOptions(writing={"scripts": True})
        kinefab.export(rich_scene(tmp_path), tmp_path / f"{name}.unitypackage", options)
        with tarfile.open(tmp_path / f"{name}.unitypackage") as tar:
            names = {m.name: tar.extractfile(m).read() for m in tar if m.isfile()}
        own = {
            n: d
            for n, d in names.items()
            if names[f"{n.partition('/')[0]}/pathname"].endswith((b".cs", b".asmdef", b"/Scripts"))
        }
        entries.append(own)
    assert entries[0] == entries[1] and len(entries[0]) == 8


def test_a_mimic_that_holds_at_the_pose_has_no_offset(tmp_path):
    """0.2 m a radian; no noise of its offset, which would change with every machine."""
    link = '<link name="{}"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
    (tmp_path / "r.urdf").write_text(
        f'<robot name="r">{"".join(map(link.format, "abc"))}'
        '<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>'
        '<limit lower="-0.5" upper="1.2" effort="11" velocity="2"/></joint>'
        '<joint name="k" type="prismatic"><parent link="a"/><child link="c"/><origin xyz="0 1 0"/><axis xyz="0 1 0"/>'
        '<limit lower="-0.1" upper="0.4" effort="12" velocity="3"/><mimic joint="j" multiplier="0.2" offset="0.05"/></joint></robot>'
    )
    kinefab.export(
        tmp_path / "r.urdf", tmp_path / "R.prefab", kinefab.ExportOptions(writing={"scripts": True})
    )
    (own,) = [
        d.fields for d in documents((tmp_path / "R.prefab").read_text("utf-8")) if d.kind == "MonoBehaviour"
    ]
    assert own["offset"] == "0" and own["drivenCoordinate"] == "1"
    assert float(own["terms"][0]["ratio"]) == pytest.approx(0.2 * 3.141592654 / 180, rel=1e-6)


def geared_links(ball: bool = False) -> kinefab.Scene:
    """A wheel that leads a slide, both links; with ``ball`` a ball joint leads instead."""
    scene = kinefab.Scene()
    box = trimesh.creation.box((0.1, 0.2, 0.3))
    base = scene.add_part("Base", box, grounded=True)
    wheel = scene.add_part("Wheel", box, translation=(1, 0, 0))
    slide = scene.add_part("Slide", box, translation=(0, 2, 0))
    if ball:
        turn = scene.add_joint("spherical", base, wheel, point=(1, 0, 0), name="Turn")
    else:
        turn = scene.add_hinge(wheel, base, point=(1, 0, 0), axis=(0, 0, 1), name="Turn")
    rail = scene.add_slider(base, slide, axis=(0, 1, 0), point=(0, 2, 0), name="Rail")
    scene.add_coupling((turn, "rx") if ball else turn, rail, 0.05, name="Rack")
    return scene


@pytest.mark.parametrize("unity", ["2021", "2022", "6"])
def test_the_script_refers_to_links_of_an_articulation(tmp_path, unity):
    options = kinefab.ExportOptions(writing={"scripts": True, "physics": "articulation", "unity": unity})
    result = kinefab.export(geared_links(), tmp_path / "a.prefab", options)
    assert not any(o.code == "COUPLING_NOT_IN_PREFAB" for o in result.report.outcomes)
    found = {str(d.file_id): d for d in documents((tmp_path / "a.prefab").read_text("utf-8"))}
    (fields,) = [d.fields for d in found.values() if d.kind == "MonoBehaviour"]
    (term,) = fields["terms"]
    assert fields["driven"] == term["joint"] == {"fileID": "0"}
    driven, leading = (found[r["fileID"]] for r in (fields["drivenArticulationBody"], term["articulationBody"]))
    assert driven.kind == leading.kind == "ArticulationBody"
    assert driven.fields["m_GameObject"] == fields["m_GameObject"]
    assert (driven.fields["m_ArticulationJointType"], leading.fields["m_ArticulationJointType"]) == ("1", "2")
    assert (fields["drivenCoordinate"], term["coordinate"]) == ("1", "4")
    (tmp_path / "k").mkdir()
    kinefab.export(geared_links(), tmp_path / "k" / "a.kinefab", kinefab.ExportOptions(writing={"physics": "articulation"}))
    (coupling,) = json.loads((tmp_path / "k" / "a.kinefab").read_text("utf-8"))["couplings"]
    assert float(term["ratio"]) == pytest.approx(coupling["ratio"], rel=1e-6)
    assert float(fields["offset"]) == pytest.approx(coupling.get("offset", 0.0), abs=1e-9)


def test_a_coupling_with_a_ball_of_an_articulation_is_told(tmp_path):
    """Whose three coordinates PhysX does not count as a joint's are counted."""
    options = kinefab.ExportOptions(writing={"scripts": True, "physics": "articulation"})
    result = kinefab.export(geared_links(ball=True), tmp_path / "a.prefab", options)
    assert [o.feature for o in result.report.outcomes if o.code == "COUPLING_NOT_IN_PREFAB"] == ["coupling Rack"]
    assert "MonoBehaviour" not in (tmp_path / "a.prefab").read_text("ascii") and not list(tmp_path.rglob("*.cs"))
