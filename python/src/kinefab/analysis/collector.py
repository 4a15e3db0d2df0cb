"""Python's search for cycles waits while much is made that stays."""

from __future__ import annotations

import gc
from collections.abc import Generator
from contextlib import contextmanager


@contextmanager
def collector_paused() -> Generator[None, None, None]:
    """Without Python's search for cycles: of what an export makes nearly all stays until its end, hundreds of thousands of
    small objects that each search would walk again for nothing."""
    running = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if running:
            gc.enable()
