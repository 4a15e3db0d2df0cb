"""Numbers that no machine has: what looks like a wrong unit is told, once for each kind, with the unit it is likely in."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from ..diagnostics import Report
from ..model import Freedom, Motion, Node, Scene
from ..spatial import Array, Pose, bounds

LARGE = 100.0
"""Metres: no part is that large, but one whose millimetres were taken for metres is."""
TINY = 1e-4
"""Metres: no whole assembly is that small, but one whose metres were taken for millimetres, twice, is."""
APART = 100.0
"""Sizes of a part: nothing that belongs to a part is that far outside of it, unless the two are in different units."""
AIR = 1.0
"""kg for each cubic metre of a bounding box: a machine that floats in no air has more, one of so many millimetres too many less."""
LIGHT, HEAVY = 12.0, 25_000.0
"""kg/m^3: foams are denser than the one, which is above lead in g/cm^3, and osmium is lighter than the other."""
SPREAD = 4.0
"""Times that a moment of inertia may exceed mass times greatest distance squared: a part may lack a mesh of its load."""
TURNS = 4.0 * math.pi
"""Radians: two turns; whole numbers beyond are degrees."""
STEP = math.pi / 12.0
"""Radians: 15 degrees, of which people's limits are multiples."""
NEAR = 2e-3
"""What pi is rounded to on the way, radians."""
UNIT_OF_PARTS = 0.01
"""Metres: what is drawn in this unit or a smaller one was not drawn in millimetres and taken for metres."""
UNITS = {1.0: "metres", 0.3048: "feet", 0.0254: "inches", 0.01: "centimetres", 0.001: "millimetres"}
"""Lengths that sources are drawn in, by their metres."""

CORNERS = np.array(np.meshgrid(*3 * [[False, True]])).reshape(3, -1).T
"""Which end of a box each of its eight corners takes, by axis."""

Box = tuple[Array, Array]
"""Lowest and highest corner of a node's geometry in its own frame."""


def check_plausible(scene: Scene, read: Scene, density: float, report: Report) -> None:
    """Tell what is likely in another unit than it says.

    read: the scene before it was weighed, with the masses that the source states.  density: kg/m^3 of bodies that state none.
    """
    boxes = _boxes(scene)
    stated = {i: weight for i, node in enumerate(read.nodes) if (weight := _stated(node)) is not None}
    _check_sizes(scene, boxes, stated, report)
    _check_masses(scene, boxes, report)
    _check_densities(scene, density, report)
    _check_anchors(scene, boxes, report)
    _check_limits(scene, report)
    mirrored = sum(d.code == "POSE_MIRRORED" for d in report.diagnostics)
    if mirrored > 1 and mirrored >= len(scene.nodes):
        report.add("SOURCE_LIKELY_LEFT_HANDED", scene.source.uri, count=mirrored)


def _stated(node: Node) -> float | None:
    return node.kilograms if node.mass is None else node.mass.mass


def _boxes(scene: Scene) -> dict[int, Box]:
    """Of each node with geometry, by its number."""
    drawn = [(i, b, b.mesh) for i, node in enumerate(scene.nodes) for b in node.bodies if b.mesh is not None]
    if not drawn:
        return {}
    used = {mesh: number for number, mesh in enumerate({mesh for _, _, mesh in drawn})}
    ends = np.array([bounds(scene.meshes[m].vertices) for m in used])
    ends = ends[[used[mesh] for _, _, mesh in drawn]] * np.array([b.scale for _, b, _ in drawn])[:, None]
    eight = np.where(CORNERS, ends[:, 1:], ends[:, :1])
    rotations = np.array([b.pose.rotation for _, b, _ in drawn])
    eight = (
        eight @ rotations.transpose(0, 2, 1) + np.array([b.pose.translation for _, b, _ in drawn])[:, None]
    )
    boxes: dict[int, Box] = {}
    for (i, _, _), low, high in zip(drawn, eight.min(axis=1), eight.max(axis=1)):
        before = boxes.get(i)
        boxes[i] = (
            (low, high) if before is None else (np.minimum(low, before[0]), np.maximum(high, before[1]))
        )
    return boxes


def _outside(box: Box, point: Array) -> float:
    """How far a point is from a box; 0 inside."""
    return _norm(np.maximum(np.maximum(box[0] - point, point - box[1]), 0.0))


def _size(box: Box) -> float:
    return _norm(box[1] - box[0])


def _check_sizes(scene: Scene, boxes: dict[int, Box], stated: dict[int, float], report: Report) -> None:
    """stated: kilograms that the source gives, of some nodes: a large part that weighs as much as one so large is believed."""
    if not boxes:
        return
    extents = np.array([high - low for low, high in boxes.values()])
    longest: list[float] = extents.max(axis=1).tolist()
    large = [
        (size, i)
        for size, i in zip(longest, boxes)
        if size > LARGE and not (i in stated and stated[i] > AIR * _volume(boxes[i]))
    ]
    unit = scene.source.meters_per_unit
    if large:
        size, worst = max(large, key=lambda found: found[0])
        if unit <= UNIT_OF_PARTS:  # the source's own unit is as small: only its meshes may be in another
            if size <= APART * _spread(scene):
                return
            unit = 1.0
        node = scene.nodes[worst]
        weight = "" if node.mass is None else f" and weighs {node.mass.mass:.3g} kg"
        meant = _meant(stated.get(worst, 0.0), _volume(boxes[worst]) / unit**3)
        report.add(
            "SIZE_IMPLAUSIBLE", node.where, node=node.id, size=f"{size:.4g}", weight=weight,
            likely=f"{size / unit * meant:.4g}", count=len(large), unit=UNITS[meant],
            taken=UNITS.get(unit, f"units of {unit:g} m"),
        )  # fmt: skip
        return
    if max(longest) < TINY and 0.0 < (whole := max(map(_size, boxes.values()))) < TINY:
        worst = max(boxes, key=lambda i: _size(boxes[i]))
        report.add(
            "SIZE_IMPLAUSIBLE", scene.nodes[worst].where, node=scene.nodes[worst].id, size=f"{whole:.4g}", weight="",
            likely=f"{whole * 1000.0:.4g}", count=len(boxes), unit="metres", taken="millimetres",
        )  # fmt: skip


def _volume(box: Box) -> float:
    """Cubic metres of a box, of a flat one as if it were a thousandth of its size thick."""
    return float(np.maximum(box[1] - box[0], 1e-3 * _size(box)).prod())


def _spread(scene: Scene) -> float:
    """Metres from one end to the other of where the parts stand."""
    places = np.array([node.pose.translation for node in scene.nodes])
    return _norm(places.max(axis=0) - places.min(axis=0))


def _meant(kilograms: float, volume: float) -> float:
    """The metres of the unit that a part of ``volume`` cubic units was likely drawn in: millimetres, unless it would be too heavy."""
    return next((unit for unit in (0.001, 0.01, 0.0254) if kilograms <= HEAVY * volume * unit**3), 0.001)


def _check_masses(scene: Scene, boxes: dict[int, Box], report: Report) -> None:
    """Of masses, whoever stated them: that they lie in their part, and are spread no wider than it."""
    weighed = [
        (node, node.mass, box) for i, box in boxes.items() if (node := scene.nodes[i]).mass is not None
    ]
    if not weighed:
        return
    low, high = (np.array([box[end] for _, _, box in weighed]) for end in (0, 1))
    masses = np.array([mass.mass for _, mass, _ in weighed])
    centers = np.array([mass.center for _, mass, _ in weighed])
    moments = np.linalg.eigvalsh(np.array([mass.inertia for _, mass, _ in weighed]))[:, 2]
    sizes = np.linalg.norm(high - low, axis=1)
    far = np.linalg.norm(np.maximum(np.maximum(low - centers, centers - high), 0.0), axis=1)
    reach = np.linalg.norm(np.maximum(abs(low - centers), abs(high - centers)), axis=1)
    with np.errstate(all="ignore"):  # parts without size, masses at the ends of what floats hold
        away = far / sizes
        wide = moments / (masses * reach * reach)
        dense = masses / np.maximum(high - low, 1e-3 * sizes[:, None]).prod(axis=1)
    sized = sizes > 0.0
    within = sized & (far <= sizes)
    for code, ratios, odd in (
        ("CENTER_OF_MASS_IMPLAUSIBLE", away, sized & (far > sizes)),
        ("INERTIA_IMPLAUSIBLE", wide, within & (wide > SPREAD) & ~(dense > HEAVY)),
        ("MASS_IMPLAUSIBLE", dense, within & (dense > HEAVY)),
    ):
        found = [(float(ratios[i]), weighed[i][0]) for i in np.flatnonzero(odd).tolist()]
        if found:
            ratio, node = max(found, key=lambda entry: entry[0])
            report.add(
                code,
                node.where,
                node=node.id,
                ratio=f"{ratio:.3g}",
                count=len(found),
                unit=_likely(code, ratio),
            )


def _likely(code: str, ratio: float) -> str:
    """The unit of a number that is ``ratio`` times too large, of a mass in words."""
    if code == "INERTIA_IMPLAUSIBLE":
        return "g mm^2" if ratio > 1e8 else "kg mm^2" if ratio > 1e4 else "g m^2 or kg cm^2"
    if code == "MASS_IMPLAUSIBLE":
        return (
            "its mesh is likely in metres that were taken for millimetres"
            if ratio > 1e8
            else "its mass is likely in grams"
        )
    return "millimetres"


def _check_densities(scene: Scene, density: float, report: Report) -> None:
    stated = [
        (body.density, f"{node.id}/{body.name}", node.where)
        for node in scene.nodes
        for body in node.bodies
        if body.density is not None
    ]
    asked = [(density, "those that state none", "")] if any(_unstated(scene)) else []
    odd = [entry for entry in [*stated, *asked] if not LIGHT <= entry[0] <= HEAVY]
    if odd:
        value, body, where = odd[0]
        units = (
            (LIGHT, 1e3, "g/cm^3"), (HEAVY, 1.0, ""), (HEAVY * 1e3, 1e-3, "g/m^3"),
        ) if value > 0.5 else ((1e-7, 1e12, "t/mm^3"), (1e-3, 1e9, "kg/mm^3"), (0.5, 1e6, "g/mm^3"))  # fmt: skip
        factor, unit = next(((f, u) for end, f, u in units if value <= end), (1e-6, "mg/m^3"))
        report.add(
            "DENSITY_IMPLAUSIBLE", where, body=body, density=f"{value:g}", count=len(odd), unit=unit,
            likely=f"{value * factor:g}",
        )  # fmt: skip


def _unstated(scene: Scene) -> Iterable[bool]:
    return (
        body.density is None and body.mesh is not None and body.weighed
        for node in scene.nodes
        for body in node.bodies
    )


def _check_anchors(scene: Scene, boxes: dict[int, Box], report: Report) -> None:
    """Joints that stand far outside of a part that they join."""
    found: list[tuple[float, str, str, str, float]] = []
    for joint in scene.joints:
        for side, frame in ((joint.a, joint.frame_a), (joint.b, joint.frame_b)):
            if side is None or side not in boxes or not (size := _size(boxes[side])) > 0.0:
                continue
            far = _outside(boxes[side], frame.translation)
            if far > APART * size and (far := _beside(boxes[side], frame, joint.freedoms)) > APART * size:
                found.append((far / size, joint.id, joint.where, scene.nodes[side].id, far))
    if found:
        _, joint, where, node, far = max(found)
        count = len({entry[1] for entry in found})
        report.add("ANCHOR_IMPLAUSIBLE", where, joint=joint, node=node, metres=f"{far:.4g}", count=count)


def _beside(box: Box, frame: Pose, freedoms: tuple[Freedom, ...]) -> float:
    """How far a box is from where a joint may as well stand: anywhere along its only axis of turning, and along its slides."""
    free = [freedom.motion is not Motion.LOCKED for freedom in freedoms]
    told = [not slides and not (turns and sum(free[3:]) == 1) for slides, turns in zip(free[:3], free[3:])]
    ends = (np.where(CORNERS, box[1], box[0]) - frame.translation) @ frame.rotation[:, told]
    low, high = ends.min(axis=0), ends.max(axis=0)
    return _norm(np.maximum(np.maximum(low, -high), 0.0))


def _check_limits(scene: Scene, report: Report) -> None:
    degrees: list[tuple[str, str, Freedom]] = []
    radians: list[tuple[str, str, Freedom]] = []
    for joint in scene.joints:
        for freedom in joint.freedoms[3:]:
            if freedom.motion is not Motion.LIMITED:
                continue
            ends = [e for e in freedom.displayed(freedom.lower, freedom.upper) if math.isfinite(e)]
            if not ends:
                continue
            where = freedom.where or joint.where
            if max(map(abs, ends)) > TURNS and all(abs(e - round(e)) < 1e-6 for e in ends):
                degrees.append((joint.id, where, freedom))
            elif _read_as_degrees([math.degrees(e) for e in ends]):
                radians.append((joint.id, where, freedom))
    for found, unit, taken in ((degrees, "degrees", "radians"), (radians, "radians", "degrees")):
        if found:
            joint, where, freedom = found[0]
            low, high = map(math.degrees, freedom.displayed_range(freedom.lower, freedom.upper))
            report.add(
                "LIMITS_IMPLAUSIBLE", where, joint=joint, lower=f"{low:.6g}", upper=f"{high:.6g}", count=len(found),
                unit=unit, taken=taken,
            )  # fmt: skip


def _read_as_degrees(ends: list[float]) -> bool:
    """Whether ends, in degrees, are what people write in radians: within a turn, and multiples of pi / 12.

    With two decimals, as 2.88, only quarters of a turn: one number in seventy is that near to a multiple.
    """
    if max(map(abs, ends)) > 2.0 * math.pi + NEAR or max(map(abs, ends)) < 2.0 * STEP - NEAR:
        return False
    steps = [STEP * (6 if abs(100.0 * e - round(100.0 * e)) < 1e-6 else 1) for e in ends]
    return all(abs(e - step * round(e / step)) < NEAR for e, step in zip(ends, steps))


def _norm(vector: Array) -> float:
    return float(np.sqrt(vector @ vector))
