"""What may be chosen about an export is checked where it is chosen."""

from __future__ import annotations

import kinefab
import pytest
from kinefab import ColliderShape, ExportOptions
from kinefab.analysis import AnalysisOptions
from kinefab.options import Closures


@pytest.mark.parametrize(
    "wrong, error, says",
    [
        ({"density": -1}, ValueError, "above zero"),
        ({"density": 0.0}, ValueError, "above zero"),
        ({"density": float("nan")}, ValueError, "above zero"),
        ({"density": float("inf")}, ValueError, "above zero"),
        ({"density": "7850"}, TypeError, "pass a number"),
        ({"density": True}, TypeError, "pass a number"),
        ({"colliders": "nonsense"}, ValueError, "pass one of: auto, none, box, hull, decompose, mesh"),
        ({"colliders": None}, ValueError, "pass one of: auto, none, box, hull, decompose, mesh"),
        ({"closures": "some"}, ValueError, "pass one of: exact, minimal"),
        ({"strict": "no"}, TypeError, "pass True or False"),
        ({"limits": 1}, TypeError, "pass True or False"),
    ],
)
def test_wrong_option_says_what_to_pass(wrong, error, says):
    """No options are made of what the export would take for something else."""
    with pytest.raises(error, match=says) as raised:
        ExportOptions(**wrong)
    assert next(iter(wrong)) in str(raised.value)


def test_words_stand_for_their_members():
    """A script may say "box", as the command line does."""
    options = ExportOptions(colliders="box", closures="minimal", density=700)
    assert options.colliders is ColliderShape.BOX and options.closures is Closures.MINIMAL


def test_loops_are_closed_by_whole_joints_unless_asked():
    """The export's default and the analysis' are one: what holds in Unity's solver."""
    assert ExportOptions().closures is AnalysisOptions().closures is Closures.EXACT


@pytest.mark.parametrize("wrong", [None, b"door.kinefab", 3])
def test_what_is_no_path_is_told_by_what_to_pass(wrong, tmp_path):
    with pytest.raises(TypeError, match="pass a path that ends in .kinefab or"):
        kinefab.export(kinefab.Scene(), wrong)
    with pytest.raises(TypeError, match="pass a file's path"):
        kinefab.export(wrong, tmp_path / "door.kinefab")
    with pytest.raises(TypeError, match="pass a file's path or a kinefab.Scene"):
        kinefab.motion(wrong)
