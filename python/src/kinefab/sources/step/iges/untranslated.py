"""Entities of an IGES file that hold parts and that OpenCASCADE passes over without a word.  Source: IGES 5.3, chapter 4."""

from __future__ import annotations

from collections import Counter

from ....diagnostics import Report

PASSED_OVER = {
    150: "block", 152: "wedge", 154: "cylinder", 156: "cone", 158: "sphere", 160: "torus", 162: "solid of revolution",
    164: "solid of linear extrusion", 168: "ellipsoid", 180: "boolean tree", 184: "solid assembly",
    412: "rectangular array of instances", 414: "circular array of instances", 416: "reference to another file",
    430: "solid instance",
}  # fmt: skip
"""By type number."""


def tell_untranslated(data: bytes, file: str, report: Report) -> None:
    """Report what holds parts and will not be there.  file: name of the source, for places."""
    entries = [line[:8] for line in data.splitlines() if line[72:73] == b"D"]
    types = Counter(int(entry) for entry in entries[::2] if entry.strip().isdigit())
    for number, name in PASSED_OVER.items():
        if count := types[number]:
            report.dropped(
                f"IGES entities of type {number}",
                "IGES_NOT_TRANSLATED",
                file,
                count=count,
                name=name,
                number=number,
            )
