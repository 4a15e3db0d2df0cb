"""Every finding that the exporter can make has a test or a conformance case that names it."""

from __future__ import annotations

import re
from itertools import groupby
from pathlib import Path

from kinefab.diagnostics import diagnostic_table

ROOT = Path(__file__).parents[2]


def words(folder: Path, *endings: str) -> set[str]:
    """Everything in capitals in the files of a folder, this file left out."""
    files = [p for p in folder.rglob("*") if p.is_file() and p.suffix in endings and p != Path(__file__)]
    text = "\n".join(path.read_text("utf-8", errors="replace") for path in files)
    return set(re.findall(r"\b[A-Z][A-Z0-9_]+\b", text))


def test_every_code_that_python_raises_is_named_in_a_test():
    """A code that no test names may be reported wrongly, or never."""
    raised = diagnostic_table().keys() & words(ROOT / "python" / "src", ".py")
    tested = words(ROOT / "tests" / "python", ".py") | words(ROOT / "tests" / "conformance", ".json")
    assert sorted(raised - tested) == []


def test_the_table_is_grouped_by_stage():
    """Each stage's codes stand together, as the table says of itself."""
    stages = [stage for stage, _ in groupby(entry["stage"] for entry in diagnostic_table().values())]
    assert len(stages) == len(set(stages))
