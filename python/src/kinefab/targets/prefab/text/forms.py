"""Documents of which a prefab has thousands: their text is made once, with blanks where two of them differ."""

from __future__ import annotations

from .yaml import Fields, Plain, document

BLANK = Plain("%s")
"""A value that each document has of its own."""


class Form:
    """The text of a class's documents in one dialect."""

    __slots__ = ("_text",)

    def __init__(self, class_id: int, kind: str, fields: Fields):
        """class_id, kind: Unity's number and name of the class.  fields: with ``BLANK`` where they differ."""
        self._text = document(class_id, kind, BLANK, fields)

    def filled(self, *values: str | int) -> str:
        """A document.  values: its fileID, then those of the blanks in the fields' order, as they are written; bools are numbers."""
        return self._text % values
