"""The architecture: imports only point down, in every folder, and heavy or foreign libraries stay where they belong."""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[2] / "python" / "src" / "kinefab"

FLOORS: dict[str, list[set[str]]] = {
    "": [
        {"spatial", "color", "diagnostics", "extras", "options", "replacing"},
        {"model", "partition"},
        {"geometry", "rigid", "findings"},
        {"sources", "analysis", "unity"},
        {"targets", "views", "mates", "builder"},
        {"capture"},
        {"pipeline", "mechanism"},
        {"showing", "batching", "bundling"},
        {"filming"},
        {"cli"},
        {"__main__", "__init__"},
    ],
    "cli": [
        {"findings"},
        {"asking", "console"},
        {"declared"},
        {"analyse", "batch", "bundle", "capture", "export", "inspect", "mates", "views"},
        {"program"},
        {"__init__"},
    ],
    "analysis": [
        {"equations", "collector"},
        {"freedom"},
        {"pairs"},
        {"assembly"},
        {"joints"},
        {"loops"},
        {"ranges"},
        {"couplings"},
        {"driving"},
        {"findings"},
        {"analyse"},
        {"__init__"},
    ],
    "unity": [
        {"frames", "scene", "definitions", "container"},
        {"bodies", "assets", "joints", "constraints", "mobility", "placing", "apart", "rules"},
        {"as_stated"},
        {"mapping"},
        {"contact"},
        {"switched_off", "counting"},
        {"links", "back"},
        {"__init__"},
    ],
    "targets": [
        {"numbers", "content", "images", "tangents"},
        {"noun_entry", "filtering", "packing"},
        {"scene_buffer", "scene_looks"},
        {"kinefab_file", "prefab", "gltf", "usd"},
        {"unitypackage"},
        {"__init__"},
    ],
    "targets/prefab": [
        {"text", "files", "names", "manifest", "last"},
        {"layers"},
        {"options", "assets", "objects", "moment", "meshes"},
        {"losses", "project"},
        {"folder", "exporting"},
        {"__init__"},
    ],
    "targets/usd": [
        {"api", "names"},
        {"prims", "bodies"},
        {"physics"},
        {"looks"},
        {"shapes", "clips"},
        {"stage"},
        {"files"},
        {"__init__"},
    ],
    "mates": [
        {"shapes", "mate"},
        {"touching"},
        {"deciding"},
        {"from_decided"},
        {"find", "apply", "mates_file", "listing"},
        {"asked"},
        {"__init__"},
    ],
    "sources": [
        {"reading", "roads", "guard"},
        {"occ", "robots"},
        {"asmt"},
        {"bundle", "freecad", "mjcf", "sdf", "step", "urdf", "usd"},
        {"paper", "simscape", "gallery", "parts"},
        {"__init__"},
    ],
}
"""Of a folder whose parts have floors, its files and folders from the ground up; those on one floor do not import each
other, but for those in NEIGHBOURS.  In every other folder files may import each other, without circles."""

NEIGHBOURS = {("mates_file", "apply"), ("geometry", "rigid"), ("diagnostics", "options")}

HOMES = {
    "trimesh": {"geometry", "builder"},
    "scipy": {"analysis", "geometry", "mates"},
    "PIL": {"views/raster", "geometry/looks/pixels"},
    "coacd": {"geometry/contact"},
    "coal": {"geometry/contact"},
    "manifold3d": {"geometry/contact"},
    "typer": {"cli"},
    "rich": {"cli", "batching/watching"},
    "distributed": {"batching/cluster"},
    "fsspec": {"batching/places"},
    "OCP": {"sources/occ", "sources/step"},
    "assimp_py": {"sources/parts"},
    "pxr": {"sources/usd", "targets/usd"},
}
"""Where a library may be imported: a folder or file, by its path in the package without ``.py``."""

CALLED = {"usd_core": "pxr"}
"""What a package is imported as, where that is another name."""

MOST_FILES = 14
"""Files of one room; past that ask whether it is two."""
MOST_LINES = 400
"""Lines of one file; past that it holds two ideas."""

MODULES = sorted(PACKAGE.rglob("*.py"))


@cache
def tree_of(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


@cache
def imports(path: Path) -> list[tuple[str, str]]:
    """('own' or 'library', dotted path in the package or name) of everything that a module imports, inside functions
    and for type checkers too."""
    package = path.relative_to(PACKAGE.parent).with_suffix("").parts
    found = []
    for statement in ast.walk(tree_of(path)):
        if isinstance(statement, ast.Import):
            found += [("library", alias.name.split(".")[0]) for alias in statement.names]
        elif isinstance(statement, ast.ImportFrom) and statement.level == 0:
            found.append(("library", (statement.module or "").split(".")[0]))
        elif isinstance(statement, ast.ImportFrom):
            base = package[: len(package) - statement.level]
            named = (*base, *(statement.module.split(".") if statement.module else ()))
            for alias in statement.names:
                found.append(("own", ".".join(_module((*named, alias.name)))))
    return found


@cache
def _module(parts: tuple[str, ...]) -> tuple[str, ...]:
    """The module that an imported name is, or is in, without the package's own name."""
    path = PACKAGE.parent.joinpath(*parts)
    is_module = path.is_dir() or path.with_suffix(".py").is_file()
    return (parts if is_module else parts[:-1])[1:]


def own_path(path: Path) -> tuple[str, ...]:
    return path.relative_to(PACKAGE).with_suffix("").parts


def floor(folder: str, name: str) -> int:
    return next(i for i, rooms in enumerate(FLOORS[folder]) if name in rooms)


@pytest.mark.parametrize("folder", FLOORS)
def test_every_file_and_folder_has_a_floor(folder: str):
    """A new file or folder is given its place here; one that is gone loses it."""
    there = {
        path.stem
        for path in (PACKAGE / folder).iterdir()
        if path.suffix == ".py" or (path / "__init__.py").is_file()
    }
    known = set().union(*FLOORS[folder])
    assert known == there | ({"__init__"} & known)


@pytest.mark.parametrize("path", MODULES, ids=lambda p: p.relative_to(PACKAGE).as_posix())
def test_imports_only_point_down(path: Path):
    """A module imports its own room and lower floors, in each folder that it is in, and each library only in its home."""
    own = own_path(path)
    for kind, name in imports(path):
        if kind == "library":
            homes = HOMES.get(name, {""})
            assert any("/".join(own).startswith(home) for home in homes), f"{name} belongs into {homes}"
            continue
        target = tuple(name.split(".")) if name else ()
        shared = 0
        while shared < min(len(own), len(target)) and own[shared] == target[shared]:
            shared += 1
        folder = "/".join(own[:shared])
        if folder not in FLOORS or shared >= len(target) or target == ("__version__",):
            continue
        here, there = own[shared], target[shared]
        if (here, there) not in NEIGHBOURS:
            assert floor(folder, there) < floor(folder, here), f"{'/'.join(own)} imports {name}"


def test_there_are_no_circles():
    """No module imports itself by way of others, except through imports inside functions."""
    edges: dict[str, set[str]] = {}
    for path in MODULES:
        module = ".".join(own_path(path)).removesuffix(".__init__")
        tree = tree_of(path)
        late = {id(s) for f in ast.walk(tree) if isinstance(f, ast.FunctionDef) for s in ast.walk(f)}
        typing_only = {
            id(s)
            for f in ast.walk(tree)
            if isinstance(f, ast.If) and isinstance(f.test, ast.Name) and f.test.id == "TYPE_CHECKING"
            for s in ast.walk(f)
        }
        package = path.relative_to(PACKAGE.parent).with_suffix("").parts
        targets = edges.setdefault(module, set())
        for s in ast.walk(tree):
            if isinstance(s, ast.ImportFrom) and s.level and id(s) not in late | typing_only:
                named = (*package[: len(package) - s.level], *(s.module.split(".") if s.module else ()))
                targets |= {".".join(_module((*named, alias.name))) for alias in s.names}
    done: set[str] = set()

    def walk(module: str, above: tuple[str, ...]) -> None:
        assert module not in above, " -> ".join((*above, module))
        if module in done:
            return
        for target in sorted(edges.get(module, ())):
            if target != module:
                walk(target, (*above, module))
        done.add(module)

    for module in sorted(edges):
        walk(module, ())


@pytest.mark.parametrize(
    "folder", sorted({path.parent for path in MODULES}), ids=lambda p: p.relative_to(PACKAGE).as_posix()
)
def test_a_room_can_be_overlooked(folder: Path):
    files = [path for path in folder.glob("*.py") if path.stem != "__init__"]
    assert len(files) <= MOST_FILES


@pytest.mark.parametrize("path", MODULES, ids=lambda p: p.relative_to(PACKAGE).as_posix())
def test_a_file_holds_one_idea(path: Path):
    assert len(path.read_text(encoding="utf-8").splitlines()) <= MOST_LINES


def test_what_is_installed_is_used():
    """Nobody installs a library for nothing: each required dependency is imported somewhere."""
    text = (PACKAGE.parents[1] / "pyproject.toml").read_text(encoding="utf-8")
    listed = re.search(r"^dependencies = \[(.*?)^\]", text, re.DOTALL | re.MULTILINE).group(1)
    required = {name.replace("-", "_") for name in re.findall(r'"([A-Za-z0-9_-]+)', listed)}
    assert required
    required = {CALLED.get(name, name) for name in required}
    used = {name for path in MODULES for kind, name in imports(path) if kind == "library"}
    late = (re.findall(r'import_module\("(\w+)"\)', path.read_text(encoding="utf-8")) for path in MODULES)
    assert required <= used.union(*late)
