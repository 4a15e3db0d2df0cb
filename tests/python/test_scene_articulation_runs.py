"""Every fixture that an articulation can be made of: exported as links it validates, counts as the source does and runs in both solvers."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import kinefab
import pytest

TOOL = shutil.which("dotnet-kinefab")
FIXTURES = Path(__file__).parents[2] / "fixtures"
SOURCES = sorted(
    path
    for pattern in ("mechanisms/*.bundle.json", "lever/lever.bundle.json", "lever/*.urdf", "lever/*.sdf", "twins/*.urdf", "twins/*.sdf")
    for path in FIXTURES.glob(pattern)
)
IMPOSSIBLE = {"M22", "M29", "M32", "M47"}
"""Mechanisms whose tree needs a joint that an ArticulationBody has not: cylindrical, universal."""
TOLD = {"LINK_NOT_EXACT", "TARGET_FIELD_DROPPED"}
"""What is known of them: PhysX's friction of a joint, and speeds that it cuts, are no part of the exact motion."""

SINGULAR = {"M45"}
"""All legs stretched: what can hardly move takes up 0.04 J and gives it back."""

pytestmark = pytest.mark.skipif(TOOL is None, reason="dotnet-kinefab is not on the PATH")


def name_of(source: Path) -> str:
    return f"{source.parent.name}-{source.name}".removeprefix("mechanisms-").removesuffix(".bundle.json").replace(".", "-")


@pytest.fixture(scope="module")
def scenes(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Those that can be made, by their names."""
    folder = tmp_path_factory.mktemp("articulations")
    made: dict[str, Path] = {}
    for source in SOURCES:
        name = name_of(source)
        try:
            options = kinefab.ExportOptions(writing={"physics": "articulation"})
            kinefab.export(source, folder / f"{name}.kinefab", options)
            made[name] = folder / f"{name}.kinefab"
        except kinefab.KinefabError as error:
            assert {d.code for d in error.report.diagnostics if d.severity.value == "error"} == {"ARTICULATION_IMPOSSIBLE"}, name
    return made


def told(command: str, scenes: dict[str, Path], *options: str) -> dict[str, Any]:
    """What the tool says of each of them in one run."""
    run = subprocess.run(
        ["dotnet-kinefab", command, *map(str, scenes.values()), *options, "--json"],
        capture_output=True,
        text=True,
        check=False,
    )
    found = {Path(entry["file"]).stem: entry for entry in json.loads(run.stdout)}
    assert set(found) == set(scenes)
    return found


def test_all_but_those_with_other_joints_are_made(scenes: dict[str, Path]):
    assert {name_of(source) for source in SOURCES} - set(scenes) == IMPOSSIBLE
    whole = {name for name, path in scenes.items() if '"ArticulationBody"' not in path.read_text(encoding="utf-8")}
    assert whole <= {"M16", "M34"}, "of these nothing moves"


@pytest.mark.parametrize("command", ["validate", "mobility"])
def test_they_are_valid_and_count_as_their_sources(scenes: dict[str, Path], command: str):
    for name, entry in told(command, scenes).items():
        assert {d["code"] for d in entry["diagnostics"]} <= TOLD, name
        assert entry["valid"], name


@pytest.mark.parametrize("solver", ["unity", "exact"])
def test_they_run(scenes: dict[str, Path], solver: str):
    for name, entry in told("simulate", scenes, "--seconds", "2", "--solver", solver).items():
        assert {d["code"] for d in entry["diagnostics"]} <= TOLD, name
        run = entry["simulation"]
        assert run["stops"] == 0, name
        # PhysX turns a fast chain on by the speeds at its start, which makes energy; the exact motion has none to make.
        if solver == "exact" and name not in SINGULAR:
            assert run["endEnergy"] <= run["startEnergy"] + 1e-3 * max(1.0, abs(run["startEnergy"])), name
