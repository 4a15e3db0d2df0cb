"""A page that lists what a batch made: a picture, a link and the outcome of each file."""

from __future__ import annotations

import html
import os
import posixpath
from collections.abc import Iterable
from urllib.parse import quote

from . import places
from .job import Record

STYLE = """
:root { color-scheme: light dark; font: 14px system-ui, sans-serif } body { margin: 2rem }
main { display: grid; grid-template-columns: repeat(auto-fill, minmax(15rem, 1fr)); gap: 1rem }
article { border: 1px solid #8884; border-radius: 8px; padding: .7rem; overflow-wrap: anywhere }
img { width: 100%; aspect-ratio: 19 / 14; object-fit: cover; object-position: left; background: #fff; border-radius: 4px }
h2 { font-size: 1rem; margin: .4rem 0 } p { margin: .2rem 0; opacity: .8 } .bad { color: #c0392b; opacity: 1 }
"""
"""The pictures are shown as far as their legend, which nobody could read at this size."""


def index_page(records: Iterable[Record], out: str) -> str:
    """HTML; links are relative to ``out``."""
    cards: list[str] = []
    ordered = sorted(records, key=lambda record: record.target)
    for record in ordered:
        picture = (
            f'<img loading="lazy" alt="" src="{_link(record.thumbnail, out)}">' if record.thumbnail else ""
        )
        name = html.escape(_relative(record.target, out))
        title = f'<a href="{_link(record.target, out)}">{name}</a>' if record.outcome.good else name
        told = " ".join(f"{code} x {count}" for code, count in record.codes.items())
        mobility = "" if record.mobility is None else f"mobility {record.mobility}, "
        messages = "".join(f'<p class="bad">{html.escape(message)}</p>' for message in record.messages)
        kind = "" if record.outcome.good else ' class="bad"'
        cards.append(
            f"<article>{picture}<h2>{title}</h2><p{kind}>{record.outcome.value.replace('_', ' ')}</p>"
            f"<p>{mobility}{record.seconds:.2f} s</p><p>{html.escape(told)}</p>{messages}</article>"
        )
    good = sum(record.outcome.good for record in ordered)
    return (
        f'<!doctype html><html lang="en"><meta charset="utf-8"><title>Kinefab batch</title><style>{STYLE}</style>'
        f"<h1>{good} of {len(ordered)} converted</h1><main>{''.join(cards)}</main></html>\n"
    )


def _relative(place: str, out: str) -> str:
    if places.is_url(place):
        return posixpath.relpath(place, out) if place.startswith(out) else place
    return os.path.relpath(place, out).replace(os.sep, "/")


def _link(place: str, out: str) -> str:
    """A colon divides a URL's scheme from the rest, and not one in a file's name, as in ``javascript:1.kinefab``."""
    relative = _relative(place, out)
    return html.escape(quote(relative, safe="/:" if places.is_url(relative) else "/"))
