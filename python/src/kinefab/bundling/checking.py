"""Everything that is wrong with a bundle, at once: its fields, its mesh files, and what the analysis says."""

from __future__ import annotations

from pathlib import Path

from ..diagnostics import Diagnostic, KinefabError, Report, Severity, diagnostic_table
from ..geometry.loading import MeshFiles, load_geometry
from ..options import ExportOptions
from ..pipeline import Analysed, analysed, prepared, silent
from ..sources.bundle.reader import draft_from_values
from ..sources.parts.readers import part_readers
from ..sources.reading.file import read_bytes
from ..sources.reading.json_text import parse_json


def check(path: Path) -> tuple[Report, Analysed | None]:
    """What an export of the bundle would find, and beside its first errors those that it would come to later; and what was
    analysed, None where errors kept it from that.

    The errors of the fields do not hide those of the mesh files, nor these what the analysis finds; where fields are wrong,
    joints are missing and nothing is analysed.  Never raises for wrong data.
    """
    report = Report()
    try:
        data = read_bytes(path, report)
        scene = draft_from_values(parse_json(data, path.name, report), path, data, report)
        if report.of(Severity.ERROR):
            load_geometry(scene, MeshFiles(report, part_readers()), report, silent)
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


def _is_of_geometry(error: Diagnostic) -> bool:
    return diagnostic_table()[error.code]["stage"] == "geometry"
