"""The design open in Fusion: occurrences, joints, motion links, rigid groups, meshes.

Standard library only: it runs in Fusion's own Python.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, cast

from ..channel import methods_of
from ..draft import Draft
from . import api
from .api import Application, Collection
from .joints import read_as_built, read_constraint, read_group, read_joint, read_link
from .occurrences import Occurrences
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
    tree = Occurrences(draft, name, Parts(draft))
    tree.read(root)
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
                    read(draft, collection.item(index), tree.component)
    with draft.safely("patterns"):
        read_patterns(tree, root)
    with draft.safely("motion links"):
        _links(draft, root.allJoints)
    with draft.safely("contact sets"):
        if design.contactSets.count:
            draft.report.approximated("contact sets", "CAPTURE_KIND_RAW", kind="contact", program=NAME)
            draft.notes["contactSets"] = design.contactSets.count


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
