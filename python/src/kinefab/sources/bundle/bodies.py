"""A component's bodies: which mesh file and name, which material, which mass belongs to it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path, PurePosixPath

import numpy as np

from ...model import Body, MassProperties, MeshKey, MeshReference
from ...spatial import Array
from ..reading.near import near_matches
from ..reading.placement import Placement
from ..reading.record import Record
from ..reading.source_frame import SourceFrame

BODY = frozenset("id name meshKey file material density".split())
MASS = frozenset("in mass center inertia".split())
MAX_MOMENT = 1e24
"""Largest moment of inertia: one of ``MAX_NUMBER`` kg m^2 in the smallest units, g mm^2; a crane's in those is beyond that."""

Materials = Mapping[str, tuple[int, float | None]]
"""By name: index in the scene, and density in kg/m^3 or None."""


@dataclass(frozen=True, eq=False)
class MeshSource:
    """What a bundle says of its mesh files.

    folder: of the bundle.  files: relative to it.  layout: one file for "single", one "per_part" or
    "per_body".
    in_world: the files' coordinates are the world's, else the part's own.
    """

    folder: Path
    files: tuple[str, ...] = ()
    layout: str = "single"
    in_world: bool = True
    keyed_by: MeshKey = MeshKey.OBJECT

    @cached_property
    def shared(self) -> Path | None:
        """The file that every body is in which names none."""
        return self.folder / PurePosixPath(self.files[0]) if self.layout == "single" and self.files else None


def read_bodies(
    component: Record,
    name: str,
    placement: Placement,
    node: int,
    frame: SourceFrame,
    meshes: MeshSource,
    materials: Materials,
) -> tuple[Body, ...]:
    """The bodies of the component ``name``, whose row in ``placement`` is ``node``."""
    part_file = relative_path(component, "file", component.text("file", ""))
    records = list(component.records("bodies", BODY))
    if part_file is not None and not records:  # the file says it all
        whole: dict[str, object] = {"name": name.rpartition("/")[2]}
        records = [Record(whole, component.pointer, component.log, BODY)]
    to_node = _mesh_to_node(placement, node, frame, meshes)
    seen: set[str] = set()
    bodies: list[Body] = []
    for record in records:
        key = record.text("id", "")
        if key and key in seen:
            record.fault("BODY_DUPLICATE", "id", component=name, id=key)
        seen.add(key)
        label = record.text("name", "") or key
        material, density = None, None
        if (word := record.text("material", "")) in materials:
            material, density = materials[word]
        elif word:
            near = near_matches(word, materials, record.log.report)
            record.fault("MATERIAL_UNKNOWN", "material", body=label, material=word, near=near)
        if record.has("density"):
            density = record.number("density")
            if record.sound and density <= 0.0:
                record.fault("DENSITY_NOT_POSITIVE", "density", density=density)
        path, mesh_key = _mesh(record, label, part_file, len(records), meshes)
        reference = None
        if path is not None:
            reference = MeshReference(
                path, to_node, mesh_key, meshes.keyed_by, record.log.place(record.pointer)
            )
        bodies.append(Body(label, None, () if material is None else (material,), density, reference))
    return tuple(bodies)


def _mesh(
    body: Record, label: str, part_file: PurePosixPath | None, siblings: int, meshes: MeshSource
) -> tuple[Path | None, str | None]:
    """File and name of a body's mesh; no file, after a report, where the bundle states none."""
    own_file = relative_path(body, "file", body.text("file", ""))
    # In a file of its own a body needs no name; everywhere else its name is the best key.
    alone = own_file is not None or (part_file is not None and siblings == 1)
    key = body.text("meshKey", None if alone else label or None)
    stated = own_file or part_file
    path = meshes.shared if stated is None else meshes.folder / stated
    if path is None:
        body.fault("BODY_WITHOUT_MESH", "", body=label)
        return None, None
    return path, key


def _mesh_to_node(placement: Placement, node: int, frame: SourceFrame, meshes: MeshSource) -> Array:
    matrix = np.eye(4)
    if meshes.in_world:
        inverse = placement.pose(node).inverse()
        matrix[:3, :3], matrix[:3, 3] = inverse.rotation @ frame.turn * frame.mesh_length, inverse.translation
    else:
        matrix[:3, :3] = placement.local[node] * frame.mesh_length
    return matrix


def relative_path(record: Record, key: str, file: str) -> PurePosixPath | None:
    """A mesh file's path; one that is bound to a machine (``C:\\...``, ``/home/...``) is reported."""
    if not file:
        return None
    path = PurePosixPath(file.replace("\\", "/"))
    if path.is_absolute() or file[1:2] == ":":
        record.fault("MESH_PATH_ABSOLUTE", key, file=file)
    return path


def read_mass(
    component: Record, placement: Placement, node: int, frame: SourceFrame, index: Mapping[str, int]
) -> MassProperties | None:
    """The mass as the source gives it, brought into the node's frame (whether a body can have it is asked
    where all masses are weighed); None when it gives none."""
    record = component.record("mass", MASS)
    if record is None:
        return None
    inside = frame_index(record, node, index)
    mass = record.number("mass") * frame.mass
    center = record.vector("center")
    xx, yy, zz, xy, yz, xz = (
        np.array(record.numbers("inertia", 6, most=MAX_MOMENT)) * frame.mass * frame.length**2
    )
    tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    if not record.sound:
        return None
    axes = placement.rotations[node].T @ placement.rotations[inside] @ placement.local[inside]
    return MassProperties(mass, placement.points([node], [inside], [center])[0], axes @ tensor @ axes.T)


def frame_index(record: Record, own: int, index: Mapping[str, int]) -> int:
    """The node in whose frame a vector is given ("world": -1, "part": ``own``, or a component's id)."""
    inside = record.text("in")
    if inside == "part":
        return own
    if inside not in ("world", "") and inside not in index:
        near = near_matches(inside, ("world", "part", *index), record.log.report)
        record.fault("FRAME_UNKNOWN", "in", frame=inside, near=near)
    return index.get(inside, -1)
