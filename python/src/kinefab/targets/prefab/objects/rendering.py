"""What is drawn: MeshFilter, MeshRenderer, and the Animation that plays clips."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

from ..text.dialects import Dialect
from ..text.documents import COMPONENT, component_head, version
from ..text.forms import BLANK, Form
from ..text.yaml import NULL, Fields, Plain, local

FIXED = 1
"""In step with the solver, which kinematic bodies want; newer editors ask by another field."""

_FILTER = Form(33, "MeshFilter", {**COMPONENT, "m_Mesh": BLANK})


def mesh_filter(file_id: int, owner: int, mesh: Plain) -> str:
    """The document.  owner: fileID of the GameObject.  mesh: a reference."""
    return _FILTER.filled(file_id, local(owner), mesh)


def mesh_renderer(
    file_id: int, owner: int, enabled: bool, materials: Sequence[Plain], dialect: Dialect
) -> str:
    """The document.  materials: references, one for each submesh."""
    return _renderer(len(materials), dialect).filled(file_id, local(owner), int(enabled), *materials)


@lru_cache(maxsize=64)
def _renderer(materials: int, dialect: Dialect) -> Form:
    tracing: Fields = {"m_RayTracingMode": 2, "m_RayTraceProcedural": 0}
    if not dialect.root_order:
        tracing = {
            **tracing,
            "m_RayTracingAccelStructBuildFlagsOverride": 0,
            "m_RayTracingAccelStructBuildFlags": 1,
            "m_SmallMeshCulling": 1,
        }
    fields: Fields = {
        **COMPONENT,
        "m_Enabled": BLANK,
        "m_CastShadows": 1,
        "m_ReceiveShadows": 1,
        "m_DynamicOccludee": 1,
        "m_StaticShadowCaster": 0,
        "m_MotionVectors": 1,
        "m_LightProbeUsage": 1,
        "m_ReflectionProbeUsage": 1,
        **tracing,
        "m_RenderingLayerMask": 1,
        "m_RendererPriority": 0,
        "m_Materials": [BLANK] * materials,
        "m_StaticBatchInfo": {"firstSubMesh": 0, "subMeshCount": 0},
        "m_StaticBatchRoot": NULL,
        "m_ProbeAnchor": NULL,
        "m_LightProbeVolumeOverride": NULL,
        "m_ScaleInLightmap": 1,
        "m_ReceiveGI": 1,
        "m_PreserveUVs": 0,
        "m_IgnoreNormalsForChartDetection": 0,
        "m_ImportantGI": 0,
        "m_StitchLightmapSeams": 1,
        "m_SelectedEditorRenderState": 3,
        "m_MinimumChartSize": 4,
        "m_AutoUVMaxDistance": 0.5,
        "m_AutoUVMaxAngle": 89,
        "m_LightmapParameters": NULL,
        "m_SortingLayerID": 0,
        "m_SortingLayer": 0,
        "m_SortingOrder": 0,
        "m_AdditionalVertexStreams": NULL,
    }
    return Form(23, "MeshRenderer", fields)


def animation_fields(owner: int, clips: Sequence[Plain], plays: bool, dialect: Dialect) -> Fields:
    """plays: the first of the clips, when the object wakes; each clip says itself how it repeats."""
    mode: Fields = {"m_UpdateMode": FIXED} if dialect.animation > 3 else {}
    return {
        **component_head(owner),
        "m_Enabled": 1,
        **version(dialect.animation),
        "m_Animation": clips[0],
        "m_Animations": list(clips),
        "m_WrapMode": 0,
        "m_PlayAutomatically": plays,
        "m_AnimatePhysics": FIXED,
        **mode,
        "m_CullingType": 0,
    }
