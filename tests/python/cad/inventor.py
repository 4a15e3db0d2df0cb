"""Inventor's answers for a described assembly."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from cad.described import Described, Part, owned
from cad.documented import Answers, Metres

JOINTS = {
    "rigid": 102401,
    "revolute": 102402,
    "slider": 102403,
    "cylindrical": 102404,
    "planar": 102405,
    "ball": 102406,
}
CONSTRAINTS = {
    "mate": 100665856, "flush": 100666368, "insert": 100665344, "angle": 100665088, "tangent": 100665600,
    "gear": 100666624, "rack": 100666880, "linear": 100667136, "transitional": 100666112, "symmetry": 100707840,
    "custom": 100673536,
}  # fmt: skip
UP_TO_DATE = 11778
BODY, FACE = 67118896, 67119408


class Inventor:
    """points: of joints, in 'assembly' or 'part' space.  order: of GetMatrixData, 'rows' or 'columns'."""

    def __init__(
        self,
        assembly: Described,
        points: str = "assembly",
        order: str = "rows",
        major: int = 28,
        facets: Any = None,
    ) -> None:
        self.assembly, self.points, self.order, self.facets = assembly, points, order, facets
        self.answers = Answers("inventor")
        self.occurrences: dict[str, dict[str, int]] = {}
        self.definitions: dict[str, dict[str, int]] = {}
        self.constraints: list[dict[str, int]] = []
        self.joints: list[dict[str, int]] = []
        self.base = assembly.parts[assembly.root]
        top = [self._occurrence(part, None) for part in assembly.children(assembly.root)]
        self.joints = self._joints(self.base)
        self.constraints = self._constraints(self.base)
        self.top, self.major = top, major

    def record(self, states: int = 1, **changes: Any) -> list[dict[str, Any]]:
        """states: how many model states there are."""
        a = self.answers
        state = a.made("ModelState", Name="Reclined")
        options = a.made("NameValueMap")
        transient = a.made("TransientObjects", CreateNameValueMap=options)
        definition = a.made(
            "Definition", Occurrences=a.listed(self.top), Constraints=a.listed(self.constraints),
            Joints=a.listed(self.joints), RigidBodyAnalysis={f"#{options['object']}": self._rigid_bodies()},
            OccurrencePatterns=self._patterns(self.assembly.root),
            ModelStates=a.made("ModelStates", Count=states, ActiveModelState=state),
        )  # fmt: skip
        document = a.made("Document", **{
            "DocumentType": 12291, "FullFileName": f"C:\\Work\\{self.assembly.root}.iam",
            "DisplayName": f"{self.assembly.root}.iam", "RequiresUpdate": False, "Dirty": False,
            "ComponentDefinition": definition, **changes,
        })  # fmt: skip
        version = a.made("SoftwareVersion", Major=self.major, DisplayVersion="2024")
        a.application(
            "Application", SoftwareVersion=version, ActiveDocument=document, TransientObjects=transient
        )
        return a.objects

    def _rigid_bodies(self) -> dict[str, int]:
        """Groups (grounded, components) and joints (type, number of one group, of the other) of the description; without them
        every part is a group of its own."""
        a, said = self.answers, self.assembly.values.get("rigidBodies", {"groups": [], "joints": []})
        groups = [
            a.made(
                "RigidBodyGroup", Occurrences=a.listed([self.occurrences[c] for c in components]), Grounded=grounded,
                GroupID=number,
            )
            for number, (grounded, components) in enumerate(said["groups"])
        ]  # fmt: skip
        joints = [
            a.made("RigidBodyJoint", JointType=kind, GroupOne=groups[one], GroupTwo=groups[two])
            for kind, one, two in said["joints"]
        ]
        return a.made("RigidBodyResults", RigidBodyGroups=a.listed(groups), RigidBodyJoints=a.listed(joints))

    def _patterns(self, owner: str) -> dict[str, int]:
        """The patterns of an assembly: name, and elements as lists of components; the first are the seeds."""
        a = self.answers
        made: list[Any] = []
        for name, elements, *states in self.assembly.values.get("patterns", {}).get(owner, []):
            state = dict(states[0]) if states else {}
            listed = [
                a.made(
                    "PatternElement", Suppressed=state.get(i) == "suppressed", Independent=state.get(i) == "independent",
                    Occurrences=a.listed([self.occurrences[c] for c in element if c in self.occurrences]),
                )
                for i, element in enumerate(elements)
            ]  # fmt: skip
            made.append(a.made("OccurrencePattern", Name=name, OccurrencePatternElements=a.listed(listed)))
        return a.listed(made)

    def _mass(self, part: Part) -> dict[str, int] | None:
        """The description's mass, centre and tensor; the moments with products as entries of the tensor, about the centre."""
        if part.mass is None:
            return None
        a, i = self.answers, part.mass["inertia"] * 1e4
        return a.made(
            "MassProperties", Mass=part.mass["mass"], CenterOfMass=self.point(part.mass["center"]),
            XYZMomentsOfInertia=[i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[1, 2], i[0, 2]],
            PrincipalMomentsOfInertia=np.linalg.eigvalsh(i).tolist(),
        )  # fmt: skip

    def asset(self, part: Part) -> dict[str, int] | None:
        """An appearance of the generic schema: sRGB bytes, opacity from 0 to 1."""
        if part.look is None:
            return None
        a, (r, g, b, opacity) = self.answers, part.look["srgb"]
        color = a.made("Color", Red=r, Green=g, Blue=b, Opacity=opacity / 255.0)
        value = a.made("AssetValue", Value=color)
        return a.made("Asset", DisplayName="Glossy", Item={'"generic_diffuse"': value})

    def matrix(self, rotation: np.ndarray, origin: np.ndarray) -> dict[str, int]:
        m = np.eye(4)
        m[:3, :3], m[:3, 3] = rotation, origin * 100.0
        cells = {f"{r + 1}, {c + 1}": float(m[r, c]) for r in range(4) for c in range(4)}
        data = m if self.order == "rows" else m.T
        return self.answers.made("Matrix", GetMatrixData=data.ravel().tolist(), Cell=cells)

    def _occurrence(self, part: Part, parent: dict[str, int] | None) -> dict[str, int]:
        a = self.answers
        if part.definition not in self.definitions:
            material = None if part.look is None else a.made("Asset", DisplayName=part.look["material"])
            name = self.assembly.values.get("componentNames", {}).get(part.definition, part.definition)
            path = f"C:\\Work\\{part.definition}\\{name}"
            document = a.made("Document", DisplayName=name, FullFileName=path, ActiveMaterial=material)
            bodies = self.facets(self, part) if self.facets else []
            kinds = [BODY, *[FACE] * part.look.get("painted", 0)] if part.look else []
            overridden = a.listed([a.made("Overridden", Type=kind) for kind in kinds])
            self.definitions[part.definition] = a.made(
                "Definition", Document=document, SurfaceBodies=a.listed(bodies), MassProperties=self._mass(part),
                Constraints=a.listed(self._constraints(part) if part.flags["flexible"] else []),
                Joints=a.listed(self._joints(part)),
                OccurrencePatterns=a.listed([]), AppearanceOverridesObjects=overridden,
            )  # fmt: skip
        made = a.made("Occurrence")
        self.occurrences[part.id] = made
        children = [self._occurrence(child, made) for child in self.assembly.children(part.id)]
        dof = next((d for d in self.assembly.dof if d["component"] == part.id), {})
        slides, turns = dof.get("translations", []), dof.get("rotations", [])
        center = self.point(dof["center"]) if "center" in dof else None
        freedoms = [
            len(slides), a.listed([self.vector(np.array(v)) for v in slides]),
            len(turns), a.listed([self.vector(np.array(v)) for v in turns]), center,
        ]  # fmt: skip
        if not dof:
            freedoms = {"failed": "com_error: no freedoms"}
        a.objects[made["object"]] = a._checked("Occurrence", {
            "Name": part.name, "ParentOccurrence": parent, "SubOccurrences": a.listed(children),
            "Definition": self.definitions[part.definition], "DefinitionDocumentType": 12291 if part.assembly else 12290,
            "Transformation": self.matrix(part.rotation, part.origin), "Grounded": part.flags["grounded"],
            "Suppressed": part.flags["suppressed"], "Visible": part.flags["visible"], "Flexible": part.flags["flexible"],
            "Adaptive": False, "IsPatternElement": self._in_pattern(part.id), "GetDegreesOfFreedom": freedoms,
        })  # fmt: skip
        return made

    def _in_pattern(self, component: str) -> bool:
        patterns = self.assembly.values.get("patterns", {}).values()
        return any(
            component in element for listed in patterns for pattern in listed for element in pattern[1]
        )

    def _constraints(self, owner: Part) -> list[dict[str, int]]:
        """Those that an assembly states, in its own space."""
        before, self.base = self.base, owner
        made = [made for c in owned(self.assembly, owner.id) if (made := self._constraint(c))]
        self.base = before
        return made

    def _joints(self, owner: Part) -> list[dict[str, int]]:
        """Those that an assembly states: a description names the ``owner`` of one that is not the root's."""
        before, self.base = self.base, owner
        stated = [j for j in self.assembly.joints if j.get("owner", self.assembly.root) == owner.id]
        made = [self._joint(j) for j in stated]
        self.base = before
        return made

    def _entity(self, side: dict[str, Any]) -> dict[str, int]:
        """A face or edge, or a work point: these have no ``Geometry``."""
        occurrence = self._occurrence_of(side["component"])
        member = "Point" if side["geometry"] == "point" else "Geometry"
        return self.answers.made("Entity", **{member: self.shape(side)}, ContainingOccurrence=occurrence)

    def _work(self, side: dict[str, Any]) -> dict[str, int]:
        """A work plane or axis."""
        member = {"plane": "Plane", "line": "Line"}.get(side["geometry"], "Geometry")
        occurrence = self._occurrence_of(side["component"])
        return self.answers.made("Entity", **{member: self.shape(side)}, ContainingOccurrence=occurrence)

    def point(self, p: np.ndarray) -> dict[str, int]:
        p = self.base.local(np.asarray(p))
        return self.answers.made("Point", X=Metres(p[0]), Y=Metres(p[1]), Z=Metres(p[2]))

    def vector(self, d: np.ndarray) -> dict[str, int]:
        d = self.base.turned(np.asarray(d))
        return self.answers.made("Vector", X=float(d[0]), Y=float(d[1]), Z=float(d[2]))

    def parameter(self, value: float, length: bool = False) -> dict[str, int]:
        return self.answers.made("Parameter", Value=Metres(value) if length else value)

    def shape(self, f: dict[str, Any]) -> dict[str, int]:
        a, word = self.answers, f["geometry"]
        if word == "plane":
            return a.made("Plane", RootPoint=self.point(f["p"]), Normal=self.vector(f["d"]))
        if word == "line":
            return a.made("Line", RootPoint=self.point(f["p"]), Direction=self.vector(f["d"]))
        if word == "circle":
            return a.made(
                "Circle",
                Center=self.point(f["p"]),
                Normal=self.vector(f["d"]),
                Radius=Metres(f.get("r", 0.01)),
            )
        if word == "cylinder":
            return a.made(
                "Cylinder",
                BasePoint=self.point(f["p"]),
                AxisVector=self.vector(f["d"]),
                Radius=Metres(f.get("r", 0.01)),
            )
        if word == "sphere":
            return a.made("Sphere", CenterPoint=self.point(f["p"]), Radius=Metres(f.get("r", 0.01)))
        return self.point(f["p"])

    def limits(self, c: dict[str, Any], length: bool) -> dict[str, int] | None:
        """Constraint limits: the numbers of ends that are off stay behind."""
        if not ({"min", "max", "offMin", "offMax"} & c.keys()):
            return None
        ends: dict[str, Any] = {}
        for word, key in (("Minimum", "min"), ("Maximum", "max")):
            value = c.get(key, c.get(f"off{key.title()}"))
            ends[f"{word}Enabled"] = key in c
            ends[word] = None if value is None else self.parameter(value, length)
        return self.answers.made("Limits", **ends)

    def _occurrence_of(self, component: str) -> dict[str, int] | None:
        """The occurrence as the owner's own definition has it: its path ends there."""
        if component in ("ground", self.base.id):
            return None
        if self.base.id == self.assembly.root:
            return self.occurrences[component]
        found = None
        for name in component.removeprefix(self.base.id + "/").split("/"):
            found = self.answers.made("Occurrence", Name=name, ParentOccurrence=found)
        return found

    def _constraint(self, c: dict[str, Any]) -> dict[str, int] | None:
        """A description's constraint in Inventor's words; None where Inventor has none."""
        kind = c.get("inventor") or {
            "coincident": "mate", "concentric": "mate", "distance": "mate", "insert": "insert", "angle": "angle",
            "tangent": "tangent", "gear": "gear", "rack": "rack", "linear": "linear", "symmetry": "symmetry",
        }.get(c["kind"])  # fmt: skip
        if kind is None:
            return None
        if (
            kind == "mate"
            and c["a"]["geometry"] == c["b"]["geometry"] == "plane"
            and c.get("sense") == "aligned"
        ):
            kind = "flush"
        a = self.answers
        answers: dict[str, Any] = {
            "Name": c["id"], "Type": CONSTRAINTS[kind], "Suppressed": c.get("suppressed", False),
            "HealthStatus": c.get("health", UP_TO_DATE),
            "OccurrenceOne": self._occurrence_of(c["a"]["component"]), "OccurrenceTwo": self._occurrence_of(c["b"]["component"]),
            "EntityOne": self._entity(c["a"]), "EntityTwo": self._entity(c["b"]),
        }  # fmt: skip
        if kind in ("mate", "flush", "insert", "angle", "transitional", "symmetry"):
            answers |= {"GeometryOne": self.shape(c["a"]), "GeometryTwo": self.shape(c["b"])}
        value = c.get("value", c.get("nominal", 0.0))
        if kind in ("mate", "flush", "insert", "angle"):
            answers["ConstraintLimits"] = self.limits(c, kind != "angle")
        if kind in ("mate", "symmetry"):
            inferred = {"line": 24834, "circle": 24834, "cylinder": 24834, "point": 24835, "sphere": 24835}
            for side, key in (("One", "a"), ("Two", "b")):
                answers[f"Entity{side}InferredType"] = c.get(
                    "inferred", inferred.get(c[key]["geometry"], 24833)
                )
        if kind in ("mate", "flush", "tangent"):
            answers["Offset"] = self.parameter(value, True)
        if kind == "mate":
            answers["SolutionType"] = {"opposed": 115457, "aligned": 115458}.get(c.get("sense", ""), 115459)
        elif kind == "insert":
            # Of an insert the axes are opposed where the normals of the edges' faces are.
            answers |= {
                "Distance": self.parameter(value, True),
                "AxesOpposed": c.get("sense") == "opposed",
                "LockRotation": c.get("lockRotation", False),
            }
        elif kind == "angle":
            answers |= {
                "Angle": self.parameter(value),
                "SolutionType": c.get("solution", 78594),
                "ReferenceVectorEntity": self._work(c["c"]) if "c" in c else None,
            }
        elif kind == "tangent":
            answers["InsideTangency"] = c.get("side") == "inside"
        elif kind == "symmetry":
            answers |= {
                "SymmetryPlane": self._work(c["c"]),
                "NormalsOpposed": False,
            }
        elif kind in ("gear", "linear", "rack"):
            answers["ForwardDirection"] = value > 0.0
            if kind == "rack":
                answers["Distance"] = self.parameter(abs(value) * math.tau, True)
            else:
                answers["Ratio"] = self.parameter(abs(value))
        return a.made("Constraint", **answers)

    def _joint(self, j: dict[str, Any]) -> dict[str, int]:
        """Inventor's first side moves against its second: b is the first."""
        a = self.answers
        slide = next((d for d in j.get("dof", []) if d["name"][0] == "t"), {})
        turn = next((d for d in j.get("dof", []) if d["name"][0] == "r"), {})

        def number(dof: dict[str, Any], key: str, length: bool) -> dict[str, int] | None:
            return self.parameter(dof[key], length) if key in dof else None

        def intent(frame: dict[str, Any], component: str) -> dict[str, int]:
            part = self.assembly.parts[component]
            p = part.local(frame["o"]) if self.points == "part" else frame["o"]
            axis = a.made("Line", RootPoint=self.point(frame["o"]), Direction=self.vector(frame["z"]))
            held = {"Point": self.point(frame["o"])} if j["type"] == "ball" else {"Geometry": axis}
            return a.made("Intent", Geometry=a.made("Entity", **held), Point=self.point(p))

        def alignment(frame: dict[str, Any]) -> dict[str, int]:
            line = a.made("Line", RootPoint=self.point(frame["o"]), Direction=self.vector(frame["x"]))
            return a.made("Entity", Line=line)

        fa, fb = j["frameA"], j.get("frameB", j["frameA"])
        definition = a.made(
            "JointDefinition", JointType=JOINTS[j["type"]], OriginOne=intent(fb, j["b"]), OriginTwo=intent(fa, j["a"]),
            AlignmentOne=alignment(fb), AlignmentTwo=alignment(fa), FlipOriginDirection=False,
            FlipAlignmentDirection=False, Gap=None, AngularPosition=number(turn, "value", False),
            LinearPosition=number(slide, "value", True), HasAngularPositionLimits=bool(turn.get("minEnabled")),
            AngularPositionStartLimit=number(turn, "min", False), AngularPositionEndLimit=number(turn, "max", False),
            HasLinearPositionStartLimit=bool(slide.get("minEnabled")), HasLinearPositionEndLimit=bool(slide.get("maxEnabled")),
            LinearPositionStartLimit=number(slide, "min", True), LinearPositionEndLimit=number(slide, "max", True),
        )  # fmt: skip
        return a.made(
            "Joint", Name=j["id"], Definition=definition, OccurrenceOne=self._occurrence_of(j["b"]),
            OccurrenceTwo=self._occurrence_of(j["a"]), Suppressed=False, HealthStatus=j.get("health", UP_TO_DATE), Locked=False,
        )  # fmt: skip
