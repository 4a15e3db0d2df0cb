"""Hypothesis strategies for poses and directions, and numbers that favour no axis."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from kinefab.spatial import Pose, rotation_exp

angles = st.floats(-3.0, 3.0, allow_nan=False)
lengths = st.floats(-2.0, 2.0, allow_nan=False)
seeds = st.integers(0, 2**32 - 1)


@st.composite
def poses(draw) -> Pose:
    """Any rigid pose within a few metres."""
    w = np.array([draw(angles) for _ in range(3)])
    return Pose(rotation_exp(w), np.array([draw(lengths) for _ in range(3)]))


def random_pose(rng: np.random.Generator, size: float = 1.0) -> Pose:
    return Pose(rotation_exp(rng.uniform(-2.0, 2.0, 3)), size * rng.uniform(-1.0, 1.0, 3))
