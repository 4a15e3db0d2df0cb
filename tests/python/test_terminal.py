"""What a terminal gets and a pipe does not: colours, a bar, completion."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import kinefab
import pytest
from command_line import LEVER, run
from scenes import lid_scene

COLOUR = re.compile(r"\x1b\[[0-9;]*3[0-9][0-9;]*m")
BAR = re.compile("\x1b\\[\\?25l|[\u2501\u2578\u257a]")
"""The cursor is hidden, or a bar is drawn."""


def on_terminal(*arguments: object, **environment: str) -> str:
    """Everything that a terminal shows."""
    pty = pytest.importorskip("pty", reason="there are no pseudo terminals here")
    ours, theirs = pty.openpty()
    own = {k: v for k, v in os.environ.items() if k not in ("NO_COLOR", "FORCE_COLOR")}
    process = subprocess.Popen(
        [sys.executable, "-m", "kinefab", *map(str, arguments)],
        stdin=theirs,
        stdout=theirs,
        stderr=theirs,
        env={**own, "TERM": "xterm", **environment},
    )
    os.close(theirs)
    shown = b""
    while True:
        try:
            chunk = os.read(ours, 65536)
        except OSError:  # the other end is closed
            break
        if not chunk:
            break
        shown += chunk
    os.close(ours)
    assert process.wait(timeout=60) is not None
    return shown.decode("utf-8")


@pytest.fixture
def broken(tmp_path) -> Path:
    (tmp_path / "x.kinefab").write_text("{")
    return tmp_path / "x.kinefab"


def test_findings_are_coloured_on_a_terminal_and_nowhere_else(broken):
    assert COLOUR.search(on_terminal("inspect", broken))
    assert "\x1b" not in run("inspect", broken, NO_COLOR="", FORCE_COLOR="").stderr


def test_no_color_is_kept_to_also_on_a_terminal(broken):
    assert not COLOUR.search(on_terminal("inspect", broken, NO_COLOR="1"))
    if int(version("rich").split(".")[0]) >= 14:  # older ones heed an empty one too
        assert COLOUR.search(on_terminal("inspect", broken, NO_COLOR="")), "an empty one says nothing"


def test_force_color_colours_a_pipe(broken):
    assert COLOUR.search(run("inspect", broken, FORCE_COLOR="1").stderr)
    assert not COLOUR.search(run("inspect", broken, FORCE_COLOR="1", NO_COLOR="1").stderr)


@pytest.mark.parametrize("command", ["export", "batch"])
def test_a_bar_is_shown_on_a_terminal_and_never_in_a_pipe(tmp_path, command):
    target = tmp_path / ("lever.kinefab" if command == "export" else "out")
    assert BAR.search(on_terminal(command, LEVER, "-o", target))
    again = tmp_path / "again" if command == "batch" else target
    done = run(command, LEVER, "-o", again, FORCE_COLOR="1")
    assert done.returncode == 0 and not BAR.search(done.stdout + done.stderr)
    assert not BAR.search(on_terminal("--quiet", command, LEVER, "-o", again))


def test_a_moving_picture_shows_how_far_it_is(tmp_path):
    """It takes seconds, in which nothing was shown."""
    shown = on_terminal("draw", LEVER, "--motion", "-o", tmp_path / "lever.svg")
    assert BAR.search(shown) and "drawing" in shown
    done = run("draw", LEVER, "--motion", "-o", tmp_path / "piped.svg", FORCE_COLOR="1")
    assert done.returncode == 0 and not BAR.search(done.stdout + done.stderr)
    assert (tmp_path / "piped.svg").read_bytes() == (tmp_path / "lever.svg").read_bytes()


def test_letters_that_a_terminal_has_not_are_escaped(tmp_path):
    scene = lid_scene()
    path = kinefab.export(scene, tmp_path / "a.kinefab").path
    path.write_text(path.read_text("utf-8").replace("Lid", "\u039b-lid"), "utf-8")
    narrow = {"PYTHONIOENCODING": "cp1252", "PYTHONUTF8": "0"}
    assert "\\u039b-lid" in run("inspect", path, **narrow).stdout
    values = json.loads(run("inspect", path, "--json", **narrow).stdout)
    assert "\u039b-lid" in [entry["name"] for entry in values["objects"]]


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion_can_be_shown(shell):
    done = run("--show-completion", shell, _TYPER_COMPLETE_TEST_DISABLE_SHELL_DETECTION="1")
    assert done.returncode == 0 and "_COMPLETE" in done.stdout and "kinefab" in done.stdout


def completed(words: str) -> list[str]:
    """What bash is offered for the last word."""
    done = subprocess.run(
        [sys.executable, "-c", "import sys; sys.argv[0] = 'kinefab'; from kinefab.cli import main; main()"],
        capture_output=True,
        text=True,
        timeout=60,
        env={
            **os.environ,
            "COMP_WORDS": words,
            "COMP_CWORD": str(len(words.split(" ")) - 1),
            "_KINEFAB_COMPLETE": "complete_bash",
        },
    )
    return done.stdout.split()


def test_commands_options_and_their_words_are_completed():
    assert completed("kinefab ex") == ["export"]
    assert completed("kinefab batch --clos") == ["--closures"]
    assert completed("kinefab batch --closures ") == ["exact", "minimal"]
    assert completed("kinefab export --physics art") == ["articulation"]


def test_completion_is_installed_for_the_shell(tmp_path):
    """Into the user's own files; here those of an empty home."""
    done = run(
        "--install-completion",
        "bash",
        HOME=str(tmp_path),
        _TYPER_COMPLETE_TEST_DISABLE_SHELL_DETECTION="1",
    )
    written = [path for path in tmp_path.rglob("*") if path.is_file()]
    assert done.returncode == 0 and written, done.stderr
    assert any("_COMPLETE" in path.read_text("utf-8") for path in written)
