"""USD stages: ``robot.usda``, ``.usd``, ``.usdc``, ``.usdz``, or a stage that a program has open."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ...diagnostics import Report, named
from ...model import Scene, Source
from ..reading.request import Request
from .animation import read_clips
from .api import Tf, UsdUtils
from .found import Found
from .parts import DEFAULT_PURPOSES, Parts, physics_of
from .physics.actuators import KIND, Actuators
from .physics.couplings import Couplings, tell_prims, tell_vendors
from .physics.filters import collision_groups, filters, offered
from .physics.freedoms import Units, mujoco_angle
from .physics.joints import Joints
from .physics.stacks import stacked
from .stage import OpenStage, examine, open_file, reason, tell
from .values import Values
from .walk import walk


def read(path: Path, report: Report, request: Request = Request()) -> Scene:
    """The scene of a USD file.  request: root, variant, load, purpose.  Raises KinefabError with every error found."""
    heard = UsdUtils.CoalescingDiagnosticDelegate()  # else pxr writes to stderr what it finds
    try:
        opened = open_file(path, report, request)
        scene = _scene(opened, report, request)
        tell(heard, opened, report)
        return scene
    except (
        UnicodeDecodeError,
        Tf.ErrorException,
    ) as error:  # names that are no text, and what pxr finds as it goes
        report.add("USD_UNREADABLE", path.name, path=path.name, detail=reason(error, path)[0])
        report.raise_for_errors()
        raise AssertionError("an unreadable stage is an error") from error


def read_stage(stage: Any, report: Report, request: Request = Request()) -> Scene:
    """As ``read``, of a ``pxr.Usd.Stage`` as it is: its loads and variants are its owner's."""
    layer = stage.GetRootLayer()
    folder = Path(layer.realPath).parent if layer.realPath else None
    name = Path(layer.realPath).name if layer.realPath else layer.GetDisplayName() or "stage"
    return _scene(examine(stage, name, report, request, folder=folder), report, request)


def _scene(opened: OpenStage, report: Report, request: Request) -> Scene:
    values = Values(opened, report)
    found = walk(opened, values, report)
    _tell_empty(found, opened, report)
    parts = Parts(opened, values, found, collision_groups(found, opened, report), _purposes(request), report)
    scene = Scene(
        source=Source(opened.name, opened.up, opened.frame.length, opened.sha256, opened.files),
        physics=physics_of(found, opened, values, report),
        offers=offered(opened),
    )
    scene.nodes = parts.read()
    scene.meshes, scene.surfaces = parts.library.meshes, parts.looks.surfaces
    moving = [parts.nodes[i] if part.body and part.enabled else -1 for i, part in enumerate(found.parts)]
    units = Units(opened, mujoco_angle(found.scenes, values))
    joints = Joints(opened, values, found, moving, parts.stands, units, report)
    made = [(entry.prim, joint) for entry in found.joints if (joint := joints.read(entry)) is not None]
    scene.joints = stacked(scene.nodes, made, joints.readings, report)
    scene.animations = read_clips(found, scene.nodes, opened, report)
    couplings = Couplings(opened, values, scene, joints.readings, report)
    scene.couplings = couplings.read(found.joints)
    scene.joints = couplings.screwed()
    moving_prims = [*(entry.prim for entry in found.joints), *(part.prim for part in found.parts)]
    tell_vendors(moving_prims, values, opened, report)
    acting = [prim for prim in found.vendor if prim.GetTypeName() == KIND]
    scene.joints = Actuators(couplings, units, values, report).drive(acting, scene.joints)
    tell_prims([prim for prim in found.vendor if prim.GetTypeName() != KIND], opened, report)
    scene.extras = filters(scene, found, opened, values, report)
    values.tell_unasked()
    report.raise_for_errors()
    return scene


def _purposes(request: Request) -> tuple[str, ...]:
    return (*DEFAULT_PURPOSES, *request.texts("purpose"))


def _tell_empty(found: Found, opened: OpenStage, report: Report) -> None:
    """Physics often sits in a variant that is off, or in a payload that is not loaded: say so where there is none."""
    if any(part.body for part in found.parts):
        return
    variants = named(opened.variants) or "none"
    payloads = named(opened.unloaded) or "none"
    report.add("USD_WITHOUT_BODIES", opened.name, variants=variants, payloads=payloads)
