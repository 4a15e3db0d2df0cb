"""The components of a whole mechanism together: what its tree and its closing joints allow.

Positions come from the components alone (``unity_d6``): the tree's coordinates are changed until the closing
joints are met again.  The constraints that the mechanism was exported from are only asked afterwards.
"""

from __future__ import annotations

import numpy as np
import pytest
import unity_d6
from exported_components import components, constraint_residual, unity_pose
from kinefab.analysis import AnalysisOptions, Closures, analyse
from mechanism_cases import scene, scene_written

EXACT = 1e-9
MET = 1e-12
STEPS = 72


class Assembled:
    """Exported components of one mechanism; its poses are functions of the tree's free coordinates."""

    def __init__(self, found):
        self.scene, parts = components(found)
        closing = [found.findings[j.id].closure for j in found.joints]
        self.closures = [p for p, c in zip(parts, closing) if c]
        self.tree = self._outwards([p for p, c in zip(parts, closing) if not c])
        self.free = [(k, i) for k, p in enumerate(self.tree) for i in range(6) if unity_d6.freedoms(p[2])[i]]

    @staticmethod
    def _outwards(parts):
        reached, order = {None}, []
        while len(order) < len(parts):
            part = next(p for p in parts if p not in order and (p[0] in reached) != (p[1] in reached))
            reached.update(part[:2])
            order.append(part)
        return order

    def displacements(self, q):
        """Left-handed displacement of every body at the free coordinates ``q``."""
        values = np.zeros((len(self.tree), 6))
        for (part, i), value in zip(self.free, q):
            values[part, i] = value
        moved = {None: (np.eye(3), np.zeros(3))}
        for (own, connected, component), coordinates in zip(self.tree, values):
            poses = unity_pose(self.scene, own), unity_pose(self.scene, connected)
            r, t = unity_d6.moved_by(component, *poses, coordinates)
            if connected in moved:
                r0, t0 = moved[connected]
                moved[own] = r0 @ r, r0 @ t + t0
            else:  # the connected body moves the other way
                r0, t0 = moved[own]
                moved[connected] = r0 @ r.T, t0 - r0 @ r.T @ t
        return moved

    def open_by(self, q):
        """What the closing components forbid of the pose at ``q``."""
        moved = self.displacements(q)
        return np.concatenate(
            [
                unity_d6.broken(
                    component,
                    unity_pose(self.scene, own),
                    unity_pose(self.scene, connected),
                    moved[own],
                    moved[connected],
                )
                for own, connected, component in self.closures
            ]
        )

    def slope(self, q, step=1e-6):
        unit = step * np.eye(len(q))
        return np.column_stack([(self.open_by(q + e) - self.open_by(q - e)) / (2 * step) for e in unit])

    def closed(self, q, held):
        """The nearest coordinates that meet every closing joint while coordinate ``held`` keeps its value."""
        others = np.arange(len(q)) != held
        for _ in range(30):
            left = self.open_by(q)
            if np.abs(left).max() < MET:
                return q
            q = q.copy()
            q[others] -= np.linalg.lstsq(self.slope(q)[:, others], left, rcond=1e-8)[0]
        raise AssertionError("the closing joints cannot be met")


def constraints_of(found, moved):
    right_handed = {node: unity_d6.mirrored(*by) for node, by in moved.items()}
    return constraint_residual(found, right_handed)


@pytest.mark.parametrize("closures", [Closures.MINIMAL, Closures.EXACT])
@pytest.mark.parametrize("up", ["Y", "Z"])
@pytest.mark.parametrize("id", ["M01", "M07", "M09", "M10", "M12", "M21"])
def test_driven_components_keep_every_constraint(id, up, closures):
    """The crank's component is turned once round: tree and closing joints together keep all constraints."""
    source = scene(id) if up == "Y" else scene_written(id, up)
    found = analyse(source, AnalysisOptions(closures=closures))
    assembled = Assembled(found)
    assert len(assembled.closures) == 1
    crank = next(n for n, (k, i) in enumerate(assembled.free) if i == 3 and None in assembled.tree[k][:2])
    q = np.zeros(len(assembled.free))
    for step in range(1, STEPS + 1):
        q = q.copy()
        q[crank] = 2.0 * np.pi * step / STEPS
        q = assembled.closed(q, crank)
        assert constraints_of(found, assembled.displacements(q)) < EXACT
        if step % 12 == 0:
            rank = np.linalg.matrix_rank(assembled.slope(q), tol=1e-6)
            assert len(q) - rank == found.mobility
