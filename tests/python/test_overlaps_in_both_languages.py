"""What the export and ``dotnet kinefab advise`` say of colliders that overlap at the start: the same pairs, each by its own code.

Depths are held against a third: the way out of the hull (qhull) of all differences between two shapes' points.  It stands in for
Coal in the export's check, so that the comparison runs where Coal is not installed.
"""

from __future__ import annotations

import json
import random
import re
import shutil
import subprocess
from collections.abc import Iterable
from pathlib import Path

import kinefab
import numpy as np
import pytest
import trimesh
from kinefab.geometry.contact.depth import Solid
from kinefab.model import Apart, Collider, ColliderKind
from kinefab.spatial import Pose
from kinefab.unity.contact import overlaps
from scipy.spatial import ConvexHull, QhullError
from scipy.spatial.transform import Rotation

ROOT = Path(__file__).parents[2]
SOURCES = sorted(path for kind in ("bundle.json", "urdf", "sdf") for path in (ROOT / "fixtures").glob(f"*/*.{kind}"))
TOOL = shutil.which("dotnet-kinefab")
needs_tool = pytest.mark.skipif(TOOL is None, reason="dotnet-kinefab is not on the PATH")
TOLERANCE = 1e-3
"""Metres: a ball of 0.2 m is one to the tool, and 48 sides to the export."""
Overlaps = dict[frozenset[str], float]


class HullDepths:
    """The depths of ``kinefab.geometry.contact.depth.Depths``."""

    def between(self, first: Solid, second: Solid) -> float:
        if first.convex and second.convex:
            return convex_depth(corners(first.vertices), corners(second.vertices))
        surface, other = (second, first) if first.convex else (first, second)
        solid = corners(other.vertices)
        triangles = surface.vertices[surface.faces]
        near = ((triangles.min(axis=1) < solid.max(axis=0)) & (triangles.max(axis=1) > solid.min(axis=0))).all(axis=1)
        return max((convex_depth(triangle, solid) for triangle in triangles[near]), default=0.0)


def corners(points: np.ndarray) -> np.ndarray:
    return points[ConvexHull(points).vertices]


def convex_depth(first: np.ndarray, second: np.ndarray) -> float:
    try:
        whole = ConvexHull((first[:, None] - second[None]).reshape(-1, 3))
    except QhullError:  # flat
        return 0.0
    return max(0.0, float((-whole.equations[:, 3]).min()))


def overlaps_of(diagnostics: Iterable[tuple[str, str]]) -> Overlaps:
    """Of codes and messages, depths of pairs of objects."""
    found = Overlaps()
    for code, message in diagnostics:
        if code == "COLLIDERS_OVERLAP":
            told = re.match(r"The colliders of (.*) and (.*) overlap by (\S+) m", message)
            assert told is not None
            found[frozenset(told.groups()[:2])] = float(told[3])
    return found


def exported(source: Path | kinefab.Scene, target: Path, options: kinefab.ExportOptions) -> Overlaps | None:
    """None: no articulation can be made of it."""
    try:
        done = kinefab.export(source, target, options)
    except kinefab.KinefabError as error:
        assert {d.code for d in error.diagnostics} == {"ARTICULATION_IMPOSSIBLE"}
        return None
    return overlaps_of((d.code, d.message) for d in done.report.diagnostics)


def advised(scenes: Iterable[Path]) -> list[Overlaps]:
    command = [str(TOOL), "advise", "--json", "--trials", "1", "--seconds", "0.02", *map(str, scenes)]
    said = json.loads(subprocess.run(command, capture_output=True, text=True).stdout)
    return [overlaps_of((d["code"], d["message"]) for d in one["diagnostics"]) for one in said]


def assert_alike(export: Overlaps, advice: Overlaps, scene: Path) -> None:
    for pair in export.keys() | advice.keys():
        if pair in export and pair in advice:
            assert advice[pair] == pytest.approx(export[pair], rel=0.01, abs=TOLERANCE), (scene, pair)
        else:  # only just deep enough for the one, and not for the other
            assert (export | advice)[pair] < overlaps.CONTACT_OFFSET + TOLERANCE, (scene, pair)


@pytest.fixture(autouse=True)
def depths_without_coal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(overlaps, "Depths", HullDepths)
    monkeypatch.setattr(overlaps, "is_available", lambda: True)


OPTIONS = {
    "default": kinefab.ExportOptions(),
    "hulls in the world": kinefab.ExportOptions(colliders="hull", ground="world"),
    "links": kinefab.ExportOptions(colliders="hull", writing={"physics": "articulation"}),
}


@needs_tool
@pytest.mark.parametrize("options", OPTIONS.values(), ids=OPTIONS)
def test_every_fixture(options: kinefab.ExportOptions, tmp_path: Path):
    exports = dict[Path, Overlaps]()
    for number, source in enumerate(SOURCES):
        if (found := exported(source, tmp_path / f"{number:03d}.kinefab", options)) is not None:
            exports[tmp_path / f"{number:03d}.kinefab"] = found
    assert len(exports) > 0.5 * len(SOURCES)
    for (target, export), advice in zip(exports.items(), advised(exports), strict=True):
        assert advice == export, target


def crowd(seed: int) -> kinefab.Scene:
    """Shapes of all kinds in a heap on a hollow bowl; some are joined, held together or told apart."""
    draw = random.Random(seed)
    scene, count = kinefab.Scene(), draw.randint(4, 9)
    for i in range(count):
        at = tuple(draw.uniform(-0.25, 0.25) for _ in range(3))
        turn = Rotation.random(random_state=draw.randrange(1 << 30)).as_matrix()
        kind = draw.choice([ColliderKind.BOX, ColliderKind.SPHERE, ColliderKind.CAPSULE, "hull"])
        size = tuple(draw.uniform(0.05, 0.3) for _ in range(3))
        if kind == "hull":
            points = np.random.default_rng(seed + i).normal(size=(12, 3)) * size
            scene.add_part(f"p{i}", trimesh.convex.convex_hull(points), translation=at, rotation=turn, mass=1.0)
            continue
        place = Pose(translation=(0.01, -0.02, 0.03))
        shape = Collider(kind, place, size=size, radius=0.5 * min(size), length=max(size))  # pyright: ignore[reportArgumentType]
        scene.add_part(f"p{i}", translation=at, rotation=turn, mass=1.0, collider=shape)
    bowl = trimesh.creation.annulus(0.2, 0.6, 0.1)
    scene.add_part("Bowl", bowl, grounded=True)
    for _ in range(draw.randint(0, count)):
        a, b = draw.sample(range(count), 2)
        what = draw.choice(["hinge", "fixed", "apart"])
        if what == "hinge":
            scene.add_hinge(a, b, point=(0, 0, 0), axis=(0, 0, 1), collide=draw.random() < 0.3)
        elif what == "fixed":
            scene.add_fixed(a, b, break_force=100.0)
        else:
            scene.apart.append(Apart(a, b, "filtered pair"))
    return scene


@needs_tool
@pytest.mark.parametrize("options", [OPTIONS["default"], OPTIONS["links"]], ids=["bodies", "links"])
def test_random_heaps(options: kinefab.ExportOptions, tmp_path: Path):
    exports = dict[Path, Overlaps]()
    for seed in range(40):
        if (found := exported(crowd(seed), tmp_path / f"{seed}.kinefab", options)) is not None:
            exports[tmp_path / f"{seed}.kinefab"] = found
    assert sum(map(len, exports.values())) > 100
    for (target, export), advice in zip(exports.items(), advised(exports), strict=True):
        assert_alike(export, advice, target)
