"""Inventor's occurrences as components: poses, flags, the meshes and masses of their definitions."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field
from typing import cast

from ..channel import MemberFailed
from ..draft import BodyMesh, Draft, Numbers, Record, at_origin, pose_of_rows
from ..held import hold
from ..looks import look, painted
from ..masses import mass_record
from .api import Asset, Body, Collection, Definition, Document, MassProperties, Matrix, Occurrence, Overridden
from .geometry import numbers

ASSEMBLY = 12291
TOLERANCE = 0.005
"""Chord of a facet, cm."""
TINY = 1e-12
WHOLE = frozenset({67118896, 83945216})
"""ObjectTypeEnum of a body and of a work surface; all others with an appearance of their own are faces and features."""
FULL = 255.0
COLORS = (
    "generic_diffuse", "opaque_albedo", "metal_f0", "metal_color", "metallicpaint_base_color", "plasticvinyl_color",
    "wallpaint_color", "ceramic_color", "layered_diffuse", "transparent_color", "surface_albedo",
)  # fmt: skip
"""Key names of the colour in the schemas of Autodesk's appearances; they are the same in all languages."""


@dataclass(slots=True)
class Occurrences:
    """draft: what is filled.  root: id of the document's own assembly.  flexible: (id, definition) of the assemblies
    whose constraints count: the root and those whose parts move against each other.
    held: of a flexible assembly that may move the first part that is grounded in it; all others go with that one.
    still: the flexible assemblies that stand still in the open one.
    order: how ``GetMatrixData`` lists its numbers, once a matrix has told: its documentation does not.
    """

    draft: Draft
    root: str
    flexible: list[tuple[str, Definition]] = field(default_factory=list[tuple[str, Definition]])
    held: dict[str, str] = field(default_factory=dict[str, str])
    still: set[str] = field(default_factory=set[str])
    order: str = ""
    definitions: dict[str, Record] = field(default_factory=dict[str, Record])

    def read(self, occurrences: Collection, parent: str, fixed: bool = True) -> None:
        """fixed: whether what is grounded in this assembly stands still in the open one too."""
        for feature, occurrence in self.draft.each(occurrences.Count, occurrences.Item, "occurrence", parent):
            with self.draft.safely(feature):
                self._occurrence(cast(Occurrence, occurrence), parent, fixed)

    def _occurrence(self, occurrence: Occurrence, parent: str, fixed: bool) -> None:
        name = occurrence.Name
        own = f"{parent}/{name}"
        suppressed = bool(occurrence.Suppressed)
        record: Record = {"id": own, "name": name, "kind": "part", "parent": parent}
        if suppressed:
            self.draft.component({**record, "pose": at_origin(), "suppressed": True})
            return
        is_assembly = occurrence.DefinitionDocumentType == ASSEMBLY
        record["kind"] = "assembly" if is_assembly else "part"
        record["pose"] = pose_of_rows(self._rows(occurrence.Transformation))
        grounded = bool(occurrence.Grounded)  # to its own assembly, which may move
        record["grounded"], record["visible"] = grounded and fixed, bool(occurrence.Visible)
        extras = {
            word: True
            for word, asked in (
                ("adaptive", occurrence.Adaptive),
                ("patternElement", occurrence.IsPatternElement),
                ("groundedInAssembly", grounded and not fixed),
            )
            if asked
        }
        if extras:
            record["extras"] = extras
        definition = occurrence.Definition
        document = definition.Document
        record["definition"] = self.draft.definition(document.DisplayName, _file(document))
        self.draft.component(record)
        if grounded and not fixed and any(parent == one for one, _ in self.flexible):
            hold(self.draft, self.held, parent, own)
        if is_assembly:
            record["flexible"] = bool(occurrence.Flexible)
            if record["flexible"]:
                self.flexible.append((own, definition))
                if record["grounded"]:
                    self.still.add(own)
            self.read(occurrence.SubOccurrences, own, record["grounded"])
        else:
            record.update(self._definition(record["definition"], definition))
        if not record["grounded"]:
            self._freedoms(occurrence, own)

    def _rows(self, matrix: Matrix) -> Numbers:
        """A matrix, row by row; ``Cell`` tells the order of the bulk call where the numbers do not."""
        try:
            data = [float(v) for v in matrix.GetMatrixData()]
        except (MemberFailed, TypeError, ValueError):
            return [float(matrix.Cell(row, column)) for row in (1, 2, 3, 4) for column in (1, 2, 3, 4)]
        if not self.order:
            last_column, last_row = any(data[i] for i in (3, 7, 11)), any(data[12:15])
            skew = data[1] - data[4]
            if last_column != last_row:
                self.order = "rows" if last_column else "columns"
            elif abs(skew) > TINY:
                self.order = "rows" if abs(matrix.Cell(1, 2) - data[1]) < TINY else "columns"
            elif abs(data[2] - data[8]) > TINY:
                self.order = "rows" if abs(matrix.Cell(1, 3) - data[2]) < TINY else "columns"
            elif abs(data[6] - data[9]) > TINY:
                self.order = "rows" if abs(matrix.Cell(2, 3) - data[6]) < TINY else "columns"
        if self.order == "columns":
            return [data[row + 4 * column] for row in range(4) for column in range(4)]
        return data

    def _definition(self, name: str, definition: Definition) -> Record:
        """Bodies, mesh and mass of a part, read once for all its occurrences."""
        if name in self.definitions:
            return self.definitions[name]
        found: Record = {}
        with self.draft.safely(f"meshes of {name}"):
            bodies = [
                cast(Body, definition.SurfaceBodies.Item(i))
                for i in range(1, definition.SurfaceBodies.Count + 1)
            ]
            meshes = [_mesh(body) for body in bodies]
            if meshes:
                self.draft.meshes[name] = meshes
                found["bodies"] = [{"id": m.name, "meshKey": m.name} for m in meshes]
                self._looks(name, definition, bodies, found["bodies"])
                self._painted(name, definition)
        with self.draft.safely(f"mass of {name}"):
            properties = definition.MassProperties
            if properties is not None and (mass := float(properties.Mass)) > 0.0:
                found["mass"] = _mass(self.draft, name, mass, properties)
        self.definitions[name] = found
        return found

    def _painted(self, name: str, definition: Definition) -> None:
        with self.draft.safely(f"colours of faces of {name}"):
            listed = definition.AppearanceOverridesObjects
            overridden = [cast(Overridden, listed.Item(i)) for i in range(1, listed.Count + 1)]
            painted(self.draft, name, sum(entry.Type not in WHOLE for entry in overridden))

    def _looks(self, name: str, definition: Definition, bodies: list[Body], records: list[Record]) -> None:
        material = ""
        with self.draft.safely(f"material of {name}"):
            if (asset := definition.Document.ActiveMaterial) is not None:
                material = asset.DisplayName
        for body, record in zip(bodies, records):
            with self.draft.safely(f"appearance of {name}/{record['id']}"):
                shown = body.Appearance
                color = None if shown is None else _color(shown)
                if shown is not None and color is None:
                    self.draft.report.approximated(
                        f"appearance {shown.DisplayName} of {name}", "CAPTURE_NO_COLOR", program=self.draft.program
                    )  # fmt: skip
                if made := look(self.draft, material, color, name):
                    record["material"] = made

    def _freedoms(self, occurrence: Occurrence, own: str) -> None:
        with self.draft.safely(f"freedoms of {own}"):
            slides, directions, turns, axes, center = occurrence.GetDegreesOfFreedom()
            record: Record = {"component": own}
            if slides:
                record["translations"] = [numbers(directions.Item(i)) for i in range(1, slides + 1)]
            if turns:
                record["rotations"] = [numbers(axes.Item(i)) for i in range(1, turns + 1)]
                if center is not None:
                    record["center"] = numbers(center)
            self.draft.dof.append(record)


def _file(document: Document) -> str:
    """Files of one name may lie in two folders."""
    with suppress(MemberFailed, AttributeError):
        return document.FullFileName
    return ""


def _mesh(body: Body) -> BodyMesh:
    _, _, points, _, corners = body.CalculateFacets(TOLERANCE)
    return BodyMesh(body.Name, [float(v) for v in points], [int(i) - 1 for i in corners])


def _mass(draft: Draft, name: str, mass: float, properties: MassProperties) -> Record:
    center = numbers(properties.CenterOfMass)
    moments = [float(v) for v in properties.XYZMomentsOfInertia()]
    principal = [float(v) for v in properties.PrincipalMomentsOfInertia()]
    return mass_record(draft, name, mass, center, moments, principal, "centre", draft.meshes.get(name, ()))


def _color(asset: Asset) -> Numbers | None:
    """Red green blue and opacity, 0 to 1, of the first key that an appearance has; None where it has none."""
    for key in COLORS:
        try:
            color = asset.Item(key).Value
            return [color.Red / FULL, color.Green / FULL, color.Blue / FULL, float(color.Opacity)]
        except (MemberFailed, AttributeError):
            continue
    return None
