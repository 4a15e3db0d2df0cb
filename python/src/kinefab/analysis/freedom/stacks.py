"""Many small problems of one shape as one stack of arrays.

numpy spends microseconds on every call, far more than on a matrix of six columns, so what is done for each of
thousands of pairs or bodies is done for all those of one shape at once.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator
from typing import TypeVar

import numpy as np

from ...spatial import IntArray

Key = TypeVar("Key", bound=Hashable)
MOST = 1000
"""Problems in one stack, which bounds its memory."""


def alike(keys: Iterable[Key]) -> Iterator[tuple[Key, IntArray]]:
    """Each key, as they first come, and the places where it stands, ascending, up to ``MOST`` at a time."""
    places: dict[Key, list[int]] = {}
    for i, key in enumerate(keys):
        places.setdefault(key, []).append(i)
    for key, own in places.items():
        for at in range(0, len(own), MOST):
            yield key, np.array(own[at : at + MOST])
