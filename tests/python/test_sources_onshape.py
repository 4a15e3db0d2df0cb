"""Onshape's saved answers as a source: the lever is the bundle's lever, by the road of the capture."""

from __future__ import annotations

import copy
import json
import os
import random
import shutil
import sys

import kinefab
import numpy as np
import pytest
from command_line import run
from kinefab import sources
from kinefab.diagnostics import KinefabError, Report
from same_scene import compare, exported, undrawn, value_paths
from source_bundles import FIXTURES
from test_sources_freecad_bad_input import damaged

LEVER = FIXTURES / "lever"
DEFINITION = LEVER / "onshape" / "definition.json"
MUTATIONS = int(os.environ.get("KINEFAB_ONSHAPE_MUTATIONS", "30"))
sys.path.insert(0, str(LEVER))

from onshape_form import as_mates  # noqa: E402


def copied(folder):
    for path in DEFINITION.parent.iterdir():
        shutil.copy(path, folder / path.name)
    return folder / "definition.json"


def test_the_lever_is_the_bundles_lever(tmp_path):
    """Joints, limits, poses; each part has the one mesh of its STL, in the bundle too."""
    values = as_mates(json.loads((LEVER / "lever.bundle.json").read_text("utf-8")))
    values.pop("materials")
    values["meta"]["mesh"] = {"units": "m", "layout": "per_part", "coordinates": "part"}
    for component in values["components"]:
        if component.pop("bodies", None):
            file = f"E{component['definition']}_JHD.stl"
            shutil.copy(DEFINITION.parent / file, tmp_path / file)
            component["file"], component["bodies"] = file, [{"id": component["name"]}]
    bundle = tmp_path / "lever.bundle.json"
    bundle.write_text(json.dumps(values), "utf-8")
    expected, found = (undrawn(exported(path, tmp_path)) for path in (bundle, DEFINITION))
    assert sum("Joint" in key for key in expected) == 4
    assert any("limited" in str(value).lower() for value in expected.values())  # the slide's range
    compare(expected, found, "lever", 2e-6)


def test_the_command_and_the_source_take_one_road(tmp_path):
    made = run("capture", "onshape", DEFINITION.parent, "-o", tmp_path / "lever.bundle.json")
    assert made.returncode == 0, made.stderr
    one, two = (undrawn(exported(path, tmp_path)) for path in (tmp_path / "lever.bundle.json", DEFINITION))
    compare(one, two, "lever", 1e-7)


def test_meshes_stand_where_the_bundle_has_them(tmp_path):
    found = kinefab.export(DEFINITION, tmp_path / "a.kinefab").analysed.scene
    expected = kinefab.export(LEVER / "lever.bundle.json", tmp_path / "b.kinefab").analysed.scene
    for other in expected.nodes:
        if other.bodies:
            node = next(n for n in found.nodes if n.id == other.id)
            points = node.pose.point(found.meshes[node.bodies[0].mesh].vertices)
            wanted = np.concatenate(
                [other.pose.point(expected.meshes[b.mesh].vertices) for b in other.bodies]
            )
            np.testing.assert_allclose(points.min(axis=0), wanted.min(axis=0), atol=2e-8)
            np.testing.assert_allclose(points.max(axis=0), wanted.max(axis=0), atol=2e-8)


@pytest.mark.parametrize("missing", ["features", "matevalues", "name"])
def test_an_answer_that_was_not_saved_is_told(tmp_path, missing):
    path = copied(tmp_path)
    (tmp_path / f"{missing}.json").unlink()
    report = Report()
    assert len(sources.read(path, report).joints) == 6
    assert [d.code for d in report.diagnostics] == ([] if missing == "name" else ["CAPTURE_NOT_SAVED"])
    assert all(f"{missing}.json" in d.message and "Rebuild" not in d.remedy for d in report.diagnostics)


def test_meshes_that_were_not_saved_are_told_once(tmp_path):
    """A definition alone: the joints move, and one finding says which files would draw the parts."""
    path = shutil.copy(DEFINITION, tmp_path)
    report = Report()
    scene = sources.read(path, report)
    assert len(scene.joints) == 6 and not any(node.bodies for node in scene.nodes)
    codes = [d.code for d in report.diagnostics]
    assert codes.count("CAPTURE_MESHES_NOT_SAVED") == 1 and "CAPTURE_MEMBER_FAILED" not in codes
    (told,) = (d for d in report.diagnostics if d.code == "CAPTURE_MESHES_NOT_SAVED")
    assert "6 part(s)" in told.message and "EShaft.ipt_JHD.glb" in told.message
    lost = [o.feature for o in report.outcomes if o.code == "CAPTURE_MESHES_NOT_SAVED"]
    assert len(lost) == 6 and "mesh of BarC:1" in lost
    shutil.copy(DEFINITION.parent / "EBarC.ipt_JHD.stl", tmp_path)
    report = Report()
    sources.read(path, report)
    assert any("5 part(s)" in d.message for d in report.diagnostics)


def test_limits_of_an_assembly_inside_are_read_from_a_file_of_its_element(tmp_path):
    """A lever below another assembly: told by the name of the file that would hold them, and read from there."""
    values = json.loads(DEFINITION.read_text("utf-8"))
    inner = values["rootAssembly"]
    own = {"id": "M1", "type": "Assembly", "name": "Lever", "suppressed": False, "elementId": "E1", "documentId": "D1",
           "documentMicroversion": "m", "configuration": "default"}  # fmt: skip
    root = {"instances": [own], "features": [], "patterns": [], "elementId": "E0", "documentId": "D1",
            "occurrences": [{"path": ["M1"], "transform": np.eye(4).ravel().tolist(), "fixed": True, "hidden": False}]}  # fmt: skip
    root["occurrences"] += [{**o, "path": ["M1", *o["path"]]} for o in inner["occurrences"]]
    sub = {**inner, "elementId": "E1", "documentId": "D1", "documentMicroversion": "m", "configuration": "default"}
    values["rootAssembly"], values["subAssemblies"] = root, [sub]
    for name in ("features.json", "matevalues.json"):
        shutil.copy(DEFINITION.parent / name, tmp_path / name)
    path = tmp_path / "definition.json"
    path.write_text(json.dumps(values), "utf-8")
    report = Report()
    ends = [freedom.upper for joint in sources.read(path, report).joints for freedom in joint.freedoms]
    assert ends and set(ends) == {np.inf}
    told = [d.message for d in report.diagnostics if d.code == "CAPTURE_NOT_SAVED"]
    assert len(told) == 1 and "E1_features.json" in told[0]
    shutil.copy(DEFINITION.parent / "features.json", tmp_path / "E1_features.json")
    report = Report()
    ends = [freedom.upper for joint in sources.read(path, report).joints for freedom in joint.freedoms]
    assert min(ends) < np.inf and "CAPTURE_NOT_SAVED" not in {d.code for d in report.diagnostics}


def test_up_is_asked_for():
    turned = sources.read(DEFINITION, Report(), options={"up": "Y"})
    slider = next(node for node in turned.nodes if node.name == "SliderD:1")
    np.testing.assert_allclose(slider.pose.translation, [0.110778352444, 0.0, 0.008], atol=1e-12)


def test_a_mesh_that_is_none_is_told(tmp_path):
    path = copied(tmp_path)
    (tmp_path / "EShaft.ipt_JHD.stl").write_bytes(b"solid nothing")
    report = Report()
    assert len(sources.read(path, report).joints) == 6
    assert [d.code for d in report.diagnostics] == ["CAPTURE_MEMBER_FAILED"]


def test_a_pose_that_is_none_loses_its_part_alone(tmp_path):
    """A transform of zeros: the part and what hangs on it are told, the rest is read."""
    path = copied(tmp_path)
    values = json.loads(path.read_text("utf-8"))
    values["rootAssembly"]["occurrences"][-1]["transform"] = [0.0] * 16
    path.write_text(json.dumps(values), "utf-8")
    report = Report()
    assert len(sources.read(path, report).joints) == 4
    assert [d.code for d in report.diagnostics] == ["CAPTURE_MEMBER_FAILED"] * 3


def test_a_damaged_file_ends_in_findings(tmp_path):
    path, chance = copied(tmp_path), random.Random(8)
    given = {
        word: (tmp_path / f"{word}.json").read_bytes() for word in ("definition", "features", "matevalues")
    }
    for _ in range(MUTATIONS):
        word = chance.choice(list(given))
        (tmp_path / f"{word}.json").write_bytes(damaged(given[word], chance))
        try:
            sources.read(path, Report())
        except KinefabError as error:
            assert error.diagnostics
        (tmp_path / f"{word}.json").write_bytes(given[word])


def test_values_may_be_something_else(tmp_path):
    """Values replaced by another type: read, or refused in words."""
    path, chance = copied(tmp_path), random.Random(9)
    given = json.loads(DEFINITION.read_text("utf-8"))
    for place in [place for place in value_paths(given) if chance.random() < 0.5]:
        values = copy.deepcopy(given)
        holder = values
        for key in place[:-1]:
            holder = holder[key]
        holder[place[-1]] = chance.choice([None, [], {}, "x", -1, 1e300, True, [1, 2, 3]])
        path.write_text(json.dumps(values), "utf-8")
        try:
            sources.read(path, Report())
        except KinefabError as error:
            assert error.diagnostics
