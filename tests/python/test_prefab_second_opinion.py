"""Others' word on the files: PyYAML reads from them what our own reader does, and the tables that our documents are held to
are those of what editors have written: any folder of Unity projects that ``KINEFAB_UNITY_PROJECTS`` names."""

from __future__ import annotations

import os
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import kinefab
import pytest
from prefab_scenes import rich_scene
from test_prefab_documents import DIALECTS, TABLE, disagreements
from unity_yaml import HEADER, Document, documents

YAML_ENDINGS = (
    ".prefab",
    ".unity",
    ".asset",
    ".mat",
    ".anim",
    ".mesh",
    ".physicMaterial",
    ".physicsMaterial",
)
LARGEST = 400_000
"""Characters of a document; terrain and baked light are of no interest."""


def as_yaml_reads(value):
    """Our reader's scalars are text; so is everything of PyYAML's base loader."""
    if isinstance(value, dict):
        return {key: as_yaml_reads(v) for key, v in value.items()}
    return [as_yaml_reads(v) for v in value] if isinstance(value, list) else str(value)


@pytest.mark.parametrize("dialect", DIALECTS)
def test_pyyaml_reads_the_same(tmp_path, dialect):
    yaml = pytest.importorskip("yaml", reason="PyYAML is not installed")

    class Loader(yaml.BaseLoader):
        pass

    Loader.add_multi_constructor(
        "tag:unity3d.com,2011:", lambda loader, _, node: loader.construct_mapping(node, deep=True)
    )
    options = kinefab.ExportOptions(writing={"unity": dialect, "pipeline": "hdrp", "scripts": True})
    target = tmp_path / "Rich.prefab"
    kinefab.export(rich_scene(tmp_path), target, options)
    files = [p for p in [target, *sorted((tmp_path / "Rich").rglob("*"))] if p.suffix in YAML_ENDINGS]
    for path in files:
        text = path.read_text("utf-8")
        tags = [int(n) for n in re.findall(r"^--- !u!(\d+) ", text, flags=re.MULTILINE)]
        parts = re.split(r"^(?=--- !u!)", text[len(HEADER) :], flags=re.MULTILINE)
        read = [
            yaml.load(HEADER + part, Loader) for part in parts if part
        ]  # a %TAG is one document's to PyYAML
        own = documents(text)
        assert [d.class_id for d in own] == tags
        assert [{d.kind: as_yaml_reads(d.fields)} for d in own] == read, path.name
    for meta in sorted(tmp_path.rglob("*.meta")):
        read = yaml.load(meta.read_text("utf-8"), yaml.BaseLoader)
        assert read["fileFormatVersion"] == "2" and re.fullmatch("[0-9a-f]{32}", read["guid"])
    assert len(files) > 5


def public_documents(root: Path) -> Iterator[tuple[Path, Document]]:
    """Of the classes that the tables know; what is stripped has no fields of its own."""
    known = set().union(*TABLE.values()) - {"MonoBehaviour"}
    for path in sorted(p for p in root.rglob("*") if p.suffix in YAML_ENDINGS and p.is_file()):
        text = path.read_text("utf-8", errors="replace")
        if not text.startswith(HEADER):
            continue
        for part in re.split(r"^(?=--- !u!)", text[len(HEADER) :], flags=re.MULTILINE):
            match = re.match(r"--- !u!\d+ &-?\d+\n([A-Za-z]+):\n", part)
            if match and match[1] in known and len(part) <= LARGEST:
                yield path, documents(HEADER + part.replace("\t", " ").rstrip("\n") + "\n")[0]


def without_negative_zero(value):
    """What editors write of a rotation turned to and fro; we write none."""
    if isinstance(value, dict):
        return {key: without_negative_zero(v) for key, v in value.items()}
    if isinstance(value, list):
        return [without_negative_zero(v) for v in value]
    if value == "-0":
        value = type(value)("0")
    return value


def same_fields(value, rule) -> bool:
    """Whether a document is of this editor's time: the same names, in whatever order, and the same version."""
    if not isinstance(rule, dict) or not isinstance(value, dict):
        return True
    version = rule.get("serializedVersion")
    if set(value) != set(rule) or (version is not None and value["serializedVersion"] != str(version)):
        return False
    return all(same_fields(value[key], rule[key]) for key in rule)


def test_what_editors_wrote_is_as_the_tables_say():
    root = os.environ.get("KINEFAB_UNITY_PROJECTS")
    if not root:
        pytest.skip("KINEFAB_UNITY_PROJECTS names no folder of Unity projects")
    seen, alike, otherwise = Counter(), Counter(), []
    for path, document in public_documents(Path(root)):
        seen[document.kind] += 1
        tables = [TABLE[dialect][document.kind] for dialect in DIALECTS if document.kind in TABLE[dialect]]
        of_its_time = [table for table in tables if same_fields(document.fields, table["fields"])]
        if not of_its_time:
            continue
        alike[document.kind] += 1
        fields = without_negative_zero(document.fields)
        found = [disagreements(fields, table["fields"], f"{path} {document.kind}") for table in of_its_time]
        if all(found) or all(table["classID"] != document.class_id for table in tables):
            otherwise.append(min(found, key=len)[0])
    print({kind: f"{alike[kind]} of {count}" for kind, count in sorted(seen.items())})
    assert seen and otherwise == []
