"""How often a program is asked: linear in its assembly, counted."""

from __future__ import annotations

import math

import pytest
from cad.captures import Program, call
from cad.described import described
from cad.fusion import Fusion
from cad.gltf import exported
from cad.inventor import Inventor
from cad.onshape import answers, weighed
from cad.solidworks import SolidWorks
from cad.tetrahedron import FACES, POINTS
from kinefab.capture.channel import Live
from kinefab.capture.draft import Draft
from kinefab.capture.fusion import capture as fusion
from kinefab.capture.inventor import capture as inventor
from kinefab.capture.onshape.answers import Answers
from kinefab.capture.onshape.capture import capture as onshape
from kinefab.capture.solidworks import capture as solidworks
from test_capture_kinds import side
from test_capture_matter import tetrahedron


def chain(parts: int, constraints: int, joints: int = 0) -> dict:
    """Parts of one definition in a row, plane mates and hinges between neighbours."""
    identity = {"o": [0.0, 0.0, 0.0], "x": [1.0, 0.0, 0.0], "y": [0.0, 1.0, 0.0], "z": [0.0, 0.0, 1.0]}
    components = [{"id": "M", "kind": "assembly", "flexible": True, "pose": identity}]
    for i in range(parts):
        pose = {**identity, "o": [0.1 * (i + 1), 0.0, 0.0]}
        components.append({"id": f"M/P{i}", "kind": "part", "parent": "M", "definition": "P", "pose": pose})

    def mate(i: int) -> dict:
        a, b = f"P{i % parts}", f"P{(i + 1) % parts}"
        return {
            "id": f"C{i}",
            "kind": "coincident",
            "a": side(a, "plane"),
            "b": side(b, "plane", d=[0.0, 0.0, -1.0]),
        }

    at = {"in": "world", "o": [0.0, 0.0, 0.0], "z": [0.0, 0.0, 1.0], "x": [1.0, 0.0, 0.0]}
    hinges = [
        {
            "id": f"J{i}",
            "type": "revolute",
            "a": f"M/P{i % parts}",
            "b": f"M/P{(i + 1) % parts}",
            "frameA": at,
            "frameB": at,
        }
        | {"dof": [{"name": "rz", "value": 0.0}]}
        for i in range(joints)
    ]
    meta = {"units": {"length": "m", "angle": "rad"}, "up": "Z"}
    return {
        "meta": meta,
        "components": components,
        "constraints": [mate(i) for i in range(constraints)],
        "joints": hinges,
    }


def asked(program: str, parts: int, constraints: int, joints: int = 0) -> int:
    double, module = {
        "inventor": (Inventor, inventor),
        "solidworks": (SolidWorks, solidworks),
        "fusion": (Fusion, fusion),
    }[program]
    record = double(described(chain(parts, constraints, joints))).record()
    channel = Live(Program(record), module.METHODS, call)
    module.capture(channel.root, Draft(program, "m", "Z"))
    return channel.calls


@pytest.mark.parametrize(
    ("program", "most"),
    [("inventor", 32.0), ("solidworks", 17.0), ("fusion", 22.0)],
)
def test_calls_are_linear_and_as_many_as_stated(program, most):
    """most: calls for each occurrence or constraint of a large assembly; out of process each costs about a millisecond."""
    hinges = program == "fusion"
    sizes = [(40, 0, 100) if hinges else (40, 100, 0), (80, 0, 200) if hinges else (80, 200, 0)]
    sizes.append((160, 0, 400) if hinges else (160, 400, 0))
    one, two, four = (asked(program, *size) for size in sizes)
    assert four - two == 2 * (two - one)
    each = (two - one) / 140.0
    assert each <= most


def test_onshape_is_asked_four_times_twice_a_part_and_once_a_studio():
    values = chain(50, 0, 120)
    known = answers(described(values))
    calls: list[str] = []

    drawn, solid = exported(POINTS, FACES, [None] * len(FACES)), tetrahedron()[1]
    mass = weighed(2.0, POINTS.mean(axis=0), solid, 0.03 * 0.02 * 0.05 / 6.0)
    others = {"gltf": drawn, "mass": mass, "parts": []}

    def fetch(question: str):
        calls.append(question)
        return known[question] if question in known else others[question.partition(" ")[0]]

    onshape(Answers(fetch=fetch), Draft("Onshape", "m", "Z"))
    assert len(calls) == 7 and math.isclose(len(set(calls)), len(calls))
