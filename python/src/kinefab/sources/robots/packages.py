"""Where the files are that a robot names: ``package://``, ``model://``, ``file://`` and plain relative names.

A name is looked for in the folders that the user gave, then in those of the environment, then upwards from the source.
What is found must lie inside the package (or beside the source), so that a robot from elsewhere reads no other files.
"""

from __future__ import annotations

import os
import re
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING
from urllib.parse import unquote

from ...diagnostics import Report
from ...geometry.references import UPWARDS, is_package
from ...options import FormatOption

if TYPE_CHECKING:  # the command line lists the formats without numpy
    from ..reading.request import Request

PACKAGE_PATH = FormatOption(
    "package_path",
    "Folder that holds the packages or models which package:// and model:// name (or is one of them); may be repeated.",
    Path,
    repeated=True,
    metavar="DIR",
)
BESIDE = 2
"""Folders above the source that a relative name may climb where no package is found around it."""
MOST_FOLDERS = 10_000
"""Folders that are looked through for manifests, below one that was given."""
MODELS = "models"
"""Where Gazebo's packages keep their models, beside ``worlds``."""
IGNORED = ("CATKIN_IGNORE", "COLCON_IGNORE", "AMENT_IGNORE")
"""A folder that holds one of these holds no packages."""
ENVIRONMENT = ("ROS_PACKAGE_PATH", "GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH", "GAZEBO_MODEL_PATH")
"""Variables that list folders of packages or models."""
_NAMED = re.compile(r"(?:package|model):/*([^/]*)/*(.*)", re.DOTALL | re.IGNORECASE)
"""As ROS and Gazebo read it: strokes too much are none."""
_SERVED = re.compile(
    r"https?://.*?/models/([^/]+)(?:/(?:tip|\d+))?(?:/files)?/?(.*)", re.DOTALL | re.IGNORECASE
)
"""A model of Gazebo's server, its version, and the file in it."""
_NAME = re.compile(rb"<name>\s*([^<\s]+)\s*</name>")


@dataclass(frozen=True, slots=True)
class Found:
    """path: the file, None where there is none.  outside: it, or what was asked for, lies out of the package."""

    path: Path | None
    outside: bool = False


@dataclass(slots=True)
class Packages:
    """folder: of the source.  given: the user's ``--package-path``.  environment: by name, as ``os.environ``."""

    folder: Path
    given: tuple[Path, ...] = ()
    environment: Mapping[str, str] = field(default_factory=lambda: os.environ)
    _known: dict[str, Path | None] = field(default_factory=dict[str, "Path | None"])
    _below: dict[Path, dict[str, Path]] = field(default_factory=dict[Path, dict[str, Path]])

    def of(self, folder: Path) -> Packages:
        """The same for a file that lies in another folder."""
        return Packages(folder, self.given, self.environment, _below=self._below)

    def find(self, uri: str) -> Found:
        """The file that a source names."""
        if (named := self.named(uri)) is not None:
            package, inner = named
            return Found(None) if package is None else _inside(package, inner)
        match = re.match(r"([A-Za-z][A-Za-z0-9+.-]+):(?://)?(.*)", uri.strip(), re.DOTALL)
        scheme, rest = (match[1].lower(), match[2]) if match else ("", uri.strip())
        rest = rest.replace("\\", "/")
        if scheme not in ("", "file"):
            return Found(None)
        # file:///$(find NAME) has four strokes after xacro, or three before a drive's letter.
        plain = re.sub(r"\A/+(?=/|[A-Za-z]:)", "", unquote(rest)) if scheme else rest
        if "\0" in plain:
            return Found(None)
        if PurePosixPath(plain).is_absolute() or re.match(r"[A-Za-z]:", plain):
            inside = any(is_inside(Path(plain), root) for root in (*self.given, self._home()))
            inside = inside or self._is_in_package(Path(plain))
            return Found(Path(plain) if inside and Path(plain).is_file() else None, not inside)
        found = _inside(self.folder, plain, self._home())
        # A name that climbs into a folder that was given, or one from there or a package around the source.
        if found.path is None:
            others = [_inside(self.folder, plain, root) for root in self.given]
            around = [self._home(), *filter(is_package, _upwards(self.folder)), *self.given]
            for other in (*others, *(_inside(root, plain) for root in around)):
                if other.path is not None:
                    return other
        return found

    def named(self, uri: str) -> tuple[Path | None, str] | None:
        """The folder of the package or model that a name begins with, where there is one, and what is named in it; None of
        other names.  The server of models is not asked: what it has stands below the model's name, as Gazebo keeps it too."""
        text = uri.strip().replace("\\", "/")
        match = _NAMED.fullmatch(text)
        served = None if match else _SERVED.fullmatch(text)
        if served is not None:
            name = unquote(served[1])
            folder = self.package(name) or self.package(name.lower())
            return folder and _newest(folder), unquote(served[2])
        return None if match is None else (self.package(match[1]), unquote(match[2]))

    def package(self, name: str) -> Path | None:
        """The folder of a package or model."""
        if name not in self._known:
            self._known[name] = self._search(name) if _is_name(name) else None
        return self._known[name]

    def _is_in_package(self, path: Path) -> bool:
        """Whether a file lies in a package that is found by its name, as one that xacro's ``$(find NAME)`` has led to."""
        for above in _upwards(path.parent):
            if (name := _stated_name(above)) is not None:
                found = self.package(name)
                return found is not None and Path(os.path.abspath(found)) == above
        return False

    def _search(self, name: str) -> Path | None:
        roots = list(self.given)
        for variable in ENVIRONMENT:
            roots += map(Path, filter(None, self.environment.get(variable, "").split(os.pathsep)))
        for root in roots:
            if (found := self._package_in(root, name)) is not None:
                return found
        for prefix in filter(None, self.environment.get("AMENT_PREFIX_PATH", "").split(os.pathsep)):
            if (found := Path(prefix) / "share" / name).is_dir():
                return found
        for above in _upwards(self.folder):
            if _is_package(above, name) or above.name == name:
                return above
            for candidate in (above / name, above / MODELS / name):
                if candidate.is_dir():
                    return _installed(candidate, name)
        for above in filter(_is_workspace, _upwards(self.folder)):
            if (found := self._packages_below(above).get(name)) is not None:
                return found
        return None

    def _package_in(self, root: Path, name: str) -> Path | None:
        """The package in a folder, which may be it, or hold it at any depth, as ROS finds it."""
        if _is_package(root, name):
            return root
        for candidate in (
            *([root] if root.name == name else ()),
            root / name,
            *sorted(root.glob(f"*/{name}")),
        ):
            if candidate.is_dir():
                return _installed(candidate, name)
        return self._packages_below(root).get(name)

    def _packages_below(self, root: Path) -> dict[str, Path]:
        if root not in self._below:
            self._below[root] = _packages_below(root)
        return self._below[root]

    def _home(self) -> Path:
        """The package that the source lies in; without one the folder a little above it."""
        line = _upwards(self.folder)
        return next(filter(is_package, line), line[min(BESIDE, len(line) - 1)])


def packages_of(source: Path, request: Request, report: Report) -> Packages:
    """Where the files lie that a source names; a finding for each ``--package-path`` that is no folder."""
    given = request.paths(PACKAGE_PATH.name)
    for folder in given:
        if not folder.is_dir():
            report.add("PACKAGE_PATH_NOT_FOUND", source.name, path=folder)
    return Packages(source.parent, given)


def is_served(uri: str) -> bool:
    """Whether it is the address of a model of Gazebo's server."""
    return _SERVED.fullmatch(uri.strip().replace("\\", "/")) is not None


def _is_name(name: str) -> bool:
    return bool(name) and name not in (".", "..") and not re.search(r"[\0/\\:]", name)


def _upwards(folder: Path) -> list[Path]:
    whole = Path(os.path.abspath(folder))
    return [whole, *whole.parents][: UPWARDS + 1]


def _is_workspace(folder: Path) -> bool:
    """Whether packages may lie anywhere below it: a workspace's ``src``, a repository, or where several lie side by side."""
    if folder.name == "src" or (folder / ".git").exists():
        return True
    try:
        beside = (path for path in folder.iterdir() if (path / "package.xml").is_file())
        return len(list(islice(beside, 2))) == 2
    except OSError:
        return False


def _packages_below(root: Path) -> dict[str, Path]:
    """Folders with a manifest, by the name that it states, the upper ones first; none within another."""
    found: dict[str, Path] = {}
    waiting, seen = deque([root]), {os.path.realpath(root)}
    while waiting and len(seen) < MOST_FOLDERS:
        folder = waiting.popleft()
        try:
            with os.scandir(folder) as entries:
                inner = sorted(e.name for e in entries if e.is_dir() and not e.name.startswith("."))
        except OSError:
            continue
        for path in (folder / name for name in inner):
            if any((path / ignored).exists() for ignored in IGNORED):
                continue
            if (stated := _stated_name(path)) is not None:
                found.setdefault(stated, path)
            elif (real := os.path.realpath(path)) not in seen:  # a link may lead upwards
                seen.add(real)
                waiting.append(path)
    return found


def _installed(folder: Path, name: str) -> Path:
    """Of a folder that is called like a package: where colcon installs each into a folder of its own, the package is in that."""
    inner = folder / "share" / name
    return inner if inner.is_dir() else folder


def _newest(folder: Path) -> Path:
    """Of a model in Gazebo's cache, where each version has a folder, the last one."""
    try:
        versions = [int(path.name) for path in folder.iterdir() if path.name.isdecimal() and path.is_dir()]
    except OSError:
        return folder
    return folder / str(max(versions)) if versions and not (folder / "model.config").exists() else folder


def _is_package(folder: Path, name: str) -> bool:
    return _stated_name(folder) == name


def _stated_name(folder: Path) -> str | None:
    """What a folder's ``package.xml`` calls it; None without one."""
    try:
        with (folder / "package.xml").open("rb") as stream:
            match = _NAME.search(stream.read(65536))
    except OSError:
        return None
    return None if match is None else match[1].decode("utf-8", "replace")


def _inside(folder: Path, name: str, home: Path | None = None) -> Found:
    """A file by its name in a folder; not where it leads out of ``home`` (the folder itself)."""
    path = Path(os.path.normpath(os.path.join(os.path.abspath(folder), name)))
    if not is_inside(path, folder if home is None else home):
        return Found(None, outside=True)
    try:
        return Found(path if path.is_file() else None)
    except OSError:  # a name that no file system takes
        return Found(None)


def is_inside(path: Path, root: Path) -> bool:
    return Path(os.path.normpath(path)).is_relative_to(os.path.abspath(root))
