"""Everything that is wrong with a bundle, at once: its fields, its mesh files, and what the analysis says."""

from __future__ import annotations

from pathlib import Path

from ..diagnostics import Diagnostic, KinefabError, Report, Severity, diagnostic_table
from ..geometry.loading import MeshFiles, load_geometry
from ..geometry.plausibility import check_plausible
from ..model import Scene
from ..options import ExportOptions
from ..pipeline import Analysed, analysed, prepared, silent
from ..sources.bundle.reader import draft_from_values
from ..sources.parts.readers import part_readers
from ..sources.reading.file import read_bytes
from ..sources.reading.json_text import parse_json

STANDING = frozenset(
    "CONSTRAINTS_CONTRADICT CONSTRAINT_GAP CONSTRAINT_AXIS_ZERO CONSTRAINT_FEATURES_MISSING CONSTRAINT_NOT_FINITE "
    "CONSTRAINT_WITH_ITSELF CONSTRAINT_NOT_INTERPRETED CONSTRAINT_PAIRING_UNKNOWN CONSTRAINTS_MANY "
    "SIZE_IMPLAUSIBLE ANCHOR_IMPLAUSIBLE LIMITS_IMPLAUSIBLE SOURCE_LIKELY_LEFT_HANDED".split()
)
"""What the analysis finds of statements by themselves: no joint that is still missing takes it back."""


def check(path: Path) -> tuple[Report, Analysed | None]:
    """What an export of the bundle would find, and beside its first errors those that it would come to later; and what was
    analysed, None where errors kept it from that.

    The errors of the fields do not hide those of the mesh files, nor these what the analysis finds.  Where fields are wrong,
    what was read is analysed all the same, as far as its units are known, and of that only what is wrong whatever else may be
    missing is told.  Never raises for wrong data.
    """
    report = Report()
    try:
        data = read_bytes(path, report)
        scene = draft_from_values(parse_json(data, path.name, report), path, data, report)
        if report.of(Severity.ERROR):
            measured = not any(_is_of_head(error) for error in report.of(Severity.ERROR))
            scene = load_geometry(scene, MeshFiles(report, part_readers()), report, silent)
            if measured:
                _analyse_rest(scene, report)
            return report, None
        report = Report()
        options = ExportOptions()
        try:
            return report, analysed(prepared(path, options, report), options, report)
        except KinefabError:
            if all(_is_of_geometry(error) for error in report.of(Severity.ERROR)):
                analysed(scene, options, report)
    except KinefabError:
        pass  # its findings are in the report
    return report, None


def _analyse_rest(scene: Scene, report: Report) -> None:
    """Add what the analysis finds in the part of a bundle that could be read."""
    found, options = Report(), ExportOptions()
    if scene.nodes:
        check_plausible(scene, scene, options.density, found)
        analysed(scene, options, found)
    report.diagnostics += [diagnostic for diagnostic in found.diagnostics if diagnostic.code in STANDING]


def _is_of_head(error: Diagnostic) -> bool:
    """Whether it is about units and axes, without which lengths mean nothing."""
    place = error.where.partition("#")[2]
    return place in ("", "/") or place.startswith("/meta")


def _is_of_geometry(error: Diagnostic) -> bool:
    return diagnostic_table()[error.code]["stage"] == "geometry"
