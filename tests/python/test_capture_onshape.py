"""Onshape's capture against answers as its API documents them: by record, by folder, over HTTP."""

from __future__ import annotations

import copy
import json
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from urllib.error import HTTPError
from urllib.parse import parse_qs, urlsplit

import numpy as np
import pytest
from cad.captures import capture, scene_differences
from cad.described import described, mechanism
from cad.documented import of_onshape
from cad.gears import gear_pair, held_by_the_world
from cad.gltf import exported
from cad.onshape import answers, boxed
from cad.tetrahedron import FACES, POINTS
from command_line import run
from kinefab.capture.channel import MemberFailed
from kinefab.capture.onshape.answers import Rest
from kinefab.capture.onshape.mates import quantity
from kinefab.capture.onshape.parts import stl
from kinefab.capture.run import capture_onshape
from kinefab.diagnostics import KinefabError, Report

DOCUMENT = f"/documents/{'d' * 24}/w/{'a' * 24}/e/e"


def only_joints(name: str) -> dict:
    """Onshape has mates with coordinate systems only: its scene is that of the bundle's joints."""
    values = gear_pair() if name == "gears" else mechanism(name)
    values.pop("constraints", None)
    values.pop("dof", None)
    for joint in values["joints"]:
        joint.pop("because", None)
    for c in values["components"]:
        if c["kind"] == "assembly":
            c["flexible"] = True
    return values


def rigid_crank(values: dict) -> dict:
    """Of the lever: its crank's parts are held together by fastened mates, as an Onshape user has to."""
    parts = [c["id"] for c in values["components"] if c.get("parent") == "Lever/Crank:1"]
    at = {"in": "world", "o": [0.0, 0.0, 0.0], "z": [0.0, 0.0, 1.0], "x": [1.0, 0.0, 0.0]}
    for joint in values["joints"]:
        for end in "ab":
            if joint[end] == "Lever/Crank:1":
                joint[end] = parts[0]
    values["joints"] += [
        {
            "id": f"Held {p}",
            "name": f"Held {p}",
            "type": "rigid",
            "a": parts[0],
            "b": p,
            "frameA": at,
            "frameB": at,
        }
        for p in parts[1:]
    ]
    return values


@pytest.mark.parametrize("unit", ["mm", "in"])
@pytest.mark.parametrize("name", ["lever/lever.bundle.json", "gears"])
def test_mates_give_the_scene_of_the_joints(name, unit, tmp_path):
    values = only_joints(name)
    values = rigid_crank(values) if "lever" in name else values
    found = capture("onshape", answers(described(values), unit), tmp_path, values["meta"]["up"])
    assert scene_differences(values, found.path, tmp_path) == []
    assert found.draft.report.diagnostics == []


@pytest.mark.parametrize("opposed", [False, True])
def test_a_gear_on_a_mate_whose_first_side_is_the_world_turns_as_there(opposed, tmp_path):
    """The mate's sides change places and its angle its sign, which the relation's ratio goes with."""
    scene, stated = held_by_the_world(opposed)
    found = capture("onshape", answers(described(stated)), tmp_path, "Y")
    assert scene_differences(scene, found.path, tmp_path) == []
    assert found.draft.report.diagnostics == []


def test_saved_answers_are_a_source(tmp_path):
    values = only_joints("gears")
    for word, answer in answers(described(values)).items():
        (tmp_path / f"{word}.json").write_text(json.dumps(answer), "utf-8")
    found = capture_onshape(str(tmp_path), {}, tmp_path / "x.bundle.json", Report(), up=values["meta"]["up"])
    assert scene_differences(values, found.path, tmp_path) == []


class Server:
    """Onshape on 127.0.0.1: what it is asked and what it answers."""

    def __init__(self, answers: dict, first: int = 0) -> None:
        self.asked: list[tuple[str, str]] = []
        outer = self

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                outer.asked.append((self.path, self.headers.get("Authorization", "")))
                if first and len(outer.asked) == 1:
                    self.send_response(first)
                    self.send_header("Retry-After", "3")
                    self.end_headers()
                    return
                word = self.path.partition("?")[0].rpartition("/")[2]
                word = {"e": "definition", "elements": "name"}.get(word, word)
                if word == "gltf":
                    body = exported(POINTS, FACES, [None] * len(FACES))
                elif word in answers:
                    body = json.dumps(answers[word]).encode()
                else:
                    self.send_error(404)
                    return
                self.send_response(200)
                self.end_headers()
                self.wfile.write(body)

            def log_message(self, *arguments: object) -> None:
                pass

        self.http = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        threading.Thread(target=self.http.serve_forever, daemon=True).start()
        self.address = f"http://127.0.0.1:{self.http.server_port}{DOCUMENT}"

    def __enter__(self) -> Server:
        return self

    def __exit__(self, *why: object) -> None:
        self.http.shutdown()
        self.http.server_close()


KEYS = {"ONSHAPE_ACCESS_KEY": "on-access", "ONSHAPE_SECRET_KEY": "on-secret"}


def test_over_http_with_keys_and_a_record_without_them(tmp_path):
    values = only_joints("gears")
    record = tmp_path / "x.record.json"
    with Server(answers(described(values)) | {"boundingboxes": boxed(POINTS)}) as server:
        found = capture_onshape(
            server.address, KEYS, tmp_path / "x.bundle.json", Report(), record, up=values["meta"]["up"]
        )
    assert found.calls == len(server.asked)
    assert all(login.startswith("Basic ") for _, login in server.asked)
    parts = {c["definition"] for c in found.draft.components if c["kind"] == "part"}
    # definition, name, features, matevalues; mesh and mass of each part, which is not known, so its box; looks of each studio
    assert found.calls == 4 + 4 * len(parts)
    assert len(found.files) == 1 + len(parts)
    assert "on-secret" not in record.read_text("utf-8") and "Basic" not in record.read_text("utf-8")
    again = run("capture", "--replay", record, "-o", tmp_path / "y.bundle.json", "--up", values["meta"]["up"])
    assert again.returncode == 0, again.stderr
    one, two = (json.loads((tmp_path / f"{n}.bundle.json").read_text("utf-8")) for n in "xy")
    assert one["joints"] == two["joints"]


def test_an_answer_that_refuses_leaves_no_connection():
    where = {"did": "d", "wvm": "w", "wid": "a", "eid": "e"}
    with Server({}) as server, pytest.raises(MemberFailed, match="404") as refused:
        Rest(server.address.partition("/documents")[0], where, ("a", "b")).fetch("features")
    assert isinstance(refused.value.__cause__, HTTPError) and refused.value.__cause__.closed


def test_a_server_that_asks_to_wait_is_waited_for(tmp_path, monkeypatch):
    slept: list[float] = []
    monkeypatch.setattr("time.sleep", slept.append)
    with Server({"features": {"features": []}}, first=429) as server:
        base = server.address.partition("/documents")[0]
        where = {"did": "d", "wvm": "w", "wid": "a", "eid": "e"}
        assert Rest(base, where, ("a", "b"), slept.append).fetch("features") == {"features": []}
    assert slept == [3.0]


@pytest.mark.parametrize(
    ("source", "environment", "code"),
    [
        ("https://cad.onshape.com/documents/only", KEYS, "CAPTURE_ADDRESS"),
        (f"https://cad.onshape.com{DOCUMENT}", {}, "CAPTURE_KEYS"),
        ("no such folder", {}, "SOURCE_NOT_FOUND"),
    ],
)
def test_what_is_in_the_way_is_a_sentence(source, environment, code, tmp_path):
    report = Report()
    with pytest.raises(KinefabError):
        capture_onshape(source, environment, tmp_path / "x.bundle.json", report)
    assert [entry.code for entry in report.diagnostics] == [code]


def test_a_refusal_is_a_sentence_and_says_no_key(tmp_path):
    with Server({}) as server:
        done = run("capture", "onshape", server.address, "-o", tmp_path / "x.bundle.json", **KEYS)
    assert done.returncode == 1 and "CAPTURE_STOPPED" in done.stderr and "404" in done.stderr
    assert "on-secret" not in done.stderr and "Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("45 deg", 0.7853981633974483),
        ("-10*mm", -0.01),
        ("2.5 in", 0.0635),
        ("1e-3 m", 0.001),
        (".5 rad", 0.5),
    ],
)
def test_expressions_have_units(expression, expected):
    assert quantity(expression) == pytest.approx(expected)


@pytest.mark.parametrize("expression", ["#stroke", "2 * 3 mm", "5 furlong", ""])
def test_a_formula_is_told_not_guessed(expression):
    if expression:
        with pytest.raises(ValueError, match="no number"):
            quantity(expression)
    else:
        with pytest.raises(ValueError):
            quantity(expression)


def test_a_mesh_that_is_none():
    with pytest.raises(ValueError):
        stl(b"solid ascii")


def test_a_part_of_a_linked_document_is_asked_by_its_version_through_the_document(tmp_path):
    """``linkDocumentId`` is documented with a version in the path alone; a version of the own document needs none."""
    values = only_joints("gears")
    known = answers(described(values))
    other, own, plain = known["definition"]["rootAssembly"]["instances"][:3]
    other |= {"documentId": "x" * 24, "documentVersion": "v" * 24, "isStandardContent": True}
    own["documentVersion"] = "u" * 24
    with Server(known) as server:
        capture_onshape(server.address, KEYS, tmp_path / "x.bundle.json", Report(), up=values["meta"]["up"])
    asked = [urlsplit(path) for path, _ in server.asked]

    def of(instance: dict) -> dict[str, dict[str, list[str]]]:
        """The queries of an instance's questions, by the rest of the path."""
        return {
            url.path: parse_qs(url.query)
            for url in asked
            if f"/e/{instance['elementId']}" in url.path and url.path.startswith("/api/parts/")
        }

    studio = f"/api/parts/d/{'x' * 24}/v/{'v' * 24}/e/{other['elementId']}"
    queries = of(other)
    assert set(queries) == {
        studio,
        *(f"{studio}/partid/JHD/{w}" for w in ("gltf", "massproperties", "boundingboxes")),
    }
    assert all(query["linkDocumentId"] == ["d" * 24] for query in queries.values())
    assert queries[f"{studio}/partid/JHD/massproperties"]["inferMetadataOwner"] == ["true"]
    for instance, state in ((own, f"v/{'u' * 24}"), (plain, f"m/{'m' * 24}")):
        queries = of(instance)
        assert len(queries) == 4 and all(f"/d/{'d' * 24}/{state}/e/" in path for path in queries)
        assert not any(query.keys() & {"linkDocumentId", "inferMetadataOwner"} for query in queries.values())


def nested(held: dict) -> dict:
    """The answers on an assembly with the given one inside it: its mates are stated in its own features."""
    top = held["definition"]["rootAssembly"]
    key = {
        "documentId": "d" * 24,
        "documentMicroversion": "m" * 24,
        "elementId": "ESub",
        "configuration": "default",
    }
    sub = of_onshape("Assembly", **{k: top[k] for k in ("instances", "features", "patterns")}, **key)
    instance = of_onshape("Instance", id="S", name="Sub", type="Assembly", suppressed=False, **key)
    placed = [
        of_onshape("Occurrence", path=["S"], transform=np.eye(4).ravel().tolist(), fixed=False, hidden=False)
    ]
    placed += [{**o, "path": ["S", *o["path"]]} for o in top["occurrences"]]
    root = of_onshape("Assembly", instances=[instance], occurrences=placed, features=[], patterns=[])
    return {
        **held, "features": of_onshape("Features", features=[]), "matevalues": of_onshape("MateValues", mateValues=[]),
        "definition": of_onshape("Definition", rootAssembly=root, subAssemblies=[sub], parts=[]),
        f"limits {'d' * 24} {'m' * 24} ESub - default": held["features"],
    }  # fmt: skip


def fixed_inside(still: bool) -> dict:
    """An assembly inside that stands off the root's origin: two of its parts are fixed in it, a third turns on its origin."""
    key = {
        "documentId": "d" * 24,
        "documentMicroversion": "m" * 24,
        "elementId": "ESub",
        "configuration": "default",
    }
    parts = [
        of_onshape(
            "Instance", id=i, name=i, type="Part", suppressed=False, partId=i, **{**key, "elementId": "EP"}
        )
        for i in ("A", "B", "C")
    ]
    sub_at, part_at = np.eye(4), np.eye(4)
    sub_at[:3, :3] = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    sub_at[:3, 3], part_at[:3, 3] = [0.31, 0.07, -0.13], [0.02, 0.05, 0.11]
    occurrences = [
        of_onshape("Occurrence", path=p, transform=t.ravel().tolist(), fixed=f, hidden=False)
        for p, t, f in (
            (["S"], sub_at, still), (["S", "A"], sub_at @ part_at, True), (["S", "B"], sub_at, True),
            (["S", "C"], sub_at, False),
        )
    ]  # fmt: skip
    cs = of_onshape(
        "MatedCS",
        origin=[0.17, 0.0, 0.03],
        xAxis=[0.0, 1.0, 0.0],
        yAxis=[0.0, 0.0, 1.0],
        zAxis=[1.0, 0.0, 0.0],
    )
    sides = [of_onshape("MatedEntity", matedOccurrence=p, matedCS=cs) for p in (["C"], [])]
    turn = {"name": "Turn", "mateType": "REVOLUTE", "matedEntities": sides}
    mate = of_onshape("Feature", id="M", featureType="mate", suppressed=False, featureData=turn)
    sub = of_onshape("Assembly", instances=parts, features=[mate], patterns=[], **key)
    instance = of_onshape("Instance", id="S", name="Sub", type="Assembly", suppressed=False, **key)
    root = of_onshape("Assembly", instances=[instance], occurrences=occurrences, features=[], patterns=[])
    return {
        "definition": of_onshape("Definition", rootAssembly=root, subAssemblies=[sub], parts=[]),
        "features": of_onshape("Features", features=[]),
        "matevalues": of_onshape("MateValues", mateValues=[]),
        f"limits {'d' * 24} {'m' * 24} ESub - default": of_onshape("Features", features=[]),
    }


@pytest.mark.parametrize("still", [False, True])
def test_what_is_fixed_in_an_assembly_inside_stands_still_only_with_it(still, tmp_path):
    draft = capture("onshape", fixed_inside(still), tmp_path, "Z").draft
    sub, a, b, _ = [c["id"] for c in draft.components[1:]]
    assert {c["id"] for c in draft.components if c.get("grounded")} == ({sub, a, b} if still else set())
    ties = [(j["a"], j["b"]) for j in draft.joints if j["type"] == "rigid"]
    assert ties == ([] if still else [(a, b)])
    (turn,) = [j for j in draft.joints if j["type"] == "revolute"]
    assert turn["a"] == ("ground" if still else a)
    assert turn["frameA"]["in"] == sub and turn["frameA"]["o"] == [0.17, 0.0, 0.03]
    assert not [d for d in draft.report.diagnostics if "Turn" in str(d)]


def test_a_mate_of_an_assembly_inside_itself_is_on_what_is_fixed_in_it(tmp_path):
    """Its origin moves with the parts that are fixed to it; its frame is stated in its own axes."""
    held = fixed_inside(still=False)
    root = held["definition"]["rootAssembly"]
    mate = copy.deepcopy(held["definition"]["subAssemblies"][0]["features"][0])
    lift = {**mate["featureData"], "name": "Lift", "mateType": "SLIDER"}
    lift["matedEntities"] = copy.deepcopy(lift["matedEntities"])
    lift["matedEntities"][0]["matedOccurrence"] = ["S"]
    lift["matedEntities"][1]["matedCS"] = lift["matedEntities"][0]["matedCS"] | {
        "origin": [0.31, 0.24, -0.10], "xAxis": [-1.0, 0.0, 0.0], "yAxis": [0.0, 0.0, 1.0], "zAxis": [0.0, 1.0, 0.0],
    }  # fmt: skip
    group = {"name": "All", "occurrences": [{"occurrence": path} for path in (["S"], ["S", "A"], ["S", "C"])]}
    root["features"] = [
        of_onshape("Feature", id="L", featureType="mate", suppressed=False, featureData=lift),
        of_onshape("Feature", id="G", featureType="mateGroup", suppressed=False, featureData=group),
    ]
    draft = capture("onshape", held, tmp_path, "Z").draft
    sub, a, b, c = [c["id"] for c in draft.components[1:]]
    (slide,) = [j for j in draft.joints if j["type"] == "slider"]
    assert (slide["a"], slide["b"]) == ("ground", a)
    assert (slide["frameA"]["in"], slide["frameB"]["in"]) == ("world", sub)
    assert [(j["a"], j["b"]) for j in draft.joints if j["type"] == "rigid"] == [(a, b), (a, c)]
    assert not [d for d in draft.report.diagnostics if "Lift" in str(d)]


def test_an_assembly_inside_that_is_not_listed_is_told(tmp_path):
    """Its parts stand among the occurrences alone; no mate names them, so that nothing else would tell of them."""
    held, report = fixed_inside(still=False), Report()
    held["definition"]["subAssemblies"][0]["configuration"] = "another"
    draft = capture("onshape", held, tmp_path, "Z", report).draft
    assert [c["name"] for c in draft.components[1:]] == ["Sub"]
    (told,) = report.diagnostics
    assert told.code == "CAPTURE_MEMBER_FAILED"
    assert draft.components[1]["id"] in told.message and "subAssemblies" in told.message


def limited() -> dict:
    values = only_joints("gears")
    values["joints"][0]["dof"] = [{"name": "rz", "value": 0.0, "min": -0.5, "minEnabled": True}]
    return values


def test_mates_of_an_assembly_inside_have_their_limits(tmp_path):
    held = answers(described(limited()))
    flat = capture("onshape", held, tmp_path, "Z").draft
    found = capture("onshape", nested(held), tmp_path, "Z")
    assert [j["id"] for j in found.draft.joints] == [
        f"{flat.components[0]['id']}/Sub/{j['id']}" for j in flat.joints
    ]
    (dof,) = found.draft.joints[0]["dof"]
    assert (dof["min"], dof["minEnabled"]) == (pytest.approx(-0.5), True) and "max" not in dof
    assert found.draft.report.diagnostics == []
    without, report = nested(held), Report()
    del without[f"limits {'d' * 24} {'m' * 24} ESub - default"]
    capture("onshape", without, tmp_path, "Z", report)
    assert [d.code for d in report.diagnostics] == ["CAPTURE_MEMBER_FAILED"]


def test_a_limit_that_the_configuration_chooses_is_told(tmp_path):
    held, report = answers(described(limited())), Report()
    for feature in held["features"]["features"]:
        for parameter in feature["message"]["parameters"]:
            if parameter["message"]["parameterId"] == "limitAxialZMin":
                parameter["message"].pop("expression")
    capture("onshape", held, tmp_path, "Z", report)
    told = [d for d in report.diagnostics if "configuration chooses" in d.message]
    assert told and {d.code for d in told} == {"CAPTURE_MEMBER_FAILED"}, [str(d) for d in report.diagnostics]


@pytest.mark.parametrize(("chosen", "told"), [("default", None), ("List_a=Long;Width=0.2+meter", "List_a=Long;Width=0.2+meter")])
def test_a_configuration_other_than_the_usual_one_is_named(tmp_path, chosen, told):
    held = answers(described(limited()))
    held["definition"]["rootAssembly"]["configuration"] = chosen
    found = capture("onshape", held, tmp_path, "Z")
    assert json.loads(found.path.read_text("utf-8"))["meta"].get("configuration") == told


def test_a_range_of_a_ball_is_told(tmp_path):
    values = limited()
    values["joints"][0] |= {"type": "ball", "dof": []}
    values.pop("couplings")
    held, report = answers(described(values)), Report()
    listed = [
        {"parameterId": "limitsEnabled", "value": True},
        {"parameterId": "limitEulerConeAngleMax", "expression": "20 deg"},
    ]
    held["features"]["features"][0]["message"]["parameters"] = [
        of_onshape("ListedParameter", message=of_onshape("Parameter", **entry)) for entry in listed
    ]
    capture("onshape", held, tmp_path, "Z", report)
    assert ["range of a ball" in d.message for d in report.diagnostics] == [True]


def test_instances_of_a_pattern_may_be_named_by_paths(tmp_path):
    values = only_joints("gears")
    held = answers(described(values))
    top = held["definition"]["rootAssembly"]
    one, two = (entry["id"] for entry in top["instances"][:2])
    ties = {one: [[two]]}
    top["patterns"] = [
        of_onshape("Pattern", id="P", name="Row", suppressed=False, seedToPatternInstances=ties)
    ]
    found = capture("onshape", held, tmp_path, "Z")
    assert [j["id"] for j in found.draft.joints if j["type"] == "rigid"] and not [
        d for d in found.draft.report.diagnostics if d.code == "CAPTURE_MEMBER_FAILED"
    ]
