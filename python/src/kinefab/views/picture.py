"""A scene as a picture: flat-shaded triangles, and over them the joints with their ranges, as one SVG.

Works on the written document (Unity's left-handed frame), so that what is drawn is what was exported.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

import numpy as np

from ..diagnostics import printable
from ..spatial import Array, Pose, frame_from_axes, rotation_about
from ..unity.back.terms import terms_of
from .bars import Bar, bars
from .camera import View, looking
from .freedoms import (
    WORLD,
    Placement,
    angle_range,
    counted,
    freedoms_of_component,
    joint_name,
    link_above,
    world_placements,
    world_points,
)
from .links import joint_of_link
from .raster.fragments import nearest_last
from .raster.image import Canvas
from .raster.solid import solid
from .seen import shapes

WIDTH, HEIGHT, LEGEND = 760, 560, 400
MAX_TRIANGLES = 40_000
"""A picture with more triangles than this draws each body as the box around it."""
LISTED = 18
"""Joints that the legend has room for; a number on any other would lead nowhere."""

COLOURS = {"HingeJoint": "#d9480f", "ConfigurableJoint": "#1864ab", "FixedJoint": "#495057"}


def draw(document: Mapping[str, Any], buffers: Sequence[bytes], title: str = "scene") -> str:
    """The SVG text of a scene.

    document: a parsed ``.kinefab``.  buffers: the bytes of its buffers, in order.  title: of one that names no source.
    """
    placements = world_placements(document["gameObjects"])
    triangles, colours = _triangles(document, buffers, placements)
    joints = drawn_joints(document["gameObjects"], placements)
    points = [triangles.reshape(-1, 3)] + [joint.pose.translation[None] for joint in joints]
    cloud = np.concatenate(points) if points else np.zeros((1, 3))
    view = looking(cloud if len(cloud) else np.zeros((1, 3)), hinge_axes(joints), WIDTH, HEIGHT, 60)
    size = (WIDTH - 60) / view.scale
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH + LEGEND} {HEIGHT}" '
        f'font-family="system-ui, sans-serif" font-size="13">',
        f'<rect width="{WIDTH + LEGEND}" height="{HEIGHT}" fill="#ffffff"/>',
        _surfaces(triangles, colours, view),
        _edges(triangles, view),
        *(_bar(bar, placements, view) for bar in bars(document["gameObjects"])),
        *(_tie(ends, view) for ends in tied(document, placements)),
        *(_glyph(joint, view, size) for joint in joints),
        *_badges(joints[:LISTED], view),
        _legend(document, joints, title),
        "</svg>",
    ]
    return "\n".join(part for part in parts if part) + "\n"


@dataclass(frozen=True, slots=True, eq=False)
class DrawnJoint:
    """A joint component in the world; pose's X is its axis; connected_anchor is None where not given; freedoms in words.

    name: the user's, or its object's.
    """

    name: str
    kind: str
    pose: Pose
    component: Mapping[str, Any]
    connected: str
    connected_anchor: Array | None
    freedoms: str


def drawn_joints(objects: Sequence[Mapping[str, Any]], placements: Sequence[Placement]) -> list[DrawnJoint]:
    """Joints of a written scene where they stand, Unity's axes, metres.  placements: of each object."""
    found: list[DrawnJoint] = []
    for index, item in enumerate(objects):
        rotation, _, _ = placements[index]
        for written in item.get("components", []):
            component, middle = written, 0.0
            linked = link_above(objects, index) if written["type"] == "ArticulationBody" else None
            if linked is not None:
                component, middle = joint_of_link(written, linked)
            if component["type"] not in COLOURS or not component.get("enabled", True):
                continue
            axis = np.array(component.get("axis", [1, 0, 0]), float)
            second = np.array(component.get("secondaryAxis", [0, 1, 0]), float)
            anchor = world_points(component.get("anchor", (0, 0, 0)), placements[index])
            other: int | None = component.get("connectedBody")
            connected: str = "world" if other is None else objects[other]["name"]
            given: list[float] | None = component.get("connectedAnchor")
            connected_anchor = None
            if given is not None:
                connected_anchor = world_points(given, WORLD if other is None else placements[other])
            words = ", ".join(freedoms_of_component(written, index, placements)) or "fixed"
            pose = Pose(rotation @ frame_from_axes(axis, second), anchor)
            if linked is not None:
                connected_anchor = anchor + middle * pose.rotation[:, 0]
            found.append(
                DrawnJoint(
                    joint_name(written) or item["name"],
                    component["type"],
                    pose,
                    component,
                    connected,
                    connected_anchor,
                    words,
                )
            )
    return found


def _triangles(
    document: Mapping[str, Any], buffers: Sequence[bytes], placements: Sequence[Placement]
) -> tuple[Array, Array]:
    """World triangles, shape (n, 3, 3), and their linear RGB, shape (n, 3)."""
    corners, colours = [np.zeros((0, 3, 3))], [np.zeros((0, 3))]
    for shape in shapes(document, buffers, placements, MAX_TRIANGLES):
        rotation, position, _ = placements[shape.index]
        corners.append((shape.corners @ rotation.T + position)[shape.faces])
        colours.append(shape.colours)
    return np.concatenate(corners), np.concatenate(colours)


def hinge_axes(joints: Sequence[DrawnJoint]) -> Array:
    """The hinges' axes in the world, shape (n, 3)."""
    return np.array([j.pose.rotation[:, 0] for j in joints if j.kind == "HingeJoint"]).reshape(-1, 3)


def _surfaces(triangles: Array, colours: Array, view: View) -> str:
    """The sides that face the viewer, each drawn after what it hides; large triangles are cut first, against circles."""
    limit = 0.1 * (WIDTH / view.scale)
    for _ in range(6):
        edges = np.linalg.norm(triangles - np.roll(triangles, -1, axis=1), axis=2)
        large = edges.max(axis=1) > limit if len(triangles) else np.zeros(0, bool)
        if not large.any() or len(triangles) > 3 * MAX_TRIANGLES:
            break
        cut, tint, longest = triangles[large], colours[large], edges[large].argmax(axis=1)
        rows = np.arange(len(cut))
        a, b, c = (cut[rows, (longest + k) % 3] for k in range(3))
        half = (a + b) / 2
        pieces = [triangles[~large], np.stack([a, half, c], axis=1), np.stack([half, b, c], axis=1)]
        triangles = np.concatenate(pieces)
        colours = np.concatenate([colours[~large], tint, tint])
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    facing = (normals @ view.toward) > 1e-9 * np.maximum(lengths, 1e-300)
    triangles, colours, normals = (
        triangles[facing],
        colours[facing],
        normals[facing] / lengths[facing][:, None],
    )
    light = view.toward + 0.5 * view.up - 0.4 * view.right
    shade = 0.45 + 0.55 * np.clip(normals @ (light / np.linalg.norm(light)), 0.0, 1.0)
    rgb = np.clip(colours * shade[:, None], 0, 1) ** (1 / 2.2) * 255
    flat = view.project(triangles.reshape(-1, 3)).reshape(-1, 3, 2)
    order = nearest_last(flat, triangles @ view.toward, WIDTH, HEIGHT, 0.25 / view.scale)
    lines, colour, path = (
        ['<g stroke-width="0.7" stroke-linejoin="round" shape-rendering="crispEdges">'],
        "",
        "",
    )
    for i in order:
        (ax, ay), (bx, by), (cx, cy) = flat[i]
        shaded = "#%02x%02x%02x" % tuple(int(v) for v in rgb[i])
        if shaded != colour:  # neighbours in depth are often of one face: one path for a run of one colour
            lines += [f'<path d="{path}" fill="{colour}" stroke="{colour}"/>'] if path else []
            colour, path = shaded, ""
        path += f"M{ax:.1f} {ay:.1f}L{bx:.1f} {by:.1f}L{cx:.1f} {cy:.1f}Z"
    lines += [f'<path d="{path}" fill="{colour}" stroke="{colour}"/>'] if path else []
    return "\n".join([*lines, "</g>"])


def _edges(triangles: Array, view: View) -> str:
    """Sharp edges and outlines, as far as nothing hides them."""
    if not len(triangles):
        return ""
    shape = solid(
        triangles.reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3), np.zeros((len(triangles), 3))
    )
    canvas = Canvas(view, WIDTH, HEIGHT)
    canvas.surfaces(shape)
    runs = canvas.seen(shape.drawn(view.toward))
    path = "".join(f"M{a:.1f} {b:.1f}L{c:.1f} {d:.1f}" for (a, b), (c, d) in runs)
    return (
        f'<path d="{path}" fill="none" stroke="#1d242c" stroke-width="0.9" stroke-opacity="0.75"/>'
        if path
        else ""
    )


def tied(document: Mapping[str, Any], placements: Sequence[Placement]) -> list[Array]:
    """Of each joint that a coupling follows its place and that of the joint that follows, in the world, shape (2, 3)."""
    objects = document["gameObjects"]

    def place(end: Mapping[str, Any]) -> Array:
        component = objects[end["gameObject"]]["components"][end["component"]]
        anchor = component.get("anchor", component.get("anchorPosition", (0, 0, 0)))
        return world_points(anchor, placements[int(end["gameObject"])])

    return [
        np.array([place(end), place(coupling["b"])])
        for coupling in document.get("couplings", ())
        for end, _ in terms_of(coupling)
    ]


def _bar(bar: Bar, placements: Sequence[Placement], view: View) -> str:
    index, colour, ends = bar
    turn, place, _ = placements[index]
    (a, b), (c, d) = view.project(ends @ turn.T + place)
    return f'<path d="M{a:.1f} {b:.1f}L{c:.1f} {d:.1f}" stroke="{colour}" stroke-width="9" stroke-linecap="round"/>'


def _tie(ends: Array, view: View) -> str:
    (a, b), (c, d) = view.project(ends)
    line = f'<path d="M{a:.1f} {b:.1f}L{c:.1f} {d:.1f}" fill="none" stroke="#862e9c" stroke-width="2"'
    return line + ' stroke-dasharray="2 4" stroke-linecap="round"/>'


def strokes_of(joint: DrawnJoint, size: float) -> list[Array]:
    """The joint's axis, and an arc or a line for its range, in the world; size: metres, of the whole picture."""
    frame, place = joint.pose.rotation, joint.pose.translation
    strokes: list[Array] = []
    if joint.kind == "HingeJoint" or joint.component.get("angularXMotion", "Free") != "Locked":
        if joint.kind != "FixedJoint":
            strokes.append(place + np.outer([-0.07 * size, 0.07 * size], frame[:, 0]))
            low, high = _turn(joint)
            angles = np.linspace(low, high, 40)
            strokes.append(
                np.array(
                    [place + 0.045 * size * (rotation_about(frame[:, 0], a) @ frame[:, 1]) for a in angles]
                )
            )
    if joint.kind == "ConfigurableJoint":
        for name, axis in zip("xyz", frame.T):
            motion = joint.component.get(f"{name}Motion", "Free")
            if motion != "Locked":
                reach = (
                    joint.component.get("linearLimit", {}).get("limit", 0.0)
                    if motion == "Limited"
                    else 0.12 * size
                )
                middle = _slide_middle(joint, place, axis)
                strokes.append(middle + np.outer([-reach, reach], axis))
    return strokes


def _glyph(joint: DrawnJoint, view: View, size: float) -> str:
    colour = COLOURS[joint.kind]
    dash = ' stroke-dasharray="5 4"' if joint.component.get("closure") else ""
    strokes = strokes_of(joint, size)
    lines: list[str] = []
    for stroke in strokes:
        path = "L".join(f"{x:.1f} {y:.1f}" for x, y in view.project(stroke))
        lines.append(f'<path d="M{path}" fill="none" stroke="#fff" stroke-width="4.5" opacity="0.7"/>')
        lines.append(
            f'<path d="M{path}" fill="none" stroke="{colour}" stroke-width="2.2" stroke-linecap="round"{dash}/>'
        )
    return "\n".join(lines)


def _badges(joints: Sequence[DrawnJoint], view: View) -> list[str]:
    """Each joint's number in a disc at its anchor; discs on one spot stand beside each other."""
    lines: list[str] = []
    taken: list[tuple[float, float]] = []
    for number, joint in enumerate(joints, 1):
        x, y = view.project(joint.pose.translation[None])[0]
        while any((x - u) ** 2 + (y - v) ** 2 < 18**2 for u, v in taken):
            x += 19
        taken.append((x, y))
        lines.append(
            f'<circle cx="{x:.1f}" cy="{y:.1f}" r="9" fill="{COLOURS[joint.kind]}" stroke="#fff" stroke-width="1.5"/>'
            f'<text x="{x:.1f}" y="{y + 4.5:.1f}" fill="#fff" text-anchor="middle" font-weight="600">{number}</text>'
        )
    return lines


def _turn(joint: DrawnJoint) -> tuple[float, float]:
    """Range of the drawn arc, radians about the axis in Unity's left-hand sense, a full turn when free."""
    component = joint.component
    if joint.kind == "HingeJoint":
        if not component.get("useLimits", False):
            return 0.0, 2 * math.pi
        limits = component.get("limits", {})
        return math.radians(limits.get("min", 0.0)), math.radians(limits.get("max", 0.0))
    if component.get("angularXMotion", "Free") == "Free":
        return 0.0, 2 * math.pi
    low, high = angle_range(component, "angularXMotion")
    return math.radians(low), math.radians(high)


def _slide_middle(joint: DrawnJoint, place: Array, axis: Array) -> Array:
    """Middle of a slide's range: the connected anchor, seen along the axis; the anchor when not given."""
    anchor = joint.connected_anchor
    return place if anchor is None else place + axis * float(axis @ (anchor - place))


def _legend(document: Mapping[str, Any], joints: Sequence[DrawnJoint], title: str) -> str:
    lines = [f'<g transform="translate({WIDTH + 10} 36)" fill="#212529">']
    title = document.get("source", {}).get("uri", title)
    lines.append(f'<text font-size="16" font-weight="600">{_text(title)}</text>')
    mobility = document.get("analysis", {}).get("mobility")
    count = ", ".join(counted(document["gameObjects"], joints))
    lines.append(
        f'<text y="22" fill="#495057">{count}{"" if mobility is None else f", mobility {_text(mobility)}"}</text>'
    )
    for number, joint in enumerate(joints[:LISTED], 1):
        y = 32 + 27 * number
        lines.append(f'<circle cx="8" cy="{y - 4.5}" r="9" fill="{COLOURS[joint.kind]}"/>')
        lines.append(
            f'<text x="8" y="{y}" fill="#fff" text-anchor="middle" font-weight="600">{number}</text>'
        )
        lines.append(
            f'<text x="26" y="{y}">{_text(joint.name)} \u2013 {_text(joint.connected)}: {joint.freedoms}</text>'
        )
    if len(joints) > LISTED:
        lines.append(f'<text y="{59 + 27 * LISTED}" fill="#495057">and {len(joints) - LISTED} more</text>')
    return "\n".join([*lines, "</g>"])


def _text(value: object) -> str:
    """What a file says, as text within XML, which knows no control characters."""
    return escape(printable(str(value)))
