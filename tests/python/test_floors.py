"""The architecture: imports only point down, and heavy or foreign libraries stay where they belong."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[2] / "python" / "src" / "kinefab"

FLOORS = [
    {"spatial", "diagnostics", "options", "replacing"},
    {"model"},
    {"geometry", "rigid"},
    {"sources", "analysis", "unity", "builder"},
    {"pipeline", "inspection"},
    {"cli"},
    {"__main__", "__init__"},
]
"""From the ground up.  Rooms on one floor do not import each other, but for those in NEIGHBOURS."""

NEIGHBOURS = {("geometry", "rigid"), ("diagnostics", "options")}

HOMES = {"trimesh": {"geometry", "builder"}, "scipy": {"analysis", "geometry"}, "typer": {"cli"}, "rich": {"cli"}}
"""Where a library may be imported."""


def imports(path: Path) -> list[tuple[str, str]]:
    """('own' or 'library', name) of everything that a module imports, inside functions too."""
    module = path.relative_to(PACKAGE.parent).with_suffix("").parts
    found = []
    for statement in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(statement, ast.Import):
            found += [("library", alias.name.split(".")[0]) for alias in statement.names]
        elif isinstance(statement, ast.ImportFrom) and statement.level == 0:
            found.append(("library", (statement.module or "").split(".")[0]))
        elif isinstance(statement, ast.ImportFrom):
            base = module[: len(module) - statement.level]
            names = statement.module.split(".") if statement.module else []
            targets = [(*base, *names)] if names else [(*base, alias.name) for alias in statement.names]
            found += [("own", target[1]) for target in targets if len(target) > 1]
    return found


def room(path: Path) -> str:
    parts = path.relative_to(PACKAGE).parts
    return parts[0] if len(parts) > 1 else path.stem


def floor(name: str) -> int:
    return next(i for i, rooms in enumerate(FLOORS) if name in rooms)


MODULES = sorted(PACKAGE.rglob("*.py"))


def test_every_module_has_a_floor():
    """A new file or folder at the top of the package is given its place here."""
    known = set().union(*FLOORS)
    assert {room(path) for path in MODULES} <= known


@pytest.mark.parametrize("path", MODULES, ids=lambda p: p.relative_to(PACKAGE).as_posix())
def test_imports_only_point_down(path: Path):
    """A module imports its own room and lower floors, and each library only in its home."""
    own = room(path)
    for kind, name in imports(path):
        if kind == "library":
            assert name not in HOMES or own in HOMES[name], f"{name} belongs into {HOMES[name]}"
        elif name != own and name != "__version__" and (own, name) not in NEIGHBOURS:
            assert floor(name) < floor(own), f"{own} imports {name}"


def test_what_is_installed_is_used():
    """Nobody installs a library for nothing: each required dependency is imported somewhere."""
    text = (PACKAGE.parents[1] / "pyproject.toml").read_text(encoding="utf-8")
    listed = re.search(r"^dependencies = \[(.*?)^\]", text, re.DOTALL | re.MULTILINE).group(1)
    required = {name.replace("-", "_") for name in re.findall(r'"([A-Za-z0-9_-]+)', listed)}
    assert required
    assert required <= {name for path in MODULES for kind, name in imports(path) if kind == "library"}
