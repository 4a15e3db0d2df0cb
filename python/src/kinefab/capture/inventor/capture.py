"""The open assembly of a running Inventor: occurrences, constraints, joints, freedoms."""

from __future__ import annotations

from typing import cast

from ..channel import methods_of
from ..draft import Draft, Record
from . import api
from .api import (
    Application,
    Collection,
    Constraint,
    Definition,
    Joint,
    Occurrence,
    RigidBodyGroup,
    RigidBodyJoint,
)
from .constraints import Owner, read_constraint
from .joints import read_joint
from .occurrences import ASSEMBLY, Occurrences
from .patterns import read_patterns

NAME, LEAST_MAJOR = "Inventor", 23
"""Version 23 is 2019: from there on a mate states its solution."""
INTERFACES = tuple(
    value for value in vars(api).values() if isinstance(value, type) and value.__module__ == api.__name__
)
METHODS = methods_of(*INTERFACES)


def capture(application: Application, draft: Draft) -> None:
    """Fill the draft with the open assembly; errors that end the capture are in its report."""
    version = application.SoftwareVersion
    draft.version = version.DisplayVersion
    if version.Major < LEAST_MAJOR:
        draft.report.add("CAPTURE_VERSION", program=NAME, found=draft.version, least="2019")
        return
    document = application.ActiveDocument
    if document is None or document.DocumentType != ASSEMBLY:
        draft.report.add("CAPTURE_NO_ASSEMBLY", program=NAME)
        return
    draft.source = document.FullFileName
    if not draft.source or document.Dirty:
        draft.report.add("CAPTURE_UNSAVED", program=NAME, name=document.DisplayName)
    draft.dirty = bool(document.RequiresUpdate)
    root = document.DisplayName.rpartition(".")[0] or document.DisplayName
    draft.component(
        {
            "id": root,
            "name": root,
            "kind": "assembly",
            "flexible": True,
            "pose": {"o": [0.0, 0.0, 0.0], "x": [1.0, 0.0, 0.0], "y": [0.0, 1.0, 0.0], "z": [0.0, 0.0, 1.0]},
        }
    )
    definition = document.ComponentDefinition
    found = Occurrences(draft, root)
    found.read(definition.Occurrences, root)
    _statements(Owner(draft, root, "world"), definition)
    for own, inner in found.flexible:
        _statements(Owner(draft, own, own), inner)
    with draft.safely("rigid bodies"):
        draft.notes["rigidBodies"] = _rigid_bodies(root, definition)


def _statements(owner: Owner, definition: Definition) -> None:
    for index in _indices(owner, definition.Joints, "joints"):
        with owner.draft.safely(f"joint {index} of {owner.id}"):
            read_joint(owner, cast(Joint, definition.Joints.Item(index)))
    for index in _indices(owner, definition.Constraints, "constraints"):
        with owner.draft.safely(f"constraint {index} of {owner.id}"):
            read_constraint(owner, cast(Constraint, definition.Constraints.Item(index)))
    read_patterns(owner, definition)


def _indices(owner: Owner, collection: Collection, words: str) -> range:
    with owner.draft.safely(f"{words} of {owner.id}"):
        return range(1, collection.Count + 1)
    return range(0)


def _rigid_bodies(root: str, definition: Definition) -> Record:
    """Inventor's own reduction to rigid groups and joints between them."""
    results = definition.RigidBodyAnalysis(None)
    owner = Owner(Draft(NAME, "cm", "Z"), root, "world")
    groups: list[Record] = []
    for index in range(1, results.RigidBodyGroups.Count + 1):
        group = cast(RigidBodyGroup, results.RigidBodyGroups.Item(index))
        occurrences = group.Occurrences
        members = [
            owner.component(cast(Occurrence, occurrences.Item(i))) for i in range(1, occurrences.Count + 1)
        ]
        groups.append({"id": int(group.GroupID), "grounded": bool(group.Grounded), "components": members})
    joints: list[Record] = []
    for index in range(1, results.RigidBodyJoints.Count + 1):
        joint = cast(RigidBodyJoint, results.RigidBodyJoints.Item(index))
        joints.append(
            {
                "type": int(joint.JointType),
                "one": int(joint.GroupOne.GroupID),
                "two": int(joint.GroupTwo.GroupID),
            }
        )
    return {"groups": groups, "joints": joints}
