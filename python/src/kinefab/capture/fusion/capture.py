"""The design open in Fusion: occurrences, joints, motion links, rigid groups, meshes.

Standard library only: it runs in Fusion's own Python.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, cast

from ..channel import methods_of
from ..draft import Draft, Record, pose_of_rows
from . import api
from .api import Application, Collection, Occurrence
from .joints import read_as_built, read_constraint, read_group, read_joint, read_link
from .parts import Parts
from .patterns import read_patterns

NAME, DESIGN = "Fusion", "DesignProductType"
INTERFACES = tuple(
    value for value in vars(api).values() if isinstance(value, type) and value.__module__ == api.__name__
)
METHODS = methods_of(*INTERFACES)


def capture(application: Application, draft: Draft) -> None:
    """Fill the draft with the open design; errors that end the capture are in its report."""
    draft.version = application.version
    design, document = application.activeProduct, application.activeDocument
    if design is None or document is None or design.productType != DESIGN:
        draft.report.add("CAPTURE_NO_ASSEMBLY", program=NAME)
        return
    draft.source = document.name
    if not document.isSaved or document.isModified:
        draft.report.add("CAPTURE_UNSAVED", program=NAME, name=document.name)
    root = design.rootComponent
    name = root.name.replace("/", "_")
    identity = pose_of_rows([1.0, 0, 0, 0, 0, 1.0, 0, 0, 0, 0, 1.0, 0, 0, 0, 0, 1.0])
    draft.component({"id": name, "name": name, "kind": "assembly", "flexible": True, "pose": identity})
    _occurrences(draft, root.occurrences, name, name, Parts(draft))

    def component(occurrence: Occurrence | None) -> str:
        return "ground" if occurrence is None else f"{name}/{_path(occurrence)}"

    steps: list[tuple[str, str, Callable[..., None]]] = [
        ("allJoints", "joint", read_joint),
        ("allAsBuiltJoints", "as-built joint", read_as_built),
        ("allRigidGroups", "rigid group", read_group),
        ("allAssemblyConstraints", "assembly constraint", read_constraint),
    ]
    for member, words, read in steps:
        with draft.safely(f"{words}s"):
            collection = cast(Collection, getattr(root, member))
            for index in range(collection.count):
                with draft.safely(f"{words} {index + 1}"):
                    read(draft, collection.item(index), component)
    with draft.safely("patterns"):
        read_patterns(draft, root.features, component)
    with draft.safely("motion links"):
        _links(draft, root.allJoints)
    with draft.safely("contact sets"):
        if design.contactSets.count:
            draft.report.approximated("contact sets", "CAPTURE_KIND_RAW", kind="contact", program=NAME)
            draft.notes["contactSets"] = design.contactSets.count


def _path(occurrence: Occurrence) -> str:
    return occurrence.fullPathName.replace("/", "_").replace("+", "/")


def _occurrences(draft: Draft, occurrences: Collection, parent: str, root: str, parts: Parts) -> None:
    for index in range(occurrences.count):
        with draft.safely(f"occurrence {index + 1} of {parent}"):
            _occurrence(draft, cast(Occurrence, occurrences.item(index)), parent, root, parts)


def _occurrence(draft: Draft, occurrence: Occurrence, parent: str, root: str, parts: Parts) -> None:
    own = f"{root}/{_path(occurrence)}"
    children = occurrence.childOccurrences
    is_assembly = children.count > 0
    definition = occurrence.component
    record: Record = {
        "id": own,
        "name": occurrence.name,
        "kind": "assembly" if is_assembly else "part",
        "parent": parent,
        "definition": definition.name,
        "pose": pose_of_rows([float(v) for v in occurrence.transform2.asArray()]),
        "grounded": bool(occurrence.isGrounded),
        "visible": bool(occurrence.isLightBulbOn),
    }
    draft.component(record)
    if is_assembly:
        record["flexible"] = True
        _occurrences(draft, children, own, root, parts)
    else:
        record.update(parts.read(record["definition"], definition))


def _links(draft: Draft, joints: Collection) -> None:
    """Both joints of a link list it: it is taken once."""
    seen: set[str] = set()
    for index in range(joints.count):
        with draft.safely(f"motion links of joint {index + 1}"):
            links: Any = joints.item(index).motionLinks
            for number in range(links.count):
                link = links.item(number)
                if link.name not in seen:
                    seen.add(link.name)
                    read_link(draft, link)
