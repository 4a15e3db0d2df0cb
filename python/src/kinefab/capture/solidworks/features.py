"""SolidWorks' features as they are chained: each names the next."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from .api import Feature, Model


def features(model: Model) -> Iterator[Feature]:
    """Those of a document, in its tree's order.  Raises MemberFailed, and ValueError for a chain that leads back."""
    return _chain(model.FirstFeature(), lambda feature: feature.GetNextFeature())


def features_below(feature: Feature) -> Iterator[Feature]:
    """Those directly below a feature.  Raises as ``features`` does."""
    return _chain(feature.GetFirstSubFeature(), lambda below: below.GetNextSubFeature())


def _chain(first: Feature | None, following: Callable[[Feature], Feature | None]) -> Iterator[Feature]:
    passed: set[Feature] = set()
    feature = first
    while feature is not None:
        if feature in passed:
            raise ValueError("a feature that comes after itself")
        passed.add(feature)
        yield feature
        feature = following(feature)
