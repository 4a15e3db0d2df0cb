"""What a script passes, checked: TypeError for what is of no use, ValueError for a value that is none, each with what to
pass instead."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Union, cast

import numpy as np
from numpy.typing import NDArray

from ..diagnostics import is_encodable
from ..spatial import Array, Pose, matrix_from_quaternion, rotation_about

Vector = Union[Sequence[float], NDArray[np.floating[Any]], NDArray[np.integer[Any]]]
"""Numbers in a row; to a type checker an array is no sequence."""
ROUNDED = 1e-4
"""Largest entry of R'R - 1 that is the rounding of typed digits; the nearest rotation is taken then."""
EXACT = 1e-12
"""Up to here a rotation matrix is taken as it is."""
LARGEST = 1e9
"""Metres; beyond, single precision has no millimetres, and far beyond no numbers."""
PARALLEL = 1e-9
"""Sine of the angle below which two axes span no plane."""
LONGEST = 120
"""Characters of a value that a message shows."""
AXES = dict(zip("XYZ", np.eye(3)))


def shown(value: object) -> str:
    """A value as a message shows it: what is long ends in dots."""
    try:
        text = repr(value)
    except ValueError:  # Python writes no integer of more than 4,300 digits
        text = f"a {type(value).__name__} of many digits"
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."


def numbers_in(values: Any) -> Array | None:
    """Real numbers, as an array of any shape; None for what holds anything else (words, flags, complex numbers)."""
    try:
        given = np.asarray(values)
        flags = any(isinstance(each, bool) for each in np.asarray(values, dtype=object).flat)
        return given.astype(np.float64) if given.dtype.kind in "iuf" and not flags else None
    except (TypeError, ValueError, OverflowError):  # lists of lists of unequal length; numbers beyond a float
        return None


def checked_vector(what: str, values: Any) -> Array:
    """Three numbers, shape (3,)."""
    array = numbers_in(values)
    if array is None or array.shape != (3,) or not np.abs(array).max() <= LARGEST:
        raise ValueError(f"{what} is {shown(values)}; pass three numbers, none beyond {LARGEST:g}")
    return array


def checked_name(name: object, empty: bool = True) -> None:
    """Raises TypeError for what is no string, ValueError for one that no file holds (a lone surrogate) and, unless
    ``empty``, for one without a character."""
    if not isinstance(name, str):
        raise TypeError(f"the name is {shown(name)}; pass a string")
    if not is_encodable(name):
        raise ValueError(f"the name is {shown(name)}; pass text that UTF-8 can hold")
    if not name and not empty:
        raise ValueError("the name is empty; pass one, ids are made of it")


def checked_axes(axis: Any, secondary: Any) -> tuple[Array, Array | None]:
    """A joint's axis and, where one is given, the direction beside it, shapes (3,)."""
    main = checked_vector("the axis", axis)
    if not np.linalg.norm(main) > 0.0:
        raise ValueError(
            f"the axis {shown(axis)} has no direction; pass a direction in the world, such as (0, 0, 1)"
        )
    near = None if secondary is None else checked_vector("the secondary axis", secondary)
    if near is not None:
        lengths = np.linalg.norm(main) * np.linalg.norm(near)
        if not np.linalg.norm(np.cross(main, near)) > PARALLEL * lengths:
            raise ValueError(
                f"the secondary axis {shown(secondary)} and the axis span no plane; pass a direction across it"
            )
    return main, near


def checked_flag(what: str, value: object) -> None:
    """Raises TypeError for what is neither True nor False; a word such as "no" would count as true."""
    if not isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{what} is {shown(value)}; pass True or False")


def checked_number(what: str, value: Any, *, least: float = -math.inf, infinite: bool = False) -> float:
    """A number, not NaN and, unless ``infinite``, finite."""
    if isinstance(value, bool) or not isinstance(value, (int, float, np.integer, np.floating)):
        raise TypeError(f"{what} is {shown(value)}; pass a number")
    try:
        number = float(cast("float", value))
    except OverflowError:  # an integer
        number = math.nan
    if math.isnan(number) or (math.isinf(number) and not infinite) or number < least:
        bound = "" if math.isinf(least) else f", not below {least:g}"
        raise ValueError(
            f"{what} is {shown(cast(object, value))}; pass a{'' if infinite else ' finite'} number{bound}"
        )
    return number


def checked_positive(what: str, value: Any, *, infinite: bool = False) -> float:
    """A number above zero, infinity too where ``infinite``."""
    number = checked_number(what, value, infinite=True)
    if not 0.0 < number or (math.isinf(number) and not infinite):
        raise ValueError(f"{what} is {shown(value)}; it must be a number above zero")
    return number


def checked_rotation(name: str, rotation: Any) -> Array:
    """A rotation matrix, shape (3, 3).

    rotation: a matrix (3, 3) of at least four digits, a quaternion (x, y, z, w), Euler angles with their order as
    ``("XYZ", (30, 0, 90))`` in degrees (capitals: about the axes as they turn with the part; small letters: about the
    fixed ones, the first first), or anything with ``as_matrix()``, such as scipy's Rotation.
    """
    if hasattr(rotation, "as_matrix"):
        rotation = rotation.as_matrix()
    if isinstance(rotation, (tuple, list)):
        pair = cast("Sequence[Any]", rotation)
        if len(pair) == 2 and isinstance(pair[0], str):
            return _from_euler(name, pair[0], pair[1])
    advice = (
        f"the rotation of {name} {{}}; pass a rotation matrix, 3 x 3, a quaternion (x, y, z, w) or angles with their"
        ' order, such as ("XYZ", (30, 0, 90))'
    )
    turn = numbers_in(rotation)
    if turn is None:
        raise ValueError(advice.format("is no matrix of numbers"))
    if turn.shape == (4,):
        return _from_quaternion(turn, advice)
    if turn.shape != (3, 3):
        raise ValueError(advice.format(f"has the shape {turn.shape}"))
    off = float(np.abs(turn.T @ turn - np.eye(3)).max()) if np.isfinite(turn).all() else math.nan
    if not off <= ROUNDED:
        raise ValueError(advice.format(f"is no rotation, R'R is off the identity by {off:.3g}"))
    if np.linalg.det(turn) < 0.0:
        raise ValueError(advice.format("is a reflection") + "; mirror the mesh instead")
    if off <= EXACT:
        return turn
    left, _, right = np.linalg.svd(turn)
    return left @ right


def checked_pose(name: str, translation: Any, rotation: Any) -> tuple[Array, Array]:
    """Rotation matrix and translation; ``rotation`` may be a whole pose, a ``Pose`` or of shape (4, 4), with no translation
    beside it."""
    matrix = _whole_pose(rotation)
    if matrix is None:
        turn = np.eye(3) if rotation is None else checked_rotation(name, rotation)
        return turn, checked_vector(
            f"the translation of {name}", (0.0, 0.0, 0.0) if translation is None else translation
        )
    if translation is not None:
        raise ValueError(f"the pose of {name} is 4 x 4 and holds its translation; pass no other beside it")
    if not np.allclose(matrix[3], (0.0, 0.0, 0.0, 1.0)):
        raise ValueError(f"the pose of {name} has the last row {matrix[3].tolist()}; it must be 0 0 0 1")
    return checked_rotation(name, matrix[:3, :3]), checked_vector(f"the translation of {name}", matrix[:3, 3])


def _whole_pose(rotation: Any) -> Array | None:
    if isinstance(rotation, Pose):
        turn, place = numbers_in(rotation.rotation), numbers_in(rotation.translation)
        if turn is None or place is None or turn.shape != (3, 3) or place.shape != (3,):
            raise ValueError(
                f"{shown(rotation)} is no pose; pass its rotation as 3 x 3, its translation as three numbers"
            )
        return np.block([[turn, place[:, None]], [np.zeros(3), np.ones(1)]])
    matrix = numbers_in(rotation)  # what is none, ``checked_rotation`` tells
    return matrix if matrix is not None and matrix.shape == (4, 4) else None


def _from_quaternion(q: Array, advice: str) -> Array:
    length = float(np.linalg.norm(q))
    if not abs(length - 1.0) <= ROUNDED:
        raise ValueError(advice.format(f"is a quaternion of length {length:.6g}, not 1"))
    return matrix_from_quaternion(q)


def _from_euler(name: str, order: str, angles: Any) -> Array:
    if len(order) != 3 or set(order.upper()) - set("XYZ") or not (order.isupper() or order.islower()):
        raise ValueError(
            f"the order of {name}'s angles is {shown(order)}; pass three of XYZ, or three of xyz"
        )
    turn = np.eye(3)
    for letter, degrees in zip(order, checked_vector(f"the angles of {name}", angles)):
        step = rotation_about(AXES[letter.upper()], math.radians(degrees))
        turn = turn @ step if order.isupper() else step @ turn
    return turn


def checked_color(name: str, color: Any) -> tuple[float, float, float, float]:
    """Linear red green blue alpha, 0..1."""
    given = numbers_in(color)
    values: list[float] = given.tolist() if given is not None and given.ndim == 1 else []
    if len(values) not in (3, 4) or not all(0.0 <= c <= 1.0 for c in values):
        raise ValueError(f"the color of {name} is {shown(color)}; pass three or four numbers from 0 to 1")
    red, green, blue, alpha = (*values, 1.0)[:4]
    return red, green, blue, alpha
