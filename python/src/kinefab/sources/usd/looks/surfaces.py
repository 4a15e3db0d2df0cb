"""Materials: UsdPreviewSurface and OmniPBR as the model's Surface, with its textures."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from ....model import AlphaMode, Surface, Texture
from ..api import UsdGeom, UsdShade
from ..found import Piece
from ..prims import source_path
from ..values import Values
from . import omnipbr
from .inputs import DISPLAY, Inputs
from .materials import PREVIEW, Materials, surface_of
from .packing import normals_of, packed
from .textures import Sampler

BIND = "materialBind"
CONSTANTS = {
    "diffuse_color_constant": "color", "metallic_constant": "metallic", "reflection_roughness_constant": "roughness",
    "base_color": "color", "diffuseColor": "color", "base_color_factor": "color",
    "diffuse_reflection_color": "color", "glass_color": "color", "metallic_factor": "metallic",
    "specular_reflection_roughness": "roughness", "roughness_factor": "roughness",
    "metalness": "metallic", "base_metalness": "metallic", "metallic": "metallic",
    "specular_roughness": "roughness", "roughness": "roughness",
}  # fmt: skip
"""What the inputs of MDL's and MaterialX's surfaces are called here."""
USUAL = 1.5
"""The index of refraction that Unity's standard surface reflects as."""
UNSEEN = 0.01
"""Share of light that a surface may reflect more or less than that one: programs write indices of 1.45 as a matter of course."""
FLAT = (0.0, 0.0, 1.0)
"""A normal that leaves the mesh's own."""
NORMALS = (((2.0, 2.0, 2.0), (-1.0, -1.0, -1.0)), ((1.0, 1.0, 1.0), (0.0, 0.0, 0.0)))
"""Scale and bias of images of normals that are as Unity's; those that state neither are meant to be."""
DISPLAYED = (0.5, 0.5, 0.5)
"""Colour of a prim that states none, as UsdGeom's fallback has it in viewers."""


@dataclass(slots=True, eq=False)
class Surfaces:
    """The scene's surfaces, each once.  by_material: index by the material's path and what it shows of the prim; by_color: of plain display colours."""

    values: Values
    materials: Materials
    surfaces: list[Surface] = field(default_factory=list[Surface])
    _by_material: dict[tuple[object, ...], int | None] = field(
        default_factory=dict[tuple[object, ...], int | None]
    )
    _by_color: dict[tuple[float, ...], int] = field(default_factory=dict[tuple[float, ...], int])
    _names: set[str] = field(default_factory=set[str])

    def covers(self, piece: Piece) -> bool:
        """Whether a mesh shows materials alone, and nothing of the colours that it states for its points or faces."""
        mesh = UsdGeom.Mesh(piece.prim)
        subsets = UsdGeom.Subset.GetGeomSubsets(mesh, UsdGeom.Tokens.face, BIND)
        paths = [str(subset.GetPath()) for subset in subsets]
        self.materials.resolve({piece.path: piece.prim, **{p: s.GetPrim() for p, s in zip(paths, subsets)}})
        own = self.materials.of(piece.path)
        materials = [self.materials.of(path) or own for path in paths]
        if UsdGeom.Subset.GetUnassignedIndices(mesh, UsdGeom.Tokens.face, BIND):
            materials.append(own)
        kind, displays = self.materials.kind, self.materials.displays
        return all(m is not None and kind(m) and not displays(m) for m in materials)

    def of(
        self, piece: Piece, subsets: tuple[Any, ...], uv_names: tuple[str, ...], colored: bool
    ) -> tuple[int, ...]:
        """Index of a surface for each submesh of a piece; () where it says nothing of its looks.

        subsets: see ``Polygons``.  colored: its vertices have colours of their own, so the surface is white.
        """
        double = self._is_double(piece)
        if not piece.dressed and not colored and not double and subsets == (None,):
            return ()
        paths = ["" if subset is None else str(subset.GetPath()) for subset in subsets]
        self.materials.resolve({piece.path: piece.prim, **{p: s for p, s in zip(paths, subsets) if p}})
        found: list[int | None] = []
        for path in paths:
            material = self.materials.of(path) or self.materials.of(piece.path)
            index = (
                None if material is None else self._of_material(material, piece, uv_names, colored, double)
            )
            found.append(self._displayed(piece, colored, double) if index is None else index)
        if not double and found.count(None) == len(found):
            return ()
        return tuple(self._plain(double) if index is None else index for index in found)

    def _is_double(self, piece: Piece) -> bool:
        """Whether both sides of a piece are seen."""
        if "doubleSided" not in piece.seen.traits.names:
            return False
        value = piece.seen.prim.GetAttribute("doubleSided").Get()
        if value is not None and not isinstance(value, bool):
            self.values.tell_unusable(piece.prim, "doubleSided", value)
        return value is True

    def _plain(self, double: bool) -> int:
        """What has no look beside what has one, or none but that both its sides are seen."""
        key = (float(double),)
        if key not in self._by_color:
            self.surfaces.append(Surface(self._unique("Default"), double_sided=double))
            self._by_color[key] = len(self.surfaces) - 1
        return self._by_color[key]

    def _displayed(self, piece: Piece, colored: bool, double: bool) -> int | None:
        stated = self._display(piece, colored)
        if not stated:
            return None
        rgba = (*stated.get("displayColor", DISPLAYED), *stated.get("displayOpacity", (1.0,)))
        r, g, b, alpha = (round(_unit(c), 6) for c in rgba)
        key = (r, g, b, alpha, float(double))
        if key not in self._by_color:
            mode = AlphaMode.OPAQUE if alpha >= 1.0 else AlphaMode.BLEND
            name = self._unique("Color " + " ".join(f"{c:g}" for c in key[:4]))
            self.surfaces.append(Surface(name, (r, g, b, alpha), alpha_mode=mode, double_sided=double))
            self._by_color[key] = len(self.surfaces) - 1
        return self._by_color[key]

    def _display(self, piece: Piece, colored: bool) -> dict[str, tuple[float, ...]]:
        """Colour and opacity that a prim states by itself, by primvar.  colored: its vertices have them, which they
        multiply."""
        api = UsdGeom.PrimvarsAPI(piece.prim)
        found: dict[str, tuple[float, ...]] = {}
        for name, width in DISPLAY.items():
            primvar = api.FindPrimvarWithInheritance(name)
            values = self._constant(primvar)
            if values is not None and len(values) == width:
                found[name] = tuple(values)
            elif colored:
                found[name] = (1.0,) * width
            elif piece.seen.traits.kind != "Mesh" and primvar and primvar.GetInterpolation() != "constant":
                self.values.report.dropped(
                    f"{name} of {piece.path}", "USD_FEATURE_DROPPED", self.values.opened.place(piece.path),
                    detail=f"it is {primvar.GetInterpolation()}, and a {piece.seen.traits.kind} has one here",
                )  # fmt: skip
        return found

    def _constant(self, primvar: Any) -> list[float] | None:
        """Numbers of a constant primvar, None for another."""
        if not primvar or not primvar.HasAuthoredValue() or primvar.GetInterpolation() != "constant":
            return None
        value = self.values.current(primvar.GetAttr())
        try:
            number = self.values.current(primvar.GetIndicesAttr())[0] if primvar.IsIndexed() else 0
            if number < 0:
                return None
            first = value[number]
            return [float(c) for c in first] if hasattr(first, "__len__") else [float(first)]
        except (TypeError, ValueError, IndexError):  # empty, or of another type than the schema's
            return None

    def _unique(self, name: str) -> str:
        wanted, count = name, 1
        while wanted in self._names:
            count += 1
            wanted = f"{name} {count}"
        self._names.add(wanted)
        return wanted

    def _of_material(
        self, material: Any, piece: Piece, uv_names: tuple[str, ...], colored: bool, double: bool
    ) -> int | None:
        display = self._display(piece, colored) if self.materials.displays(material) else {}
        key = (source_path(material), uv_names, double, *display.items())
        if key not in self._by_material:
            surface = self._read(material, uv_names, display)
            if surface is not None:
                self.surfaces.append(replace(surface, double_sided=double))
            self._by_material[key] = None if surface is None else len(self.surfaces) - 1
        return self._by_material[key]

    def _read(
        self, material: Any, uv_names: tuple[str, ...], display: Mapping[str, tuple[float, ...]]
    ) -> Surface | None:
        where, feature = self.values.opened.place(material), f"material {material.GetPath()}"
        kind = self.materials.kind(material)
        if not kind:
            return None
        shader = surface_of(material)
        if kind == PREVIEW or kind in omnipbr.NAMES:
            inputs_of = Inputs if kind == PREVIEW else omnipbr.inputs_of
            return self._preview(material, inputs_of(shader, uv_names, display, self.values))
        found: dict[str, Any] = {}
        children = [UsdShade.Shader(each) for each in material.GetChildren() if each.IsA(UsdShade.Shader)]
        for each in [shader] if shader else children:
            inputs = Inputs(each, uv_names, display, self.values)
            for source, wanted in CONSTANTS.items():
                if inputs.value(source) is None:
                    continue
                if wanted == "color":
                    found[wanted] = inputs.color(source, (0.8, 0.8, 0.8))
                else:
                    found[wanted] = inputs.number(source, 0.5)
        self.values.report.approximated(feature, "USD_MATERIAL_UNKNOWN", where, kind=kind)
        color = found.get("color", (0.8, 0.8, 0.8))
        return Surface(
            self._unique(self.values.title(material)), (_unit(color[0]), _unit(color[1]), _unit(color[2]), 1.0),
            _unit(found.get("metallic", 0.0)), 1.0 - _unit(found.get("roughness", 0.5)),
        )  # fmt: skip

    def _preview(self, material: Any, inputs: Inputs) -> Surface:
        where, feature = self.values.opened.place(material), f"material {material.GetPath()}"
        diffuse = inputs.sampler("diffuseColor")
        opacity = inputs.sampler("opacity")
        alpha = inputs.share("opacity", 1.0)
        threshold = inputs.share("opacityThreshold", 0.0)
        shown = diffuse.texture if diffuse else None
        if opacity is not None and (
            diffuse is None or opacity.texture.name != diffuse.texture.name or opacity.output != "a"
        ):
            colors = [None if diffuse is None else (diffuse, channel) for channel in "rgb"]
            if (image := packed([*colors, (opacity, opacity.output)])) is None:
                inputs.lost("opacity", "its texture is not the alpha of the base colour's")
                opacity = None
            else:
                shown, opacity = image, replace(opacity, alpha=opacity.amount)
        rough, metallic, roughness = self._packed(inputs)
        for name, default in (("clearcoat", 0.0), ("displacement", 0.0)):
            if inputs.number(name, default) != default or inputs.sampler(name) is not None:
                inputs.lost(name, "there is no such thing in Unity's standard surface")
        reflected = _reflected(inputs.number("ior", USUAL))
        if abs(reflected - _reflected(USUAL)) > UNSEEN or inputs.sampler("ior") is not None:
            inputs.approximated("ior", f"Unity's standard surface reflects as one of {USUAL:g} does")
        if inputs.number("useSpecularWorkflow", 0.0):
            self.values.report.approximated(
                feature, "USD_MATERIAL_UNKNOWN", where, kind="the specular workflow"
            )
        base = diffuse.tint if diffuse else inputs.color("diffuseColor", (0.18, 0.18, 0.18))
        r, g, b = inputs.color_within("diffuseColor", base)
        emissive = inputs.sampler("emissiveColor")
        mode = (
            AlphaMode.MASK
            if threshold > 0.0
            else AlphaMode.BLEND
            if alpha < 1.0 or opacity
            else AlphaMode.OPAQUE
        )
        return Surface(
            self._unique(self.values.title(material)),
            (r, g, b, alpha if opacity is None else inputs.within("opacity", opacity.alpha)),
            metallic,
            1.0 - roughness,
            mode,
            threshold if mode is AlphaMode.MASK else 0.5,
            False,
            _emission(emissive.tint if emissive else inputs.color("emissiveColor", (0.0, 0.0, 0.0))),
            shown,
            self._normals(inputs),
            rough,
            self._shade(inputs),
            emissive.texture if emissive else None,
        )

    def _normals(self, inputs: Inputs) -> Texture | None:
        """The image of the normals, with x and y from -1 to 1 as Unity counts them."""
        sampler = inputs.sampler("normal")
        if sampler is None:
            if inputs.color("normal", FLAT) != FLAT and "normal" not in inputs.read:
                inputs.lost("normal", "Unity has it as an image alone")
            return None
        if (sampler.tint, sampler.bias) in NORMALS:
            return sampler.texture
        image = normals_of(sampler)
        if image is None:
            inputs.approximated("normal", "its image counts otherwise, and its pixels could not be read")
        return image or sampler.texture

    def _shade(self, inputs: Inputs) -> Texture | None:
        """The image of the occlusion, with it in r."""
        sampler = inputs.sampler("occlusion")
        if sampler is None:
            if inputs.number("occlusion", 1.0) != 1.0 and "occlusion" not in inputs.read:
                inputs.lost("occlusion", "Unity has it as an image alone")
            return None
        if sampler.amount != 1.0:
            inputs.approximated("occlusion", f"its image was taken whole, and not {sampler.amount:g} times")
        if sampler.output in ("r", "rgb"):
            return sampler.texture
        image = packed([(sampler, sampler.output), None, None])
        if image is None:
            inputs.lost("occlusion", f"Unity's map has it in r, the texture gives {sampler.output}")
        return image

    def _packed(self, inputs: Inputs) -> tuple[Texture | None, float, float]:
        """The image of roughness and metallic, and what each is, or is multiplied by in the image."""
        metal, rough = inputs.sampler("metallic"), inputs.sampler("roughness")
        metallic = inputs.within("metallic", metal.amount) if metal else inputs.share("metallic", 0.0)
        roughness = inputs.within("roughness", rough.amount) if rough else inputs.share("roughness", 0.5)
        if metal is None and rough is None:
            return None, metallic, roughness
        used = [sampler for sampler in (metal, rough) if sampler is not None]
        right = (metal is None or metal.output == "b") and (rough is None or rough.output == "g")
        whole = (metal is not None or metallic == 0.0) and (rough is not None or roughness == 0.0)
        if right and whole and len({sampler.texture.name for sampler in used}) == 1:
            return used[0].texture, metallic, roughness
        image = packed([None, rough and (rough, rough.output), metal and (metal, metal.output)])
        return (image, metallic, roughness) if image is not None else self._kept(inputs, metal, rough)

    def _kept(
        self, inputs: Inputs, metal: Sampler | None, rough: Sampler | None
    ) -> tuple[Texture | None, float, float]:
        """``_packed``, of images that cannot be made one: what has each in the channel that Unity's has it in."""
        image: Texture | None = None
        amounts: list[float] = []
        still: list[str] = []
        for name, sampler, channel, default in (
            ("metallic", metal, "b", 0.0),
            ("roughness", rough, "g", 0.5),
        ):
            if sampler is not None and sampler.output != channel:
                inputs.lost(name, f"Unity's map has it in {channel}, the texture gives {sampler.output}")
            elif sampler is not None and image is not None and sampler.texture.name != image.name:
                inputs.lost(
                    name,
                    f"Unity's map has it in {channel} of {image.name}, here it is {sampler.texture.name}",
                )
            elif sampler is not None:
                image = sampler.texture
                amounts.append(_unit(sampler.amount))
                continue
            amounts.append(_unit(inputs.number(name, default)))
            if amounts[-1] > 0.0:
                still.append(f"{name} {amounts[-1]:g} is multiplied by its {channel}")
        if image is not None and still:
            self.values.report.approximated(
                f"texture {image.name}", "USD_FEATURE_APPROXIMATED", self.values.opened.place(inputs.shader.GetPrim()),
                detail=f"Unity has roughness and metallic in one image, so the {', '.join(still)}",
            )  # fmt: skip
        return image, amounts[0], amounts[1]


def _unit(value: float) -> float:
    value = float(value)
    return min(1.0, max(0.0, value)) if math.isfinite(value) else 0.0


def _reflected(index: float) -> float:
    """Share of the light that falls straight on a surface of this index of refraction."""
    return ((index - 1.0) / (index + 1.0)) ** 2 if index >= 0.0 else 1.0


def _emission(color: tuple[float, float, float]) -> tuple[float, float, float]:
    return (max(0.0, color[0]), max(0.0, color[1]), max(0.0, color[2]))
