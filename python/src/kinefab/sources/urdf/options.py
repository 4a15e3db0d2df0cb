"""What a user may ask of URDF; imports nothing heavy, as the command line needs it for --help."""

from __future__ import annotations

from ...options import FormatOption

XACRO_ARG = FormatOption(
    "xacro_arg", "Argument of a xacro file; may be repeated.", repeated=True, metavar="NAME:=VALUE"
)
FLOATING_BASE = FormatOption(
    "floating_base", "Leave the robot's base free instead of fixing it to the world.", bool
)
