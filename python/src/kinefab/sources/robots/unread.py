"""Elements of a robot's file that nothing reads: told by name and place up to a number, the rest counted."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from ...diagnostics import Report
from ..reading.record import shown
from .xml_elements import Element

MOST_TOLD = 1000
"""Findings of one file; a file of tags alone would make millions."""
MOST_NAMED = 8


@dataclass(frozen=True, slots=True)
class Children:
    """Of one element, by their tags.  many: read, each of them.  one: read, the first.  foreign: known to have no place
    in a scene."""

    many: frozenset[str]
    one: frozenset[str]
    foreign: frozenset[str]


def children(many: str = "", one: str = "", foreign: str = "") -> Children:
    """Each as words."""
    return Children(*(frozenset(words.split()) for words in (many, one, foreign)))


@dataclass(slots=True)
class Unread:
    """grammar: what is read, by the tag of the element that holds it.  is_foreign: of
    other tags and the one that holds them."""

    grammar: Mapping[str, Children]
    is_foreign: Callable[[str, str], bool]
    report: Report
    _told: int = 0
    _more: Counter[str] = field(default_factory=Counter[str])
    _where: str = ""

    def look_through(self, root: Element, label: str, prefix: str = "") -> None:
        """Tell what is not read, the outer elements first.  label: of the root.  prefix: of names in it."""
        waiting = deque([(root, label, prefix)])
        while waiting:
            element, label, prefix = waiting.popleft()
            known = self.grammar[element.tag]
            seen: set[str] = set()
            for child in element.children:
                tag = child.tag
                if tag in seen and tag in known.one:
                    self._tell(child, element, label, "ELEMENT_REPEATED")
                elif tag not in known.many and tag not in known.one:
                    foreign = tag in known.foreign or self.is_foreign(tag, element.tag)
                    self._tell(child, element, label, "ELEMENT_DROPPED" if foreign else "ELEMENT_UNKNOWN")
                elif tag in self.grammar:
                    name = child.attributes.get("name", "").strip()
                    inner = f"{prefix}{name}/" if tag == "model" else prefix
                    waiting.append((child, _label(child, label, prefix), inner))
                seen.add(tag)

    def _tell(self, child: Element, inside: Element, label: str, code: str) -> None:
        self._told += 1
        if self._told > MOST_TOLD:
            self._where = self._where or child.where
            self._more[child.tag] += 1
            return
        values = {} if code == "ELEMENT_DROPPED" else {"element": shown(child.tag), "inside": inside.tag}
        self.report.dropped(_feature(child, label), code, child.where, **values)

    def tell_rest(self) -> None:
        """One finding for all that were not told; to be called at the end."""
        if not self._more:
            return
        named = [f"{shown(tag)} ({n})" for tag, n in self._more.most_common(MOST_NAMED)]
        names = ", ".join(named) + (" ..." if len(self._more) > MOST_NAMED else "")
        count = self._more.total()
        self.report.dropped(
            f"{count} more elements", "ELEMENTS_OMITTED", self._where, count=count, names=names
        )


def _named(element: Element) -> str:
    """What an extension calls itself, or what it is about."""
    keys = ("name", "reference", "link")
    return next((element.attributes[key] for key in keys if element.attributes.get(key)), "")


def _label(element: Element, outer: str, prefix: str) -> str:
    name = element.attributes.get("name", "").strip()
    if element.tag in ("link", "joint", "model"):
        return f"{element.tag} {prefix}{name}"
    own = f"{element.tag} {name}".strip()
    return f"{own} of {outer}" if outer else own


def _feature(child: Element, label: str) -> str:
    own = f"{shown(child.tag)} {_named(child)}".strip()
    return f"{own} of {label}" if label else own
