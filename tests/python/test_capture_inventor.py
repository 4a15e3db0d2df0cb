"""Inventor's capture against its documented double."""

from __future__ import annotations

import json

import numpy as np
import pytest
from cad.captures import capture, scene_differences
from cad.described import described, mechanism
from cad.inventor import Inventor
from kinefab.capture.draft import Draft
from kinefab.capture.masses import mass_record
from kinefab.diagnostics import Report
from kinefab.sources import read


@pytest.mark.parametrize("name", ["lever/lever.bundle.json", "mechanisms/M04.bundle.json"])
@pytest.mark.parametrize(("points", "order"), [("assembly", "rows"), ("part", "columns")])
def test_a_mechanism_is_the_scene_of_its_bundle(name, points, order, tmp_path):
    values = mechanism(name)
    found = capture(
        "inventor", Inventor(described(values), points, order).record(), tmp_path, values["meta"]["up"]
    )
    assert scene_differences(values, found.path, tmp_path) == []


@pytest.mark.parametrize(("states", "told"), [(1, None), (3, "Reclined")])
def test_one_of_several_model_states_is_named(tmp_path, states, told):
    values = mechanism("lever/lever.bundle.json")
    found = capture("inventor", Inventor(described(values)).record(states), tmp_path, values["meta"]["up"])
    assert json.loads(found.path.read_text("utf-8"))["meta"].get("configuration") == told
    assert read(found.path, Report()).source.configuration == (told or "")


def test_a_release_without_model_states_is_read(tmp_path):
    values = mechanism("lever/lever.bundle.json")
    asked = Inventor(described(values)).record(states=3)
    record = [{k: v for k, v in own.items() if k != "ModelStates"} for own in asked]
    found = capture("inventor", record, tmp_path, values["meta"]["up"])
    assert "configuration" not in json.loads(found.path.read_text("utf-8"))["meta"]


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
