"""What a user may ask of a STEP or IGES file."""

from __future__ import annotations

from ...options import FormatOption
from ..occ.options import TOLERANCE

UP = FormatOption("up", "Axis of the file that points up.", words=("X", "Y", "Z"))
MATES = FormatOption(
    "mates", "Mates to move by, where the file states none: auto (found in the geometry), or a file of 'kinefab mates'.",
    metavar="auto|FILE",
)  # fmt: skip
GROUND = FormatOption(
    "ground",
    "What joints to the ground connect to: a body, with which the whole can be moved (the default), or the world; "
    "with --mates auto also the part that stands still, by its name or id.",
    metavar="body|world|PART",
)
ASKED = (TOLERANCE, UP, MATES, GROUND)
"""All of them; what becomes of the last two is ``kinefab.mates``' affair, once the file is read."""
