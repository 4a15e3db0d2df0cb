"""Fusion's answers for a described assembly: its joints as joints or as-built joints, its couplings as motion links."""

from __future__ import annotations

import uuid
from typing import Any

import numpy as np
from cad.described import Described, Part
from cad.documented import Answers, Metres

TYPES = {"rigid": 0, "revolute": 1, "slider": 2, "cylindrical": 3, "pin_slot": 4, "planar": 5, "ball": 6}
OWN = "own bodies"
MOTIONS = {("revolute", "rz"): 10, ("slider", "tz"): 11, ("cylindrical", "rz"): 3, ("cylindrical", "tz"): 4}


class Fusion:
    """as_built: names of joints that are as-built.  bodies: (double, part) to the bodies of a component.

    A part that is called ``own bodies`` is no occurrence but the bodies of the component that it is in.
    """

    def __init__(self, assembly: Described, as_built: tuple[str, ...] = (), bodies: Any = None) -> None:
        self.assembly, self.bodies = assembly, bodies
        self.answers = Answers("fusion")
        self.occurrences: dict[str, dict[str, int]] = {}
        self.top = [self._occurrence(part) for part in self._children(assembly.root)]
        self.joints = {j["id"]: self._joint(j, j["id"] in as_built) for j in assembly.joints}
        links: dict[str, list[dict[str, int]]] = {name: [] for name in self.joints}
        kinds = {j["id"]: j["type"] for j in assembly.joints}
        for c in assembly.couplings:
            one, two = c["a"]["joint"], c["b"]["joint"]
            link = self.answers.made(
                "MotionLink", name=c["id"], jointOne=self.joints[one], jointTwo=self.joints[two],
                motionOne=MOTIONS[kinds[one], c["a"]["dof"]], motionTwo=MOTIONS[kinds[two], c["b"]["dof"]],
                valueOne=self.answers.made("Parameter", value=2.0), valueTwo=self.answers.made("Parameter", value=2.0 * abs(c["ratio"])),
                isReversed=c["ratio"] < 0.0, isSuppressed=False,
            )  # fmt: skip
            links[one].append(link)
            links[two].append(link)
        for name, made in self.joints.items():
            self.answers.objects[made["object"]]["motionLinks"] = links[name]
        self.as_built = as_built

    def listed(self, entries: list[Any]) -> dict[str, int]:
        return self.answers.listed(entries, count="count", item="item", first=0)

    def record(
        self, groups: tuple[Any, ...] = (), contacts: int = 0, configurations: int = 0, **changes: Any
    ) -> list[dict[str, Any]]:
        a = self.answers
        row = a.made("ConfigurationRow", name="Reclined")
        table = a.made("ConfigurationTable", rows=self.listed([row] * configurations), activeRow=row)
        made = [
            a.made(
                "RigidGroup",
                name=name,
                occurrences=self.listed([self.occurrences[m] for m in members]),
                isSuppressed=False,
            )
            for name, members in groups
        ]
        constraints = [
            a.made(
                "AssemblyConstraint", name=name, isSuppressed=False, geometricRelationships=self.listed([
                    a.made(
                        "Relationship", isMate=True, isFlipped=False, offsetOrAngle=a.made("Parameter", value=0.5),
                        entityOne=a.made("Entity", assemblyContext=self.occurrences[one]),
                        entityTwo=a.made("Entity", assemblyContext=self.occurrences.get(two)),
                    )
                ]),
            )
            for name, one, two in self.assembly.values.get("assemblyConstraints", [])
        ]  # fmt: skip
        root = a.made(
            "RootComponent", name=self.assembly.root, occurrences=self.listed(self.top),
            bRepBodies=self.listed(self._bodies(self.assembly.parts[self.assembly.root])),
            allJoints=[j for n, j in self.joints.items() if n not in self.as_built],
            allAsBuiltJoints=[j for n, j in self.joints.items() if n in self.as_built],
            allRigidGroups=made, allAssemblyConstraints=constraints,
            features=self._features(self.assembly.root),
        )  # fmt: skip
        design = a.made(
            "Design",
            productType="DesignProductType",
            rootComponent=root,
            contactSets=self.listed([None] * contacts),
            configurationTopTable=table if configurations else None,
        )
        document = a.made(
            "Document", **{"name": self.assembly.root, "isSaved": True, "isModified": False, **changes}
        )
        a.application("Application", version="2.0.20000", activeDocument=document, activeProduct=design)
        return a.objects

    def _features(self, owner: str) -> dict[str, int]:
        """A component's patterns, all of them rectangular; of a pattern of faces the elements hold no occurrences.  Occurrences
        are the component's own: their paths begin in it."""
        a = self.answers
        made: list[Any] = []
        for name, elements, *_ in self.assembly.values.get("patterns", {}).get(owner, []):
            listed = [
                a.made("PatternElement", occurrences=[self._native(c, owner) for c in element])
                for element in elements
            ]
            listed.append(a.made("PatternElement", occurrences=None))
            made.append(a.made("PatternFeature", name=name, patternElements=self.listed(listed)))
        others = {
            kind: self.listed([])
            for kind in ("circularPatternFeatures", "pathPatternFeatures", "mirrorFeatures")
        }
        return a.made("Features", rectangularPatternFeatures=self.listed(made), **others)

    def _native(self, component: str, owner: str) -> dict[str, int]:
        path = component.removeprefix(owner + "/").replace("/", "+")
        return self.answers.made("Occurrence", fullPathName=path)

    def _component(self, part: Part) -> dict[str, int]:
        """The mass of one with children is theirs too."""
        patterns = {"features": self._features(part.id)} if part.assembly else {}
        return self.answers.made(
            "Component",
            name=self.assembly.values.get("componentNames", {}).get(part.definition, part.definition),
            id=str(uuid.uuid5(uuid.NAMESPACE_OID, part.definition)),
            bRepBodies=self.listed(self._bodies(part)),
            getPhysicalProperties={"2": self.mass(part)},
            **patterns,
        )

    def _children(self, parent: str) -> list[Part]:
        return [part for part in self.assembly.children(parent) if not part.id.endswith(f"/{OWN}")]

    def _bodies(self, part: Part) -> list[Any]:
        own = self.assembly.parts.get(f"{part.id}/{OWN}") if part.assembly else part
        return self.bodies(self, own) if self.bodies and own is not None else []

    def mass(self, part: Part) -> dict[str, int] | None:
        """kg, cm, about the component's origin."""
        if part.mass is None:
            return None
        m, c, a = part.mass["mass"], part.mass["center"], self.answers
        i = (part.mass["inertia"] + m * (c @ c * np.eye(3) - np.outer(c, c))) * 1e4
        moments = np.linalg.eigvalsh(part.mass["inertia"] * 1e4).tolist()
        return a.made(
            "PhysicalProperties", mass=m, centerOfMass=a.made("Point", asArray=Metres(c)),
            getXYZMomentsOfInertia=[True, i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[1, 2], i[0, 2]],
            getPrincipalMomentsOfInertia=[True, *moments],
        )  # fmt: skip

    def looks(self, part: Part) -> dict[str, Any]:
        """material and appearance of a body: sRGB and opacity as bytes."""
        if part.look is None:
            return {"material": None, "appearance": None}
        a, (r, g, b, opacity) = self.answers, part.look["srgb"]
        held = a.made("ColorProperty", value=a.made("Color", red=r, green=g, blue=b, opacity=opacity))
        shown = a.made(
            "Appearance",
            name="Glossy",
            appearanceProperties=a.made("Properties", itemById={'"opaque_albedo"': held}),
        )
        return {"material": a.made("Material", name=part.look["material"]), "appearance": shown}

    def matrix(self, rotation: np.ndarray, origin: np.ndarray) -> dict[str, int]:
        m = np.eye(4)
        m[:3, :3], m[:3, 3] = rotation, origin * 100.0
        return self.answers.made("Matrix", asArray=m.ravel().tolist())

    def _occurrence(self, part: Part) -> dict[str, int]:
        a = self.answers
        children = [self._occurrence(child) for child in self._children(part.id)]
        made = a.made(
            "Occurrence", name=part.name, fullPathName=part.id.removeprefix(self.assembly.root + "/").replace("/", "+"),
            component=self._component(part),
            transform2=self.matrix(part.rotation, part.origin), childOccurrences=self.listed(children),
            isGrounded=part.flags["grounded"], isLightBulbOn=part.flags["visible"],
            isGroundToParent=part.id in self.assembly.values.get("groundToParent", []),
        )  # fmt: skip
        self.occurrences[part.id] = self.occurrences[f"{part.id}/{OWN}"] = made
        return made

    def vector(self, v: np.ndarray) -> dict[str, int]:
        return self.answers.made("Vector", asArray=np.asarray(v).tolist())

    def limits(self, dof: dict[str, Any]) -> dict[str, int]:
        def value(key: str) -> Any:
            number = dof.get(key, 0.0)
            return Metres(number) if dof.get("name", "r")[0] == "t" else number

        return self.answers.made(
            "Limits", isMinimumValueEnabled=bool(dof.get("minEnabled")), minimumValue=value("min"),
            isMaximumValueEnabled=bool(dof.get("maxEnabled")), maximumValue=value("max"),
        )  # fmt: skip

    def _joint(self, j: dict[str, Any], as_built: bool) -> dict[str, int]:
        """The first occurrence moves against the second; the joint's axis is the frames' own X, the zero direction their Y."""
        a = self.answers
        dofs = {d["name"]: d for d in j.get("dof", [])}
        fa, fb = j["frameA"], j.get("frameB", j["frameA"])
        motion: dict[str, Any] = {"jointType": TYPES[j["type"]]}
        if "rz" in dofs:
            motion |= {
                "rotationAxisVector": self.vector(fa["z"]),
                "rotationValue": dofs["rz"].get("value", 0.0),
                "rotationLimits": self.limits(dofs["rz"]),
            }
        if j["type"] == "planar":
            motion |= {
                "normalDirectionVector": self.vector(fa["z"]),
                "primarySlideDirectionVector": self.vector(fa["x"]),
            }
            for word, key in (("primary", "tx"), ("secondary", "ty")):
                motion |= {
                    f"{word}SlideValue": Metres(dofs[key].get("value", 0.0)),
                    f"{word}SlideLimits": self.limits(dofs[key]),
                }
        if j["type"] == "pin_slot":
            motion |= {
                "slideDirectionVector": self.vector(fa["x"]),
                "slideValue": Metres(dofs["tx"].get("value", 0.0)),
                "slideLimits": self.limits(dofs["tx"]),
            }
        if j["type"] == "ball":
            motion |= {f"{word}Limits": self.limits(j.get("range", {})) for word in ("pitch", "yaw", "roll")}
        if "tz" in dofs:
            motion |= {
                "slideDirectionVector": self.vector(fa["z"]),
                "slideValue": Metres(dofs["tz"].get("value", 0.0)),
                "slideLimits": self.limits(dofs["tz"]),
            }
        answers: dict[str, Any] = {
            "name": j["id"], "jointMotion": a.made("Motion", **motion), "isSuppressed": False,
            "occurrenceOne": self.occurrences.get(j["b"]), "occurrenceTwo": self.occurrences.get(j["a"]),
        }  # fmt: skip
        if as_built:
            point = a.made("Point", asArray=Metres(fa["o"]))
            answers["geometry"] = a.made(
                "Geometry",
                origin=point,
                primaryAxisVector=self.vector(fa["z"]),
                secondaryAxisVector=self.vector(fa["x"]),
            )
        else:
            for word, at in (("One", fb), ("Two", fa)):
                axes = np.column_stack([at["z"], at["x"], np.cross(at["z"], at["x"])])
                answers[f"geometry{word}Transform"] = self.matrix(axes, at["o"])
            answers |= {"healthState": j.get("health", 0), "isLocked": False}
        return a.made("AsBuiltJoint" if as_built else "Joint", **answers)
