"""The ``.meta`` beside each file: its guid, and which importer reads it."""

from __future__ import annotations

from pathlib import Path

from .yaml import Fields, Plain, lines

_TAIL: Fields = {"userData": "", "assetBundleName": "", "assetBundleVariant": ""}
_HEAD: Fields = {"externalObjects": Plain("{}")}


def _meta(guid: str, importer: str, fields: Fields, before: str = "") -> str:
    block = "\n".join(lines(fields))
    return f"fileFormatVersion: 2\nguid: {guid}\n{before}{importer}:\n{block}\n"


def guid_in(meta: Path) -> str:
    """Of a meta that is there, whoever wrote it; "" where there is none."""
    try:
        text = meta.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return ""
    return next((line.removeprefix("guid: ").strip() for line in text if line.startswith("guid: ")), "")


def folder_meta(guid: str) -> str:
    return _meta(guid, "DefaultImporter", {**_HEAD, **_TAIL}, "folderAsset: yes\n")


def prefab_meta(guid: str) -> str:
    return _meta(guid, "PrefabImporter", {**_HEAD, **_TAIL})


def native_meta(guid: str, main_object: int) -> str:
    """Of an asset in Unity's own YAML."""
    return _meta(guid, "NativeFormatImporter", {**_HEAD, "mainObjectFileID": main_object, **_TAIL})


def script_meta(guid: str) -> str:
    fields: Fields = {**_HEAD, "serializedVersion": 2, "defaultReferences": [], "executionOrder": 0}
    return _meta(guid, "MonoImporter", {**fields, "icon": Plain("{instanceID: 0}"), **_TAIL})


def assembly_meta(guid: str) -> str:
    return _meta(guid, "AssemblyDefinitionImporter", {**_HEAD, **_TAIL})


def simple_meta(guid: str, importer: str) -> str:
    """Of an importer that has no settings."""
    return _meta(guid, importer, {**_HEAD, **_TAIL})


def plugin_meta(guid: str) -> str:
    """Of a managed library for every platform, seen only by assemblies that name it."""
    fields: Fields = {
        **_HEAD,
        "serializedVersion": 2,
        "iconMap": Plain("{}"),
        "executionOrder": Plain("{}"),
        "defineConstraints": [],
        "isPreloaded": 0,
        "isOverridable": 0,
        "isExplicitlyReferenced": 1,
        "validateReferences": 1,
        "platformData": [
            {"first": {"Any": ""}, "second": {"enabled": 1, "settings": Plain("{}")}},
            {
                "first": {"Editor": "Editor"},
                "second": {"enabled": 0, "settings": {"DefaultValueInitialized": "true"}},
            },
        ],
    }
    return _meta(guid, "PluginImporter", {**fields, **_TAIL})


def scripted_meta(guid: str, importer: str) -> str:
    """Of a file that a ScriptedImporter reads, with its settings as the script has them.  importer: the script's guid."""
    fields: Fields = {"internalIDToNameTable": [], **_HEAD, "serializedVersion": 2, **_TAIL}
    script = Plain(f"{{fileID: 11500000, guid: {importer}, type: 3}}")
    return _meta(guid, "ScriptedImporter", {**fields, "script": script})


LARGEST_TEXTURE = 16384
"""Pixels of a side: Unity's own most, so that no image is made smaller when it is imported."""


def texture_meta(guid: str, srgb: bool, normal: bool, wrap: int) -> str:
    """srgb: whether its numbers are colours.  wrap: Unity's number of what lies beyond the edge."""
    fields: Fields = {
        "internalIDToNameTable": [],
        **_HEAD,
        "serializedVersion": 11,
        "mipmaps": {
            "mipMapMode": 0,
            "enableMipMap": 1,
            "sRGBTexture": srgb,
            "linearTexture": 0,
            "fadeOut": 0,
            "borderMipMap": 0,
            "mipMapsPreserveCoverage": 0,
            "alphaTestReferenceValue": 0.5,
            "mipMapFadeDistanceStart": 1,
            "mipMapFadeDistanceEnd": 3,
        },
        "bumpmap": {
            "convertToNormalMap": 0,
            "externalNormalMap": 0,
            "heightScale": 0.25,
            "normalMapFilter": 0,
        },
        "isReadable": 0,
        "streamingMipmaps": 0,
        "streamingMipmapsPriority": 0,
        "grayScaleToAlpha": 0,
        "generateCubemap": 6,
        "cubemapConvolution": 0,
        "seamlessCubemap": 0,
        "textureFormat": 1,
        "maxTextureSize": LARGEST_TEXTURE,
        "textureSettings": {
            "serializedVersion": 2,
            "filterMode": 1,
            "aniso": 1,
            "mipBias": 0,
            "wrapU": wrap,
            "wrapV": wrap,
            "wrapW": wrap,
        },
        "nPOTScale": 0,  # 1 makes sides powers of two, so that images of other sizes are drawn anew
        "lightmap": 0,
        "compressionQuality": 50,
        "spriteMode": 0,
        "alphaUsage": 1,
        "alphaIsTransparency": 0,
        "textureType": 1 if normal else 0,
        "textureShape": 1,
        "platformSettings": [
            {
                "serializedVersion": 3,
                "buildTarget": "DefaultTexturePlatform",
                "maxTextureSize": LARGEST_TEXTURE,
                "resizeAlgorithm": 0,
                "textureFormat": -1,
                "textureCompression": 1,
                "compressionQuality": 50,
                "crunchedCompression": 0,
                "allowsAlphaSplitting": 0,
                "overridden": 0,
                "androidETC2FallbackOverride": 0,
                "forceMaximumCompressionQuality_BC6H_BC7": 0,
            }
        ],
        **_TAIL,
    }
    return _meta(guid, "TextureImporter", fields)
