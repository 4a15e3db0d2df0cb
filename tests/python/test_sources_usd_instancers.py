"""Mechanisms in the prototypes of PointInstancers: every instance has bodies and joints of its own."""

from __future__ import annotations

import kinefab
import numpy as np
import pytest
from kinefab.model import Scene
from scene_kinematics import SceneKinematics, about, difference, unity_point, unity_pose
from usd_stages import body, codes, joint, scene_of, stage

pytest.importorskip("pxr", reason="usd-core is not installed")

TURNED = "(0.5, 0.5, 0.5, 0.5)"  # X to Y to Z to X
PLACES = ((1, 2, 3), (4, 5, 6))
LIMITS = " float physics:lowerLimit = -10\n float physics:upperLimit = 80\n"


def arm(path: str, more: str = "") -> str:
    """Bodies A and B below ``path``, B on a hinge about Z at (0.5, 0, 0)."""
    hinge = ' uniform token physics:axis = "Z"\n point3f physics:localPos0 = (0.5, 0, 0)\n' + LIMITS
    bodies = body("A") + body("B", at=(0.5, 0, 0))
    return bodies + joint("PhysicsRevoluteJoint", "J", hinge, f"{path}/A", f"{path}/B") + more


def instancer(inside: str, name: str = "I", path: str = "/I", turned: str = TURNED) -> str:
    """Two instances of the prototype ``Proto``, at PLACES, the second turned."""
    return (
        f'def PointInstancer "{name}" {{\n rel prototypes = [<{path}/Proto>]\n int[] protoIndices = [0, 0]\n'
        f" point3f[] positions = [{PLACES[0]}, {PLACES[1]}]\n quath[] orientations = [(1, 0, 0, 0), {turned}]\n"
        f' def Xform "Proto" {{\n{inside}\n }}\n}}\n'
    )


def ends(scene: Scene) -> dict[str, tuple[str | None, str | None]]:
    """Names of the bodies that each joint holds."""
    names = {None: None} | {i: node.id for i, node in enumerate(scene.nodes)}
    return {j.id: (names[j.a], names[j.b]) for j in scene.joints}


def test_each_instance_has_its_own_joint(tmp_path):
    """Pose of the second instance's arm at 30 degrees, by hand: its frame turns X to Y, Y to Z and Z to X."""
    scene, report = scene_of(tmp_path, stage(instancer(arm("/I/Proto"))))
    assert scene is not None and not codes(report)
    assert ends(scene) == {f"I[{i}]/Proto/J": (f"I[{i}]/Proto/A", f"I[{i}]/Proto/B") for i in (0, 1)}
    target = tmp_path / "scene.kinefab"
    kinefab.export(scene, target)
    motion = SceneKinematics.load(target)
    coordinates = {
        name: motion.reading(name, unity_point(np.array(axis)), True, name[:-1] + "B")
        for name, axis in (("I[0]/Proto/J", (0.0, 0.0, 1.0)), ("I[1]/Proto/J", (1.0, 0.0, 0.0)))
    }
    angles = dict(zip(coordinates, (20.0, 30.0)))
    values = {read[0]: read[1] * angles[name] for name, read in coordinates.items()}
    assert all(sorted(map(abs, motion.range_of(read[0]))) == [10.0, 80.0] for read in coordinates.values())
    poses = motion.poses(values)
    turn = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    z = np.array([0.0, 0.0, 1.0])
    for i, (frame, angle) in enumerate(((np.eye(3), 20.0), (turn, 30.0))):
        expected = unity_pose(frame @ about(z, np.radians(angle)), frame @ [0.5, 0, 0] + PLACES[i])
        assert max(difference(poses[motion.object(f"I[{i}]/Proto/B")], expected)) < 1e-6


def test_couplings_of_an_instance_stay_in_it(tmp_path):
    slide = (
        ' uniform token physics:axis = "X"\n'
        " rel newton:mimicJoint = </I/Proto/J>\n float newton:mimicCoef0 = 0\n float newton:mimicCoef1 = 0.01\n"
    )
    more = body("C") + joint(
        "PhysicsPrismaticJoint", "S", slide, "/I/Proto/B", "/I/Proto/C", '"NewtonMimicAPI"'
    )
    scene, _ = scene_of(tmp_path, stage(instancer(arm("/I/Proto", more))))
    assert scene is not None
    assert [(c.id, c.joint, c.terms[0].joint) for c in scene.couplings] == [
        (f"mimic:I[{i}]/Proto/S", f"I[{i}]/Proto/S", f"I[{i}]/Proto/J") for i in (0, 1)
    ]


def test_instancers_within_instancers_keep_apart(tmp_path):
    """A joint of the inner prototype holds a body of the outer one."""
    inner = instancer(
        body("Leaf") + joint("PhysicsFixedJoint", "F", "", "/I/Proto/A", "/I/Proto/K/Proto/Leaf"),
        "K", "/I/Proto/K",
    )  # fmt: skip
    scene, _ = scene_of(tmp_path, stage(instancer(arm("/I/Proto", inner))))
    assert scene is not None
    held = {name: pair for name, pair in ends(scene).items() if name.endswith("F")}
    assert held == {
        f"I[{i}]/Proto/K[{k}]/Proto/F": (f"I[{i}]/Proto/A", f"I[{i}]/Proto/K[{k}]/Proto/Leaf")
        for i in (0, 1)
        for k in (0, 1)
    }


def test_a_joint_from_outside_holds_the_first_instance_and_says_so(tmp_path):
    outside = body("B") + joint("PhysicsFixedJoint", "F", "", "/B", "/I/Proto/A")
    scene, report = scene_of(tmp_path, stage(instancer(arm("/I/Proto")) + outside))
    assert scene is not None and ends(scene)["F"] == ("B", "I[0]/Proto/A")
    told = [d.message for d in report.diagnostics if d.code == "USD_FEATURE_APPROXIMATED"]
    assert ["PointInstancer" in message for message in told] == [True, False], "and its frames do not meet"
    assert all("joint F" in message for message in told)


def test_instances_that_move_by_samples_are_told(tmp_path):
    text = instancer(arm("/I/Proto")).replace(
        f"positions = [{PLACES[0]}, {PLACES[1]}]",
        f"positions.timeSamples = {{ 0: [{PLACES[0]}, {PLACES[1]}], 24: [(0, 0, 0), (1, 1, 1)] }}",
    )
    scene, report = scene_of(tmp_path, stage(text))
    assert scene is not None and not scene.animations
    assert [o.feature for o in report.outcomes if "animation" in o.feature] == ["animation of I"]


@pytest.mark.parametrize("above", ['over "Q"', 'class "Q"', 'def Scope "Q"'])
def test_prototypes_that_nothing_else_draws_are_drawn_by_their_instancer(tmp_path, above):
    """As usd's documents advise, they lie in an ``over``; instances within them, too."""
    prototype = 'def Xform "P" {\ndef Sphere "G" {}\ndef Xform "N" (\ninstanceable = true\nreferences = </Lib>\n) {}\n}'
    text = f'def Xform "Lib" {{\ndef Cube "C" {{}}\n}}\n{instancer("", "I", "/Q/P")}{above} {{\n{prototype}\n}}\n'
    text = text.replace("</Q/P/Proto>", "</Q/P>")
    scene, _ = scene_of(tmp_path, stage(text))
    drawn = {node.id for node in scene.nodes if node.bodies}
    assert {f"I[{i}]/P/{name}" for i in (0, 1) for name in ("G", "N/C")} == {n for n in drawn if n[0] == "I"}
    assert any(name.startswith("Q") for name in drawn) == above.startswith("def")


def test_speeds_of_instances_are_told(tmp_path):
    text = instancer(arm("/I/Proto")).replace(
        "int[] protoIndices", "vector3f[] velocities = [(0, 0, 0), (0, 2, 0)]\nint[] protoIndices", 1
    )
    assert "velocities" in text
    _, report = scene_of(tmp_path, stage(text))
    assert "velocities of /I" in {o.feature for o in report.outcomes}


def test_colours_of_instances_are_told_and_one_of_all_is_theirs(tmp_path):
    def told(primvar: str):
        text = instancer(arm("/I/Proto")).replace("int[] protoIndices", f"{primvar}\nint[] protoIndices", 1)
        _, report = scene_of(tmp_path, stage(text), f"{len(primvar)}.usda")
        return {o.feature for o in report.outcomes if "primvar" in o.feature}

    each = 'color3f[] primvars:displayColor = [(1, 0, 0), (0, 1, 0)] (interpolation = "vertex")'
    assert told(each) == {"primvar displayColor of /I"}
    assert told("color3f[] primvars:displayColor = [(1, 0, 0)]") == set()
