"""Mass properties as programs list them, as a bundle's: the tensor about the centre of mass, in the part's axes.

Standard library only: it also runs in a CAD program's own Python.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from .draft import BodyMesh, Draft, Numbers, Record

AGREE = 1e-6
"""Difference of two readings, of the largest moment, up to which the principal moments do not tell them apart."""
WRONG = 1e-4
"""Difference from the principal moments, of the largest, from which no reading is right."""
OUTSIDE = 1e-3
"""How far, of the part's size, a centre of mass may be outside of its mesh's box."""


def mass_record(
    draft: Draft,
    name: str,
    mass: float,
    center: Numbers,
    moments: Numbers,
    principal: Numbers,
    about: str,
    meshes: Sequence[BodyMesh] = (),
) -> Record:
    """A bundle's mass, of numbers in the draft's units.

    moments: xx yy zz xy yz xz.  about: 'centre' or 'origin', which the documentation says they count from.
    principal: the program's own moments about the principal axes.  These tell from where the moments count, since trace and
    determinant of a tensor are theirs, and mostly with which sign the products are listed; where two readings fit, the one that is
    nearer to the mesh's own tensor is meant, and without a mesh the documented one.
    """
    readings = _readings([float(v) for v in moments], mass, [float(v) for v in center], about)
    size = max(map(abs, principal)) or 1.0
    off = [_off(tensor, principal, size) for _, tensor in readings]
    best = min(off)
    likely = [i for i in range(len(off)) if off[i] <= best + AGREE]
    chosen = likely[0]
    if len(likely) > 1 and (own := mesh_tensor(meshes, mass)) is not None:
        chosen = min(likely, key=lambda i: sum(abs(p - q) for p, q in zip(readings[i][1], own)))
    if best > WRONG:
        draft.report.add("CAPTURE_INERTIA", name=name, program=draft.program, off=f"{best:.2g}")
    if (far := _outside(center, meshes)) > OUTSIDE:
        draft.report.add("CAPTURE_CENTER", name=name, program=draft.program, off=f"{far:.2g}")
    words, tensor = readings[chosen]
    return {
        "in": "part",
        "mass": float(mass),
        "center": [float(v) for v in center],
        "inertia": tensor,
        "extras": {"reading": words},
    }


def together(masses: Sequence[Record]) -> Record:
    """Mass of several bodies of one part that were weighed each, in the part's frame."""
    mass = sum(m["mass"] for m in masses)
    center = [sum(m["mass"] * m["center"][n] for m in masses) / mass for n in range(3)]
    tensor = [0.0] * 6
    for m in masses:
        apart = [p - q for p, q in zip(center, m["center"])]
        tensor = [t + v for t, v in zip(tensor, _to_center(m["inertia"], -m["mass"], apart))]
    extras = {"reading": "; ".join(sorted({m["extras"]["reading"] for m in masses}))}
    return {"in": "part", "mass": mass, "center": center, "inertia": tensor, "extras": extras}


def _readings(
    moments: list[float], mass: float, center: list[float], about: str
) -> list[tuple[str, list[float]]]:
    found: list[tuple[str, list[float]]] = []
    for where in (about, "origin" if about == "centre" else "centre"):
        for words, sign in (("entries of the tensor", 1.0), ("products with the other sign", -1.0)):
            given = moments[:3] + [sign * v for v in moments[3:]]
            tensor = given if where == "centre" else _to_center(given, mass, center)
            found.append((f"{words}, about the {where}", tensor))
    return found


def _off(tensor: list[float], principal: Numbers, size: float) -> float:
    trace = abs(sum(tensor[:3]) - sum(principal)) / size
    return trace + abs(_determinant(tensor) - math.prod(principal)) / size**3


def _to_center(tensor: list[float], m: float, c: list[float]) -> list[float]:
    x, y, z = c
    shift = [y * y + z * z, x * x + z * z, x * x + y * y, -x * y, -y * z, -x * z]
    return [t - m * s for t, s in zip(tensor, shift)]


def _determinant(tensor: list[float]) -> float:
    xx, yy, zz, xy, yz, xz = tensor
    return xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz)


def mesh_tensor(meshes: Sequence[BodyMesh], mass: float) -> list[float] | None:
    """The tensor about its centre of a solid of one density between the triangles; None where they enclose nothing."""
    volume = 0.0
    first = [0.0, 0.0, 0.0]
    second = [0.0] * 6  # xx yy zz xy yz xz of the integral of p p^T
    for mesh in meshes:
        points: list[tuple[float, float, float]] = list(zip(*(iter(mesh.points),) * 3))
        for at in range(0, len(mesh.triangles), 3):
            a, b, c = (points[corner] for corner in mesh.triangles[at : at + 3])
            v = (
                a[0] * (b[1] * c[2] - b[2] * c[1])
                - a[1] * (b[0] * c[2] - b[2] * c[0])
                + a[2] * (b[0] * c[1] - b[1] * c[0])
            )
            s = [a[n] + b[n] + c[n] for n in range(3)]
            volume += v / 6.0
            first = [f + v / 24.0 * p for f, p in zip(first, s)]
            for n, (p, q) in enumerate(((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))):
                second[n] += v / 120.0 * (s[p] * s[q] + a[p] * a[q] + b[p] * b[q] + c[p] * c[q])
    if volume <= 0.0:
        return None
    x, y, z = (f / volume for f in first)
    density = mass / volume
    xx, yy, zz, xy, yz, xz = (density * v for v in second)
    about_origin = [yy + zz, xx + zz, xx + yy, -xy, -yz, -xz]
    return _to_center(about_origin, mass, [x, y, z])


def _outside(center: Numbers, meshes: Sequence[BodyMesh]) -> float:
    """How far outside of the meshes' box the centre is, of the box's size."""
    points = [point for mesh in meshes for point in zip(*(iter(mesh.points),) * 3)]
    if not points:
        return 0.0
    low, high = ([end(p[n] for p in points) for n in range(3)] for end in (min, max))
    size = max(h - l for l, h in zip(low, high)) or 1.0
    return max(max(l - c, c - h) for l, c, h in zip(low, center, high)) / size
