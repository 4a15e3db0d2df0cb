"""The golden scenes of ``fixtures``: each mechanism's and pair's bundle beside the scene it is exported to.

``python tests/python/golden.py`` (``make golden``) writes them anew; a person reads the difference before it
is committed.  They stand in ``fixtures/format_1_1``; those of format 1.0, whose closing joints have the fewest rows, stay beside
the bundles.  C# counts and drives both.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import kinefab

SETTINGS = kinefab.ExportOptions(colliders="hull", ground="world", smooth=None)
"""What the golden scenes are exported with."""
OLDER = replace(SETTINGS, closures=kinefab.Closures.MINIMAL)
"""What those of format 1.0 were exported with."""
FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"


NEWER = r', "(?:id|name|part|connectedPart|definition)": "(?:[^"\\]|\\.)*"'
"""What format 1.1 tells beyond 1.0 of a joint, behind its type, and of a part, at its end or before its components."""

AS_STATED = r'"asStated": ' + r"\{(?:[^{}]|" * 4 + r"\{[^{}]*\}" + r")*\}" * 4
"""What stands beside a component, or in a part that stands, for targets of other formats: braces in braces."""


def unnamed(text: str) -> str:
    """A scene's text as format 1.0 has it, which the golden scenes were written in."""
    text = re.sub(rf'("type": "\w+Joint")(?:{NEWER})+', r"\1", text)
    text = re.sub(r', "definition": "(?:[^"\\]|\\.)*"', "", text)
    text = re.sub(rf'(?:, )?{AS_STATED}|(?:, )?"chosen": "\w+"', "", text).replace(', "extras": {}', "").replace('"extras": {, ', '"extras": {')
    return text.replace('"version": "1.1"', '"version": "1.0"', 1)


def golden_pairs() -> list[tuple[Path, Path]]:
    """Every bundle that has a golden scene, and where that of format 1.0 is, beside it."""
    folders = ("mechanisms", "pairs", "lever", "hinge_slider_zup", "hinge_slider_yup")
    bundles = [bundle for folder in folders for bundle in sorted((FIXTURES / folder).glob("*.bundle.json"))]
    return [(bundle, bundle.with_name(bundle.name.replace(".bundle.json", ".kinefab"))) for bundle in bundles]


def today_of(scene: Path) -> Path:
    """The golden scene of today, by that of format 1.0."""
    return FIXTURES / "format_1_1" / scene.relative_to(FIXTURES)


def numbers_and_words(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Each leaf of a JSON value with its pointer."""
    if isinstance(value, dict):
        for key in sorted(value):
            yield from numbers_and_words(value[key], f"{path}/{key}")
    elif isinstance(value, list):
        yield f"{path}/length", len(value)
        for i, item in enumerate(value):
            yield from numbers_and_words(item, f"{path}/{i}")
    else:
        yield path, value


def differences(expected: Any, actual: Any, tolerance: float) -> list[str]:
    """Pointers of leaves that are missing, other words, or numbers further apart than the tolerance."""
    a, b = dict(numbers_and_words(expected)), dict(numbers_and_words(actual))
    found = [f"{path}: only on one side" for path in sorted(a.keys() ^ b.keys())]
    for path in sorted(a.keys() & b.keys()):
        x, y = a[path], b[path]
        numeric = all(isinstance(v, (int, float)) and not isinstance(v, bool) for v in (x, y))
        if (abs(x - y) > tolerance) if numeric else (x != y):
            found.append(f"{path}: {x!r} became {y!r}")
    return found


if __name__ == "__main__":
    for source, scene in golden_pairs():
        today = today_of(scene)
        today.parent.mkdir(parents=True, exist_ok=True)
        kinefab.export(source, today, SETTINGS)
        print(
            today.relative_to(FIXTURES.parent),
            len(json.loads(today.read_text("utf-8"))["gameObjects"]),
            file=sys.stderr,
        )
