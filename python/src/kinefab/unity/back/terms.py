"""What a coupling of a scene file follows, whichever of its two ways it is written in."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

Entry = Mapping[str, Any]


def terms_of(coupling: Entry) -> list[tuple[Entry, float]]:
    """Each coordinate with its ratio: of ``terms``, or of ``a`` and ``ratio``.  Raises LookupError where neither is there."""
    if "terms" in coupling:
        return [(term["coordinate"], float(term["ratio"])) for term in coupling["terms"]]
    return [(coupling["a"], float(coupling["ratio"]))]
