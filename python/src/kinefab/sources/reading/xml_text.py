"""XML bytes to elements, strict and bounded: no document type, so no entities of its own and nothing from elsewhere."""

from __future__ import annotations

from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

from ...diagnostics import Report

MAX_ELEMENTS = 4_000_000
"""Most elements in one file: a small text of tags must not become gigabytes of objects."""
MAX_DEPTH = 128
"""Deepest nesting."""


class _Refused(Exception):
    """What the parser was stopped for."""


def parse_xml(data: bytes, name: str, report: Report) -> Element:
    """The root element.  name: of the file, for diagnostics.  Raises KinefabError when it is not XML, has a document
    type (and with it entities), or is larger or deeper than any real file."""
    builder = TreeBuilder()
    parser = expat.ParserCreate()
    parser.buffer_text = True
    depth = count = 0

    def start(tag: str, attributes: dict[str, str]) -> None:
        nonlocal depth, count
        depth, count = depth + 1, count + 1
        if depth > MAX_DEPTH:
            raise _Refused(f"it is nested more than {MAX_DEPTH} levels deep")
        if count > MAX_ELEMENTS:
            raise _Refused(f"it has more than {MAX_ELEMENTS} elements")
        builder.start(tag, attributes)

    def end(tag: str) -> None:
        nonlocal depth
        depth -= 1
        builder.end(tag)

    def doctype(*_: object) -> None:
        raise _Refused("it has a document type; entities are not taken")

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.CharacterDataHandler = builder.data
    parser.StartDoctypeDeclHandler = doctype
    detail, place = "", name
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        detail, place = expat.ErrorString(error.code), f"{name}:{error.lineno}:{error.offset + 1}"
    except _Refused as error:
        detail, place = str(error), f"{name}:{parser.CurrentLineNumber}"
    except (ValueError, LookupError) as error:  # an encoding that Python does not have
        detail = str(error)
    if detail:
        report.add("XML_REFUSED", place, detail=detail)
        report.raise_for_errors()
    return builder.close()


def root_name(head: bytes) -> str:
    """The name of the first element, without its namespace; "" where the bytes hold none.

    head: how the file begins, in any encoding that XML knows; comments, declarations and document types are passed over.
    """
    found: list[str] = []
    parser = expat.ParserCreate()

    def start(tag: str, attributes: dict[str, str]) -> None:
        found.append(tag.rpartition(":")[2])
        raise _Refused

    parser.StartElementHandler = start
    try:
        parser.Parse(head.lstrip(), False)
    except (_Refused, expat.ExpatError, ValueError, LookupError):
        pass
    return found[0] if found else ""
