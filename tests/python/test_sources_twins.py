"""One mechanism in several formats becomes the same scene, number by number (``fixtures/twins``)."""

from __future__ import annotations

import json
from pathlib import Path

import kinefab
import numpy as np
import pytest

TWINS = Path(__file__).parents[2] / "fixtures" / "twins"
TREES = ("urdf",)
"""Formats that hold no loop."""
LOOPS = ("sdf", "xml")
"""Formats that hold them."""
CLOSE = 1e-9


def exported(path: Path, folder: Path) -> dict:
    target = kinefab.export(path, folder / f"{path.name}.kinefab").path
    return json.loads(target.read_text(encoding="utf-8"))


def plain(document: dict, without: set[str]) -> dict[str, object]:
    """What a scene says by the object's id: its place, its body, its joints by the source's name of them."""
    found: dict[str, object] = {}
    objects = document["gameObjects"]
    for entry in objects:
        found[entry["id"]] = entry.get("transform", {})
        parent = entry.get("parent")
        found[f"{entry['id']} parent"] = None if parent is None else objects[parent]["id"]
        for component in entry.get("components", ()):
            if not without.intersection(component.get("because", ())):
                name = "".join(component.get("because", ()))
                found[f"{entry['id']} {component['type']} {name}"] = stripped(component, objects)
    for coupling in document.get("couplings", ()):
        name = coupling["id"].rpartition(":")[2].rpartition("/")[2]  # SDF's ids name the model too
        found[f"coupling of {name}"] = (coupling["ratio"], coupling.get("offset", 0.0))
    return found


def stripped(component: dict, objects: list[dict]) -> dict[str, object]:
    """Without what no motion depends on: the source's own words, and where a slide's second axis points to."""
    kept = {k: v for k, v in component.items() if k not in ("extras", "secondaryAxis", "closure", "because")}
    if "connectedBody" in kept:
        kept["connectedBody"] = objects[kept["connectedBody"]]["id"]
    return kept


def compare(one: object, other: object, where: str) -> None:
    if isinstance(one, dict) and isinstance(other, dict):
        assert one.keys() == other.keys(), where
        for key, value in one.items():
            compare(value, other[key], f"{where}/{key}")
    elif isinstance(one, (list, tuple)) and isinstance(other, (list, tuple)):
        assert np.allclose(one, other, rtol=CLOSE, atol=CLOSE), f"{where}: {one}, {other}"
    elif isinstance(one, float) or isinstance(other, float):
        assert one == pytest.approx(other, rel=CLOSE, abs=CLOSE), where
    else:
        assert one == other, where


@pytest.mark.parametrize("ending", [*TREES, *LOOPS])
@pytest.mark.parametrize("name", ["lever", "arm", "fourbar"])
def test_a_twin_is_the_same_scene(tmp_path, name, ending):
    """Against the CAD bundle; what a tree leaves out, the joint that closes the loop, is left out of both."""
    bundle = TWINS / f"{name}.bundle.json"
    if ending in TREES:
        values = json.loads(bundle.read_text(encoding="utf-8"))
        values["joints"] = [j for j in values["joints"] if j["name"] not in ("Gudgeon", "Closing pin")]
        bundle = tmp_path / f"{name}.bundle.json"
        bundle.write_text(json.dumps(values), encoding="utf-8")
    expected = plain(exported(bundle, tmp_path), set())
    compare(expected, plain(exported(TWINS / f"{name}.{ending}", tmp_path), set()), name)


def test_the_folder_is_what_its_script_writes(tmp_path, monkeypatch):
    import runpy
    import shutil

    shutil.copytree(TWINS, tmp_path / "twins")
    (tmp_path / "lever").mkdir()
    monkeypatch.syspath_prepend(str(tmp_path / "twins"))
    runpy.run_path(str(tmp_path / "twins" / "make.py"), run_name="__main__")
    for path in sorted([*TWINS.glob("*.json"), *TWINS.glob("*.urdf"), *TWINS.glob("*.sdf")]):
        assert (tmp_path / "twins" / path.name).read_text("utf-8") == path.read_text("utf-8"), path.name
    written = sorted((tmp_path / "lever").iterdir())
    assert written and all(
        p.read_text("utf-8") == (TWINS.parent / "lever" / p.name).read_text("utf-8") for p in written
    )
