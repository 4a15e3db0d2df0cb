"""What a user may ask of any format with an exact B-rep; imports nothing heavy."""

from __future__ import annotations

from ...options import FormatOption

TOLERANCE = FormatOption(
    "tolerance", "How far triangles may be off the surfaces: CHORD in millimetres, or CHORD,ANGLE in degrees.",
    metavar="CHORD[,ANGLE]",
)  # fmt: skip
