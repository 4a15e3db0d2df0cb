"""Islands of parts, where a rope goes from one to another: a joint that ends motions and takes none away."""

from __future__ import annotations

import json
import random
import shutil
import subprocess

import kinefab
import numpy as np
import pytest
from kinefab.analysis import analyse
from kinefab.model import Freedom, Joint, JointKind, MassProperties, Motion, Node, Scene, freedoms_of
from kinefab.spatial import Pose

TOOL = shutil.which("dotnet-kinefab")
MASS = MassProperties(1.5, np.array([0.01, -0.02, 0.03]), np.diag([0.02, 0.03, 0.04]))
FREEDOMS = {
    "hinge": (
        JointKind.REVOLUTE,
        freedoms_of(JointKind.REVOLUTE, rx=Freedom(Motion.LIMITED, -np.pi / 18, np.pi / 2.25)),
    ),
    "ball": (JointKind.SPHERICAL, freedoms_of(JointKind.SPHERICAL)),
    "rope": (JointKind.FREE, freedoms_of(JointKind.FREE, tx=Freedom(Motion.LIMITED, -9.0, 9.5))),
    "loose": (JointKind.FREE, freedoms_of(JointKind.FREE)),
}


def linked(*joints: tuple[str, int, int]) -> Scene:
    """Parts 1, 2, ... a metre apart on the ground's part 0, and joints (kind, part, part) midway between theirs."""
    count = 1 + max(max(a, b) for _, a, b in joints)
    at = np.array([[i, 0.3 * i * i, 0.1 * i] for i in range(count)])
    nodes = [
        Node(f"part{i}", f"part{i}", grounded=i == 0, pose=Pose(np.eye(3), at[i]), mass=MASS)
        for i in range(count)
    ]
    built: list[Joint] = []
    for n, (kind, a, b) in enumerate(joints):
        middle = 0.5 * (at[a] + at[b]) + np.array([0.0, 0.02 * n, 0.0])
        frames = (Pose(np.eye(3), middle - at[a]), Pose(np.eye(3), middle - at[b]))
        built.append(Joint(f"j{n}", FREEDOMS[kind][0], a, b, *frames, FREEDOMS[kind][1]))
    return Scene(nodes=nodes, joints=built)


def hinged(*pairs: tuple[int, int]) -> list[tuple[str, int, int]]:
    return [("hinge", a, b) for a, b in pairs]


ARMS, CHAIN = hinged((0, 1), (0, 2)), hinged((0, 1), (1, 2), (2, 3))
CASES = {
    "two arms": (ARMS, [(1, 0), (1, 0)]),
    "a rope from arm to arm": ([*ARMS, ("rope", 1, 2)], [(2, 1)]),
    "two ropes from arm to arm": ([*ARMS, ("rope", 1, 2), ("rope", 2, 1)], [(2, 2)]),
    "what ends and drives nothing is not written": ([*ARMS, ("loose", 1, 2)], [(1, 0), (1, 0)]),
    "a rope from the ground to a chain's end": ([*CHAIN, ("rope", 0, 3)], [(3, 1)]),
    "a rope along a chain": ([*CHAIN, ("rope", 1, 3)], [(3, 1)]),
    "a load on an arm": ([*hinged((0, 1)), ("rope", 1, 2)], [(7, 0)]),
    "a load on two arms, and another on it": (
        [*ARMS, ("rope", 1, 3), ("rope", 2, 3), ("rope", 3, 4)],
        [(14, 1)],
    ),
    "a load on the ground": ([("rope", 0, 1)], [(6, 0)]),
    "a load on two ropes from the ground": ([("rope", 0, 1), ("rope", 1, 0)], [(6, 1)]),
    "chains that float, roped together": ([*hinged((1, 2), (3, 4)), ("rope", 1, 3)], [(14, 0)]),
    "the same by two ropes": ([*hinged((1, 2), (3, 4)), ("rope", 1, 3), ("rope", 2, 4)], [(14, 1)]),
    "the same, one on the ground too": (
        [*hinged((1, 2), (3, 4)), ("rope", 1, 3), ("rope", 2, 4), ("rope", 0, 4)],
        [(14, 1)],
    ),
}


@pytest.mark.parametrize("joints, islands", CASES.values(), ids=CASES)
def test_a_rope_makes_one_island_of_its_two_sides(joints, islands):
    """(mobility, loops) of each; what only ropes lead to the ground does not float."""
    found = analyse(linked(*joints))
    assert [(i.mobility, i.loops) for i in found.islands] == islands
    assert found.mobility == sum(mobility for mobility, _ in islands)
    roped = [i for i in found.islands if i.floating]
    assert len(roped) == (len(islands) if not any(0 in pair for _, *pair in joints) else 0)


def test_idle_freedoms_are_left_out_where_a_rope_closes_a_loop(tmp_path):
    """An arm on a slack rope moves nothing else, and is no rod that spins between its balls either."""

    def written(*joints):
        path = kinefab.export(linked(*joints), tmp_path / "scene.kinefab").path
        return json.loads(path.read_text(encoding="utf-8"))["analysis"].get("idle")

    rod = [*hinged((0, 1)), ("ball", 1, 2), ("ball", 2, 3), *hinged((3, 0))]
    assert [written(*rod), written(*rod, ("rope", 3, 4))] == [1, 1]
    assert [written(*ARMS, ("rope", 1, 2)), written(*rod, ("rope", 3, 1))] == [None, None]


def drawn(seed: int) -> list[tuple[str, int, int]]:
    """Up to six parts in a forest of hinges and balls, one loop at most, and some ropes between any two."""
    draw = random.Random(seed)
    count = draw.randint(2, 6)
    pairs = {
        (draw.randrange(i), i): draw.choice(["hinge", "hinge", "ball"])
        for i in range(1, count + 1)
        if draw.random() < 0.75
    }
    for kind in [draw.choice(["hinge", "rope"]), *["rope"] * draw.randint(1, 4)]:
        a, b = sorted(draw.sample(range(count + 1), 2))
        pairs.setdefault((a, b), kind)
    return [(kind, a, b) for (a, b), kind in pairs.items()]


@pytest.mark.skipif(TOOL is None, reason="dotnet-kinefab is not on the PATH")
@pytest.mark.parametrize(
    "joints", [*(joints for joints, _ in CASES.values()), *map(drawn, range(12))], ids=str
)
def test_csharp_counts_the_same_from_the_joints(tmp_path, joints):
    target = kinefab.export(linked(*joints), tmp_path / "scene.kinefab").path
    said = subprocess.run([str(TOOL), "mobility", str(target)], capture_output=True, text=True)
    assert said.returncode == 0, said.stdout + said.stderr
