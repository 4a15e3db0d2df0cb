"""``analyse`` and ``export`` take one road: what one tells is what the other writes."""

from __future__ import annotations

import json
from pathlib import Path

import kinefab
import pytest
from command_line import runner
from golden import FIXTURES, golden_pairs
from kinefab.cli import app

SOURCES = [*(bundle for bundle, _ in golden_pairs()), FIXTURES / "lever" / "lever_paper.csv"]


@pytest.mark.parametrize("source", SOURCES, ids=lambda path: path.name)
def test_analyse_tells_what_export_writes(source: Path, tmp_path: Path):
    """Mobility, redundancy, each island's numbers, each part's directions and the joints' constraints."""
    done = runner().invoke(app, ["analyse", str(source), "--json"])
    assert done.exit_code == 0
    told = json.loads(done.stdout)
    content = json.loads(kinefab.export(source, tmp_path / "out.kinefab").path.read_text("utf-8"))
    written = content["analysis"]
    for name in ("mobility", "firstOrderMobility", "redundant"):
        assert written.get(name, told["mobility"]) == told[name]
    counts = ("mobility", "redundant", "loops")
    assert [[island.get(n, 0) for n in counts] for island in written["islands"]] == [
        [island[n] for n in counts] for island in told["islands"]
    ]
    components = [
        c for o in content["gameObjects"] for c in o.get("components", []) if c["type"].endswith("Joint")
    ]
    reasons = [set(joint["because"]) for joint in told["joints"]]
    assert all(
        any(set(c.get("because", ())) <= own for own in reasons) for c in components if c["type"] != "FixedJoint"
    )
