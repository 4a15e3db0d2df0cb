"""Colours as robot formats state them: as the screen has them, each channel from 0 to 1."""

from __future__ import annotations

from collections.abc import Iterable

from ...diagnostics import Report


def clamped(rgba: Iterable[float], feature: str, where: str, report: Report) -> tuple[float, ...]:
    """The channels within 0 to 1; what lay outside, as numbers from 0 to 255 do, is told."""
    given = tuple(rgba)
    found = tuple(min(1.0, max(0.0, channel)) for channel in given)
    if found != given:
        report.approximated(feature, "COLOR_CLAMPED", where)
    return found
