"""The guides and the C# reference as pages: every link leads somewhere."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = ROOT / "out" / "docs"


def test_the_pages_are_made_without_a_broken_link():
    """docfx takes a link to nowhere for an error; the reference has what people call first, and pages can be searched."""
    if shutil.which("dotnet") is None or shutil.which("make") is None:
        pytest.skip("no .NET SDK: the pages are not made")
    restored = subprocess.run(["dotnet", "tool", "restore"], cwd=ROOT, capture_output=True, text=True)
    if restored.returncode != 0:
        pytest.skip("docfx is not to be had: the pages are not made")
    done = subprocess.run(["make", "docs"], cwd=ROOT, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-1000:]
    for name in ("Kinefab.Dynamics.World", "Kinefab.Kinematics.Mechanism", "Kinefab.NUnit.DrivesConstraint"):
        assert (PAGES / "reference" / f"{name}.html").is_file(), name
    assert (PAGES / "index.json").stat().st_size > 100_000
    page = (PAGES / "README.html").read_text(encoding="utf-8")
    local = {link.partition("#")[0] for link in re.findall(r'href="([^":]+)"', page)} - {""}
    assert len(local) > 10 and [link for link in sorted(local) if not (PAGES / link).exists()] == []
