"""The Python in the READMEs runs as it stands, and their picture and figures are those of the code and of the results."""

from __future__ import annotations

import importlib.util
import re
import subprocess
import sys
from pathlib import Path

import pytest
from scenes import read

ROOT = Path(__file__).parents[2]
BLOCK = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)
PAGES = [ROOT / "README.md", ROOT / "python" / "README.md", *sorted((ROOT / "guides").glob("*.md"))]
"""What a user reads; schemas and results are referred to."""
READMES = [path for path in PAGES if BLOCK.search(path.read_text("utf-8"))]


@pytest.mark.parametrize("readme", READMES, ids=lambda path: path.parent.name)
def test_readme_code_runs(readme, tmp_path):
    """The blocks of one README, one after the other, run without an error and write what they say."""
    (tmp_path / "fixtures").symlink_to(ROOT / "fixtures")
    code = "\n".join(BLOCK.findall(readme.read_text(encoding="utf-8")))
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stderr
    written = list(tmp_path.glob("*.kinefab"))
    wanted = set(re.findall(r'"(\w+\.kinefab)"', code))
    assert wanted and {path.name for path in written} == wanted
    assert all(read(path)["gameObjects"] for path in written)


def test_python_readme_has_code():
    """The check above does not pass for want of anything to check."""
    assert ROOT / "python" / "README.md" in READMES


EXTRA = re.compile(r"""pip install +(?:-e +)?((?:\\?["'])?)(?:\./python|kinefab)\[""")


def test_extras_are_asked_for_in_words_that_every_shell_takes():
    """Brackets alone are a pattern to zsh, macOS' own, which finds no file; apostrophes are letters to Windows' cmd."""
    told = [*PAGES, ROOT / "schemas" / "diagnostics.json"]
    told += (ROOT / "python" / "src").rglob("*.py")
    marks = {path: EXTRA.findall(path.read_text(encoding="utf-8")) for path in told}
    wrong = {path.name: found for path, found in marks.items() if set(found) - {'"', '\\"'}}
    assert wrong == {} and sum(map(len, marks.values())) > 2


@pytest.mark.parametrize("half", ["python", "csharp"])
def test_the_house_is_drawn_as_it_stands(half):
    """``python HALF/draw_house.py`` would write the picture that is there."""
    spec = importlib.util.spec_from_file_location("draw_house", ROOT / half / "draw_house.py")
    drawing = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(drawing)
    assert drawing.picture() == drawing.PICTURE.read_text(encoding="utf-8")


# Of each row of the README's table what stands in its cell of times, by the benchmark's section and name.
TOLD = {
    "Kinefab `unity`": ["Kinefab, unity"],
    "Kinefab `exact`": [f"Kinefab, exact, {width} lanes" for width in (1, 4, 8)],
    "BepuPhysics 2": ["Bepu, 8 iterations, 30 Hz", "Bepu, 8 substeps, 120 Hz"],
    "Jitter2": ["Jitter2, default", "ODE, WorldStep"],
    "Box3D": ["Box3D, 4 substeps (default)", "Box3D, 32 substeps, 480 Hz"],
    "driven arm": [
        "articulation, driven",
        "joints in unity, driven",
        "joints in Bepu, 8 iterations, 30 Hz, held by motors",
        "joints in Jitter2, default, held by motors",
    ],
}
FOURBARS = re.compile(r"^\| ([^|]+) \| (\d+) \|", re.MULTILINE)
ARMS = re.compile(r"^\| 7 links \| ([^|]+) \| [\d.]+ \| (\d+) \|", re.MULTILINE)


def test_solver_figures_are_those_of_the_results():
    """What the README tells of the solvers' speed is what the benchmarks wrote last."""
    results = (ROOT / "csharp" / "bench" / "RESULTS.md").read_text("utf-8")
    peers = results.partition("| fourbar100 | ns/joint-step |")[2].partition("\n\n")[0]
    measured = dict(FOURBARS.findall(peers)) | dict(ARMS.findall(results))
    for row, names in TOLD.items():
        (line,) = [line for line in (ROOT / "README.md").read_text("utf-8").splitlines() if line.startswith(f"| {row}")]
        assert re.findall(r"\d+", line.split("|")[2]) == [measured[name] for name in names], row


def test_the_page_of_mates_says_first_that_they_are_to_be_looked_over():
    """What an independent set gave stands above our own machines, and how to look before either."""
    page = (ROOT / "guides" / "mates.md").read_text("utf-8")
    words = ("Look them over", "kinefab view", "| 14 | 0.73 | 0.79 | 7 of 14 |", "| 68 |")
    assert (told := [page.index(word) for word in words]) == sorted(told)
    (line,) = [line for line in README.splitlines() if "guides/mates.md" in line]
    assert "`kinefab view robot.step --mates auto`" in line and "looked over" in line


README = (ROOT / "README.md").read_text("utf-8")
SCREEN = "\n".join(README.splitlines()[:30])
READERS = ("Unity developer", "CAD engineer", "roboticist", "script writer", "CI maintainer")


def test_the_first_screen_says_what_it_is_for_whom_and_what_to_type(tmp_path):
    """A picture, three commands of which the two of ours run as they stand, and for whom it is not."""
    assert re.search(r"^!\[.+\]\(fixtures/lever/lever\.gif\)$", SCREEN, re.MULTILINE)
    assert "**Is it for me?** Yes, if" in SCREEN and "No, if" in SCREEN
    commands = SCREEN.partition("```sh\n")[2].partition("```")[0].splitlines()
    assert len(commands) == 3 and commands[0].startswith("pip install ./python ")
    (tmp_path / "fixtures").symlink_to(ROOT / "fixtures")
    for command in commands[1:]:
        program, *words = command.partition("#")[0].replace("--open", "").split()
        assert program == "kinefab"
        done = subprocess.run([sys.executable, "-m", "kinefab", *words], cwd=tmp_path, capture_output=True)
        assert done.returncode == 0, done.stderr
    written = {path.suffix for path in tmp_path.iterdir()}
    assert written >= {".unitypackage", ".html"}


def test_a_program_is_used_after_it_is_said_how_to_get_it():
    """Of the second program the quick way and the lasting one, where it is first named; of the packages the way before a release."""
    paragraph = next(part for part in README.split("\n\n") if "dotnet kinefab" in part)
    for words in ("`make tool`", "bin/Release/net10.0:$PATH", "command-line.md#install"):
        assert words in paragraph
    page = (ROOT / "guides" / "ci.md").read_text("utf-8")
    assert "using Kinefab.NUnit;\n" in page and "using static Kinefab.NUnit.MechanismConstraints;\n" in page
    box = page.partition("## Until it is released\n")[2]
    for words in ("dotnet pack", "packageSources", "dotnet tool install Kinefab.Cli", "-p:Version="):
        assert words in box
    tool = (ROOT / "csharp" / "src" / "Kinefab.Cli" / "README.md").read_text("utf-8")
    assert "--add-source out/pkg" in tool and "-p:Version=" in tool


def test_each_reader_has_ten_lines_and_a_link():
    """What is longer stands on the page that is linked; headings, blank lines and fences are not counted."""
    for reader in READERS:
        title = reader[0].upper() + reader[1:]
        assert f"[{reader}](#{reader.lower().replace(' ', '-')})" in README
        section = README.partition(f"\n## {title}\n")[2].partition("\n## ")[0]
        lines = [line for line in section.splitlines() if line and not line.startswith("```")]
        assert 3 <= len(lines) <= 10, reader
        assert re.search(r"\]\((guides|python|schemas)/", section), reader


@pytest.mark.parametrize("page", PAGES, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_words_are_those_that_people_say(page):
    """What a newcomer does not know is said in the README's first words, or is not said."""
    text = page.read_text("utf-8")
    assert not re.search(r"\b(and|are|is|each|text|reasons?) told\b|\btold by name\b|closing row", text)
    if page.parent == ROOT:
        head = text.partition("\n## ")[0]
        assert all(f"**{word}**" in head for word in ("kept", "approximated", "dropped", "feature", "mate", "scene"))
        assert "**CAD bundle** is" in " ".join(head.split())
