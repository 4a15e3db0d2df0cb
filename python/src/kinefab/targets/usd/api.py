"""The modules of pxr.  They have no types, so here they are Any, once for all."""

# pyright: reportMissingTypeStubs=false, reportMissingImports=false, reportUnusedImport=false

from __future__ import annotations

from typing import Any

import pxr.Gf
import pxr.Sdf
import pxr.Vt

modules: Any = pxr
Gf: Any = modules.Gf
Sdf: Any = modules.Sdf
Vt: Any = modules.Vt
