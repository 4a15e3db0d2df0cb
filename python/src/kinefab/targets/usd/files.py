"""The layer as text (``.usda``), as a crate (``.usdc``), or as a package of crate and images (``.usdz``).

Beside text and crates the images are named by what they hold, so a new one never stands in an old one's place: they are
written first, then the stage takes its place, then old images go.  A kill leaves an old or a new stage with all its images.
"""

from __future__ import annotations

import re
import shutil
import struct
import tempfile
import zipfile
from pathlib import Path

from ...replacing import one_at_a_time, remove_leftovers, replacing, sync_directory
from ..content import Content
from .looks.textures import ENDINGS, HASH_DIGITS, Textures
from .stage import Stage

ROLES = ("stage", "image")
ALIGNED = 64
"""Bytes, of what stands in a package."""
PADDING = 0x1986
"""The extra field that USD's own packages are filled up with."""


def write(content: Content, target: Path) -> tuple[Path, ...]:
    """Write the scene; the report gets what USD has no place for.  Raises OSError; then the old files stand."""
    ending = target.suffix.lower()
    packed = ending == ".usdz"
    textures = Textures("textures/" if packed else f"{target.name}.", content.report)
    stage = Stage(content, target.stem, ending, textures)
    stage.write()
    content.refuse_losses()
    with tempfile.TemporaryDirectory(prefix="kinefab-usd-") as folder:
        made = Path(folder) / f"stage{'.usdc' if packed else ending}"
        if not stage.layer.Export(str(made)):
            raise OSError("USD could not write the stage")
        content.progress(0.9)
        if packed:
            made = _package(made, textures.files)
        images = {} if packed else {target.with_name(name): data for name, data in textures.files.items()}
        with one_at_a_time(target.parent):
            remove_leftovers(target, *ROLES)
            for path, data in images.items():
                with replacing(path, "image") as file:
                    file.write(data)
            with replacing(target, "stage") as file, made.open("rb") as source:
                shutil.copyfileobj(source, file)
            sync_directory(target.parent)
            _remove_old_images(target, set(images))
    content.progress(1.0)
    return (target, *images)


def _package(stage: Path, files: dict[str, bytes]) -> Path:
    """The package of a stage, which is its first file, and its images.

    A zip file that holds everything as it is, each file's bytes at a multiple of 64; USD's own writer would date them.
    """
    package = stage.with_suffix(".usdz")
    try:
        with zipfile.ZipFile(package, "w", zipfile.ZIP_STORED, allowZip64=False) as archive:
            with stage.open("rb") as source, archive.open(_entry(archive, stage.name), "w") as member:
                shutil.copyfileobj(source, member)
            for name, data in files.items():
                archive.writestr(_entry(archive, name), data)
    except zipfile.LargeZipFile as error:
        raise OSError("a package holds at most 4 GiB") from error
    return package


def _entry(archive: zipfile.ZipFile, name: str) -> zipfile.ZipInfo:
    """The next file of an archive."""
    entry = zipfile.ZipInfo(name)  # of 1980, the first year that there is
    entry.create_system, entry.external_attr = 3, 0o644 << 16
    assert archive.fp is not None
    head = 30 + len(name.encode()) + 4
    padding = -(archive.fp.tell() + head) % ALIGNED
    entry.extra = struct.pack("<HH", PADDING, padding) + bytes(padding)
    return entry


def _remove_old_images(target: Path, keep: set[Path]) -> None:
    endings = "|".join(map(re.escape, ENDINGS))
    pattern = re.compile(re.escape(target.name) + rf"\.[0-9a-f]{{{HASH_DIGITS}}}({endings})")
    for path in target.parent.iterdir():
        if path not in keep and pattern.fullmatch(path.name):
            path.unlink(missing_ok=True)
