"""Random poses and directions for property tests: a seed is drawn by Hypothesis, numbers that favour no axis follow from it."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st
from kinefab.spatial import Pose, rotation_exp

seeds = st.integers(0, 2**32 - 1)


def random_pose(rng: np.random.Generator, size: float = 1.0) -> Pose:
    return Pose(rotation_exp(rng.uniform(-2.0, 2.0, 3)), size * rng.uniform(-1.0, 1.0, 3))


def random_direction(rng: np.random.Generator) -> np.ndarray:
    v = rng.normal(size=3)
    return v / np.linalg.norm(v)
