"""``NAME.unitypackage``: the prefab and its folder in one file, which a double click imports.

A tar in gzip: for each asset a folder, as a member of its own, named by its guid with ``asset``, ``asset.meta`` and ``pathname``.  Entries are sorted and
bear no time, so that the same scene gives the same bytes.
"""

from __future__ import annotations

import tarfile
from pathlib import Path

from ..diagnostics import KinefabError, is_encodable
from ..replacing import one_at_a_time, remove_leftovers, replacing
from .content import Content
from .packing import GzipStream
from .prefab.exporting import prefab_files
from .prefab.files import AssetFile
from .prefab.last import last_package
from .prefab.names import UNSEEN, file_name
from .prefab.options import PrefabOptions
from .prefab.text.ids import guid
from .prefab.text.metas import folder_meta

ENDING = ".unitypackage"
HOME = "Assets/Kinefab"
"""The project's folder that gets the prefab."""
INNER_NAME = "archtemp.tar"
"""What the editor calls the tar within."""


def write(content: Content, target: Path) -> tuple[Path, ...]:
    """Write the package.  Raises OSError as the file system does; then the old file stands as it was."""
    options = PrefabOptions.of(content.options)
    if not is_encodable(target.name):
        detail = "its name is not UTF-8"
        raise KinefabError([content.report.add("TARGET_UNWRITABLE", path=target, detail=detail)])
    name = _plain(target.name[: -len(ENDING)])
    last = last_package(target, guid(name, "prefab"))
    files = prefab_files(content, name, options, "Scripts", last=last)
    content.refuse_losses()
    home = guid("project folder", HOME)
    entries = [AssetFile("", home, folder_meta(home)), *files]
    with one_at_a_time(target.parent):
        remove_leftovers(target, "package")
        with replacing(target, "package") as out, GzipStream(out, INNER_NAME) as packed:
            for i, file in enumerate(sorted(entries, key=lambda f: f.guid)):
                _add(packed, file)
                content.progress((i + 1) / len(entries))
            packed.write(bytes(2 * tarfile.BLOCKSIZE))  # which end a tar; it fills its last record
            packed.write(bytes(-packed.size % tarfile.RECORDSIZE))
            packed.finish()
    return (target,)


def _plain(name: str) -> str:
    """The prefab's name in the project: one that every system holds and Unity imports."""
    plain = file_name(name)
    return f"_{plain}_" if UNSEEN.fullmatch(plain) else plain


def _add(packed: GzipStream, file: AssetFile) -> None:
    entries = {
        "asset.meta": [file.meta.encode("utf-8")],
        "pathname": [f"{HOME}/{file.path}".rstrip("/").encode("utf-8")],
    }
    if file.content is not None:
        entries = {"asset": list(file.content()), **entries}
    folder = tarfile.TarInfo(file.guid)
    folder.type, folder.mode = tarfile.DIRTYPE, 0o755
    packed.write(folder.tobuf(tarfile.GNU_FORMAT))
    for name, pieces in entries.items():
        entry = tarfile.TarInfo(f"{file.guid}/{name}")
        entry.size = sum(map(len, pieces))
        packed.write(entry.tobuf(tarfile.GNU_FORMAT))
        for piece in pieces:
            packed.write(piece)
        packed.write(bytes(-entry.size % tarfile.BLOCKSIZE))
