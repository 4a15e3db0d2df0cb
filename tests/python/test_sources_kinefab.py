"""A written scene as a source: what is exported from it is what is exported from the source that it was made of."""

from __future__ import annotations

import json
import re
import struct
from pathlib import Path

import kinefab
import numpy as np
import pytest
from golden import golden_pairs

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
LEVER = FIXTURES / "lever"
OTHERS = ("urdf", "sdf", "asmt", "csv", "FCStd")
SOURCES = [bundle for bundle, _ in golden_pairs()] + [LEVER / f"lever.{ending}" for ending in OTHERS]


def twice(source: Path, ending: str, folder: Path, **options) -> tuple[dict[str, bytes], dict[str, bytes]]:
    """Every file that an export writes, by its name: from the source, and from the scene that is made of the source."""
    (folder / "made").mkdir()
    scene = kinefab.export(source, folder / "made" / "scene.kinefab").path
    found = []
    for name, given in (("direct", source), ("by scene", scene)):
        (folder / name).mkdir()
        kinefab.export(given, folder / name / f"scene{ending}", kinefab.ExportOptions(writing=options))
        own = folder / name
        files = sorted(path for path in own.rglob("*") if path.is_file())
        found.append({str(path.relative_to(own)): path.read_bytes() for path in files})
    return found[0], found[1]




def unnumbered(files: dict[str, bytes]) -> list[tuple[str, str]]:
    """Files of a prefab with their own numbers counted in the order in which they are met.

    Where a source tells its objects by more than names, as FreeCAD's documents do, they hang on what a scene file does not hold.
    """
    numbers: dict[str, str] = {}
    own = re.compile(r"(?<=guid: )[0-9a-f]{32}|(?<=fileID: )-?\d{6,}|(?<= &)-?\d+")
    return [
        (name, own.sub(lambda m: numbers.setdefault(m.group(), f"#{len(numbers)}"), text.decode("utf-8")))
        for name, text in files.items()
    ]


@pytest.mark.parametrize("source", SOURCES, ids=lambda path: path.name)
def test_a_scene_of_a_scene_has_the_same_bytes(source, tmp_path):
    direct, by_scene = twice(source, ".kinefab", tmp_path)
    assert direct == by_scene


@pytest.mark.parametrize(
    "source", [path for path in SOURCES if path.suffix != ".FCStd"], ids=lambda path: path.name
)
def test_a_prefab_of_a_scene_has_the_same_bytes(source, tmp_path):
    direct, by_scene = twice(source, ".prefab", tmp_path, scripts=True)
    assert len(direct) > 1 and direct == by_scene


def test_a_prefab_of_a_scene_whose_source_tells_its_parts_by_more_than_names_has_the_same_documents(tmp_path):
    """FreeCAD's documents name an object for good; a scene holds the names alone, and Unity orders documents by numbers."""
    documents = []
    for files in map(unnumbered, twice(LEVER / "lever.FCStd", ".prefab", tmp_path)):
        text = re.sub("#\\d+", "#", dict(files)["scene.prefab"])
        documents.append(sorted(re.sub("m_RootOrder: \\d+", "", part) for part in text.split("--- ")))
    assert documents[0] == documents[1] and len(documents[0]) > 20


def test_a_package_of_a_scene_has_the_same_bytes(tmp_path):
    direct, by_scene = twice(LEVER / "lever.bundle.json", ".unitypackage", tmp_path, unity="6")
    assert direct == by_scene


def glb(content: bytes) -> dict:
    (length,) = struct.unpack_from("<I", content, 12)
    return json.loads(content[20 : 20 + length])


def told(document: dict) -> dict[str, object]:
    """Of each node that the source names, its own place and its motion; and how many bodies, joints and triangles there are."""
    found: dict[str, object] = {}
    for node in document.get("nodes", ()):
        if "id" in node.get("extras", {}):
            moves = node.get("extensions", {}).get("KHR_physics_rigid_bodies", {}).get("motion", {})
            place = {
                "translation": node.get("translation", [0.0, 0.0, 0.0]),
                "rotation": node.get("rotation", [0.0, 0.0, 0.0, 1.0]),
            }
            told = {k: v for k, v in moves.items() if k not in ("inertiaOrientation", "isKinematic")}
            found[node["extras"]["id"]] = {**place, **told}
    physics = document.get("extensions", {}).get("KHR_physics_rigid_bodies", {})
    found["joints"] = sorted(
        sorted((json.dumps(limit.get("linearAxes") or limit.get("angularAxes")), reach(limit)) for limit in j["limits"])
        for j in physics.get("physicsJoints", ())
        if "limits" in j
    )  # fmt: skip
    drawn = [m for n in document.get("nodes", ()) if "mesh" in n and "shape" not in n["name"] for m in [n["mesh"]]]
    found["triangles"] = sum(
        document["accessors"][p["indices"]]["count"] for m in drawn for p in document["meshes"][m]["primitives"]
    )
    return found


def reach(limit: dict) -> float:
    """Which way and how far: in a scene file a coordinate is zero at the exported pose, wherever the source's zero is."""
    return round(limit["max"] - limit["min"], 9) if "min" in limit and "max" in limit else -1.0


@pytest.mark.parametrize(
    "source", [p for p in SOURCES if "P" not in p.name[:1]], ids=lambda path: path.name
)
def test_a_glb_of_a_scene_tells_the_same_places_masses_and_joints(source, tmp_path):
    """Not the same bytes: coordinates count from the exported pose, numbers have twelve decimals, colliders are stated,
    and what joins a part of the ground joins the ground, so no part of it is a kinematic body."""
    first, second = (told(glb(files["scene.glb"])) for files in twice(source, ".glb", tmp_path))
    assert first.keys() == second.keys()
    for name, value in first.items():
        close(value, second[name], name)


def close(one: object, other: object, where: str) -> None:
    if isinstance(one, dict):
        assert one.keys() == other.keys(), where
        for key, value in one.items():
            close(value, other[key], f"{where}/{key}")
    elif isinstance(one, (int, float, list)) and not isinstance(one, bool) and where != "joints":
        assert np.allclose(one, other, atol=1e-9), f"{where}: {one} {other}"
    else:
        assert one == other, where


CONFORMANCE = FIXTURES.parent / "tests" / "conformance"


@pytest.mark.parametrize("ending", [".kinefab", ".prefab", ".glb"])
@pytest.mark.parametrize(
    "path", sorted(CONFORMANCE.rglob("*.kinefab")), ids=lambda path: f"{path.parent.name}/{path.stem}"
)
def test_a_scene_with_a_fault_is_refused_or_written_never_an_exception(path, ending, tmp_path):
    try:
        kinefab.export(path, tmp_path / f"scene{ending}")
    except kinefab.KinefabError as error:
        assert path.parents[1].name == "invalid" and error.diagnostics
