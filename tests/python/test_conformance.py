"""Every case under ``tests/conformance`` that the manifest lists, as Python sees it."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from kinefab.diagnostics import Report
from kinefab.model import Freedom, Joint, JointKind, Motion, Node, Scene, freedoms_of
from kinefab.rigid import rigid_groups
from kinefab.spatial import Pose, rotation_about
from kinefab.unity import frames
from kinefab.unity.joints.mapping import map_joint
from scenes import scene_validator
from unity_entries import entry_of
from unity_semantics import Live, matrix

ROOT = Path(__file__).parents[1] / "conformance"
AXES = {
    sign + name: (1 if sign == "" else -1) * np.eye(3)[i]
    for sign in ("", "-")
    for i, name in enumerate("XYZ")
}


def cases(kind: str) -> list[dict]:
    manifest = json.loads((ROOT / "manifest.json").read_text(encoding="utf-8"))
    return [entry for entry in manifest["cases"] if entry["kind"] == kind]


def each(kind: str):
    return pytest.mark.parametrize("case", cases(kind), ids=lambda case: Path(case["path"]).stem)


def load(case: dict) -> dict:
    return json.loads((ROOT / case["path"]).read_text(encoding="utf-8"))


RUNNERS = {"scene": "here", "frames": "here", "joints": "here", "source": "test_sources_conformance.py"}


def test_every_case_on_disk_is_listed_once_and_has_a_runner():
    """The manifest names each case file, none twice, none that is not there, and no kind that nobody runs."""
    manifest = json.loads((ROOT / "manifest.json").read_text(encoding="utf-8"))["cases"]
    assert {entry["kind"] for entry in manifest} <= RUNNERS.keys()
    listed = [entry["path"] for entry in manifest if RUNNERS[entry["kind"]] == "here"]
    patterns = ("frames/*.json", "joints/*.json", "**/*.kinefab")
    found = [path.relative_to(ROOT).as_posix() for pattern in patterns for path in ROOT.glob(pattern)]
    assert sorted(listed) == sorted(found)
    assert len(listed) >= 124


@each("scene")
def test_scene_case_is_what_the_schema_says(case):
    """JSON Schema alone accepts or rejects the text, as the manifest states; faults that it cannot see are C#'s."""
    try:
        content = json.loads((ROOT / case["path"]).read_bytes().decode("utf-8"))
        accepted = scene_validator().is_valid(content)
    except ValueError:
        accepted = False
    assert ("accepts" if accepted else "rejects") == case["schema"]


def turn_of(source: dict) -> np.ndarray:
    """Source axes to the scene's: rows are right, up and forward."""
    up, forward = AXES[source["up"]], AXES[source["forward"]]
    return np.vstack([np.cross(up, forward), up, forward])


@each("frames")
def test_frames_case(case):
    """Each number pair: turned and scaled as a reader does, mirrored by the one mirror."""
    content = load(case)
    turn, unit = turn_of(content["source"]), content["source"]["metersPerUnit"]
    mapped = {
        "point": lambda v: frames.point(turn @ v * unit),
        "direction": lambda v: frames.direction(turn @ v),
        "normal": lambda v: frames.direction(turn @ v),
        "force": lambda v: frames.direction(turn @ v),
        "axis": lambda v: frames.axial(turn @ v),
        "angularVelocity": lambda v: frames.axial(turn @ v),
        "torque": lambda v: frames.axial(turn @ v),
        "quaternion": lambda q: frames.quaternion(np.append(turn @ q[:3], q[3])),
        "rotation": lambda r: frames.rotation(turn @ r @ turn.T),
        "inertia": lambda i: frames.inertia(turn @ i @ turn.T),
        "triangle": lambda t: frames.winding(t.reshape(1, 3))[0],
        "angleAboutDirection": frames.angle,
        "angleAboutAxis": lambda q: q,
        "distanceAlongDirection": lambda q: frames.distance(q * unit),
        "screwLead": lambda h: frames.lead(h * unit),
    }
    for pair in content["pairs"]:
        got = mapped[pair["quantity"]](np.array(pair["given"]))
        assert np.allclose(got, pair["unity"], atol=1e-12), pair


@each("joints")
def test_joints_case(case):
    """The component for the joint is the one the case states, and its sampled poses are allowed or not."""
    content = load(case)
    scene, joint = scene_of(content)
    report = Report()
    mapped = map_joint(joint, scene, rigid_groups(scene), lambda node: node, report)
    assert "ab"[mapped.owner] == content["carriedBy"]
    assert_same({"exact": True, "bounciness": 0} | entry_of(mapped.component), content["component"])
    for sample in content["samples"]:
        check_sample(content, entry_of(mapped.component), sample)


def scene_of(content: dict) -> tuple[Scene, Joint]:
    turn, unit = turn_of(content["source"]), content["source"]["metersPerUnit"]
    nodes = []
    for name in "ab":
        part = content.get(name)
        pose = Pose()
        if part is not None:
            axes = np.column_stack([part["x"], part["y"], part["z"]])
            pose = Pose(turn @ axes @ turn.T, turn @ part["o"] * unit)
        nodes.append(Node(name, name, pose=pose, grounded=bool(part and part.get("grounded"))))
    stated = content["joint"]
    x, y = turn @ np.array(stated["axis"], dtype=float), turn @ np.array(stated["secondary"], dtype=float)
    frame = Pose(np.column_stack([x, y, np.cross(x, y)]), turn @ stated["point"] * unit)
    values, freedoms = np.zeros(6), {}
    for name, entry in stated["freedoms"].items():
        index = ("tx", "ty", "tz", "rx", "ry", "rz").index(name)
        scale = unit if index < 3 else math.radians(1.0)
        values[index] = entry["value"] * scale
        freedoms[name] = Freedom(Motion.LIMITED, entry["lower"] * scale, entry["upper"] * scale)
    at_pose = frame @ Pose(rotation_about(np.array([1.0, 0, 0]), values[3]), values[:3])
    a = 0 if "a" in content else None
    kind = JointKind(stated["type"])
    frame_a, frame_b = (scene_node.pose.inverse() @ at for scene_node, at in zip(nodes, (frame, at_pose)))
    return Scene(nodes=nodes), Joint("J", kind, a, 1, frame_a, frame_b, freedoms_of(kind, **freedoms))


DEFAULTS = {"anchor": [0, 0, 0], "connectedAnchor": [0, 0, 0], "axis": [1, 0, 0], "secondaryAxis": [0, 1, 0]}
IGNORED_WHEN_IDLE = ("targetPosition", "targetVelocity", "targetAngularVelocity", "targetRotation")


def assert_same(got: dict, expected: dict, path: str = "") -> None:
    for key, value in expected.items():
        found = got.get(key, DEFAULTS.get(key, 0))
        if isinstance(value, dict):
            assert_same(found, value, f"{path}{key}.")
        elif isinstance(value, (str, bool)):
            assert found == value, path + key
        else:
            assert np.allclose(found, value, atol=1e-9), (path + key, found, value)
    for key in got.keys() - expected.keys():
        idle = key in IGNORED_WHEN_IDLE or key.endswith("Spring") or key in ("exact", "bounciness")
        assert idle, f"{path}{key} was not expected"


def check_sample(content: dict, component: dict, sample: dict) -> None:
    start = next(s for s in content["samples"] if is_start(content, s))
    pose = lambda p: (matrix(p["rotation"]), np.array(p["position"], dtype=float))  # noqa: E731
    bodies = [
        pose(s[key]) if key in s else (np.eye(3), np.zeros(3))
        for s in (start, sample)
        for key in ("own", "connected")
    ]
    live = Live(component, bodies[0], bodies[1])
    violation = live.violation(bodies[2], bodies[3])
    assert violation < 1e-9 if sample["allowed"] else violation > 1e-4, sample
    if "angle" in sample:
        assert live.hinge_angle(bodies[2], bodies[3]) == pytest.approx(sample["angle"], abs=1e-7)


def is_start(content: dict, sample: dict) -> bool:
    values = {name: entry["value"] for name, entry in content["joint"]["freedoms"].items()}
    return all(value == values.get(name, 0) for name, value in sample["coordinate"].items())
