"""Tests of what only some systems have (links, pipes, locks) are left out on the others, at collection: a skip
stands for something that is missing and could be there."""

from __future__ import annotations

import os
import sys

import pytest

# Before anything imports numpy, and as the command line does: its threads wait for each other by spinning, which beside
# other work costs several times what they save.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

ELSEWHERE = {"posix": sys.platform == "win32", "linux": sys.platform != "linux"}
"""Markers of such tests, and whether this system is another."""


FEW = 400
"""Mutated files that a run tries of each format; ``--fuzz 5000`` tries more."""


def pytest_addoption(parser):
    parser.addoption("--fuzz", type=int, default=FEW, help="mutated files tried of each format")


@pytest.fixture()
def fuzz_count(request) -> int:
    return request.config.getoption("--fuzz")


def pytest_configure(config):
    for name in ELSEWHERE:
        config.addinivalue_line("markers", f"{name}: left out on other systems")


def pytest_collection_modifyitems(config, items):
    left_out = [item for item in items if any(ELSEWHERE.get(mark.name) for mark in item.iter_markers())]
    config.hook.pytest_deselected(items=left_out)
    items[:] = [item for item in items if item not in left_out]
