"""Of every fixture, whatever is asked for: an export from its scene file, text or binary, says what the export from the source says."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import product
from pathlib import Path

import kinefab
import pytest
from kinefab.unity.back.scene_file import read_scene


FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
ENDINGS = ("bundle.json", "assembly.json", "urdf", "sdf", "FCStd", "asmt", "csv")
SOURCES = sorted(path for ending in ENDINGS for path in FIXTURES.rglob(f"*{ending}"))
CLOSURES, PHYSICS, FORMS = ("exact", "minimal"), ("rigidbody", "articulation"), ("text", "binary")
CLOSE = 1e-9
"""Of numbers: a scene file has twelve digits of each."""
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def export(source: Path, target: Path, closures: str, **writing: str) -> Path | list[str]:
    """The file that is written, or why none is."""
    target.parent.mkdir(parents=True, exist_ok=True)
    try:
        return kinefab.export(source, target, kinefab.ExportOptions(closures=closures, writing=writing)).path
    except kinefab.KinefabError as error:
        return sorted(f"{finding.code} {finding.message}" for finding in error.diagnostics)


def written(source: Path, folder: Path, closures: str) -> Iterator[Path]:
    """The source's scene file as text and as one file."""
    for form in FORMS:
        path = export(source, folder / f"{closures} {form}" / "scene.kinefab", closures, container=form)
        assert isinstance(path, Path)
        yield path


def apart(one: object, other: object, where: str = "") -> Iterator[str]:
    """Places at which two values of JSON differ; what is left out is zero."""
    if isinstance(one, dict) and isinstance(other, dict):
        for key in one.keys() | other.keys():
            yield from apart(one.get(key), other.get(key), f"{where}/{key}")
    elif isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        for index, pair in enumerate(zip(one, other)):
            yield from apart(*pair, f"{where}/{index}")
    elif one is None or other is None:
        zero = one if other is None else other
        if not (isinstance(zero, list) and all(isinstance(v, (int, float)) and abs(v) < CLOSE for v in zero)):
            yield f"{where}: {one}, {other}"
    elif isinstance(one, (int, float)) and isinstance(other, (int, float)):
        if abs(one - other) > CLOSE * max(1.0, abs(one)):
            yield f"{where}: {one}, {other}"
    elif one != other:
        yield f"{where}: {one}, {other}"


def scene_of(path: Path | list[str]) -> list[object]:
    """Its text and its buffers; or why it was not written."""
    if isinstance(path, list):
        return [path]
    document, buffers = read_scene(path)
    return [dict(document), buffers]


@pytest.mark.parametrize("source", SOURCES, ids=lambda path: f"{path.parent.name}-{path.name}")
def test_a_scene_of_a_scene_says_the_same(source: Path, tmp_path: Path):
    """Bodies and joints, or links, of either form; found with either choice of closing joints."""
    for closures, physics in product(CLOSURES, PHYSICS):
        direct = scene_of(export(source, tmp_path / "direct" / "scene.kinefab", closures, physics=physics))
        for scene in written(source, tmp_path, closures):
            again = scene_of(export(scene, tmp_path / "again" / "scene.kinefab", "exact", physics=physics))
            assert not list(apart(direct, again))


def differing(one: str, other: str) -> list[tuple[str, str]]:
    """Lines of two texts that say something else, or other numbers."""
    lines = list(zip(one.splitlines(), other.splitlines(), strict=True))
    return [(a, b) for a, b in lines if a != b and (NUMBER.sub("#", a) != NUMBER.sub("#", b) or not _close(a, b))]


def _close(one: str, other: str) -> bool:
    numbers = (list(map(float, NUMBER.findall(line))) for line in (one, other))
    return all(abs(a - b) <= CLOSE * max(1.0, abs(a)) for a, b in zip(*numbers))


BY_MORE_THAN_NAMES = (".FCStd", "lever_paper.csv")
"""FreeCAD's documents know their objects, and the paper's CSV its meshes, by what no scene file holds; Unity's ids hang on that."""


@pytest.mark.parametrize(
    "source", [path for path in SOURCES if not path.name.endswith(BY_MORE_THAN_NAMES)], ids=lambda path: f"{path.parent.name}-{path.name}"
)
def test_a_prefab_of_a_scene_says_the_same(source: Path, tmp_path: Path):
    for closures, physics in (("exact", "articulation"), ("minimal", "rigidbody")):  # the other two meet in these
        folders = [tmp_path / f"{name} {closures} {physics}" for name in ("direct", "again")]
        direct = export(source, folders[0] / "scene.prefab", closures, physics=physics)
        again = export(next(written(source, tmp_path, closures)), folders[1] / "scene.prefab", "exact", physics=physics)
        if isinstance(direct, list) or isinstance(again, list):
            assert direct == again
            continue
        found = [{path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()} for folder in folders]
        prefabs = [files.pop(Path("scene.prefab")).decode("utf-8") for files in found]
        assert found[0] == found[1]
        assert not differing(*prefabs)


@pytest.mark.parametrize("wrong", ["Nowhere", "Plate", ""])
def test_a_part_that_does_not_move_with_the_joints_body_is_not_taken(wrong: str, tmp_path: Path):
    scene = kinefab.Scene()
    base = scene.add_part("Base", grounded=True)
    arm, _ = scene.add_part("Arm", mass=1.0), scene.add_part("Plate", mass=1.0)
    scene.add_joint("revolute", base, arm, point=(0, 0, 0), axis=(0, 0, 1), name="Pin")
    path = kinefab.export(scene, tmp_path / "a.kinefab").path
    text = path.read_text("utf-8")
    assert text.count('"connectedPart": "Base"') == 1
    path.write_text(text.replace('"connectedPart": "Base"', f'"connectedPart": "{wrong}"'), "utf-8")
    (joint,) = kinefab.sources.read(path, kinefab.Report()).joints
    assert joint.a is None and joint.b is not None
