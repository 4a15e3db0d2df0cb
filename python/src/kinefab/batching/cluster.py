"""Dask's scheduler as the one that hands out the work."""

from __future__ import annotations

from collections.abc import Generator
from concurrent.futures import Executor
from contextlib import contextmanager
from typing import Any, cast

from ..diagnostics import KinefabError, diagnostic

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
        detail = "the Python package distributed is not installed (pip install 'kinefab[cluster]')"
        raise KinefabError([diagnostic("BATCH_SCHEDULER", scheduler=scheduler, detail=detail)]) from None
    try:
        client = Client(scheduler, timeout=CONNECT_SECONDS, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        detail = f"it does not answer ({type(error).__name__})"
        raise KinefabError([diagnostic("BATCH_SCHEDULER", scheduler=scheduler, detail=detail)]) from None
    with client:
        try:
            client.get_versions(check=True)
        except ValueError as error:
            detail = f"it or a worker has other versions: {' '.join(str(error).split())[:300]}"
            raise KinefabError([diagnostic("BATCH_SCHEDULER", scheduler=scheduler, detail=detail)]) from None
        if not client.scheduler_info()["workers"]:
            raise KinefabError(
                [diagnostic("BATCH_SCHEDULER", scheduler=scheduler, detail="it has no workers")]
            )
        yield cast("Any", client).get_executor(pure=False, retries=TRIES)
