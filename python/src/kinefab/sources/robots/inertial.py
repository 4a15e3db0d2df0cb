"""Mass as robot formats state it, for each link; what moves together is weighed together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...diagnostics import Report
from ...geometry.mass import ball_inertia, combined, is_possible, moved
from ...model import MassProperties
from ...spatial import Array, Pose
from .robot_frame import TURN

THIN = 1e-3
"""Smallest moment against the largest that stands in for one that is zero or negative."""
ROUNDING = 1e-9
"""Share of the largest moment that is lost in sums and turns."""
POINT = 1e-6
"""Metres of the radius of gyration up to which a link states no inertia at all."""


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
    # Stricter than what is asked of a scene, so that the turn's rounding decides nothing.
    thin = float(np.linalg.eigvalsh(inertia)[0]) <= ROUNDING * float(np.abs(inertia).max())
    if thin or not is_possible(inertia, ROUNDING):
        inertia = _mended(inertia, whole.mass)
        report.approximated(f"inertia {name}", "INERTIA_MENDED", where, link=name)
    return MassProperties(whole.mass, TURN @ whole.center, TURN @ inertia @ TURN.T)


def _mended(inertia: Array, mass: float) -> Array:
    """The possible inertia next to one that is none: moments positive, none above the sum of the others."""
    moments, axes = np.linalg.eigh(inertia)
    largest = float(moments[2])
    if not largest > POINT * POINT * mass:  # zero, or what is left of it by the sums
        return ball_inertia(mass)
    moments = np.maximum(moments, THIN * largest)
    if (excess := float(moments[2] - moments[0] - moments[1])) > 0.0:
        moments = moments + excess / 3.0 * np.array([1.0, 1.0, -1.0])
        moments[2] *= 1.0 - 2.0 * ROUNDING
    return axes @ np.diag(moments) @ axes.T
