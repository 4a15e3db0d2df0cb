"""The registry of source formats: options and libraries are asked for by the format, and told where they are not there."""

from __future__ import annotations

from pathlib import Path

import kinefab.sources as registry
import pytest
from kinefab.diagnostics import KinefabError, Report
from kinefab.sources import FORMATS, Format, read, source_options

LEVER = Path(__file__).resolve().parents[2] / "fixtures" / "lever" / "lever.bundle.json"


def test_an_option_that_the_format_does_not_have_is_told_and_left_out():
    report = Report()
    assert read(LEVER, report, options={"package_path": ["."]}).nodes
    (found,) = (d for d in report.diagnostics if d.code == "SOURCE_OPTION_UNUSED")
    assert "--package-path" in found.message and "CAD bundle" in found.message


def test_a_library_that_is_missing_is_named_with_the_extra_that_installs_it(monkeypatch, tmp_path):
    made = Format("Toy", (".toy",), "bundle.reader", requires=("no_such_library",), extra="toy")
    monkeypatch.setattr(registry, "FORMATS", (*FORMATS, made))
    with pytest.raises(KinefabError) as caught:
        read(tmp_path / "machine.toy", Report())
    (found,) = caught.value.diagnostics
    assert found.code == "SOURCE_LIBRARY_MISSING" and "kinefab[toy]" in found.remedy


def test_options_of_one_name_are_one():
    names = [option.name for option in source_options()]
    assert len(names) == len(set(names))
