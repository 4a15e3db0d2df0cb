"""Products of a STEP file: their names, and which of them state no shape (ISO 10303-41 and -43)."""

from __future__ import annotations

import re
from collections import defaultdict

from ..entities import EntityError, Ref, entity, ref, text_of
from ..part21 import Part21, references

PLACEMENTS = frozenset({"AXIS2_PLACEMENT_3D", "AXIS1_PLACEMENT", "PLACEMENT"})
_SHAPED = re.compile(rb"=\s*(SHAPE_DEFINITION_REPRESENTATION\s*\([^;]*)")
_RELATED = re.compile(rb"=\s*\(?\s*(?:SHAPE_)?REPRESENTATION_RELATIONSHIP\s*\(([^;]*)")


def name_of(text: Part21, definition: int) -> str:
    """The name of the product that a product definition is of.  Raises EntityError."""
    row = entity(text, definition).get("PRODUCT_DEFINITION")
    if row is None:
        raise EntityError("it is stated of no product, but of a piece of one")
    formation = next(iter(entity(text, ref(row, 2)).values()))
    product = entity(text, ref(formation, 2)).get("PRODUCT", [])
    return text_of(product, 1) or text_of(product, 0)


def shapeless(text: Part21) -> frozenset[str]:
    """Names of the products whose shapes are placements alone: components that hold sketches, or nothing as yet."""
    if text.external_files():
        return frozenset()  # shapes are there that this text does not hold
    beside = _related(text)
    found: defaultdict[str, bool] = defaultdict(bool)
    for match in _SHAPED.finditer(text.plain):
        shape, representation = references(match[1])[:2]
        try:
            definition = ref(entity(text, shape).get("PRODUCT_DEFINITION_SHAPE", []), 2)
            found[name_of(text, definition)] |= _has_shape(text, representation, beside)
        except (EntityError, ValueError):  # of a usage, or damaged
            continue
    return frozenset(name for name, shaped in found.items() if not shaped)


def _related(text: Part21) -> defaultdict[int, set[int]]:
    """Representations that say the same of one product, by each other; not those that an assembly places."""
    found: defaultdict[int, set[int]] = defaultdict(set)
    for match in _RELATED.finditer(text.plain):
        ends = references(match[1])[:2]
        if len(ends) == 2 and b"WITH_TRANSFORMATION" not in match[1]:
            found[ends[0]].add(ends[1])
            found[ends[1]].add(ends[0])
    return found


def _has_shape(text: Part21, representation: int, beside: defaultdict[int, set[int]]) -> bool:
    """Whether a representation, or one beside it, has an item that is no placement.  Raises EntityError."""
    front = [representation]
    for one in front:  # grows
        front += sorted(beside[one] - set(front))
        items = [*next(iter(entity(text, one).values())), None, None][1]
        for item in items if isinstance(items, list) else []:
            if not isinstance(item, Ref) or not PLACEMENTS & entity(text, item.number).keys():
                return True
    return False
