"""Inventor's capture against its documented double."""

from __future__ import annotations

import numpy as np
import pytest
from cad.captures import capture, scene_differences
from cad.described import described, mechanism
from cad.inventor import Inventor
from kinefab.capture.draft import Draft
from kinefab.capture.masses import mass_record


@pytest.mark.parametrize("name", ["lever/lever.bundle.json", "mechanisms/M04.bundle.json"])
@pytest.mark.parametrize(("points", "order"), [("assembly", "rows"), ("part", "columns")])
def test_a_mechanism_is_the_scene_of_its_bundle(name, points, order, tmp_path):
    values = mechanism(name)
    found = capture(
        "inventor", Inventor(described(values), points, order).record(), tmp_path, values["meta"]["up"]
    )
    assert scene_differences(values, found.path, tmp_path) == []


def test_inertia_is_read_whatever_its_sign_and_point(tmp_path):
    """The principal moments tell which of four readings of the tensor is meant."""
    tensor = np.array([[3.0, 0.4, -0.2], [0.4, 5.0, 0.7], [-0.2, 0.7, 6.0]])
    mass, center = 2.0, np.array([0.3, -0.5, 0.9])
    about = tensor + mass * (center @ center * np.eye(3) - np.outer(center, center))
    for sign, given in ((1, tensor), (-1, tensor), (1, about), (-1, about)):
        moments = [given[0, 0], given[1, 1], given[2, 2]]
        moments += [sign * given[0, 1], sign * given[1, 2], sign * given[0, 2]]
        draft = Draft("Inventor", "cm", "Z")
        principal = np.linalg.eigvalsh(tensor).tolist()
        found = mass_record(draft, "X", mass, center.tolist(), moments, principal, "centre")
        assert found["inertia"] == pytest.approx([3.0, 5.0, 6.0, 0.4, 0.7, -0.2])
        assert draft.report.diagnostics == []
    draft = Draft("Inventor", "cm", "Z")
    mass_record(draft, "X", mass, center.tolist(), [9.0, 1.0, 1.0, 0.0, 0.0, 0.0], [1.0, 2.0, 3.0], "centre")
    assert [entry.code for entry in draft.report.diagnostics] == ["CAPTURE_INERTIA"]
