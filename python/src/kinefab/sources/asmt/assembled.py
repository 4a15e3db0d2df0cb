"""A list of the solver's joints brought into a scene: joints, constraints, and couplings between the joints."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from ...model import Joint, Scene
from ...rigid import rigid_groups
from ...spatial import Pose
from .constant_velocity import add_constant_velocity, turned_against
from .couplings import Bodies, UncarriedError, coupling_of
from .joints import (
    CONSTANT_VELOCITY,
    CONSTRAINTS,
    COUPLINGS,
    JOINTS,
    Statement,
    constraints_of,
    frames_together,
    is_open,
    joint_of,
    world,
)

UNCARRIED = "no part carries both sides by joints along their axes, so that there is nothing to count from"

Left = Callable[[Statement, str], None]
"""Told of a statement that is left out, and why."""


def add_statements(scene: Scene, statements: Iterable[Statement], left: Left) -> None:
    """Adds each statement's joint, constraint or coupling to the scene, whose nodes stand already."""
    statements = list(statements)
    poses = [node.pose for node in scene.nodes]
    for statement in statements:
        if statement.i.node == statement.j.node:
            left(statement, "both sides are the same part")
        elif statement.kind == "FixedJoint" and is_open(statement, poses):
            scene.constraints.append(frames_together(statement, poses))
        elif statement.kind in JOINTS:
            scene.joints.append(joint_of(statement, poses))
        elif statement.kind in CONSTRAINTS:
            scene.constraints += constraints_of(statement)
        elif statement.kind == CONSTANT_VELOCITY:
            _add_constant_velocity(scene, statement, poses, left)
    bodies = bodies_of(scene)
    joints: list[Joint] = list(scene.joints)
    for statement in statements:
        if statement.kind not in COUPLINGS or statement.i.node == statement.j.node:
            continue
        try:
            if statement.value == 0.0 or (statement.kind == "GearJoint" and statement.second == 0.0):
                left(statement, "a radius or pitch of it is zero")
            else:
                scene.couplings.append(coupling_of(statement, joints, bodies))
        except UncarriedError:
            left(statement, UNCARRIED)


def bodies_of(scene: Scene) -> Bodies:
    """Which of the scene's nodes are one body, for couplings to count from."""
    groups = rigid_groups(scene)
    ground = len(groups.members)
    of = [ground if groups.is_ground(node) else groups.group_of[node] for node in range(len(scene.nodes))]
    poses = [node.pose for node in scene.nodes]
    return Bodies(
        [ground + 1 + node if body is None else body for node, body in enumerate(of)], ground, poses
    )


def _add_constant_velocity(scene: Scene, statement: Statement, poses: Sequence[Pose], left: Left) -> None:
    i, j = statement.i, statement.j
    half = turned_against(world(i, poses).rotation.T @ world(j, poses).rotation)
    if half is None:
        left(
            statement,
            "its shafts are in line and their axes point one way, where the solver's equation has two meanings",
        )
        return
    other = Pose(j.frame.rotation @ half, j.frame.translation)
    add_constant_velocity(
        scene, statement.id, statement.name, ((i.node, i.frame), (j.node, other)), statement.where
    )
