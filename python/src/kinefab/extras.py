"""What installs the libraries of single formats.

A remedy names the libraries themselves, which pip brings into any environment that Kinefab runs in; an extra of a package
would have to be asked for where that package came from, a clone or an index.
"""

from __future__ import annotations

from collections.abc import Mapping

LIBRARIES: Mapping[str, tuple[str, ...]] = {
    "usd": ("usd-core",),
    "picture": ("pillow",),
    "meshes": ("assimp-py",),
    "urdf": ("xacro", "pycollada"),
    "cluster": ("distributed", "fsspec"),
    "s3": ("s3fs",),
    "decompose": ("coacd", "coal"),
    "cad": ("cadquery-ocp-novtk",),
    "com": ("pywin32",),
    "mujoco": ("mujoco",),
}
"""Of each extra in ``pyproject.toml``."""


def install(extra: str) -> str:
    """The command that installs what an extra brings.

    >>> install("urdf")
    'pip install xacro pycollada'
    """
    return " ".join(["pip install", *LIBRARIES[extra]])
