"""Convex pieces of hollow bodies: cut by planes, or by CoACD where that is installed and the cuts are not possible
(Wei et al. 2022, *Approximate Convex Decomposition for 3D Meshes with Collision-Aware Concavity and Tree Search*)."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from importlib import import_module
from importlib.util import find_spec
from typing import Any

import numpy as np

from ...diagnostics import Report, named as names_of
from ...model import Mesh, Scene
from ...spatial import Array, IntArray
from ..closure import is_skin, welded
from ..hulls import hull_of_points, within_unity
from ..mass import solid_volume
from .cuts import nearly_convex_parts

SOLID = 0.9
"""Share of its convex hull from which on a body counts as convex: fillets and chamfers take less."""
MOST_BODIES = 32
"""Shapes that are decomposed, those near others first: each takes a tenth of a second, or seconds by CoACD."""
MOST_FREE = 8
"""Of them such as stand free: nothing that they collide with is near the hulls of any of their bodies."""
MOST_TRIANGLES = 50_000
"""Of a body that is decomposed; a finer one takes minutes."""
MOST_PIECES = 16
CONCAVITY = 0.05
"""Of a piece, as CoACD measures it: a share of the body's size."""

SEARCH = {"mcts_iterations": 20, "mcts_nodes": 10, "mcts_max_depth": 2, "resolution": 500}
"""A short search: a ring in 10 pieces instead of 8, in a third of the time that CoACD's own settings take."""


def convex_pieces(
    scene: Scene,
    bodies: Iterable[tuple[int, str]],
    hulls: Mapping[int, Mesh],
    near: Collection[int],
    report: Report,
) -> dict[int, tuple[Mesh, ...]]:
    """The pieces of each hollow mesh named in ``bodies``: pairs of a mesh and what to call its body in the report.

    near: meshes that come first, as something may stand in their hollows.
    What is left as its hull although it is hollow is in the report.  The same mesh gives the same pieces.
    """
    named = {index: body for index, body in reversed(list(bodies)) if index in hulls}
    hollow = {
        index: (named[index], share)
        for index in reversed(named)
        if (share := solid_share(scene.meshes[index], hulls[index])) < SOLID
    }
    possible = [i for i in hollow if len(scene.meshes[i].faces) <= MOST_TRIANGLES]
    wanted = [i for i in possible if i in near][:MOST_BODIES]
    free = [i for i in possible if i not in near][: min(MOST_FREE, MOST_BODIES - len(wanted))]
    found: dict[int, tuple[Mesh, ...]] = {}
    if not _libraries():
        left = [body for body, _ in hollow.values()]
        if left:
            features = [f"collider {body}" for body in left]
            told = {"count": len(left), "bodies": names_of(left)}
            report.approximated_alike(features, "COLLIDERS_NOT_CUT", **told)
        return found
    for index, (body, share) in hollow.items():
        mesh = scene.meshes[index]
        if len(mesh.faces) > MOST_TRIANGLES:
            detail = f"it has {len(mesh.faces)} triangles, at most {MOST_TRIANGLES} are decomposed"
        elif index in wanted or index in free:
            pieces = _decomposed(mesh)
            if len(pieces) > 1:
                found[index] = pieces
                continue
            detail = "no decomposition was found"
        elif index in near:
            detail = f"{len(wanted)} other shapes were decomposed"
        else:
            detail = f"nothing that it may collide with is near, and {len(wanted) + len(free)} other shapes were decomposed"
        told = f"collider {body}"
        report.approximated(
            told, "COLLIDER_HOLLOW_AS_HULL", body=body, share=f"{100.0 * share:.0f}", detail=detail
        )
    return found


def solid_share(mesh: Mesh, hull: Mesh) -> float:
    """Volume of a mesh as a share of its hull's; 1 where it is open, as it has none."""
    volume = abs(solid_volume(mesh.vertices, mesh.faces)) if mesh.volume is None else mesh.volume
    share = volume / solid_volume(hull.vertices, hull.faces)
    closed = share >= SOLID or mesh.volume is not None or is_skin(mesh.vertices, mesh.faces)
    return share if closed else 1.0


def _libraries() -> list[str]:
    return [name for name in ("manifold3d", "coacd") if find_spec(name) is not None]


def _decomposed(mesh: Mesh) -> tuple[Mesh, ...]:
    numbers = welded(mesh.vertices, mesh.faces)
    kept, first = np.unique(numbers, return_index=True)
    # In the 32 bits that files have them in: the search hangs on the last digit, and a mesh read back is to be cut alike.
    vertices = mesh.vertices[mesh.faces.reshape(-1)[first]].astype(np.float32).astype(np.float64)
    faces = np.searchsorted(kept, numbers).reshape(-1, 3)
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]  # not those that welding made a line
    if not len(faces):
        return ()
    size = float(np.ptp(vertices, axis=0).max())
    middle = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    scaled = (vertices - middle) / size
    there = _libraries()
    parts = nearly_convex_parts(scaled, faces, MOST_PIECES) if "manifold3d" in there else []
    if not parts and "coacd" in there:
        parts = _by_coacd(scaled, faces)
    pieces: list[Mesh] = []
    for points in parts:
        hull = hull_of_points(points * size + middle, fast=True)
        if hull is not None:
            which = f"piece {len(pieces) + 1}"
            origin = mesh.origin and f"{mesh.origin} {which}"
            pieces.append(Mesh(f"{mesh.name} {which}", *within_unity(hull)[0], origin=origin))
    return tuple(pieces)


def _by_coacd(vertices: Array, faces: IntArray) -> list[Array]:
    library: Any = import_module("coacd")  # it states no types
    library.set_log_level("error")
    whole = library.Mesh(vertices, faces.astype(np.int32))
    found: list[tuple[Array, IntArray]] = library.run_coacd(
        whole, threshold=CONCAVITY, max_convex_hull=MOST_PIECES, max_ch_vertex=64, seed=1, **SEARCH
    )
    return [np.asarray(points, dtype=np.float64) for points, _ in found]
