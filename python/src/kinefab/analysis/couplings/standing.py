"""Couplings that count from coordinates which cannot change: what is left of them, or that they hold what they couple."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from ...diagnostics import Report
from ...model import Coupling, Joint, Scene, Term
from ..assembly.assemble import Assembly
from ..joints.links import Link


def without_standing(
    assembly: Assembly, links: Sequence[Link], couplings: Sequence[Coupling], scene: Scene, report: Report
) -> list[Coupling]:
    """The couplings, each counted from the coordinates that move.

    A coordinate stands still where other statements fix its joint's bodies to each other, or take it from the joint; a
    coupling with one that moves holds that one too, so its rows took it from its joint already.  scene: at the closed pose.
    """
    by_id = {link.joint.id: link for link in links}
    stated = {joint.id: joint for joint in assembly.scene.joints}
    taken = {name for link in links for name in link.joint.because}
    found: list[Coupling] = []
    for coupling in couplings:
        ends = [Term(coupling.joint, coupling.freedom, -1.0), *coupling.terms]
        moving = [end for end in ends if not _stands(assembly, by_id, stated, end)]
        if len(moving) == len(ends):
            found.append(coupling)
        elif len(moving) < 2 and (not moving or coupling.id in taken):
            told = {"coupling": coupling.id, "joints": ", ".join(sorted(coupling.joints))}
            report.kept(f"coupling {coupling.id}", coupling.where, "COUPLING_HELD", **told)
        elif len(moving) > 1 and all(end.joint in by_id for end in moving):
            found.append(counted_from(coupling, moving, by_id, scene))
        else:
            found.append(coupling)
    return found


def _stands(assembly: Assembly, by_id: Mapping[str, Link], stated: Mapping[str, Joint], end: Term) -> bool:
    if (link := by_id.get(end.joint)) is not None:
        return end.freedom not in link.joint.unlocked
    joint = stated.get(end.joint)
    return joint is not None and assembly.body_of(joint.a) == assembly.body_of(joint.b)


def counted_from(
    coupling: Coupling, moving: Sequence[Term], by_id: Mapping[str, Link], scene: Scene
) -> Coupling:
    """The coupling between these coordinates, as it holds at the closed pose.  moving: with the ratios of
    0 = sum ratio_i q_i + constant; the first becomes the one that follows."""
    own, *others = moving
    terms = tuple(replace(end, ratio=-end.ratio / own.ratio) for end in others)
    here = [by_id[end.joint].coordinate(end.freedom, scene) for end in moving]
    offset = here[0] - sum(term.ratio * q for term, q in zip(terms, here[1:]))
    return replace(coupling, joint=own.joint, freedom=own.freedom, terms=terms, offset=offset)
