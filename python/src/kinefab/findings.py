"""What an analysis finds out about a joint: not part of the joint, but a record that names it."""

from __future__ import annotations

from dataclasses import dataclass

from .diagnostics import chained
from .model import Joint, JointKind, Scene, kind_of


@dataclass(frozen=True, slots=True)
class JointFinding:
    """joint: id of the joint that this is about; its frame and freedoms are those of ``model.Joint``.

    closure: the joint closes a loop (the spanning tree does not need it).
    loop: of a closure, the nodes (None: ground) from a to b, each joined to the next by a joint of the spanning tree.
    freed: freedoms (TX..RZ) that the joint locks by itself and that were left free, since the loop holds them.
    misfit: by how much the joint's motions miss what it stands for, at most, metres and radians; zero where exact.
    """

    joint: str
    closure: bool = False
    loop: tuple[int | None, ...] = ()
    freed: tuple[int, ...] = ()
    misfit: tuple[float, float] = (0.0, 0.0)

    def whole_kind(self, joint: Joint) -> JointKind:
        """The kind of the joint with what the loop holds instead of it."""
        return kind_of(tuple(i for i in joint.unlocked if i not in self.freed)) if self.freed else joint.kind

    def loop_names(self, scene: Scene) -> str:
        """The parts of the loop that the joint closes, for a message."""
        return chained([scene.name(node) for node in self.loop], " - ")
