"""What is wrong with a URDF file is found with its code and its line; what cannot be kept is told by name."""

from __future__ import annotations

import importlib.util
import math
import random
import time
from pathlib import Path

import kinefab
import numpy as np
import pytest
from kinefab.diagnostics import KinefabError, Report, Severity
from kinefab.model import RX, Motion
from kinefab.sources import read

HEAVY = "<inertial><mass value='2'/><inertia ixx='0.1' iyy='0.2' izz='0.25'/></inertial>"
LINK = "<link name='{}'>" + HEAVY + "</link>"
A, B, C = (LINK.format(name) for name in "abc")
PAIR = A + "\n" + B + "\n"


def joint(inner="", kind="continuous", name="j", parent="a", child="b") -> str:
    return f"<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>{inner}</joint>\n"


def robot(inner: str) -> str:
    return f"<robot name='r'>\n{inner}\n</robot>"


BOMB = "<!DOCTYPE r [<!ENTITY a 'xxxxxxxx'><!ENTITY b '&a;&a;&a;&a;'>]>\n" + robot("<link name='&b;'/>")
OUTSIDE = "<!DOCTYPE r [<!ENTITY x SYSTEM 'file:///etc/passwd'>]>\n" + robot("<link name='&x;'/>")

REFUSED = {
    "cut off": ("XML_SYNTAX", 3, robot(PAIR)[:-20]),
    "no XML": ("XML_SYNTAX", 1, "solid cube"),
    "encoding": ("XML_SYNTAX", 1, "<?xml version='1.0' encoding='nonsense'?><robot/>"),
    "bomb": ("XML_ENTITY", 1, BOMB),
    "external entity": ("XML_ENTITY", 1, OUTSIDE),
    "deep": ("XML_TOO_LARGE", 1, "<robot>" + "<link>" * 200 + "</link>" * 200 + "</robot>"),
    "other root": ("XML_ROOT", 1, "<sdf version='1.9'/>"),
    "no links": ("LINKS_NONE", 1, "<robot name='r'/>"),
    "nameless link": ("XML_MISSING", 2, robot("<link/>" + A)),
    "link twice": ("SOURCE_ID_DUPLICATE", 3, robot(A + "\n" + A)),
    "joint twice": ("SOURCE_ID_DUPLICATE", 5, robot(PAIR + joint() + joint())),
    "unknown type": ("JOINT_TYPE_UNKNOWN", 4, robot(PAIR + joint(kind="revolut"))),
    "no type": ("XML_MISSING", 4, robot(PAIR + joint(kind=""))),
    "unknown link": ("LINK_UNKNOWN", 4, robot(PAIR + joint(child="bb"))),
    "no child": ("XML_MISSING", 3, robot(A + "\n<joint name='j' type='fixed'><parent link='a'/></joint>")),
    "itself": ("SAME_COMPONENT", 4, robot(PAIR + joint(child="a"))),
    "two roots": ("LINK_ROOTS", 3, robot(PAIR)),
    "two parents": ("LINK_PARENTS", 6, robot(PAIR + C + "\n" + joint(child="c") + joint(name="k", parent="b", child="c"))),
    "cycle": ("LINK_CYCLE", 6, robot(PAIR + C + "\n" + joint(parent="b", child="c") + joint(name="k", parent="c", child="b"))),
    "only a cycle": ("LINK_CYCLE", 5, robot(PAIR + joint() + joint(name="k", parent="b", child="a"))),
    "nan": ("XML_VALUE", 4, robot(PAIR + joint("<origin xyz='0 nan 0'/>"))),
    "infinite": ("XML_VALUE", 4, robot(PAIR + joint("<origin xyz='0 inf 0'/>"))),
    "two numbers": ("XML_VALUE", 4, robot(PAIR + joint("<axis xyz='0 1'/>"))),
    "a word": ("XML_VALUE", 4, robot(PAIR + joint("<axis xyz='0 0 up'/>"))),
    "follows itself": ("MIMIC_UNKNOWN", 4, robot(PAIR + joint("<mimic joint='j'/>"))),
    "follow each other": (
        "MIMIC_UNKNOWN",
        5,
        robot(PAIR + C + "\n" + joint("<mimic joint='k'/>") + joint("<mimic joint='j'/>", name="k", child="c")),
    ),
    "follows a floating one": (
        "MIMIC_UNKNOWN",
        6,
        robot(PAIR + C + "\n" + joint(kind="floating") + joint("<mimic joint='j'/>", name="k", child="c")),
    ),
}  # fmt: skip

SHAPE = "<link name='a'>{}</link>"
BALL = "<visual><geometry><sphere radius='1'/></geometry>{}</visual>"
TOLD = {
    "mass of words": ("VALUE_UNREADABLE", 2, robot(A.replace("'2'", "'heavy'"))),
    "negative mass": ("VALUE_UNREADABLE", 2, robot(A.replace("'2'", "'-2'"))),
    "moment of words": ("VALUE_UNREADABLE", 2, robot(A.replace("'0.25'", "'1.#QNAN'"))),
    "centre of mass of words": ("VALUE_UNREADABLE", 2, robot(A.replace("<mass", "<origin xyz='0 nan 0'/><mass"))),
    "negative damping": ("VALUE_UNREADABLE", 4, robot(PAIR + joint("<dynamics damping='-1'/>"))),
    "friction of words": ("VALUE_UNREADABLE", 4, robot(PAIR + joint("<dynamics friction='none'/>"))),
    "no axis": ("ROBOT_AXIS_ZERO", 4, robot(PAIR + joint("<axis xyz='0 0 0'/>"))),
    "a second robot": ("XML_AFTER_ROOT", 4, robot(A) + "\n<robot name='q'><link name='b'/></robot>"),
    "a colour of bytes": (
        "COLOR_CLAMPED",
        2,
        robot(SHAPE.format(BALL.format("<material name='m'><color rgba='255 128 0 255'/></material>"))),
    ),
    "limits missing": ("LIMITS_MISSING", 4, robot(PAIR + joint(kind="revolute"))),
    "world unstated": ("LINK_WORLD_UNSTATED", 3, robot(A + "\n" + joint(parent="world", child="a"))),
    "limits reversed": ("LIMITS_REVERSED_DROPPED", 4, robot(PAIR + joint("<limit lower='80' upper='-10'/>", "prismatic"))),
    "limits at zero": ("LIMITS_AT_ZERO", 4, robot(PAIR + joint("<limit effort='1' velocity='1'/>", "revolute"))),
    "inertia": ("INERTIA_MENDED", 3, robot(PAIR.replace("'0.25'", "'0.9'") + joint())),
    "no inertia": ("INERTIA_MENDED", 3, robot(A + "\n<link name='b'><inertial><mass value='1'/></inertial></link>" + joint())),
    "no mass, a shape": (
        "MASS_FROM_GEOMETRY",
        3,
        robot(A + "\n<link name='b'><visual><geometry><box size='1 2 3'/></geometry></visual></link>" + joint()),
    ),
    "no mass, no shape": ("MASS_STAND_IN", 3, robot(A + "\n<link name='b'/>" + joint())),
    "mesh missing": (
        "MESH_NOT_FOUND",
        2,
        robot(SHAPE.format("<visual><geometry><mesh filename='package://r/a.stl'/></geometry></visual>")),
    ),
    "mesh outside": (
        "MESH_OUTSIDE",
        2,
        robot(SHAPE.format("<visual><geometry><mesh filename='../../../../../../etc/a.stl'/></geometry></visual>")),
    ),
    "absolute": (
        "MESH_OUTSIDE",
        2,
        robot(SHAPE.format("<collision><geometry><mesh filename='file:///etc/passwd'/></geometry></collision>")),
    ),
    "texture missing": (
        "TEXTURE_NOT_FOUND",
        2,
        robot(
            SHAPE.format(
                "<visual><geometry><sphere radius='1'/></geometry>"
                "<material name='m'><texture filename='t.png'/></material></visual>"
            )
        ),
    ),
    "material": (
        "MATERIAL_NOT_STATED",
        2,
        robot(SHAPE.format("<visual><geometry><sphere radius='1'/></geometry><material name='m'/></visual>")),
    ),
    "colour": (
        "SHAPE_UNREADABLE",
        2,
        robot(
            SHAPE.format(
                "<visual><geometry><sphere radius='1'/></geometry>"
                "<material name='m'><color rgba='1 zero 0 1'/></material></visual>"
            )
        ),
    ),
    "mesh of no size": (
        "SHAPE_EMPTY",
        2,
        robot(SHAPE.format("<visual><geometry><mesh filename='a.stl' scale='1 0 1'/></geometry></visual>")),
    ),
    "damping of a plane": ("ELEMENT_DROPPED", 5, robot(PAIR + joint("\n<dynamics damping='0.3'/>", "planar"))),
    "force of a floating one": ("ELEMENT_DROPPED", 5, robot(PAIR + joint("\n<limit effort='7' velocity='2'/>", "floating"))),
    "empty shape": ("SHAPE_EMPTY", 2, robot(SHAPE.format("<visual><geometry><sphere radius='0'/></geometry></visual>"))),
    "no geometry": ("SHAPE_UNREADABLE", 2, robot(SHAPE.format("<visual><origin/></visual>"))),
    "no shape": ("SHAPE_UNREADABLE", 2, robot(SHAPE.format("<collision><geometry/></collision>"))),
    "nameless mesh": ("SHAPE_UNREADABLE", 2, robot(SHAPE.format("<visual><geometry><mesh/></geometry></visual>"))),
    "size of words": ("SHAPE_UNREADABLE", 2, robot(SHAPE.format("<visual><geometry><box size='1 x 1'/></geometry></visual>"))),
    "shape at nan": (
        "SHAPE_UNREADABLE",
        2,
        robot(SHAPE.format("<collision><origin xyz='0 nan 0'/><geometry><sphere radius='1'/></geometry></collision>")),
    ),
    "follows nobody": ("MIMIC_LEFT_OUT", 4, robot(PAIR + joint("<mimic joint='k'/>"))),
    "follows, fixed": ("MIMIC_LEFT_OUT", 4, robot(PAIR + joint("<mimic joint='k'/>", "fixed"))),
    "transmission": ("ELEMENT_DROPPED", 3, robot(A + "\n<transmission name='t'/>")),
    "gazebo": ("ELEMENT_DROPPED", 3, robot(A + "\n<gazebo reference='a'/>")),
    "unknown element": ("ELEMENT_UNKNOWN", 3, robot(A + "\n<lnik name='b'/>")),
}  # fmt: skip


def written(folder: Path, text: str) -> Path:
    path = folder / "r.urdf"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("case", REFUSED)
def test_a_wrong_file_is_refused_at_its_line(tmp_path, case):
    code, line, text = REFUSED[case]
    with pytest.raises(KinefabError) as refused:
        kinefab.export(written(tmp_path, text), tmp_path / "r.kinefab")
    found = {(d.code, d.where.rsplit(":", 1)[-1]) for d in refused.value.diagnostics}
    assert (code, str(line)) in found
    assert not (tmp_path / "r.kinefab").exists()


@pytest.mark.parametrize("case", TOLD)
def test_a_loss_is_told_at_its_line_and_the_rest_converts(tmp_path, case):
    code, line, text = TOLD[case]
    result = kinefab.export(written(tmp_path, text), tmp_path / "r.kinefab")
    found = {(d.code, d.where) for d in result.report.diagnostics}
    assert (code, f"r.urdf:{line}") in found
    assert result.path.exists()


@pytest.mark.parametrize("options", [{}, {"floating_base": True}])
def test_joints_on_a_world_that_is_no_link_hang_from_the_world(tmp_path, options):
    """As in a file that states the link, whatever else is to be free; told at the first of them."""
    hung = joint("<origin xyz='1 2 3' rpy='.1 .2 .3'/><axis xyz='0 3 4'/>", parent="world", child="a")
    text = robot(PAIR + hung + joint(name="k", parent="world", child="b"))
    scene = read(written(tmp_path, text), report := Report(), options=options)
    assert [d.code for d in report.diagnostics] == ["LINK_WORLD_UNSTATED"]
    stated = text.replace("</robot>", "<link name='world'/></robot>")
    same = read(written(tmp_path, stated), report := Report(), options=options)
    assert not report.diagnostics
    for one, other in zip(scene.nodes, same.nodes, strict=True):
        assert (one.id, one.parent, one.grounded) == (other.id, other.parent, other.grounded)
    ends = [(j.a, j.b, j.name) for j in scene.joints]
    assert ends == [(j.a, j.b, j.name) for j in same.joints]
    world = next(i for i, node in enumerate(scene.nodes) if node.name == "world")
    assert scene.nodes[world].grounded and all(a == world for a, _, _ in ends)


def test_a_child_called_world_that_is_no_link_is_refused(tmp_path):
    with pytest.raises(KinefabError) as refused:
        read(written(tmp_path, robot(A + joint(child="world"))), Report())
    assert [d.code for d in refused.value.diagnostics] == ["LINK_UNKNOWN"]


def test_a_range_from_its_upper_end_to_its_lower_one_leaves_the_joint_free(tmp_path):
    """Bullet takes it for no limits, Gazebo exchanges the two, others refuse it: the joint moves, and the loss is its own."""
    limit = "<limit lower='1.3962634' upper='-0.17453293' effort='7' velocity='2'/>"
    report = Report()
    scene = read(written(tmp_path, robot(PAIR + joint(limit, "revolute"))), report)
    freedom = scene.joints[0].freedoms[RX]
    assert freedom.motion is Motion.FREE and freedom.passive is not None
    assert (freedom.passive.effort, freedom.passive.speed) == (7.0, 2.0)
    (lost,) = [o for o in report.outcomes if o.code]
    assert (lost.feature, lost.outcome.value) == ("joint j", "approximated")
    assert "1.39626" in lost.message and "-0.174533" in lost.message
    with pytest.raises(KinefabError):
        kinefab.export(tmp_path / "r.urdf", tmp_path / "r.kinefab", kinefab.ExportOptions(strict=True))


def test_a_mesh_that_cannot_be_read_is_left_out_and_told(tmp_path):
    """Both where it is drawn and where it is touched; the link keeps its mass and its joint."""
    (tmp_path / "broken.stl").write_bytes(b"solid nothing of the kind")
    mesh = "<geometry><mesh filename='broken.stl'/></geometry>"
    text = robot(A.replace("</link>", f"<visual>{mesh}</visual><collision>{mesh}</collision></link>"))
    result = kinefab.export(written(tmp_path, text), tmp_path / "r.kinefab")
    lost = [o for o in result.report.outcomes if o.code == "MESH_UNREADABLE"]
    assert len(lost) == 2 and all(o.outcome.value == "dropped" for o in lost)


def test_a_shape_that_cannot_be_read_leaves_the_link_its_others(tmp_path):
    good = "<visual name='ball'><geometry><sphere radius='1'/></geometry></visual>"
    scene = read(
        written(tmp_path, robot(SHAPE.format("<visual><geometry/></visual>" + good))),
        report := Report(),
    )
    (node,) = (node for node in scene.nodes if node.name == "a")
    assert [body.name for body in node.bodies] == ["ball"]
    assert [o.outcome.value for o in report.outcomes if o.code == "SHAPE_UNREADABLE"] == ["dropped"]


@pytest.mark.parametrize(
    "encoding", ["utf8", "UTF-8", "iso-8859-1", "shift_jis", "GB2312", "euc-kr", "big5", "utf-16"]
)
def test_a_file_is_read_in_the_encoding_that_it_states(tmp_path, encoding):
    """Also by names that expat does not know, and in letters of several bytes."""
    name = {"iso-8859-1": "Gelenkträger"}.get(encoding, "手")
    text = f"<?xml version='1.0' encoding='{encoding}'?>\n<robot name='r'><link name='{name}'/></robot>"
    path = tmp_path / "r.urdf"
    path.write_bytes(text.encode(encoding))
    assert [node.name for node in read(path, Report()).nodes] == ["r", name]


def test_bytes_that_are_not_of_the_stated_encoding_are_a_finding(tmp_path):
    path = tmp_path / "r.urdf"
    path.write_bytes(
        b"<?xml version='1.0' encoding='shift_jis'?><robot name='r'><link name='\xff\xff'/></robot>"
    )
    with pytest.raises(KinefabError) as refused:
        read(path, Report())
    assert [d.code for d in refused.value.diagnostics] == ["XML_SYNTAX"]


def test_what_cannot_be_read_of_a_link_or_joint_leaves_the_others_theirs(tmp_path):
    """A mass and a damping that are none do not keep a robot from standing and moving; a joint about nothing is fixed."""
    heavy = A.replace("'2'", "'nan'") + B + C + LINK.format("d")
    turning = "<dynamics damping='-1' friction='0.5'/><limit lower='-10' upper='80' effort='1' velocity='1'/>"
    path = written(tmp_path, robot(heavy + joint(turning, "revolute", parent="b", child="a")
        + joint("<axis xyz='0 0 0'/>", name="k", parent="b", child="c")
        + joint("<axis xyz='0 0 1'/><mimic joint='k'/>", name="l", parent="c", child="d")))  # fmt: skip
    scene = read(path, report := Report())
    assert {node.name: node.mass is None for node in scene.nodes[1:]} == {"b": False, "a": False}
    assert {d.code for d in report.diagnostics} == {"VALUE_UNREADABLE", "ROBOT_AXIS_ZERO", "MASS_STAND_IN"}
    (only,) = scene.joints
    freedom = only.freedoms[RX]
    assert (freedom.lower, freedom.upper, freedom.passive.damping, freedom.passive.friction) == (
        -10,
        80,
        0,
        0.5,
    )


LOOSE = [
    "<?xml?>",
    "<?xml verison='1.0'?>",
    "\n<?xml version='1.0'?>",
    "<!-- a -- b\n<!-- c -->",
]


@pytest.mark.parametrize("before", LOOSE)
def test_what_robot_programs_pass_over_is_passed_over(tmp_path, before):
    """Declarations without a version or after blanks, and two dashes within a comment."""
    scene = read(written(tmp_path, before + robot(A)), Report())
    assert [node.name for node in scene.nodes] == ["r", "a"]


@pytest.mark.parametrize("after", ["</robot>", "\n</link>\n</robot>\n"])
def test_ends_of_elements_after_the_root_are_passed_over(tmp_path, after):
    """A line too much at the end, as robot programs and MuJoCo have it; one of Unitree's scenes was refused."""
    scene = read(written(tmp_path, robot(A) + after), Report())
    assert [node.name for node in scene.nodes] == ["r", "a"]


@pytest.mark.parametrize("after", ["</robot><robot/>", "</robot> words", "</robot", "</", "words"])
def test_what_else_stands_after_the_root_is_refused(tmp_path, after):
    with pytest.raises(KinefabError) as refused:
        read(written(tmp_path, robot(A) + after), Report())
    assert [d.code for d in refused.value.diagnostics] == ["XML_SYNTAX"]


def test_an_ampersand_that_begins_no_entity_is_one(tmp_path):
    """As TinyXML and MuJoCo read it; entities stay what they are."""
    inner = A.replace("'a'", "'a&b &lt; &#99;'") + "\n<gazebo><text>this & that</text></gazebo>"
    scene = read(written(tmp_path, robot(inner)), report := Report())
    assert [node.name for node in scene.nodes] == ["r", "a&b < c"]
    assert [(d.code, d.where) for d in report.diagnostics] == [("ELEMENT_DROPPED", "r.urdf:3")]


def test_xacro_without_its_package_is_an_error_that_names_it(tmp_path, monkeypatch):
    path = tmp_path / "r.xacro"
    path.write_text(robot(A), encoding="utf-8")
    real = importlib.util.find_spec
    monkeypatch.setattr(
        "kinefab.sources.urdf.expansion.find_spec", lambda name: None if name == "xacro" else real(name)
    )
    with pytest.raises(KinefabError) as refused:
        read(path, Report())
    (found,) = refused.value.diagnostics
    assert found.code == "SOURCE_LIBRARY_MISSING" and "xacro" in found.message and "pip install xacro" in found.remedy


def test_a_xacro_that_fails_says_why(tmp_path):
    pytest.importorskip("xacro", reason="xacro is not installed")
    path = tmp_path / "r.xacro"
    path.write_text(
        "<robot name='r' xmlns:xacro='http://ros.org/wiki/xacro'><link name='${undefined_thing}'/></robot>",
        encoding="utf-8",
    )
    with pytest.raises(KinefabError) as refused:
        read(path, Report())
    assert [d.code for d in refused.value.diagnostics] == ["XACRO_FAILED"]
    assert "undefined_thing" in refused.value.diagnostics[0].message


def test_macros_that_call_each_other_twice_and_twice_again_are_ended(tmp_path):
    """2^40 links are asked for."""
    pytest.importorskip("xacro", reason="xacro is not installed")
    path = tmp_path / "r.xacro"
    macros = "".join(
        f"<xacro:macro name='m{i}'><xacro:m{i + 1}/><xacro:m{i + 1}/></xacro:macro>" for i in range(40)
    )
    path.write_text(
        f"<robot name='r' xmlns:xacro='http://ros.org/wiki/xacro'>{macros}"
        "<xacro:macro name='m40'><link name='x'/></xacro:macro><xacro:m0/></robot>",
        encoding="utf-8",
    )
    with pytest.raises(KinefabError) as refused:
        read(path, Report())
    (found,) = refused.value.diagnostics
    assert found.code == "XACRO_FAILED" and "more than" in found.message


ENDLESS = {
    "power": "${9**9**9}",
    "sum": "${python.sum(python.range(10**12))}",
    "comprehension": "${[i for i in python.range(10**12) if i == -1]}",
    "list": "${[0] * 10**10}",
    "string": "${'a' * 10**10}",
    "width": "${'%9999999999d' % 1}",
}


@pytest.mark.parametrize("ending", [".xacro", ".urdf"])
@pytest.mark.parametrize("expression", ENDLESS.values(), ids=ENDLESS)
def test_python_in_a_xacro_that_never_ends_or_takes_all_memory_is_ended(
    tmp_path, monkeypatch, expression, ending
):
    pytest.importorskip("xacro", reason="xacro is not installed")
    monkeypatch.setattr("kinefab.sources.urdf.expansion.MOST_SECONDS", 1.5)
    path = tmp_path / f"r{ending}"
    path.write_text(
        "<robot name='r' xmlns:xacro='http://ros.org/wiki/xacro'><link name='a'/>"
        f"<xacro:if value=\"{expression}\"><link name='b'/></xacro:if></robot>",
        encoding="utf-8",
    )
    start, report = time.monotonic(), Report()
    if ending == ".urdf":  # its leftovers are told as such
        read(path, report)
        assert "ELEMENT_DROPPED" in [d.code for d in report.diagnostics]
    else:
        with pytest.raises(KinefabError) as refused:
            read(path, report)
        (found,) = refused.value.diagnostics
        assert found.code == "XACRO_FAILED"
        assert "more than" in found.message or "longer than" in found.message
    assert time.monotonic() - start < 20.0


YAML = "<xacro:property name='p' value=\"${{xacro.load_yaml('{}')}}\"/><link name='l${{p.n}}'/>"
INCLUDED = "<xacro:include filename='{}'/>"


@pytest.mark.parametrize(
    ("inner", "found"),
    [
        (YAML.format("../more.yaml"), True),
        (YAML.format("$(find near)/more.yaml"), True),
        (INCLUDED.format("$(find near)/more.xacro"), True),
        (YAML.format("../../../far/more.yaml"), False),
        (YAML.format("{far}/more.yaml"), False),
        (INCLUDED.format("../../../far/more.xacro"), False),
        (INCLUDED.format("{far}/m*.xacro"), False),
    ],
)
def test_a_xacro_reads_what_lies_in_a_package_alone(tmp_path, inner, found):
    """What it loads and includes, absolute or not; a folder that is given opens the way."""
    pytest.importorskip("xacro", reason="xacro is not installed")
    near, far = tmp_path / "ws" / "near", tmp_path / "far"
    (near / "urdf").mkdir(parents=True)
    far.mkdir()
    (near / "package.xml").write_text("<package><name>near</name></package>", encoding="utf-8")
    for folder in (near, far):
        (folder / "more.yaml").write_text("n: 7", encoding="utf-8")
        text = "<robot xmlns:xacro='http://ros.org/wiki/xacro'><link name='l7'/></robot>"
        (folder / "more.xacro").write_text(text, encoding="utf-8")
    path = near / "urdf" / "r.xacro"
    text = (
        f"<robot name='r' xmlns:xacro='http://ros.org/wiki/xacro'>{inner.replace('{far}', str(far))}</robot>"
    )
    path.write_text(text, encoding="utf-8")
    if not found:
        with pytest.raises(KinefabError) as refused:
            read(path, Report())
        (why,) = refused.value.diagnostics
        assert why.code == "XACRO_FAILED" and "leads out of the package" in why.message
        assert "--package-path" in why.remedy
    scene = read(path, Report(), options={} if found else {"package_path": [far]})
    assert [node.name for node in scene.nodes] == ["r", "l7"]


def test_an_inertia_of_which_only_rounding_is_left_is_none(tmp_path):
    """iCub's head: no moments, its mass off the origin, and a frame that weighs nothing; sums leave 1e-19 kg m^2 of it."""
    nothing = "<inertia ixx='0' ixy='0' ixz='0' iyy='0' iyz='0' izz='0'/></inertial></link>"
    head = "<link name='b'><inertial><mass value='1.33687'/><origin xyz='.0225 -.1005 .0333'/>" + nothing
    frame = "<link name='c'><inertial><mass value='0'/>" + nothing
    held = joint("<origin xyz='.0225 -.1005 .0066' rpy='1.5708 0 0'/>", "fixed", "k", "b", "c")
    path = tmp_path / "r.urdf"
    path.write_text(robot(A + head + frame + joint() + held), encoding="utf-8")
    made = kinefab.export(path, tmp_path / "s.kinefab")
    assert [d.code for d in made.report.diagnostics if "INERTIA" in d.code] == ["INERTIA_MENDED"]
    (found,) = (node.mass for node in read(path, Report()).nodes if node.name == "b")
    radius = (3.0 * 1.33687 / (4.0 * math.pi * 1000.0)) ** (1.0 / 3.0)
    assert found.inertia == pytest.approx(0.4 * 1.33687 * radius**2 * np.eye(3))


@pytest.mark.parametrize(
    "name, text",
    [
        ("r.urdf", "<robot name='r'><link name='a'/></robot>"),
        ("m.sdf", "<sdf version='1.9'><model name='m'><link name='a'/></model></sdf>"),
        ("m.xml", "<mujoco><worldbody><body name='a'><geom size='.1'/></body></worldbody></mujoco>"),
    ],
)
def test_a_package_path_that_is_no_folder_is_told(tmp_path, name, text):
    """Beside it the others are used; nothing else of the file says that the folder is missing."""
    if name == "m.xml":
        pytest.importorskip("mujoco", reason="mujoco (pip install mujoco) is not installed")
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    given = [tmp_path, tmp_path / "gone", path]
    assert read(path, report := Report(), options={"package_path": given}).nodes
    told = [d for d in report.diagnostics if d.code == "PACKAGE_PATH_NOT_FOUND"]
    assert [str(folder) in d.message for d, folder in zip(told, given[1:])] == [True, True]
    assert all(d.severity is Severity.WARNING and d.remedy for d in told)


@pytest.mark.parametrize("kind", [str, Path])
def test_one_package_path_needs_no_list(tmp_path, kind):
    """A word was taken letter by letter, and each was a folder that is missing."""
    path = tmp_path / "r.urdf"
    path.write_text("<robot name='r'><link name='a'/></robot>", encoding="utf-8")
    assert read(path, report := Report(), options={"package_path": kind(tmp_path / "gone")}).nodes
    (told,) = report.diagnostics
    assert str(tmp_path / "gone") in told.message


def mutated(text: str, chance: random.Random) -> bytes:
    """The text with a few bytes, words or lines changed, doubled, cut or exchanged."""
    data = bytearray(text.encode("utf-8"))
    for _ in range(chance.randint(1, 4)):
        at = chance.randrange(len(data))
        kind = chance.randrange(6)
        if kind == 0:
            data[at] = chance.randrange(256)
        elif kind == 1:
            del data[at : at + chance.randint(1, 40)]
        elif kind == 2:
            data[at:at] = data[at : at + chance.randint(1, 60)]
        elif kind == 3:
            data[at:at] = chance.choice(
                [b"nan", b"-", b"1e400", b"<", b"&x;", b"\0", b"\xff", b"'", b"<link/>"]
            )
        elif kind == 4:
            other = chance.randrange(len(data))
            size = chance.randint(1, 30)
            data[at : at + size] = data[other : other + size]
        else:
            lines = bytes(data).split(b"\n")
            chance.shuffle(lines) if chance.random() < 0.1 else lines.insert(
                chance.randrange(len(lines)), chance.choice(lines)
            )
            data = bytearray(b"\n".join(lines))
        if not data:
            return b""
    return bytes(data)


def test_no_mutation_of_a_file_is_a_traceback(tmp_path, fuzz_count):
    """Every one is read or refused by diagnostics; ``--fuzz N`` tries N of them."""
    arm = (Path(__file__).parents[2] / "fixtures" / "twins" / "arm.urdf").read_text(encoding="utf-8")
    chance = random.Random(14)
    path = tmp_path / "r.urdf"
    refused = 0
    for _ in range(fuzz_count):
        path.write_bytes(mutated(arm, chance))
        try:
            read(path, Report())
        except KinefabError as error:
            refused += 1
            assert error.diagnostics
    assert 0 < refused < fuzz_count


def test_a_chain_of_massless_links_does_not_get_lighter_and_lighter(tmp_path):
    """Each weighs a tenth of the nearest link that states a mass, of 1 kg where none does; not of the stand-in before it."""
    links = A + "".join(f"<link name='l{i}'/>\n" for i in range(30))
    names = ["a", *(f"l{i}" for i in range(30))]
    joints = [joint(name=f"j{i}", parent=p, child=c) for i, (p, c) in enumerate(zip(names, names[1:]))]
    scene = read(written(tmp_path, robot(links + "".join(joints))), Report())
    assert {node.mass.mass for node in scene.nodes if node.name.startswith("l")} == {0.2}
    scene = read(written(tmp_path, robot((links + "".join(joints)).replace(A, "<link name='a'/>"))), Report())
    assert {node.mass.mass for node in scene.nodes if node.name.startswith("l")} == {0.1}
