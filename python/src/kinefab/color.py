"""Colours of the screen (sRGB) and of linear light; most formats state the one, the model has the other (IEC 61966-2-1).

Standard library only: it also runs in a CAD program's own Python.
"""

from __future__ import annotations


def linear(channel: float) -> float:
    """A channel of the screen as linear light.  0 to 1, more where light is emitted."""
    return channel / 12.92 if channel <= 0.04045 else ((channel + 0.055) / 1.055) ** 2.4


def encoded(channel: float) -> float:
    """A channel of linear light as the screen has it, the inverse of ``linear``."""
    return 12.92 * channel if channel <= 0.0031308 else 1.055 * channel ** (1.0 / 2.4) - 0.055
