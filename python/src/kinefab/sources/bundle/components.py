"""A bundle's components: the hierarchy and the poses."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...diagnostics import chained, diagnostic
from ...model import Node, NodeKind
from ...spatial import Array
from ..reading.near import near_matches
from ..reading.placement import ROUNDED, SKEWED, Placement, place
from ..reading.record import REQUIRED, Log, Record, Vector, shown
from ..reading.source_frame import SourceFrame
from .bodies import Materials, MeshSource, read_bodies, read_mass

COMPONENT = frozenset(
    "id name kind parent definition pose grounded flexible suppressed visible bodies mass file".split()
)
POSE = frozenset("o x y z".split())
KINDS = {"part": NodeKind.PART, "assembly": NodeKind.ASSEMBLY}

UNTURNED = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
"""Axes of a component whose own cannot be read."""
GROUND = "ground"
"""Where a joint or constraint names a component: the world itself."""


@dataclass(slots=True)
class Misnamed:
    """What was told of a name that is no component's.  at: its finding in the report.  pointer: of the field that was told.  near: names like
    it.  others: how many more places name it."""

    at: int
    pointer: str
    feature: str
    near: str
    others: int = 0


@dataclass(frozen=True, slots=True, eq=False)
class Components:
    """nodes: parents before children.  index: of a node by its id.  placement: of the nodes, in that
    order.  misnamed: by each name that is no component's, what was told of it."""

    nodes: list[Node]
    index: dict[str, int]
    placement: Placement
    misnamed: dict[str, Misnamed] = field(default_factory=dict[str, Misnamed])

    def is_active(self, node: int) -> bool:
        """Whether neither the node nor an assembly above it is suppressed; the ground always is."""
        at: int | None = node if node >= 0 else None
        while at is not None and not self.nodes[at].suppressed:
            at = self.nodes[at].parent
        return at is None

    def find(self, record: Record, key: str, feature: str) -> int:
        """The node that a field names; -1 for the ground, and after a fault.  A name that is no component's is told once, and of how many
        more places."""
        name = record.text(key)
        if name and name != GROUND and name not in self.index:
            found = record.log.report.diagnostics
            if name not in self.misnamed:
                near = near_matches(name, self.index, record.log.report)
                self.misnamed[name] = Misnamed(len(found), f"{record.pointer}/{key}", feature, near)
                record.fault("COMPONENT_UNKNOWN", key, feature=feature, component=name, near=near)
            else:
                told = self.misnamed[name]
                told.others += 1
                places = f"{told.feature} and {told.others} more {'places' if told.others > 1 else 'place'}"
                found[told.at] = diagnostic(
                    "COMPONENT_UNKNOWN", record.log.place(told.pointer), feature=places, component=name, near=told.near
                )
                record.sound = False
        return self.index.get(name, -1)


def read_components(
    bundle: Record, frame: SourceFrame, meshes: MeshSource, materials: Materials, log: Log
) -> Components:
    """The nodes of the scene, without geometry."""
    records = _unique(bundle, log)
    parents = {name: record.text("parent", "") for name, record in records.items()}
    order = _parents_first(records, parents)
    index = {name: i for i, name in enumerate(order)}
    placement = place(*_axes_and_origins([records[name] for name in order]), frame)
    nodes: list[Node] = []
    for i, name in enumerate(order):
        record = records[name]
        _check_axes(record, name, placement, i)
        definition = record.text("definition", None)
        nodes.append(
            Node(
                id=name,
                name=record.text("name", "") or name.rpartition("/")[2],
                kind=record.choice("kind", KINDS),
                parent=index.get(parents[name]),
                pose=placement.pose(i),
                # A mirrored occurrence has a mesh of its own.
                definition=f"{definition} (mirrored)" if definition and placement.mirrored[i] else definition,
                bodies=read_bodies(record, name, placement, i, frame, meshes, materials),
                mass=read_mass(record, placement, i, frame, index),
                grounded=record.flag("grounded"),
                flexible=record.flag("flexible"),
                suppressed=record.flag("suppressed"),
                visible=record.flag("visible", True),
                where=log.place(record.pointer),
                extras=record.extras(),
            )
        )
    return Components(nodes, index, placement)


def _unique(bundle: Record, log: Log) -> dict[str, Record]:
    """Component records by id; one without an id of its own by its place, so that its other faults are told too."""
    found: dict[str, Record] = {}
    for record in bundle.records("components", COMPONENT):
        name = record.text("id")
        if name == GROUND:
            record.fault("ID_RESERVED", "id", id=name)
        elif name in found:
            record.fault("SOURCE_ID_DUPLICATE", "id", id=name, first=log.place(found[name].pointer))
        elif name:
            found[name] = record
            continue
        found[record.pointer] = record
    return found


def _parents_first(records: dict[str, Record], parents: dict[str, str]) -> list[str]:
    """The ids with every parent before its children, else in the order of the file; cycles are cut."""
    ordered: dict[str, None] = {}
    for name in records:
        chain: dict[str, None] = {}
        while name and name not in ordered:
            if name in chain:
                loop = list(chain)[list(chain).index(name) :]
                records[name].fault(
                    "HIERARCHY_CYCLE", "parent", path=chained([shown(own) for own in (*loop, name)], " -> ")
                )
                parents[name] = ""  # cut, so that nobody walks it for ever
                break
            chain[name] = None
            if (parent := parents[name]) and parent not in records:
                near = near_matches(parent, records, records[name].log.report)
                records[name].fault("PARENT_UNKNOWN", "parent", component=name, parent=parent, near=near)
                break
            name = parent
        ordered.update(dict.fromkeys(reversed(chain)))
    return list(ordered)


def _axes_and_origins(records: list[Record]) -> tuple[Array, Array]:
    triads: list[tuple[Vector, ...]] = []
    origins: list[Vector] = []
    for record in records:
        pose = record.record("pose", POSE, REQUIRED)
        origins.append((0.0, 0.0, 0.0) if pose is None else pose.vector("o"))
        triad = UNTURNED if pose is None else tuple(pose.vector(axis) for axis in "xyz")
        triads.append(triad if pose is None or pose.sound else UNTURNED)
    axes = np.reshape(np.array(triads, dtype=np.float64), (-1, 3, 3)).transpose(0, 2, 1)
    return np.ascontiguousarray(axes), np.reshape(np.array(origins, dtype=np.float64), (-1, 3))


def _check_axes(record: Record, name: str, placement: Placement, i: int) -> None:
    deviation = placement.deviation[i]
    if deviation > SKEWED:
        record.fault(
            "POSE_NOT_ORTHONORMAL", "pose", component=name, deviation=f"{deviation:.2g}", limit=SKEWED
        )
        return
    if deviation > ROUNDED:
        record.fault("POSE_ROUNDED", "pose", component=name, deviation=f"{deviation:.2g}")
    if placement.mirrored[i]:
        record.fault("POSE_MIRRORED", "pose", component=name)
