"""Options that several commands have, declared once."""

from __future__ import annotations

from typing import Any

import typer

from ..options import DEFAULT_DENSITY, Closures
from ..sources import known_suffixes
from ..targets import known_endings

SOURCE_HELP = f"Assembly to read: {', '.join(sorted(known_suffixes()))}."
DENSITY: Any = typer.Option(DEFAULT_DENSITY, "--density", help="kg/m^3 of bodies that state none.")
CLOSURES: Any = typer.Option(
    Closures.EXACT,
    "--closures",
    show_default="exact",
    help="Equations of loop-closing joints: all, as Unity needs them, or the fewest, for a direct solver.",
)
TARGET_HELP = f"File to write; its ending chooses the kind: {', '.join(known_endings())}."
