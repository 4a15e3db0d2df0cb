"""Simscape Multibody XML 2.0: instances, constraints with the geometry of both sides, joints, masses, colours.

It is a bundle in other clothes and becomes a bundle's records.  Geometry stands in STEP or STL files beside it, in part
coordinates.  Source: the files that Simscape Multibody Link writes, and the elements that ``smexportonshape`` writes.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from ...diagnostics import Report
from ...geometry.mass import mended_inertia
from ...model import Body, Scene
from ..bundle.reader import scene_from_values
from ..reading.beside import beside
from ..reading.file import read_bytes
from ..reading.record import shown
from ..reading.request import Request
from ..reading.source_frame import METRES
from ..reading.xml_text import root_name
from ..robots.xml_elements import Element, parse_xml
from .statements import Statements
from .tree import Tree

ROOT = "SimscapeMultibodyImportXML"
MASSES = {"kilogram": "kg", "gram": "g", "pound": "lb", "lbm": "lb", "ounce": "oz", "tonne": "t"}
"""The words of Simscape for a bundle's."""
STEP = frozenset((".step", ".stp"))
"""Their unit stands in the file; an STL is in its part's model unit."""


def sniff(head: bytes) -> bool:
    """Whether the root element of an XML is Simscape Multibody's."""
    return root_name(head) == ROOT


def read(path: Path, report: Report, request: Request = Request()) -> Scene:
    """The scene of a Simscape Multibody ``.xml``.  request: ``up``.  Raises KinefabError with every error found."""
    data = read_bytes(path, report)
    root = parse_xml(data, path.name, report)
    assembly = root.child("RootAssembly")
    if not root.attributes.get("version", "2").startswith("2") or assembly is None:
        found = f"{shown(root.tag)} of version {shown(root.attributes.get('version', '?'))}"
        report.add(
            "XML_ROOT", root.where, found=found, wanted=f"{ROOT} version 2", format="Simscape Multibody"
        )
    report.raise_for_errors()
    assert assembly is not None
    units = _units(root)
    tree = Tree(root, assembly, report)
    statements = Statements(tree, report)
    statements.read()
    values: dict[str, object] = {
        "meta": {
            "format": "kinefab.bundle",
            "version": "1.0",
            "units": {"length": units[0], "angle": "rad", "mass": units[1]},
            "up": request.text("up", "Z"),
            "mesh": {"units": "m", "layout": "per_part", "coordinates": "part"},
        },
        "materials": tree.materials,
        "components": tree.components,
        "joints": statements.joints,
        "constraints": statements.constraints,
    }
    report.raise_for_errors()
    scene = scene_from_values(values, path, data, report, {**tree.lines, **statements.lines})
    scene.source = replace(scene.source, meters_per_unit=METRES[units[0]])
    _with_geometry(scene, tree, path, report)
    _mend_masses(scene, report)
    return scene


def _units(root: Element) -> tuple[str, str]:
    """Words for length and mass of the numbers; the bundle's reader tells those that nobody knows."""
    data = root.child("DataUnits")
    if data is None:
        return "meter", "kg"
    mass = data.attributes.get("mass", "kilogram").lower()
    return data.attributes.get("length", "meter").lower(), MASSES.get(mass, mass)


def _with_geometry(scene: Scene, tree: Tree, path: Path, report: Report) -> None:
    """Point the parts' bodies at their files: a part whose file is missing or bad is told, and moves without it."""
    for index, node in enumerate(scene.nodes):
        part = tree.parts.get(node.definition or "")
        if part is None or not node.bodies:
            continue
        bodies: list[Body] = []
        for body in node.bodies:
            reference = body.reference
            if reference is None:
                continue
            file = beside(path, part.file)
            if file is None:
                report.dropped(
                    f"geometry of {node.id}", "SIMSCAPE_LEFT_OUT", node.where,
                    reason="its file would be outside of the folder",
                )  # fmt: skip
                continue
            matrix = np.array(reference.to_node)
            if file.suffix.lower() not in STEP:
                matrix[:3, :3] *= METRES.get(part.length, 1.0)
            reference = replace(reference, path=file, to_node=matrix, needed=False)
            bodies.append(replace(body, reference=reference))
        scene.nodes[index] = replace(node, bodies=tuple(bodies))


def _mend_masses(scene: Scene, report: Report) -> None:
    """Some writers round: nine decimals of a small part's kg m^2 are nought, or a tensor that no body can have."""
    told: set[str] = set()
    for index, node in enumerate(scene.nodes):
        if node.mass is None or (mended := mended_inertia(node.mass.inertia, node.mass.mass)) is None:
            continue
        scene.nodes[index] = replace(node, mass=replace(node.mass, inertia=mended))
        name = node.definition or node.id
        if name not in told:
            report.approximated(f"inertia {node.id}", "INERTIA_MENDED", node.where, link=node.id)
        told.add(name)
