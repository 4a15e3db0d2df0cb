"""Materials of the shader that each render pipeline calls its standard one: Standard, URP Lit, HDRP Lit.

Colours stand in the file as sRGB, emission (an HDR property) linear.  Properties that are not written are the shader's defaults.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from ....color import encoded
from ....model import AlphaMode
from ....unity.scene import Color, Material, Vector2
from ..text.dialects import Dialect, Pipeline
from ..text.documents import HEAD
from ..text.yaml import HEADER, NULL, Fields, Plain, document, external, vector

MATERIAL_ID = 2100000
URP_VERSION_ID = 11400000
URP_VERSION_SCRIPT = external(11500000, "d0353a89b1f911e48b9e16bdc9f2e058", 3)
HIDDEN = 11
"""Hide flags of an object that neither hierarchy nor inspector shows, and that nobody edits."""
PREMULTIPLY, ALPHA = 1.0, 0.0
"""Blend modes of URP."""
SHADERS = {
    Pipeline.BUILTIN: external(46, "0000000000000000f000000000000000", 0),
    Pipeline.URP: external(4800000, "933532a4fcc9baf4fa0491de14d08ed7", 3),
    Pipeline.HDRP: external(4800000, "6e4ae4064600d784cac1e41a9e6f2e59", 3),
}
CUTOUT_QUEUE, TRANSPARENT_QUEUE = 2450, 3000
HDRP_OPAQUE_QUEUE, HDRP_CUTOUT_QUEUE = 2225, 2475
"""HDRP's queues of what takes decals."""


@dataclass(frozen=True, slots=True)
class Map:
    """A texture of a material: reference, and the part of it that is shown: uv' = scale * uv + offset."""

    texture: Plain
    scale: Vector2 = (1.0, 1.0)
    offset: Vector2 = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Maps:
    """color: where it has no texture it says how all maps lie, as the shaders place them alike (HDRP's emission by itself).
    packed: metallic in R, occlusion in G, smoothness in A.  occlusion: whether packed holds it."""

    color: Map
    normal: Map | None = None
    packed: Map | None = None
    metallic: bool = False
    occlusion: bool = False
    emission: Map | None = None


@dataclass(slots=True)
class _Sheet:
    """What a pipeline writes of a material, in no order."""

    keywords: set[str] = field(default_factory=set[str])
    queue: int = -1
    render_type: str = ""
    disabled: list[str] = field(default_factory=list[str])
    maps: dict[str, Map | None] = field(default_factory=dict[str, "Map | None"])
    floats: dict[str, float] = field(default_factory=dict[str, float])
    colors: dict[str, Color] = field(default_factory=dict[str, Color])


def material_asset(material: Material, name: str, maps: Maps, pipeline: Pipeline, dialect: Dialect) -> bytes:
    """The file."""
    if pipeline is Pipeline.URP:
        sheet, tail = _urp(material, maps, dialect), _urp_version(dialect)
    else:
        sheet, tail = (_builtin if pipeline is Pipeline.BUILTIN else _hdrp)(material, maps), ""
    text = document(21, "Material", MATERIAL_ID, _fields(material, name, sheet, pipeline, dialect))
    return (HEADER + text + tail).encode("ascii")


def _urp_version(dialect: Dialect) -> str:
    """The object by which URP knows which of its changes a material has seen (MaterialPostprocessor.cs in Unity's Graphics
    repository).  One without it is taken for the project's last state, or for the oldest, and then its emission is darkened."""
    fields: Fields = {
        **HEAD,
        "m_ObjectHideFlags": HIDDEN,
        "m_GameObject": NULL,
        "m_Enabled": 1,
        "m_EditorHideFlags": 0,
        "m_Script": URP_VERSION_SCRIPT,
        "m_Name": "",
        "m_EditorClassIdentifier": "",
        "version": dialect.urp_material,
    }
    return document(114, "MonoBehaviour", URP_VERSION_ID, fields)


def _fields(material: Material, name: str, sheet: _Sheet, pipeline: Pipeline, dialect: Dialect) -> Fields:
    keywords = sorted(sheet.keywords)
    told: Fields = {"m_ShaderKeywords": " ".join(keywords)}
    if dialect.valid_keywords:
        told = {
            "m_Parent": NULL,
            "m_ModifiedSerializedProperties": 0,
            "m_ValidKeywords": keywords,
            "m_InvalidKeywords": [],
        }
    locked: Fields = {"m_LockedProperties": ""} if dialect.valid_keywords else {}
    locking: Fields = {} if dialect.root_order else {"m_AllowLocking": 1}
    return {
        "serializedVersion": dialect.material,
        **HEAD,
        "m_Name": name,
        "m_Shader": SHADERS[pipeline],
        **told,
        "m_LightmapFlags": 2 if _shines(material) else 4,
        "m_EnableInstancingVariants": 0,
        "m_DoubleSidedGI": material.doubleSided,
        "m_CustomRenderQueue": sheet.queue,
        "stringTagMap": {"RenderType": sheet.render_type} if sheet.render_type else {},
        "disabledShaderPasses": sheet.disabled,
        **locked,
        "m_SavedProperties": _properties(sheet),
        "m_BuildTextureStacks": [],
        **locking,
    }


def _properties(sheet: _Sheet) -> Fields:
    integers: Fields = {"m_Ints": []}
    return {
        "serializedVersion": 3,
        "m_TexEnvs": [{key: _environment(sheet.maps[key])} for key in sorted(sheet.maps)],
        **integers,
        "m_Floats": [{key: float(sheet.floats[key])} for key in sorted(sheet.floats)],
        "m_Colors": [{key: vector(sheet.colors[key], "rgba")} for key in sorted(sheet.colors)],
    }


def _environment(shown: Map | None) -> Fields:
    shown = shown or Map(NULL)
    return {"m_Texture": shown.texture, "m_Scale": vector(shown.scale), "m_Offset": vector(shown.offset)}


def _shines(material: Material) -> bool:
    return any(material.emission)


def _common(material: Material, maps: Maps) -> _Sheet:
    """What all three have; each pipeline's colour and map also by the name that the converters between them look for."""
    blend = material.alphaMode is AlphaMode.BLEND
    sheet = _Sheet()
    color = srgb(material.color)
    sheet.colors = {"_Color": color, "_EmissionColor": (*material.emission, 1.0)}
    sheet.floats = {
        "_Cutoff": material.alphaCutoff,
        "_Metallic": material.metallic,
        "_Glossiness": material.smoothness,
        "_SrcBlend": 1.0,
        "_DstBlend": 10.0 if blend else 0.0,
        "_ZWrite": 0.0 if blend else 1.0,
        "_BumpScale": 1.0,
    }
    if blend:
        sheet.queue, sheet.render_type = TRANSPARENT_QUEUE, "Transparent"
    elif material.alphaMode is AlphaMode.MASK:
        sheet.queue, sheet.render_type = CUTOUT_QUEUE, "TransparentCutout"
        sheet.keywords.add("_ALPHATEST_ON")
    if maps.normal:
        sheet.keywords.add("_NORMALMAP")
    return sheet


def _builtin(material: Material, maps: Maps) -> _Sheet:
    sheet = _common(material, maps)
    if material.alphaMode is AlphaMode.BLEND:
        sheet.keywords.add("_ALPHAPREMULTIPLY_ON")
    if maps.packed and maps.metallic:
        sheet.keywords.add("_METALLICGLOSSMAP")
    if _shines(material):
        sheet.keywords.add("_EMISSION")
    modes = {AlphaMode.OPAQUE: 0.0, AlphaMode.MASK: 1.0, AlphaMode.BLEND: 3.0}
    sheet.floats |= {
        "_Mode": modes[material.alphaMode],
        "_GlossMapScale": 1.0,
        "_OcclusionStrength": 1.0,
        "_SmoothnessTextureChannel": 0.0,
        "_SpecularHighlights": 1.0,
        "_GlossyReflections": 1.0,
        "_UVSec": 0.0,
    }
    sheet.maps = {
        "_MainTex": maps.color,
        "_BumpMap": maps.normal,
        "_MetallicGlossMap": maps.packed if maps.metallic else None,
        "_OcclusionMap": maps.packed if maps.occlusion else None,
        "_EmissionMap": maps.emission,
    }
    return sheet


def _urp(material: Material, maps: Maps, dialect: Dialect) -> _Sheet:
    sheet = _builtin(material, maps)
    # from its sixth change on, URP tells what shines through glass undimmed from how colours blend
    premultiplied = PREMULTIPLY if dialect.urp_material < 6 else ALPHA
    blend = material.alphaMode is AlphaMode.BLEND
    if "_METALLICGLOSSMAP" in sheet.keywords:
        sheet.keywords.remove("_METALLICGLOSSMAP")
        sheet.keywords.add("_METALLICSPECGLOSSMAP")
    if maps.occlusion:
        sheet.keywords.add("_OCCLUSIONMAP")
    if blend:
        sheet.keywords.add("_SURFACE_TYPE_TRANSPARENT")
        sheet.disabled = ["DepthOnly", "SHADOWCASTER"]
    sheet.render_type = sheet.render_type or "Opaque"
    sheet.floats |= {
        "_WorkflowMode": 1.0,
        "_Surface": 1.0 if blend else 0.0,
        "_Blend": premultiplied if blend else ALPHA,
        "_BlendModePreserveSpecular": 1.0,
        "_SrcBlendAlpha": 1.0,
        "_DstBlendAlpha": 10.0 if blend else 0.0,
        "_AlphaClip": 1.0 if material.alphaMode is AlphaMode.MASK else 0.0,
        "_AlphaToMask": 1.0 if material.alphaMode is AlphaMode.MASK else 0.0,
        "_Cull": 0.0 if material.doubleSided else 2.0,
        "_Smoothness": 1.0 if maps.metallic else material.smoothness,
        "_ReceiveShadows": 1.0,
        "_EnvironmentReflections": 1.0,
        "_QueueOffset": 0.0,
    }
    sheet.colors["_BaseColor"] = sheet.colors["_Color"]
    sheet.maps["_BaseMap"] = maps.color
    return sheet


def _hdrp(material: Material, maps: Maps) -> _Sheet:
    sheet = _common(material, maps)
    blend, mask = material.alphaMode is AlphaMode.BLEND, material.alphaMode is AlphaMode.MASK
    sheet.keywords |= {"_DISABLE_SSR_TRANSPARENT", "_NORMALMAP_TANGENT_SPACE"}
    sheet.disabled = [
        "TransparentDepthPrepass",
        "TransparentDepthPostpass",
        "TransparentBackface",
        "RayTracingPrepass",
        "MOTIONVECTORS",
    ]
    if blend:
        sheet.keywords |= {"_SURFACE_TYPE_TRANSPARENT", "_ENABLE_FOG_ON_TRANSPARENT"}
    else:
        sheet.queue = HDRP_CUTOUT_QUEUE if mask else HDRP_OPAQUE_QUEUE
    if material.doubleSided:
        sheet.keywords.add("_DOUBLESIDED_ON")
    if maps.packed:
        sheet.keywords.add("_MASKMAP")
    if maps.emission:
        sheet.keywords.add("_EMISSIVE_COLOR_MAP")
    sided = 0.0 if material.doubleSided else 2.0
    sheet.floats |= {
        "_SurfaceType": 1.0 if blend else 0.0,
        "_BlendMode": 0.0,
        "_AlphaCutoffEnable": 1.0 if mask else 0.0,
        "_AlphaCutoff": material.alphaCutoff,
        "_AlphaSrcBlend": 1.0,
        "_AlphaDstBlend": 10.0 if blend else 0.0,
        "_CullMode": sided,
        "_CullModeForward": sided,
        "_DoubleSidedEnable": 1.0 if material.doubleSided else 0.0,
        "_DoubleSidedNormalMode": 1.0,
        "_MaterialID": 1.0,
        "_Metallic": 1.0 if maps.packed and maps.metallic else material.metallic,
        "_MetallicRemapMin": 0.0 if maps.metallic else material.metallic,
        "_MetallicRemapMax": 1.0 if maps.metallic else material.metallic,
        "_Smoothness": material.smoothness,
        "_SmoothnessRemapMin": 0.0 if maps.metallic else material.smoothness,
        "_SmoothnessRemapMax": 1.0 if maps.metallic else material.smoothness,
        "_AORemapMin": 0.0,
        "_AORemapMax": 1.0,
        "_NormalScale": 1.0,
        "_NormalMapSpace": 0.0,
        "_UseEmissiveIntensity": 0.0,
        "_EmissiveExposureWeight": 1.0,
        "_ZTestGBuffer": 3.0 if mask else 4.0,
        "_ZTestDepthEqualForOpaque": 4.0 if blend else 3.0,
        "_StencilRefDepth": 0.0 if blend else 8.0,
        "_StencilRefGBuffer": 2.0 if blend else 10.0,
        "_StencilRefMV": 32.0 if blend else 40.0,
    }
    sheet.colors |= {
        "_BaseColor": sheet.colors["_Color"],
        "_EmissiveColor": (*material.emission, 1.0),
        "_DoubleSidedConstants": (1.0, 1.0, -1.0, 0.0),
    }
    sheet.maps = {
        "_BaseColorMap": maps.color,
        "_MainTex": maps.color,
        "_NormalMap": maps.normal,
        "_MaskMap": maps.packed,
        "_EmissiveColorMap": maps.emission,
    }
    return sheet


def srgb(color: Color) -> Color:
    """A linear colour as the inspector shows it; alpha as it is."""
    r, g, b, a = color
    return (encoded(max(r, 0.0)), encoded(max(g, 0.0)), encoded(max(b, 0.0)), a)
