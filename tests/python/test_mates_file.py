"""The mates file and what uses it: written, edited, switched off, given to the export; wrong ones are refused."""

from __future__ import annotations

import json
from pathlib import Path

import kinefab
import pytest
from command_line import run
from kinefab.analysis import analyse
from kinefab.diagnostics import KinefabError, Report
from kinefab.mates.asked import mated
from kinefab.mates.find import find_mates
from kinefab.mates.mates_file import text
from kinefab.model import ConstraintKind, Node, Scene
from kinefab.sources import read

pytest.importorskip("OCP", reason="OpenCASCADE is not installed: pip install cadquery-ocp-novtk")

LEVER = Path(__file__).resolve().parents[2] / "fixtures" / "lever" / "lever.step"


@pytest.fixture(scope="module")
def lever() -> Scene:
    return read(LEVER, Report())


@pytest.fixture
def file(lever: Scene, tmp_path: Path) -> Path:
    path = tmp_path / "lever.mates.json"
    path.write_text(text(lever, find_mates(lever)), encoding="utf-8")
    return path


def changed(path: Path, change) -> Path:
    values = json.loads(path.read_text(encoding="utf-8"))
    change(values)
    path.write_text(json.dumps(values), encoding="utf-8")
    return path


def mobility(lever: Scene, path: Path | str) -> int:
    return analyse(mated(lever, {"mates": str(path)}, Report())).mobility


def test_the_file_says_what_auto_does(lever: Scene, file: Path):
    from_file = mated(lever, {"mates": str(file)}, Report())
    found = mated(lever, {"mates": "auto"}, Report())
    assert [(c.id, c.kind) for c in from_file.constraints] == [(c.id, c.kind) for c in found.constraints]
    for a, b in zip(from_file.constraints, found.constraints, strict=True):
        for own, other in zip(a.features, b.features, strict=True):
            assert own.node == other.node and own.kind is other.kind
            assert own.point == pytest.approx(other.point, abs=1e-11)
    assert [n.grounded for n in from_file.nodes] == [n.grounded for n in found.nodes]
    assert mobility(lever, file) == mobility(lever, "auto") == 1


def test_a_mate_that_is_switched_off_is_not_used(lever: Scene, file: Path):
    def off(values):
        slide = next(c for c in values["constraints"] if c["joint"] == "prismatic")
        slide["enabled"] = False

    report = Report()
    scene = mated(lever, {"mates": str(changed(file, off))}, report)
    assert analyse(scene).mobility > 1
    assert "FEATURE_SUPPRESSED" in [d.code for d in report.diagnostics]


def test_what_does_not_say_whether_it_is_on_is_judged_by_the_threshold(lever: Scene, file: Path):
    def unsaid(values):
        slide = next(c for c in values["constraints"] if c["joint"] == "prismatic")
        del slide["enabled"]
        slide["confidence"] = 0.4

    assert mobility(lever, changed(file, unsaid)) > mobility(lever, "auto")
    assert mobility(lever, changed(file, lambda v: v.update(threshold=0.3))) == mobility(lever, "auto")


def test_the_field_that_is_wrong_is_named(lever: Scene, file: Path):
    def words(values):
        values["constraints"][0]["enabled"] = "no"
        values["constraints"][1]["confidence"] = "high"

    with pytest.raises(KinefabError) as raised:
        mobility(lever, changed(file, words))
    places = [d.where.partition("#")[2] for d in raised.value.diagnostics]
    assert places == ["/constraints/0/enabled", "/constraints/1/confidence"]


def test_every_mate_is_reported_as_found(lever: Scene, file: Path):
    report = Report()
    mated(lever, {"mates": "auto"}, report)
    assert [d.code for d in report.diagnostics] == ["MATE_FOUND"] * 6 + ["GROUND_FOUND"]
    assert all(o.outcome.value == "approximated" for o in report.outcomes)
    report = Report()
    mated(lever, {"mates": str(file)}, report)
    assert [d.code for d in report.diagnostics] == ["MATE_FROM_FILE"] * 6 + ["GROUND_FOUND"]


def test_the_ground_can_be_named(lever: Scene):
    scene = mated(lever, {"mates": "auto", "ground": "SliderD:1"}, Report())
    assert [n.id for n in scene.nodes if n.grounded] == ["Lever/SliderD:1"]
    report = Report()
    mated(lever, {"mates": "auto", "ground": "Nobody"}, report)
    assert "GROUND_UNKNOWN" in [d.code for d in report.diagnostics]


def test_where_no_part_has_faces_none_is_said_to_be_called_otherwise():
    report = Report()
    mated(Scene([Node("Base", "Base"), Node("Arm", "Arm")]), {"mates": "auto", "ground": "Base"}, report)
    assert not report.diagnostics


def test_without_mates_a_file_of_parts_is_told_so(lever: Scene):
    report = Report()
    assert mated(lever, {}, report) is lever
    assert [d.code for d in report.diagnostics] == ["MATES_NOT_ASKED"]


def test_mates_that_are_neither_auto_nor_a_file_are_refused_and_both_are_named(lever):
    with pytest.raises(KinefabError) as refused:
        mated(lever, {"mates": "atuo"}, Report())
    (told,) = refused.value.diagnostics
    assert told.code == "MATES_NOT_FOUND" and "atuo" in told.message
    assert "auto" in told.remedy and ".mates.json" in told.remedy


@pytest.mark.parametrize(
    ("text", "code"),
    [
        (None, "MATES_NOT_FOUND"),
        ("{", "JSON_SYNTAX"),
        ("[]", "BUNDLE_NOT_OBJECT"),
        ('{"format": "kinefab.scene", "version": "1.0", "constraints": []}', "BUNDLE_FORMAT"),
        ('{"format": "kinefab.mates", "version": "1.0"}', "BUNDLE_FIELD_MISSING"),
        ('{"format": "kinefab.mates", "version": "1.0", "constraints": [{}]}', "BUNDLE_FIELD_TYPE"),
    ],
)
def test_a_page_of_a_mates_file_that_is_none_is_refused_as_an_export_is(text, code, tmp_path):
    path = tmp_path / "robot.mates.json"
    if text is not None:
        path.write_text(text, encoding="utf-8")
    options = kinefab.ExportOptions(reading={"mates": str(path)})
    with pytest.raises(KinefabError) as refused:
        kinefab.view(LEVER.with_name("lever.kinefab"), tmp_path / "page.html", options)
    assert code in [diagnostic.code for diagnostic in refused.value.diagnostics]
    assert not (tmp_path / "page.html").exists()


def test_a_mate_below_the_threshold_is_left_out(lever: Scene):
    from kinefab.mates.apply import with_found

    report = Report()
    scene = with_found(lever, find_mates(lever), report, threshold=0.85)
    assert not scene.constraints
    assert [d.code for d in report.diagnostics][:6] == ["MATE_UNSURE"] * 6


def test_parts_that_nothing_holds_are_told(tmp_path: Path):
    plates = LEVER.parents[1] / "step" / "two_plates_inch_ap242.step"
    report = Report()
    scene = mated(read(plates, Report()), {"mates": "auto"}, report)
    assert [d.code for d in report.diagnostics] == ["MATE_NONE", "GROUND_FOUND"]
    assert not scene.constraints


@pytest.mark.parametrize(
    "change, code",
    [
        (lambda v: v.update(format="other"), "BUNDLE_FORMAT"),
        (lambda v: v.update(version="2.0"), "BUNDLE_VERSION"),
        (lambda v: v.update(ground="Nobody"), "COMPONENT_UNKNOWN"),
        (lambda v: v["constraints"][0]["a"].update(component="Nobody"), "COMPONENT_UNKNOWN"),
        (lambda v: v["constraints"][2]["a"].pop("p"), "BUNDLE_FIELD_MISSING"),
        (lambda v: v["constraints"].append(dict(v["constraints"][0])), "SOURCE_ID_DUPLICATE"),
        (lambda v: v["constraints"][0].update(enabled="maybe"), "BUNDLE_FIELD_TYPE"),
        (lambda v: v.update(constraints="none"), "BUNDLE_FIELD_TYPE"),
    ],
)
def test_a_wrong_file_is_refused(lever: Scene, file: Path, change, code: str):
    report = Report()
    with pytest.raises(KinefabError):
        mated(lever, {"mates": str(changed(file, change))}, report)
    assert code in [d.code for d in report.diagnostics]


def test_a_file_without_its_list_is_refused(lever: Scene, file: Path):
    with pytest.raises(KinefabError) as raised:
        mobility(lever, changed(file, lambda values: values.pop("constraints")))
    assert [d.code for d in raised.value.diagnostics] == ["BUNDLE_FIELD_MISSING"]


def test_mates_of_another_version_are_told(lever: Scene, file: Path):
    report = Report()
    mated(lever, {"mates": str(changed(file, lambda v: v.update(sha256="0" * 64)))}, report)
    assert report.diagnostics[0].code == "MATES_OF_OTHER_SOURCE"


def test_the_command_writes_and_the_export_reads(tmp_path: Path):
    """kinefab mates, then kinefab export --mates FILE."""
    file, scene = tmp_path / "lever.mates.json", tmp_path / "lever.kinefab"
    done = run("mates", str(LEVER), "-o", str(file))
    assert done.returncode == 0 and "revolute" in done.stdout and "ground: Lever/Base:1 (hub)" in done.stdout
    done = run("export", str(LEVER), "--mates", str(file), "-o", str(scene))
    assert done.returncode == 0, done.stderr
    joints = [
        c["type"]
        for o in json.loads(scene.read_text())["gameObjects"]
        for c in o.get("components", ())
        if "Joint" in c["type"]
    ]
    assert sorted(joints) == ["ConfigurableJoint", "HingeJoint", "HingeJoint", "HingeJoint"]


def test_a_source_without_exact_faces_has_no_mates(tmp_path: Path):
    done = run("mates", str(LEVER.with_name("lever.bundle.json")), "-o", str(tmp_path / "x.mates.json"))
    assert done.returncode == 1 and "MATES_WITHOUT_FACES" in done.stderr


def test_words_of_the_mates_are_those_of_the_model(file: Path):
    kinds = {c["kind"] for c in json.loads(file.read_text(encoding="utf-8"))["constraints"]}
    assert kinds <= {kind.value for kind in ConstraintKind}
