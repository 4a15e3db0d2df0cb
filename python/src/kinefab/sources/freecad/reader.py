"""A FreeCAD document (``.FCStd``) as a scene, without FreeCAD."""

from __future__ import annotations

import hashlib
import os
from dataclasses import replace
from pathlib import Path

from ...diagnostics import Report
from ...model import NodeKind, Scene, Source, SourceFile
from ..asmt.assembled import add_statements
from ..asmt.joints import Statement
from ..occ.asked import tolerance_of
from ..reading.record import shown
from ..reading.request import Request
from .document import UNIT, Thing
from .joints import JointReader, joints_of
from .links import Documents
from .looks import Looks
from .occurrences import ASSEMBLY, NO_PART, SUB_ASSEMBLY, Occurrence, TooManyError, Tree
from .parts import Parts, has_assembly, has_shape, linked
from .shapes import Shapes
from .workbenches import is_held, report_foreign


def read(path: Path, report: Report, request: Request = Request()) -> Scene:
    """The scene of a document and of those it links to.  request: ``tolerance`` of the triangles.  Raises KinefabError with every error found."""
    documents = Documents(path, report)
    root = documents.root
    scene = Scene(source=Source(path.name, "Z", UNIT, hashlib.sha256(root.archive.data).hexdigest()))
    try:
        roots = [Tree(documents).occurrence(thing, None) for thing in top(documents)]
    except TooManyError:
        report.add(
            "ARCHIVE_REFUSED",
            path.name,
            path=path.name,
            detail="its links unfold to more than any assembly has",
        )
        report.raise_for_errors()
        raise
    parts = Parts()
    mechanism = any(below.type == ASSEMBLY for occurrence in roots for below in occurrence.walk())
    for occurrence in roots:
        parts.add(occurrence, ground=mechanism and occurrence.type != ASSEMBLY)
    tolerance = tolerance_of(request, path, report)
    shapes = Shapes(report, tolerance)
    reader = JointReader(parts, shapes, report)
    scene.nodes = parts.nodes
    for occurrence in roots:
        for below in occurrence.walk():
            node = parts.of.get(id(below))
            if below.type not in (ASSEMBLY, SUB_ASSEMBLY) or node is None:
                continue
            if scene.nodes[node].flexible:
                reader.read(below)
            else:
                tell_rigid(below, documents)
    scene.identities = parts.identities | reader.identities
    report_foreign(root, report)
    reader.grounded += [
        parts.of[id(below)]
        for occurrence in roots
        for below in occurrence.walk()
        if id(below) in parts.of and is_held(below.thing)
    ]
    for node in reader.grounded:
        scene.nodes[node] = replace(scene.nodes[node], grounded=True)
    add_statements(scene, reader.statements, lambda statement, reason: left(report, statement, reason))
    _set_aside(scene, parts.empty)
    shapes.load(scene, parts.shapes, Looks(scene, report, documents.follow), request.progress)
    scene.source = replace(scene.source, files=tuple(
        SourceFile(Path(os.path.relpath(found.path, documents.folder)).as_posix(), hashlib.sha256(found.archive.data).hexdigest())
        for found in documents.others
    ))  # fmt: skip
    report.raise_for_errors()
    return scene


def _set_aside(scene: Scene, empty: list[int]) -> None:
    """Containers with nothing in them, or with sketches and datums alone, are no bodies that could fall, unless a joint moves
    one."""
    named = {node for joint in scene.joints for node in (joint.a, joint.b)}
    named |= {feature.node for constraint in scene.constraints for feature in constraint.features}
    for node in set(empty) - named:
        if not scene.nodes[node].grounded:
            scene.nodes[node] = replace(scene.nodes[node], kind=NodeKind.ASSEMBLY, flexible=True)


def left(report: Report, statement: Statement, reason: str) -> None:
    report.dropped(f"joint {shown(statement.name)}", "FREECAD_JOINT_DROPPED", statement.where, reason=reason)


def tell_rigid(assembly: Occurrence, documents: Documents) -> None:
    """Remark on the joints of an assembly whose parts move as one: FreeCAD keeps them where the assembly was made."""
    made = assembly.target
    source = None if made is None else made.target("LinkedObject")
    if made is not None and source is not None:
        made = documents.follow(made, source)
    count = sum(thing.has("JointType") for thing in joints_of(made))
    if count:
        rigid = _rigid(assembly)
        feature = f"joints of rigid assembly {shown(assembly.label)}"
        if rigid is not assembly:
            feature = f"joints of assembly {shown(assembly.label)} in rigid assembly {shown(rigid.label)}"
        documents.report.kept(feature, assembly.thing.where, "FREECAD_RIGID", count=count)


def _rigid(assembly: Occurrence) -> Occurrence:
    """The assembly that keeps the parts of one together: itself, or where it is flexible the next one above that is not."""
    above: Occurrence | None = assembly
    while above is not None:
        flexible = above.thing.type == SUB_ASSEMBLY and not above.thing.flag("Rigid", True)
        if above.type in (ASSEMBLY, SUB_ASSEMBLY) and not flexible and above.parent is not None:
            return above
        above = above.parent
    return assembly


def top(documents: Documents) -> list[Thing]:
    """What stands at the root of the first document: what nothing holds, and no link of an assembly shows elsewhere."""
    document = documents.root
    held: set[str] = set()
    assemblies = has_assembly(document)
    elsewhere = linked(document)
    for thing in document.things.values():
        for name in ("Group", "ElementList", "OriginFeatures"):
            held |= {entry.name for entry in thing.targets(name) if not entry.file}
        for name in ("Origin",):
            target = thing.target(name)
            held |= {target.name} if target is not None else set()
    found: list[Thing] = []
    for thing in document.things.values():
        if thing.name in held or thing.type.startswith(NO_PART):
            continue
        container = thing.type.startswith(
            ("App::Part", "App::Link", "App::DocumentObjectGroup", "Assembly::")
        )
        if not container and not has_shape(thing) and not thing.type.startswith("Mesh::"):
            continue
        hidden = not thing.flag("Visibility", True)
        if (
            thing.type != ASSEMBLY
            and assemblies
            and (hidden or thing.name in elsewhere)
            and not holds_assembly(thing, set())
        ):
            continue
        found.append(thing)
    return found


def holds_assembly(thing: Thing, above: set[str]) -> bool:
    """Whether an assembly stands in a container, at any depth."""
    if thing.type == ASSEMBLY:
        return True
    if thing.name in above:
        return False
    below = [thing.document.things.get(entry.name) for entry in thing.targets("Group") if not entry.file]
    return any(holds_assembly(entry, above | {thing.name}) for entry in below if entry is not None)
