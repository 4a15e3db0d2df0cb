"""The analysis, read like a sentence: assemble, joint, span, close, limit, couple, count."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..diagnostics import Report, named
from ..findings import JointFinding
from ..model import Coupling, Joint, Scene
from ..options import Closures
from ..rigid import is_rigid, rigid_groups
from .assembly.assemble import Assembly, assemble
from .assembly.bases import built_together
from .collector import collector_paused
from .couplings.rehanging import rehung
from .couplings.standing import without_standing
from .couplings.stated import couplings_of
from .couplings.superseded import on_links
from .couplings.symmetry import symmetric_couplings
from .findings.freedoms import check_records, singular_joints
from .findings.idle import IdleFreedom, idle_freedoms
from .findings.islands import islands_of
from .findings.result import Analysis
from .findings.still import report_still
from .joints.jointing import links_of
from .joints.links import Link, Links
from .joints.welding import welded
from .loops.minimal import minimal_closures
from .loops.spanning import spanning_tree
from .ranges.limits import found_ranges, with_found_ranges
from .ranges.stated import with_ranges


@dataclass(frozen=True, slots=True)
class AnalysisOptions:
    """closures: see ``Closures``.  limits: sweep the mechanisms and write the ranges into the joints."""

    closures: Closures = Closures.EXACT
    limits: bool = False


@collector_paused()
def analyse(
    scene: Scene,
    options: AnalysisOptions = AnalysisOptions(),
    progress: Callable[[float], None] = lambda done: None,
) -> Analysis:
    """Find the mechanism in a scene's constraints, joints and couplings.

    What is wrong with the data is in the result's report, by name; nothing is raised for it.
    progress: called with the share of the joints whose limits are searched.
    """
    found = _analysed(scene, options, progress)
    _report_whole(found)
    if not _led(scene):
        return found
    nodes = [replace(n, grounded=n.grounded or n.dynamics.kinematic) for n in scene.nodes]
    held = _analysed(replace(scene, nodes=nodes), AnalysisOptions(options.closures), lambda done: None)
    return replace(
        found,
        mobility=held.mobility,
        first_order=held.first_order,
        rows=held.rows,
        rank=held.rank,
        islands=held.islands,
        idle=held.idle,
        held=held,
    )


def _led(scene: Scene) -> bool:
    """Whether scripts lead a body of it: where such a body is is given, and no freedom of the mechanism."""
    return any(node.dynamics.kinematic for node in scene.nodes)


def _analysed(scene: Scene, options: AnalysisOptions, progress: Callable[[float], None]) -> Analysis:
    """With bodies that scripts lead counted as free ones; what there is to tell of the whole is not yet in its report."""
    report = Report()
    assembly = assemble(scene, report)
    found = links_of(assembly, report)
    tree = spanning_tree(found)
    closed = _closed_scene(assembly, found)
    links = tree.links
    if options.closures is Closures.MINIMAL:
        links = minimal_closures(assembly, tree, closed, report)
    links = with_ranges(assembly, links, closed, report)
    ranges = found_ranges(assembly, links, closed, report, progress) if options.limits else []
    links = with_found_ranges(assembly, links, ranges, report)
    links = rehung(assembly, links, closed, report)
    couplings = on_links(assembly, links, couplings_of(assembly, links, closed, report), closed, report)
    stated = len(couplings)
    couplings = without_standing(assembly, links, couplings, closed, report)
    as_stated = (
        len(closed.nodes) == len(assembly.scene.nodes)
        and len(couplings) == stated
        and not any(is_rigid(link.joint) for link in links)
    )
    couplings += symmetric_couplings(assembly, tree, links, closed, report)
    fixed, built = _fixed(assembly), built_together(assembly)
    groups = rigid_groups(scene, [*fixed, *built])
    joints = _in_source_order(assembly, links)
    place = {joint.id: i for i, joint in enumerate(joints)}
    return Analysis(
        source=scene,
        mobility=sum(f.mobility for f in assembly.finite) + 6 * assembly.floating,
        first_order=sum(f.mobility for f in assembly.freedoms) + 6 * assembly.floating,
        rows=assembly.counted,
        rank=_rank(assembly),
        groups=groups,
        fixed=fixed,
        built=built,
        islands=islands_of(assembly, tree, links, found.aside, couplings),
        idle=sorted(
            idle_freedoms(assembly) if as_stated else _idle(assembly, [*joints, *found.aside], couplings, closed),
            key=lambda idle: idle.nodes,
        ),
        joints=[*joints, *found.aside],
        findings={
            **{joint.id: JointFinding(joint.id) for joint in found.aside},
            **{link.joint.id: link.finding for link in links},
        },
        couplings=couplings,
        nodes=found.nodes,
        poses=assembly.poses,
        ranges=sorted(ranges, key=lambda r: place.get(r.joint, -1)),
        gaps=assembly.closing.gaps,
        worst_gap=assembly.closing.worst,
        contradictory=assembly.closing.contradictory,
        report=report,
        assembly=assembly,
        singular=singular_joints(assembly, found.relations),
    )


def _in_source_order(assembly: Assembly, links: list[Link]) -> list[Joint]:
    """The links' joints by the first nodes of the two bodies."""
    bodies, first = np.unique(assembly.body, return_index=True)
    place = {int(b): int(i) for b, i in zip(bodies, first)}

    def key(link: Link) -> list[int]:
        return sorted(place.get(b, len(assembly.body) + b) for b in (link.a, link.b))

    return [link.joint for link in sorted(links, key=key)]


def _closed_scene(assembly: Assembly, found: Links) -> Scene:
    scene = assembly.closed_scene
    return replace(scene, nodes=[*scene.nodes, *found.nodes])


def _rank(assembly: Assembly) -> int:
    """Rows that remove something, over the bodies as the source states them."""
    bodies = int(assembly.closing.body.max()) + 1
    return 6 * (bodies - 1) - sum(f.mobility for f in assembly.freedoms) - 6 * assembly.floating


def _fixed(assembly: Assembly) -> tuple[tuple[int | None, int], ...]:
    """Pairs of each body's first node (or ground) and the other nodes that constraints fix to it."""
    first: dict[int, int | None] = {0: None}
    pairs: list[tuple[int | None, int]] = []
    for node in range(len(assembly.scene.nodes)):
        body = int(assembly.body[node + 1])
        if assembly.stated.group_of[node] is None:
            continue
        if body not in first:
            first[body] = node
        elif not assembly.stated.together(first[body], node):
            pairs.append((first[body], node))
    return tuple(pairs)


def _idle(
    assembly: Assembly, joints: list[Joint], couplings: list[Coupling], scene: Scene
) -> list[IdleFreedom]:
    """Over the bodies that are exported.  joints: with those by which the source itself fixes parts.  scene: with middle bodies, at the
    closed pose.

    The rod that stands for a distance moves along with what it holds, or leaves it alone where several meet; what a coupling holds
    is one body, and so are two whose common velocities are all obstructed.
    """
    return idle_freedoms(assemble(welded(scene, _fixed(assembly), joints, couplings), Report()))


def _report_whole(analysis: Analysis) -> None:
    scene, assembly, report = analysis.source, analysis.assembly, analysis.report
    _report_singular(assembly, report)
    loose = not any(analysis.groups.grounded) and not _led(scene)
    if analysis.joints and loose and all(island.floating for island in analysis.islands):
        report.add("NOTHING_GROUNDED", count=len(analysis.joints))
    report_still(scene, assembly, analysis.mobility, report)
    if scene.dof_records:
        check_records(assembly, analysis.freedoms, report)
    _report_outcomes(assembly, report)


def _report_singular(assembly: Assembly, report: Report) -> None:
    for first, finite in zip(assembly.freedoms, assembly.finite):
        if finite.mobility < first.mobility:
            bodies: list[int] = first.bodies.tolist()
            nodes = sorted(n for body in bodies for n in assembly.nodes[body])
            parts = named(assembly.scene.nodes[n].id for n in nodes)
            report.add("MECHANISM_SINGULAR", parts=parts, first=first.mobility, finite=finite.mobility)


def _report_outcomes(assembly: Assembly, report: Report) -> None:
    """Constraints that nothing was said about are kept: in a joint, or by the rigid group they make."""
    said = {o.feature for o in report.outcomes}
    for constraint in assembly.scene.constraints:
        feature = f"constraint {constraint.id}"
        if not constraint.suppressed and feature not in said:
            report.kept(feature, constraint.where)
