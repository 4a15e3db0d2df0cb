"""Arguments and options that several commands have, declared once."""

from __future__ import annotations

from typing import Any

import typer

from ..options import DEFAULT_DENSITY, DEFAULT_SMOOTH, Closures, ColliderShape, ExportOptions, Ground
from ..sources import known_suffixes, source_options
from ..targets import known_endings, target_options
from .asking import asking

SOURCE_HELP = f"Assembly to read: {', '.join(sorted(known_suffixes()))}."
TARGET_HELP = f"File to write; its ending chooses the kind: {', '.join(known_endings())}."
DENSITY: Any = typer.Option(DEFAULT_DENSITY, "--density", help="kg/m^3 of bodies that state none.")
BUNDLE = ".bundle.json"
"""How a CAD bundle's name ends."""
AS_JSON: bool = typer.Option(False, "--json", help="Print the same as JSON.")
CLOSURES: Any = typer.Option(
    Closures.EXACT,
    "--closures",
    show_default="exact",
    help="Equations of loop-closing joints: all, as Unity needs them, or the fewest, for a direct solver.",
)


@asking(("reading", source_options()), ("writing", target_options()))
def export_options(
    reading: dict[str, Any],
    writing: dict[str, Any],
    strict: bool = typer.Option(
        False,
        "--strict",
        help="Fail on every warning of what would be approximated or dropped; remarks (-v) stay remarks.",
    ),
    colliders: ColliderShape = typer.Option(
        ColliderShape.AUTO, "--colliders", show_default="auto", help="Collider of each body."
    ),
    density: float = DENSITY,
    closures: Closures = CLOSURES,
    solve: bool = typer.Option(
        False, "--solve", help="Move the parts to the nearest pose that fits the constraints."
    ),
    limits: bool = typer.Option(
        False, "--limits", help="Search how far joints can move and write it as limits."
    ),
    smooth: float = typer.Option(
        DEFAULT_SMOOTH,
        "--smooth",
        help="Degrees up to which an edge is drawn smooth, of meshes without normals.",
    ),
) -> ExportOptions:
    """Everything that may be chosen about an export, whether of one file or of many."""
    ground = Ground.among(reading)
    given = (colliders, density, strict, closures, solve, limits, reading, writing, smooth, ground)
    try:
        return ExportOptions(*given)
    except ValueError as error:
        hint = "--smooth" if str(error).startswith("smooth") else "--density"
        raise typer.BadParameter(str(error), param_hint=hint) from None


@asking(("reading", source_options()))
def analysis_options(
    reading: dict[str, Any],
    density: float = DENSITY,
    closures: Closures = CLOSURES,
    limits: bool = typer.Option(False, "--limits", help="Search how far joints can move."),
) -> ExportOptions:
    """What of it counts where nothing is written."""
    try:
        return ExportOptions(density=density, closures=closures, limits=limits, reading=reading)
    except ValueError as error:
        raise typer.BadParameter(str(error), param_hint="--density") from None
