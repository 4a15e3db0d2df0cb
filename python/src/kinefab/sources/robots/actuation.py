"""What MuJoCo's actuators do to a joint as the one drive that Unity has for it; MJCF and stages with its schemas share it.

MuJoCo's force on a joint is gear (gain u + b0 + b1 gear q + b2 gear qdot), u the control.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from ...model import Drive, Passive

FORCE = "a force is no drive; without one beside it its largest is kept as the joint's effort"
UNEVEN = "its force range is not the same to both sides"
LAG = "Unity's drive has no lag"
APART = "each actuator of its joint has a largest force of its own; one drive has their sum"
GROWS = "its force grows with the coordinate"


@dataclass(frozen=True, slots=True)
class Law:
    """force = constant - stiffness q - damping qdot, within +-most; N and m, or N m and rad."""

    constant: float
    stiffness: float
    damping: float
    most: float = math.inf

    @property
    def is_force(self) -> bool:
        """Whether it pushes alike wherever the joint stands and however fast it moves: no drive does."""
        return self.stiffness == 0.0 and self.damping == 0.0


def drive_of(laws: Sequence[Law]) -> Drive:
    """One drive for laws of which one at least is no force alone."""
    constant, stiffness, damping, most = (
        math.fsum(getattr(law, name) for law in laws) for name in ("constant", "stiffness", "damping", "most")
    )
    if stiffness > 0.0:
        return Drive(constant / stiffness, 0.0, stiffness, damping, most)
    return Drive(0.0, constant / damping, 0.0, damping, most)


def clipped_apart(laws: Sequence[Law]) -> bool:
    """Whether their sum is clipped otherwise than each of them."""
    return len(laws) > 1 and any(math.isfinite(law.most) for law in laws)


def bounded(drive: Drive, passive: Passive | None) -> Drive:
    """The drive within the largest force that all actuators of its joint have together.

    Beside a spring or damper of the joint it stays as it is: Unity has one drive for both, and would bound that one too.
    """
    if passive is None or passive.stiffness or passive.damping:
        return drive
    return replace(drive, max_force=min(drive.max_force, passive.effort))
