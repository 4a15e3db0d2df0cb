"""The file itself: template, style, code and data in one, safe against whatever a name holds."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from functools import cache
from html import escape
from pathlib import Path
from typing import Any

from .blob import Blob

CODE = ("kinematics.js", "stage.js", "glyphs.js", "mates.js", "app.js")
"""In the order in which they are read."""
_PLACE = re.compile(r"%(TITLE|STYLE|DATA|BLOB|THREE|CODE|WORDS|CLASS)%")


def page(description: Mapping[str, Any], blob: Blob, words: str = "") -> str:
    """The HTML text of a page.  description: plain data, its arrays in ``blob``; ``title`` and what ``app.js`` reads.

    words: HTML of the report under it (``words``).
    """
    values = {
        "TITLE": escape(str(description["title"])),
        "STYLE": _asset("style.css"),
        "DATA": script_safe(description),
        "BLOB": blob.text(),
        "THREE": _asset("three.min.js"),
        "WORDS": words,
        "CLASS": "report" if words else "",
        "CODE": "\n".join(_asset(name) for name in CODE),
    }
    # In one pass: no value is searched again.
    return _PLACE.sub(lambda match: values[match[1]], _asset("page.html"))


def script_safe(value: Any) -> str:
    """JSON that may stand in a script element: without ``<``, so that no text in it ends the element or opens another."""
    text = json.dumps(value, ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


@cache
def _asset(name: str) -> str:
    return (Path(__file__).parent / "assets" / name).read_text(encoding="utf-8")
