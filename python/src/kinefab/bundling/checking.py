"""Everything that is wrong with a bundle, at once: its fields, its mesh files, and what the analysis says."""

from __future__ import annotations

from pathlib import Path

from ..diagnostics import KinefabError, Report, Severity
from ..geometry.loading import MeshFiles, load_geometry
from ..options import ExportOptions
from ..pipeline import analysed, prepared, silent
from ..sources.bundle.reader import draft_from_values
from ..sources.parts.readers import part_readers
from ..sources.reading.file import read_bytes
from ..sources.reading.json_text import parse_json


def check(path: Path) -> Report:
    """What an export of the bundle would find, and beside its first errors those that it would come to later.

    The errors of the fields do not hide those of the mesh files.  Never raises for wrong data.
    """
    report = Report()
    try:
        data = read_bytes(path, report)
        scene = draft_from_values(parse_json(data, path.name, report), path, data, report)
        if report.of(Severity.ERROR):
            load_geometry(scene, MeshFiles(report, part_readers()), report, silent)
            return report
        report = Report()
        options = ExportOptions()
        analysed(prepared(path, options, report), options, report)
    except KinefabError:
        pass  # its findings are in the report
    return report
