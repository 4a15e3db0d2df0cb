"""Runs every test of both languages and counts them; the last line is ``N passed, N failed, N skipped``.

A toolchain that is missing counts as one skip with its reason.  With KINEFAB_REQUIRE_ALL=1 every skip is
a failure.  ``--without-mono`` leaves the tests under mono out, for systems that it is not meant for; tests of
what a system does not have are left out there by themselves.  Exit status 0 only when something passed and
nothing failed.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]

# Ten seconds do; a registry that does not answer is not waited for longer.
NPM_SECONDS = 180


@dataclass
class Counts:
    passed: int = 0
    failed: list[str] = field(default_factory=list)
    skipped: list[str] = field(default_factory=list)


def run_python(counts: Counts, scratch: Path) -> None:
    """pytest, read back from its JUnit file."""
    result = scratch / "pytest.xml"
    command = [sys.executable, "-m", "pytest", "-c", "python/pyproject.toml", "tests/python",
               f"--junitxml={result}", "-p", "no:cacheprovider"]
    status = subprocess.run(command, cwd=ROOT).returncode
    if not result.is_file():
        counts.failed.append(f"pytest ended with status {status} and left no result")
        return
    cases = ElementTree.parse(result).getroot().iter("testcase")
    before = len(counts.failed)
    for case in cases:
        name = f"{case.get('classname')}.{case.get('name')}"
        skip = case.find("skipped")
        if case.find("failure") is not None or case.find("error") is not None:
            counts.failed.append(name)
        elif skip is not None:
            counts.skipped.append(f"{name}: {skip.get('message')}")
        else:
            counts.passed += 1
    if status not in (0, 1) and len(counts.failed) == before:
        counts.failed.append(f"pytest ended with status {status}")


def write_physx_states() -> None:
    """States of random mechanisms in PhysX itself, for the C# test that is skipped without them: needs npm."""
    npm = shutil.which("npm")
    if npm is None:
        return
    reference = ROOT / "tests" / "reference"
    commands = [[npm, "run", "--silent", "fuzz"]]
    if not (reference / "node_modules").is_dir():
        commands.insert(0, [npm, "ci", "--silent", "--no-audit", "--no-fund", "--fetch-retries=0"])
    try:
        for command in commands:
            subprocess.run(command, cwd=reference, timeout=NPM_SECONDS, check=True)
    except (OSError, subprocess.SubprocessError) as error:
        print(f"no PhysX states: {error}", file=sys.stderr)


def run_csharp(counts: Counts, scratch: Path) -> None:
    """dotnet test, read back from its TRX file."""
    if shutil.which("dotnet") is None:
        counts.skipped.append("C# tests: no dotnet on the PATH")
        return
    command = ["dotnet", "test", "csharp/Kinefab.slnx", "-c", "Release", "--nologo", "-v", "quiet",
               "--logger", "trx", "--results-directory", str(scratch)]
    if "--without-mono" in sys.argv[1:]:
        command += ["--filter", "TestCategory!=Mono"]
    status = subprocess.run(command, cwd=ROOT).returncode
    results = sorted(scratch.glob("*.trx"))
    if not results:
        counts.failed.append(f"dotnet test ended with status {status} and left no result")
        return
    before = len(counts.failed)
    for result in results:
        for case in ElementTree.parse(result).getroot().iter():
            if not case.tag.endswith("}UnitTestResult"):
                continue
            name, outcome = case.get("testName", "?"), case.get("outcome")
            if outcome == "Passed":
                counts.passed += 1
            elif outcome == "NotExecuted":
                text = "".join(case.itertext()).strip()
                counts.skipped.append(f"{name}: {text.splitlines()[0] if text else 'no reason given'}")
            else:
                counts.failed.append(name)
    if status != 0 and len(counts.failed) == before:
        counts.failed.append(f"dotnet test ended with status {status}")


def main() -> int:
    counts = Counts()
    with tempfile.TemporaryDirectory() as scratch:
        run_python(counts, Path(scratch))
        write_physx_states()
        run_csharp(counts, Path(scratch))
    if os.environ.get("KINEFAB_REQUIRE_ALL") == "1":
        counts.failed += [f"skipped, and KINEFAB_REQUIRE_ALL=1: {reason}" for reason in counts.skipped]
        counts.skipped = []
    print()
    for reason in counts.skipped:
        print(f"skipped  {reason}")
    for name in counts.failed:
        print(f"FAILED   {name}")
    print(f"{counts.passed} passed, {len(counts.failed)} failed, {len(counts.skipped)} skipped", flush=True)
    return 0 if counts.passed and not counts.failed else 1


if __name__ == "__main__":
    sys.exit(main())
