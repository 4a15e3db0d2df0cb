"""The Unity project that a prefab is written into."""

from __future__ import annotations

import os
from pathlib import Path

from .objects.couplings import SCRIPT, script_guid

ASSETS = "Assets"


def has_script(target: Path) -> bool:
    """Whether another export left the script in the project already: a second one of its assembly's name, and of its guid,
    would keep the project from compiling.  False outside a project's ``Assets``."""
    absolute = target.absolute()
    assets = next((folder for folder in absolute.parents if folder.name == ASSETS), None)
    if assets is None:
        return False
    own = absolute.with_suffix("")
    line = f"guid: {script_guid(SCRIPT)}"
    for where, folders, names in os.walk(assets):
        folders[:] = [name for name in folders if not name.startswith(".") and Path(where, name) != own]
        if f"{SCRIPT}.meta" in names and line in _text(Path(where, f"{SCRIPT}.meta")).splitlines():
            return True
    return False


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""
