"""Colours of screens, which most formats state, as the scene's linear ones."""

from __future__ import annotations


def linear(channel: float) -> float:
    """A channel of the screen (sRGB), 0..1, as linear light (IEC 61966-2-1)."""
    return channel / 12.92 if channel <= 0.04045 else ((channel + 0.055) / 1.055) ** 2.4
