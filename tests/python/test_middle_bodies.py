"""Bodies that no source has, between two joints of one pair: they weigh a share of the body that they help, and nobody else's mass changes."""

from __future__ import annotations

import json
import random
import xml.etree.ElementTree as xml
from pathlib import Path

import kinefab
import numpy as np
import pytest
from kinefab.model import JointKind
from kinefab.sources.mjcf.stacks import Axis, steps_of

FIXTURES = Path(__file__).parents[2] / "fixtures"
ROBOTS = sorted([*FIXTURES.glob("*/*.urdf"), *FIXTURES.glob("*/*.sdf")])


def weights(path: Path) -> dict[str, float]:
    """Of all bodies that forces move, by their ids."""
    objects = json.loads(path.read_text(encoding="utf-8"))["gameObjects"]
    return {
        entry["id"]: c.get("mass", 1.0)
        for entry in objects
        for c in entry.get("components", ())
        if c["type"] == "Rigidbody" and not c.get("isKinematic", False)
    }


@pytest.mark.parametrize("source", ROBOTS, ids=lambda path: path.parent.name + "-" + path.name)
def test_a_robot_weighs_what_its_links_do(source: Path, tmp_path: Path):
    kinefab.export(source, tmp_path / "scene.kinefab")
    found = weights(tmp_path / "scene.kinefab")
    links = {
        link.attrib["name"]: float(mass.attrib.get("value") or mass.text or 0.0)
        for link in xml.parse(source).getroot().iter("link")
        if (mass := link.find("inertial/mass")) is not None
    }
    moving = {id.split("/")[-1] for id in found}
    assert sum(found.values()) == pytest.approx(sum(m for name, m in links.items() if name in moving))


JOINTS = {
    "revolute": "<axis><xyz>{0}</xyz></axis>",
    "prismatic": "<axis><xyz>{0}</xyz></axis>",
    "ball": "",
    "universal": "<axis><xyz>{0}</xyz></axis><axis2><xyz>{1}</xyz></axis2>",
    "revolute2": "<axis><xyz>{0}</xyz></axis><axis2><xyz>{1}</xyz></axis2>",
}


def random_tree(seed: int) -> tuple[str, float]:
    """An SDF model whose joints turn about axes anywhere, so that many need a body between; and what its links weigh."""
    draw = random.Random(seed)
    count, total = draw.randint(2, 8), 0.0
    text = ""
    for i in range(count):
        mass = 10.0 ** draw.uniform(-3, 3)
        total += mass
        at = " ".join(f"{draw.uniform(-1, 1):.3f}" for _ in range(6))
        size = "<geometry><box><size>.1 .2 .3</size></box></geometry>"
        text += f'<link name="l{i}"><pose>{at}</pose><inertial><mass>{mass!r}</mass></inertial><collision name="c">{size}</collision></link>'
    for i in range(1, count):
        kind = draw.choice(sorted(JOINTS))
        axes = [" ".join(f"{draw.gauss(0, 1):.3f}" for _ in range(3)) for _ in range(2)]
        parent = f"l{draw.randrange(i)}"
        text += f'<joint name="j{i}" type="{kind}"><parent>{parent}</parent><child>l{i}</child>{JOINTS[kind].format(*axes)}</joint>'
    return f'<sdf version="1.9"><model name="m">{text}</model></sdf>', total


@pytest.mark.parametrize("seed", range(20))
def test_a_tree_weighs_what_its_links_do(seed: int, tmp_path: Path):
    text, total = random_tree(seed)
    (tmp_path / "m.sdf").write_text(text, encoding="utf-8")
    kinefab.export(tmp_path / "m.sdf", tmp_path / "m.kinefab")
    found = weights(tmp_path / "m.kinefab")
    assert sum(found.values()) == pytest.approx(total, rel=1e-6)
    assert min(found.values()) > 0.0


@pytest.mark.parametrize("seed", range(10))
def test_three_free_slides_anywhere_and_a_ball_are_a_free_body(seed: int):
    """Square to each other, in any order and sense."""
    draw = np.random.default_rng(seed)
    directions = np.linalg.qr(draw.standard_normal((3, 3)))[0] * draw.choice([-1.0, 1.0], 3)
    slides = [
        Axis(i, "slide", np.zeros(3), directions[:, i], 0.0, 0.0, True, False) for i in range(3)
    ]
    ball = Axis(3, "ball", draw.standard_normal(3), np.array([0.0, 0, 1]), 0.0, 0.0, True, False, np.eye(3))
    (step,) = steps_of([*slides, ball])
    assert step.kind is JointKind.FREE
    for axis, index in zip(slides, step.freedoms):
        assert step.frame_a.rotation[:, index] == pytest.approx(axis.direction)
