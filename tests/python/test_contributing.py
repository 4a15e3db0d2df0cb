"""What ``CONTRIBUTING.md`` promises: an addition that is made by half fails here, and its lists name files that exist."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from kinefab.analysis.equations.constraints import _BUILDERS
from kinefab.diagnostics import schema_directory
from kinefab.model import ConstraintKind, CouplingKind, FeatureKind, Sense, Side
from kinefab.sources import FORMATS, format_of

ROOT = Path(__file__).resolve().parents[2]


def definitions(name: str) -> dict:
    return json.loads((schema_directory() / name).read_text(encoding="utf-8"))["$defs"]


def test_the_lever_is_there_in_every_source_format():
    """Each reader has one mechanism in common with the others, so that it can be held against them."""
    found = (format_of(path) for path in (ROOT / "fixtures" / "lever").rglob("*"))
    assert {entry.name for entry in found if entry} == {entry.name for entry in FORMATS}


@pytest.mark.parametrize(
    "definition, field, words",
    [
        ("constraint", "kind", ConstraintKind),
        ("constraint", "sense", Sense),
        ("constraint", "side", Side),
        ("feature", "kind", FeatureKind),
        ("coupling", "kind", CouplingKind),
    ],
)
def test_words_of_the_model_are_those_of_the_scene(definition, field, words):
    """What the model can say the file can hold, and nothing else; C# holds its own words to the same schema."""
    rule = definitions("scene.schema.json")[definition]["properties"][field]
    assert sorted(rule["enum"]) == sorted(word.value for word in words)


def test_words_of_the_model_are_those_of_the_bundle():
    """Whoever writes an export macro reads there which kinds there are."""
    told = definitions("bundle.schema.json")["constraint"]["properties"]["kind"]["description"]
    kinds = re.match(r"One of ([a-z_, ]+);", told).group(1).split(", ")
    assert sorted(kinds) == sorted(kind.value for kind in ConstraintKind)


def test_every_constraint_kind_has_equations():
    """Ground is no equation and other is never interpreted; each other kind makes rows."""
    assert _BUILDERS.keys() == set(ConstraintKind) - {ConstraintKind.GROUND, ConstraintKind.OTHER}


def test_contributing_names_what_exists():
    """Paths and tests of the lists are those of the repository; what is to be made has a word in capitals."""
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    paths = [
        path for path in re.findall(r"`([\w.]+(?:/[\w.]+)+/?)`", text) if not re.search("[A-Z]{4}", path)
    ]
    assert [path for path in paths if not (ROOT / path).exists()] == []
    files = [path for ending in ("py", "cs") for path in (ROOT / "tests").rglob(f"*.{ending}")]
    known = set(re.findall(r"\w+", "\n".join(path.read_text(encoding="utf-8") for path in files)))
    tests = set(re.findall(r"`(test_\w+|[A-Z]\w+_\w+|\w+Tests)`", text))
    assert tests - known == set() and len(tests) > 10 and len(paths) > 20


def test_decisions_stand_by_subject_in_the_order_of_their_dates():
    """A decision is one entry, dated, below its subject; a later one on the same matter takes its place."""
    text = (ROOT / "DECISIONS.md").read_text(encoding="utf-8")
    _, *subjects = re.split(r"^## .+$", text, flags=re.MULTILINE)
    entries = [re.findall(r"^### (\d{4}-\d\d-\d\d) (.+)$", subject, re.MULTILINE) for subject in subjects]
    assert [len(found) for found in entries] == [subject.count("\n#") for subject in subjects]
    assert all(found == sorted(found, key=lambda entry: entry[0]) for found in entries)
    titles = [title for found in entries for _, title in found]
    assert len(set(titles)) == len(titles) > 50
