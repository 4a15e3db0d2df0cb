"""What the inputs of a UsdPreviewSurface are: constants, images, and colours of the prim that it is on."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, TypeVar

from ..api import UsdShade
from ..values import Values, shown
from .textures import Sampler, read_fallback, read_input, read_sampler

T = TypeVar("T")

DISPLAY = {"displayColor": 3, "displayOpacity": 1}
"""Primvars of a prim's own looks, with how many numbers they have."""
ROUNDED = 1e-6
"""A share that is beyond 0 or 1 by less is not."""


@dataclass(frozen=True, slots=True, eq=False)
class Inputs:
    """Inputs of one shader: constants, and what is connected to them.  display: colours that the prim states, by primvar.
    read: what readers of primvars give, and images that are not there."""

    shader: Any
    uv_names: tuple[str, ...]
    display: Mapping[str, tuple[float, ...]]
    values: Values
    read: dict[str, Any] = field(default_factory=dict[str, Any])

    def value(self, name: str) -> Any:
        """What is stated for an input, wherever it stands; None for nothing."""
        if name in self.read:
            return self.read[name]
        given = self.shader.GetInput(name)
        if not given:
            return None
        for attribute in given.GetValueProducingAttributes():
            if attribute.GetPrim() == self.shader.GetPrim() or not UsdShade.Shader(attribute.GetPrim()):
                return self.values.current(attribute)
        return None

    def number(self, name: str, default: float) -> float:
        value = self.value(name)
        if value is None:
            return default
        if isinstance(value, bool) or not isinstance(value, (float, int)) or not math.isfinite(value):
            return self._wrong(name, value, default)
        return float(value)

    def color(self, name: str, default: tuple[float, float, float]) -> tuple[float, float, float]:
        value = self.value(name)
        if value is None:
            return default
        try:
            numbers = [float(c) for c in value]
        except (TypeError, ValueError):
            numbers = []
        if len(numbers) != 3 or not all(map(math.isfinite, numbers)):
            return self._wrong(name, value, default)
        return numbers[0], numbers[1], numbers[2]

    def share(self, name: str, default: float) -> float:
        """A number from 0 to 1."""
        return self.within(name, self.number(name, default))

    def within(self, name: str, value: float) -> float:
        """What an input comes to, brought between 0 and 1; that it was beyond is told."""
        found = min(1.0, max(0.0, value))
        if abs(found - value) > ROUNDED:
            self.approximated(name, f"{value:g} is beyond a surface's range from 0 to 1; {found:g} was taken")
        return found

    def color_within(self, name: str, color: tuple[float, float, float]) -> tuple[float, float, float]:
        r, g, b = color
        return self.within(name, r), self.within(name, g), self.within(name, b)

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
            if not source or source.GetPrim() == self.shader.GetPrim():
                continue
            value, found = None, None
            if source.GetIdAttr().Get() == "UsdUVTexture":
                self._tell_space(name, source)
                output = attribute.GetBaseName()
                found = read_sampler(source, output, self.uv_names, self.values)
                if found is not None and any(found.bias) and name != "normal":
                    self._tell_bias(found.bias, source)
                if found is None:
                    value = read_fallback(source, output, self.values)
            elif is_reader(source):
                value = self._of_primvar(name, source)
            else:
                kind = source.GetIdAttr().Get() or "shader without a name"
                self.lost(name, f"it comes from {source.GetPath()}, a {kind}, which is not read")
            if value is not None:
                self.read[name] = value
            return found
        return None

    def _of_primvar(self, name: str, reader: Any) -> Any:
        """What a reader gives for the whole mesh: a colour that it displays, else its fallback."""
        varname = str(read_input(reader, "varname", self.values) or "")
        if varname in self.display:
            values = list(self.display[varname])
            return values if DISPLAY[varname] > 1 else values[0]
        if varname not in DISPLAY:
            self.lost(name, f"it follows the primvar '{varname}', which is not read")
        return read_input(reader, "fallback", self.values)

    def _tell_bias(self, bias: tuple[float, float, float], source: Any) -> None:
        prim, opened = source.GetPrim(), self.values.opened
        self.values.report.approximated(
            f"texture {prim.GetPath()}", "USD_FEATURE_APPROXIMATED", opened.place(prim, "inputs:bias"),
            detail=f"the bias {' '.join(f'{b:g}' for b in bias)} was left out",
        )  # fmt: skip

    def _tell_space(self, name: str, source: Any) -> None:
        """That an image is said to be counted otherwise than Unity counts what it is used for."""
        given = source.GetInput("sourceColorSpace")
        space = given.Get() if given else None
        usual = "sRGB" if name in ("diffuseColor", "emissiveColor") else "raw"
        if space in ("raw", "sRGB") and space != usual and name != "opacity":  # alpha is never sRGB
            prim, opened = source.GetPrim(), self.values.opened
            self.values.report.approximated(
                f"texture {prim.GetPath()}", "USD_FEATURE_APPROXIMATED", opened.place(prim, "inputs:sourceColorSpace"),
                detail=f"as {name} it is taken as {usual}, not as {space}",
            )  # fmt: skip

    def lost(self, name: str, detail: str) -> None:
        prim = self.shader.GetPrim()
        where = self.values.opened.place(prim, name)
        self.values.report.dropped(f"{name} of {prim.GetPath()}", "USD_FEATURE_DROPPED", where, detail=detail)

    def approximated(self, name: str, detail: str) -> None:
        prim = self.shader.GetPrim()
        self.values.report.approximated(
            f"{name} of {prim.GetPath()}", "USD_FEATURE_APPROXIMATED", self.values.opened.place(prim, name), detail=detail
        )  # fmt: skip


def is_reader(shader: Any) -> bool:
    return str(shader.GetIdAttr().Get() or "").startswith("UsdPrimvarReader")
