"""The command line: exit codes, streams, options, start-up time's cause."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
from pathlib import Path

import kinefab
import pytest
from command_line import LEVER, checked_report, lid, run  # noqa: F401 (a fixture)
from scenes import BOX, lid_scene, read

HEAVY = ("trimesh", "scipy", "numpy", "jsonschema")


def test_version_goes_to_stdout():
    """--version prints the package's version and exits 0."""
    done = run("--version")
    assert (done.returncode, done.stdout.strip()) == (0, f"kinefab {kinefab.__version__}")


@pytest.mark.parametrize("arguments", [["--help"], ["export", "--help"], ["inspect", "--help"]])
def test_help_imports_nothing_heavy(arguments):
    """Help answers without numpy, trimesh and the like: that is what keeps it quick."""
    code = (
        "import sys\nfrom kinefab.cli import app\n"
        f"try: app({arguments!r})\nexcept SystemExit as end: assert not end.code\n"
        f"print([m for m in {HEAVY!r} if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.stdout.strip().endswith("[]"), done.stdout + done.stderr


@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="threads are counted as Linux lists them")
def test_a_call_starts_no_threads_of_blas_and_does_not_search_its_imports_for_cycles():
    """Both would be paid for by every call, however small."""
    code = (
        "import gc, os, sys\nfrom kinefab.cli import main\n"
        f"sys.argv = ['kinefab', 'analyse', {str(LEVER)!r}]\n"
        "try: main()\nexcept SystemExit as end: assert not end.code\n"
        "print(len(os.listdir('/proc/self/task')), gc.get_stats()[2]['collections'], file=sys.stderr)"
    )
    environment = {name: value for name, value in os.environ.items() if name != "OPENBLAS_NUM_THREADS"}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment)
    assert done.stderr.split()[-2:] == ["1", "0"], done.stderr


@pytest.mark.parametrize("arguments", [["nonsense"], ["export"], ["export", "a.json"], ["export", "a", "-o", "b.kinefab", "--colliders", "egg"],
                                       ["export", "a", "-o", "b.kinefab", "--density", "-3"], ["inspect"]])  # fmt: skip
def test_wrong_usage_exits_2(arguments):
    """What the user mistyped is told on stderr, and nothing on stdout."""
    done = run(*arguments)
    assert done.returncode == 2 and done.stderr and not done.stdout


@pytest.mark.parametrize(
    "command, name", [("export", "x.json"), ("export", "x"), ("export", "x.kinefab.bin"), ("draw", "x.bmp")]
)
def test_output_of_another_ending_is_wrong_usage(lid, tmp_path, command, name):
    """What no program would find by its name is not written: usage error, with the ending that is wanted."""
    done = run(command, LEVER if command == "export" else lid, "-o", tmp_path / name, TERMINAL_WIDTH="200")
    assert done.returncode == 2 and not (tmp_path / name).exists()
    assert {"export": ".kinefab", "draw": ".svg"}[command] in done.stderr


@pytest.mark.parametrize("command, defaults", [("export", ("auto", "exact")), ("analyse", ("exact",))])
def test_help_shows_defaults_as_they_are_typed(command, defaults):
    """A default reads as the word to type, not as a name of the program's inside."""
    text = run(command, "--help", TERMINAL_WIDTH="200", NO_COLOR="1").stdout
    assert "ColliderShape" not in text and "Closures" not in text
    assert all(f"default: {word}" in text or f"default: ({word})" in text for word in defaults)


def test_one_of_a_thing_is_told_in_the_singular(lid, tmp_path):
    """One error, one joint: in the summaries as in the overview."""
    done = run("export", tmp_path / "none.bundle.json", "-o", tmp_path / "x.kinefab")
    assert "was not written: 1 error." in done.stderr
    assert "\n1 joint\n" in run("inspect", lid).stdout


def test_inspect_tells_what_is_in_a_scene(lid):
    """The tree, the hinge's range and the loss report."""
    done = run("inspect", lid)
    assert done.returncode == 0 and done.stderr == ""
    assert "Lid -> world: HingeJoint, turn X 0 .. 110 deg" in done.stdout
    assert "kept, 0 approximated, 0 dropped" in done.stdout


@pytest.mark.parametrize("limits, told", [((0, 0.4), "0 .. 0.4"), ((-0.1, 0.3), "-0.1 .. 0.3")])
def test_inspect_tells_a_slide_from_the_pose_in_the_file(tmp_path, limits, told):
    """Unity's limit has its middle at the connected anchor; a reader wants what the turned drawer can do."""
    scene = kinefab.Scene()
    turned = [[0, 0, 1], [1, 0, 0], [0, 1, 0]]
    case = scene.add_part("Case", BOX, translation=(1, 2, 3), rotation=turned, grounded=True)
    drawer = scene.add_part("Drawer", BOX, translation=(1, 2.5, 3), rotation=turned, parent=None)
    scene.add_slider(case, drawer, point=(1, 2.5, 3), axis=(0, 0.6, 0.8), limits=limits)
    done = run(
        "inspect", kinefab.export(scene, tmp_path / "a.kinefab", kinefab.ExportOptions(ground="world")).path
    )
    assert f"Drawer -> world: ConfigurableJoint, slide X {told} m" in done.stdout


def test_inspect_shows_children_under_their_parent(tmp_path):
    """Two assemblies filled in turns: each part stands under its own one."""
    scene = kinefab.Scene()
    left, right = scene.add_assembly("Left"), scene.add_assembly("Right")
    for number, parent in enumerate((left, right, left)):
        scene.add_part(f"P{number}", BOX, parent=parent, grounded=True)
    done = run(
        "inspect", kinefab.export(scene, tmp_path / "a.kinefab", kinefab.ExportOptions(ground="world")).path
    )
    assert [line.split("  0.")[0].rstrip() for line in done.stdout.splitlines()[:5]] == [
        "Left", "  P0", "  P2", "Right", "  P1",
    ]  # fmt: skip


def test_inspect_as_json_is_json(lid):
    """--json prints one document with objects, joints and report."""
    content = json.loads(run("inspect", lid, "--json").stdout)
    assert [o["id"] for o in content["objects"]] == ["Box", "Lid"]
    assert content["joints"][0]["freedoms"] == ["turn X 0 .. 110 deg"]


@pytest.mark.parametrize(
    "text, code",
    [
        (None, "SOURCE_NOT_FOUND"),
        ("", "SCENE_EMPTY"),
        ("{", "JSON_SYNTAX"),
        ('x{"gameObjects": []}', "JSON_SYNTAX"),
        ("<robot name='arm'/>", "FORMAT_MISSING"),
        ("\n#usda 1.0", "FORMAT_MISSING"),
        ('{"format": "else"}', "FORMAT_UNKNOWN"),
        ('{"format": "kinefab.scene", "version": "2.0"}', "VERSION_UNSUPPORTED"),
        ("[" * 100000, "JSON_TOO_DEEP"),
    ],
)
def test_inspect_of_no_scene_exits_1_without_a_traceback(tmp_path, text, code):
    """Missing, empty, broken, foreign, newer and absurdly nested files each give one diagnostic."""
    path = tmp_path / "x.kinefab"
    if text is not None:
        path.write_text(text)
    done = run("inspect", path)
    assert done.returncode == 1 and done.stdout == ""
    assert "Traceback" not in done.stderr and len(done.stderr.splitlines()) == 1
    assert code in done.stderr


def lever_joints(path: Path) -> list[dict]:
    return [
        {**c, "object": o["id"]}
        for o in read(path)["gameObjects"]
        for c in o.get("components", [])
        if c["type"].endswith("Joint")
    ]


def test_lever_is_exported_with_its_hinges_and_slider(tmp_path):
    """The paper's mechanism from its bundle: three hinges and a slider, nothing lost, no bar in a pipe."""
    target, found = tmp_path / "lever.kinefab", tmp_path / "r.json"
    done = run("export", LEVER, "-o", target, "--strict", "--colliders", "none", "--report", found)
    assert done.returncode == 0, done.stderr
    assert done.stdout == "" and len(done.stderr.splitlines()) <= 2 and "\x1b" not in done.stderr
    report = checked_report(found)
    assert report["written"] is True and len(report["outcomes"]) >= 4
    assert {entry["outcome"] for entry in report["outcomes"]} == {"kept"}
    joints = lever_joints(target)
    assert sorted(j["type"] for j in joints) == [
        "ConfigurableJoint",
        "HingeJoint",
        "HingeJoint",
        "HingeJoint",
    ]
    (slider,) = [j for j in joints if j["type"] == "ConfigurableJoint"]
    assert slider["object"] == "Lever/SliderD:1" and slider["xMotion"] == "Limited"
    # 6.5 .. 11.5 cm: 2.5 cm to each side of x = 9 cm, which the mirror makes -9 cm.
    assert slider["linearLimit"]["limit"] == pytest.approx(0.025, abs=1e-12)
    assert slider["connectedAnchor"][0] == pytest.approx(-0.09, abs=1e-12)


def test_lever_closes_with_the_rows_its_plane_needs(tmp_path):
    """When asked the loop-closing joint only holds what the rest leaves open: two rows in the plane."""
    done = run("export", LEVER, "-o", tmp_path / "lever.kinefab", "--closures", "minimal")
    assert done.returncode == 0, done.stderr
    (closing,) = [j for j in lever_joints(tmp_path / "lever.kinefab") if j.get("closure")]
    locked = [key for key, value in closing.items() if value == "Locked"]
    assert len(locked) == 2 and all(key in ("xMotion", "yMotion", "zMotion") for key in locked)


def test_lever_needs_its_constraints_alone(tmp_path):
    """Without explicit joints the constraints give the same mechanism, and the DOF analysis does not hinder it."""
    bundle = json.loads(LEVER.read_text("utf-8"))
    bundle["joints"] = []
    for mesh in LEVER.parent.glob("lever.[om]??"):
        (tmp_path / mesh.name).write_bytes(mesh.read_bytes())
    (tmp_path / "lever.bundle.json").write_text(json.dumps(bundle), "utf-8")
    done = run("export", tmp_path / "lever.bundle.json", "-o", tmp_path / "lever.kinefab", "--strict")
    assert done.returncode == 0, done.stderr
    scene = read(tmp_path / "lever.kinefab")
    assert (scene["analysis"]["mobility"], scene["analysis"]["redundant"]) == (1, 4)
    joints = lever_joints(tmp_path / "lever.kinefab")
    hinged = sorted(j["object"] for j in joints if j["type"] == "HingeJoint")
    assert hinged == ["Lever/BarC:1", "Lever/Crank:1", "Lever/SliderD:1"]
    (slider,) = [j for j in joints if j["type"] == "ConfigurableJoint" and not j.get("closure")]
    assert slider["object"] == "Lever/SliderD:1" and slider.get("xMotion", "Free") == "Free"


def test_draw_writes_a_picture(lid, tmp_path):
    """draw makes an SVG of a scene that names its joints."""
    done = run("draw", lid, "-o", tmp_path / "lid.svg")
    assert done.returncode == 0, done.stderr
    assert "turn X 0 .. 110 deg" in (tmp_path / "lid.svg").read_text("utf-8")


def test_draw_tells_of_a_missing_buffer(lid, tmp_path):
    """A scene without its buffer is a finding, and no picture is written."""
    for buffer in tmp_path.glob("*.bin"):
        buffer.unlink()
    done = run("draw", lid, "-o", tmp_path / "lid.svg")
    assert done.returncode == 1 and "BUFFER_MISSING" in done.stderr
    assert not (tmp_path / "lid.svg").exists()


def test_draw_tells_of_an_unsound_scene(tmp_path):
    """What cannot be drawn is a finding, not a traceback."""
    scene = {"format": "kinefab.scene", "version": "1.0", "gameObjects": [{"id": "a"}], "meshes": [3]}
    (tmp_path / "a.kinefab").write_text(json.dumps(scene))
    done = run("draw", tmp_path / "a.kinefab", "-o", tmp_path / "a.svg")
    assert done.returncode == 1 and "a.kinefab#/meshes/0: error TYPE_MISMATCH" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(
    "content, code",
    [
        ({"gameObjects": [{"id": "a", "name": "a", "components": [{}]}]}, "FIELD_MISSING"),
        ({"gameObjects": [3]}, "TYPE_MISMATCH"),
        ({"gameObjects": [{"name": "a"}]}, "FIELD_MISSING"),
        ({"gameObjects": [], "physics": {"fixedTimestep": math.nan}}, "JSON_SYNTAX"),
        ({"gameObjects": [], "physics": {"fixedTimestep": 10**400}}, "NUMBER_NOT_FINITE"),
        ({"gameObjects": [], "report": [1]}, "TYPE_MISMATCH"),
    ],
)
def test_inspect_of_an_unsound_scene_is_a_finding(tmp_path, content, code):
    """JSON that says it is a scene and is none: exit 1, a code, no traceback."""
    path = tmp_path / "bad.kinefab"
    path.write_text(json.dumps({"format": "kinefab.scene", "version": "1.0", **content}), encoding="utf-8")
    done = run("inspect", path)
    assert done.returncode == 1 and code in done.stderr and "Traceback" not in done.stderr


def test_inspect_json_of_half_a_surrogate_pair_is_a_finding(tmp_path):
    """JSON's escapes can hold what no UTF-8 output can."""
    path = tmp_path / "bad.kinefab"
    scene = {"format": "kinefab.scene", "version": "1.0", "gameObjects": [{"id": "a", "name": "\ud800"}]}
    path.write_text(json.dumps(scene), encoding="utf-8")
    done = run("inspect", path, "--json")
    assert done.returncode == 1 and "JSON_STRING_INVALID" in done.stdout and "Traceback" not in done.stderr


def test_control_characters_of_an_id_do_not_reach_the_terminal(tmp_path):
    """A name can neither colour the terminal nor forge a line, in findings and in what inspect shows."""
    scene = lid_scene()
    part = scene.add_part("a\x1b[31m\nb")
    scene.add_hinge(None, part, point=(0, 0, 0), axis=(0, 0, 1), name="H\x1b[2J", limits=(-999, 999))
    kinefab.export(scene, tmp_path / "a.kinefab", kinefab.ExportOptions(ground="world"))
    done = run("inspect", tmp_path / "a.kinefab")
    assert done.returncode == 0 and "a\\x1b[31m\\nb" in done.stdout and "\x1b" not in done.stdout


@pytest.mark.parametrize("command", [[], ["export"], ["analyse"], ["inspect"], ["draw"]])
def test_h_is_help(command):
    """-h and --help say the same, of the program and of each command."""
    short, long = (run(*command, word, NO_COLOR="1") for word in ("-h", "--help"))
    assert short.returncode == long.returncode == 0
    assert short.stdout == long.stdout and "Usage:" in short.stdout


@pytest.mark.parametrize("group", [[], ["bundle"], ["capture"]])
def test_the_list_of_commands_ends_no_sentence_in_the_middle(group):
    """In 80 columns; and words that an option takes stand where its value does."""
    assert "..." not in run(*group, "--help", NO_COLOR="1", COLUMNS="80").stdout.partition("Commands:")[2]
    assert "--unity 2021|2022|6" in run("export", "--help", NO_COLOR="1").stdout
