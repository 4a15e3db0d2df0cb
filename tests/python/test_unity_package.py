"""The package for Unity: every file has its meta, each guid stands once and is the one that it always was, and the same
files pack to the same bytes."""

from __future__ import annotations

import io
import json
import re
import sys
import tarfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "csharp" / "unity"))

import metas  # noqa: E402
import pack  # noqa: E402

@pytest.fixture(scope="module")
def library(tmp_path_factory) -> Path:
    """Stands for the library, which the build makes."""
    path = tmp_path_factory.mktemp("library") / "Kinefab.dll"
    path.write_bytes(b"MZ")
    return path


def guid_in(text: str) -> str:
    found = re.search(r"^guid: ([0-9a-f]{32})$", text, re.MULTILINE)
    assert found, text
    return found[1]


def test_every_file_has_the_meta_that_the_script_makes():
    wanted = {path.with_name(path.name + ".meta"): path for path in metas.wanting(metas.PACKAGE)}
    assert set(metas.PACKAGE.rglob("*.meta")) == set(wanted)
    for meta, path in wanted.items():
        made = metas.meta_of(path.relative_to(metas.PACKAGE).as_posix(), path.is_dir())
        assert meta.read_text("utf-8") == made, f"{path}: run csharp/unity/metas.py"


def test_packed_files_have_each_a_guid_of_its_own(library):
    files = pack.contents(library)
    visible = {path for path in files if not path.endswith(".meta") and not path.startswith("Documentation~")}
    folders = {f.as_posix() for path in visible for f in list(Path(path).parents)[:-1]} - {"Samples~"}
    of = {path.removesuffix(".meta") for path in files if path.endswith(".meta")}
    assert of == visible | folders
    guids = [guid_in(data.decode()) for path, data in files.items() if path.endswith(".meta")]
    assert len(set(guids)) == len(guids)


def test_packing_twice_gives_the_same_bytes(library):
    first, second = (pack.packed(pack.contents(library)) for _ in range(2))
    assert first == second
    with tarfile.open(fileobj=io.BytesIO(first)) as tar:
        assert "package/package.json" in tar.getnames()
        assert {member.mtime for member in tar} == {0}


def test_the_version_is_the_library_s():
    stated = re.search(r"<Version>(.+)</Version>", (ROOT / "csharp/Directory.Build.props").read_text("utf-8"))
    assert stated and pack.version() == stated[1]


def test_the_guides_name_the_oldest_editor_that_the_package_names():
    oldest = json.loads((ROOT / "csharp/unity/com.kinefab/package.json").read_text("utf-8"))["unity"]
    assert f"Unity {oldest} and later" in (ROOT / "guides/csharp.md").read_text("utf-8")
    assert f"Unity {oldest} or newer" in (ROOT / "csharp/unity/com.kinefab/README.md").read_text("utf-8")


def test_assemblies_see_the_library_and_nobody_else_does(library):
    files = pack.contents(library)
    assert b"isExplicitlyReferenced: 1" in files[pack.LIBRARY + ".meta"]
    for path, data in files.items():
        if path.endswith(".asmdef"):
            stated = json.loads(data)
            assert stated["overrideReferences"] and "Kinefab.dll" in stated["precompiledReferences"], path


def test_samples_that_are_named_are_there(library):
    files = pack.contents(library)
    for sample in json.loads(files["package.json"])["samples"]:
        assert any(path.startswith(sample["path"] + "/") for path in files), sample["path"]
