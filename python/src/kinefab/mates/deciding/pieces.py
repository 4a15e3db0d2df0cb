"""Machines that hang together by one body alone."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from ...partition import Partition
from .edge import Edge


def parted(count: int, chosen: Sequence[Edge], inside: Sequence[Edge]) -> list[tuple[list[Edge], list[Edge]]]:
    """Edges by machine: what hangs together without the body that most others hang on.  Seen from that body, one
    machine's motions are no other's affair."""
    whole, apart = Partition(count), Partition(count)
    degree: Counter[int] = Counter()
    for edge in chosen:
        whole.join(*edge.pair)
        degree.update(edge.pair)
    hubs: dict[int, int] = {}
    for body in sorted(degree):
        key = whole.find(body)
        hubs[key] = max(hubs.get(key, body), body, key=lambda b: (degree[b], -b))
    for edge in [*chosen, *inside]:
        if hubs[whole.find(edge.pair[0])] not in edge.pair:
            apart.join(*edge.pair)
    found: dict[int, tuple[list[Edge], list[Edge]]] = {}
    for edges, place in ((chosen, 0), (inside, 1)):
        for edge in edges:
            hub = hubs[whole.find(edge.pair[0])]
            body = edge.pair[0] if edge.pair[0] != hub else edge.pair[1]
            found.setdefault(apart.find(body), ([], []))[place].append(edge)
    return [found[key] for key in sorted(found)]
