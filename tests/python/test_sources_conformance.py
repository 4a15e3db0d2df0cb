"""The source cases of tests/conformance: one fault each, with its expected report; every code has one."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from kinefab import sources
from kinefab.diagnostics import KinefabError, Report, diagnostic_table

ROOT = Path(__file__).parents[1] / "conformance"
FOLDER = ROOT / "invalid" / "source"

OF_BUNDLES = ("BUNDLE_", "CSV_", "JOINT_", "COUPLING_", "DOF_", "PAPER_", "AXIS_", "AXES_", "POSE_")
"""Beginnings of the codes that a text file of a few lines shows; what the readers of other formats find, their own tests
name (``test_codes.py``)."""


def cases() -> list[dict]:
    manifest = json.loads((ROOT / "manifest.json").read_text(encoding="utf-8"))
    return [entry for entry in manifest["cases"] if entry["kind"] == "source"]


def stem(case: dict) -> str:
    return Path(case["path"]).name.split(".")[0]


def expected(case: dict) -> list[dict]:
    return json.loads((FOLDER / f"{stem(case)}.report.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize("case", cases(), ids=lambda case: Path(case["path"]).name)
def test_source_case(case):
    """Reading the file gives exactly the expected findings, and refuses it exactly when one is an error."""
    report = Report()
    outcome = "valid"
    try:
        sources.read(ROOT / case["path"], report)
    except KinefabError:
        outcome = "invalid"
    found = [{"code": d.code, "severity": d.severity.value, "where": d.where} for d in report.diagnostics]
    assert found == expected(case)
    assert outcome == case["expect"]
    assert all("{" not in d.message + d.remedy for d in report.diagnostics if d.code != "BUNDLE_NOT_OBJECT")


def test_every_report_belongs_to_a_listed_case():
    """The manifest and the folder agree, so that no case is lost on the way."""
    listed = sorted(stem(case) for case in cases())
    reports = sorted(path.name.removesuffix(".report.json") for path in FOLDER.glob("*.report.json"))
    assert listed == reports
    assert len(listed) >= 97


def test_every_code_of_bundles_has_a_case():
    """No code of the bundle's and the paper's readers goes without a file that shows it."""
    of_stage = {code for code, entry in diagnostic_table().items() if entry["stage"] == "source"}
    in_cases = {finding["code"] for case in cases() for finding in expected(case)}
    assert {code for code in of_stage if code.startswith(OF_BUNDLES)} <= in_cases
    assert in_cases <= set(diagnostic_table())
