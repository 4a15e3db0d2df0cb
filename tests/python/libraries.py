"""Marks for cases that need a library that may not be there: one skip with its reason."""

from __future__ import annotations

from importlib.util import find_spec

import pytest

usd = pytest.mark.skipif(find_spec("pxr") is None, reason="usd-core is not installed")
