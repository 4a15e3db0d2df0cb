"""The files beside a STEP assembly that hold parts of its geometry, and those that these name in turn.

OpenCASCADE opens them by itself, each from the folder of the file that names it, and says nothing of one that it does not
find; so they are looked at before.
"""

from __future__ import annotations

import posixpath
from pathlib import Path

from ...diagnostics import Report
from ..reading.file import read_bytes
from .part21 import Part21


def check_external(text: Part21, path: Path, limit: int, report: Report) -> int:
    """Report the files named that are missing or lie outside of the assembly's folder; bytes of those that are there.

    path: of the assembly.  limit: bytes that they may have together.  Raises KinefabError where one cannot be read.
    """
    size = 0
    seen = {path.name}
    named = [("", file) for file in text.external_files()]
    for folder, file in named:  # grows while files name others
        plain = file.replace("\\", "/")
        inside = posixpath.normpath(posixpath.join(folder, plain))
        if plain.startswith("/") or plain[1:2] == ":" or inside.split("/")[0] == "..":
            report.add("STEP_FILE_OUTSIDE", path.name, file=file)
        elif inside not in seen:
            seen.add(inside)
            if not (path.parent / inside).is_file():
                report.dropped(f"file {file}", "STEP_FILE_MISSING", path.name, file=file)
                continue
            data = read_bytes(path.parent / inside, report, limit - size)
            size += len(data)
            named += [(posixpath.dirname(inside), other) for other in Part21(data).external_files()]
    return size
