"""Blocks and cut pairs of random graphs, against taking the edges away."""

import random
from itertools import combinations

import pytest
from kinefab.analysis.assembly.cut_pairs import cut_pairs
from kinefab.partition import Partition


def parts(nodes: int, edges: list[tuple[int, int]]) -> int:
    partition = Partition(nodes)
    for a, b in edges:
        partition.join(a, b)
    return len({partition.find(node) for node in range(nodes)})


@pytest.mark.parametrize("seed", range(200))
def test_classes_are_the_pairs_that_cut(seed):
    draw = random.Random(seed)
    nodes = draw.randint(2, 12)
    every = list(combinations(range(nodes), 2))
    edges = sorted(draw.sample(every, draw.randint(1, min(len(every), nodes + 3))))
    found = cut_pairs(nodes, edges)
    whole = parts(nodes, edges)
    without = {e: parts(nodes, edges[:e] + edges[e + 1 :]) > whole for e in range(len(edges))}
    assert [block < 0 for block in found.block] == [without[e] for e in range(len(edges))]
    told = {frozenset(pair) for members in found.classes for pair in combinations(members, 2)}
    cut = {
        frozenset((e, f))
        for e, f in combinations(range(len(edges)), 2)
        if not without[e] and not without[f]
        and parts(nodes, [edge for i, edge in enumerate(edges) if i not in (e, f)]) > whole
    }  # fmt: skip
    assert told == cut


def test_between_two_edges_of_a_class_lies_what_does_not_hang_on_the_root():
    """A ring: from the root outwards, and then back to it."""
    found = cut_pairs(5, [(0, 1), (1, 2), (2, 3), (3, 4), (0, 4)])
    (members,) = found.classes
    assert [found.of_tree(edge) for edge in members] == [True, True, True, True, False]
    assert [found.lower(edge) for edge in members[:-1]] == [1, 2, 3, 4]
    assert (found.lower(members[-1]), found.upper(members[-1])) == (4, 0)
