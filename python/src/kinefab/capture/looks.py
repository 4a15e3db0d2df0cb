"""Colours and materials as programs show them, as a bundle's materials.

Standard library only: it also runs in a CAD program's own Python.
"""

from __future__ import annotations

from ..color import linear
from .draft import Draft, Numbers, Record


def look(draft: Draft, material: str, color: Numbers | None, part: str) -> str | None:
    """Name of the bundle's material of a body, which is made if there is none yet; None where nothing is known.

    part: what it is called where the program names no material, or where another part shows that one in another colour.
    color: red green blue as screens have them (sRGB) and opacity, 0 to 1.
    """
    if not material and color is None:
        return None
    return listed(draft, material, {} if color is None else {"color": linear_rgba(color)}, part)


def listed(draft: Draft, material: str, wanted: Record, part: str) -> str:
    """The same of a look in a bundle's own words: ``color``, linear, ``metallic``, ``smoothness``."""
    name, number = material or part, 1
    while name in draft.materials and draft.materials[name] != {"name": name, **wanted}:
        number += 1
        name = f"{material or part}, {part}" if number == 2 and material else f"{material or part} ({number})"
    draft.materials[name] = {"name": name, **wanted}
    return name


def painted(draft: Draft, name: str, count: int) -> None:
    """Tell of faces and features of a part that have colours of their own: a bundle's body has one material."""
    if count:
        draft.report.approximated(
            f"colours of {name}", "CAPTURE_FACE_COLORS", count=count, name=name, program=draft.program
        )


def linear_rgba(color: Numbers) -> list[float]:
    """Of screens' red green blue (sRGB) and opacity, 0 to 1, a bundle's."""
    red, green, blue, opacity = (min(1.0, max(0.0, float(value))) for value in color)
    return [linear(red), linear(green), linear(blue), opacity]
