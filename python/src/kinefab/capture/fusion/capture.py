"""The design open in Fusion: occurrences, joints, motion links, rigid groups, meshes.

Standard library only: it runs in Fusion's own Python.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any, cast

from ..channel import MemberFailed, methods_of
from ..draft import Draft
from . import api
from .api import Application, AsBuiltJoint, Joint
from .joints import joint_id, read_as_built, read_constraint, read_group, read_joint, read_link
from .occurrences import Occurrences
from .parts import Parts
from .patterns import read_patterns

NAME, DESIGN = "Fusion", "DesignProductType"
METHODS = methods_of(api)


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
    with suppress(MemberFailed):  # before 2024 no design has configurations
        table = design.configurationTopTable
        draft.configuration = table.activeRow.name if table is not None and table.rows.count > 1 else ""
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
            for number, entry in enumerate(cast("Sequence[Any]", getattr(root, member))):
                with draft.safely(f"{words} {number + 1}"):
                    read(draft, entry, tree.component)
    with draft.safely("patterns"):
        read_patterns(tree, root)
    with draft.safely("motion links"):
        _links(draft, [*root.allJoints, *root.allAsBuiltJoints], tree)
    with draft.safely("contact sets"):
        if design.contactSets.count:
            draft.report.approximated("contact sets", "CAPTURE_KIND_RAW", kind="contact", program=NAME)
            draft.notes["contactSets"] = design.contactSets.count


def _links(draft: Draft, joints: Sequence[Joint | AsBuiltJoint], tree: Occurrences) -> None:
    """Both joints of a link list it: it is taken once."""
    seen: set[tuple[str, str]] = set()
    for number, joint in enumerate(joints):
        with draft.safely(f"motion links of joint {number + 1}"):
            for link in joint.motionLinks:
                first = joint_id(draft, link.jointOne, tree.component)
                if (link.name, first) not in seen:
                    seen.add((link.name, first))
                    read_link(draft, link, tree.component)
