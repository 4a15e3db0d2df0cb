"""How the closing joints of one block could open, if only the joints of the spanning tree held.

Everything here is of one pose: twists (v / length, w) about one point, rows that act on them, and their span.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..model import LOCKED, RX, RY, RZ, Joint, Motion, Scene
from ..spatial import Array, Pose, cross
from .loops import Link, Tree
from .rank import rank_of

CARDAN = {RX: (1, 2), RY: (2, 0), RZ: (1, 0)}
"""Of a lone locked rotation: the axis of a and that of b which stay at right angles (see ``joint_rows``)."""
NONE = 1e-5
"""Share of a twist, or of a row's effect, up to which it is a rounding of the export."""
REPEATED = 1e-9
"""Relative singular value up to which a row repeats others at a pose that the analysis itself has closed."""
ALIKE = 6
"""Decimals of directions, and of places as fractions of the length, in which blocks that are alike agree."""
NEARLY_SINGULAR = 0.02
"""Where the last independent row has this share of its effect at the exported pose, all rows together give way."""


@dataclass(slots=True, eq=False)
class Block:
    """Closing joints of one block, and the bodies it has, outwards."""

    bodies: list[int]
    closures: list[int]


@dataclass(slots=True, eq=False)
class Openings:
    """One block at one pose.

    rows: for each closure its locked rows on the tree's freedoms, shape (locked, columns).  span: for each closure
    an orthonormal basis, shape (locked, rank), of what its rows can come to by motions of the tree that keep the
    closures before it.  least: the smallest independent singular value of all rows.
    """

    rows: list[Array]
    span: list[Array]
    least: float

    @property
    def rank(self) -> int:
        return sum(span.shape[1] for span in self.span)


class BlockTree:
    """The spanning tree inside one block, its twists in units of one length about one point."""

    def __init__(self, block: Block, tree: Tree, scene: Scene):
        self.block = block
        self.held = [(b, tree.links[tree.parent[b]]) for b in block.bodies if tree.parent[b] >= 0]
        self.closing = [tree.links[i] for i in block.closures]
        self.frames = [self._frames(link, scene) for _, link in self.held]
        self.ends = [self._frames(link, scene) for link in self.closing]
        points = np.array([a.translation for a, _ in self.frames] or [np.zeros(3)])
        self.origin = points.mean(axis=0)
        self.length = float(np.linalg.norm(points - self.origin, axis=1).max()) or 1.0

    @staticmethod
    def _frames(link: Link, scene: Scene) -> tuple[Pose, Pose]:
        joint = link.joint
        return scene.pose(joint.a) @ joint.frame_a, scene.pose(joint.b) @ joint.frame_b

    def likeness(self) -> tuple:
        """Equal for blocks that are alike but for where they stand, as mass-produced mechanisms are."""
        links = [*(link for _, link in self.held), *self.closing]
        number = {body: n for n, body in enumerate(sorted({b for link in links for b in (link.a, link.b)}))}
        motions = [tuple(f.motion for f in link.joint.freedoms) for link in links]
        joints = tuple((number[l.a], number[l.b], l.joint.kind, l.joint.lead, m) for l, m in zip(links, motions))
        frames = [frame for ends in (*self.frames, *self.ends) for frame in ends]
        seen = frames[0].rotation.T
        turns = np.array([seen @ frame.rotation for frame in frames])
        places = np.array([seen @ (frame.translation - self.origin) / self.length for frame in frames])
        # adding nothing to what is rounded makes a zero of a negative one
        return joints, (np.round(turns, ALIKE) + 0.0).tobytes(), (np.round(places, ALIKE) + 0.0).tobytes()

    def twists(self, rotation: Array | None = None, translation: Array | None = None) -> list[tuple[Array, Array]]:
        """For each closure its locked rows, shape (locked, 6), and the twists of its b against its a, shape
        (6, columns), a column for each freedom of the tree; at the exported pose or displaced (all bodies)."""

        def at(link: Link, frames: tuple[Pose, Pose]) -> tuple[Pose, Pose]:
            if rotation is None or translation is None:
                return frames
            a, b = (Pose(rotation[n], translation[n]) @ f for n, f in zip((link.a, link.b), frames))
            return a, b

        own = [self._freedoms(link.joint, *at(link, frames)) for (_, link), frames in zip(self.held, self.frames)]
        columns = sum(len(twists) for twists in own)
        rest = np.zeros((6, columns))
        carried: dict[int, Array] = {}
        done = 0
        for (body, link), twists in zip(self.held, own):
            twist = carried.get(link.a if link.b == body else link.b, rest).copy()
            twist[:, done : done + len(twists)] += twists.T
            carried[body] = twist
            done += len(twists)
        return [
            (
                self._wrenches(link.joint, *at(link, ends))[locked_of(link.joint)],
                carried.get(link.b, rest) - carried.get(link.a, rest),
            )
            for link, ends in zip(self.closing, self.ends)
        ]

    def _lever(self, b: Pose) -> Array:
        return (b.translation - self.origin) / self.length

    def _freedoms(self, joint: Joint, a: Pose, b: Pose) -> Array:
        """Twists that the joint leaves free (of a screw, turn and slide apart), shape (free, 6)."""
        slides, turns = a.rotation.T, _turns(joint, a, b)
        both = np.block([[slides, np.zeros((3, 3))], [cross(self._lever(b), turns), turns]])
        return both[[i for i, f in enumerate(joint.freedoms) if f.motion is not Motion.LOCKED]]

    def _wrenches(self, joint: Joint, a: Pose, b: Pose) -> Array:
        """Rows of the joint's six freedoms, shape (6, 6)."""
        slides, turns = a.rotation.T, _turns(joint, a, b)
        return np.block([[slides, cross(self._lever(b), slides)], [np.zeros((3, 3)), turns]])


def locked_of(joint: Joint) -> list[int]:
    return [i for i, f in enumerate(joint.freedoms) if f.motion is Motion.LOCKED]


def _turns(joint: Joint, a: Pose, b: Pose) -> Array:
    """Axes of the three rotations, rows: a's, which a lone locked one shares with b."""
    axes = a.rotation.T
    locked = [i for i in (RX, RY, RZ) if joint.freedoms[i].motion is Motion.LOCKED]
    if len(locked) != 1:
        return axes
    one, other = (frame.rotation[:, i] for frame, i in zip((a, b), CARDAN[locked[0]]))
    across = cross(one, other)
    turns = np.empty((3, 3))
    turns[[i for i in range(3) if RX + i != locked[0]]] = one, other
    turns[locked[0] - RX] = across / np.linalg.norm(across)
    return turns


def openings(twists: list[tuple[Array, Array]], like: Openings | None = None) -> Openings | None:
    """What ``BlockTree.twists`` comes to.

    like: the exported pose's, for any other pose; None is returned where all rows together are nearly singular.
    """
    rows = [wrenches @ twist for wrenches, twist in twists]
    s = np.linalg.svd(np.concatenate(rows), compute_uv=False)
    rank = like.rank if like is not None else int(rank_of(s)[0]) if s.max(initial=0.0) > NONE else 0
    least = float(s[rank - 1]) if rank else 0.0
    if like is not None and least < NEARLY_SINGULAR * like.least:
        return None
    columns = rows[0].shape[1]
    basis, span = np.zeros((0, columns)), []
    for own in rows:
        fresh = own - own @ basis.T @ basis
        u, size, vt = np.linalg.svd(fresh, full_matrices=False)
        if like is None:  # the exported pose is closed only as well as its data
            count = int(rank_of(size)[0]) if np.abs(fresh).max(initial=0.0) > 1e-7 * max(np.abs(own).max(initial=0.0), 1e-300) else 0
        else:
            next_ = float(s[rank]) if rank < len(s) else 0.0
            count = int(np.sum(size > np.sqrt(least * max(next_, REPEATED * s[0]))))
        span.append(u[:, :count])
        basis = np.concatenate([basis, vt[:count]])
    return Openings(rows, span, least)


def moved_by(wrenches: Array, twist: Array) -> np.ndarray:
    """Which rows of a closure any finite motion of the tree can violate, a mask.

    All motions of b against a are products of exponentials of the twists, hence of the algebra that the twists
    generate (planar, spherical, ...); a row that vanishes on the algebra vanishes at every pose.
    """
    algebra = _orthonormal(twist)
    while True:
        v, w = algebra[:3].T, algebra[3:].T
        across = cross(w[:, None], v[None]) - cross(w[None], v[:, None])
        brackets = np.concatenate([across, cross(w[:, None], w[None])], axis=2).reshape(-1, 6).T
        larger = _orthonormal(np.concatenate([algebra, brackets], axis=1))
        if larger.shape[1] == algebra.shape[1]:
            return np.abs(wrenches @ algebra).max(axis=1, initial=0.0) > NONE
        algebra = larger


def _orthonormal(vectors: Array) -> Array:
    u, s, _ = np.linalg.svd(vectors, full_matrices=False)
    return u[:, s > NONE * max(s.max(initial=0.0), 1e-300)]
