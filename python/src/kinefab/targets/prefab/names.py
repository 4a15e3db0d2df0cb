"""Names that Unity, its animation paths and every file system hold, each once among its neighbours."""

from __future__ import annotations

import hashlib
import re
import unicodedata
from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence

MOST_BYTES = 120
"""Of a file's name, so that ending, ``.meta`` and a temporary name's ornaments stay below the 255 of file systems."""
LEAST_BYTES = 24
TOGETHER_BYTES = 140
"""Of the prefab's name and a file's: with folders, endings and some for the project's own path they stay below Windows' 260 characters."""
RESERVED = re.compile(r"(con|prn|aux|nul|conin\$|conout\$|(com|lpt)[\d¹²³]) *(\..*)?", re.IGNORECASE)
"""Names that Windows keeps for devices, whatever follows the dot."""
UNSEEN = re.compile(
    r"(\..*|.*~|cvs|.*\.(tmp|bundle|framework|plugin|androidlib)|editor|streamingassets)?", re.IGNORECASE
)
"""Folders whose assets Unity leaves alone, takes for parts of a plug-in, or leaves out of what it builds; and no name at all."""
NOT_IN_WINDOWS = re.compile(r'[<>:"\\|?*\x00-\x1f]')
_DIGITS = 6


def object_name(name: str) -> str:
    """A GameObject's: without slashes, which divide paths, and without control characters; never empty."""
    plain = "".join(
        "_" if c == "/" or unicodedata.category(c) in ("Cc", "Cs", "Zl", "Zp") else c for c in name
    )
    return plain.strip() or "_"


def most_bytes(prefab: str) -> int:
    """Of the files' names in the folder of a prefab of this name."""
    room = TOGETHER_BYTES - len(prefab.encode("utf-8", "surrogatepass"))
    return max(LEAST_BYTES, min(MOST_BYTES, room))


def file_name(name: str, most: int = MOST_BYTES) -> str:
    """A file's, without ending: nothing that a file system of Windows, macOS or Linux refuses, and none that Unity hides."""
    plain = unicodedata.normalize("NFC", object_name(name))
    plain = re.sub(r'[<>:"\\|?*#%~]', "_", plain).strip(" .")
    while len(plain.encode("utf-8", "surrogatepass")) > most:
        plain = plain[:-1]
    plain = plain.rstrip(" .") or "_"
    return f"_{plain}" if RESERVED.fullmatch(plain) else plain


def why_not_shared(name: str) -> str:
    """Why a project with a file of this name, without ending, cannot be opened on Windows; "" where it can."""
    if RESERVED.fullmatch(name):
        return f"Windows keeps the name '{name}' for a device"
    if NOT_IN_WINDOWS.search(name) or name != name.rstrip(" ."):
        return f"Windows holds no folder '{name}', and a project is shared; '{file_name(name)}' would do"
    return ""


def unique(named: Sequence[tuple[str, str]], key: Callable[[str], str] = str) -> list[str]:
    """Each once, compared by ``key``.  named: pairs (name, what the thing is in the source).

    Of several alike the one that is first by what it is keeps the name, the others get digits that are made of what they are: a name
    depends on no order, and seldom on what else is there.
    """
    alike: dict[str, list[int]] = defaultdict(list)
    for i, (name, _) in enumerate(named):
        alike[key(name)].append(i)
    found = [name for name, _ in named]
    taken = set(alike)
    for members in alike.values():
        for i in sorted(members, key=lambda i: named[i][1])[1:]:
            name, identity = named[i]
            tail, count = _digits(identity), 1
            while key(f"{name}~{tail}") in taken:
                count += 1
                tail = _digits(f"{identity}#{count}")
            found[i] = f"{name}~{tail}"
            taken.add(key(found[i]))
    return found


def folded(name: str) -> str:
    """By which file systems that know no capitals compare names."""
    return unicodedata.normalize("NFC", name).casefold()


def _digits(identity: str) -> str:
    return hashlib.md5(identity.encode("utf-8", "surrogatepass"), usedforsecurity=False).hexdigest()[:_DIGITS]


def sibling_names(parents: Iterable[int | None], names: Sequence[str], ids: Sequence[str]) -> list[str]:
    """Names of GameObjects, each once below its parent."""
    below: dict[int | None, list[int]] = defaultdict(list)
    for i, parent in enumerate(parents):
        below[parent].append(i)
    found = [""] * len(names)
    for members in below.values():
        for i, name in zip(members, unique([(object_name(names[i]), ids[i]) for i in members])):
            found[i] = name
    return found
