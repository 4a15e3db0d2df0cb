"""Every scene case of the manifest against ``scene.schema.json`` alone: what it accepts and what it leaves to C#; and
against what shows scenes."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import pytest
from kinefab.diagnostics import KinefabError, schema_directory
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


@pytest.mark.parametrize("case", CASES, ids=lambda case: case["path"])
@pytest.mark.parametrize("show", [lambda path: overview(path, True), picture], ids=["inspect", "draw"])
def test_valid_scenes_are_shown_and_others_at_most_refused(case, show):
    """A sound scene is shown whatever it holds; of an unsound one a finding is told, if anything."""
    try:
        assert show(ROOT / case["path"])
    except KinefabError as error:
        assert case["expect"] != "valid" and error.diagnostics
