"""A mechanism that can be driven, from a source or a scene made in a script."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

from .analysis import Analysis, analyse
from .analysis.driving.coordinates import Driven
from .analysis.driving.mechanism import Mechanism
from .analysis.driving.trajectory import Branching, Coordinate, Stop, Trajectory
from .analysis.joints.dof_records import joints_of_dof_records
from .analysis.joints.stated_limits import check_limits
from .analysis.joints.welding import welded
from .diagnostics import Report
from .model import Scene
from .rigid import rigid_groups
from .unity.back.restored import restored
from .unity.back.scene_file import read_scene

__all__ = ["Branching", "Coordinate", "Mechanism", "Stop", "Trajectory", "mechanism_of", "motion"]


def motion(source: str | Path | Scene) -> Mechanism:
    """The mechanism of a source, found and ready to be driven.

    source: a file that a reader of ``kinefab.sources`` knows, a written ``NAME.kinefab``, or a Scene made in code; treated
    as read-only.  A written scene moves by its joints, in the right-handed frame; its parts are the Rigidbodies.
    Raises KinefabError, with every error found, when the data is wrong, TypeError for a source that is none.

    >>> import kinefab, trimesh
    >>> scene = kinefab.Scene()
    >>> door = scene.add_part("Door", trimesh.creation.box((0.8, 2.0, 0.04)), translation=(0.4, 1.0, 0.0))
    >>> hinge = scene.add_hinge(None, door, point=(0, 1, 0), axis=(0, 1, 0), limits=(0, 110), name="Hinge")
    >>> mechanism = kinefab.motion(scene)
    >>> mechanism.mobility, mechanism.parts
    (1, ('Door',))
    """
    report = Report()
    check_source(source)
    if isinstance(source, Scene):
        scene = source
    elif Path(source).suffix.lower() == ".kinefab":
        scene = restored(read_scene(Path(source))[0]).scene
    else:
        from .sources import read

        scene = read(Path(source), report)
    scene = scene.with_disabled_apart()
    check_limits(scene, report)
    report.raise_for_errors()
    records = joints_of_dof_records(scene, rigid_groups(scene), report)
    found = analyse(replace(scene, joints=[*scene.joints, *records]))
    found.report.raise_for_errors()
    return mechanism_of(found)


def check_source(source: object) -> None:
    """Raises TypeError for what is none."""
    if not isinstance(source, (str, os.PathLike, Scene)):
        raise TypeError(f"the source is {source!r}; pass a file's path or a kinefab.Scene")


def mechanism_of(found: Analysis) -> Mechanism:
    """What an analysis found, ready to be driven.

    Where a relation needs two joints and a body between them, the mechanism is that of the joints.
    """
    if found.nodes:
        found = analyse(welded(found.scene(solved=True), found.fixed, found.joints, found.couplings))
    return Mechanism(found.assembly, Driven.of(found.joints, found.findings), found.scene(solved=True))
