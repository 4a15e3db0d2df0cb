"""Every public name has an example, and each does what it says."""

from __future__ import annotations

import doctest

import kinefab
import pytest

NAMES = [name for name in kinefab.__all__ if name != "__version__"]


@pytest.mark.parametrize("name", NAMES)
def test_the_example_of_a_public_name_runs(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    found = [test for test in doctest.DocTestFinder().find(getattr(kinefab, name), name) if test.examples]
    assert name in {test.name for test in found}, f"the docstring of kinefab.{name} has no example"
    for test in found:
        test.globs = {}
        assert doctest.DocTestRunner(optionflags=doctest.ELLIPSIS).run(test).failed == 0
