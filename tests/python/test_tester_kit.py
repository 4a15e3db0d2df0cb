"""What one tester with an editor gets: the files that ``schemas/TESTER.md`` names, as it describes them."""

from __future__ import annotations

import re
import runpy
import shutil
import subprocess
import tarfile
from pathlib import Path

import pytest
from unity_yaml import documents

ROOT = Path(__file__).resolve().parents[2]
TESTER = ROOT / "tests" / "tester"


@pytest.fixture(scope="module")
def kit(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("kit") / "tester-kit"
    runpy.run_path(str(TESTER / "kit.py"))["make"](folder)
    return folder


def named(text: str, kind: str) -> dict[str, dict]:
    """Components of a class by the names of their objects."""
    found = {str(d.file_id): d for d in documents(text)}
    return {
        found[d.fields["m_GameObject"]["fileID"]].fields["m_Name"]: d.fields for d in found.values() if d.kind == kind
    }


def test_the_page_names_what_is_in_the_kit(kit):
    page = (ROOT / "schemas" / "TESTER.md").read_text("utf-8")
    assert re.findall(r"^\| (\d) \|", page, re.MULTILINE) == list("1234567")
    loose = {path.name for path in (kit / "Loose").iterdir()}
    assert {"Hinges.prefab", "Renamed.prefab", "HDRP.prefab", "TesterLog.cs"} <= loose
    assert "make tester-kit" in page and "tester-kit:" in (ROOT / "Makefile").read_text("utf-8")


def test_drives_ask_for_what_the_page_says(kit):
    with tarfile.open(kit / "Tester.unitypackage") as packed:
        assert any(member.isdir() for member in packed.getmembers())
        held = [packed.extractfile(m).read() for m in packed.getmembers() if m.name.endswith("/asset")]
    (prefab,) = (text.decode("ascii") for text in held if b"GameObject:" in text)
    links = named(prefab, "ArticulationBody")
    assert float(links["Turning link"]["m_XDrive"]["targetVelocity"]) == pytest.approx(90)
    # Against which it runs in editors of this version, by +0.1 m/s.
    assert float(links["Sliding link"]["m_XDrive"]["targetVelocity"]) == pytest.approx(-0.1)
    assert links["Sliding link"]["serializedVersion"] == "5"


def test_one_hinge_has_extended_limits_and_one_has_none(kit):
    hinges = named((kit / "Loose" / "Hinges.prefab").read_text("ascii"), "HingeJoint")
    assert {name: hinge["m_ExtendedLimits"] for name, hinge in hinges.items()} == {"Hinge plain": "0", "Hinge extended": "1"}
    assert all(hinge["m_Motor"]["targetVelocity"] in ("720", "-720") for hinge in hinges.values())
    assert "m_Name: Other\n" in (kit / "Loose" / "Renamed.prefab").read_text("ascii")


@pytest.mark.parametrize("newer", [False, True])
@pytest.mark.skipif(not shutil.which("mcs"), reason="the Mono compiler is not installed (apt-get install mono-mcs)")
def test_the_script_compiles(tmp_path, newer):
    """Against what it needs of Unity, in few lines."""
    define = ["-define:UNITY_6000_2_OR_NEWER"] if newer else []
    sources = [str(TESTER / "TesterLog.cs"), str(TESTER / "StandIns.cs")]
    done = subprocess.run(
        ["mcs", "-langversion:7", "-target:library", *define, f"-out:{tmp_path / 'log.dll'}", *sources], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr
