"""USD stages with UsdPhysics: right-handed, +Y up, metres, kilograms, so nothing is mirrored.

Only this room and ``sources/usd`` import pxr.  Everything is authored as specs of one layer (``prims``), since vendors'
schemas (Physx*, Newton*) are not registered in plain usd-core and the order of what is written is then ours.

Road: ``bodies`` says which nodes are bodies and where their prims hang, ``stage`` writes them, ``looks`` and ``physics``
what is on them, ``files`` the layer as text, as a crate or as a package.
"""

from .files import write

__all__ = ["write"]
