"""The manifest in the folder beside a prefab: which files an export wrote, and what an export that is under way has still to do."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, cast

from ...replacing import write_whole

MANIFEST = ".kinefab.json"
"""In the folder beside the prefab; Unity leaves out what begins with a dot."""
FORMAT = "kinefab.prefab"


@dataclass(frozen=True, slots=True)
class Pending:
    """An export whose files are in place, and which has still to be ended.

    staging: name of the hidden folder beside the target that holds the prefab.  leaving: paths that the last export wrote and
    this one did not; they stay until the prefab that refers to them has gone.
    """

    staging: str
    leaving: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Manifest:
    """files: paths that the export wrote, from the folder that holds the prefab, slashes between.

    identity: by what its guids are told from other exports', "" where that is the prefab's name.
    """

    files: frozenset[str] = frozenset()
    pending: Pending | None = None
    identity: str = ""

    @property
    def ours(self) -> frozenset[str]:
        """Everything of which an export says that it wrote it."""
        return self.files if self.pending is None else self.files.union(self.pending.leaving)

    def write(self, folder: Path) -> None:
        """At once, so that it is the old one or the new one.  Raises OSError."""
        content: dict[str, Any] = {"format": FORMAT, "files": sorted(self.files)}
        if self.identity:
            content["identity"] = self.identity
        if self.pending is not None:
            content["pending"] = {"staging": self.pending.staging, "leaving": list(self.pending.leaving)}
        text = json.dumps(content, indent=1, ensure_ascii=False) + "\n"
        write_whole(folder / MANIFEST, text.encode("utf-8"))


def read_manifest(folder: Path) -> Manifest:
    """What the folder says of itself, whatever it and its prefab are called by now; an empty one where it says nothing that can
    be read."""
    try:
        read: Any = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))
        if read["format"] != FORMAT:
            return Manifest()
        pending: Any = read.get("pending")
        if pending is not None:
            pending = Pending(str(pending["staging"]), _paths(pending["leaving"]))
        found = Manifest(frozenset(_paths(read["files"])), pending, str(read.get("identity", "")))
        return _called(found, folder.name)
    except (OSError, ValueError, AttributeError, KeyError, TypeError, RecursionError):
        return Manifest()


def _called(manifest: Manifest, name: str) -> Manifest:
    """The same where folder and prefab were renamed, which leaves guids as they were: they are told by the name of then."""
    homes = (path.removesuffix(f"/{MANIFEST}") for path in manifest.files if path.endswith(f"/{MANIFEST}"))
    old = next(homes, name)
    if old == name:
        return manifest
    beside = {f"{old}.meta", f"{old}.prefab", f"{old}.prefab.meta"}

    def now(path: str) -> str:
        return name + path[len(old) :] if path.startswith(f"{old}/") or path in beside else path

    pending = manifest.pending
    if pending is not None:
        pending = replace(pending, leaving=tuple(map(now, pending.leaving)))
    return Manifest(frozenset(map(now, manifest.files)), pending, manifest.identity or old)


def _paths(listed: object) -> tuple[str, ...]:
    """Those that lead nowhere else: a manifest may have been edited."""
    if not isinstance(listed, list):
        raise TypeError("paths are a list")
    found = [path for path in cast("list[object]", listed) if isinstance(path, str)]
    return tuple(path for path in found if path and not path.startswith("/") and ".." not in path.split("/"))
