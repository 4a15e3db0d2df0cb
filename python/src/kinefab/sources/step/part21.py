"""The text of a STEP file (ISO 10303-21) as it stands, before any geometry: is it whole, what does it say of itself."""

from __future__ import annotations

import math
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
METRES_OF_PREFIX = {
    b"": 1.0, b"EXA": 1e18, b"PETA": 1e15, b"TERA": 1e12, b"GIGA": 1e9, b"MEGA": 1e6, b"KILO": 1e3, b"HECTO": 1e2,
    b"DECA": 10.0, b"DECI": 0.1, b"CENTI": 1e-2, b"MILLI": 1e-3, b"MICRO": 1e-6, b"NANO": 1e-9, b"PICO": 1e-12,
    b"FEMTO": 1e-15, b"ATTO": 1e-18,
}  # fmt: skip
_METRE = re.compile(rb"SI_UNIT\s*\(\s*(?:\.(\w+)\.|\$)\s*,\s*\.METRE\.")
_RADIAN = re.compile(rb"SI_UNIT\s*\(\s*(?:\.(\w+)\.|\$)\s*,\s*\.RADIAN\.")
_CONVERSION = re.compile(rb"CONVERSION_BASED_UNIT\s*\(\s*'([^']*)'", re.IGNORECASE)
_ASSIGNED = re.compile(rb"GLOBAL_UNIT_ASSIGNED_CONTEXT\s*\(\s*\(([^)]*)\)")
_MECHANISM = re.compile(rb"=\s*MECHANISM_REPRESENTATION\s*\(\s*\$?\s*,\s*\([^)]*\)\s*,\s*#\s*(\d+)")
_DEGREES = (b"DEGREE", b"DEGREES")
_CONVERSIONS = {b"INCH": 0.0254, b"FOOT": 0.3048, b"YARD": 0.9144, b"MILE": 1609.344, b"MIL": 2.54e-5}


def references(text: bytes) -> list[int]:
    """The numbers of the instances that a piece of ``Part21.plain`` refers to, in order."""
    return [int(number) for number in _REFERENCE.findall(text)]


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
        return len(set(references(self.plain)) - self.instances.keys())

    @cached_property
    def _units(self) -> list[bytes]:
        """Each unit that a context assigns, those of a mechanism's context first (ISO 10303-41, global_unit_assigned_context):
        a file may define units that it does not use.  The whole file where no context assigns any."""
        contexts = [int(found[1]) for found in _MECHANISM.finditer(self.plain)]
        texts = [self.plain[slice(*self.instances[c])] for c in contexts if c in self.instances]
        assigned = [found[1] for text in (*texts, self.plain) for found in _ASSIGNED.finditer(text)]
        numbers = dict.fromkeys(number for units in assigned for number in references(units))
        return [self.text(number) for number in numbers if number in self.instances] or [self.data]

    def metres(self) -> float:
        """Metres in the file's unit of length; the first one where it has several, a millimetre where none is found."""
        for unit in self._units:
            for found in _CONVERSION.finditer(unit):
                if (name := found[1].strip().upper()) in _CONVERSIONS:
                    return _CONVERSIONS[name]
            if found := _METRE.search(unit):
                return METRES_OF_PREFIX.get((found[1] or b"").upper(), 1e-3)
        return 1e-3

    def radians(self) -> float:
        """Radians in the file's unit of angle; the first one where it has several."""
        for unit in self._units:
            if any(found[1].strip().upper() in _DEGREES for found in _CONVERSION.finditer(unit)):
                return math.pi / 180.0
            if _RADIAN.search(unit):
                return 1.0
        return 1.0

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
