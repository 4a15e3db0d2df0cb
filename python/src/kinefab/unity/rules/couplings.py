"""Couplings between joint coordinates."""

from __future__ import annotations

from collections.abc import Sequence

from .findings import Entry, Findings
from .hierarchy import Hierarchy
from .links import LINK


def check_couplings(couplings: Sequence[Entry], places: Hierarchy, found: Findings) -> None:
    for index, coupling in enumerate(couplings):
        _check(coupling, f"/couplings/{index}", places, found)


def _check(coupling: Entry, at: str, places: Hierarchy, found: Findings) -> None:
    b: Entry = coupling["b"]
    if "terms" not in coupling:
        for field in ("a", "ratio"):
            if field not in coupling:
                found.add("FIELD_MISSING", at, field=field)
    elif "a" in coupling or "ratio" in coupling:
        found.add("COUPLING_TERMS_BESIDE", f"{at}/{'a' if 'a' in coupling else 'ratio'}")
    known: list[object] = []
    for index, term in enumerate(coupling.get("terms", ())):
        end, place = term["coordinate"], f"{at}/terms/{index}/coordinate"
        _demand_coordinate(end, place, places, found)
        if _place(end) == _place(b):
            found.add("COUPLING_ITSELF", place)
        elif _place(end) in known:
            found.add("COUPLING_TERM_TWICE", place)
        known.append(_place(end))
    if "a" in coupling:
        _demand_coordinate(coupling["a"], f"{at}/a", places, found)
    _demand_coordinate(b, f"{at}/b", places, found)
    if "a" in coupling and _place(coupling["a"]) == _place(b):
        found.add("COUPLING_ITSELF", f"{at}/b")


def _place(end: Entry) -> tuple[int, int, str]:
    return end["gameObject"], end["component"], end["coordinate"]


def _demand_coordinate(end: Entry, at: str, places: Hierarchy, found: Findings) -> None:
    """That it is one of a joint, and that this has it."""
    owner, index, coordinate = _place(end)
    if not found.reference(owner, "gameObjects", len(places.objects), f"{at}/gameObject"):
        return
    components = places.objects[owner].get("components", ())
    if not found.reference(index, "components", len(components), f"{at}/component"):
        return
    kind: str = components[index]["type"]
    turns = coordinate == "angle"
    linked = kind == LINK and not turns and places.links_above[owner] is not None
    if kind.endswith("Joint") and (kind == "FixedJoint" or turns != (kind == "HingeJoint")):
        found.add("COUPLING_COORDINATE_MISSING", f"{at}/coordinate", coordinate=coordinate)
    elif not kind.endswith("Joint") and not linked:
        found.add("COUPLING_NOT_A_JOINT", f"{at}/component", component=index)
