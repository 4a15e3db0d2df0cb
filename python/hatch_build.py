"""Brings the schemas, which live once at the root for both languages, into what is built from a checkout.

A source distribution holds them where the package does, so that a wheel can be made from it alone; there, and in
an editable install, nothing is left to do.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class Schemas(BuildHookInterface):
    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """version: of the target, "standard" or "editable"."""
        packaged = Path(self.root, "src", "kinefab", "schemas")
        if version == "editable" or packaged.is_dir():
            return
        place = "src/kinefab/schemas" if self.target_name == "sdist" else "kinefab/schemas"
        build_data["force_include"][str(Path(self.root).parent / "schemas")] = place
