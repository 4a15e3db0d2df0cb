"""SolidWorks' answers for a described assembly: its constraints as mates in the frames of their owners."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from cad.described import Described, Part, owned
from cad.documented import Answers, Metres

SHAPES = {"point": 0, "line": 1, "circle": 2, "plane": 3, "cylinder": 4, "sphere": 5}
TYPES = {
    "coincident": 0, "concentric": 1, "perpendicular": 2, "parallel": 3, "tangent": 4, "distance": 5, "angle": 6,
    "symmetry": 8, "gear": 10, "width": 11, "rack": 13, "path": 15, "lock": 16, "screw": 17, "linear": 18,
    "universal": 19, "slot": 21, "insert": 22, "profile": 24, "cam": 9,
}  # fmt: skip


class SolidWorks:
    """bodies: (double, part) to the bodies of a part."""

    def __init__(self, assembly: Described, bodies: Any = None, revision: str = "32.1.0") -> None:
        self.assembly, self.bodies, self.revision = assembly, bodies, revision
        self.answers = Answers("solidworks")
        self.components: dict[str, dict[str, int]] = {}
        self.patterns = assembly.values.get("patterns", {})
        self.instances = {
            c
            for listed in self.patterns.values()
            for _, elements, *_ in listed
            for e in elements[1:]
            for c in e
        }
        self.opened: list[dict[str, int]] = []
        top = [self._component(part) for part in assembly.children(assembly.root)]
        self.top = self.answers.made("Component", Name2=assembly.root, GetChildren=top)

    def record(self, kind: int = 2, **changes: Any) -> list[dict[str, Any]]:
        a, root = self.answers, self.assembly.root
        configuration = a.made("Configuration", Name="Reclined", GetRootComponent3={"true": self.top})
        manager = a.made("ConfigurationManager", ActiveConfiguration=configuration)
        features = self._features(root, True)
        number = len(a.objects)
        for data in self.opened:  # the model is an argument: its number is the next but the extension
            a.objects[data["object"]][f"AccessSelections(#{number + 1}, null)"] = True
        model = a.made("Model", **{
            "ConfigurationManager": manager, "Extension": a.made("Extension", NeedsRebuild2=0), "LengthUnit": 0,
            "GetType": kind, "GetConfigurationCount": 1, "GetTitle": f"{root}.SLDASM", "GetPathName": f"C:\\Work\\{root}.SLDASM",
            "GetSaveFlag": False, "FirstFeature": features, **changes,
        })  # fmt: skip
        a.application(
            "Application",
            ActiveDoc=model,
            RevisionNumber=self.revision,
            **{"CommandInProgress=": [True, False]},
        )
        return a.objects

    def _component(self, part: Part) -> dict[str, int]:
        a = self.answers
        made = a.made("Component")
        self.components[part.id] = made
        children = [self._component(child) for child in self.assembly.children(part.id)]
        m = np.concatenate([part.rotation.T.ravel(), part.origin, [1.0, 0.0, 0.0, 0.0]])
        model = None
        if part.assembly and part.flags["flexible"]:
            inside = [
                a.made(
                    "Component", Name2=child.id.removeprefix(part.id + "/"), IsFixed=child.flags["grounded"]
                )
                for child in self.assembly.children(part.id)
            ]
            root = a.made("Component", GetChildren=inside)
            model = a.made(
                "Model", LengthUnit=0, FirstFeature=self._features(part.id, False),
                GetConfigurationByName={'"Default"': a.made("Configuration", GetRootComponent3={"true": root})},
            )  # fmt: skip
        elif not part.assembly:
            look = [v / 255.0 for v in part.look["srgb"]] if part.look else None
            color = [*look[:3], 0.5, 1.0, 0.3, 0.4, 1.0 - look[3], 0.0] if look else None
            model = a.made(
                "Model", MaterialPropertyValues=color, MaterialUserName=part.look["material"] if part.look else "",
                Extension=a.made("Extension", CreateMassProperty2=self._mass(part)),
            )  # fmt: skip
        a.objects[made["object"]] = a._checked("Component", {
            "Name2": part.id.removeprefix(self.assembly.root + "/"), "Transform2": a.made("Transform", ArrayData=m.tolist()),
            "ReferencedConfiguration": "Default", "Visible": 1 if part.flags["visible"] else 0,
            "Solving": 1 if part.flags["flexible"] else 0 if part.assembly else -1, "GetChildren": children,
            "GetPathName": f"C:\\Work\\{part.definition}.SLD{'ASM' if part.assembly else 'PRT'}", "GetModelDoc2": model,
            "GetSuppression2": 0 if part.flags["suppressed"] else 2, "IsFixed": part.flags["grounded"] and part.parent == self.assembly.root,
            "IsMirrored": bool(np.linalg.det(part.rotation) < 0.0), "IsPatternInstance": part.id in self.instances,
            "GetBodies2": {"0": self.bodies(self, part) if self.bodies else None},
        })  # fmt: skip
        return made

    def _features(self, owner: str, top: bool) -> dict[str, int]:
        """A chain of features: an origin, then the group of mates, the last of them in a folder."""
        a, base = self.answers, self.assembly.parts[owner]
        mates = [self._mate(c, base) for c in owned(self.assembly, owner)]
        for one, two in zip(mates, [*mates[1:], None]):
            a.objects[one["object"]]["GetNextSubFeature()"] = two
        following = None
        for pattern in reversed(self.patterns.get(owner, [])):
            following = self._pattern(pattern, base, following)
        for name, kind, suppressed in self.assembly.values.get("assemblyFeatures", []) if top else ():
            following = a.made(
                "Feature", Name=name, GetTypeName2=kind, GetNextFeature=following, IsSuppressed2={"1, null": [suppressed]}
            )  # fmt: skip
        group = a.made(
            "Feature",
            GetTypeName2="MateGroup",
            GetNextFeature=following,
            GetFirstSubFeature=mates[0] if mates else None,
        )
        return a.made("Feature", GetTypeName2="OriginProfileFeature", GetNextFeature=group)

    def _pattern(self, pattern: Any, base: Part, following: Any) -> dict[str, int]:
        """A linear component pattern: its sub-features are the instances, its definition names the seeds."""
        a, (name, (seeds, *elements), *_) = self.answers, pattern

        def feature(component: str) -> dict[str, int]:
            return a.made(
                "Feature", GetSpecificFeature2=self._relative(component, base), GetNextSubFeature=None
            )

        instances = [feature(c) for element in elements for c in element]
        for one, two in zip(instances, [*instances[1:], None]):
            a.objects[one["object"]]["GetNextSubFeature()"] = two
        data = a.made(
            "PatternData", SeedComponentArray=[feature(c) for c in seeds], ReleaseSelectionAccess=None
        )
        self.opened.append(data)
        return a.made(
            "Feature", Name=name, GetTypeName2="LocalLPattern", GetNextFeature=following, GetDefinition=data,
            GetFirstSubFeature=instances[0] if instances else None,
        )  # fmt: skip

    def _mass(self, part: Part) -> dict[str, int] | None:
        """SI, about the centre, products as entries of the tensor."""
        if part.mass is None:
            return None
        tensor = part.mass["inertia"]
        return self.answers.made(
            "MassProperty", Mass=part.mass["mass"], CenterOfMass=Metres(part.mass["center"]),
            GetMomentOfInertia={"0": tensor.ravel().tolist()},
            PrincipalMomentsOfInertia=np.linalg.eigvalsh(tensor).tolist(), **{"UseSystemUnits=": [True]},
        )  # fmt: skip

    def entity(self, side: dict[str, Any], base: Part, word: str = "") -> dict[str, int]:
        grounded = side["component"] == "ground"
        component = None if grounded else self._relative(side["component"], base)
        face = {"Reference": self.answers.made("Entity", GetComponent=None)} if grounded else {}
        p, d = base.local(side["p"]), base.turned(side["d"]) if "d" in side else np.zeros(3)
        return self.answers.made(
            "MateEntity", EntityParams=[*p.tolist(), *np.asarray(d).tolist(), side.get("r", 0.0), 0.0],
            ReferenceType=SHAPES[word or side["geometry"]], ReferenceComponent=component,
            **face,
        )  # fmt: skip

    def _relative(self, component: str, base: Part) -> dict[str, int]:
        """A component as its owner's own document names it."""
        return self.answers.made("Component", Name2=component.removeprefix(base.id + "/"))

    def _mate(self, c: dict[str, Any], base: Part) -> dict[str, int]:
        a, kind = self.answers, c.get("solidworks", c["kind"])
        sides = [self.entity(c[k], base) for k in "ab" if k in c]
        value = c.get("value", 0.0)
        data: dict[str, Any] = {}
        if kind == "coincident" and value:
            kind = "distance"
        if kind in ("concentric", "profile"):
            data["LockRotation"] = c.get("lockRotation", False)
        if kind == "insert":
            sides = [self.entity(c[k], base, "cylinder") for k in "ab"] + [
                self.entity(c[k], base, "plane") for k in "ab"
            ]
            data |= {"AngleSelection": "min" in c}
            if "min" in c:
                sides += [self.entity({**c[k], "d": c["across"][k]}, base, "plane") for k in "ab"]
                data |= {"MinVal": c["min"], "MaxVal": c["max"]}
        elif kind in ("distance", "angle"):
            word = kind.title()
            data |= {"IsAdvancedMate": "min" in c, word: Metres(abs(value)) if kind == "distance" else value}
            if "min" in c:
                low, high = (Metres(c[k]) if kind == "distance" else c[k] for k in ("min", "max"))
                data |= {f"Minimum{word}": low, f"Maximum{word}": high}
        elif kind == "gear":
            along = float(c["a"]["d"] @ c["b"]["d"])
            data |= {
                "GearRatioNumerator": abs(value),
                "GearRatioDenominator": 1.0,
                "Reverse": (value > 0.0) == (along >= 0.0),
            }
        elif kind == "rack":
            sides.reverse()
            data |= {
                "DiameterType": c.get("diameterType", 0),
                "DiameterVal": Metres(abs(value) * (math.tau if c.get("diameterType") else 2.0)),
                "Reverse": value < 0.0,
            }
        elif kind == "screw":
            data |= {"RevolutionType": 1, "RevolutionVal": Metres(abs(value)), "Reverse": value < 0.0}
        elif kind == "linear":
            data |= {
                "CouplerRatioNumerator": abs(value),
                "CouplerRatioDenominator": 1.0,
                "Reverse": value < 0.0,
            }
        elif kind == "profile":
            data["OffsetDistance"] = Metres(value)
        elif kind in ("symmetry", "width"):
            third = self.entity(c["c"], base)
            if kind == "symmetry":
                sides.append(third)
            else:
                walls = [{**c["c"], "p": c["c"]["p"] + s * 0.02 * c["c"]["d"]} for s in (1.0, -1.0)]
                sides = [*(self.entity(wall, base) for wall in walls), *sides]
                data["ConstraintType"] = c.get("constraintType", 0)
        mate = a.made(
            "Mate", Type=TYPES[kind], Alignment={"aligned": 0, "opposed": 1}.get(c.get("sense", ""), 2),
            GetMateEntityCount=len(sides), MateEntity={str(i): s for i, s in enumerate(sides)},
        )  # fmt: skip
        return a.made(
            "Feature", Name=c["id"], GetTypeName2="Mate", GetSpecificFeature2=mate,
            GetDefinition=a.made("MateData", **data) if data else None,
            IsSuppressed2={"1, null": [c.get("suppressed", False)]}, GetErrorCode=c.get("error", 0),
        )  # fmt: skip
