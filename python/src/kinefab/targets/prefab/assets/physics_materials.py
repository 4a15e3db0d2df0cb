"""How surfaces rub and bounce."""

from __future__ import annotations

from ....unity.scene import PhysicsMaterial
from ..text.dialects import Dialect
from ..text.documents import HEAD, version
from ..text.yaml import HEADER, Fields, document

PHYSICS_MATERIAL_ID = 13400000
PHYSICS_MATERIAL_ENDING = ".physicMaterial"
"""In every editor: the class got another name in Unity 6, its files did not (``InternalEditorUtility.cs`` of UnityCsReference)."""
COMBINE = {"Average": 0, "Multiply": 1, "Minimum": 2, "Maximum": 3}


def physics_material_asset(material: PhysicsMaterial, name: str, dialect: Dialect) -> bytes:
    fields: Fields = {
        "dynamicFriction": float(material.dynamicFriction),
        "staticFriction": float(material.staticFriction),
        "bounciness": float(material.bounciness),
        "frictionCombine": COMBINE[material.frictionCombine],
        "bounceCombine": COMBINE[material.bounceCombine],
    }
    kind = "PhysicMaterial"
    if dialect.physics_material > 1:
        kind = "PhysicsMaterial"
        fields = {f"m_{key[0].upper()}{key[1:]}": value for key, value in fields.items()}
    whole = {**HEAD, "m_Name": name, **version(dialect.physics_material), **fields}
    return (HEADER + document(134, kind, PHYSICS_MATERIAL_ID, whole)).encode("ascii")
