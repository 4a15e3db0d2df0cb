"""SDF: frames, joints of every kind, couplings and masses, against Drake and closed forms; what is wrong, with its line."""

from __future__ import annotations

import importlib.util
import json
import math
import random
import re
import sys
from pathlib import Path

import kinefab
import numpy as np
import pytest
from kinefab.color import linear
from kinefab.diagnostics import KinefabError, Report
from kinefab.geometry import primitives
from kinefab.geometry.mass import solid_properties
from kinefab.model import RX, RZ, ColliderKind, JointKind
from kinefab.sources import read
from kinefab.sources.robots.robot_frame import TURN as TO_SCENE
from kinefab.sources.robots.robot_frame import rotation_rpy
from scene_kinematics import SceneKinematics, about, difference, unity_inertia, unity_point, unity_pose
from test_sources_urdf_faults import mutated

sys.path.append(str(Path(__file__).parents[2] / "python" / "bench"))

TWINS = Path(__file__).parents[2] / "fixtures" / "twins"
HEAVY = (
    "<inertial><pose>.1 .02 -.03 .1 .2 .3</pose><mass>2</mass><inertia><ixx>.1</ixx><iyy>.2</iyy><izz>.25</izz>"
    "<ixy>.01</ixy><ixz>-.02</ixz><iyz>.005</iyz></inertia></inertial>"
)


def link(name: str, pose: str = "", inner: str = HEAVY) -> str:
    return f"<link name='{name}'>{pose}{inner}</link>\n"


def joint(name: str, kind: str, parent: str, child: str, inner: str = "") -> str:
    return (
        f"<joint name='{name}' type='{kind}'><parent>{parent}</parent><child>{child}</child>{inner}</joint>\n"
    )


def model(inner: str, version: str = "1.9", attributes: str = "") -> str:
    return f"<sdf version='{version}'>\n<model name='m' {attributes}>\n{inner}</model>\n</sdf>"


def written(folder: Path, text: str, name: str = "m.sdf") -> Path:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def scene_of(folder: Path, text: str):
    return read(written(folder, text), Report())


def exported(path: Path, folder: Path, **options) -> SceneKinematics:
    return SceneKinematics.load(
        kinefab.export(read(path, Report(), options=options), folder / "s.kinefab").path
    )


LIMITS = (
    "<limit><lower>-0.17453292519943295</lower><upper>1.3962634015954636</upper><effort>5</effort></limit>"
)
ZOO = model(
    "<pose>.5 .1 .2 .3 .2 .1</pose><frame name='aside' attached_to='b'><pose>.1 .2 .3 .4 .5 .6</pose></frame>\n"
    + link("base")
    + link("b", "<pose>.1 .2 .3 .3 -.2 .5</pose>")
    + link("c", "<pose relative_to='b'>.3 0 .1 0 .4 0</pose>")
    + link("d", "<pose relative_to='j2'>.05 0 0 .1 0 .2</pose>")
    + link("e", "<pose degrees='true'>1 0 .5 10 20 30</pose>")
    + link("f", "<pose rotation_format='quat_xyzw'>1 1 .5 .1 .2 .3 .9273618495495704</pose>")
    + joint("ground", "fixed", "world", "base")
    + joint("j1", "revolute", "base", "b", f"<pose>.05 -.1 .2 .3 .2 .1</pose><axis><xyz>0 3 4</xyz>{LIMITS}</axis>")
    + joint(
        "j2", "prismatic", "b", "c",
        "<axis><xyz expressed_in='__model__'>1 0 0</xyz><limit><lower>-.05</lower><upper>.4</upper></limit></axis>",
    )
    + joint("j3", "continuous", "c", "d", "<pose relative_to='aside'/><axis><xyz expressed_in='aside'>0 1 1</xyz></axis>")
    + joint("j4", "screw", "base", "e", "<axis><xyz>0 0 1</xyz></axis><screw_thread_pitch>.02</screw_thread_pitch>")
    + joint(
        "j5", "revolute", "aside", "f",
        f"<axis><xyz>1 0 0</xyz>{LIMITS}<mimic joint='j1'><multiplier>-.5</multiplier><offset>0</offset>"
        "<reference>0</reference></mimic></axis>",
    ),
    "1.11",
)  # fmt: skip


@pytest.mark.parametrize("name", ["zoo", "arm"])
def test_every_link_stands_where_drake_has_it(tmp_path, name):
    """50 configurations inside the limits; limits and senses by asymmetric ranges; masses of what moves as one."""
    pytest.importorskip("pydrake", reason="drake is not installed")
    from engines.sdf import DrakePlant

    path = written(tmp_path, ZOO) if name == "zoo" else TWINS / "arm.sdf"
    motion, engine = exported(path, tmp_path), DrakePlant(path, ())
    rng = np.random.default_rng(5)
    for _ in range(50):
        values, asked = {}, {}
        for each in engine.joints:
            coordinate, sense = motion.reading(each.name, unity_point(each.axis), each.is_angle, each.child)
            unit = 180.0 / math.pi if each.is_angle else 1.0
            asked[each.key] = rng.uniform(max(each.lower, -3.0), min(each.upper, 3.0))
            values[coordinate] = sense * unit * asked[each.key]
            if math.isfinite(each.lower):
                ends = sorted(sense * unit * end for end in (each.lower, each.upper))
                assert motion.range_of(coordinate) == pytest.approx(ends, abs=1e-9)
        poses = motion.poses(motion.coupled(values))
        for body, pose in engine.poses(asked).items():
            metres, radians = difference(unity_pose(*pose), motion.pose_of(body, poses))
            assert metres < 1e-9 and radians < 1e-9, body
    for body, expected in engine.masses().items():
        mass, center, inertia = motion.mass(motion.body_of[motion.object(body)])
        r, t = motion.placed[motion.body_of[motion.object(body)]]
        assert mass == pytest.approx(expected.mass, rel=1e-9)
        assert r @ center + t == pytest.approx(unity_point(expected.center), abs=1e-9)
        assert r @ inertia @ r.T == pytest.approx(unity_inertia(expected.inertia), abs=1e-9)


def test_a_four_bar_closes_where_freudenstein_says(tmp_path):
    """The loop is kept; crank and rocker turn by the closed form, and no joint opens."""
    motion = exported(TWINS / "fourbar.sdf", tmp_path)
    assert len(motion.joints) == 4
    ground, crank, coupler, rocker, start = 0.1, 0.03, 0.09, 0.07, math.radians(50.0)

    def angles(t):
        b = crank * np.array([math.cos(t), math.sin(t)])
        d = np.array([ground, 0.0])
        reach = np.linalg.norm(d - b)
        along = (coupler**2 - rocker**2 + reach**2) / (2.0 * reach)
        u = (d - b) / reach
        c = b + along * u + math.sqrt(coupler**2 - along**2) * np.array([-u[1], u[0]])
        return t, math.atan2(*(c - b)[::-1]), math.atan2(*(c - d)[::-1])

    for turn in np.radians([-20.0, 15.0, 35.0]):
        (t0, k0, r0), (t, k, r) = angles(start), angles(start + turn)
        values = {
            motion.coordinate("Crank pin"): math.degrees(t - t0),
            motion.coordinate("Coupler pin"): math.degrees((k - t) - (k0 - t0)),
            motion.coordinate("Rocker pin"): math.degrees(r - r0),
        }
        poses = motion.poses(values)
        assert max(max(motion.gap(each, poses)) for each in motion.joints) < 1e-9


def test_two_axes_turn_in_the_parent_and_in_the_child(tmp_path):
    """universal: first about axis in the parent, then about axis2 in the child; both ranges where they belong."""
    inner = (
        link("a") + link("b", "<pose>1 0 0 0 0 0</pose>") + joint("g", "fixed", "world", "a")
        + joint("u", "universal", "a", "b", f"<axis><xyz>0 0 1</xyz>{LIMITS}</axis><axis2><xyz>0 1 0</xyz></axis2>")
    )  # fmt: skip
    scene = scene_of(tmp_path, model(inner))
    (found,) = scene.joints
    assert found.kind is JointKind.UNIVERSAL
    assert found.freedoms[RZ].upper == pytest.approx(math.radians(80.0)) and math.isinf(
        found.freedoms[RX].upper
    )
    motion = exported(tmp_path / "m.sdf", tmp_path)
    read_z = motion.reading("u", unity_point([0, 0, 1]), True, "b")
    read_y = motion.reading("u", unity_point([0, 1, 0]), True, "b")
    values = {read_z[0]: read_z[1] * 20.0, read_y[0]: read_y[1] * 35.0}
    turn = about((0, 0, 1), math.radians(20.0)) @ about((0, 1, 0), math.radians(35.0))
    expected = unity_pose(turn, [1.0, 0.0, 0.0])
    assert max(difference(expected, motion.pose_of("b", motion.poses(values)))) < 1e-9


@pytest.mark.parametrize("second", ["0 0 1", "0 1 1"])
def test_revolute2_of_other_axes_has_a_middle_body(tmp_path, second):
    inner = (
        link("a") + link("b", "<pose>1 0 0 0 0 0</pose>") + joint("g", "fixed", "world", "a")
        + joint("u", "revolute2", "a", "b", f"<axis><xyz>0 0 1</xyz>{LIMITS}</axis><axis2><xyz>{second}</xyz></axis2>")
    )  # fmt: skip
    motion = exported(written(tmp_path, model(inner)), tmp_path)
    assert [each.kind for each in motion.joints_of("u")] == ["HingeJoint", "HingeJoint"]
    axis = np.array([float(v) for v in second.split()])
    axis /= np.linalg.norm(axis)
    first, last = (
        motion.joints[[j.game_object for j in motion.joints].index(motion.object(n))]
        for n in ("u middle", "b")
    )
    values = {first.coordinates[0]: 20.0, last.coordinates[0]: 35.0}
    turn = about((0, 0, 1), math.radians(20.0)) @ about(axis, math.radians(35.0))
    assert max(difference(unity_pose(turn, [1, 0, 0]), motion.pose_of("b", motion.poses(values)))) < 1e-9


@pytest.mark.parametrize(
    "pitch, lead",
    [
        ("<screw_thread_pitch>0.5</screw_thread_pitch>", 0.5),
        ("<thread_pitch>-12.566370614359172</thread_pitch>", 0.5),
        ("<thread_pitch>20</thread_pitch>", -math.pi / 10.0),
        ("<screw_thread_pitch>0.5</screw_thread_pitch><thread_pitch>9</thread_pitch>", 0.5),
        ("", 1.0),
    ],
)
def test_both_spellings_of_a_thread(tmp_path, pitch, lead):
    inner = link("a") + link("b") + joint("s", "screw", "a", "b", f"<axis><xyz>0 0 1</xyz></axis>{pitch}")
    (found,) = scene_of(tmp_path, model(inner)).joints
    assert found.kind is JointKind.SCREW and found.lead == pytest.approx(lead)


def test_a_gearbox_couples_two_turns_against_its_reference(tmp_path):
    """theta_2 = -ratio theta_1; here the second hinge is stated the other way round, so its coordinate changes sign."""
    inner = (
        link("r") + link("a") + link("b") + joint("g", "fixed", "world", "r")
        + joint("ra", "revolute", "r", "a", "<axis><xyz>0 0 1</xyz></axis>")
        + joint("br", "revolute", "b", "r", "<axis><xyz>0 0 1</xyz></axis>")
        + joint(
            "gear", "gearbox", "a", "b",
            "<gearbox_ratio>3</gearbox_ratio><gearbox_reference_body>r</gearbox_reference_body>"
            "<axis><xyz>0 0 1</xyz></axis><axis2><xyz>0 0 1</xyz></axis2>",
        )
    )  # fmt: skip
    motion = exported(written(tmp_path, model(inner)), tmp_path)
    (coordinate, sense) = motion.reading("ra", unity_point([0, 0, 1]), True, "a")
    poses = motion.poses(motion.coupled({coordinate: sense * 10.0}))
    for name, angle in (("a", 10.0), ("b", -30.0)):
        expected = unity_pose(about((0, 0, 1), math.radians(angle)), np.zeros(3))
        assert max(difference(expected, motion.pose_of(name, poses))) < 1e-9


@pytest.mark.parametrize(
    "version, inner, axis",
    [
        ("1.4", "<axis><xyz>1 0 0</xyz></axis>", (1, 0, 0)),
        ("1.5", "<axis><xyz>1 0 0</xyz></axis>", (0, 1, 0)),
        (
            "1.6",
            "<axis><xyz>1 0 0</xyz><use_parent_model_frame>true</use_parent_model_frame></axis>",
            (1, 0, 0),
        ),
        ("1.7", "<axis><xyz expressed_in='__model__'>1 0 0</xyz></axis>", (1, 0, 0)),
        ("1.9", "<axis><xyz>1 0 0</xyz></axis>", (0, 1, 0)),
    ],
)
def test_in_which_frame_an_axis_stands_depends_on_the_version(tmp_path, version, inner, axis):
    """The child is turned a quarter about Z: its X is the model's Y."""
    text = model(
        link("a")
        + link("b", "<pose>0 0 0 0 0 1.5707963267948966</pose>")
        + joint("j", "revolute", "a", "b", inner),
        version,
    )
    scene = scene_of(tmp_path, text)
    (found,) = scene.joints
    world = scene.pose(found.b).rotation @ found.frame_b.rotation[:, 0]
    assert world == pytest.approx([axis[1], axis[2], axis[0]], abs=1e-12)


@pytest.mark.parametrize("word", ["frame", "relative_to"])
def test_poses_of_old_versions_are_seen_from_the_frame_they_name(tmp_path, word):
    """The newer word in a file of 1.6 too, as libsdformat and Drake have it."""
    inner = (
        link("a", "<pose>0 0 .25 0 0 1.5707963267948966</pose>")
        + link("b", f"<pose {word}='a'>.1 .02 .3 0 0 0</pose>")
        + joint("j", "revolute", "a", "b", "<axis><xyz>0 0 1</xyz></axis>")
    )
    scene = scene_of(tmp_path, model(inner, "1.6"))
    at = next(node.pose for node in scene.nodes if node.id == "m/b").translation
    assert at == pytest.approx([0.1, 0.55, -0.02], abs=1e-12)  # y z x of (-.02, .1, .55)


def test_parts_of_one_name_in_nested_models_keep_their_names_apart(tmp_path):
    nested = "".join(
        f"<model name='{name}'><pose>{x} .2 0 0 0 .3</pose>{link('tip')}</model>" + joint(f"to_{name}", "fixed", "rod", f"{name}::tip")
        for name, x in (("left", 0.1), ("right", -0.4))
    )  # fmt: skip
    inner = (
        link("base")
        + link("rod")
        + nested
        + joint("j", "revolute", "base", "rod", "<axis><xyz>0 0 1</xyz></axis>")
    )
    rod = next(node for node in scene_of(tmp_path, model(inner)).nodes if node.id == "m/rod")
    assert {site.name: round(float(site.pose.translation[2]), 9) for site in rod.sites} == {
        "left/tip": 0.1,
        "right/tip": -0.4,
    }


def test_a_link_that_weighs_what_its_shape_does_adds_to_the_one_that_carries_it(tmp_path):
    """``<inertial auto='true'/>`` of a box, 1000 kg/m^3, fixed to a link of stated mass: both weigh, as in Drake."""
    box = "<inertial auto='true'/><collision name='c'><geometry><box><size>.1 .2 .05</size></box></geometry></collision>"
    inner = (
        link("base") + link("a") + link("b", "<pose>.4 -.1 .2 0 0 .3</pose>", box) + joint("f", "fixed", "a", "b")
        + joint("j", "revolute", "base", "a", "<axis><xyz>0 0 1</xyz></axis>")
    )  # fmt: skip
    report = Report()
    scene = read(written(tmp_path, model(inner)), report)
    mass = next(node.mass for node in scene.nodes if node.id == "m/a")
    assert mass.mass == pytest.approx(2.0 + 1.0)
    assert mass.center == pytest.approx(
        np.array([2 * 0.02 - 0.1, -2 * 0.03 + 0.2, 2 * 0.1 + 0.4]) / 3.0
    )  # y z x
    assert [o.outcome.value for o in report.outcomes if o.feature == "mass b"] == ["kept"]


SOLIDS = {
    "box": ("<box><size>.1 .2 .3</size></box>", 0.006),
    "sphere": ("<sphere><radius>.1</radius></sphere>", 4 / 3 * math.pi * 1e-3),
    "cylinder": ("<cylinder><radius>.1</radius><length>.5</length></cylinder>", math.pi * 5e-3),
    "capsule": ("<capsule><radius>.1</radius><length>.2</length></capsule>", math.pi * (2e-3 + 4 / 3 * 1e-3)),
    "ellipsoid": ("<ellipsoid><radii>.1 .2 .3</radii></ellipsoid>", 4 / 3 * math.pi * 6e-3),
    "cone": ("<cone><radius>.1</radius><length>.4</length></cone>", math.pi * 4e-3 / 3),
}


@pytest.mark.parametrize("shape", SOLIDS)
@pytest.mark.parametrize(
    ("inertial", "own", "factor"),
    [
        ("", "", 1000.0),
        ("<density>2700</density>", "", 2700.0),
        ("<density>2700</density>", "<density>1200</density>", 1200.0),
        ("<mass>3</mass><density>2700</density>", "", None),
    ],
)
def test_a_mass_left_to_the_shapes_is_exact(tmp_path, shape, inertial, own, factor):
    """A collision's density before its link's before water's; a mass that is stated is theirs together.  Held against the
    shape's mesh, which is a little short of it, and Drake where it is installed."""
    text, volume = SOLIDS[shape]
    solid = f"<inertial auto='true'>{inertial}</inertial><collision name='c'><pose>.1 .2 .3 .4 .5 .6</pose>{own}<geometry>{text}</geometry></collision>"
    inner = (
        link("base")
        + link("a", "", solid)
        + joint("j", "revolute", "base", "a", "<axis><xyz>0 0 1</xyz></axis>")
    )
    path = written(tmp_path, model(inner, "1.12"))
    report = Report()
    scene = read(path, report)
    mass = next(node.mass for node in scene.nodes if node.id == "m/a")
    assert mass.mass == pytest.approx(3.0 if factor is None else factor * volume, rel=1e-12)
    assert not [d for d in report.diagnostics if d.code != "COLLIDER_CYLINDER_AS_MESH"]
    sizes = [float(v) for v in re.findall(r"[\d.]+", re.sub("<[^>]*>", " ", text))]
    make = getattr(primitives, shape)
    coarse = make(sizes) if shape in ("box", "ellipsoid") else make(*sizes)
    unit = solid_properties(coarse.vertices, coarse.faces, mass.mass / volume)
    turn = TO_SCENE @ rotation_rpy(0.4, 0.5, 0.6)
    assert mass.center == pytest.approx(TO_SCENE @ [0.1, 0.2, 0.3] + turn @ unit.center, abs=1e-9)
    assert mass.inertia == pytest.approx(
        turn @ unit.inertia @ turn.T, rel=0.02, abs=0.02 * unit.inertia.max()
    )
    if importlib.util.find_spec("pydrake") and shape != "cone":
        from engines.sdf import load as in_drake

        (there,) = (m for name, m in in_drake(path, ()).masses().items() if name.endswith("a"))
        assert there.mass == pytest.approx(mass.mass, rel=1e-12)


def test_a_mass_left_to_a_mesh_is_the_stated_one(tmp_path):
    """Nobody has loaded the file yet: the mass is right, and the report says that its spread is a stand-in."""
    (tmp_path / "t.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n", "utf-8"
    )
    shape = "<geometry><mesh><uri>t.obj</uri></mesh></geometry>"
    inner = link("base") + joint("j", "revolute", "base", "a", "<axis><xyz>0 0 1</xyz></axis>")
    for inertial, mass in (("<mass>3</mass>", 3.0), ("<density>2700</density>", 2700.0)):
        solid = f"<inertial auto='true'>{inertial}</inertial><collision name='c'>{shape}</collision><visual name='v'>{shape}</visual>"
        report = Report()
        scene = read(written(tmp_path, model(inner + link("a", "", solid), "1.12")), report)
        told = [o.code for o in report.outcomes if o.feature in ("mass a", "inertia of the meshes of a")]
        assert told == ["ELEMENT_DROPPED" if mass == 3.0 else "MASS_FROM_GEOMETRY"]
        target = kinefab.export(scene, tmp_path / "m.kinefab").path
        motion = SceneKinematics.load(target)
        assert motion.mass(motion.object("a"))[0] == pytest.approx(mass)


def test_a_base_without_mass_is_weighed_by_its_shape(tmp_path):
    """Drake reads a mass of zero; Unity has no such body, so the report tells what was taken."""
    box = "<inertial><mass>0</mass></inertial><collision name='c'><geometry><box><size>.1 .2 .05</size></box></geometry></collision>"
    inner = (
        link("base", "", box)
        + link("a")
        + joint("j", "revolute", "base", "a", "<axis><xyz>0 0 1</xyz></axis>")
    )
    report = Report()
    scene = read(written(tmp_path, model(inner)), report)
    assert next(node.mass for node in scene.nodes if node.id == "m/base").mass == pytest.approx(1.0)
    assert [o.feature for o in report.outcomes if o.code == "MASS_FROM_GEOMETRY"] == ["mass base"]


def test_models_are_included_by_name_and_placed(tmp_path):
    written(
        tmp_path,
        model(link("a") + link("b", "<pose>0 0 1 0 0 0</pose>") + joint("j", "ball", "a", "b")),
        "arm/model.sdf",
    )
    (tmp_path / "arm" / "model.config").write_text(
        "<model><sdf version='1.4'>old.sdf</sdf><sdf version='1.9'>model.sdf</sdf></model>", encoding="utf-8"
    )
    text = (
        "<sdf version='1.9'><world name='w'><gravity>0 1 -5</gravity>"
        "<include><uri>model://arm</uri><name>left</name><pose>1 0 0 0 0 0</pose></include>"
        "<include><uri>model://arm</uri><name>right</name><pose>0 1 0 0 0 0</pose><static>true</static></include>"
        "<include><uri>model://nobody</uri></include></world></sdf>"
    )
    path = written(tmp_path, text, "worlds/deep/er/w.world")
    report = Report()
    scene = read(path, report, options={"package_path": [tmp_path]})
    assert [d.code for d in report.diagnostics] == ["INCLUDE_NOT_FOUND"]
    by_id = {node.id: node for node in scene.nodes}
    assert by_id["left/b"].pose.translation == pytest.approx((0.0, 1.0, 1.0))
    assert by_id["right/b"].grounded and not by_id["left/b"].grounded
    assert scene.physics.gravity == pytest.approx((1.0, -5.0, 0.0))
    assert [j.kind for j in scene.joints] == [JointKind.SPHERICAL] * 2


def test_what_an_arm_carries_of_models_beside_its_own_keeps_their_names(tmp_path):
    """Two grippers of one kind, each a model beside the arm's; their links and frames are sites of the arm's tool."""

    def gripper(name: str, y: float) -> str:
        frame = "<frame name='tip' attached_to='palm'><pose>0 0 .1 0 0 0</pose></frame>"
        return f"<model name='{name}'><pose>0 {y} 1 0 0 0</pose>{link('palm')}{frame}</model>"

    inner = (
        "<model name='arm'>" + link("base") + link("tool", "<pose>0 0 1 0 0 0</pose>")
        + joint("j", "revolute", "base", "tool", "<axis><xyz>0 0 1</xyz></axis>") + "</model>"
        + gripper("left", 0.1) + gripper("right", -0.2)
        + joint("l", "fixed", "arm::tool", "left::palm") + joint("r", "fixed", "arm::tool", "right::palm")
        + "<frame name='tip' attached_to='left::palm'><pose>0 0 .3 0 0 0</pose></frame>"
    )  # fmt: skip
    scene = scene_of(tmp_path, model(inner))
    (tool,) = (node for node in scene.nodes if node.id == "m/arm/tool")
    assert {site.name: tuple(site.pose.translation.round(9)) for site in tool.sites} == {
        "left/palm": (0.1, 0.0, 0.0),
        "left/tip": (0.1, 0.1, 0.0),
        "left/tip_2": (0.1, 0.3, 0.0),
        "right/palm": (-0.2, 0.0, 0.0),
        "right/tip": (-0.2, 0.1, 0.0),
    }


@pytest.mark.parametrize("place", ["My Cone", "my cone/2", "my cone/10"])
@pytest.mark.parametrize("version", ["", "/tip", "/2"])
def test_a_model_of_gazebos_server_is_the_one_of_that_name(tmp_path, place, version):
    """Whose folder was given, or the cache that Gazebo keeps it in: small letters, a folder for each version."""
    uri = f"https://fuel.gazebosim.org/1.0/OpenRobotics/models/My%20Cone{version}"
    shape = f"<visual name='v'><geometry><mesh><uri>{uri}/files/meshes/t.obj</uri></mesh></geometry></visual>"
    written(tmp_path, model(link("a", "", HEAVY + shape)), f"cache/{place}/model.sdf")
    written(tmp_path, "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 3 2\n", f"cache/{place}/meshes/t.obj")
    (tmp_path / "cache" / "my cone" / "1").mkdir(parents=True)
    path = written(
        tmp_path, f"<sdf version='1.9'><world name='w'><include><uri>{uri}</uri></include></world></sdf>"
    )
    report = Report()
    scene = read(path, report, options={"package_path": [tmp_path / "cache"]})
    assert [node.name for node in scene.nodes] == ["m", "a"] and len(scene.nodes[1].bodies) == 1
    assert report.diagnostics == []
    with pytest.raises(KinefabError, match="LINKS_NONE"):
        read(path, Report())


def test_nested_and_merged_models_and_placement_frames(tmp_path):
    written(
        tmp_path,
        model(link("a", "<pose>0 0 2 0 0 0</pose>"), attributes="placement_frame='a'"),
        "arm/model.sdf",
    )
    inner = (
        link("base") + "<model name='n'><pose>1 2 3 0 0 1.5707963267948966</pose>" + link("x", "<pose>1 0 0 0 0 0</pose>")
        + "</model><include merge='true'><uri>arm</uri><pose>5 0 0 0 0 0</pose></include>"
        + joint("j", "fixed", "n::x", "a") + joint("k", "ball", "base", "n::x")
    )  # fmt: skip
    scene = scene_of(tmp_path, model(inner))
    by_id = {node.id: node for node in scene.nodes}
    assert by_id["m/n/x"].pose.translation == pytest.approx((3.0, 3.0, 1.0))  # y z x of (1, 3, 3)
    (site,) = by_id["m/n/x"].sites
    at = by_id["m/n/x"].pose @ site.pose
    assert site.name == "a" and at.translation == pytest.approx((0.0, 0.0, 5.0), abs=1e-12)


def test_shapes_materials_and_friction(tmp_path):
    shapes = {
        "box": "<box><size>.1 .2 .3</size></box>", "sphere": "<sphere><radius>.1</radius></sphere>",
        "capsule": "<capsule><radius>.1</radius><length>.4</length></capsule>",
        "cone": "<cone><radius>.1</radius><length>.4</length></cone>",
        "ellipsoid": "<ellipsoid><radii>.1 .2 .3</radii></ellipsoid>",
    }  # fmt: skip
    surface = "<surface><friction><ode><mu>.7</mu></ode></friction><bounce><restitution_coefficient>.3</restitution_coefficient></bounce></surface>"
    inner = "".join(
        f"<collision name='{k}'><geometry>{v}</geometry>{surface}</collision>" for k, v in shapes.items()
    )
    inner += (
        "<visual name='v'><geometry><box><size>1 1 1</size></box></geometry><material><diffuse>.1 .2 .3 1</diffuse>"
        "<emissive>.4 .5 .6 1</emissive><pbr><metal><metalness>.9</metalness><roughness>.2</roughness></metal></pbr>"
        "</material></visual>"
    )
    scene = scene_of(tmp_path, model(link("a", inner=inner)))
    node = scene.nodes[-1]
    assert [c.kind for c in node.colliders] == [
        ColliderKind.BOX, ColliderKind.SPHERE, ColliderKind.CAPSULE, ColliderKind.HULL, ColliderKind.HULL,
    ]  # fmt: skip
    assert {(c.material.dynamic_friction, c.material.restitution) for c in node.colliders} == {(0.7, 0.3)}
    (paint,) = scene.surfaces
    assert (
        paint.color == (linear(0.1), linear(0.2), linear(0.3), 1.0)
        and paint.metallic == 0.9
        and paint.smoothness == pytest.approx(0.8)
    )
    assert paint.emission == (linear(0.4), linear(0.5), linear(0.6))


def test_gazebos_own_colours_are_known_by_the_names_of_their_scripts(tmp_path):
    """Other scripts are told; a colour of the material's own goes before."""
    script = (
        "<script><uri>file://media/materials/scripts/gazebo.material</uri><name>Gazebo/{}</name></script>"
    )
    words = ("Orange", "RedTransparent", "Wood", "Blue")
    visuals = "".join(
        f"<visual name='{word}'><geometry><sphere/></geometry><material>{script.format(word)}"
        f"{'<diffuse>.2 .4 .6 1</diffuse>' if word == 'Blue' else ''}</material></visual>"
        for word in words
    )
    scene = read(written(tmp_path, model(link("a", inner=visuals))), report := Report())
    assert {s.name: s.color for s in scene.surfaces} == {
        "Orange": (1.0, linear(0.5088), linear(0.0468), 1.0),
        "RedTransparent": (1.0, 0.0, 0.0, 0.5),
        "Blue": (linear(0.2), linear(0.4), linear(0.6), 1.0),
    }
    assert [s.alpha_mode.value for s in scene.surfaces] == ["opaque", "blend", "opaque"]
    (lost,) = [o.feature for o in report.outcomes if o.code == "ELEMENT_DROPPED" and "script" in o.feature]
    assert lost.startswith("material script Gazebo/Wood of visual Wood")


def test_a_plane_lies_across_its_normal(tmp_path):
    inner = "<collision name='c'><geometry><plane><normal>0 1 1</normal></plane></geometry></collision>"
    node = scene_of(tmp_path, model(link("a", inner=inner) + "<static>true</static>")).nodes[-1]
    (collider,) = node.colliders
    up = collider.pose.rotation[:, 2]
    assert up == pytest.approx(np.array([1.0, 1.0, 0.0]) / math.sqrt(2.0))
    assert node.grounded


def test_rpy_is_about_fixed_axes():
    assert rotation_rpy(0.1, 0.2, 0.3) == pytest.approx(
        about((0, 0, 1), 0.3) @ about((0, 1, 0), 0.2) @ about((1, 0, 0), 0.1)
    )


A, B = link("a"), link("b")
PAIR = A + B
TURN = "<axis><xyz>0 0 1</xyz></axis>"
REFUSED = {
    "cut off": ("XML_SYNTAX", 5, model(PAIR)[:-12]),
    "bomb": ("XML_ENTITY", 1, "<!DOCTYPE s [<!ENTITY a 'aa'><!ENTITY b '&a;&a;'>]>" + model("&b;" + A)),
    "other root": ("XML_ROOT", 1, "<robot name='r'/>"),
    "no version": ("XML_MISSING", 1, model(A).replace(" version='1.9'", "")),
    "no links": ("LINKS_NONE", 1, "<sdf version='1.9'/>"),
    "twice": ("SOURCE_ID_DUPLICATE", 4, model(A + A)),
    "unknown link": ("LINK_UNKNOWN", 5, model(PAIR + joint("j", "ball", "a", "bb"))),
    "unknown type": ("JOINT_TYPE_UNKNOWN", 5, model(PAIR + joint("j", "balls", "a", "b"))),
    "itself": ("SAME_COMPONENT", 5, model(PAIR + joint("j", "ball", "a", "a"))),
    "no parent": ("XML_MISSING", 5, model(PAIR + "<joint name='j' type='ball'><child>b</child></joint>")),
    "no axis": ("XML_MISSING", 5, model(PAIR + joint("j", "revolute", "a", "b"))),
    "zero axis": ("AXIS_ZERO", 5, model(PAIR + joint("j", "revolute", "a", "b", "<axis><xyz>0 0 0</xyz></axis>"))),
    "frame unknown": ("LINK_UNKNOWN", 3, model(link("a", "<pose relative_to='q'>0 0 0 0 0 0</pose>"))),
    "frame cycle": (
        "FRAME_CYCLE", 3,
        model("<frame name=\'p\'><pose relative_to='q'/></frame>\n<frame name='q'><pose relative_to='p'/></frame>\n" + A),
    ),
    "attached in a circle": (
        "FRAME_CYCLE", 4,
        model("<frame name='p' attached_to='q'/>\n<frame name='q' attached_to='p'/>\n" + A),
    ),
    "nan": ("XML_VALUE", 3, model(link("a", "<pose>0 0 nan 0 0 0</pose>"))),
    "five numbers": ("XML_VALUE", 3, model(link("a", "<pose>0 0 0 0 0</pose>"))),
    "mimic": (
        "MIMIC_UNKNOWN", 5,
        model(PAIR + joint("j", "revolute", "a", "b", "<axis><xyz>0 0 1</xyz><mimic joint='k'/></axis>")),
    ),
    "lead": ("SCREW_LEAD_ZERO", 5, model(PAIR + joint("j", "screw", "a", "b", TURN + "<thread_pitch>0</thread_pitch>"))),
}  # fmt: skip
TOLD = {
    "zero axis that cannot matter": ("ROBOT_AXIS_ZERO", 5, model(PAIR + joint("j", "revolute", "a", "b", "<axis><xyz>0 0 0</xyz><limit><lower>0</lower><upper>0</upper></limit></axis>"))),
    "negative mass": ("VALUE_UNREADABLE", 3, model(A.replace("<mass>2", "<mass>-2"))),
    "moment of words": ("VALUE_UNREADABLE", 3, model(A.replace("<ixx>.1", "<ixx>none"))),
    "a colour of bytes": (
        "COLOR_CLAMPED", 3,
        model(link("a", inner="<visual name='v'><geometry><sphere/></geometry><material><diffuse>255 128 0</diffuse></material></visual>")),
    ),
    "version": ("SDF_VERSION", 1, model(A, "1.3")),
    "include": ("INCLUDE_NOT_FOUND", 4, model(A + "<include><uri>model://gone</uri></include>")),
    "plugin": ("ELEMENT_DROPPED", 4, model(A + "<plugin name='p' filename='x.so'/>")),
    "unknown": ("ELEMENT_UNKNOWN", 4, model(A + "<lnik name='p'/>")),
    "inertia": ("INERTIA_MENDED", 3, model(A.replace("<ixx>.1", "<ixx>9"))),
    "universal": (
        "UNIVERSAL_NOT_SQUARE", 5,
        model(PAIR + joint("j", "universal", "a", "b", TURN + "<axis2><xyz>0 1 1</xyz></axis2>")),
    ),
    "limits": (
        "LIMITS_REVERSED_DROPPED", 5,
        model(PAIR + joint("j", "revolute", "a", "b", "<axis><xyz>0 0 1</xyz><limit><lower>80</lower><upper>-10</upper></limit></axis>")),
    ),
    "gearbox": (
        "GEARBOX_WITHOUT_JOINT", 5,
        model(PAIR + joint("j", "gearbox", "a", "b", TURN + TURN.replace("axis", "axis2") + "<gearbox_reference_body>a</gearbox_reference_body>")),
    ),
    "two frictions": (
        "ELEMENT_DROPPED", 3,
        model(link("a", inner="<collision name='c'><geometry><sphere/></geometry><surface><friction><ode><mu>.3</mu><mu2>.7</mu2></ode></friction></surface></collision>")),
    ),
    "mesh": ("MESH_NOT_FOUND", 3, model(link("a", inner="<visual name='v'><geometry><mesh><uri>model://x/a.stl</uri></mesh></geometry></visual>"))),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_a_wrong_file_is_refused_at_its_line(tmp_path, case):
    code, line, text = REFUSED[case]
    with pytest.raises(KinefabError) as refused:
        kinefab.export(written(tmp_path, text), tmp_path / "m.kinefab")
    assert (code, f"m.sdf:{line}") in {(d.code, d.where) for d in refused.value.diagnostics}
    assert not (tmp_path / "m.kinefab").exists()


@pytest.mark.parametrize("case", TOLD)
def test_a_loss_is_told_at_its_line_and_the_rest_converts(tmp_path, case):
    code, line, text = TOLD[case]
    result = kinefab.export(written(tmp_path, text), tmp_path / "m.kinefab")
    assert (code, f"m.sdf:{line}") in {(d.code, d.where) for d in result.report.diagnostics}
    assert json.loads(result.path.read_text("utf-8"))["gameObjects"]


def test_a_model_that_includes_itself_is_refused(tmp_path):
    path = written(tmp_path, model(A + "<include><uri>m.sdf</uri></include>"))
    with pytest.raises(KinefabError) as refused:
        read(path, Report())
    assert [d.code for d in refused.value.diagnostics] == ["INCLUDE_CYCLE"]


def test_a_model_may_include_the_servers_model_of_its_own_name(tmp_path):
    """It is another one, which is not here unless its folder is given."""
    uri = "https://fuel.gazebosim.org/1.0/OpenRobotics/models/Lidar"
    path = written(tmp_path, model(A + f"<include><uri>{uri}</uri></include>"), "lidar/model.sdf")
    report = Report()
    assert [node.name for node in read(path, report).nodes][:2] == ["m", "a"]
    assert [(d.code, d.where) for d in report.diagnostics] == [("INCLUDE_NOT_FOUND", "model.sdf:4")]
    written(tmp_path, model(link("beam")), "cache/lidar/3/model.sdf")
    scene = read(path, Report(), options={"package_path": [tmp_path / "cache"]})
    assert [node.name for node in scene.nodes].count("beam") == 1


def test_an_include_of_another_format_is_told_and_the_rest_converts(tmp_path):
    """Gazebo takes a URDF there."""
    written(tmp_path, "<robot name='r'><link name='b'/></robot>", "r.urdf")
    report = Report()
    scene = read(written(tmp_path, model(A + "<include><uri>r.urdf</uri></include>")), report)
    assert [node.name for node in scene.nodes] == ["m", "a"]
    assert [(d.code, d.where) for d in report.diagnostics] == [("INCLUDE_NOT_SDF", "m.sdf:4")]


@pytest.mark.parametrize("yes", ["true", "True", "TRUE", "1"])
def test_words_are_read_in_letters_of_any_size(tmp_path, yes):
    """As libsdformat reads them: a static model would fall, and a joint was refused."""
    turned = f"<pose degrees='{yes}'>1 0 0 0 0 90</pose><gravity>False</gravity>"
    text = model(A + link("b", turned) + joint("j", "Revolute", "a", "b", "<axis><xyz>0 0 1</xyz></axis>"))
    scene = scene_of(tmp_path, text)
    b = next(node for node in scene.nodes if node.name == "b")
    assert [j.kind for j in scene.joints] == [JointKind.REVOLUTE] and not b.dynamics.gravity
    assert TO_SCENE.T @ b.pose.rotation @ TO_SCENE == pytest.approx(rotation_rpy(0.0, 0.0, math.pi / 2.0))
    still = scene_of(tmp_path, model(A + f"<static>{yes}</static>"))
    assert [node.grounded for node in still.nodes if node.name == "a"] == [True]


def test_a_fault_before_an_include_does_not_end_the_reading_of_it(tmp_path):
    """Both are found: what stands before it, and what the included file has."""
    (tmp_path / "other.sdf").write_text(model(link("b", "<pose>0 0 nan 0 0 0</pose>")), encoding="utf-8")
    path = written(
        tmp_path,
        model(link("a", "<pose>0 0</pose>") + "<include><uri>other.sdf</uri></include>"),
    )
    with pytest.raises(KinefabError) as refused:
        read(path, Report())
    assert [(d.code, d.where) for d in refused.value.diagnostics] == [
        ("XML_VALUE", "m.sdf:3"),
        ("XML_VALUE", "other.sdf:3"),
    ]


def test_a_mimic_that_is_many_sizes_of_its_mechanism_off_is_no_contradiction(tmp_path):
    """A kneecap beside its knee: all joints within 5 mm, and one slide that its mimic puts 26 mm away."""
    text = model(
        link("a")
        + link("b", "<pose>.004 .003 0 0 0 0</pose>")
        + link("c", "<pose>0 .002 .001 0 0 0</pose>")
        + joint("j", "revolute", "a", "b", "<axis><xyz>0 0 1</xyz></axis>")
        + joint("k", "prismatic", "a", "c", "<axis><xyz>0 1 0</xyz><mimic joint='j'><multiplier>.0003</multiplier><offset>.026</offset><reference>0</reference></mimic></axis>")
    )  # fmt: skip
    made = kinefab.export(written(tmp_path, text), tmp_path / "s.kinefab")
    told = [d for d in made.report.diagnostics if d.code.startswith("CONSTRAINT")]
    assert [d.code for d in told] == ["CONSTRAINT_GAP"] and "0.026 m" in told[0].message
    solved = kinefab.ExportOptions(solve=True)
    made = kinefab.export(tmp_path / "m.sdf", tmp_path / "t.kinefab", solved)
    (entry,) = json.loads(made.path.read_text(encoding="utf-8"))["couplings"]
    assert "offset" not in entry  # the pose meets the law


def test_a_mimic_that_is_off_at_the_pose_keeps_its_offset_and_is_told(tmp_path):
    """The stated pose is where Gazebo and Drake begin, and the law is the file's; once told, and ``--solve`` meets both."""
    inner = (
        link("a") + link("b") + link("c") + joint("j", "revolute", "a", "b", TURN)
        + joint("k", "revolute", "a", "c", "<axis><xyz>0 0 1</xyz><mimic joint='j'><multiplier>2</multiplier><offset>.3</offset><reference>.1</reference></mimic></axis>")
    )  # fmt: skip
    path = written(tmp_path, model(inner))
    (coupling,) = read(path, Report()).couplings
    assert coupling.offset == pytest.approx(0.1) and coupling.terms[0].ratio == 2.0
    result = kinefab.export(path, tmp_path / "m.kinefab")
    gaps = [d for d in result.report.diagnostics if d.code.endswith("_GAP")]
    assert [(d.code, d.where) for d in gaps] == [("CONSTRAINT_GAP", coupling.where)]
    assert kinefab.motion(result.path).follow({"j": [0.0]})["k"][0] == pytest.approx(math.degrees(0.1))
    solved = kinefab.export(path, tmp_path / "s.kinefab", kinefab.ExportOptions(solve=True)).path
    (entry,) = json.loads(solved.read_text("utf-8"))["couplings"]
    assert "offset" not in entry


def test_a_mimic_follows_a_joint_of_a_model_inside(tmp_path):
    """As sdformat's JointByName: names of joints have scopes too."""
    law = "<multiplier>-2.5</multiplier><offset>.3</offset><reference>.1</reference>"
    inside = "<model name='n'>" + link("a") + link("b") + joint("k", "revolute", "a", "b", TURN) + "</model>"
    inner = (
        link("base") + link("c") + inside + joint("g", "fixed", "base", "n::a", "")
        + joint("j", "revolute", "base", "c", f"<axis><xyz>0 1 0</xyz><mimic joint='n::k'>{law}</mimic></axis>")
    )  # fmt: skip
    scene = read(written(tmp_path, model(inner)), Report())
    (coupling,) = scene.couplings
    leader = next(joint.id for joint in scene.joints if joint.id.endswith("n/k"))
    assert [(term.joint, term.ratio) for term in coupling.terms] == [(leader, -2.5)]
    assert coupling.offset == pytest.approx(0.3 + 2.5 * 0.1)


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-16-le", "iso-8859-1"])
def test_the_encoding_that_a_file_states_is_its_own(tmp_path, encoding):
    path = written(tmp_path, "")
    declared = encoding.removesuffix("-sig").removesuffix("-le")
    text = f"<?xml version='1.0' encoding='{declared}'?>" + model(link("\u00e4").replace("><", ">\r\n<"))
    path.write_bytes(text.encode(encoding))
    assert read(path, Report()).nodes[-1].name == "\u00e4"


def test_no_mutation_of_a_file_is_a_traceback(tmp_path, fuzz_count):
    """Every one is read or refused by diagnostics; ``--fuzz N`` tries N of them."""
    chance, path, refused = random.Random(15), tmp_path / "m.sdf", 0
    for _ in range(fuzz_count):
        path.write_bytes(mutated(ZOO, chance))
        try:
            read(path, Report())
        except KinefabError as error:
            refused += 1
            assert error.diagnostics
    assert 0 < refused < fuzz_count


@pytest.mark.parametrize("given", [False, True])
def test_an_include_by_a_models_name_alone_finds_the_model(tmp_path, given):
    """As PX4's variants of the x500 name it; the name alone is no file beside them."""
    models = tmp_path / "models"
    for name, inner in (
        ("base", "<link name='b'/>"),
        ("more", "<include merge='true'><uri>base</uri></include>"),
    ):
        (models / name).mkdir(parents=True)
        text = f"<sdf version='1.9'><model name='{name}'>{inner}</model></sdf>"
        (models / name / "model.sdf").write_text(text, encoding="utf-8")
    path, options = models / "more" / "model.sdf", {}
    if given:
        path = tmp_path / "alone" / "model.sdf"
        path.parent.mkdir()
        (models / "more" / "model.sdf").rename(path)
        options = {"package_path": [str(models)]}
    scene = read(path, report := Report(), options=options)
    assert [node.name for node in scene.nodes] == ["more", "b"] and not report.diagnostics
