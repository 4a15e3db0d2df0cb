"""XML as elements that know their line, read within limits; whatever is wrong with it becomes a diagnostic at its place.

No entity of the file's own is taken, inside or outside: such a file can grow without end or read others.
"""

from __future__ import annotations

import codecs
import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TypeVar
from xml.parsers import expat

from ...diagnostics import KinefabError, Report, Severity, is_encodable
from ..reading.record import MAX_NUMBER, shown

T = TypeVar("T")

_COMMENT = re.compile(rb"<!--.*?-->", re.DOTALL)
_ENCODING = re.compile(rb"\A(?:\xef\xbb\xbf)?<\?xml[^>]*?\bencoding\s*=\s*[\"']([A-Za-z][\w.-]*)[\"']")
DECODED = frozenset("utf-8 shift_jis cp932 euc_jp gb2312 gbk gb18030 big5 euc_kr cp949".split())
"""Encodings that Python reads and expat does not, or not by all their names (``utf8``)."""
_ENDS = re.compile(rb"(?:</[^<>]*>\s*)+\Z")
_ANOTHER = re.compile(rb"<[A-Za-z_]")
_BARE = re.compile(rb"&(?!#?\w+;)")
_NO_VERSION = re.compile(rb"\A<\?xml(?![^>]*\bversion\s*=)[^>\n]*\?>")

MAX_DEPTH = 128
MAX_ELEMENTS = 2_000_000


@dataclass(slots=True, eq=False)
class Element:
    """One element.  text: what stands in it, without its children.  path: the file's name.  line: from 1.

    What is wrong with a value is added to ``report``; the accessors then return a harmless one (zeros, the default).
    """

    tag: str
    attributes: Mapping[str, str]
    path: str
    line: int
    report: Report
    children: list[Element] = field(default_factory=list["Element"])
    text: str = ""

    @property
    def where(self) -> str:
        return f"{self.path}:{self.line}"

    # Children .........................................................................................................

    def child(self, tag: str) -> Element | None:
        """The first child of that name."""
        return next((child for child in self.children if child.tag == tag), None)

    def all(self, *tags: str) -> Iterator[Element]:
        """The children of these names, in order."""
        return (child for child in self.children if child.tag in tags)

    def content(self, tag: str) -> str:
        """The text of the first child of that name, stripped; "" without one."""
        child = self.child(tag)
        return "" if child is None else child.text.strip()

    # Faults ...........................................................................................................

    def fault(self, code: str, **values: object) -> None:
        self.report.add(code, self.where, **values)

    def wrong(self, name: str, wanted: str, found: str) -> None:
        self.fault("XML_VALUE", element=shown(self.tag), field=name, wanted=wanted, found=shown(found))

    # Values ...........................................................................................................

    def name(self, key: str = "name") -> str:
        """A name that must be there; "" after a fault."""
        value = self.attributes.get(key, "").strip()
        if not value:
            self.fault("XML_MISSING", element=shown(self.tag), field=key)
        elif not is_encodable(value) or not value.isprintable():
            self.wrong(key, "a name of printable characters", value)
            return ""
        return value

    def number(self, key: str, default: float = 0.0, infinite: bool = False) -> float:
        """An attribute.  infinite: whether it may be."""
        given = self.attributes.get(key)
        if given is None or not given.strip():
            return default
        found = self.parsed(key, given, 1, infinite)
        return default if found is None else found[0]

    def numbers(self, key: str, count: int, default: tuple[float, ...]) -> tuple[float, ...]:
        """An attribute of ``count`` numbers, between blanks."""
        given = self.attributes.get(key)
        if given is None or not given.strip():
            return default
        found = self.parsed(key, given, count)
        return default if found is None else found

    def value(self, default: float = 0.0, infinite: bool = False) -> float:
        """The text as a number."""
        found = self.values(1, (default,), infinite)
        return found[0]

    def values(self, count: int, default: tuple[float, ...], infinite: bool = False) -> tuple[float, ...]:
        """The text as ``count`` numbers."""
        if not self.text.strip():
            return default
        found = self.parsed("text", self.text, count, infinite)
        return default if found is None else found

    def parsed(self, name: str, text: str, count: int, infinite: bool = False) -> tuple[float, ...] | None:
        """So many finite numbers; None, and a finding at the element, where the text is anything else.

        infinite: a number beyond MAX_NUMBER is no bound, instead of a fault.
        """
        words = text.replace(",", " ").split() if count > 1 else [text.strip()]
        wanted = "a number" if count == 1 else f"{count} numbers"
        try:
            found = tuple(map(_number, words))
        except ValueError:
            self.wrong(name, wanted, text.strip())
            return None
        if len(found) != count:
            self.wrong(name, wanted, text.strip())
            return None
        if infinite:  # 1e16 is how some formats write it
            found = tuple(math.copysign(math.inf, v) if abs(v) > MAX_NUMBER else v for v in found)
        for number in found:
            if not (abs(number) <= MAX_NUMBER or (infinite and math.isinf(number))):
                self.wrong(name, f"{wanted}, none beyond {MAX_NUMBER:g}", text.strip())
                return None
        return found

    def choice(self, name: str, word: str, words: Mapping[str, T]) -> T | None:
        """What ``word``, the value called ``name``, stands for; None after a fault."""
        if word in words:
            return words[word]
        self.wrong(name, "one of: " + ", ".join(words), word)
        return None


def truth(text: str, default: bool = False) -> bool:
    """What true, 1, false and 0 say, in letters of any size; ``default`` for all else."""
    return {"true": True, "1": True, "false": False, "0": False}.get(text.strip().lower(), default)


def _number(word: str) -> float:
    if "_" in word:  # Python's digit separator is nobody else's
        raise ValueError(word)
    return float(word)


class _Refused(Exception):
    """Raised in a callback to end the parsing; the report says why."""


class _Builder:
    """Takes the parser's events."""

    def __init__(self, name: str, report: Report, faults: Report, encoding: str | None) -> None:
        self.name, self.report, self.faults = name, report, faults
        self.root: Element | None = None
        self.open: list[Element] = []
        self.pieces: list[list[str]] = []
        self.count = 0
        self.parser = expat.ParserCreate(encoding)
        self.parser.buffer_text = True
        self.parser.StartElementHandler = self.start
        self.parser.EndElementHandler = self.end
        self.parser.CharacterDataHandler = self.characters
        self.parser.EntityDeclHandler = self.entity
        self.parser.SkippedEntityHandler = self.entity
        self.parser.ExternalEntityRefHandler = self.entity

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        self.count += 1
        if len(self.open) >= MAX_DEPTH or self.count > MAX_ELEMENTS:
            limit = f"{MAX_DEPTH} levels" if len(self.open) >= MAX_DEPTH else f"{MAX_ELEMENTS} elements"
            self.refuse("XML_TOO_LARGE", limit=limit)
        element = Element(tag, attributes, self.name, self.parser.CurrentLineNumber, self.report)
        if self.open:
            self.open[-1].children.append(element)
        else:
            self.root = element
        self.open.append(element)
        self.pieces.append([])

    def end(self, tag: str) -> None:
        self.open.pop().text = "".join(self.pieces.pop())

    def characters(self, text: str) -> None:
        if self.pieces:
            self.pieces[-1].append(text)

    def entity(self, *_: object) -> int:
        self.refuse("XML_ENTITY")
        return 0

    def refuse(self, code: str, **values: object) -> None:
        self.faults.add(code, f"{self.name}:{self.parser.CurrentLineNumber}", **values)
        raise _Refused


def without_comments(data: bytes) -> bytes:
    """The same, each line where it was."""
    return _COMMENT.sub(lambda match: b"\n" * match[0].count(b"\n"), data)


def parse_xml(data: bytes, name: str, report: Report) -> Element:
    """The root element.  name: of the file, for places.  Raises KinefabError for what is no XML or beyond the limits."""
    # Against the rules, and read by robot programs: blanks before the declaration, one without a version, -- in a comment,
    # an & that begins no entity, ends of elements after that of the root, and further elements there, which they pass over.
    data = _NO_VERSION.sub(b"", data.lstrip())
    tried = Report()
    root = _built(data, name, report, tried)
    if root is None and any(d.code == "XML_SYNTAX" for d in tried.diagnostics):
        root = _built(_BARE.sub(b"&amp;", without_comments(data)), name, report, Report())
    if root is None:
        report.extend(tried)
        raise KinefabError(report.of(Severity.ERROR))
    return root


def _built(data: bytes, name: str, report: Report, faults: Report) -> Element | None:
    """None where ``faults`` gets the reason.  report: of the elements."""
    builder = None
    try:
        decoded = _decoded(data)
        data = data if decoded is None else decoded
        builder = _Builder(name, report, faults, None if decoded is None else "utf-8")
        builder.parser.Parse(data, True)
        return builder.root
    except _Refused:
        pass
    except expat.ExpatError as error:
        if builder is not None and builder.root is not None and not builder.open:
            rest = builder.parser.ErrorByteIndex
            if _ANOTHER.match(data, rest):
                report.add("XML_AFTER_ROOT", f"{name}:{error.lineno}", element=shown(builder.root.tag))
                return builder.root
            if _ENDS.match(data, rest - 1):  # the index is that of the slash
                return builder.root
        detail = expat.errors.messages[error.code]
        faults.add("XML_SYNTAX", f"{name}:{error.lineno}", detail=detail)
    except (LookupError, ValueError) as error:  # an encoding that nobody knows, bytes that are none of it
        faults.add("XML_SYNTAX", f"{name}:1", detail=error)
    return None


def _decoded(data: bytes) -> bytes | None:
    """As UTF-8, where expat would not know the encoding that is stated; None where it does.  Raises LookupError and
    ValueError."""
    match = _ENCODING.match(data)
    if match is None or match[1].lower() == b"utf-8":
        return None
    name = codecs.lookup(match[1].decode("ascii")).name
    return data.decode(name).encode() if name in DECODED else None
