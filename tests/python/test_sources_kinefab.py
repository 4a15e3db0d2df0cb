"""A written scene as a source: what is exported from it is what is exported from the source that it was made of."""

from __future__ import annotations

import json
import re
import struct
from dataclasses import is_dataclass, replace
from pathlib import Path

import kinefab
import kinefab.unity.scene as nouns_of_unity
import numpy as np
import pytest
from golden import golden_pairs
from kinefab.diagnostics import Report
from kinefab.model import Apart, Site
from kinefab.sources import read as read_source
from kinefab.spatial import Pose
from kinefab.targets.noun_entry import unsaid
from kinefab.unity.definitions import definition_of, definitions

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


LINKED = [LEVER / "lever.bundle.json", LEVER / "lever.urdf"] + [
    FIXTURES / "mechanisms" / f"{name}.bundle.json" for name in ("M01", "M08", "M25", "M26", "M27")
]


@pytest.mark.parametrize("source", LINKED, ids=lambda path: path.name)
def test_a_scene_of_links_is_a_source_as_one_of_bodies_is(source, tmp_path):
    """Asked for links again or not; and it moves as the source does."""
    asked = kinefab.ExportOptions(writing={"physics": "articulation"})
    scene = kinefab.export(source, tmp_path / "scene.kinefab", asked).path
    for name, options in (("plain", kinefab.ExportOptions()), ("asked", asked)):
        (tmp_path / name).mkdir()
        again = kinefab.export(scene, tmp_path / name / "scene.kinefab", options).path
        assert again.read_bytes() == scene.read_bytes()
    direct, by_scene = ({}, {})
    for files, given in ((direct, source), (by_scene, scene)):
        folder = tmp_path / ("prefab of scene" if given is scene else "prefab")
        folder.mkdir()
        kinefab.export(given, folder / "scene.prefab", asked)
        files |= {str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*") if p.is_file()}
    assert direct == by_scene
    whole, links = kinefab.motion(source), kinefab.motion(scene)
    assert whole.mobility == links.mobility
    document = glb(kinefab.export(scene, tmp_path / "scene.glb").path.read_bytes())
    moving = [n for n in document["nodes"] if "motion" in n.get("extensions", {}).get("KHR_physics_rigid_bodies", {})]
    assert sum("mass" in node["extensions"]["KHR_physics_rigid_bodies"]["motion"] for node in moving) >= 2


def test_the_range_and_the_drive_of_a_link_come_back(tmp_path):
    """Turned anchors, asymmetric ends: what the page and a .glb of it tell is what the joint was made with."""
    scene = kinefab.Scene()
    parts = [
        scene.add_part(name, translation=at, mass=kinefab.MassProperties(m, np.zeros(3), 0.01 * m * np.eye(3)))
        for name, at, m in (("Base", (0, 0, 0), 1.0), ("Arm", (0.1, 0.2, 0.3), 2.0), ("Slide", (0.4, 0.1, -0.2), 3.0))
    ]
    scene.nodes[0] = replace(scene.nodes[0], grounded=True)
    drive = kinefab.Drive(target=0.2, stiffness=30.0, damping=2.0, max_force=7.0)
    scene.add_hinge(parts[0], parts[1], point=(0.1, 0.1, 0), axis=(0.6, 0.0, 0.8), limits=(-20, 70), name="Turn", drive=drive)
    scene.add_slider(parts[1], parts[2], point=(0, 0, 0.1), axis=(0, 0.8, -0.6), limits=(-0.1, 0.4), name="Reach")
    asked = kinefab.ExportOptions(writing={"physics": "articulation"})
    path = kinefab.export(scene, tmp_path / "arm.kinefab", asked).path
    stated = {joint.name: joint for joint in scene.joints}
    found = {joint.name: joint for joint in kinefab.sources.read(path, kinefab.Report()).joints}
    for name, freedom, base in (("Turn", 3, parts[0]), ("Reach", 0, parts[1])):
        axes = [(scene.pose(base) @ joint.frame_a).rotation[:, 0] for joint in (stated[name], found[name])]
        sense = float(axes[0] @ axes[1])  # a link may count about the axis turned round
        assert abs(sense) == pytest.approx(1.0)
        one, other = stated[name].freedoms[freedom], found[name].freedoms[freedom]
        one = one if sense > 0.0 else one.turned_round()
        assert (other.lower, other.upper) == pytest.approx((one.lower, one.upper))
        if name == "Turn":
            assert other.drive.target == pytest.approx(one.drive.target)
            assert (other.drive.stiffness, other.drive.max_force) == pytest.approx((30.0, 7.0))


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


@pytest.mark.parametrize("ground", ["body", "world"])
def test_what_is_asked_of_geometry_that_a_scene_states_already_is_told_as_unused(ground, tmp_path):
    scene = kinefab.export(LEVER / "lever.bundle.json", tmp_path / "scene.kinefab").path
    asked = kinefab.ExportOptions(colliders="box", density=7850, smooth=None, solve=True, ground=ground)
    report = kinefab.export(scene, tmp_path / "again.kinefab", asked).report
    told = sorted(d.message.split()[0] for d in report.diagnostics if d.code == "SOURCE_OPTION_UNUSED")
    assert told == ["--colliders", "--density", "--smooth", "--solve"][: 4 if ground == "body" else 3]
    assert not kinefab.export(scene, tmp_path / "again.kinefab").report.diagnostics


def test_roles_configuration_and_pairs_are_said_and_read_back(tmp_path):
    """The ground, a site, which state of the source it was, and a rule by which two parts pass through each other."""
    scene = kinefab.Scene()
    parts = [scene.add_part(name, density=1000, translation=(i, 0, 0)) for i, name in enumerate("AB")]
    for part in parts:
        scene.add_hinge(None, part, point=(0, 0, 0), axis=(0, 1, 0))
    scene.nodes[1] = replace(scene.nodes[1], sites=(Site("tip", Pose(translation=np.array([0.0, 0.2, 0.0]))),))
    scene.apart.append(Apart(0, 1, "contact exclude"))
    scene.source = replace(scene.source, configuration="Tool=long")
    first = kinefab.export(scene, tmp_path / "first.kinefab").path
    document = json.loads(first.read_text("utf-8"))
    roles = {entry["id"]: entry["role"] for entry in document["gameObjects"] if "role" in entry}
    assert roles == {"kinefab:ground": "ground", "B/site:tip": "site"} and document["version"] == "1.1"
    assert document["source"]["configuration"] == "Tool=long"
    assert document["ignoredCollisions"] == [{"a": 1, "b": 2, "reason": "contact exclude"}]
    again = kinefab.export(first, tmp_path / "again.kinefab").path
    assert again.read_bytes() == first.read_bytes()
    world = json.loads(kinefab.export(scene, tmp_path / "w.kinefab", kinefab.ExportOptions(ground="world")).path.read_text("utf-8"))
    assert "ground" not in [entry.get("role") for entry in world["gameObjects"]]
    back = read_source(first, Report())
    assert [site.name for site in back.nodes[1].sites] == ["tip"] and back.source.configuration == "Tool=long"
    assert [(pair.a, pair.b, pair.reason) for pair in back.apart] == [(0, 1, "contact exclude")]


def test_every_field_of_every_noun_has_a_place_in_the_file():
    """So nothing that Unity has is lost on the way into a scene; of a mesh and a coupling the file's own words are others."""
    nouns = [noun for name in nouns_of_unity.__all__ if is_dataclass(noun := getattr(nouns_of_unity, name))]
    written_otherwise = {"Mesh": {"vertices", "triangles", "uvs"}, "Coupling": {"coordinate"}}
    left = {
        noun.__name__: set(unsaid(noun)) - written_otherwise.get(noun.__name__, set())
        for noun in nouns
        if definition_of(noun) in definitions()
    }
    assert len(left) > 30 and not any(left.values()), left


def test_what_other_programs_wrote_into_any_object_stays(tmp_path):
    """On objects that no noun of ours has extras for, and on ones that are left out at their default."""
    folder = tmp_path / "made"
    folder.mkdir()
    path = kinefab.export(LEVER / "lever.bundle.json", folder / "scene.kinefab").path
    document = json.loads(path.read_text("utf-8"))
    document["gameObjects"][0].setdefault("transform", {})
    marked = 0

    def mark(value, place):
        nonlocal marked
        if isinstance(value, dict):
            for key, item in list(value.items()):
                mark(item, f"{place}/{key}")
            if not place.endswith(("/extras", "/closureGap", "/bounds")):
                value["extras"], marked = {**value.get("extras", {}), "mark": place, "number": 3.0}, marked + 1
        elif isinstance(value, list):
            for index, item in enumerate(value):
                mark(item, f"{place}/{index}")

    mark(document, "")
    path.write_text(json.dumps(document), "utf-8")
    result = kinefab.export(path, tmp_path / "scene.kinefab")
    assert not result.report.diagnostics and marked > 100
    assert json.loads(result.path.read_text("utf-8")) == document
    assert '"number": 3}' in result.path.read_text("utf-8")
