"""A mechanism stated by joints alone: what its constraints make rigid is welded by fixed joints."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from ...model import ConstraintKind, Coupling, Joint, JointKind, Scene, freedoms_of


def welded(
    scene: Scene,
    fixed: Iterable[tuple[int | None, int]],
    joints: Iterable[Joint],
    couplings: Sequence[Coupling],
) -> Scene:
    """``scene`` with these joints and couplings, and of its constraints only those that hold a part to the ground.

    scene: with middle bodies, at the closed pose.  fixed: pairs of nodes that constraints fix to each other (None: ground).
    """
    welds = [_weld(f"fixed:{i}", *pair, scene) for i, pair in enumerate(fixed)]
    grounds = [c for c in scene.constraints if c.kind is ConstraintKind.GROUND]
    return replace(
        scene, constraints=grounds, dof_records=[], joints=[*joints, *welds], couplings=list(couplings)
    )


def _weld(id: str, a: int | None, b: int, scene: Scene) -> Joint:
    frame_a, frame_b = (scene.pose(node).inverse() for node in (a, b))
    return Joint(id, JointKind.FIXED, a, b, frame_a, frame_b, freedoms_of(JointKind.FIXED))
