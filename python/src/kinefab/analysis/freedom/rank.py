"""Rank, null space and span, with the tolerance placed in the largest gap of the singular values.

A rank is a statement about noise: exported poses carry errors of 1e-7..1e-5, and an over-constrained
mechanism exists only inside them.  So the border between "constrains" and "repeats" is put where the
singular values leave the widest gap, within a window; how wide it is says how sure the answer is.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...spatial import Array, IntArray
from .stacks import alike

WINDOW = (1e-7, 1e-3)
"""Relative singular values between which the border may lie."""

SURE_GAP = 1e2
"""A narrower gap (ratio of the singular values on its two sides) is reported as uncertain."""


def rank_of(s: Array) -> tuple[IntArray, Array]:
    """Rank and gap for descending singular values, shape (..., k) to two arrays of shape (...).

    The gap is the ratio of the last value kept to the first one dropped, infinite where none is dropped.
    """
    low, high = WINDOW
    largest = s[..., :1]
    relative = np.divide(s, largest, out=np.zeros_like(s), where=largest > 0.0)
    after = np.concatenate([relative[..., 1:], np.zeros_like(largest)], axis=-1)
    allowed = (relative > low) & (after < high)
    ratio = np.where(allowed, relative / np.maximum(after, low), 0.0)
    last = np.argmax(ratio, axis=-1)
    rank = np.where(np.any(allowed, axis=-1), last + 1, 0)
    kept = np.take_along_axis(relative, last[..., None], axis=-1)[..., 0]
    dropped = np.take_along_axis(after, last[..., None], axis=-1)[..., 0]
    gap = np.divide(kept, dropped, out=np.full(kept.shape, np.inf), where=dropped > 1e-30)
    return rank, gap


def normalised(rows: Array, sizes: Array) -> Array:
    """Rows (..., m, n) of unit length; a zero row stays zero.

    sizes: shape (..., m), see ``System.sizes``: what is left of a row whose parts cancel is a rounding, or noise, and stays
    as small as it is.
    """
    size = np.maximum(np.linalg.norm(rows, axis=-1), sizes)[..., None]
    return np.divide(rows, size, out=np.zeros_like(rows), where=size > 0.0)


def factored(rows: Array) -> tuple[IntArray, Array, Array]:
    """Rank and gap (...), and V' (..., n, n) of normalised rows (..., m, n); the null space is V'[rank:]."""
    m, n = rows.shape[-2:]
    if m < n:
        rows = np.concatenate([rows, np.zeros((*rows.shape[:-2], n - m, n))], axis=-2)
    _, s, vt = np.linalg.svd(rows, full_matrices=False)
    return *rank_of(s), vt


def spans(
    columns: Sequence[Array], cut: float | None = None, least: Sequence[float] | None = None
) -> list[Array]:
    """Orthonormal bases, shape (m, rank), of the spans of columns, shape (m, n) each.

    cut: share of the largest singular value up to which one counts as a rounding; None puts it in the largest gap.
    least: instead, of each, the singular value up to which one counts as none; the bases keep no entry that small times it.
    """
    found = list(columns)
    for _, group in alike(own.shape for own in columns):
        members: list[int] = group.tolist()
        stack = np.array([columns[i] for i in members])
        if stack.shape[2] > stack.shape[1]:  # of many columns in few dimensions, their triangular factor
            stack = np.swapaxes(np.linalg.qr(np.swapaxes(stack, 1, 2), mode="r"), 1, 2)
        u, s, _ = np.linalg.svd(stack, full_matrices=False)
        if least is not None:
            none = np.array([least[i] for i in members])
            rank = np.sum(s > none[:, None], axis=1)
            u = np.where(np.abs(u) * s[:, None] > none[:, None, None], u, 0.0)
        else:
            rank = rank_of(s)[0] if cut is None and s.size else np.sum(s > (cut or 0.0) * s[:, :1], axis=1)
        for i, basis, count in zip(members, u, rank):
            found[i] = basis[:, :count]
    return found
