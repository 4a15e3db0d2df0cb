"""What a user may ask of MJCF; imports nothing heavy, as the command line needs it for --help."""

from __future__ import annotations

from ...options import FormatOption

KEYFRAME = FormatOption(
    "keyframe", "Take the pose and the controls of this keyframe, by name or number.", metavar="NAME", chooses=True
)
