"""STEP and IGES: what a file states besides shapes and places: densities, colours of single occurrences, subfigures."""

from __future__ import annotations

import re
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from kinefab.diagnostics import Report
from kinefab.model import Scene
from kinefab.sources import read
from kinefab.sources.step.entities import parsed

pytest.importorskip("OCP", reason="OpenCASCADE is not installed: pip install cadquery-ocp-novtk")

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "fixtures"))

from kinefab.sources.step.xcaf import _children, _name  # noqa: E402
from OCP.Quantity import Quantity_Color, Quantity_TOC_sRGB  # noqa: E402
from OCP.STEPCAFControl import STEPCAFControl_Writer  # noqa: E402
from OCP.STEPControl import STEPControl_StepModelType  # noqa: E402
from OCP.TDF import TDF_Label  # noqa: E402
from OCP.TopLoc import TopLoc_Location  # noqa: E402
from OCP.XCAFDoc import XCAFDoc_ColorType, XCAFDoc_DocumentTool, XCAFDoc_ShapeTool  # noqa: E402
from step.machine import Machine  # noqa: E402
from step.solids import box  # noqa: E402
from step.writer import document_of, write_iges, write_step  # noqa: E402


def read_whole(path: Path) -> tuple[Scene, Report]:
    report = Report()
    return read(path, report), report


def density(value: str, unit: str, kind: str = "density", of: str = "PRODUCT_DEFINITION(") -> str:
    """The entities of a density of the product ``Arm``.  unit: mass, exponent, length, exponent, comma between."""
    mass, power, length, other = unit.split(",")
    return (
        f"#9001={mass};\n#9002={length};\n#9003=DERIVED_UNIT_ELEMENT(#9001,{power});\n"
        f"#9004=DERIVED_UNIT_ELEMENT(#9002,{other});\n#9005=DERIVED_UNIT((#9003,#9004));\n"
        f"#9006=MEASURE_REPRESENTATION_ITEM('density measure',POSITIVE_RATIO_MEASURE({value}),#9005);\n"
        f"#9007=REPRESENTATION('density',(#9006),$);\n#9008=PROPERTY_DEFINITION('material property','{kind}',{of}#0);\n"
        "#9009=PROPERTY_DEFINITION_REPRESENTATION(#9008,#9007);\n"
        "#9020=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.));\n"
        "#9021=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(0.0508),#9020);\n"
        "#9022=(MASS_UNIT()NAMED_UNIT(*)SI_UNIT(.KILO.,.GRAM.));\n"
        "#9023=MASS_MEASURE_WITH_UNIT(MASS_MEASURE(0.45),#9022);\n"
        "#9024=DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);\n"
    )


GRAM = "(MASS_UNIT()NAMED_UNIT(*)SI_UNIT($/.GRAM.))"
KILOGRAM = GRAM.replace("$", ".KILO.")
CENTIMETRE = "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.CENTI./.METRE.))"
METRE = CENTIMETRE.replace(".CENTI.", "$")
POUND = "(CONVERSION_BASED_UNIT('my pound'/#9023)MASS_UNIT()NAMED_UNIT(#9024))"
HAND = "(CONVERSION_BASED_UNIT('double inch'/#9021)LENGTH_UNIT()NAMED_UNIT(#9024))"


def arm(folder: Path, stated: str) -> Path:
    """An arm and a plate; stated: as ``density`` writes it, a slash where a unit has a comma."""
    machine = Machine("Top")
    machine.add("Arm:1", box((0.0, 0.0, 0.0), (20.0, 5.0, 6.0)), product="Wälzarm")
    machine.add("Arm:2", box((0.0, 0.0, 0.0), (20.0, 5.0, 6.0)), (0.0, 30.0, 0.0), product="Wälzarm")
    machine.add("Plate", box((0.0, 0.0, 0.0), (9.0, 8.0, 7.0)))
    path = folder / "arm.step"
    write_step(machine, path)
    text = path.read_text("utf-8")
    product = next(line for line in text.splitlines() if " PRODUCT('W" in line).split(" ")[0]
    formation = next(
        line for line in text.splitlines() if f"PRODUCT_DEFINITION_FORMATION('','',{product})" in line
    )
    definition = next(
        line
        for line in text.splitlines()
        if f"PRODUCT_DEFINITION('design','',{formation.split(' ')[0]}," in line
    )
    stated = stated.replace("PRODUCT_DEFINITION(#0", definition.split(" ")[0]).replace("#0", product)
    path.write_text(text.replace("DATA;\n", "DATA;\n" + stated.replace("/", ","), 1), "utf-8")
    return path


@pytest.mark.parametrize(
    "value, unit, expected",
    [
        ("2.71", f"{GRAM},1.,{CENTIMETRE},-3.", 2710.0),
        ("7830.", f"{KILOGRAM},1.,{METRE},-3.", 7830.0),
        ("2.71", f"{GRAM},3.,{CENTIMETRE},2.", 2710.0),  # as OpenCASCADE writes it
        ("1.07", f"{GRAM},0.,{CENTIMETRE},0.", 1070.0),  # as Autodesk writes it
        ("1.", f"{POUND},1.,{HAND},-3.", 0.45 / 0.0508**3),
        (
            "0.5",
            f"{POUND.replace('my pound', 'pound')},1.,{HAND.replace('double inch', 'INCH')},-3.",
            0.45359237 / 2 / 0.0254**3,
        ),
    ],
)
@pytest.mark.parametrize("kind", ["density", "density of part"])
def test_the_density_of_a_product_is_that_of_its_bodies(tmp_path, value, unit, expected, kind):
    scene, report = read_whole(arm(tmp_path, density(value, unit, kind)))
    assert not report.diagnostics
    given = [body.density for node in scene.nodes for body in node.bodies]
    assert given == [pytest.approx(expected, rel=1e-11)] * 2 + [None]


@pytest.mark.parametrize(
    "stated, reason",
    [
        (density("7.8", f"{GRAM},1.,{GRAM},-3."), "not a mass and a length"),
        (density("-7.8", f"{GRAM},1.,{METRE},-3."), "it is -7.8"),
        (density("7.8", f"{GRAM},1.,(TIME_UNIT()NAMED_UNIT(*)SI_UNIT($/.SECOND.)),-3."), "not a mass and a length"),
        (density("7.8", f"{GRAM},1.,{METRE},-3.", of=""), "of no product"),
        (density("7.8", f"{GRAM},1.,{METRE},-3.").replace("(#9006)", "(#9006/#9010)")
         + "#9010=MEASURE_REPRESENTATION_ITEM('density measure',POSITIVE_RATIO_MEASURE(3.),#9005);\n", "it has several"),
    ],
)  # fmt: skip
def test_a_density_that_cannot_be_read_is_told(tmp_path, stated, reason):
    scene, report = read_whole(arm(tmp_path, stated))
    assert [d.code for d in report.diagnostics] == ["STEP_DENSITY"]
    assert reason in report.diagnostics[0].message
    assert not any(body.density for node in scene.nodes for body in node.bodies)
    assert [o.outcome.value for o in report.outcomes] == ["dropped"]


@pytest.mark.parametrize(
    "written, read_as",
    [
        (rb"W\X2\00E4\X0\lz", "Wälz"),
        ("Wälz".encode(), "Wälz"),
        (rb"\X\E4\S\d\\n", "ää\\n"),
        (rb"\X4\0001F600\X0\ ", "😀 "),
        (rb"\X2\D83D\X0\ ", "\\X2\\D83D\\X0\\ "),
    ],
)
def test_texts_read_as_they_were_meant(written: bytes, read_as: str):
    assert parsed(b"PRODUCT('" + written + b"')") == {"PRODUCT": [read_as]}


def styled(folder: Path) -> Path:
    """Cell: Unit twice, in it a pin twice; the second pin of the second unit is red, the pins are green."""
    machine = Machine("Unit")
    pin = box((0.0, 0.0, 0.0), (1.0, 2.0, 3.0))
    for i in (1, 2):
        machine.add(f"Pin:{i}", pin, (10.0 * i, 0.0, 0.0), product="Pin", color=(0.0, 1.0, 0.0))
    document = document_of(machine)
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    unit = next(label for label in _children(shapes.BaseLabel()) if _name(label) == "Unit")
    cell = shapes.NewShape()
    uses = [shapes.AddComponent(cell, unit, _shift(50.0 * i)) for i in (1, 2)]
    shapes.UpdateAssemblies()
    second = [label for label in _children(unit) if XCAFDoc_ShapeTool.IsComponent_s(label)][1]
    _paint(document, [uses[1], second], (1.0, 0.0, 0.0))
    writer = STEPCAFControl_Writer()
    writer.SetColorMode(True)
    writer.SetNameMode(True)
    writer.SetSHUOMode(True)
    writer.Transfer(document, STEPControl_StepModelType.STEPControl_AsIs)
    writer.Write(str(folder / "styled.step"))
    return folder / "styled.step"


def _shift(y: float) -> TopLoc_Location:
    from OCP.gp import gp_Trsf, gp_Vec

    trsf = gp_Trsf()
    trsf.SetTranslation(gp_Vec(0.0, y, 0.0))
    return TopLoc_Location(trsf)


def _paint(document: Any, path: Sequence[Any], color: tuple[float, float, float]) -> None:
    location, product = TopLoc_Location(), TDF_Label()
    for label in path:
        location = location.Multiplied(XCAFDoc_ShapeTool.GetLocation_s(label))
    XCAFDoc_ShapeTool.GetReferredShape_s(path[-1], product)
    assert XCAFDoc_DocumentTool.ColorTool_s(document.Main()).SetInstanceColor(
        XCAFDoc_ShapeTool.GetShape_s(product).Located(location),
        XCAFDoc_ColorType.XCAFDoc_ColorSurf,
        Quantity_Color(*color, Quantity_TOC_sRGB),
    )


def colors(scene: Scene) -> list[str]:
    return [scene.surfaces[body.surfaces[0]].name for node in scene.nodes for body in node.bodies]


def test_a_colour_of_one_occurrence_in_one_sub_assembly_is_its_alone(tmp_path: Path):
    scene, report = read_whole(styled(tmp_path))
    assert not report.diagnostics
    assert colors(scene) == ["#00FF00", "#00FF00", "#00FF00", "#FF0000"]


def test_a_colour_by_context_is_told(tmp_path: Path):
    path = styled(tmp_path)
    text = path.read_text("utf-8")
    place = re.search(r"#(\d+) = \( REPRESENTATION_RELATIONSHIP\(", text)
    assert place is not None
    text, styles = re.subn(
        r"= OVER_RIDING(_STYLED_ITEM\([^;]*)\);", rf"= CONTEXT_DEPENDENT_OVER_RIDING\1,(#{place[1]}));", text
    )
    text, assigned = re.subn(
        r"PRESENTATION_STYLE_BY_CONTEXT\((\(#\d+\)),#\d+\)", r"PRESENTATION_STYLE_ASSIGNMENT(\1)", text
    )
    assert styles == assigned == 1
    path.write_text(text, "utf-8")
    scene, report = read_whole(path)
    assert [d.code for d in report.diagnostics] == ["STEP_COLOR_CONTEXT"]
    assert colors(scene) == ["#00FF00"] * 4


class Iges:
    """An IGES file with one box of 10 x 20 x 30 mm, to which entities are added."""

    def __init__(self, folder: Path) -> None:
        machine = Machine("Top")
        machine.add("A", box((0.0, 0.0, 0.0), (10.0, 20.0, 30.0)))
        self.path = folder / "figures.igs"
        write_iges(machine, self.path)
        lines = self.path.read_text("latin-1").splitlines()
        self._sections = {name: [line[:72] for line in lines if line[72] == name] for name in "SGDP"}
        entries = self._sections["D"]
        solid = next(i for i in range(0, len(entries), 2) if entries[i].startswith("     186"))
        entries[solid] = entries[solid][:64] + "00010000"
        self.bolt = self.add(308, "0,4HBolt,1", solid + 1, status="00000200")

    def add(
        self, kind: int, *values: object, status: str = "00000000", matrix: int = 0, form: int = 0
    ) -> int:
        """The entity's number in the directory.  status: 00010000 where it stands in another one alone."""
        entries, rows = self._sections["D"], self._sections["P"]
        number = len(entries) + 1
        text = ",".join(map(str, (kind, *values))) + ";"
        entries.append(f"{kind:>8}{len(rows) + 1:>8}{0:>8}{1:>8}{0:>8}{0:>8}{matrix:>8}{0:>8}{status:>8}")
        entries.append(f"{kind:>8}{0:>8}{0:>8}{-(-len(text) // 64):>8}{form:>8}{'':>24}{0:>8}")
        rows += [f"{text[i : i + 64]:<64}{number:>8}" for i in range(0, len(text), 64)]
        return number

    def read(self) -> tuple[Scene, Report]:
        lines = [
            f"{line:<72}{name}{i:>7}" for name, own in self._sections.items() for i, line in enumerate(own, 1)
        ]
        counts = "".join(f"{name}{len(own):>7}" for name, own in self._sections.items())
        self.path.write_text("\n".join([*lines, f"{counts:<72}T{1:>7}"]) + "\n", "latin-1")
        return read_whole(self.path)


def boxes(scene: Scene) -> dict[str, list[float]]:
    """Corners in the file's axes, millimetres; the axes of the scene are X, Z, -Y."""
    found = {}
    for node in scene.nodes:
        for body in node.bodies:
            assert body.mesh is not None
            x, z, y = (
                scene.meshes[body.mesh].vertices @ node.pose.rotation.T + node.pose.translation
            ).T * 1e3
            found[node.id] = [round(float(v), 6) for a in (x, -y, z) for v in (a.min(), a.max())]
    return found


def test_subfigures_within_subfigures_stand_where_freecad_has_them(tmp_path: Path):
    file = Iges(tmp_path)
    inner = [
        file.add(408, file.bolt, *at, "1.", status="00010000")
        for at in (("100.", "20.", "5."), ("-50.", "0.", "0."))
    ]
    unit = file.add(308, "1,4HUnit,2", *inner, status="00000200")
    file.add(408, unit, "0.,0.,0.,1.")
    file.add(408, unit, "0.,0.,300.,1.")
    scene, report = file.read()
    assert not report.diagnostics
    assert boxes(scene) == {
        "Top": [0, 10, 0, 20, 0, 30],
        "Unit/Bolt": [100, 110, 20, 40, 5, 35],
        "Unit/Bolt:2": [-50, -40, 0, 20, 0, 30],
        "Unit:2/Bolt": [100, 110, 20, 40, 305, 335],
        "Unit:2/Bolt:2": [-50, -40, 0, 20, 300, 330],
    }
    first, second = (next(n for n in scene.nodes if n.id == name) for name in ("Unit/Bolt", "Unit:2/Bolt:2"))
    assert first.bodies[0].mesh == second.bodies[0].mesh and first.definition == second.definition == "Bolt"


def test_a_turned_subfigure_stands_where_freecad_has_it(tmp_path: Path):
    """Its matrix acts first, its own translation after that: both OpenCASCADE and FreeCAD read an instance so."""
    file = Iges(tmp_path)
    turn = file.add(124, "0.,-1.,0.,7.,1.,0.,0.,8.,0.,0.,1.,9.")
    file.add(408, file.bolt, "100.,20.,5.,1.", matrix=turn)
    scene, report = file.read()
    assert not report.diagnostics
    assert boxes(scene)["Bolt"] == [87, 107, 28, 38, 14, 44]


def test_a_scaled_and_a_mirrored_subfigure_have_meshes_of_their_own(tmp_path: Path):
    file = Iges(tmp_path)
    file.add(408, file.bolt, "100.,20.,5.,2.5")
    file.add(408, file.bolt, "-50.,0.,0.,1.")
    down = file.add(124, "1.,0.,0.,0.,0.,1.,0.,0.,0.,0.,-1.,0.", form=1)
    file.add(408, file.bolt, "0.,70.,0.,1.", matrix=down)
    scene, report = file.read()
    assert sorted(d.code for d in report.diagnostics) == ["IGES_SCALED", "POSE_MIRRORED"]
    assert sorted(map(tuple, boxes(scene).values())) == [
        (-50, -40, 0, 20, 0, 30), (0, 10, 0, 20, 0, 30), (0, 10, 70, 90, -30, 0), (100, 125, 20, 70, 5, 80),
    ]  # fmt: skip
    for node in scene.nodes:
        np.testing.assert_allclose(node.pose.rotation @ node.pose.rotation.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(node.pose.rotation) > 0.0
    large = next(body for n in scene.nodes for body in n.bodies if "scaled 2.5" in n.definition)
    assert max(float(face.triangles.max()) for face in large.boundary) == pytest.approx(0.075)


@pytest.mark.parametrize(
    "kind, values", [(412, "1.,3.,4.,5.,2,3,40.,60.,0.,0,0"), (414, "4,1.,2.,3.,50.,0.,1.5,0,0")]
)
def test_arrays_of_instances_are_told(tmp_path: Path, kind: int, values: str):
    file = Iges(tmp_path)
    base = file.add(408, file.bolt, "10.,0.,0.,1.", status="00010000")
    file.add(kind, base, values)
    _, report = file.read()
    assert [d.code for d in report.diagnostics] == ["IGES_NOT_TRANSLATED"]
    assert f"type {kind}" in report.diagnostics[0].message
    assert [o.outcome.value for o in report.outcomes] == ["dropped"]
