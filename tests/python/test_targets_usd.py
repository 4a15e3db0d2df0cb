"""USD: what pxr finds in the file, in the units of its schemas; validators of OpenUSD; files that are whole or not there."""

from __future__ import annotations

import math
import os
import subprocess
import sys
import warnings
import zipfile
from dataclasses import replace
from pathlib import Path

import kinefab
import numpy as np
import pytest
from golden import FIXTURES, golden_pairs
from kinefab import model
from kinefab.diagnostics import Outcome, Report
from kinefab.model import Body, Collider, ColliderKind, Freedom, JointKind, Motion, Node, Scene
from kinefab.sources import read
from kinefab.spatial import Pose
from prefab_scenes import block, rich_scene, turned
from test_targets_gltf import robot

pytest.importorskip("pxr", reason="usd-core is not installed")
from pxr import Gf, Sdf, Usd, UsdGeom, UsdPhysics, UsdShade, UsdValidation  # noqa: E402
from test_targets_usd_roundtrip import HINGE, SLIDE, scene_of  # noqa: E402

ENDINGS = (".usda", ".usdc", ".usdz")
LEVER = FIXTURES / "lever" / "lever.bundle.json"


def opened(source, path: Path, **options):
    result = kinefab.export(source, path, kinefab.ExportOptions(**options))
    return Usd.Stage.Open(str(result.path)), result


def codes(result, *outcomes: Outcome) -> set[str]:
    return {o.code for o in result.report.outcomes if o.outcome in (outcomes or tuple(Outcome)) and o.code}


def complaints(stage) -> list[str]:
    """Of all validators that OpenUSD brings."""
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    assert len(validators) > 20
    return [e.GetMessage() for e in UsdValidation.ValidationContext(validators).Validate(stage)]


@pytest.mark.parametrize("ending", ENDINGS)
def test_openusds_validators_find_nothing(tmp_path, ending):
    for name, source in (("Lever", LEVER), ("Robot", robot()), ("Rich", rich_scene(tmp_path))):
        stage, _ = opened(source, tmp_path / f"{name}{ending}")
        assert complaints(stage) == []


def test_the_validators_find_what_is_wrong(tmp_path):
    """A joint to a prim that is not there."""
    stage, _ = opened(robot(), tmp_path / "robot.usda")
    UsdPhysics.Joint(stage.GetPrimAtPath("/robot/Joints/Hinge")).GetBody1Rel().SetTargets(["/robot/Nowhere"])
    assert complaints(stage) != []


@pytest.mark.parametrize("ending", ENDINGS)
def test_the_same_scene_gives_the_same_bytes(tmp_path, ending):
    """In other processes too, whatever their seeds of hashing."""
    script = (
        "import sys, kinefab\nfrom pathlib import Path\nfrom prefab_scenes import rich_scene\n"
        "kinefab.export(rich_scene(Path(sys.argv[1])), sys.argv[2])"
    )
    written = []
    for seed in ("1", "2"):
        (tmp_path / seed).mkdir()
        target = tmp_path / seed / f"same{ending}"
        environment = {**os.environ, "PYTHONHASHSEED": seed}
        environment["PYTHONPATH"] = os.pathsep.join(sys.path)
        subprocess.run(
            [sys.executable, "-c", script, str(tmp_path / seed), str(target)], check=True, env=environment
        )
        written.append(target.read_bytes())
    assert written[0] == written[1]


def test_units_axes_and_the_default_prim(tmp_path):
    stage, _ = opened(LEVER, tmp_path / "lever.usda")
    assert UsdGeom.GetStageUpAxis(stage) == "Y" and UsdGeom.GetStageMetersPerUnit(stage) == 1.0
    assert UsdPhysics.GetStageKilogramsPerUnit(stage) == 1.0
    assert stage.GetDefaultPrim().GetPath() == "/Lever"
    scene = UsdPhysics.Scene(stage.GetPrimAtPath("/PhysicsScene"))
    assert scene.GetGravityMagnitudeAttr().Get() == pytest.approx(9.81)
    assert scene.GetGravityDirectionAttr().Get() == Gf.Vec3f(0, -1, 0)


def test_angles_are_degrees_and_gains_per_degree(tmp_path):
    stage, _ = opened(scene_of(JointKind.REVOLUTE, rx=HINGE), tmp_path / "hinge.usda")
    prim = stage.GetPrimAtPath("/hinge/Joints/J")
    hinge, drive = UsdPhysics.RevoluteJoint(prim), UsdPhysics.DriveAPI(prim, "angular")
    assert (hinge.GetLowerLimitAttr().Get(), hinge.GetUpperLimitAttr().Get()) == pytest.approx((-10.0, 80.0))
    assert hinge.GetAxisAttr().Get() == "X" and hinge.GetBreakForceAttr().Get() == 300.0
    assert drive.GetStiffnessAttr().Get() == pytest.approx(math.radians(30.0))
    assert drive.GetDampingAttr().Get() == pytest.approx(math.radians(4.0))
    assert drive.GetTargetPositionAttr().Get() == pytest.approx(math.degrees(0.4))
    assert drive.GetTargetVelocityAttr().Get() == pytest.approx(math.degrees(0.2))
    assert drive.GetMaxForceAttr().Get() == pytest.approx(7.0)
    assert prim.GetAttribute("physxLimit:angular:restitution").Get() == pytest.approx(0.3)
    assert prim.GetAttribute("state:angular:physics:position").Get() == pytest.approx(math.degrees(0.3))


def test_generic_joints_name_every_freedom(tmp_path):
    stage, _ = opened(scene_of(JointKind.CYLINDRICAL, tx=SLIDE, rx=HINGE), tmp_path / "pipe.usda")
    prim = stage.GetPrimAtPath("/pipe/Joints/J")
    assert prim.GetTypeName() == "PhysicsJoint"
    ends = {
        name: (
            UsdPhysics.LimitAPI(prim, name).GetLowAttr().Get(),
            UsdPhysics.LimitAPI(prim, name).GetHighAttr().Get(),
        )
        for name in ("transX", "transY", "transZ", "rotX", "rotY", "rotZ")
    }
    assert ends["transX"] == pytest.approx((-0.02, 0.1)) and ends["rotX"] == pytest.approx((-10, 80))
    assert all(low > high for name, (low, high) in ends.items() if name not in ("transX", "rotX"))
    assert UsdPhysics.DriveAPI(prim, "transX").GetStiffnessAttr().Get() == 300.0


def test_both_frames_of_a_joint_meet_where_the_bodies_stand(tmp_path):
    """By pxr's own matrices: body 0 is what the model calls a, body 1 is b, and only the free axis has turned."""
    stage, result = opened(scene_of(JointKind.REVOLUTE, rx=HINGE), tmp_path / "hinge.usda")
    joint = UsdPhysics.Joint(stage.GetPrimAtPath("/hinge/Joints/J"))
    worlds = []
    for body, place, turn in (
        (joint.GetBody0Rel(), joint.GetLocalPos0Attr(), joint.GetLocalRot0Attr()),
        (joint.GetBody1Rel(), joint.GetLocalPos1Attr(), joint.GetLocalRot1Attr()),
    ):
        own = Gf.Matrix4d(Gf.Rotation(Gf.Quatd(turn.Get())), Gf.Vec3d(place.Get()))
        target = stage.GetPrimAtPath(body.GetTargets()[0])
        worlds.append(np.array(own * UsdGeom.XformCache().GetLocalToWorldTransform(target)).T)
    found = np.linalg.inv(worlds[0]) @ worlds[1]
    assert np.allclose(found[:3, 3], 0.0, atol=1e-6) and np.allclose(found[:3, 0], [1, 0, 0], atol=1e-6)
    assert math.atan2(found[2, 1], found[1, 1]) == pytest.approx(0.3, abs=1e-6)
    assert [n.name for n in result.analysed.scene.nodes] == ["A", "B"]


def test_a_robots_base_is_a_link_and_its_loop_is_left_out_of_the_articulation(tmp_path):
    stage, _ = opened(LEVER, tmp_path / "lever.usda")
    roots = [p for p in stage.Traverse() if p.HasAPI(UsdPhysics.ArticulationRootAPI)]
    assert [p.GetPath().name for p in roots] == ["Base_1_fixed"]
    base = UsdPhysics.FixedJoint(roots[0])
    assert base.GetBody0Rel().GetTargets() == ["/Lever"] and base.GetBody1Rel().GetTargets() == [
        "/Lever/Base_1"
    ]
    joints = [UsdPhysics.Joint(p) for p in stage.Traverse() if p.IsA(UsdPhysics.Joint)]
    outside = [j.GetPath().name for j in joints if j.GetExcludeFromArticulationAttr().Get()]
    assert len(joints) == 5 and len(outside) == 1  # four joints of a loop of four bodies, and the base's
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # newer releases have it by another name
        ranges = UsdPhysics.LoadUsdPhysicsFromRange(stage, ["/"])
    (found,) = ranges[UsdPhysics.ObjectType.Articulation][1]
    assert [p.name for p in found.rootPrims] == ["Base_1_fixed"] and len(
        set(found.articulatedBodies) - {Sdf.Path.emptyPath}
    ) == 4


def test_what_hangs_on_nothing_begins_at_its_first_body(tmp_path):
    stage, _ = opened(scene_of(JointKind.SPHERICAL, grounded=False), tmp_path / "pair.usda")
    joint = UsdPhysics.Joint(stage.GetPrimAtPath("/pair/Joints/J"))
    assert joint.GetExcludeFromArticulationAttr().Get()  # it breaks, which no articulation does
    scene = scene_of(JointKind.SPHERICAL, grounded=False)
    scene.joints[0] = replace(scene.joints[0], break_force=math.inf, break_torque=math.inf)
    stage, _ = opened(scene, tmp_path / "tree.usda")
    roots = [p.GetPath() for p in stage.Traverse() if p.HasAPI(UsdPhysics.ArticulationRootAPI)]
    assert roots == ["/tree/A"] and stage.GetPrimAtPath("/tree/Joints/J").IsA(UsdPhysics.SphericalJoint)


def test_a_grounded_part_that_nothing_names_is_static(tmp_path):
    scene = scene_of(JointKind.REVOLUTE)
    scene.meshes.append(block("Plate", (0.4, 0.02, 0.3)))
    scene.nodes.append(Node("Floor", "Floor", grounded=True, bodies=(Body("Plate", 0),)))
    stage, _ = opened(scene, tmp_path / "cell.usda")
    assert not stage.GetPrimAtPath("/cell/Floor").HasAPI(UsdPhysics.RigidBodyAPI)
    plate = stage.GetPrimAtPath("/cell/Floor/Plate")
    assert plate.HasAPI(UsdPhysics.CollisionAPI)
    assert UsdPhysics.MeshCollisionAPI(plate).GetApproximationAttr().Get() == "none"


def test_one_mesh_in_many_places_is_one_prototype(tmp_path):
    mesh = block("Plate", (0.4, 0.02, 0.3), two=True, uvs=True)
    surfaces = [model.Surface("Steel", (0.5, 0.25, 0.1, 1.0)), model.Surface("Red", (0.9, 0.0, 0.1, 1.0))]
    nodes = [
        Node(f"N:{i}", f"N:{i}", grounded=True, pose=turned((0, 1, 0), 20 * i, (i, 0, 0)), bodies=(Body("Plate", 0, (0, 1)),))
        for i in range(4)
    ]  # fmt: skip
    nodes.append(Node("Odd", "Odd", grounded=True, bodies=(Body("Plate", 0, (1, 0)),)))
    stage, _ = opened(Scene(nodes=nodes, meshes=[mesh], surfaces=surfaces), tmp_path / "many.usda")
    instances = [p for p in stage.Traverse() if p.IsInstance()]
    assert len(instances) == 4 and len({p.GetPrototype().GetPath() for p in instances}) == 1
    proxies = [p for p in Usd.PrimRange.Stage(stage, Usd.TraverseInstanceProxies()) if p.IsA(UsdGeom.Subset)]
    bound = [UsdShade.MaterialBindingAPI(p).ComputeBoundMaterial()[0].GetPath().name for p in proxies]
    assert sorted(bound) == ["Red"] * 5 + ["Steel"] * 5
    subsets = UsdGeom.Subset.GetAllGeomSubsets(UsdGeom.Imageable(stage.GetPrimAtPath("/many/Odd/Plate")))
    assert [list(s.GetIndicesAttr().Get()) for s in subsets] == [[0, 1, 2, 3], list(range(4, 12))]
    drawn = UsdGeom.Mesh(stage.GetPrimAtPath("/many/Odd/Plate"))
    assert drawn.GetNormalsInterpolation() == "vertex" and drawn.GetSubdivisionSchemeAttr().Get() == "none"
    st = UsdGeom.PrimvarsAPI(drawn).GetPrimvar("st")
    assert np.allclose(np.array(st.Get()), mesh.uvs[0]) and st.GetInterpolation() == "vertex"


def test_materials_and_their_images(tmp_path):
    stage, result = opened(rich_scene(tmp_path), tmp_path / "rich.usda")
    lamp = UsdShade.Material(stage.GetPrimAtPath("/Top/Materials/Lamp")).ComputeSurfaceSource()[0]
    assert lamp.GetIdAttr().Get() == "UsdPreviewSurface"
    glow = lamp.GetInput("emissiveColor").GetConnectedSource()[0].GetPrim()
    assert tuple(UsdShade.Shader(glow).GetInput("scale").Get()) == (2.0, 1.0, 0.0, 1.0)
    images = {p.name for p in result.files if p.suffix == ".png"}
    named = {
        UsdShade.Shader(p).GetInput("file").Get().path[2:]
        for p in stage.Traverse()
        if p.IsA(UsdShade.Shader) and UsdShade.Shader(p).GetIdAttr().Get() == "UsdUVTexture"
    }
    assert images == named and len(images) == 4
    glass = UsdShade.Material(stage.GetPrimAtPath("/Top/Materials/Glass")).ComputeSurfaceSource()[0]
    assert glass.GetInput("opacity").Get() == pytest.approx(0.3)


def test_a_package_is_aligned_and_holds_its_images(tmp_path):
    stage, result = opened(rich_scene(tmp_path), tmp_path / "rich.usdz")
    assert result.files == (tmp_path / "rich.usdz",)
    data = result.path.read_bytes()
    with zipfile.ZipFile(result.path) as archive:
        entries = archive.infolist()
    assert entries[0].filename == "stage.usdc" and len(entries) == 5
    for entry in entries:
        name, extra = (
            int.from_bytes(data[entry.header_offset + k : entry.header_offset + k + 2], "little")
            for k in (26, 28)
        )
        assert (
            entry.compress_type == zipfile.ZIP_STORED and (entry.header_offset + 30 + name + extra) % 64 == 0
        )
    lamp = UsdShade.Material(stage.GetPrimAtPath("/Top/Materials/Lamp")).ComputeSurfaceSource()[0]
    image = (
        UsdShade.Shader(lamp.GetInput("diffuseColor").GetConnectedSource()[0].GetPrim())
        .GetInput("file")
        .Get()
    )
    assert image.resolvedPath.endswith(".png]")


def test_old_images_go_and_other_files_stay(tmp_path):
    kinefab.export(rich_scene(tmp_path), tmp_path / "rich.usda")
    other = tmp_path / "rich.usda.notes.png"
    other.write_bytes(b"mine")
    result = kinefab.export(robot(), tmp_path / "rich.usda")
    left = {p.name for p in tmp_path.iterdir() if p.name.startswith("rich.usda")}
    assert left == {p.name for p in result.files} | {other.name} and len(result.files) == 2


def test_nothing_is_written_where_a_loss_is_refused(tmp_path):
    target = tmp_path / "robot.usda"
    kinefab.export(LEVER, target)
    before = {p.name: p.read_bytes() for p in tmp_path.iterdir()}
    with pytest.raises(kinefab.KinefabError):
        kinefab.export(robot(), target, kinefab.ExportOptions(strict=True))
    assert {p.name: p.read_bytes() for p in tmp_path.iterdir()} == before


def test_names_that_are_no_names_of_prims(tmp_path):
    """Slashes, digits, twins, signs of other scripts, what the stage calls its own scopes: each has a path and its own name."""
    names = ["Joints", "1st / part", "Teil", "Teil", "Über\n", "部品", ""]
    nodes = [
        Node(f"id:{i}", name, grounded=True, sites=(model.Site("tip"), model.Site("tip")))
        for i, name in enumerate(names)
    ]
    stage, _ = opened(Scene(nodes=nodes), tmp_path / "7 names.usda")
    root = stage.GetDefaultPrim()
    assert root.GetName() == "_7_names"
    found = {
        p.GetCustomData()["kinefab"]["id"]: p for p in root.GetChildren() if "kinefab" in p.GetCustomData()
    }
    assert len(found) == len({p.GetPath() for p in found.values()}) == 7
    assert found["id:1"].GetDisplayName() == "1st / part" and found["id:5"].GetDisplayName() == "部品"
    assert all(len(p.GetChildren()) == 2 for p in found.values())
    (tmp_path / "again").mkdir()
    again, _ = opened(Scene(nodes=nodes[::-1]), tmp_path / "again" / "7 names.usda")
    turned_round = {
        p.GetCustomData()["kinefab"]["id"]: p.GetPath()
        for p in again.GetDefaultPrim().GetChildren()
        if p.GetCustomData()
    }
    assert turned_round == {id: p.GetPath() for id, p in found.items()}


def test_losses_are_told_by_name(tmp_path):
    scene = robot()
    scene.nodes[1] = replace(scene.nodes[1], layer="Robots", tag="Cart")
    scene.nodes.append(Node("Spare", "Spare", suppressed=True, bodies=(Body("b", 0),)))
    empty = Collider(ColliderKind.SPHERE, radius=0.0)
    scene.nodes[2] = replace(scene.nodes[2], colliders=(*scene.nodes[2].colliders, empty))
    given = model.SphericalDrive(np.eye(3), np.zeros(3), 5.0, 1.0)
    scene.nodes.append(Node("Bob", "Bob", pose=scene.nodes[2].pose, mass=scene.nodes[2].mass))
    ball = model.Joint(
        "Ball", JointKind.SPHERICAL, 2, 4, Pose(), Pose(), model.freedoms_of(JointKind.SPHERICAL), slerp=given
    )
    scene.joints.append(ball)
    terms = (model.Term("Hinge", model.RX, 1.0), model.Term("Slide", model.TX, 2.0))
    scene.couplings.append(model.Coupling("Sum", model.CouplingKind.LINEAR, "Ball", model.RX, terms))
    scene.animations.append(scene.animations[0])
    stage, result = opened(scene, tmp_path / "robot.usda")
    assert {"TARGET_FEATURE_APPROXIMATED"} <= codes(result, Outcome.APPROXIMATED)
    assert codes(result, Outcome.DROPPED) >= {
        "TARGET_FIELD_DROPPED", "COLLIDER_EMPTY", "COUPLING_TERMS_DROPPED", "TEXTURE_DROPPED"
    }  # fmt: skip
    assert "TARGET_BODY_BESIDE" in codes(result, Outcome.KEPT)
    spare = stage.GetPrimAtPath("/robot/Spare")
    assert not spare.IsActive()
    arm = stage.GetPrimAtPath("/robot/Arm")
    assert arm and not stage.GetPrimAtPath("/robot/Cart/Arm") and complaints(stage) == []


def test_what_is_coupled_together_follows_one_joint(tmp_path):
    """Two wheels that follow a third, then a third that follows one of them: a chain, of which Newton takes no mimic of a mimic.
    What the others imply is written by them."""
    scene = scene_of(JointKind.REVOLUTE)
    base, frame = scene.nodes[0], scene.joints[0].frame_a
    free = model.freedoms_of(JointKind.REVOLUTE)
    nodes = [base, *(replace(scene.nodes[1], id=f"W{i}", name=f"W{i}") for i in range(4))]
    joints = [
        model.Joint(f"J{i}", JointKind.REVOLUTE, 0, i + 1, frame, scene.joints[0].frame_b, free)
        for i in range(4)
    ]
    pairs = [("J0", "J1", 2.0, 0.1), ("J2", "J0", -3.0, 0.2), ("J3", "J2", 0.5, -0.4)]
    ties = [
        model.Coupling(
            f"C{k}", model.CouplingKind.GEAR, own, model.RX, (model.Term(other, model.RX, ratio),), offset
        )
        for k, (own, other, ratio, offset) in enumerate(pairs)
    ]
    implied = replace(
        ties[0], id="Again", joint="J3", terms=(model.Term("J1", model.RX, -3.0),), offset=-0.45
    )
    gears = Scene(nodes, joints=joints, couplings=[*ties, implied])
    stage, result = opened(gears, tmp_path / "gears.usda")
    follows = {
        p.GetName(): (
            p.GetRelationship("newton:mimicJoint").GetTargets()[0].name,
            p.GetAttribute("newton:mimicCoef1").Get(),
            math.radians(p.GetAttribute("newton:mimicCoef0").Get()),
        )
        for p in stage.Traverse()
        if p.HasRelationship("newton:mimicJoint")
    }
    assert follows == {
        "J0": ("J1", pytest.approx(2.0), pytest.approx(0.1)),
        "J2": ("J1", pytest.approx(-6.0), pytest.approx(-0.1)),
        "J3": ("J1", pytest.approx(-3.0), pytest.approx(-0.45)),
    }
    for name, (_, ratio, offset) in follows.items():
        prim = stage.GetPrimAtPath(f"/gears/Joints/{name}")
        assert prim.GetAttribute("physxMimicJoint:rotX:gearing").Get() == pytest.approx(-ratio)
        told = math.radians(prim.GetAttribute("physxMimicJoint:rotX:offset").Get())
        assert told == pytest.approx(-offset)
    told = {
        o.feature: (o.outcome, o.code) for o in result.report.outcomes if o.feature.startswith("coupling")
    }
    assert len(told) == 4 and {outcome for outcome, _ in told.values()} == {Outcome.KEPT}


@pytest.mark.parametrize(
    ("kind", "moved", "names"),
    [
        (JointKind.REVOLUTE, {"rx": Freedom(Motion.LIMITED, math.radians(-10.0), math.inf)}, ("physics:lowerLimit", "physics:upperLimit")),
        (JointKind.CYLINDRICAL, {"tx": Freedom(Motion.LIMITED, -math.inf, 0.08)}, ("limit:transX:physics:low", "limit:transX:physics:high")),
    ],
)  # fmt: skip
def test_an_end_that_a_range_lacks_is_a_large_number(tmp_path, kind, moved, names):
    """Infinity is the schema's word for it, at which PhysX refuses the other end too."""
    stage, _ = opened(scene_of(kind, **moved), tmp_path / "side.usda")
    prim = stage.GetPrimAtPath("/side/Joints/J")
    ends = [prim.GetAttribute(name).Get() for name in names]
    assert ends == (
        [-10.0, pytest.approx(1e30)] if "rx" in moved else [pytest.approx(-1e30), pytest.approx(0.08)]
    )


def test_a_joint_that_leaves_everything_free_is_not_written(tmp_path):
    """As Unity has no component for it; Newton makes a floating body of its own and warns of a second joint to the world.  One
    that a coupling counts by, or that a spring pulls, stands there."""
    free = scene_of(JointKind.FREE)
    stage, result = opened(free, tmp_path / "free.usda")
    assert not stage.GetPrimAtPath("/free/Joints/J")
    assert codes(result, Outcome.DROPPED) == {"JOINT_REMOVES_NOTHING"}
    sprung = scene_of(JointKind.FREE, tz=Freedom(Motion.FREE, drive=model.Drive(stiffness=3.0)))
    assert opened(sprung, tmp_path / "sprung.usda")[0].GetPrimAtPath("/sprung/Joints/J")
    tie = model.Coupling("C", model.CouplingKind.LINEAR, "J", model.RX, (model.Term("J", model.TX, 2.0),))
    counted = replace(free, couplings=[tie])
    assert opened(counted, tmp_path / "counted.usda")[0].GetPrimAtPath("/counted/Joints/J")


def test_a_slide_that_follows_has_its_leaders_drive_beside_the_mimic(tmp_path):
    """PhysX has mimics between turns alone: the slide's drive does the same work as the leader's."""
    scene = kinefab.Scene()
    base, finger, rack = (
        scene.add_part(name, grounded=name == "Base", mass=None if name == "Base" else 1.0)
        for name in ("Base", "Finger", "Rack")
    )
    drive = kinefab.Drive(target=30.0, stiffness=8.0, damping=2.0, max_force=5.0)
    leader = scene.add_hinge(base, finger, point=(0, 0, 0), axis=(1, 0, 0), drive=drive, name="Lead")
    slide = scene.add_slider(base, rack, point=(0, 0, 0.1), axis=(0, 0, 1), name="Slide")
    scene.add_coupling(leader, slide, ratio=0.02)
    stage, result = opened(scene, tmp_path / "hand.usda")
    prim = next(p for p in stage.Traverse() if p.HasRelationship("newton:mimicJoint"))
    own = scene.joints[0].freedoms[model.RX].drive
    found = {
        name: prim.GetAttribute(f"drive:linear:physics:{name}").Get()
        for name in ("targetPosition", "stiffness", "damping", "maxForce")
    }
    tie = scene.couplings[0]
    ratio, offset = tie.terms[0].ratio, tie.offset
    assert found == {
        "targetPosition": pytest.approx(ratio * own.target + offset),
        "stiffness": pytest.approx(own.stiffness / ratio**2),
        "damping": pytest.approx(own.damping / ratio**2),
        "maxForce": pytest.approx(own.max_force / abs(ratio)),
    }
    assert "mimic of joint Slide" in {o.feature for o in result.report.outcomes}
    back = read(tmp_path / "hand.usda", Report())
    assert [j.freedoms[model.TX].drive for j in back.joints if j.kind is JointKind.PRISMATIC] == [None]


def test_what_no_engine_couples_is_written_in_words_of_our_own(tmp_path):
    """Slides of joints that turn too: one coupling on each of the two, the second turned round; a third has no place."""
    scene = scene_of(JointKind.CYLINDRICAL)
    base, part, joint = scene.nodes[0], scene.nodes[1], scene.joints[0]
    nodes = [base, *(replace(part, id=f"R{i}", name=f"R{i}") for i in range(2))]
    joints = [replace(joint, id=f"J{i}", a=0, b=i + 1) for i in range(2)]
    tie = model.Coupling(
        "C0", model.CouplingKind.LINEAR, "J0", model.TX, (model.Term("J1", model.TX, -2.0),), 0.01
    )
    ties = [replace(tie, id=f"C{i}") for i in range(3)]
    stage, result = opened(Scene(nodes, joints=joints, couplings=ties), tmp_path / "rods.usda")
    names = ("freedom", "ratio", "offset")
    found = []
    for i in range(2):
        prim = stage.GetPrimAtPath(f"/rods/Joints/J{i}")
        assert prim.GetRelationship("kinefab:mimic:transX:joint").GetTargets()[0].name == f"J{1 - i}"
        assert not any("Mimic" in schema for schema in prim.GetAppliedSchemas())
        found.append([prim.GetAttribute(f"kinefab:mimic:transX:{name}").Get() for name in names])
    assert found == [["transX", -2.0, 0.01], ["transX", -0.5, 0.005]]
    told = [(o.outcome, o.code) for o in result.report.outcomes if o.feature.startswith("coupling")]
    approximated = (Outcome.APPROXIMATED, "TARGET_FEATURE_APPROXIMATED")
    assert told == [approximated, approximated, (Outcome.DROPPED, "COUPLING_FOLLOWS_TWO")]


@pytest.mark.parametrize("bundle", [b for b, _ in golden_pairs()], ids=lambda b: b.name.split(".")[0])
def test_articulations_are_as_engines_of_reduced_coordinates_take_them(tmp_path, bundle):
    """Newton refuses a stage in which body 0 of a joint is not the parent, or a joint follows one that follows another."""
    stage, _ = opened(bundle, tmp_path / "stage.usda", colliders="none")
    parents, roots, leaders, followers = {}, set(), set(), set()
    for prim in stage.Traverse():
        if not prim.IsA(UsdPhysics.Joint):
            continue
        for name in ("newton:mimicJoint", *(f"physxMimicJoint:rot{axis}:referenceJoint" for axis in "XYZ")):
            if prim.HasRelationship(name):
                followers.add(prim.GetPath())
                leaders |= set(prim.GetRelationship(name).GetTargets())
        joint = UsdPhysics.Joint(prim)
        if not joint.GetExcludeFromArticulationAttr().Get():
            first, second = (r.GetTargets()[0] for r in (joint.GetBody0Rel(), joint.GetBody1Rel()))
            assert second not in parents, f"{second} has two parents"
            parents[second] = first
    for body in parents:
        above, seen = body, set()
        while above in parents:
            assert above not in seen
            seen.add(above)
            above = parents[above]
        roots.add(above)
    heads = {r for r in roots if r != stage.GetDefaultPrim().GetPath()}
    assert all(stage.GetPrimAtPath(head).HasAPI(UsdPhysics.ArticulationRootAPI) for head in heads)
    assert not leaders & followers


def test_a_slide_along_another_axis_is_a_prismatic_joint_of_that_axis(tmp_path):
    stage, _ = opened(
        scene_of(JointKind.GENERAL, ty=Freedom(Motion.LIMITED, -0.02, 0.1)), tmp_path / "slide.usda"
    )
    slide = UsdPhysics.PrismaticJoint(stage.GetPrimAtPath("/slide/Joints/J"))
    assert slide.GetAxisAttr().Get() == "Y"
    assert (slide.GetLowerLimitAttr().Get(), slide.GetUpperLimitAttr().Get()) == pytest.approx((-0.02, 0.1))


def test_reversed_limits_are_an_error_and_not_a_lock(tmp_path):
    scene = scene_of(JointKind.REVOLUTE, rx=Freedom(Motion.LIMITED, 0.5, -0.5))
    with pytest.raises(kinefab.KinefabError) as error:
        kinefab.export(scene, tmp_path / "wrong.usda")
    assert {d.code for d in error.value.diagnostics} == {"JOINT_LIMITS_REVERSED"}
    assert list(tmp_path.iterdir()) == []


def test_without_gravity_there_is_a_direction_all_the_same(tmp_path):
    scene = scene_of(JointKind.REVOLUTE)
    scene.physics = model.Physics((0.0, 0.0, 0.0))
    stage, _ = opened(scene, tmp_path / "space.usda")
    found = UsdPhysics.Scene(stage.GetPrimAtPath("/PhysicsScene"))
    assert found.GetGravityMagnitudeAttr().Get() == 0.0 and found.GetGravityDirectionAttr().Get() == Gf.Vec3f(
        0, -1, 0
    )
