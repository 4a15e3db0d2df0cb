"""Attributes of a stage whose value is of another type than their schema has: told with their place, never a traceback."""

from __future__ import annotations

import kinefab
import pytest
from kinefab.diagnostics import KinefabError

STAGE = """#usda 1.0
(
    defaultPrim = "World"
    metersPerUnit = 1
    upAxis = "Y"
)
def Xform "World"
{
    def Scope "Looks"
    {
        def Material "Red"
        {
            token outputs:surface.connect = </World/Looks/Red/Surface.outputs:surface>
            def Shader "Surface"
            {
                uniform token info:id = "UsdPreviewSurface"
                color3f inputs:diffuseColor = (1, 0, 0)
                float inputs:metallic = 0.3
                color3f inputs:emissiveColor.connect = </World/Looks/Red/Image.outputs:rgb>
                token outputs:surface
            }
            def Shader "Image"
            {
                uniform token info:id = "UsdUVTexture"
                asset inputs:file = @there.png@
                float4 inputs:scale = (1, 1, 1, 1)
                float3 outputs:rgb
            }
        }
    }
    def Xform "Body" (prepend apiSchemas = ["PhysicsRigidBodyAPI", "PhysicsMassAPI"])
    {
        bool physics:kinematicEnabled = 0
        float physics:mass = 2
        point3f physics:centerOfMass = (0, 0, 0)
        float3 physics:diagonalInertia = (1, 1, 1)
        double3 xformOp:translate = (0, 1, 0)
        uniform token[] xformOpOrder = ["xformOp:translate"]
        def Points "Points" (prepend apiSchemas = ["PhysicsCollisionAPI"])
        {
            point3f[] points = [(0, 0, 0), (0, 1, 0)]
            float[] widths = [0.1, 0.2]
        }
        def Mesh "Mesh" (prepend apiSchemas = ["PhysicsCollisionAPI", "PhysicsMeshCollisionAPI", "MaterialBindingAPI"])
        {
            rel material:binding = </World/Looks/Red>
            point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
            int[] faceVertexCounts = [3, 3, 3, 3]
            int[] faceVertexIndices = [0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2]
            int[] holeIndices = []
            normal3f[] normals = [(0, 0, 1), (0, 0, 1), (0, 0, 1), (0, 0, 1)]
            texCoord2f[] primvars:st = [(0, 0), (1, 0), (0, 1), (1, 1)] (interpolation = "vertex")
            uniform token orientation = "rightHanded"
            uniform token subdivisionScheme = "none"
            uniform token physics:approximation = "convexHull"
            def GeomSubset "Some"
            {
                uniform token elementType = "face"
                uniform token familyName = "materialBind"
                int[] indices = [0, 1]
            }
        }
    }
    def PointInstancer "Copies"
    {
        rel prototypes = </World/Copies/Block>
        int[] protoIndices = [0, 0]
        point3f[] positions = [(5, 0, 0), (6, 0, 0)]
        quath[] orientations = [(1, 0, 0, 0), (1, 0, 0, 0)]
        def Cube "Block"
        {
            double size = 0.3
        }
    }
}
"""

MISTYPED = [
    ("float[] widths = [0.1, 0.2]", 'string widths = "2"'),
    ("float[] widths = [0.1, 0.2]", 'string[] widths = ["1", "2"]'),
    ("float[] widths = [0.1, 0.2]", "float3[] widths = [(1, 2, 3)]"),
    ("float[] widths = [0.1, 0.2]", "float widths = 0.3"),
    ("float[] widths = [0.1, 0.2]", "float[] widths = [0.1, nan]"),
    ("float[] widths = [0.1, 0.2]", "float[] widths = [0.1, 0.2, 0.3]"),
    ("float3 physics:diagonalInertia = (1, 1, 1)", 'string[] physics:diagonalInertia = ["1", "1", "1"]'),
    ("point3f physics:centerOfMass = (0, 0, 0)", 'token[] physics:centerOfMass = ["0", "0", "0"]'),
    ("double3 xformOp:translate = (0, 1, 0)", 'string xformOp:translate = "up"'),
    ("double3 xformOp:translate = (0, 1, 0)", "quatf xformOp:translate = (1, 0, 0, 0)"),
    (
        'uniform token[] xformOpOrder = ["xformOp:translate"]',
        'uniform token xformOpOrder = "xformOp:translate"',
    ),
    ("bool physics:kinematicEnabled = 0", 'string physics:kinematicEnabled = "no"'),
    ("float physics:mass = 2", 'string physics:mass = "2"'),
    ("float physics:mass = 2", "bool physics:mass = 1"),
    ("float physics:mass = 2", "float[] physics:mass = [2]"),
    (
        'uniform token physics:approximation = "convexHull"',
        'uniform token[] physics:approximation = ["convexHull"]',
    ),
    ("color3f inputs:diffuseColor = (1, 0, 0)", 'string inputs:diffuseColor = "red"'),
    ("float inputs:metallic = 0.3", 'token inputs:metallic = "high"'),
    ("asset inputs:file = @there.png@", 'string inputs:file = "there.png"'),
    ("float4 inputs:scale = (1, 1, 1, 1)", 'string inputs:scale = "full"'),
    ("int[] holeIndices = []", 'string holeIndices = "none"'),
    ("normal3f[] normals = [(0, 0, 1), (0, 0, 1), (0, 0, 1), (0, 0, 1)]", "float normals = 1"),
    (
        'texCoord2f[] primvars:st = [(0, 0), (1, 0), (0, 1), (1, 1)] (interpolation = "vertex")',
        "float primvars:st = 0.5",
    ),
    ('uniform token orientation = "rightHanded"', "float orientation = 1"),
    ('uniform token subdivisionScheme = "none"', "bool subdivisionScheme = 0"),
    ('uniform token familyName = "materialBind"', "float familyName = 1"),
    ("int[] indices = [0, 1]", 'string indices = "all"'),
    ("int[] protoIndices = [0, 0]", "float protoIndices = 1"),
    ("quath[] orientations = [(1, 0, 0, 0), (1, 0, 0, 0)]", "float[] orientations = [1, 2]"),
]


def findings(tmp_path, text: str) -> set[tuple[str, str]]:
    """Code and place of every finding."""
    source = tmp_path / "stage.usda"
    source.write_text(text)
    try:
        report = kinefab.export(source, tmp_path / "stage.kinefab").report
    except KinefabError as error:
        report = error.report
    return {(found.code, found.where or "") for found in [*report.diagnostics, *report.outcomes]}


@pytest.mark.parametrize("right, wrong", MISTYPED, ids=[wrong.split(" = ")[0] for _, wrong in MISTYPED])
def test_a_value_of_another_type_than_its_schema_s_is_told_where_it_stands(tmp_path, right, wrong):
    pytest.importorskip("pxr")
    (tmp_path / "there.png").write_bytes(b"\x89PNG\r\n\x1a\n")
    assert right in STAGE
    name = right.split(" = ")[0].split()[-1]
    fresh = findings(tmp_path, STAGE.replace(right, wrong)) - findings(tmp_path, STAGE)
    assert any(
        where.endswith(f".{name}>") or where.endswith(f".{name.rpartition(':')[2]}>") for _, where in fresh
    )
