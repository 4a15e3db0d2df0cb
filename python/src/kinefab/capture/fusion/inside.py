"""What the add-in does in Fusion: the record first, then the bundle, as its documentation reads it.

Standard library only.  The self check needs numpy, which Fusion's Python has not: it is made from the record.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, cast

from ..channel import Live, MemberFailed, plainly, record
from ..draft import Draft
from ..writing import mesh_files, write_files
from .capture import METHODS, NAME, capture


def listed(target: Any, name: str, arguments: tuple[Any, ...] | None) -> Any:
    """A member of Fusion's, its arrays as lists: they come as vectors of the bridge to its C++, which collections are not."""
    found = plainly(target, name, arguments)
    members = set(dir(cast(object, type(found))))
    if (
        isinstance(found, (str, list, tuple))
        or "item" in members
        or not {"__len__", "__getitem__"} <= members
    ):
        return cast(Any, found)
    return list(found)


def capture_to(application: object, target: str) -> str:
    """Write NAME.record.json and NAME.bundle.json; the message for the user.  Raises OSError."""
    path = Path(target)
    stem = path.name.removesuffix(".json").removesuffix(".bundle")
    live, draft = Live(application, METHODS, listed), Draft(NAME, "cm", "Z")
    try:
        capture(live.root, draft)
    except MemberFailed as error:
        draft.report.add("CAPTURE_STOPPED", program=NAME, member=error.member, detail=error.detail)
    saved = path.with_name(f"{stem}.record.json")
    text = json.dumps(record("fusion", live.answers), separators=(",", ":"))
    saved.write_text(text, encoding="ascii")
    told = [str(found) for found in draft.report.diagnostics]
    if any(found.severity.value == "error" for found in draft.report.diagnostics):
        return "\n".join(told)
    draft.settle()
    values, files = mesh_files(draft, f"{stem}.parts")
    bundle = path.with_name(f"{stem}.bundle.json")
    write_files(values, files, bundle, lambda file, content: (file.write_bytes(content), None)[1])
    told += [f"Now check it: kinefab capture --replay {saved.name} -o {bundle.name}"]
    return "\n".join(told)
