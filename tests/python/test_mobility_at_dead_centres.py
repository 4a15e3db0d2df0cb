"""What a CAD program's rounding leaves of a dead centre: the count that is meant, and what stays in doubt told as that, in both languages."""

from __future__ import annotations

import json
import math

import kinefab
import numpy as np
import pytest
from dead_centres import DeadCentre
from kinefab.analysis import analyse
from test_mobility_in_both_languages import TOOL, counted, differences, hinged, needs_tool

IN_LINE = [(0, 1, (0, 0, 0)), (0, 2, (1, 0, 0)), (1, 3, (0.5, 0, 0)), (2, 3, (1.5, 0, 0))]
STRETCHED = [(0, 1, (0, 0, 0)), (1, 2, (0.5, 0, 0)), (0, 2, (1.2, 0, 0))]


@pytest.mark.parametrize("noise", [0, 1e-8, 1e-7, 1e-6])
@pytest.mark.parametrize(
    ("hinges", "mobility"), [(IN_LINE, 1), (STRETCHED, 0)], ids=["parallelogram", "two bars that stand"]
)
def test_axes_that_are_a_rounding_off_neither_lock_nor_loosen_a_dead_centre(tmp_path, hinges, mobility, noise):
    """A parallelogram in line was locked by the letter of its axes in both languages, since not all of its velocities are motions."""
    scene = hinged(noise, *hinges)
    assert analyse(scene).mobility == mobility
    if TOOL is not None:
        kinefab.export(scene, tmp_path / "scene.kinefab")
        (said,) = counted(tmp_path)
        assert (said["mobility"]["mobility"], differences(said)) == (mobility, [])


@pytest.mark.parametrize("seed", [1, 7, 9, 51, 100, 146, 148, 160, 176, 213, 242, 250])
def test_both_count_the_motions_that_are_meant(tmp_path, seed):
    """As without noise and rounding; all of them were counted apart, and most wrong in one language at least."""
    meant = analyse(DeadCentre(seed, exact=True).scene).mobility
    scene = DeadCentre(seed).scene
    assert analyse(scene).mobility == meant
    if TOOL is not None:
        kinefab.export(scene, tmp_path / "scene.kinefab")
        (said,) = counted(tmp_path)
        assert (said["mobility"]["mobility"], differences(said)) == (meant, [])


IN_DOUBT = [
    11, 26, 33, 40, 45, 48, 63, 64, 90, 92, 97, 101, 111, 133, 147, 150, 155, 197, 205, 220, 230, 245, 263, 275, 292, 346, 362, 449,
]  # fmt: skip


@needs_tool
@pytest.mark.parametrize("seed", IN_DOUBT)
def test_what_the_rounding_leaves_in_doubt_is_no_error(tmp_path, seed):
    """At a dead centre what closes a loop turns it by the root of what it was open by: another pose, where other bodies stand still and other
    rows repeat each other.  Each was told as an error."""
    kinefab.export(DeadCentre(seed).scene, tmp_path / "scene.kinefab")
    assert differences(counted(tmp_path)[0]) == []


@needs_tool
def test_a_wrong_count_of_an_exact_mechanism_is_still_an_error(tmp_path):
    kinefab.export(hinged(0, *IN_LINE), tmp_path / "scene.kinefab")
    scene = json.loads((tmp_path / "scene.kinefab").read_text())
    scene["analysis"]["mobility"] = 2
    (tmp_path / "scene.kinefab").write_text(json.dumps(scene))
    assert differences(counted(tmp_path)[0])


FLAT = {
    "a motion that curves within a trial step": ([2.03, 3.9, 0.05, 6.18, 5.17], [0.5, 1, 0.5, 0.5, 0.5], 2, (3, 1)),
    "another one": ([2.0350, 0.9480, 4.0900, 0.4547, 3.3674], [1, 1, 1, 1, 1], 3, (3, 1)),
    "of six bars": ([2.0350, 0.9480, 4.0900, 0.4547, 3.3674, 2.2980], [1, 1, 1, 1, 1, 1], 5, (4, 1)),
    "nothing but the rod's spin": ([5.4, 3.24, 0.71, 0.76, 1.94], [0.5, 1, 0.5, 1, 1], 3, (1, 0)),
    "the same, held by little": ([3.11, 3.5, 5.09, 2.01, 2.02], [0.5, 1, 1, 1, 0.5], 4, (1, 0)),
}


@pytest.mark.parametrize("which", FLAT)
def test_a_flat_spherical_linkage_with_a_rod_moves_as_its_squared_length_says(tmp_path, which):
    """Hinges whose axes meet in one point and lie in a plane, and one bar a rod between balls, which spins.  How far apart the balls are
    depends on the hinges by a quadratic form: with both signs it has zeros, along which all but one of the hinges turn; else only the spin
    is left.  With shares of 1e-3 and less Python lost a motion, and C# the spin that what is obstructed took back along."""
    turns, radii, rod, expected = FLAT[which]
    axes = [np.array([math.cos(turn), math.sin(turn), 0.0]) for turn in turns]
    scene = kinefab.Scene()
    parts = [scene.add_part(f"p{i}", grounded=i == 0, mass=1.0 if i else None) for i in range(len(turns))]
    for i, (axis, radius) in enumerate(zip(axes, radii)):
        a, b = sorted((parts[i], parts[(i + 1) % len(parts)]))
        if rod in (a, b):
            scene.add_ball(a, b, point=tuple(radius * axis))
        else:
            scene.add_hinge(a, b, point=tuple(radius * axis), axis=tuple(axis))
    found = analyse(scene)
    assert (found.mobility, sum(one.count for one in found.idle)) == expected
    if TOOL is not None:
        kinefab.export(scene, tmp_path / "scene.kinefab")
        (said,) = counted(tmp_path)
        idle = sum(one["count"] for one in said["mobility"]["idle"])
        assert (said["mobility"]["mobility"], idle, differences(said)) == (*expected, [])
