"""What a URDF file holds for other programs, or misspells: left out by name."""

from __future__ import annotations

from ...diagnostics import Report
from ..robots.unread import Unread, children
from ..robots.xml_elements import Element

GRAMMAR = {
    "robot": children(
        "link joint material", foreign="gazebo transmission sensor mujoco plugin group end_effector"
    ),
    "link": children("visual collision", "inertial", "contact sensor gazebo origin"),
    "inertial": children(one="origin mass inertia"),
    "visual": children(one="origin geometry material"),
    "collision": children(
        one="origin geometry", foreign="material contact contact_coefficients surface verbose"
    ),
    "material": children(one="color texture"),
    "joint": children(
        one="origin parent child axis limit dynamics mimic safety_controller calibration",
        foreign="gazebo sensor",
    ),
}


def tell_unread(root: Element, report: Report) -> None:
    """Tell what of a robot no other module reads."""
    unread = Unread(GRAMMAR, _is_foreign, report)
    unread.look_through(root, "")
    unread.tell_rest()


def _is_foreign(tag: str, inside: str) -> bool:
    """Whether it looks like the name of an extension: of a robot or a link, in more than one word."""
    return ":" in tag or tag.startswith("drake") or ("_" in tag and inside in ("robot", "link"))
