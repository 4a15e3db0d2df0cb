"""Buffers: that they are the ones that the scene was written with, and that what is said to lie in them does."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable

from .findings import Entry, Findings

_HASH = re.compile("[0-9a-f]{64}")


def check_buffer(buffer: Entry, at: str, read: Callable[[], bytes | None], found: Findings) -> bytes | None:
    """Its bytes, as long as it says; None where nobody should look into them.  read: gives them, or None and says why."""
    named = is_hash(buffer["sha256"])
    if not named:
        found.add("SHA256_INVALID", f"{at}/sha256")
    if "uri" in buffer and not is_safe(buffer["uri"]):
        found.add("BUFFER_URI_UNSAFE", f"{at}/uri", uri=buffer["uri"])
        return None
    content = read()
    if content is None or not named:
        return None
    if hashlib.sha256(content).hexdigest() != buffer["sha256"]:
        found.add("BUFFER_SHA256", f"{at}/sha256", uri=buffer.get("uri", "What lies in this file"))
        return None
    return content


def is_hash(text: str) -> bool:
    """Whether it is a SHA-256 as the format writes it."""
    return _HASH.fullmatch(text) is not None


def is_safe(uri: str) -> bool:
    """Whether it names a file in the scene's folder, or below it, on every system."""
    # ":" is a drive or a scheme, a backslash Windows' separator
    if any(c in ":\\" or c < " " or "\x7f" <= c <= "\x9f" for c in uri):
        return False
    return not {"", ".", ".."}.intersection(uri.split("/"))


def check_place(place: Entry, length: int, buffers: list[Entry], at: str, found: Findings) -> bool:
    """Whether so many bytes lie in the buffer at the place that an accessor names, on a multiple of 4."""
    if not found.reference(place["buffer"], "buffers", len(buffers), f"{at}/buffer"):
        return False
    offset, ends = place["offset"], buffers[place["buffer"]]["byteLength"]
    if offset < 0 or offset % 4:
        found.add("BUFFER_MISALIGNED", f"{at}/offset", offset=offset)
        return False
    if offset + length > ends:
        found.add("BUFFER_OVERRUN", at, end=offset + length, length=ends)
        return False
    return True
