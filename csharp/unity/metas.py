"""Writes the ``.meta`` beside every file and folder of the Unity package: ``python csharp/unity/metas.py``.

A guid comes from the path, so that it is the same wherever and whenever it is made. Users' projects refer to scripts and
assets by guid alone: nothing that was released may be moved.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path, PurePosixPath

from kinefab.targets.prefab.text import metas
from kinefab.targets.prefab.text.ids import guid

NAME = "com.kinefab"
PACKAGE = Path(__file__).parent / NAME
IMPORTER = "Editor/Import/KinefabImporter.cs"


def guid_of(path: str) -> str:
    """path: in the package, with slashes."""
    return guid(NAME, path)


def is_of_exporter(path: str) -> bool:
    """Whether ``kinefab export`` wrote a sample's file, and its meta with the guid by which the files beside it know it."""
    parts = PurePosixPath(path).parts
    return len(parts) > 3 and parts[0] == "Samples~" and parts[2] == "Prefab"


def meta_of(path: str, is_folder: bool) -> str:
    """The text of the meta beside a file or folder."""
    own = guid_of(path)
    name = PurePosixPath(path).name
    if is_of_exporter(path):
        return (PACKAGE / f"{path}.meta").read_text("utf-8")
    if is_folder:
        return metas.folder_meta(own)
    if name == "package.json":
        return metas.simple_meta(own, "PackageManifestImporter")
    match PurePosixPath(path).suffix:
        case ".cs":
            return metas.script_meta(own)
        case ".asmdef":
            return metas.assembly_meta(own)
        case ".dll":
            return metas.plugin_meta(own)
        case ".prefab":
            return metas.prefab_meta(own)
        case ".kinefab":
            return metas.scripted_meta(own, guid_of(IMPORTER))
        case ".md" | ".txt" | ".json" | ".xml":
            return metas.simple_meta(own, "TextScriptImporter")
        case _:
            return metas.simple_meta(own, "DefaultImporter")


def wanting(root: Path) -> Iterator[Path]:
    """All files and folders that Unity looks at, in order: none whose name begins with a dot, and of those whose name ends
    with a tilde only what is in the samples."""
    for path in sorted(root.rglob("*")):
        parts = path.relative_to(root).parts
        hidden = [part for part in parts if part.startswith(".") or part.endswith("~")]
        in_samples = parts[0] == "Samples~" and len(parts) > 1 and hidden == ["Samples~"]
        if path.suffix != ".meta" and (not hidden or in_samples):
            yield path


def main() -> int:
    wanted = {
        path.with_name(path.name + ".meta"): meta_of(path.relative_to(PACKAGE).as_posix(), path.is_dir())
        for path in wanting(PACKAGE)
    }
    for orphan in set(PACKAGE.rglob("*.meta")) - set(wanted):
        orphan.unlink()
    for path, text in wanted.items():
        path.write_text(text, encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
