"""What an export consists of: the prefab, the assets that it refers to, and a ``.meta`` for each."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class AssetFile:
    """path: from the folder that holds the prefab, slashes between.  content: made when asked, piece by piece; None for a folder."""

    path: str
    guid: str
    meta: str
    content: Callable[[], Iterable[bytes]] | None = None
