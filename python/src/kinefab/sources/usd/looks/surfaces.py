"""Materials: UsdPreviewSurface as the model's Surface, with its textures."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, TypeVar

from ....diagnostics import Report
from ....model import AlphaMode, Surface, Texture
from ..api import UsdGeom, UsdShade
from ..found import Piece
from ..prims import source_path
from ..stage import OpenStage
from ..values import Values, shown
from .textures import Sampler, read_fallback, read_sampler

T = TypeVar("T")

DISPLAYED = (0.5, 0.5, 0.5)
"""Colour of a prim that states none, as UsdGeom's fallback has it in viewers."""


@dataclass(slots=True, eq=False)
class Surfaces:
    """The scene's surfaces, each once.  by_material: index by the material's path; by_color: of plain display colours."""

    opened: OpenStage
    values: Values
    report: Report
    surfaces: list[Surface] = field(default_factory=list[Surface])
    _by_material: dict[str, int | None] = field(default_factory=dict[str, int | None])
    _by_color: dict[tuple[float, ...], int] = field(default_factory=dict[tuple[float, ...], int])
    _bound: dict[str, Any] = field(default_factory=dict[str, Any])
    _names: set[str] = field(default_factory=set[str])

    def resolve(self, prims: Mapping[str, Any]) -> None:
        """Find the materials of many prims, by their paths, in one go, which is far cheaper than one by one."""
        fresh = [path for path in prims if path not in self._bound]
        if not fresh:
            return
        asked = [prims[path] for path in fresh]
        materials, _ = UsdShade.MaterialBindingAPI.ComputeBoundMaterials(asked, UsdShade.Tokens.full)
        for path, material in zip(fresh, materials):
            self._bound[path] = material.GetPrim() if material else None

    def of(
        self, piece: Piece, subsets: tuple[Any, ...], uv_names: tuple[str, ...], colored: bool
    ) -> tuple[int, ...]:
        """Index of a surface for each submesh of a piece; () where it says nothing of its looks.

        subsets: see ``Polygons``.  colored: its vertices have colours of their own, so the surface is white.
        """
        if not piece.dressed and not colored and subsets == (None,):
            return ()
        paths = ["" if subset is None else str(subset.GetPath()) for subset in subsets]
        self.resolve({piece.path: piece.prim, **{p: s for p, s in zip(paths, subsets) if p}})
        found: list[int | None] = []
        for path in paths:
            material = self._bound.get(path) or self._bound[piece.path]
            index = None if material is None else self._of_material(material, uv_names)
            found.append(self._displayed(piece.prim, colored) if index is None else index)
        return tuple(i for i in found if i is not None) if None not in found else ()

    def _displayed(self, prim: Any, colored: bool) -> int | None:
        api = UsdGeom.PrimvarsAPI(prim)
        color, opacity = (
            _constant(api.FindPrimvarWithInheritance(name)) for name in ("displayColor", "displayOpacity")
        )
        if color is None and opacity is None and not colored:
            return None
        rgb = (
            (1.0, 1.0, 1.0)
            if colored
            else tuple(color)
            if color is not None and len(color) == 3
            else DISPLAYED
        )
        rgba = (*rgb, opacity[0] if opacity else 1.0)
        key = tuple(round(min(1.0, max(0.0, c)), 6) if math.isfinite(c) else 0.0 for c in rgba)
        if key not in self._by_color:
            mode = AlphaMode.OPAQUE if key[3] >= 1.0 else AlphaMode.BLEND
            name = self._unique("Color " + " ".join(f"{c:g}" for c in key))
            self.surfaces.append(Surface(name, (key[0], key[1], key[2], key[3]), alpha_mode=mode))
            self._by_color[key] = len(self.surfaces) - 1
        return self._by_color[key]

    def _unique(self, name: str) -> str:
        wanted, count = name, 1
        while wanted in self._names:
            count += 1
            wanted = f"{name} {count}"
        self._names.add(wanted)
        return wanted

    def _of_material(self, material: Any, uv_names: tuple[str, ...]) -> int | None:
        key = f"{source_path(material)}|{'|'.join(uv_names)}"
        if key not in self._by_material:
            surface = self._read(material, uv_names)
            if surface is not None:
                self.surfaces.append(surface)
            self._by_material[key] = None if surface is None else len(self.surfaces) - 1
        return self._by_material[key]

    def _read(self, material: Any, uv_names: tuple[str, ...]) -> Surface | None:
        where, feature = self.opened.place(material), f"material {material.GetPath()}"
        shader = UsdShade.Material(material).ComputeSurfaceSource()[0]
        kind = (
            ""
            if not shader
            else str(shader.GetIdAttr().Get() or shader.GetSourceAssetSubIdentifier("mdl") or "")
        )
        if kind == "UsdPreviewSurface":
            return self._preview(material, shader, uv_names)
        if not shader and not UsdShade.Material(material).GetOutputs():
            return None  # a physics material
        names = {
            "diffuse_color_constant": "color",
            "metallic_constant": "metallic",
            "reflection_roughness_constant": "roughness",
        }
        found: dict[str, Any] = {}
        for prim in [shader.GetPrim()] if shader else material.GetChildren():
            for source, wanted in names.items():
                name = f"inputs:{source}"
                if self.values.get(prim, name) is None:
                    continue
                if wanted == "color":
                    found[wanted] = self.values.vector(prim, name, (0.8, 0.8, 0.8))
                else:
                    found[wanted] = self.values.number(prim, name, 0.5)
        self.report.approximated(feature, "USD_MATERIAL_UNKNOWN", where, kind=kind or "none")
        color = found.get("color", (0.8, 0.8, 0.8))
        return Surface(
            self._unique(self.values.title(material)), (_unit(color[0]), _unit(color[1]), _unit(color[2]), 1.0),
            _unit(found.get("metallic", 0.0)), 1.0 - _unit(found.get("roughness", 0.5)),
        )  # fmt: skip

    def _preview(self, material: Any, shader: Any, uv_names: tuple[str, ...]) -> Surface:
        where, feature = self.opened.place(material), f"material {material.GetPath()}"
        inputs = _Inputs(shader, uv_names, self.opened, self.values, self.report)
        diffuse = inputs.sampler("diffuseColor")
        opacity = inputs.sampler("opacity")
        metal, rough = inputs.sampler("metallic"), inputs.sampler("roughness")
        alpha = inputs.number("opacity", 1.0)
        threshold = inputs.number("opacityThreshold", 0.0)
        if opacity is not None and (
            diffuse is None or opacity.texture.name != diffuse.texture.name or opacity.output != "a"
        ):
            inputs.lost("opacity", "its texture is not the alpha of the base colour's")
            opacity = None
        packed = None
        for name, sampler, channel in (("metallic", metal, "b"), ("roughness", rough, "g")):
            if sampler is None:
                continue
            if sampler.output == channel and (packed is None or packed.name == sampler.texture.name):
                packed = sampler.texture
            else:
                inputs.lost(name, f"Unity's map has it in {channel}, the texture gives {sampler.output}")
        for name, default in (("clearcoat", 0.0), ("displacement", 0.0)):
            if inputs.number(name, default) != default or inputs.sampler(name) is not None:
                inputs.lost(name, "there is no such thing in Unity's standard surface")
        if inputs.number("useSpecularWorkflow", 0.0):
            self.report.approximated(feature, "USD_MATERIAL_UNKNOWN", where, kind="the specular workflow")
        base = diffuse.tint if diffuse else inputs.color("diffuseColor", (0.18, 0.18, 0.18))
        emissive, occlusion = inputs.sampler("emissiveColor"), inputs.sampler("occlusion")
        if occlusion is not None and occlusion.output not in ("r", "rgb"):
            inputs.lost("occlusion", f"Unity's map has it in r, the texture gives {occlusion.output}")
            occlusion = None
        mode = (
            AlphaMode.MASK
            if threshold > 0.0
            else AlphaMode.BLEND
            if alpha < 1.0 or opacity
            else AlphaMode.OPAQUE
        )
        return Surface(
            self._unique(self.values.title(material)),
            (
                _unit(base[0]),
                _unit(base[1]),
                _unit(base[2]),
                _unit(alpha if opacity is None else opacity.alpha),
            ),
            _unit(metal.tint[2] if metal and packed else inputs.number("metallic", 0.0)),
            1.0 - _unit(rough.tint[1] if rough and packed else inputs.number("roughness", 0.5)),
            mode,
            _unit(threshold) if mode is AlphaMode.MASK else 0.5,
            False,
            _emission(emissive.tint if emissive else inputs.color("emissiveColor", (0.0, 0.0, 0.0))),
            diffuse.texture if diffuse else None,
            _texture(inputs.sampler("normal")),
            packed,
            _texture(occlusion),
            emissive.texture if emissive else None,
        )


@dataclass(frozen=True, slots=True, eq=False)
class _Inputs:
    """Inputs of one shader: constants, and what is connected to them.  fallbacks: of images that are not there."""

    shader: Any
    uv_names: tuple[str, ...]
    opened: OpenStage
    values: Values
    report: Report
    fallbacks: dict[str, float | tuple[float, ...]] = field(
        default_factory=dict[str, float | tuple[float, ...]]
    )

    def _value(self, name: str) -> Any:
        if name in self.fallbacks:
            return self.fallbacks[name]
        given = self.shader.GetInput(name)
        if not given:
            return None
        for attribute in given.GetValueProducingAttributes():
            if attribute.GetPrim() == self.shader.GetPrim() or not UsdShade.Shader(attribute.GetPrim()):
                return attribute.Get()
        return None

    def number(self, name: str, default: float) -> float:
        value = self._value(name)
        if value is None:
            return default
        if isinstance(value, bool) or not isinstance(value, (float, int)) or not math.isfinite(value):
            return self._wrong(name, value, default)
        return float(value)

    def color(self, name: str, default: tuple[float, float, float]) -> tuple[float, float, float]:
        value = self._value(name)
        if value is None:
            return default
        try:
            numbers = [float(c) for c in value]
        except (TypeError, ValueError):
            numbers = []
        if len(numbers) != 3 or not all(map(math.isfinite, numbers)):
            return self._wrong(name, value, default)
        return numbers[0], numbers[1], numbers[2]

    def _wrong(self, name: str, value: object, default: T) -> T:
        """The default; that the value cannot be used is told."""
        self.lost(name, f"it cannot be {shown(value)}")
        return default

    def sampler(self, name: str) -> Sampler | None:
        given = self.shader.GetInput(name)
        if not given:
            return None
        for attribute in given.GetValueProducingAttributes():
            source = UsdShade.Shader(attribute.GetPrim())
            if source and source.GetIdAttr().Get() == "UsdUVTexture":
                self._tell_space(name, source)
                output = attribute.GetBaseName()
                found = read_sampler(source, output, self.uv_names, self.opened, self.report)
                if found is None:
                    value = read_fallback(source, output, self.opened, self.report)
                    if value is not None:
                        self.fallbacks[name] = value
                return found
        return None

    def _tell_space(self, name: str, source: Any) -> None:
        """That an image is said to be counted otherwise than Unity counts what it is used for."""
        given = source.GetInput("sourceColorSpace")
        space = given.Get() if given else None
        usual = "sRGB" if name in ("diffuseColor", "emissiveColor") else "raw"
        if space in ("raw", "sRGB") and space != usual and name != "opacity":  # alpha is never sRGB
            prim = source.GetPrim()
            self.report.approximated(
                f"texture {prim.GetPath()}", "USD_FEATURE_APPROXIMATED", self.opened.place(prim, "inputs:sourceColorSpace"),
                detail=f"as {name} it is taken as {usual}, not as {space}",
            )  # fmt: skip

    def lost(self, name: str, detail: str) -> None:
        prim = self.shader.GetPrim()
        self.report.dropped(
            f"{name} of {prim.GetPath()}", "USD_FEATURE_DROPPED", self.opened.place(prim, name), detail=detail
        )


def _constant(primvar: Any) -> list[float] | None:
    """Numbers of a constant primvar, None for another."""
    if not primvar or not primvar.HasAuthoredValue() or primvar.GetInterpolation() != "constant":
        return None
    value = primvar.Get()
    try:
        first = value[0]
        return [float(c) for c in first] if hasattr(first, "__len__") else [float(first)]
    except (TypeError, ValueError, IndexError):  # empty, or of another type than the schema's
        return None


def _unit(value: float) -> float:
    value = float(value)
    return min(1.0, max(0.0, value)) if math.isfinite(value) else 0.0


def _emission(color: tuple[float, float, float]) -> tuple[float, float, float]:
    return (max(0.0, color[0]), max(0.0, color[1]), max(0.0, color[2]))


def _texture(sampler: Sampler | None) -> Texture | None:
    return None if sampler is None else sampler.texture
