"""SolidWorks' mates, every type, as records of a bundle in the frame of the assembly that owns them."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass

from ..channel import MemberFailed
from ..draft import Draft, Record, exchanged, frame, freedom, three
from .api import Component, Entity, Feature, Mate, MateData, MateEntity

TYPES = (
    "coincident", "concentric", "perpendicular", "parallel", "tangent", "distance", "angle", "unknown", "symmetric",
    "cam follower", "gear", "width", "lock to sketch", "rack-pinion", "max", "path", "lock", "screw", "linear coupler",
    "universal joint", "coordinate", "slot", "hinge", "slider", "profile centre", "magnetic",
)  # fmt: skip
"""swMateType_e."""
SHAPES = {0: "point", 1: "line", 2: "circle", 3: "plane", 4: "cylinder", 5: "sphere", 7: "cone"}
"""swMateEntity2ReferenceType_e."""
SENSES = {0: "aligned", 1: "opposed"}
ERRORS = {
    38: "an edge is gone", 39: "a face is gone", 40: "a surface is gone", 41: "an entity is invalid",
    42: "the tangency is not met", 43: "dangling", 44: "not linear", 45: "failed", 46: "over-defined",
    47: "ill-defined", 48: "broken",
}  # fmt: skip
UNIT = {
    0: 0.001, 1: 0.01, 2: 1.0, 3: 0.0254, 4: 0.3048, 5: 0.0254, 6: 1e-10, 7: 1e-9, 8: 1e-6, 9: 2.54e-5, 10: 2.54e-8,
}  # fmt: skip
"""swLengthUnit_e, metres; of feet and inches together the inch."""
PARALLEL = 1e-9
INSTANCE = re.compile(r"-\d+$")
"""How the name of every component ends; that of an assembly's own root does not."""


@dataclass(slots=True)
class Owner:
    """The assembly whose mates are read.  id: its component; frame: what a bundle calls its space.
    unit: metres of its document's unit of length.  itself: what its own planes and origin are on."""

    draft: Draft
    id: str
    frame: str
    unit: float
    itself: str = "ground"

    def component(self, found: Component | None, own: str) -> str:
        """Id of an entity's component; none, or the assembly itself, is the owner: its planes and origin."""
        name = "" if found is None else found.Name2
        known = f"{self.id}/{name}"
        itself = not name or name == own or (known not in self.draft.parts and not INSTANCE.search(name))
        return self.itself if itself else known

    def holder(self, entity: MateEntity) -> str:
        """Id of what a mate's entity is on.  One of a component inside may be said to be the assembly's own: its face knows better."""
        found = self.component(entity.ReferenceComponent, self.id)
        if found == self.itself:
            with suppress(MemberFailed, AttributeError):  # a plane of the assembly has no component
                face: Entity | None = entity.Reference
                component = None if face is None else face.GetComponent()
                if component is not None:
                    return self.component(component, self.id)
        return found


def read_mate(owner: Owner, feature: Feature) -> None:
    """Add the mate to the draft."""
    draft, name = owner.draft, feature.Name
    mate: Mate | None = feature.GetSpecificFeature2()
    if mate is None:
        return
    kind = TYPES[mate.Type] if 0 <= mate.Type < len(TYPES) else f"type {mate.Type}"
    own = draft.unique(name if owner.frame == "world" else f"{owner.id}/{name}")
    record: Record = {"id": own, "name": name, "kind": "other", "rawKind": kind}
    draft.owners[own] = owner.frame
    if any(feature.IsSuppressed2(1, None)):
        draft.constraints.append(record | {"suppressed": True})
        return
    error = feature.GetErrorCode()
    sides = [_side(owner, mate.MateEntity(i)) for i in range(mate.GetMateEntityCount())]
    for key, side in zip("ab", sides):
        record[key] = side
    joint: Record | None = None
    try:
        build = BUILDERS.get(kind)
        if build is None or len(sides) < 2:
            draft.report.approximated(f"mate {own}", "CAPTURE_KIND_RAW", kind=kind, program=draft.program)
        else:
            joint = build(Given(owner, mate, feature, sides), record)
    except MemberFailed as failure:
        draft.failed(f"mate {name}", failure)
        record = {k: record[k] for k in ("id", "name", "rawKind", "a", "b") if k in record} | {
            "kind": "other"
        }
    made = record if joint is None else joint
    if error in ERRORS:
        draft.report.add("CAPTURE_SICK", id=own, health=ERRORS[error], program=draft.program)
        made |= {"suppressed": True, "extras": {"health": ERRORS[error]}}
    (draft.constraints if joint is None else draft.joints).append(made)


@dataclass(slots=True)
class Given:
    """What a mate states."""

    owner: Owner
    mate: Mate
    feature: Feature
    sides: list[Record]

    @property
    def data(self) -> MateData:
        found: MateData | None = self.feature.GetDefinition()
        if found is None:
            raise MemberFailed("GetDefinition()", "there is none")
        return found

    @property
    def sense(self) -> Record:
        both = all("d" in side for side in self.sides[:2])
        word = SENSES.get(self.mate.Alignment)
        return {"sense": word} if both and word else {}


def _side(owner: Owner, entity: MateEntity) -> Record:
    numbers = [float(v) for v in entity.EntityParams]
    word = SHAPES.get(entity.ReferenceType, "body")
    side: Record = {"component": owner.holder(entity), "geometry": word}
    side |= {"in": owner.frame, "p": three(numbers[:3])}
    if word == "cone":  # its angle is not stated: its axis is what all mates but a tangency use
        side["geometry"] = "line"
    if word not in ("point", "sphere", "body"):
        side["d"] = three(numbers[3:6])
    if word in ("circle", "cylinder", "sphere"):
        side["r"] = numbers[6]
    return side


def _plain(kind: str) -> Callable[[Given, Record], None]:
    def build(given: Given, record: Record) -> None:
        record |= {"kind": kind, **given.sense}

    return build


def _concentric(given: Given, record: Record) -> None:
    record |= {"kind": "concentric", **given.sense}
    if given.data.LockRotation:
        record["lockRotation"] = True


def _tangent(given: Given, record: Record) -> None:
    record["kind"] = "tangent"
    for side in given.sides[:2]:
        if side["geometry"] == "line":
            raise MemberFailed("EntityParams", "a cone's angle is not stated")


def _distance(given: Given, record: Record) -> None:
    data = given.data
    record["kind"] = "distance"
    if all(side["geometry"] == "plane" for side in given.sides[:2]):
        record |= given.sense
    if data.IsAdvancedMate:
        record |= {
            "min": data.MinimumDistance,
            "max": data.MaximumDistance,
            "extras": {"nominal": data.Distance},
        }
    else:
        record["value"] = data.Distance


def _angle(given: Given, record: Record) -> None:
    data = given.data
    record["kind"] = "angle"
    if data.IsAdvancedMate:
        record |= {"min": data.MinimumAngle, "max": data.MaximumAngle, "extras": {"nominal": data.Angle}}
    else:
        record["value"] = data.Angle


def _symmetric(given: Given, record: Record) -> None:
    if len(given.sides) < 3:
        raise MemberFailed("MateEntity(2)", "the plane of symmetry is not among the entities")
    record |= {"kind": "symmetry", "c": given.sides[2]}


def _gear(given: Given, record: Record) -> None:
    """Wheels in mesh turn against each other, whichever way their axes were picked; ``Reverse`` makes them turn alike."""
    data = given.data
    value = data.GearRatioNumerator / data.GearRatioDenominator
    along = sum(p * q for p, q in zip(given.sides[0]["d"], given.sides[1]["d"]))
    against = (along >= 0.0) != bool(data.Reverse)
    record |= {"kind": "gear", "value": -value if against else value}


def _rack(given: Given, record: Record) -> None:
    """Of the bundle's rack the first side turns: the pinion, SolidWorks' second."""
    data = given.data
    radius = data.DiameterVal / (math.tau if data.DiameterType == 1 else 2.0)
    record |= {
        "kind": "rack",
        "a": given.sides[1],
        "b": given.sides[0],
        "value": -radius if data.Reverse else radius,
    }


def _screw(given: Given, record: Record) -> None:
    data = given.data
    lead = data.RevolutionVal if data.RevolutionType == 1 else given.owner.unit / data.RevolutionVal
    record |= {"kind": "screw", "value": -lead if data.Reverse else lead}


def _linear(given: Given, record: Record) -> None:
    data = given.data
    value = data.CouplerRatioNumerator / data.CouplerRatioDenominator
    record |= {"kind": "linear", "value": -value if data.Reverse else value}


def _universal(given: Given, record: Record) -> None:
    """SolidWorks states the shafts, a bundle the arms of the cross; where these stand now is chosen across the shafts."""
    a, b = given.sides[:2]
    arm = _cross(a["d"], b["d"])
    if sum(v * v for v in arm) < PARALLEL:
        raise MemberFailed("EntityParams", "the shafts are in line: the arms of the cross cannot be told")
    point = _nearest(a, b)
    other = _cross(b["d"], arm)
    for key, side, d in (("a", a, arm), ("b", b, other)):
        size = math.sqrt(sum(v * v for v in d))
        record[key] = {**side, "geometry": "line", "p": point, "d": [v / size for v in d]}
        record[key].pop("r", None)
    record["kind"] = "universal"


def _width(given: Given, record: Record) -> None:
    """A tab centred in a width: its two faces are each other's images in the plane between the width's faces."""
    if len(given.sides) < 4 or given.data.ConstraintType != 0:
        raise MemberFailed("ConstraintType", "a width that is not centred")
    one, two, *tab = given.sides
    middle = [(p + q) / 2.0 for p, q in zip(one["p"], two["p"])]
    record |= {"kind": "symmetry", "a": tab[0], "b": tab[1], "c": {**one, "p": middle}}


def _lock(given: Given, record: Record) -> None:
    record["kind"] = "lock"


def _hinge(given: Given, record: Record) -> Record | None:
    """Entities 0, 1 are concentric, 2, 3 coincident, 4, 5 the angle's: an insert, with limits a revolute joint."""
    if len(given.sides) < 4:
        raise MemberFailed("GetMateEntityCount()", "a hinge has four entities")
    axes, planes = given.sides[:2], given.sides[2:4]
    seats = [_on_plane(axis, plane) for axis, plane in zip(axes, planes)]
    data = given.data
    if data.AngleSelection and len(given.sides) >= 6:
        frames = [
            frame(given.owner.frame, seat, axes[0]["d"], side["d"])
            for seat, side in zip(seats, given.sides[4:6])
        ]
        joint: Record = {
            "id": record["id"],
            "name": record["name"],
            "type": "revolute",
            "a": axes[0]["component"],
            "b": axes[1]["component"],
            "frameA": frames[0],
            "frameB": frames[1],
            "dof": [freedom("rz", None, data.MinVal, data.MaxVal)],
        }
        return exchanged(joint) if joint["b"] == "ground" else joint
    for key, seat, axis in zip("ab", seats, axes):
        record[key] = {**axis, "geometry": "circle", "p": seat}
    record |= {"kind": "insert", **given.sense}
    return None


def _profile(given: Given, record: Record) -> None:
    data = given.data
    for key, side in zip("ab", given.sides):
        record[key] = {**side, "geometry": "circle"}
    record |= {"kind": "insert", "value": data.OffsetDistance, **given.sense}
    if data.LockRotation:
        record["lockRotation"] = True


BUILDERS: Mapping[str, Callable[[Given, Record], Record | None]] = {
    "coincident": _plain("coincident"),
    "concentric": _concentric,
    "perpendicular": _plain("perpendicular"),
    "parallel": _plain("parallel"),
    "tangent": _tangent,
    "distance": _distance,
    "angle": _angle,
    "symmetric": _symmetric,
    "gear": _gear,
    "width": _width,
    "rack-pinion": _rack,
    "lock": _lock,
    "screw": _screw,
    "linear coupler": _linear,
    "universal joint": _universal,
    "hinge": _hinge,
    "profile centre": _profile,
}


def _cross(p: list[float], q: list[float]) -> list[float]:
    return [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]


def _on_plane(axis: Record, plane: Record) -> list[float]:
    """Where an axis meets a plane; the axis' own point where it runs along the plane."""
    along = sum(p * q for p, q in zip(axis["d"], plane["d"]))
    if abs(along) < PARALLEL:
        return list(axis["p"])
    step = sum((q - p) * n for p, q, n in zip(axis["p"], plane["p"], plane["d"])) / along
    return [p + step * d for p, d in zip(axis["p"], axis["d"])]


def _nearest(a: Record, b: Record) -> list[float]:
    """The middle of the shortest line between two axes."""
    u, v = a["d"], b["d"]
    w = [p - q for p, q in zip(a["p"], b["p"])]
    uv, uw, vw = (sum(p * q for p, q in zip(*pair)) for pair in ((u, v), (u, w), (v, w)))
    s, t = (uv * vw - uw) / (1.0 - uv * uv), (vw - uv * uw) / (1.0 - uv * uv)
    return [(p + s * d + q + t * e) / 2.0 for p, d, q, e in zip(a["p"], u, b["p"], v)]
