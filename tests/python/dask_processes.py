"""A Dask scheduler and its workers, as processes of their own."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

START = "import sys\n{before}\nfrom distributed.cli.dask_{part} import main\nsys.argv[0] = 'dask'\nmain()"


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def demand_answer(port: int, seconds: float = 60.0) -> None:
    end = time.monotonic() + seconds
    while True:
        try:
            socket.create_connection(("127.0.0.1", port), timeout=1.0).close()
            return
        except OSError:
            if time.monotonic() > end:
                raise
            time.sleep(0.05)


@contextmanager
def dask(
    folder: Path, workers: int = 2, in_scheduler: str = "", in_worker: str = ""
) -> Iterator[tuple[str, list[subprocess.Popen]]]:
    """(address, workers) of a scheduler.  in_scheduler, in_worker: Python that runs in the process before Dask does."""
    pytest.importorskip("distributed", reason="the Python package distributed is not installed")
    port = free_port()
    address = f"tcp://127.0.0.1:{port}"
    parts: list[subprocess.Popen] = []

    def start(part: str, before: str, *arguments: str) -> None:
        parts.append(
            subprocess.Popen(
                [
                    sys.executable,
                    "-c",
                    START.format(before=before, part=part),
                    *arguments,
                    "--host",
                    "127.0.0.1",
                ],
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                cwd=folder,
                env=dict(os.environ),
            )
        )

    try:
        start("scheduler", in_scheduler, "--port", str(port), "--no-dashboard")
        for i in range(workers):
            start(
                "worker",
                in_worker,
                address,
                "--nthreads",
                "1",
                "--no-nanny",
                "--no-dashboard",
                "--name",
                f"w{i}",
            )
        demand_answer(port)
        if workers:
            from distributed import Client

            with Client(address, timeout=60, set_as_default=False) as client:
                client.wait_for_workers(workers, timeout=60)
        yield address, parts[1:]
    finally:
        for part in parts:
            part.kill()
            part.wait()


@pytest.fixture
def cluster(tmp_path):
    """A scheduler and two workers: (address, workers)."""
    with dask(tmp_path) as found:
        yield found
