"""What collides with what: a scene has room for it in its extras only."""

from __future__ import annotations

from collections.abc import Sequence

from ...diagnostics import Report
from ...model import Apart, Scene
from ..robots.rigid_links import Carrier
from .engine import Compiled


def excluded(compiled: Compiled) -> list[frozenset[int]]:
    """Pairs of bodies, by MuJoCo's ids, that do not collide, in its order."""
    signatures = [int(s) for s in compiled.model.exclude_signature]
    return [frozenset((s >> 16, s & 0xFFFF)) for s in signatures]


def add_excludes(
    scene: Scene,
    compiled: Compiled,
    carriers: Sequence[Carrier | None],
    joined: set[frozenset[int]],
    report: Report,
) -> None:
    """Pairs of nodes for the excludes.  carriers: where each body went.  joined: pairs of bodies that a joint keeps from colliding."""
    bodies_of: dict[int, set[int]] = {}
    for body, carrier in enumerate(carriers):
        if carrier is not None and int(compiled.model.body_geomnum[body]):
            bodies_of.setdefault(carrier.node, set()).add(body)
    for i, pair in enumerate(excluded(compiled)):
        first, second = (compiled.bodies[b] for b in (min(pair), max(pair)))
        name = compiled.name("exclude", i) or f"{first} and {second}"
        where = compiled.where("contact", name)
        if pair in joined:
            report.kept(f"contact exclude {name}", where)
            continue
        nodes = [(b, carrier.node) for b in sorted(pair) if (carrier := carriers[b]) is not None]
        whole = all(bodies_of.get(node, {body}) <= {body} for body, node in nodes)
        if len(nodes) < 2 or nodes[0][1] == nodes[1][1] or not whole:  # a part of a body cannot pass by itself
            report.dropped(f"contact exclude {name}", "MJCF_COLLISION_FILTER", where)
            continue
        scene.apart.append(Apart(nodes[0][1], nodes[1][1], f"contact exclude {name}", where))


def masks(compiled: Compiled, report: Report) -> dict[str, object]:
    """For the extras.  collisionMasks: contype and conaffinity by the groups of colliders."""
    m = compiled.model
    extras: dict[str, object] = {}
    by_name: dict[str, list[int]] = {}
    for geom in range(m.ngeom):
        kind, affinity = int(m.geom_contype[geom]), int(m.geom_conaffinity[geom])
        if (kind or affinity) and (kind, affinity) != (1, 1):
            by_name[f"contype {kind} conaffinity {affinity}"] = [kind, affinity]
    for name in by_name:
        feature = f"collision mask {name}"
        report.approximated(feature, "MJCF_COLLISION_FILTER", compiled.files.path.name)
    if by_name:
        extras["collisionMasks"] = by_name
    for i in range(m.npair):
        name = compiled.name("pair", i) or str(i)
        feature = f"contact pair {name}"
        report.approximated(feature, "MJCF_COLLISION_FILTER", compiled.where("contact", name))
    return extras
