"""What a user asks about mates when a file is read: none, those found, or those of a file.

What finds and reads them is imported where they are asked for: few exports do, and all would wait for it.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from ..diagnostics import Report
from ..model import Scene
from .mate import Mates


def mated(scene: Scene, asked: Mapping[str, object], report: Report) -> Scene:
    """The scene with the mates asked for; where none are, and the scene states nothing that moves, that is told.

    asked: the source's options; ``mates`` ("auto" or a path) and ``ground`` are looked at.
    Raises KinefabError for a mates file that is wrong or not there.
    """
    choice, ground = str(asked.get("mates", "")), str(asked.get("ground", ""))
    if choice == "auto":
        from .apply import with_found

        return with_found(scene, found_mates(scene, ground, report), report)
    if choice:
        from .mates_file import with_file

        return with_file(scene, Path(choice), report)
    silent = not (scene.joints or scene.constraints or scene.dof_records)
    exact = sum(any(body.boundary for body in node.bodies) for node in scene.nodes)
    if silent and exact > 1:
        report.add("MATES_NOT_ASKED", scene.source.uri, count=exact)
    return scene


def found_mates(scene: Scene, ground: str, report: Report) -> Mates:
    """The mates found in the scene's geometry, as ``find_mates`` has them; told where no part is called like the ground."""
    from .find import find_mates

    found = find_mates(scene, ground)
    if ground and found.ground is not None and found.ground_reason != "named":
        report.add("GROUND_UNKNOWN", scene.source.uri, part=ground)
    return found
