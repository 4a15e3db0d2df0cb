"""Which bodies of an exported scene may collide, counted from the written file alone and held against the source's own rule."""

from __future__ import annotations

import json
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import kinefab
import numpy as np
import pytest
import trimesh
from kinefab.geometry.looks.gltf_document import gltf_document
from kinefab.model import Apart, Collider, ColliderKind, Colliding, JointKind, MassProperties, Node
from kinefab.sources.mjcf.stacks import Axis, steps_of

JOINTS = ("HingeJoint", "ConfigurableJoint", "FixedJoint")
COLLIDERS = ("BoxCollider", "SphereCollider", "CapsuleCollider", "MeshCollider")


def touching(path: Path) -> set[frozenset[str]]:
    """Pairs of objects with colliders that Unity lets collide: of two Rigidbodies, one of them dynamic, no joint between them."""
    objects = json.loads(path.read_text(encoding="utf-8"))["gameObjects"]
    body: list[int | None] = []
    for i, entry in enumerate(objects):
        kinds = [c["type"] for c in entry.get("components", ())]
        parent = entry.get("parent")
        body.append(i if "Rigidbody" in kinds else None if parent is None else body[parent])
    dynamic = {
        i
        for i, entry in enumerate(objects)
        for c in entry.get("components", ())
        if c["type"] == "Rigidbody" and not c.get("isKinematic", False)
    }
    joined = {
        frozenset((body[i], c["connectedBody"]))
        for i, entry in enumerate(objects)
        for c in entry.get("components", ())
        if c["type"] in JOINTS and "connectedBody" in c and not c.get("enableCollision", False)
    }
    shaped = [
        i
        for i, entry in enumerate(objects)
        if any(c["type"] in COLLIDERS for c in entry.get("components", ()))
    ]
    return {
        frozenset((objects[a]["id"], objects[b]["id"]))
        for a, b in combinations(shaped, 2)
        if body[a] != body[b] and {body[a], body[b]} & dynamic and frozenset((body[a], body[b])) not in joined
    }


ARM = """<sdf version="1.9"><world name="w"><model name="ground"><static>true</static><link name="floor"><collision name="c">
<geometry><box><size>10 10 0.1</size></box></geometry></collision></link></model>
<model name="pend"><link name="arm"><pose>0 0 0.5 0 0 0</pose><inertial><mass>1</mass></inertial><collision name="c"><pose>0.35 0 0 0 0 0</pose>
<geometry><box><size>.1 .1 .1</size></box></geometry></collision></link>
<joint name="j" type="revolute"><parent>world</parent><child>arm</child><axis><xyz>0 1 0</xyz></axis></joint></model></world></sdf>"""


def test_what_is_joined_to_the_world_collides_with_the_floor(tmp_path: Path):
    (tmp_path / "arm.sdf").write_text(ARM, encoding="utf-8")
    kinefab.export(tmp_path / "arm.sdf", tmp_path / "arm.kinefab")
    assert touching(tmp_path / "arm.kinefab") == {frozenset(("ground/floor", "pend/arm"))}


def lid_over_floor() -> kinefab.Scene:
    scene = kinefab.Scene()
    box = scene.add_part("Box", trimesh.creation.box((0.4, 0.2, 0.3)), translation=(0, 0.1, 0), grounded=True)
    lid = scene.add_part("Lid", trimesh.creation.box((0.4, 0.02, 0.3)), translation=(0, 0.21, 0))
    scene.add_part("Floor", trimesh.creation.box((4, 0.1, 4)), translation=(0, -0.05, 0), grounded=True)
    scene.add_hinge(box, lid, point=(0, 0.2, -0.15), axis=(-1, 0, 0), name="Hinge")
    return scene


def test_an_arm_collides_with_the_floor_and_not_with_its_base(tmp_path: Path):
    kinefab.export(lid_over_floor(), tmp_path / "lid.kinefab")
    assert touching(tmp_path / "lid.kinefab") == {frozenset(("Lid", "Floor"))}


def test_scenery_stands_below_the_ground_that_moves_the_scene(tmp_path: Path):
    kinefab.export(lid_over_floor(), tmp_path / "lid.kinefab")
    objects = json.loads((tmp_path / "lid.kinefab").read_text(encoding="utf-8"))["gameObjects"]
    floor = next(o for o in objects if o["id"] == "Floor")
    body = next(c for c in floor["components"] if c["type"] == "Rigidbody")
    assert objects[floor["parent"]]["id"] == "kinefab:ground"
    assert body["isKinematic"]


def test_a_bracket_welded_to_the_base_is_the_base(tmp_path: Path):
    scene = lid_over_floor()
    bracket = scene.add_part("Bracket", trimesh.creation.box((0.1, 0.1, 0.1)), translation=(0, 0.3, -0.3))
    scene.add_fixed(0, bracket)
    kinefab.export(scene, tmp_path / "lid.kinefab")
    assert touching(tmp_path / "lid.kinefab") == {frozenset(("Lid", "Floor"))}


def two_balls() -> kinefab.Scene:
    scene = kinefab.Scene()
    for name, x in (("A", 0.0), ("B", 0.1), ("C", 0.2)):
        scene.add_part(name, trimesh.creation.box((0.2, 0.2, 0.2)), translation=(x, 1, 0))
    scene.apart.append(Apart(0, 1, "contact exclude"))
    return scene


def test_bodies_that_the_source_lets_pass_are_kept_apart_without_a_script(tmp_path: Path):
    result = kinefab.export(two_balls(), tmp_path / "balls.kinefab")
    assert touching(tmp_path / "balls.kinefab") == {frozenset("AC"), frozenset("BC")}
    content = json.loads((tmp_path / "balls.kinefab").read_text(encoding="utf-8"))
    names = [entry["id"] for entry in content["gameObjects"]]
    (pair,) = content["ignoredCollisions"]
    assert [names[pair[end]] for end in "ab"] == ["A", "B"] and pair["reason"]
    overlaps = [d.message for d in result.report.diagnostics if d.code == "COLLIDERS_OVERLAP"]
    assert not any("A" in message.split() and "B" in message.split() for message in overlaps)


def grouped(*groups: tuple[str, ...], masks: dict[str, list[int]] | None = None) -> kinefab.Scene:
    """Balls in a row; each has a collider for each of its groups."""
    ball = Collider(ColliderKind.SPHERE, radius=0.1)
    mass = MassProperties(1.0, np.zeros(3), np.eye(3))
    nodes = [
        Node(name, name, mass=mass, colliders=tuple(replace(ball, group=group) for group in own))
        for name, own in zip("ABCD", groups)
    ]
    extras = {"collisionMasks": masks} if masks else {"collisionGroups": {"ghosts": ["stones", "ghosts"]}}
    return kinefab.Scene(nodes, extras=extras)


def test_groups_are_pairs_of_bodies(tmp_path: Path):
    result = kinefab.export(grouped(("ghosts",), ("ghosts",), ("stones",), ("",)), tmp_path / "a.kinefab")
    assert touching(tmp_path / "a.kinefab") == pairs(("A", "D"), ("B", "D"), ("C", "D"))
    assert "GROUP_PARTLY_KEPT" not in {d.code for d in result.report.diagnostics}
    assert "collision group ghosts" in {o.feature for o in result.report.outcomes}


def test_masks_are_pairs_of_bodies(tmp_path: Path):
    masks = {"floor": [1, 2], "foot": [2, 1], "shell": [4, 4]}
    kinefab.export(grouped(("floor",), ("foot",), ("shell",), ("",), masks=masks), tmp_path / "a.kinefab")
    assert touching(tmp_path / "a.kinefab") == pairs(("A", "B"), ("A", "D"), ("B", "D"))


def test_a_body_of_which_a_part_passes_through_another_is_told(tmp_path: Path):
    result = kinefab.export(grouped(("ghosts", ""), ("stones",)), tmp_path / "a.kinefab")
    assert touching(tmp_path / "a.kinefab") == pairs(("A", "B"))
    told = {o.feature for o in result.report.outcomes if o.code == "GROUP_PARTLY_KEPT"}
    assert told == {"collision group ghosts", "collision group stones"}


def test_a_pair_that_collides_in_spite_of_its_groups_does(tmp_path: Path):
    scene = grouped(("ghosts",), ("stones",), ("stones",))
    scene.colliding.append(Colliding(0, 1, "contact pair ghost"))
    kinefab.export(scene, tmp_path / "a.kinefab")
    assert touching(tmp_path / "a.kinefab") == pairs(("A", "B"), ("B", "C"))


@pytest.mark.parametrize("options", [{}, {"closures": "minimal"}, {"ground": "world"}])
def test_a_written_scene_keeps_a_pair_that_collides_in_spite_of_its_groups(tmp_path: Path, options: dict[str, str]):
    """It lists no such pair: those that it does not keep apart collide, also where it is made anew."""
    scene = grouped(("ghosts",), ("stones",), ("stones",))
    scene.colliding.append(Colliding(0, 1, "contact pair ghost"))
    kinefab.export(scene, tmp_path / "a.kinefab")
    kinefab.export(tmp_path / "a.kinefab", tmp_path / "b.kinefab", kinefab.ExportOptions(**options))
    assert touching(tmp_path / "b.kinefab") == pairs(("A", "B"), ("B", "C"))


def test_gltf_tells_a_pair_that_collides_in_spite_of_its_groups(tmp_path: Path):
    scene = grouped(("ghosts",), ("stones",), ("stones",))
    scene.colliding.append(Colliding(0, 1, "contact pair ghost"))
    result = kinefab.export(scene, tmp_path / "a.glb")
    assert "contact pair ghost" in {o.feature for o in result.report.outcomes if o.code == "TARGET_FIELD_DROPPED"}


def test_pairs_by_node_reach_usd(tmp_path: Path):
    pytest.importorskip("pxr")
    kinefab.export(two_balls(), tmp_path / "balls.usda")
    assert "physics:filteredPairs = </" in (tmp_path / "balls.usda").read_text(encoding="utf-8")


def test_pairs_by_node_reach_gltf(tmp_path: Path):
    kinefab.export(two_balls(), tmp_path / "balls.glb")
    document = gltf_document(tmp_path / "balls.glb")
    filters = document["extensions"]["KHR_physics_rigid_bodies"]["collisionFilters"]
    assert {tuple(f["notCollideWithSystems"]) for f in filters} == {("A",), ("B",)}


def test_an_articulation_tells_the_pairs_that_it_cannot_say(tmp_path: Path):
    result = kinefab.export(
        two_balls(), tmp_path / "balls.prefab", kinefab.ExportOptions(writing={"physics": "articulation"})
    )
    assert any(d.code == "TARGET_FIELD_DROPPED" and "A - B" in d.message for d in result.report.diagnostics)


def test_a_pair_with_what_stands_in_the_world_is_told(tmp_path: Path):
    scene = two_balls()
    scene.add_part("Floor", trimesh.creation.box((4, 0.1, 4)), grounded=True)
    scene.apart.append(Apart(0, 3, "filtered pair"))
    result = kinefab.export(scene, tmp_path / "balls.kinefab", kinefab.ExportOptions(ground="world"))
    assert "PAIR_DROPPED" in {d.code for d in result.report.diagnostics}
    assert frozenset(("A", "Floor")) in touching(tmp_path / "balls.kinefab")


@pytest.mark.parametrize("ignored", [True, False])
def test_a_pair_that_the_source_lets_pass_is_not_said_to_overlap(tmp_path: Path, ignored: bool):
    """Also where Unity does not keep it, which is told; other pairs are looked at, or that is said where the library is missing."""
    scene = kinefab.Scene()
    scene.add_part("A", trimesh.creation.box((0.2, 0.2, 0.2)))
    scene.add_part("Floor", trimesh.creation.box((4, 0.1, 4)), grounded=True)
    scene.apart += [Apart(0, 1, "filtered pair")] if ignored else []
    result = kinefab.export(scene, tmp_path / "a.kinefab", kinefab.ExportOptions(ground="world"))
    looked_at = {"COLLIDERS_OVERLAP", "OVERLAPS_NOT_CHECKED"} & {d.code for d in result.report.diagnostics}
    assert bool(looked_at) is not ignored


TWISTED = """<sdf version="1.9"><model name="m">
<link name="a"><inertial><mass>4</mass></inertial><collision name="c"><geometry><box><size>.3 .3 .3</size></box></geometry></collision></link>
<link name="b"><pose>0 0 .2 0 0 0</pose><inertial><mass>2</mass></inertial><collision name="c"><geometry><box><size>.3 .3 .3</size></box></geometry></collision></link>
<joint name="u" type="revolute2"><parent>a</parent><child>b</child><axis><xyz>1 0 0</xyz></axis><axis2><xyz>0.6 0.8 0</xyz></axis2></joint></model></sdf>"""


def test_a_body_between_joints_is_of_the_mass_that_it_helps_and_in_nobodys_way(tmp_path: Path):
    (tmp_path / "m.sdf").write_text(TWISTED, encoding="utf-8")
    result = kinefab.export(tmp_path / "m.sdf", tmp_path / "m.kinefab")
    objects = json.loads((tmp_path / "m.kinefab").read_text(encoding="utf-8"))["gameObjects"]
    masses = {
        o["id"]: c.get("mass", 1.0) for o in objects for c in o.get("components", ()) if c["type"] == "Rigidbody"
    }
    assert len(masses) == 3
    assert sum(masses.values()) == pytest.approx(6.0)
    assert masses["m/a"] == pytest.approx(4.0)
    assert touching(tmp_path / "m.kinefab") == set()
    assert not {"MASS_STAND_IN", "COLLIDERS_OVERLAP"} & {d.code for d in result.report.diagnostics}


def slide(index: int, direction: tuple[float, float, float], limited: bool = False) -> Axis:
    return Axis(index, "slide", np.zeros(3), np.array(direction), 0.0, 0.0, True, limited)


@pytest.mark.parametrize("limited", [False, True])
def test_three_slides_and_a_ball_are_a_free_body(limited: bool):
    ball = Axis(3, "ball", np.array([0.1, 0, 0]), np.array([0.0, 0, 1]), 0.0, 0.0, True, False, np.eye(3))
    slides = [slide(0, (0, 1, 0)), slide(1, (1, 0, 0), limited), slide(2, (0, 0, 1))]
    steps = steps_of([*slides, ball])
    assert (steps[0].kind is JointKind.FREE and len(steps) == 1) is not limited
    for step in steps[: 0 if limited else 1]:
        for axis, index in zip(slides, step.freedoms):
            assert step.frame_a.rotation[:, index] == pytest.approx(axis.direction)
        assert np.linalg.det(step.frame_a.rotation) == pytest.approx(1.0)


def gears() -> kinefab.Scene:
    """Two gears whose teeth overlap, each on a pin of the base, and a third one beside them that meshes with none."""
    scene = kinefab.Scene()
    base = scene.add_part("Base", trimesh.creation.box((0.6, 0.02, 0.3)), translation=(0, -0.05, 0), grounded=True)
    wheels = [
        scene.add_part(name, trimesh.creation.cylinder(0.055, 0.02), translation=(x, 0, 0))
        for name, x in (("Pinion", 0.0), ("Wheel", 0.1), ("Loose", 0.2))
    ]
    pins = [
        scene.cylinder(part, point=(x, 0, 0), axis=(0, 0, 1), radius=0.01)
        for part in (base, *wheels)
        for x in ((0.0, 0.1, 0.2) if part == base else (0.1 * wheels.index(part),))
    ]
    holes, own = pins[:3], pins[3:]
    for hole, pin in zip(holes, own):
        scene.add_constraint("insert", hole, pin)
    scene.add_constraint("gear", own[0], own[1], value=-1.0)
    return scene


def test_gears_that_mesh_pass_through_each_other(tmp_path: Path):
    result = kinefab.export(gears(), tmp_path / "gears.kinefab")
    assert touching(tmp_path / "gears.kinefab") == {frozenset(("Wheel", "Loose")), frozenset(("Pinion", "Loose"))}
    assert not [
        d
        for d in result.report.diagnostics
        if d.code == "COLLIDERS_OVERLAP" and "Pinion" in d.message and "Wheel" in d.message
    ]


def test_parts_that_are_rigid_with_a_third_pass_through_each_other(tmp_path: Path):
    """A hub, and two rims that overlap each other, all three held together; a fourth body hangs below the hub."""
    scene = kinefab.Scene()
    base = scene.add_part("Base", trimesh.creation.box((0.02, 0.02, 0.3)), translation=(0, 0, -0.5), grounded=True)
    parts = [
        scene.add_part(name, trimesh.creation.box((0.1, 0.1, 0.1)), translation=(x, 0, 0))
        for name, x in (("Hub", 0.0), ("Left", 0.3), ("Right", 0.35), ("Far", 3.0))
    ]
    scene.add_hinge(base, parts[0], point=(0, 0, 0), axis=(0, 0, 1), name="Pin")
    for part in parts[1:]:
        scene.add_fixed(parts[0], part)
    kinefab.export(scene, tmp_path / "hub.kinefab")
    found = touching(tmp_path / "hub.kinefab")
    assert frozenset(("Left", "Right")) not in found
    objects = json.loads((tmp_path / "hub.kinefab").read_text(encoding="utf-8"))["gameObjects"]
    assert [c["extras"]["apart"] for o in objects for c in o.get("components", ()) if "apart" in c.get("extras", {})] == [
        "held together by FixedJoints"
    ]


def three_links(model: str = "", fore: str = "") -> str:
    def link(name: str, z: float, more: str = "") -> str:
        return f"""<link name="{name}"><pose>0 0 {z} 0 0 0</pose><inertial><mass>1</mass></inertial>{more}<collision name="c"><geometry>
<box><size>.1 .1 .3</size></box></geometry></collision></link>"""

    def pin(parent: str, child: str) -> str:
        return f"""<joint name="{parent}{child}" type="revolute"><parent>{parent}</parent><child>{child}</child>
<axis><xyz>0 1 0</xyz></axis></joint>"""

    return f"""<sdf version="1.9"><world name="w"><model name="arm">{model}{link("base", 0)}{link("upper", 0.3)}{link("fore", 0.6, fore)}
{pin("base", "upper")}{pin("upper", "fore")}</model><model name="crate">{link("box", 3)}</model></world></sdf>"""


TRUE = "<self_collide>true</self_collide>"
FALSE = "<self_collide>false</self_collide>"


@pytest.mark.parametrize(
    ("model", "fore", "collides"),
    [("", "", False), (TRUE, "", True), (FALSE, TRUE, True), (TRUE, FALSE, True), ("", FALSE, False)],
)
def test_links_of_a_model_collide_where_one_of_them_says_so(tmp_path: Path, model: str, fore: str, collides: bool):
    """SDFormat 1.12: two links collide if one of both has self_collide, which a link has from its model; never across a joint."""
    (tmp_path / "arm.sdf").write_text(three_links(model, fore), encoding="utf-8")
    kinefab.export(tmp_path / "arm.sdf", tmp_path / "arm.kinefab")
    with_crate = {frozenset((f"arm/{name}", "crate/box")) for name in ("base", "upper", "fore")}
    within = {frozenset(("arm/base", "arm/fore"))} if collides else set()
    assert touching(tmp_path / "arm.kinefab") == with_crate | within


def test_a_link_that_says_so_collides_with_what_it_is_welded_to(tmp_path: Path):
    """Two links that a fixed joint makes one body, of which one passes through a third and one does not: what collides, collides."""
    weld = """<joint name="weld" type="fixed"><parent>base</parent><child>tool</child></joint></model><model name="crate">"""
    tool = """<link name="tool"><pose>0 0 1 0 0 0</pose><self_collide>true</self_collide><inertial><mass>1</mass></inertial>
<collision name="c"><geometry><box><size>.1 .1 .1</size></box></geometry></collision></link>"""
    text = three_links().replace("""</model><model name="crate">""", tool + weld)
    (tmp_path / "arm.sdf").write_text(text, encoding="utf-8")
    result = kinefab.export(tmp_path / "arm.sdf", tmp_path / "arm.kinefab")
    assert any({"arm/base", "arm/fore"} <= pair for pair in touching(tmp_path / "arm.kinefab"))
    assert "PAIR_DROPPED" in {d.code for d in result.report.diagnostics}


def test_a_link_passes_through_what_stands_of_its_own_model_alone(tmp_path: Path):
    """Nothing is joined to what stands: the pair alone is why that has a body of its own."""
    def link(name: str, x: float) -> str:
        return f"""<link name="{name}"><pose>{x} 0 0 0 0 0</pose><inertial><mass>1</mass></inertial><collision name="c"><geometry><box>
<size>.1 .1 .1</size></box></geometry></collision></link>"""

    foot = '<joint name="foot" type="fixed"><parent>world</parent><child>post</child></joint>'
    text = f"""<sdf version="1.9"><world name="w"><model name="wall"><static>true</static>{link("brick", 3)}</model><model name="m">
{link("post", 0)}{link("loose", 1)}{foot}</model></world></sdf>"""
    (tmp_path / "post.sdf").write_text(text, encoding="utf-8")
    kinefab.export(tmp_path / "post.sdf", tmp_path / "post.kinefab")
    assert touching(tmp_path / "post.kinefab") == {frozenset(("m/loose", "wall/brick"))}


def robot(name: str, x: float, base: str = "", more: str = "") -> str:
    """An arm on a hinge to a base that is fixed to the world, or to ``base``."""
    own = f"""<link name="base"><inertial><mass>2</mass></inertial><collision name="c"><geometry><box><size>.2 .2 .2</size></box></geometry>
</collision></link><joint name="foot" type="fixed"><parent>world</parent><child>base</child></joint>"""
    return f"""<model name="{name}"><pose>{x} 0 0 0 0 0</pose>{"" if base else own}{more}<link name="arm"><pose>0 0 .3 0 0 0</pose>
<inertial><mass>1</mass></inertial><collision name="c"><geometry><box><size>.1 .1 .3</size></box></geometry></collision></link>
<joint name="pin" type="revolute"><parent>{base or "base"}</parent><child>arm</child><axis><xyz>0 1 0</xyz></axis></joint></model>"""


FLOOR = """<model name="floor"><static>true</static><link name="plate"><collision name="c"><geometry><box><size>9 9 .1</size></box></geometry>
</collision></link></model>"""
ROBOTS = f'<sdf version="1.9"><world name="w">{FLOOR}{robot("one", 0)}{robot("two", 1)}{robot("hung", 2, "world")}</world></sdf>'


def pairs(*names: tuple[str, str]) -> set[frozenset[str]]:
    return {frozenset(pair) for pair in names}


BETWEEN_ROBOTS = pairs(
    *((arm, "floor/plate") for arm in ("one/arm", "two/arm", "hung/arm")),
    ("one/arm", "two/base"),
    ("two/arm", "one/base"),
    ("hung/arm", "one/base"),
    ("hung/arm", "two/base"),
    ("one/arm", "two/arm"),
    ("one/arm", "hung/arm"),
    ("two/arm", "hung/arm"),
)


def test_each_robot_passes_its_own_base_alone(tmp_path: Path):
    (tmp_path / "robots.sdf").write_text(ROBOTS, encoding="utf-8")
    kinefab.export(tmp_path / "robots.sdf", tmp_path / "robots.kinefab")
    assert touching(tmp_path / "robots.kinefab") == BETWEEN_ROBOTS


def test_each_robot_passes_its_own_base_alone_when_read_again(tmp_path: Path):
    (tmp_path / "robots.sdf").write_text(ROBOTS, encoding="utf-8")
    kinefab.export(tmp_path / "robots.sdf", tmp_path / "robots.kinefab")
    kinefab.export(tmp_path / "robots.kinefab", tmp_path / "again.kinefab")
    kinefab.export(tmp_path / "robots.kinefab", tmp_path / "bare.kinefab", kinefab.ExportOptions(closures="minimal"))
    assert touching(tmp_path / "again.kinefab") == BETWEEN_ROBOTS
    assert touching(tmp_path / "bare.kinefab") == BETWEEN_ROBOTS


def mated_base(grounded: bool, planes: int) -> kinefab.Scene:
    """An arm on the first of three boxes in a row, of which planes hold each to the one before; a fourth stands far away.

    grounded: whether each of them is fixed to the ground by itself too."""
    scene, box = kinefab.Scene(), trimesh.creation.box((0.1, 0.1, 0.1))
    row = [
        scene.add_part(name, box, translation=(0.3 * i, 0, 0), grounded=grounded or i == 0)
        for i, name in enumerate(("Foot", "Column", "Head"))
    ]
    scene.add_part("Far", box, translation=(5, 0, 0), grounded=True)
    for i, (one, other) in enumerate(zip(row, row[1:])):
        for normal in np.eye(3)[:planes]:
            at = (0.3 * i + 0.15, 0, 0)
            sides = (scene.plane(part, point=at, normal=tuple(normal)) for part in (one, other))
            scene.add_constraint("coincident", *sides)
    scene.add_hinge(row[0], scene.add_part("Arm", box, translation=(0, 0.05, 0)), point=(0, 0, 0), axis=(0, 0, 1))
    return scene


@pytest.mark.parametrize("grounded", [False, True])
def test_parts_that_mates_hold_together_are_one_base(tmp_path: Path, grounded: bool):
    kinefab.export(mated_base(grounded, planes=3), tmp_path / "a.kinefab")
    assert touching(tmp_path / "a.kinefab") == pairs(("Arm", "Far"))


def test_parts_that_mates_leave_a_slide_are_bases_of_their_own(tmp_path: Path):
    """A machine that stands on the floor, each fixed to the ground by itself: the floor is no part of the machine."""
    kinefab.export(mated_base(True, planes=2), tmp_path / "a.kinefab")
    assert touching(tmp_path / "a.kinefab") == pairs(("Arm", "Far"), ("Arm", "Column"), ("Arm", "Head"))
