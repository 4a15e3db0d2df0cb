"""A stage opened as the user asked for it: loaded payloads, chosen variants, units, and what did not compose."""

from __future__ import annotations

import hashlib
import math
import os
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ...diagnostics import Report, named
from ...model import SourceFile
from ..reading.file import MAX_BYTES, read_bytes
from ..reading.record import MAX_NUMBER
from ..reading.request import Request
from ..reading.source_frame import DIRECTIONS, SourceFrame, turn_to_scene
from .api import Sdf, Tf, Usd, UsdGeom, UsdPhysics

FORWARD = {"Y": "Z", "Z": "X"}
"""USD names no forward axis.  With Z up it is that of robots, X, so that one robot in USD, URDF, MJCF and SDF stands alike."""
MAX_OFFERS = 1000
"""Most variants that are listed."""
CHUNK = 2**22
ADDRESS = re.compile(r" \([^()]*<0x[0-9a-f]+>\)\s*$")
"""What pxr says at the end of a message of the stage in memory: another at each run."""
HEEDED = ("but MaterialBindingAPI is not applied on the prim",)
"""A part of what pxr says of a stage that is not as its schemas want it, and takes all the same."""


@dataclass(frozen=True, slots=True, eq=False)
class OpenStage:
    """A stage and what its numbers mean.

    name: of the root file.  frame: its axes and units.  up: 'Y' or 'Z'.  root: the prim that is read, with all below.
    unloaded: paths of payloads that were not loaded.  folder: of the root file, None for a stage that has none.
    """

    stage: Any
    name: str
    frame: SourceFrame
    up: str
    root: Any
    sha256: str = ""
    unloaded: tuple[str, ...] = ()
    variants: tuple[str, ...] = ()
    folder: Path | None = None
    files: tuple[SourceFile, ...] = ()
    degree: float = field(default=math.pi / 180.0)

    def place(self, prim: Any, attribute: str = "") -> str:
        """Where something stands, for diagnostics: ``robot.usda</World/Arm.physics:mass>``."""
        path = prim if isinstance(prim, str) else str(prim.GetPath())
        return f"{self.name}<{path}{'.' + attribute if attribute else ''}>"


def open_file(path: Path, report: Report, request: Request) -> OpenStage:
    """The stage of a file.  Raises KinefabError with every error found."""
    sha256 = _sha256(path, report)
    load = Usd.Stage.LoadNone if request.text("load", "all") == "none" else Usd.Stage.LoadAll
    try:
        stage = Usd.Stage.Open(os.fspath(path), load)
    except Tf.ErrorException as error:
        detail, line = reason(error, path)
        report.add("USD_UNREADABLE", f"{path.name}{line}", path=path.name, detail=detail)
        report.raise_for_errors()
        raise AssertionError("an unreadable stage is an error") from error
    root_layer = stage.GetRootLayer()
    if not root_layer.pseudoRoot.nameChildren and not root_layer.subLayerPaths:
        report.add("SOURCE_EMPTY", path.name, path=path)
        report.raise_for_errors()
    _choose_variants(stage, request.texts("variant"), path.name, report)
    return examine(stage, path.name, report, request, sha256, path.resolve().parent)


def examine(
    stage: Any, name: str, report: Report, request: Request, sha256: str = "", folder: Path | None = None
) -> OpenStage:
    """What a stage's numbers mean and which prim of it is asked for."""
    frame, up = _units(stage, name, report)
    root = _root(stage, request.text("root"), name, report)
    report.raise_for_errors()
    loaded = stage.GetLoadSet()
    unloaded = tuple(sorted(str(p) for p in stage.FindLoadable() if p not in loaded))
    for path in unloaded:
        report.dropped(f"payload {path}", "USD_PAYLOAD_UNLOADED", f"{name}<{path}>")
    return OpenStage(
        stage, name, frame, up, root, sha256, unloaded, _variants(root), folder, _files(stage, folder)
    )


def _sha256(path: Path, report: Report) -> str:
    """Of the file; a diagnostic and KinefabError where there is none."""
    try:
        large = path.is_file() and path.stat().st_size > MAX_BYTES
    except (OSError, ValueError):
        large = False
    if not large:
        return hashlib.sha256(read_bytes(path, report)).hexdigest()
    found = hashlib.sha256()
    with path.open("rb") as stream:
        while chunk := stream.read(CHUNK):
            found.update(chunk)
    return found.hexdigest()


def reason(error: Exception, path: Path) -> tuple[str, str]:
    """pxr's own words without the places in its source code, and ``:line:column`` where it tells them."""
    try:
        text = str(error)
    except UnicodeDecodeError:  # pxr quotes the bytes that it could not read
        return "it holds bytes that are no UTF-8", ""
    parts = [line.split(" : ", 1)[1].strip(" '\n") for line in text.splitlines() if " : " in line]
    found = re.search(re.escape(path.name) + r"(:\d+:\d+): ", text)
    said = "; ".join(dict.fromkeys(p for p in parts if not p.startswith("Failed to open layer")))
    said = said.replace(f"{path.resolve().parent}{os.sep}", "") or text.strip() or type(error).__name__
    said = said if said.isprintable() else ascii(said)[1:-1]
    return (said, "") if found is None else (said.replace(f"{path.name}{found[1]}: ", ""), found[1])


def tell(heard: Any, opened: OpenStage, report: Report) -> None:
    """What pxr said while composing and reading (missing references, cycles, ...) as losses, by their words: its threads
    say it in another order at each run.  Not told by an error."""
    told: set[str] = set()
    for entry in heard.TakeUncoalescedDiagnostics():
        try:
            text = " ".join(ADDRESS.sub("", str(entry.commentary)).split())
        except UnicodeDecodeError:
            text = "what is named there holds bytes that are no UTF-8."
        text = text.replace(f"{opened.folder}{os.sep}", "")
        if text and not any(part in text for part in HEEDED):
            told.add(text)
    for text in sorted(told):
        report.dropped("composition arc", "USD_COMPOSITION", opened.name, detail=text)


def _units(stage: Any, name: str, report: Report) -> tuple[SourceFrame, str]:
    metres = UsdGeom.GetStageMetersPerUnit(stage)
    kilograms = UsdPhysics.GetStageKilogramsPerUnit(stage)
    for key, value in (("metersPerUnit", metres), ("kilogramsPerUnit", kilograms)):
        if not 1.0 / MAX_NUMBER <= value <= MAX_NUMBER:
            report.add("USD_UNIT_IMPOSSIBLE", name, field=key, value=f"{value:g}")
    up = str(UsdGeom.GetStageUpAxis(stage))
    if up not in FORWARD:
        report.add("USD_UNIT_IMPOSSIBLE", name, field="upAxis", value=up)
        up = "Y"
    for layer in sorted(stage.GetUsedLayers(), key=lambda each: each.identifier):
        rate = layer.timeCodesPerSecond
        if not (math.isfinite(rate) and rate > 0.0):  # of 0 pxr counts time samples without end
            place = layer.GetDisplayName()
            report.add("USD_UNIT_IMPOSSIBLE", place, field="timeCodesPerSecond", value=f"{rate:g}")
    report.raise_for_errors()
    _other_units(stage, name, report)
    turn = turn_to_scene(DIRECTIONS[up], DIRECTIONS[FORWARD[up]])
    return SourceFrame(turn, metres, math.pi / 180.0, kilograms, metres), up


def _other_units(stage: Any, name: str, report: Report) -> None:
    """Layers that are referenced and count in other units: USD does not convert them."""
    own = {layer.identifier for layer in stage.GetLayerStack()}
    for layer in sorted(stage.GetUsedLayers(), key=lambda each: each.identifier):
        if layer.identifier in own:
            continue
        for key, used in (
            ("metersPerUnit", UsdGeom.GetStageMetersPerUnit(stage)),
            ("kilogramsPerUnit", UsdPhysics.GetStageKilogramsPerUnit(stage)),
            ("upAxis", UsdGeom.GetStageUpAxis(stage)),
        ):
            if not layer.pseudoRoot.HasInfo(key):
                continue
            other = layer.pseudoRoot.GetInfo(key)
            if other != used:
                report.add(
                    "USD_UNITS_DIFFER", name, layer=layer.GetDisplayName(), field=key, other=other, used=used
                )


def _root(stage: Any, asked: str, name: str, report: Report) -> Any:
    if not asked:
        return stage.GetPseudoRoot()
    wanted = asked if asked.startswith("/") else f"/{asked}"
    prim = stage.GetPrimAtPath(wanted) if Sdf.Path.IsValidPathString(wanted) else None
    if not prim:
        known = named(str(p.GetPath()) for p in stage.GetPseudoRoot().GetChildren()) or "none"
        report.add("USD_ROOT_UNKNOWN", name, path=asked, known=known)
        return stage.GetPseudoRoot()
    return prim


def _choose_variants(stage: Any, asked: tuple[str, ...], name: str, report: Report) -> None:
    """Select variants in the session layer.  asked: ``set=name``, or ``/Prim:set=name`` for one prim only.

    One choice may bring the set of the next, so each is looked for on the stage as the ones before have left it.
    """
    for choice in asked:
        where, _, rest = choice.rpartition(":") if choice.startswith("/") else ("", "", choice)
        key, equals, value = rest.partition("=")
        found = False
        if equals:
            with Usd.EditContext(stage, stage.GetSessionLayer()):
                for prim in list(Usd.PrimRange.Stage(stage, Usd.PrimAllPrimsPredicate)):
                    if where and str(prim.GetPath()) != where or not prim.HasVariantSets():
                        continue
                    sets = prim.GetVariantSets()
                    if sets.HasVariantSet(key) and value in sets.GetVariantSet(key).GetVariantNames():
                        found |= sets.GetVariantSet(key).SetVariantSelection(value)
        if not found:
            known = named(_variants(stage.GetPseudoRoot())) or "none"
            report.add("USD_VARIANT_UNKNOWN", name, asked=choice, known=known)
    report.raise_for_errors()


def _variants(root: Any) -> tuple[str, ...]:
    """``set=name`` of everything that may be chosen at or below a prim, as ``--variant`` takes it."""
    found: dict[str, None] = {}
    for prim in Usd.PrimRange(root, Usd.PrimAllPrimsPredicate):
        if not prim.HasVariantSets():
            continue
        sets = prim.GetVariantSets()
        for key in sets.GetNames():
            for value in sets.GetVariantSet(key).GetVariantNames():
                found.setdefault(f"{key}={value}")
        if len(found) > MAX_OFFERS:
            break
    return tuple(sorted(found))[:MAX_OFFERS]


def _files(stage: Any, folder: Path | None) -> tuple[SourceFile, ...]:
    """The layers beside the root's, relative to its folder."""
    if folder is None:
        return ()
    root = stage.GetRootLayer().realPath
    uris: set[str] = set()
    for layer in stage.GetUsedLayers():
        if layer.realPath and layer.realPath != root and "[" not in layer.realPath:
            try:
                uris.add(Path(os.path.relpath(layer.realPath, folder)).as_posix())
            except ValueError:  # another drive
                continue
    return tuple(SourceFile(uri) for uri in sorted(uris))


def matrix(value: Any) -> np.ndarray:
    """A pxr row-form matrix as a column-form array, shape (4, 4)."""
    return np.array(value, dtype=np.float64).T
