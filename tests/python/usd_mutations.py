"""Reads mutated stages in a process of its own, since what crashes within pxr would end the tests' too.

    python tests/python/usd_mutations.py FOLDER COUNT SEED

Prints the number of files that were read and of those refused; any other end is a traceback.
"""

from __future__ import annotations

import random
import re
import sys
from pathlib import Path

from kinefab.diagnostics import KinefabError, Report
from kinefab.sources import read
from usd_stages import BODY, body, joint, stage

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
NUMBERS = ("nan", "inf", "-inf", "0", "-1", "1e38", "-1e-38", "99999999", "3", "-7", "0.5", "2", "1e-12")
WORDS = (
    "nan", "inf", "-inf", "0", "-1", "1e38", "-1e-38", "99999999999", "(0, 0, 0)", "[]", "</Nowhere>", "</>", '"X"', '""',
    "None", "true", "def", "over", "class", "PhysicsRevoluteJoint", "PhysicsJoint", "Mesh", "Cube", "Points", "(", ")", "{", "}",
)  # fmt: skip


def rich() -> str:
    """A small stage with a little of everything."""
    mesh = 'def Mesh "M" (prepend apiSchemas = ["PhysicsCollisionAPI", "PhysicsMeshCollisionAPI"]) { int[] faceVertexCounts = [4, 3]\n int[] faceVertexIndices = [0, 1, 2, 3, 0, 1, 4]\n point3f[] points = [(0,0,0), (1,0,0), (1,1,0), (0,1,0), (0,0,1)]\n texCoord2f[] primvars:st = [(0,0), (1,0), (1,1), (0,1), (0,0), (1,0), (0,1)] (interpolation = "faceVarying")\n int[] holeIndices = [1]\n def GeomSubset "S" { uniform token elementType = "face"\n uniform token familyName = "materialBind"\n int[] indices = [0]\n }\n }\n'
    keys = f'def Xform "K" {BODY} {{ bool physics:kinematicEnabled = 1\n float xformOp:rotateZ.timeSamples = {{ 0: 0, 10: 90 }}\n uniform token[] xformOpOrder = ["xformOp:rotateZ"]\n }}\n'
    points = 'def PointInstancer "I" { rel prototypes = [</I/P>]\n int[] protoIndices = [0, 0]\n point3f[] positions = [(0,0,5), (0,0,7)]\n def Sphere "P" (prepend apiSchemas = ["PhysicsCollisionAPI"]) { double radius = 2\n }\n }\n'
    limits = "float limit:rotX:physics:low = -10\nfloat limit:rotX:physics:high = 80\nfloat drive:rotX:physics:stiffness = 3"
    generic = joint(
        "PhysicsJoint", "D6", limits, "/B", "/C", '"PhysicsLimitAPI:rotX", "PhysicsDriveAPI:rotX"'
    )
    ball = joint(
        "PhysicsSphericalJoint",
        "Ball",
        "float physics:coneAngle0Limit = 30\nfloat physics:coneAngle1Limit = 30",
        "/C",
        "/D",
    )
    mimic = joint(
        "PhysicsRevoluteJoint",
        "R2",
        "rel newton:mimicJoint = </R1>\nfloat newton:mimicCoef1 = 2",
        "",
        "/E",
        '"NewtonMimicAPI"',
    )
    hinge = joint(
        "PhysicsRevoluteJoint",
        "R1",
        'uniform token physics:axis = "Y"\nfloat physics:lowerLimit = -10\nfloat physics:upperLimit = 80',
    )
    bodies = body("B", inside=mesh) + "".join(body(name, (i, 0, 0)) for i, name in enumerate("CDE"))
    return stage(bodies + keys + points + hinge + generic + ball + mimic, metres=0.01)


def mutated(text: str, chance: random.Random) -> bytes:
    """One to three changes: a token replaced, a span cut, doubled or moved, or a byte."""
    for _ in range(chance.choice((1, 1, 1, 2, 3))):
        kind = chance.random()
        if chance.random() < 0.6:  # a number, so that most are still read
            numbers = list(re.finditer(r"(?<![\w\"])-?\d+(\.\d+)?(?![\w\"])", text)) or [re.match("", text)]
            start, end = chance.choice(numbers).span()
            text = text[:start] + chance.choice(NUMBERS) + text[end:]
            continue
        tokens = list(re.finditer(r"[\w.:+-]+|[^\w\s]", text))
        if not tokens:
            break
        start, end = chance.choice(tokens).span()
        if kind < 0.5:
            text = text[:start] + chance.choice(WORDS) + text[end:]
        elif kind < 0.7:
            other = chance.choice(tokens).group()
            text = text[:start] + other + text[end:]
        elif kind < 0.85:
            stop = min(len(text), start + chance.randint(1, 200))
            text = text[:start] + text[stop:]
        elif kind < 0.95:
            stop = min(len(text), start + chance.randint(1, 200))
            text = text[:stop] + text[start:stop] + text[stop:]
        else:
            text = text[:start] + chr(chance.randint(0, 255)) + text[start + 1 :]
    return text.encode("latin-1", "replace")


def main() -> None:
    folder, count, seed = Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3])
    chance = random.Random(seed)
    sources = [rich(), rich(), (FIXTURES / "twins" / "arm.usda").read_text("utf-8")]
    path = folder / "mutated.usda"
    found = {"read": 0, "refused": 0}
    for number in range(count):
        path = folder / f"mutated{number}.usda"  # pxr keeps layers by their names
        data = mutated(sources[number % len(sources)], chance)
        path.write_bytes(data)
        try:
            read(path, Report())
            found["read"] += 1
        except KinefabError as error:
            found["refused"] += 1
            assert error.diagnostics
        except Exception:
            (folder / "culprit.usda").write_bytes(data)
            raise
        path.unlink()
    print(found["read"], found["refused"])


if __name__ == "__main__":
    main()
