"""How a batch scales: files a second of one process and of N, and what a scheduler costs a file.

    python python/bench/batch_bench.py [FILES] [JOBS]

Generated assemblies, no two alike, converted by one worker and by JOBS (two) in turn, twice each; the ratio of the rates is
over JOBS.  The overhead of handing out a file is measured with a task that does nothing, on 10,000 of them: in this process's
threads, and through a Dask scheduler with two workers on this machine where ``distributed`` is installed.
"""

from __future__ import annotations

import sys
import tempfile
import time
from concurrent.futures import Executor, ThreadPoolExecutor, wait
from pathlib import Path

import kinefab
from kinefab.batching.job import Job

EMPTY_TASKS = 10_000


def write_assembly(path: Path, number: int) -> None:
    """A chain of three parts on hinges, as long as its number says."""
    parts = [
        {"id": f"P{i}", "kind": "part", "grounded": i == 0,
         "pose": {"o": [0.1 * i + 1e-4 * number, 0, 0], "x": [1, 0, 0], "y": [0, 1, 0], "z": [0, 0, 1]}}
        for i in range(4)
    ]  # fmt: skip
    joints = [
        {"id": f"J{i}", "type": "revolute", "a": f"P{i}", "b": f"P{i + 1}",
         "frameA": {"in": "world", "o": [0.1 * i + 0.05, 0, 0], "z": [0, 0, 1], "x": [1, 0, 0]},
         "frameB": {"in": "world", "o": [0.1 * i + 0.05, 0, 0], "z": [0, 0, 1], "x": [1, 0, 0]}}
        for i in range(3)
    ]  # fmt: skip
    import json

    meta = {"format": "kinefab.bundle", "version": "1.0", "units": {"length": "m", "angle": "deg"}, "up": "Y"}
    path.write_text(json.dumps({"meta": meta, "components": parts, "joints": joints}), "utf-8")


def rate(folder: Path, out: Path, jobs: int, files: int) -> float:
    start = time.perf_counter()
    result = kinefab.batch([folder], out, jobs=jobs)
    assert result.counts == {"written": files}, result.counts
    return files / (time.perf_counter() - start)


def nothing(job: Job) -> str:
    return job.target


def overhead(executor: Executor) -> float:
    """Milliseconds a task."""
    jobs = [Job(f"in/{i}.urdf", f"out/{i}.kinefab", "out/ledger") for i in range(EMPTY_TASKS)]
    start = time.perf_counter()
    wait([executor.submit(nothing, job) for job in jobs])
    return 1e3 * (time.perf_counter() - start) / EMPTY_TASKS


def main(files: int = 200, jobs: int = 2) -> None:
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch) / "in"
        folder.mkdir()
        for i in range(files):
            write_assembly(folder / f"n{i:06}.bundle.json", i)
        ratios: list[float] = []
        for turn in range(2):
            one = rate(folder, Path(scratch) / f"one{turn}", 1, files)
            many = rate(folder, Path(scratch) / f"many{turn}", jobs, files)
            ratios.append(many / one / jobs)
            print(
                f"{files} files: 1 worker {one:.1f} files/s, {jobs} workers {many:.1f} files/s, {ratios[-1]:.2f} x {jobs}"
            )
        start = time.perf_counter()
        kinefab.batch([folder], Path(scratch) / "one0", jobs=jobs)
        print(f"all up to date: {1e3 * (time.perf_counter() - start) / files:.2f} ms a file")
    with ThreadPoolExecutor(jobs) as executor:
        print(f"handing out, threads: {overhead(executor):.3f} ms a file")
    try:
        from distributed import Client, LocalCluster
    except ImportError:
        print("handing out, Dask: distributed is not installed")
        return
    with (
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        Client(cluster) as client,
    ):
        cost = overhead(client.get_executor(pure=False))
        print(f"handing out, Dask: {cost:.3f} ms a file, {cost * 100:.0f} s for 100,000")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
