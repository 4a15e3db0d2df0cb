"""The files that the command line reads and writes: whole or not at all, and findings where that cannot be."""

from __future__ import annotations

import json
import signal
import subprocess
import sys

import pytest
from command_line import LEVER, checked_report, lid, run  # noqa: F401 (a fixture)
from source_bundles import bundle as bundle_of
from source_bundles import part


def test_missing_source_exits_1_and_writes_nothing(tmp_path):
    """A source that is not there is a diagnostic; so it is in the report file."""
    done = run(
        "export", tmp_path / "none.bundle.json", "-o", tmp_path / "x.kinefab", "--report", tmp_path / "r.json"
    )
    assert done.returncode == 1 and "Traceback" not in done.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["r.json"]
    report = checked_report(tmp_path / "r.json")
    assert report["diagnostics"][0]["severity"] == "error"
    assert report["written"] is False and report["errors"] == 1


@pytest.mark.parametrize("name", ["none.step", "none.kinefab", "none.usda", "none.mjcf"])
@pytest.mark.parametrize("command", ["export", "analyse", "view"])
def test_a_path_that_is_misspelt_is_told_before_anything_that_its_format_needs(tmp_path, name, command):
    output = {"export": "x.kinefab", "view": "x.html"}.get(command)
    for path, code in ((tmp_path / name, "SOURCE_NOT_FOUND"), (tmp_path / f"folder{name}", "SOURCE_IS_FOLDER")):
        (tmp_path / f"folder{name}").mkdir(exist_ok=True)
        done = run(command, path, *(("-o", tmp_path / output) if output else ()))
        assert done.returncode == 1 and f"error {code}: " in done.stderr and "pip install" not in done.stderr


def test_a_scene_that_cannot_be_read_is_told_by_whatever_reads_it(lid, tmp_path):
    """As of any other source: its buffer is gone, or half of it."""
    next(tmp_path.glob("*.bin")).unlink()
    half = tmp_path / "half.kinefab"
    half.write_bytes(lid.read_bytes()[:300])
    for path, code in ((lid, "BUFFER_MISSING"), (half, "JSON_SYNTAX")):
        for command in (("analyse", path), ("export", path, "-o", tmp_path / "x.glb"), ("mates", path)):
            done = run(*command)
            assert done.returncode == 1 and done.stderr.count(f"error {code}: ") == 1
        told = json.loads(run("export", path, "-o", tmp_path / "x.glb", "--json").stdout)
        assert (told["errors"], told["diagnostics"][0]["code"]) == (1, code)


@pytest.mark.parametrize(
    "output, report",
    [("a.bundle.json", "r.json"), ("a.kinefab", "a.bundle.json"), ("a.kinefab", "../{folder}/a.kinefab")],
)
def test_no_file_of_the_call_overwrites_another(tmp_path, output, report):
    """The source as target, or the report in the place of either, is wrong usage, and the files stay."""
    (tmp_path / "a.bundle.json").write_bytes(LEVER.read_bytes())
    report = tmp_path / report.format(folder=tmp_path.name)
    done = run("export", tmp_path / "a.bundle.json", "-o", tmp_path / output, "--report", report)
    assert done.returncode == 2
    assert [path.name for path in tmp_path.iterdir()] == ["a.bundle.json"]
    assert (tmp_path / "a.bundle.json").read_bytes() == LEVER.read_bytes()


@pytest.mark.parametrize("output", ["a" * 300 + ".kinefab", "no/folder.kinefab"])
def test_target_that_cannot_be_made_is_a_finding(tmp_path, output):
    """The reason is told, also where the file system refuses even to look."""
    done = run("export", LEVER, "-o", tmp_path / output)
    assert done.returncode == 1 and "TARGET_UNWRITABLE" in done.stderr and "Traceback" not in done.stderr


@pytest.mark.parametrize("report", ["a" * 300 + ".json", "no/folder.json"])
def test_report_that_cannot_be_made_is_found_before_the_work(tmp_path, report):
    """A scene whose losses cannot be told is not written; neither is anything else."""
    done = run("export", LEVER, "-o", tmp_path / "a.kinefab", "--report", tmp_path / report)
    assert done.returncode == 1 and "TARGET_UNWRITABLE" in done.stderr and "Traceback" not in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_report_into_a_folder_is_wrong_usage(tmp_path):
    """As a scene is."""
    done = run("export", LEVER, "-o", tmp_path / "a.kinefab", "--report", tmp_path)
    assert done.returncode == 2 and list(tmp_path.iterdir()) == []


@pytest.mark.linux  # file names of any bytes are Linux's
@pytest.mark.parametrize(
    "source, output", [("a\udcff.bundle.json", "a.kinefab"), ("a.bundle.json", "a\udcff.kinefab")]
)
def test_file_name_that_is_not_utf8_is_a_finding(tmp_path, source, output):
    """A name that no JSON file can hold is refused, and the report of that is JSON all the same."""
    (tmp_path / source).write_bytes(b'{"meta": 1}' if source != "a.bundle.json" else LEVER.read_bytes())
    for mesh in LEVER.parent.glob("*.obj"):
        (tmp_path / mesh.name).write_bytes(mesh.read_bytes())
    done = run("export", tmp_path / source, "-o", tmp_path / output, "--report", tmp_path / "r.json")
    assert done.returncode == 1 and "Traceback" not in done.stderr
    found = json.loads((tmp_path / "r.json").read_bytes())["diagnostics"]
    assert {"SOURCE_UNREADABLE", "TARGET_UNWRITABLE"} & {entry["code"] for entry in found}


def limited_run(blocks: int, *arguments):
    """As ``run``, with files cut off at so many KiB, as a full disk does."""
    command = f'ulimit -f {blocks}; exec "$@"'
    return subprocess.run(
        ["bash", "-c", command, "bash", sys.executable, "-m", "kinefab", *map(str, arguments)],
        capture_output=True, text=True, timeout=60,
    )  # fmt: skip


@pytest.mark.posix  # needs ulimit
@pytest.mark.parametrize("old", [None, "the old picture"])
def test_a_picture_is_written_whole_or_not_at_all(lid, tmp_path, old):
    """A full disk leaves the old picture, or none, and a finding with its code."""
    picture = tmp_path / "lid.svg"
    if old is not None:
        picture.write_text(old)
    before = sorted(tmp_path.iterdir())
    done = limited_run(1, "draw", lid, "-o", picture)
    assert (
        done.returncode == 1 and "error TARGET_UNWRITABLE" in done.stderr and "Traceback" not in done.stderr
    )
    assert sorted(tmp_path.iterdir()) == before and (old is None or picture.read_text() == old)
    assert run("draw", lid, "-o", picture).returncode == 0 and picture.read_text().rstrip().endswith("</svg>")


@pytest.mark.posix  # needs ulimit
def test_a_report_is_written_whole_or_not_at_all(tmp_path):
    """A full disk leaves the report of the last run, not the first half of this one."""
    bundle, report = tmp_path / "a.bundle.json", tmp_path / "r.json"
    orphans = [part(f"p{i}", parent="none") for i in range(50)]
    bundle.write_text(json.dumps(bundle_of(*orphans)))
    assert run("export", bundle, "-o", tmp_path / "a.kinefab", "--report", report).returncode == 1
    old = report.read_bytes()
    assert len(old) > 2048
    done = limited_run(1, "export", bundle, "-o", tmp_path / "a.kinefab", "--report", report)
    assert done.returncode == 1 and "error TARGET_UNWRITABLE" in done.stderr
    assert report.read_bytes() == old and sorted(p.name for p in tmp_path.iterdir()) == [
        "a.bundle.json",
        "r.json",
    ]


@pytest.mark.posix  # needs links and pipes
def test_a_report_goes_through_a_link_and_into_a_pipe(lid, tmp_path):
    """A link stays a link, and what is no regular file is not replaced by one."""
    (tmp_path / "there").mkdir()
    link = tmp_path / "lid.svg"
    link.symlink_to(tmp_path / "there" / "picture.svg")
    assert run("draw", lid, "-o", link).returncode == 0
    assert link.is_symlink() and (tmp_path / "there" / "picture.svg").is_file()
    done = run(
        "export", tmp_path / "none.bundle.json", "-o", tmp_path / "x.kinefab", "--report", "/dev/stdout"
    )
    assert json.loads(done.stdout)["written"] is False


@pytest.mark.posix  # has the signals
@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGHUP"])
@pytest.mark.parametrize("target", ["lever.kinefab", "Lever.prefab", "lever.glb"])
def test_a_job_that_is_stopped_leaves_nothing_half_written(tmp_path, target, name):
    """What is written stands under a hidden name yet when it is made lasting; the shell sees the signal in the exit status."""
    number = getattr(signal, name)
    # Under nohup, or in the background, the signal is ignored, and children inherit that.
    usual = "signal.default_int_handler" if name == "SIGINT" else "signal.SIG_DFL"
    told = f"import signal; signal.signal({number:d}, {usual})\n"
    stopped = f"{told}import os; os.fsync = lambda file: os.kill(os.getpid(), {number:d})\nimport kinefab.cli as c; c.main()"
    command = [sys.executable, "-c", stopped, "export", LEVER, "-o", tmp_path / target]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert done.returncode == 128 + number and done.stderr == ""
    assert list(tmp_path.iterdir()) == []


@pytest.mark.posix
def test_nohup_is_kept_to(tmp_path):
    ignored = "import os, signal; signal.signal(signal.SIGHUP, signal.SIG_IGN)\n"
    held = f"{ignored}os.fsync = lambda file: os.kill(os.getpid(), signal.SIGHUP)\nimport kinefab.cli as c; c.main()"
    command = [sys.executable, "-c", held, "export", LEVER, "-o", tmp_path / "lever.kinefab"]
    assert subprocess.run(command, capture_output=True, timeout=60).returncode == 0
