"""The scenes committed beside the bundles are what the exporter makes of them."""

from __future__ import annotations

import json
from pathlib import Path

import kinefab
import pytest
from golden import OLDER, SETTINGS, differences, golden_pairs, today_of, unnamed

PAIRS = golden_pairs()


@pytest.mark.parametrize(("source", "scene"), PAIRS, ids=lambda path: path.name)
def test_golden_scene_is_what_the_export_gives(source: Path, scene: Path, tmp_path: Path):
    """Structure and words exactly, numbers to 1e-9; ``make golden`` writes them anew."""
    result = kinefab.export(source, tmp_path / scene.name, SETTINGS)
    assert apart(today_of(scene).read_text("utf-8"), result.path.read_text("utf-8")) == []


@pytest.mark.parametrize(("source", "scene"), PAIRS, ids=lambda path: path.name)
def test_a_scene_of_format_1_0_is_today_s_without_what_is_newer(source: Path, scene: Path, tmp_path: Path):
    result = kinefab.export(source, tmp_path / scene.name, OLDER)
    assert apart(scene.read_text("utf-8"), unnamed(result.path.read_text("utf-8"))) == []


def apart(expected: str, actual: str) -> list[str]:
    documents = [json.loads(text) for text in (expected, actual)]
    for document in documents:  # the order of a hull's corners is qhull's, and changes with its version
        document.pop("buffers", None)
        document.pop("meshes", None)
    return differences(*documents, 1e-9)


def test_differences_are_found():
    """The comparison sees other words, other numbers, missing fields and other lengths."""
    base = {"a": [1.0, 2.0], "b": "x", "c": True}
    assert differences(base, {"a": [1.0, 2.0 + 1e-12], "b": "x", "c": True}, 1e-9) == []
    for other in (
        {**base, "a": [1.0, 2.1]},
        {**base, "a": [1.0]},
        {**base, "b": "y"},
        {"a": [1.0, 2.0], "b": "x"},
        {**base, "c": False},
    ):
        assert differences(base, other, 1e-9) != []
