"""How far first order can be trusted: which velocities grow into finite motions.

At a change point, a dead centre or on a mechanism that is singular all along its path, the null space of
the Jacobian is larger than the set of motions.  A velocity counts when a step along it, brought back onto
the constraints, is still there: an obstructed one shrinks with the square root of the closing tolerance.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from ...spatial import Array
from ..equations.solve import FEW, Solver
from ..equations.system import State
from .branches import NOISY_GAP, held_there, largest_branch, mixtures_move
from .first_order import BlockFreedom, block_freedoms
from .independent import independent_velocities
from .noise import moves_up_to_noise, noise_of
from .probes import OPEN, STEP, TELLING, WHOLE, floor_of, kept_of, left_of, random_direction, trial
from .second_order import second_order
from .stacks import alike

SURVIVES = 5.0
"""Relative change of a random step, over its size, by which the whole null space still counts as motions: their own curvature
changes it by about its size."""
DIRECTION = 0.05
"""Share of its length that a step must keep to count as a motion of its own."""
HALF = 0.5
"""Share above which it counts where it stays in doubt: a motion keeps all of itself, what is obstructed less each time."""
MOST_DIRECTIONS = 12
"""Directions tried at the start pose itself; beyond, the tangent is the one found some steps away."""
MOST_WORK = 1_000
"""Directions times unknowns tried one by one; beyond, random ones are tried until they add nothing."""
MOST_SAMPLES = 30
"""Random directions tried; beyond, the first-order mobility some steps away stands as an upper bound."""
SPARE = 3
LONG_STEP = 3e-2
"""Size of their trial steps: what obstructs a long chain shows at the root of its closing error, far above STEP's."""
FURTHER = 0.1
"""Size of the last step to where these start: larger, or they fall back to the singular pose and onto its other branches."""
MOST_FURTHER = 5
"""Such steps, while what is left of some velocity is in doubt."""
PROBES = (STEP, 1e-2, 0.2)
"""Sizes of the trial steps of a singular part, each where the one before does not tell."""
BESIDE = 10.0
"""Times the error asked for up to which a trial step came back onto the rows."""
MOST_FORMS = 1_000_000
"""Squares of directions, times unknowns, up to which what second order leaves of many bodies' velocities is worth its time."""
WAYS = 3
"""Of many bodies, from the start pose, while fewer motions are found than it has directions: the largest branch counts."""
WALK = 3
WALK_STEP = 0.05
NOISE = 1e-9
"""Residual at the start beyond which it is none of rounding."""
MOVES = 1e-6
"""Share of a velocity up to which a body stands still in it."""


@dataclass(slots=True, eq=False)
class FiniteFreedom:
    """A block's finite motions.

    mobility: their number.  tangent: scaled twists that lead into them, shape (6 n, mobility), near the
    start pose; exact (the null space) where nothing is obstructed.  singular: whether something is.
    """

    mobility: int
    tangent: Array
    singular: bool


def finite_freedoms(solver: Solver, first_order: list[BlockFreedom], start: State) -> list[FiniteFreedom]:
    """Finite mobility of every part.

    Rows that are independent at a pose make a smooth set of poses there, so only parts with redundant
    rows (and something to move) need a trial.
    """
    found = [FiniteFreedom(f.mobility, f.basis, False) for f in first_order]
    doubtful = np.array([f.mobility > 0 and len(f.rows) > f.rank for f in first_order], dtype=bool)
    if doubtful.any():
        draw, blocks = np.random.default_rng(11), dict(enumerate(first_order))
        floor = floor_of(solver, start)
        for part in np.flatnonzero(doubtful).tolist():
            noisy = first_order[part].gap < NOISY_GAP or floor[part] > NOISE
            doubtful[part] = not (noisy and moves_up_to_noise(solver.alone(part), first_order[part]))
        for step in PROBES[:2]:
            directions = _random_directions(blocks, np.flatnonzero(doubtful).tolist(), draw)
            if not directions:
                break
            moved, left, there = trial(solver, blocks, start, directions, step, floor)
            changed = _changed(directions, moved, SURVIVES * step)
            # what does not come back onto the rows may have kept its length for that alone
            beside = [p for p in directions if left[p] > BESIDE * floor[p]]
            held = held_there(solver, blocks, there, doubtful) if step == PROBES[1] else []
            for part in sorted({*changed, *beside, *held}):
                searched = _searched(solver, part, first_order[part])
                if searched.mobility < first_order[part].mobility:
                    found[part] = searched
                doubtful[part] = False
    return found


def _random_directions(
    first_order: Mapping[int, BlockFreedom], parts: list[int], draw: np.random.Generator
) -> dict[int, Array]:
    """As ``random_direction``, of many parts."""
    numbers = [draw.standard_normal((first_order[p].mobility,)) for p in parts]
    found: dict[int, Array] = dict.fromkeys(parts, np.zeros(0))
    for _, group in alike(first_order[p].basis.shape for p in parts):
        members: list[int] = group.tolist()
        bases = np.array([first_order[parts[i]].basis for i in members])
        directions = (bases @ np.array([numbers[i] for i in members])[..., None])[..., 0]
        directions /= np.abs(directions).max(axis=1)[:, None]
        found.update(zip((parts[i] for i in members), directions))
    return found


def _changed(directions: Mapping[int, Array], moved: Mapping[int, Array], most: float) -> list[int]:
    """Parts of whose direction a trial step has changed more than a share, ascending."""
    parts, changed = list(directions), list[int]()
    for _, group in alike(directions[p].shape for p in parts):
        places: list[int] = group.tolist()
        members = [parts[i] for i in places]
        wanted, kept = (np.array([own[p] for p in members]) for own in (directions, moved))
        lost = np.linalg.norm(kept - wanted, axis=1) > most * np.linalg.norm(wanted, axis=1)
        changed += [p for p, gone in zip(members, lost.tolist()) if gone]
    return sorted(changed)


def displaced(solver: Solver, first_order: Mapping[int, BlockFreedom], start: State) -> dict[int, Array]:
    """Displacements over STEP of some parts' bodies after a random small motion, by part, shape (6 n,) each."""
    directions = {p: random_direction(f.basis, np.random.default_rng(11)) for p, f in first_order.items()}
    return trial(solver, first_order, start, directions, furthest=STEP)[0] if directions else {}


def stepped(
    solver: Solver, first_order: list[BlockFreedom], start: State, size: float, draw: np.random.Generator
) -> State:
    """A pose of all parts after a random step of ``size``, radians or fractions of the length, and back onto the rows."""
    moving = [f for f in first_order if f.mobility]
    if not moving:
        return start
    twists = [size * random_direction(f.basis, draw).reshape(-1, 6) for f in moving]
    return solver.project(
        solver.system.moved(start, np.concatenate([f.bodies for f in moving]), np.concatenate(twists))
    )[0]


def walked(solver: Solver, part: int, first_order: BlockFreedom, start: State, seed: int = 5) -> State:
    """A pose some random steps away, to leave an isolated singular one."""
    draw = np.random.default_rng(seed)
    active, floor = np.arange(solver.parts) == part, floor_of(solver, start)
    state, basis = start, first_order.basis
    for _ in range(WALK):
        if not basis.shape[1]:
            break
        twist = WALK_STEP * random_direction(basis, draw).reshape(-1, 6)
        there, left = solver.project(solver.system.moved(state, first_order.bodies, twist), active, floor)
        if left[part] > OPEN * floor[part]:
            continue
        state, basis = there, block_freedoms(solver, there)[part].basis
    return state


def _searched(solver: Solver, part: int, first_order: BlockFreedom) -> FiniteFreedom:
    """Walk away from the start pose, then try every direction of the null space there: up to what its rows are off by."""
    system = solver.alone(part)
    solver, part = Solver(system, cautious=True, noise=noise_of(system, first_order.rank)), 0
    first_order = replace(first_order, bodies=np.arange(1, solver.system.bodies))
    start = solver.system.start()
    if len(first_order.basis) > FEW and first_order.mobility**2 * len(first_order.basis) <= MOST_FORMS:
        of_many = _of_many(solver, first_order, start)
        if of_many is not None:
            return of_many
    away = walked(solver, part, first_order, start)
    there = block_freedoms(solver, away)
    if there[part].mobility * len(first_order.basis) > MOST_WORK:
        return _found_far_away(solver, part, there, away)
    floor = floor_of(solver, start)
    tangent = _beyond_doubt(solver, part, there[part], away, floor)
    if tangent.shape[1] == 0:
        return FiniteFreedom(*_with_bodies_at_rest(solver, first_order, start), True)
    if first_order.mobility > MOST_DIRECTIONS:
        return FiniteFreedom(tangent.shape[1], tangent, True)
    here = _survivors(solver, part, first_order, start)
    if here.shape[1] > tangent.shape[1]:  # the way led onto a smaller branch, or several branches meet here
        away = walked(solver, part, first_order, start, seed=6)
        other = _beyond_doubt(solver, part, block_freedoms(solver, away)[part], away, floor)
        tangent = other if other.shape[1] > tangent.shape[1] else tangent
    if here.shape[1] > tangent.shape[1]:
        at_rest = _with_bodies_at_rest(solver, first_order, start)[1]
        tangent = at_rest if at_rest.shape[1] > tangent.shape[1] else tangent
    return FiniteFreedom(tangent.shape[1], here if here.shape[1] == tangent.shape[1] else tangent, True)


def _of_many(solver: Solver, first_order: BlockFreedom, start: State) -> FiniteFreedom | None:
    """As ``_searched``, of a solver's only part of many bodies: only velocities are tried that second order leaves.  Where it
    obstructs many at once, steps along mixtures lead back to where they began.  None where it stays in doubt what moves."""
    floor, found = floor_of(solver, start), np.zeros((len(first_order.basis), 0))
    here = second_order(solver, first_order, start)
    most = max(1, here.basis(np.random.default_rng(WAYS)).shape[1])
    for seed in range(WAYS):
        if found.shape[1] >= most:
            break
        draw = np.random.default_rng(seed)
        freedom, left, state, tangent = first_order, here, start, found[:, :0]
        for step in range(WALK + MOST_FURTHER):
            if step >= WALK:
                tried = replace(freedom, basis=left.basis(draw))
                tangent, is_sure = tried.basis, True
                if tried.mobility:
                    ways, share, _ = kept_of(solver, 0, tried, state, LONG_STEP)
                    tangent, is_sure = ways[:, share > HALF], not np.any((share > DIRECTION) & (share < WHOLE))
                if is_sure and mixtures_move(solver, 0, freedom, state, tangent, LONG_STEP, floor_of(solver, state)):
                    break
                if step == WALK + MOST_FURTHER - 1:
                    return None
            twist = (WALK_STEP if step < WALK else FURTHER) * left.one(draw).reshape(-1, 6)
            there, open_ = solver.project(solver.system.moved(state, first_order.bodies, twist), None, floor)
            if open_[0] <= OPEN * floor[0]:
                state, freedom = there, block_freedoms(solver, there)[0]
                left = second_order(solver, freedom, state)
        found = tangent if tangent.shape[1] > found.shape[1] else found
    return FiniteFreedom(found.shape[1], found, True)


def _beyond_doubt(solver: Solver, part: int, freedom: BlockFreedom, state: State, floor: Array) -> Array:
    """As ``_survivors``; while some velocity keeps a part of itself only, as where two branches of motions touch each other, from
    poses further away.  floor: of the pose where the walk to the state began."""
    ways, share, step = freedom.basis, np.ones(freedom.mobility), STEP
    for further in range(MOST_FURTHER):
        if further:
            there, freedoms = _further(solver, part, freedom, state)
            if there is state:  # no step led away, and none would from the same pose again
                break
            state, freedom = there, freedoms[part]
        if not freedom.mobility:
            return freedom.basis
        all_move = independent_velocities(solver, freedom, state, float(floor[part]))
        if all_move is not None:
            return all_move
        for step in PROBES:
            ways, share, open_ = kept_of(solver, part, freedom, state, step, floor)
            if open_ <= min(BESIDE * floor[part], (TELLING * step) ** 4):
                break
        ways, share = ways[:, share > DIRECTION], share[share > DIRECTION]
        if not np.any(share < WHOLE) and mixtures_move(solver, part, freedom, state, ways, step, floor):
            return ways
    ways = ways[:, share > HALF]
    return ways if np.any(share < WHOLE) else largest_branch(solver, part, freedom, state, ways, step, floor)


def _found_far_away(
    solver: Solver, part: int, there: list[BlockFreedom], away: State
) -> FiniteFreedom:
    """The motions of a part with many velocities, by random ones, some steps further from ``away``.

    A velocity is a motion or none; where one keeps a part of itself, the step fell back to a singular pose, and which
    rounding decides: so another one is taken from there."""
    for _ in range(MOST_FURTHER):
        away, there = _further(solver, part, there[part], away)
        sampled = _sampled(solver, part, there[part], away)
        if sampled is None:
            return FiniteFreedom(there[part].mobility, there[part].basis, True)
        if sampled.shape[1] < 2:
            break
        # What an obstructed velocity left of itself is no motion, and does not go on.
        ways, share, _ = kept_of(solver, part, replace(there[part], basis=sampled), away, LONG_STEP)
        sampled = ways[:, share > DIRECTION]
        if share.min() > WHOLE:
            break
    return FiniteFreedom(sampled.shape[1], sampled, True)


def _with_bodies_at_rest(solver: Solver, first_order: BlockFreedom, start: State) -> tuple[int, Array]:
    """Mobility and tangent at ``start`` where nothing survives of random velocities, of the solver's only part.

    An obstructed velocity can take a motion beside it along, back to where both began: two cranks that turn about one
    axis in a linkage that cannot move else.  So velocities are tried by themselves in which bodies stand still.
    """
    found = 0, np.zeros((len(first_order.basis), 0))
    if not 1 < first_order.mobility <= MOST_DIRECTIONS:
        return found
    for way in _velocities_at_rest(first_order):
        left, *_ = left_of(solver, 0, first_order, start, way, STEP)
        if np.linalg.norm(left) < 1.0 - DIRECTION:
            continue
        twist = WALK_STEP * (way / np.abs(way).max()).reshape(-1, 6)
        floor = floor_of(solver, start)
        state, _ = solver.project(solver.system.moved(start, first_order.bodies, twist), None, floor)
        tangent = _beyond_doubt(solver, 0, block_freedoms(solver, state)[0], state, floor)
        if tangent.shape[1] > found[0]:
            found = tangent.shape[1], left[:, None] if tangent.shape[1] == 1 else tangent
    return found


def _velocities_at_rest(freedom: BlockFreedom) -> list[Array]:
    """Velocities of a block, shape (6 n,), that are the only ones with some of its bodies at rest."""
    found: list[Array] = []
    for first in range(len(freedom.bodies)):
        basis = freedom.basis
        for k in range(len(freedom.bodies)):
            body = (first + k) % len(freedom.bodies)
            _, s, vt = np.linalg.svd(basis[6 * body : 6 * body + 6])
            rank = int(np.sum(s > MOVES))
            if rank < basis.shape[1]:
                basis = basis @ vt[rank:].T
        way = basis[:, 0] / np.linalg.norm(basis[:, 0])
        if basis.shape[1] == 1 and all(abs(way @ other) < 1.0 - MOVES for other in found):
            found.append(way)
    return found


def _further(
    solver: Solver, part: int, freedom: BlockFreedom, state: State
) -> tuple[State, list[BlockFreedom]]:
    """A pose further away, and the first order there: of many random velocities the obstructed ones take the others
    along, so that the pose has hardly moved; what a trial step leaves of one is a motion that goes on."""
    random = random_direction(freedom.basis, np.random.default_rng(29))
    way, *_ = left_of(solver, part, freedom, state, random, LONG_STEP)
    if (size := np.abs(way).max()) > 0.0:
        twist = FURTHER * (way / size).reshape(-1, 6)
        state, _ = solver.project(
            solver.system.moved(state, freedom.bodies, twist), None, floor_of(solver, state)
        )
    return state, block_freedoms(solver, state)


def _survivors(solver: Solver, part: int, freedom: BlockFreedom, state: State) -> Array:
    """Orthonormal directions that trial steps both ways keep, shape (6 n, m): of the first size of steps that leaves none in doubt,
    since noise hides in a small one what obstructs a direction; of the smallest where all do."""
    found: Array | None = None
    for step in PROBES if freedom.mobility else ():
        ways, share, _ = kept_of(solver, part, freedom, state, step)
        kept = ways[:, share > DIRECTION]
        found = kept if found is None else found
        if not np.any((share > DIRECTION) & (share < WHOLE)):
            return kept
    return np.zeros((len(freedom.bodies) * 6, 0)) if found is None else found


def _sampled(solver: Solver, part: int, freedom: BlockFreedom, state: State) -> Array | None:
    """As ``_survivors``, from random directions: what is left of one lies in the motions, so that a few more than
    their number span them all.  None where ``MOST_SAMPLES`` are not enough."""
    draw = np.random.default_rng(31)
    kept: list[Array] = []
    for _ in range(MOST_SAMPLES):
        kept.append(left_of(solver, part, freedom, state, random_direction(freedom.basis, draw), LONG_STEP)[0])
        u, s, _ = np.linalg.svd(np.array(kept).T, full_matrices=False)
        # A random direction's share of one motion.
        least = DIRECTION * max(s[0], 1.0 / np.sqrt(freedom.mobility))
        if (found := int(np.sum(s > least))) <= len(kept) - SPARE:
            return u[:, :found]
    return None
