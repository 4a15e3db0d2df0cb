"""Which of the last export's objects and components this export's are: Unity knows them by their numbers.

What has a name of its own is known by it.  What has none is known by what it is, shape and class, and by where it stands below the
same parent: first what is the same, then the nearest of its shape, then what stands in its place; ties by the order.  A name that
is new is the old object's where all else is the same.
"""

from __future__ import annotations

import math
import re
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from ..last import Document, LastExport

NEAR = 1e-6
"""Metres, and parts of a quaternion, within which two places are one: a prefab's numbers have 32 bits."""
MOST_PAIRS = 250_000
"""Objects that lost their places are compared each with each up to here, beyond it in their order."""
SHAPES = ("MeshFilter", "BoxCollider", "SphereCollider", "CapsuleCollider", "MeshCollider")
CHANGED_LINES = {"HingeJoint": 3, "ConfigurableJoint": 3}
"""Fields in which a component without a name may differ from the one that it was; 1 of a collider."""
BLANKED = re.compile(r"\{fileID: -?\d+\}")
NUMBERS = re.compile(r"-?\d+\.?\d*(?:e[+-]?\d+)?")

Place = tuple[float, ...]
"""Position, rotation, scale."""


@dataclass(slots=True)
class NewComponent:
    """file_id: by its name.  counted: it has none.  text: of its document, made when asked."""

    kind: str
    file_id: int
    counted: bool
    text: Callable[[], str]


@dataclass(slots=True)
class NewObject:
    """file_id, transform_id: by its name.  parent: its place in the list, None for the root."""

    id: str
    name: str
    file_id: int
    transform_id: int
    parent: int | None
    counted: bool
    place: Place
    components: list[NewComponent]


@dataclass(slots=True)
class Matched:
    """What the last export called them.  objects: old GameObject and Transform by the new's place.  components: by object and place
    among its components.  unsure: ids of objects that may as well be others."""

    objects: dict[int, tuple[int, int]] = field(default_factory=dict[int, tuple[int, int]])
    components: dict[tuple[int, int], Document] = field(default_factory=dict[tuple[int, int], Document])
    unsure: list[str] = field(default_factory=list[str])


@dataclass(slots=True)
class _Seen:
    """What an object is, and where."""

    kinds: tuple[str, ...]
    shape: str
    place: Place
    name: str


def matched(last: LastExport, objects: Sequence[NewObject]) -> Matched:
    return _Matching(last, objects).all()


class _Matching:
    def __init__(self, last: LastExport, objects: Sequence[NewObject]):
        self.last, self.objects = last, objects
        self.found = Matched()
        self.old_of: dict[int, int] = {}
        self.taken: set[int] = set()

    def all(self) -> Matched:
        for i, own in enumerate(self.objects):
            if not own.counted and self.last.is_a(own.file_id, "GameObject"):
                self._is(i, own.file_id)
        below: dict[int | None, list[int]] = defaultdict(list)
        for i, own in enumerate(self.objects):
            below[own.parent].append(i)
        waiting: list[int | None] = [None]
        while waiting:
            parent = waiting.pop()
            children = below.get(parent, [])
            if parent is None or parent in self.old_of:
                self._children(parent, [i for i in children if i not in self.old_of])
            waiting += children
        for i, old in sorted(self.old_of.items()):
            self._components(i, old)
        return self.found

    def _is(self, new: int, old: int) -> None:
        self.old_of[new] = old
        self.taken.add(old)

    def _children(self, parent: int | None, new: list[int]) -> None:
        if not new:
            return
        old = [c for c in self.last.children(0 if parent is None else self.old_of[parent]) if c not in self.taken]
        if not old:
            return
        mine = {i: self._seen_now(self.objects[i]) for i in new}
        theirs = {c: self._seen_then(c) for c in old}
        self._same(mine, theirs)
        self._nearest(mine, theirs)
        self._in_place(mine, theirs)

    def _same(self, mine: dict[int, _Seen], theirs: dict[int, _Seen]) -> None:
        """The same shape in the same place."""
        at: dict[object, list[int]] = defaultdict(list)
        for c, seen in theirs.items():
            at[seen.kinds, seen.shape, _rounded(seen.place)].append(c)
        for i, seen in list(mine.items()):
            there = at.get((seen.kinds, seen.shape, _rounded(seen.place)), [])
            if there:
                own = self.objects[i]
                best = min(there, key=lambda c: (c != own.file_id, theirs[c].name != own.name))
                there.remove(best)
                self._is(i, best)
                del mine[i], theirs[best]

    def _nearest(self, mine: dict[int, _Seen], theirs: dict[int, _Seen]) -> None:
        """What has no name and has moved."""
        for shape in dict.fromkeys((s.kinds, s.shape) for s in mine.values()):
            now = [i for i, s in mine.items() if (s.kinds, s.shape) == shape and self.objects[i].counted]
            then = [c for c, s in theirs.items() if (s.kinds, s.shape) == shape]
            if len(now) * len(then) > MOST_PAIRS:
                pairs: Iterable[tuple[int, int]] = zip(now, then)
            else:
                near = [(_apart(mine[i].place, theirs[c].place), c != self.objects[i].file_id, i, c) for i in now for c in then]
                pairs = [(i, c) for _, _, i, c in sorted(near)]
            several = len(now) > 1 or len(then) > 1
            for i, c in pairs:
                if i in mine and c in theirs:
                    self._is(i, c)
                    if several:
                        self.found.unsure.append(self.objects[i].id)
                    del mine[i], theirs[c]

    def _in_place(self, mine: dict[int, _Seen], theirs: dict[int, _Seen]) -> None:
        """What has no name and another shape."""
        for i, seen in list(mine.items()):
            alike = [c for c, s in theirs.items() if s.kinds == seen.kinds and _apart(s.place, seen.place) <= NEAR]
            if self.objects[i].counted and alike:
                self._is(i, alike[0])
                if len(alike) > 1:
                    self.found.unsure.append(self.objects[i].id)
                del mine[i], theirs[alike[0]]

    def _seen_now(self, own: NewObject) -> _Seen:
        shapes = [_blank(c.text()) for c in own.components if c.kind in SHAPES]
        return _Seen(tuple(sorted(c.kind for c in own.components)), "".join(sorted(shapes)), own.place, own.name)

    def _seen_then(self, game_object: int) -> _Seen:
        transform, *components = self.last.components(game_object) or [Document(0, "", "")]
        components = [c for c in components if c.kind not in ("MonoBehaviour", "Animation")]
        place = (*transform.numbers("m_LocalPosition"), *transform.numbers("m_LocalRotation"), *transform.numbers("m_LocalScale"))
        shapes = [_blank(c.text) for c in components if c.kind in SHAPES]
        named = self.last.document(game_object)
        name = re.search(r"^  m_Name: ?(.*)$", "" if named is None else named.text, re.MULTILINE)
        return _Seen(tuple(sorted(c.kind for c in components)), "".join(sorted(shapes)), place, name[1] if name else "")

    def _components(self, i: int, old: int) -> None:
        own = self.objects[i]
        documents = self.last.components(old)
        if not documents:
            return
        transform, *rest = documents
        self.found.objects[i] = (old, transform.file_id)
        then = {d.file_id: d for d in rest}
        now: dict[int, NewComponent] = {}
        for k, component in enumerate(own.components):
            if not component.counted and component.file_id in then:
                self.found.components[i, k] = then.pop(component.file_id)
            else:
                now[k] = component
        for kind in dict.fromkeys(c.kind for c in now.values()):
            self._of_a_kind(
                i, {k: c for k, c in now.items() if c.kind == kind}, {n: d for n, d in then.items() if d.kind == kind}
            )

    def _of_a_kind(self, i: int, now: dict[int, NewComponent], then: dict[int, Document]) -> None:
        """Components of one class of one object: first those that are written alike, then by how many fields they differ in."""
        if len(now) == len(then) == 1 and not next(iter(now.values())).kind.endswith(("Joint", "Collider")):
            self.found.components[i, next(iter(now))] = next(iter(then.values()))
            return
        if not then:
            return
        mine = {k: _blank(c.text()) for k, c in now.items()}
        theirs = {n: _blank(d.text) for n, d in then.items()}
        alike: dict[str, list[int]] = defaultdict(list)
        for n, text in theirs.items():
            alike[text].append(n)
        for k, text in list(mine.items()):
            if there := alike.get(text):
                own = now[k].file_id if now[k].file_id in there else there[0]
                there.remove(own)
                self.found.components[i, k] = then[own]
                del mine[k], theirs[own]
        mine = {k: text for k, text in mine.items() if now[k].counted}
        if len(mine) * len(theirs) <= MOST_PAIRS:
            self._with_changes(i, {k: now[k] for k in mine}, mine, {n: then[n] for n in theirs}, theirs)

    def _with_changes(
        self, i: int, now: dict[int, NewComponent], mine: dict[int, str], then: dict[int, Document], theirs: dict[int, str]
    ) -> None:
        """Those without a name by how many fields they differ in, then by how much."""
        pairs = [
            (*difference, n != now[k].file_id, k, n)
            for k in mine
            for n in theirs
            if (difference := _difference(mine[k], theirs[n]))[0] <= CHANGED_LINES.get(now[k].kind, 1)
        ]
        told: set[int] = set()
        chances = Counter(pair[3] for pair in pairs)
        for _, _, _, k, n in sorted(pairs):
            if (i, k) not in self.found.components and n not in told:
                told.add(n)
                self.found.components[i, k] = then[n]
                if chances[k] > 1:
                    self.found.unsure.append(self.objects[i].id)


def _blank(text: str) -> str:
    """Without the numbers of objects in the same file; those of assets stay, by their guids."""
    return BLANKED.sub("{}", text)


def _difference(one: str, other: str) -> tuple[int, float]:
    """In how many lines two texts differ, and by how much in their numbers."""
    a, b = one.splitlines(), other.splitlines()
    if len(a) != len(b):
        return max(len(a), len(b)), math.inf
    lines, apart = 0, 0.0
    for x, y in zip(a, b):
        if x != y:
            lines += 1
            apart += sum(abs(float(p) - float(q)) for p, q in zip(NUMBERS.findall(x), NUMBERS.findall(y)))
    return lines, apart


def _apart(a: Place, b: Place) -> float:
    """Metres, and parts of quaternions, of which either sign is one turn."""
    if len(a) != 10 or len(b) != 10:
        return math.inf
    turns = min(math.dist(a[3:7], b[3:7]), math.dist(a[3:7], [-x for x in b[3:7]]))
    return math.dist(a[:3], b[:3]) + turns + math.dist(a[7:], b[7:])


def _rounded(place: Place) -> tuple[float, ...]:
    sign = next((math.copysign(1.0, x) for x in reversed(place[3:7]) if abs(x) > NEAR), 1.0)
    return tuple(round(x, 6) + 0.0 for x in (*place[:3], *(sign * x for x in place[3:7]), *place[7:]))


def assets_of_before(
    pairs: Iterable[tuple[str, Document]], last: LastExport, now: frozenset[str]
) -> Mapping[str, str]:
    """The guids of the last export's assets by those that they would get: of what the same component referred to, where this
    export has no other of that guid.

    pairs: a component's new text, and its old document.  now: the guids of all this export's assets.
    """
    found: dict[str, str] = {}
    taken = set(now)
    for text, old in pairs:
        new_guids, old_guids = Document(0, "", text).guids, old.guids
        if len(new_guids) != len(old_guids):
            continue
        for a, b in zip(new_guids, old_guids):
            if a == b or a in found or b in taken:
                continue
            if a not in last.own and b in last.own:
                found[a] = b
                taken.add(b)
    return found
