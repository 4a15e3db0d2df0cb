"""All contacts of an assembly: near parts by their boxes, then feature by feature; what a part between them rules out."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

import numpy as np

from ...spatial import Array
from ..shapes.features import Shape
from ..shapes.nearby import near_pairs
from .contact import Contact, ContactKind, shared
from .flat_contacts import flat_contacts
from .round_contacts import round_contacts

NEAR = 0.02
"""Share of the smaller part's size up to which flats that face each other may be a clearance apart."""
TOUCH = 2e-5
"""Share of the smaller part's size up to which there is no clearance."""

SAME_WAY = 1.0 - 1e-9
"""Cosine between normals that are one."""


def near_parts(shapes: Sequence[Shape]) -> list[tuple[int, int]]:
    """Pairs of parts whose boxes come near each other, lower number first, in order."""
    lows, highs = (
        np.array([s.low for s in shapes]).reshape(-1, 3),
        np.array([s.high for s in shapes]).reshape(-1, 3),
    )
    return near_pairs(lows, highs, [NEAR * s.size for s in shapes])


def contacts_of(shapes: Sequence[Shape], pairs: Sequence[tuple[int, int]]) -> list[Contact]:
    """Contacts between these pairs of parts.  shapes: WORLD."""
    found: list[Contact] = []
    for i, j in pairs:
        a, b = shapes[i], shapes[j]
        size = min(a.size, b.size)
        near, touch = NEAR * size, TOUCH * size
        low, high = np.maximum(a.low, b.low) - near, np.minimum(a.high, b.high) + near
        found += round_contacts(i, j, a, b, low, high, near, touch)
        found += flat_contacts(i, j, a, b, low, high, near, touch)
    return _without_parted(_without_lined(found))


def _without_lined(contacts: list[Contact]) -> list[Contact]:
    """Fits whose bore is lined by another part are none: the shaft turns in the bushing, the bushing sits in the bore.

    Of the shafts in one bore at one place only the widest is kept, and of the bores round one shaft the narrowest.
    """
    fits = [c for c in contacts if c.kind in (ContactKind.FIT, ContactKind.ARC)]
    dropped: set[int] = set()
    for by_inner in (False, True):
        groups: defaultdict[tuple[int, tuple[str, ...]], list[Contact]] = defaultdict(list)
        for c in fits:
            part = c.inner if by_inner else c.other(c.inner)
            groups[part, c.side(part).faces].append(c)
        for group in groups.values():
            for c in group:
                if any(other.gap < c.gap - 1e-9 and shared(c, other) > 0.5 * c.reach for other in group):
                    dropped.add(id(c))
    return [c for c in contacts if id(c) not in dropped]


def _without_parted(contacts: list[Contact]) -> list[Contact]:
    """Flats that face each other over a gap are none where a third part's flats lie between, closer to both: the middle
    member of a drawer's slide guides the inner one, not the outer."""
    beside: defaultdict[tuple[int, int], list[Contact]] = defaultdict(list)
    near: defaultdict[int, set[int]] = defaultdict(set)
    for c in contacts:
        if c.kind is ContactKind.FLAT and len(c.points):
            beside[c.first, c.second].append(c)
            near[c.first].add(c.second)
            near[c.second].add(c.first)

    def closer(a: int, b: int, normal: Array, gap: float) -> bool:
        """Whether b is over a along the normal, by less than a gap."""
        way, pair = (1.0, (a, b)) if a < b else (-1.0, (b, a))
        return any(c.gap < gap and way * float(c.normals[0] @ normal) > SAME_WAY for c in beside[pair])

    def is_parted(c: Contact) -> bool:
        if c.kind is not ContactKind.FLAT or c.touching:
            return False
        return any(
            closer(c.first, middle, c.normals[0], c.gap) and closer(middle, c.second, c.normals[0], c.gap)
            for middle in sorted(near[c.first] & near[c.second])
        )

    return [c for c in contacts if not is_parted(c)]
