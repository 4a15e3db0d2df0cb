"""Parts under parts, thousands deep: found in one walk, and told in a message that one can read."""

from __future__ import annotations

import json

import kinefab
import numpy as np
import pytest
from kinefab import rigid
from kinefab.diagnostics import KinefabError, Report
from kinefab.model import MassProperties, Node, NodeKind, Scene
from kinefab.rigid import rigid_groups
from kinefab.unity import mapping
from kinefab.unity.bodies.rigidbodies import map_rigidbody, place_rigidbodies
from source_bundles import bundle, part, read

MASS = MassProperties(1.0, np.zeros(3), np.eye(3))


class Counted(list):
    """A list that counts how often it is asked."""

    asked = 0

    def __getitem__(self, key):
        self.asked += 1
        return super().__getitem__(key)


def ancestors(scene: Scene, node: int) -> list[int]:
    line = [node]
    while (parent := scene.nodes[line[-1]].parent) is not None:
        line.append(parent)
    return line


@pytest.mark.parametrize("frozen", [False, True])
def test_a_chain_of_parts_is_walked_in_proportion_to_its_depth(frozen):
    """Each part its own body, or all of them one."""
    deep = 1500
    nodes = Counted([Node("top", "top", NodeKind.ASSEMBLY, flexible=not frozen)])
    nodes += [Node(f"p{i}", f"p{i}", parent=i, mass=MASS) for i in range(deep)]
    scene = Scene(nodes=nodes)
    groups = rigid_groups(scene)
    nodes.asked = 0
    placed = place_rigidbodies(scene, groups)
    for carrier, members in placed.carriers.items():
        map_rigidbody(scene, carrier, members, Report())
    assert len(placed.carriers) == (1 if frozen else deep)
    assert nodes.asked < 40 * deep


def test_a_chain_of_assemblies_is_exported_in_proportion_to_its_depth(tmp_path, monkeypatch):
    """Which Rigidbody moves each object was asked of all that stand above it."""
    deep, counted = 800, []
    nodes = [Node(f"a{i}", f"a{i}", NodeKind.ASSEMBLY, parent=i - 1 if i else None) for i in range(deep)]
    nodes += [Node("p", "p", parent=deep - 1, mass=MASS)]
    keep_apart = mapping._Builder.keep_apart

    def counting(builder):
        builder.objects, builder.components = Counted(builder.objects), Counted(builder.components)
        keep_apart(builder)
        counted.append(builder.objects.asked + builder.components.asked)

    monkeypatch.setattr(mapping._Builder, "keep_apart", counting)
    kinefab.export(Scene(nodes=nodes), tmp_path / "deep.kinefab")
    assert len(counted) == 1 and counted[0] < 10 * deep


def test_a_chain_that_was_written_is_read_again(tmp_path):
    """What an object gives a place was asked of all below it, from within each other: a thousand were too many for Python."""
    deep = 1200
    nodes = [Node("top", "top", NodeKind.ASSEMBLY)]
    nodes += [Node(f"p{i}", f"p{i}", parent=i, mass=MASS) for i in range(deep)]
    written = kinefab.export(Scene(nodes=nodes), tmp_path / "deep.kinefab").path
    again = kinefab.export(written, tmp_path / "again.kinefab").path
    assert [one["id"] for one in json.loads(again.read_text())["gameObjects"]] == [node.id for node in nodes]


def test_a_group_of_thousands_is_looked_at_once(tmp_path, monkeypatch):
    """Whether scripts move it was asked of all its parts for each of them."""
    parts, looked = 600, []
    nodes = [Node("top", "top", NodeKind.ASSEMBLY, flexible=False)]
    nodes += [Node(f"p{i}", f"p{i}", parent=0, mass=MASS) for i in range(parts)]
    is_kinematic = rigid.is_kinematic
    monkeypatch.setattr(rigid, "is_kinematic", lambda scene, nodes: looked.append(len(nodes)) or is_kinematic(scene, nodes))
    kinefab.export(Scene(nodes=nodes), tmp_path / "group.kinefab")
    assert 0 < sum(looked) < 10 * parts


def test_masses_are_counted_once_in_every_tree():
    """Of random trees: an assembly with a mass of its own stands for all below it, whatever else is there."""
    rng = np.random.default_rng(5)
    for _ in range(60):
        nodes = [Node("top", "top", NodeKind.ASSEMBLY, flexible=False)]
        for i in range(1, 14):
            kind = NodeKind.ASSEMBLY if rng.random() < 0.4 else NodeKind.PART
            mass = MassProperties(2.0**i, np.zeros(3), 2.0**i * np.eye(3)) if rng.random() < 0.6 else None
            nodes.append(Node(f"n{i}", f"n{i}", kind, int(rng.integers(i)), mass=mass))
        scene = Scene(nodes=nodes)
        whole = {i for i, n in enumerate(nodes) if n.kind is NodeKind.ASSEMBLY and n.mass is not None}
        outer = [i for i in range(len(nodes)) if not whole & set(ancestors(scene, i)[1:])]
        wanted = sum(nodes[i].mass.mass for i in outer if nodes[i].mass is not None)
        for carrier, members in place_rigidbodies(scene, rigid_groups(scene)).carriers.items():
            assert members == tuple(range(len(nodes))) and carrier == 0
            assert map_rigidbody(scene, carrier, members, Report()).mass == pytest.approx(wanted or 1.0)


def test_a_cycle_of_thousands_is_told_by_its_ends(tmp_path):
    """Not by megabytes of names."""
    count = 5000
    parts = [part(f"{'x' * 200}{i}", parent=f"{'x' * 200}{(i + 1) % count}") for i in range(count)]
    with pytest.raises(KinefabError) as raised:
        read(bundle(*parts), tmp_path)[1].raise_for_errors()
    (found,) = raised.value.diagnostics
    assert found.code == "HIERARCHY_CYCLE" and len(found.message) < 2000
    assert f"({count + 1 - 12} more)" in found.message
