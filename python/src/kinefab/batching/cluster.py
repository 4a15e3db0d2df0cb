"""Dask's scheduler as the one that hands out the work."""

from __future__ import annotations

import gc
import warnings
from collections.abc import Generator
from concurrent.futures import Executor
from contextlib import contextmanager
from typing import Any, cast

from ..diagnostics import KinefabError, diagnostic
from ..extras import install

CONNECT_SECONDS = 10
TRIES = 3
"""Workers that one file may outlive before it is given up."""


@contextmanager
def executor_of(scheduler: str | None) -> Generator[Executor | None, None, None]:
    """The workers of a Dask scheduler as an executor; None for none.

    scheduler: its address, ``tcp://host:port``.  A worker that dies loses nothing: its files go to others.
    Raises KinefabError where it is not there, of another version, has no workers, or Dask is not installed.
    """
    if scheduler is None:
        yield None
        return
    try:
        from distributed import Client
    except ImportError:
        told = f"the Python package distributed is not installed ({install('cluster')})"
        raise _unusable(scheduler, told) from None
    client, detail = None, ""
    try:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", "Mismatched versions", Warning)  # an error below
            client = Client(scheduler, timeout=CONNECT_SECONDS, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        detail = f"it does not answer ({type(error).__name__})"
    if client is None:
        # Half a client closes itself when it is collected; were that while the next one starts, both would wait for ever
        # for one lock of distributed's.
        gc.collect()
        raise _unusable(scheduler, detail)
    with client:
        if not client.scheduler_info()["workers"]:
            raise _unusable(scheduler, "it has no workers")
        if other := _other_version(cast("Any", client)):
            raise _unusable(scheduler, other)
        yield cast("Any", client).get_executor(pure=False, retries=TRIES)


def _unusable(scheduler: str, detail: str) -> KinefabError:
    return KinefabError([diagnostic("BATCH_SCHEDULER", scheduler=scheduler, detail=detail)])


def _other_version(client: Any) -> str:
    """What the scheduler or a worker has in another version than this process, "" where all have the same.

    Dask itself only warns, and a file that a worker of another Kinefab converts would not be what one converts here.
    """
    found = client.get_versions()
    own, scheduler = found["client"]["packages"], found["scheduler"]["packages"]
    named = [("the scheduler", scheduler), *(("a worker", w["packages"]) for w in found["workers"].values())]
    for who, packages in named:
        if packages["distributed"] != own["distributed"]:
            return f"{who} has distributed {packages['distributed']}, and this is {own['distributed']}"
    for who, packages in named[1:]:
        theirs, ours = (".".join(p["python"].split(".")[:2]) for p in (packages, own))
        if theirs != ours:
            return f"{who} has Python {theirs}, and this is {ours}"
    try:
        versions = client.run(version_there)
    except Exception as error:  # whatever its import of Kinefab ends with
        return f"a worker cannot use Kinefab ({type(error).__name__}: {error})"
    others = sorted({version for version in versions.values() if version != version_there()})
    return f"a worker has Kinefab {others[0]}, and this is {version_there()}" if others else ""


def version_there() -> str:
    """Kinefab's version where this is called."""
    import kinefab

    return kinefab.__version__
