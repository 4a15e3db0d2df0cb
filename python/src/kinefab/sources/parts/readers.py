"""Which reader takes which mesh file of a part, by its ending, where the library for it is installed."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.util import find_spec

from ...geometry.files import Reader
from .exact import read_exact
from .guarded_meshes import read_guarded

EXACT = (".step", ".stp", ".iges", ".igs")
"""By OpenCASCADE; their unit stands in the file."""
VRML = (".wrl", ".vrml")
"""By OpenCASCADE too."""
ASSIMP = (".3ds", ".fbx", ".x3d")
ARCHIVE = ".3mf"
"""trimesh's where it has what it needs for it, else assimp's."""


def part_readers() -> Mapping[str, Reader]:
    """Reader by ending, lower case, of those whose libraries are there."""
    found: dict[str, Reader] = {}
    if find_spec("OCP") is not None:
        found |= dict.fromkeys(EXACT, read_exact) | dict.fromkeys(VRML, read_guarded)
    if find_spec("assimp_py") is not None:
        found |= dict.fromkeys(ASSIMP, read_guarded)
        if find_spec("networkx") is None or find_spec("lxml") is None:
            found[ARCHIVE] = read_guarded
    return found
