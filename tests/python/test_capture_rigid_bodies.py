"""Inventor's own rigid bodies against those that the analysis finds in the captured constraints."""

from __future__ import annotations

import copy

import pytest
from cad.captures import capture
from cad.described import described, mechanism
from cad.inventor import Inventor
from kinefab.diagnostics import Report

REVOLUTE, TRANSLATIONAL, WELD, CYLINDERS, GEAR, PLANES = 68136, 68135, 68140, 68101, 68138, 68115
CRANK = ["Lever/Crank:1/LeverA:1", "Lever/Crank:1/Shaft:1", "Lever/Crank:1/PanelB:1"]
GROUPS = [[True, ["Lever/Base:1"]], [False, CRANK], [False, ["Lever/BarC:1"]], [False, ["Lever/SliderD:1"]]]
JOINTS = [[REVOLUTE, 0, 1], [REVOLUTE, 1, 2], [REVOLUTE, 2, 3], [TRANSLATIONAL, 0, 3]]
TYPES = {"CAPTURE_GROUP_SPLIT", "CAPTURE_GROUP_JOINED", "CAPTURE_PAIR_DIFFERS"}


def told(folder, groups=GROUPS, joints=JOINTS) -> list:
    values = mechanism("lever/lever.bundle.json")
    values["rigidBodies"] = {"groups": copy.deepcopy(groups), "joints": joints}
    report = Report()
    found = capture("inventor", Inventor(described(values)).record(), folder, "Z", report)
    assert found.draft.notes["rigidBodies"]["joints"][0]["type"] == joints[0][0]
    return [entry for entry in report.diagnostics if entry.code in TYPES]


def test_a_mechanism_that_both_see_alike_is_not_remarked(tmp_path):
    assert told(tmp_path) == []


def test_the_whole_rigid_assembly_is_as_good_as_its_parts(tmp_path):
    groups = [GROUPS[0], [False, ["Lever/Crank:1"]], *GROUPS[2:]]
    assert told(tmp_path, groups) == []


def test_parts_that_inventor_holds_together_and_we_do_not(tmp_path):
    groups = [GROUPS[0], GROUPS[1], [False, ["Lever/BarC:1", "Lever/SliderD:1"]]]
    (found,) = told(tmp_path, groups, [[REVOLUTE, 0, 1], [REVOLUTE, 1, 2]])
    assert found.code == "CAPTURE_GROUP_SPLIT"
    assert "Lever/BarC:1, Lever/SliderD:1" in found.message and found.remedy


def test_a_part_that_inventor_has_on_the_ground(tmp_path):
    groups = [[True, ["Lever/Base:1", "Lever/SliderD:1"]], *GROUPS[1:3]]
    (found,) = told(tmp_path, groups, [[REVOLUTE, 0, 1], [REVOLUTE, 1, 2]])
    assert found.code == "CAPTURE_GROUP_SPLIT" and "ground, Lever/SliderD:1" in found.message


def test_parts_that_we_hold_together_and_inventor_does_not(tmp_path):
    groups = [GROUPS[0], [False, CRANK[:2]], [False, CRANK[2:]], *GROUPS[2:]]
    joints = [[REVOLUTE, 0, 1], [REVOLUTE, 1, 2], [REVOLUTE, 2, 3], [REVOLUTE, 3, 4], [TRANSLATIONAL, 0, 4]]
    (found,) = told(tmp_path, groups, joints)
    assert found.code == "CAPTURE_GROUP_JOINED" and CRANK[2] in found.message


@pytest.mark.parametrize(
    ("joints", "stated", "ours"),
    [
        ([[CYLINDERS, 0, 1], *JOINTS[1:]], "cylindrical", "revolute"),
        ([*JOINTS[:3], [REVOLUTE, 3, 0]], "revolute", "prismatic"),
        ([*JOINTS[:3], [PLANES, 0, 3], [WELD, 0, 3]], "planar, fixed", "prismatic"),
        ([*JOINTS, [REVOLUTE, 1, 3]], "revolute", "nothing"),
        (JOINTS[:3], "nothing", "prismatic"),
    ],
    ids=["another kind", "another kind, turned round", "less than two leave", "only theirs", "only ours"],
)
def test_a_joint_that_is_another_one(joints, stated, ours, tmp_path):
    (found,) = told(tmp_path, joints=joints)
    assert found.code == "CAPTURE_PAIR_DIFFERS"
    assert f"has {stated}, the analysis finds {ours}" in found.message


@pytest.mark.parametrize(
    "joints",
    [[*JOINTS[:3], [PLANES, 0, 3], [PLANES, 0, 3]], [*JOINTS, [GEAR, 1, 3]], [[CYLINDERS, 0, 1], [PLANES, 0, 1], *JOINTS[1:]]],
    ids=["two planes make a slide", "a gear is no pair", "axes and planes make a hinge"],
)  # fmt: skip
def test_several_that_together_may_be_the_one(joints, tmp_path):
    assert told(tmp_path, joints=joints) == []
