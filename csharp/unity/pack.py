"""Packs the Unity package as ``out/com.kinefab-VERSION.tgz``: ``python csharp/unity/pack.py LIBRARY.dll [-o FOLDER]``.

What is not committed comes in here: the library, and licence and notices, which stand at the top of the repository. The same files give the same
bytes; ``make unity`` builds the library first.
"""

from __future__ import annotations

import argparse
import gzip
import io
import json
import sys
import tarfile
from pathlib import Path

from metas import NAME, PACKAGE, meta_of, wanting

ROOT = Path(__file__).resolve().parents[2]
LIBRARY = "Runtime/Plugins/Kinefab.dll"
ADDED = {"LICENSE.md": ROOT / "LICENSE", "Third Party Notices.md": ROOT / "THIRD-PARTY-NOTICES.md"}


def version() -> str:
    return json.loads((PACKAGE / "package.json").read_text("utf-8"))["version"]


def contents(library: Path) -> dict[str, bytes]:
    """Every file of the package by its path, in order, each with its meta."""
    files = {
        path.relative_to(PACKAGE).as_posix(): path.read_bytes()
        for path in PACKAGE.rglob("*")
        if path.is_file() and not any(part.startswith(".") for part in path.relative_to(PACKAGE).parts)
    }
    added = {LIBRARY: library, **ADDED}
    for path, source in added.items():
        files[path] = source.read_bytes()
        files[path + ".meta"] = meta_of(path, is_folder=False).encode()
        for folder in list(Path(path).parents)[:-1]:
            files[f"{folder.as_posix()}.meta"] = meta_of(folder.as_posix(), is_folder=True).encode()
    return dict(sorted(files.items()))


def packed(files: dict[str, bytes]) -> bytes:
    """As npm packs: below ``package/``, without times and owners."""
    tape = io.BytesIO()
    with tarfile.open(fileobj=tape, mode="w", format=tarfile.USTAR_FORMAT) as tar:
        for path, data in files.items():
            entry = tarfile.TarInfo(f"package/{path}")
            entry.size, entry.mode = len(data), 0o644
            tar.addfile(entry, io.BytesIO(data))
    return gzip.compress(tape.getvalue(), compresslevel=9, mtime=0)


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("library", type=Path, help="Kinefab.dll, built for netstandard2.1")
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "out", help="folder of the package")
    chosen = parser.parse_args(arguments)
    missing = [path for path in wanting(PACKAGE) if not path.with_name(path.name + ".meta").is_file()]
    if missing:
        print(f"no .meta: {missing[0]}; run csharp/unity/metas.py", file=sys.stderr)
        return 1
    chosen.output.mkdir(parents=True, exist_ok=True)
    target = chosen.output / f"{NAME}-{version()}.tgz"
    target.write_bytes(packed(contents(chosen.library)))
    print(target)
    return 0


if __name__ == "__main__":
    sys.exit(main())
