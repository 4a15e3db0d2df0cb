"""Findings about the data: a code from the shared table, a severity, a place and a remedy.

The table is ``schemas/diagnostics.json``; C# embeds the same file.  Wrong *data* gives a Diagnostic,
a wrong *call* (a programmer's mistake) gives an ordinary exception.
"""

from __future__ import annotations

import json
import unicodedata
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from functools import lru_cache
from pathlib import Path


class Severity(str, Enum):
    """How bad a finding is: an ERROR keeps the target from being written, a WARNING of a loss where ``strict`` asks for it.

    >>> import kinefab
    >>> kinefab.Severity("warning") is kinefab.Severity.WARNING
    True
    """

    ERROR = "error"
    WARNING = "warning"
    INFO = "info"


class Outcome(str, Enum):
    """What became of a feature of the source.

    >>> import kinefab
    >>> [outcome.value for outcome in kinefab.Outcome]
    ['kept', 'approximated', 'dropped']
    """

    KEPT = "kept"
    APPROXIMATED = "approximated"
    DROPPED = "dropped"


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One finding.

    code: a key of the table.  severity: the table's, unless the caller re-graded it.
    message, remedy: the table's templates, filled in.
    where: where in the source: a file, with a JSON pointer (``lever.bundle.json#/joints/3``), a line
        (``lever.csv:12``) or an id; empty when there is no narrower place than the call itself.

    >>> import kinefab
    >>> try:
    ...     result = kinefab.export("gone.urdf", "gone.kinefab")
    ... except kinefab.KinefabError as error:
    ...     found = error.diagnostics[0]
    >>> found.code, found.severity.value, found.message
    ('SOURCE_NOT_FOUND', 'error', 'There is no file gone.urdf.')
    """

    code: str
    severity: Severity
    message: str
    remedy: str
    where: str = ""

    def __str__(self) -> str:
        place = f"{self.where}: " if self.where else ""
        return f"{place}{self.severity.value} {self.code}: {self.message} {self.remedy}".rstrip()


@dataclass(frozen=True, slots=True)
class FeatureOutcome:
    """One line of the loss report: a feature of the source and what became of it.

    feature: kind and id in the source (``joint Hinge:1``).  code: empty when kept without remark.

    >>> import kinefab
    >>> outcome = kinefab.FeatureOutcome("joint Hinge", kinefab.Outcome.KEPT)
    >>> outcome.feature, outcome.outcome.value, outcome.code
    ('joint Hinge', 'kept', '')
    """

    feature: str
    outcome: Outcome
    code: str = ""
    severity: Severity = Severity.INFO
    message: str = ""
    where: str = ""


def is_encodable(text: str) -> bool:
    """Whether a string can be written as UTF-8: JSON's escapes can hold half of a surrogate pair, and Python has such halves
    for the bytes of a file's name that are no UTF-8."""
    return text.isascii() or not any("\ud800" <= character <= "\udfff" for character in text)


def readable(text: str) -> bool:
    """Whether people can be shown the text as it is: spaces of every script and joiners (U+200C, U+200D), but nothing that
    controls or turns round the line."""
    return all(c.isprintable() or unicodedata.category(c) == "Zs" or c in "\u200c\u200d" for c in text)


def printable(text: str) -> str:
    """The text as one line that cannot steer a terminal: an id may hold control characters."""
    return text if text.isprintable() else "".join(c if c.isprintable() else ascii(c)[1:-1] for c in text)


MOST_NAMES = 12
"""Names that a message lists."""


def named(names: Iterable[str], most: int = MOST_NAMES) -> str:
    """The names in a row for a message: the first ``most``, and how many more there are."""
    given = list(names)
    more = len(given) - most
    return ", ".join(given[:most]) + (f" and {more} more" if more > 0 else "")


def chained(names: Sequence[str], link: str) -> str:
    """The names as a way from one to the next, ``link`` between them: of a long one its two ends."""
    if len(names) > MOST_NAMES:
        half = MOST_NAMES // 2
        names = [*names[:half], f"({len(names) - 2 * half} more)", *names[-half:]]
    return link.join(names)


MOST_ALIKE = 100
"""Findings of one code that a text lists."""


def listed(found: Iterable[Diagnostic], most_warnings: int = MOST_ALIKE, remedy: str = "") -> list[Diagnostic]:
    """The findings as people read them: of one code the first ``MOST_ALIKE``, and at the end how many more there are.

    most_warnings: instead, of those that are no errors.  remedy: where these can all be had; without it the table's.
    """
    shown: list[Diagnostic] = []
    counts: dict[tuple[str, Severity], int] = {}
    for entry in found:
        alike = entry.code, entry.severity
        counts[alike] = counts.get(alike, 0) + 1
        if counts[alike] <= (MOST_ALIKE if entry.severity is Severity.ERROR else most_warnings):
            shown.append(entry)
    for (code, severity), count in counts.items():
        most = MOST_ALIKE if severity is Severity.ERROR else most_warnings
        if count > most:
            left = replace(diagnostic("FINDINGS_OMITTED", code, count=count - most), severity=severity)
            shown.append(left if severity is Severity.ERROR or not remedy else replace(left, remedy=remedy))
    return shown


class KinefabError(Exception):
    """The data cannot be carried on; holds the diagnostics that say why, and everything found until then.

    Its text lists the first findings of each code (``listed``).

    >>> import kinefab
    >>> try:
    ...     result = kinefab.export("gone.urdf", "gone.kinefab")
    ... except kinefab.KinefabError as error:
    ...     print(error.diagnostics[0].remedy)
    Check the path.
    """

    def __init__(self, diagnostics: Iterable[Diagnostic], report: Report | None = None):
        self.diagnostics = tuple(diagnostics)
        self.report = report
        super().__init__("\n".join(map(str, listed(self.diagnostics))))

    def __reduce__(self) -> tuple[type[KinefabError], tuple[tuple[Diagnostic, ...], Report | None]]:
        """By what it was made of: a process pool hands its tasks' exceptions over pickled, and an exception's own way takes
        the text for the diagnostics."""
        return type(self), (self.diagnostics, self.report)


def schema_directory() -> Path:
    """Where the schemas are: beside the package when installed, at the root in a checkout."""
    packaged = Path(__file__).parent / "schemas"
    return packaged if packaged.is_dir() else Path(__file__).parents[3] / "schemas"


@lru_cache(maxsize=1)
def diagnostic_table() -> Mapping[str, Mapping[str, str]]:
    """The shared table: code to {stage, severity, message, remedy}."""
    text = (schema_directory() / "diagnostics.json").read_text(encoding="utf-8")
    return json.loads(text)["codes"]


def diagnostic(code: str, where: str = "", **values: object) -> Diagnostic:
    """Make a diagnostic from the table.

    code: a key of the table; KeyError for any other (that is a programmer's mistake).
    values: what the message's and the remedy's ``{placeholders}`` stand for.
    """
    entry = diagnostic_table()[code]
    return Diagnostic(
        code,
        Severity(entry["severity"]),
        entry["message"].format_map(values),
        entry["remedy"].format_map(values),
        where,
    )


@dataclass(slots=True)
class Report:
    """What a run found (``diagnostics``) and what became of each feature (``outcomes``), in order.

    >>> import kinefab
    >>> report = kinefab.Report()
    >>> report.kept("joint Hinge")
    >>> len(report.of(kinefab.Severity.ERROR)), [outcome.feature for outcome in report.outcomes]
    (0, ['joint Hinge'])
    """

    diagnostics: list[Diagnostic] = field(default_factory=list[Diagnostic])
    outcomes: list[FeatureOutcome] = field(default_factory=list[FeatureOutcome])

    def __repr__(self) -> str:
        """In one line: both lists may hold thousands."""
        found = (f"{len(self.of(severity))} {severity.value}" for severity in Severity)
        became = [outcome.outcome for outcome in self.outcomes]
        return f"<Report: {', '.join([*found, *(f'{became.count(word)} {word.value}' for word in Outcome)])}>"

    def add(self, code: str, where: str = "", **values: object) -> Diagnostic:
        """Note a finding and return it; the arguments as ``diagnostic`` has them.

        >>> kinefab.Report().add("SOURCE_NOT_FOUND", "arm.urdf", path="arm.urdf").severity.value
        'error'
        """
        found = diagnostic(code, where, **values)
        self.diagnostics.append(found)
        return found

    def kept(self, feature: str, where: str = "", code: str = "", **values: object) -> None:
        """Note that a feature is in the scene as the source has it.

        feature: kind and id (``joint Hinge:1``).  code: of a remark, where the one who looks at the scene may wonder.

        >>> report = kinefab.Report()
        >>> report.kept("joint Hinge:1")
        >>> report.outcomes[0].outcome.value
        'kept'
        """
        if code:
            self._told([feature], Outcome.KEPT, code, where, {"feature": feature, **values})
        else:
            self.outcomes.append(FeatureOutcome(feature, Outcome.KEPT, where=where))

    def noted(self, feature: str, code: str, where: str = "", **values: object) -> None:
        """Note that a feature is in the scene as the source has it, with a remark for whoever looks at that feature: no finding.

        >>> report = kinefab.Report()
        >>> report.noted("collider Box", "COLLIDER_RECOGNISED", body="Box", shape="BoxCollider")
        >>> len(report.outcomes), len(report.diagnostics)
        (1, 0)
        """
        beside = Report()
        beside.kept(feature, where, code, **values)
        self.outcomes += beside.outcomes

    def approximated(self, feature: str, code: str, where: str = "", **values: object) -> None:
        """Note that a feature is in the scene nearly as the source has it, and the finding that says how nearly.

        >>> report = kinefab.Report()
        >>> report.approximated("joint Wrist", "JOINT_ZERO_SHIFTED", joint="Wrist")
        >>> report.outcomes[0].outcome.value
        'approximated'
        """
        self._told([feature], Outcome.APPROXIMATED, code, where, {"feature": feature, **values})

    def approximated_alike(self, features: Iterable[str], code: str, **values: object) -> None:
        """Note features that are in the scene only nearly for one reason, and one finding for all of them.

        >>> report = kinefab.Report()
        >>> report.approximated_alike(["collider Ring"], "COLLIDERS_NOT_CUT", count=1, bodies="Ring")
        >>> len(report.outcomes), len(report.diagnostics)
        (1, 1)
        """
        self._told(features, Outcome.APPROXIMATED, code, "", values)

    def dropped_alike(self, features: Iterable[str], code: str, **values: object) -> None:
        """Note features that are not in the scene for one reason, and one finding for all of them.

        >>> report = kinefab.Report()
        >>> told = {"count": 2, "files": "E_A.glb, E_B.glb", "program": "Onshape"}
        >>> report.dropped_alike(["mesh of A", "mesh of B"], "CAPTURE_MESHES_NOT_SAVED", **told)
        >>> len(report.outcomes), len(report.diagnostics)
        (2, 1)
        """
        self._told(features, Outcome.DROPPED, code, "", values)

    def dropped(self, feature: str, code: str, where: str = "", **values: object) -> None:
        """Note that a feature is not in the scene, and the finding that says why.

        >>> report = kinefab.Report()
        >>> report.dropped("spring Return", "JOINT_REST_DROPPED")
        >>> report.outcomes[0].outcome.value
        'dropped'
        """
        self._told([feature], Outcome.DROPPED, code, where, {"feature": feature, **values})

    def field_dropped(self, owner: str, field: str, target: str, where: str = "") -> None:
        """Note that a target has no place for one field of what it holds: a feature of its own, beside the owner's.

        >>> report = kinefab.Report()
        >>> report.field_dropped("joint Hinge", "friction", ".glb")
        >>> report.outcomes[0].feature
        'friction of joint Hinge'
        """
        values = {"feature": owner, "field": field, "target": target}
        self._told([f"{field} of {owner}"], Outcome.DROPPED, "TARGET_FIELD_DROPPED", where, values)

    def _told(
        self, features: Iterable[str], outcome: Outcome, code: str, where: str, values: Mapping[str, object]
    ) -> None:
        """One finding, and what became of each feature that it is about."""
        found = self.add(code, where, **values)
        became = outcome, code, found.severity, found.message, where
        self.outcomes += [FeatureOutcome(feature, *became) for feature in features]

    def forgive(self, since: int, feature: str, code: str) -> bool:
        """Turn the errors after the first ``since`` findings into the loss of a feature, each with its place and its
        message as ``detail``; whether there were any.

        >>> report = kinefab.Report()
        >>> _ = report.add("SOURCE_NOT_FOUND", path="bolt.stl")
        >>> report.forgive(0, "mesh of Bolt", "SHAPE_UNREADABLE"), len(report.of(kinefab.Severity.ERROR))
        (True, 0)
        """
        later = self.diagnostics[since:]
        errors = [d for d in later if d.severity is Severity.ERROR]
        if errors:
            self.diagnostics[since:] = [d for d in later if d.severity is not Severity.ERROR]
        for error in errors:
            self.dropped(feature, code, error.where, detail=error.message)
        return bool(errors)

    def withdraw(self, feature: str, code: str) -> None:
        """Take back what was told of a feature under a code: whoever came later could keep it after all.

        >>> report = kinefab.Report()
        >>> report.dropped("spring Return", "JOINT_REST_DROPPED")
        >>> report.withdraw("spring Return", "JOINT_REST_DROPPED")
        >>> report.outcomes, report.diagnostics
        ([], [])
        """
        told = {o.message for o in self.outcomes if (o.feature, o.code) == (feature, code)}
        self.outcomes = [o for o in self.outcomes if (o.feature, o.code) != (feature, code)]
        self.diagnostics = [d for d in self.diagnostics if d.code != code or d.message not in told]

    def settle(self) -> None:
        """Leave out that a feature was kept, where nothing else is said of that and a loss of it was told as well: one stage
        lost what another one kept.

        >>> report = kinefab.Report()
        >>> report.kept("spring Return")
        >>> report.dropped("spring Return", "JOINT_REST_DROPPED")
        >>> report.settle()
        >>> [outcome.outcome.value for outcome in report.outcomes]
        ['dropped']
        """
        lost = {o.feature for o in self.outcomes if o.outcome is not Outcome.KEPT}
        self.outcomes = [
            o for o in self.outcomes if o.outcome is not Outcome.KEPT or o.code or o.feature not in lost
        ]

    def extend(self, other: Report) -> None:
        """Append what another run found.

        >>> report, other = kinefab.Report(), kinefab.Report()
        >>> other.kept("joint Hinge:1")
        >>> report.extend(other)
        >>> len(report.outcomes)
        1
        """
        self.diagnostics.extend(other.diagnostics)
        self.outcomes.extend(other.outcomes)

    def of(self, severity: Severity) -> list[Diagnostic]:
        """The findings of one severity, in order.

        >>> kinefab.Report().of(kinefab.Severity.WARNING)
        []
        """
        return [d for d in self.diagnostics if d.severity is severity]

    def raise_for_errors(self, since: int = 0) -> None:
        """Raise KinefabError with every error found so far, if there is any (after the first ``since`` findings).

        >>> kinefab.Report().raise_for_errors()
        """
        if any(d.severity is Severity.ERROR for d in self.diagnostics[since:]):
            raise KinefabError(self.of(Severity.ERROR))
