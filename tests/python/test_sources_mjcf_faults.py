"""What is wrong with an MJCF file is found with its code and its place; what is missing is told, and the rest converts."""

from __future__ import annotations

import importlib.util
import math
import random
from pathlib import Path

import kinefab
import pytest
from kinefab.diagnostics import KinefabError, Report, Severity
from kinefab.sources import read

INSTALLED = importlib.util.find_spec("mujoco") is not None
needs_mujoco = pytest.mark.skipif(not INSTALLED, reason="mujoco (pip install mujoco) is not installed")
FIXTURES = Path(__file__).parents[2] / "fixtures"

BODY = "<body name='a'><joint name='j'/><geom size='.1'/></body>"


def world(inner: str, rest: str = "") -> str:
    return f"<mujoco>\n<worldbody>\n{inner}\n</worldbody>\n{rest}</mujoco>"


BOMB = "<!DOCTYPE m [<!ENTITY a 'xxxxxxxx'><!ENTITY b '&a;&a;&a;&a;'>]>\n" + world("<body name='&b;'/>")
OUTSIDE = "<!DOCTYPE m [<!ENTITY x SYSTEM 'file:///etc/passwd'>]>\n" + world("<body name='&x;'/>")

REFUSED = {
    "cut off": ("XML_SYNTAX", 4, world(BODY)[:-10]),
    "bomb": ("XML_ENTITY", 1, BOMB),
    "external entity": ("XML_ENTITY", 1, OUTSIDE),
    "deep": ("XML_TOO_LARGE", 1, "<mujoco >" + "<body>" * 200 + "</body>" * 200 + "</mujoco>"),
    "a weight beyond all": ("MJCF_REFUSED", None, world(BODY.replace("size", "mass='1e308' size"))),
    "unknown element": ("MJCF_REFUSED", 3, world("<bodi/>")),
    "unknown default": ("MJCF_REFUSED", 3, world("<body><geom size='.1' class='x'/></body>")),
    "negative mass": ("MJCF_REFUSED", 3, world(BODY.replace("size", "mass='-1' size"))),
    "no mass": ("MJCF_REFUSED", 3, world("<body name='a'><joint/></body>")),
    "twice": ("MJCF_REFUSED", 4, world(BODY + "\n" + BODY)),
    "no such joint": ("MJCF_REFUSED", 6, world(BODY, "<actuator>\n<motor joint='k'/></actuator>")),
    "nan": ("MJCF_REFUSED", None, world(BODY.replace("<joint", "<joint pos='0 nan 0'"))),
    "infinite": ("MJCF_REFUSED", None, world(BODY.replace("<joint", "<joint pos='0 inf 0'"))),
    "include missing": ("MJCF_INCLUDE", 6, world(BODY, "\n<include file='b.xml'/>")),
    "include outside": ("MJCF_INCLUDE", 5, world(BODY, "<include file='../../../../../../etc/passwd'/>")),
    "include absolute": ("MJCF_INCLUDE", 5, world(BODY, "<include file='/etc/passwd'/>")),
    "include itself": ("MJCF_INCLUDE", 5, world(BODY, "<include file='m.xml'/>")),
    "copies": ("MJCF_TOO_LARGE", 3, world("<replicate count='1000000000'>" + BODY + "</replicate>")),
    "pixels": (
        "MJCF_TOO_LARGE",
        5,
        world(BODY, "<asset><texture type='2d' builtin='flat' width='100000' height='100000'/></asset>"),
    ),
}


@needs_mujoco
@pytest.mark.parametrize("name", REFUSED)
def test_what_is_wrong_is_found_at_its_line(tmp_path, name):
    code, line, text = REFUSED[name]
    path = tmp_path / "m.xml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(KinefabError) as refused:
        kinefab.export(path, tmp_path / "m.kinefab")
    found = [(d.code, d.where) for d in refused.value.diagnostics]
    assert any(c == code and (line is None or where.endswith(f":{line}")) for c, where in found), found
    assert list(tmp_path.iterdir()) == [path]


def test_another_root_is_not_taken_for_mjcf(tmp_path):
    path = tmp_path / "m.xml"
    path.write_text("<mujocoinclude/>", encoding="utf-8")
    with pytest.raises(KinefabError) as refused:
        read(path, Report())
    assert [d.code for d in refused.value.diagnostics] == ["SOURCE_FORMAT_UNKNOWN"]


@needs_mujoco
def test_includes_of_each_other_end(tmp_path):
    (tmp_path / "m.xml").write_text(world("<include file='b.xml'/>"), encoding="utf-8")
    (tmp_path / "b.xml").write_text(
        "<mujocoinclude>\n<include file='b.xml'/></mujocoinclude>", encoding="utf-8"
    )
    with pytest.raises(KinefabError) as refused:
        read(tmp_path / "m.xml", Report())
    assert [(d.code, d.where) for d in refused.value.diagnostics] == [("MJCF_INCLUDE", "b.xml:2")]


@needs_mujoco
def test_without_its_mesh_the_rest_converts(tmp_path):
    """A file that is not there, one out of the folder, a picture: left out by name; a body of nothing else has a stand-in."""
    text = world(
        BODY
        + "<body name='b'><joint name='k'/><geom type='mesh' mesh='m'/><geom type='mesh' mesh='n'/></body>"
        "<geom type='plane' size='1 1 1' material='p'/>",
        "<asset><mesh name='m' file='m.stl'/><mesh name='n' file='../../../../../etc/n.stl'/>"
        "<texture name='t' type='2d' file='t.png'/><material name='p' texture='t'/></asset>",
    )
    path = tmp_path / "m.xml"
    path.write_text(text, encoding="utf-8")
    result = kinefab.export(path, tmp_path / "m.kinefab")
    lost = {(o.feature, o.code) for o in result.report.outcomes if o.outcome.value == "dropped"}
    assert {
        ("mesh m", "MESH_NOT_FOUND"),
        ("mesh n", "MESH_OUTSIDE"),
        ("texture t", "TEXTURE_NOT_FOUND"),
    } <= lost
    assert {j.id for j in read(path, Report()).joints} == {"j", "k"}


@needs_mujoco
def test_a_missing_mesh_weighs_nothing_beside_shapes_that_weigh(tmp_path):
    """What it would have weighed is not known, and the body is told as approximated."""
    path = tmp_path / "m.xml"
    geoms = "<geom size='.1' density='500'/><geom type='mesh' mesh='bone'/>"
    body = (
        f"<body name='a'><joint/>{geoms}</body><body name='b'><joint/><geom type='mesh' mesh='bone'/></body>"
        "<body><joint/><geom type='mesh' mesh='bone'/></body>"
    )
    path.write_text(
        world(body, "<asset><mesh name='bone' file='bone.stl'/></asset>"),
        encoding="utf-8",
    )
    scene = read(path, report := Report())
    masses = {node.name: node.mass for node in scene.nodes}
    assert masses["a"].mass == pytest.approx(500.0 * 4.0 / 3.0 * math.pi * 0.1**3)
    assert masses["b"].mass > 0.0
    told = [(o.feature, o.outcome.value) for o in report.outcomes if o.code == "MASS_WITHOUT_MESH"]
    assert told == [(f"mass {name}", "approximated") for name in ("a", "b", "body")]
    assert {"a", "b", "body"} <= set(masses)


@needs_mujoco
def test_an_unknown_keyframe_names_the_known(tmp_path):
    path = tmp_path / "m.xml"
    path.write_text(world(BODY, "<keyframe><key name='home' qpos='1'/></keyframe>"), encoding="utf-8")
    with pytest.raises(KinefabError) as refused:
        read(path, Report(), options={"keyframe": "hom"})
    (found,) = refused.value.diagnostics
    assert found.code == "MJCF_KEYFRAME" and "home" in found.message


def test_without_mujoco_it_is_said_which_extra_brings_it(tmp_path, monkeypatch):
    """A diagnostic, not an import error."""
    from kinefab import sources

    monkeypatch.setattr(sources, "find_spec", lambda name: None)
    path = tmp_path / "m.xml"
    path.write_text(world(BODY), encoding="utf-8")
    with pytest.raises(KinefabError) as refused:
        read(path, Report())
    (found,) = refused.value.diagnostics
    assert found.code == "SOURCE_LIBRARY_MISSING" and "mujoco" in found.message + found.remedy


WORDS = [
    b"nan",
    b"-1",
    b"1e308",
    b"0",
    b"inf",
    b"''",
    b"<body>",
    b"/>",
    b"&#0;",
    b"joint",
    b"99999999",
    b"-",
    b"1e-320",
]


@needs_mujoco
def test_mutated_files_give_a_scene_or_findings(tmp_path, capfd, fuzz_count):
    """Nothing else: no traceback, no half-written file.  ``--fuzz N`` tries N of them."""
    generator = random.Random(14)
    seeds = [path.read_bytes() for path in sorted((FIXTURES / "mjcf").glob("*.xml"))]
    path, target = tmp_path / "m.xml", tmp_path / "out" / "m.kinefab"
    target.parent.mkdir()
    refused = 0
    for _ in range(fuzz_count):
        data = bytearray(generator.choice(seeds))
        for _ in range(generator.randint(1, 4)):
            at, kind = generator.randrange(len(data)), generator.random()
            if kind < 0.4:
                data[at : at + generator.randint(0, 12)] = generator.choice(WORDS)
            elif kind < 0.7:
                data[at] = generator.choice(b'0123456789.- "<>=/ex')
            else:
                del data[at : at + generator.randint(1, 30)]
        path.write_bytes(bytes(data))
        try:
            kinefab.export(path, target)
            for written in target.parent.iterdir():
                written.unlink()
        except KinefabError as error:
            refused += 1
            assert error.diagnostics
            assert list(target.parent.iterdir()) == []
    assert refused > 20


@needs_mujoco
def test_a_long_licence_hides_no_model(tmp_path):
    path = tmp_path / "m.xml"
    path.write_text("<!-- " + "all rights " * 900 + "-->\n" + world(BODY), encoding="utf-8")
    assert [joint.id for joint in read(path, Report()).joints] == ["j"]


@needs_mujoco
@pytest.mark.parametrize("encoding", ["iso-8859-1", "utf-16"])
def test_other_encodings_than_mujocos_are_refused_at_their_line(tmp_path, encoding):
    """MuJoCo takes every file for UTF-8; what stands in a comment is no matter."""
    path = tmp_path / "m.xml"
    text = f"<?xml version='1.0' encoding='{encoding}'?>\n<!-- \u00e4\n-->" + world(BODY)
    named = text.replace("name='a'", "name='\u00e4'", 1)
    assert named != text
    path.write_bytes(named.encode(encoding))
    with pytest.raises(KinefabError) as raised:
        read(path, Report())
    (found,) = raised.value.diagnostics
    line = 1 if encoding == "utf-16" else 3 + named.partition("-->")[2].partition("\u00e4")[0].count("\n")
    assert (found.code, found.where) == ("MJCF_REFUSED", f"m.xml:{line}") and "UTF-8" in found.message
    if encoding != "utf-16":
        path.write_bytes(text.encode(encoding))
        assert read(path, Report()).nodes


@needs_mujoco
@pytest.mark.parametrize("head, file", [("", "{far}/box.obj"), ("<compiler meshdir='{far}'/>", "box.obj")])
def test_meshes_of_soft_bodies_lie_where_meshes_may(tmp_path, head, file):
    """MuJoCo opens them while it parses, wherever they are."""
    far, near = tmp_path / "far", tmp_path / "one" / "two" / "near"
    near.mkdir(parents=True)
    far.mkdir()
    for folder in (far, near):
        (folder / "box.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n", encoding="utf-8")
    soft = "<body name='a'>\n<flexcomp name='x' type='mesh' file='{}' dim='2' mass='1'/></body>"
    path = near / "m.xml"
    text = world(soft.format(file)).replace("<worldbody>", head + "<worldbody>")
    path.write_text(text.replace("{far}", str(far)), encoding="utf-8")
    with pytest.raises(KinefabError) as refused:
        read(path, Report())
    (found,) = refused.value.diagnostics
    assert found.code == "MJCF_INCLUDE" and "leads out" in found.message
    read(path, report := Report(), options={"package_path": [far]})
    assert "MJCF_LEFT_OUT" in {d.code for d in report.diagnostics}


@needs_mujoco
def test_no_file_of_a_skin_is_opened(tmp_path):
    tail = "<deformable><skin name='coat' file='/nowhere/coat.skn'/></deformable>"
    path = tmp_path / "m.xml"
    path.write_text(world(BODY, tail), encoding="utf-8")
    report = Report()
    assert len(read(path, report).nodes) > 1
    assert [o.feature for o in report.outcomes if o.code == "MJCF_LEFT_OUT"] == ["skin coat"]


@needs_mujoco
def test_a_model_of_nothing_is_told(tmp_path):
    path = tmp_path / "m.xml"
    path.write_text("<mujoco/>", encoding="utf-8")
    report = Report()
    read(path, report)
    assert [(d.code, d.where) for d in report.diagnostics] == [("SCENE_WITHOUT_PARTS", "m.xml:1")]


@needs_mujoco
def test_a_sensor_that_asks_for_contacts_has_them(tmp_path):
    """Meshes are compiled without their hulls, as nothing touched them; MuJoCo refused sensors of touch then."""
    head = "<asset><mesh name='box' builtin='plate' params='3 4' scale='.3 .5 .2'/></asset>"
    body = (
        "<body name='f' pos='0 0 1'><freejoint/><geom name='g' type='box' size='.3 .5 .2' contype='3' conaffinity='5'/>"
        "<geom name='skin' type='mesh' mesh='box' mass='0' contype='0' conaffinity='0'/></body>"
    )
    path = tmp_path / "m.xml"
    text = world(body, "<sensor><tactile geom='skin' mesh='box'/></sensor>")
    path.write_text(text.replace("<worldbody>", head + "<worldbody>"), encoding="utf-8")
    scene = read(path, report := Report())
    (node,) = [node for node in scene.nodes if node.name == "f"]
    assert [collider.name for collider in node.colliders] == ["g"]
    assert not report.of(Severity.ERROR)


@needs_mujoco
def test_a_second_model_in_a_file_is_told(tmp_path):
    path = tmp_path / "m.xml"
    path.write_text(world(BODY) + "\n<mujoco model='other'/>", encoding="utf-8")
    read(path, report := Report())
    assert "XML_AFTER_ROOT" in {d.code for d in report.diagnostics}
