"""The script that keeps couplings, as a component of the object whose joint follows."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from ....unity.scene import Coupling, JointCoordinate
from ...numbers import DECIMALS
from ..text.documents import component_head
from ..text.ids import guid
from ..text.yaml import Fields, external, local

SCRIPT_ID = 11500000
IMPORTED = 3
FOLDER = Path(__file__).parents[1] / "scripts"
SCRIPT, ASSEMBLY = "KinefabCoupling.cs", "Kinefab.Couplings.asmdef"
COORDINATES = ("angle", "x", "y", "z", "angularX", "angularY", "angularZ")
"""By the numbers of the script's enumeration."""


def script_guid(name: str) -> str:
    """The same in every export: a project has the script once."""
    return guid("", "script", name)


def coupling_fields(coupling: Coupling, owner: int, joints: Mapping[tuple[int, int], int]) -> Fields:
    """joints: fileIDs of the components, by object and component."""

    def joint(end: JointCoordinate) -> int:
        return joints[end.gameObject, end.component]

    return {
        **component_head(owner),
        "m_Enabled": 1,
        "m_EditorHideFlags": 0,
        "m_Script": external(SCRIPT_ID, script_guid(SCRIPT), IMPORTED),
        "m_Name": "",
        "m_EditorClassIdentifier": "",
        "driven": local(joint(coupling.coordinate)),
        "drivenCoordinate": COORDINATES.index(coupling.coordinate.coordinate),
        "terms": [
            {
                "joint": local(joint(term.coordinate)),
                "coordinate": COORDINATES.index(term.coordinate.coordinate),
                "ratio": float(term.ratio),
            }
            for term in coupling.terms
        ],
        "offset": round(float(coupling.offset), DECIMALS),
        "stiffness": 10000,
        "damping": 200,
    }
