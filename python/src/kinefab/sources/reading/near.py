"""Names that a misspelt one may have meant, for a message."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from itertools import islice

from ...diagnostics import MOST_ALIKE, Report

ABOUT = 5
"""Letters by which the length of a near match may differ."""


def near_matches(name: str, known: Iterable[str], report: Report) -> str:
    """Names that look like ``name``, or "none".  They are sought among a thousand of about its length, and not for
    findings beyond those that are listed."""
    if len(report.diagnostics) >= MOST_ALIKE:
        return "not sought"
    alike = (other for other in known if abs(len(other) - len(name)) <= ABOUT)
    return ", ".join(difflib.get_close_matches(name, list(islice(alike, 1000)), 3)) or "none"


def near_words(word: str, known: Iterable[str], report: Report) -> str:
    """As ``near_matches`` among a format's own words, which are small and joined by ``_``: Concentric, pin-slot."""
    return near_matches(word[:40].lower().replace("-", "_").replace(" ", "_"), known, report)
