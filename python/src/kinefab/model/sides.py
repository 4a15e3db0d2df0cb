"""A joint seen from its other body."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from ..spatial import Array
from .freedoms import RX, RY, RZ, Freedom
from .joints import unlocked_of

T = TypeVar("T")


@dataclass(frozen=True, slots=True, eq=False)
class Exchange:
    """What makes a joint of bodies a and b one of b and a, so that coordinates keep their sense where they can.

    axes: that both frames are turned by, columns in the old ones, shape (3, 3).
    names: for each axis X, Y, Z of the new frames which of the old ones its freedoms were.
    senses: -1 where they are counted the other way, else 1.

    Done twice it is nothing.
    """

    axes: Array
    names: tuple[int, int, int]
    senses: tuple[int, int, int]

    def picked(self, six: Sequence[T]) -> tuple[T, ...]:
        """What goes by freedoms TX..RZ, in the order of the new ones."""
        return tuple(six[self.names[i % 3] + i // 3 * 3] for i in range(6))

    def coordinates(self, given: Sequence[float]) -> tuple[float, ...]:
        """The joint's six from its other side."""
        return tuple(value * self.senses[i % 3] for i, value in enumerate(self.picked(given)))

    def freedoms(self, given: tuple[Freedom, ...]) -> tuple[Freedom, ...]:
        """The joint's six from its other side."""
        return tuple(
            f.turned_round() if self.senses[i % 3] < 0 else f for i, f in enumerate(self.picked(given))
        )


def exchange_of(freedoms: tuple[Freedom, ...]) -> Exchange:
    """Of a joint with these freedoms.

    The inverse of T = Trans(t) R has -t and the turns in the other order; with all axes turned round (and two turns
    exchanged) both read as before.
    """
    turns = [i - RX for i in unlocked_of(freedoms) if i >= RX]
    slides = [i for i in unlocked_of(freedoms) if i < RX]
    if not turns and len(slides) != 1:
        return Exchange(np.eye(3), (0, 1, 2), (-1, -1, -1))
    if len(turns) == 2:
        i, j = turns
        swap = [j if k == i else i if k == j else k for k in range(3)]
        return Exchange(-np.eye(3)[:, swap], (swap[0], swap[1], swap[2]), (1, 1, 1))
    across = ((turns or slides)[0] + 1) % 3
    axes, senses = -np.eye(3), [1, 1, 1]
    axes[across, across], senses[across] = 1.0, -1
    return Exchange(axes, (0, 1, 2), (senses[0], senses[1], senses[2]))


def is_same_from_both_sides(freedoms: tuple[Freedom, ...]) -> bool:
    """Whether ``exchange_of`` keeps the joint as it is: it slides along one axis, or turns; about all three only where the
    swings are free or a cone."""
    free = unlocked_of(freedoms)
    turns = [i for i in free if i >= RX]
    if len(turns) == 3:
        first, second = freedoms[RY], freedoms[RZ]
        cone = (
            first == second and first.lower == -first.upper and first.drive is None and first.passive is None
        )
        return len(free) == 3 and (cone or not (first.acts or second.acts))
    return len(free) <= 1 or len(turns) == len(free)
