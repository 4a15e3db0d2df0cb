"""Parts under parts, thousands deep: found in one walk, and told in a message that one can read."""

from __future__ import annotations

import numpy as np
import pytest
from kinefab.diagnostics import KinefabError, Report
from kinefab.model import MassProperties, Node, NodeKind, Scene
from kinefab.rigid import rigid_groups
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
