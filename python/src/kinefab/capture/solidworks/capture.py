"""The open assembly of a running SolidWorks: components, mates, meshes, colours."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field

from ..channel import MemberFailed, methods_of
from ..draft import BodyMesh, Draft, Record, at_origin, pose
from ..held import hold, standing
from ..looks import look, painted
from ..masses import mass_record
from . import api
from .api import Application, Component, Feature, Model
from .features import features, features_below
from .mates import UNIT, Owner, read_mate
from .patterns import read_patterns

NAME, ASSEMBLY, LEAST = "SolidWorks", 2, 26
"""Revision 26 is 2018: from there on mates have feature data."""
FLEXIBLE, SUPPRESSED, HIDDEN, SOLID = 1, 0, 0, 0
ABOUT_CENTER = 0
SHAPING = frozenset({
    "Cut", "CutThin", "ICE", "RevCut", "RevCutThin", "SweepCut", "HoleWzd", "AdvHoleWzd", "HoleSeries", "Fillet", "Chamfer",
    "WeldBeadFeat",
})  # fmt: skip
"""``GetTypeName2`` of what an assembly may do to the shapes of its parts."""
METHODS = methods_of(api)


def capture(application: Application, draft: Draft) -> None:
    """Fill the draft with the open assembly; errors that end the capture are in its report."""
    draft.version = application.RevisionNumber()
    if int(draft.version.partition(".")[0]) < LEAST:
        draft.report.add("CAPTURE_VERSION", program=NAME, found=draft.version, least="2018")
        return
    model = application.ActiveDoc
    if model is None or model.GetType() != ASSEMBLY:
        draft.report.add("CAPTURE_NO_ASSEMBLY", program=NAME)
        return
    title = model.GetTitle()
    draft.source = model.GetPathName()
    if not draft.source or model.GetSaveFlag():
        draft.report.add("CAPTURE_UNSAVED", program=NAME, name=title)
    with draft.safely("rebuild state"):
        draft.dirty = model.Extension.NeedsRebuild2 != 0
    root = title.rpartition(".")[0] if title.lower().endswith(".sldasm") else title
    draft.component({"id": root, "name": root, "kind": "assembly", "flexible": True, "pose": at_origin()})
    with _in_bulk(application):
        _assembly(model, draft, root)


@contextmanager
def _in_bulk(application: Application) -> Generator[None, None, None]:
    """SolidWorks told that many calls come: they are faster then."""
    with suppress(MemberFailed):
        application.CommandInProgress = True
    try:
        yield
    finally:
        with suppress(MemberFailed):
            application.CommandInProgress = False


def _assembly(model: Model, draft: Draft, root: str) -> None:
    found = Components(draft, root)
    active = model.ConfigurationManager.ActiveConfiguration
    with suppress(MemberFailed):  # what an earlier record was not asked
        draft.configuration = active.Name if model.GetConfigurationCount() > 1 else ""
    top = active.GetRootComponent3(True)
    found.read(top, root)
    if found.unloaded:
        first, count = found.unloaded[0], len(found.unloaded)
        draft.report.dropped(
            "documents of components", "CAPTURE_LIGHTWEIGHT", first=first, count=count, program=NAME
        )
    for own, inner, configuration in found.flexible:
        with draft.safely(f"fixed components of {own}"):
            found.fix(own, inner, configuration)
    owners = [(own, own, inner) for own, inner, _ in found.flexible]
    for own, frame, inner in [(root, "world", model), *owners]:
        owner = Owner(draft, own, frame, 1.0, standing(found.held, own, own in found.still))
        with draft.safely(f"unit of {own}"):
            owner.unit = UNIT[inner.LengthUnit]
        with draft.safely(f"mates of {own}"):
            _mates(owner, inner)
        with draft.safely(f"patterns of {own}"):
            read_patterns(owner, inner)


@dataclass(slots=True)
class Components:
    """flexible: (id, document, configuration) of the sub-assemblies whose mates count.  unloaded: ids of what SolidWorks has no
    document of in memory: it is lightweight.  still: the root and flexible sub-assemblies that stand still in it.
    held: of one that may move the first component that is fixed in it; all others go with that one."""

    draft: Draft
    root: str
    flexible: list[tuple[str, Model, str]] = field(default_factory=list[tuple[str, Model, str]])
    unloaded: list[str] = field(default_factory=list[str])
    definitions: dict[str, Record] = field(default_factory=dict[str, Record])
    still: set[str] = field(default_factory=set[str])
    held: dict[str, str] = field(default_factory=dict[str, str])

    def __post_init__(self) -> None:
        self.still.add(self.root)

    def fix(self, own: str, model: Model, configuration: str) -> None:
        """Hold what is fixed in a flexible sub-assembly: its own document knows, in the configuration that is used."""
        used = model.GetConfigurationByName(configuration)
        if used is None:
            raise ValueError(f"no configuration {configuration}")
        records = {c["id"]: c for c in self.draft.components}
        for child in used.GetRootComponent3(True).GetChildren() or ():
            record = records.get(f"{own}/{child.Name2}")
            if record is None or record.get("suppressed") or not child.IsFixed():
                continue
            if own not in self.still:
                hold(self.draft, self.held, own, record["id"])
                continue
            record["grounded"] = True
            if record.get("flexible"):
                self.still.add(record["id"])

    def read(self, parent: Component, own: str) -> None:
        for child in parent.GetChildren() or ():
            with self.draft.safely(f"a component of {own}"):
                self._component(child, own)

    def _component(self, component: Component, parent: str) -> None:
        path = component.Name2
        own = f"{self.root}/{path}"
        record: Record = {"id": own, "name": path.rpartition("/")[2], "kind": "part", "parent": parent}
        if component.GetSuppression2() == SUPPRESSED:
            self.draft.component({**record, "pose": at_origin(), "suppressed": True})
            return
        transform = component.Transform2
        if transform is None:
            raise ValueError("a component without a transform")
        m = [float(v) for v in transform.ArrayData]
        record["pose"] = pose(m[9:12], m[0:3], m[3:6], m[6:9])
        file = component.GetPathName()
        is_assembly = file.lower().endswith(".sldasm")
        record["definition"] = (
            f"{file.replace(chr(92), '/').rpartition('/')[2]}:{component.ReferencedConfiguration}"
        )
        record["kind"] = "assembly" if is_assembly else "part"
        record["grounded"] = bool(component.IsFixed()) and parent == self.root
        record["visible"] = component.Visible != HIDDEN
        copied = [
            word
            for word, asked in (
                ("mirrored", component.IsMirrored()),
                ("patternInstance", component.IsPatternInstance()),
            )
            if asked
        ]
        if copied:
            record["extras"] = dict.fromkeys(copied, True)
        self.draft.component(record)
        if is_assembly:
            record["flexible"] = component.Solving == FLEXIBLE
            if record["flexible"]:
                if (inner := component.GetModelDoc2()) is None:
                    self.unloaded.append(own)
                else:
                    self.flexible.append((own, inner, component.ReferencedConfiguration))
                    if record["grounded"]:
                        self.still.add(own)
            self.read(component, own)
        else:
            record.update(self._definition(record["definition"], component))

    def _definition(self, name: str, component: Component) -> Record:
        """Bodies, mesh and colour of a part, read once for all its components."""
        if name in self.definitions:
            return self.definitions[name]
        found: Record = {}
        with self.draft.safely(f"meshes of {name}"):
            bodies = component.GetBodies2(SOLID) or ()
            meshes = [mesh for body in bodies if (mesh := _mesh(body)).triangles]
            if meshes:
                self.draft.meshes[name] = meshes
                found["bodies"] = [{"id": mesh.name, "meshKey": mesh.name} for mesh in meshes]
            with self.draft.safely(f"colours of faces of {name}"):
                painted(self.draft, name, sum(map(_painted, bodies)))
        with self.draft.safely(f"material and mass of {name}"):
            if (model := component.GetModelDoc2()) is None:
                self.unloaded.append(f"{self.root}/{component.Name2}")
            else:
                self._matter(name, model, found)
        self.definitions[name] = found
        return found

    def _matter(self, name: str, model: Model, found: Record) -> None:
        """Material, colour, mass: of a part's own document, in its own frame."""
        material: str = ""
        with self.draft.safely(f"material of {name}"):
            material = model.MaterialUserName or ""
        with self.draft.safely(f"colour of {name}"):
            values = model.MaterialPropertyValues
            color = [*values[:3], 1.0 - values[7]] if values and values[0] >= 0.0 else None
            if made := look(self.draft, material, color, name):
                for body in found.get("bodies", ()):
                    body["material"] = made
        with self.draft.safely(f"mass of {name}"):
            if (mass := _mass(self.draft, name, model)) is not None:
                found["mass"] = mass


def _mass(draft: Draft, name: str, model: Model) -> Record | None:
    properties = model.Extension.CreateMassProperty2()
    if properties is None:
        return None
    properties.UseSystemUnits = True
    mass = float(properties.Mass)
    if mass <= 0.0:
        return None
    m = properties.GetMomentOfInertia(ABOUT_CENTER)
    principal = [float(v) for v in properties.PrincipalMomentsOfInertia]
    moments, center = [m[0], m[4], m[8], m[1], m[5], m[2]], list(properties.CenterOfMass)
    return mass_record(draft, name, mass, center, moments, principal, "centre", draft.meshes.get(name, ()))


def _mesh(body: api.Body) -> BodyMesh:
    points = [float(v) for face in body.GetFaces() or () for v in face.GetTessTriangles(True) or ()]
    return BodyMesh(body.Name, points, list(range(len(points) // 3)))


def _painted(body: api.Body) -> int:
    """How many of its faces have a colour of their own."""
    return sum(bool(face.HasMaterialPropertyValues()) for face in body.GetFaces() or ())


def _mates(owner: Owner, model: Model) -> None:
    read: set[str] = set()
    for feature in features(model):
        with owner.draft.safely(f"a feature of {owner.id}"):
            kind = feature.GetTypeName2()
            if kind == "MateGroup":
                for mate in _below(feature):
                    with owner.draft.safely(f"a mate of {owner.id}"):
                        if (name := mate.Name) not in read:
                            read.add(name)
                            read_mate(owner, mate)
            elif kind in SHAPING:
                _shaping(owner, feature, kind)


def _shaping(owner: Owner, feature: Feature, kind: str) -> None:
    """Tell of a feature of an assembly that changes its parts' shapes."""
    if not any(feature.IsSuppressed2(1, None)):
        name = f"feature {feature.Name} of {owner.id}"
        owner.draft.report.approximated(name, "CAPTURE_ASSEMBLY_FEATURE", kind=kind, program=NAME)


def _below(group: Feature) -> Iterator[Feature]:
    """The mates of a group and of its folders; what lies in a folder may be listed behind it too."""
    for feature in features_below(group):
        kind = feature.GetTypeName2()
        if kind == "FtrFolder":
            yield from _below(feature)
        elif kind != "MateInPlace":
            yield feature
