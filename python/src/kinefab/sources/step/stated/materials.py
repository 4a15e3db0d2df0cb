"""Densities that a STEP file states of its products, as properties of their materials.

Sources: CAx-IF, Recommended Practices for Material Identification and Density 2.1, section 4.2; ISO 10303-41 (units).
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace

from ....diagnostics import Report, is_encodable
from ....model import Node, Scene
from ...reading.record import shown
from ..entities import EntityError, Ref, Value, entity, number, ref, text_of
from ..part21 import METRES_OF_PREFIX, Part21
from .products import name_of

MATERIAL = b"material property"
POUND, OUNCE = 0.45359237, 0.028349523125
KILOGRAMS = {
    "POUND": POUND,
    "LB": POUND,
    "LBM": POUND,
    "POUND_MASS": POUND,
    "OUNCE": OUNCE,
    "TONNE": 1e3,
    "TON": 1e3,
}
METRES = {"INCH": 0.0254, "IN": 0.0254, "FOOT": 0.3048, "FT": 0.3048}
"""Units that are named and not derived from another one."""
MOST_STEPS = 8
"""Units that are defined by units."""
_ENTITY = re.compile(rb"#\s*(\d+)\s*=\s*(PROPERTY_DEFINITION(?:_REPRESENTATION)?)\s*\(")


def add_densities(scene: Scene, text: Part21, report: Report) -> None:
    """Give the bodies of each product the density that the file states of it; one that cannot be read is told."""
    if MATERIAL not in text.data:
        return
    found: dict[str, set[float]] = {}
    users = {_product_of(node) for node in scene.nodes if node.bodies}
    for property_, representation in _properties(text):
        product = ""
        try:
            product = name_of(text, ref(property_, 2))
            if product in users:
                found.setdefault(product, set()).update(_densities(text, representation))
        except EntityError as error:
            _left(scene, product, str(error), report)
    for product, densities in sorted(found.items()):
        if len(densities) > 1:
            _left(scene, product, "several products have its name, or it has several", report)
        elif densities:
            density = densities.pop()
            for i, node in enumerate(scene.nodes):
                if node.bodies and _product_of(node) == product:
                    bodies = tuple(replace(body, density=density) for body in node.bodies)
                    scene.nodes[i] = replace(node, bodies=bodies)


def _product_of(node: Node) -> str:
    return (node.definition or "").removesuffix(" (mirrored)")


def _left(scene: Scene, product: str, reason: str, report: Report) -> None:
    name = shown(product) if product and is_encodable(product) else "a product"
    report.dropped(f"density of {name}", "STEP_DENSITY", scene.source.uri, name=name, reason=reason)


def _properties(text: Part21) -> Iterator[tuple[list[Value], int]]:
    """Each material property that says a density: its arguments, and the instance of its representation."""
    stated: dict[int, list[Value]] = {}
    represented: list[list[Value]] = []
    for match in _ENTITY.finditer(text.plain):
        try:
            row = entity(text, int(match[1])).get(match[2].decode(), [])
        except EntityError:  # what is damaged OpenCASCADE leaves out
            continue
        if match[2] != b"PROPERTY_DEFINITION":
            represented.append(row)
        elif text_of(row, 0).lower() == MATERIAL.decode() and "density" in text_of(row, 1).lower():
            stated[int(match[1])] = row
    for row in represented:
        if len(row) > 1 and isinstance(row[0], Ref) and isinstance(row[1], Ref) and row[0].number in stated:
            yield stated[row[0].number], row[1].number


def _densities(text: Part21, representation: int) -> Iterator[float]:
    """kg/m^3 of the measures of a representation.

    The exponents of their unit are not looked at: OpenCASCADE and Autodesk write 3 and 2, and 0 and 0, where gram per cubic
    centimetre is meant.
    """
    items = [*next(iter(entity(text, representation).values())), None, None][1]
    for item in items if isinstance(items, list) else []:
        given = entity(text, item.number) if isinstance(item, Ref) else {}
        row = given.get("MEASURE_WITH_UNIT") or given.get("MEASURE_REPRESENTATION_ITEM", [])[1:]
        if not row:
            continue
        value = number(row, 0)
        unit = entity(text, ref(row, 1)).get("DERIVED_UNIT", [])
        elements = unit[0] if unit and isinstance(unit[0], list) else []
        factors = [_factor(text, ref(_element(text, element), 0), 0) for element in elements]
        masses = [factor for factor, is_mass in factors if is_mass]
        lengths = [factor for factor, is_mass in factors if not is_mass]
        if value is None or len(masses) != 1 or len(lengths) != 1:
            raise EntityError("its unit is not a mass and a length")
        if not value > 0.0:
            raise EntityError(f"it is {value:g}")
        yield float(f"{value * masses[0] / lengths[0] ** 3:.12g}")


def _element(text: Part21, element: Value) -> list[Value]:
    return entity(text, element.number).get("DERIVED_UNIT_ELEMENT", []) if isinstance(element, Ref) else []


def _factor(text: Part21, unit: int, step: int) -> tuple[float, bool]:
    """Kilograms or metres in a unit, and whether it is one of mass.  Raises EntityError for any other."""
    given = entity(text, unit)
    is_mass = "MASS_UNIT" in given
    if step < MOST_STEPS and (is_mass or "LENGTH_UNIT" in given):
        if (row := given.get("SI_UNIT")) is not None:
            prefix = getattr(row[0], "text", "") if row else ""
            if prefix.encode() in METRES_OF_PREFIX:
                return METRES_OF_PREFIX[prefix.encode()] * (1e-3 if is_mass else 1.0), is_mass
        elif (row := given.get("CONVERSION_BASED_UNIT")) is not None:
            named = (KILOGRAMS if is_mass else METRES).get(text_of(row, 0).strip().upper())
            if named is not None:
                return named, is_mass
            measured = entity(text, ref(row, 1)).items()
            empty: list[Value] = []
            measure = next((arguments for name, arguments in measured if name.endswith("WITH_UNIT")), empty)
            value, of = number(measure, 0), _factor(text, ref(measure, 1), step + 1)[0]
            if value is not None and value > 0.0:
                return value * of, is_mass
    raise EntityError("its unit is not a mass and a length")
