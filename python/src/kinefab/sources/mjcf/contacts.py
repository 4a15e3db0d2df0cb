"""What collides with what: excludes, stated pairs, the masks of geoms, and the filter of parents."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ...diagnostics import Report
from ...model import Apart, Colliding, Joint, Scene
from ...rigid import rigid_groups
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


def add_pairs(
    scene: Scene, compiled: Compiled, carriers: Sequence[Carrier | None], report: Report
) -> None:
    """Pairs of nodes that collide whatever else is said: MuJoCo asks neither masks, excludes nor joints about a pair that is stated."""
    m = compiled.model
    for i in range(m.npair):
        geoms = int(m.pair_geom1[i]), int(m.pair_geom2[i])
        names = [compiled.name("geom", geom) or str(geom) for geom in geoms]
        name = compiled.name("pair", i) or " and ".join(names)
        feature, where = f"contact pair {name}", compiled.where("contact", name)
        bodies = [carriers[int(m.geom_bodyid[geom])] for geom in geoms]
        nodes = [carrier.node for carrier in bodies if carrier is not None]
        if len(nodes) < 2 or nodes[0] == nodes[1]:
            report.dropped(feature, "MJCF_COLLISION_FILTER", where)
            continue
        scene.colliding.append(Colliding(nodes[0], nodes[1], feature, where))
        both = frozenset(nodes)
        scene.apart = [pair for pair in scene.apart if frozenset((pair.a, pair.b)) != both]
        scene.joints = [
            replace(joint, collide=True) if frozenset((joint.a, joint.b)) == both else joint
            for joint in scene.joints
        ]
        if all(len(scene.nodes[node].colliders or ()) == 1 for node in nodes):
            report.kept(feature, where)
        else:  # whole bodies collide here
            report.approximated(feature, "MJCF_COLLISION_FILTER", where)


def with_parents_met(
    scene: Scene, compiled: Compiled, carriers: Sequence[Carrier | None]
) -> list[Joint]:
    """The joints, of which those collide whose bodies MuJoCo lets collide: what is joined to the world does with what is part of it,
    and all do where the filter of parents is switched off; none of an excluded pair does."""
    flags = compiled.mujoco.mjtDisableBit
    all_meet = bool(int(compiled.model.opt.disableflags) & int(flags.mjDSBL_FILTERPARENT))
    groups = rigid_groups(scene)
    apart: set[frozenset[int | None]] = set()
    for pair in excluded(compiled):
        own = [None if (carrier := carriers[body]) is None else carrier.node for body in pair]
        apart.add(frozenset(own))

    def meets(joint: Joint) -> bool:
        to_world = groups.is_ground(joint.a) or groups.is_ground(joint.b)
        return (all_meet or to_world) and frozenset((joint.a, joint.b)) not in apart

    return [replace(joint, collide=True) if meets(joint) else joint for joint in scene.joints]


def masks(compiled: Compiled) -> dict[str, object]:
    """For the extras.  collisionMasks: contype and conaffinity by the groups of colliders."""
    m = compiled.model
    by_name: dict[str, list[int]] = {}
    paired = {int(geom) for geom in (*m.pair_geom1, *m.pair_geom2)}
    for geom in range(m.ngeom):
        kind, affinity = int(m.geom_contype[geom]), int(m.geom_conaffinity[geom])
        touches = kind or affinity or geom in paired
        if touches and (kind, affinity) != (1, 1):
            by_name[f"contype {kind} conaffinity {affinity}"] = [kind, affinity]
    return {"collisionMasks": by_name} if by_name else {}
