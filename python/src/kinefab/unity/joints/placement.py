"""Which of a joint's two bodies carries the Unity component, and in which order PhysX takes them."""

from __future__ import annotations

from dataclasses import dataclass

from ...model import RX
from ..frames import Senses
from .coordinates import CanonicalJoint


@dataclass(frozen=True, slots=True)
class Placement:
    """on_a: the component is on the joint's ``a`` (else on ``b``).  swap: ``swapBodies``."""

    on_a: bool
    swap: bool

    @property
    def actors(self) -> Senses:
        """Of PhysX's "actor1 in actor0": actor0 is the component's own body, unless the actors are swapped."""
        return Senses.of(b_in_a=self.on_a != self.swap)

    @property
    def own(self) -> Senses:
        """Of the own body's motion against the connected one's."""
        return Senses.of(b_in_a=not self.on_a)


def place(joint: CanonicalJoint, a_is_ground: bool, b_is_ground: bool) -> Placement:
    """The component goes on ``b``, unless ``b`` has no Rigidbody or a's axes must be PhysX's actor0.

    Linear motion and the swing cone are measured in actor0's frame, which the model says is a's: then the
    component goes on ``a``, or on ``b`` with the actors swapped where ``a`` is the world.
    """
    if b_is_ground:
        return Placement(on_a=True, swap=False)
    if not order_matters(joint):
        return Placement(on_a=False, swap=False)
    return Placement(on_a=False, swap=True) if a_is_ground else Placement(on_a=True, swap=False)


def order_matters(joint: CanonicalJoint) -> bool:
    """Whether the joint moves differently when its two bodies change places."""
    rotations, translations = joint.rotations, joint.translations
    if not rotations:
        return False
    if rotations == (0,):
        across = tuple(i for i in translations if i != 0)
        return bool(across) and not (across == (1, 2) and joint.plain(across))
    if rotations == (0, 1, 2):
        whole = not translations or (len(translations) == 3 and joint.plain(translations))
        return not (whole and joint.plain(range(RX, RX + 3)))
    return True
