"""Vectors and quaternions (w first) as tuples."""

from __future__ import annotations


class _Numbers(tuple[float, ...]):
    def __new__(cls, *values: float) -> _Numbers:
        return tuple.__new__(cls, values)


class Vec2f(_Numbers): ...


class Vec3d(_Numbers): ...


class Vec3f(_Numbers): ...


class Vec4f(_Numbers): ...


class Quatd(_Numbers): ...


class Quatf(_Numbers): ...
