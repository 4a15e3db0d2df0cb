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


def test_a_library_that_is_missing_is_named_with_what_installs_it(monkeypatch, tmp_path):
    made = Format("Toy", (".toy",), "bundle.reader", requires=("no_such_library",), extra="urdf")
    monkeypatch.setattr(registry, "FORMATS", (*FORMATS, made))
    (tmp_path / "machine.toy").touch()
    with pytest.raises(KinefabError) as caught:
        read(tmp_path / "machine.toy", Report())
    (found,) = caught.value.diagnostics
    assert found.code == "SOURCE_LIBRARY_MISSING" and found.remedy == "Install it: pip install xacro pycollada."


def test_of_an_option_whose_words_differ_the_word_is_told():
    """--ground world is for every format, --ground PART for those whose mates are found: a misspelt word is told as what it is."""
    report = Report()
    assert read(LEVER, report, options={"ground": "wrold", "up": "Z", "floating_base": True}).nodes
    told = [d.message.partition(" means")[0] for d in report.diagnostics if d.code == "SOURCE_OPTION_UNUSED"]
    assert told == ["--floating-base", "--ground wrold", "--up Z"]


def test_options_of_one_name_are_one():
    names = [option.name for option in source_options()]
    assert len(names) == len(set(names))


@pytest.mark.parametrize(
    "source, asked, told",
    [
        ("lever.step", {"up": "z"}, "up is 'z'; pass one of: X, Y, Z"),
        ("lever.usda", {"load": "nothing"}, "load is 'nothing'; pass one of: all, none"),
        ("lever.usda", {"purpose": ["proxy", "x"]}, "purpose is 'x'; pass one of: proxy, guide"),
        ("lever.urdf", {"floating_base": "no"}, "floating_base is 'no'; pass True or False"),
        ("lever.urdf", {"package_path": 3}, "package_path is 3; pass one of its values, or a list of them"),
    ],
)
def test_a_value_that_an_option_cannot_have_is_a_wrong_call(source, asked, told, monkeypatch):
    """The command line refuses it by itself; a script saw it passed over, taken for a yes, or a traceback."""
    monkeypatch.setattr(registry, "find_spec", lambda name: True)
    with pytest.raises((TypeError, ValueError)) as refused:
        read(LEVER.parent / source, Report(), options=asked)
    assert str(refused.value) == told


def test_an_open_stage_s_options_are_held_to_their_words():
    usd = pytest.importorskip("pxr.Usd", reason="usd-core is not installed")
    with pytest.raises(ValueError, match="load is 'some'; pass one of: all, none"):
        registry.read_stage(usd.Stage.CreateInMemory(), Report(), {"load": "some"})


def test_one_value_of_an_option_that_may_have_several_is_the_only_one():
    asked = {"purpose": "proxy", "variant": "a=b"}
    for option in source_options():
        option.check(asked.get(option.name))


SNIFFED = sorted({ending for entry in FORMATS if entry.sniffed for ending in entry.suffixes})


def refused(path: Path):
    with pytest.raises(KinefabError) as caught:
        read(path, Report())
    (found,) = caught.value.diagnostics
    return found


@pytest.mark.parametrize("ending", SNIFFED)
@pytest.mark.parametrize("content", ["", "  \n"], ids=["empty", "blank"])
def test_a_file_without_content_is_told_as_that_whatever_it_might_have_been(tmp_path, ending, content):
    """It was said to be of no known format, and its own ending to be one that is."""
    path = tmp_path / f"a{ending}"
    path.write_text(content, encoding="utf-8")
    assert refused(path).code == "SOURCE_EMPTY"
    path.unlink()
    assert refused(path).code == "SOURCE_NOT_FOUND"
    path.mkdir()
    assert refused(path).code == "SOURCE_IS_FOLDER"


@pytest.mark.parametrize(
    "name, formats", [("a.sdf", "SDF"), ("a.xml", "Simscape Multibody XML, MJCF"), ("a.mjcf", "MJCF")]
)
def test_of_a_known_ending_it_is_the_content_that_no_reader_knows(tmp_path, name, formats):
    (tmp_path / name).write_text("no markup", encoding="utf-8")
    found = refused(tmp_path / name)
    assert found.code == "SOURCE_FORMAT_UNKNOWN" and f"its content is none of {formats}." in found.message
    assert "Give one of" not in found.remedy
