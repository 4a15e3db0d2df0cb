"""USD: what engines make of an exported stage.  PhysX 5 itself (ovphysx, on the CPU) as an articulation, 1 s under gravity, against
the exact solver of the same export in C#; Newton's bodies where it imports them (where ``newton`` is installed).

Found: a double pendulum of asymmetric links is 0.001 m from the exact solver after a second of steps of 1 ms, half that at half the step; the lever, a closed
loop in a horizontal plane, stays within 1e-6 m of where it was drawn.
"""

from __future__ import annotations

import json
import math
import subprocess
from dataclasses import replace
from pathlib import Path

import kinefab
import numpy as np
import pytest
from golden import FIXTURES
from kinefab.diagnostics import Outcome
from kinefab.model import (
    RX,
    Coupling,
    CouplingKind,
    Freedom,
    Joint,
    JointKind,
    MassProperties,
    Motion,
    Node,
    Scene,
    Term,
    freedoms_of,
)
from kinefab.spatial import Pose, rotation_about, rotation_exp
from scene_kinematics import (
    WORLD,
    SceneKinematics,
    compose,
    difference,
    inverse,
    matrix_of,
    unity_point,
)
from test_dynamics_physx5 import PYTHON, TOOL, physx5

pytest.importorskip("pxr", reason="usd-core is not installed")
from pxr import Usd, UsdGeom  # noqa: E402
from usd_roundtrip import sources  # noqa: E402

needs_physx = pytest.mark.skipif(
    PYTHON is None, reason="ovphysx is not installed, and KINEFAB_OVPHYSX names no Python that has it"
)
BARE = kinefab.ExportOptions(colliders="none")


def double_pendulum() -> Scene:
    """A grounded base and two links askew, hinged about a tilted axis; it turns slower than Unity's 7 rad/s."""
    axis = rotation_exp(np.array([0.3, 0.2, 0.1]))
    nodes = [Node("Base", "Base", grounded=True, pose=Pose(axis, np.array([0.1, 1.0, -0.2])))]
    joints = []
    at = nodes[0].pose
    for i, (angle, mass, length) in enumerate(((0.5, 2.0, 0.6), (-0.3, 0.7, 0.4))):
        start = at @ Pose(rotation_about(np.array([1.0, 0, 0]), angle))
        inertia = np.array([[0.06, 0.001, 0.0], [0.001, 0.05, 0.002], [0.0, 0.002, 0.03]]) * mass
        weight = MassProperties(mass, np.array([0.02, -0.5 * length, 0.01]), inertia)
        name = f"Link{i}"
        nodes.append(Node(name, name, pose=start, mass=weight))
        frame = at if i == 0 else Pose(np.eye(3), np.array([0.0, -0.6, 0.0]))
        own = nodes[0].pose.inverse() @ frame if i == 0 else frame
        joints.append(
            Joint(f"J{i}", JointKind.REVOLUTE, i, i + 1, own, Pose(), freedoms_of(JointKind.REVOLUTE))
        )
        at = start @ Pose(np.eye(3), np.array([0.0, -length, 0.0]))
    return Scene(nodes, joints=joints)


def exact(path: Path, seconds: float, step: float) -> dict[str, np.ndarray]:
    """Positions of each body by its id, in Unity's frame."""
    written = path.with_suffix(".moved.json")
    command = [
        str(TOOL),
        "simulate",
        str(path),
        "--seconds",
        str(seconds),
        "--step",
        str(step),
        "-o",
        str(written),
    ]
    subprocess.run([*command, "--solver", "exact"], check=True, capture_output=True, timeout=300)
    bodies = json.loads(written.read_text("utf-8"))["bodies"]
    return {entry["id"]: np.array(entry["poses"])[1:, :3] for entry in bodies}


@needs_physx
@pytest.mark.skipif(TOOL is None, reason="dotnet-kinefab is not on the PATH")
def test_an_articulation_swings_as_the_exact_solver_has_it(tmp_path):
    scene, step = double_pendulum(), 0.0005
    stage = kinefab.export(scene, tmp_path / "swing.usda", BARE).path
    found = physx5(stage, 1.0, step, ["/swing/Link0", "/swing/Link1"])
    found = found[..., [2, 0, 1]] * (
        -1.0,
        -1.0,
        1.0,
    )  # that helper takes a stage with Z up; this one has Y up
    expected = exact(kinefab.export(scene, tmp_path / "swing.kinefab", BARE).path, 1.0, step)
    assert float(np.ptp(expected["Link1"], axis=0).max()) > 0.1
    for i, name in enumerate(("Link0", "Link1")):
        apart = float(np.abs(found[:, i] - expected[name][: len(found)]).max())
        assert apart < 1e-3, name


@needs_physx
def test_a_closed_loop_stands_still_where_gravity_moves_nothing(tmp_path):
    """Three joints of the articulation and one that closes it, in PhysX 5, 1 s."""
    result = kinefab.export(FIXTURES / "lever" / "lever.bundle.json", tmp_path / "lever.usda", BARE)
    names = ["Crank_1", "BarC_1", "SliderD_1"]
    found = physx5(result.path, 1.0, 1.0 / 240.0, [f"/Lever/{name}" for name in names])
    drawn = [
        next(
            n.pose.translation
            for n in result.analysed.scene.nodes
            if n.id == f"Lever/{name.replace('_', ':')}"
        )
        for name in names
    ]
    assert float(np.abs(found - np.array([unity_point(p) for p in drawn])).max()) < 1e-6


@needs_physx
@pytest.mark.parametrize("terms", [{"H0": -0.5}, {"H0": -0.5, "H1": 0.2}])
def test_joints_without_ends_are_coupled(tmp_path, terms):
    """Three weights that fall about one axis, the third by ratios of the others: by one mimic, and by two and a light link."""
    scene = Scene([Node("Base", "Base", grounded=True)])
    for i in range(3):
        place = Pose(np.eye(3), np.array([1.0 + i, 0.0, 0.3]))
        inertia = np.diag([0.02, 0.03, 0.04])
        scene.nodes.append(
            Node(f"Link{i}", f"Link{i}", pose=place, mass=MassProperties(2.0 - 0.5 * i, np.zeros(3), inertia))
        )
        hinge = JointKind.REVOLUTE
        on, off = Pose(np.eye(3), np.array([1.0 + i, 0.0, 0.0])), Pose(np.eye(3), np.array([0.0, 0.0, -0.3]))
        scene.joints.append(Joint(f"H{i}", hinge, 0, i + 1, on, off, freedoms_of(hinge)))
    told = tuple(Term(name, RX, ratio) for name, ratio in terms.items())
    scene.couplings.append(Coupling("Sum", CouplingKind.LINEAR, "H2", RX, told))
    stage = kinefab.export(scene, tmp_path / "fall.usda", BARE)
    assert {o.outcome for o in stage.report.outcomes} == {Outcome.KEPT}
    found = physx5(stage.path, 0.6, 0.001, [f"/fall/Link{i}" for i in range(3)])
    places = found[..., [2, 0, 1]] * (-1.0, -1.0, 1.0)
    angles = np.unwrap(np.arctan2(-places[..., 1], places[..., 2]), axis=0)
    assert float(np.ptp(angles[:, 0])) > 0.3
    follows = sum(ratio * angles[:, int(name[1])] for name, ratio in terms.items())
    assert float(np.abs(angles[:, 2] - follows).max()) < 3e-5


@needs_physx
@pytest.mark.parametrize("turns", [False, True])
def test_physx_holds_a_range_that_has_one_end(tmp_path, turns):
    """A slide and a slide that turns fall to where their range ends; with infinity at the other end PhysX refused both."""
    limits = (-0.1, math.inf)
    scene = kinefab.Scene()
    base = scene.add_part("Base", grounded=True, mass=MassProperties(1.0, np.zeros(3), np.eye(3)))
    rod = scene.add_part("Rod", translation=(0.2, 1.0, 0.3), mass=MassProperties(1.0, np.zeros(3), np.eye(3)))
    kind = JointKind.CYLINDRICAL if turns else JointKind.PRISMATIC
    scene.add_joint(kind.value, base, rod, point=(0.2, 1.0, 0.3), axis=(0, 1, 0))
    slide = Freedom(Motion.LIMITED, *limits)
    joint = scene.joints[0]
    scene.joints[0] = replace(joint, freedoms=(slide, *joint.freedoms[1:]))
    stage = kinefab.export(scene, tmp_path / "fall.usda", BARE)
    height = -physx5(stage.path, 0.6, 0.001, ["/fall/Rod"])[:, 0, 0]  # of a stage whose Y is up
    assert height[-1] == pytest.approx(0.9, abs=2e-3) and height[5] > 0.99


def in_newton(stage: Path):
    """Newton and its model of a stage."""
    newton = pytest.importorskip("newton", reason="newton is not installed")
    pytest.importorskip("newton_usd_schemas", reason="newton's importers are not installed")
    from newton.usd import SchemaResolverNewton, SchemaResolverPhysx

    builder = newton.ModelBuilder(up_axis=newton.Axis.Y)
    builder.add_usd(str(stage), schema_resolvers=[SchemaResolverNewton(), SchemaResolverPhysx()])
    return newton, builder.finalize()


def newton_poses(newton, model, moved: dict[int, float]) -> list:
    """Of each body, in the stage's frame.  moved: what is added to joint coordinates, by their number."""
    import warp

    q = model.joint_q.numpy().copy()
    for number, more in moved.items():
        q[number] += more
    state = model.state()
    newton.eval_fk(model, warp.array(q, dtype=float), model.joint_qd, state)
    return [(matrix_of(p[3:]), p[:3].astype(float)) for p in state.body_q.numpy()]


@pytest.mark.parametrize("source", ["lever/lever.bundle.json", "twins/arm.urdf", "twins/fourbar.bundle.json"])
def test_newton_puts_the_bodies_where_they_stand(tmp_path, source):
    """By its own forward kinematics from the joints' states, loops among them; masses and axes of inertia by the way."""
    result = kinefab.export(FIXTURES / source, tmp_path / "stage.usda", BARE)
    newton, model = in_newton(result.path)
    cache = UsdGeom.XformCache()
    stage = Usd.Stage.Open(str(result.path))
    assert model.body_count > 3
    for label, (rotation, place) in zip(model.body_label, newton_poses(newton, model, {})):
        world = cache.GetLocalToWorldTransform(stage.GetPrimAtPath(label))
        assert np.allclose(place, world.ExtractTranslation(), atol=2e-6)
        assert np.allclose(rotation, np.array(world.ExtractRotationMatrix()).T, atol=2e-5)


@pytest.mark.parametrize(
    "source",
    ["twins/arm.urdf", "mechanisms/M14.bundle.json", "mechanisms/M27.bundle.json", "mechanisms/M42.bundle.json", "mechanisms/M43.bundle.json"],
)  # fmt: skip
def test_newton_moves_each_joint_as_unity_does(tmp_path, source):
    """Each hinge and slide of its articulation by a fifth of a radian or a metre, the sense of its range by that; of the fixtures
    some have joints that are written the other way round, or chains of couplings, and Newton refused them once."""
    scene = SceneKinematics.load(kinefab.export(FIXTURES / source, tmp_path / "scene.kinefab", BARE).path)
    result = kinefab.export(FIXTURES / source, tmp_path / "stage.usda", BARE)
    newton, model = in_newton(result.path)
    told, objects = sources(result.path), {entry["id"]: i for i, entry in enumerate(scene.objects)}
    number = [objects.get(told.get(label[1:], "")) for label in model.body_label]
    number = [
        i if i is not None and scene.body_of[i] == i else None for i in number
    ]  # what is fixed is the ground's
    mirror = np.diag([-1.0, 1.0, 1.0])
    for i, (rotation, place) in zip(number, newton_poses(newton, model, {})):
        if i is not None:
            assert max(difference((mirror @ rotation @ mirror, mirror @ place), scene.placed[i])) < 1e-5
    grounds = {None, *(i for i, entry in enumerate(scene.objects) if entry["id"] == "kinefab:ground")}
    checked = 0
    kinds = {int(newton.JointType.REVOLUTE): True, int(newton.JointType.PRISMATIC): False}
    for j, kind in enumerate(model.joint_type.numpy().tolist()):
        parent, child = (int(side.numpy()[j]) for side in (model.joint_parent, model.joint_child))
        ends = {number[child], None if parent < 0 else number[parent]}
        found = [
            s for s in scene.joints if {scene.body_of[s.game_object], s.connected} - grounds == ends - {None}
        ]
        if kind not in kinds or len(found) != 1 or len(found[0].coordinates) != 1 or found[0].closure:
            continue
        name = model.joint_label[j]
        (coordinate,) = found[0].coordinates
        turns, first = kinds[kind], int(model.joint_q_start.numpy()[j])
        moved = newton_poses(newton, model, {first: 0.2})
        above = moved[parent] if parent >= 0 else WORLD
        rotation, place = compose(inverse(above), moved[child])
        expected = (mirror @ rotation @ mirror, mirror @ place)
        on = None if parent < 0 else number[parent]
        senses = []
        for sense in (1.0, -1.0):
            poses = scene.poses({coordinate: sense * (math.degrees(0.2) if turns else 0.2)})
            relative = compose(inverse(WORLD if on is None else poses[on]), poses[number[child]])
            if max(difference(relative, expected)) < 1e-5:
                senses.append(sense)
        assert len(senses) == 1, name
        unit = math.degrees(1.0) if turns else 1.0
        q = float(model.joint_q.numpy()[first])
        dof = int(model.joint_qd_start.numpy()[j])
        ends = [
            (float(limits.numpy()[dof]) - q) * unit
            for limits in (model.joint_limit_lower, model.joint_limit_upper)
        ]
        ends = sorted(senses[0] * (end if abs(end) < 1e5 else math.copysign(math.inf, end)) for end in ends)
        assert ends == pytest.approx(scene.range_of(coordinate), abs=1e-3), name
        checked += 1
    assert checked > 1
