"""The CAD bundle: ``NAME.bundle.json``, what a CAD macro writes beside its mesh export.

Every text form (JSON, tagged CSV, the paper's CSV) becomes the same raw values and is interpreted here, so
there is one road from a source of records to a ``Scene``.  The format is stated in
``schemas/bundle.schema.json``.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...diagnostics import Report, Severity
from ...model import MeshKey, Scene, Source, Surface
from ..reading.file import read_bytes
from ..reading.json_text import parse_json, top_keys
from ..reading.record import REQUIRED, Log, Record, is_array, is_object
from ..reading.request import Request
from ..reading.source_frame import DIRECTIONS, FORWARD, KILOGRAMS, METRES, RADIANS, SourceFrame, turn_to_scene
from .bodies import Materials, MeshSource, relative_path
from .components import read_components
from .constraints import read_constraints, read_freedoms
from .couplings import read_couplings
from .joints import read_joints

BUNDLE = frozenset("meta materials components joints couplings constraints dof".split())
META = frozenset(
    "format version generator units handed up forward poseState mesh sourceFile configuration timestamp".split()
)
UNITS = frozenset("length angle mass".split())
MESH = frozenset("files units layout coordinates key".split())
MATERIAL = frozenset("name density color metallic smoothness".split())
GENERATOR = frozenset("name version macro".split())

FORMAT, MAJOR = "kinefab.bundle", 1

MEASURED = frozenset("JOINT_VALUE_MISMATCH JOINT_FLIP_MISMATCH COUPLING_GAP POSE_MIRRORED".split())
"""Findings that compare numbers: without units and axes they would be misread, and nothing is said."""
NAMING = frozenset("COMPONENT_UNKNOWN FRAME_UNKNOWN".split())
"""Findings of whatever names a component: where there is none at all, that is said once."""


def sniff(head: bytes) -> bool:
    """Whether a ``.json`` of any name begins as a bundle: with its head, or with a list of records."""
    keys = top_keys(head)
    return keys.get("meta") == "{" or any(keys.get(key) == "[" for key in BUNDLE - {"meta"})


def read(path: Path, report: Report, request: Request = Request()) -> Scene:
    """The scene of a ``.bundle.json``.  request: nothing of it is needed here.  Raises KinefabError with every error
    found."""
    data = read_bytes(path, report)
    return scene_from_values(parse_json(data, path.name, report), path, data, report)


def scene_from_values(
    values: object, path: Path, data: bytes, report: Report, lines: Mapping[str, int | str] | None = None
) -> Scene:
    """The scene that raw bundle values describe.

    path, data: the file they come from and its bytes.  lines: line of each record by JSON pointer, for a
    source of lines.  Raises KinefabError with every error found.
    """
    scene = draft_from_values(values, path, data, report, lines)
    report.raise_for_errors()
    return scene


def draft_from_values(
    values: object, path: Path, data: bytes, report: Report, lines: Mapping[str, int | str] | None = None
) -> Scene:
    """As ``scene_from_values``, but errors leave a scene that is good for nothing but looking for more of them.

    Raises KinefabError where there is nothing to look at: no object, or a version of the format that is not known.
    """
    log = Log(report, path.name, lines or {})
    if not is_object(values):
        log.add("BUNDLE_NOT_OBJECT", "")
        report.raise_for_errors()
    began = bool(report.of(Severity.ERROR))
    bundle = Record(values if is_object(values) else {}, "", log, BUNDLE)
    frame, meshes, up = _meta(bundle, path)
    if (
        _names_files(bundle.values)
        and is_object(meta := bundle.values.get("meta"))
        and meta.get("mesh") is None
    ):
        log.add("BUNDLE_FIELD_MISSING", "/meta", field="mesh")  # unit and frame of the files would be guessed
    if began or any(found.code == "BUNDLE_VERSION" for found in report.diagnostics):
        report.raise_for_errors()  # lines are lost already, or the names below mean something else there
    misread, before = bool(report.of(Severity.ERROR)), len(report.diagnostics)
    scene = Scene(source=Source(path.name, up, frame.length, hashlib.sha256(data).hexdigest()))
    if is_object(meta := bundle.values.get("meta")) and isinstance(chosen := meta.get("configuration"), str):
        scene.source = replace(scene.source, configuration=chosen)
    materials = _materials(bundle, scene)
    components = read_components(bundle, frame, meshes, materials, log)
    if not components.nodes:
        log.add("BUNDLE_WITHOUT_COMPONENTS", "")
    scene.nodes = components.nodes
    joints = read_joints(bundle, components, frame, log)
    scene.joints = joints.joints
    scene.couplings = read_couplings(bundle, joints, frame, log)
    scene.constraints = read_constraints(bundle, components, frame, log)
    scene.dof_records = read_freedoms(bundle, components, log)
    scene.extras = bundle.extras()
    if not components.nodes:
        report.diagnostics[before:] = [d for d in report.diagnostics[before:] if d.code not in NAMING]
    if misread:  # the rest was looked at all the same, so that everything is told at once
        untold = MEASURED if bundle.has("meta") else MEASURED | {"BODY_WITHOUT_MESH"}
        report.diagnostics[before:] = [d for d in report.diagnostics[before:] if d.code not in untold]
    return scene


def _meta(bundle: Record, path: Path) -> tuple[SourceFrame, MeshSource, str]:
    """Units and axes, the mesh files, and the up axis ('X', 'Y' or 'Z')."""
    meta = bundle.record("meta", META, REQUIRED)
    if meta is None:
        return SourceFrame(), MeshSource(path.parent), "Y"
    if (format_name := meta.text("format")) != FORMAT and format_name:
        meta.fault("BUNDLE_FORMAT", "format", found=format_name, wanted=FORMAT)
    version = meta.text("version")
    if (match := re.fullmatch(r"(\d{1,6})\.\d{1,6}", version)) is None and version:
        meta.fault(
            "BUNDLE_FIELD_TYPE",
            "version",
            field="version",
            wanted="a version like 1.0",
            found=f"'{version[:20]}'",
        )
    elif match and int(match[1]) != MAJOR:
        meta.fault("BUNDLE_VERSION", "version", found=version, known=f"{MAJOR}.x")
    for key in ("sourceFile", "timestamp", "configuration"):
        meta.text(key, "")
    if generator := meta.record("generator", GENERATOR):
        for key in sorted(GENERATOR):
            generator.text(key, "")
    if meta.choice("poseState", {"solved": True, "dirty": False}, True) is False:
        meta.fault("POSE_STATE_DIRTY", "poseState")
    up, turn = _axes(meta)
    length, angle, mass = 1.0, 1.0, 1.0
    if units := meta.record("units", UNITS, REQUIRED):
        length = units.choice("length", METRES, code="UNIT_UNKNOWN")
        angle = units.choice("angle", RADIANS, code="UNIT_UNKNOWN")
        mass = units.choice("mass", KILOGRAMS, 1.0, code="UNIT_UNKNOWN")
    mesh_length, meshes = _meshes(meta, path.parent, length, _names_files(bundle.values))
    return SourceFrame(turn, length, angle, mass, mesh_length), meshes, up


def _axes(meta: Record) -> tuple[str, np.ndarray]:
    up = meta.choice("up", {axis: axis for axis in "XYZ"})
    forward = meta.choice("forward", {word: word for word in DIRECTIONS}, FORWARD[up])
    if forward[-1] == up:
        if meta.sound:
            meta.fault("AXES_CONFLICT", "forward", up=up, forward=forward)
        forward = FORWARD[up]
    left = meta.choice("handed", {"right": False, "left": True}, False)
    return up, turn_to_scene(DIRECTIONS[up], DIRECTIONS[forward], left)


def _meshes(meta: Record, folder: Path, length: float, named: bool) -> tuple[float, MeshSource]:
    mesh = meta.record("mesh", MESH)
    if mesh is None:
        return length, MeshSource(folder)
    files = mesh.texts("files")
    for index, file in enumerate(files):
        relative_path(mesh, f"files/{index}", file)
    stated = mesh.choice("layout", {word: word for word in ("single", "per_part", "per_body")}, None)
    layout = stated or ("per_part" if named and len(files) > 1 else "single")
    if layout == "single" and len(files) > 1:
        mesh.fault("MESH_LAYOUT", "files", count=len(files))
    # The mesh export has a unit setting of its own; nothing in the mesh file tells which.
    mesh_length = mesh.choice("units", METRES, length, code="UNIT_UNKNOWN")
    if not mesh.has("units"):
        mesh.fault("MESH_UNIT_ASSUMED", "")
    return mesh_length, MeshSource(
        folder,
        tuple(file.replace("\\", "/") for file in files),
        layout,
        in_world=mesh.choice("coordinates", {"world": True, "part": False}),
        keyed_by=mesh.choice("key", {key.value: key for key in MeshKey}, MeshKey.OBJECT),
    )


def _names_files(values: Mapping[str, object]) -> bool:
    """Whether a component, or a body of one, names a mesh file of its own."""
    components = values.get("components")
    for component in components if is_array(components) else ():
        bodies = component.get("bodies") if is_object(component) else None
        for record in (component, *(bodies if is_array(bodies) else ())):
            if is_object(record) and record.get("file"):
                return True
    return False


def _materials(bundle: Record, scene: Scene) -> Materials:
    found: dict[str, tuple[int, float | None]] = {}
    for record in bundle.records("materials", MATERIAL):
        name = record.text("name")
        if name in found:
            record.fault("SOURCE_ID_DUPLICATE", "name", id=name, first=record.log.place("/materials"))
        density = record.number("density", None)
        r, g, b, a = color = record.numbers("color", 4, (0.8, 0.8, 0.8, 1.0))
        metallic, smoothness = record.number("metallic", 0.0), record.number("smoothness", 0.5)
        if record.sound and density is not None and density <= 0.0:
            record.fault("DENSITY_NOT_POSITIVE", "density", density=density)
        if record.sound and not all(0.0 <= part <= 1.0 for part in (*color, metallic, smoothness)):
            record.fault("COLOR_RANGE", "", name=name)
        found[name] = (len(scene.surfaces), density)
        scene.surfaces.append(Surface(name, (r, g, b, a), metallic, smoothness))
    return found
