"""ArticulationBodies."""

from __future__ import annotations

from .findings import Entry, Findings
from .hierarchy import Hierarchy

LINK = "ArticulationBody"


def motion(link: Entry, axis: int) -> str:
    """Of its coordinate along or about X, Y or Z of the joint: ``Locked``, ``Limited`` or ``Free``."""
    kind = link.get("jointType", "Fixed")
    if kind == "Spherical":
        return link.get(("twistLock", "swingYLock", "swingZLock")[axis], "Locked")
    if axis > 0 or kind == "Fixed":
        return "Locked"
    locked = link.get("linearLock" if kind == "Prismatic" else "twistLock", "Locked")
    return "Limited" if locked == "Limited" else "Free"


def check_link(link: Entry, index: int, at: str, places: Hierarchy, found: Findings) -> None:
    """The order of limits that count, and what stands beside and above it."""
    for axis, name in enumerate(("xDrive", "yDrive", "zDrive")):
        drive: Entry = link.get(name, {})
        lower, upper = drive.get("lowerLimit", 0), drive.get("upperLimit", 0)
        if lower > upper and motion(link, axis) == "Limited":
            found.add("LINK_LIMITS_ORDER", f"{at}/{name}/lowerLimit", lower=lower, upper=upper)
    objects = places.objects
    if any(component["type"] == "Rigidbody" for component in objects[index]["components"]):
        found.add("LINK_AND_RIGIDBODY", at)
    parent = places.parents[index]
    above = None if parent is None else places.bodies[parent]
    if above is not None and not places.is_link[above]:
        found.add("LINK_BELOW_RIGIDBODY", at, object=objects[above]["id"])
