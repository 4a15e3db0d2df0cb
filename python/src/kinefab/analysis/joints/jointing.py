"""From the relations between bodies to the joints that a Unity scene can have."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np

from ...diagnostics import Report, named
from ...findings import JointFinding
from ...model import RX, TY, TZ, Constraint, Coupling, FreeIds, Joint, MassProperties, Node
from ...spatial import Array, Pose
from ..assembly.assemble import Assembly
from ..freedom.finite import Candidate
from ..pairs.relations import Relation, find_joints, relations_of
from .links import Link, Links
from .narrowing import narrowed
from .resolving import find_by_finite_motions, joints_of_each, missed
from .writing import Draft, written

MIDDLE_SHARE = 0.1
"""Mass of a middle body against the lighter of its neighbours."""
MANY = 200
"""Constraints between one pair from which the report mentions their number."""


def links_of(assembly: Assembly, report: Report) -> Links:
    """A joint for every pair of bodies that constraints join; explicit joints stay as they are."""
    return _Jointing(assembly, report).run()


class _Jointing:
    def __init__(self, assembly: Assembly, report: Report):
        self.assembly, self.report = assembly, report
        self.depth = np.empty(assembly.system.bodies, dtype=np.int64)
        self.depth[assembly.blocks.order] = np.arange(assembly.system.bodies)
        self.found: list[Link | Draft] = []
        self.nodes: list[Node] = []
        statements = assembly.equations.statements
        self.free_ids = FreeIds(s.id for s in statements if isinstance(s, Joint))
        self.where = {s.id: s.where for s in statements}

    def run(self) -> Links:
        assembly = self.assembly
        system = assembly.system
        relations = relations_of(system, assembly.pairs, system.start())
        explicit = [self._explicit(r) for r in relations]
        open_ = [r for r, joint in zip(relations, explicit) if joint is None]
        find_joints(system, open_, system.residual(system.start()))
        for relation, joint in zip(relations, explicit):
            names = self._names(relation)
            if joint is not None:
                doubled = dict.fromkeys([*joint.because, *self._doubled(joint)])
                self._link_explicit(replace(joint, because=tuple(doubled)))
                continue
            if len(names) >= MANY:
                a, b = (self._label(body) for body in (relation.first, relation.second))
                self.report.add(
                    "CONSTRAINTS_MANY", count=len(names), a=a, b=b, first=names[0], last=names[-1]
                )
            if not relation.sure:
                self.report.add(
                    "PAIR_RANK_UNCERTAIN",
                    names=named(names),
                    rank=relation.rank,
                    gap=f"{relation.gap:.3g}",
                )
            if relation.joint is None:
                self._resolve(relation)
            found = relation.joint
            if found is not None and not self._kept_explicit(relation, found, names):
                self._add(relation.first, relation.second, found, relation, names)
        bodies = system.bodies + len(self.nodes)
        return Links(self._links(), self._aside(relations), self.nodes, bodies, relations)

    def _links(self) -> list[Link]:
        drafts = [own for own in self.found if isinstance(own, Draft)]
        poses = [*self.assembly.poses, *(n.pose for n in self.nodes)]
        joints = iter(written(drafts, self.assembly, poses))
        return [next(joints) if isinstance(own, Draft) else own for own in self.found]

    def _aside(self, relations: list[Relation]) -> list[Joint]:
        spoken = {o for r in relations for o in r.owners}
        return [
            s
            for i, s in enumerate(self.assembly.equations.statements)
            if isinstance(s, Joint) and i not in spoken
        ]

    def _explicit(self, relation: Relation) -> Joint | None:
        """The source's own joint, where it alone makes the relation."""
        statements = self.assembly.equations.statements
        owners = relation.owners
        alone = statements[owners[0]] if len(owners) == 1 else None
        return alone if isinstance(alone, Joint) else None

    def _kept_explicit(self, relation: Relation, found: Candidate, names: list[str]) -> bool:
        """Of several statements about a pair, an explicit joint of the found kind, or else one that has the found
        freedoms among its own, stands for all of them, so that its name, limits and drives are kept; another is given
        up, and reported.  One beside couplings of its own freedoms alone stays as it is: they count from these."""
        stated = [self.assembly.equations.statements[o] for o in relation.owners]
        explicit = [s for s in stated if isinstance(s, Joint)]
        coupled = len(explicit) == 1 and all(
            isinstance(s, Joint) or (isinstance(s, Coupling) and s.joints <= {explicit[0].id}) for s in stated
        )
        standing = next(
            ((j, j) for j in explicit if coupled or j.kind is found.kind),
            next(((j, own) for j in explicit if (own := self._narrowed(j, found)) is not None), None),
        )
        same, kept = (None, None) if standing is None else standing
        for joint in explicit:
            if joint is not same:
                by = found.kind.value if same is None else same.id
                self.report.dropped(
                    f"joint {joint.id}", "JOINT_SUPERSEDED", joint.where, joint=joint.id, by=by
                )
        if kept is not None:
            others = [n for n in names if n != kept.id]
            self._link_explicit(replace(kept, because=tuple(dict.fromkeys([*kept.because, *others]))))
        return kept is not None

    def _narrowed(self, joint: Joint, found: Candidate) -> Joint | None:
        a, b = (Pose() if n is None else self.assembly.poses[n] for n in (joint.a, joint.b))
        return narrowed(joint, found, a, b)

    def _link_explicit(self, joint: Joint) -> None:
        a, b = (self.assembly.body_of(n) for n in (joint.a, joint.b))
        joint = joint if joint.because else replace(joint, because=(joint.id,))
        self.found.append(Link(a, b, joint, JointFinding(joint.id)))

    def _doubled(self, joint: Joint) -> list[str]:
        equations = self.assembly.equations
        return equations.names(
            i for i, by in self.assembly.duplicates.items() if equations.statements[by] is joint
        )

    def _names(self, relation: Relation) -> list[str]:
        return self.assembly.equations.names(relation.owners)

    def _label(self, body: int) -> str:
        return "ground" if body == 0 else self.assembly.scene.nodes[self.assembly.nodes[body][0]].id

    def _resolve(self, relation: Relation) -> None:
        """What no candidate of the twists expresses: finite motions, middle bodies, or a report."""
        find_by_finite_motions(self.assembly, relation)
        if relation.joint is not None:
            return
        stands = joints_of_each(self.assembly, relation)
        if stands is None:
            self._approximate(relation)
            return
        for stand, names in stands:
            if isinstance(stand, Relation):
                if stand.joint is not None:
                    self._add(relation.first, relation.second, stand.joint, stand, names)
                continue
            near, far = stand
            body = self._middle_node(near.origin, far.origin, names[0], relation)
            self.report.add("RELATION_BY_MIDDLE_BODY", names=named(names), body=self.nodes[-1].id)
            self._add(relation.first, body, near, relation, names)
            self._add(body, relation.second, far, relation, names)

    def _approximate(self, relation: Relation) -> None:
        names = named(self._names(relation))
        if relation.tried:
            relation.joint = relation.tried[-1]
            relation.missed = missed(self.assembly.system, relation, relation.joint)
            self.report.approximated(
                f"constraint {names}",
                "RELATION_APPROXIMATED",
                names=names,
                kind=relation.joint.kind.value,
                metres=f"{relation.missed[0]:.2g}",
                degrees=f"{math.degrees(relation.missed[1]):.2g}",
            )
        else:
            self.report.dropped(f"constraint {names}", "RELATION_DROPPED", names=names)

    def _middle_node(self, near: Array, far: Array, name: str, relation: Relation) -> int:
        """A body without geometry; a tenth of the lighter neighbour's mass keeps the solver's mass ratios low."""
        nodes = self.assembly.scene.nodes
        beside = [n for body in (relation.first, relation.second) for n in self.assembly.nodes[body]]
        masses = [(mass.mass, n) for n in beside if (mass := nodes[n].mass) is not None]
        mass = MIDDLE_SHARE * min(masses, default=(1.0, 0))[0]
        moving = [(m, n) for m, n in masses if not self.assembly.stated.is_ground(n)]
        radius = max(0.5 * float(np.linalg.norm(far - near)), 0.1 * relation.length)
        weight = MassProperties(mass, np.zeros(3), 0.4 * mass * radius * radius * np.eye(3))
        self.nodes.append(
            Node(
                self.free_ids.take(f"middle:{name}"),
                f"middle {name}",
                pose=Pose(np.eye(3), 0.5 * (near + far)),
                mass=weight,
                visible=False,
                helps=min(moving)[1] if moving else None,
            )
        )
        return self.assembly.system.bodies + len(self.nodes) - 1

    def _add(
        self, first: int, second: int, candidate: Candidate, relation: Relation, names: list[str]
    ) -> None:
        """A joint of the model is to be written from a candidate between two bodies."""
        bodies = (first, second)
        first_is_a = candidate.first_is_a
        if not order_matters(candidate.unlocked):
            first_is_a = self._rank(first) <= self._rank(second)
        a, b = bodies if first_is_a else bodies[::-1]
        node_a, node_b = self._node(a, relation), self._node(b, relation)
        id = self.free_ids.take(f"{self._label_of(node_a)} - {self._label_of(node_b)}")
        where = self.where.get(names[0], "")
        self.found.append(Draft(id, a, b, node_a, node_b, candidate, relation, names, where))

    def _rank(self, body: int) -> int:
        return int(self.depth[body]) if body < len(self.depth) else body

    def _node(self, body: int, relation: Relation) -> int | None:
        """The node of a body that the relation's own constraints name."""
        if body >= self.assembly.system.bodies:
            return len(self.assembly.scene.nodes) + body - self.assembly.system.bodies
        for owner in relation.owners:
            for node in nodes_of(self.assembly.equations.statements[owner]):
                if node is not None and self.assembly.body_of(node) == body:
                    return node
        return None

    def _label_of(self, node: int | None) -> str:
        if node is None:
            return "ground"
        nodes = self.assembly.scene.nodes
        return nodes[node].id if node < len(nodes) else self.nodes[node - len(nodes)].id


def nodes_of(statement: Constraint | Joint | Coupling) -> tuple[int | None, ...]:
    """The nodes that a statement joins."""
    if isinstance(statement, Constraint):
        return tuple(f.node for f in statement.features)
    if isinstance(statement, Joint):
        return (statement.a, statement.b)
    return ()


@cache
def order_matters(unlocked: tuple[int, ...]) -> bool:
    """Whether a joint moves differently when its two bodies change places (plain freedoms)."""
    slides, turns = (tuple(i for i in unlocked if (i >= RX) == turning) for turning in (False, True))
    if not turns:
        return False
    if turns == (RX,):
        return (TY in slides) != (TZ in slides)
    if len(turns) == 3:
        return 0 < len(slides) < 3
    return True
