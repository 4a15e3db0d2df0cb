"""Layers that are filled and looked at, and written as files without content."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path as FilePath
from types import SimpleNamespace
from typing import Any

SpecifierClass, SpecifierDef = "class", "def"
VariabilityUniform, VariabilityVarying = "uniform", "varying"
ChangeBlock = nullcontext


class _Names:
    def __getattr__(self, name: str) -> str:
        return name


ValueTypeNames = _Names()


class TokenListOp:
    @staticmethod
    def Create(prependedItems: list[str]) -> list[str]:
        return list(prependedItems)


class Path(str):
    @property
    def name(self) -> str:
        return self.rpartition("/")[2]

    def AppendProperty(self, name: str) -> Path:
        return Path(f"{self}.{name}")


class Reference:
    def __init__(self, primPath: object):
        self.primPath = primPath


class PrimSpec:
    def __init__(self, parent: PrimSpec | Layer | None, name: str, specifier: str = "", kind: str = ""):
        self.nameParent = parent.pseudoRoot if isinstance(parent, Layer) else parent
        self.name, self.specifier, self.kind = name, specifier, kind
        self.infos: dict[str, Any] = {}
        self.attributes: dict[str, AttributeSpec] = {}
        self.relationships: dict[str, RelationshipSpec] = {}
        self.nameChildren: dict[str, PrimSpec] = {}
        self.customData: dict[str, Any] = {}
        self.referenceList = SimpleNamespace(prependedItems=list[Reference]())
        self.instanceable, self.active = False, True
        if self.nameParent is not None:
            self.nameParent.nameChildren[name] = self

    @property
    def path(self) -> Path:
        if self.nameParent is None:
            return Path("/")
        return Path(f"{'' if self.nameParent.nameParent is None else self.nameParent.path}/{self.name}")

    def SetInfo(self, key: str, value: object) -> None:
        self.infos[key] = value


class AttributeSpec:
    def __init__(self, prim: PrimSpec, name: str, kind: str, variability: str, custom: bool):
        self.kind, self.variability, self.custom = kind, variability, custom
        self.default: Any = None
        self.infos: dict[str, Any] = {}
        self.connectionPathList = SimpleNamespace(explicitItems=list[object]())
        prim.attributes[name] = self

    def SetInfo(self, key: str, value: object) -> None:
        self.infos[key] = value


class RelationshipSpec:
    def __init__(self, prim: PrimSpec, name: str, custom: bool):
        self.targetPathList = SimpleNamespace(explicitItems=list[object]())
        prim.relationships[name] = self


class Layer:
    """last: that was written."""

    last: Layer | None = None

    def __init__(self) -> None:
        self.pseudoRoot = PrimSpec(None, "")
        self.samples: dict[tuple[str, float], Any] = {}
        self.customLayerData: dict[str, Any] = {}
        self.defaultPrim = ""

    @staticmethod
    def CreateAnonymous(ending: str) -> Layer:
        return Layer()

    def SetTimeSample(self, path: str, code: float, value: object) -> None:
        self.samples[path, code] = value

    def Export(self, path: str) -> bool:
        FilePath(path).write_bytes(b"")
        Layer.last = self
        return True
