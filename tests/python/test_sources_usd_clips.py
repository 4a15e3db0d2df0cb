"""Clips put everything where pxr has it, also between the samples; what no clip holds is told."""

from __future__ import annotations

import numpy as np
import pytest
from kinefab.spatial import Pose, matrix_from_quaternion, rotation_exp, rotation_log
from usd_stages import scene_of, stage

pxr = pytest.importorskip("pxr", reason="usd-core is not installed")
from pxr import Usd, UsdGeom  # noqa: E402

TURN = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
"""Scene from a stage with Z up."""


def xform(name: str, attributes: str, order: str, inside: str = 'def Sphere "G" {}') -> str:
    return f'def Xform "{name}" {{\n{attributes}\nuniform token[] xformOpOrder = [{order}]\n{inside}\n}}\n'


def sampled(scene, clip, second: float) -> dict[str, Pose]:
    """World poses of all nodes: translations between keys linear, rotations along the great arc."""
    i = int(np.clip(np.searchsorted(clip.times, second), 1, len(clip.times) - 1))
    share = (second - clip.times[i - 1]) / (clip.times[i] - clip.times[i - 1])
    tracks = {track.node: track for track in clip.tracks}
    worlds: list[Pose] = []
    for number, node in enumerate(scene.nodes):
        above, outer = Pose(), Pose()
        if node.parent is not None:
            above, outer = worlds[node.parent], scene.nodes[node.parent].pose
        own = outer.inverse() @ node.pose
        turn, place = own.rotation, own.translation
        track = tracks.get(number)
        if track is not None and track.translations is not None:
            place = track.translations[i - 1] * (1.0 - share) + track.translations[i] * share
        if track is not None and track.rotations is not None:
            first, last = (matrix_from_quaternion(track.rotations[k]) for k in (i - 1, i))
            turn = first @ rotation_exp(share * rotation_log(first.T @ last))
        worlds.append(above @ Pose(turn, place))
    return {node.id: world for node, world in zip(scene.nodes, worlds)}


MATRIX = "((1,0,0,0),(0,1,0,0),(0,0,1,0),(2,0,0,1))", "((0,1,0,0),(-1,0,0,0),(0,0,1,0),(2,3,0,1))"
PIVOT = "double3 xformOp:translate:p = (3, 1, 0)"
CASES = {
    "a turn about a pivot": xform(
        "A", f"{PIVOT}\ndouble xformOp:rotateZ.timeSamples = {{0: 10, 24: 100}}",
        '"xformOp:translate:p", "xformOp:rotateZ", "!invert!xformOp:translate:p"',
    ),
    "a sparse quaternion about a pivot": xform(
        "A", f"{PIVOT}\nquatf xformOp:orient.timeSamples = {{0: (1,0,0,0), 24: (0.0871557,0.9961947,0,0)}}",
        '"xformOp:translate:p", "xformOp:orient", "!invert!xformOp:translate:p"',
    ),
    "matrices": xform(
        "A", f"matrix4d xformOp:transform.timeSamples = {{0: {MATRIX[0]}, 24: {MATRIX[1]}}}", '"xformOp:transform"'
    ),
    "an inverse turn": xform(
        "A", f"{PIVOT}\ndouble xformOp:rotateX.timeSamples = {{0: 0, 24: 120}}",
        '"!invert!xformOp:rotateX", "xformOp:translate:p"',
    ),
    "one that ignores what moves above it": xform(
        "P", "double3 xformOp:translate.timeSamples = {0: (0,0,0), 24: (1,2,3)}", '"xformOp:translate"',
        xform("A", "double3 xformOp:translate = (5,0,7)", '"!resetXformStack!", "xformOp:translate"'),
    ),
    "a curve": xform(
        "A", "double xformOp:translateY.spline = {\nbezier,\n0: 1; post curve (10, 0),\n24: 9; pre (10, 0); post held,\n}",
        '"xformOp:translateY"',
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", CASES)
def test_between_its_samples_a_clip_is_where_pxr_is(tmp_path, case):
    if case == "a curve" and not hasattr(Usd.Attribute, "HasSpline"):
        pytest.skip("this usd-core has no splines")
    scene, _ = scene_of(tmp_path, stage(CASES[case], metres=0.1))
    (clip,) = scene.animations
    assert clip.times[-1] == pytest.approx(1.0) and len(clip.times) < 60
    opened = Usd.Stage.Open(str(tmp_path / "stage.usda"))
    for second in np.linspace(0.0, 1.0, 33):
        cache = UsdGeom.XformCache(Usd.TimeCode(24.0 * second))
        for name, pose in sampled(scene, clip, second).items():
            there = np.array(cache.GetLocalToWorldTransform(opened.GetPrimAtPath(f"/{name}"))).T
            left, _, right = np.linalg.svd(there[:3, :3])
            away = np.linalg.norm(pose.translation - TURN @ there[:3, 3] * 0.1)
            turned = np.linalg.norm(rotation_log((TURN @ left @ right @ TURN.T).T @ pose.rotation))
            assert away <= 2e-3 and turned <= 2e-3, (name, second)


def test_copies_of_a_moving_prototype_move_each_at_its_own_place(tmp_path):
    """Also of an instancer that moves itself, and of prototypes that lie elsewhere."""
    copies = 'def PointInstancer "I" {\npoint3f[] positions = [(10,0,0), (20,5,0)]\nint[] protoIndices = [0, 0]\nrel prototypes = </Q/P>\n}'
    moving = xform(
        "W",
        "double3 xformOp:translate.timeSamples = {0: (0,0,0), 24: (100,0,0)}",
        '"xformOp:translate"',
        copies,
    )
    prototype = xform(
        "P", "double3 xformOp:translate.timeSamples = {0: (0,0,1), 24: (0,0,4)}", '"xformOp:translate"'
    )
    text = f'{moving}over "Q" {{\n{prototype}\n}}\n'
    scene, _ = scene_of(tmp_path, stage(text))
    (clip,) = scene.animations
    poses = sampled(scene, clip, 0.5)
    assert np.allclose(poses["W/I[0]/P/G"].translation, TURN @ (60, 0, 2.5))
    assert np.allclose(poses["W/I[1]/P/G"].translation, TURN @ (70, 5, 2.5))


def test_what_no_clip_holds_is_told(tmp_path):
    """A scale, being seen, a colliding size and a drive; of visibility the first sample is what is exported."""
    grows = xform("S", "float3 xformOp:scale.timeSamples = {0: (1,1,1), 24: (2,3,4)}", '"xformOp:scale"')
    blinks = 'def Xform "V" {\ntoken visibility.timeSamples = {0: "invisible", 10: "inherited"}\ndef Sphere "G" {\ndouble radius.timeSamples = {0: 2, 24: 3}\n}\n}\n'
    scene, report = scene_of(tmp_path, stage(grows + blinks))
    seen = {node.id: node.bodies[0].visible for node in scene.nodes if node.bodies}
    assert seen == {"S/G": True, "V/G": False}
    told = {o.feature for o in report.outcomes if o.outcome.value == "dropped"}
    assert told == {
        "animation of the scale of S",
        "animation of V.visibility",
        "animation of V/G.radius",
    }
