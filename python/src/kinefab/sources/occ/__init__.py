"""OpenCASCADE shapes as meshes, for the formats whose geometry is an exact B-rep.

``triangles`` holds what comes out and needs no OpenCASCADE; ``tessellation`` needs it (the extra ``cad``)
and is imported where a shape is at hand, after ``available()`` has said that it can be.
"""

from __future__ import annotations

from importlib.util import find_spec

EXTRA = "cad"
"""The package's extra that brings OpenCASCADE."""


def available() -> bool:
    """Whether OpenCASCADE's Python binding is installed."""
    return find_spec("OCP") is not None
