"""``NAME.unitypackage``: the prefab and its folder in one file, which a double click imports.

A tar in gzip: for each asset a folder named by its guid with ``asset``, ``asset.meta`` and ``pathname``.  Entries are sorted and
bear no time, so that the same scene gives the same bytes.
"""

from __future__ import annotations

import gzip
import io
import tarfile
from pathlib import Path

from ..diagnostics import KinefabError
from ..replacing import one_at_a_time, remove_leftovers, replacing
from .content import Content
from .prefab.exporting import prefab_files
from .prefab.files import AssetFile
from .prefab.names import UNSEEN, file_name
from .prefab.options import PrefabOptions
from .prefab.text.ids import guid
from .prefab.text.metas import folder_meta

ENDING = ".unitypackage"
HOME = "Assets/Kinefab"
"""The project's folder that gets the prefab."""
INNER_NAME = "archtemp.tar"
"""What the editor calls the tar within."""
LEVEL = 3
"""Of gzip: hexadecimal shrinks as well as it does at 6, in a third of the time."""


def write(content: Content, target: Path) -> tuple[Path, ...]:
    """Write the package.  Raises OSError as the file system does; then the old file stands as it was."""
    options = PrefabOptions.of(content.options)
    if any("\ud800" <= character <= "\udfff" for character in target.name):
        detail = "its name is not UTF-8"
        raise KinefabError([content.report.add("TARGET_UNWRITABLE", path=target, detail=detail)])
    files = prefab_files(content, _plain(target.name[: -len(ENDING)]), options, "Scripts")
    content.refuse_losses()
    home = guid("project folder", HOME)
    entries = [AssetFile("", home, folder_meta(home)), *files]
    with one_at_a_time(target.parent):
        remove_leftovers(target, "package")
        with replacing(target, "package") as out:
            packed = gzip.GzipFile(INNER_NAME, "wb", LEVEL, out, mtime=0)  # type: ignore[arg-type]
            with packed, tarfile.open(fileobj=packed, mode="w|", format=tarfile.GNU_FORMAT) as tar:
                for i, file in enumerate(sorted(entries, key=lambda f: f.guid)):
                    _add(tar, file)
                    content.progress((i + 1) / len(entries))
    return (target,)


def _plain(name: str) -> str:
    """The prefab's name in the project: one that every system holds and Unity imports."""
    plain = file_name(name)
    return f"_{plain}_" if UNSEEN.fullmatch(plain) else plain


def _add(tar: tarfile.TarFile, file: AssetFile) -> None:
    entries = {
        "asset.meta": file.meta.encode("utf-8"),
        "pathname": f"{HOME}/{file.path}".rstrip("/").encode("utf-8"),
    }
    if file.content is not None:
        entries = {"asset": b"".join(file.content()), **entries}
    for name, data in entries.items():
        entry = tarfile.TarInfo(f"{file.guid}/{name}")
        entry.size = len(data)
        tar.addfile(entry, io.BytesIO(data))
