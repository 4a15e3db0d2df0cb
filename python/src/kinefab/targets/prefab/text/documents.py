"""An object of a Unity file, and the fields that all of them begin with."""

from __future__ import annotations

from .forms import BLANK
from .yaml import NULL, Fields, local

HEAD: Fields = {
    "m_ObjectHideFlags": 0,
    "m_CorrespondingSourceObject": NULL,
    "m_PrefabInstance": NULL,
    "m_PrefabAsset": NULL,
}
NO_LAYERS: Fields = {"serializedVersion": 2, "m_Bits": 0}
"""A mask of layers without any."""


COMPONENT: Fields = {**HEAD, "m_GameObject": BLANK}
"""With which every component's form begins."""


def version(number: int) -> Fields:
    """The line that tells a class's version; the first is not told."""
    return {"serializedVersion": number} if number > 1 else {}


def component_head(game_object: int) -> Fields:
    return {**HEAD, "m_GameObject": local(game_object)}


def layers(told: bool) -> Fields:
    """Layers that a body or collider treats otherwise than the project does: none."""
    return {"m_IncludeLayers": NO_LAYERS, "m_ExcludeLayers": NO_LAYERS} if told else {}
