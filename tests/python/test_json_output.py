"""Whatever a command prints with ``--json`` is what its schema says, when all is well and when it is not."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import jsonschema
import kinefab
import pytest
import typer
from command_line import runner
from kinefab.cli import app
from kinefab.diagnostics import schema_directory
from scenes import lid_scene

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
LEVER = FIXTURES / "lever" / "lever.bundle.json"


def schema(name: str) -> jsonschema.Draft202012Validator:
    text = (schema_directory() / f"{name}.schema.json").read_text("utf-8")
    values = json.loads(text)
    jsonschema.Draft202012Validator.check_schema(values)
    return jsonschema.Draft202012Validator(values)


def printed(name: str, *arguments: object, status: int = 0) -> dict:
    """The one object on stdout, valid by the schema of that name."""
    done = runner().invoke(app, [*map(str, arguments), "--json"])
    assert done.exit_code == status, done.output
    values = json.loads(done.stdout)
    schema(name).validate(values)
    return values


@pytest.fixture(scope="module")
def scene(tmp_path_factory) -> Path:
    return kinefab.export(lid_scene(), tmp_path_factory.mktemp("scene") / "lid.kinefab").path


def broken(folder: Path, name: str) -> Path:
    (folder / name).write_text("{")
    return folder / name


def test_every_command_has_it():
    group = typer.main.get_command(app)

    def commands(command, name):
        below = getattr(command, "commands", {})
        return [found for word in below for found in commands(below[word], f"{name} {word}")] or [
            (name, command)
        ]

    found = commands(group, "kinefab")
    assert len(found) >= 13
    without = [name for name, command in found if "--json" not in {o for p in command.params for o in p.opts}]
    assert without == []


@pytest.mark.parametrize(
    "source",
    [
        LEVER,
        FIXTURES / "lever" / "lever.step",
        *sorted((FIXTURES / "mechanisms").glob("M[1-3]*.bundle.json")),
    ],
    ids=lambda p: p.name,
)
def test_analyse(source):
    if source.suffix == ".step":
        pytest.importorskip("OCP", reason="the Python package cadquery-ocp-novtk is not installed")
    values = printed("analysis", "analyse", source, "--limits")
    assert values["parts"] and values["redundant"] == values["rows"] - values["rank"]


def test_analyse_tells_what_else_the_source_can_give(tmp_path):
    """The keyframes of a model, by the option that poses it by one, as a table and as JSON."""
    pytest.importorskip("mujoco", reason="the Python package mujoco is not installed")
    model = tmp_path / "arm.xml"
    model.write_text(
        "<mujoco><worldbody><body name='arm'><joint name='j' range='-10 80'/><geom size='.1'/></body></worldbody>"
        "<keyframe><key name='home' qpos='.5'/><key name='rest' qpos='-.1'/></keyframe></mujoco>"
    )
    assert printed("analysis", "analyse", model)["offers"] == {"keyframe": ["home", "rest"]}
    assert (
        "the source also has: --keyframe home, rest"
        in runner().invoke(app, ["analyse", str(model)]).stdout.splitlines()
    )
    assert printed("analysis", "analyse", LEVER)["offers"] == {}


def test_inspect(scene):
    assert [joint["name"] for joint in printed("inspection", "inspect", scene)["joints"]] == ["Hinge"]


def test_mates(tmp_path):
    pytest.importorskip("OCP", reason="the Python package cadquery-ocp-novtk is not installed")
    target = tmp_path / "lever.mates.json"
    values = printed("mates", "mates", FIXTURES / "lever" / "lever.step", "-o", target)
    assert values["constraints"] and values == json.loads(target.read_text("utf-8"))


def test_export(tmp_path):
    values = printed("export_report", "export", LEVER, "-o", tmp_path / "a.kinefab")
    assert values["written"] is True and len(values["outcomes"]) >= 4
    values = printed(
        "export_report", "export", broken(tmp_path, "x.bundle.json"), "-o", tmp_path / "b.kinefab", status=1
    )
    assert values["written"] is False and values["errors"] >= 1


@pytest.mark.parametrize(
    "command, ending", [("draw", ".svg"), ("draw", ".png"), ("view", ".html"), ("report", ".html")]
)
def test_what_writes_says_that_it_did(scene, tmp_path, command, ending):
    if ending == ".png":
        pytest.importorskip("PIL", reason="the Python package pillow is not installed")
    target = tmp_path / f"a{ending}"
    values = printed("findings", command, scene, "-o", target)
    assert values["written"] is True and values["file"] == str(target) and target.is_file()


@pytest.mark.parametrize(
    "arguments",
    [
        ("analyse", "IN"),
        ("inspect", "SCENE"),
        ("mates", "IN", "-o", "OUT.mates.json"),
        ("draw", "IN", "-o", "OUT.svg"),
        ("view", "IN", "-o", "OUT.html"),
        ("report", "IN", "-o", "OUT.html"),
        ("bundle", "check", "IN"),
        ("bundle", "init", "FOLDER", "--units", "mm"),
        ("capture", "--replay", "IN", "-o", "OUT.bundle.json"),
    ],
    ids=lambda a: " ".join(a[:2]),
)
def test_what_fails_says_why(tmp_path, arguments):
    (tmp_path / "empty").mkdir()
    words = {"IN": str(broken(tmp_path, "x.bundle.json")), "FOLDER": str(tmp_path / "empty")}
    words["SCENE"] = str(broken(tmp_path, "x.kinefab"))
    given = [words.get(a, a.replace("OUT", str(tmp_path / "out"))) for a in arguments]
    values = printed("findings", *given, status=1)
    assert values["errors"] == len([d for d in values["diagnostics"] if d["severity"] == "error"]) >= 1


def test_bundle(tmp_path):
    none = printed("findings", "bundle", "init", tmp_path, "--units", "mm", status=1)
    assert [d["code"] for d in none["diagnostics"]] == ["BEGINNING_IMPOSSIBLE"]
    shutil.copy(FIXTURES / "lever" / "lever.obj", tmp_path / "lever.obj")
    values = printed(
        "findings", "bundle", "init", tmp_path, "--units", "mm", "-o", tmp_path / "a.bundle.json"
    )
    assert values["written"] is True
    assert printed("findings", "bundle", "check", LEVER)["errors"] == 0


def test_capture(tmp_path):
    assert printed("findings", "capture", "fusion", "--install", tmp_path)["written"] is True


def test_batch_prints_and_keeps_a_record_a_line(tmp_path):
    (tmp_path / "in").mkdir()
    shutil.copy(FIXTURES / "pairs" / "P01.bundle.json", tmp_path / "in" / "a.bundle.json")
    broken(tmp_path / "in", "torn.bundle.json")
    out = tmp_path / "out"
    done = runner().invoke(app, ["batch", str(tmp_path / "in"), "-o", str(out), "--json"])
    lines = [json.loads(line) for line in done.stdout.splitlines()]
    for line in lines:
        schema("batch_record").validate(line)
    assert {line["outcome"] for line in lines} == {"written", "refused"} and done.exit_code == 1
    kept = [json.loads(line) for line in (out / "batch.jsonl").read_text("utf-8").splitlines()]
    assert kept == lines


def test_a_batch_that_cannot_begin_says_why(tmp_path):
    (tmp_path / "out").write_text("a file of somebody's")
    assert printed("findings", "batch", LEVER, "-o", tmp_path / "out", status=1)["written"] is False


def test_a_name_that_is_no_utf8_is_still_json(tmp_path):
    source = Path(str(tmp_path)) / "caf\udce9.bundle.json"
    try:
        source.write_text("{")
    except (OSError, UnicodeError):
        pytest.skip("the file system takes no such name")
    assert printed("findings", "analyse", source, status=1)["file"].endswith("caf\udce9.bundle.json")
