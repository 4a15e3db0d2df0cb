"""A pair of parts gets the joint that it gets alone, whatever else the assembly holds and in whatever order."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from itertools import permutations

import numpy as np
import pytest
from kinefab.analysis import Analysis, analyse
from kinefab.model import Constraint, Joint, JointKind, Node, Scene, freedoms_of
from kinefab.spatial import Pose
from mechanism_cases import analysed, scene
from strategies import random_pose

PAIRS = [f"P{n:02}" for n in range(1, 37)]
HINGE = JointKind.REVOLUTE
SIDES = ((-3.0, 0.4, -0.7), (3.0, 0.4, -0.7))
"""Where a further part hangs on a joint of its own: it is taken before the pair's in one case, after it in the other."""
SAME = 1e-6


def named(pair: Scene, name: str, at) -> Scene:
    """The pair elsewhere, its parts and constraints under the pair's name."""
    nodes = [
        replace(n, id=f"{name}/{n.id}", pose=Pose(n.pose.rotation, n.pose.translation + at))
        for n in pair.nodes
    ]
    return Scene(nodes=nodes, constraints=[replace(c, id=f"{name}/{c.id}") for c in pair.constraints])


def hung(name: str, pose: Pose, kind: JointKind) -> Scene:
    """A part on an explicit joint of its own to the world."""
    joint = Joint(f"{name}/joint", kind, None, 0, pose, Pose(), freedoms_of(kind))
    return Scene(nodes=[Node(name, name, pose=pose)], joints=[joint])


def together(scenes: Sequence[Scene], order: Sequence[int]) -> Scene:
    """One scene of all, its nodes in the given order."""
    nodes = [node for s in scenes for node in s.nodes]
    place = {old: new for new, old in enumerate(order)}
    constraints: list[Constraint] = []
    joints: list[Joint] = []
    first = 0
    for s in scenes:
        for c in s.constraints:
            features = tuple(replace(f, node=place[f.node + first]) for f in c.features)
            constraints.append(replace(c, features=features))
        joints += [replace(j, b=place[j.b + first]) for j in s.joints]
        first += len(s.nodes)
    return Scene(nodes=[nodes[i] for i in order], joints=joints, constraints=constraints)


def joints_between(found: Analysis, name: str, at) -> tuple[list, np.ndarray]:
    """Of each joint that a pair's constraints became: the parts and what it leaves; its place and axes."""
    solved = found.scene(solved=True)
    entries = []
    for joint in found.joints:
        if any(reason.startswith(f"{name}/") for reason in joint.because):
            frame = solved.pose(joint.a) @ joint.frame_a
            words = (solved.name(joint.a), solved.name(joint.b), joint.kind, joint.freedoms, joint.because)
            entries.append((words, [*(frame.translation - at), *frame.rotation.ravel(), joint.lead]))
    entries.sort(key=lambda entry: entry[0][:2])
    return [words for words, _ in entries], np.array([numbers for _, numbers in entries])


@cache
def alone(id: str) -> tuple[list, np.ndarray]:
    return joints_between(analyse(named(scene(id), id, np.zeros(3))), id, np.zeros(3))


def assert_as_alone(found: Analysis, id: str, at) -> None:
    words, numbers = joints_between(found, id, at)
    expected, places = alone(id)
    assert words == expected
    assert np.abs(numbers - places).max(initial=0.0) < SAME
    a, b = (next(i for i, n in enumerate(found.source.nodes) if n.id == f"{id}/{part}") for part in "AB")
    assert found.groups.together(a, b) == analysed(id).groups.together(0, 1)


@pytest.mark.parametrize("id", PAIRS)
def test_a_pair_beside_an_explicit_joint_is_what_it_is_alone(id):
    """The joint's part on either side, and the parts in every order."""
    for side in SIDES:
        pose = random_pose(np.random.default_rng(int(id[1:])))
        pose = Pose(pose.rotation, np.array(side))
        scenes = [named(scene(id), id, np.zeros(3)), hung("other", pose, HINGE)]
        for order in permutations(range(3)):
            found = analyse(together(scenes, order))
            assert_as_alone(found, id, np.zeros(3))
            assert [j.kind for j in found.joints if j.id == "other/joint"] == [HINGE]


@pytest.mark.parametrize("seed", range(4))
def test_all_pairs_in_one_scene_with_joints_among_them_are_what_they_are_alone(seed):
    """Each pair at a place of its own, in a random order, with joints of several kinds between and beside them."""
    rng = np.random.default_rng(seed)
    places = {id: rng.uniform(-20.0, 20.0, 3) for id in PAIRS}
    kinds = [k for k in JointKind if k not in (JointKind.FIXED, JointKind.SCREW, JointKind.GENERAL)]
    others = [
        hung(f"other{n}", random_pose(rng, 20.0), kinds[int(rng.integers(len(kinds)))]) for n in range(12)
    ]
    scenes = [*(named(scene(id), id, places[id]) for id in PAIRS), *others]
    scenes = [scenes[i] for i in rng.permutation(len(scenes))]
    found = analyse(together(scenes, rng.permutation(sum(len(s.nodes) for s in scenes)).tolist()))
    for id in PAIRS:
        assert_as_alone(found, id, places[id])
    for other in others:
        assert [j.kind for j in found.joints if j.id == other.joints[0].id] == [other.joints[0].kind]
