"""What other assembly workbenches leave in a document: A2plus' constraints, Assembly4's attachments, simulations.

Their parts are read like any others.  A2plus solves constraints that hold no frames, Assembly4 places parts by
expressions that leave no freedom: neither tells joints, and what is left out is said.
"""

from __future__ import annotations

from ...diagnostics import Report
from ..reading.record import shown
from .document import Document, Thing

A2PLUS = (
    "it is a constraint of the A2plus workbench, whose geometry is not stored; make it a joint of Assembly"
)
MESH = "it is a mesh, whose points FreeCAD keeps in a form of its own; make a shape of it, or export the mesh as OBJ"


def is_a2plus_constraint(thing: Thing) -> bool:
    return thing.has("SubElement1") and thing.has("Object1") and not thing.has("JointType")


def is_held(thing: Thing) -> bool:
    """Whether A2plus holds the part where it is."""
    return thing.flag("fixedPosition")


def report_foreign(document: Document, report: Report) -> None:
    """Tell of everything that moves parts in another way than the Assembly workbench's joints."""
    for thing in document.things.values():
        label = shown(thing.label)
        if is_a2plus_constraint(thing):
            kind = shown(thing.text("Type") or thing.word("Type"))
            report.dropped(
                f"constraint {label} ({kind})", "FREECAD_JOINT_DROPPED", thing.where, reason=A2PLUS
            )
        elif "Asm4EE" in (thing.text("SolverId"), thing.text("AssemblyType")) and thing.text("AttachedTo"):
            report.approximated(f"attachment of {label}", "FREECAD_ATTACHED", thing.where)
        elif thing.type.startswith("Mesh::"):
            report.dropped(f"mesh {label}", "SHAPE_NOT_READ", thing.where, object=label, detail=MESH)
        elif thing.has("MotionType") and thing.has("Formula"):
            report.dropped(f"motion {label}", "JOINT_DRIVER_DROPPED", thing.where)
