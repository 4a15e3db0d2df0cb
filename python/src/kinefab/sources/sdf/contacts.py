"""Links of one model pass through each other, unless it says ``self_collide`` (SDFormat: model, link)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations

from ...diagnostics import Report
from ...model import Apart, Scene
from ..robots.rigid_links import Carrier, Link
from ..robots.xml_elements import truth
from .scopes import Entry, Scope, visible

MOST_PAIRS = 2_000
"""Of one model: beyond that engines would spend their time on them."""


def keep_apart(
    scene: Scene,
    entries: Sequence[Entry],
    links: Sequence[Link],
    carriers: Sequence[Carrier],
    joined: Iterable[tuple[int, int]],
    report: Report,
) -> None:
    """Fill ``scene.apart``: two links of a model collide where one of them says so, and never when a joint connects them.

    joined: indices of links that joints connect.
    """
    known = {frozenset((carriers[a].node, carriers[b].node)) for a, b in joined}
    of_model: dict[Scope, list[int]] = {}
    for i, entry in enumerate(entries):
        if links[i].touched and not entry.owner.static and entry.element.tag == "link":
            of_model.setdefault(visible(entry.owner), []).append(i)
    links_of = Counter(carriers[i].node for own in of_model.values() for i in own)
    for model, own in of_model.items():
        whole = truth(model.element.content("self_collide"))
        alone = [i for i in own if not truth(entries[i].element.content("self_collide"), whole)]
        _keep(scene, model, Counter(carriers[i].node for i in alone), links_of, known, report)


def _keep(
    scene: Scene,
    model: Scope,
    alone: Mapping[int, int],
    links_of: Mapping[int, int],
    known: set[frozenset[int]],
    report: Report,
) -> None:
    """alone: of each node how many links of the model on it ask for no collisions.  links_of: how many there are on it at all."""
    pairs = [pair for pair in combinations(alone, 2) if frozenset(pair) not in known]
    reason = f"self_collide of model {model.name}"
    if len(pairs) > MOST_PAIRS:
        report.dropped(f"{reason}: {len(pairs)} pairs of links", "ELEMENT_DROPPED", model.element.where)
        return
    for a, b in pairs:
        known.add(frozenset((a, b)))
        if all(alone[node] == links_of[node] for node in (a, b)):
            scene.apart.append(Apart(a, b, reason, model.element.where, stated=False))
        else:
            ids = (scene.nodes[a].id, scene.nodes[b].id)
            report.dropped(f"{reason} of {ids[0]} and {ids[1]}", "PAIR_DROPPED", model.element.where, a=ids[0], b=ids[1])
