"""How the closing joints of one block could open, if only the joints of the spanning tree held.

Everything here is of one pose: twists (v / length, w) about one point, rows that act on them, and their span.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...model import RX, RY, RZ, Joint
from ...spatial import Array, BoolArray, cross
from ..freedom.rank import rank_of, spans
from ..freedom.stacks import alike
from .spanning import Tree

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


Likeness = tuple[tuple[tuple[object, ...], ...], bytes, bytes]
"""What blocks that are alike agree in: their joints, and the joints' turns and places as seen from the first."""


class BlockTree:
    """The spanning tree inside one block, in units of one length about one point.

    held: each body and the link that holds it, outwards.  closing: the links that close loops.
    links, indices: all of them, the held ones first, and their numbers in the tree.
    rotation, place: their WORLD frames, on a and on b, shapes (links, 2, 3, 3) and (links, 2, 3), metres.
    """

    def __init__(self, block: Block, tree: Tree, frames: tuple[Array, Array]):
        held = [(body, int(tree.parent[body])) for body in block.bodies if tree.parent[body] >= 0]
        self.block = block
        self.held = [(body, tree.links[i]) for body, i in held]
        self.closing = [tree.links[i] for i in block.closures]
        self.links = [*(link for _, link in self.held), *self.closing]
        self.indices = [*(i for _, i in held), *block.closures]
        self.rotation, self.place = (values[self.indices] for values in frames)
        points = self.place[: len(held), 0] if held else np.zeros((1, 3))
        self.origin = points.mean(axis=0)
        self.length = float(np.linalg.norm(points - self.origin, axis=1).max()) or 1.0

    def likeness(self) -> Likeness:
        """Equal for blocks that are alike but for where they stand, as mass-produced mechanisms are."""
        links = self.links
        number = {body: n for n, body in enumerate(sorted({b for link in links for b in (link.a, link.b)}))}
        motions = [tuple(f.motion for f in link.joint.freedoms) for link in links]
        joints = tuple(
            (number[l.a], number[l.b], l.joint.kind, l.joint.lead, m) for l, m in zip(links, motions)
        )
        seen = self.rotation[0, 0].T
        turns: Array = seen @ self.rotation
        places: Array = (self.place - self.origin) @ seen.T / self.length
        # adding nothing to what is rounded makes a zero of a negative one
        return joints, (np.round(turns, ALIKE) + 0.0).tobytes(), (np.round(places, ALIKE) + 0.0).tobytes()

    def closed_by(self, freedoms: Array, wrenches: Array) -> list[tuple[Array, Array]]:
        """For each closure its locked rows and the twists of its b against its a, see ``tree_twists``.

        freedoms, wrenches: of the links' six freedoms, shape (links, 6, 6)."""
        own = [twists[list(link.joint.unlocked)] for (_, link), twists in zip(self.held, freedoms)]
        rest = np.zeros((6, sum(len(twists) for twists in own)))
        carried: dict[int, Array] = {}
        done = 0
        for (body, link), twists in zip(self.held, own):
            twist = carried.get(link.a if link.b == body else link.b, rest).copy()
            twist[:, done : done + len(twists)] += twists.T
            carried[body] = twist
            done += len(twists)
        return [
            (rows[list(link.joint.locked)], carried.get(link.b, rest) - carried.get(link.a, rest))
            for link, rows in zip(self.closing, wrenches[len(self.held) :])
        ]


def tree_twists(
    trees: list[BlockTree], rotation: Array | None = None, translation: Array | None = None
) -> list[list[tuple[Array, Array]]]:
    """For each closure of each tree its locked rows, shape (locked, 6), and the twists of its b against its a, shape
    (6, columns), a column for each freedom of the tree; at the exported pose or displaced (all bodies)."""
    if not trees:
        return []
    links = [link for tree in trees for link in tree.links]
    turn, place = (np.concatenate([getattr(tree, name) for tree in trees]) for name in ("rotation", "place"))
    if rotation is not None and translation is not None:
        bodies = np.array([(link.a, link.b) for link in links])
        turn = rotation[bodies] @ turn
        place = (rotation[bodies] @ place[..., None])[..., 0] + translation[bodies]
    count = [len(tree.links) for tree in trees]
    origin = np.repeat([tree.origin for tree in trees], count, axis=0)
    lever = (place[:, 1] - origin) / np.repeat([tree.length for tree in trees], count)[:, None]
    slides = np.swapaxes(turn[:, 0], 1, 2)
    turns = _turns([link.joint for link in links], turn)
    freedoms, wrenches = np.zeros((2, len(links), 6, 6))
    freedoms[:, :3, :3] = wrenches[:, :3, :3] = slides  # of a screw, turn and slide are apart
    freedoms[:, 3:, 3:] = wrenches[:, 3:, 3:] = turns
    freedoms[:, 3:, :3] = cross(lever[:, None], turns)
    wrenches[:, :3, 3:] = cross(lever[:, None], slides)
    ends = np.cumsum(count)[:-1]
    return [
        tree.closed_by(*own) for tree, *own in zip(trees, np.split(freedoms, ends), np.split(wrenches, ends))
    ]


def _turns(joints: list[Joint], turn: Array) -> Array:
    """Axes of the three rotations, rows, shape (joints, 3, 3): a's, which a lone locked one shares with b.

    turn: see ``BlockTree.rotation``.
    """
    axes = np.swapaxes(turn[:, 0], 1, 2).copy()
    for n, joint in enumerate(joints):
        locked = [i for i in joint.locked if i >= RX]
        if len(locked) == 1:
            one, other = (frame[:, i] for frame, i in zip(turn[n], CARDAN[locked[0]]))
            across = cross(one, other)
            axes[n, [i for i in range(3) if RX + i != locked[0]]] = one, other
            axes[n, locked[0] - RX] = across / np.linalg.norm(across)
    return axes


def openings(
    twists: Sequence[list[tuple[Array, Array]]], like: Sequence[Openings] | None = None
) -> list[Openings | None]:
    """What the ``tree_twists`` of each tree come to.

    like: the exported pose's, for any other pose; None stands where all rows together are nearly singular.
    """
    found: list[Openings | None] = [None] * len(twists)
    shapes = (tuple((*wrenches.shape, *twist.shape) for wrenches, twist in own) for own in twists)
    for _, group in alike(shapes):
        members: list[int] = group.tolist()
        rows = [
            np.array([wrenches for wrenches, _ in closure]) @ np.array([twist for _, twist in closure])
            for closure in zip(*(twists[i] for i in members))
        ]
        s = np.linalg.svd(np.concatenate(rows, axis=1), compute_uv=False)
        s = np.concatenate([s, np.zeros((len(group), 1))], axis=1)
        if like is None:
            rank = np.where(s[:, 0] > NONE, rank_of(s)[0], 0)
        else:
            rank = np.array([like[i].rank for i in members])
        at = np.arange(len(group))
        least = np.where(rank > 0, s[at, rank - 1], 0.0)
        border = np.sqrt(least * np.maximum(s[at, rank], REPEATED * s[:, 0]))
        seen = np.zeros((len(group), 0, rows[0].shape[2]))
        come_to: list[list[Array]] = []
        for own in rows:
            fresh = own - own @ np.swapaxes(seen, 1, 2) @ seen
            u, size, vt = np.linalg.svd(fresh, full_matrices=False)
            if like is None:  # the exported pose is closed only as well as its data
                left, all_ = (np.abs(values).max(axis=(1, 2), initial=0.0) for values in (fresh, own))
                count = np.where(
                    left > np.maximum(1e-7 * all_, NONE), rank_of(size)[0] if size.size else 0, 0
                )
            else:
                count = np.sum(size > border[:, None], axis=1)
            most = int(count.max())
            seen = np.concatenate(
                [seen, vt[:, :most] * (np.arange(most) < count[:, None])[..., None]], axis=1
            )
            come_to.append([basis[:, :c] for basis, c in zip(u, count)])
        for n, i in enumerate(members):
            if like is None or least[n] >= NEARLY_SINGULAR * like[i].least:
                found[i] = Openings([own[n] for own in rows], [own[n] for own in come_to], float(least[n]))
    return found


def moved_by(wrenches: Sequence[Array], twists: Sequence[Array]) -> list[BoolArray]:
    """Which rows of each closure any finite motion of the tree can violate, masks.

    All motions of b against a are products of exponentials of the twists, hence of the algebra that the twists
    generate (planar, spherical, ...); a row that vanishes on the algebra vanishes at every pose.
    """
    algebra = spans(twists, NONE)
    growing = list(range(len(algebra)))
    while growing:
        larger = spans([_with_brackets(algebra[i]) for i in growing], NONE)
        grown = [i for i, more in zip(growing, larger) if more.shape[1] > algebra[i].shape[1]]
        for i, more in zip(growing, larger):
            algebra[i] = more if i in grown else algebra[i]
        growing = grown
    return [np.abs(rows @ basis).max(axis=1, initial=0.0) > NONE for rows, basis in zip(wrenches, algebra)]


def _with_brackets(algebra: Array) -> Array:
    """The twists and all their Lie brackets, columns."""
    v, w = algebra[:3].T, algebra[3:].T
    across = cross(w[:, None], v[None]) - cross(w[None], v[:, None])
    brackets = np.concatenate([across, cross(w[:, None], w[None])], axis=2).reshape(-1, 6).T
    return np.concatenate([algebra, brackets], axis=1)
