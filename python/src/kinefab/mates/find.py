"""The mates of an assembly that states none, read like a sentence: shapes, contacts, what is fastened, what moves."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

from ..model import NodeKind, Scene
from ..rigid import active_nodes, rigid_groups
from .deciding.bodies import Bodies
from .deciding.decide import Decided, decide
from .deciding.fasten import Parts
from .from_decided import axles_of, mate_of_fixing, mate_of_mesh, mates_of_edge
from .mate import Mates
from .shapes.features import Shape, placed, shape_of
from .shapes.gears import Wheel, meshes, wheel_of
from .shapes.turned import Turned, fastener, is_named_fastener, turned
from .touching.search import contacts_of, near_parts


def find_mates(scene: Scene, ground: str = "") -> Mates:
    """The mates of all active parts with exact faces, numbered.

    ground: id, or the last part of the id, of the node that stands still; "" takes what the scene states, else the hub
    of the contacts.  Joints and constraints that the scene states are not looked at.
    """
    nodes, shapes, forms, named, wheels, kinds = _parts(scene)
    if not nodes:
        return Mates((), None)
    pairs = near_parts(shapes)
    meshing = meshes(wheels, pairs)
    teeth = {(mesh.first, mesh.second) for mesh in meshing}
    apart = [pair for pair in pairs if pair not in teeth]
    bodies = Bodies(shapes, contacts_of(shapes, apart))
    _join_stated(scene, nodes, bodies)
    poses = [scene.nodes[node].pose for node in nodes]
    decided = decide(bodies, Parts(forms, named, kinds, poses), apart)
    names = [scene.nodes[node].id for node in nodes]
    middles = [0.5 * (shape.low + shape.high) for shape in shapes]
    found = [
        mate_of_fixing(fixing, nodes, middles, names)
        for fixing in decided.bodies.fixings
        if fixing.reason != "stated"
    ]
    for edge in decided.edges:
        found += mates_of_edge(edge, nodes, middles, names)
    axles = axles_of(decided.edges)
    found += [mate for mesh in meshing if (mate := mate_of_mesh(mesh, decided, axles, nodes)) is not None]
    numbered = tuple(replace(mate, number=i) for i, mate in enumerate(found, 1))
    still, reason = _ground(scene, nodes, shapes, decided, ground)
    held = {side.node for mate in numbered for side in mate.sides} | {still}
    return Mates(numbered, still, reason, tuple(node for node in nodes if node not in held))


def _parts(
    scene: Scene,
) -> tuple[list[int], list[Shape], list[Turned | None], list[bool], list[Wheel | None], list[int]]:
    """Nodes with exact faces; their features in the world; the turned ones; whether a name says fastener; the wheels; a number
    for each definition."""
    active = active_nodes(scene)
    known: dict[tuple[int, ...], tuple[Shape, Turned | None, Wheel | None, int]] = {}
    kinds: list[int] = []
    wheels: list[Wheel | None] = []
    nodes: list[int] = []
    shapes: list[Shape] = []
    forms: list[Turned | None] = []
    named: list[bool] = []
    for i, node in enumerate(scene.nodes):
        if not active[i] or node.kind is not NodeKind.PART or not any(body.boundary for body in node.bodies):
            continue
        key = tuple(id(body.boundary) for body in node.bodies)
        is_named = is_named_fastener(node.name) or is_named_fastener(node.definition or "")
        if key not in known:
            shape = shape_of(node)
            assert shape is not None
            form = turned(shape) or (fastener(shape) if is_named else None)
            known[key] = shape, form, wheel_of(shape), len(known)
        own, form, wheel, kind = known[key]
        nodes.append(i)
        shapes.append(placed(own, node.pose))
        forms.append(form)
        kinds.append(kind)
        wheels.append(None if wheel is None else wheel.placed(node.pose))
        named.append(is_named)
    return nodes, shapes, forms, named, wheels, kinds


def _join_stated(scene: Scene, nodes: list[int], bodies: Bodies) -> None:
    """What the source itself says is one rigid body."""
    groups = rigid_groups(scene)
    first: dict[int, int] = {}
    for part, node in enumerate(nodes):
        group = groups.group_of[node]
        if group is not None:
            bodies.fix(first.setdefault(group, part), part, "stated", 1.0)


def _ground(
    scene: Scene, nodes: list[int], shapes: list[Shape], decided: Decided, name: str
) -> tuple[int, str]:
    """The part that stands still: named, stated, else the largest part of the body with most neighbours."""
    if name:
        for node in nodes:
            if name in (scene.nodes[node].id, scene.nodes[node].name):
                return node, "named"
    for node in nodes:
        if scene.nodes[node].grounded:
            return node, "stated"
    bodies = decided.bodies
    neighbours: Counter[int] = Counter()
    for edge in decided.edges:
        neighbours.update(edge.pair)
    volumes = [shape.volume for shape in shapes]
    members = bodies.members()

    def rank(body: int) -> tuple[int, float, int]:
        return neighbours[body], round(sum(volumes[p] for p in members[body]), 15), -body

    hub = max(members, key=rank)
    return nodes[max(members[hub], key=lambda part: (volumes[part], -part))], "hub"
