"""The null space of a large block by its tree's motions is that of its dense Jacobian."""

from __future__ import annotations

import kinefab
import numpy as np
import pytest
from kinefab.analysis import analyse
from kinefab.analysis.equations.solve import Solver
from kinefab.analysis.freedom.first_order import large_null_space, tree_motions
from kinefab.analysis.freedom.inverse import few_velocities
from kinefab.analysis.freedom.rank import factored, normalised
from kinefab.spatial import skew
from linkages import flat_ladder, ring
from mechanism_cases import scene
from scipy.sparse import csr_matrix
from test_analysis_cost import pins

CASES = {
    "four-bar": lambda: scene("M01"),
    "parallelogram at its change point": lambda: scene("M05"),
    "Bennett": lambda: scene("M12"),
    "Stewart platform": lambda: scene("M14"),
    "Delta": lambda: scene("M18"),
    "two planetary stages": lambda: scene("M43"),
    "40 four-bars": lambda: scene("M40"),
    "wobble plate": lambda: scene("M47"),
    "ladder in one line": lambda: flat_ladder(6),
    "ring": lambda: ring(pins(50), [f"bar{i}" for i in range(50)]),
}


@pytest.mark.parametrize("case", CASES)
def test_rank_and_null_space_are_those_of_the_dense_jacobian(case):
    """Also where the rank is a matter of the gap between singular values."""
    whole = analyse(CASES[case]()).assembly.solver
    assert whole.parts
    for part in range(whole.parts):
        system = whole.alone(part)
        solver, start = Solver(system), system.start()
        (group,) = solver.groups
        _, at_a, at_b = system.linearise(start)
        jacobian = solver.sparse_jacobian(group, at_a, at_b)
        sizes = solver.sizes(at_a, at_b)
        rank, basis, _ = large_null_space(system, start, group.bodies[0], group.atoms, jacobian, sizes)
        ranks, _, vt = factored(normalised(jacobian.toarray(), sizes)[None])
        assert rank == ranks[0]
        assert np.abs(basis.T @ basis - np.eye(basis.shape[1])).max(initial=0.0) < 1e-12
        assert np.linalg.norm(vt[0, :rank] @ basis) < 1e-6


def grid(cells: int, noise: float = 0.0) -> kinefab.Scene:
    """Closed cells of plates hinged at the middles of their sides, axes off by about ``noise``."""
    draw, scene = np.random.default_rng(2), kinefab.Scene()
    plates = [
        [scene.add_part(f"{x} {y}", mass=1.0, translation=(x, y, 0), grounded=x + y == 0) for x in range(cells + 1)]
        for y in range(cells + 1)
    ]
    for y, row in enumerate(plates):
        for x, plate in enumerate(row):
            for other, point in ((row[x - 1], (x - 0.5, y, 0)), (plates[y - 1][x], (x, y - 0.5, 0))):
                if (x if point[1] == y else y) > 0:
                    axis = np.array([0.0, 0.0, 1.0]) + noise * draw.standard_normal(3)
                    scene.add_hinge(other, plate, point=point, axis=tuple(axis))
    return scene


@pytest.mark.parametrize("case", [*CASES, "grid", "grid with axes off"])
def test_inverse_iteration_finds_the_same_velocities(case):
    """Up to the noise of rows that do not quite repeat each other."""
    made = CASES.get(case, lambda: grid(5, 1e-6 if "off" in case else 0.0))()
    for part, known in enumerate((found := analyse(made).assembly).freedoms):
        system = found.solver.alone(part)
        solver = Solver(system)
        (group,) = solver.groups
        _, at_a, at_b = system.linearise(system.start())
        jacobian = normalised(solver.sparse_jacobian(group, at_a, at_b).toarray(), solver.sizes(at_a, at_b))
        told = few_velocities(csr_matrix(jacobian))
        assert told is not None
        rank, basis, gap = told
        assert (rank, gap >= 1e10) == (known.rank, known.gap >= 1e10)
        assert np.abs(basis.T @ basis - np.eye(basis.shape[1])).max(initial=0.0) < 1e-12
        assert np.linalg.norm(known.basis - basis @ (basis.T @ known.basis)) < max(1e-7, known.noise)


def test_more_velocities_than_are_worth_it_are_left_to_the_tree():
    assert few_velocities(csr_matrix(np.eye(40, 300))) is None


@pytest.mark.parametrize("seed", range(3))
def test_motions_of_a_tree_are_orthonormal_and_those_of_its_joints(seed):
    """A tree of 400 bodies with joints of one to three freedoms."""
    draw = np.random.default_rng(seed)
    point = draw.standard_normal((400, 3))
    tree = [
        (int(draw.integers(max(0, i - 3), i)) if i else -1, i,
         np.linalg.qr(draw.standard_normal((6, int(draw.integers(1, 4)))))[0])
        for i in range(400)
    ]  # fmt: skip
    found = tree_motions(tree, point)
    assert np.abs(found.T @ found - np.eye(found.shape[1])).max() < 1e-11
    twists = found.reshape(400, 6, -1)
    for parent, body, free in tree:
        own = twists[body].copy()
        if parent >= 0:
            own -= twists[parent]
            own[:3] += skew(point[body] - point[parent]) @ twists[parent, 3:]
        assert np.abs(own - free @ (free.T @ own)).max() < 1e-11


@pytest.mark.parametrize("count", [31, 60])
@pytest.mark.parametrize("axis", [(0, 0, 1), (1, 2, 3)])
def test_a_large_ring_of_hinges_on_one_axis_turns_in_all_of_them(count, axis):
    """Its loop repeats rows of the tree alone, and the largest of its singular values is a rounding."""
    rings = kinefab.Scene()
    rings.add_part("base", grounded=True)
    for i in range(count):
        rings.add_part(f"ring{i}", mass=1.0, translation=(0.1 * i, -0.2, 0.3))
    for i in range(count + 1):
        at = 0.3 * np.sin(i) * np.array(axis) + (0.3, -7.0, 5.0)
        rings.add_hinge(i, (i + 1) % (count + 1), point=tuple(at), axis=axis)
    found = analyse(rings)
    assert (found.mobility, found.first_order) == (count, count)
