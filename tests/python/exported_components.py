"""The Unity components of an analysed scene, and what the source's constraints say of moved bodies."""

from __future__ import annotations

import numpy as np
import unity_d6
from kinefab.diagnostics import Report
from kinefab.rigid import rigid_groups
from kinefab.unity.joints.couplings import map_coupling, screw_couplings
from kinefab.unity.joints.mapping import map_joint
from unity_entries import entry_of


def components(found):
    """(node of the own body, node of the connected one or None, component) of every joint that has one: none has one
    inside a rigid group."""
    return found.scene(), [(m.owner, m.connected, entry_of(m.component)) for m in _mapped(found)]


def couplings(found):
    """Every coupling as the scene file has it; a coordinate's component is the number of its joint."""
    mapped = _mapped(found)
    numbered = {m.source.id: (m, i) for i, m in enumerate(mapped)}
    scene = found.scene()
    stated = [*scene.couplings, *screw_couplings(mapped, scene.couplings)]
    return [map_coupling(c, numbered, range(len(scene.nodes)), Report()) for c in stated]


def _mapped(found):
    scene = found.scene()
    groups = rigid_groups(scene, found.fixed)
    carrier = lambda node: groups.members[groups.group_of[node]][0]  # noqa: E731
    mapped = (map_joint(j, scene, groups, carrier, Report(), found.findings[j.id]) for j in found.joints)
    return [m for m in mapped if m is not None]


def unity_pose(scene, node):
    return (
        (np.eye(3), np.zeros(3))
        if node is None
        else unity_d6.mirrored(scene.pose(node).rotation, scene.pose(node).translation)
    )


def constraint_residual(found, moved):
    """Largest residual of the constraints with the nodes displaced so (right-handed), fraction of the size."""
    system, body = found.assembly.closing.system, found.assembly.closing.body
    system.length = np.full(system.bodies, found.assembly.equations.length)
    system.row_length = np.full(system.rows, found.assembly.equations.length)
    return float(np.abs(system.residual(state_of(found, system, body, moved))).max(initial=0.0))


def state_of(found, system, body, moved):
    state, nodes = system.start(), len(found.source.nodes)
    named = [
        n for n in moved if n is not None and n < nodes
    ]  # a middle body has no constraints of the source
    for node in range(nodes):
        own = next((n for n in named if found.groups.together(n, node)), None)
        if own is not None and body[node + 1]:
            i = int(body[node + 1])
            state.rotation[i], t = moved[own]
            state.shift[i] = t + state.rotation[i] @ system.center[i] - system.center[i]
    return state
