"""Records how Python moves the first freedom of every fixture, for the Unity package to be held against.

``python tests/reference/unity_motion.py`` writes ``unity_motion.json``: of each fixture the coordinate, four of its values, and by the id of each
part with a Rigidbody its world pose at each (metres, a unit quaternion, in the file's left-handed frame). Other freedoms stand still.
Left out are turns of joints that turn about several axes, whose single angles are counted otherwise by the two halves.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import kinefab
import numpy as np
from kinefab.unity import frames

ROOT = Path(__file__).resolve().parents[2]
FRAMES = 4
STEP = {"deg": 18.0, "m": 0.009}
DECIMALS = 12


def turns_about_several(mechanism: kinefab.Mechanism, freedom: kinefab.Coordinate) -> bool:
    turns = [c for c in mechanism.coordinates if c.joint == freedom.joint and c.unit == "deg"]
    return freedom.unit == "deg" and len(turns) > 1


def recorded(path: Path) -> dict[str, Any] | None:
    mechanism = kinefab.motion(path)
    told = [freedom for freedom in mechanism.freedoms if not turns_about_several(mechanism, freedom)]
    if not told:
        return None
    driven = mechanism.coordinate(told[0].name)
    room = (driven.upper if np.isfinite(driven.upper) else np.inf) - driven.value
    motion = mechanism.sweep(driven.name, driven.value, driven.value + min(STEP[driven.unit], 0.9 * room), frames=FRAMES)
    if len(motion) < FRAMES:
        return None  # it starts at a dead point
    poses: dict[str, Any] = {}
    for entry in json.loads(path.read_text("utf-8"))["gameObjects"]:
        if any(component["type"] == "Rigidbody" for component in entry.get("components", ())):
            own = motion.part(entry["id"])
            pose = np.column_stack([frames.point(own[:, :3]), frames.quaternion(own[:, 3:])])
            poses[entry["id"]] = pose.round(DECIMALS).tolist()
    return {"coordinate": driven.name, "values": motion[driven.name].tolist(), "poses": poses}


def main() -> None:
    found = {
        path.relative_to(ROOT / "fixtures").as_posix(): motion
        for path in sorted((ROOT / "fixtures").rglob("*.kinefab"))
        if (motion := recorded(path)) is not None
    }
    lines = ",\n".join(f"{json.dumps(name)}: {json.dumps(motion, separators=(',', ':'))}" for name, motion in found.items())
    (Path(__file__).parent / "unity_motion.json").write_text(f"{{\n{lines}\n}}\n", encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
