"""An assembly of which nothing moves: told, with what holds it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from ...diagnostics import Report, named
from ...model import Constraint, ConstraintKind, Joint, JointKind, NodeKind, Scene
from ...rigid import active_nodes
from ..assembly.assemble import Assembly, assemble

MOST, WORK = 60, 10_000
"""Joints or constraints that are left out one by one, at most, to see which of them holds the rest; and statements that are
assembled for it in all, at most: it says why, and must not take longer than what it is about."""
SEARCHES = 1_000_000
"""Cubes of the unknowns of what is left without one and has to be searched for finite motions, summed: then no more are left out."""
HOLDING = frozenset({ConstraintKind.LOCK, ConstraintKind.GROUND})


def report_still(scene: Scene, assembly: Assembly, mobility: int, report: Report) -> None:
    """Tell that nothing moves where joints or constraints are stated.

    What holds it is what alone leaves the fewest freedoms, but some, when it is taken away: a fixed joint if one does, else
    anything.  What takes a part off all others says nothing.
    """
    stated = list(_statements(scene))
    if mobility or not stated or assembly.closing.contradictory:
        return
    active = active_nodes(scene)
    parts = sum(a and node.kind is NodeKind.PART for a, node in zip(active, scene.nodes))
    where = stated[0].where
    if all(_is_fixed(statement) for statement in stated):
        report.add("ALL_FIXED", where, parts=parts, names=named([s.id for s in stated]))
        return
    most = min(MOST, WORK // len(stated))
    left: dict[int, list[Joint | Constraint]] = {}
    all_tried = True
    for fixed in (True, False):
        tried = [s for s in stated if _is_fixed(s) is fixed]
        left, count = _left_without(scene, assembly.floating, tried[:most])
        all_tried = all_tried and len(tried) == count
        if left:
            break
    reason = "no single one of them holds it, so more than one is too many"
    if not all_tried:
        reason = "which of them hold it is not looked for among so many"
    if left:
        fewest, found = min(left.items())
        names = [f"{statement.id} ({statement.kind.value})" for statement in found]
        freedoms = "1 freedom is" if fewest == 1 else f"{fewest} freedoms are"
        reason = f"without {'any one of ' if len(names) > 1 else ''}{named(names)} {freedoms} left"
        where = found[0].where
    report.add("NOTHING_MOVES", where, parts=parts, count=len(stated), reason=reason)


def _statements(scene: Scene) -> Iterator[Joint | Constraint]:
    """What joins parts: couplings hold none still by themselves."""
    yield from (joint for joint in scene.joints if joint.enabled)
    yield from (constraint for constraint in scene.constraints if not constraint.suppressed)


def _is_fixed(statement: Joint | Constraint) -> bool:
    if isinstance(statement, Joint):
        return statement.kind is JointKind.FIXED
    return statement.kind in HOLDING


def _without(scene: Scene, statement: Joint | Constraint) -> Scene:
    joints = [joint for joint in scene.joints if joint is not statement]
    kept = {joint.id for joint in joints}
    return replace(
        scene,
        joints=joints,
        constraints=[constraint for constraint in scene.constraints if constraint is not statement],
        couplings=[coupling for coupling in scene.couplings if coupling.joints <= kept],
    )


def _left_without(
    scene: Scene, floating: int, statements: Sequence[Joint | Constraint]
) -> tuple[dict[int, list[Joint | Constraint]], int]:
    """The statements by how many freedoms are left without one; not those that leave none, nor a part that nothing holds.
    And how many were tried.

    floating: the scene's own islands that nothing joins to ground.
    """
    found: dict[int, list[Joint | Constraint]] = {}
    searched = 0
    for tried, statement in enumerate(statements):
        if searched > SEARCHES:
            return found, tried
        assembly = assemble(_without(scene, statement), Report())
        count = sum(finite.mobility for finite in assembly.finite)
        if count and assembly.floating == floating:
            found.setdefault(count, []).append(statement)
        searched += sum(len(finite.tangent) ** 3 for finite in assembly.finite if finite.singular)
    return found, len(statements)
