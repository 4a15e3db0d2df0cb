"""The looks of a trimesh mesh in the model's terms: materials, textures, and colours of faces and vertices."""

from __future__ import annotations

import hashlib
import io
import math
from dataclasses import dataclass, replace
from pathlib import PurePosixPath
from typing import Any

import numpy as np

from ...color import linear
from ...model import AlphaMode, Surface, Texture
from ...spatial import Array, IntArray

MOST_SURFACES = 32
"""Colours of one mesh's faces that become surfaces, a draw call each; more of them become colours of vertices."""
WHITE = Surface("Vertex colors", (1.0, 1.0, 1.0, 1.0))
"""What colours of vertices are multiplied with."""
FULL, GREY = np.array([255, 255, 255, 255]), np.array([102, 102, 102, 255])
"""What a texture is multiplied with where no colour is stated, and what trimesh says then."""
FILES = {"PNG": (b"\x89PNG\r\n\x1a\n", "png"), "JPEG": (b"\xff\xd8\xff", "jpg")}
"""Beginning and ending of the files that every target takes, by PIL's name of them."""
PLAIN = ("1", "L", "LA", "P", "RGB", "RGBA", "I;16")
"""PIL's names of the pixels that both have."""


@dataclass(frozen=True, slots=True, eq=False)
class Look:
    """How a mesh of m faces looks.

    order: the faces in the order of their surfaces, shape (m,), or None for the order they have.
    face_counts, surfaces: for each run of faces its length and its surface (None: the source says nothing).
    uv: shape (n, 2), v upwards, or None.  colors: linear RGBA of the vertices, shape (n, 4), or None.
    corners: the vertices that the mesh is to have, indices into its own, shape (k, 3 m) flat, where faces that meet in a
        vertex differ in colour: the faces are then 0 1 2, 3 4 5 ...; else None.
    """

    order: IntArray | None
    face_counts: tuple[int, ...]
    surfaces: tuple[Surface | None, ...]
    uv: Array | None = None
    colors: Array | None = None
    corners: IntArray | None = None


def look_of(mesh: Any, gltf: bool = False, screen: bool = False) -> Look:
    """The look of a trimesh.Trimesh or of anything that has its ``visual``.

    gltf: it comes from a glTF file, whose absent factors and linear colours of vertices mean what glTF says.
    screen: all its colours are those of the screen, as a Collada file's are; else those of a PBRMaterial are linear.
    """
    count = len(mesh.faces)
    visual = getattr(mesh, "visual", None)
    if visual is None or not getattr(visual, "defined", True):
        return Look(None, (count,), (None,))
    kind = getattr(visual, "kind", None)
    if kind == "face":
        return _of_faces(np.asarray(visual.face_colors), mesh)
    if kind == "vertex":
        return _of_vertices(np.asarray(visual.vertex_colors), mesh, gltf)
    material = getattr(visual, "material", None)
    uv = getattr(visual, "uv", None)
    attributes: Any = getattr(visual, "vertex_attributes", None)
    colors: Any = attributes.get("color") if hasattr(attributes, "get") else None
    fits = uv is not None and np.shape(uv) == (len(mesh.vertices), 2)
    surface = None if material is None else surface_of(material, gltf, screen)
    of_vertices = None
    if colors is not None and len(colors) == len(mesh.vertices):
        of_vertices = linear_colors(np.asarray(colors), gltf)
    return Look(None, (count,), (surface,), np.asarray(uv, dtype=np.float64) if fits else None, of_vertices)


def surface_of(material: Any, gltf: bool = False, screen: bool = False) -> Surface | None:
    """Of a trimesh SimpleMaterial (Phong), PBRMaterial (glTF) or MultiMaterial (its first)."""
    if getattr(material, "materials", None):
        return surface_of(material.materials[0], gltf, screen)
    if not hasattr(material, "main_color"):
        return None
    physical = hasattr(material, "baseColorFactor")
    image = getattr(material, "baseColorTexture" if physical else "image", None)
    shown = np.asarray(material.main_color)
    if physical and material.baseColorFactor is None and (gltf or image is not None):
        shown = FULL
    elif not physical and image is not None and (shown == GREY).all():
        shown = FULL  # what trimesh calls a colour that nobody states
    name = str(getattr(material, "name", None) or _hex(shown))
    red, green, blue, alpha = (float(c) for c in shown / 255.0)
    if screen or not physical:
        red, green, blue = from_screen((red, green, blue))
    if physical:
        found = _of_pbr(name, material, (red, green, blue, alpha), gltf)
        if not screen:
            return found
        if found.emission_texture is not None:  # trimesh has the base colour's there
            found = replace(found, emission_texture=None, emission=(0.0, 0.0, 0.0))
        return replace(found, emission=from_screen(found.emission))
    return Surface(
        name,
        (red, green, blue, alpha),
        0.0,
        phong_smoothness(getattr(material, "glossiness", 0.0)),
        AlphaMode.BLEND if alpha < 1.0 else AlphaMode.OPAQUE,
        color_texture=_texture(image, name, "color"),
    )


def phong_smoothness(exponent: Any) -> float:
    """Of a Blinn-Phong exponent n: alpha^2 = 2 / (n + 2); smoothness = 1 - alpha."""
    return 1.0 - math.sqrt(2.0 / (max(0.0, float(exponent or 0.0)) + 2.0))


def _of_pbr(name: str, m: Any, color: tuple[float, float, float, float], gltf: bool) -> Surface:
    def factor(attribute: str, absent: float) -> float:
        value = getattr(m, attribute, None)
        return absent if value is None else min(1.0, max(0.0, float(value)))

    blend = _texture(getattr(m, "metallicRoughnessTexture", None), name, "metallic-roughness")
    glow = _texture(getattr(m, "emissiveTexture", None), name, "emission")
    whole = gltf or blend is not None  # what multiplies a texture is one where nothing is said
    emitted = getattr(m, "emissiveFactor", None)
    if emitted is None:
        emitted = (1.0, 1.0, 1.0) if glow is not None and not gltf else (0.0, 0.0, 0.0)
    stated = str(getattr(m, "alphaMode", None) or "").upper()
    modes = {"OPAQUE": AlphaMode.OPAQUE, "MASK": AlphaMode.MASK, "BLEND": AlphaMode.BLEND}
    absent = AlphaMode.BLEND if color[3] < 1.0 and not gltf else AlphaMode.OPAQUE
    mode = modes.get(stated, absent)
    if mode is AlphaMode.OPAQUE:
        color = (*color[:3], 1.0)  # of which glTF has alpha ignored
    return Surface(
        name,
        color,
        factor("metallicFactor", 1.0 if whole else 0.0),
        1.0 - factor("roughnessFactor", 1.0 if whole else 0.5),
        mode,
        factor("alphaCutoff", 0.5),
        bool(getattr(m, "doubleSided", None)),
        (float(emitted[0]), float(emitted[1]), float(emitted[2])),
        _texture(getattr(m, "baseColorTexture", None), name, "color"),
        _texture(getattr(m, "normalTexture", None), name, "normal"),
        blend,
        _texture(getattr(m, "occlusionTexture", None), name, "occlusion"),
        glow,
    )


def _texture(image: Any, material: str, role: str) -> Texture | None:
    """A PIL image, named by what it holds so that different ones never share a name."""
    if image is None or not hasattr(image, "save"):
        return None
    data, ending = _file_of(image) or (_as_png(image), "png")
    stem = PurePosixPath(str(image.info.get("file_path", "")).replace("\\", "/")).stem or f"{material} {role}"
    name = f"{stem}-{hashlib.sha256(data).hexdigest()[:8]}.{ending}"
    return Texture(name, data=data, media_type=f"image/{ending.replace('jpg', 'jpeg')}")


def _file_of(image: Any) -> tuple[bytes, str] | None:
    """Bytes and ending of the file that an image was opened from, as long as nobody has asked for its pixels.

    Packing pixels anew takes a hundred times as long as reading a robot, and loses what a JPEG has gained.
    """
    stream, (magic, ending) = getattr(image, "fp", None), FILES.get(str(image.format), (b"", ""))
    if stream is None or not ending or image.mode not in PLAIN:
        return None
    at = stream.tell()
    stream.seek(0)
    data = bytes(stream.read())
    stream.seek(at)
    return (data, ending) if data.startswith(magic) else None


def _as_png(image: Any) -> bytes:
    written = io.BytesIO()
    plain = image if image.mode in PLAIN else image.convert("RGBA")
    plain.save(written, format="PNG")
    return written.getvalue()


def _of_faces(colors: Array, mesh: Any) -> Look:
    """A surface for each colour; of more than ``MOST_SURFACES`` colours of corners, which the faces then own alone."""
    count = len(mesh.faces)
    found, first, number = np.unique(colors, axis=0, return_index=True, return_inverse=True)
    if len(found) > MOST_SURFACES:
        corners = np.asarray(mesh.faces, dtype=np.int64).reshape(-1)
        return Look(
            None, (count,), (WHITE,), None, np.repeat(linear_colors(colors, False), 3, axis=0), corners
        )
    by_use = np.argsort(first, kind="stable")  # in the order in which the faces name them
    rank = np.argsort(by_use, kind="stable")[np.reshape(number, -1)]
    order = np.argsort(rank, kind="stable")
    counts = np.bincount(rank, minlength=len(found))
    surfaces = tuple(_colored(found[i]) for i in by_use)
    return Look(order if len(found) > 1 else None, tuple(counts.tolist()), surfaces)


def _of_vertices(colors: Array, mesh: Any, gltf: bool) -> Look:
    """A surface where all vertices have one colour, else colours of the vertices."""
    count = len(mesh.faces)
    used = colors[np.unique(mesh.faces)] if len(colors) == len(mesh.vertices) else colors
    if (used == used[0]).all() and not gltf:
        return Look(None, (count,), (_colored(used[0]),))
    if (used == used[0]).all():
        red, green, blue, alpha = (float(c) for c in linear_colors(used[:1], gltf)[0])
        return Look(None, (count,), (Surface(_hex(used[0]), (red, green, blue, alpha)),))
    return Look(None, (count,), (WHITE,), None, linear_colors(colors, gltf))


def _colored(color: Array) -> Surface:
    red, green, blue, alpha = (float(c) for c in linear_colors(color[None], False)[0])
    mode = AlphaMode.BLEND if alpha < 1.0 else AlphaMode.OPAQUE
    return Surface(_hex(color), (red, green, blue, alpha), alpha_mode=mode)


def _hex(color: Array) -> str:
    values = [int(c) for c in color]
    return "#" + "".join(f"{c:02x}" for c in (values if len(values) < 4 or values[3] < 255 else values[:3]))


def from_screen(color: tuple[float, float, float]) -> tuple[float, float, float]:
    """Red, green and blue as Phong's materials have them, sRGB, as linear ones: programs that show such files
    show the numbers as they stand.  May exceed 1, as emission does."""
    red, green, blue = map(linear, color)
    return red, green, blue


def linear_colors(colors: Array, stated_linear: bool) -> Array:
    """Bytes, shape (n, 3 or 4), as linear RGBA, shape (n, 4).  stated_linear: they are already; else sRGB."""
    values = np.asarray(colors, dtype=np.float64)
    values = np.clip(values / 255.0 if np.asarray(colors).dtype.kind in "ui" else values, 0.0, 1.0)
    if values.shape[1] == 3:
        values = np.column_stack([values, np.ones(len(values))])
    if not stated_linear:
        rgb = values[:, :3]  # as ``linear`` has it, all at once
        values[:, :3] = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    return values
