"""The self check: what does not close is read in another documented way, or told with its residual."""

from __future__ import annotations

import numpy as np
import pytest
from cad.captures import capture, scene_differences
from cad.described import described, mechanism
from cad.inventor import Inventor
from kinefab.capture.checking import CLOSED, check, residuals
from kinefab.capture.draft import Draft
from kinefab.diagnostics import Report

TURNED = [[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0], [0.0, 0.0, 1.0]]


def draft(joints=(), constraints=(), length="m") -> Draft:
    """A base, an assembly turned and shifted, in it an arm, shifted again."""
    found = Draft("Inventor", length, "Y")

    def component(name, o, axes, **more):
        pose = {"o": o, **dict(zip("xyz", axes))}
        found.components.append({"id": name, "kind": "part", "pose": pose, **more})

    component("M", [0.0, 0.0, 0.0], np.eye(3).tolist(), kind="assembly", flexible=True)
    component("M/Base", [0.0, 0.0, 0.0], np.eye(3).tolist(), parent="M", grounded=True)
    component("M/Sub", [0.3, -0.2, 0.5], TURNED, parent="M", kind="assembly", flexible=True)
    component("M/Sub/Arm", [0.7, 0.1, -0.4], TURNED, parent="M/Sub")
    found.joints += joints
    found.constraints += constraints
    return found


def told(found: Draft) -> list[str]:
    check(found)
    return [entry.code for entry in found.report.diagnostics]


def circles(p_a, p_b, d_a=(0.0, 0.0, 1.0), d_b=(0.0, 0.0, 1.0), inside="world", **more):
    a = {"component": "M/Base", "geometry": "circle", "in": inside, "p": list(p_a), "d": list(d_a), "r": 0.01}
    b = {
        "component": "M/Sub/Arm",
        "geometry": "circle",
        "in": inside,
        "p": list(p_b),
        "d": list(d_b),
        "r": 0.01,
    }
    return {
        "id": "c",
        "kind": "insert",
        "a": a,
        "b": b,
        "sense": "aligned",
        "reading": {"offset": "along_normal"},
    } | more


def lowered(name: str, point) -> list[float]:
    pose = {"M/Sub": [0.3, -0.2, 0.5], "M/Sub/Arm": [0.7, 0.1, -0.4]}[name]
    return (np.array(TURNED) @ (np.array(point) - pose)).tolist()


POINT = (0.42, 0.13, -0.27)


def test_what_closes_is_left_alone():
    found = draft(constraints=[circles(POINT, POINT)])
    before = [dict(c) for c in found.constraints]
    assert told(found) == []
    assert found.constraints == before


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (circles(POINT, lowered("M/Sub/Arm", POINT)), "part's frame"),
        (circles(POINT, POINT, d_b=(0.0, 0.0, -1.0)), "side reversed"),
        (
            circles(np.array(POINT) * 100.0, np.array(lowered("M/Sub/Arm", POINT)) * 100.0, inside="part"),
            "centimetres",
        ),
        (circles(POINT, np.array(POINT) + (0.0, 0.0, 0.05), value=-0.05), "other sign"),
        (circles(POINT, np.array(POINT) + (0.0, 0.0, 0.05), value=5.0), "value taken in centimetres"),
    ],
    ids=["frame", "face side", "points in cm", "sign", "value in cm"],
)
def test_the_reading_that_closes_is_taken_and_told(wrong, words):
    found = draft(constraints=[wrong])
    assert told(found) == ["CAPTURE_READING_CHANGED"]
    assert words in found.constraints[0]["extras"]["reading"]
    assert residuals(found, constraints=found.constraints)["c"] <= CLOSED


def test_numbers_of_an_owner_are_lifted():
    """A mate of a sub-assembly is stated in its frame: taken for the root's it does not close, and the check says so."""
    a = {
        "component": "M/Sub",
        "geometry": "circle",
        "in": "world",
        "p": lowered("M/Sub", POINT),
        "d": [0.0, 0.0, 1.0],
    }
    b = {
        "component": "M/Sub/Arm",
        "geometry": "circle",
        "in": "M/Sub/Arm",
        "p": lowered("M/Sub/Arm", POINT),
        "d": [0.0, 0.0, 1.0],
    }
    found = draft(constraints=[{"id": "c", "kind": "insert", "a": a, "b": b}])
    found.owners["c"] = "M/Sub"
    assert told(found) == ["CAPTURE_READING_CHANGED"]
    assert residuals(found, constraints=found.constraints)["c"] <= CLOSED


def test_what_nothing_closes_is_told_with_its_residual():
    found = draft(constraints=[circles(POINT, np.array(POINT) + (0.0123, 0.0, 0.0))])
    assert told(found) == ["CAPTURE_NOT_CLOSED"]
    assert "0.0123" in found.report.diagnostics[0].message


def joint(**more):
    frame = {"in": "world", "o": list(POINT), "z": [0.0, 0.0, 1.0], "x": [1.0, 0.0, 0.0]}
    turned = {**frame, "x": [np.cos(0.3), np.sin(0.3), 0.0]}
    dof = {"name": "rz", "value": 0.3, "min": -0.2, "max": 1.4, "minEnabled": True, "maxEnabled": True}
    return {
        "id": "j",
        "type": "revolute",
        "a": "M/Base",
        "b": "M/Sub/Arm",
        "frameA": frame,
        "frameB": turned,
        "dof": [dof | more],
    }


def test_a_joint_that_reads_its_value_closes():
    assert told(draft(joints=[joint()])) == []


@pytest.mark.parametrize(
    ("more", "words", "expected"),
    [
        ({"value": -0.3, "min": -1.4, "max": 0.2}, "other sign", (-0.2, 1.4)),
        ({"min": -0.5, "max": 0.1}, "counted from the value", (-0.2, 0.4)),
    ],
)
def test_values_and_limits_of_joints(more, words, expected):
    """A value counted the other way round turns its limits too; limits that leave the value out are counted from it."""
    found = draft(joints=[joint(**more)])
    assert told(found) == ["CAPTURE_READING_CHANGED"]
    assert words in found.joints[0]["extras"]["reading"]
    dof = found.joints[0]["dof"][0]
    assert (dof["min"], dof["max"]) == pytest.approx(expected)


@pytest.mark.parametrize(
    ("value", "b", "ratio"),
    [(0.3, "k", 2.5), (-0.3, "k", -2.5), (-0.3, "j", 2.5)],
    ids=["as shown", "one end", "both ends"],
)
def test_a_ratio_goes_with_a_value_that_counts_the_other_way(value, b, ratio):
    """Relations are stated between the coordinates that the program shows."""
    ends = (0.2, 1.4) if value > 0.0 else (-1.4, -0.2)
    other = {**joint(), "id": "k", "a": "M/Sub"}
    found = draft(joints=[joint(value=value, min=ends[0], max=ends[1]), other])
    found.couplings.append(
        {
            "id": "g",
            "kind": "linear",
            "a": {"joint": "j", "dof": "rz"},
            "b": {"joint": b, "dof": "rz"},
            "ratio": 2.5,
        }
    )
    check(found)
    assert found.values()["couplings"][0]["ratio"] == ratio


def test_a_limit_whose_flag_is_off_is_not_checked():
    assert told(draft(joints=[joint(min=0.5, minEnabled=False)])) == []


@pytest.mark.parametrize("points", ["assembly", "part"])
def test_joint_points_of_inventor_in_either_frame_give_one_scene(points, tmp_path):
    values = mechanism("lever/lever.bundle.json")
    report = Report()
    answers = Inventor(described(values), points).record()
    found = capture("inventor", answers, tmp_path, values["meta"]["up"], report)
    changed = [d for d in report.diagnostics if d.code == "CAPTURE_READING_CHANGED"]
    assert bool(changed) == (points == "part")
    assert scene_differences(values, found.path, tmp_path) == []
