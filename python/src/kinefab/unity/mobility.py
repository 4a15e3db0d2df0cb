"""What the analysis found, in the scene file's terms."""

from __future__ import annotations

from typing import Any, Mapping, Sequence

from . import frames
from .numbers import rounded


def mobility_entry(found: Mapping[str, Any], object_of: Sequence[int]) -> dict[str, Any]:
    """The file's ``analysis``.

    found: by node number and in the right-handed frame, as ``analysis.summary.scene_entry`` gives it.
    object_of: for each node the index of its GameObject.
    """
    entry = {key: value for key, value in found.items() if key not in ("closureGap", "islands", "bodies")}
    entry["closureGap"] = rounded(dict(found["closureGap"]))
    entry["islands"] = [
        {"gameObjects": [object_of[node] for node in island["nodes"]]}
        | {key: value for key, value in island.items() if key != "nodes"}
        for island in found["islands"]
    ]
    entry["bodies"] = [
        {
            "gameObject": object_of[body["node"]],
            "translations": len(body["directions"]),
            "rotations": len(body["axes"]),
            "directions": [rounded(frames.direction(v)) for v in body["directions"]],
            "axes": [rounded(frames.axial(v)) for v in body["axes"]],
        }
        for body in found["bodies"]
    ]
    return entry
