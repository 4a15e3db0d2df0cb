"""Wrong units and hands that pass as data: each is told once, with the unit it is likely in; what is right is not."""

from __future__ import annotations

import json
import math

import kinefab
import numpy as np
import pytest
import trimesh
from kinefab.diagnostics import Report, Severity
from kinefab.model import Freedom, JointKind, MassProperties, Motion, Source
from kinefab.pipeline import prepared

CODES = (
    "SIZE_IMPLAUSIBLE", "CENTER_OF_MASS_IMPLAUSIBLE", "INERTIA_IMPLAUSIBLE", "MASS_IMPLAUSIBLE", "DENSITY_IMPLAUSIBLE",
    "ANCHOR_IMPLAUSIBLE", "LIMITS_IMPLAUSIBLE", "SOURCE_LIKELY_LEFT_HANDED",
)  # fmt: skip
BOX = (0.4, 0.2, 0.3)
HULL = MassProperties(2.0e8, np.zeros(3), np.diag((7.6e10, 2.7e12, 2.7e12)))


def arm(
    size=BOX, at=(0.0, 0.0, 0.0), limits=None, mass=None, density=None, rx=None, unit=1.0
) -> kinefab.Scene:
    scene = kinefab.Scene(source=Source("arm", meters_per_unit=unit))
    base = scene.add_part("Base", trimesh.creation.box(BOX), grounded=True)
    lid = scene.add_part("Lid", trimesh.creation.box(size), mass=mass, density=density)
    more = {} if rx is None else {"rx": rx}
    scene.add_joint(
        JointKind.REVOLUTE, base, lid, point=at, axis=(0, 0, 1), name="Hinge", limits=limits, **more
    )
    return scene


def ship(mass: MassProperties | None = HULL, unit: float = 1.0) -> kinefab.Scene:
    """A hull of 399 m with a rudder at its stern, 195 m from its middle."""
    scene = kinefab.Scene(source=Source("ship", meters_per_unit=unit))
    hull = scene.add_part("Hull", trimesh.creation.box((399.0, 59.0, 33.0)), mass=mass)
    rudder = scene.add_part(
        "Rudder", trimesh.creation.box((8.0, 0.8, 10.0)), translation=(-195.0, 0.0, -10.0)
    )
    scene.add_hinge(hull, rudder, point=(-195.0, 0.0, -5.0), axis=(0, 0, 1), limits=(-35, 35))
    return scene


def mass(kilograms=2.0, center=(0.01, 0.0, 0.0), moments=(0.02, 0.03, 0.02)) -> MassProperties:
    return MassProperties(kilograms, np.array(center), np.diag(moments))


def told(scene, **options) -> list[tuple[str, str]]:
    report = Report()
    prepared(scene, kinefab.ExportOptions(**options), report)
    found = [d for d in report.diagnostics if d.code in CODES]
    assert all(d.severity is Severity.WARNING and d.remedy for d in found)
    return [(d.code, d.message) for d in found]


@pytest.mark.parametrize(
    "scene, options, code, says",
    [
        (arm((1000.0,) * 3), {}, "SIZE_IMPLAUSIBLE", "1000 m large and weighs 1e+12 kg (1 part(s) alike): millimetres"),
        (arm((450.0, 180.0, 140.0), mass=mass(1200.0)), {}, "SIZE_IMPLAUSIBLE", "centimetres were likely taken for metres, and it is 4.5 m"),
        (arm((114.3, 45.7, 35.6), mass=mass(1200.0), unit=0.0254), {}, "SIZE_IMPLAUSIBLE", "millimetres were likely taken for inches, and it is 4.5 m"),
        (arm((4500.0, 1800.0, 1400.0), unit=0.001), {}, "SIZE_IMPLAUSIBLE", "millimetres were likely taken for metres, and it is 4.5 m"),
        (arm(mass=mass(1e12, moments=(1e12, 2e12, 1.5e12))), {}, "MASS_IMPLAUSIBLE", "its mesh is likely in metres that were taken for millimetres"),
        (arm((0.4, 0.2, 0.004), at=(0.0, 60.0, 3000.0)), {}, "ANCHOR_IMPLAUSIBLE", "Hinge stands 59.9 m outside of"),
        (arm(limits=(0.0, 2.618)), {}, "LIMITS_IMPLAUSIBLE", "likely radians that were taken for degrees"),
        (arm(at=(500.0, 0.0, 0.0)), {}, "ANCHOR_IMPLAUSIBLE", "Hinge stands 499.8 m outside of"),
        (arm(mass=mass(center=(10.0, 0.0, 0.0))), {}, "CENTER_OF_MASS_IMPLAUSIBLE", "likely in millimetres"),
        (arm(mass=mass(moments=(2e4, 3e4, 2e4))), {}, "INERTIA_IMPLAUSIBLE", "likely in kg mm^2"),
        (arm(mass=mass(2000.0, moments=(20.0, 30.0, 20.0))), {}, "MASS_IMPLAUSIBLE", "likely in grams"),
        (arm(density=7.85), {}, "DENSITY_IMPLAUSIBLE", "g/cm^3, 7850 kg/m^3"),
        (arm(density=11.34), {}, "DENSITY_IMPLAUSIBLE", "g/cm^3, 11340 kg/m^3"),
        (arm(density=7.85e-6), {}, "DENSITY_IMPLAUSIBLE", "kg/mm^3, 7850 kg/m^3"),
        (arm(density=7.85e-9), {}, "DENSITY_IMPLAUSIBLE", "t/mm^3, 7850 kg/m^3"),
        (arm(), {"density": 2.7}, "DENSITY_IMPLAUSIBLE", "g/cm^3, 2700 kg/m^3"),
        (arm(limits=(-1.5708, 1.5708)), {}, "LIMITS_IMPLAUSIBLE", "likely radians that were taken for degrees"),
        (arm(limits=(0.0, 3.14)), {}, "LIMITS_IMPLAUSIBLE", "likely radians that were taken for degrees"),
        (
            arm(rx=Freedom(Motion.LIMITED, -90.0, 90.0)), {}, "LIMITS_IMPLAUSIBLE",
            "likely degrees that were taken for radians",
        ),
        (
            arm(rx=Freedom(Motion.LIMITED, -10.0, 80.0)), {}, "LIMITS_IMPLAUSIBLE",
            "likely degrees that were taken for radians",
        ),
    ],
)  # fmt: skip
def test_one_warning_names_the_likely_unit(scene, options, code, says):
    """One finding for the fault, and no other of these codes beside it."""
    ((found, message),) = told(scene, **options)
    assert found == code and says in message


@pytest.mark.parametrize(
    "scene",
    [
        arm(limits=(-10, 80)), arm(limits=(-90, 90)), arm(limits=(-2, 2)), arm(limits=(-5, 1)), arm(limits=(-3600, 3600)),
        arm(density=7850.0), arm(density=15.0), arm(mass=mass()), arm((30.0, 3.0, 3.0)), arm(limits=(-2.88, 2.88)), arm(limits=(0.0, 1.31)), ship(), ship(mass=None, unit=0.001), arm(at=(0.0, 0.0, 500.0)),
        arm((399.0, 59.0, 33.0), mass=mass(2.0e8, moments=(2e10, 2e12, 2e12))), arm((0.004, 0.002, 0.003)),
        arm(rx=Freedom(Motion.LIMITED, math.radians(-10.0), math.radians(80.0))),
        arm(rx=Freedom(Motion.LIMITED, -20.0 * math.pi, 20.0 * math.pi)), arm(at=(5.0, 0.0, 0.0)),
    ],
)  # fmt: skip
def test_what_machines_have_is_not_told(scene):
    assert told(scene) == []


@pytest.mark.parametrize("turned, handed, expected", [(2, None, 1), (1, None, 0), (0, "left", 0)])
def test_poses_that_are_all_mirrored_are_likely_left_handed(turned, handed, expected, tmp_path):
    """A mirrored part among others is a mirrored part; all of them are a source that does not state its hand."""
    axes = [{"x": [1, 0, 0], "y": [0, 1, 0], "z": [0, 0, -1 if i < turned else 1]} for i in range(2)]
    parts = [
        {"id": f"p{i}", "kind": "part", "pose": {"o": [i, 0, 0], **a}, "grounded": True}
        for i, a in enumerate(axes)
    ]
    meta = {"format": "kinefab.bundle", "version": "1.0", "units": {"length": "m", "angle": "deg"}, "up": "Y"}
    meta |= {} if handed is None else {"handed": handed}
    path = tmp_path / "m.bundle.json"
    path.write_text(json.dumps({"meta": meta, "components": parts}), "utf-8")
    assert [code for code, _ in told(path)] == ["SOURCE_LIKELY_LEFT_HANDED"] * expected
