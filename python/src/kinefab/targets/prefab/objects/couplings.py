"""The script that keeps couplings, as a component of the object whose joint follows."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from ....unity.scene import ArticulationBody, Coupling, JointCoordinate, UnityScene
from ...numbers import DECIMALS
from ..text.documents import component_head
from ..text.ids import guid
from ..text.yaml import NULL, Fields, Plain, external, local

SCRIPT_ID = 11500000
IMPORTED = 3
FOLDER = Path(__file__).parents[1] / "scripts"
SCRIPT, ASSEMBLY = "KinefabCoupling.cs", "Kinefab.Couplings.asmdef"
COORDINATES = ("angle", "x", "y", "z", "angularX", "angularY", "angularZ")
"""By the numbers of the script's enumeration."""


def script_guid(name: str) -> str:
    """The same in every export: a project has the script once."""
    return guid("", "script", name)


def is_kept_by_script(coupling: Coupling, scene: UnityScene) -> bool:
    """Whether the script knows all of its coordinates: of a joint any, of a link that of the one axis that it has."""
    ends = (coupling.coordinate, *(term.coordinate for term in coupling.terms))
    links = [c for end in ends if isinstance(c := _component(end, scene), ArticulationBody)]
    return all(link.jointType in ("Revolute", "Prismatic") for link in links)


def _component(end: JointCoordinate, scene: UnityScene) -> object:
    return scene.gameObjects[end.gameObject].components[end.component]


def coupling_fields(
    coupling: Coupling, owner: int, ids: Mapping[tuple[int, int], int], scene: UnityScene
) -> Fields:
    """ids: fileIDs of the components, by object and component."""

    def side(end: JointCoordinate) -> tuple[Plain, Plain]:
        """The joint and the link: one of the two is none."""
        found = local(ids[end.gameObject, end.component])
        return (NULL, found) if isinstance(_component(end, scene), ArticulationBody) else (found, NULL)

    joint, link = side(coupling.coordinate)
    terms: list[Fields] = []
    for term in coupling.terms:
        other, other_link = side(term.coordinate)
        terms.append(
            {
                "joint": other,
                "articulationBody": other_link,
                "coordinate": COORDINATES.index(term.coordinate.coordinate),
                "ratio": float(term.ratio),
            }
        )
    return {
        **component_head(owner),
        "m_Enabled": 1,
        "m_EditorHideFlags": 0,
        "m_Script": external(SCRIPT_ID, script_guid(SCRIPT), IMPORTED),
        "m_Name": "",
        "m_EditorClassIdentifier": "",
        "driven": joint,
        "drivenArticulationBody": link,
        "drivenCoordinate": COORDINATES.index(coupling.coordinate.coordinate),
        "terms": terms,
        "offset": round(float(coupling.offset), DECIMALS),
        "stiffness": 10000,
        "damping": 200,
    }
