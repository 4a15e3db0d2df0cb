"""Arrays as lists, or as numpy's own."""

from __future__ import annotations

import numpy as np


class _Array(list[object]):
    @staticmethod
    def FromNumpy(values: np.ndarray) -> np.ndarray:
        return values


class TokenArray(_Array): ...


class IntArray(_Array): ...


class FloatArray(_Array): ...


class Vec2fArray(_Array): ...


class Vec3fArray(_Array): ...
