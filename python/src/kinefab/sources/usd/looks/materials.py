"""Which material each prim shows, and what of it is read."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import PurePath
from typing import Any

from ..api import Usd, UsdShade
from ..prims import source_path
from ..values import Values
from .inputs import DISPLAY, is_reader
from .textures import read_input

PREVIEW = "UsdPreviewSurface"
BINDINGS = ("material:binding", "material:binding:full", "material:binding:preview")
"""Relationships that lead a prim, and what lies below it, to the material of its looks."""
CONTEXTS = ("", "mtlx", "mdl")
"""Of renderers whose surfaces are looked at, the first that a material has."""


@dataclass(slots=True, eq=False)
class Materials:
    """Those that prims are bound to, by the prims' paths."""

    values: Values
    _bound: dict[str, Any] = field(default_factory=dict[str, Any])
    _astray: set[Any] = field(default_factory=set[Any])
    _kinds: dict[str, str] = field(default_factory=dict[str, str])
    _shown: dict[str, frozenset[str]] = field(default_factory=dict[str, frozenset[str]])

    def of(self, path: str) -> Any:
        """The prim of the material that the prim at a path shows, None for none.  It was asked to be resolved."""
        return self._bound.get(path)

    def resolve(self, prims: Mapping[str, Any]) -> None:
        """Find the materials of many prims, by their paths, in one go, which is far cheaper than one by one.

        Where the full look is none that is read, that for previews stands in for it, if there is one."""
        fresh = [path for path in prims if path not in self._bound]
        for path, material in zip(fresh, _bound([prims[path] for path in fresh], UsdShade.Tokens.full)):
            self._bound[path] = material
        unread = [path for path in fresh if self.kind(self._bound[path]) != PREVIEW]
        for path, material in zip(unread, _bound([prims[path] for path in unread], UsdShade.Tokens.preview)):
            if self._bound[path] is None or self.kind(material) == PREVIEW:
                self._bound[path] = material
        for path in fresh:
            if self._bound[path] is None:
                self._tell_astray(prims[path])

    def _tell_astray(self, prim: Any) -> None:
        """That bindings of a prim, or of those above it, lead to no material; each once."""
        while prim and prim not in self._astray:
            self._astray.add(prim)
            names = self.values.traits(prim).names.intersection(BINDINGS)
            for name in sorted(names):
                for target in prim.GetRelationship(name).GetForwardedTargets():
                    feature, where = f"material of {prim.GetPath()}", self.values.opened.place(prim, name)
                    found = self.values.opened.stage.GetPrimAtPath(target)
                    if not found:
                        self.values.report.dropped(feature, "USD_TARGET_MISSING", where, path=str(target))
                    elif not UsdShade.Material(found):
                        detail = f"it leads to {target}, which is no Material"
                        self.values.report.dropped(feature, "USD_FEATURE_DROPPED", where, detail=detail)
            prim = prim.GetParent()

    def displays(self, material: Any) -> frozenset[str]:
        """Which of the colours that a prim states by itself a material shows."""
        path = source_path(material)
        if path not in self._shown:
            readers = [UsdShade.Shader(prim) for prim in Usd.PrimRange(material) if prim.IsA(UsdShade.Shader)]
            names = {
                str(read_input(each, "varname", self.values) or "") for each in readers if is_reader(each)
            }
            self._shown[path] = frozenset(names.intersection(DISPLAY))
        return self._shown[path]

    def kind(self, material: Any) -> str:
        """What its surface is; "" for none: a physics material."""
        if material is None:
            return ""
        path = source_path(material)
        if path not in self._kinds:
            shader = surface_of(material)
            kind = "" if not shader else shader.GetIdAttr().Get() or _of_module(shader)
            stated = bool(shader) or bool(UsdShade.Material(material).GetOutputs())
            self._kinds[path] = str(kind or "none") if stated else ""
        return self._kinds[path]


def surface_of(material: Any) -> Any:
    """The shader of a material's surface, none where it has no such."""
    sources = (UsdShade.Material(material).ComputeSurfaceSource(context)[0] for context in CONTEXTS)
    return next((shader for shader in sources if shader), None)


def _of_module(shader: Any) -> str:
    """The name of a material in an MDL module: that of the module, where it states none."""
    asset = shader.GetSourceAsset("mdl")
    return str(
        shader.GetSourceAssetSubIdentifier("mdl") or ("" if asset is None else PurePath(asset.path).stem)
    )


def _bound(prims: list[Any], purpose: str) -> list[Any]:
    """Prims of the materials that are bound to these for a purpose, None for none."""
    if not prims:
        return []
    materials, _ = UsdShade.MaterialBindingAPI.ComputeBoundMaterials(prims, purpose)
    return [material.GetPrim() if material else None for material in materials]
