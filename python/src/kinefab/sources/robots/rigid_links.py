"""Links of a robot as nodes of a scene: those that fixed joints hold together are one node, their names its sites."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ...diagnostics import Report
from ...geometry.mass import STAND_IN_DENSITY, ball_inertia, combined
from ...model import Body, Collider, MassProperties, Node, NodeKind, PhysicsMaterial, Scene, Site
from ...partition import Partition
from ...spatial import Pose
from .inertial import Inertial, weighed_together
from .robot_frame import placed
from .shapes import Shape, Shapes

STAND_IN_SHARE = 0.1
"""Mass of a link that has none against the lightest that it is joined to; what solvers of joints take well."""
STAND_IN_RADIUS = 0.05
"""Metres: its inertia is that of a ball of this radius."""


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """A shape of a link.  pose: in the link's frame, source axes.  surfaces: of one that is drawn.
    material, group: of one that is touched; density: kg/m^3, where its link weighs what it does.
    counted: the source has no name for it."""

    name: str
    shape: Shape
    pose: Pose
    surfaces: tuple[int, ...] = ()
    material: PhysicsMaterial | None = None
    group: str = ""
    density: float = STAND_IN_DENSITY
    counted: bool = False


@dataclass(slots=True, eq=False)
class Solid:
    """A link that weighs what its touched shapes do.  mass: kg, of all of them; None where their densities count."""

    mass: float | None = None


@dataclass(slots=True, eq=False)
class Link:
    """pose: in the world at the exported pose, source axes.  id: unique path.  parent: index of its assembly's node.
    frames: further named frames, in the link's own.  solid: of one without ``inertial`` that leaves it to its shapes.
    extras: kept with the node.  helps: of a link that no source has the index of the one that it helps, as ``Node.helps``."""

    id: str
    name: str
    pose: Pose
    where: str
    inertial: Inertial | None = None
    drawn: list[Part] = field(default_factory=list[Part])
    touched: list[Part] = field(default_factory=list[Part])
    grounded: bool = False
    parent: int | None = None
    frames: dict[str, Pose] = field(default_factory=dict[str, Pose])
    gravity: bool = True
    kinematic: bool = False
    solid: Solid | None = None
    extras: dict[str, object] = field(default_factory=dict[str, object])
    helps: int | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Carrier:
    """Which node moves a link, and the link's frame in that node's, turned into the scene."""

    node: int
    pose: Pose


def add_links(
    scene: Scene,
    links: Sequence[Link],
    fixed: Iterable[tuple[int, int]],
    joined: Iterable[tuple[int, int]],
    report: Report,
) -> list[Carrier]:
    """Add a node for each rigid group of links, the first of them its carrier; where each link went.

    fixed, joined: pairs of indices of links that fixed joints, and that other joints connect.
    """
    groups = _groups(len(links), fixed)
    neighbours: dict[int, set[int]] = {}
    for a, b in joined:
        first, second = groups[a], groups[b]
        neighbours.setdefault(first, set()).add(second)
        neighbours.setdefault(second, set()).add(first)
    members: dict[int, list[int]] = {}
    for index, group in enumerate(groups):
        members.setdefault(group, []).append(index)
    shapes = Shapes(scene.meshes, report)
    first_node = len(scene.nodes)
    carriers: list[Carrier | None] = [None] * len(links)
    light: list[int] = []
    for group, indices in members.items():
        own = links[group]
        inside = [own.pose.inverse() @ links[i].pose for i in indices]
        for i, pose in zip(indices, inside):
            carriers[i] = Carrier(len(scene.nodes), placed(pose))
        together = [links[i] for i in indices]
        node = _node(own, together, inside, shapes, report)
        if own.helps is None and node.mass is None and not node.grounded and not any(body.weighed for body in node.bodies):
            light.append(len(scene.nodes))
        scene.nodes.append(node)
        scene.counted |= _counted(own, together, node)
    node_of = {group: first_node + i for i, group in enumerate(members)}
    group_of = {node: group for group, node in node_of.items()}
    for group, node in node_of.items():
        helped = links[group].helps
        if helped is not None:
            scene.nodes[node] = replace(scene.nodes[node], helps=node_of[groups[helped]])
    beside = {node: [node_of[g] for g in neighbours.get(group, ())] for node, group in group_of.items()}
    for index, mass in _nearest_masses(scene, light, beside).items():
        _stand_in(scene, index, mass, report)
    return [carrier for carrier in carriers if carrier is not None]


def _counted(own: Link, together: Sequence[Link], node: Node) -> set[str]:
    """Ids of the shapes that have no name: see ``Scene.counted``."""
    found: set[str] = set()
    for link in together:
        prefix = "" if link is own else f"{link.name}/"
        for kind, parts in (("body", link.drawn), ("collider", link.touched)):
            found |= {f"{node.id}/{kind}:{prefix}{part.name}" for part in parts if part.counted}
    return found


def _groups(count: int, fixed: Iterable[tuple[int, int]]) -> list[int]:
    """For each link the first of those that it is fixed to."""
    together = Partition(count)
    for a, b in fixed:
        together.join(a, b)
    return [together.find(i) for i in range(count)]


def _models_between(own: Link, link: Link) -> str:
    """Names of the models that a carried link lies in and its carrier does not, with an ending stroke, so that two of one
    name stay apart; "" in one model."""
    outer, inner = (each.id.removesuffix(f"/{each.name}").split("/") for each in (own, link))
    shared = next((i for i, (a, b) in enumerate(zip(outer, inner)) if a != b), min(len(outer), len(inner)))
    return "".join(f"{name}/" for name in inner[shared:])


def _node(
    own: Link, together: Sequence[Link], inside: Sequence[Pose], shapes: Shapes, report: Report
) -> Node:
    inertials = [(link.inertial, pose) for link, pose in zip(together, inside) if link.inertial is not None]
    mass = weighed_together(inertials, own.name, own.where, report)
    grounded = any(link.grounded for link in together)
    weighed = False
    known = [*([] if mass is None else [mass]), *_of_solids(together, inside, shapes, report)]
    mass = combined(known) if known else None
    if mass is None and not grounded:
        mass = _of_touched(together, inside, shapes)
        weighed = mass is None and any(link.drawn for link in together)
        if mass is not None or weighed:
            report.approximated(f"mass {own.name}", "MASS_FROM_GEOMETRY", own.where, link=own.name)
    bodies: list[Body] = []
    colliders: list[Collider] = []
    sites: list[Site] = []
    for link, pose in zip(together, inside):
        prefix = "" if link is own else f"{link.name}/"
        density = None if link.solid is None or not link.touched else link.touched[0].density
        inside_of = _models_between(own, link)
        if link is not own:
            sites.append(Site(f"{inside_of}{link.name}", placed(pose), link.where))
        sites += [
            Site(f"{inside_of}{name}", placed(pose @ frame), link.where)
            for name, frame in link.frames.items()
        ]
        for part in link.drawn:
            body = shapes.body(prefix + part.name, part.shape, pose @ part.pose, part.surfaces, weighed)
            bodies.append(body if density is None else replace(body, density=density))
        for part in link.touched:
            at = pose @ part.pose
            colliders.append(shapes.collider(prefix + part.name, part.shape, at, part.material, part.group))
    extras: dict[str, object] = {}
    for link in together:
        extras |= {key: value for key, value in link.extras.items() if key not in extras}
    node = Node(
        own.id,
        own.name,
        NodeKind.PART,
        own.parent,
        placed(own.pose),
        bodies=tuple(bodies),
        mass=mass,
        grounded=grounded,
        colliders=tuple(colliders),
        sites=tuple(sites),
        where=own.where,
        extras=extras,
    )
    dynamics = replace(node.dynamics, gravity=own.gravity, kinematic=own.kinematic)
    return replace(node, dynamics=dynamics)


def _of_touched(together: Sequence[Link], inside: Sequence[Pose], shapes: Shapes) -> MassProperties | None:
    """Of the shapes that are touched; None where there are none, or one has no volume that is known yet."""
    found: list[MassProperties] = []
    for link, pose in zip(together, inside):
        for part in link.touched:
            if (solid := shapes.solid(part.shape, pose @ part.pose)) is None:
                return None
            found.append(_times(solid, part.density))
    return combined(found) if found else None


def _of_solids(
    together: Sequence[Link], inside: Sequence[Pose], shapes: Shapes, report: Report
) -> list[MassProperties]:
    """Of the links that leave their mass to their shapes."""
    found: list[MassProperties] = []
    for link, pose in zip(together, inside):
        if link.solid is None:
            continue
        whole, stated = _of_touched([link], [pose], shapes), link.solid.mass
        if whole is not None and whole.mass > 0.0:
            found.append(whole if stated is None else _times(whole, stated / whole.mass))
            report.kept(f"mass {link.name}", link.where)
        elif stated is not None:
            report.dropped(f"inertia of the meshes of {link.name}", "ELEMENT_DROPPED", link.where)
            found.append(MassProperties(stated, placed(pose).translation, ball_inertia(stated)))
        elif len(together) > 1:  # one that stands alone is weighed with what is drawn of it
            report.dropped(f"mass of the meshes of {link.name}", "ELEMENT_DROPPED", link.where)
    return found


def _times(solid: MassProperties, factor: float) -> MassProperties:
    return MassProperties(factor * solid.mass, solid.center, factor * solid.inertia)


def _nearest_masses(
    scene: Scene, light: Sequence[int], beside: Mapping[int, Sequence[int]]
) -> dict[int, float]:
    """Of each light node the mass of the nearest that is weighed, of several as near the least; 1 kg where there is none.

    Never that of another light one: in a chain each would be a tenth of the one before, the thirtieth 1e-29 kg.
    """
    found = dict.fromkeys(light, 1.0)
    ring = {i: node.mass.mass for i, node in enumerate(scene.nodes) if node.mass is not None}
    open_ones = set(light)
    while ring and open_ones:
        further: dict[int, float] = {}
        for node, mass in ring.items():
            for other in beside.get(node, ()):
                if other in open_ones:
                    further[other] = min(mass, further.get(other, mass))
        open_ones -= further.keys()
        found |= further
        ring = further
    return found


def _stand_in(scene: Scene, index: int, beside: float, report: Report) -> None:
    """Give a node without mass and shape a light one, a share of what is ``beside`` it: a body cannot be without."""
    node = scene.nodes[index]
    mass = STAND_IN_SHARE * beside
    weight = MassProperties(mass, np.zeros(3), 0.4 * mass * STAND_IN_RADIUS**2 * np.eye(3))
    scene.nodes[index] = replace(node, mass=weight)
    report.approximated(f"mass {node.name}", "MASS_STAND_IN", node.where, link=node.name, mass=f"{mass:g}")


def unique(names: Mapping[str, object], wanted: str) -> str:
    """``wanted``, with a number that makes it new: where they were given in order the next one."""
    if wanted not in names:
        return wanted
    taken, free = 1, 2
    while f"{wanted}_{free}" in names:
        taken, free = free, 2 * free
    while free - taken > 1:
        middle = (taken + free) // 2
        taken, free = (middle, free) if f"{wanted}_{middle}" in names else (taken, middle)
    return f"{wanted}_{free}"
