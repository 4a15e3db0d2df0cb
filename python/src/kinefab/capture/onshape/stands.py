"""In which unit and axes the meshes of a program's parts stand: what it says of each part's mass or box tells.

Onshape's documentation of glTF states neither.  As far as it can be seen they are metres and the part's own axes, as of
everything else; glTF itself has Y up, and programs like millimetres.  The program weighs each part and boxes it in metres and the
part's axes: the reading whose volume, centre and moments, or whose box, are those is right.  Where more than one is, as of a ball,
the documented one is taken, or that which the other parts of the assembly have told.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from ...geometry.mass import solid_properties
from ...spatial import Array, IntArray

FITS = 0.02
"""How far off, of the part's size, a reading may be: facets lie inside of what is round."""
MOST_VOLUME = 1.2
"""Of the stated volume, or the stated of the mesh's."""
AXES: Mapping[str, Array] = {
    "the part's own axes": np.eye(3),
    "Y up": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]),
    "axes exchanged in a ring": np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]),
}
"""Of a vector of the file the part's."""
UNITS: Mapping[str, float] = {"metres": 1.0, "millimetres": 0.001, "centimetres": 0.01, "inches": 0.0254}
READINGS: Mapping[str, Array] = {f"{u}, {a}": UNITS[u] * AXES[a] for u in UNITS for a in AXES}
"""Linear map of each reading into the part's axes, metres; the first is the documented one."""
DOCUMENTED = next(iter(READINGS))


@dataclass(frozen=True, slots=True, eq=False)
class Said:
    """What the program says of a part, metres; None or nothing where it does not.

    volume, center (3,) and moments (3, 3) of one kilogram about it; low and high end of its box, (3,).
    """

    volume: float = 0.0
    center: Array | None = None
    moments: Array | None = None
    low: Array | None = None
    high: Array | None = None


def misfits(points: Array, faces: IntArray, said: Said) -> dict[str, float]:
    """How far off each reading is, of the part's size; empty where nothing was said that tells."""
    if not len(points):
        return {}
    volume, center, moments = _solid(points, faces)
    found: dict[str, float] = {}
    for words, linear in READINGS.items():
        unit = abs(float(np.linalg.det(linear))) ** (1.0 / 3.0)
        size = unit * float(np.linalg.norm(np.ptp(points, axis=0))) or 1.0
        off: list[float] = []
        if volume > 0.0 and said.volume > 0.0:
            ratio = volume * unit**3 / said.volume
            off.append(0.0 if 1.0 / MOST_VOLUME <= ratio <= MOST_VOLUME else abs(float(np.log(ratio))))
        if volume > 0.0 and said.center is not None:
            off.append(float(np.abs(linear @ center - said.center).max()) / size)
            if said.moments is not None:
                off.append(float(np.abs(linear @ moments @ linear.T - said.moments).max()) / size**2)
        if said.low is not None and said.high is not None:
            own = points @ linear.T
            off += [
                float(np.abs(own.min(axis=0) - said.low).max()) / size,
                float(np.abs(own.max(axis=0) - said.high).max()) / size,
            ]
        if off:
            found[words] = max(off)
    return found


def _solid(points: Array, faces: IntArray) -> tuple[float, Array, Array]:
    """Volume, centre and moments of one kilogram about it, of the solid between the triangles; a volume of 0 for none."""
    found = solid_properties(points, faces, 1.0)
    if found.mass <= 1e-9 * float(np.linalg.norm(np.ptp(points, axis=0))) ** 3:  # open, flat or inside out
        return 0.0, np.zeros(3), np.zeros((3, 3))
    return found.mass, found.center, found.inertia / found.mass


@dataclass(slots=True)
class Votes:
    """misfits: of each part, by its definition, how far off each reading is."""

    misfits: dict[str, dict[str, float]] = field(default_factory=dict[str, dict[str, float]])

    def of(self, definition: str) -> str | None:
        """The reading of a part: the documented one where it fits, unless the other parts have told another.  None: none fits."""
        off, told = self.misfits.get(definition), self.told()
        if not off:
            return told
        fitting = _fitting(off)
        return told if told in fitting else fitting[0] if fitting else None

    def told(self) -> str:
        """What most parts have told, each of which only one reading fits: all of an assembly come alike."""
        counts = Counter(fitting[0] for off in self.misfits.values() if len(fitting := _fitting(off)) == 1)
        return max(counts, key=lambda words: counts[words]) if counts else DOCUMENTED


def settled(off: Mapping[str, float]) -> bool:
    """Whether any reading fits."""
    return bool(_fitting(off))


def _fitting(off: Mapping[str, float]) -> list[str]:
    """The readings that fit: the documented one first, then by how well."""
    return sorted(
        (words for words in off if off[words] <= FITS), key=lambda words: (words != DOCUMENTED, off[words])
    )
