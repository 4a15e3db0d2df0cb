"""``--physics articulation``: links instead of Rigidbodies, the same motion, loops closed, what cannot be so refused."""

from __future__ import annotations

from dataclasses import replace
from math import radians
from pathlib import Path

import kinefab
import numpy as np
import pytest
import trimesh
from golden import FIXTURES
from kinefab.spatial import Pose, matrix_from_quaternion
from prefab_reader import Node, read_prefab, vector
from test_prefab_documents import TABLE, disagreements
from unity_yaml import documents

ARTICULATED = {"physics": "articulation"}
BOX = trimesh.creation.box((0.1, 0.2, 0.3))


def mass(kg: float) -> kinefab.MassProperties:
    return kinefab.MassProperties(kg, np.array([0.01, 0.02, -0.01]), np.diag([0.01, 0.02, 0.025]))


def arm() -> kinefab.Scene:
    """Base, upper arm, fore arm on a slide, hand on a ball; nothing along an axis of the frame."""
    scene = kinefab.Scene()
    base = scene.add_part("Base", BOX, grounded=True)
    upper = scene.add_part("Upper", BOX, translation=(0.3, 0.1, 0.2), mass=mass(2.0))
    fore = scene.add_part("Fore", BOX, translation=(0.6, 0.1, 0.2), mass=mass(1.0))
    scene.add_hinge(base, upper, point=(0.15, 0.1, 0.1), axis=(1, 2, 3), limits=(-10, 80), name="Shoulder")
    scene.add_slider(upper, fore, axis=(3, -1, 2), point=(0.45, 0.1, 0.2), limits=(-0.02, 0.1), name="Rail")
    return scene


def exported(scene, folder: Path, **options) -> tuple[Node, kinefab.ExportResult]:
    writing = {**ARTICULATED, **options.pop("writing", {})}
    result = kinefab.export(scene, folder / "Arm.prefab", kinefab.ExportOptions(writing=writing, **options))
    return read_prefab(folder / "Arm.prefab")[0], result


def nodes_of(node: Node) -> dict[str, Node]:
    found = {node.name: node}
    for child in node.children:
        found |= nodes_of(child)
    return found


def link(node: Node) -> dict:
    (own,) = [c["fields"] for c in node.components if c["type"] == "ArticulationBody"]
    return own


def poses(node: Node, above: Pose = Pose()) -> dict[str, Pose]:
    t = node.transform
    own = above @ Pose(matrix_from_quaternion(np.array(t["localRotation"])), np.array(t["localPosition"]))
    found = {node.name: own}
    for child in node.children:
        found |= poses(child, own)
    return found


def test_links_stand_below_each_other_where_they_stood(tmp_path):
    root, result = exported(arm(), tmp_path)
    nodes = nodes_of(root)
    assert [
        c.name for c in nodes["Upper"].children if any(k["type"] == "ArticulationBody" for k in c.components)
    ] == ["Fore"]
    (tmp_path / "plain").mkdir()
    kinefab.export(arm(), tmp_path / "plain" / "Arm.prefab")
    expected = poses(read_prefab(tmp_path / "plain" / "Arm.prefab")[0])
    actual = poses(root)
    for name in ("Base", "Upper", "Fore"):
        assert np.allclose(actual[name].translation, expected[name].translation, atol=1e-6)
        assert np.allclose(actual[name].rotation, expected[name].rotation, atol=1e-6)
    assert link(root)["m_Immovable"] == "1" and link(nodes["Upper"])["m_Immovable"] == "0"
    assert float(link(nodes["Upper"])["m_Mass"]) == 2.0
    text = (tmp_path / "Arm.prefab").read_text()
    assert "Rigidbody:" not in text and "HingeJoint:" not in text
    assert not result.report.of(kinefab.Severity.ERROR)


def test_limits_and_frames_are_those_of_the_source(tmp_path):
    """The link's angle about X is Unity's, left-handed about the mirrored axis turned round: the CAD angle."""
    root, _ = exported(arm(), tmp_path)
    nodes, placed = nodes_of(root), poses(root)
    hinge, slide = link(nodes["Upper"]), link(nodes["Fore"])
    assert hinge["m_ArticulationJointType"] == "2" and hinge["m_Twist"] == "1"
    assert [float(hinge["m_XDrive"][k]) for k in ("lowerLimit", "upperLimit")] == pytest.approx([-10, 80])
    assert slide["m_ArticulationJointType"] == "1" and slide["m_LinearX"] == "1" and slide["m_LinearY"] == "0"
    assert [float(slide["m_XDrive"][k]) for k in ("lowerLimit", "upperLimit")] == pytest.approx(
        [-0.02, 0.1], abs=1e-7
    )
    mirror = np.array([-1.0, 1.0, 1.0])
    for name, above, own, axis, point in (
        ("Upper", root.name, hinge, -mirror * (1, 2, 3), mirror * (0.15, 0.1, 0.1)),
        ("Fore", "Upper", slide, mirror * (3, -1, 2), None),
    ):
        frames = []
        for at, prefix in ((name, "m_Anchor"), (above, "m_ParentAnchor")):
            local = Pose(
                matrix_from_quaternion(np.array(vector(own[f"{prefix}Rotation"]))),
                np.array(vector(own[f"{prefix}Position"])),
            )
            frames.append(placed[at] @ local)
        assert np.allclose(frames[0].translation, frames[1].translation, atol=1e-6)
        assert np.allclose(frames[0].rotation, frames[1].rotation, atol=1e-6)
        assert np.allclose(frames[0].rotation[:, 0], np.array(axis) / np.linalg.norm(axis), atol=1e-6)
        if point is not None:
            assert np.allclose(frames[0].translation, point, atol=1e-6)


@pytest.mark.parametrize("turned_round", [False, True], ids=["joint on the link", "joint on the one above"])
def test_links_count_and_are_driven_as_the_source_says_whichever_body_has_the_joint(tmp_path, turned_round):
    """Limits, targets and speeds are those of CAD, from the exported pose, about the mirrored axis turned round for an angle."""
    scene = kinefab.Scene()
    base = scene.add_part("Base", BOX, grounded=True)
    upper = scene.add_part("Upper", BOX, translation=(0.3, 0.1, 0.2), mass=mass(2.0))
    fore = scene.add_part("Fore", BOX, translation=(0.6, 0.1, 0.2), mass=mass(1.0))
    shoulder, rail = ((upper, base), (fore, upper)) if turned_round else ((base, upper), (upper, fore))
    turning = {"target": 30, "target_velocity": 20, "stiffness": 50, "damping": 2, "max_force": 9}
    sliding = {"target": 0.06, "target_velocity": 0.3, "stiffness": 70, "damping": 4}
    scene.add_hinge(*shoulder, point=(0.15, 0.1, 0.1), axis=(1, 2, 3), limits=(-10, 80), drive=turning)
    scene.add_slider(*rail, axis=(3, -1, 2), point=(0.45, 0.1, 0.2), limits=(-0.02, 0.1), drive=sliding)
    root, result = exported(scene, tmp_path)
    assert not result.report.of(kinefab.Severity.ERROR)
    nodes, placed = nodes_of(root), poses(root)
    sense = -1.0 if turned_round else 1.0
    names = ("lowerLimit", "upperLimit", "target", "targetVelocity", "stiffness", "damping")
    for name, axis, numbers in (
        ("Upper", (1, -2, -3), [-10, 80, 30, 20, 50, 2]),
        ("Fore", (-3, -1, 2), [-0.02, 0.1, 0.06, 0.3, 70, 4]),
    ):
        own = link(nodes[name])
        low, high, target, speed, *gains = (float(own["m_XDrive"][k]) for k in names)
        if own["m_ArticulationJointType"] == "1":  # a slide runs against it: PhysX#411, Unity's UUM-113920
            assert int(own["serializedVersion"]) < 6
            speed = -speed
        x = placed[name].rotation @ matrix_from_quaternion(np.array(vector(own["m_AnchorRotation"])))[:, 0]
        along = sense * np.array(axis) / np.linalg.norm(axis)
        if x @ along < 0.0:  # counted the other way
            x, low, high, target, speed = -x, -high, -low, -target, -speed
        assert np.allclose(x, along, atol=1e-6)
        assert [low, high, target, speed, *gains] == pytest.approx(numbers, abs=1e-5)


@pytest.mark.parametrize("dialect", TABLE)
def test_every_document_has_the_fields_of_its_class(tmp_path, dialect):
    exported(arm(), tmp_path, writing={"unity": dialect})
    found = documents((tmp_path / "Arm.prefab").read_text("utf-8"))
    assert "ArticulationBody" in {d.kind for d in found}
    for document in found:
        rule = TABLE[dialect][document.kind]
        assert document.class_id == rule["classID"]
        assert disagreements(document.fields, rule["fields"], document.kind) == []


@pytest.mark.parametrize("ground", ["body", "world"])
def test_a_loop_is_closed_by_a_helper(tmp_path, ground):
    """The lever: three links in a row, and the bar's other end on a body of its own, both sides of which are links."""
    root, result = exported(FIXTURES / "lever" / "lever.bundle.json", tmp_path, ground=ground)
    told = [o for o in result.report.outcomes if o.code == "ARTICULATION_LOOP_HELPER"]
    assert len(told) == 1 and told[0].outcome.value == "kept"
    (helper,) = [n for n in nodes_of(root).values() if n.name.endswith("closure")]
    kinds = [c["type"] for c in helper.components]
    assert kinds.count("Rigidbody") == 1 and kinds.count("FixedJoint") == 1 and len(kinds) == 3
    joints = [c for c in helper.components if c["type"].endswith("Joint")]
    assert all(j["connectedBody"] is None and j["connectedArticulationBody"] for j in joints)
    assert len({j["connectedArticulationBody"] for j in joints}) == 2
    links = [n for n in nodes_of(root).values() if any(c["type"] == "ArticulationBody" for c in n.components)]
    assert len(links) == 4  # with the ground
    (body,) = [c for c in helper.components if c["type"] == "Rigidbody"]
    twin = next(
        n for n in links if np.allclose(poses(root)[n.name].translation, poses(root)[helper.name].translation)
    )
    own = link(twin)  # whose twentieth it is, in the same place
    assert body["mass"] == pytest.approx(0.05 * float(own["m_Mass"])) and not body["useGravity"]
    assert body["centerOfMass"] == pytest.approx(vector(own["m_CenterOfMass"])) and any(body["centerOfMass"])
    moments = [0.05 * moment for moment in vector(own["m_InertiaTensor"])]
    assert body["inertiaTensor"] == pytest.approx(moments)
    assert body["inertiaTensorRotation"] == pytest.approx(vector(own["m_InertiaRotation"]))


@pytest.mark.parametrize("shape", ["hull", "none"])
def test_links_that_overlap_at_a_closed_loop_are_told(tmp_path, shape):
    """The joint between the lever's bar and slider keeps them from colliding; on a helper it keeps the helper from that, and Unity
    keeps links apart from those above them only."""
    pytest.importorskip("coal")
    lever, colliders = FIXTURES / "lever" / "lever.bundle.json", kinefab.ColliderShape(shape)
    _, result = exported(lever, tmp_path, colliders=colliders)
    told = [d.where + d.message for d in result.report.diagnostics if d.code == "COLLIDERS_OVERLAP"]
    assert len(told) == (shape == "hull") and all(
        "BarC:1 and Lever/SliderD:1 overlap" in text for text in told
    )
    plain = kinefab.export(lever, tmp_path / "Plain.prefab", kinefab.ExportOptions(colliders=colliders))
    assert "COLLIDERS_OVERLAP" not in {d.code for d in plain.report.diagnostics}


@pytest.mark.parametrize("ground", ["body", "world"])
@pytest.mark.parametrize("held", [False, True])
def test_what_a_script_moves_is_no_ground_but_a_root(tmp_path, ground, held):
    """A hinge to the world does not follow a kinematic part, one to that part does, whichever of its parts comes first."""
    scene = kinefab.Scene()
    fore, upper, cart = (scene.add_part(name, BOX, translation=(i, 0, 0)) for i, name in enumerate("FUC"))
    scene.nodes[cart] = replace(scene.nodes[cart], dynamics=kinefab.model.Dynamics(kinematic=True))
    scene.add_hinge(cart if held else None, upper, point=(0, 0, 0), axis=(0, 0, 1), limits=(-10, 80))
    scene.add_hinge(upper, fore, point=(1, 0, 0), axis=(0, 0, 1))
    root, _ = exported(scene, tmp_path, ground=ground)
    nodes = nodes_of(root)
    (base,) = [node.name for node in nodes.values() if "U" in nodes_of(node) and any(
        c["type"] == "ArticulationBody" and c["fields"]["m_Immovable"] == "1" for c in node.components
    )]  # fmt: skip
    assert base == ("C" if held else root.name if ground == "body" else "Ground")
    assert [c.name for c in nodes["U"].children] == ["F"]
    assert [c.name for c in nodes[base].children if "U" in c.name] == ["U"]


def test_what_no_articulation_has_is_refused_with_its_reason(tmp_path):
    scene = arm()
    lid = scene.add_part("Lid", BOX, translation=(1, 1, 1))
    scene.add_joint("cylindrical", None, lid, point=(1, 1, 1), axis=(0, 1, 0), name="Pin")
    with pytest.raises(kinefab.KinefabError) as caught:
        exported(scene, tmp_path)
    assert [d.code for d in caught.value.diagnostics] == ["ARTICULATION_IMPOSSIBLE"]
    assert "Pin" in caught.value.diagnostics[0].message and not list(tmp_path.iterdir())


def test_friction_of_a_joint_is_the_link_s(tmp_path):
    from kinefab.model import RX, Drive, Passive

    scene = arm()
    (index,) = [i for i, j in enumerate(scene.joints) if j.name == "Shoulder"]
    joint = scene.joints[index]
    freedoms = list(joint.freedoms)
    drive = Drive(radians(30), radians(5), 12.0, 0.5, 7.0)
    freedoms[RX] = replace(freedoms[RX], passive=Passive(friction=0.75), drive=drive)
    scene.joints[index] = replace(joint, freedoms=tuple(freedoms))
    root, _ = exported(scene, tmp_path)
    own = link(nodes_of(root)["Upper"])
    assert float(own["m_JointFriction"]) == 0.75
    # With a largest torque it is a ConfigurableJoint elsewhere; the link's drive reads the CAD angle up to the axis' sense.
    drive, sign = own["m_XDrive"], -1 if float(own["m_XDrive"]["upperLimit"]) == pytest.approx(10) else 1
    assert [sign * float(drive[k]) for k in ("lowerLimit", "upperLimit")][::sign] == pytest.approx([-10, 80])
    assert sign * float(drive["target"]) == pytest.approx(30, abs=1e-4)
    assert sign * float(drive["targetVelocity"]) == pytest.approx(5, abs=1e-4)
    assert [float(drive[k]) for k in ("stiffness", "damping", "forceLimit")] == [12.0, 0.5, 7.0]


@pytest.mark.parametrize("scripts", [False, True])
def test_couplings_are_told_where_no_script_keeps_them(tmp_path, scripts):
    from prefab_scenes import rich_scene

    scene = rich_scene(tmp_path)
    scene.joints = [j for j in scene.joints if j.id != "Snap"]
    result = kinefab.export(
        scene, tmp_path / "Rich.prefab", kinefab.ExportOptions(writing={**ARTICULATED, "scripts": scripts})
    )
    told = [o.feature for o in result.report.outcomes if o.code == "COUPLING_NOT_IN_PREFAB"]
    assert told == ([] if scripts else ["coupling Gear", "coupling Rack"])
    assert (tmp_path / "Rich.prefab").read_text("ascii").count("MonoBehaviour:") == (2 if scripts else 0)


RING = trimesh.creation.annulus(0.05, 0.1, 0.04)


def colliders_below(node: Node, body: str = "") -> list[tuple[str, dict]]:
    """Each mesh collider with the class of the body that it is of, the nearest above it; "" where there is none."""
    kinds = [c["type"] for c in node.components if c["type"] in ("ArticulationBody", "Rigidbody")]
    body = kinds[0] if kinds else body
    found = [(body, c) for c in node.components if c["type"] == "MeshCollider"]
    return found + [each for child in node.children for each in colliders_below(child, body)]


def ringed(stated: bool, joined: bool = True) -> kinefab.Scene:
    """A base with a hole, drawn or also stated as a true mesh, and a ring that a script leads; something turns on each."""
    scene = kinefab.Scene()
    base = scene.add_part("Base", RING, grounded=True)
    if stated:
        mesh = scene.nodes[base].bodies[0].mesh
        collider = kinefab.model.Collider(kinefab.model.ColliderKind.MESH, mesh=mesh)
        scene.nodes[base] = replace(scene.nodes[base], colliders=(collider,))
    led = scene.add_part("Led", RING, translation=(1, 0, 0))
    scene.nodes[led] = replace(scene.nodes[led], dynamics=kinefab.model.Dynamics(kinematic=True))
    for name, below, at in (("Arm", base if joined else led, 0.3), ("Hand", led, 0.7)):
        part = scene.add_part(name, BOX, translation=(at, 0, 0))
        scene.add_hinge(below, part, point=(at, 0, 0), axis=(0, 0, 1), limits=(-10, 80), name=name)
    return scene


@pytest.mark.parametrize("ground", ["body", "world"])
@pytest.mark.parametrize("stated", [False, True])
def test_a_link_has_convex_colliders_however_it_is_held(tmp_path, stated, ground):
    """Unity refuses others: "Non-convex MeshCollider with ArticulationBody is not supported", the kinematic ground's among them.
    What no joint makes a link keeps its true mesh, and hollows stay as convex pieces."""
    pytest.importorskip("manifold3d")
    root, _ = exported(ringed(stated), tmp_path, ground=ground)
    found = colliders_below(root)
    assert {body for body, c in found if not c["convex"]} == (set() if ground == "body" else {""})
    assert sum(body == "ArticulationBody" for body, _ in found) > (4 if ground == "body" else 2)
    (tmp_path / "plain").mkdir()
    options = kinefab.ExportOptions(ground=ground)
    plain = kinefab.export(ringed(stated), tmp_path / "plain" / "Arm.prefab", options)
    stands = [c["convex"] for _, c in colliders_below(read_prefab(plain.path)[0])]
    assert stands.count(False) == 2  # of the base and of what is led


def test_a_ground_that_nothing_is_joined_to_is_no_link(tmp_path):
    pytest.importorskip("manifold3d")
    root, _ = exported(ringed(stated=True, joined=False), tmp_path)
    assert [body for body, c in colliders_below(root) if not c["convex"]] == ["Rigidbody"]
