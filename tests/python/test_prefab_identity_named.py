"""A second export of what has names, from a CAD bundle and an assembly of FreeCAD's: whatever is still there keeps its fileIDs."""

from __future__ import annotations

import json
import re
from pathlib import Path

import kinefab
import pytest
from test_prefab_identity_nameless import TARGETS, prefab_of

FIXTURES = Path(__file__).parents[2] / "fixtures"


def known(text: str) -> dict[tuple[str, str], set[int]]:
    """The fileID of each GameObject, and those of its components of each class, by its name."""
    documents = [
        (int(head[1]), head[2], document)
        for document in re.split(r"^--- ", text, flags=re.MULTILINE)[1:]
        if (head := re.match(r"!u!\d+ &(-?\d+)\n(\w+):", document)) is not None
    ]
    named = {id: re.search(r"^  m_Name: (.*)$", document, re.MULTILINE)[1] for id, kind, document in documents if kind == "GameObject"}
    found: dict[tuple[str, str], set[int]] = {}
    for id, kind, document in documents:
        owner = re.search(r"^  m_GameObject: \{fileID: (-?\d+)\}", document, re.MULTILINE)
        name = named[id] if kind == "GameObject" else named[int(owner[1])] if owner is not None else ""
        found.setdefault((kind, name), set()).add(id)
    return found


def before_and_after(source: Path, target: Path, texts: tuple[str, str]) -> list[dict[tuple[str, str], set[int]]]:
    """What is known in the export of a source, and in the next one after it was changed."""
    found: list[dict[tuple[str, str], set[int]]] = []
    for text in texts:
        source.write_text(text, encoding="utf-8")
        kinefab.export(source, target)
        found.append(known(prefab_of(target)))
    return found


def arm(change: str) -> str:
    """The bundle of an arm, changed."""
    bundle = json.loads((FIXTURES / "twins" / "arm.bundle.json").read_text(encoding="utf-8"))
    parts, joints = bundle["components"], bundle["joints"]
    if change == "reorder":
        parts[1:], joints[:] = parts[:0:-1], joints[::-1]
    elif change == "insert":
        parts.insert(1, {**parts[2], "id": "Arm/Cover", "name": "Cover"})
    elif change == "delete":
        parts[:] = [part for part in parts if part["name"] != "FingerA"]
        joints[:] = [joint for joint in joints if "Arm/FingerA" not in (joint["a"], joint["b"])]
        bundle["couplings"] = []
    elif change == "move":
        parts[-1]["pose"]["o"][0] += 0.01
        joints[-1]["frameB"] = joints[-1]["frameA"]
    elif change == "rename":
        parts[2]["name"] = "Shoulder"
    return json.dumps(bundle)


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("change", ["reorder", "insert", "delete", "move", "rename"])
def test_parts_of_a_bundle_are_known_by_their_ids(tmp_path: Path, change: str, target: str):
    before, now = before_and_after(tmp_path / "arm.bundle.json", tmp_path / f"Arm.{target}", (arm(""), arm(change)))
    gone = {name for _, name in before.keys() - now.keys()}
    assert gone == {"delete": {"FingerA"}, "rename": {"Link1"}}.get(change, set())
    assert {key: now[key] for key in before if key[1] not in gone} == {key: id for key, id in before.items() if key[1] not in gone}
    if change == "rename":
        assert {kind: now[kind, "Shoulder"] for kind, name in before if name == "Link1"} == {kind: id for (kind, name), id in before.items() if name == "Link1"}


def assembly(change: str) -> str:
    """The lever as FreeCAD's solver writes it with a loose cover beside it, changed."""
    text = (FIXTURES / "lever" / "lever.asmt").read_text(encoding="utf-8")
    start = text.index("\tParts\n") + len("\tParts\n")
    end = re.compile(r"^\t(?=\w)", re.MULTILINE).search(text, start).start()
    parts = re.split(r"(?=^\t\tPart\n)", text[start:end], flags=re.MULTILINE)[1:]
    cover = parts[-1].replace("lever#SliderD_1", "lever#Cover")
    parts.append(cover)
    if change == "reorder":
        parts.reverse()
    elif change == "insert":
        parts.insert(0, cover.replace("lever#Cover", "lever#Seal"))
    elif change == "delete":
        parts.remove(cover)
    elif change == "move":
        parts[-1] = re.sub(r"(\t\t\tPosition3D\n\s+)\S+", r"\g<1>25", cover, count=1)
    elif change == "rename":
        parts[-1] = cover.replace("lever#Cover", "lever#Lid")
    return text[:start] + "".join(parts) + text[end:]


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("change", ["reorder", "insert", "delete", "move", "rename"])
def test_parts_of_an_assembly_are_known_by_their_names(tmp_path: Path, change: str, target: str):
    texts = (assembly(""), assembly(change))
    assert texts[0] != texts[1]
    before, now = before_and_after(tmp_path / "lever.asmt", tmp_path / f"Lever.{target}", texts)
    gone = {name for _, name in before.keys() - now.keys()}
    assert gone == ({"Cover"} if change in ("delete", "rename") else set())
    assert {key: now[key] for key in before if key[1] not in gone} == {key: ids for key, ids in before.items() if key[1] not in gone}
    assert {name for _, name in now.keys() - before.keys()} == {"insert": {"Seal"}, "rename": {"Lid"}}.get(change, set())
    if change == "rename":
        assert {kind: now[kind, "Lid"] for kind, name in before if name == "Cover"} == {kind: ids for (kind, name), ids in before.items() if name == "Cover"}
