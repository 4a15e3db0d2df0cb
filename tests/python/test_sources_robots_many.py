"""Robots of thousands of alike things, and chains of thousands, are read or refused soon, and by no traceback."""

from __future__ import annotations

import math
import time
from pathlib import Path

import kinefab
import numpy as np
import pytest
from kinefab.diagnostics import MOST_ALIKE, KinefabError, Report
from kinefab.sources import read
from kinefab.sources.robots.rigid_links import unique

SOON = 15.0
"""Seconds of processor; what these need is a tenth of it, and what they needed once is more."""


def written(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def urdf(*elements: str) -> str:
    return "<robot name='r'>" + "\n".join(elements) + "</robot>"


def sdf(*elements: str) -> str:
    return "<sdf version='1.9'><model name='m'>" + "\n".join(elements) + "</model></sdf>"


def links(count: int) -> list[str]:
    mass = "<inertial><mass value='2'/><inertia ixx='.1' iyy='.2' izz='.25'/></inertial>"
    return [f"<link name='l{i}'>{mass}</link>" for i in range(count)]


def joint(i: int, parent: str, child: str, inner: str = "", kind: str = "continuous") -> str:
    return f"<joint name='j{i}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>{inner}</joint>"


@pytest.mark.parametrize("name", ["r.urdf", "m.sdf"])
def test_thousands_of_unknown_links_are_refused_soon(tmp_path, name):
    """Near matches are named for the findings that are listed."""
    count = 3000
    if name == "r.urdf":
        text = urdf(*links(count), *(joint(i, f"l{i}", f"lx{i}", kind="fixed") for i in range(count)))
    else:
        ends = "<joint name='j{0}' type='fixed'><parent>l{0}</parent><child>lx{0}</child></joint>"
        text = sdf(*(f"<link name='l{i}'/>" for i in range(count)), *(ends.format(i) for i in range(count)))
    path, start = written(tmp_path, name, text), time.process_time()
    with pytest.raises(KinefabError) as refused:
        read(path, Report())
    assert time.process_time() - start < SOON
    messages = [d.message for d in refused.value.diagnostics]
    assert len(messages) == count and {d.code for d in refused.value.diagnostics} == {"LINK_UNKNOWN"}
    assert "Near matches: l0" in messages[0] and "l99" in messages[MOST_ALIKE - 1]
    assert "not sought" in messages[-1]


def test_mimics_that_follow_each_other_by_thousands_are_read_soon(tmp_path):
    """q = 1.5 q' + 0.002 of each, where the last one stands at 0.1: what the one before the last is at tells the rest."""
    count = 2000
    limit = "<limit lower='0.1' upper='0.9' effort='1' velocity='1'/>"
    follow = "<mimic joint='j{}' multiplier='-1' offset='0.3'/>"
    joints = [joint(i, "l0", f"l{i + 1}", follow.format(i + 1)) for i in range(count - 1)]
    last = joint(count - 1, "l0", f"l{count}", "<axis xyz='0 0 1'/>" + limit, "revolute")
    path, start = written(tmp_path, "r.urdf", urdf(*links(count + 1), *joints, last)), time.process_time()
    scene = read(path, Report())
    assert time.process_time() - start < SOON
    assert len(scene.couplings) == count - 1
    turn = {node.name: node.pose.rotation for node in scene.nodes}
    for i, angle in ((count, 0.1), (count - 1, 0.2), (count - 2, 0.1), (1, 0.2)):
        assert math.isclose(np.trace(turn[f"l{i}"]), 1.0 + 2.0 * math.cos(angle), rel_tol=1e-9)


@pytest.mark.parametrize("word", ["relative_to", "attached_to"])
def test_frames_that_count_from_each_other_by_thousands_are_read(tmp_path, word):
    """Each a millimetre from the next one, the link the first of them: longer than Python's stack is deep."""
    count = 3000

    def frame(i: int) -> str:
        if word == "relative_to":
            return f"<frame name='f{i}'><pose relative_to='f{i + 1}'>0.001 0 0 0 0 0</pose></frame>"
        return f"<frame name='f{i}' attached_to='f{i + 1}'><pose>0.001 0 0 0 0 0</pose></frame>"

    ends = "<link name='base'/>" if word == "relative_to" else ""
    far = f"<frame name='f{count}'/>" if word == "relative_to" else f"<link name='f{count}'/>"
    body = "<link name='a'><pose relative_to='f0'/></link>"
    text = sdf(ends, *(frame(i) for i in range(count)), far, body)
    scene = read(written(tmp_path, "m.sdf", text), Report())
    (node,) = (node for node in scene.nodes if node.name == "a")
    assert node.pose.translation == pytest.approx([0.0, 0.0, 3.0])  # +X of SDF looks along the scene's +Z


def test_frames_in_a_long_circle_are_a_finding(tmp_path):
    count = 3000
    frames = (
        f"<frame name='f{i}'><pose relative_to='f{(i + 1) % count}'>1 0 0 0 0 0</pose></frame>"
        for i in range(count)
    )
    text = sdf("<link name='a'><pose relative_to='f7'/></link>", *frames)
    with pytest.raises(KinefabError) as refused:
        kinefab.export(written(tmp_path, "m.sdf", text), tmp_path / "m.kinefab")
    assert [d.code for d in refused.value.diagnostics] == ["FRAME_CYCLE"]


def test_thousands_of_geoms_of_one_body_are_read_soon(tmp_path):
    pytest.importorskip("mujoco", reason="mujoco (pip install mujoco) is not installed")
    body = "<body name='a'>" + "<geom size='.1'/>" * 10_000 + "</body>"
    text = f"<mujoco><worldbody>{body}</worldbody></mujoco>"
    path, start = written(tmp_path, "m.xml", text), time.process_time()
    scene = read(path, Report())
    assert time.process_time() - start < 0.5 * SOON
    (names,) = ([c.name for c in node.colliders] for node in scene.nodes if node.name == "a")
    assert len(set(names)) == 10_000 and names[:2] + names[-1:] == ["sphere", "sphere_2", "sphere_10000"]


def test_thousands_of_missing_meshes_are_told_soon(tmp_path):
    """Each stands for a ball that weighs nothing, and MuJoCo's own delete would walk through the whole model for each."""
    pytest.importorskip("mujoco", reason="mujoco (pip install mujoco) is not installed")
    count = 1200
    assets = "".join(f"<mesh name='m{i}' file='m{i}.stl'/>" for i in range(count))
    shapes = "<geom size='.1' mass='3'/><geom type='mesh' mesh='m{0}'/>"
    bodies = "".join(f"<body name='b{i}'><joint/>{shapes.format(i)}</body>" for i in range(count))
    text = f"<mujoco><asset>{assets}</asset><worldbody>{bodies}</worldbody></mujoco>"
    path, start = written(tmp_path, "m.xml", text), time.process_time()
    scene = read(path, report := Report())
    assert time.process_time() - start < 0.5 * SOON
    assert sum(d.code == "MESH_NOT_FOUND" for d in report.diagnostics) == count
    assert [mesh.name for mesh in scene.meshes] == ["sphere"]
    masses = [node.mass.mass for node in scene.nodes if node.mass is not None]
    assert len(masses) == count and masses == pytest.approx([3.0] * count)


def test_each_of_many_held_joints_is_held_at_its_own_value(tmp_path):
    """Joints that equalities hold are found by their names, not by a walk through all of them for each."""
    mujoco = pytest.importorskip("mujoco", reason="mujoco (pip install mujoco) is not installed")
    count = 400
    bodies = "".join(f"<body name='b{i}'><joint name='j{i}'/><geom size='.1'/></body>" for i in range(count))
    held = "".join(f"<joint joint1='j{i}' polycoef='.{i + 1:03} 0 0 0 0'/>" for i in range(count))
    text = f"<mujoco><worldbody>{bodies}</worldbody><equality>{held}</equality></mujoco>"
    assert mujoco.MjModel.from_xml_string(text).neq == count
    scene = read(written(tmp_path, "m.xml", text), Report())
    ranges = [(f.lower, f.upper) for joint in scene.joints for f in joint.freedoms if f.lower > -math.inf]
    assert ranges == [(pytest.approx((i + 1) / 1000),) * 2 for i in range(count)]


class Counted(dict[str, int]):
    asked = 0

    def __contains__(self, key: object) -> bool:
        self.asked += 1
        return super().__contains__(key)


def test_the_next_of_many_names_is_found_in_a_few_steps():
    names = Counted()
    for _ in range(5000):
        names[unique(names, "visual")] = 0
    expected = ["visual", *(f"visual_{i}" for i in range(2, 5001))]
    assert list(names) == expected and names.asked < 5000 * 40
