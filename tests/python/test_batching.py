"""Many files: one that hangs, crashes or eats memory costs only itself, what is done is skipped, a lost worker loses nothing."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from concurrent.futures import Future, ThreadPoolExecutor
from fractions import Fraction
from pathlib import Path

import kinefab
import pytest
from dask_processes import cluster  # noqa: F401 (a fixture)
from kinefab.batching import job as jobs
from kinefab.batching import places
from kinefab.batching.index import index_page
from kinefab.batching.job import Outcome
from kinefab.batching.ledger import AWAITED
from kinefab.batching.plan import planned
from kinefab.sources.guard import command
from kinefab.views.picture import HEIGHT, WIDTH

ROOT = Path(__file__).resolve().parents[2]
PAIRS = ROOT / "fixtures" / "pairs"
SOURCE = Path(__file__).resolve().parents[2] / "python" / "src"

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="files in processes of their own need fork")


def bundles(folder: Path, *names: str) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    for name in names:
        shutil.copy(PAIRS / "P01.bundle.json", folder / f"{name}.bundle.json")
    return folder


def outcomes(result: kinefab.BatchResult) -> dict[str, str]:
    return {Path(r.source).name.partition(".")[0]: r.outcome.value for r in result.records}


def test_a_folder_becomes_a_folder_with_its_tree_and_an_index(tmp_path):
    bundles(tmp_path / "in" / "deep", "b")
    bundles(tmp_path / "in", "a & <b>")
    (tmp_path / "in" / "notes.json").write_text("{}")
    result = kinefab.batch([tmp_path / "in"], tmp_path / "out", jobs=2)
    assert result.counts == {"written": 2} and result.worst is Outcome.WRITTEN
    assert (tmp_path / "out" / "deep" / "b.kinefab").is_file()
    page = (tmp_path / "out" / "index.html").read_text("utf-8")
    assert "a &amp; &lt;b&gt;.kinefab" in page and "<b>." not in page and page.count("<img") == 2
    assert (
        f"aspect-ratio: {Fraction(WIDTH, HEIGHT).numerator} / {Fraction(WIDTH, HEIGHT).denominator};" in page
    )
    lines = [json.loads(line) for line in (tmp_path / "out" / "batch.jsonl").read_text("utf-8").splitlines()]
    assert {line["outcome"] for line in lines} == {"written"}
    assert all(
        line["seconds"] > 0 and line["memory"] > 2**20 and line["mobility"] is not None for line in lines
    )
    assert all(Path(line["thumbnail"]).is_file() for line in lines)


def test_what_is_up_to_date_is_skipped_and_what_changed_is_not(tmp_path):
    folder = bundles(tmp_path / "in", "a", "b", "c")
    run = lambda **options: kinefab.batch([folder], tmp_path / "out", jobs=2, **options)  # noqa: E731
    first = run()
    before = {r.target: Path(r.target).stat().st_mtime_ns for r in first.records}
    assert outcomes(run()) == dict.fromkeys("abc", "up_to_date")
    assert before == {r.target: Path(r.target).stat().st_mtime_ns for r in first.records}
    text = (folder / "b.bundle.json").read_text("utf-8")
    (folder / "b.bundle.json").write_text(text + "\n")
    (tmp_path / "out" / "c.kinefab").unlink()
    assert outcomes(run()) == {"a": "up_to_date", "b": "written", "c": "written"}
    assert outcomes(run(options=kinefab.ExportOptions(density=7850))) == dict.fromkeys("abc", "written")


def test_a_mesh_that_changed_counts_as_read(tmp_path):
    """What a source names is found out by what was opened."""
    (tmp_path / "in").mkdir()
    for name in ("lever.bundle.json", "lever.obj", "lever.mtl"):
        shutil.copy(ROOT / "fixtures" / "lever" / name, tmp_path / "in" / name)
    run = lambda: outcomes(kinefab.batch([tmp_path / "in" / "lever.bundle.json"], tmp_path / "out"))  # noqa: E731
    assert (run(), run()) == ({"lever": "written"}, {"lever": "up_to_date"})
    with (tmp_path / "in" / "lever.obj").open("a") as file:
        file.write("\n# seen again\n")
    assert run() == {"lever": "written"}


def test_a_file_that_a_library_opens_by_itself_counts_as_read(tmp_path):
    """MuJoCo opens the meshes of its models, and Python hears nothing of it."""
    pytest.importorskip("mujoco", reason="mujoco (pip install mujoco) is not installed")
    (tmp_path / "in").mkdir()
    shutil.copy(ROOT / "fixtures" / "lever" / "lever.obj", tmp_path / "in" / "lever.obj")
    (tmp_path / "in" / "a.xml").write_text(
        "<mujoco><asset><mesh name='m' file='lever.obj'/></asset><worldbody><body><joint axis='0 0 1'/>"
        "<geom size='.1'/><geom type='mesh' mesh='m' mass='1'/></body></worldbody></mujoco>"
    )
    run = lambda: outcomes(kinefab.batch([tmp_path / "in" / "a.xml"], tmp_path / "out", jobs=1))  # noqa: E731
    assert (run(), run()) == ({"a": "written"}, {"a": "up_to_date"})
    with (tmp_path / "in" / "lever.obj").open("a") as file:
        file.write("\n# seen again\n")
    assert run() == {"a": "written"}


def test_a_mesh_that_was_not_there_is_read_once_it_is(tmp_path):
    """What a source had to do without was not opened, so nothing that was read tells of it."""
    (tmp_path / "in").mkdir()
    geometry = '<visual><geometry><mesh filename="lever.obj"/></geometry></visual>'
    (tmp_path / "in" / "a.urdf").write_text(f'<robot name="a"><link name="base">{geometry}</link></robot>')
    run = lambda: kinefab.batch([tmp_path / "in" / "a.urdf"], tmp_path / "out", jobs=1).records[0]  # noqa: E731
    assert run().codes["MESH_NOT_FOUND"] == 1
    for name in ("lever.obj", "lever.mtl"):
        shutil.copy(ROOT / "fixtures" / "lever" / name, tmp_path / "in" / name)
    assert "MESH_NOT_FOUND" not in (found := run()).codes and found.outcome is Outcome.WRITTEN
    assert run().outcome is Outcome.UP_TO_DATE


@pytest.mark.parametrize("target", ["kinefab", "prefab", "glb", "usda"])
def test_a_library_of_materials_that_is_not_there_is_remembered(tmp_path, target):
    """What was made without it is up to date until it comes, and again when it has gone."""
    if target == "usda":
        pytest.importorskip("pxr", reason="usd-core (python[usd]) is not installed")
    for name in ("lever.bundle.json", "lever.obj"):
        (tmp_path / "in").mkdir(exist_ok=True)
        shutil.copy(ROOT / "fixtures" / "lever" / name, tmp_path / "in" / name)
    source, library = tmp_path / "in" / "lever.bundle.json", tmp_path / "in" / "lever.mtl"
    run = lambda: kinefab.batch([source], tmp_path / "out", to=target, jobs=1).records[0]  # noqa: E731
    assert (first := run()).codes["MATERIALS_MISSING"] > 0 and first.outcome is Outcome.WRITTEN
    assert run().outcome is Outcome.UP_TO_DATE
    shutil.copy(ROOT / "fixtures" / "lever" / "lever.mtl", library)
    assert "MATERIALS_MISSING" not in (found := run()).codes and found.outcome is Outcome.WRITTEN
    assert run().outcome is Outcome.UP_TO_DATE
    library.unlink()
    assert run().codes["MATERIALS_MISSING"] > 0
    assert run().outcome is Outcome.UP_TO_DATE


REMEMBERED = {"MATERIALS_MISSING"}
"""Of files that are opened where they are looked for."""


def test_every_finding_of_a_file_that_is_not_there_is_one_that_is_waited_for():
    """Of errors there is no target; those of prims and columns are of what was read."""
    codes = json.loads((ROOT / "schemas" / "diagnostics.json").read_text("utf-8"))["codes"]
    told = {
        code
        for code, entry in codes.items()
        if entry["stage"] in ("source", "geometry") and entry["severity"] != "error"
        if code.endswith(("_NOT_FOUND", "_FILE_MISSING", "_TEXTURE_MISSING"))
        or "which is not there" in entry["message"]
    }
    assert told <= AWAITED | REMEMBERED <= codes.keys() and not AWAITED & REMEMBERED


def test_a_target_of_another_source_is_not_up_to_date(tmp_path):
    """Two releases of one tree go to one folder, one after the other, and the older one is still there."""
    for release in ("1.0", "1.1"):
        bundles(tmp_path / release, "a")
    run = lambda release: kinefab.batch([tmp_path / release], tmp_path / "out", jobs=1)  # noqa: E731
    assert [outcomes(run(r))["a"] for r in ("1.0", "1.0", "1.1", "1.1")] == ["written", "up_to_date"] * 2


def test_a_copy_of_a_target_folder_is_made_anew(tmp_path):
    bundles(tmp_path / "in", "a")
    kinefab.batch([tmp_path / "in"], tmp_path / "out", jobs=1)
    shutil.copytree(tmp_path / "out", tmp_path / "copy")
    (tmp_path / "copy" / "a.kinefab").unlink()
    (record,) = kinefab.batch([tmp_path / "in"], tmp_path / "copy", jobs=1).records
    assert (record.target, record.outcome) == (str(tmp_path / "copy" / "a.kinefab"), Outcome.WRITTEN)
    assert (tmp_path / "copy" / "a.kinefab").is_file()


def test_what_is_read_counts_wherever_the_batch_is_started(tmp_path):
    """The folder of the sources is then on Python's own path; what is no file of the user's does not count."""
    (tmp_path / "in").mkdir()
    for name in ("lever.bundle.json", "lever.obj", "lever.mtl"):
        shutil.copy(ROOT / "fixtures" / "lever" / name, tmp_path / "in" / name)
    command = [sys.executable, "-m", "kinefab", "batch", "in", "-o", "out", "--json"]

    def run() -> str:
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
        return json.loads(done.stdout)["outcome"]

    assert (run(), run()) == ("written", "up_to_date")
    (record,) = (tmp_path / "out" / ".kinefab-batch" / "records").glob("*.json")
    read = json.loads(record.read_text("utf-8"))["read"]
    assert {Path(path).name for path in read} == {"lever.bundle.json", "lever.obj", "lever.mtl"}
    with (tmp_path / "in" / "lever.obj").open("a") as file:
        file.write("\n# seen again\n")
    assert run() == "written"


def test_a_bad_file_costs_only_itself(tmp_path):
    folder = bundles(tmp_path / "in", "good")
    (folder / "torn.bundle.json").write_text("{")
    bundles(tmp_path / "out")
    result = kinefab.batch([folder, folder / "gone.urdf"], tmp_path / "out", jobs=2)
    found = {Path(r.source).name: r for r in result.records}
    assert found["good.bundle.json"].outcome is Outcome.WRITTEN
    assert found["torn.bundle.json"].outcome is Outcome.REFUSED and found["torn.bundle.json"].messages
    assert found["gone.urdf"].outcome is Outcome.REFUSED and not result.worst.good


HOSTILE = """
import sys, os, time, signal, subprocess
from kinefab.batching import child, work
real = work.work
def hostile(job, reading):
    name = os.path.basename(job.source)
    if name.startswith("hang"):
        with open(job.source + ".pid", "w") as file: file.write(str(os.getpid()))
        time.sleep(600)
    if name.startswith("crash"): os.kill(os.getpid(), signal.SIGSEGV)
    if name.startswith("exit"): os._exit(7)
    if name.startswith("raise"): raise RuntimeError("a library's own")
    if name.startswith("greedy"):
        held = []
        while True: held.append(bytearray(8 << 20)); time.sleep(0.01)
    if name.startswith("nested"):
        greed = "import time; held = bytearray(700 << 20); time.sleep(600)" if "greedy" in name else "import time; time.sleep(600)"
        started = subprocess.Popen([sys.executable, "-c", greed])
        with open(job.source + ".pid", "w") as file: file.write(str(started.pid))
        started.wait()
    if name.startswith("slow"): time.sleep(float(os.environ.get("SLOW", "1")))
    return real(job, reading)
child.work = hostile
child.serve()
"""
"""A converting process whose work does, for some names, what damaged files do to libraries."""


@pytest.fixture
def hostile(tmp_path, monkeypatch):
    script = tmp_path / "hostile.py"
    script.write_text(HOSTILE)
    real = subprocess.Popen

    def started(command, **options):
        if "kinefab.batching.child" in command[-1]:
            command = [command[0], str(script)]
        return real(command, **options)

    monkeypatch.setattr("kinefab.batching.slot.subprocess.Popen", started)


def test_what_hangs_crashes_or_eats_memory_is_ended_and_told(tmp_path, hostile):
    folder = bundles(tmp_path / "in", "hang", "crash", "exit", "raise", "greedy", "ok1", "ok2")
    result = kinefab.batch([folder], tmp_path / "out", jobs=2, timeout=8, memory=600 * 2**20)
    assert outcomes(result) == {
        "hang": "timeout", "crash": "crashed", "exit": "crashed", "raise": "crashed", "greedy": "memory",
        "ok1": "written", "ok2": "written",
    }  # fmt: skip
    told = {Path(r.source).name.partition(".")[0]: r.messages[0] for r in result.records if r.messages}
    codes = {Path(r.source).name.partition(".")[0]: [*r.codes] for r in result.records if r.messages}
    assert codes == {"hang": ["BATCH_TIMEOUT"], "greedy": ["BATCH_MEMORY"]} | dict.fromkeys(
        ("crash", "exit", "raise"), ["BATCH_CRASHED"]
    )
    assert "8 s" in told["hang"] and "SIGSEGV" in told["crash"] and "status 7" in told["exit"]
    assert "a library's own" in told["raise"] and "600 MiB" in told["greedy"]


def test_what_a_file_s_reader_starts_is_counted_and_ended_with_it(tmp_path, hostile):
    """As OpenCASCADE or assimp in a process of their own: that one eats the memory, and lived on when its job was ended."""
    folder = bundles(tmp_path / "in", "nested", "nested_greedy")
    result = kinefab.batch([folder], tmp_path / "out", jobs=2, timeout=8, memory=600 * 2**20)
    assert outcomes(result) == {"nested": "timeout", "nested_greedy": "memory"}
    for marker in folder.glob("*.pid"):
        with pytest.raises(ProcessLookupError):
            for _ in range(500):
                os.kill(int(marker.read_text()), 0)
                time.sleep(0.01)


def command_of(folder, out, *more):
    """A batch in a process of its own that tells each record."""
    return [sys.executable, "-m", "kinefab", "batch", str(folder), "-o", str(out), "--json", *more]


def test_a_batch_that_is_killed_goes_on_where_it_was(tmp_path):
    folder = bundles(tmp_path / "in", *(f"n{i}" for i in range(12)))
    command = command_of(folder, tmp_path / "out", "-j", "1")
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    for _ in range(3):
        process.stdout.readline()
    process.send_signal(signal.SIGKILL)
    process.communicate()
    time.sleep(0.5)  # the converting process notices that nobody asks any more
    result = kinefab.batch([folder], tmp_path / "out", jobs=2)
    assert result.counts.get("up_to_date", 0) >= 3 and result.worst.good and len(result.records) == 12
    assert list(tmp_path.glob("out/.*.tmp")) == []


def test_a_converting_process_that_nobody_hears_ends_without_a_word(tmp_path):
    """Its batch was killed while the file was converted: its traceback stood below the job that was stopped."""
    child = command("kinefab.batching.child", "serve")
    job = jobs.Job(str(tmp_path / "none.urdf"), str(tmp_path / "none.kinefab"), str(tmp_path / "ledger"))
    with subprocess.Popen(
        child, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        process.stdout.close()
        process.stdin.write(json.dumps(job.as_json()).encode() + b"\n")
        process.stdin.flush()
        assert process.wait(timeout=60) == 1 and process.stderr.read() == b""


def test_a_batch_that_is_broken_off_ends_what_is_under_way_and_begins_nothing(tmp_path, hostile):
    """As by Ctrl+C, which a terminal sends to a whole session: the converting processes have one of their own."""
    folder = bundles(tmp_path / "in", "hang", "ok1", "ok2", "ok3")
    marker = folder / "hang.bundle.json.pid"

    def broken_off(done, total, record):
        while not marker.exists() or not marker.read_text():
            time.sleep(0.01)
        assert os.getsid(int(marker.read_text())) != os.getsid(0)
        raise KeyboardInterrupt

    began = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        kinefab.batch([folder], tmp_path / "out", jobs=2, progress=broken_off)
    assert time.monotonic() - began < 60.0
    with pytest.raises(ProcessLookupError):
        for _ in range(500):
            os.kill(int(marker.read_text()), 0)
            time.sleep(0.01)
    assert kinefab.batch([bundles(tmp_path / "more", "ok4")], tmp_path / "out").worst.good


def test_two_batches_at_once_write_every_target_once(tmp_path):
    folder = bundles(tmp_path / "in", *(f"n{i}" for i in range(8)))
    command = command_of(folder, tmp_path / "out", "-q")
    both = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(2)]
    told = [[json.loads(line) for line in one.communicate()[0].splitlines()] for one in both]
    assert [one.returncode for one in both] == [0, 0]
    one, other = ({record["source"]: record["outcome"] for record in records} for records in told)
    assert len(one) == 8
    assert all({one[source], other[source]} == {"written", "up_to_date"} for source in one)


def test_targets_of_somebody_else_are_left_alone(tmp_path):
    folder = bundles(tmp_path / "in", "a")
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "a.kinefab").write_text("mine")
    result = kinefab.batch([folder], tmp_path / "out")
    assert result.worst is Outcome.FAILED and "no batch wrote it" in result.records[0].messages[0]
    assert (tmp_path / "out" / "a.kinefab").read_text() == "mine"
    assert kinefab.batch([folder], tmp_path / "out", force=True).worst is Outcome.WRITTEN


@pytest.mark.parametrize(
    "target, out, link",
    [
        ("/out/javascript:1.kinefab", "/out", "javascript%3A1.kinefab"),
        ("/out/a b/ö.kinefab", "/out", "a%20b/%C3%B6.kinefab"),
        ("s3://b/out/a:1.kinefab", "s3://b/out", "a%3A1.kinefab"),
        ("s3://b/elsewhere/a.kinefab", "s3://b/out", "s3://b/elsewhere/a.kinefab"),
    ],
)
def test_links_of_the_index_lead_to_files_whatever_their_names(target, out, link):
    page = index_page([jobs.Record("source", target, Outcome.WRITTEN)], out)
    assert re.findall('href="([^"]*)"', page) == [link]


def test_sources_of_one_name_keep_their_endings(tmp_path):
    for name in ("arm.urdf", "arm.bundle.json", "leg.urdf"):
        (tmp_path / name).write_text("<robot name='r'><link name='l'/></robot>")
    targets = dict(planned([str(tmp_path)], "/out", ".kinefab").work)
    assert targets == {
        str(tmp_path / "arm.urdf"): "/out/arm.urdf.kinefab",
        str(tmp_path / "arm.bundle.json"): "/out/arm.bundle.json.kinefab",
        str(tmp_path / "leg.urdf"): "/out/leg.kinefab",
    }


def test_any_executor_does(tmp_path):
    folder = bundles(tmp_path / "in", "a", "b")
    with ThreadPoolExecutor(1) as executor:
        assert kinefab.batch([folder], tmp_path / "out", executor=executor).counts == {"written": 2}
    with pytest.raises(ValueError, match="there is no output 'fbx'"):
        kinefab.batch([folder], tmp_path / "out", "fbx")


class Lossy(ThreadPoolExecutor):
    """An executor whose workers are lost and not replaced."""

    def submit(self, *_, **__):
        future = Future()
        future.set_exception(ConnectionError("gone"))
        return future


def test_an_executor_that_loses_its_workers_is_told(tmp_path):
    folder = bundles(tmp_path / "in", "a", "b")
    with Lossy(1) as executor:
        result = kinefab.batch([folder], tmp_path / "out", executor=executor)
    assert result.counts == {"crashed": 2}
    assert all([*r.codes] == ["BATCH_WORKER_LOST"] and "gone" in r.messages[0] for r in result.records)
    assert kinefab.batch([folder], tmp_path / "out").counts == {"written": 2}


def test_options_travel_as_json(tmp_path):
    options = kinefab.ExportOptions(density=7.0, reading={"package_path": [tmp_path], "root": "/a"})
    values = json.loads(json.dumps(jobs.options_as_json(options)))
    assert jobs.options_as_json(jobs.options_of_json(values)) == values and values["closures"] == "exact"


def test_urls_are_read_and_written(tmp_path):
    fsspec = pytest.importorskip("fsspec", reason="the Python package fsspec is not installed")
    system = fsspec.filesystem("file")
    bundles(tmp_path / "in", "a", "b")
    url = f"file://{tmp_path}/in"
    result = kinefab.batch([url + "/*.bundle.json"], f"file://{tmp_path}/out", jobs=1)
    assert result.counts == {"written": 2} and system.exists(f"{tmp_path}/out/a.kinefab")
    assert kinefab.batch([url + "/*.bundle.json"], f"file://{tmp_path}/out", jobs=1).counts == {
        "up_to_date": 2
    }
    places.write_bytes("memory://batch/x", b"1")
    assert places.read_bytes("memory://batch/x") == b"1" and places.read_bytes("memory://batch/y") is None


@pytest.mark.parametrize("ending", [".usda", ".usdc"])
def test_a_stage_by_url_comes_with_the_layers_beside_it(tmp_path, ending):
    pytest.importorskip("fsspec", reason="the Python package fsspec is not installed")
    usd = pytest.importorskip("pxr.Usd", reason="usd-core is not installed")
    (tmp_path / "in").mkdir()
    arm, robot = (f"{tmp_path}/in/{name}{ending}" for name in ("arm", "robot"))
    for path in (arm, robot):
        stage = usd.Stage.CreateNew(path)
        stage.SetDefaultPrim(stage.DefinePrim("/Arm", "Cube"))
        if path == robot:
            stage.GetDefaultPrim().GetReferences().AddReference(f"./arm{ending}")
        stage.GetRootLayer().Save()
    (record,) = kinefab.batch([f"file://{robot}"], tmp_path / "out", jobs=1).records
    assert record.outcome is Outcome.WRITTEN and "USD_COMPOSITION" not in record.codes


def test_a_worker_that_is_killed_loses_nothing_and_nothing_is_done_twice(tmp_path, cluster):
    from kinefab.batching.cluster import executor_of

    address, workers = cluster
    folder = bundles(tmp_path / "in", *(f"n{i:02}" for i in range(16)))
    killed = []

    def progress(done, total, record):
        if done == 4 and not killed:
            killed.append(workers[0].pid)
            workers[0].kill()

    with executor_of(address) as executor:
        result = kinefab.batch([folder], tmp_path / "out", executor=executor, timeout=120, progress=progress)
    assert killed and len(result.records) == 16 and result.worst.good
    assert len(list((tmp_path / "out").glob("*.kinefab"))) == 16
    assert len(list((tmp_path / "out").glob("*.kinefab.*.bin"))) in (0, 16)
    with executor_of(address) as executor:
        again = kinefab.batch([folder], tmp_path / "out", executor=executor)
    assert again.counts == {"up_to_date": 16}


def test_the_command_line_tells_the_worst_by_its_status(tmp_path):
    folder = bundles(tmp_path / "in", "a")
    command = [sys.executable, "-m", "kinefab", "batch", str(folder), "-o", str(tmp_path / "out")]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0 and "1 written" in done.stderr and "index.html" in done.stderr
    (folder / "torn.bundle.json").write_text("{")
    done = subprocess.run([*command, "--json"], capture_output=True, text=True)
    assert done.returncode == 1 and "Traceback" not in done.stderr and "refused: " in done.stderr
    assert {json.loads(line)["outcome"] for line in done.stdout.splitlines()} == {"up_to_date", "refused"}
