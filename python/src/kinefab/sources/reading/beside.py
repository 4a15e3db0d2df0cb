"""Files that a source names beside itself: inside its folder or below it, and nowhere else."""

from __future__ import annotations

import os
from pathlib import Path, PurePosixPath


def beside(source: Path, name: str) -> Path | None:
    """The file that ``source`` names, whether it is there or not; None for a name that leads out of the source's folder,
    also through a link, or that is none."""
    plain = PurePosixPath(name.replace("\\", "/"))
    if not plain.name or "\0" in name or plain.is_absolute() or name[1:2] == ":":
        return None
    root = Path(os.path.realpath(source.parent))
    try:
        found = Path(os.path.realpath(root / plain))
    except (OSError, ValueError):
        return None
    return source.parent / plain if found.is_relative_to(root) else None
