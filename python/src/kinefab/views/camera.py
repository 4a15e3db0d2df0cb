"""An orthographic camera that looks at a scene so that its mechanism lies open."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..spatial import Array


@dataclass(frozen=True, slots=True, eq=False)
class View:
    """right, up, toward: unit vectors in the world; scale: pixels a metre; center: in the middle of the picture.

    width, height: of the picture, pixels.
    """

    right: Array
    up: Array
    toward: Array
    scale: float
    center: Array
    width: int
    height: int

    def project(self, points: Array) -> Array:
        """World points, shape (n, 3), to pixels, shape (n, 2), y downwards."""
        flat = (points - self.center) @ np.column_stack([self.right, -self.up]) * self.scale
        return flat + np.array([self.width / 2, self.height / 2])


def looking(cloud: Array, axes: Array, width: int, height: int, margin: int) -> View:
    """Mostly along the direction that most axes share, shape (n, 3), tilted; all of the cloud, shape (m, 3), inside the margin.

    Left-handed, as a scene file is.
    """
    main = np.linalg.svd(axes)[2][0] if len(axes) else np.array([0.2, 0.4, -1.0]) / np.sqrt(1.2)
    if main @ np.array([0.3, 1.0, -0.6]) < 0:
        main = -main
    lift = np.array([0.0, 1.0, 0.0]) if abs(main[1]) < 0.9 else np.array([0.0, 0.0, -1.0])
    lift = lift - main * (main @ lift)
    lift /= np.linalg.norm(lift)
    toward = main + 0.62 * lift + 0.45 * np.cross(main, lift)
    toward /= np.linalg.norm(toward)
    up = np.array([0.0, 1.0, 0.0]) - toward * toward[1]
    up /= np.linalg.norm(up)
    right = np.cross(up, -toward)  # left-handed: right = up x forward
    flat = cloud @ np.column_stack([right, up])
    low, high = flat.min(axis=0), flat.max(axis=0)
    span = np.maximum(high - low, 1e-9)
    scale = float(min((width - 2 * margin) / span[0], (height - 2 * margin) / span[1]))
    middle = (low + high) / 2
    return View(right, up, toward, scale, right * middle[0] + up * middle[1], width, height)
