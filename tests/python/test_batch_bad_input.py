"""What can be wrong with a batch's inputs, target folder, numbers and scheduler: each a sentence with its remedy, and the
rest goes on."""

from __future__ import annotations

import gc
import os
import re
import shutil
from pathlib import Path

import kinefab
import pytest
from command_line import runner
from dask_processes import dask, free_port
from kinefab.batching import cluster as clusters
from kinefab.batching.job import Job, Outcome, Record, options_as_json
from kinefab.batching.ledger import Reading
from kinefab.batching.work import work
from kinefab.cli import app
from kinefab.diagnostics import KinefabError

PAIR = Path(__file__).resolve().parents[2] / "fixtures" / "pairs" / "P01.bundle.json"

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="files in processes of their own need fork")


def sources(folder: Path, *names: str) -> Path:
    for name in names:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(PAIR, folder / f"{name}.bundle.json")
    return folder


def found(result: kinefab.BatchResult) -> dict[str, Record]:
    return {Path(record.source).name.partition(".")[0]: record for record in result.records}


def told(record: Record, code: str, *words: str) -> bool:
    """One finding of that code, whose sentence has the words and is followed by what to do."""
    (message,) = record.messages
    return (
        record.codes == {code: 1}
        and message.startswith(f"error {code}: ")
        and message.count(". ") >= 1
        and all(word in message for word in words)
    )


@pytest.mark.parametrize("numbers", [{"jobs": 0}, {"jobs": -1}, {"timeout": 0.0}, {"memory": 0}], ids=str)
def test_numbers_that_allow_nothing_are_a_wrong_call(tmp_path, numbers):
    (name,) = numbers
    with pytest.raises(ValueError, match=f"{name} is .* above zero"):
        kinefab.batch([sources(tmp_path / "in", "a")], tmp_path / "out", **numbers)
    done = runner().invoke(
        app, ["batch", str(tmp_path), "-o", str(tmp_path / "out"), f"--{name}", str(numbers[name])]
    )
    assert done.exit_code == 2 and f"--{name}" in done.stderr and not (tmp_path / "out").exists()


@pytest.mark.parametrize("through", [str, Path], ids=["text", "path"])
def test_one_folder_alone_is_that_folder(tmp_path, monkeypatch, through):
    """Text is a sequence too: each of its letters was looked for, and what lay in a folder of one letter was exported."""
    monkeypatch.chdir(tmp_path)
    sources(tmp_path / "robots", "arm")
    sources(tmp_path / "o", "other")
    result = kinefab.batch(through("robots"), "out", jobs=1)
    assert [*found(result)] == ["arm"] and result.counts == {"written": 1}


@pytest.mark.parametrize(
    "wrong, told",
    [
        ({"inputs": None}, "the inputs are None; pass files, folders or patterns"),
        ({"inputs": ["a.urdf", 3]}, "3 is among the inputs; pass files, folders or patterns"),
        ({"out": None}, "out is None; pass a folder or a URL"),
        ({"options": {"colliders": "box"}}, "the options are {'colliders': 'box'}; pass kinefab.ExportOptions(...)"),
        ({"jobs": "2"}, "jobs is '2'; pass a number, or None"),
        ({"timeout": True}, "timeout is True; pass a number, or None"),
        ({"options": kinefab.ExportOptions(reading={"up": "z"})}, "up is 'z'; pass one of: X, Y, Z"),
        ({"options": kinefab.ExportOptions(writing={"scripts": 1})}, "scripts is 1; pass True or False"),
    ],
)  # fmt: skip
def test_what_is_no_input_folder_option_or_number_is_a_wrong_call(tmp_path, wrong, told):
    """At once, and nothing is made."""
    call = {"inputs": [tmp_path / "gone.urdf"], "out": tmp_path / "out"} | wrong
    with pytest.raises((TypeError, ValueError)) as refused:
        kinefab.batch(**call)
    assert str(refused.value) == told and not (tmp_path / "out").exists()


def test_a_target_folder_that_is_a_file_is_told_before_anything_is_read(tmp_path):
    (tmp_path / "out").write_text("somebody's")
    with pytest.raises(KinefabError) as caught:
        kinefab.batch([sources(tmp_path / "in", "a")], tmp_path / "out")
    assert [d.code for d in caught.value.diagnostics] == ["TARGET_UNWRITABLE"]
    assert (tmp_path / "out").read_text() == "somebody's"


def test_what_somebody_else_has_in_the_target_folder_stays(tmp_path):
    folder = sources(tmp_path / "in", "a", "b")
    sources(tmp_path / "out", "notes")
    (tmp_path / "out" / "a.kinefab").write_text("mine")
    records = found(kinefab.batch([folder], tmp_path / "out", jobs=1))
    assert told(records["a"], "BATCH_TARGET_FOREIGN", "no batch wrote it", "--force")
    assert records["b"].outcome is Outcome.WRITTEN
    assert (tmp_path / "out" / "a.kinefab").read_text() == "mine"
    assert (tmp_path / "out" / "notes.bundle.json").read_bytes() == PAIR.read_bytes()


def test_a_name_in_many_folders_is_told_briefly(tmp_path):
    """Each of the files named all others: of a thousand a megabyte of the same."""
    sources(tmp_path, *(f"{number}/arm" for number in range(40)))
    records = kinefab.batch([tmp_path / str(n) for n in range(40)], tmp_path / "out", jobs=1).records
    assert len(records) == 40
    for record in records:
        assert told(record, "BATCH_TARGET_SHARED", "and 36 more")
        assert len(re.findall(r"\d/arm\.bundle", record.messages[0])) == 3
        assert record.source not in record.messages[0]


def test_one_name_in_two_folders_is_written_from_neither(tmp_path):
    sources(tmp_path, "x/arm", "y/arm", "y/leg")
    records = kinefab.batch([tmp_path / "x", tmp_path / "y"], tmp_path / "out", jobs=1).records
    arms = [record for record in records if "arm" in record.source]
    assert len(arms) == 2 and all(told(arm, "BATCH_TARGET_SHARED", "arm") for arm in arms)
    assert all(arms[1 - i].source in arms[i].messages[0] for i in (0, 1))
    assert [r.outcome for r in records if "leg" in r.source] == [Outcome.WRITTEN]
    assert [path.name for path in (tmp_path / "out").glob("*.kinefab")] == ["leg.kinefab"]
    above = kinefab.batch([tmp_path], tmp_path / "out2", jobs=1)
    assert above.counts == {"written": 3}


def test_a_target_folder_within_the_sources_is_no_source(tmp_path):
    folder = sources(tmp_path / "in", "a", "deep/b")
    sources(folder, "out/earlier")
    first, second = (kinefab.batch([folder], folder / "out", jobs=1) for _ in range(2))
    assert first.counts == {"written": 2} and second.counts == {"up_to_date": 2}


def test_the_folder_of_the_sources_may_be_the_target_folder(tmp_path):
    folder = sources(tmp_path / "in", "a", "deep/b")
    first, second = (kinefab.batch([folder], folder, jobs=1) for _ in range(2))
    assert first.counts == {"written": 2} and second.counts == {"up_to_date": 2}
    assert (folder / "deep" / "b.kinefab").is_file()


@pytest.mark.parametrize("name", ["nothing/*.urdf", "empty"])
def test_an_input_without_a_source_is_not_success(tmp_path, name):
    (tmp_path / "empty").mkdir()
    result = kinefab.batch([sources(tmp_path / "in", "a"), tmp_path / name], tmp_path / "out", jobs=1)
    assert result.counts == {"written": 1, "failed": 1}
    assert told(result.records[0], "BATCH_INPUT_EMPTY", str(tmp_path / name))
    done = runner().invoke(app, ["batch", str(tmp_path / name), "-o", str(tmp_path / "out")])
    assert done.exit_code == 1 and "BATCH_INPUT_EMPTY" in done.stderr


def test_sources_that_cannot_be_read_cost_only_themselves(tmp_path):
    folder = sources(tmp_path / "in", "good")
    (folder / "gone.bundle.json").symlink_to(tmp_path / "nowhere.bundle.json")
    (folder / "empty.bundle.json").write_bytes(b"")
    (folder / "folder.bundle.json").mkdir()
    result = kinefab.batch([folder, folder / "folder.bundle.json"], tmp_path / "out", jobs=2)
    outcomes = {name: record.outcome.value for name, record in found(result).items()}
    assert outcomes == {"good": "written", "gone": "refused", "empty": "refused", "folder": "failed"}
    assert all(r.messages and ". " in r.messages[0] for r in result.records if not r.outcome.good)


@pytest.mark.skipif(
    not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may read and write everything"
)
def test_folders_without_rights_are_told(tmp_path):
    folder = sources(tmp_path / "in", "good", "shut/b")
    (folder / "shut").chmod(0)
    (tmp_path / "out").mkdir(mode=0o500)
    try:
        result = kinefab.batch([folder], tmp_path / "made", jobs=1)
        assert result.counts == {"written": 1, "failed": 1}
        assert told(result.records[0], "BATCH_IO", "shut", "Permission denied")
        with pytest.raises(KinefabError, match="TARGET_UNWRITABLE"):
            kinefab.batch([folder], tmp_path / "out")
    finally:
        (folder / "shut").chmod(0o700)


class Restless(Reading):
    """While a source is read, somebody writes to it: so many times."""

    def __init__(self, path: Path, times: int):
        super().__init__()
        self.path, self.times = path, times

    def add(self, path):
        super().add(path)
        if self.times and os.path.realpath(path) == os.path.realpath(self.path):
            self.times -= 1
            with self.path.open("a") as file:
                file.write("\n")


def test_a_source_that_changes_under_way_is_read_again_and_then_told(tmp_path):
    source = sources(tmp_path / "in", "a") / "a.bundle.json"
    job = Job(
        str(source),
        str(tmp_path / "out" / "a.kinefab"),
        str(tmp_path / "out" / ".kinefab-batch"),
        options_as_json(kinefab.ExportOptions()),
    )
    record = work(job, Restless(source, 1000))
    assert record.outcome is Outcome.FAILED and told(record, "BATCH_SOURCE_CHANGED", "a.bundle.json")
    assert work(job, Restless(source, 1)).outcome is Outcome.WRITTEN
    assert work(job, Reading()).outcome is Outcome.UP_TO_DATE


def test_a_run_that_ended_after_the_target_and_before_its_record_is_gone_on_with(tmp_path, monkeypatch):
    """The moment at which a kill would leave a target of which no record tells; also of an older one's record."""
    folder, out = sources(tmp_path / "in", "a"), tmp_path / "out"
    job = Job(
        str(folder / "a.bundle.json"),
        str(out / "a.kinefab"),
        str(out / ".kinefab-batch"),
        options_as_json(kinefab.ExportOptions(ground="world")),
    )

    class Killed(BaseException):
        pass

    def killed(*_):
        raise Killed

    assert kinefab.batch([folder], out, jobs=1).counts == {"written": 1}
    plain = (out / "a.kinefab").read_bytes()
    with monkeypatch.context() as patch, pytest.raises(Killed):
        patch.setattr("kinefab.batching.work.note", killed)
        work(job, Reading())
    assert (out / "a.kinefab").read_bytes() != plain
    assert kinefab.batch([folder], out, jobs=1).counts == {"written": 1}
    assert (out / "a.kinefab").read_bytes() == plain


def test_what_a_target_reads_of_its_own_is_no_source(tmp_path):
    """A prefab's folder holds a list of what is in it, which the next export reads and writes anew."""
    folder, out = sources(tmp_path / "in", "a"), tmp_path / "out"
    assert kinefab.batch([folder], out, "prefab", jobs=1).counts == {"written": 1}
    options = kinefab.ExportOptions(ground="world")
    assert kinefab.batch([folder], out, "prefab", options, jobs=1).counts == {"written": 1}
    assert kinefab.batch([folder], out, "prefab", options, jobs=1).counts == {"up_to_date": 1}


def test_a_target_that_was_cut_short_is_made_again(tmp_path):
    folder, out = sources(tmp_path / "in", "a"), tmp_path / "out"
    assert kinefab.batch([folder], out, jobs=1).counts == {"written": 1}
    whole = (out / "a.kinefab").read_bytes()
    (out / "a.kinefab").write_bytes(whole[:100])
    assert kinefab.batch([folder], out, jobs=1).counts == {"written": 1}
    assert (out / "a.kinefab").read_bytes() == whole


@pytest.mark.parametrize("source, target", [("IN", "nosuch://bucket/out"), ("nosuch://bucket/in", "OUT")])
def test_a_scheme_that_nothing_installed_reaches_is_told(tmp_path, source, target):
    pytest.importorskip("fsspec", reason="the Python package fsspec is not installed")
    places = {"IN": str(sources(tmp_path / "in", "a")), "OUT": str(tmp_path / "out")}
    with pytest.raises(KinefabError) as caught:
        kinefab.batch([places.get(source, source)], places.get(target, target))
    (finding,) = caught.value.diagnostics
    assert finding.code == "BATCH_LIBRARY_MISSING" and "nosuch" in str(finding)


def refused(address: str) -> str:
    with pytest.raises(KinefabError) as caught, clusters.executor_of(address):
        pass
    (finding,) = caught.value.diagnostics
    assert finding.code == "BATCH_SCHEDULER" and "dask scheduler" in finding.remedy
    return finding.message


def test_a_scheduler_that_is_not_there_or_no_address(monkeypatch):
    pytest.importorskip("distributed", reason="the Python package distributed is not installed")
    monkeypatch.setattr(clusters, "CONNECT_SECONDS", 1)
    from distributed import Client

    for address in (f"tcp://127.0.0.1:{free_port()}", "nonsense://here", "127.0.0.1"):
        assert address in refused(address) and "does not answer" in refused(address)
        assert not any(
            isinstance(thing, Client) for thing in gc.get_objects()
        )  # half of one would stop the next


def test_a_scheduler_without_workers(tmp_path):
    with dask(tmp_path, workers=0) as (address, _):
        assert "it has no workers" in refused(address)


@pytest.mark.filterwarnings("ignore:Mismatched versions found")
def test_a_scheduler_of_another_version(tmp_path):
    older = (
        "import importlib.metadata as m\nreal = m.version\n"
        "m.version = lambda name: '2020.1.0' if name == 'distributed' else real(name)"
    )
    with dask(tmp_path, workers=1, in_scheduler=older) as (address, _):
        assert "the scheduler has distributed 2020.1.0" in refused(address)


def test_workers_with_another_kinefab(tmp_path):
    older = "import kinefab\nkinefab.__version__ = '0.0.1'"
    with dask(tmp_path, workers=1, in_worker=older) as (address, _):
        assert "a worker has Kinefab 0.0.1" in refused(address)
