"""Records broken at random: cut off, or with answers taken away, exchanged, or replaced by what no documentation allows."""

from __future__ import annotations

import copy
import json
import random
from collections.abc import Iterator
from typing import Any

ODD: tuple[Any, ...] = (
    None, True, False, 0, -1, 1, 3, 1e308, -1e308, 1e-320, 10**400, "", "x", "ground", "\x00", "../../x", "é/+", [], [[]], [1.0],
    ["a", "b", "c"], [0.0] * 16, [1e200] * 16, {}, {"object": 0}, {"object": 1}, {"object": -1}, {"object": 10**9}, {"object": "x"},
    {"failed": "com_error: E_FAIL"}, {"failed": 3},
)  # fmt: skip


def mutated(record: dict[str, Any], seed: int) -> bytes:
    """One broken record of a sound one, as a file's bytes."""
    chance = random.Random(seed)
    if chance.random() < 0.1:
        text = json.dumps(record).encode()
        cut = chance.randrange(len(text))
        if chance.random() < 0.5:
            return text[:cut]
        return text[:cut] + bytes([chance.randrange(256)]) + text[cut + 1 :]
    broken = copy.deepcopy(record)
    places = list(_places(broken["answers"]))
    for _ in range(chance.choice((1, 1, 2, 5, 20))):
        holder, key = chance.choice(places)
        other, there = chance.choice(places)
        try:
            kind = chance.random()
            if kind < 0.15:
                del holder[key]
            elif kind < 0.4:
                holder[key] = copy.deepcopy(other[there])
            elif isinstance(holder[key], (int, float)) and kind < 0.6:
                holder[key] = holder[key] * chance.choice((-1, 0, 2, 1e9, 1e-9))
            else:
                holder[key] = copy.deepcopy(chance.choice(ODD))
        except (KeyError, IndexError, OverflowError):  # it has gone with an earlier one
            continue
    return json.dumps(broken).encode()


def _places(value: Any) -> Iterator[tuple[Any, Any]]:
    keys = value if isinstance(value, dict) else range(len(value)) if isinstance(value, list) else ()
    for key in list(keys):
        if key != "#kind":
            yield value, key
            yield from _places(value[key])
