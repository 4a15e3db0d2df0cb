"""The way into a written scene: its JSON and its buffers, held to the rules of the format."""

from __future__ import annotations

import errno
import os
from collections.abc import Generator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ...diagnostics import KinefabError, diagnostic
from ..container import Damaged, chunks_of, is_container
from ..rules.findings import Findings
from ..rules.scene import check_contents, check_document
from ..rules.text import parsed


def read_scene(path: Path) -> tuple[Mapping[str, Any], list[bytes]]:
    """A scene's JSON, and the bytes of its buffers, which stand beside it, or in it.

    Raises KinefabError when it is missing, or with every place that breaks a rule: a buffer that is missing, or not the one
    that the scene was written with, too.
    """
    path = Path(path)
    if os.path.isdir(path):
        raise KinefabError([diagnostic("SOURCE_IS_FOLDER", path=path)])
    try:
        content = _content(path)
    except FileNotFoundError:
        raise KinefabError([diagnostic("SOURCE_NOT_FOUND", path=path)]) from None
    except OSError as error:
        raise _unreadable(path, error.strerror) from error
    except ValueError as error:  # a NUL in the path
        raise _unreadable(path, error) from error
    found = Findings(path)
    document = parsed(content, found)
    check_document(document, found)
    held = next((i for i, entry in enumerate(document.get("buffers", ())) if "uri" not in entry), None)
    buffers = check_contents(
        document, lambda index, entry: _buffer(path, entry, index, index == held, found), found
    )
    found.refuse()
    return document, buffers


def _content(path: Path) -> bytes:
    """Of a regular file: a pipe may never end.  Raises OSError."""
    if path.exists() and not path.is_file():
        raise OSError(errno.EINVAL, "it is no regular file")
    return path.read_bytes()


def _buffer(path: Path, entry: Mapping[str, Any], index: int, first: bool, found: Findings) -> bytes | None:
    """None, and a finding, where there is none of the length that is stated."""
    at, length = f"/buffers/{index}", int(entry["byteLength"])
    try:
        return _beside(path, entry["uri"], length) if "uri" in entry else _held(path, length, first)
    except _OtherSize as error:
        found.add("BUFFER_SIZE", f"{at}/byteLength", found=error, expected=length)
    except OSError as error:
        uri = entry.get("uri", "of this file")
        found.add("BUFFER_MISSING", f"{at}/uri" if "uri" in entry else at, uri=uri, detail=error.strerror)
    return None


class _OtherSize(Exception):
    """A buffer has another size than the scene states; the text is its own."""


def _beside(path: Path, uri: str, length: int) -> bytes:
    """A buffer in a file of its own.  Raises OSError, or _OtherSize without having read it."""
    own = path.parent / uri
    size = own.stat().st_size
    if own.is_file() and size != length:
        raise _OtherSize(size)
    return _content(own)


def _held(path: Path, length: int, first: bool) -> bytes:
    """The buffer that stands in the scene's own file, of which there is one.  Raises OSError or _OtherSize."""
    try:
        content = _content(path)
        held = chunks_of(content)[1] if is_container(content) and first else None
    except Damaged as error:
        raise OSError(errno.EINVAL, str(error)) from error
    if held is None:
        raise OSError(errno.ENOENT, "the file holds none" if first else "another one without a uri stands before it")
    if not 0 <= len(held) - length < 4:
        raise _OtherSize(len(held))
    return bytes(held[:length])


@contextmanager
def unsound_as_finding(path: Path) -> Generator[None, None, None]:
    """What breaks no rule of the format and yet no reader here can take is refused as a whole, never an exception."""
    try:
        yield
    except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as error:
        raise _unreadable(path, f"no reader here can take it: {error}") from error


def _unreadable(path: Path, detail: object) -> KinefabError:
    return KinefabError([diagnostic("SCENE_UNREADABLE", str(path), detail=detail)])
