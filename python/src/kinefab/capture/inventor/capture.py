"""The open assembly of a running Inventor: occurrences, constraints, joints, freedoms."""

from __future__ import annotations

from contextlib import suppress
from typing import cast

from ..channel import MemberFailed, methods_of
from ..draft import Draft, Record, at_origin
from ..held import standing
from . import api
from .api import (
    Application,
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
METHODS = methods_of(api)
HANDED = {"GetMatrixData": ("doubles",), "CalculateFacets": ("long", "long", "doubles", "doubles", "longs")}
"""Methods that write into arrays of their caller."""
NUMBERS = {"Geometry": 67119422}
"""DISPID of ``Face.Geometry``, which a face of an occurrence does not name to a late bound caller."""


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
    draft.component({"id": root, "name": root, "kind": "assembly", "flexible": True, "pose": at_origin()})
    definition = document.ComponentDefinition
    with suppress(MemberFailed):  # Inventor 2021 and before have none
        states = definition.ModelStates
        draft.configuration = states.ActiveModelState.Name if states.Count > 1 else ""
    found = Occurrences(draft, root)
    found.read(definition.Occurrences, root)
    _statements(Owner(draft, root, "world"), definition)
    for own, inner in found.flexible:
        _statements(Owner(draft, own, own, standing(found.held, own, own in found.still)), inner)
    with draft.safely("rigid bodies"):
        draft.notes["rigidBodies"] = _rigid_bodies(application, root, definition)


def _statements(owner: Owner, definition: Definition) -> None:
    draft = owner.draft
    with draft.safely(f"joints of {owner.id}"):
        joints = definition.Joints
        for feature, joint in draft.each(joints.Count, joints.Item, "joint", owner.id):
            with draft.safely(feature):
                read_joint(owner, cast(Joint, joint))
    with draft.safely(f"constraints of {owner.id}"):
        constraints = definition.Constraints
        for feature, constraint in draft.each(constraints.Count, constraints.Item, "constraint", owner.id):
            with draft.safely(feature):
                read_constraint(owner, cast(Constraint, constraint))
    read_patterns(owner, definition)


def _rigid_bodies(application: Application, root: str, definition: Definition) -> Record:
    """Inventor's own reduction to rigid groups and joints between them."""
    results = definition.RigidBodyAnalysis(application.TransientObjects.CreateNameValueMap())
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
