"""Constraints that are built together have the equations that each has by itself, in the source's order."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from kinefab.analysis.equations.scene_equations import equations_of
from kinefab.diagnostics import Report
from kinefab.model import Constraint, Scene
from kinefab.model import ConstraintKind as C
from kinefab.model import FeatureKind as F
from test_analysis_constraints import ROWS, case, geometry, random_pose, scene_with, shifted

FIELDS = ("kind", "weight", "p_a", "a", "k", "p_b", "b", "d", "is_length")


def drawn(seed: int, count: int) -> list[Scene]:
    """Two parts and a constraint each, of all pairings in turn, some with a value."""
    rng = np.random.default_rng(seed)
    scenes: list[Scene] = []
    for i in range(count):
        row = ROWS[int(rng.integers(len(ROWS)))]
        if i % 5 == 0:
            f = random_pose(rng)
            planes = geometry(F.PLANE, f), geometry(F.PLANE, shifted(f, 0.0, 0.0, 0.3))
            scenes.append(scene_with(C.DISTANCE, *planes, {"value": float(rng.uniform(-1, 1))}, rng))
        else:
            scenes.append(scene_with(*case((row["elemA"], row["elemB"]), row["relation"], rng), rng))
    return scenes


def together(scenes: list[Scene]) -> Scene:
    nodes, constraints = [], []
    for i, scene in enumerate(scenes):
        first = len(nodes)
        nodes += [replace(n, id=f"{i}:{n.id}") for n in scene.nodes]
        for c in scene.constraints:
            features = tuple(
                replace(f, node=f.node if f.node is None else f.node + first) for f in c.features
            )
            constraints.append(replace(c, id=f"c{i}", features=features))
    return Scene(nodes=nodes, constraints=constraints)


@pytest.mark.parametrize("seed", range(4))
def test_a_stack_has_the_equations_of_each(seed):
    scenes = drawn(seed, 60)
    whole = equations_of(together(scenes), Report()).system
    alone = [equations_of(scene, Report()).system for scene in scenes]
    assert whole.owner.tolist() == [i for i, own in enumerate(alone) for _ in range(own.rows)]
    assert np.all(np.diff(whole.row) >= 0)
    for name in FIELDS:
        singly = np.concatenate([getattr(own, name) for own in alone])
        assert getattr(whole, name) == pytest.approx(singly, abs=1e-14), name
    bodies = np.cumsum([0, *(len(s.nodes) for s in scenes)])
    for end in ("body_a", "body_b"):
        singly = [np.where(getattr(own, end), getattr(own, end) + at, 0) for own, at in zip(alone, bodies)]
        assert getattr(whole, end).tolist() == np.concatenate(singly).tolist()


def test_what_has_no_equations_is_told_in_the_sources_order():
    """Of stacks and of single constraints alike; the others keep theirs."""
    rng = np.random.default_rng(3)
    f = random_pose(rng)
    point, line = geometry(F.POINT, f), geometry(F.LINE, f)

    def of(kind: C, a, b) -> Scene:
        return scene_with(kind, a, b, {}, rng)

    scenes = [
        of(C.PARALLEL, point, line), of(C.COINCIDENT, line, line), of(C.GEAR, point, line),
        of(C.UNIVERSAL, point, line), of(C.PARALLEL, line, point), of(C.COINCIDENT, line, line),
    ]  # fmt: skip
    report = Report()
    equations = equations_of(together(scenes), report)
    assert [o.feature for o in report.outcomes] == [f"constraint c{i}" for i in (0, 2, 3, 4)]
    assert equations.system.owner.tolist() == [1] * 4 + [5] * 4
    assert all(isinstance(s, Constraint) for s in equations.statements)
