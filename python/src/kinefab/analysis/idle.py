"""Freedoms that move nothing else: a rod spinning between its two balls."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .assembly import Assembly


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
            others = np.ones(len(freedom.basis), dtype=bool)
            for body in leg:
                others[6 * place[body] : 6 * place[body] + 6] = False
            s = np.linalg.svd(freedom.basis[others], compute_uv=False)
            count = freedom.mobility - int(np.sum(s > 1e-6))
            if count:
                nodes = [n for n in range(len(assembly.scene.nodes)) if int(assembly.body[n + 1]) in leg]
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
