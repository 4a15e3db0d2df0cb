"""The paper's CSV: columns by name or order, hinges from axes, and where the point of an axis comes from."""

from __future__ import annotations

import math

import numpy as np
import pytest
from kinefab import sources
from kinefab.diagnostics import Report
from kinefab.model import JointKind
from kinefab.sources.paper.axis_point import circles, common_axis_point
from source_bundles import FIXTURES, codes

PAPER = FIXTURES / "lever" / "lever_paper.csv"
PIN = np.array([0.025 * math.cos(math.radians(30)), 0.0, -0.0125])
SLIDER_X = 0.11077835244

ROWS = """# length: mm
# up: Z
{head}
Box;assembly;;;0 0 0;1 0 0;0 1 0;0 0 1;;{tail}
Base:1;part;Box;Base;0 0 0;1 0 0;0 1 0;0 0 1;;{tail}
Lid:1;part;Box;Lid;10 20 30;1 0 0;0 1 0;0 0 1;R 1 0 0;{lid}
"""


def obj_vertices(reference):
    """Vertices of one ``o`` of an OBJ, through the reference's map: a loader of a dozen lines."""
    found, inside = [], False
    for line in reference.path.read_text(encoding="utf-8").splitlines():
        if line.startswith("o "):
            inside = line[2:] == reference.key
        elif line.startswith("v ") and inside:
            found.append([*map(float, line.split()[1:4]), 1.0])
    return (np.reshape(found, (-1, 4)) @ reference.to_node.T)[:, :3]


def read(path, vertices=None):
    report = Report()
    return sources.read(path, report, vertices), report


def on_axis(scene, joint, point) -> float:
    """Distance of a world point from a joint's axis, metres."""
    frame = scene.pose(joint.a) @ joint.frame_a
    return float(np.linalg.norm(np.cross(point - frame.translation, frame.rotation[:, 0])))


def test_paper_csv_gives_the_same_parts_as_the_bundle():
    """Names, hierarchy, poses and mesh references are those of the bundle, as far as the columns go."""
    paper, _ = read(PAPER)
    bundle, _ = read(FIXTURES / "lever" / "lever.bundle.json")
    assert [node.id for node in paper.nodes] == [node.id for node in bundle.nodes]
    for ours, theirs in zip(paper.nodes, bundle.nodes):
        assert (ours.parent, ours.kind, ours.grounded, ours.flexible) == (
            theirs.parent,
            theirs.kind,
            theirs.grounded,
            theirs.flexible,
        )
        assert np.array_equal(ours.pose.rotation, theirs.pose.rotation)
        assert np.array_equal(ours.pose.translation, theirs.pose.translation)
        assert [b.reference.key for b in ours.bodies] == [b.reference.key for b in theirs.bodies]
        assert all(
            np.array_equal(b.reference.to_node, t.reference.to_node)
            for b, t in zip(ours.bodies, theirs.bodies)
        )


def test_paper_csv_gives_the_same_freedoms_as_the_bundle():
    """The slider's translation, the crank's and the bar's rotation, with their centres."""
    paper, _ = read(PAPER)
    bundle, _ = read(FIXTURES / "lever" / "lever.bundle.json")
    assert [record.node for record in paper.dof_records] == [record.node for record in bundle.dof_records]
    for ours, theirs in zip(paper.dof_records, bundle.dof_records):
        assert np.array_equal(ours.translations, theirs.translations)
        assert np.array_equal(ours.rotations, theirs.rotations)
        assert (
            np.array_equal(ours.center, theirs.center) if theirs.center is not None else ours.center is None
        )


def test_paper_axes_become_hinges_on_the_mesh_cylinders():
    """With the meshes at hand the two pins are found where the mechanism's closed form has them."""
    scene, report = read(PAPER, obj_vertices)
    assert [joint.kind for joint in scene.joints[:3]] == [JointKind.REVOLUTE] * 3
    shaft, pin, gudgeon = scene.joints[:3]
    assert on_axis(scene, shaft, np.zeros(3)) < 1e-9
    assert on_axis(scene, pin, PIN) < 1e-6
    assert on_axis(scene, gudgeon, np.array([SLIDER_X, 0.0, 0.0])) < 1e-6
    assert codes(report) == ["AXIS_POINT_FOUND"] * 3 + ["SLIDE_FROM_DOF"]
    assert "DOF centre of Lever/Crank:1" in report.diagnostics[0].message
    assert "cylinder" in report.diagnostics[1].message and "cylinder" in report.diagnostics[2].message
    assert [constraint.kind.value for constraint in scene.constraints] == ["concentric"] * 3


def test_bar_hinge_is_never_put_at_its_instantaneous_pole():
    """The bar's DOF centre is its pole, no axis in the bar: without meshes a guess is reported."""
    scene, report = read(PAPER)
    assert codes(report) == ["AXIS_POINT_FOUND", "AXIS_POINT_GUESSED", "AXIS_POINT_GUESSED", "SLIDE_FROM_DOF"]
    pole = np.array([SLIDER_X, 0.0, -SLIDER_X * math.tan(math.radians(30))])
    assert all(on_axis(scene, joint, pole) > 0.05 for joint in scene.joints[:3])
    assert [outcome.outcome.value for outcome in report.outcomes] == ["approximated"] * 2


def test_slider_of_the_paper_slides_on_the_ground():
    """The slider's only axis is that to the bar; its line comes from its free direction."""
    scene, _ = read(PAPER)
    slide = scene.joints[-1]
    assert (slide.kind, slide.a, scene.nodes[slide.b].name) == (JointKind.PRISMATIC, None, "SliderD:1")
    assert slide.frame_a.rotation[:, 0] == pytest.approx([1, 0, 0])


@pytest.mark.parametrize(
    "head",
    [
        "Name;Type;Parent;Bodies;Origin;X;Y;Z;DOF;Axis constraints;Points",
        "Bauteilname;Typ;Übergeordnete Baugruppe;Körper;Ursprung;X-Achse;Y-Achse;Z-Achse;Freiheitsgrade;"
        "Abhängigkeiten;Achspunkte",
    ],
)
def test_columns_are_found_by_english_and_german_names(tmp_path, head):
    """The hinge stands at the point that the row states."""
    path = tmp_path / "box.csv"
    path.write_text(ROWS.format(head=head, tail=";", lid="Base:1 1 0 0;10 20 35"), encoding="cp1252")
    scene, report = read(path)
    assert codes(report) == ["AXIS_POINT_FOUND"]
    assert "point column" in report.diagnostics[0].message
    (joint,) = scene.joints
    assert (scene.pose(joint.a) @ joint.frame_a).translation == pytest.approx([0.010, 0.035, -0.020])


def test_columns_without_names_stand_in_the_papers_order(tmp_path):
    """Name, type, parent, bodies, origin, X, Y, Z, DOF, axes, DOF centre; vectors as three columns."""
    rows = [
        "Box,assembly,,,0,0,0,1,0,0,0,1,0,0,0,1,,,,,",
        "Base:1,part,Box,Base,0,0,0,1,0,0,0,1,0,0,0,1,,,,,",
        "Lid:1,part,Box,Lid,10,20,30,1,0,0,0,1,0,0,0,1,R 1 0 0,Base:1 1 0 0,10,21,30",
    ]
    path = tmp_path / "box.csv"
    path.write_text("# length: mm\n# up: Z\n" + "\n".join(rows) + "\n", encoding="utf-8")
    scene, report = read(path)
    assert codes(report) == ["AXIS_POINT_FOUND"]
    assert scene.nodes[2].pose.translation == pytest.approx([0.010, 0.030, -0.020])
    assert scene.dof_records[0].center == pytest.approx([0.010, 0.030, -0.021])


def ring(center, radius, heights, count=24):
    """Vertices of a cylinder along z."""
    angles = 2 * math.pi * np.arange(count) / count
    circle = np.column_stack([np.cos(angles), np.sin(angles)]) * radius + center
    return np.vstack([np.column_stack([circle, np.full(count, z)]) for z in heights])


BOX = np.array([[x, y, z] for x in (-9.0, 40.0) for y in (-7.0, 12.0) for z in (0.0, 5.0)])


def test_common_cylinder_is_found_among_others():
    """A plate with two bores and a lever with one pin share one axis, in any direction of space."""
    plate = np.vstack([BOX, ring((3, 4), 2.0, (0, 5)), ring((25, -1), 3.0, (0, 5))])
    lever = np.vstack([BOX + [30, 2, 6], ring((25, -1), 2.9, (-1, 11), count=37)])
    turn = np.linalg.qr(np.array([[2.0, 1, 0.5], [-1, 3, 1], [0.3, -0.7, 2]]))[0]
    point = common_axis_point(plate @ turn.T, lever @ turn.T, turn[:, 2])
    assert (turn.T @ point)[:2] == pytest.approx([25, -1], abs=1e-9)
    assert (turn.T @ point)[2] == pytest.approx(5.0)


def test_two_common_cylinders_are_no_hinge():
    """Two dowels in line fix the parts; which one would be the axis cannot be told."""
    two = np.vstack([BOX, ring((3, 4), 2.0, (0, 5)), ring((25, -1), 3.0, (0, 5))])
    assert common_axis_point(two, two + [0, 0, 5], np.array([0.0, 0.0, 1.0])) is None


def test_fillets_and_boxes_are_no_cylinders():
    """A quarter circle and the corners of a box are not taken for a bore."""
    quarter = ring((10, 10), 4.0, (0, 5), count=48)
    quarter = quarter[(quarter[:, 0] >= 10) & (quarter[:, 1] >= 10)]
    assert circles(np.vstack([BOX, quarter])) == []
    assert circles(np.zeros((0, 3))) == []
