"""For every fixture: the bodies that pass through each other in the exported scene are those of the source, counted from its own text."""

from __future__ import annotations

import json
import xml.etree.ElementTree as xml
from itertools import combinations
from pathlib import Path

import kinefab
import pytest

ROOT = Path(__file__).parents[2]
BUNDLES = sorted((ROOT / "fixtures").glob("*/*.bundle.json"))
ROBOTS = sorted([*(ROOT / "fixtures").glob("*/*.urdf"), *(ROOT / "fixtures").glob("*/*.sdf")])
BESIDE = {
    *("distance", "tangent", "angle", "parallel", "perpendicular", "symmetry"),
    *("lock_orientation", "linear", "other", "ground"),
}
"""Kinds that say nothing of one body standing in another (``schemas/SPEC.md``, section 7)."""
Pair = frozenset[int]


class Written:
    """A scene file.  body: for each object what moves with it, as the lowest object of all that FixedJoints hold together."""

    def __init__(self, path: Path):
        self.objects = json.loads(path.read_text(encoding="utf-8"))["gameObjects"]
        self.index = {entry["id"]: i for i, entry in enumerate(self.objects)}
        own: list[int | None] = []
        for i, entry in enumerate(self.objects):
            parent = entry.get("parent")
            has = any(c["type"] == "Rigidbody" for c in entry.get("components", ()))
            own.append(i if has else None if parent is None else own[parent])
        welded = {i: i for i in own if i is not None}
        for i, component in self.components("FixedJoint"):
            a, b = (welded[own[k]] for k in (i, component["connectedBody"]))  # pyright: ignore
            welded = {k: min(a, b) if v in (a, b) else v for k, v in welded.items()}
        self.body = [None if i is None else welded[i] for i in own]
        self.led = {
            self.body[i] for i, c in self.components("Rigidbody") if c.get("isKinematic", False)
        }

    def components(self, *kinds: str):
        for i, entry in enumerate(self.objects):
            for component in entry.get("components", ()):
                if component["type"] in kinds:
                    yield i, component

    def pair(self, a: int, b: int) -> Pair | None:
        """Of two objects, where they are two bodies of which one moves."""
        found = {self.body[a], self.body[b]}
        return None if len(found) < 2 or None in found or found <= self.led else frozenset(found)  # pyright: ignore

    def apart(self, among: set[int], holding: bool = True) -> set[Pair]:
        """Pairs of bodies that a joint keeps from colliding.  holding: also those of joints that hold something."""
        found = {
            self.pair(i, c["connectedBody"])
            for i, c in self.components("HingeJoint", "ConfigurableJoint")
            if "connectedBody" in c and not c.get("enableCollision", False)
            if holding or "apart" in c.get("extras", {})
        }
        bodies = {self.body[i] for i in among}
        return {pair for pair in found if pair is not None and pair <= bodies}


def exported(source: Path, folder: Path) -> Written:
    kinefab.export(source, folder / "scene.kinefab")
    return Written(folder / "scene.kinefab")


@pytest.mark.parametrize("source", BUNDLES, ids=lambda path: path.name.split(".")[0])
def test_bundle(source: Path, tmp_path: Path):
    bundle = json.loads(source.read_text(encoding="utf-8"))
    try:
        scene = exported(source, tmp_path)
    except kinefab.KinefabError as error:
        pytest.skip(f"the fixture shows a fault: {error}")
    parts = {c["id"]: scene.index[c["id"]] for c in bundle["components"] if c["id"] in scene.index}
    mated = [
        [parts.get(c[side]["component"]) for side in "ab" if side in c]
        for c in bundle.get("constraints", ())
        if c["kind"] not in BESIDE and not c.get("suppressed", False)
    ]
    mated += [[parts.get(j[side]) for side in "ab"] for j in bundle.get("joints", ())]
    expected = {scene.pair(*pair) for pair in mated if len(pair) == 2 and None not in pair} - {None}  # pyright: ignore
    found = scene.apart(set(parts.values()))
    assert expected <= found
    # Unity never lets what a joint holds together collide, as one that stands for an angle or a tangency.
    assert scene.apart(set(parts.values()), holding=False) <= expected


def links_of(root: xml.Element, source: Path) -> tuple[dict[str, str], set[frozenset[str]]]:
    """Links by the ids of their objects, and the pairs that the file keeps apart.

    URDF: what a joint connects.  SDF: the same, and all links of one model, as ``self_collide`` is false by default.
    """
    if source.suffix == ".urdf":
        ids = {link.attrib["name"]: link.attrib["name"] for link in root.iter("link")}
        sides = [[joint.find(end) for end in ("parent", "child")] for joint in root.iter("joint")]
        return ids, {frozenset(end.attrib["link"] for end in pair if end is not None) for pair in sides}
    ids, found = dict[str, str](), set[frozenset[str]]()
    for model in root.iter("model"):
        assert model.find("model") is None and model.find("self_collide") is None
        own = [link.attrib["name"] for link in model.findall("link")]
        ids |= {f"{model.attrib['name']}/{name}": f"{model.attrib['name']}/{name}" for name in own}
        found |= {frozenset(f"{model.attrib['name']}/{name}" for name in pair) for pair in combinations(own, 2)}
    return ids, found


@pytest.mark.parametrize("source", ROBOTS, ids=lambda path: path.parent.name + "-" + path.name)
def test_robot(source: Path, tmp_path: Path):
    root = xml.parse(source).getroot()
    shaped = {
        link.attrib["name"] for link in root.iter("link") if link.find("collision") is not None
    }
    ids, pairs = links_of(root, source)
    scene = exported(source, tmp_path)
    present = {name: scene.index[id] for name, id in ids.items() if id in scene.index and name.split("/")[-1] in shaped}
    kept = [tuple(pair) for pair in pairs if len(pair) == 2 and set(pair) <= set(present)]
    expected = {scene.pair(present[a], present[b]) for a, b in kept} - {None}
    assert scene.apart(set(present.values())) == expected
