"""Couplings: told where nothing keeps them, kept by a script where it is asked for, and the script run."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import tarfile
from pathlib import Path

import kinefab
import pytest
from kinefab.targets.prefab.objects.couplings import FOLDER, SCRIPT
from prefab_reader import Project
from prefab_scenes import rich_scene
from unity_yaml import documents, mapping

STAND_INS = Path(__file__).parents[1] / "csharp" / "Kinefab.UnityImport" / "UnityEngine"
OWN = Path(__file__).parent / "coupling_script"
ELDER, NEWER = "", "UNITY_2022_2_OR_NEWER;UNITY_6000_0_OR_NEWER"


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
            names = {m.name: tar.extractfile(m).read() for m in tar}
        own = {
            n: d
            for n, d in names.items()
            if names[f"{n.partition('/')[0]}/pathname"].endswith((b".cs", b".asmdef", b"/Scripts"))
        }
        entries.append(own)
    assert entries[0] == entries[1] and len(entries[0]) == 8


def for_mono(text: str) -> str:
    """Without the two things that Debian's compiler has not learned: MathF, and one assignment to several fields."""

    def single(match: re.Match) -> str:
        pairs = zip(match[1].split(", "), match[2].split(", "))
        return "{ " + " ".join(f"{a} = {b};" for a, b in pairs) + " }"

    text = re.sub(r"=> \((this\.[^)]*)\) = \(([^)]*)\);", single, text)
    return text.replace("MathF.Pow(c, 1 / 2.4f)", "(float)Math.Pow(c, 1 / 2.4f)")


@pytest.fixture(scope="module", params=[ELDER, NEWER], ids=["2021", "6"])
def program(request, tmp_path_factory) -> Path:
    """The script and the test's gear pair, compiled against the stand-ins of UnityEngine."""
    if not (shutil.which("mcs") and shutil.which("mono")):
        pytest.skip("the Mono compiler is not installed (apt-get install mono-mcs)")
    folder = tmp_path_factory.mktemp("script")
    sources = []
    for path in (STAND_INS / f"{name}.cs" for name in ("Bodies", "Joints", "Objects", "Values", "Meshes")):
        text = path.read_text("utf-8")
        for name in ("Rigidbody", "Transform"):
            text = text.replace(f"public sealed class {name} ", f"public sealed partial class {name} ")
        sources.append(folder / path.name)
        sources[-1].write_text(for_mono(text), "utf-8")
    out = folder / "gear.exe"
    define = [f"-define:{request.param}"] if request.param else []
    command = [
        "mcs",
        "-langversion:7",
        "-warnaserror+",
        "-nowarn:0649",
        *define,
        f"-out:{out}",
        *map(str, sources),
    ]
    command += [
        str(FOLDER / SCRIPT),
        *(
            str(OWN / f"{name}.cs")
            for name in ("MotionStandIns", "GearPair", "Slide", "Release", "Recompiled")
        ),
    ]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return out


@pytest.mark.parametrize(
    "how",
    [
        "moved",
        "hinge",
        "configurable",
        "driven slide",
        "swapped slide",
        "moved slide",
        "from slide",
        "moved screw",
        "late moved",
        "late hinge",
        "recompiled moved",
        "recompiled hinge",
        "recompiled configurable",
    ],
)
def test_a_gear_pair_keeps_its_ratio_over_a_thousand_steps(program, how):
    """Degrees that it is off, and millimetres that it leaves its axle: float32 is all there is.  Slides too, which count from the
    pose of the prefab and not from where their anchors meet; a component that is enabled late, and one whose script is compiled
    anew while the editor plays."""
    done = subprocess.run(["mono", str(program), how], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) < 2e-3


@pytest.mark.parametrize(
    "how", ["free hinge", "free configurable", "free broken hinge", "free broken configurable"]
)
def test_a_joint_that_is_driven_no_longer_has_its_own_drives_again(program, how):
    """The component is disabled, as a clutch opens, or the joint that leads has broken."""
    done = subprocess.run(["mono", str(program), how], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) == 0


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
