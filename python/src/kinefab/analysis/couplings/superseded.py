"""Couplings that count from a joint of which another one between the same bodies took the place."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from ...diagnostics import Report
from ...model import RX, Coupling, Joint, Scene, Term
from ..assembly.assemble import Assembly
from ..joints.links import Link
from .standing import counted_from
from .stated import by_pair_of


def on_links(
    assembly: Assembly, links: Sequence[Link], couplings: Sequence[Coupling], scene: Scene, report: Report
) -> list[Coupling]:
    """The couplings, each counted from the joints that are left, where these have the same coordinate.  scene: at the closed pose."""
    by_id = {link.joint.id: link for link in links}
    by_pair = by_pair_of(list(links))
    stated = {joint.id: joint for joint in assembly.scene.joints}
    found: list[Coupling] = []
    for coupling in couplings:
        ends = [Term(coupling.joint, coupling.freedom, -1.0), *coupling.terms]
        on = [_on_a_link(assembly, by_id, by_pair, stated, end, scene) for end in ends]
        if on == ends or not all(end.joint in by_id for end in on):
            found.append(coupling)
        elif len(summed := _summed(on)) > 1:
            found.append(counted_from(coupling, summed, by_id, scene))
        else:  # of one coordinate: it holds that one, or says nothing
            told = {"coupling": coupling.id, "joints": ", ".join(sorted(coupling.joints))}
            report.kept(f"coupling {coupling.id}", coupling.where, "COUPLING_HELD", **told)
    return found


def _summed(ends: Sequence[Term]) -> list[Term]:
    """The ends with those of one coordinate added up, without what cancels."""
    sums: dict[tuple[str, int], float] = {}
    for end in ends:
        slot = (end.joint, end.freedom)
        sums[slot] = sums.get(slot, 0.0) + end.ratio
    return [Term(*slot, ratio) for slot, ratio in sums.items() if ratio]


def _on_a_link(
    assembly: Assembly,
    by_id: Mapping[str, Link],
    by_pair: Mapping[frozenset[int], list[Link]],
    stated: Mapping[str, Joint],
    end: Term,
    scene: Scene,
) -> Term:
    """The end on the link that took its joint's place, or as it is."""
    joint = stated.get(end.joint)
    if end.joint in by_id or joint is None:
        return end
    bodies = assembly.body_of(joint.a), assembly.body_of(joint.b)
    direction = (scene.pose(joint.a) @ joint.frame_a).rotation[:, end.freedom % 3]
    for link in by_pair.get(frozenset(bodies), []) if bodies[0] != bodies[1] else []:
        found = link.freedom_along(direction, end.freedom >= RX, bodies[1], scene)
        if found is not None and _turns_about_alone(link, found[0] % 3):
            return replace(end, joint=link.joint.id, freedom=found[0], ratio=end.ratio * found[1])
    return end


def _turns_about_alone(link: Link, axis: int) -> bool:
    """Whether a link turns about one of its axes alone, so that its other coordinates along that axis are everybody's."""
    return all(freedom < RX or freedom - RX == axis for freedom in link.joint.unlocked)
