"""The modules of pxr.  They have no types, so here they are Any, once for all."""

# pyright: reportMissingTypeStubs=false, reportMissingImports=false, reportUnusedImport=false

from __future__ import annotations

from typing import Any

import pxr.Ar
import pxr.Gf
import pxr.Sdf
import pxr.Tf
import pxr.Usd
import pxr.UsdGeom
import pxr.UsdPhysics
import pxr.UsdShade
import pxr.UsdUtils
import pxr.Vt

modules: Any = pxr
Ar: Any = modules.Ar
Gf: Any = modules.Gf
Sdf: Any = modules.Sdf
Tf: Any = modules.Tf
Usd: Any = modules.Usd
UsdGeom: Any = modules.UsdGeom
UsdPhysics: Any = modules.UsdPhysics
UsdShade: Any = modules.UsdShade
UsdUtils: Any = modules.UsdUtils
Vt: Any = modules.Vt
