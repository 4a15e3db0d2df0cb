"""Every public name, and every public attribute of a public class, has an example, and each does what it says."""

from __future__ import annotations

import doctest
import inspect

import kinefab
import pytest
import trimesh

NAMES = [name for name in kinefab.__all__ if name != "__version__"]


def bases_of(name: str) -> list[type]:
    """A class and those of ours that it stands on, none for a function."""
    value = getattr(kinefab, name)
    return [c for c in value.__mro__ if c.__module__.startswith("kinefab.")] if inspect.isclass(value) else []


def documented(name: str) -> set[str]:
    """The name and, of a class, its methods and properties."""
    attributes = [item for own in bases_of(name) for item in vars(own).items()]
    kinds = (classmethod, property, staticmethod)
    return {name} | {
        f"{name}.{own}"
        for own, what in attributes
        if not own.startswith("_") and (inspect.isfunction(what) or isinstance(what, kinds))
    }


@pytest.mark.parametrize("name", NAMES)
def test_the_example_of_a_public_name_runs(name, tmp_path, monkeypatch):
    """What a class's own example imports, those of its methods need not import again."""
    monkeypatch.chdir(tmp_path)
    finder, value = doctest.DocTestFinder(), getattr(kinefab, name)
    found = [test for own in bases_of(name) or [value] for test in finder.find(own, name) if test.examples]
    assert documented(name) <= {test.name for test in found}, f"kinefab.{name} is in part without an example"
    for test in found:
        test.globs = {} if test.name == name else {"kinefab": kinefab, "trimesh": trimesh}
        assert doctest.DocTestRunner(optionflags=doctest.ELLIPSIS).run(test).failed == 0
