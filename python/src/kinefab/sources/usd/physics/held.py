"""Bodies that a fixed joint holds to the world: no force moves them, so their meshes collide as they are."""

from __future__ import annotations

from ..api import UsdPhysics
from ..found import Found, body_above
from ..values import Values

WORLD = -1


def held_parts(found: Found, values: Values) -> frozenset[int]:
    """Numbers of the parts that fixed joints hold to what stands still, one by way of another."""
    beside: dict[int, list[int]] = {}
    for entry in found.joints:
        prim = entry.prim
        if not prim.IsA(UsdPhysics.FixedJoint) or not values.flag(prim, "physics:jointEnabled", True):
            continue
        if values.authored(prim, "physics:breakForce") or values.authored(prim, "physics:breakTorque"):
            continue
        ends: list[int] = []
        for side in (0, 1):
            targets = values.targets(prim, f"physics:body{side}")
            part = body_above(entry.meant(str(targets[0].GetPrimPath())), found) if targets else WORLD
            ends.append(part if part >= 0 and found.parts[part].body and found.parts[part].enabled else WORLD)
        beside.setdefault(ends[0], []).append(ends[1])
        beside.setdefault(ends[1], []).append(ends[0])
    held, waiting = {WORLD}, [WORLD]
    while waiting:
        fresh = [part for part in beside.get(waiting.pop(), ()) if part not in held]
        held.update(fresh)
        waiting += fresh
    return frozenset(held - {WORLD})
