"""The report under the page: the analysis in words, a plot for each driven freedom, the losses.  Every text is escaped."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

import numpy as np

from ...spatial import Array
from .plots import Curve, plot

MOST_CURVES = 4
MOST_ENTRIES = 500
Entry = Mapping[str, Any]


@dataclass(frozen=True, slots=True, eq=False)
class Stroke:
    """One freedom through its whole reach.

    name, unit: of the driven coordinate.  values: of it, ascending.  ends: what stops it at either end, in words.
    followers: name, unit and values of the coordinates that move with it.
    branchings: values of it where the mechanism could go another way.
    """

    name: str
    unit: str
    values: Array
    ends: tuple[str, str]
    followers: Sequence[tuple[str, str, Array]]
    branchings: Sequence[float] = ()


def report_words(description: Entry, strokes: Sequence[Stroke]) -> str:
    """The HTML of the report.  description: the page's (``describe``)."""
    parts = [f"<h2>{_text(description['title'])}</h2>", f"<p>{_text(_summary(description))}</p>"]
    parts.append(_table(("", ""), description["facts"]))
    for stroke in strokes:
        parts.append(_stroke(stroke))
    parts += ["<h2>Joints</h2>", _joints(description["joints"])]
    parts += ["<h2>What became of the source</h2>", _losses(description["report"])]
    return "".join(parts)


def _summary(description: Entry) -> str:
    free = len({name for block in description["blocks"] for name in block["held"]})
    joints = description["joints"]
    closing = sum(joint["closure"] for joint in joints)
    if not free:
        return "No joint of this scene can move."
    words = f"The mechanism moves in {free} way{'s' if free > 1 else ''}"
    words += f", by {len(joints)} joint{'s' if len(joints) != 1 else ''}"
    return words + (
        f", {closing} of which close{'s' if closing == 1 else ''} a loop." if closing else ", in no loop."
    )


def _stroke(stroke: Stroke) -> str:
    unit = "degrees" if stroke.unit == "deg" else "m"
    low, high = (_rounded(stroke.values[i]) for i in (0, -1))
    parts = [f"<h2>{_text(stroke.name)}</h2>"]
    reach = f"From {low:.4g} {unit} ({stroke.ends[0]}) to {high:.4g} {unit} ({stroke.ends[1]})."
    if stroke.branchings:
        places = ", ".join(f"{value:.6g}" for value in stroke.branchings)
        reach += f" At {places} {unit} another motion branches off; the plots go straight on."
    parts.append(f"<p>{_text(reach)}</p>")
    rows: list[tuple[str, str]] = []
    for name, other, values in stroke.followers:
        least, most = _rounded(values.min()), _rounded(values.max())
        told = f"{least:.6g} to {most:.6g} {other}, a stroke of {most - least:.6g} {other}"
        rows.append((name, told))
    if rows:
        parts.append(_table(("follows", "reach"), rows))
    for kind in ("m", "deg"):
        curves = [Curve(name, values) for name, other, values in stroke.followers if other == kind][
            :MOST_CURVES
        ]
        if not curves or high <= low:
            continue
        across, up = f"{stroke.name}, {unit}", "degrees" if kind == "deg" else "m"
        turns = stroke.unit == "deg", kind == "deg"
        parts.append(_figure(plot(stroke.values, curves, across, up, turns), "Where the others stand."))
        rates = [Curve(c.name, np.gradient(c.values, stroke.values)) for c in curves]
        caption = "Transmission: how far each goes for each unit of the driven one."
        parts.append(
            _figure(
                plot(stroke.values, rates, across, f"{up} per {unit.removesuffix('s')}", (turns[0], False)),
                caption,
            )
        )
    return "".join(parts)


def _figure(svg: str, caption: str) -> str:
    return f"<figure>{svg}<figcaption>{escape(caption)}</figcaption></figure>"


def _joints(joints: Sequence[Entry]) -> str:
    rows = [
        (j["label"], j["type"], j["words"], ", ".join(r["id"] for r in j["because"]))
        for j in joints[:MOST_ENTRIES]
    ]
    return _table(("joint", "in Unity", "what moves", "from"), rows) if rows else "<p>There are none.</p>"


def _losses(report: Sequence[Entry]) -> str:
    counts = [sum(e["outcome"] == word for e in report) for word in ("kept", "approximated", "dropped")]
    words = "{} kept, {} approximated, {} dropped.".format(*counts)
    told = [
        (e["outcome"], e["feature"], e.get("message", ""))
        for e in report
        if e["outcome"] != "kept" or e.get("code")
    ]
    table = _table(("outcome", "feature", "why"), told[:MOST_ENTRIES]) if told else ""
    return f"<p>{words}</p>{table}"


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    top = "".join(f"<th>{_text(word)}</th>" for word in head) if any(head) else ""
    body = "".join("<tr>" + "".join(f"<td>{_text(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<div class=wide><table>{f'<tr>{top}</tr>' if top else ''}{body}</table></div>"


def _rounded(value: float) -> float:
    """Without the last digits of a solution: a nanometre says zero where they say 1e-17."""
    return round(float(value), 9) + 0.0


def _text(value: object) -> str:
    return escape(str(value))
