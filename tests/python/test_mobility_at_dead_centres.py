"""What a CAD program's rounding leaves of a dead centre: the count that is meant, and what stays in doubt told as that, in both languages."""

from __future__ import annotations

import json

import kinefab
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


@needs_tool
@pytest.mark.parametrize("seed", [11, 26, 33, 40, 45, 63, 64, 90, 92, 97, 111, 133, 147, 150, 155, 197, 205, 220, 230, 245, 263, 292])
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
