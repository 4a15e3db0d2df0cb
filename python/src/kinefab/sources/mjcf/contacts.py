"""What collides with what: a scene has room for it in its extras only."""

from __future__ import annotations

from ...diagnostics import Report
from .engine import Compiled


def excluded(compiled: Compiled) -> list[frozenset[int]]:
    """Pairs of bodies, by MuJoCo's ids, that do not collide, in its order."""
    signatures = [int(s) for s in compiled.model.exclude_signature]
    return [frozenset((s >> 16, s & 0xFFFF)) for s in signatures]


def filters(compiled: Compiled, joined: set[frozenset[int]], report: Report) -> dict[str, object]:
    """joined: pairs that a joint keeps from colliding already.  ignoreCollision: pairs of bodies.  collisionMasks: contype and conaffinity by the groups of colliders."""
    m = compiled.model
    extras: dict[str, object] = {}
    pairs: list[list[str]] = []
    for i, pair in enumerate(excluded(compiled)):
        first, second = (compiled.bodies[b] for b in (min(pair), max(pair)))
        name = compiled.name("exclude", i) or f"{first} and {second}"
        where = compiled.where("contact", name)
        if pair in joined:
            report.kept(f"contact exclude {name}", where)
            continue
        report.approximated(f"contact exclude {name}", "MJCF_COLLISION_FILTER", where)
        pairs.append([first, second])
    if pairs:
        extras["ignoreCollision"] = pairs
    masks: dict[str, list[int]] = {}
    for geom in range(m.ngeom):
        kind, affinity = int(m.geom_contype[geom]), int(m.geom_conaffinity[geom])
        if (kind or affinity) and (kind, affinity) != (1, 1):
            masks[f"contype {kind} conaffinity {affinity}"] = [kind, affinity]
    for name in masks:
        feature = f"collision mask {name}"
        report.approximated(feature, "MJCF_COLLISION_FILTER", compiled.files.path.name)
    if masks:
        extras["collisionMasks"] = masks
    for i in range(m.npair):
        name = compiled.name("pair", i) or str(i)
        feature = f"contact pair {name}"
        report.approximated(feature, "MJCF_COLLISION_FILTER", compiled.where("contact", name))
    return extras
