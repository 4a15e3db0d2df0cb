"""Freedoms that move nothing else: a rod spinning between its two balls."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .assembly import Assembly


ALONE = 1e-12
"""Share of a motion, squared, that all other bodies may have in it."""


@dataclass(frozen=True, slots=True)
class IdleFreedom:
    """Freedoms of some nodes that move nothing else, such as a rod's spin."""

    nodes: tuple[int, ...]
    count: int


def idle_freedoms(assembly: Assembly) -> list[IdleFreedom]:
    """Freedoms of a single body, or of a leg of bodies between two others, that move nothing else."""
    neighbours: dict[int, set[int]] = {}
    low, high = assembly.system.body_a, assembly.system.body_b
    for i, j in set(zip(low.tolist(), high.tolist())):
        neighbours.setdefault(i, set()).add(j)
        neighbours.setdefault(j, set()).add(i)
    found = []
    for freedom in assembly.freedoms:
        if freedom.mobility < 2 or len(freedom.bodies) < 2:
            continue
        place = {int(b): k for k, b in enumerate(freedom.bodies)}
        for leg in _legs(freedom.bodies.tolist(), neighbours):
            if len(leg) == len(freedom.bodies):
                continue
            own = np.concatenate([freedom.basis[6 * place[b] : 6 * place[b] + 6] for b in leg])
            # columns are orthonormal: what is wholly in the leg's rows has nothing left for all others
            count = int(np.sum(np.linalg.svd(own, compute_uv=False) ** 2 > 1.0 - ALONE))
            if count:
                nodes = sorted(n for body in leg for n in assembly.nodes[body])
                found.append(IdleFreedom(tuple(nodes), count))
    return found


def _legs(bodies: list[int], neighbours: dict[int, set[int]]) -> list[list[int]]:
    """Chains of bodies with two neighbours each, as long as they go; other bodies by themselves."""
    inside, seen, legs = set(bodies), set(), []
    for body in bodies:
        if body in seen:
            continue
        leg = [body]
        seen.add(body)
        if len(neighbours[body]) == 2:
            for start in sorted(neighbours[body]):
                following = start
                while following in inside and following not in seen and len(neighbours[following]) == 2:
                    seen.add(following)
                    leg.append(following)
                    following = next((n for n in sorted(neighbours[following]) if n not in seen), -1)
        legs.append(leg)
    return legs
