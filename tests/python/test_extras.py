"""What is missing is asked for by the names of its libraries, which pip finds wherever Kinefab itself came from."""

from __future__ import annotations

import re
from pathlib import Path

from kinefab.diagnostics import diagnostic_table
from kinefab.extras import LIBRARIES, install
from kinefab.sources import FORMATS
from kinefab.targets import TARGETS

ROOT = Path(__file__).parents[2]


def test_each_extra_of_the_package_has_its_libraries():
    """All but those that gather others, and those of the tests."""
    settings = (ROOT / "python" / "pyproject.toml").read_text("utf-8")
    table = settings.partition("[project.optional-dependencies]\n")[2].partition("\n[")[0]
    stated = dict(re.findall(r"^([a-z0-9]+) = \[(.*)\]$", table, re.MULTILINE))
    del stated["all"]
    assert {name: tuple(re.findall(r'"([a-z0-9-]+)', text)) for name, text in stated.items()} == LIBRARIES


def test_every_format_names_an_extra_that_there_is():
    wanted = {entry.extra for entry in (*FORMATS, *TARGETS) if entry.requires}
    assert wanted <= LIBRARIES.keys() and "cad" in wanted
    assert install("cad") == "pip install cadquery-ocp-novtk"


def test_nobody_is_sent_to_an_index_for_a_package_that_is_not_there():
    """``pip install "kinefab[cad]"`` finds nothing before a release, and in a clone installs another one."""
    told = [*(ROOT / "python" / "src").rglob("*.py"), *(ROOT / "guides").glob("*.md")]
    told += [ROOT / "README.md", ROOT / "python" / "README.md", ROOT / "schemas" / "diagnostics.json"]
    assert [path.name for path in told if "kinefab[" in path.read_text("utf-8")] == []


def test_remedies_of_the_table_name_the_same_libraries():
    known = {library for libraries in LIBRARIES.values() for library in libraries} | {"manifold3d"}
    remedies = " ".join(entry["remedy"] for entry in diagnostic_table().values())
    named = set(re.findall(r"pip install ([a-z0-9-]+)", remedies))
    assert named <= known and {"pywin32", "coal"} <= named
