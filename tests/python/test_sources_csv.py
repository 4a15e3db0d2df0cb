"""The tagged CSV form: the same scene as the JSON, however a Windows in some language wrote it."""

from __future__ import annotations

import codecs
import re
from dataclasses import fields, is_dataclass

import numpy as np
import pytest
from kinefab import sources
from kinefab.diagnostics import KinefabError, Report
from kinefab.model import Source
from source_bundles import FIXTURES, codes

TAGGED = FIXTURES / "lever" / "lever.csv"


def plain(value):
    """A scene as nested lists, without places (a line here, a pointer there) and without the file's own
    name."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, Source):
        return [value.up_axis, value.meters_per_unit]
    if is_dataclass(value):
        return [plain(getattr(value, f.name)) for f in fields(value) if f.name not in ("where", "path")]
    return [plain(entry) for entry in value] if isinstance(value, (list, tuple)) else value


@pytest.fixture(scope="module")
def from_json():
    return plain(sources.read(FIXTURES / "lever" / "lever.bundle.json", Report()))


def scene_of(content: bytes, folder, name="lever.csv"):
    path = folder / name
    path.write_bytes(content)
    report = Report()
    return sources.read(path, report), report


def with_commas(text: str) -> str:
    """Decimal points as commas, in number cells only: a macro writes the version as a text."""
    meta, records = text.split("MAT;", 1)
    return meta + re.sub(r"(?<=;)(-?\d+)\.(\d+)(?=;|\n)", r"\1,\2", "MAT;" + records)


def test_tagged_csv_gives_the_scene_of_the_json(from_json):
    """The fixture in both forms is one scene, number for number."""
    report = Report()
    scene = sources.read(TAGGED, report)
    assert report.diagnostics == []
    assert plain(scene) == from_json


@pytest.mark.parametrize(
    "written",
    [
        lambda text: with_commas(text).encode("cp1252"),
        lambda text: text.replace("\n", "\r\n").encode("utf-8-sig"),
        lambda text: text.replace(";", "\t").encode("utf-8"),
        lambda text: text.replace(";", ",").encode("utf-8"),
        lambda text: re.sub(r"(?m)(?<=;)([A-Za-z][^;\n]*)", r'"\1"', text).encode("utf-8"),
        lambda text: text.replace("true", "Wahr").encode("cp1252"),
        lambda text: with_commas(text).replace(";", "\t").replace("\n", "\r\n").encode("utf-16"),
        lambda text: codecs.BOM_UTF16_BE + text.encode("utf-16-be"),
        lambda text: ("sep=;\r\n" + text.replace("\n", "\r\n")).encode("utf-8-sig"),
        lambda text: f'"sep=,";;;\n{text.replace(";", ",")}'.encode("cp1252"),
        lambda text: f"SEP=~\n{text.replace(';', '~')}".encode(),
    ],
    ids=[
        "decimal-comma",
        "crlf-bom",
        "tab",
        "comma",
        "quoted",
        "german-booleans",
        "excel-unicode-text",
        "utf-16-be",
        "stated-delimiter",
        "stated-delimiter-quoted",
        "stated-delimiter-of-its-own",
    ],
)
def test_tagged_csv_reads_as_any_windows_writes_it(tmp_path, from_json, written):
    """Delimiter, decimal sign, byte order mark, line ends, quotes and Boolean words change nothing."""
    content = written(TAGGED.read_text(encoding="utf-8"))
    scene, report = scene_of(content, tmp_path)
    assert report.diagnostics == []
    assert plain(scene) == from_json


def test_a_line_below_a_stated_delimiter_keeps_its_number(tmp_path):
    """``sep=;`` is Excel's line and no record, but it is a line of the file."""
    text = "sep=;\n" + TAGGED.read_text(encoding="utf-8") + "NONSENSE;1\n"
    _, report = scene_of(text.encode(), tmp_path)
    assert [(found.code, found.where) for found in report.diagnostics] == [
        ("CSV_TAG_UNKNOWN", f"lever.csv:{text.count(chr(10))}")
    ]


def test_cp1252_names_survive(tmp_path):
    """A German part name comes through both encodings."""
    text = TAGGED.read_text(encoding="utf-8").replace("BarC:1;BarC:1", "BarC:1;Hebelstück:1")
    for encoding in ("cp1252", "utf-8-sig"):
        scene, _ = scene_of(text.encode(encoding), tmp_path)
        assert any(node.name == "Hebelstück:1" for node in scene.nodes)


def test_csv_faults_name_their_line(tmp_path):
    """A finding about a record points to the line it stands in, not into a structure the user never saw."""
    lines = TAGGED.read_text(encoding="utf-8").splitlines()
    at = next(i for i, line in enumerate(lines) if line.startswith("JOINT;Joint:Pin"))
    lines[at] = lines[at].replace("revolute;Lever/Crank:1/PanelB:1", "revolute;Lever/Nowhere:1")
    path = tmp_path / "lever.csv"
    path.write_text("\n".join(lines), encoding="utf-8")
    report = Report()
    with pytest.raises(KinefabError):
        sources.read(path, report)
    assert codes(report) == ["COMPONENT_UNKNOWN"]
    assert report.diagnostics[0].where == f"lever.csv:{at + 1}"


def test_mass_and_couplings_and_materials_map_one_to_one(tmp_path):
    """MASS, COUP and MAT lines say what the JSON fields of the same names say."""
    text = """META;format;kinefab.bundle
META;version;1.0
META;units.length;mm
META;units.angle;deg
META;units.mass;g
META;up;Y
META;mesh.files;w.obj
META;mesh.units;mm
META;mesh.coordinates;part
MAT;Steel;7850;0,1;0,2;0,3;1
COMP;A;A;part;;;0;0;0;1;0;0;0;1;0;0;0;1
BODY;A;1;Wheel;;Steel
MASS;A;500;part;1;2;3;100;200;250;0;0;0
COMP;B;B;part;;;0;0;0;1;0;0;0;1;0;0;0;1
JOINT;JA;;revolute;ground;A;world;0;0;0;0;0;1;1;0;0
JOINT;JB;;revolute;ground;B;world;0;0;0;0;0;1;1;0;0
COUP;G;;gear;JA;rz;JB;rz;;;;20;50
"""
    scene, report = scene_of(text.encode(), tmp_path)
    assert report.diagnostics == []
    assert scene.couplings[0].terms[0].ratio == pytest.approx(-0.4)
    assert scene.nodes[0].mass.mass == pytest.approx(0.5)
    assert scene.nodes[0].mass.center == pytest.approx([0.001, 0.002, 0.003])
    assert np.diag(scene.nodes[0].mass.inertia) == pytest.approx([1e-7, 2e-7, 2.5e-7])
    assert scene.surfaces[0].color == (0.1, 0.2, 0.3, 1.0)
    assert scene.nodes[0].bodies[0].density == 7850.0
