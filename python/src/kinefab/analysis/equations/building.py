"""All constraints' equations, those that are alike built as one stack."""

from __future__ import annotations

from collections.abc import Hashable

import numpy as np

from ...diagnostics import Report
from ...model import Constraint, ConstraintKind, FeatureKind
from ...spatial import IntArray
from .bounded import is_bounded
from .constraints import Context, build, build_stack, pair_of, stack_of
from .features import Sides, UnknownPairing
from .rows import Rows

MEASURES = (ConstraintKind.DISTANCE, ConstraintKind.ANGLE)
"""Constraints that state nothing but a measure, so that nothing is left where it is only bounded."""
AXIS_MAKERS = (ConstraintKind.COINCIDENT, ConstraintKind.CONCENTRIC, ConstraintKind.INSERT)


def constraint_rows(
    rows: Rows, constraints: list[Constraint], sides: Sides, context: Context, report: Report
) -> None:
    """Equations of all constraints, the alike ones in stacks; those that have none are reported.

    sides: their features, one constraint's after the other's.
    """
    counts = np.array([len(c.features) for c in constraints], dtype=np.int64)
    starts = np.cumsum(counts) - counts
    first: list[int] = starts.tolist()
    looks = list(zip((f.kind for f in sides.features), sides.framed.tolist()))
    single: list[int] = []
    stacks: dict[Hashable, list[int]] = {}
    for i, (constraint, at, count) in enumerate(zip(constraints, first, counts.tolist())):
        key = stack_of(constraint, tuple(looks[at : at + count]))
        (single if key is None else stacks.setdefault(key, [])).append(i)
    own = {
        i: [sides.one(k) for k in range(first[i], first[i] + len(constraints[i].features))] for i in single
    }
    if any(constraints[i].kind is ConstraintKind.ANGLE for i in single):
        _note_axes(constraints, sides, starts, context)
    unknown: list[int] = []
    for i in single:
        rows.owner = i
        try:
            build(rows, constraints[i], own[i], context)
        except UnknownPairing:
            unknown.append(i)
    for members in stacks.values():
        rows.owner = np.array(members)
        stacked = [sides.stack(starts[members] + k) for k in range(int(counts[members[0]]))]
        try:
            build_stack(rows, [constraints[i] for i in members], stacked, context)
        except UnknownPairing:
            unknown += members
    noted = {own.constraint.id for own in context.ranges}
    for i in single:
        constraint = constraints[i]
        if is_bounded(constraint) and constraint.id not in noted:
            tell = report.dropped if constraint.kind in MEASURES else report.approximated
            tell(
                f"constraint {constraint.id}", "CONSTRAINT_RANGE_DROPPED", constraint.where, id=constraint.id
            )
    for constraint in (constraints[i] for i in sorted(unknown)):
        report.dropped(
            f"constraint {constraint.id}",
            "CONSTRAINT_PAIRING_UNKNOWN",
            constraint.where,
            id=constraint.id,
            kind=constraint.kind.value,
            features=" and ".join(f.kind.value for f in constraint.features),
        )


def _note_axes(constraints: list[Constraint], sides: Sides, starts: IntArray, context: Context) -> None:
    pointed = (FeatureKind.POINT, FeatureKind.SPHERE, FeatureKind.PLANE, FeatureKind.BODY)
    for constraint, at in zip(constraints, starts.tolist()):
        if constraint.kind in AXIS_MAKERS and not any(f.kind in pointed for f in constraint.features[:2]):
            a, b = sides.one(at), sides.one(at + 1)
            context.axes.setdefault(pair_of(a, b), []).append(a.z)
