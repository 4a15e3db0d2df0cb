"""Every scene case of the manifest against ``scene.schema.json`` alone: what it accepts and what it leaves to C#; and
against every way in which Python reads scenes."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import kinefab
import pytest
from kinefab.diagnostics import KinefabError, Report, schema_directory
from kinefab.sources import read
from kinefab.views.overview import overview, picture

ROOT = Path(__file__).parents[1] / "conformance"
CASES = [
    case
    for case in json.loads((ROOT / "manifest.json").read_text(encoding="utf-8"))["cases"]
    if case["kind"] == "scene"
]


@pytest.fixture(scope="module")
def schema() -> jsonschema.Draft202012Validator:
    return jsonschema.Draft202012Validator(
        json.loads((schema_directory() / "scene.schema.json").read_text(encoding="utf-8"))
    )


@pytest.mark.parametrize("case", CASES, ids=lambda case: case["path"])
def test_schema_says_what_the_manifest_says(case, schema):
    """The schema accepts or rejects each case as its entry states; broken JSON counts as rejected."""
    try:
        accepts = schema.is_valid(json.loads((ROOT / case["path"]).read_bytes().decode("utf-8")))
    except ValueError:
        accepts = False
    assert ("accepts" if accepts else "rejects") == case["schema"]


def test_schema_is_stricter_than_the_reader_in_three_things_only():
    """Unknown fields are warnings in C#, and python's json stops at a byte order mark and at a binary file; nothing else is
    valid but rejected."""
    stricter = {case["path"] for case in CASES if case["expect"] == "valid" and case["schema"] == "rejects"}
    assert stricter == {
        "invalid/component/unknown_field.kinefab",
        "invalid/scene/unknown_field.kinefab",
        "valid/container/one_file.kinefab",
        "valid/text/byte_order_mark.kinefab",
    }


READERS = {
    "export": lambda path, folder: read(path, Report()),
    "inspect": lambda path, folder: overview(path, True),
    "draw": lambda path, folder: picture(path),
    "view": lambda path, folder: kinefab.view(path, folder / "page.html"),
    "motion": lambda path, folder: kinefab.motion(path),
}


@pytest.mark.parametrize("case", CASES, ids=lambda case: case["path"])
@pytest.mark.parametrize("reader", READERS)
def test_every_reader_refuses_what_the_validator_refuses(case, reader, tmp_path):
    """With the same errors: code, severity and place in the file, as the case's report has them.  There is no exception: the
    limits that C# sets by itself, bytes and items of a file, have no case.  What is valid is read, whatever C# warns of."""
    path = ROOT / case["path"]
    if case["expect"] == "valid":
        assert READERS[reader](path, tmp_path)
        return
    with pytest.raises(KinefabError) as raised:
        READERS[reader](path, tmp_path)
    report = json.loads(path.with_suffix(".report.json").read_text(encoding="utf-8"))
    expected = [(entry["code"], "error", f"{path}#{entry['pointer']}".rstrip("#")) for entry in report]
    assert [(d.code, d.severity.value, d.where) for d in raised.value.diagnostics] == expected


def test_nothing_is_written_of_a_scene_that_the_validator_refuses(tmp_path):
    with pytest.raises(KinefabError, match="ID_DUPLICATE"):
        kinefab.export(ROOT / "invalid/gameobject/id_twice.kinefab", tmp_path / "again.kinefab")
    assert not list(tmp_path.iterdir())
