"""Where the edges of a mesh pass a plane."""

from __future__ import annotations

from ...spatial import Array, IntArray


def crossings(values: Array, edges: IntArray, height: Array) -> Array:
    """What the points' values come to where edges pass the plane, shape (c, w); for their places these points themselves.

    values: shape (n, w), as they change along an edge.  edges: pairs of points, shape (2, k).  height: of each point above the
    plane, shape (n,); a point on it counts as above.
    """
    above = height >= 0.0
    start, end = edges[:, above[edges[0]] != above[edges[1]]]
    share = height[start] / (height[start] - height[end])
    found: Array = values[start] + share[:, None] * (values[end] - values[start])
    return found
