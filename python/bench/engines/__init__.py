"""What the engine that owns a format says of a file: one module a format, asked by ``corpus.py``.

A module has ``NAME``, the engine's name, ``FORMATS``, the names of Kinefab's formats that it judges, and
``load(path, packages) -> Engine``, which raises ``Refused`` where the engine does not load the file, and ImportError where
it is not installed.  packages: folders for ``package://`` and ``model://``.  All that an ``Engine`` says is right-handed
and in the engine's own frame; metres (or ``length`` of them), radians, kilograms.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

Pose = tuple[np.ndarray, np.ndarray]
"""Rotation matrix of shape (3, 3) and translation of shape (3,), in the engine's world."""


class Refused(Exception):
    """The engine does not load the file."""


@dataclass(frozen=True)
class EngineJoint:
    """One coordinate of the engine that may be chosen: none that a coupling gives.

    name: of the joint, as the scene file's ``because`` has it.  key: its own in ``Engine.poses`` (a joint may have several).
    axis: unit, in the engine's world at the exported pose; ``child`` turns about or slides along it.
    lower, upper: radians or metres, infinite where there is no limit.  start: at the exported pose.
    """

    name: str
    key: str
    child: str
    is_angle: bool
    axis: np.ndarray
    lower: float
    upper: float
    start: float = 0.0


@dataclass(frozen=True)
class Mass:
    """kg; centre of mass in the engine's world at the exported pose; kg m^2 about it, along the world's axes."""

    mass: float
    center: np.ndarray
    inertia: np.ndarray


class Engine(Protocol):
    """A file as its engine has it.

    turn: 3 x 3, the engine's world to Unity's.  joints: see ``EngineJoint``.
    mobility: nv less the rank of what closes loops and couples joints, six for each base that floats among it; None where
    the engine cannot say.
    slack: metres and radians by which the file's bodies miss what their joints lock, at the exported pose.
    """

    turn: np.ndarray
    length: float
    joints: list[EngineJoint]
    mobility: int | None
    slack: tuple[float, float]

    def poses(self, values: Mapping[str, float]) -> dict[str, Pose]:
        """Of every body, by its name in the file.  values: by ``EngineJoint.key``; those not given are as exported."""
        ...

    def masses(self) -> dict[str, Mass]:
        """Of everything that moves as one, by the name of any body in it; what stands on the ground is left out."""
        ...

    def passing(self) -> set[frozenset[str]] | None:
        """Pairs of bodies with colliders that do not collide, by their names; None where the engine has no rule of its own."""
        ...


def without_prefixes(text: str) -> str:
    """XML without names of extensions, whose prefixes robots often do not declare."""
    text = re.sub(r"\s[\w.-]+:[\w.-]+\s*=\s*(\"[^\"]*\"|'[^']*')", "", text)
    return re.sub(r"<(/?)[\w.-]+:", r"<\1", text)
