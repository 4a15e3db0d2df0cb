"""Every kind of constraint and mate: its record closes at the captured pose, with the numbers of the description."""

from __future__ import annotations

import math

import numpy as np
import pytest
from cad.captures import capture
from cad.described import described
from cad.inventor import Inventor
from cad.solidworks import SolidWorks
from kinefab.capture.checking import residuals
from kinefab.diagnostics import Report

DOUBLES = {"inventor": Inventor, "solidworks": SolidWorks}
Z, X = [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]
P = [0.42, 0.13, -0.27]
TURN = [[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0], [0.0, 0.0, 1.0]]


def up(length: float, p=P) -> list[float]:
    return [p[0], p[1], p[2] + length]


def side(part: str, geometry: str, p=P, d=Z, r: float = 0.0) -> dict:
    found = {"component": f"M/{part}", "geometry": geometry, "in": "world", "p": list(p)}
    if geometry not in ("point", "sphere"):
        found["d"] = list(d)
    return found | ({"r": r} if r else {})


def machine(*constraints: dict, unit: str = "mm") -> dict:
    """A base, and an arm in a flexible sub-assembly, both turned and shifted; lengths are given in metres."""
    size = {"mm": 1000.0, "m": 1.0, "in": 1 / 0.0254, "cm": 100.0}[unit]

    def component(name: str, o, axes=np.eye(3), **more) -> dict:
        pose = {"o": (np.array(o) * size).tolist(), **dict(zip("xyz", np.array(axes).tolist()))}
        path = f"M/{name}" if name else "M"
        parent = {"parent": path.rpartition("/")[0]} if name else {}
        return (
            {"id": path, "kind": "part", "definition": path.rpartition("/")[2], "pose": pose} | parent | more
        )

    def scaled(c: dict) -> dict:
        found = dict(c)
        for key in "abc":
            if key in c:
                found[key] = {**c[key], "p": (np.array(c[key]["p"]) * size).tolist()}
                if "r" in c[key]:
                    found[key]["r"] = c[key]["r"] * size
        if c["kind"] not in ("angle", "gear", "linear"):
            found |= {k: c[k] * size for k in ("value", "min", "max") if k in c}
        return found

    meta = {
        "format": "kinefab.bundle",
        "version": "1.0",
        "units": {"length": unit, "angle": "rad"},
        "up": "Z",
    }
    return {
        "meta": meta,
        "components": [
            component("", [0, 0, 0], kind="assembly", flexible=True),
            component("Base", [0.1, 0.2, 0.3], grounded=True),
            component("Sub", [0.3, -0.2, 0.5], TURN, kind="assembly", flexible=True),
            component("Sub/Arm", [0.7, 0.1, -0.4], TURN),
            component("Sub/Pin", [0.2, 0.6, -0.1]),
        ],
        "constraints": [scaled({"id": f"C{i}", **c}) for i, c in enumerate(constraints)],
    }


def pair(kind: str, a: dict, b: dict, **more) -> dict:
    return {"kind": kind, "a": a, "b": b} | more


DIAGONAL = [math.cos(0.7), math.sin(0.7), 0.0]
BOTH = {
    "planes": pair("coincident", side("Base", "plane"), side("Sub/Arm", "plane", [0.9, 0.9, P[2]], [0.0, 0.0, -1.0]), sense="opposed"),
    "planes, aligned": pair("coincident", side("Base", "plane"), side("Sub/Arm", "plane", [0.9, 0.9, P[2]]), sense="aligned"),
    "planes apart": pair("distance", side("Base", "plane"), side("Sub/Arm", "plane", up(0.05), [0.0, 0.0, -1.0]), value=0.05, sense="opposed"),
    "point on plane": pair("coincident", side("Base", "plane"), side("Sub/Arm", "point", [0.9, 0.9, P[2]])),
    "points": pair("coincident", side("Base", "point"), side("Sub/Arm", "point")),
    "axes": pair("concentric", side("Base", "cylinder", r=0.02), side("Sub/Arm", "cylinder", up(0.3), r=0.02)),
    "lines apart": pair("distance", side("Base", "line"), side("Sub/Arm", "line", [P[0] + 0.08, *P[1:]]), value=0.08),
    "insert": pair("insert", side("Base", "circle", r=0.01), side("Sub/Arm", "circle", d=[0.0, 0.0, -1.0], r=0.01), sense="opposed"),
    "insert, aligned": pair("insert", side("Base", "circle", r=0.01), side("Sub/Arm", "circle", r=0.01), sense="aligned"),
    "angle": pair("angle", side("Base", "plane", d=X), side("Sub/Arm", "plane", d=DIAGONAL), value=0.7),
    "tangent": pair("tangent", side("Base", "plane"), side("Sub/Arm", "cylinder", up(0.03), X, r=0.03), side="outside"),
    "gear": pair("gear", side("Base", "cylinder", r=0.02), side("Sub/Arm", "cylinder", [0.6, 0.1, 0.0], r=0.05), value=-0.4),
    "rack": pair("rack", side("Base", "cylinder", r=0.02), side("Sub/Arm", "line", d=X), value=0.025),
    "linear": pair("linear", side("Base", "line"), side("Sub/Arm", "line", d=X), value=2.5),
    "symmetry": pair("symmetry", side("Sub/Pin", "plane", [0.5, 0, 0], X), side("Sub/Arm", "plane", [0.1, 0, 0], [-1.0, 0.0, 0.0]), c=side("Base", "plane", [0.3, 0, 0], X)),
    "distance in a range": pair("distance", side("Base", "plane"), side("Sub/Arm", "plane", up(0.05)), min=-0.01, max=0.08, sense="aligned"),
}  # fmt: skip
SOLIDWORKS = {
    "parallel": pair("parallel", side("Base", "line"), side("Sub/Arm", "line", d=[0.0, 0.0, -1.0])),
    "perpendicular": pair("perpendicular", side("Base", "line"), side("Sub/Arm", "line", d=X)),
    "lock": pair("lock", side("Base", "point"), side("Sub/Arm", "point", [0.9, 0.9, 0.1])),
    "screw": pair("screw", side("Base", "cylinder", r=0.01), side("Sub/Arm", "cylinder", up(0.1), r=0.01), value=0.002),
    "screw, left": pair("screw", side("Base", "cylinder", r=0.01), side("Sub/Arm", "cylinder", up(0.1), r=0.01), value=-0.002),
    "universal": pair("universal", side("Base", "line"), side("Sub/Arm", "line", d=[0.0, 0.6, 0.8])),
    "width": pair("symmetry", side("Sub/Pin", "plane", [0.5, 0, 0], X), side("Sub/Arm", "plane", [0.1, 0, 0], [-1.0, 0.0, 0.0]), c=side("Base", "plane", [0.3, 0, 0], X), solidworks="width"),
    "profile centre": pair("insert", side("Base", "circle", r=0.01), side("Sub/Arm", "circle", up(0.04), r=0.01), value=0.04, solidworks="profile"),
    "rotation locked": pair("concentric", side("Base", "cylinder", r=0.02), side("Sub/Arm", "cylinder", up(0.3), r=0.02), lockRotation=True),
    "rack by travel": pair("rack", side("Base", "cylinder", r=0.02), side("Sub/Arm", "line", d=X), value=-0.025, diameterType=1),
}  # fmt: skip
CASES = [(p, n, c) for p in DOUBLES for n, c in BOTH.items()] + [
    ("solidworks", n, c) for n, c in SOLIDWORKS.items()
]


def one(program: str, c: dict, folder, unit: str = "mm"):
    report = Report()
    found = capture(program, DOUBLES[program](described(machine(c, unit=unit))).record(), folder, "Z", report)
    codes = [entry.code for entry in report.diagnostics if entry.code != "CAPTURE_MEMBER_FAILED"]
    return found, codes


@pytest.mark.parametrize(("program", "name", "c"), CASES, ids=[f"{p}: {n}" for p, n, _ in CASES])
def test_a_kind_closes_with_the_numbers_of_the_description(program, name, c, tmp_path):
    found, codes = one(program, c, tmp_path)
    assert codes == []
    (made,) = found.draft.constraints
    unit = 100.0 if program == "inventor" else 1.0
    expected = "symmetry" if name == "width" else c["kind"]
    alike = {"coincident", "distance", "concentric"}
    assert made["kind"] == expected or {made["kind"], expected} <= alike
    length = 1.0 if c["kind"] in ("angle", "gear", "linear") else unit
    for key in ("value", "min", "max"):
        assert abs(made.get(key, 0.0)) == pytest.approx(abs(c.get(key, 0.0)) * length)
    if c["kind"] in ("gear", "rack", "linear", "screw"):
        assert made["value"] == pytest.approx(c["value"] * length)
    assert residuals(found.draft, constraints=found.draft.constraints)["C0"] < 1e-9


@pytest.mark.parametrize("unit", ["mm", "in", "cm", "m"])
@pytest.mark.parametrize("program", DOUBLES)
def test_the_document_s_unit_does_not_matter(program, unit, tmp_path):
    found, codes = one(program, BOTH["planes apart"], tmp_path, unit)
    assert codes == []
    assert found.draft.constraints[0]["value"] == pytest.approx(5.0 if program == "inventor" else 0.05)


@pytest.mark.parametrize(
    ("solution", "c", "value"),
    [
        (78594, BOTH["angle"], 0.7),
        (78593, BOTH["angle"], 0.7),
        (78595, {**BOTH["angle"], "c": side("Base", "line")}, 0.7),
        (78595, {**BOTH["angle"], "c": side("Base", "line", d=[0.0, 0.0, -1.0]), "value": -0.7}, -0.7),
    ],
    ids=["undirected", "directed", "reference vector", "reference vector, from below"],
)
def test_the_three_solutions_of_an_angle(solution, c, value, tmp_path):
    found, codes = one("inventor", c | {"solution": solution}, tmp_path)
    made = found.draft.constraints[0]
    assert codes == [] and made["value"] == pytest.approx(value)
    assert made.get("reading", {}).get("angle") == (None if solution == 78594 else "directed")
    assert ("c" in made) == (solution == 78595)


def test_a_wrong_angle_about_its_reference_is_told(tmp_path):
    c = {**BOTH["angle"], "c": side("Base", "line"), "value": 0.9, "solution": 78595}
    assert one("inventor", c, tmp_path)[1] == ["CAPTURE_NOT_CLOSED"]


@pytest.mark.parametrize(("more", "kept"), [({"min": -0.01, "max": 0.08}, {"min", "max"}), ({"max": 0.08, "offMin": 0.06}, {"max"}),
                                            ({"offMin": 0.06, "offMax": 0.08, "value": 0.05}, set())], ids=["both", "one", "none"])  # fmt: skip
def test_limits_count_with_their_flags(more, kept, tmp_path):
    base = {k: v for k, v in BOTH["distance in a range"].items() if k not in ("min", "max")}
    c = base | {k: v if k.startswith("off") else v for k, v in more.items()}
    found, codes = one("inventor", c | {"inventor": "flush"}, tmp_path)
    made = found.draft.constraints[0]
    assert codes == [] and made.keys() & {"min", "max"} == kept
    assert ("value" in made) == (not kept)


@pytest.mark.parametrize("geometry", ["cylinder", "sphere"])
def test_inferred_types_of_inventor(geometry, tmp_path):
    """A cylinder of which its line was inferred is its axis, a sphere its centre; without inference the face itself."""
    a, b = side("Base", geometry, r=0.02), side("Sub/Arm", geometry, r=0.02)
    inferred, _ = one("inventor", pair("coincident", a, b), tmp_path)
    assert inferred.draft.constraints[0]["a"]["geometry"] == {"cylinder": "line", "sphere": "point"}[geometry]
    itself, _ = one("inventor", pair("coincident", a, b, inferred=24833), tmp_path)
    assert itself.draft.constraints[0]["a"]["geometry"] == geometry


@pytest.mark.parametrize("gap", [0.0, 0.004])
def test_a_tangency_at_a_distance(gap, tmp_path):
    c = pair(
        "tangent",
        side("Base", "plane"),
        side("Sub/Arm", "cylinder", up(0.03 + gap), X, r=0.03),
        value=gap,
        side="outside",
    )
    found, codes = one("inventor", c, tmp_path)
    assert codes == []
    assert found.draft.constraints[0]["b"]["r"] == pytest.approx((0.03 + gap) * 100.0)


@pytest.mark.parametrize("word", ["path", "slot", "cam"])
def test_mates_without_equations_are_kept_raw(word, tmp_path):
    found, codes = one("solidworks", {**BOTH["points"], "solidworks": word}, tmp_path)
    assert codes == ["CAPTURE_KIND_RAW"] and found.draft.constraints[0]["kind"] == "other"


def test_a_hinge_with_limits_is_a_joint(tmp_path):
    across = {"a": np.array(X), "b": np.array(DIAGONAL)}
    c = BOTH["insert, aligned"] | {"min": -0.2, "max": 1.4, "across": across}
    assembly = machine()
    assembly["constraints"] = []
    base = described(assembly)
    for key in "ab":
        c = {**c, key: {**c[key], "p": np.array(c[key]["p"]), "d": np.array(c[key]["d"])}}
    base.constraints = [{"id": "Hinge", **c}]
    report = Report()
    found = capture("solidworks", SolidWorks(base).record(), tmp_path, "Z", report)
    (joint,) = found.draft.joints
    assert joint["type"] == "revolute" and report.diagnostics == []
    assert (joint["dof"][0]["min"], joint["dof"][0]["max"]) == (-0.2, 1.4)


@pytest.mark.parametrize("program", DOUBLES)
def test_a_mate_of_a_flexible_sub_assembly_is_in_its_frame(program, tmp_path):
    inner = pair(
        "insert",
        side("Sub/Arm", "circle", r=0.01),
        side("Sub/Pin", "circle", d=[0.0, 0.0, -1.0], r=0.01),
        sense="opposed",
    )
    assembly = machine(inner)
    found = capture(program, DOUBLES[program](described(assembly)).record(), tmp_path, "Z")
    (made,) = found.draft.constraints
    assert {made["a"]["component"], made["b"]["component"]} == {"M/Sub/Arm", "M/Sub/Pin"}
    assert made["a"]["in"] == "M/Sub"
    assert residuals(found.draft, constraints=[made])[made["id"]] < 1e-9
    local = np.array(TURN) @ (np.array(P) - [0.3, -0.2, 0.5])
    assert made["a"]["p"] == pytest.approx((local * (100.0 if program == "inventor" else 1.0)).tolist())


@pytest.mark.parametrize("program", DOUBLES)
def test_mirrored_and_patterned_parts_are_kept(program, tmp_path):
    assembly = machine(BOTH["points"])
    mirrored = {
        **assembly["components"][3],
        "id": "M/Sub/Twin",
        "pose": dict(assembly["components"][3]["pose"]),
    }
    mirrored["pose"]["x"] = [-v for v in mirrored["pose"]["x"]]
    assembly["components"].append(mirrored)
    found = capture(program, DOUBLES[program](described(assembly)).record(), tmp_path, "Z")
    twin = next(c for c in found.draft.components if c["id"] == "M/Sub/Twin")
    axes = np.array([twin["pose"][k] for k in "xyz"])
    assert np.linalg.det(axes) == pytest.approx(-1.0)
    assert (
        twin["definition"] == next(c for c in found.draft.components if c["id"] == "M/Sub/Arm")["definition"]
    )


@pytest.mark.parametrize("program", DOUBLES)
def test_suppressed_ones_are_kept_as_such(program, tmp_path):
    assembly = machine(BOTH["points"], {**BOTH["axes"], "suppressed": True})
    assembly["components"][-1]["suppressed"] = True
    found = capture(program, DOUBLES[program](described(assembly)).record(), tmp_path, "Z")
    assert [c.get("suppressed", False) for c in found.draft.constraints] == [False, True]
    assert next(c for c in found.draft.components if c["id"] == "M/Sub/Pin")["suppressed"] is True


@pytest.mark.parametrize("program", DOUBLES)
@pytest.mark.parametrize("fixed", [False, True])
@pytest.mark.parametrize("flexible", [False, True])
def test_what_is_grounded_in_a_sub_assembly_stands_still_only_where_that_does(
    program, fixed: bool, flexible: bool, tmp_path
):
    """Both programs ground the first part of every assembly in it; it moves with the assembly all the same, and so do the
    assembly's own planes, to which other parts of it are mated."""
    plane = {**side("Sub", "plane"), "component": "M/Sub"}
    assembly = machine(pair("coincident", plane, side("Sub/Arm", "point", [0.9, 0.9, P[2]])))
    one = assembly["components"][4]
    assembly["components"] += [
        {**one, "id": f"M/Sub/{name}", "grounded": True} for name in ("First", "Second")
    ]
    assembly["components"][2] |= {"flexible": flexible, "grounded": fixed}
    if program == "inventor":
        frame = {"in": "world", "o": P, "z": Z, "x": X}
        swing = {"id": "Swing", "type": "revolute", "a": "M/Sub", "b": "M/Sub/Pin", "owner": "M/Sub"}
        assembly["joints"] = [swing | {"frameA": frame, "frameB": frame}]
    found = capture(program, DOUBLES[program](described(assembly)).record(), tmp_path, "Z")
    grounded = {c["id"].partition("/")[2] for c in found.draft.components if c.get("grounded")}
    inside = {"Sub/First", "Sub/Second"} if flexible or program == "inventor" else set()
    assert grounded == {"Base"} | ({"Sub"} | inside if fixed else set())
    tied = [(j["type"], j["a"], j["b"]) for j in found.draft.joints]
    loose = flexible and not fixed
    itself = "M/Sub/First" if loose else "ground"
    swings = [("revolute", itself, "M/Sub/Pin")] if flexible and program == "inventor" else []
    assert tied == ([("rigid", "M/Sub/First", "M/Sub/Second")] if loose else []) + swings
    if flexible:
        (made,) = found.draft.constraints
        assert (made["a"]["component"], made["a"]["in"]) == (itself, "M/Sub")
        assert residuals(found.draft, constraints=[made])[made["id"]] < 1e-9
