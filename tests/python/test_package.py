"""What ``import kinefab`` offers, and what a package of it says about itself."""

from __future__ import annotations

import ast
import copy
import pickle
import re
from pathlib import Path

import kinefab
import pytest
from scenes import lid_scene

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "python" / "src" / "kinefab" / "__init__.py"


def test_every_public_name_is_there():
    """What __all__ promises can be had, by its own name."""
    for name in kinefab.__all__:
        value = getattr(kinefab, name)
        assert name == "__version__" or value.__name__ == name


def test_type_checkers_see_the_public_names():
    """The imports that only type checkers run name what is imported on demand, from the same modules."""
    (block,) = (s for s in ast.parse(SOURCE.read_text(encoding="utf-8")).body if isinstance(s, ast.If))
    seen = {(alias.asname, statement.module) for statement in block.body for alias in statement.names}
    homes = {(name, home) for name, home in kinefab._HOMES.items()}
    assert seen == homes and {name for name, _ in homes} == set(kinefab.__all__) - {"__version__"}
    assert SOURCE.with_name("py.typed").is_file()


def test_what_the_api_hands_out_is_public(tmp_path):
    """Whoever gets a thing can name its type without a module of the inside."""
    options = kinefab.ExportOptions(closures=kinefab.Closures.EXACT)
    scene = lid_scene()
    result = kinefab.export(scene, tmp_path / "lid.kinefab", options)
    kept = result.report.outcomes[0]
    found = result.report.add("SCENE_WITHOUT_PARTS")
    mechanism = kinefab.motion(scene)
    swept = mechanism.sweep("Hinge", 0, 120)
    scene.add_hinge(None, scene.add_part("Gear"), point=(0, 0, 0), axis=(0, 0, 1), name="Gear")
    batch = kinefab.batch(tmp_path / "gone.urdf", tmp_path / "out")
    for thing in (
        scene,
        *scene.joints,
        result,
        scene.add_coupling("Hinge", "Gear", -2),
        options.colliders,
        options.closures,
        options.ground,
        mechanism,
        mechanism.coordinates[0],
        swept,
        swept.stop,
        batch,
        batch.records[0],
        result.report,
        kept,
        kept.outcome,
        found,
        found.severity,
    ):
        assert type(thing).__name__ in kinefab.__all__


@pytest.mark.parametrize(
    "through", [copy.copy, copy.deepcopy, lambda error: pickle.loads(pickle.dumps(error))]
)
def test_a_refusal_is_the_same_on_the_other_side_of_a_process(tmp_path, through):
    """A pool whose task raised what cannot be unpickled is broken, and says only that a process ended abruptly."""
    with pytest.raises(kinefab.KinefabError) as refused:
        kinefab.export(tmp_path / "gone.urdf", tmp_path / "gone.kinefab")
    error = refused.value
    other = through(error)
    assert (type(other), str(other), other.diagnostics) == (type(error), str(error), error.diagnostics)
    assert [str(found) for found in other.report.diagnostics] == [
        str(found) for found in error.report.diagnostics
    ]


def test_what_an_export_returns_comes_out_of_a_process(tmp_path):
    """A pool's task that returns what ``export`` returned; only its files came out."""
    result = kinefab.export(lid_scene(), tmp_path / "lid.glb")
    other = pickle.loads(pickle.dumps(result))
    assert (other.files, other.numbers, repr(other)) == (result.files, result.numbers, repr(result))
    assert [entry.name for entry in other.unity.gameObjects] == [
        entry.name for entry in result.unity.gameObjects
    ]


def test_both_languages_have_one_version():
    """Scenes, exporter and library are released together."""
    properties = (ROOT / "csharp" / "Directory.Build.props").read_text(encoding="utf-8")
    assert re.search("<Version>(.*)</Version>", properties).group(1) == kinefab.__version__


def test_the_package_carries_the_licence():
    """A build takes no file from outside its folder, so the licence stands there a second time."""
    assert (ROOT / "python" / "LICENSE").read_bytes() == (ROOT / "LICENSE").read_bytes()
