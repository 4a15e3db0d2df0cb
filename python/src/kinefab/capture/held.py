"""What is fixed in a sub-assembly that moves: it goes together, and stands for the sub-assembly itself, which is no body.

Standard library only: it also runs in a CAD program's own Python.
"""

from __future__ import annotations

from .draft import Draft


def hold(draft: Draft, held: dict[str, str], assembly: str, own: str) -> None:
    """Tie what is fixed in an assembly to the first that is.  held: of each assembly that one."""
    first = held.setdefault(assembly, own)
    if first != own:
        joint = draft.unique(f"grounded: {own.rpartition('/')[2]}")
        draft.joints.append({"id": joint, "name": joint, "type": "rigid", "a": first, "b": own})


def standing(held: dict[str, str], assembly: str, still: bool) -> str:
    """What an assembly's own planes, axes and origin are on.  still: whether it stands still in the open one."""
    return "ground" if still else held.get(assembly, assembly)
