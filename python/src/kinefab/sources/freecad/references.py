"""What a joint's reference points at: the part that moves, and the frame of the object in it."""

from __future__ import annotations

from dataclasses import dataclass

from ...spatial import Pose
from .document import Target, Thing
from .occurrences import Occurrence
from .parts import Parts


@dataclass(frozen=True, slots=True, eq=False)
class Reference:
    """node: what moves.  pose: of the object, in the world, millimetres.  element: ``Face6``, "" for the whole.
    owner: the object whose shape the element is of."""

    node: int
    pose: Pose
    element: str
    owner: Thing | None


class Lost(Exception):
    """A reference that leads nowhere, and why."""


def resolve(target: Target, root: Occurrence, parts: Parts) -> Reference:
    """root: an assembly; the path goes through it or begins in it.  Raises Lost."""
    path = target.subs[0] if target.subs else ""
    names = [target.name, *path.split(".")]
    element = names.pop() if path else ""
    start: Occurrence = root
    # The selection's root may be a container above the assembly, the assembly, or, in old files, a part of it.
    chain = [root]
    while chain[-1].parent is not None:
        chain.append(chain[-1].parent)
    by_name = {above.name: above for above in chain}
    linked = root.thing.target("LinkedObject") if target.file else None
    if linked is not None and linked.name == names[0]:
        # FreeCAD 1.0 leaves a joint that it copies out of a flexible sub-assembly's own file at that file's objects
        names = names[1:]
    elif root.name in names:
        names = names[names.index(root.name) + 1 :]
    elif names[0] in by_name:
        start, names = by_name[names[0]], names[1:]
    here, pose = start, start.jcs
    owner: Thing | None = None
    within: Thing | None = None
    for number, name in enumerate(names):
        if within is None:
            below = child_of(here, name)
            if below is not None:
                here, pose, owner = below, below.jcs, below.target
                continue
            if number == 0 and here is start:
                raise Lost(f"it names '{name}', which is not in the assembly")
        inside = _inside(within or here.target, name)
        if inside is None:
            continue  # a feature of a body, a folder, or an element's mapped name: the frame stays
        within, pose, owner = inside, pose @ inside.placement(), inside
    node = parts.node(here)
    if here is start or node is None:
        raise Lost("it names no part of the assembly")
    moving = _moving(here, parts)
    return Reference(node, moving.pose @ moving.jcs.inverse() @ pose, element, owner)


def _moving(here: Occurrence, parts: Parts) -> Occurrence:
    """What FreeCAD moves where it moves this occurrence: the outermost one round it that moves as one."""
    found, above = here, here.parent
    while above is not None:
        node = parts.of.get(id(above))
        if node is not None and parts.nodes[node].flexible:
            break
        if not above.is_group:
            found = above
        above = above.parent
    return found


def child_of(here: Occurrence, name: str) -> Occurrence | None:
    """By name, folders looked through."""
    for child in here.children:
        if child.name == name:
            return child
    for child in here.children:
        if child.is_group and (found := child_of(child, name)) is not None:
            return found
    return None


def _inside(holder: Thing | None, name: str) -> Thing | None:
    """A datum or a sketch that a path goes on to inside a part; None for a feature, which stands where its body does."""
    if holder is None:
        return None
    found = holder.document.things.get(name)
    if (
        found is None
        or found.type.startswith(("PartDesign::Feature", "PartDesign::Pad"))
        or not found.has("Placement")
    ):
        return None
    solid = found.type.startswith("PartDesign::") and found.type.rpartition("::")[2] not in DATUMS
    return None if solid or found.key == holder.key else found


DATUMS = ("Point", "Line", "Plane", "CoordinateSystem")
