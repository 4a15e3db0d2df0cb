"""Mass as robot formats state it, for each link; what moves together is weighed together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...diagnostics import Report
from ...geometry.mass import combined, mended_inertia, moved
from ...model import MassProperties
from ...spatial import Array, Pose
from .robot_frame import TURN


@dataclass(frozen=True, slots=True, eq=False)
class Inertial:
    """kg; centre of mass and the axes of the inertia in the link's frame, both in the source's axes; kg m^2 about the
    centre, shape (3, 3)."""

    mass: float
    pose: Pose
    inertia: Array


def tensor(xx: float, yy: float, zz: float, xy: float, xz: float, yz: float) -> Array:
    """The symmetric matrix, shape (3, 3), of these entries, kg m^2: xy is what stands off the diagonal."""
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def weighed_together(
    links: Sequence[tuple[Inertial, Pose]], name: str, where: str, report: Report
) -> MassProperties | None:
    """Of links that move as one, in the frame of the first, turned into the scene; None where none has a mass.

    links: with their poses in the first one's frame, source axes.  What no body can have is mended and reported.
    """
    known = [
        moved(
            MassProperties(
                link.mass, link.pose.translation, link.pose.rotation @ link.inertia @ link.pose.rotation.T
            ),
            pose,
        )
        for link, pose in links
    ]
    if not any(part.mass > 0.0 for part in known):
        return None
    whole = combined(known)
    inertia = 0.5 * (whole.inertia + whole.inertia.T)
    if (mended := mended_inertia(inertia, whole.mass)) is not None:
        inertia = mended
        report.approximated(f"inertia {name}", "INERTIA_MENDED", where, link=name)
    return MassProperties(whole.mass, TURN @ whole.center, TURN @ inertia @ TURN.T)
