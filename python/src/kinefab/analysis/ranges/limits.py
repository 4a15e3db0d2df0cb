"""Real limits: how far each joint can go before a dead point or another joint's limit.

A joint's range is what its coordinate can reach while all other freedoms of its mechanism move as they may: the
widest range there is, so that a limit written from it forbids no motion that the constraints allow.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

from ...diagnostics import Report
from ...model import RX, JointKind, Motion, Scene
from ..assembly.assemble import Assembly
from ..joints.links import Link
from .curve import Curve
from .measured import Measured
from .reach import Reach

MOST_WORK = 2e7
"""Joints times the cube of their mechanism's unknowns (6 a part) up to which a mechanism of several freedoms is
searched: about half a minute."""


@dataclass(frozen=True, slots=True)
class JointRange:
    """What a joint's coordinate can reach, metres or radians, counted as the joint's own limits are: from where
    its frames meet, which need not be the exported pose.

    Infinite where the joint turns all the way round or slides without end.  displayed: both ends as the source
    shows them, which may be whole turns further.
    """

    joint: str
    freedom: int
    lower: float
    upper: float
    displayed: tuple[float, ...]

    @property
    def endless(self) -> bool:
        return math.isinf(self.lower) and math.isinf(self.upper)


def found_ranges(
    assembly: Assembly,
    links: list[Link],
    scene: Scene,
    report: Report,
    progress: Callable[[float], None] = lambda done: None,
) -> list[JointRange]:
    """Ranges of all hinges and slides that close no loop.

    scene: with middle bodies, at the closed pose.  progress: called with the share of the joints searched.
    """
    ranges: list[JointRange] = []
    by_block = _by_block(assembly, links)
    total, done = len(_swept(links)), 0
    for part, first in enumerate(assembly.freedoms):
        inside = by_block.get(int(assembly.blocks.block[first.bodies[0]]), [])
        swept = [(link, freedom) for link, freedom in _swept(inside) if not link.finding.closure]
        for link, freedom, ends in _ranges_in(assembly, part, inside, swept, scene):
            if isinstance(ends, str):
                report.add("LIMITS_NOT_SWEPT", link.joint.where, joint=link.joint.id, detail=ends)
            else:
                displayed = link.joint.freedoms[freedom].displayed_range(*ends)
                ranges.append(JointRange(link.joint.id, freedom, *ends, displayed))
            done += 1
            progress(done / total)
    return ranges


def _ranges_in(
    assembly: Assembly, part: int, inside: list[Link], swept: list[tuple[Link, int]], scene: Scene
) -> Iterator[tuple[Link, int, tuple[float, float] | str]]:
    """Of each of a block's ``swept`` links and freedoms the ends of its range, or why it has none.

    part: the block's number among ``Assembly.freedoms``.  inside: all links in the block.
    """
    bodies, mobility = len(assembly.freedoms[part].bodies), assembly.finite[part].mobility
    if not swept:
        return
    if bodies == 1 and mobility == 1:  # a joint in no loop: nothing but its own limits
        for link, freedom in swept:
            own = link.joint.freedoms[freedom]
            yield (
                link,
                freedom,
                (own.lower, own.upper) if own.motion is Motion.LIMITED else (-math.inf, math.inf),
            )
        return
    if mobility == 0:
        yield from ((*own, "its mechanism cannot move") for own in swept)
        return
    if mobility > 1 and len(swept) * (6.0 * bodies) ** 3 > MOST_WORK:
        size = f"its mechanism has {mobility} freedoms and {bodies} parts, which would take minutes"
        yield from ((*own, size) for own in swept)
        return
    coordinates = list(swept)
    coordinates += [(l, f) for l in inside for f in _limited(l) if (l, f) not in coordinates]
    block = Measured(assembly, part, coordinates, scene)
    lost = "its mechanism was lost at a singular pose"
    if mobility == 1:
        curve = Curve(block)
        found = curve.ranges()
        for i, own in enumerate(swept):
            if found is not None:
                yield *own, (float(found[0][i]), float(found[1][i]))
            elif curve.stopped:
                yield *own, _stopped(*own, curve.steps, (float(curve.low[i]), float(curve.high[i])))
            else:
                yield *own, lost
        return
    reach = Reach(block)
    for i, own in enumerate(swept):
        yield (
            *own,
            reach.range_of(i) or (_stopped(*own, reach.steps, reach.seen) if reach.stopped else lost),
        )


def _stopped(link: Link, freedom: int, steps: int, seen: tuple[float, float]) -> str:
    """How far the search had come where it stopped."""
    unit, factor = ("degrees", math.degrees(1.0)) if freedom >= RX else ("m", 1.0)
    low, high = (end * factor for end in link.joint.freedoms[freedom].displayed_range(*seen))
    return f"the search stopped after {steps} steps, having come from {low:.6g} to {high:.6g} {unit}"


def _by_block(assembly: Assembly, links: list[Link]) -> dict[int, list[Link]]:
    """The links between the assembly's own bodies, by the block they are in."""
    found: dict[int, list[Link]] = {}
    for link in links:
        if max(link.a, link.b) < len(assembly.blocks.block):
            found.setdefault(assembly.blocks.of_pair(link.a, link.b), []).append(link)
    return found


def _limited(link: Link) -> list[int]:
    """The freedoms with a limit that can be measured while the joint moves: slides, and its only rotation."""
    freedoms = link.joint.freedoms
    turns = [i for i in link.joint.unlocked if i >= RX]
    return [i for i, f in enumerate(freedoms) if f.motion is Motion.LIMITED and (i < RX or len(turns) == 1)]


def with_found_ranges(
    assembly: Assembly, links: list[Link], ranges: list[JointRange], report: Report
) -> list[Link]:
    """The links with the ranges of the joints on each block's root as limits, where the source has none."""
    by_id = {(r.joint, r.freedom): r for r in ranges}
    roots = {int(r) for r in assembly.blocks.root}
    result: list[Link] = []
    for link in links:
        freedom = _single(link)
        found = None if freedom is None else by_id.get((link.joint.id, freedom))
        if freedom is None or found is None or found.endless or not (link.a in roots or link.b in roots):
            result.append(link)
            continue
        unit, factor = ("degrees", math.degrees(1.0)) if freedom >= RX else ("m", 1.0)
        report.add(
            "LIMITS_FOUND",
            link.joint.where,
            joint=link.joint.id,
            unit=unit,
            lower=f"{found.displayed[0] * factor:.6f}",
            upper=f"{found.displayed[1] * factor:.6f}",
        )
        freedoms = list(link.joint.freedoms)
        old = freedoms[freedom]
        lower, upper = max(found.lower, old.lower), min(found.upper, old.upper)
        if lower <= upper:  # else the mechanism cannot come into the source's range, which stays as it is
            freedoms[freedom] = replace(old, motion=Motion.LIMITED, lower=lower, upper=upper)
        result.append(link.changed(freedoms=tuple(freedoms)))
    return result


def _swept(links: list[Link]) -> list[tuple[Link, int]]:
    """The hinges and slides, each with its freedom."""
    return [(link, freedom) for link in links if (freedom := _single(link)) is not None]


def _single(link: Link) -> int | None:
    """The freedom of a hinge or slide, or None."""
    if link.joint.kind not in (JointKind.REVOLUTE, JointKind.PRISMATIC):
        return None
    return link.joint.unlocked[0]
