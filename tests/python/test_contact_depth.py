"""How deep shapes overlap, also those that are flat, far or no shapes at all."""

from __future__ import annotations

import numpy as np
import pytest
from kinefab.geometry.primitives import box

pytest.importorskip("coal", reason="coal is not installed")
from kinefab.geometry.contact.depth import Depths, Solid  # noqa: E402


def placed(size, at=(0.0, 0.0, 0.0)) -> Solid:
    made = box(size)
    return Solid(made.vertices + np.array(at), made.faces)


def test_boxes_that_overlap_by_a_tenth():
    assert Depths().between(
        placed((1.0, 2.0, 3.0)), placed((1.0, 2.0, 3.0), (0.9, 0.0, 0.0))
    ) == pytest.approx(0.1)


@pytest.mark.parametrize(
    "size", [(1.0, 1.0, 0.0), (1.0, 1.0, 1e-13), (1.0, 0.0, 0.0), (0.0, 0.0, 0.0), (1e-320,) * 3]
)
def test_a_flat_shape_ends_no_process(size):
    """Convex hulls of plates, needles and points: qhull would end the whole process."""
    assert Depths().between(placed(size), placed((1.0, 1.0, 1.0), (0.2, 0.3, 0.4))) >= 0.0


@pytest.mark.parametrize("at", [np.nan, np.inf, 1e17, 1e300])
def test_a_shape_that_is_nowhere_overlaps_nothing(at):
    assert Depths().between(placed((1.0, 1.0, 1.0), (at, 0.0, 0.0)), placed((1.0, 1.0, 1.0))) == 0.0
