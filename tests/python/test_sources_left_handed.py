"""A left-handed source is the same mechanism, counted by the other hand."""

from __future__ import annotations

import copy
import dataclasses
import json
from enum import Enum
from pathlib import Path

import kinefab
import numpy as np
import pytest
from golden import differences
from kinefab.spatial import rotation_about
from source_bundles import FIXTURES, bundle, codes, frame, part, read

ACROSS = np.array([-1.0, 1.0, 1.0])
"""With Y up and Z forward, or Z up and -Y forward, the right-hand X is the left-hand -X."""


def turned_part(name: str, o, axis, angle: float, **more) -> dict:
    axis = np.array(axis) / np.linalg.norm(axis)
    x, y, z = rotation_about(axis, angle).T.tolist()
    return part(name, o, **more) | {"pose": {"o": list(o), "x": x, "y": y, "z": z}}


def limited(name: str, value: float, low: float, high: float) -> dict:
    return {"name": name, "value": value, "min": low, "max": high, "minEnabled": True, "maxEnabled": True}


def feature(component: str, geometry: str, p, d=None, **more) -> dict:
    return {
        "component": component,
        "geometry": geometry,
        "in": "world",
        "p": p,
        **({} if d is None else {"d": d}),
        **more,
    }


def asymmetric(up: str, length: str, angle: str) -> dict:
    """Every kind of number that a mirror can get wrong, none of them equal to another."""
    degree = 1.0 if angle == "deg" else np.pi / 180.0
    axis, across = [0.6, 0.0, 0.8], [0.8, 0.0, -0.6]
    more_across = (np.cos(0.4) * np.array(across) + np.sin(0.4) * np.cross(axis, across)).tolist()
    mass = {"in": "part", "mass": 2.0, "center": [0.1, 0.2, 0.3], "inertia": [3.0, 4.0, 5.0, 0.3, 0.4, 0.5]}
    parts = [
        part("base", (0.1, 0.2, 0.3), grounded=True),
        turned_part("lid", (1.0, 2.0, 3.0), (1, 2, 3), 0.7, mass=mass),
        *(
            turned_part(name, (k, 1.5, -k), (2, -1, k), 0.3 * k)
            for k, name in enumerate(["slide", "table", "nut", "wheel", "rack"], 2)
        ),
        *(part(f"free{k}", (5.0, k, 1.0)) for k in range(4)),
    ]
    joint = lambda kind, b, dof, **more: {  # noqa: E731
        "id": f"{kind} {b}", "type": kind, "a": "base", "b": b, "frameA": frame((1.0, 2.0, 0.5), axis, across),
        "frameB": frame((1.0, 2.0, 0.5), axis, more_across), "dof": dof, **more,
    }  # fmt: skip
    turn = 0.4 if angle == "rad" else np.degrees(0.4)
    joints = [
        joint("revolute", "lid", [limited("rz", turn, -10 * degree, 80 * degree)]),
        joint("slider", "slide", [limited("tz", 0.0, -0.1, 0.8)])
        | {"frameB": frame((1.0, 2.0, 0.5), axis, across)},
        joint(
            "planar",
            "table",
            [
                limited("tx", 0.0, -0.2, 0.3),
                limited("ty", 0.0, -0.1, 0.8),
                limited("rz", turn, -20 * degree, 50 * degree),
            ],
        ),
        joint("screw", "nut", [], lead=0.05),
        joint("revolute", "wheel", []),
        joint("slider", "rack", []) | {"frameB": frame((1.0, 2.0, 0.5), axis, across)},
    ]
    couplings = [
        {
            "id": "gear",
            "kind": "gear",
            "a": {"joint": "revolute lid", "dof": "rz"},
            "b": {"joint": "revolute wheel", "dof": "rz"},
            "ratio": -2.5,
        },
        {
            "id": "rack",
            "kind": "rack",
            "a": {"joint": "revolute wheel", "dof": "rz"},
            "b": {"joint": "slider rack", "dof": "tz"},
            "radius": 0.25,
        },
        {
            "id": "table",
            "kind": "linear",
            "a": {"joint": "planar table", "dof": "ty"},
            "b": {"joint": "slider rack", "dof": "tz"},
            "ratio": 1.5,
        },
    ]
    y, z = [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]
    tilted = [np.sin(0.3), np.cos(0.3), 0.0]
    constraints = [
        {"id": "angle", "kind": "angle", "a": feature("base", "plane", [1, 2, 3], y), "b": feature("free0", "plane", [3, 2, 1], tilted), "c": feature("base", "line", [0, 0, 0], z), "value": -0.3 if angle == "rad" else np.degrees(-0.3)},
        {"id": "range", "kind": "angle", "a": feature("base", "plane", [1, 2, 3], y), "b": feature("free1", "plane", [3, 2, 1], tilted), "c": feature("base", "line", [0, 0, 0], z), "min": -10 * degree, "max": 80 * degree},
        {"id": "plain", "kind": "angle", "a": feature("base", "plane", [1, 2, 3], y), "b": feature("free2", "line", [3, 2, 1], tilted), "value": 70 * degree},
        {"id": "screw", "kind": "screw", "a": feature("base", "cylinder", [1, 2, 3], z), "b": feature("free3", "cylinder", [1, 2, 3], z), "value": 0.07},
        {"id": "cone", "kind": "concentric", "a": feature("base", "cone", [1, 2, 3], z, halfAngle=20 * degree), "b": feature("free2", "cylinder", [1, 2, 3], z, r=0.1)},
        {"id": "offset", "kind": "coincident", "a": feature("base", "plane", [1, 2, 3], y), "b": feature("free3", "plane", [3, 2.4, 1], y), "value": 0.4},
    ]  # fmt: skip
    record = {"component": "lid", "translations": [axis], "rotations": [across], "center": [1.0, 2.0, 3.0]}
    return bundle(
        *parts,
        up=up,
        length=length,
        angle=angle,
        joints=joints,
        couplings=couplings,
        constraints=constraints,
        dof=[record],
    )


def by_the_other_hand(right: dict) -> dict:
    """The same parts and features as a left-handed program writes them.

    Vectors lose the sign of their X.  An angle about an axis is counted by the other hand, a frame's y (z x x) points
    the other way, and so do travels for a turn; an angle between a line and a plane is what it was.
    """
    left = copy.deepcopy(right)
    left["meta"]["handed"] = "left"

    def walk(value):
        if isinstance(value, dict):
            for key, item in value.items():
                vector = key in ("o", "x", "y", "z", "p", "d", "center") and isinstance(item, list)
                value[key] = (ACROSS * item).tolist() if vector else walk(item)
        elif isinstance(value, list):
            return [walk(item) for item in value]
        return value

    def turned(entry: dict) -> None:
        entry |= {key: -entry[key] for key in ("value",) if key in entry}
        ends = {end: entry.pop(end) for end in ("min", "max", "minEnabled", "maxEnabled") if end in entry}
        for end, other in (("min", "max"), ("max", "min")):
            entry |= {other: -ends[end]} if end in ends else {}
            entry |= {f"{other}Enabled": ends[f"{end}Enabled"]} if f"{end}Enabled" in ends else {}

    for key in ("components", "joints", "constraints"):
        left[key] = walk(left.get(key, []))
    for component in left["components"]:
        component["pose"]["x"] = (-np.array(component["pose"]["x"])).tolist()  # the part's own X turns too
        if "mass" in component:
            xx, yy, zz, xy, yz, xz = component["mass"]["inertia"]
            component["mass"]["inertia"] = [xx, yy, zz, -xy, yz, -xz]
    for joint in left["joints"]:
        for coordinate in joint["dof"]:
            if coordinate["name"] in ("ty", "rx", "rz"):
                turned(coordinate)
        if "lead" in joint:
            joint["lead"] = -joint["lead"]
    for coupling in left.get("couplings", []):
        if coupling["kind"] == "rack":
            coupling["radius"] = -coupling["radius"]
        if coupling["id"] == "table":
            coupling["ratio"] = -coupling["ratio"]
    for constraint in left["constraints"]:
        if constraint["id"] in ("angle", "range", "screw"):
            turned(constraint)
    for record in left.get("dof", []):
        for key in ("translations", "rotations"):
            record[key] = [(ACROSS * v).tolist() for v in record[key]]
        record["center"] = (ACROSS * record["center"]).tolist()
    return left


def plain(value):
    """A scene as JSON values, without where it was read from and how it is shown there."""
    if dataclasses.is_dataclass(value):
        return {
            f.name: plain(getattr(value, f.name))
            for f in dataclasses.fields(value)
            if f.name not in ("source", "where", "sign")
        }
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    return str(value) if isinstance(value, Path) else dict(value) if isinstance(value, dict) else value


@pytest.mark.parametrize(("length", "angle"), [("m", "rad"), ("mm", "deg")])
@pytest.mark.parametrize("up", ["Y", "Z"])
def test_a_left_handed_source_is_read_as_its_right_handed_twin(up, length, angle, tmp_path):
    """Poses, frames, limits -10...80, leads, ratios, directed angles, inertia: the same scene from either hand."""
    right = asymmetric(up, length, angle)
    expected, report = read(right, tmp_path)
    found, other = read(by_the_other_hand(right), tmp_path)
    assert codes(report) == codes(other) == []
    assert len(found.joints) == 6 and len(found.couplings) == 3 and len(found.constraints) == 6
    assert differences(plain(expected), plain(found), 1e-12) == []


def test_what_is_counted_about_an_axis_is_counted_by_the_left_hand(tmp_path):
    """Stated by hand: a lid at +25 degrees by the left hand about +X of a left-handed source, free from -10 to 80."""
    turn = np.radians(25.0)
    x, y, z = [1, 0, 0], [0, np.cos(turn), np.sin(turn)], [0, -np.sin(turn), np.cos(turn)]
    values = bundle(
        part("base", grounded=True),
        {"id": "lid", "kind": "part", "pose": {"o": [1, 2, 3], "x": x, "y": y, "z": z}},
        angle="deg",
        joints=[{
            "id": "hinge", "type": "revolute", "a": "base", "b": "lid", "frameA": frame((1, 2, 3), (1, 0, 0), (0, 1, 0)),
            "frameB": frame((1, 2, 3), (1, 0, 0), y), "dof": [limited("rz", 25.0, -10.0, 80.0)],
        }],
    )  # fmt: skip
    values["meta"]["handed"] = "left"
    scene, report = read(values, tmp_path)
    assert codes(report) == []
    result = kinefab.export(scene, tmp_path / "lid.kinefab")
    objects = json.loads(result.path.read_text("utf-8"))["gameObjects"]
    lid = next(o for o in objects if o["name"] == "lid")
    assert lid["transform"]["localPosition"] == [1, 2, 3]
    assert lid["transform"]["localRotation"] == pytest.approx(
        [np.sin(turn / 2), 0, 0, np.cos(turn / 2)], abs=1e-9
    )
    hinge = next(c for c in lid["components"] if c["type"] == "HingeJoint")
    # the component's axis may point either way; what the hinge lets the lid do may not
    sense = hinge["axis"][0]
    assert hinge["axis"] == pytest.approx([sense, 0, 0], abs=1e-9) and abs(sense) == pytest.approx(1.0)
    limits = sorted(sense * hinge["limits"][end] for end in ("min", "max"))
    assert limits == pytest.approx([-35.0, 55.0], abs=1e-6)


@pytest.mark.parametrize("handed", ["right", "left"])
def test_a_coordinate_is_shown_as_the_source_counts_it(handed, tmp_path):
    """Displayed 380 (20 and a whole turn), limits -10 to 80 and a turn: in messages and in motions, from either hand."""
    z, x, off = (0, 0, 1), (1, 0, 0), (np.cos(np.radians(23.0)), np.sin(np.radians(23.0)), 0)
    joint = {"id": "hinge", "type": "revolute", "a": "base", "b": "lid", "frameA": frame((1, 2, 3), z, x)}
    values = bundle(
        part("base", grounded=True),
        part("lid", (1.5, 2.0, 3.0)),
        angle="deg",
        joints=[joint | {"frameB": frame((1, 2, 3), z, off), "dof": [limited("rz", 380.0, 350.0, 440.0)]}],
    )
    values["meta"]["handed"] = handed
    scene, report = read(values, tmp_path)
    assert [d.message for d in report.diagnostics] == [
        "joint hinge has the value 380 degrees, its frames say 23 degrees; the value was taken."
    ]
    mechanism = kinefab.motion(scene)
    hinge = mechanism.coordinate("hinge")
    assert (hinge.value, hinge.lower, hinge.upper) == pytest.approx((380.0, 350.0, 440.0))
    counted = (20.0, -10.0, 80.0) if handed == "right" else (-20.0, -80.0, 10.0)
    assert np.degrees(mechanism.internal(hinge)) == pytest.approx(counted)
    way = mechanism.sweep("hinge", 380.0, 470.0, frames=10)
    assert len(way) == 7 and way["hinge"][-1] == pytest.approx(440.0)
    assert str(way.stop) == "hinge is at its limit at 440 deg"
    assert way["lid"][6, :3] - way["lid"][0, :3] == pytest.approx(
        np.array([1.0 if handed == "right" else -1.0, 1.0, 1.0]) * [-0.25, np.sqrt(0.1875), 0.0], abs=1e-9
    )

    values["joints"][0] |= {"frameB": None, "dof": [limited("rz", 20.0, -10.0, 15.0)]}
    del values["joints"][0]["frameB"]
    scene, report = read(values, tmp_path)
    said = [d.message for d in kinefab.export(scene, tmp_path / "lid.kinefab").report.diagnostics]
    assert report.diagnostics == [] and any("rz = 20 degrees, outside its range -10 to 15" in m for m in said)


def test_a_unity_like_source_comes_back_as_it_was_written(tmp_path):
    """Y up, Z forward, left-handed, metres: positions, rotations, vertices and triangles are Unity's already."""
    vertices = [[0, 0, 0], [1, 0, 0], [0, 2, 0], [0, 0, 3]]
    faces = [[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]]  # clockwise seen from outside, as Unity has them
    obj = (
        ["o block"]
        + [f"v {x} {y} {z}" for x, y, z in vertices]
        + ["f " + " ".join(str(i + 1) for i in f) for f in faces]
    )
    (tmp_path / "parts.obj").write_text("\n".join(obj) + "\n", "utf-8")
    turn = rotation_about(np.array([2.0, 3.0, 6.0]) / 7.0, 0.9)
    x, y, z = turn.T.tolist()
    values = bundle(
        {
            "id": "block",
            "kind": "part",
            "pose": {"o": [1, 2, 3], "x": x, "y": y, "z": z},
            "bodies": [{"id": "block"}],
        }
    )
    values["meta"] |= {
        "handed": "left",
        "mesh": {
            "files": ["parts.obj"],
            "units": "m",
            "layout": "single",
            "coordinates": "part",
            "key": "object",
        },
    }
    path = tmp_path / "block.bundle.json"
    path.write_text(json.dumps(values), "utf-8")
    result = kinefab.export(path, tmp_path / "block.kinefab")
    document = json.loads(result.path.read_text("utf-8"))
    block = next(o for o in document["gameObjects"] if o["name"] == "block")
    assert block["transform"]["localPosition"] == [1, 2, 3]
    q = [*(np.array([2.0, 3.0, 6.0]) / 7.0 * np.sin(0.45)), np.cos(0.45)]
    assert block["transform"]["localRotation"] == pytest.approx(q, abs=1e-9)
    mesh, data = document["meshes"][0], result.files[1].read_bytes()
    count, indices = mesh["vertexCount"], sum(s["indexCount"] for s in mesh["submeshes"])
    points = np.frombuffer(data, "<f4", 3 * count, mesh["positions"]["offset"]).reshape(-1, 3)
    kind = {"uint16": "<u2", "uint32": "<u4"}[mesh["indexFormat"]]
    triangles = points[np.frombuffer(data, kind, indices, mesh["indices"]["offset"]).reshape(-1, 3)]
    normal = lambda t: tuple(np.cross(t[1] - t[0], t[2] - t[0]).round(6).tolist())  # noqa: E731
    assert sorted(map(normal, triangles)) == sorted(normal(np.array(vertices, float)[f]) for f in faces)
    assert {tuple(p) for p in points.tolist()} == {tuple(map(float, v)) for v in vertices}
    body = next(c for c in block["components"] if c["type"] == "Rigidbody")
    assert body["mass"] == pytest.approx(1000.0) and body["centerOfMass"] == pytest.approx(
        [0.25, 0.5, 0.75], abs=1e-6
    )


def test_the_golden_box_is_the_same_from_the_left_hand(tmp_path):
    """A hinge from -10 to 80 degrees and a slide, in millimetres with Z up, through the whole export.  Beside the component stands
    that the source itself counts the turn the other way."""
    source = FIXTURES / "hinge_slider_zup" / "hinge_slider.bundle.json"
    right = json.loads(source.read_text("utf-8"))
    right["meta"].pop("mesh")
    for component in right["components"]:
        component.pop("bodies", None)
    documents = []
    for values in (right, by_the_other_hand(right)):
        path = tmp_path / "box.bundle.json"
        path.write_text(json.dumps(values), "utf-8")
        document = json.loads(kinefab.export(path, tmp_path / "box.kinefab").path.read_text("utf-8"))
        documents.append({key: document[key] for key in ("gameObjects", "analysis", "report")})
    assert differences(*documents, 1e-9) == [
        "/gameObjects/3/components/1/extras/asStated/freedoms/rx/sign: only on one side"
    ]
