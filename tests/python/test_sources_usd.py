"""USD stages: bodies, joints and units become the scene that a CAD bundle of the same mechanism gives."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import kinefab
import numpy as np
import pytest
import scenes

pytest.importorskip("pxr", reason="usd-core is not installed")

LEVER = Path(__file__).resolve().parents[2] / "fixtures" / "lever"
TWINS = {
    "Lever/Crank_1": "Lever/Crank:1",
    "Lever/BarC_1": "Lever/BarC:1",
    "Lever/SliderD_1": "Lever/SliderD:1",
}
BECAUSE = {
    "Lever/Shaft": "Insert:1",
    "Lever/Pin": "Insert:4",
    "Lever/Gudgeon": "Insert:5",
    "Lever/Slide": "Mate:1",
}


def moving(content: dict) -> dict[str, dict]:
    """Rigidbody and joints of each GameObject that has one, by its id; joints by the first thing they come from."""
    found = {}
    for entry in content["gameObjects"]:
        parts = {c["type"]: c for c in entry.get("components", ()) if c["type"] == "Rigidbody"}
        parts |= {c["because"][0]: c for c in entry.get("components", ()) if c["type"].endswith("Joint")}
        if parts:
            found[entry["id"]] = parts
    return found


def test_the_lever_is_the_bundle_s_lever(tmp_path):
    """The twin: masses from densities of closed meshes, joints from frames, one by one the same numbers."""
    bundle = json.loads((LEVER / "lever.bundle.json").read_text("utf-8"))
    bundle["meta"]["forward"] = "X"  # a stage with Z up looks along X
    (tmp_path / "lever.bundle.json").write_text(json.dumps(bundle), "utf-8")
    for mesh in ("lever.obj", "lever.mtl"):
        shutil.copy(LEVER / mesh, tmp_path)
    for source in (tmp_path / "lever.bundle.json", LEVER / "lever.usda"):
        world = kinefab.ExportOptions(ground="world")
        kinefab.export(source, tmp_path / f"{source.name}.kinefab", world)
    cad, usd = (scenes.read(tmp_path / f"{name}.kinefab") for name in ("lever.bundle.json", "lever.usda"))
    expected, given = moving(cad), moving(usd)
    assert {TWINS[name] for name in given} == set(expected)
    assert usd["analysis"]["mobility"] == cad["analysis"]["mobility"] == 1
    for name, parts in given.items():
        for key, fields in parts.items():
            other = expected[TWINS[name]][BECAUSE.get(key, key)]
            fields, other = (
                {k: v for k, v in c.items() if k not in ("because", "connectedBody")} for c in (fields, other)
            )
            assert fields.keys() | {"inertiaTensorRotation"} == other.keys() | {"inertiaTensorRotation"}
            for field in fields.keys() & other.keys():
                if isinstance(fields[field], (float, int, list)) and not isinstance(fields[field], bool):
                    # The bundle's meshes have six digits after the point, in centimetres.
                    assert np.allclose(fields[field], other[field], rtol=2e-6, atol=1e-6), (name, key, field)
                else:
                    assert fields[field] == other[field], (name, key, field)
