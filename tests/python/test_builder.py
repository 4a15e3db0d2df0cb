"""Scenes made in a script: ids, their cost, and what a wrong call says."""

from __future__ import annotations

import copy
import math

import kinefab
import numpy as np
import pytest
import trimesh
from kinefab.spatial import rotation_about


class CountedNodes(list):
    """A list that counts the nodes read from it."""

    read = 0

    def __iter__(self):
        self.read += len(self)
        return super().__iter__()

    def __getitem__(self, key):
        found = super().__getitem__(key)
        self.read += len(found) if isinstance(key, slice) else 1
        return found


def test_adding_a_part_does_not_read_all_others_again():
    """Ten thousand parts take ten thousand steps, of one name or of many, not their square."""
    scene = kinefab.Scene(nodes=CountedNodes())
    for number in range(5000):
        scene.add_part("Bolt")
        scene.add_part(f"Part{number}")
    assert scene.nodes.read <= 3 * 10_000
    assert len({node.id for node in list(scene.nodes)}) == 10_000


def test_copies_are_numbered_past_ids_from_elsewhere():
    """A third bolt is Bolt:3, unless a node that no add_part made, or another name, has that id already."""
    scene = kinefab.Scene()
    for name in ("Bolt", "Bolt:3", "Bolt", "Bolt"):
        scene.add_part(name)
    scene.nodes.append(kinefab.model.Node("Bolt:5", "Bolt"))
    scene.add_part("Bolt")
    assert [node.id for node in scene.nodes] == ["Bolt", "Bolt:3", "Bolt:2", "Bolt:4", "Bolt:5", "Bolt:6"]


HINGE = {"point": (0, 0, 0), "axis": (0, 0, 1)}


@pytest.mark.parametrize(
    "a, b, change, error, says",
    [
        ("Box", 1, {}, TypeError, "a is 'Box'; pass the index that add_part"),
        (0, "Lid", {}, TypeError, "b is 'Lid'; pass the index that add_part"),
        (0, None, {}, TypeError, "b is None; pass the index"),
        (0, 7, {}, ValueError, "b is 7; the scene has nodes 0 to 1"),
        (-1, 1, {}, ValueError, "a is -1; the scene has nodes 0 to 1"),
        (1, 1, {}, ValueError, "pass two different parts"),
        (0, 1, {"axis": (0, 0, 0)}, ValueError, "pass a direction in the world"),
        (0, 1, {"limits": (80, -10)}, ValueError, "lower not above upper"),
        (0, 1, {"limits": 80}, TypeError, "pass two numbers"),
    ],
)
def test_wrong_joint_says_what_to_pass(a, b, change, error, says):
    """A name for an index, a part joined to itself, a zero axis, reversed limits: an error, and no joint."""
    scene = kinefab.Scene()
    scene.add_part("Box")
    scene.add_part("Lid")
    with pytest.raises(error) as raised:
        scene.add_hinge(a, b, **{**HINGE, **change})
    assert says in str(raised.value)
    assert scene.joints == []


@pytest.mark.parametrize("parent, error", [("Box", TypeError), (3, ValueError), (-1, ValueError)])
def test_wrong_parent_says_what_to_pass(parent, error):
    """A parent is an index too."""
    scene = kinefab.Scene()
    scene.add_part("Box")
    with pytest.raises(error, match="^parent is"):
        scene.add_part("Lid", parent=parent)
    assert len(scene.nodes) == 1


TURN = rotation_about(np.array([0.6, 0.0, 0.8]), 0.7)
NAN, INF = math.nan, math.inf


class Shape:
    """A tetrahedron, as a mesh of a library of one's own."""

    def __init__(
        self,
        vertices=((0, 0, 0), (1, 0, 0), (0, 2, 0), (0, 0, 3)),
        faces=((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)),
    ):
        self.vertices, self.faces = vertices, faces


@pytest.mark.parametrize(
    "change, says",
    [
        ({"rotation": TURN @ np.diag([-1, 1, 1])}, "the rotation of Lid is a reflection"),
        ({"rotation": 2 * np.eye(3)}, "is no rotation, R'R is off the identity by 3"),
        ({"rotation": np.zeros((3, 3))}, "is no rotation"),
        ({"rotation": np.full((3, 3), NAN)}, "is no rotation"),
        ({"rotation": [0, 0, 0, 2]}, "is a quaternion of length 2, not 1; pass a rotation matrix, 3 x 3"),
        ({"rotation": np.eye(2)}, "has the shape (2, 2); pass a rotation matrix, 3 x 3"),
        ({"rotation": np.eye(4), "translation": (1, 0, 0)}, "holds its translation"),
        ({"rotation": np.ones((4, 4))}, "must be 0 0 0 1"),
        ({"rotation": ("XYW", (0, 0, 0))}, "pass three of XYZ"),
        ({"mesh": "no_such_file.obj"}, "where there is no file"),
        ({"mesh": Shape(), "unit": "parsec"}, "pass one of: m, cm"),
        ({"unit": "inch"}, "pass one of: m, cm"),
        ({"unit": ["mm"]}, "pass one of: m, cm"),
        ({"rotation": kinefab.Pose(np.eye(2))}, "is no pose"),
        ({"rotation": kinefab.Pose(-np.eye(3))}, "is a reflection"),
        ({"mass": -3.0}, "the mass of Lid is -3.0; it must be a number above zero"),
        ({"mass": NAN}, "the mass of Lid is nan"),
        ({"mass": INF}, "the mass of Lid is inf"),
        ({"mesh": Shape(), "collider": "egg"}, "pass one of: auto, none, box"),
        ({"mesh": Shape(), "collider": []}, "pass 'none' for a part that nothing touches"),
        ({"name": ""}, "the name is empty"),
        ({"name": "Lid\ud800"}, "pass text that UTF-8 can hold"),
        ({"rotation": [[1, 0, 0], [0, 1], [0, 0, 1]]}, "is no matrix of numbers"),
        ({"translation": (0, NAN, 0)}, "the translation of Lid is (0, nan, 0); pass three numbers"),
        ({"translation": (INF, 0, 0)}, "pass three numbers"),
        ({"translation": (1, 2)}, "pass three numbers"),
        ({"translation": ("1", "2", "3")}, "pass three numbers"),
        ({"translation": (True, False, True)}, "pass three numbers"),
        ({"translation": np.array([1 + 2j, 0, 3])}, "pass three numbers"),
        ({"translation": [10**400, 0, 3]}, "000...; pass three numbers"),
        ({"translation": [10**5000, 0, 3]}, "is a list of many digits; pass three numbers"),
        ({"rotation": [10**400, 0, 0, 1]}, "is no matrix of numbers"),
        ({"rotation": np.eye(3) * 1j}, "is no matrix of numbers"),
        ({"color": [0.1, 10**400, 0.3]}, "pass three or four numbers from 0 to 1"),
        ({"color": ("0.1", "0.2", "0.3")}, "pass three or four numbers from 0 to 1"),
        ({"density": 10**400}, "pass a number"),
        ({"mesh": "x" * 9999}, "xxx..., where there is no file"),
        ({"translation": 5}, "pass three numbers"),
        (
            {"mesh": Shape(vertices=((0, 0, 0), (1, NAN, 0), (0, 2, 0), (0, 0, 3)))},
            "has a vertex that is not finite",
        ),
        (
            {"mesh": Shape(vertices=((0, 0, 0), (1, 0, 0), (0, 2, 0), (0, 0, INF)))},
            "has a vertex that is not finite",
        ),
        ({"mesh": Shape(faces=((0, 1, 4),))}, "names vertex 4; it has 4"),
        ({"mesh": Shape(faces=((0, 1, 2, 3),))}, "pass triangles"),
        ({"mesh": Shape(faces=((0, 1, -2),))}, "names vertex -2; it has 4"),
        ({"mesh": Shape(faces=((0.0, 1.5, 2.0),))}, "the faces of Lid's mesh are no whole numbers"),
        ({"mesh": Shape(faces=None)}, "the faces of Lid's mesh are None; pass an array of numbers"),
        ({"mesh": Shape(faces=((0, 1, 2), (0, 1)))}, "pass an array of numbers, (n, 3)"),
        ({"mesh": Shape(faces=3)}, "pass triangles"),
        ({"mesh": Shape(vertices="abc")}, "the vertices of Lid's mesh are 'abc'; pass an array of numbers"),
        ({"mesh": Shape(vertices=np.eye(4, 3) * 1j)}, "pass an array of numbers, (n, 3)"),
        ({"density": INF}, "above zero"),
        ({"mesh": Shape(), "color": (0.1, NAN, 0.2)}, "from 0 to 1"),
        ({"mesh": Shape(), "color": (255, 0, 0)}, "from 0 to 1"),
        ({"mesh": Shape(), "color": (1, 0)}, "from 0 to 1"),
    ],
)
def test_wrong_part_says_what_to_pass(change, says):
    """What Unity cannot place, or no file can hold, is refused where it is given, and nothing is added."""
    scene = kinefab.Scene()
    with pytest.raises(ValueError) as raised:
        scene.add_part(**{"name": "Lid", **change})
    assert says in str(raised.value)
    assert not (scene.nodes or scene.meshes or scene.surfaces)


@pytest.mark.parametrize(
    "change",
    [
        {"name": 3},
        {"density": "steel"},
        {"density": True},
        {"grounded": "no"},
        {"flexible": 1},
        {"material": ""},
        {"material": 0},
        {"material": np.array(3.0)},
        {"collider": np.array(3.0)},
        {"material": {"color": (1, 0, 0)}},
        {"mass": "x" * 9999},
    ],
)
def test_a_part_takes_what_its_words_mean(change):
    """A name is a string, a density a number, and "no" is not taken for True."""
    scene = kinefab.Scene()
    add = scene.add_assembly if "flexible" in change else scene.add_part
    with pytest.raises(TypeError, match="; pass ") as raised:
        add(**{"name": "Lid", **change})
    assert not scene.nodes and len(str(raised.value)) < 300


@pytest.mark.parametrize(
    "kind, lead, says",
    [("screw", 0.0, "pass lead=, metres a turn"), ("revolute", 0.002, "only a screw has one")],
)
def test_a_lead_is_a_screw_s(kind, lead, says):
    """A screw without one would be a hinge with a slide that stays, and elsewhere it would mean nothing."""
    scene = kinefab.Scene()
    bolt = scene.add_part("Bolt")
    with pytest.raises(ValueError, match=says):
        scene.add_joint(kind, None, bolt, point=(0, 0, 0), axis=(0, 1, 0), lead=lead)
    assert not scene.joints


def test_export_takes_a_source_and_options(tmp_path):
    """What is neither says what to pass."""
    scene = kinefab.Scene()
    scene.add_part("Part", Shape())
    with pytest.raises(TypeError, match="pass kinefab.ExportOptions"):
        kinefab.export(scene, tmp_path / "part.kinefab", {"strict": True})  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="pass a file's path, a kinefab.Scene"):
        kinefab.export(5, tmp_path / "part.kinefab")  # type: ignore[arg-type]


def test_a_rotation_of_four_digits_is_taken_as_the_nearest():
    """Digits typed off a page make a proper rotation; an exact one stays to the last bit."""
    scene = kinefab.Scene()
    for turn in (TURN.round(4), TURN):
        scene.add_part("Lid", rotation=turn)
    typed, exact = (node.pose.rotation for node in scene.nodes)
    assert (
        np.abs(typed.T @ typed - np.eye(3)).max() < 8 * np.finfo(float).eps
        and np.abs(typed - TURN).max() < 1e-4
    )
    assert np.array_equal(exact, TURN)


@pytest.mark.parametrize(
    "change, error",
    [
        ({"point": (0, NAN, 0)}, ValueError),
        ({"axis": (0, NAN, 1)}, ValueError),
        ({"axis": (INF, 0, 1)}, ValueError),
        ({"limits": (None, 5)}, TypeError),
        ({"limits": ("a", "b")}, TypeError),
        ({"limits": ("0", "10")}, TypeError),
        ({"limits": (False, 10)}, TypeError),
        ({"limits": (-10, 80, 90)}, TypeError),
        ({"name": 3}, TypeError),
        ({"collide": "no"}, TypeError),
        ({"limits": (NAN, 80)}, ValueError),
    ],
)
def test_a_joint_takes_numbers_only(change, error):
    """NaN, infinity and None are refused where they are given; a range may be open on one side."""
    scene = kinefab.Scene()
    box, lid = scene.add_part("Box"), scene.add_part("Lid")
    with pytest.raises(error, match="pass"):
        scene.add_hinge(box, lid, **{**HINGE, **change})
    assert scene.joints == []
    assert scene.add_hinge(box, lid, **HINGE, limits=(-10, INF)).freedoms[3].upper == INF


@pytest.mark.parametrize(
    "drive", [kinefab.Drive(target=NAN), kinefab.Drive(stiffness=INF), kinefab.Drive(max_force=NAN)]
)
def test_a_drive_takes_numbers_only(drive):
    """Only its largest force may be infinite."""
    scene = kinefab.Scene()
    box, lid = scene.add_part("Box"), scene.add_part("Lid")
    with pytest.raises(ValueError, match="^rx is"):
        scene.add_joint(
            kinefab.JointKind.REVOLUTE,
            box,
            lid,
            point=(0, 0, 0),
            rx=kinefab.Freedom(kinefab.Motion.FREE, drive=drive),
        )


def test_an_index_of_another_scene_is_refused():
    """It may be in range and still mean another part; a copy of a scene has the parts it was made with."""
    one, other = kinefab.Scene(), kinefab.Scene()
    box, lid, foreign = one.add_part("Box"), one.add_part("Lid"), other.add_part("Bolt")
    with pytest.raises(ValueError, match="^a is 0 of another scene"):
        one.add_hinge(foreign, lid, **HINGE)
    with pytest.raises(ValueError, match="^parent is 0 of another scene"):
        one.add_part("Pin", parent=foreign)
    for same in (one, copy.deepcopy(one), one.with_poses([node.pose for node in one.nodes])):
        assert same.add_hinge(box, lid, **HINGE).a == 0
    joint = one.add_hinge(0, np.int64(1), **HINGE)
    assert (type(joint.a), type(joint.b)) == (int, int)


def test_a_scene_without_parts_is_a_warning(tmp_path):
    """An export of nothing is more likely a mistake than meant."""
    result = kinefab.export(kinefab.Scene(), tmp_path / "none.kinefab")
    assert [d.code for d in result.report.diagnostics] == ["SCENE_WITHOUT_PARTS"]


@pytest.mark.parametrize("name", ["x.txt", "x", "x.kinefab.bin"])
def test_a_target_of_another_ending_is_refused(tmp_path, name):
    """As on the command line: Unity would not find it."""
    with pytest.raises(ValueError, match="must end in .kinefab"):
        kinefab.export(kinefab.Scene(), tmp_path / name)
    assert not list(tmp_path.iterdir())


def test_a_mass_in_kilograms_has_the_inertia_of_the_mesh(tmp_path):
    """Of a box off its origin with two bodies: what a density of the same mass gives; and no density is assumed."""
    box = trimesh.creation.box((0.8, 2.0, 0.04)).apply_translation((0.4, 0.0, 0.0))
    path = tmp_path / "box.stl"
    box.export(path)
    for mesh in (box, path, trimesh.Scene([box, box.copy().apply_translation((1, 0, 0))])):
        scene = kinefab.Scene()
        volume = box.volume * (2 if isinstance(mesh, trimesh.Scene) else 1)
        for name, weight in (("Dense", {"density": 12.0 / volume}), ("Heavy", {"mass": 12.0})):
            scene.add_hinge(None, scene.add_part(name, mesh, **weight), point=(0, 0, 0), axis=(0, 1, 0))
        result = kinefab.export(scene, tmp_path / "door.kinefab")
        dense, heavy = (
            next(c for c in entry.components if type(c).__name__ == "Rigidbody")
            for entry in result.unity.gameObjects
            if entry.name in ("Dense", "Heavy")
        )
        assert heavy.mass == 12.0
        assert heavy.centerOfMass == pytest.approx(dense.centerOfMass)
        assert heavy.inertiaTensor == pytest.approx(dense.inertiaTensor)
        assert "DENSITY_ASSUMED" not in {d.code for d in result.report.diagnostics}


@pytest.mark.parametrize("mesh", [None, Shape(faces=((0, 1, 2),))])
def test_a_mass_in_kilograms_without_a_volume_is_told(tmp_path, mesh):
    """The mass is kept; whose inertia stands in is told."""
    scene = kinefab.Scene()
    scene.add_hinge(None, scene.add_part("Door", mesh, mass=12.0), point=(0, 0, 0), axis=(0, 1, 0))
    result = kinefab.export(scene, tmp_path / "door.kinefab")
    body = next(c for c in result.unity.gameObjects[-1].components if type(c).__name__ == "Rigidbody")
    assert body.mass == 12.0
    codes = {d.code for d in result.report.diagnostics}
    assert "INERTIA_ASSUMED" in codes and "MASS_UNKNOWN" not in codes


def test_a_mass_beside_a_density_is_a_wrong_call():
    """One of them would be left aside, and nobody told."""
    stated = kinefab.MassProperties(2.0, np.zeros(3), 0.008 * np.eye(3))
    for mass in (12.0, stated):
        with pytest.raises(ValueError, match="pass one of them"):
            kinefab.Scene().add_part("Door", Shape(), mass=mass, density=700)


def test_a_pose_and_lists_are_taken_where_arrays_and_pairs_are():
    """A rotation as ["XYZ", [30, 0, 90]], a whole Pose, a coordinate as [joint, "rx"]: as from JSON."""
    scene = kinefab.Scene()
    angles = [30, 0, 90]
    one, two = (
        scene.add_part("One", rotation=("XYZ", angles)),
        scene.add_part("Two", rotation=["XYZ", angles]),
    )
    assert np.array_equal(scene.pose(one).rotation, scene.pose(two).rotation)
    three = scene.add_part("Three", rotation=kinefab.Pose(TURN, np.array([1.0, 2.0, 3.0])))
    assert scene.pose(three).translation.tolist() == [1, 2, 3]
    assert scene.pose(three).rotation == pytest.approx(TURN)
    hinge = scene.add_hinge(None, one, **HINGE)
    rod = scene.add_joint("cylindrical", None, two, **HINGE)
    assert scene.add_coupling(hinge, [rod, "rx"], ratio=2.0).terms[0].joint == hinge.id


def test_a_coupling_takes_joints_of_its_own_scene_alone():
    """A hinge of another scene has the same id; a copy of the scene takes the joints of the first one, which stand alike."""
    scenes = [kinefab.Scene(), kinefab.Scene()]
    hinges = [
        [scene.add_hinge(None, scene.add_part("Gear"), point=(x, at, 0), axis=(0, 0, 1)) for x in (0, 0.06)]
        for at, scene in enumerate(scenes)
    ]
    assert [hinge.id for hinge in hinges[0]] == [hinge.id for hinge in hinges[1]]
    for wrong in (hinges[1][0], np.array([1, 2, 3]), 3):
        with pytest.raises(ValueError, match="pass a joint of this scene, or its id"):
            scenes[0].add_coupling(wrong, hinges[0][1], ratio=-0.5)
    assert scenes[0].couplings == []
    assert copy.deepcopy(scenes[0]).add_coupling(*hinges[0], ratio=-0.5).terms[0].joint == hinges[0][0].id
