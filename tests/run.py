"""Runs every test of both languages and counts them; the last line is ``N passed, N failed, N skipped``.

What is missing counts as one skip with its reason, however many tests want it.  With KINEFAB_REQUIRE_ALL=1 every skip is
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
from importlib.util import find_spec
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]

# Ten seconds do; a registry that does not answer is not waited for longer.
NPM_SECONDS = 180
# Each is a process with every library of every format in it.
MOST_WORKERS = 8


@dataclass
class Counts:
    passed: int = 0
    failed: list[str] = field(default_factory=list)
    skipped: list[str] = field(default_factory=list)


def side_by_side() -> list[str]:
    """What makes pytest run on every core, a test file on one: its fixtures are made once, its tests keep their order."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    if cores < 2 or find_spec("xdist") is None:
        return []
    return ["-n", str(min(cores, MOST_WORKERS)), "--dist", "loadfile"]


def run_python(counts: Counts, scratch: Path) -> None:
    """pytest, read back from its JUnit file."""
    result = scratch / "pytest.xml"
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-c",
        "python/pyproject.toml",
        "tests/python",
        f"--junitxml={result}",
        "-p",
        "no:cacheprovider",
        *side_by_side(),
    ]
    status = subprocess.run(command, cwd=ROOT).returncode
    if not result.is_file():
        counts.failed.append(f"pytest ended with status {status} and left no result")
        return
    before = len(counts.failed)
    count(counts, result)
    if status not in (0, 1) and len(counts.failed) == before:
        counts.failed.append(f"pytest ended with status {status}")


def count(counts: Counts, result: Path) -> None:
    """The outcomes in a JUnit file."""
    missing: dict[str, list[str]] = {}
    for case in ElementTree.parse(result).getroot().iter("testcase"):
        name = f"{case.get('classname')}.{case.get('name')}"
        skip = case.find("skipped")
        if case.find("failure") is not None or case.find("error") is not None:
            counts.failed.append(name)
        elif skip is not None:
            missing.setdefault(reason_of(skip), []).append(name)
        else:
            counts.passed += 1
    for reason, names in missing.items():
        counts.skipped.append(f"{reason}: {names[0]}" + (f" and {len(names) - 1} more" if names[1:] else ""))


def reason_of(skip: ElementTree.Element) -> str:
    """Why a test was left out; of a whole file pytest says it in the text alone: ``('PATH', LINE, 'Skipped: REASON')``."""
    message = str(skip.get("message"))
    if message != "collection skipped":
        return message
    _, _, told = (skip.text or "").partition("'Skipped: ")
    return told.rstrip().removesuffix(")").removesuffix("'") or message


def run_npm(what: str, *arguments: str) -> None:
    """A command of npm in ``tests/reference``; without npm, or where it fails, the tests that want it say what they miss."""
    npm = shutil.which("npm")
    if npm is None:
        return
    try:
        subprocess.run([npm, *arguments], cwd=ROOT / "tests" / "reference", timeout=NPM_SECONDS, check=True)
    except (OSError, subprocess.SubprocessError) as error:
        print(f"no {what}: {error}", file=sys.stderr)


def install_node_modules() -> None:
    """PhysX itself, and Khronos' validator of glTF."""
    if not (ROOT / "tests" / "reference" / "node_modules" / "physx-js-webidl").is_dir():
        run_npm("PhysX and glTF validator", "ci", "--silent", "--no-audit", "--no-fund", "--fetch-retries=0")


def has_sdk() -> bool:
    """Whether there is an SDK that builds for .NET 10; a runtime alone has a ``dotnet`` too."""
    if shutil.which("dotnet") is None:
        return False
    listed = subprocess.run(["dotnet", "--list-sdks"], capture_output=True, text=True).stdout
    return any(int(line.partition(".")[0]) >= 10 for line in listed.splitlines() if line[:1].isdigit())


def run_csharp(counts: Counts, scratch: Path) -> None:
    """dotnet test, read back from its TRX file."""
    if not has_sdk():
        counts.skipped.append("C# tests: no .NET 10 SDK on the PATH")
        return
    command = [
        "dotnet",
        "test",
        "csharp/Kinefab.slnx",
        "-c",
        "Release",
        "--nologo",
        "-v",
        "quiet",
        "--logger",
        "trx",
        "--results-directory",
        str(scratch),
    ]
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
        install_node_modules()
        run_python(counts, Path(scratch))
        if has_sdk():  # states of random mechanisms in PhysX, for the C# test that is skipped without them
            run_npm("PhysX states", "run", "--silent", "fuzz")
            run_npm("random articulations", "run", "--silent", "fuzz:articulations")
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
