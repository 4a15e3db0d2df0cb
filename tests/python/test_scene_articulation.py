"""``--physics articulation`` to ``.kinefab``: the links of the prefab, with format 1.1 and the couplings kept."""

from __future__ import annotations

import json
from pathlib import Path

import kinefab
import numpy as np
import pytest
from kinefab.model import Apart
from kinefab.spatial import matrix_from_quaternion
from kinefab.views.overview import overview, picture
from test_prefab_articulation import ARTICULATED, BOX, arm, exported, link, mass, nodes_of, ringed

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
VECTORS = {
    "anchorPosition": "m_AnchorPosition",
    "parentAnchorPosition": "m_ParentAnchorPosition",
    "centerOfMass": "m_CenterOfMass",
}


def written(scene, folder: Path, **options) -> dict:
    writing = {**ARTICULATED, **options.pop("writing", {})}
    kinefab.export(scene, folder / "arm.kinefab", kinefab.ExportOptions(writing=writing, **options))
    return json.loads((folder / "arm.kinefab").read_text(encoding="utf-8"))


def links_of(scene: dict) -> dict[str, dict]:
    return {
        entry["name"]: component
        for entry in scene["gameObjects"]
        for component in entry.get("components", [])
        if component["type"] == "ArticulationBody"
    }


def test_links_are_those_of_the_prefab(tmp_path):
    found = links_of(written(arm(), tmp_path))
    nodes = nodes_of(exported(arm(), tmp_path)[0])
    assert {"Upper", "Fore"} <= set(found)
    for name in ("Upper", "Fore"):
        ours, theirs = found[name], link(nodes[name])
        assert ours.get("mass", 1.0) == float(theirs["m_Mass"])
        for mine, unity in VECTORS.items():
            there = np.array([float(theirs[unity][k]) for k in "xyz"])
            assert np.allclose(ours.get(mine, [0, 0, 0]), there, atol=1e-6), (name, mine)
        turns = [
            matrix_from_quaternion(np.array(q))
            for q in (
                ours.get("anchorRotation", [0, 0, 0, 1]),
                [float(theirs["m_AnchorRotation"][k]) for k in "xyzw"],
            )
        ]
        assert np.allclose(turns[0], turns[1], atol=1e-6)
        for mine, unity in (("xDrive", "m_XDrive"), ("yDrive", "m_YDrive")):
            drive = ours.get(mine, {})
            for field in ("lowerLimit", "upperLimit", "stiffness", "damping", "target"):
                assert drive.get(field, 0.0) == pytest.approx(float(theirs[unity][field]), abs=1e-6), (name, mine, field)
    assert found["Upper"]["jointType"] == "Revolute"
    assert found["Fore"]["jointType"] == "Prismatic"


def test_a_link_says_which_joint_it_stands_for(tmp_path):
    assert links_of(written(arm(), tmp_path))["Upper"]["because"]


def test_version_is_that_of_what_is_in_the_file(tmp_path):
    assert written(arm(), tmp_path)["version"] == "1.1"
    bare = kinefab.Scene()
    bare.add_part("Base", BOX)
    assert written(bare, tmp_path, writing={"physics": "rigidbody"})["version"] == "1.0"


def test_couplings_are_those_of_the_links(tmp_path):
    scene = kinefab.Scene()
    base = scene.add_part("Base", BOX, grounded=True)
    wheels = [scene.add_part(f"Wheel{i}", BOX, translation=(i, 0, 0), mass=mass(1.0)) for i in range(2)]
    joints = [
        scene.add_hinge(base, wheel, point=(i, 0, 0), axis=(0, 0, 1), name=f"Pin{i}")
        for i, wheel in enumerate(wheels)
    ]
    scene.add_coupling(*joints, -2.0)
    found = written(scene, tmp_path)
    plain = written(scene, tmp_path, writing={"physics": "rigidbody"})
    assert len(found["couplings"]) == 1
    (mine,), (theirs,) = found["couplings"], plain["couplings"]
    assert mine["ratio"] == theirs["ratio"]
    for side in ("a", "b"):
        at = mine[side]
        entry = found["gameObjects"][at["gameObject"]]
        assert entry["components"][at["component"]]["type"] == "ArticulationBody"
        assert at["coordinate"] == "angularX"
        assert entry["id"] == plain["gameObjects"][theirs[side]["gameObject"]]["id"]


def test_inspect_and_page_show_what_a_link_may_do(tmp_path):
    """As of the same scene with bodies: between the same two, as far; the page moves by the same coordinates."""
    told = []
    for physics in ("rigidbody", "articulation"):
        options = kinefab.ExportOptions(writing={"physics": physics})
        path = kinefab.export(arm(), tmp_path / f"{physics}.kinefab", options).path
        found = json.loads(overview(path, True))
        joints = [(j["name"], j["object"], j["freedoms"]) for j in found["joints"] if j["freedoms"]]
        moved = [(c.name, c.unit, c.lower, c.upper) for c in kinefab.motion(path).coordinates]
        assert any(entry["mass"] not in (None, 1) for entry in found["objects"])
        told.append((sorted(joints), sorted(moved)))
        assert "joint" in overview(path, False) and picture(path).startswith("<svg")
        assert kinefab.view(path, tmp_path / f"{physics}.html").stat().st_size > 10000
    assert told[0][0] == told[1][0] and len(told[0][0]) > 1
    assert [c[:2] for c in told[0][1]] == [c[:2] for c in told[1][1]]
    for one, other in zip(told[0][1], told[1][1]):
        assert one[2:] == pytest.approx(other[2:])


def test_pairs_that_do_not_collide_name_the_same_parts_below_other_ones(tmp_path):
    """Links stand below those that hold them, so that objects change places in the file."""
    scene = kinefab.Scene()
    for name in ("Base", "Loose", "Upper", "Fore"):
        scene.add_part(name, BOX, grounded=name == "Base")
    scene.add_hinge(0, 3, point=(0, 0, 0), axis=(0, 0, 1))
    scene.add_hinge(3, 2, point=(0, 0, 1), axis=(0, 0, 1))
    scene.apart.append(Apart(1, 3, "filtered pair"))
    found = written(scene, tmp_path)
    names = [entry["name"] for entry in found["gameObjects"]]
    assert names.index("Fore") < names.index("Upper")
    assert [{names[pair["a"]], names[pair["b"]]} for pair in found["ignoredCollisions"]] == [{"Loose", "Fore"}]


LOOPS = [FIXTURES / "mechanisms" / f"{name}.bundle.json" for name in ("M43", "M44", "M50")]


def linked(document: dict, folder: Path) -> dict:
    """The scene of links that an edited scene file gives, without the report."""
    path = folder / "edited.kinefab"
    path.write_text(json.dumps(document), encoding="utf-8")
    found = written(path, folder)
    del found["report"]
    return found


@pytest.mark.parametrize("source", LOOPS, ids=lambda path: path.name)
def test_a_joint_that_keeps_apart_changes_nothing_wherever_it_stands(tmp_path, source):
    """Before those that hold, which have other places among the object's components then; couplings still name them."""
    document = json.loads(kinefab.export(source, tmp_path / "edited.kinefab").path.read_text("utf-8"))
    plain, first = linked(document, tmp_path), {}
    for i, entry in enumerate(document["gameObjects"]):
        joints = [c for c in entry.get("components", ()) if "connectedBody" in c]
        if joints:
            first[i] = entry["components"].index(joints[0])
            apart = {"type": "ConfigurableJoint", "connectedBody": joints[0]["connectedBody"], "extras": {"apart": "by hand"}}
            entry["components"].insert(first[i], apart)
    for coupling in document.get("couplings", ()):
        for end in (coupling["b"], coupling.get("a"), *coupling.get("terms", ())):
            if end is not None:
                end["component"] += end["component"] >= first[end["gameObject"]]
    assert linked(document, tmp_path) == plain


def test_helpers_of_joints_without_ids_have_ids_of_their_own(tmp_path):
    document = json.loads(kinefab.export(LOOPS[1], tmp_path / "edited.kinefab").path.read_text("utf-8"))
    for entry in document["gameObjects"]:
        for component in entry.get("components", ()):
            component.pop("id", None)
    ids = [entry["id"] for entry in linked(document, tmp_path)["gameObjects"]]
    assert len(set(ids)) == len(ids) and sum("kinefab:helper" in id for id in ids) == 7


@pytest.mark.parametrize("stated", [False, True])
def test_hollows_of_a_base_are_cut_alike_from_its_scene_file(tmp_path, stated):
    """Hulls where nothing cuts; what the pieces are made of has the file's order and digits either way."""
    scene = kinefab.export(ringed(stated), tmp_path / "made.kinefab").path
    assert written(ringed(stated), tmp_path) == written(scene, tmp_path)
