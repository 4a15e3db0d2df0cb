"""Scenes made in a script: ids, their cost, and what a wrong call says."""

from __future__ import annotations

import pytest

import kinefab


class CountedNodes(list):
    """A list that counts the nodes read from it."""

    read = 0

    def __iter__(self):
        self.read += len(self)
        return super().__iter__()

    def __getitem__(self, key):
        found = super().__getitem__(key)
        self.read += len(found) if isinstance(key, slice) else 1
        return found


def test_adding_a_part_does_not_read_all_others_again():
    """Ten thousand parts take ten thousand steps, of one name or of many, not their square."""
    scene = kinefab.Scene(nodes=CountedNodes())
    for number in range(5000):
        scene.add_part("Bolt")
        scene.add_part(f"Part{number}")
    assert scene.nodes.read <= 3 * 10_000
    assert len({node.id for node in list(scene.nodes)}) == 10_000


def test_copies_are_numbered_past_ids_from_elsewhere():
    """A third bolt is Bolt:3, unless a node that no add_part made, or another name, has that id already."""
    scene = kinefab.Scene()
    for name in ("Bolt", "Bolt:3", "Bolt", "Bolt"):
        scene.add_part(name)
    scene.nodes.append(kinefab.model.Node("Bolt:5", "Bolt"))
    scene.add_part("Bolt")
    assert [node.id for node in scene.nodes] == ["Bolt", "Bolt:3", "Bolt:2", "Bolt:4", "Bolt:5", "Bolt:6"]


HINGE = {"point": (0, 0, 0), "axis": (0, 0, 1)}


@pytest.mark.parametrize(
    "a, b, change, error, says",
    [
        ("Box", 1, {}, TypeError, "a is 'Box'; pass the index that add_part"),
        (0, "Lid", {}, TypeError, "b is 'Lid'; pass the index that add_part"),
        (0, None, {}, TypeError, "b is None; pass the index"),
        (0, 7, {}, ValueError, "b is 7; the scene has nodes 0 to 1"),
        (-1, 1, {}, ValueError, "a is -1; the scene has nodes 0 to 1"),
        (1, 1, {}, ValueError, "pass two different parts"),
        (0, 1, {"axis": (0, 0, 0)}, ValueError, "pass a direction in the world"),
        (0, 1, {"limits": (80, -10)}, ValueError, "lower not above upper"),
        (0, 1, {"limits": 80}, TypeError, "pass two numbers"),
    ],
)
def test_wrong_joint_says_what_to_pass(a, b, change, error, says):
    """A name for an index, a part joined to itself, a zero axis, reversed limits: an error, and no joint."""
    scene = kinefab.Scene()
    scene.add_part("Box")
    scene.add_part("Lid")
    with pytest.raises(error) as raised:
        scene.add_hinge(a, b, **{**HINGE, **change})
    assert says in str(raised.value)
    assert scene.joints == []


@pytest.mark.parametrize("parent, error", [("Box", TypeError), (3, ValueError), (-1, ValueError)])
def test_wrong_parent_says_what_to_pass(parent, error):
    """A parent is an index too."""
    scene = kinefab.Scene()
    scene.add_part("Box")
    with pytest.raises(error, match="^parent is"):
        scene.add_part("Lid", parent=parent)
    assert len(scene.nodes) == 1
