"""The scenes committed beside the bundles are what the exporter makes of them."""

from __future__ import annotations

import json
from pathlib import Path

import kinefab
import pytest
from golden import SETTINGS, differences, golden_pairs, unnamed

PAIRS = golden_pairs()


@pytest.mark.parametrize(("source", "scene"), PAIRS, ids=lambda path: path.name)
def test_golden_scene_is_what_the_export_gives(source: Path, scene: Path, tmp_path: Path):
    """Structure and words exactly, numbers to 1e-9; ``make golden`` writes them anew."""
    result = kinefab.export(source, tmp_path / scene.name, SETTINGS)
    expected, actual = (json.loads(unnamed(path.read_text("utf-8"))) for path in (scene, result.path))
    for content in (
        expected,
        actual,
    ):  # the order of a hull's corners is qhull's, and changes with its version
        content.pop("buffers", None)
        content.pop("meshes", None)
    assert differences(expected, actual, 1e-9) == []


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
