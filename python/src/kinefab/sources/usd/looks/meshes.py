"""A UsdGeom.Mesh as triangles with normals, texture coordinates, colours and submeshes."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ....spatial import Array, lengths_of
from ..api import UsdGeom, Vt
from ..values import Values, value_of
from .triangulate import triangles

MAX_UVS = 8
"""Texture coordinate sets of a Unity mesh."""
MAX_COORDINATE = 1e15


@dataclass(slots=True, eq=False)
class Polygons:
    """Triangles in the prim's own axes and units.

    vertices: shape (n, 3).  faces: shape (m, 3), counter-clockwise from outside.  normals: shape (n, 3) or None.
    uvs: arrays of shape (n, 2), with their names.  colors: linear RGBA, shape (n, 4), or None.
    face_counts, subsets: number of faces and GeomSubset prim (None: the mesh's own) of each submesh.
    """

    vertices: Array
    faces: np.ndarray
    normals: Array | None = None
    uvs: tuple[Array, ...] = ()
    uv_names: tuple[str, ...] = ()
    colors: Array | None = None
    face_counts: tuple[int, ...] = ()
    subsets: tuple[Any, ...] = field(default=())


@dataclass(frozen=True, slots=True, eq=False)
class _Primvar:
    """values: shape (k, d).  indices: into values for each element of ``interpolation``, None where each has its own."""

    name: str
    values: Array
    indices: np.ndarray | None
    interpolation: str

    def numbers(self, elements: np.ndarray | slice) -> np.ndarray | slice:
        """Which of ``values`` these elements have."""
        return elements if self.indices is None else self.indices[elements]


def read_mesh(prim: Any, values: Values) -> Polygons | None:
    """The cage of a mesh; None, and a loss in the report, where it cannot be drawn."""
    mesh = UsdGeom.Mesh(prim)
    cage = [mesh.GetPointsAttr(), mesh.GetFaceVertexCountsAttr(), mesh.GetFaceVertexIndicesAttr()]
    (given, *topology), moves = zip(*map(value_of, cage))
    points, (counts, corners) = _array(given, 3), map(_integers, topology)
    where, report = values.opened.place(prim), values.report
    if any(moves) or prim.HasAttribute("primvars:skel:jointIndices"):
        report.approximated(f"deformation of {prim.GetPath()}", "USD_DEFORMATION", where)
    detail = _unsound(points, counts, corners)
    if detail:
        report.dropped(f"mesh {prim.GetPath()}", "USD_MESH_UNSOUND", where, detail=detail)
        return None
    assert points is not None
    tri, owner = triangles(points, counts, corners)
    _tell_mistyped(prim, _TYPES, values)
    holes = _integers(values.current(mesh.GetHoleIndicesAttr()))
    if len(holes):
        keep = ~np.isin(owner, holes)
        tri, owner = tri[keep], owner[keep]
    if not len(tri):
        report.dropped(f"mesh {prim.GetPath()}", "USD_MESH_UNSOUND", where, detail="it has no faces")
        return None
    if mesh.GetOrientationAttr().Get() == UsdGeom.Tokens.leftHanded:
        tri = tri[:, ::-1]
    tri, owner, face_counts, subsets = _submeshes(mesh, tri, owner, len(counts), values)
    if mesh.GetSubdivisionSchemeAttr().Get() != UsdGeom.Tokens.none:
        report.approximated(f"subdivision of {prim.GetPath()}", "USD_SUBDIVISION", where)
    sizes = {
        "constant": 1,
        "uniform": len(counts),
        "varying": len(points),
        "vertex": len(points),
        "faceVarying": len(corners),
    }
    primvars = _primvars(prim, mesh, sizes, values)
    found = _indexed(points, _Corners(tri.ravel(), np.repeat(owner, 3), corners[tri].ravel()), primvars)
    found.face_counts, found.subsets = face_counts, subsets
    return found


_TYPES: dict[str, tuple[Any, ...]] = {
    "holeIndices": (Vt.IntArray, Vt.UIntArray, Vt.Int64Array),
    "normals": (Vt.Vec3fArray, Vt.Vec3dArray, Vt.Vec3hArray),
    "orientation": (str,),
    "subdivisionScheme": (str,),
}
_SUBSET_TYPES: dict[str, tuple[Any, ...]] = {
    "elementType": (str,),
    "familyName": (str,),
    "indices": (Vt.IntArray, Vt.UIntArray, Vt.Int64Array),
}
"""Of values that would be passed over, were they of another type; what a mesh cannot do without is told anyway."""


def _tell_mistyped(prim: Any, types: dict[str, tuple[Any, ...]], values: Values) -> None:
    for name, kinds in types.items():
        attribute = prim.GetAttribute(name)
        value = value_of(attribute)[0] if attribute and attribute.HasAuthoredValue() else None
        if value is not None and not isinstance(value, kinds):
            values.tell_unusable(prim, name, value)


def _array(value: Any, width: int) -> Array | None:
    if value is None:
        return None
    try:
        found = np.array(value, dtype=np.float64)
    except (TypeError, ValueError):  # of another type than the schema's
        return None
    return found.reshape(-1, width) if found.size % width == 0 else None


def _integers(value: Any) -> np.ndarray:
    """Empty where there are none, or something else than numbers."""
    try:
        return np.array([] if value is None else value, dtype=np.int64).ravel()
    except (TypeError, ValueError, OverflowError):
        return np.zeros(0, dtype=np.int64)


def _unsound(points: Array | None, counts: np.ndarray, corners: np.ndarray) -> str:
    """What is wrong with a mesh, "" for nothing."""
    if points is None or not len(points):
        return "it has no points"
    if not (np.abs(points) <= MAX_COORDINATE).all():
        return "a point is no finite number"
    if not len(counts):
        return "it has no faces"
    if (counts < 0).any() or counts.sum() != len(corners):
        return "its faces name another number of corners than it has"
    if len(corners) and (corners.min() < 0 or corners.max() >= len(points)):
        return "a face names a point that it does not have"
    return ""


def _submeshes(
    mesh: Any, tri: np.ndarray, owner: np.ndarray, count: int, values: Values
) -> tuple[np.ndarray, np.ndarray, tuple[int, ...], tuple[Any, ...]]:
    """Triangles ordered by the material subsets; what is in none comes last."""
    for subset in UsdGeom.Subset.GetAllGeomSubsets(mesh):
        _tell_mistyped(subset.GetPrim(), _SUBSET_TYPES, values)
    subsets = UsdGeom.Subset.GetGeomSubsets(mesh, UsdGeom.Tokens.face, "materialBind")
    if not subsets:
        return tri, owner, (), (None,)
    of_face = np.full(count, len(subsets), dtype=np.int64)
    for number, subset in enumerate(subsets):
        named = _integers(values.current(subset.GetIndicesAttr()))
        sound = named[(named >= 0) & (named < count)]
        taken = of_face[sound] != len(subsets)
        if len(sound) < len(named) or taken.any():
            values.report.approximated(
                f"subset {subset.GetPath()}", "USD_SUBSET_UNSOUND", values.opened.place(subset.GetPrim()),
                faces=len(named) - len(sound) + int(taken.sum()),
            )  # fmt: skip
        of_face[sound[~taken]] = number
    order = np.argsort(of_face[owner], kind="stable")
    sizes = np.bincount(of_face[owner], minlength=len(subsets) + 1)
    chosen = [*(subset.GetPrim() for subset in subsets), None]
    used = [i for i in range(len(subsets) + 1) if sizes[i]]
    face_counts = tuple(int(sizes[i]) for i in used) if len(used) > 1 else ()
    return tri[order], owner[order], face_counts, tuple(chosen[i] for i in used)


@dataclass(frozen=True, slots=True, eq=False)
class _Corners:
    """Of each corner of the triangles, three a triangle: which of the faces' corners it is, its face, its point."""

    corner: np.ndarray
    face: np.ndarray
    point: np.ndarray

    def elements(self, interpolation: str, chosen: np.ndarray | slice) -> np.ndarray:
        """Of these corners, the elements that a primvar counts."""
        if interpolation == "faceVarying":
            return self.corner[chosen]
        if interpolation == "uniform":
            return self.face[chosen]
        point = self.point[chosen]
        return point if interpolation != "constant" else np.zeros_like(point)

    def vertices(self, split: list[_Primvar]) -> tuple[np.ndarray, np.ndarray]:
        """A vertex for all corners of one point that agree in these primvars: its first corner, and each corner's vertex."""
        keys = self.point.astype(np.uint64)
        for p in split:
            keys *= np.uint64(0x9E3779B97F4A7C15)
            keys += _identities(p)[p.numbers(self.elements(p.interpolation, slice(None)))]
            keys ^= keys >> np.uint64(29)
        _, first, inverse = np.unique(keys, return_index=True, return_inverse=True)
        # In the order of their first use, so that equal meshes have equal vertices.
        rank = np.argsort(np.argsort(first, kind="stable"), kind="stable")
        return np.sort(first), rank[inverse]

    def points(self, count: int) -> tuple[np.ndarray | slice, np.ndarray]:
        """The points that a corner has, of so many, and for each corner its place among them."""
        named = np.zeros(count, dtype=bool)
        named[self.point] = True
        if named.all():
            return slice(None), self.point
        return np.flatnonzero(named), (np.cumsum(named) - 1)[self.point]


def _indexed(points: Array, corners: _Corners, primvars: list[_Primvar]) -> Polygons:
    """Corners that agree in everything become one vertex."""
    split = [p for p in primvars if p.interpolation in ("faceVarying", "uniform")]
    if split:
        first, inverse = corners.vertices(split)
        found = Polygons(points[corners.point[first]], inverse.reshape(-1, 3))
        _dress(found, [(p, corners.elements(p.interpolation, first)) for p in primvars])
        return found
    chosen, inverse = corners.points(len(points))
    found = Polygons(points[chosen], inverse.reshape(-1, 3))
    same = np.zeros(len(found.vertices), dtype=np.int64)
    _dress(found, [(p, chosen if p.interpolation in ("vertex", "varying") else same) for p in primvars])
    return found


def _dress(found: Polygons, primvars: list[tuple[_Primvar, np.ndarray | slice]]) -> None:
    """Give vertices the values of primvars, each with the elements that the vertices have of it."""
    colours: dict[str, Array] = {}
    for p, elements in primvars:
        values = p.values[p.numbers(elements)]
        if p.name == "normals":
            lengths = lengths_of(values)
            if (lengths > 0.0).all():
                found.normals = values / lengths[:, None]
        elif p.name in ("displayColor", "displayOpacity"):
            colours[p.name] = values
        else:
            found.uvs += (values,)
            found.uv_names += (p.name,)
    if colours:
        count = len(found.vertices)
        rgb = colours.get("displayColor", np.ones((count, 3)))
        alpha = colours.get("displayOpacity", np.ones((count, 1)))
        found.colors = np.clip(np.column_stack([rgb, alpha]), 0.0, 1.0)


def _identities(primvar: _Primvar) -> np.ndarray:
    """A number for each value, the same for equal ones, shape (k,)."""
    bits = (
        np.ascontiguousarray(primvar.values.astype(np.float32) + np.float32(0.0))
        .view(np.uint32)
        .astype(np.uint64)
    )
    mixed = np.zeros(len(bits), dtype=np.uint64)
    for column in bits.T:
        mixed = (mixed ^ column) * np.uint64(0xBF58476D1CE4E5B9)
        mixed ^= mixed >> np.uint64(31)
    return mixed


def _primvars(prim: Any, mesh: Any, sizes: dict[str, int], values: Values) -> list[_Primvar]:
    """Normals, texture coordinates ("st" first) and colours that differ over the mesh."""
    api = UsdGeom.PrimvarsAPI(prim)
    found: list[_Primvar] = []
    normals = api.GetPrimvar("normals")
    if normals and normals.HasAuthoredValue():
        found += _primvar("normals", normals, 3, sizes, values)
    elif mesh.GetNormalsAttr().HasAuthoredValue():
        directions = _array(value_of(mesh.GetNormalsAttr())[0], 3)
        interpolation = str(mesh.GetNormalsInterpolation())
        sound = directions is not None and np.isfinite(directions).all()
        if sound and directions is not None and len(directions) == sizes.get(interpolation):
            found.append(_Primvar("normals", directions, None, interpolation))
        elif directions is not None and len(directions):
            _report_primvar("normals", prim, values)
    coordinates: list[tuple[bool, str, Any]] = []
    for primvar in api.FindPrimvarsWithInheritance():
        kind, name = str(primvar.GetTypeName()), primvar.GetPrimvarName()
        if kind.startswith("texCoord2") or (
            kind in ("float2[]", "double2[]", "half2[]") and name.startswith(("st", "uv", "UV"))
        ):
            coordinates.append((name != "st", name, primvar))
        elif name == "st":
            _report_primvar(name, prim, values)
        elif name in ("displayColor", "displayOpacity") and primvar.GetInterpolation() != "constant":
            found += _primvar(name, primvar, 3 if name == "displayColor" else 1, sizes, values)
    for number, (_, name, primvar) in enumerate(sorted(coordinates, key=lambda entry: entry[:2])):
        if number == MAX_UVS:
            values.report.dropped(
                f"uv sets of {prim.GetPath()}",
                "USD_FEATURE_DROPPED",
                values.opened.place(prim),
                detail=f"Unity has {MAX_UVS}, the mesh {len(coordinates)}",
            )
            break
        found += _primvar(name, primvar, 2, sizes, values)
    return found


def _primvar(name: str, primvar: Any, width: int, sizes: dict[str, int], values: Values) -> list[_Primvar]:
    """The primvar, or none and a loss in the report where it does not fit the mesh."""
    interpolation = str(primvar.GetInterpolation())
    numbers = _array(values.current(primvar.GetAttr()), width)
    if numbers is None or not len(numbers):
        return []
    indices = _integers(values.current(primvar.GetIndicesAttr())) if primvar.IsIndexed() else None
    count = len(numbers) if indices is None else len(indices)
    sound = count == sizes.get(interpolation) and np.isfinite(numbers).all()
    if not sound or (
        indices is not None and len(indices) and (indices.min() < 0 or indices.max() >= len(numbers))
    ):
        _report_primvar(name, primvar.GetAttr().GetPrim(), values)
        return []
    return [_Primvar(name, numbers, indices, interpolation)]


def _report_primvar(name: str, prim: Any, values: Values) -> None:
    values.report.dropped(
        f"primvar {name} of {prim.GetPath()}", "USD_PRIMVAR_UNSOUND", values.opened.place(prim, name)
    )
