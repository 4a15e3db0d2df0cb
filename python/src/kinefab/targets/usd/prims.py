"""Prims and their properties as specs of a layer."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ...spatial import Array, Pose, quaternion_from_matrix
from .api import Gf, Sdf, Vt
from .names import PrimNames, display_name

Scale = tuple[float, float, float]
ONE: Scale = (1.0, 1.0, 1.0)
NOISE = 1e-12
"""Metres, or parts of a quaternion, that say nothing: a scene file has as many decimals."""


class Prim:
    """A prim that is being written."""

    def __init__(self, spec: Any):
        self._spec = spec
        self._schemas: list[str] = []
        self._names = PrimNames()

    @property
    def path(self) -> Any:
        return self._spec.path

    def child(
        self, wanted: str, kind: str, identity: str = "", *, prototype: bool = False, name: str | None = None
    ) -> Prim:
        """A prim below this one.  wanted: its name, shown to users as it is.  identity: what it is in the source, which
        decides its prim's name among others alike.  prototype: only what refers to it is drawn.  name: the prim's, where
        it was chosen already."""
        chosen = self._names.take(wanted, identity or wanted) if name is None else name
        specifier = Sdf.SpecifierClass if prototype else Sdf.SpecifierDef
        found = Prim(Sdf.PrimSpec(self._spec, chosen, specifier, kind))
        shown = display_name(wanted)
        if shown and shown != chosen:
            found.info("displayName", shown)
        return found

    def reserve(self, names: Sequence[str]) -> None:
        """Names that no other child gets."""
        self._names.reserve(names)

    def info(self, key: str, value: Any) -> None:
        """Metadata of the prim."""
        self._spec.SetInfo(key, value)

    def tell_source(self, identity: str) -> None:
        """What the prim is in the source, for programs that look for it again."""
        self._spec.customData["kinefab"] = {"id": identity}

    def apply(self, *schemas: str) -> None:
        """API schemas, each once, registered or not."""
        self._schemas += [schema for schema in schemas if schema not in self._schemas]
        self._spec.SetInfo("apiSchemas", Sdf.TokenListOp.Create(prependedItems=self._schemas))

    def refer(self, prototype: Any) -> None:
        """Make the prim an instance of what stands at a path of this layer."""
        self._spec.referenceList.prependedItems.append(Sdf.Reference(primPath=prototype))
        self._spec.instanceable = True

    def remove_if_empty(self) -> None:
        """Take the prim away where nothing stands below it."""
        if not self._spec.nameChildren:
            del self._spec.nameParent.nameChildren[self._spec.name]

    def deactivate(self) -> None:
        self._spec.active = False

    def attribute(
        self, name: str, kind: str, value: Any = None, *, uniform: bool = False, custom: bool = False
    ) -> Any:
        """kind: as ``Sdf.ValueTypeNames`` calls it.  custom: of no schema.  Returns the spec."""
        variability = Sdf.VariabilityUniform if uniform else Sdf.VariabilityVarying
        spec = Sdf.AttributeSpec(self._spec, name, getattr(Sdf.ValueTypeNames, kind), variability, custom)
        if value is not None:
            spec.default = value
        return spec

    def numbers(self, values: Mapping[str, float]) -> None:
        """Attributes of one 32-bit number each."""
        for name, value in values.items():
            self.attribute(name, "Float", float(value))

    def missing_numbers(self, values: Mapping[str, float]) -> None:
        """The same, of those that are not there yet."""
        self.numbers({name: value for name, value in values.items() if name not in self._spec.attributes})

    def connect(self, name: str, kind: str, source: Any) -> None:
        """An attribute that takes another's value.  source: path of that."""
        self.attribute(name, kind).connectionPathList.explicitItems.append(source)

    def relation(self, name: str, *targets: Any) -> None:
        spec = Sdf.RelationshipSpec(self._spec, name, False)
        spec.targetPathList.explicitItems[:] = list(targets)

    def place(self, pose: Pose, scale: Scale = ONE, *, moves: bool = False) -> None:
        """Where the prim stands in its parent: translation, rotation, scale, those that are not nothing.

        moves: with both of the first even so, as time samples follow.
        """
        order: list[str] = []
        if moves or pose.translation.any():
            self.attribute("xformOp:translate", "Double3", vector3d(pose.translation))
            order.append("xformOp:translate")
        turn = quaternion_from_matrix(pose.rotation)
        if moves or turn[:3].any():
            self.attribute("xformOp:orient", "Quatd", quaternion64(turn))
            order.append("xformOp:orient")
        if scale != ONE:
            self.attribute("xformOp:scale", "Double3", vector3d(np.array(scale)))
            order.append("xformOp:scale")
        if order:
            self.attribute("xformOpOrder", "TokenArray", Vt.TokenArray(order), uniform=True)


def rounded(values: Array) -> bool:
    """Whether 32 bits cannot hold the numbers, metres or parts of a quaternion."""
    return bool(np.abs(values - values.astype(np.float32)).max() > NOISE)


def vector3d(values: Array) -> Any:
    return Gf.Vec3d(*(float(v) + 0.0 for v in values))


def vector3f(values: Array) -> Any:
    return Gf.Vec3f(*(float(v) + 0.0 for v in values))


def quaternion64(q: Array) -> Any:
    """Of (x, y, z, w)."""
    x, y, z, w = (float(v) + 0.0 for v in q)
    return Gf.Quatd(w, x, y, z)


def quaternion32(q: Array) -> Any:
    """Of (x, y, z, w)."""
    x, y, z, w = (float(v) + 0.0 for v in q)
    return Gf.Quatf(w, x, y, z)
