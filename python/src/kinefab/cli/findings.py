"""What a run found as documents for other programs: ``--json`` and ``--report``."""

from __future__ import annotations

from ..diagnostics import Report, Severity


def findings_document(report: Report, file: str, written: bool | None = None) -> dict[str, object]:
    """The findings as ``schemas/findings.schema.json`` has them.

    file: that was asked about, or that was to be written; ``written`` then says whether it was, and is None otherwise.
    """
    return {
        "file": file,
        **({} if written is None else {"written": written}),
        "errors": len(report.of(Severity.ERROR)),
        "warnings": len(report.of(Severity.WARNING)),
        "diagnostics": [
            {
                "code": d.code,
                "severity": d.severity.value,
                **({"where": d.where} if d.where else {}),
                "message": d.message,
                "remedy": d.remedy,
            }
            for d in report.diagnostics
        ],
    }


def report_document(report: Report, target: str, written: bool) -> dict[str, object]:
    """A report as ``schemas/export_report.schema.json`` has it.  target: the scene file; written: whether it was."""
    outcomes = [
        {
            "feature": o.feature,
            "outcome": o.outcome.value,
            **({"code": o.code, "message": o.message} if o.code else {}),
            **({"where": o.where} if o.where else {}),
        }
        for o in report.outcomes
    ]
    return {**findings_document(report, target, written), "outcomes": outcomes}
