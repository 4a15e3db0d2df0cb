"""What no reader of a URDF or SDF file reads is told by name and place, and a flood of it is counted."""

from __future__ import annotations

from pathlib import Path

import pytest
from kinefab.diagnostics import Report, Severity
from kinefab.sources import read
from kinefab.sources.robots.unread import MOST_TOLD

SPHERE = "<geometry><sphere radius='1'/></geometry>"
SDF_SPHERE = "<geometry><sphere><radius>1</radius></sphere></geometry>"


def urdf(inner: str) -> str:
    return f"<robot name='r'>\n{inner}\n</robot>"


def in_link(inner: str) -> str:
    return urdf(f"<link name='a'>\n{inner}</link>")


def jointed(inner: str) -> str:
    mass = "<inertial><mass value='2'/><inertia ixx='.1' iyy='.2' izz='.25'/></inertial>"
    links = f"<link name='a'>{mass}</link><link name='b'>{mass}</link>"
    joint = "<joint name='j' type='continuous'><parent link='a'/><child link='b'/>"
    return urdf(f"{links}{joint}\n{inner}</joint>")


def sdf(inner: str, version: str = "1.9") -> str:
    return f"<sdf version='{version}'><model name='m'>\n{inner}\n</model></sdf>"


def in_sdf_link(inner: str) -> str:
    return sdf(f"<link name='a'>{inner}</link>")


def in_axis(inner: str) -> str:
    axis = f"<axis><xyz>0 0 1</xyz>{inner}</axis>"
    joint = f"<joint name='j' type='revolute'><parent>a</parent><child>b</child>{axis}</joint>"
    return sdf(f"<link name='a'/><link name='b'/>\n{joint}")


LOST = {
    "a word in a robot": ("r.urdf", urdf("<link name='a'/>\n<lnik name='b'/>"), "lnik b", "ELEMENT_UNKNOWN", 3),
    "an extension": ("r.urdf", urdf("<link name='a'/>\n<ros2_control name='c'/>"), "ros2_control c", "ELEMENT_DROPPED", 3),
    "a link's sensor": ("r.urdf", in_link("<sensor name='s'/>"), "sensor s of link a", "ELEMENT_DROPPED", 3),
    "a visual's": ("r.urdf", in_link(f"<visual name='v'>{SPHERE}<colour/></visual>"), "colour of visual v of link a", "ELEMENT_UNKNOWN", 3),
    "a collision's": ("r.urdf", in_link(f"<collision>{SPHERE}<verbose/></collision>"), "verbose of collision of link a", "ELEMENT_DROPPED", 3),
    "an inertial's": ("r.urdf", in_link("<inertial><mas value='2'/></inertial>"), "mas of inertial of link a", "ELEMENT_UNKNOWN", 3),
    "a joint's": ("r.urdf", jointed("<limits lower='-.1' upper='1.3'/>"), "limits of joint j", "ELEMENT_UNKNOWN", 3),
    "a second limit": ("r.urdf", jointed("<limit effort='7' velocity='2'/><limit effort='8' velocity='3'/>"), "limit of joint j", "ELEMENT_REPEATED", 3),
    "a second shape": (
        "r.urdf", in_link("<visual><geometry><box size='1 2 3'/>\n<sphere radius='1'/></geometry></visual>"),
        "sphere of visual a/visual", "ELEMENT_REPEATED", 4,
    ),
    "a word in a model": ("m.sdf", sdf("<link name='a'/>\n<lnik name='b'/>"), "lnik b of model m", "ELEMENT_UNKNOWN", 3),
    "a plugin": ("m.sdf", sdf("<link name='a'/>\n<plugin name='p'/>"), "plugin p of model m", "ELEMENT_DROPPED", 3),
    "a word in a link": ("m.sdf", in_sdf_link("<inertal/>"), "inertal of link m/a", "ELEMENT_UNKNOWN", 2),
    "Bullet's contact": ("m.sdf", in_sdf_link("<contact><lateral_friction>.8</lateral_friction></contact>"), "contact of link m/a", "ELEMENT_DROPPED", 2),
    "a sensor of a link": ("m.sdf", in_sdf_link("<sensor name='s'/>"), "sensor s of link m/a", "ELEMENT_DROPPED", 2),
    "a visual's shadows": ("m.sdf", in_sdf_link(f"<visual name='v'>{SDF_SPHERE}<cast_shadows>0</cast_shadows></visual>"), "cast_shadows of visual v of link m/a", "ELEMENT_DROPPED", 2),
    "a material's": (
        "m.sdf", in_sdf_link(f"<visual name='v'>{SDF_SPHERE}<material><ambient>1 0 0</ambient></material></visual>"),
        "ambient of material of visual v of link m/a", "ELEMENT_DROPPED", 2,
    ),
    "a contact's": (
        "m.sdf", in_sdf_link(f"<collision name='c'>{SDF_SPHERE}<surface><contact/></surface></collision>"),
        "contact of surface of collision c of link m/a", "ELEMENT_DROPPED", 2,
    ),
    "an axis's": ("m.sdf", in_axis("<limits><lower>-.1</lower></limits>"), "limits of axis of joint m/j", "ELEMENT_UNKNOWN", 3),
    "a second axis": ("m.sdf", in_axis("</axis><axis>"), "axis of joint m/j", "ELEMENT_REPEATED", 3),
    "the world's physics": (
        "m.sdf", "<sdf version='1.9'><world name='w'>\n<physics type='ode'/><model name='m'><link name='a'/></model></world></sdf>",
        "physics of world w", "ELEMENT_DROPPED", 2,
    ),
    "a model beside a world": (
        "m.sdf", "<sdf version='1.9'><world name='w'><model name='m'><link name='a'/></model></world>\n<model name='n'/></sdf>",
        "model n", "ELEMENT_DROPPED", 2,
    ),
}  # fmt: skip


def written(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("case", LOST)
def test_what_is_not_read_is_told_by_name_and_place(tmp_path, case):
    name, text, feature, code, line = LOST[case]
    report = Report()
    read(written(tmp_path, name, text), report)
    told = [(o.feature, o.outcome.value, o.where) for o in report.outcomes if o.code == code]
    assert told == [(feature, "dropped", f"{name}:{line}")]


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("r.urdf", jointed("<origin/><axis xyz='0 1 0'/><dynamics/><safety_controller/><calibration/>")),
        ("r.urdf", in_link(f"<visual>{SPHERE}<material name='m'><color rgba='1 0 0 1'/></material></visual>" * 2)),
        ("m.sdf", in_axis("<limit><lower>-.1</lower><upper>1.3</upper></limit><dynamics><damping>2</damping></dynamics>")),
        ("m.sdf", in_sdf_link(f"<visual name='v'>{SDF_SPHERE}<material><diffuse>1 0 0</diffuse></material></visual>" * 2)),
    ],
)  # fmt: skip
def test_of_what_is_read_nothing_is_told(tmp_path, name, text):
    report = Report()
    read(written(tmp_path, name, text), report)
    assert [o for o in report.outcomes if o.code.startswith("ELEMENT")] == []


FLOODS = {
    "robot": ("r.urdf", lambda more: urdf(f"<link name='a'/>{more}")),
    "link": ("r.urdf", in_link),
    "model": ("m.sdf", lambda more: sdf(f"<link name='a'/>{more}")),
    "link of a model": ("m.sdf", in_sdf_link),
    "beside the model": ("m.sdf", lambda more: f"<sdf version='1.9'><model name='m'><link name='a'/></model>{more}</sdf>"),
}  # fmt: skip


@pytest.mark.parametrize("case", FLOODS)
def test_of_a_flood_the_first_are_told_and_the_rest_is_counted(tmp_path, case):
    """20,000 and 7 of another name, which come last."""
    name, around = FLOODS[case]
    report = Report()
    read(written(tmp_path, name, around("<foo/>" * 20_000 + "\n" + "<bar/>" * 7)), report)
    codes = [o.code for o in report.outcomes]
    assert codes.count("ELEMENT_UNKNOWN") == MOST_TOLD and codes[MOST_TOLD:] == ["ELEMENTS_OMITTED"]
    rest, found = report.outcomes[-1], report.diagnostics[-1]
    assert f"{20_007 - MOST_TOLD} more elements" in rest.feature
    assert f"foo ({20_000 - MOST_TOLD}), bar (7)" in found.message
    assert found.severity is Severity.WARNING and found.where.startswith(name)


def test_outer_elements_are_told_before_the_many_inside(tmp_path):
    """A plugin after two thousand details of links is still told by name."""
    details = "".join(
        f"<link name='l{i}'><sensor name='s'/><light name='n'/></link>" for i in range(MOST_TOLD)
    )
    report = Report()
    read(written(tmp_path, "m.sdf", sdf(details + "<plugin name='late'/>")), report)
    assert "plugin late of model m" in [o.feature for o in report.outcomes]
    assert report.outcomes[-1].code == "ELEMENTS_OMITTED"
