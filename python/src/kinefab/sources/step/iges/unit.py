"""The length unit that an IGES file states, in its global section."""

from __future__ import annotations

METRES = {
    1: 0.0254,
    2: 1e-3,
    4: 0.3048,
    5: 1609.344,
    6: 1.0,
    7: 1000.0,
    8: 2.54e-5,
    9: 1e-6,
    10: 1e-2,
    11: 2.54e-8,
}
"""Of IGES 5.3's unit flags, parameter 14; 3 has its name in parameter 15."""
NAMED = {
    "IN": 1,
    "INCH": 1,
    "MM": 2,
    "FT": 4,
    "MI": 5,
    "M": 6,
    "KM": 7,
    "MIL": 8,
    "UM": 9,
    "CM": 10,
    "UIN": 11,
}
FLAG = 13
"""Parameters before the flag."""
INCH = 1


def metres_of(data: bytes) -> float:
    """Metres in the unit of an IGES file; those of an inch, the standard's default, where it states none."""
    lines = data.decode("latin-1").splitlines()
    text = "".join(line[:72].ljust(72) for line in lines if line[72:73] == "G")
    values = _parameters(text)
    flag = values[FLAG].strip() if len(values) > FLAG else ""
    number = int(flag) if flag.isdecimal() else INCH
    if number == 3:
        name = values[FLAG + 1] if len(values) > FLAG + 1 else ""
        number = NAMED.get(name.strip().upper(), INCH)
    return METRES.get(number, METRES[INCH])


def _parameters(text: str) -> list[str]:
    """The parameters of a global section; texts are counted (``3Habc``), and the first two say what parts and ends."""
    parts, ends = ",", ";"
    found: list[str] = []
    place = 0
    while place < len(text) and len(found) <= FLAG + 1:
        while place < len(text) and text[place] == " ":
            place += 1
        digits = place
        while digits < len(text) and text[digits].isdecimal():
            digits += 1
        if digits > place and text[digits : digits + 1] == "H":
            first, last = digits + 1, digits + 1 + int(text[place : min(digits, place + 6)])
            found.append(text[first:last])
        else:
            first = last = place
            while last < len(text) and text[last] not in (parts, ends):
                last += 1
            found.append(text[first:last])
        if len(found) == 1 and found[0].strip():
            parts = found[0].strip()[0]
        elif len(found) == 2 and found[1].strip():
            ends = found[1].strip()[0]
        while last < len(text) and text[last] not in (parts, ends):
            last += 1
        if text[last : last + 1] == ends:
            break
        place = last + 1
    return found
