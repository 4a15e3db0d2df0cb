"""What an object is in the source whatever it is called there."""

from __future__ import annotations

import re
from collections.abc import Mapping

_MARK = re.compile("[/: ]")
"""Stands round the ids of what something is made of: ``Lever/Crank:1/body:Solid``, ``Base - Arm``, ``middle:Pin``, ``Pin helper``."""


def lasting(id: str, identities: Mapping[str, str]) -> str:
    """An id with the source's own identities (``Scene.identities``) in place of all ids in it that have one, longer ones first."""
    if not identities or not id:
        return id
    if (known := identities.get(id)) is not None:
        return known
    marks = [mark.start() for mark in _MARK.finditer(id)]
    for start in (0, *(mark + 1 for mark in marks)):
        for end in (len(id), *reversed(marks)):
            if end > start and (known := identities.get(id[start:end])) is not None:
                return id[:start] + known + lasting(id[end:], identities)
    return id
