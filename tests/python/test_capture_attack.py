"""What goes wrong while a capture runs: broken records, a server that fails in every way, keys that stay where they belong."""

from __future__ import annotations

import json
import threading
import time
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import pytest
from cad.described import described, mechanism
from cad.documented import untagged
from cad.fusion import Fusion
from cad.gltf import exported
from cad.inventor import Inventor
from cad.mutations import mutated
from cad.onshape import answers, boxes, masses, of_each_part, stl
from cad.solidworks import SolidWorks
from cad.tetrahedron import FACES, POINTS, fusion_bodies, inventor_bodies, solidworks_bodies
from kinefab.capture.channel import MemberFailed, record
from kinefab.capture.onshape.answers import Rest, may_have_keys
from kinefab.capture.run import capture_onshape, replay
from kinefab.diagnostics import KinefabError, Report
from test_capture_kinds import BOTH, SOLIDWORKS, machine
from test_capture_matter import LOOK
from test_capture_onshape import only_joints
from test_capture_rigid_bodies import GROUPS, JOINTS

PROGRAMS = ("inventor", "solidworks", "fusion", "onshape")
SEEDS = 60
"""Broken records of each program that the tests try; thousands were tried by hand."""


def records(program: str):
    """A record of everything at once: mates or joints, meshes, masses, looks, a pattern, rigid bodies."""
    values = mechanism("lever/lever.bundle.json") if program == "inventor" else only_joints("gears")
    if program == "solidworks":
        values = machine(*BOTH.values(), *SOLIDWORKS.values())
    parts = [c for c in values["components"] if c["kind"] == "part"]
    for c in parts:
        c["mass"] = {"mass": 2.5, "center": [0.1, 0.2, 0.3], "inertia": [3.1, 5.2, 6.0, 0.4, 0.7, -0.2]}
        c["look"] = LOOK
    root = values["components"][0]["id"]
    values["patterns"] = {root: [["Row", [[parts[0]["id"]], [parts[-1]["id"]]]]]}
    if program == "inventor":
        values["rigidBodies"] = {"groups": GROUPS, "joints": JOINTS}
        return Inventor(described(values), facets=inventor_bodies).record()
    if program == "solidworks":
        return SolidWorks(described(values), solidworks_bodies).record()
    assembly = described(values)
    if program == "fusion":
        return Fusion(assembly, bodies=fusion_bodies).record(
            groups=(("G", [parts[0]["id"], parts[1]["id"]]),)
        )
    drawn = exported(POINTS, FACES, [{"baseColorFactor": [0.2, 0.5, 0.9, 1.0]}] * len(FACES), binary=False)
    bodies = of_each_part(assembly, "gltf", drawn) | boxes(assembly, POINTS) | stl(assembly, POINTS, FACES)
    return answers(assembly) | masses(assembly) | bodies


@pytest.mark.parametrize("program", PROGRAMS)
def test_a_broken_record_is_a_finding_or_a_bundle(program, tmp_path):
    """No traceback, no number without end, and a bundle that is refused later is refused by name."""
    sound = record(program, records(program))
    sound["answers"] = untagged(sound["answers"])  # an answer may lead to an object of any class
    source, target = tmp_path / "x.record.json", tmp_path / "x.bundle.json"
    for seed in range(SEEDS):
        source.write_bytes(mutated(sound, seed))
        report = Report()
        try:
            replay(source, target, report, "Z")
            json.loads(target.read_text("utf-8"), parse_constant=pytest.fail)
        except KinefabError as error:
            assert error.diagnostics


class Server:
    """A server on 127.0.0.1.  answer: of a path, (status, headers, body), the body cut off where its length says more."""

    def __init__(self, answer) -> None:
        self.asked: list[tuple[str, str]] = []
        outer = self

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                outer.asked.append((self.path, self.headers.get("Authorization", "")))
                status, headers, body = answer(self.path)
                if status == 0:  # never
                    time.sleep(1.0)
                    return
                if status < 0:  # not HTTP at all
                    self.wfile.write(body)
                    return
                self.send_response(status)
                for name, value in headers.items():
                    self.send_header(name, value)
                self.end_headers()
                self.wfile.write(body)

            def log_message(self, *arguments: object) -> None:
                pass

        self.http = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.http.daemon_threads = True
        threading.Thread(target=self.http.serve_forever, daemon=True).start()
        self.base = f"http://127.0.0.1:{self.http.server_port}"

    def __enter__(self) -> Server:
        return self

    def __exit__(self, *why: object) -> None:
        self.http.shutdown()
        self.http.server_close()


WHERE = {"did": "d", "wvm": "w", "wid": "a", "eid": "e"}
KEYS = ("on-access", "on-secret")


def asked(answer, question: str = "definition", patience: float = 60.0) -> tuple[str, list[float], int]:
    """What a question of a server comes to, how long was waited, how often it was asked."""
    slept: list[float] = []
    with Server(answer) as server:
        try:
            found = Rest(server.base, WHERE, KEYS, slept.append, patience).fetch(question)
        except MemberFailed as error:
            found = error.detail
            assert "on-secret" not in str(error) and "Basic" not in str(error)
        return str(found), slept, len(server.asked)


@pytest.mark.parametrize(
    ("status", "headers", "body", "words", "waited"),
    [
        (401, {}, b"", "the keys are not accepted", []),
        (402, {}, b"", "yearly number of calls", []),
        (403, {}, b"", "no right to this document", []),
        (404, {}, b"", "no such document", []),
        (429, {"Retry-After": "7"}, b"", "too many calls", [7.0, 7.0]),
        (429, {"Retry-After": "99999"}, b"", "too many calls", [60.0, 60.0]),
        (429, {"Retry-After": "soon"}, b"", "too many calls", [1.0, 1.0]),
        (429, {}, b"", "too many calls", [1.0, 1.0]),
        (500, {}, b"", "the server failed", []),
        (503, {"Retry-After": "2"}, b"", "the server failed", [2.0, 2.0]),
        (200, {}, b'{"rootAssembly": {"inst', "no JSON", []),
        (200, {}, b"<html>sign in</html>", "no JSON", []),
        (200, {}, b"[" * 100_000, "no JSON", []),
        (200, {"Content-Length": "1000"}, b'{"half": ', "IncompleteRead", []),
        (302, {"Location": "no scheme at all:"}, b"", "", []),
        (302, {"Location": "file:///etc/passwd"}, b"", "", []),
        (302, {}, b"", "", []),
        (-1, {}, b"\x00\x01 nothing that anybody speaks\r\n\r\n", "nothing that anybody speaks", []),
        (0, {}, b"", "timed out", []),
    ],
)  # fmt: skip
def test_a_server_that_fails_is_a_sentence(status, headers, body, words, waited):
    found, slept, _ = asked(lambda path: (status, headers, body), patience=60.0 if status else 0.3)
    assert words in found and slept == waited and "{" not in found


def test_a_server_that_is_not_there():
    with pytest.raises(MemberFailed, match="refused"):
        Rest("http://127.0.0.1:9", WHERE, KEYS).fetch("definition")


def test_a_redirect_to_another_host_goes_without_the_keys():
    with Server(lambda path: (200, {}, b'{"at": "another"}')) as other:
        found, _, _ = asked(lambda path: (307, {"Location": f"{other.base}/elsewhere"}, b""))
        assert "another" in found
        assert other.asked == [("/elsewhere", "")]


def test_a_redirect_at_the_same_host_keeps_them():
    with Server(lambda path: (200, {}, b"{}") if path == "/b" else (307, {"Location": "/b"}, b"")) as server:
        Rest(server.base, WHERE, KEYS).fetch("definition")
        assert len(server.asked) == 2 and all(login.startswith("Basic ") for _, login in server.asked)


def test_a_redirect_without_end():
    assert "leads nowhere" in asked(lambda path: (302, {"Location": path}, b""))[0]


@pytest.mark.parametrize(
    ("address", "allowed"),
    [
        ("https://cad.onshape.com/x", True),
        ("https://cad-usw2.onshape.com/x", True),  # where meshes are made
        ("http://cad-usw2.onshape.com/x", False),
        ("https://onshape.com.evil.org/x", False),
        ("https://evilonshape.com/x", False),
        ("https://s3.amazonaws.com/x", False),
        ("https://cad.onshape.com@evil.org/x", False),
    ],
)
def test_whose_hosts_may_have_the_keys(address, allowed):
    assert may_have_keys("https://cad.onshape.com", address) == allowed
    assert not may_have_keys("https://example.org", address)


def test_one_part_that_fails_does_not_lose_the_rest(tmp_path):
    known = answers(described(only_joints("gears")))

    def answer(path: str):
        word = path.partition("?")[0].rpartition("/")[2]
        word = {"e": "definition", "elements": "name"}.get(word, word)
        return (200, {}, json.dumps(known[word]).encode()) if word in known else (403, {}, b"")

    report, target = Report(), tmp_path / "x.bundle.json"
    with Server(answer) as server:
        environment = dict(zip(("ONSHAPE_ACCESS_KEY", "ONSHAPE_SECRET_KEY"), KEYS))
        address = f"{server.base}/documents/{'d' * 24}/w/{'a' * 24}/e/e"
        kept = tmp_path / "x.record.json"
        found = capture_onshape(address, environment, target, report, kept, up="Y")
    assert len(found.draft.joints) == 2 and {d.code for d in report.diagnostics} == {"CAPTURE_MEMBER_FAILED"}
    for path in tmp_path.iterdir():
        assert not [word for word in (*KEYS, "Basic", "Authorization") if word in path.read_text("utf-8")]


def test_a_blanked_record_holds_no_name_and_no_path(tmp_path):
    """Of failures too, whose text is the program's: it may name a file."""
    for program in PROGRAMS:
        held = records(program)
        if isinstance(held, list):
            held.append({"Range": {"failed": "com_error: (0x80004005, 'C:\\Users\\Zuse\\Secret.iam')"}})
        text = json.dumps(record(program, held, blank=True))
        words = (
            "Lever",
            "Crank",
            "Gears",
            "Plate",
            "Hinge",
            "Zuse",
            "Secret",
            "Base:",
            "Arm",
            LOOK["material"],
        )
        assert not [
            word for word in words if f'"{word}' in text or f"\\\\{word}" in text or f"/{word}" in text
        ], program
        path = tmp_path / "x.record.json"
        path.write_text(text, "utf-8")
        found = replay(path, tmp_path / "x.bundle.json", Report(), "Z")
        assert found.draft.joints or found.draft.constraints


@pytest.mark.parametrize("program", ["solidworks", "fusion"])
@pytest.mark.parametrize("fault", ["old", "none", "part", "throws"])
def test_what_is_in_the_way_of_the_others(program, fault, tmp_path):
    """As of Inventor: a sentence with a remedy, and no bundle."""
    held = records(program)
    first = held[0]
    document = held[first["ActiveDoc" if program == "solidworks" else "activeProduct"]["object"]]
    if fault == "old" and program == "solidworks":
        first["RevisionNumber()"] = "24.0.0"
    elif fault == "none":
        first["ActiveDoc" if program == "solidworks" else "activeProduct"] = None
    elif fault == "part" and program == "solidworks":
        document["GetType()"] = 1
    elif fault == "part":
        document["productType"] = "CAMProductType"
    elif fault == "throws":
        first["RevisionNumber()" if program == "solidworks" else "version"] = {"failed": "com_error: gone"}
    else:
        return  # Fusion is always the newest
    source, report = tmp_path / "x.record.json", Report()
    source.write_text(json.dumps(record(program, held)), "utf-8")
    with pytest.raises(KinefabError):
        replay(source, tmp_path / "x.bundle.json", report)
    expected = {
        "old": "CAPTURE_VERSION",
        "none": "CAPTURE_NO_ASSEMBLY",
        "part": "CAPTURE_NO_ASSEMBLY",
        "throws": "CAPTURE_STOPPED",
    }
    assert [d.code for d in report.diagnostics] == [expected[fault]] and report.diagnostics[0].remedy
    assert not (tmp_path / "x.bundle.json").exists()


@pytest.mark.parametrize(
    ("program", "kind", "member"),
    [
        ("inventor", "RigidBodyGroup", "GroupID"),
        ("inventor", "RigidBodyJoint", "JointType"),
        ("inventor", "Document", "DisplayName"),
        ("fusion", "Component", "name"),
    ],
)
@pytest.mark.parametrize("answer", [[], [0.1], 7.5, None])
def test_an_answer_of_another_type_is_told(program, kind, member, answer, tmp_path):
    held = records(program)
    first = next(entry for entry in held if entry.get("#kind") == f"{program}.{kind}")
    if answer == 7.5 and member in ("GroupID", "JointType"):
        return  # a number is one
    first[member] = answer
    source, report = tmp_path / "x.record.json", Report()
    source.write_text(json.dumps(record(program, held)), "utf-8")
    replay(source, tmp_path / "x.bundle.json", report, "Z")
    assert "CAPTURE_MEMBER_FAILED" in [d.code for d in report.diagnostics]
