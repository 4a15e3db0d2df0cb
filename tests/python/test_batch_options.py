"""``batch`` takes what ``export`` takes, and makes of each file what ``export`` makes of it."""

from __future__ import annotations

import shutil
from pathlib import Path

import typer
from command_line import runner
from kinefab.cli import app

LEVER = Path(__file__).resolve().parents[2] / "fixtures" / "lever"
OF_ONE_FILE = {"--output", "--report", "--json"}
"""What ``export`` asks that has another meaning, or none, for many files."""


def options(name: str) -> dict[str, tuple[object, ...]]:
    command = typer.main.get_command(app).commands[name]
    return {
        p.opts[0]: (p.help, str(p.default), p.multiple, p.is_flag)
        for p in command.params
        if p.opts[0][0] == "-"
    }


def test_every_option_of_an_export_is_one_of_a_batch():
    one, many = options("export"), options("batch")
    shared = one.keys() - OF_ONE_FILE
    assert {"--ground", "--closures", "--smooth", "--solve", "--limits", "--unity", "--mates"} <= shared
    assert {name: one[name] for name in shared} == {name: many.get(name) for name in shared}


def test_the_same_options_write_the_same_bytes(tmp_path):
    for name in ("lever.bundle.json", "lever.obj", "lever.mtl"):
        shutil.copy(LEVER / name, tmp_path / name)
    source, given = (
        tmp_path / "lever.bundle.json",
        "--closures minimal --ground world --smooth 0 --colliders box",
    )
    cli, words = runner(), [*given.split(), "--density", "2700", "--limits", "--solve"]
    one = cli.invoke(app, ["export", str(source), "-o", str(tmp_path / "lever.kinefab"), *words])
    many = cli.invoke(app, ["batch", str(source), "-o", str(tmp_path / "many"), *words])
    plain = cli.invoke(app, ["batch", str(source), "-o", str(tmp_path / "plain")])
    assert (one.exit_code, many.exit_code, plain.exit_code) == (0, 0, 0), one.output + many.output
    written = (tmp_path / "lever.kinefab").read_bytes()
    assert (tmp_path / "many" / "lever.kinefab").read_bytes() == written
    assert (tmp_path / "plain" / "lever.kinefab").read_bytes() != written


def test_an_option_out_of_range_is_wrong_usage_and_nothing_is_made(tmp_path):
    done = runner().invoke(app, ["batch", str(LEVER), "-o", str(tmp_path / "out"), "--smooth", "200"])
    assert done.exit_code == 2 and "--smooth" in done.stderr and not (tmp_path / "out").exists()
