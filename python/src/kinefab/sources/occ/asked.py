"""The tolerance that a user asked for."""

from __future__ import annotations

import math
from pathlib import Path

from ...diagnostics import Report
from ..reading.request import Request
from .triangles import Tolerance

MILLIMETRE = 1e-3


def tolerance_of(request: Request, path: Path, report: Report) -> Tolerance:
    """The tolerance that was asked for, the usual one after an error in the report."""
    text = request.text("tolerance")
    if not text:
        return Tolerance()
    try:
        values = [float(value) for value in text.split(",")]
    except ValueError:
        values = []
    if len(values) not in (1, 2) or not all(0.0 < value < math.inf for value in values):
        report.add("STEP_TOLERANCE", path.name, text=text)
        return Tolerance()
    chord = MILLIMETRE * values[0]
    return Tolerance(chord, math.radians(values[1])) if len(values) == 2 else Tolerance(chord)
