"""The motions of a machine whose mates are being found: carried along a tree of joints, held to the plain null space."""

from __future__ import annotations

import numpy as np
import pytest
from kinefab.mates.deciding import motions
from kinefab.mates.deciding.edge import Edge
from kinefab.mates.deciding.freedom import Scale, null_space
from kinefab.mates.deciding.motions import held_rows, motions_of

CHANCE = np.random.default_rng(5)


def hinge(a: int, b: int, point: np.ndarray, axis: np.ndarray, length: float = 0.02) -> Edge:
    """About a point off the scale's centre, so that its twist has a translation too."""
    center = point + CHANCE.normal(size=3) * length
    twist = np.concatenate([np.cross(axis, center - point), axis * length])
    return Edge((a, b), [], Scale(center, length), (twist / np.linalg.norm(twist))[:, None], 1.0, "as told")


def plain(members: list[int], edges: list[Edge]) -> np.ndarray:
    """What all rows on all bodies leave, the first body still."""
    rows = np.concatenate([held_rows(members, edge, edges[0].scale) for edge in edges])
    still = np.hstack([np.eye(6), np.zeros((6, rows.shape[1] - 6))])
    return null_space(np.concatenate([rows, still]))


def four_bar(first: int) -> list[Edge]:
    """Parallel axes: one motion.  Bodies first .. first + 3."""
    axis = np.array([0.0, 0.6, 0.8])
    x, y = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.8, -0.6])
    at = [0.0 * x, 0.04 * x + 0.09 * y, 0.31 * x + 0.12 * y, 0.4 * x - 0.01 * y]
    return [hinge(first + i, first + (i + 1) % 4, at[i], axis) for i in range(4)]


def chain(count: int) -> list[Edge]:
    axes = CHANCE.normal(size=(count, 3))
    return [
        hinge(i, i + 1, np.array([0.03 * i, 0.0, 0.01 * (i % 3)]), axes[i] / np.linalg.norm(axes[i]))
        for i in range(count)
    ]


CASES = {
    "a four-bar": (four_bar(0), 1),
    "an open chain": (chain(7), 7),
    "a four-bar on a chain": ([*chain(3), *four_bar(3)], 4),
    "numbers against the tree": ([Edge((b, a), [], e.scale, e.space, 1.0, "") for e in four_bar(0) for a, b in [e.pair]], 1),
    "six hinges that hold each other": (
        [hinge(i, (i + 1) % 6, 0.05 * CHANCE.normal(size=3), n / np.linalg.norm(n)) for i, n in enumerate(CHANCE.normal(size=(6, 3)))], 0,
    ),
    "two pieces": ([*four_bar(0), *four_bar(4)], 1 + 6 + 1),
    "nothing moves": ([Edge((0, 1), [], Scale(np.zeros(3), 1.0), np.zeros((6, 0)), 1.0, "")], 0),
}  # fmt: skip


@pytest.mark.parametrize("case", CASES)
def test_motions_are_those_that_all_rows_leave(case: str):
    edges, count = CASES[case]
    members = sorted({body for edge in edges for body in edge.pair})
    found, expected = motions_of(members, edges), plain(members, edges)
    assert found.shape == expected.shape == (6 * len(members), count)
    assert np.allclose(found.T @ found, np.eye(count))
    assert np.abs(found - expected @ (expected.T @ found)).max(initial=0.0) < 1e-7


def test_a_null_space_is_as_wide_as_the_freedoms_and_as_high_as_the_loops(monkeypatch: pytest.MonkeyPatch):
    """With six columns a body and the rows of every joint, 400 links took 18 s of the 21 s that their mates took."""
    asked: list[tuple[int, ...]] = []
    real = motions.null_space
    monkeypatch.setattr(motions, "null_space", lambda rows: (asked.append(rows.shape), real(rows))[1])
    edges = [*chain(60), *four_bar(60)]
    assert motions_of(list(range(64)), edges).shape == (6 * 64, 61)
    assert max(asked, key=lambda shape: shape[1]) == (5, 63)
