"""The exported Unity components themselves: they allow what the constraints allow, and nothing more."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import unity_d6
from exported_components import components, constraint_residual, couplings, state_of, unity_pose
from kinefab.analysis import AnalysisOptions, Closures, analyse
from kinefab.model import Scene
from kinefab.spatial import Pose
from mechanism_cases import MINIMAL, all_ids, analysed, scene, scene_written
from strategies import random_pose

MOTIONS = 200
EXACT = 1e-9
REST = np.eye(3), np.zeros(3)
PAIRS = [id for id in all_ids() if id[0] == "P"]


def turned(source: Scene, by: Pose) -> Scene:
    return source.with_poses([by @ n.pose for n in source.nodes])


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
    reach = 0.4 * found.assembly.equations.length
    return max(constraint_residual(found, chained(scene, parts, rng, reach)) for _ in range(MOTIONS))


def written(id, how, rng):
    if how == "any pose":
        return analyse(turned(scene(id), random_pose(rng)), MINIMAL)
    up, *mirrored = how.split()
    return analysed(id) if how == "Y" else analyse(scene_written(id, up, bool(mirrored)), MINIMAL)


@pytest.mark.parametrize("how", ["Y", "Z", "X", "Z mirrored", "any pose"])
@pytest.mark.parametrize("id", PAIRS)
def test_component_moves_keep_the_constraints(id, how):
    """200 random finite motions of the component keep every constraint below 1e-9 of the size, whichever axis
    is up in the source, with left-handed parts too."""
    rng = np.random.default_rng(int(id[1:]))
    found = written(id, how, rng)
    if not found.joints:
        assert found.groups.together(0, 1)
        return
    scene_, parts = components(found)
    dof = sum(sum(unity_d6.freedoms(component)) for _, _, component in parts)
    screws = couplings(found)
    assert dof - len(screws) == found.mobility
    if not screws:  # a screw's component alone is a cylinder: see the next test
        assert worst_violation(found, parts, scene_, rng) < EXACT


@pytest.mark.parametrize("lead", [0.05, -0.03])
@pytest.mark.parametrize("how", ["Y", "Z", "X", "Z mirrored", "any pose"])
def test_screw_and_its_coupling_keep_the_constraint_over_three_turns(how, lead):
    """q_b = ratio q_a + offset (SPEC 5), each q of the own body against the connected one by the left-hand rule about,
    or along, the joint's axis (SPEC 4): so moved, to either side, the part stays on the screw's own constraint."""
    up, *mirrored = how.split()
    source = scene_written("P22", up, bool(mirrored)) if how != "any pose" else scene("P22")
    source = replace(source, constraints=[replace(c, value=lead) for c in source.constraints])
    if how == "any pose":
        source = turned(source, random_pose(np.random.default_rng(22)))
    found = analyse(source)
    scene_, ((own, connected, component),) = components(found)
    (coupling,) = couplings(found)
    assert (coupling.terms[0].coordinate.coordinate, coupling.coordinate.coordinate) == ("angularX", "x")
    frame, anchor = unity_d6.frame(component)
    rotation, translation = unity_pose(scene_, own)
    axis, point = rotation @ frame[:, 0], rotation @ anchor + translation
    system, body = found.assembly.closing.system, found.assembly.closing.body
    size = found.assembly.equations.length
    system.length[:], system.row_length[:] = size, size
    for step in (0.1, -0.1):
        last = system.start()
        for k in range(1, 201):
            angle = k * step
            travel = coupling.terms[0].ratio * np.degrees(angle) + coupling.offset
            turn = unity_d6.any_turn(angle * axis)
            moved = turn, point + travel * axis - turn @ point
            assert (
                np.abs(
                    unity_d6.broken(
                        component, (rotation, translation), unity_pose(scene_, connected), moved, REST
                    )
                ).max()
                < EXACT
            )
            state = state_of(found, system, body, {own: unity_d6.mirrored(*moved), connected: REST})
            state.angle = last.angle
            assert np.abs(system.residual(state)).max() < EXACT
            system.remember(state)
            last = state
        assert abs(abs(travel) - 20.0 / (2.0 * np.pi) * abs(lead)) < EXACT


@pytest.mark.parametrize("id", PAIRS)
def test_component_is_the_same_from_either_up_axis(id):
    """A pair written with +Z up and with +Y up gives the same Unity component."""
    (_, expected), (_, got) = components(analysed(id)), components(analyse(scene_written(id, "Z"), MINIMAL))
    assert len(expected) == len(got)
    for (*bodies, one), (*others, other) in zip(expected, got):
        assert bodies == others and one.keys() == other.keys() and one["type"] == other["type"]
        for key, value in one.items():
            numeric = isinstance(value, (float, list, tuple, np.ndarray)) and key != "because"
            assert np.allclose(value, other[key], atol=1e-9) if numeric else value == other[key]


@pytest.mark.parametrize("id", ["M09", "M14", "M21", "M32", "M35"])
def test_tree_joints_of_mechanisms_keep_their_own_constraints(id):
    """Each component of a mechanism's tree keeps the constraints of its own pair, however the rest moves."""
    rng = np.random.default_rng(9)
    found = analyse(scene(id), AnalysisOptions(closures=Closures.EXACT))
    scene_, parts = components(found)
    tree = [(part, joint) for part, joint in zip(parts, found.joints) if not found.findings[joint.id].closure]
    named = {name for _, joint in tree for name in joint.because}
    system, body = found.assembly.closing.system, found.assembly.closing.body
    statements = found.assembly.equations.statements
    rows = np.array([statements[o].id in named for o in system.owner])
    for _ in range(20):
        moved = chained(scene_, [part for part, _ in tree], rng, 0.1)
        state = state_of(found, system, body, moved)
        assert np.abs(system.residual(state)[rows]).max() < EXACT
