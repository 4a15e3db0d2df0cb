"""Convex pieces of hollow bodies, by CoACD (Wei et al. 2022, *Approximate Convex Decomposition for 3D Meshes with
Collision-Aware Concavity and Tree Search*)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from importlib import import_module
from importlib.util import find_spec
from typing import Any

import numpy as np

from ...diagnostics import Report
from ...model import Mesh, Scene
from ...spatial import Array, IntArray
from ..closure import is_closed, welded
from ..hulls import hull_of_points
from ..mass import solid_properties

SOLID = 0.9
"""Share of its convex hull from which on a body counts as convex: fillets and chamfers take less."""
MOST_BODIES = 64
"""Shapes that are decomposed: each takes seconds."""
MOST_TRIANGLES = 50_000
"""Of a body that is decomposed; a finer one takes minutes."""
MOST_PIECES = 16
CONCAVITY = 0.05
"""Of a piece, as CoACD measures it: a share of the body's size."""

SEARCH = {"mcts_iterations": 20, "mcts_nodes": 10, "mcts_max_depth": 2, "resolution": 500}
"""A short search: a ring in 10 pieces instead of 8, in a third of the time that CoACD's own settings take."""


def convex_pieces(
    scene: Scene, bodies: Iterable[tuple[int, str]], hulls: Mapping[int, Mesh], report: Report
) -> dict[int, tuple[Mesh, ...]]:
    """The pieces of each hollow mesh named in ``bodies``: pairs of a mesh and what to call its body in the report.

    What is left as its hull although it is hollow is in the report.  The same mesh gives the same pieces.
    """
    found: dict[int, tuple[Mesh, ...]] = {}
    seen: set[int] = set()
    there, done = find_spec("coacd") is not None, 0
    for index, body in bodies:
        if index in seen or index not in hulls:
            continue
        seen.add(index)
        mesh = scene.meshes[index]
        share = solid_share(mesh, hulls[index])
        if share >= SOLID:
            continue
        detail = ""
        if not there:
            detail = "the Python package coacd is not installed"
        elif len(mesh.faces) > MOST_TRIANGLES:
            detail = f"it has {len(mesh.faces)} triangles, at most {MOST_TRIANGLES} are decomposed"
        elif done >= MOST_BODIES:
            detail = f"{MOST_BODIES} other shapes were decomposed already"
        else:
            done += 1
            pieces = _decomposed(mesh)
            if len(pieces) > 1:
                found[index] = pieces
                continue
            detail = "no decomposition was found"
        told = f"collider {body}"
        report.approximated(
            told, "COLLIDER_HOLLOW_AS_HULL", body=body, share=f"{100.0 * share:.0f}", detail=detail
        )
    return found


def solid_share(mesh: Mesh, hull: Mesh) -> float:
    """Volume of a mesh as a share of its hull's; 1 where it is open, as it has none."""
    if not is_closed(welded(mesh.vertices, mesh.faces)):
        return 1.0
    volume = solid_properties(mesh.vertices, mesh.faces, 1.0).mass
    return abs(volume) / solid_properties(hull.vertices, hull.faces, 1.0).mass


def _decomposed(mesh: Mesh) -> tuple[Mesh, ...]:
    library: Any = import_module("coacd")  # it states no types
    library.set_log_level("error")
    numbers = welded(mesh.vertices, mesh.faces)
    kept, first = np.unique(numbers, return_index=True)
    vertices = mesh.vertices[mesh.faces.reshape(-1)[first]]
    faces = np.searchsorted(kept, numbers).reshape(-1, 3)
    size = float(np.ptp(vertices, axis=0).max())
    whole = library.Mesh(vertices / size, faces.astype(np.int32))
    found: list[tuple[Array, IntArray]] = library.run_coacd(
        whole, threshold=CONCAVITY, max_convex_hull=MOST_PIECES, max_ch_vertex=64, seed=1, **SEARCH
    )
    pieces: list[Mesh] = []
    for points, _ in found:
        hull = hull_of_points(np.asarray(points, dtype=np.float64) * size)
        if hull is not None:
            pieces.append(Mesh(f"{mesh.name} piece {len(pieces) + 1}", *hull))
    return tuple(pieces)
