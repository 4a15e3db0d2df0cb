"""The mates as a table for people."""

from __future__ import annotations

from ..model import Scene
from .mate import AUTO, Mates


def listing(scene: Scene, found: Mates) -> str:
    """A line a mate: number, confidence (``?``: below what ``auto`` takes), what it leaves, the parts, what was seen; then the
    ground and what is loose."""
    names = [" - ".join(scene.nodes[side.node].id for side in mate.sides) for mate in found.mates]
    width = max(map(len, names), default=0)
    lines = [
        f"{mate.number:4}  {mate.confidence:.2f}{' ' if mate.confidence >= AUTO else '?'} {mate.joint:<12} {name:<{width}}  {mate.reason}"
        for mate, name in zip(found.mates, names, strict=True)
    ]
    if lines:
        lines.insert(0, f"  no  conf  {'joint':<12} {'parts':<{width}}  seen")
    if found.ground is not None:
        lines.append(f"ground: {scene.nodes[found.ground].id} ({found.ground_reason})")
    if found.loose:
        lines.append("held by none: " + ", ".join(scene.nodes[node].id for node in found.loose))
    return "\n".join(lines)
