"""One body, the same tetrahedron, as each program facets it: 30, 20 and 50 mm along the part's axes."""

from __future__ import annotations

from typing import Any

import numpy as np
from cad.documented import Metres
from cad.fusion import Fusion
from cad.inventor import Inventor
from cad.solidworks import SolidWorks

POINTS = np.array([[0.0, 0.0, 0.0], [0.03, 0.0, 0.0], [0.0, 0.02, 0.0], [0.0, 0.0, 0.05]])
FACES = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]


def painted(part: Any) -> int:
    """How many of its faces have a colour of their own."""
    return (part.look or {}).get("painted", 0)


def inventor_bodies(double: Inventor, part: Any) -> list[Any]:
    if part.assembly:
        return []
    points, corners = (POINTS * 100.0).ravel().tolist(), [i + 1 for face in FACES for i in face]
    facets = {"0.005": [4, 4, points, [0.0] * 12, corners]}
    return [double.answers.made("Body", Name="Solid1", CalculateFacets=facets, Appearance=double.asset(part))]


def solidworks_bodies(double: SolidWorks, part: Any) -> list[Any] | None:
    if part.assembly:
        return None
    faces = [
        double.answers.made(
            "Face", GetTessTriangles={"true": POINTS[face].ravel().tolist()}, HasMaterialPropertyValues=i < painted(part)
        )
        for i, face in enumerate(FACES)
    ]  # fmt: skip
    return [double.answers.made("Body", Name="Solid1", GetFaces=faces)]


def fusion_bodies(double: Fusion, part: Any) -> list[Any]:
    a = double.answers
    points = Metres(POINTS.ravel())
    mesh = a.made("Mesh", nodeCoordinatesAsDouble=points, nodeIndices=[i for face in FACES for i in face])
    calculator = a.made("MeshCalculator", setQuality={"11": True}, calculate=mesh)
    manager = a.made("MeshManager", createMeshCalculator=calculator)
    faces = a.listed(
        [a.made("Face", appearanceSourceType=3 if i < painted(part) else 1) for i in range(len(FACES))],
        count="count", item="item", first=0,
    )  # fmt: skip
    weighed = {"2": double.mass(part)}
    return [
        a.made(
            "Body",
            name="Solid1",
            meshManager=manager,
            getPhysicalProperties=weighed,
            faces=faces,
            **double.looks(part),
        )
    ]
