"""Mesh files that colliders refer to are loaded as bodies are: lent to their nodes for that, and taken back."""

from __future__ import annotations

from dataclasses import replace

from ..diagnostics import Report, Severity
from ..model import Body, Scene


def with_lent_bodies(scene: Scene) -> Scene:
    """The scene with a further body at the end of a node's for each of its colliders that has a mesh to be loaded."""
    nodes = list(scene.nodes)
    for i, node in enumerate(nodes):
        lent = [
            Body(c.name or c.kind.value, reference=c.reference, weighed=False)
            for c in node.colliders or ()
            if c.reference is not None and c.mesh is None
        ]
        if lent:
            nodes[i] = replace(node, bodies=(*node.bodies, *lent))
    return replace(scene, nodes=nodes)


def without_lent_bodies(given: Scene, loaded: Scene) -> Scene:
    """The loaded scene with the lent bodies' meshes in their colliders; a collider without one is left out.

    given: the scene before bodies were lent.
    """
    nodes = list(loaded.nodes)
    for i, (node, before) in enumerate(zip(nodes, given.nodes)):
        if before.colliders is None:  # nothing was lent
            continue
        count = len(before.bodies)
        lent = iter(node.bodies[count:])
        filled = [
            replace(c, mesh=next(lent).mesh, reference=None)
            if c.reference is not None and c.mesh is None
            else c
            for c in before.colliders
        ]
        colliders = tuple(
            new for new, old in zip(filled, before.colliders) if new.mesh is not None or old.reference is None
        )
        nodes[i] = replace(node, bodies=node.bodies[:count], colliders=colliders)
    return replace(loaded, nodes=nodes)


LOOKS = frozenset({"MESH_LOOK", "TEXTURE_UNREADABLE"})


def without_looks(found: Report) -> None:
    """Take back what was found about the looks of a mesh file: nothing draws it."""
    found.diagnostics = [d for d in found.diagnostics if d.code not in LOOKS]
    found.outcomes = [o for o in found.outcomes if o.code not in LOOKS]


def tell_losses(found: Report, names: list[str], file: str, where: str, report: Report) -> None:
    """What was found in a mesh file that the source can do without: its errors are losses of all bodies in ``names``."""
    errors = found.of(Severity.ERROR)
    report.diagnostics += [d for d in found.diagnostics if d.severity is not Severity.ERROR]
    report.outcomes += found.outcomes
    for name in names if errors else ():
        report.dropped(f"mesh {name}", "MESH_UNREADABLE", where, file=file, detail=errors[0].message)
