"""URDF: poses, limits, signs and masses against Pinocchio and yourdfpy; names, shapes, materials and packages."""

from __future__ import annotations

import json
import math
import re
import sys
from pathlib import Path

import kinefab
import numpy as np
import pytest
from kinefab.color import linear
from kinefab.diagnostics import Report
from kinefab.model import ColliderKind, JointKind
from kinefab.sources import read
from kinefab.sources.robots.packages import Packages
from kinefab.sources.robots.robot_frame import rotation_rpy
from kinefab.sources.robots.shapes import Shape, Shapes
from kinefab.spatial import Pose
from scene_kinematics import ROS, SceneKinematics, difference, unity_inertia, unity_point, unity_pose

sys.path.append(str(Path(__file__).parents[2] / "python" / "bench"))

FIXTURES = Path(__file__).parents[2] / "fixtures"
ARM = FIXTURES / "twins" / "arm.urdf"


def written(folder: Path, inner: str, name: str = "r.urdf") -> Path:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"<robot name='r'>\n{inner}\n</robot>", encoding="utf-8")
    return path


def exported(path: Path, folder: Path, **options) -> SceneKinematics:
    scene = read(path, Report(), options=options)
    return SceneKinematics.load(kinefab.export(scene, folder / "scene.kinefab").path)


@pytest.fixture(scope="module")
def zoo(tmp_path_factory) -> Path:
    """All joint types, turned frames, an offset mimic in a chain, merged links."""
    heavy = "<inertial><origin xyz='.1 .02 -.03' rpy='.1 .2 .3'/><mass value='2'/><inertia ixx='.1' iyy='.2' izz='.25' ixy='.01' ixz='-.02' iyz='.005'/></inertial>"
    links = (
        "".join(f"<link name='{n}'>{heavy}</link>" for n in "abcdefgh")
        + "<link name='world'/><link name='tool'/>"
    )
    origin = "<origin xyz='{} -.2 .3' rpy='.3 -.2 {}'/>"

    def joint(name, kind, parent, child, inner="", at=0.1):
        return (
            f"<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>"
            f"{origin.format(at, at * 3)}{inner}</joint>"
        )

    limits = "<limit lower='-0.17453292519943295' upper='1.3962634015954636' effort='3' velocity='2'/>"
    joints = [
        joint("base", "fixed", "world", "a"),
        joint("r", "revolute", "a", "b", f"<axis xyz='0 3 4'/>{limits}<dynamics damping='.5' friction='.1'/>", 0.2),
        joint("c", "continuous", "b", "c", "<axis xyz='-1 2 2'/>", 0.3),
        joint("p", "prismatic", "c", "d", "<axis xyz='0 0 -1'/><limit lower='-.05' upper='.4' effort='1' velocity='1'/>"),
        joint("f", "fixed", "d", "tool", at=0.5),
        joint("m", "revolute", "tool", "e", f"<axis xyz='1 1 0'/>{limits}<mimic joint='r' multiplier='-0.5' offset='.2'/>"),
        joint("n", "prismatic", "e", "f", "<axis xyz='0 1 0'/><limit lower='-1' upper='1' effort='1' velocity='1'/><mimic joint='m' multiplier='.25' offset='-.01'/>"),
        joint("pl", "planar", "b", "g", "<axis xyz='0 0 1'/>"),
        joint("fl", "floating", "a", "h"),
    ]  # fmt: skip
    return written(tmp_path_factory.mktemp("zoo"), links + "".join(joints))


def chosen(motion: SceneKinematics, engine, rng) -> tuple[dict, dict]:
    """A random configuration: values by the scene's coordinates, and by the engine's keys."""
    values, asked = {}, {}
    for joint in engine.joints:
        found = motion.reading(joint.name, unity_point(joint.axis), joint.is_angle, joint.child)
        assert found is not None, joint.name
        coordinate, sense = found
        low, high = max(joint.lower, -3.0), min(joint.upper, 3.0)
        asked[joint.key] = rng.uniform(low, high)
        unit = 180.0 / math.pi if joint.is_angle else 1.0
        values[coordinate] = sense * unit * (asked[joint.key] - joint.start)
        if math.isfinite(joint.lower):
            ends = sorted(sense * unit * (end - joint.start) for end in (joint.lower, joint.upper))
            assert motion.range_of(coordinate) == pytest.approx(ends, abs=1e-9)
    return values, asked


@pytest.mark.parametrize("name", ["zoo", "arm"])
def test_every_link_stands_where_pinocchio_has_it(tmp_path, zoo, name):
    """50 configurations inside the limits, every link, merged ones too; mimics follow by the file's couplings."""
    pytest.importorskip("pinocchio", reason="pinocchio (pip install pin) is not installed")
    from engines.urdf import PinocchioModel

    path = zoo if name == "zoo" else ARM
    motion, engine = exported(path, tmp_path), PinocchioModel(path)
    rng = np.random.default_rng(3)
    for _ in range(50):
        values, asked = chosen(motion, engine, rng)
        poses, expected = motion.poses(motion.coupled(values)), engine.poses(asked)
        for link, pose in expected.items():
            metres, radians = difference(unity_pose(*pose), motion.pose_of(link, poses))
            assert metres < 1e-9 and radians < 1e-9, link


@pytest.mark.parametrize("name", ["zoo", "arm"])
def test_masses_are_pinocchios(tmp_path, zoo, name):
    pytest.importorskip("pinocchio", reason="pinocchio (pip install pin) is not installed")
    from engines.urdf import PinocchioModel

    path = zoo if name == "zoo" else ARM
    motion, engine = exported(path, tmp_path), PinocchioModel(path)
    masses = engine.masses()
    for link, expected in masses.items():
        body = motion.body_of[motion.object(link)]
        mass, center, inertia = motion.mass(body)
        r, t = motion.placed[body]
        assert mass == pytest.approx(expected.mass, rel=1e-9)
        assert r @ center + t == pytest.approx(unity_point(expected.center), abs=1e-9)
        assert r @ inertia @ r.T == pytest.approx(unity_inertia(expected.inertia), abs=1e-9)
    assert len(masses) == len(motion.moving)


def test_the_arm_stands_where_yourdfpy_has_it(tmp_path):
    yourdfpy = pytest.importorskip("yourdfpy", reason="yourdfpy is not installed")
    robot = yourdfpy.URDF.load(str(ARM), load_meshes=False)
    motion = exported(ARM, tmp_path)
    rng = np.random.default_rng(4)
    for _ in range(50):
        limits = [robot.joint_map[name].limit for name in robot.actuated_joint_names]
        q = rng.uniform([x.lower for x in limits], [x.upper for x in limits])
        robot.update_cfg(q)
        values = {}
        for name, value in zip(robot.actuated_joint_names, q):
            entry = robot.joint_map[name]
            world = motion.placed[motion.object(entry.child)][0]  # its axis is given in the child's frame
            axis = world @ ROS @ entry.axis
            coordinate, sense = motion.reading(name, axis, entry.type == "revolute", entry.child)
            values[coordinate] = sense * (math.degrees(value) if entry.type == "revolute" else value)
        poses = motion.poses(motion.coupled(values))
        for link in robot.link_map:
            t = robot.get_transform(link)
            metres, radians = difference(unity_pose(t[:3, :3], t[:3, 3]), motion.pose_of(link, poses))
            assert metres < 1e-9 and radians < 1e-9, link


def test_kinds_and_words_are_kept(zoo):
    scene = read(zoo, Report())
    kinds = {joint.name: joint.kind for joint in scene.joints}
    assert kinds == {
        "r": JointKind.REVOLUTE, "c": JointKind.REVOLUTE, "p": JointKind.PRISMATIC, "m": JointKind.REVOLUTE,
        "n": JointKind.PRISMATIC, "pl": JointKind.PLANAR, "fl": JointKind.FREE,
    }  # fmt: skip
    r = next(joint for joint in scene.joints if joint.name == "r")
    assert r.freedoms[3].passive.damping == 0.5 and r.freedoms[3].passive.friction == 0.1
    assert r.freedoms[3].passive.effort == 3.0 and r.freedoms[3].passive.speed == 2.0
    assert r.extras["urdf"]["limit"]["effort"] == 3.0
    assert [c.id for c in scene.couplings] == ["mimic:m", "mimic:n"]
    d = next(node for node in scene.nodes if node.name == "d")
    assert [site.name for site in d.sites] == ["tool"] and d.extras["fixedJoints"] == {"f": "tool"}


def test_safety_and_calibration_stay_in_the_extras(tmp_path):
    inner = (
        "<link name='a'/><link name='b'/><joint name='j' type='continuous'><parent link='a'/><child link='b'/>"
        "<safety_controller soft_lower_limit='-1' k_position='100' k_velocity='2'/><calibration rising='0.3'/></joint>"
    )
    (joint,) = read(written(tmp_path, inner), Report()).joints
    assert joint.extras["urdf"] == {
        "type": "continuous",
        "safety_controller": {"soft_lower_limit": -1.0, "k_position": 100.0, "k_velocity": 2.0},
        "calibration": {"rising": 0.3},
    }


def test_a_range_without_end_is_none(tmp_path):
    """1e16 is how some exporters write it; the extras keep the word."""
    inner = (
        "<link name='a'/><link name='b'/><joint name='j' type='revolute'><parent link='a'/><child link='b'/>"
        "<limit lower='-1e16' upper='1e16' effort='0' velocity='0'/></joint>"
    )
    motion = exported(written(tmp_path, inner), tmp_path)
    (made,) = motion.joints
    assert motion.range_of(made.coordinates[0]) == (-math.inf, math.inf)
    assert made.fields["extras"]["urdf"]["limit"]["upper"] == 1e16


def test_an_inertia_without_mass_counts_where_its_link_is_fixed(tmp_path):
    """Pinocchio adds it to the link that carries it."""
    inner = (
        "<link name='a'/><joint name='j' type='continuous'><parent link='a'/><child link='b'/></joint>"
        "<link name='b'><inertial><mass value='2'/><inertia ixx='.1' iyy='.2' izz='.25'/></inertial></link>"
        "<joint name='k' type='fixed'><origin rpy='0 0 1.5707963267948966'/><parent link='b'/><child link='c'/></joint>"
        "<link name='c'><inertial><mass value='0'/><inertia ixx='.01' iyy='.02' izz='.015'/></inertial></link>"
    )
    motion = exported(written(tmp_path, inner), tmp_path)
    mass, _, inertia = motion.mass(motion.object("b"))
    assert mass == 2.0
    assert inertia == pytest.approx(unity_inertia(np.diag([0.12, 0.21, 0.265])))


def test_ranges_without_zero_and_without_width(tmp_path):
    """A joint that cannot stand at zero is exported at the end next to it; one that has a single value holds its links,
    and so does one that follows it."""
    pytest.importorskip("pinocchio", reason="pinocchio (pip install pin) is not installed")
    from engines.urdf import PinocchioModel

    heavy = (
        "<inertial><mass value='2'/><inertia ixx='.1' iyy='.2' izz='.25' ixy='0' ixz='0' iyz='0'/></inertial>"
    )
    links = "".join(f"<link name='{n}'>{heavy}</link>" for n in "abcde")

    def joint(name, kind, parent, child, lower, upper, more=""):
        return (
            f"<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/><origin xyz='.1 .2 .3'/>"
            f"<axis xyz='0 3 4'/><limit lower='{lower}' upper='{upper}' effort='1' velocity='1'/>{more}</joint>"
        )

    joints = (
        joint("away", "prismatic", "a", "b", 0.015, 0.037) + joint("held", "revolute", "b", "c", 0.4, 0.4)
        + joint("after", "revolute", "c", "d", -1, 1, "<mimic joint='held' multiplier='2' offset='-.1'/>")
        + joint("with", "prismatic", "a", "e", -1, 1, "<mimic joint='away' multiplier='-1' offset='.002'/>")
    )  # fmt: skip
    path = written(tmp_path, links + joints)
    report = Report()
    scene = read(path, report)
    assert [j.name for j in scene.joints] == ["away", "with"] and len(scene.couplings) == 1
    assert {"START_AT_END", "LIMITS_AT_ZERO"} <= {d.code for d in report.diagnostics}
    motion, engine = exported(path, tmp_path), PinocchioModel(path)
    assert engine.mobility == 1
    for trial in range(5):
        values, asked = chosen(motion, engine, np.random.default_rng(trial)) if trial else ({}, {})
        poses = motion.poses(motion.coupled(values))
        for link, pose in engine.poses(asked).items():
            assert max(difference(unity_pose(*pose), motion.pose_of(link, poses))) < 1e-9, link


def test_a_base_that_floats_hangs_from_nothing(tmp_path):
    fixed, free = (exported(ARM, tmp_path, floating_base=floating) for floating in (False, True))
    moved = [
        sum(
            c["type"] == "Rigidbody" and not c.get("isKinematic")
            for o in motion.document["gameObjects"]
            for c in o.get("components", ())
        )
        for motion in (free, fixed)
    ]
    assert moved[0] == moved[1] + 1  # the ground's own body is kinematic


def test_what_is_touched_is_apart_from_what_is_drawn(tmp_path):
    inner = (
        "<link name='a'><visual><origin xyz='1 2 3' rpy='0 0 1'/><geometry><box size='.1 .2 .3'/></geometry></visual>"
        "<collision><geometry><cylinder radius='.1' length='.5'/></geometry></collision>"
        "<collision name='ball'><geometry><sphere radius='.2'/></geometry></collision></link><link name='b'/>"
        "<joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>"
    )
    scene = read(written(tmp_path, inner), Report())
    (node,) = (n for n in scene.nodes if n.name == "a")
    assert [(c.kind, c.name) for c in node.colliders] == [
        (ColliderKind.CYLINDER, "collision"), (ColliderKind.SPHERE, "ball"),
    ]  # fmt: skip
    (body,) = node.bodies
    assert body.pose.translation == pytest.approx((2.0, 3.0, 1.0))
    corners = body.pose.point(scene.meshes[body.mesh].vertices) - body.pose.translation
    turned = rotation_rpy(0.0, 0.0, 1.0) @ np.array([0.05, 0.1, 0.15])  # in the source's axes
    assert np.abs(corners - [turned[1], turned[2], turned[0]]).max(axis=1).min() < 1e-12


MESH = "<visual><geometry><mesh filename='{}' {}/></geometry></visual>"
TETRA = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


def robot_with_mesh(folder: Path, uri: str, more: str = "", name: str = "pkg/urdf/r.urdf") -> Path:
    (folder / "pkg" / "meshes").mkdir(parents=True, exist_ok=True)
    (folder / "pkg" / "meshes" / "t.obj").write_text(TETRA, encoding="utf-8")
    return written(folder, f"<link name='a'>{MESH.format(uri, more)}</link>", name)


def loaded(path: Path, folder: Path, **options):
    """Codes of what was said, and the meshes of the scene file."""
    report = Report()
    scene = read(path, report, options=options)
    result = kinefab.export(scene, folder / "m.kinefab", kinefab.ExportOptions(colliders="none"))
    codes = [d.code for d in [*report.diagnostics, *result.report.diagnostics]]
    return codes, json.loads(result.path.read_text("utf-8")).get("meshes", [])


def test_packages_are_found_by_option_environment_and_upwards(tmp_path, monkeypatch):
    for variable in ("ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH"):
        monkeypatch.delenv(variable, raising=False)
    far = robot_with_mesh(
        tmp_path, "package://pkg/meshes/t.obj", name="elsewhere/deep/er/still/and/so/on/far/away/r.urdf"
    )
    assert loaded(far, tmp_path) == (["MESH_NOT_FOUND"], [])
    for given in (tmp_path, tmp_path / "pkg"):
        assert len(loaded(far, tmp_path, package_path=[given])[1]) == 1
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    assert len(loaded(far, tmp_path)[1]) == 1
    monkeypatch.delenv("ROS_PACKAGE_PATH")
    (tmp_path / "ws" / "share").mkdir(parents=True)
    (tmp_path / "pkg").rename(tmp_path / "ws" / "share" / "pkg")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "ws"))
    assert len(loaded(far, tmp_path)[1]) == 1
    monkeypatch.delenv("AMENT_PREFIX_PATH")
    named = robot_with_mesh(tmp_path, "package://other_name/meshes/t.obj")
    assert loaded(named, tmp_path)[0] == ["MESH_NOT_FOUND"]
    manifest = tmp_path / "pkg" / "package.xml"
    manifest.write_text("<package><name>other_name</name></package>", encoding="utf-8")
    assert len(loaded(named, tmp_path)[1]) == 1


def packages_in(folder: Path, *places: str) -> None:
    """Packages of these places, named as their last folders with _pkg, each with one mesh."""
    for place in places:
        (folder / place / "meshes").mkdir(parents=True)
        name = f"{Path(place).name.removesuffix('_pkg')}_pkg"
        (folder / place / "package.xml").write_text(
            f"<package><name>{name}</name></package>", encoding="utf-8"
        )
        (folder / place / "meshes" / "t.obj").write_text(TETRA, encoding="utf-8")


@pytest.mark.parametrize("given", ["ws/src", "ws", "ws/src/vendor"])
def test_a_workspace_holds_its_packages_at_any_depth(tmp_path, given):
    """As ROS finds them: by what the manifest says, none within another, none where a workspace is told to look away."""
    vendor = tmp_path / "ws/src/vendor"
    packages_in(vendor, "robots/arms/tool", "left/deep/out_pkg", "robots/base", "robots/base/a/b/in_pkg")
    (vendor / "left/COLCON_IGNORE").write_text("", encoding="utf-8")
    (vendor / "around").symlink_to(tmp_path / "ws", target_is_directory=True)
    found = Packages(tmp_path / "elsewhere", (tmp_path / given,), {})
    assert found.package("tool_pkg") == vendor / "robots/arms/tool"
    assert found.package("out_pkg") is None and found.package("in_pkg") is None
    assert Packages(tmp_path, (), {"ROS_PACKAGE_PATH": str(tmp_path / given)}).package("tool_pkg") is not None


@pytest.mark.parametrize("kind", ["src", "repository", "side by side", "none"])
def test_a_package_elsewhere_in_the_workspace_of_the_source_is_found(tmp_path, kind):
    """Without being told where: a workspace's src, a repository, or a folder of packages; not any folder above."""
    root = tmp_path / ("src" if kind == "src" else "downloads")
    packages_in(root, "arms/arm_pkg", "tools/deep/tool_pkg")
    if kind == "repository":
        (root / ".git").mkdir()
    if kind == "side by side":
        packages_in(root, "one_pkg", "two_pkg")
    found = Packages(root / "arms/arm_pkg/urdf", (), {}).find("package://tool_pkg/meshes/t.obj")
    assert found.path == (None if kind == "none" else root / "tools/deep/tool_pkg/meshes/t.obj")


@pytest.mark.parametrize("given", [(), ("ws/install",), ("ws/install/tool_pkg",)])
def test_a_package_that_colcon_installed_is_not_the_folder_around_it(tmp_path, given):
    """install/NAME/share/NAME; the source lies in such a package too."""
    packages_in(tmp_path, "ws/install/tool_pkg/share/tool_pkg", "ws/install/arm_pkg/share/arm_pkg")
    folder = tmp_path / "ws/install/arm_pkg/share/arm_pkg/urdf"
    found = Packages(folder, tuple(tmp_path / g for g in given), {}).find("package://tool_pkg/meshes/t.obj")
    assert found.path == tmp_path / "ws/install/tool_pkg/share/tool_pkg/meshes/t.obj"


@pytest.mark.parametrize(
    "uri",
    ["package://tool_pkg//meshes/t.obj", "package:///tool_pkg/meshes/t.obj", "model://tool//t.obj", "model:///tool/t.obj",
     "file://Media/t.obj", "file:///{}/ws/house_pkg/Media/t.obj"],
)  # fmt: skip
def test_names_are_found_where_ros_and_gazebo_find_them(tmp_path, uri):
    """Strokes too much are none; a package of Gazebo's has its models beside its worlds, and media at its top, and is found
    from inside one of its models too."""
    packages_in(tmp_path, "ws/tool_pkg", "ws/house_pkg")
    (tmp_path / "ws/secret.obj").write_text(TETRA, encoding="utf-8")
    for place in ("models/tool", "models/table", "Media", "worlds"):
        (tmp_path / "ws/house_pkg" / place).mkdir(parents=True)
        (tmp_path / "ws/house_pkg" / place / "t.obj").write_text(TETRA, encoding="utf-8")
    (tmp_path / "ws/house_pkg/models/table/model.config").write_text("<model/>", encoding="utf-8")
    for inside in ("worlds", "models/table"):
        packages = Packages(tmp_path / "ws/house_pkg" / inside, (), {})
        found = packages.find(uri.format(tmp_path))
        assert found.path is not None and found.path.name == "t.obj" and found.path.parent.name != inside
        assert packages.find("package://tool_pkg//../secret.obj").outside


def test_a_whole_path_into_a_package_is_one_into_the_package(tmp_path, monkeypatch):
    """What xacro makes of ``file://$(find NAME)``, or of that with a stroke too much, found by the environment, or by a folder that was given from where one stands."""
    pytest.importorskip("xacro", reason="xacro is not installed")
    packages_in(tmp_path, "ws/code/arm_pkg", "ws/code/far/tool_pkg", "ws/hidden/secret_pkg")
    secret = tmp_path / "ws/hidden/secret_pkg/meshes/t.obj"
    found = "$(find tool_pkg)/meshes/t.obj"
    uris = (f"file://{found}", f"file:///{found}", found, secret)
    path = written(
        tmp_path / "ws/code/arm_pkg",
        "".join(f"<link name='l{i}'>{MESH.format(uri, '')}</link>" for i, uri in enumerate(uris))
        + "".join(f"<joint name='j{i}' type='fixed'><parent link='l0'/><child link='l{i}'/></joint>" for i in (1, 2, 3)),
        "r.urdf.xacro",
    )  # fmt: skip
    monkeypatch.chdir(tmp_path / "ws")
    for folders, variable in (([Path("code")], ""), ([], str(tmp_path / "ws" / "code"))):
        monkeypatch.setenv("ROS_PACKAGE_PATH", variable)
        codes, meshes = loaded(path, tmp_path, package_path=folders)
        assert codes == ["MESH_OUTSIDE"] and len(meshes) == 1
    monkeypatch.delenv("ROS_PACKAGE_PATH")
    with pytest.raises(kinefab.KinefabError, match=r"expanded: there is no package 'tool_pkg'\."):
        read(path, Report())


def test_names_that_lead_out_of_the_package_are_not_followed(tmp_path):
    path = robot_with_mesh(tmp_path, "package://pkg/../secret.obj")
    (tmp_path / "secret.obj").write_text(TETRA, encoding="utf-8")
    (tmp_path / "pkg" / "package.xml").write_text("<package><name>pkg</name></package>", encoding="utf-8")
    assert loaded(path, tmp_path) == (["MESH_OUTSIDE"], [])
    relative = robot_with_mesh(tmp_path, "../../secret.obj")
    assert loaded(relative, tmp_path) == (["MESH_OUTSIDE"], [])
    assert len(loaded(robot_with_mesh(tmp_path, "../meshes/t.obj"), tmp_path)[1]) == 1


def test_a_name_may_climb_into_a_folder_that_was_given(tmp_path):
    folder, meshes = tmp_path / "a" / "b" / "c" / "d" / "e", tmp_path / "a" / "meshes"
    folder.mkdir(parents=True)
    meshes.mkdir()
    (meshes / "m.stl").write_bytes(b"")
    up = "../../../../meshes/m.stl"
    assert Packages(folder, (), {}).find(up).path is None
    assert Packages(folder, (meshes,), {}).find(up).path == meshes / "m.stl"


def test_a_mesh_is_scaled_along_its_own_axes(tmp_path):
    path = robot_with_mesh(tmp_path, "package://pkg/meshes/t.obj", "scale='0.1 0.2 -0.5'")
    _, (mesh,) = loaded(path, tmp_path)
    # x y z of the file, scaled, are z x y of the scene, and -y z x of Unity.
    assert np.abs(mesh["bounds"]["extents"]) == pytest.approx((0.2, 0.75, 0.05))
    assert mesh["bounds"]["center"] == pytest.approx((-0.2, -0.75, 0.05))


COLLADA = """<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>
<unit name="centimeter" meter="0.01"/><up_axis>{}</up_axis></asset>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="f" count="12">0 0 0 10 0 0 0 20 0 0 0 30</float_array>
<technique_common><accessor source="#f" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles></mesh></geometry>
</library_geometries><library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>"""


@pytest.mark.parametrize("up", ["Z_UP", "Y_UP"])
def test_collada_has_its_unit_and_lies_as_ros_lays_it(tmp_path, up):
    pytest.importorskip("collada", reason="pycollada is not installed")
    path = robot_with_mesh(tmp_path, "package://pkg/meshes/t.dae")
    (tmp_path / "pkg" / "meshes" / "t.dae").write_text(COLLADA.format(up), encoding="utf-8")
    codes, (mesh,) = loaded(path, tmp_path)
    assert np.array(mesh["bounds"]["extents"]) == pytest.approx((0.1, 0.15, 0.05))
    assert codes == (["COLLADA_UP_AXIS"] if up == "Y_UP" else [])


@pytest.mark.parametrize("tag, told", [("visual", ["MESH_LOOK"]), ("collision", [])])
def test_the_looks_of_what_only_collides_are_no_loss(tmp_path, tag, told):
    pytest.importorskip("collada", reason="pycollada is not installed")
    path = robot_with_mesh(tmp_path, "package://pkg/meshes/t.dae")
    path.write_text(path.read_text("utf-8").replace("visual", tag), encoding="utf-8")
    faint = "<library_effects><effect id='e'><profile_COMMON><technique sid='c'><lambert><transparency><float>.5</float>"
    faint += "</transparency></lambert></technique></profile_COMMON></effect></library_effects><library_geometries>"
    text = COLLADA.format("Z_UP").replace("<library_geometries>", faint)
    (tmp_path / "pkg" / "meshes" / "t.dae").write_text(text, encoding="utf-8")
    result = kinefab.export(path, tmp_path / "m.kinefab")
    assert [d.code for d in result.report.diagnostics if d.code == "MESH_LOOK"] == told
    assert json.loads(result.path.read_text("utf-8"))["meshes"]


def test_materials_by_name_may_stand_anywhere(tmp_path):
    inner = (
        "<link name='a'><visual><geometry><sphere radius='1'/></geometry><material name='red'/></visual></link>"
        "<link name='b'><visual><geometry><sphere radius='1'/></geometry><material name='red'><color rgba='1 .2 .1 .5'/>"
        "</material></visual></link><joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>"
    )
    scene = read(written(tmp_path, inner), Report())
    (surface,) = scene.surfaces
    assert (
        surface.name == "red"
        and surface.color == (1.0, linear(0.2), linear(0.1), 0.5)
        and surface.alpha_mode.value == "blend"
    )
    assert [body.surfaces for body in scene.nodes[1].bodies] == [(0,), (0,)]


def test_a_colour_of_three_numbers_is_opaque(tmp_path):
    inner = (
        "<link name='a'><visual><geometry><sphere radius='1'/></geometry>"
        "<material name='red'><color rgba='1 .2 .1'/></material></visual></link>"
    )
    report = Report()
    (surface,) = read(written(tmp_path, inner), report).surfaces
    assert surface.color == (1.0, linear(0.2), linear(0.1), 1.0) and surface.alpha_mode.value == "opaque"
    assert report.diagnostics == []


PAINTED = {
    "r.urdf": "<robot name='r'><link name='a'><visual><geometry><box size='1 2 3'/></geometry>"
    "<material name='m'><color rgba='.2 .4 .6 1'/></material></visual></link></robot>",
    "r.sdf": "<sdf version='1.9'><model name='r'><link name='a'><visual name='v'><geometry><box><size>1 2 3</size></box>"
    "</geometry><material><diffuse>.2 .4 .6</diffuse></material></visual></link></model></sdf>",
    "r.xml": "<mujoco><worldbody><body><geom type='box' size='1 2 3' rgba='.2 .4 .6 1'/></body></worldbody></mujoco>",
}


@pytest.mark.parametrize("name", PAINTED)
def test_a_colour_is_the_one_that_the_screen_shows(tmp_path, name):
    """RViz, Gazebo and MuJoCo show the file's numbers; so do Unity's materials, which state them, and a scene's are linear."""
    if name == "r.xml":
        pytest.importorskip("mujoco", reason="mujoco is not installed")
    path = tmp_path / name
    path.write_text(PAINTED[name], encoding="utf-8")
    (surface,) = read(path, Report()).surfaces
    assert surface.color == pytest.approx((0.0331047666, 0.1328683216, 0.3185467781, 1.0))
    kinefab.export(path, tmp_path / "R.prefab")
    stated = re.search(
        r"- _Color: \{r: (.*), g: (.*), b: (.*), a: 1\}", next(tmp_path.rglob("*.mat")).read_text("utf-8")
    )
    assert [float(v) for v in stated.groups()] == pytest.approx([0.2, 0.4, 0.6], abs=1e-6)


def test_a_plane_collides_as_a_box_below_it():
    report = Report()
    collider = Shapes([], report).collider("floor", Shape("plane", (2.0, 3.0)), Pose())
    assert collider.kind is ColliderKind.BOX and collider.size == (2.0, 3.0, 0.1)
    assert collider.pose.translation == pytest.approx((0.0, -0.05, 0.0))
    assert [d.code for d in report.diagnostics] == ["COLLIDER_PLANE_AS_BOX"]


def test_xacro_is_expanded_with_arguments_and_packages(tmp_path):
    pytest.importorskip("xacro", reason="xacro is not installed")
    (tmp_path / "pkg").mkdir()
    (tmp_path / "pkg" / "more.xacro").write_text(
        "<robot xmlns:xacro='http://ros.org/wiki/xacro'><xacro:macro name='arm' params='n'><link name='${n}'/>"
        "<joint name='to_${n}' type='revolute'><parent link='a'/><child link='${n}'/><axis xyz='0 0 1'/>"
        "<limit lower='-${pi/18}' upper='${radians(80)}' effort='1' velocity='1'/></joint></xacro:macro></robot>",
        encoding="utf-8",
    )
    path = tmp_path / "r.urdf.xacro"
    path.write_text(
        "<robot name='r' xmlns:xacro='http://ros.org/wiki/xacro'><xacro:arg name='who' default='x'/>"
        "<xacro:include filename='$(find pkg)/more.xacro'/><link name='a'/><xacro:arm n='$(arg who)'/></robot>",
        encoding="utf-8",
    )
    motion = exported(path, tmp_path, xacro_arg=["who:=elbow"])
    (coordinate,) = motion.joint("to_elbow").coordinates
    assert motion.range_of(coordinate) == pytest.approx((-10.0, 80.0))


@pytest.mark.parametrize("argument", ["who=elbow", ":=elbow", "elbow"])
def test_an_argument_without_name_or_value_is_told(tmp_path, argument):
    pytest.importorskip("xacro", reason="xacro is not installed")
    path = tmp_path / "r.xacro"
    path.write_text(
        "<robot name='r' xmlns:xacro='http://ros.org/wiki/xacro'><xacro:arg name='who' default='x'/>"
        "<xacro:arg name='side' default='y'/><link name='$(arg who)_$(arg side)'/></robot>",
        encoding="utf-8",
    )
    report = Report()
    scene = read(path, report, options={"xacro_arg": [argument, "side:=left"]})
    assert [node.name for node in scene.nodes] == ["r", "x_left"]
    assert [(d.code, d.severity.value) for d in report.diagnostics] == [("XACRO_ARGUMENT", "warning")]
    assert argument in report.diagnostics[0].message


def test_arguments_beside_a_urdf_are_used_or_told(tmp_path):
    """A plain one has no use for them; one in which elements of xacro stand takes them, and tells one without a value."""
    pytest.importorskip("xacro", reason="xacro is not installed")
    plain, left = tmp_path / "plain.urdf", tmp_path / "left.urdf"
    plain.write_text("<robot name='r'><link name='l'/></robot>", encoding="utf-8")
    left.write_text(
        "<robot name='r' xmlns:xacro='http://ros.org/wiki/xacro'><xacro:arg name='side' default='y'/>"
        "<link name='$(arg side)'/></robot>",
        encoding="utf-8",
    )
    for path, names, code in (
        (plain, ["r", "l"], "SOURCE_OPTION_UNUSED"),
        (left, ["r", "left"], "XACRO_ARGUMENT"),
    ):
        report = Report()
        scene = read(path, report, options={"xacro_arg": ["who=elbow", "side:=left"]})
        assert [node.name for node in scene.nodes] == names
        assert [d.code for d in report.diagnostics] == [code]
    report = Report()
    read(plain, report)
    assert report.diagnostics == []


def test_the_engine_is_given_what_xacro_makes(tmp_path):
    """A package whose folder has another name than its package.xml; without such a package the engine refuses."""
    pytest.importorskip("xacro", reason="xacro is not installed")
    pytest.importorskip("pinocchio", reason="pinocchio (pip install pin) is not installed")
    from engines import Refused
    from engines.urdf import PinocchioModel

    heavy = (
        "<inertial><mass value='2'/><inertia ixx='.1' iyy='.2' izz='.25' ixy='0' ixz='0' iyz='0'/></inertial>"
    )
    package = tmp_path / "ws" / "arm_folder"
    package.mkdir(parents=True)
    (package / "package.xml").write_text("<package><name> arm_of_two </name></package>", encoding="utf-8")
    (package / "more.xacro").write_text(
        "<robot xmlns:xacro='http://ros.org/wiki/xacro'><xacro:macro name='arm' params='n limits'>"
        f"<link name='${{n}}'>{heavy}</link><joint name='to_${{n}}' type='revolute'><parent link='a'/><child link='${{n}}'/>"
        "<origin xyz='.1 -.2 .3'/><axis xyz='0 3 4'/><limit ${limits} effort='1' velocity='1'/></joint></xacro:macro></robot>"
        .replace("${limits}", "lower='${limits[0]}' upper='${limits[1]}'"),
        encoding="utf-8",
    )  # fmt: skip
    path = (
        tmp_path / "one" / "r.urdf.xacro"
    )  # the engine looks four folders up, and others write below the fifth
    path.parent.mkdir()
    path.write_text(
        "<robot name='r' xmlns:xacro='http://ros.org/wiki/xacro'><xacro:include filename='$(find arm_of_two)/more.xacro'/>"
        f"<link name='a'>{heavy}</link><xacro:arm n='b' limits='${{[-pi/18, radians(80)]}}'/>"
        "<xacro:arm n='c' limits='${[1, -1]}'/></robot>",
        encoding="utf-8",
    )
    engine = PinocchioModel(path, (tmp_path / "ws",))
    limits = {j.name: (j.lower, j.upper) for j in engine.joints}
    assert limits["to_b"] == pytest.approx((-math.pi / 18, math.radians(80)))
    assert limits["to_c"] == (-math.inf, math.inf) and engine.mobility == 2  # a reversed range holds nothing
    motion = exported(path, tmp_path, package_path=[str(tmp_path / "ws")])
    values, asked = chosen(motion, engine, np.random.default_rng(14))
    poses = motion.poses(values)
    for link, pose in engine.poses(asked).items():
        assert max(difference(unity_pose(*pose), motion.pose_of(link, poses))) < 1e-9, link
    path.write_text(path.read_text("utf-8").replace("arm_of_two", "nobodys"), encoding="utf-8")
    with pytest.raises(Refused, match="nobodys"):
        PinocchioModel(path, (tmp_path / "ws",))
