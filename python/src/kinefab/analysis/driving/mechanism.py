"""A mechanism that can be driven: its freedoms by name, and where every part is along the way.

Coordinates are as the source shows them: degrees and metres, counted from the joint's own zero.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from ...model import RX, Joint, Motion, Scene
from ...model.freedoms import Amount
from ...spatial import Array, quaternions_from_matrices, without_flips
from ..assembly.assemble import Assembly
from .coordinates import Driven, DrivenBlock, coordinate_names, driven_blocks
from .run import Run, shares, straight
from .trajectory import Branching, Coordinate, Stop, Trajectory
from .way import Way

MOST_FRAMES = 1_000_000
"""Of a sweep: beyond, a slip of the keyboard would fill the memory."""


class Mechanism:
    """What an analysis found, to be driven.  Every motion starts from the exported pose.

    scene: at the closed pose, with its joints, right-handed, +Y up, metres.

    >>> import kinefab, trimesh
    >>> scene = kinefab.Scene()
    >>> door = scene.add_part("Door", trimesh.creation.box((0.8, 2.0, 0.04)), translation=(0.4, 1.0, 0.0))
    >>> hinge = scene.add_hinge(None, door, point=(0, 1, 0), axis=(0, 1, 0), limits=(0, 110), name="Hinge")
    >>> mechanism = kinefab.motion(scene)
    >>> [(c.name, c.unit, round(c.lower), round(c.upper)) for c in mechanism.coordinates]
    [('Hinge', 'deg', 0, 110)]
    """

    def __init__(self, assembly: Assembly, joints: Sequence[Driven], scene: Scene):
        self._assembly = assembly
        self.scene = scene
        self.blocks: list[DrivenBlock] = driven_blocks(assembly, joints, scene)
        names = coordinate_names(joints)
        self.parts = tuple(node.id for node in assembly.scene.nodes)
        self._place: dict[str, tuple[DrivenBlock, int]] = {}
        self._names: dict[tuple[int, int], str] = {}
        self._other: dict[str, list[str]] = {}
        self._coordinates: dict[str, Coordinate] = {}
        for block in self.blocks:
            values = block.measured.read(block.measured.start, block.measured.turns)[0]
            for i, (driven, freedom) in enumerate(block.joints):
                joint = driven.joint
                name = names[joint.id, freedom]
                self._place[name] = block, i
                self._names[id(block), i] = name
                self._coordinates[name] = _coordinate(name, joint, freedom, float(values[i]))
                for other in {joint.id, joint.name} - {name}:
                    self._other.setdefault(other, []).append(name)

    def __repr__(self) -> str:
        return f"<Mechanism: mobility {self.mobility}; {', '.join(self._coordinates)}>"

    @property
    def mobility(self) -> int:
        """How many freedoms it has, those of floating islands left out.

        >>> scene = kinefab.Scene()
        >>> hinge = scene.add_hinge(None, scene.add_part("Door"), point=(0, 1, 0), axis=(0, 1, 0), limits=(0, 110), name="Hinge")
        >>> kinefab.motion(scene).mobility
        1
        """
        return sum(block.mobility for block in self.blocks)

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """All joint coordinates that can move.

        >>> scene = kinefab.Scene()
        >>> hinge = scene.add_hinge(None, scene.add_part("Door"), point=(0, 1, 0), axis=(0, 1, 0), limits=(0, 110), name="Hinge")
        >>> [coordinate.name for coordinate in kinefab.motion(scene).coordinates]
        ['Hinge']
        """
        return tuple(self._coordinates.values())

    @property
    def freedoms(self) -> tuple[Coordinate, ...]:
        """As many coordinates as there are freedoms, where the joints have so many: what one would put on sliders.

        >>> scene = kinefab.Scene()
        >>> hinge = scene.add_hinge(None, scene.add_part("Door"), point=(0, 1, 0), axis=(0, 1, 0), limits=(0, 110), name="Hinge")
        >>> [coordinate.name for coordinate in kinefab.motion(scene).freedoms]
        ['Hinge']
        """
        chosen = ((block, i) for block in self.blocks for i in sorted(block.independent()))
        return tuple(self._coordinates[self.name_of(block, i)] for block, i in chosen)

    def sweep(
        self, name: str | Joint, start: float | None = None, stop: float | None = None, frames: int = 100
    ) -> Trajectory:
        """Move one coordinate evenly from ``start`` to ``stop``, the others following or staying.

        name: of a coordinate, or of a joint that has only one, or that joint.
        start, stop: degrees or metres as the source shows them; without them the joint's limits, or a whole turn from
        where it stands.  frames: at least 2, at most a million.
        Raises ValueError for a name that is none, a number that is not finite, and a slide without limits and stop,
        TypeError for what is no number.

        >>> scene = kinefab.Scene()
        >>> hinge = scene.add_hinge(None, scene.add_part("Door"), point=(0, 1, 0), axis=(0, 1, 0), limits=(0, 110), name="Hinge")
        >>> kinefab.motion(scene).sweep(hinge, frames=3)["Hinge"].round(9).tolist()
        [0.0, 55.0, 110.0]
        """
        coordinate = self.coordinate(name)
        _check_numbers(start, stop, frames)
        if stop is None:
            start, stop = self._whole(coordinate, start)
        elif start is None:
            start = coordinate.value
        if not 2 <= frames <= MOST_FRAMES:
            raise ValueError(f"a sweep has at least 2 frames and at most {MOST_FRAMES}, not {frames}")
        return self.follow({coordinate.name: np.linspace(start, stop, frames)})

    def follow(self, values: Mapping[str, Sequence[float] | Array]) -> Trajectory:
        """Move several coordinates at once, through their values frame by frame.

        values: by name, each of shape (frames,), degrees or metres as the source shows them.
        Raises ValueError for a name that is none, for values of different lengths or not finite, and for coordinates of
        which one already moves the other.

        >>> scene = kinefab.Scene()
        >>> hinge = scene.add_hinge(None, scene.add_part("Door"), point=(0, 1, 0), axis=(0, 1, 0), limits=(0, 110), name="Hinge")
        >>> kinefab.motion(scene).follow({"Hinge": [10, 80, 20]})["Hinge"].round(9).tolist()
        [10.0, 80.0, 20.0]
        """
        driven = self._driven(values)
        frames = len(next(iter(driven.values()))[1][0])
        runs: list[Run] = [
            Run(block, places, np.array(columns).T) for block, (places, columns) in driven.items()
        ]
        pieces = straight(np.concatenate([run.goals for run in runs], axis=1))
        reached, stop = frames, None
        for first, last in pieces:
            ways = [run.go(first, last) for run in runs]
            share = min(way.reached for way in ways)
            if share < 1.0:
                at = next(i for i, way in enumerate(ways) if way.reached == share)
                reached = 0 if first < 0 else first + int(np.sum(shares(first, last) <= share))
                stop = self._stopped(runs[at], ways[at], reached)
                break
        return self._trajectory(runs, reached, stop)

    def name_of(self, block: DrivenBlock, i: int) -> str:
        """The name of a block's coordinate.

        >>> scene = kinefab.Scene()
        >>> hinge = scene.add_hinge(None, scene.add_part("Door"), point=(0, 1, 0), axis=(0, 1, 0), limits=(0, 110), name="Hinge")
        >>> mechanism = kinefab.motion(scene)
        >>> mechanism.name_of(mechanism.blocks[0], 0)
        'Hinge'
        """
        return self._names[id(block), i]

    def coordinate(self, name: str | Joint) -> Coordinate:
        """A coordinate by its name, or by a joint that has only one, its id or name.  Raises ValueError.

        >>> scene = kinefab.Scene()
        >>> hinge = scene.add_hinge(None, scene.add_part("Door"), point=(0, 1, 0), axis=(0, 1, 0), limits=(0, 110), name="Hinge")
        >>> round(kinefab.motion(scene).coordinate("Hinge").upper)
        110
        """
        return self._coordinates[self._named(name)]

    def freedom_of(self, name: str) -> int:
        """TX..RZ of a coordinate.

        >>> scene = kinefab.Scene()
        >>> hinge = scene.add_hinge(None, scene.add_part("Door"), point=(0, 1, 0), axis=(0, 1, 0), limits=(0, 110), name="Hinge")
        >>> kinefab.motion(scene).freedom_of("Hinge")  # RX
        3
        """
        block, i = self._place[name]
        return block.joint(i)[1]

    def internal(self, coordinate: Coordinate) -> tuple[float, float, float]:
        """Value, lower and upper of a coordinate, metres or radians from where the joint's frames meet.

        >>> scene = kinefab.Scene()
        >>> hinge = scene.add_hinge(None, scene.add_part("Door"), point=(0, 1, 0), axis=(0, 1, 0), limits=(0, 110), name="Hinge")
        >>> mechanism = kinefab.motion(scene)
        >>> [round(x, 3) for x in mechanism.internal(mechanism.coordinate("Hinge"))]
        [0.0, 0.0, 1.92]
        """
        block, i = self._place[coordinate.name]
        joint, freedom = block.joint(i)
        value = float(_counted(joint, freedom, coordinate.value))
        lower, upper = sorted(
            float(_counted(joint, freedom, x)) for x in (coordinate.lower, coordinate.upper)
        )
        return value, lower, upper

    def bodies_of(self, block: DrivenBlock) -> tuple[int, list[int]]:
        """A block's root and its bodies, as ``body_of_part`` numbers them (0: the ground).

        >>> scene = kinefab.Scene()
        >>> hinge = scene.add_hinge(None, scene.add_part("Door"), point=(0, 1, 0), axis=(0, 1, 0), limits=(0, 110), name="Hinge")
        >>> mechanism = kinefab.motion(scene)
        >>> mechanism.bodies_of(mechanism.blocks[0])
        (0, [1])
        """
        bodies = self._assembly.freedoms[block.part].bodies
        blocks = self._assembly.blocks
        return int(blocks.root[blocks.block[bodies[0]]]), bodies.tolist()

    @property
    def body_of_part(self) -> list[int]:
        """The body that each part moves with.

        >>> scene = kinefab.Scene()
        >>> hinge = scene.add_hinge(None, scene.add_part("Door"), point=(0, 1, 0), axis=(0, 1, 0), limits=(0, 110), name="Hinge")
        >>> kinefab.motion(scene).body_of_part
        [1]
        """
        return self._assembly.body[1:].tolist()

    @property
    def generation_of(self) -> dict[int, int]:
        """How many blocks each block is from its island's root, by its number.

        >>> scene = kinefab.Scene()
        >>> hinge = scene.add_hinge(None, scene.add_part("Door"), point=(0, 1, 0), axis=(0, 1, 0), limits=(0, 110), name="Hinge")
        >>> kinefab.motion(scene).generation_of
        {0: 0}
        """
        blocks, found = self._assembly.blocks, dict[int, int]()
        for depth, bodies in enumerate(blocks.generations()):
            found |= {self._assembly.part_of_block[int(blocks.block[b])]: depth for b in bodies}
        return found

    def _named(self, name: str | Joint) -> str:
        """The coordinate meant by its name, or by a joint that has only one, its id or name."""
        name = name.id if isinstance(name, Joint) else name
        if name in self._place:
            return name
        others = self._other.get(name, [])
        if len(others) == 1:
            return others[0]
        known = ", ".join(others or self._place) or "none: nothing moves"
        raise ValueError(f"there is no coordinate {name!r}; the mechanism has {known}")

    def _whole(self, coordinate: Coordinate, start: float | None) -> tuple[float, float]:
        ends = [coordinate.lower, coordinate.upper]
        if coordinate.unit == "deg":
            free = [math.isinf(end) for end in ends]
            ends = [
                (coordinate.value if all(free) else ends[1 - i] + (-360.0, 360.0)[i]) if free[i] else ends[i]
                for i in (0, 1)
            ]
            ends[1] += 360.0 * all(free)
        if not all(map(math.isfinite, ends)):
            raise ValueError(
                f"{coordinate.name} slides without limits; say how far: sweep(name, start, stop)"
            )
        return (ends[0] if start is None else start), ends[1]

    def _driven(
        self, values: Mapping[str, Sequence[float] | Array]
    ) -> dict[DrivenBlock, tuple[list[int], list[Array]]]:
        """For each block the places of its driven coordinates and their values, metres and radians."""
        driven: dict[DrivenBlock, tuple[list[int], list[Array]]] = {}
        lengths: set[int] = set()
        for asked, given in values.items():
            name = self._named(asked)
            block, i = self._place[name]
            column = np.array(given, dtype=float)
            if column.ndim != 1 or not len(column) or not np.isfinite(column).all():
                raise ValueError(f"the values of {name} are no list of finite numbers")
            lengths.add(len(column))
            joint, freedom = block.joint(i)
            column = np.asarray(_counted(joint, freedom, column))
            places, columns = driven.setdefault(block, ([], []))
            if i in places:
                raise ValueError(f"{name} is named twice")
            places.append(i)
            columns.append(column)
        if len(lengths) != 1:
            raise ValueError("every coordinate needs as many values as the others, and one at least")
        for block, (places, _) in driven.items():
            rank = np.linalg.matrix_rank(block.rates[places], 1e-9) if len(places) > 1 else 1
            if rank < len(places):
                names = ", ".join(self.name_of(block, i) for i in places)
                raise ValueError(f"{names} move together; drive fewer of them")
        return driven

    def _stopped(self, run: Run, way: Way, frames: int) -> Stop:
        i = way.limit if way.limit is not None else run.driven[0]
        coordinate = self._coordinates[self.name_of(run.block, i)]
        joint, freedom = run.block.joint(i)
        value = way.bound if way.limit is not None else float(run.walk.values[0])
        return Stop(
            "dead point" if way.limit is None else "limit",
            coordinate.name,
            _shown(joint, freedom, value),
            coordinate.unit,
            frames,
        )

    def _branchings(self, runs: Sequence[Run]) -> tuple[Branching, ...]:
        found: list[Branching] = []
        for run in runs:
            coordinate = self._coordinates[self.name_of(run.block, run.driven[0])]
            joint, freedom = run.block.joint(run.driven[0])
            for frames, held in run.crossings():
                value = _shown(joint, freedom, float(held[0]))
                found.append(Branching(coordinate.name, value, coordinate.unit, frames))
        return tuple(found)

    def _trajectory(self, runs: Sequence[Run], frames: int, stop: Stop | None) -> Trajectory:
        assembly = self._assembly
        bodies = assembly.system.bodies
        turn = np.broadcast_to(np.eye(3), (frames, bodies, 3, 3)).copy()
        move = np.zeros((frames, bodies, 3))
        moving = {id(run.block): run for run in runs}
        for run in runs:
            own, center = assembly.freedoms[run.block.part].bodies, run.block.measured.system.center[1:]
            rotation, shift = run.poses(frames)
            turn[:, own] = rotation[:, 1:]
            move[:, own] = center + shift[:, 1:] - np.einsum("fbij,bj->fbi", rotation[:, 1:], center)
        _carry(assembly, turn, move)
        at = assembly.body[1:]
        poses = np.empty((frames, len(at), 7))
        if len(at):
            placed = [(pose.rotation, pose.translation) for pose in assembly.poses]
            rotation, translation = (np.array(column) for column in zip(*placed))
            poses[:, :, :3] = np.einsum("fnij,nj->fni", turn[:, at], translation) + move[:, at]
            poses[:, :, 3:] = without_flips(quaternions_from_matrices(turn[:, at] @ rotation))
        coordinates: dict[str, Array] = {}
        for name, (block, i) in self._place.items():
            joint, freedom = block.joint(i)
            run = moving.get(id(block))
            if run is None:
                column: Array = np.full(frames, self._coordinates[name].value)
            else:
                column = _shown(joint, freedom, run.column(i, frames))
            coordinates[name] = column
        gap = max((run.gap for run in runs), default=0.0)
        return Trajectory(self.parts, poses, coordinates, stop, gap, self._branchings(runs))


def _carry(assembly: Assembly, turn: Array, move: Array) -> None:
    """Displacements against each block's root to displacements, over all frames, in place."""
    blocks = assembly.blocks
    for bodies in blocks.generations():
        root = blocks.root[blocks.block[bodies]]
        move[:, bodies] = np.einsum("fbij,fbj->fbi", turn[:, root], move[:, bodies]) + move[:, root]
        turn[:, bodies] = turn[:, root] @ turn[:, bodies]


def _coordinate(name: str, joint: Joint, freedom: int, value: float) -> Coordinate:
    own = joint.freedoms[freedom]
    limits = (own.lower, own.upper) if own.motion is Motion.LIMITED else (-math.inf, math.inf)
    lower, upper = sorted(_shown(joint, freedom, x) for x in limits)
    at = _shown(joint, freedom, value)
    return Coordinate(name, joint.id, "deg" if freedom >= RX else "m", at, lower, upper)


def _shown(joint: Joint, freedom: int, value: Amount) -> Amount:
    """Metres or degrees of a coordinate as the source shows it."""
    (shown,) = joint.freedoms[freedom].displayed(value)
    return shown if freedom < RX else shown * math.degrees(1.0)


def _counted(joint: Joint, freedom: int, shown: Amount) -> Amount:
    """What ``_shown`` undoes: metres or radians from where the joint's frames meet."""
    return joint.freedoms[freedom].counted(shown if freedom < RX else shown * math.radians(1.0))


def _check_numbers(start: object, stop: object, frames: object) -> None:
    """Of a sweep.  Raises TypeError."""
    if isinstance(frames, bool) or not isinstance(frames, (int, np.integer)):
        raise TypeError(f"frames is {frames!r}; pass a whole number")
    for what, value in (("start", start), ("stop", stop)):
        if not (value is None or isinstance(value, (int, float, np.integer, np.floating))):
            raise TypeError(f"{what} is {value!r}; pass a number")
