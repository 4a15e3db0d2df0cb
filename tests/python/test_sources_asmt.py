"""Joints of OndselSolver that are more than one of the scene's: a link between two hinges, a joint of constant velocity."""

from __future__ import annotations

import math
import shutil
import subprocess
from pathlib import Path

import kinefab
import numpy as np
import pytest
from kinefab import sources
from kinefab.analysis import analyse
from kinefab.diagnostics import Report
from kinefab.model import RX, TX, ConstraintKind, CouplingKind, JointKind
from kinefab.sources.asmt.reader import TURN
from kinefab.spatial import quaternion_from_matrix, rotation_about, rotation_log

X, Y, Z = np.eye(3)
HALF = np.diag([1.0, -1.0, -1.0])


def frame(point, rotation=np.eye(3)) -> np.ndarray:
    found = np.eye(4)
    found[:3, :3], found[:3, 3] = rotation, point
    return found


def numbers(values) -> str:
    return "\t".join(repr(float(v)) for v in values)


def placed(at: np.ndarray, tabs: str) -> str:
    rows = "".join(f"{tabs}\t{numbers(row)}\n" for row in at[:3, :3])
    return f"{tabs}Position3D\n{tabs}\t{numbers(at[:3, 3])}\n{tabs}RotationMatrix\n{rows}"


def document(parts: dict[str, np.ndarray], joints: list[tuple[str, str, dict[str, float]]], markers) -> str:
    """parts: poses, WORLD.  joints: kind, name, numbers.  markers: by joint, its two sides: part ("" for the ground) and frame,
    WORLD."""

    def holder(name: str, pose: np.ndarray, tabs: str) -> str:
        own = [(joint, side[1]) for joint, sides in markers.items() for side in sides if side[0] == name]
        text = f"{tabs}RefPoints\n"
        for joint, at in own:
            text += f"{tabs}\tRefPoint\n{placed(np.eye(4), tabs + chr(9) * 2)}{tabs}\t\tMarkers\n{tabs}\t\t\tMarker\n"
            text += f"{tabs}\t\t\t\tName\n{tabs}\t\t\t\t\t{joint}\n{placed(np.linalg.inv(pose) @ at, tabs + chr(9) * 4)}"
        return text

    text = (
        "OndselSolver\nAssembly\n\tName\n\t\tA\n"
        + placed(np.eye(4), "\t")
        + holder("", np.eye(4), "\t")
        + "\tParts\n"
    )
    for name, pose in parts.items():
        text += f"\t\tPart\n\t\t\tName\n\t\t\t\t{name}\n{placed(pose, chr(9) * 3)}{holder(name, pose, chr(9) * 3)}"
    text += "\tConstraintSets\n\t\tJoints\n"
    for kind, name, values in joints:
        text += f"\t\t\t{kind}\n\t\t\t\tName\n\t\t\t\t\t{name}\n"
        for word, (part, _) in zip(("MarkerI", "MarkerJ"), markers[name]):
            text += f"\t\t\t\t{word}\n\t\t\t\t\t/A/{part + '/' if part else ''}{name}\n"
        text += "".join(f"\t\t\t\t{word}\n\t\t\t\t\t{value!r}\n" for word, value in values.items())
    return text + "\t\tMotions\n"


def read(folder: Path, text: str):
    (folder / "a.asmt").write_text(text, "utf-8")
    report = Report()
    return sources.read(folder / "a.asmt", report), report


@pytest.mark.parametrize("length, kinds", [(30.0, 2), (0.0, 2)])
def test_a_link_between_two_hinges(length: float, kinds: int, tmp_path: Path):
    """RevRevJoint: axes parallel at a distance, no way along them: 4 rows, 5 where the distance is none."""
    tilt = rotation_about(np.array([1.0, 2.0, 0.5]) / math.sqrt(5.25), 0.7)
    arm = frame(tilt @ np.array([length, 0.0, 0.0]) + [5.0, 6.0, 7.0], tilt @ rotation_about(Z, 0.4))
    sides = (("", frame([5.0, 6.0, 7.0], tilt)), ("Arm", arm))
    text = document({"Arm": arm}, [("RevRevJoint", "Rod", {"distanceIJ": length})], {"Rod": sides})
    scene, report = read(tmp_path, text)
    assert [d.code for d in report.diagnostics] == ["ASMT_ASSUMED"]
    assert len(scene.constraints) == kinds and not scene.joints
    first = ConstraintKind.DISTANCE if length else ConstraintKind.COINCIDENT
    assert [c.kind for c in scene.constraints] == [first, ConstraintKind.DISTANCE]
    assert analyse(scene).mobility == (2 if length else 1)


def along(axis: np.ndarray) -> np.ndarray:
    """A rotation that takes Z to an axis of the world."""
    across = np.roll(axis, 1)
    return np.column_stack([across, np.cross(axis, across), axis])


@pytest.mark.parametrize("holder", ["", "Base"])
@pytest.mark.parametrize("second_first", [False, True], ids=["holder is I", "holder is J"])
@pytest.mark.parametrize("way", [1.0, -1.0], ids=["axis along", "axis against"])
@pytest.mark.parametrize(
    ("kind", "numbers", "own", "motion", "word"),
    [
        ("GearJoint", {"radiusI": 20.0, "radiusJ": 8.0}, ("RevoluteJoint", Z), -2.5, CouplingKind.GEAR),
        ("GearJoint", {"radiusI": 20.0, "radiusJ": -8.0}, ("RevoluteJoint", Z), 2.5, CouplingKind.BELT),
        ("RackPinionJoint", {"pitchRadius": 12.0}, ("TranslationalJoint", X), 1.0 / 0.012, CouplingKind.RACK),
        ("ScrewJoint", {"pitch": 5.0}, ("TranslationalJoint", Z), -2.0 * math.pi / 0.005, CouplingKind.RACK),
    ],
)
def test_a_coupling_ties_the_motions_whichever_way_its_joints_count(
    kind, numbers, own, motion, word, way, second_first, holder, tmp_path: Path
):
    """own: joint and axis of the part with marker I.  motion: radians that J turns about Z for one of I's, or for its metre."""
    at = {
        "Base": frame([5.0, 2.0, 1.0], rotation_about(X, 0.4)),
        "One": frame([0, 0, 0], along(Z)),
        "Two": frame([28.0, 3.0, 5.0], rotation_about(Z, 0.3)),
    }
    joint, axis = own
    turning = joint == "RevoluteJoint"
    stands = frame(
        np.zeros(3) if turning else 4.0 * axis, along(way * axis) @ rotation_about(Z, 0.5 if turning else 0.0)
    )
    first = ((holder, frame([0, 0, 0], along(way * axis))), ("One", stands))
    second = ((holder, frame([28.0, 3.0, 5.0])), ("Two", frame([28.0, 3.0, 5.0], rotation_about(Z, 0.3))))
    markers = {
        "J1": first[::-1] if second_first else first,
        "J2": second,
        "Tie": (("One", frame([0, 0, 0])), ("Two", frame([28.0, 3.0, 5.0]))),
    }
    scene, _ = read(
        tmp_path,
        document(at, [(joint, "J1", {}), ("RevoluteJoint", "J2", {}), (kind, "Tie", numbers)], markers),
    )
    speeds = {"One": TURN @ axis, "Two": motion * (TURN @ Z)}
    rates, here = {}, {}
    for found in scene.joints:
        between = (scene.pose(found.a) @ found.frame_a).inverse() @ scene.pose(found.b) @ found.frame_b
        here[found.id] = {RX: rotation_log(between.rotation)[0], TX: between.translation[0]}
        main = (scene.pose(found.a) @ found.frame_a).rotation[:, 0]
        moved, held = (
            np.zeros(3) if n is None else speeds.get(scene.nodes[n].name, np.zeros(3))
            for n in (found.b, found.a)
        )
        rates[found.id] = float(main @ (moved - held))
    (coupling,) = scene.couplings
    (term,) = coupling.terms
    assert coupling.kind is word and {coupling.freedom, term.freedom} == {RX, RX if turning else TX}
    assert rates[coupling.joint] == pytest.approx(term.ratio * rates[term.joint])
    led, leader = here[coupling.joint][coupling.freedom], here[term.joint][term.freedom]
    assert led != 0.0 != leader and led == pytest.approx(term.ratio * leader + coupling.offset)


def shafts(bend: float, turn: float, way: np.ndarray) -> str:
    """A shaft along Z that is driven, one that leaves it at ``bend`` and has turned as far; ``way``: how J's marker stands."""
    second = rotation_about(Y, bend) @ rotation_about(Z, turn)
    parts = {"In": frame([0, 0, -40.0], rotation_about(Z, turn)), "Out": frame(second @ [0, 0, 50.0], second)}
    markers = {
        "Bearing": (("", frame([0, 0, -40.0])), ("In", parts["In"])),
        "Joint": (("In", frame([0, 0, 0], parts["In"][:3, :3])), ("Out", frame([0, 0, 0], second @ way))),
        "Sleeve": (("", frame(second @ [0, 0, 60.0], rotation_about(Y, bend))), ("Out", frame(second @ [0, 0, 60.0], second))),
    }  # fmt: skip
    kinds = (("RevoluteJoint", "Bearing"), ("ConstantVelocityJoint", "Joint"), ("CylindricalJoint", "Sleeve"))
    return document(parts, [(kind, name, {}) for kind, name in kinds], markers)


@pytest.mark.parametrize("way", [HALF, np.diag([-1.0, 1.0, -1.0])])
@pytest.mark.parametrize("bend, turn", [(0.6, 0.0), (0.6, 1.3), (-1.0, 2.9), (0.05, -0.7)])
def test_shafts_turn_alike(bend: float, turn: float, way: np.ndarray, tmp_path: Path):
    """Mobility 1 at every turn, the hinges' coordinates as split, and the second shaft's angle is the first's all the way round."""
    scene, report = read(tmp_path, shafts(bend, turn, way))
    assert [d.code for d in report.diagnostics] == ["ASMT_ASSUMED"]
    assert [joint.kind for joint in scene.joints].count(JointKind.REVOLUTE) == 4 and len(scene.couplings) == 1
    result = analyse(scene)
    assert result.mobility == 1
    (coupling,) = scene.couplings
    by_id = {joint.id: joint for joint in scene.joints}
    turned = []
    for key in (coupling.terms[0].joint, coupling.joint):
        joint = by_id[key]
        gap = (scene.pose(joint.a) @ joint.frame_a).inverse() @ scene.pose(joint.b) @ joint.frame_b
        assert np.abs(gap.translation).max() < 1e-12 and np.abs(gap.rotation[:, 0] - X).max() < 1e-9
        turned.append(2.0 * math.atan2(*quaternion_from_matrix(gap.rotation)[[RX - 3, 3]]))
    assert turned[0] == pytest.approx(turned[1], abs=1e-9)


def test_shafts_in_line_whose_axes_point_one_way_are_told(tmp_path: Path):
    """OndselSolver's equation holds nothing there, and two joints follow from it."""
    scene, report = read(tmp_path, shafts(0.0, 0.3, np.eye(3)))
    assert "ASMT_LEFT_OUT" in [d.code for d in report.diagnostics] and not scene.couplings


@pytest.mark.skipif(shutil.which("dotnet-kinefab") is None, reason="dotnet-kinefab is not on the PATH")
def test_the_written_shafts_are_valid_and_move(tmp_path: Path):
    (tmp_path / "a.asmt").write_text(shafts(0.6, 0.4, HALF), "utf-8")
    kinefab.export(tmp_path / "a.asmt", tmp_path / "a.kinefab")
    asked = (
        ("validate", "--strict", "0 errors"),
        ("mobility", "mobility   1, 1 in the file"),
        ("sweep", "--joint", "A/In.angle", 'A/Out[1].angularX "Sleeve.angularX" -360 to 0 deg'),
    )
    for word, *words, wanted in asked:
        command = ["dotnet-kinefab", word, str(tmp_path / "a.kinefab"), *words]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0 and wanted in done.stdout, done.stdout + done.stderr
