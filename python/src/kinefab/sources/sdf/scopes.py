"""Names and frames of an SDF file: each model (and the world) is a scope, in which links, joints, frames and nested models
have names; poses are given relative to any of them."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...diagnostics import Report
from ...spatial import Pose, matrix_from_quaternion
from ..reading.near import near_matches
from ..robots.packages import Packages
from ..robots.robot_frame import rotation_rpy
from ..robots.unread import Unread
from ..robots.xml_elements import Element, truth

SCOPE_FRAMES = ("__model__", "__root__")


@dataclass(slots=True, eq=False)
class Entry:
    """A named frame of a scope.  kind: link, joint, frame or model.  owner: the scope whose frame its pose is counted from.
    inner: of a model.  link: that it moves with, once somebody has asked."""

    kind: str
    name: str
    element: Element
    owner: Scope
    inner: Scope | None = None
    pose: Pose | None = None
    link: Entry | None = None
    open: bool = False


@dataclass(slots=True, eq=False)
class Scope:
    """A model, or the world.  path: id of its node, "" for the world.  version: of its file, as (1, 9).
    posed: the element whose ``<pose>`` places it: its own or the ``<include>``.  placement: the frame that is placed there.
    merged: its entries have their names in the scope above.
    """

    name: str
    path: str
    element: Element
    above: Scope | None
    version: tuple[int, int]
    packages: Packages
    report: Report
    posed: Element
    unread: Unread
    placement: str = ""
    static: bool = False
    merged: bool = False
    entries: dict[str, Entry] = field(default_factory=dict[str, Entry])
    entry: Entry | None = None

    @property
    def is_world(self) -> bool:
        return self.above is None and self.element.tag != "model"

    def add(self, entry: Entry) -> None:
        """Note a name; a fault where it is taken.  What is merged stands in the scope above too."""
        scope: Scope | None = self
        while scope is not None:
            if (first := scope.entries.get(entry.name)) is not None:
                entry.element.fault("SOURCE_ID_DUPLICATE", id=entry.name, first=first.element.where)
                return
            scope.entries[entry.name] = entry
            scope = scope.above if scope.merged else None

    def find(self, name: str, asking: Element, feature: str) -> Entry | None:
        """As ``named``; None after a fault."""
        found, word, known = self._down(name)
        if found is None:
            near = near_matches(word, known, self.report)
            asking.fault("LINK_UNKNOWN", link=name, feature=feature, near=near)
        return found

    def named(self, name: str) -> Entry | None:
        """The entry of a name, with ``::`` between scopes, if there is one."""
        return self._down(name)[0]

    def _down(self, name: str) -> tuple[Entry | None, str, dict[str, Entry]]:
        """The entry, or None with the word that is unknown and those that are known in its place."""
        if name in self.entries:
            return self.entries[name], name, self.entries
        scope: Scope | None = self
        found: Entry | None = None
        for word in name.split("::"):
            known = {} if scope is None else scope.entries
            found = known.get(word)
            if found is None:
                return None, word, known
            scope = found.inner
        return found, name, self.entries

    def all_entries(self, kind: str) -> list[Entry]:
        """Its own and those of nested models, in the file's order."""
        found: list[Entry] = []
        for entry in self.entries.values():
            if entry.inner is not None:
                found += entry.inner.all_entries(kind) if not entry.inner.merged else []
            elif entry.kind == kind and (entry.owner is self or entry.owner.merged):
                found.append(entry)
        return found

    def scopes(self) -> list[Scope]:
        """This one and all below that are not merged."""
        inner = [e.inner for e in self.entries.values() if e.inner is not None and not e.inner.merged]
        return [self, *(s for scope in inner for s in scope.scopes())]


def pose_of(element: Element) -> Pose:
    """The numbers of an element's ``<pose>``, whatever they are relative to."""
    child = element.child("pose")
    if child is None:
        return Pose()
    if child.attributes.get("rotation_format", "euler_rpy") == "quat_xyzw":
        v = child.values(7, (0.0,) * 6 + (1.0,))
        q = np.array(v[3:])
        if not q @ q > 1e-18:
            child.fault("AXIS_ZERO", field="pose")
            return Pose(translation=np.array(v[:3]))
        return Pose(matrix_from_quaternion(q), np.array(v[:3]))
    v = child.values(6, (0.0,) * 6)
    scale = np.pi / 180.0 if truth(child.attributes.get("degrees", "")) else 1.0
    return Pose(rotation_rpy(*(scale * a for a in v[3:])), np.array(v[:3]))


def relative_to(element: Element, scope: Scope) -> str:
    """What an element's pose says that it is relative to; "" where it does not.

    Before 1.7 the word was ``frame``; files of those versions that have the newer word are read by it, as libsdformat does.
    """
    child = element.child("pose")
    if child is None:
        return ""
    found = child.attributes.get("relative_to", "").strip()
    return found or (child.attributes.get("frame", "").strip() if scope.version < (1, 7) else "")


def frame_pose(name: str, scope: Scope, asking: Element, feature: str) -> Pose:
    """The pose of a named frame in the scope's own frame."""
    if name in SCOPE_FRAMES or (name == "world" and scope.is_world):
        return Pose()
    if name == "world":
        return world_pose(scope).inverse()
    entry = scope.find(name, asking, feature)
    return Pose() if entry is None else pose_in(entry, scope)


def pose_in(entry: Entry, scope: Scope) -> Pose:
    """The pose of an entry in the frame of a scope that holds it, or holds what holds it."""
    pose, owner = entry_pose(entry), entry.owner
    while owner is not scope and owner.entry is not None:
        pose = entry_pose(owner.entry) @ pose
        owner = owner.entry.owner
    return pose


def world_pose(scope: Scope) -> Pose:
    """The pose of a scope's frame in the world."""
    if scope.entry is None:
        return Pose()
    return world_pose(scope.entry.owner) @ entry_pose(scope.entry)


def entry_world_pose(entry: Entry) -> Pose:
    """The pose of a link, joint or frame in the world, source axes, metres."""
    return world_pose(entry.owner) @ entry_pose(entry)


def entry_pose(entry: Entry) -> Pose:
    """The pose of an entry in its owner's frame."""
    if entry.pose is not None:
        return entry.pose
    # From the far end, since Python's calls are too few for a chain whose frames count from each other.
    chain, known = [entry], {entry}
    while (following := chain[-1].owner.entries.get(_base(chain[-1]))) is not None and following.pose is None:
        if following in known:
            following.element.fault("FRAME_CYCLE", feature=f"{following.kind} {following.name}")
            following.pose = Pose()
            break
        chain.append(following)
        known.add(following)
    for each in reversed(chain):
        each.pose = each.pose or _own_pose(each)
    assert entry.pose is not None
    return entry.pose


def _base(entry: Entry) -> str:
    """What an entry's pose is counted from; "" for its owner's frame."""
    base = relative_to(entry.element if entry.inner is None else entry.inner.posed, entry.owner)
    if not base and entry.kind == "joint":
        return entry.element.content("child")
    if not base and entry.kind == "frame":
        return entry.element.attributes.get("attached_to", "").strip()
    return base


def _own_pose(entry: Entry) -> Pose:
    """From that of what it is counted from."""
    feature = f"{entry.kind} {entry.name}"
    if entry.open:  # a cycle by way of other scopes
        entry.element.fault("FRAME_CYCLE", feature=feature)
        return Pose()
    entry.open = True
    scope, base = entry.owner, _base(entry)
    posed = entry.element if entry.inner is None else entry.inner.posed
    outer = frame_pose(base, scope, posed, feature) if base else Pose()
    pose = outer @ pose_of(posed)
    if entry.inner is not None and entry.inner.placement:
        inner = entry.inner
        pose = pose @ frame_pose(inner.placement, inner, posed, feature).inverse()
    entry.open = False
    return pose


def link_of(entry: Entry, feature: str) -> Entry | None:
    """The link that a frame moves with; None for the world, and after a fault."""
    seen: set[Entry] = set()
    while entry.kind != "link" and entry.link is None:
        if entry in seen:
            entry.element.fault("FRAME_CYCLE", feature=f"{entry.kind} {entry.name}")
            return None
        seen.add(entry)
        if entry.inner is not None:
            following = canonical_link(entry.inner)
        elif entry.kind == "joint":
            following = entry.owner.find(entry.element.content("child"), entry.element, feature)
        else:
            name = entry.element.attributes.get("attached_to", "").strip()
            if name == "world" or (not name and entry.owner.is_world):
                return None
            if not name or name in SCOPE_FRAMES:
                following = canonical_link(entry.owner)
            else:
                following = entry.owner.find(name, entry.element, feature)
        if following is None:
            return None
        entry = following
    link = entry.link or entry
    for each in seen:
        each.link = link
    return link


def canonical_link(scope: Scope) -> Entry | None:
    """The link that a model's own frame moves with: the named one, else its first, else that of its first nested model."""
    named = scope.element.attributes.get("canonical_link", "").strip()
    if named and not scope.merged:
        return scope.find(named, scope.element, f"model {scope.name}")
    own = next((e for e in scope.entries.values() if e.kind == "link"), None)
    if own is not None:
        return own
    nested = (e.inner for e in scope.entries.values() if e.inner is not None)
    return next((link for inner in nested if (link := canonical_link(inner)) is not None), None)


def visible(scope: Scope) -> Scope:
    """The scope whose node a link hangs from: an include that is merged has its links in the model around it."""
    while scope.merged and scope.above is not None:
        scope = scope.above
    return scope
