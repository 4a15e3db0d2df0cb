"""Every finding of the analysis, each from data that has just that fault or trait."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import kinefab.analysis
import numpy as np
import pytest
from kinefab.analysis import AnalysisOptions, Closures, analyse
from kinefab.diagnostics import diagnostic_table
from kinefab.model import (
    RX,
    TX,
    Constraint,
    Coupling,
    CouplingKind,
    DofRecord,
    Feature,
    Joint,
    JointKind,
    Node,
    Scene,
    Term,
    freedoms_of,
)
from kinefab.model import ConstraintKind as C
from kinefab.model import FeatureKind as F
from kinefab.spatial import Pose
from mechanism_cases import scene

X, Y, Z = np.eye(3)
O = np.zeros(3)  # noqa: E741


def parts(*constraints, suppressed=False) -> Scene:
    nodes = [Node("base", "base", grounded=True), Node("part", "part", suppressed=suppressed)]
    return Scene(nodes=nodes, constraints=list(constraints))


def joining(id, kind, a, b, third=None, **more) -> Constraint:
    """a, b: (feature kind, point, direction) on the base and on the part."""
    features = [Feature(i, g[0], g[1], g[2] if len(g) > 2 else None) for i, g in enumerate((a, b))]
    return Constraint(id, kind, (*features, *(third or ())), **more)


def mate(id="mate", kind=C.COINCIDENT, normal=Z, **more) -> Constraint:
    return joining(id, kind, (F.PLANE, O, normal), (F.PLANE, O, normal), **more)


def ball() -> Joint:
    """None of whose turns is about an axis that stays."""
    return replace(tube(), id="ball", kind=JointKind.SPHERICAL, freedoms=freedoms_of(JointKind.SPHERICAL))


def tube() -> Joint:
    axes = np.column_stack([Z, X, Y])
    at = np.array([0.1, -0.2, 0.3])
    frame_b = scene("P03").nodes[1].pose.inverse() @ Pose(axes, at)
    return Joint(
        "tube", JointKind.CYLINDRICAL, 0, 1, Pose(axes, at), frame_b, freedoms_of(JointKind.CYLINDRICAL)
    )


def bolted_screw() -> Scene:
    """Bolted parts, and between them a rod whose slide follows its turn."""
    rod = Joint("rod", JointKind.CYLINDRICAL, 0, 1, Pose(), Pose(), freedoms_of(JointKind.CYLINDRICAL))
    pitch = Coupling("pitch", CouplingKind.SCREW, "rod", TX, (Term("rod", RX, 0.01),))
    bolts = joining("bolts", C.LOCK, (F.BODY, O), (F.BODY, O))
    return replace(parts(bolts), joints=[rod], couplings=[pitch])


def ungrounded(source: Scene) -> Scene:
    return replace(source, nodes=[replace(node, grounded=False) for node in source.nodes])


def listed(translations, rotations) -> Scene:
    """A part on the plane z = 0, whose freedoms the source lists so."""
    record = DofRecord(1, np.array(translations), np.array(rotations))
    return replace(parts(mate()), dof_records=[record])


def shifted(source: Scene) -> Scene:
    second = source.constraints[1]
    a, b = second.features
    moved = replace(second, features=(a, replace(b, point=b.point + [0.05, 0, 0])))
    return replace(source, constraints=[source.constraints[0], moved])


def uncertain() -> Scene:
    """Normals that differ a little and a little less: no gap says where constraining ends."""
    turns = ((X, Z), (Y, Z + 0.03 * X), (X, Z + 1e-3 * Y))
    square = [
        joining(f"square:{i}", C.PERPENDICULAR, (F.LINE, O, a), (F.LINE, O, np.cross(row, a)))
        for i, (a, row) in enumerate(turns)
    ]
    normals = (Z, Z + 1e-5 * X)
    flat = [joining(f"flat:{i}", C.COINCIDENT, (F.PLANE, O, n), (F.POINT, O)) for i, n in enumerate(normals)]
    return parts(*square, *flat)


def bounded(*others) -> Scene:
    return parts(*others, mate("bound", C.DISTANCE, lower=-0.1, upper=0.2))


BALL = joining("ball", C.COINCIDENT, (F.POINT, O), (F.POINT, O))
LINES = (F.LINE, O, Z), (F.LINE, O, Z)
SLIDE = joining("slide", C.SLIDER, *LINES)
SPIN = joining("spin", C.INSERT, (F.CIRCLE, O, Z), (F.CIRCLE, O, Z))
ANGLE_ALONE = Constraint(
    "angle",
    C.ANGLE,
    (Feature(0, F.LINE, O, X), Feature(1, F.LINE, O, 0.8 * X + 0.6 * Y), Feature(0, F.LINE, O, Z)),
    value=float(np.arctan2(0.6, 0.8)),
)
ON_PLANE = Constraint("on", C.COINCIDENT, (Feature(0, F.PLANE, O, X), Feature(1, F.POINT, 0.2 * Y)))
RECORD = DofRecord(1, np.array([X]), np.zeros((0, 3)))

CASES = {
    "CONSTRAINT_NOT_INTERPRETED": lambda: parts(joining("path", C.OTHER, (F.BODY, O), (F.BODY, O))),
    "CONSTRAINT_PAIRING_UNKNOWN": lambda: parts(joining("angle", C.ANGLE, (F.POINT, O), (F.POINT, O))),
    "CONSTRAINT_FEATURES_MISSING": lambda: parts(Constraint("half", C.COINCIDENT, (Feature(0, F.POINT, O),))),
    "CONSTRAINT_NODE_MISSING": lambda: parts(
        Constraint("far", C.LOCK, (Feature(0, F.BODY, O), Feature(9, F.BODY, O)))
    ),
    "CONSTRAINT_NOT_FINITE": lambda: parts(mate(value=float("inf"), kind=C.DISTANCE)),
    "CONSTRAINT_AXIS_ZERO": lambda: parts(mate(normal=O)),
    "CONSTRAINT_PART_SUPPRESSED": lambda: parts(mate(), suppressed=True),
    "CONSTRAINT_WITH_ITSELF": lambda: parts(
        Constraint("self", C.COINCIDENT, (Feature(1, F.POINT, O), Feature(1, F.POINT, X)))
    ),
    "CONSTRAINTS_CONTRADICT": lambda: shifted(scene("P09")),
    "CONSTRAINT_GAP": lambda: parts(mate(kind=C.DISTANCE, value=0.02)),
    "CONSTRAINTS_MANY": lambda: parts(*(mate(f"mate:{i}") for i in range(200))),
    "JOINT_CONSTRAINTS_DISAGREE": lambda: replace(scene("P03"), joints=[tube()]),
    "JOINT_SUPERSEDED": lambda: replace(scene("P03"), joints=[ball()]),
    "JOINT_REHUNG": lambda: scene("M27"),
    "JOINT_FOR_COUPLING": lambda: scene("M43"),
    "PAIR_RANK_UNCERTAIN": uncertain,
    "RELATION_BY_MIDDLE_BODY": lambda: scene("P30"),
    "RELATION_APPROXIMATED": lambda: parts(ANGLE_ALONE, ON_PLANE),
    "RELATION_DROPPED": lambda: Scene(
        nodes=[Node("base", "base", grounded=True), Node("a", "a"), Node("b", "b")],
        constraints=[
            Constraint(
                "mirror",
                C.SYMMETRY,
                (Feature(1, F.POINT, Z), Feature(2, F.POINT, -Z), Feature(0, F.PLANE, O, Z)),
            )
        ],
    ),
    "MECHANISM_SINGULAR": lambda: scene("M05"),
    "NOTHING_GROUNDED": lambda: ungrounded(scene("P03")),
    "NOTHING_MOVES": lambda: parts(SLIDE, SPIN),
    "ALL_FIXED": lambda: parts(joining("bolts", C.LOCK, (F.BODY, O), (F.BODY, O))),
    "CLOSURE_ROWS_FREED": lambda: scene("M01"),
    "CLOSURE_ROWS_REPEATED": lambda: scene("M12"),
    "CLOSURE_KEPT_WHOLE": lambda: scene("M24"),
    "DOF_RECORD_DIFFERS": lambda: replace(parts(mate()), dof_records=[RECORD]),
    "DOF_DIRECTION_DIFFERS": lambda: listed([X, Z], [Z]),
    "CONSTRAINT_RANGE_KEPT": lambda: bounded(SLIDE),
    "CONSTRAINT_RANGE_DROPPED": lambda: bounded(BALL),
    "CONSTRAINT_RANGE_EXCLUDED": lambda: bounded(SLIDE, mate("apart", C.DISTANCE, lower=0.3, upper=0.4)),
    "COUPLING_HELD": bolted_screw,
    "COUPLING_UNPLACED": lambda: parts(joining("gear", C.GEAR, *LINES, value=2.0)),
    "LIMITS_FOUND": lambda: scene("M03"),
    "LIMITS_NOT_SWEPT": lambda: scene("M05"),
}


def test_what_holds_everything_is_named():
    """A rail and a hinge of the same parts: either alone leaves one freedom; beside a lock the lock is what holds, and where
    no single statement does, that is told.  What still moves is not told of."""

    def told(*constraints: Constraint) -> list[str]:
        found = analyse(parts(*constraints)).report.diagnostics
        return [d.message for d in found if d.code in ("NOTHING_MOVES", "ALL_FIXED")]

    lock = joining("bolts", C.LOCK, (F.BODY, O), (F.BODY, O))
    (both,) = told(SLIDE, SPIN)
    assert "without any one of slide (slider), spin (insert) 1 freedom is left" in both
    (locked,) = told(SLIDE, lock)
    assert "without bolts (lock) 1 freedom is left" in locked
    (several,) = told(SLIDE, lock, SPIN)
    assert "more than one is too many" in several
    (fixed,) = told(lock)
    assert "(bolts)" in fixed
    assert told(SLIDE) == told(SPIN) == told() == []


def test_every_finding_of_the_analysis_has_a_case():
    """The codes that the analysis itself reports are the cases here; what the mapping to a target finds, which shares the
    stage, is named by the tests of the mapping (``test_codes.py``)."""
    room = Path(kinefab.analysis.__file__).parent
    named = set(re.findall(r'"([A-Z][A-Z0-9_]+)"', "".join(p.read_text("utf-8") for p in room.rglob("*.py"))))
    of_stage = {code for code, entry in diagnostic_table().items() if entry["stage"] == "analysis"}
    assert set(CASES) == of_stage & named


@pytest.mark.parametrize("code", CASES)
def test_finding_is_reported_with_its_message_filled_in(code):
    """The case gives its code, and the message names what it is about."""
    found = analyse(CASES[code](), AnalysisOptions(Closures.MINIMAL, limits=code.startswith("LIMITS")))
    mine = [d for d in found.report.diagnostics if d.code == code]
    assert mine and all("{" not in d.message + d.remedy for d in mine)
    errors = {d.code for d in found.report.diagnostics if d.severity == "error"}
    assert errors <= {code}


def test_nothing_grounded_is_told_once_and_only_then():
    """One warning for a whole scene that floats; none where a part stands or hangs on the world, or alone."""

    def told(source):
        return [d.code for d in analyse(source).report.diagnostics].count("NOTHING_GROUNDED")

    floating = ungrounded(scene("M27"))
    hung = Joint("hook", JointKind.SPHERICAL, None, 1, Pose(), Pose(), freedoms_of(JointKind.SPHERICAL))
    loose = Scene(nodes=[Node("a", "a"), Node("b", "b")])
    sources = (scene("M27"), floating, replace(floating, joints=[hung]), loose)
    assert [told(source) for source in sources] == [0, 1, 0, 0]


@pytest.mark.parametrize(
    "translations, rotations, differ",
    [
        ([X, Y], [Z], []),
        ([0.6 * X + 0.8 * Y, X], [-Z], []),
        ([X, Y], [Z + 0.005 * X], []),
        ([X, Y], [X], ["rotation axes", "90"]),
        ([X, Y + 0.1 * Z], [Z], ["translations", "5.71"]),
        ([X, X], [Z], ["translations", "90"]),
    ],
)
def test_stated_directions_are_compared_as_spans(translations, rotations, differ):
    """Any basis of the plane will do; an axis 0.29 degrees off is rounding, atan(0.1) = 5.71 degrees is not."""
    found = analyse(listed(translations, rotations)).report.diagnostics
    messages = [d.message for d in found if d.code == "DOF_DIRECTION_DIFFERS"]
    assert len(messages) == bool(differ)
    assert all(word in messages[0] for word in differ)
