"""The text of a STEP file (ISO 10303-21) as it stands, before any geometry: is it whole, what does it say of itself."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property

START, END = b"ISO-10303-21", b"END-ISO-10303-21"

_TOKENS = re.compile(rb"'(?:[^']|'')*'|/\*.*?\*/", re.DOTALL)
_INSTANCE = re.compile(rb"#\s*(\d+)\s*=\s*([^;]*);")
_REFERENCE = re.compile(rb"#\s*(\d+)")
_SCHEMA = re.compile(rb"FILE_SCHEMA\s*\(\s*\(\s*'([^']*)'", re.IGNORECASE)
_PAIR = re.compile(
    rb"\b(?:REVOLUTE|PRISMATIC|CYLINDRICAL|SPHERICAL|PLANAR|UNIVERSAL|HOMOKINETIC|SCREW|GEAR|RACK_AND_PINION|FULLY_CONSTRAINED|"
    rb"UNCONSTRAINED|LOW_ORDER_KINEMATIC|SLIDING_SURFACE|ROLLING_SURFACE|POINT_ON_SURFACE|SLIDING_CURVE|ROLLING_CURVE|"
    rb"POINT_ON_PLANAR_CURVE|PLANAR_CURVE|SURFACE|LINEAR_FLEXIBLE_AND_PINION|LINEAR_FLEXIBLE_AND_PLANAR_CURVE)"
    rb"_PAIR(?:_WITH_(?:RANGE|PIN(?:_AND_RANGE)?|MOTION_COUPLING))?\s*\("
)
_METRES = {
    b"": 1.0, b"EXA": 1e18, b"PETA": 1e15, b"TERA": 1e12, b"GIGA": 1e9, b"MEGA": 1e6, b"KILO": 1e3, b"HECTO": 1e2,
    b"DECA": 10.0, b"DECI": 0.1, b"CENTI": 1e-2, b"MILLI": 1e-3, b"MICRO": 1e-6, b"NANO": 1e-9, b"PICO": 1e-12,
    b"FEMTO": 1e-15, b"ATTO": 1e-18,
}  # fmt: skip
_CONVERSIONS = {b"INCH": 0.0254, b"FOOT": 0.3048, b"YARD": 0.9144, b"MILE": 1609.344, b"MIL": 2.54e-5}


@dataclass(frozen=True, eq=False)
class Part21:
    """The bytes of a STEP file.  strings and comments are blanked in ``plain``, so that what stands there is syntax."""

    data: bytes

    @cached_property
    def plain(self) -> bytes:
        return _TOKENS.sub(lambda found: b" " * len(found[0]), self.data)

    @property
    def starts(self) -> bool:
        return self.plain.lstrip(b"\xef\xbb\xbf \t\r\n\0").startswith(START)

    @property
    def ends(self) -> bool:
        """Whether the end is there: what was cut off is not."""
        return END in self.plain[-4096:]

    @cached_property
    def schema(self) -> str:
        found = _SCHEMA.search(self.data[:65536])
        return found[1].split(b"{")[0].strip().decode("ascii", "replace") if found else ""

    @cached_property
    def instances(self) -> dict[int, tuple[int, int]]:
        """Where each instance's text after the ``=`` lies in the data, by its number."""
        return {int(found[1]): found.span(2) for found in _INSTANCE.finditer(self.plain)}

    def text(self, number: int) -> bytes:
        first, last = self.instances[number]
        return self.data[first:last]

    def dangling(self) -> int:
        """How many numbers are referred to and never defined."""
        return len({int(number) for number in _REFERENCE.findall(self.plain)} - self.instances.keys())

    def metres(self) -> float:
        """Metres in the file's unit of length; the first one where it has several, a millimetre where none is found."""
        for found in re.finditer(rb"CONVERSION_BASED_UNIT\s*\(\s*'([^']*)'", self.data):
            if (name := found[1].strip().upper()) in _CONVERSIONS:
                return _CONVERSIONS[name]
        found = re.search(rb"SI_UNIT\s*\(\s*(?:\.(\w+)\.|\$)\s*,\s*\.METRE\.", self.plain)
        return _METRES.get((found[1] or b"").upper(), 1e-3) if found else 1e-3

    def kinematic_pairs(self) -> int:
        """How many pairs of an AP242 mechanism the file states."""
        return len(_PAIR.findall(self.plain))

    def external_files(self) -> list[str]:
        """Files that hold parts of the geometry, as they are named."""
        found = re.finditer(
            rb"=\s*(?:\(\s*)?DOCUMENT_FILE\s*\(\s*'((?:[^']|'')*)'\s*,\s*'((?:[^']|'')*)'", self.data
        )
        named = re.finditer(rb"APPLIED_EXTERNAL_IDENTIFICATION_ASSIGNMENT\s*\(\s*'((?:[^']|'')*)'", self.data)
        names = [entry[1] for entry in found] + [entry[1] for entry in named]
        return sorted({name.decode("utf-8", "replace") for name in names if name})
