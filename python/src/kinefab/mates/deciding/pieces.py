"""Which bodies hang together."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from .edge import Edge


class Pieces:
    """Numbers joined step by step to sets; each set is known by its lowest."""

    def __init__(self, count: int) -> None:
        self._leader = list(range(count))

    def of(self, i: int) -> int:
        while self._leader[i] != i:
            self._leader[i] = self._leader[self._leader[i]]
            i = self._leader[i]
        return i

    def join(self, a: int, b: int) -> bool:
        a, b = self.of(a), self.of(b)
        self._leader[max(a, b)] = min(a, b)
        return a != b


def parted(count: int, chosen: Sequence[Edge], inside: Sequence[Edge]) -> list[tuple[list[Edge], list[Edge]]]:
    """Edges by machine: what hangs together without the body that most others hang on.  Seen from that body, one
    machine's motions are no other's affair."""
    whole, apart = Pieces(count), Pieces(count)
    degree: Counter[int] = Counter()
    for edge in chosen:
        whole.join(*edge.pair)
        degree.update(edge.pair)
    hubs: dict[int, int] = {}
    for body in sorted(degree):
        key = whole.of(body)
        hubs[key] = max(hubs.get(key, body), body, key=lambda b: (degree[b], -b))
    for edge in [*chosen, *inside]:
        if hubs[whole.of(edge.pair[0])] not in edge.pair:
            apart.join(*edge.pair)
    found: dict[int, tuple[list[Edge], list[Edge]]] = {}
    for edges, place in ((chosen, 0), (inside, 1)):
        for edge in edges:
            hub = hubs[whole.of(edge.pair[0])]
            body = edge.pair[0] if edge.pair[0] != hub else edge.pair[1]
            found.setdefault(apart.of(body), ([], []))[place].append(edge)
    return [found[key] for key in sorted(found)]
