"""The exported Unity components themselves: they allow what the constraints allow, and nothing more."""

from __future__ import annotations

import numpy as np
import pytest
import unity_d6
from mechanism_cases import all_ids, analysed, scene
from strategies import random_pose

from kinefab.analysis import AnalysisOptions, Closures, analyse
from kinefab.diagnostics import Report
from kinefab.model import Scene
from kinefab.rigid import rigid_groups
from kinefab.spatial import Pose
from kinefab.unity.joints import map_joint

MOTIONS = 200
EXACT = 1e-9
PAIRS = [id for id in all_ids() if id[0] == "P"]


def turned(source: Scene, by: Pose) -> Scene:
    return source.with_poses([by @ n.pose for n in source.nodes])


def components(found):
    """(node of the own body, node of the connected one or None, component) of every joint."""
    scene = found.scene()
    groups = rigid_groups(scene, found.fixed)
    carrier = lambda node: groups.members[groups.group_of[node]][0]  # noqa: E731
    mapped = [map_joint(j, scene, groups, carrier, Report()) for j in found.joints]
    return scene, [(m.owner, m.connected, m.component) for m in mapped]


def unity_pose(scene, node):
    return (
        (np.eye(3), np.zeros(3))
        if node is None
        else unity_d6.mirrored(scene.pose(node).rotation, scene.pose(node).translation)
    )


def chained(scene, parts, rng, reach):
    """Displacements (right-handed) of the nodes, ground at rest, with every component moved at random."""
    moved = {None: (np.eye(3), np.zeros(3))}
    waiting = list(parts)
    while waiting:
        left = []
        for own, connected, component in waiting:
            if (own in moved) == (connected in moved):
                left.append((own, connected, component))
                continue
            step = unity_d6.displaced(
                component, unity_pose(scene, own), unity_pose(scene, connected), rng, reach
            )
            r, t = unity_d6.mirrored(*step)
            if own in moved:  # the connected body moves the other way
                own_r, own_t = moved[own]
                moved[connected] = own_r @ r.T, own_t - own_r @ r.T @ t
            else:
                base_r, base_t = moved[connected]
                moved[own] = base_r @ r, base_r @ t + base_t
        assert len(left) < len(waiting)
        waiting = left
    return moved


def worst_violation(found, parts, scene, rng):
    """Largest residual of the constraints over random motions of the components, fraction of the size."""
    system = found.assembly.closing.system
    body = found.assembly.closing.body
    system.length = np.full(system.bodies, found.assembly.equations.length)
    system.row_length = np.full(system.rows, found.assembly.equations.length)
    worst = 0.0
    for _ in range(MOTIONS):
        moved = chained(scene, parts, rng, 0.4 * found.assembly.equations.length)
        state = system.start()
        for node, (r, t) in moved.items():
            if node is not None and node < len(found.source.nodes) and body[node + 1]:
                i = int(body[node + 1])
                state.rotation[i] = r
                state.shift[i] = t + r @ system.center[i] - system.center[i]
        worst = max(worst, float(np.abs(system.residual(state)).max(initial=0.0)))
    return worst


@pytest.mark.parametrize("turn", ["as drawn", "any pose"])
@pytest.mark.parametrize("id", PAIRS)
def test_component_moves_keep_the_constraints(id, turn):
    """200 random finite motions of the component keep every constraint below 1e-9 of the size."""
    rng = np.random.default_rng(int(id[1:]))
    found = analysed(id) if turn == "as drawn" else analyse(turned(scene(id), random_pose(rng)))
    if not found.joints:
        assert found.groups.together(0, 1)
        return
    scene_, parts = components(found)
    dof = sum(sum(unity_d6.freedoms(component)) for _, _, component in parts)
    screw = sum(j.lead != 0.0 for j in found.joints)
    assert dof - screw == found.mobility
    if not screw:  # a screw's component is a cylinder; its coupling is a script's
        assert worst_violation(found, parts, scene_, rng) < EXACT


@pytest.mark.parametrize("id", ["M09", "M14", "M21", "M32", "M35"])
def test_tree_joints_of_mechanisms_keep_their_own_constraints(id):
    """Each component of a mechanism's tree keeps the constraints of its own pair, however the rest moves."""
    rng = np.random.default_rng(9)
    found = analyse(scene(id), AnalysisOptions(closures=Closures.EXACT))
    scene_, parts = components(found)
    tree = [(part, joint) for part, joint in zip(parts, found.joints) if not joint.closure]
    named = {name for _, joint in tree for name in joint.because}
    system, body = found.assembly.closing.system, found.assembly.closing.body
    statements = found.assembly.equations.statements
    rows = np.array([statements[o].id in named for o in system.owner])
    for _ in range(20):
        moved = chained(scene_, [part for part, _ in tree], rng, 0.1)
        state = system.start()
        for node in range(len(found.source.nodes)):
            own = next((n for n in moved if n is not None and found.groups.together(n, node)), None)
            if own is not None and body[node + 1]:
                i = int(body[node + 1])
                state.rotation[i], t = moved[own]
                state.shift[i] = t + state.rotation[i] @ system.center[i] - system.center[i]
        assert np.abs(system.residual(state)[rows]).max() < EXACT
