"""Held to FreeCAD itself: ``fixtures/freecad/*.oracle.json`` is what the program says of the documents beside it."""

from __future__ import annotations

import io
import json
import math
import re
import shutil
import subprocess
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import kinefab
import numpy as np
import pytest
from kinefab import sources
from kinefab.analysis import analyse
from kinefab.diagnostics import Outcome, Report
from kinefab.model import JointKind
from kinefab.sources.freecad.document import UNIT
from kinefab.sources.freecad.parts import TURN, scene_pose
from kinefab.spatial import Pose, quaternion_from_matrix
from source_bundles import FIXTURES

FOLDER = FIXTURES / "freecad"
DOCUMENTS = sorted(path.name.removesuffix(".oracle.json") for path in FOLDER.glob("*.oracle.json"))
SAME = 1e-9
"""Metres and entries of a rotation: two ways to the same numbers of a file."""
SOLVED = 1e-6
"""Metres and radians: what two solvers may differ by."""
KINDS = {
    "Fixed": JointKind.FIXED, "Revolute": JointKind.REVOLUTE, "Cylindrical": JointKind.CYLINDRICAL,
    "Slider": JointKind.PRISMATIC, "Ball": JointKind.SPHERICAL,
}  # fmt: skip


def said_of(name: str) -> dict:
    return json.loads((FOLDER / f"{name}.oracle.json").read_text(encoding="utf-8"))


def pose_of(numbers: list[float]) -> Pose:
    """A matrix of FreeCAD as a pose of its own, millimetres."""
    matrix = np.reshape(numbers, (4, 4))
    return Pose(matrix[:3, :3], matrix[:3, 3])


def demand_shapes(name: str) -> None:
    """Which distance a joint keeps hangs on what its elements are, and only OpenCASCADE tells."""
    if name.startswith("distance_"):
        pytest.importorskip("OCP", reason="OpenCASCADE is not installed")


@pytest.fixture(scope="module")
def scenes():
    return {name: sources.read(FOLDER / f"{name}.FCStd", Report()) for name in DOCUMENTS}


def by_path(scene) -> dict:
    """Nodes by the path of names that FreeCAD gives them (``Carriage.Plate`` is within its part's node)."""
    found = {}
    for index, node in enumerate(scene.nodes):
        names, at = [], index
        while at is not None and scene.nodes[at].parent is not None:
            names.insert(0, scene.nodes[at].where.partition("#")[2])
            at = scene.nodes[at].parent
        found[".".join(names)] = node
    return found


def test_there_are_documents_of_all_types():
    types = {joint["type"] for name in DOCUMENTS for joint in said_of(name)["joints"].values()}
    assert types == set(
        "Fixed Revolute Cylindrical Slider Ball Distance Parallel Perpendicular Angle RackPinion Screw Gears Belt".split()
    )


@pytest.mark.parametrize("name", DOCUMENTS)
def test_parts_stand_where_freecad_has_them(scenes, name):
    """Through links, arrays, parts within parts, sub-assemblies and other files."""
    nodes, compared = by_path(scenes[name]), 0
    for path, numbers in said_of(name)["parts"].items():
        array, _, number = path.rpartition(".")
        node = nodes.get(path) or nodes.get(f"{array}.{array}_i{number}")
        if node is None:
            continue  # a solid within a part, whose place is in the mesh
        compared += 1
        expected = scene_pose(pose_of(numbers))
        assert np.abs(node.pose.rotation - expected.rotation).max() < SAME, path
        assert np.abs(node.pose.translation - expected.translation).max() < SAME, path
    assert compared >= min(2, len(said_of(name)["parts"]))


@pytest.mark.parametrize("name", DOCUMENTS)
def test_joints_have_freecads_frames_and_coordinates(scenes, name):
    scene = scenes[name]
    joints = {joint.name: joint for joint in scene.joints}
    for label, told in said_of(name)["joints"].items():
        if label not in joints:
            assert told["type"] not in KINDS or label == "Within array"  # switched off
            continue
        joint = joints[label]
        assert joint.kind is KINDS[told["type"]]
        first = pose_of(told["first"])
        frame = scene.pose(joint.a) @ joint.frame_a
        assert np.abs(frame.translation - TURN @ first.translation * UNIT).max() < SAME
        axes = TURN @ first.rotation
        assert np.abs(frame.rotation - np.column_stack([axes[:, 2], axes[:, 0], axes[:, 1]])).max() < SAME
        between = frame.inverse() @ scene.pose(joint.b) @ joint.frame_b
        assert between.translation[0] == pytest.approx(told["length"] * UNIT, abs=SAME)
        if joint.kind in (JointKind.REVOLUTE, JointKind.CYLINDRICAL):
            angle = math.atan2(between.rotation[2, 1], between.rotation[1, 1])
            assert math.remainder(angle - told["angle"], math.tau) == pytest.approx(0.0, abs=SAME)


@pytest.mark.parametrize("name", DOCUMENTS)
def test_what_freecad_solved_holds_by_our_equations(scenes, name):
    """The saved pose satisfies every joint and constraint: solving it moves nothing."""
    scene = scenes[name]
    found = analyse(scene)
    assert not [d for d in found.report.diagnostics if d.code in ("CONSTRAINT_GAP", "JOINT_POSE_GAP")]
    moved = found.scene(True)
    for before, after in zip(scene.nodes, moved.nodes):
        assert np.abs(before.pose.translation - after.pose.translation).max() < SOLVED
        assert np.abs(before.pose.rotation - after.pose.rotation).max() < SOLVED


MOBILITY = {
    "fixed": 0, "revolute": 1, "cylindrical": 2, "slider": 1, "ball": 3, "parallel": 4, "perpendicular": 5, "angle": 5,
    "distance_planes": 3, "distance_lines": 3, "distance_points": 5, "distance_plane_point": 5, "distance_point_line": 5,
    "distance_cylinders": 3, "distance_plane_cylinder": 4, "distance_plane_sphere": 5, "distance_cylinder_sphere": 5,
    "couplings": 2, "four_bar": 0, "wheel_unit": 1, "linked": 7, "stretched": 2, "deep": 2,
}  # fmt: skip
"""6 less the rows of the solver's joint (``*Joint::initializeGlobally``); couplings: six joints, four couplings;
linked: 1 + 0 + 1 + 3 + 1 + 0 + 0 + 1 of its joints; elements of arrays that no joint holds are no part of an island."""


@pytest.mark.parametrize("name", DOCUMENTS)
def test_mobility_is_that_of_the_solvers_rows(scenes, name):
    demand_shapes(name)
    assert sum(island.mobility for island in analyse(scenes[name]).islands) == MOBILITY[name]


@pytest.mark.parametrize("name", [n for n in DOCUMENTS if (FOLDER / f"{n}.asmt").is_file()])
def test_the_export_for_the_solver_says_the_same(scenes, name):
    demand_shapes(name)
    """FreeCAD's own ``.asmt``: kinds, axes and limits of the same joints, kinds and values of the same constraints."""
    ours = scenes[name]
    theirs = sources.read(FOLDER / f"{name}.asmt", Report())

    def key(entry) -> str:
        return (
            entry.where.partition("#")[2]
            if "#" in entry.where
            else entry.id.partition("#")[2].partition(":")[0]
        )

    joints = {key(j): j for j in theirs.joints if "Ground" not in j.id}
    assert joints.keys() == {key(j) for j in ours.joints}
    for joint in ours.joints:
        other = joints[key(joint)]
        assert other.kind is joint.kind
        for mine, told in zip(joint.freedoms, other.freedoms):
            assert (mine.motion, mine.lower, mine.upper) == (
                told.motion,
                pytest.approx(told.lower),
                pytest.approx(told.upper),
            )
        a, b = ours.pose(joint.a) @ joint.frame_a, theirs.pose(other.a) @ other.frame_a
        assert np.abs(a.rotation[:, 0] - b.rotation[:, 0]).max() < SOLVED
        assert np.abs(a.translation - b.translation).max() < SOLVED
    constraints = {key(c): c for c in theirs.constraints}
    assert constraints.keys() == {key(c) for c in ours.constraints}
    for constraint in ours.constraints:
        other = constraints[key(constraint)]
        assert (other.kind, [f.kind for f in other.features]) == (
            constraint.kind,
            [f.kind for f in constraint.features],
        )
        assert other.value == pytest.approx(constraint.value, abs=SAME)
    couplings = {key(c): c for c in theirs.couplings}
    assert couplings.keys() == {key(c) for c in ours.couplings}
    for coupling in ours.couplings:
        other = couplings[key(coupling)]
        assert other.terms[0].ratio == pytest.approx(coupling.terms[0].ratio)
        assert other.kind is coupling.kind


def test_couplings_move_as_freecads_solver_moved_them(scenes):
    """Ten degrees of wheel A and forty of the spindle: gear, belt with an opposed axis, rack and screw, with their signs."""
    told, scene = said_of("couplings"), scenes["couplings"]
    joints = {joint.id: joint for joint in scene.joints}

    def coordinate(joint, freedom, poses) -> float:
        b = by_path(scene)
        names = {id(node): path for path, node in b.items()}
        world = [scene_pose(pose_of(told[poses][names[id(scene.nodes[n])]])) for n in (joint.a, joint.b)]
        between = (world[0] @ joint.frame_a).inverse() @ world[1] @ joint.frame_b
        if freedom < 3:
            return float(between.translation[0])
        return math.atan2(between.rotation[2, 1], between.rotation[1, 1])

    assert {c.id for c in scene.couplings} == {"Mesh", "Strap", "RackAndPinion", "Thread"}
    for coupling in scene.couplings:
        for poses in ("parts", "driven"):
            led = coordinate(joints[coupling.joint], coupling.freedom, poses)
            terms = sum(t.ratio * coordinate(joints[t.joint], t.freedom, poses) for t in coupling.terms)
            assert led - terms == pytest.approx(coupling.offset, abs=SOLVED), (coupling.id, poses)


def with_placement(path: Path, thing: str, name: str, pose: Pose) -> bytes:
    """The document with another value of one placement."""
    out = io.BytesIO()
    with zipfile.ZipFile(path) as old, zipfile.ZipFile(out, "w") as new:
        for member in old.namelist():
            content = old.read(member)
            if member == "Document.xml":
                root = ElementTree.fromstring(content)
                value = root.find(
                    f"ObjectData/Object[@name='{thing}']/Properties/Property[@name='{name}']/PropertyPlacement"
                )
                for key, number in zip(("Px", "Py", "Pz"), pose.translation):
                    value.set(key, repr(float(number)))
                for key, number in zip(("Q0", "Q1", "Q2", "Q3"), quaternion_from_matrix(pose.rotation)):
                    value.set(key, repr(float(number)))
                content = ElementTree.tostring(root)
            new.writestr(member, content)
    return out.getvalue()


def test_four_bar_is_solved_to_freecads_poses(tmp_path, scenes):
    """24 angles of the crank, each solved from the pose before; FreeCAD's own solver did the same."""
    told, scene = said_of("four_bar"), scenes["four_bar"]
    drive = next(joint for joint in scene.joints if joint.name == "Drive")
    poses = [node.pose for node in scene.nodes]
    worst = 0.0
    for step in told["steps"]:
        changed = with_placement(
            FOLDER / "four_bar.FCStd",
            drive.where.partition("#")[2],
            "Placement1",
            pose_of(step["placement1"]),
        )
        (tmp_path / "four_bar.FCStd").write_bytes(changed)
        asked = sources.read(tmp_path / "four_bar.FCStd", Report()).with_poses(poses)
        assert "Drive" in {
            constraint.name for constraint in asked.constraints
        }  # open: to be closed by solving
        solved = analyse(asked).scene(True)
        poses = [node.pose for node in solved.nodes]
        for path, node in by_path(solved).items():
            if path in step["parts"]:
                expected = scene_pose(pose_of(step["parts"][path]))
                worst = max(worst, np.abs(node.pose.translation - expected.translation).max())
                worst = max(worst, np.abs(node.pose.rotation - expected.rotation).max())
    assert worst < SOLVED


UNHELD = {"linked": 18}
"""Freedoms of bodies that no joint holds, three of linked: two elements of one array, and the other array whole."""


@pytest.mark.skipif(shutil.which("dotnet-kinefab") is None, reason="dotnet-kinefab is not on the PATH")
@pytest.mark.parametrize("name", ["couplings", "linked", "four_bar", "distance_plane_cylinder"])
def test_the_library_takes_the_scene_and_counts_the_same(tmp_path, name):
    """Valid to the letter, and as mobile as the solver's rows leave it."""
    demand_shapes(name)
    target = tmp_path / f"{name}.kinefab"
    kinefab.export(FOLDER / f"{name}.FCStd", target)
    run = [
        subprocess.run(["dotnet-kinefab", *words], capture_output=True, text=True, check=False)
        for words in (["validate", str(target), "--strict"], ["mobility", str(target)])
    ]
    assert [one.returncode for one in run] == [0, 0], run[0].stdout + run[0].stderr
    counted = re.search(r"^mobility\s+(\d+), (\d+) in the file", run[1].stdout, re.MULTILINE)
    assert (
        counted is not None
        and [int(number) for number in counted.groups()] == [MOBILITY[name] + UNHELD.get(name, 0)] * 2
    )


def test_shapes_lie_where_freecad_has_them_however_links_scale_them():
    """Boxes in the world: of parts turned within uneven scales, of links to scaled links, of arrays and groups of links."""
    pytest.importorskip("OCP", reason="OpenCASCADE is not installed")
    report = Report()
    scene = sources.read(FOLDER / "stretched.FCStd", report)
    boxes, hidden = [], {node.name for node in scene.nodes if not node.visible}
    for node in scene.nodes:
        for body in node.bodies:
            points = node.pose.point(np.asarray(scene.meshes[body.mesh].vertices)) @ TURN / UNIT
            boxes.append(np.array([points.min(axis=0), points.max(axis=0)]))
            hidden |= set() if body.visible else {f"{node.where.partition('#')[2]}.{body.name}"}
    expected = said_of("stretched")["boxes"]
    assert len(boxes) == len(expected) == 13
    for path, box in expected.items():
        nearest = min(range(len(boxes)), key=lambda index: np.abs(boxes[index] - box).max())
        assert np.abs(boxes.pop(nearest) - box).max() < 1e-5, (
            path
        )  # millimetres; meshes keep single precision
    assert hidden == {"Folded:1", "Bundle.Cube", "BundleAgain.Cube"}
    assert not [found for found in report.outcomes if found.outcome is Outcome.DROPPED]
