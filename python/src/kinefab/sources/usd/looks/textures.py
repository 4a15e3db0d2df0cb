"""UsdUVTexture: the image, how it repeats and which coordinates it takes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ....geometry.looks.pixels import MOST_BYTES
from ....model import Texture, Wrap
from ..api import Ar, Sdf, UsdShade
from ..stage import OpenStage
from ..values import Values, shown

MEDIA = {
    ".png": ("image/png", b"\x89PNG"),
    ".jpg": ("image/jpeg", b"\xff\xd8"),
    ".jpeg": ("image/jpeg", b"\xff\xd8"),
    ".bmp": ("image/bmp", b"BM"),
    ".exr": ("image/x-exr", b"\x76\x2f\x31\x01"),
    ".hdr": ("image/vnd.radiance", b"#?"),
    ".psd": ("image/vnd.adobe.photoshop", b"8BPS"),
    ".tga": ("image/x-tga", b""),
    ".tif": ("image/tiff", b""),
    ".tiff": ("image/tiff", b""),
}
"""Media type and first bytes by ending: what Unity imports."""
CHANNELS = {"rgb": slice(0, 3), "r": slice(0, 1), "g": slice(1, 2), "b": slice(2, 3), "a": slice(3, 4)}
SQUARE = 1e-6
"""Axes of coordinates whose cosine is below this are at right angles."""
Move = tuple[tuple[float, float], tuple[float, float], float]
"""Scale, offset and rotation (radians), as ``Texture`` has them: scaled first, then turned, then moved."""
STILL: Move = ((1.0, 1.0), (0.0, 0.0), 0.0)
WRAPS = {"repeat": Wrap.REPEAT, "mirror": Wrap.MIRROR, "clamp": Wrap.CLAMP, "black": Wrap.CLAMP}


@dataclass(frozen=True, slots=True, eq=False)
class Sampler:
    """texture; output: 'rgb', 'r', 'g', 'b' or 'a'.  tint: linear RGB that the image is multiplied by, alpha: its opacity.  bias: of
    RGB, added after that."""

    texture: Texture
    output: str
    tint: tuple[float, float, float]
    alpha: float = 1.0
    bias: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @property
    def amount(self) -> float:
        """What one number of the image is multiplied by."""
        return self.alpha if self.output == "a" else self.tint["rgb".index(self.output[:1])]


def read_sampler(shader: Any, output: str, uv_names: tuple[str, ...], values: Values) -> Sampler | None:
    """None, and a loss in the report, where the image is not there or is none."""
    prim, opened, report = shader.GetPrim(), values.opened, values.report
    where, feature = opened.place(prim, "inputs:file"), f"texture {prim.GetPath()}"
    texture = read_image(shader, "file", feature, values)
    if texture is None:
        return None
    uv_set, scale, offset, rotation = _coordinates(shader, uv_names, values)
    wraps = {str(read_input(shader, key, values) or "useMetadata") for key in ("wrapS", "wrapT")}
    wrap = next((WRAPS[w] for w in sorted(wraps) if w in WRAPS), Wrap.REPEAT)
    if len(wraps) > 1 or "black" in wraps:
        report.approximated(
            feature,
            "USD_FEATURE_APPROXIMATED",
            where,
            detail=f"wrap {', '.join(sorted(wraps))} became {wrap.value}",
        )
    *tint, alpha = read_floats(shader, "scale", (1.0, 1.0, 1.0, 1.0), values)
    r, g, b, _ = read_floats(shader, "bias", (0.0, 0.0, 0.0, 0.0), values)
    laid = replace(moved(texture, uv_set, (scale, offset, rotation)), wrap=wrap)
    return Sampler(laid, output, (tint[0], tint[1], tint[2]), alpha, (r, g, b))


def read_image(shader: Any, name: str, feature: str, values: Values) -> Texture | None:
    """The image that an input names, as it lies on the mesh's first coordinates; None, and a loss, where there is none."""
    where, report = values.opened.place(shader.GetPrim(), f"inputs:{name}"), values.report
    given = read_input(shader, name, values)
    if given is None:
        report.dropped(feature, "USD_TEXTURE_MISSING", where, path="", detail="no file is named")
        return None
    if not isinstance(given, Sdf.AssetPath):
        report.dropped(feature, "USD_TEXTURE_MISSING", where, path=shown(given), detail="it names no asset")
        return None
    image, detail = _image(str(given.path), str(given.resolvedPath), values.opened)
    if image is None:
        report.dropped(feature, "USD_TEXTURE_MISSING", where, path=given.path, detail=detail)
        return None
    return Texture(*image)


def moved(texture: Texture, uv_set: int, move: Move) -> Texture:
    """The image as it lies on a mesh's coordinates of that number."""
    scale, offset, rotation = move
    return replace(texture, uv_set=uv_set, scale=scale, offset=offset, rotation=rotation)


def read_fallback(shader: Any, output: str, values: Values) -> float | tuple[float, ...] | None:
    """What the shader says to take where its image is not there, None for nothing."""
    if read_input(shader, "fallback", values) is None or output not in CHANNELS:
        return None
    found = read_floats(shader, "fallback", (0.0, 0.0, 0.0, 1.0), values)[CHANNELS[output]]
    return found[0] if len(found) == 1 else found


def read_input(shader: Any, name: str, values: Values) -> Any:
    """What an input is at the exported time, wherever its value stands; None where nothing is said."""
    given = shader.GetInput(name)
    if not given:
        return None
    producing = given.GetValueProducingAttributes()
    return values.current(producing[0]) if producing else None


def read_floats(shader: Any, name: str, default: tuple[float, ...], values: Values) -> tuple[float, ...]:
    """As many finite numbers as the default has; the default where nothing is said, or, told, something else."""
    value = read_input(shader, name, values)
    if value is None:
        return default
    try:
        found = tuple(float(c) for c in ([value] if len(default) == 1 else value))
    except (TypeError, ValueError):
        found = ()
    if len(found) == len(default) and all(map(math.isfinite, found)):
        return found
    values.tell_unusable(shader.GetPrim(), f"inputs:{name}", value)
    return default


def _image(
    named: str, resolved: str, opened: OpenStage
) -> tuple[tuple[str, Path | None, bytes | None, str] | None, str]:
    """(name, path, data, media type), or None and what is wrong."""
    inner = resolved.rpartition("[")[2].rstrip("]") if resolved.endswith("]") else ""
    given = Path(inner or named)
    if given.suffix.lower() not in MEDIA:
        return None, "it is no image that Unity reads"
    if not inner and Path(named).is_absolute():
        return None, "it is named by an absolute path"
    if not resolved:
        return None, "the file is not there"
    media, magic = MEDIA[given.suffix.lower()]
    try:
        if inner:
            asset = Ar.GetResolver().OpenAsset(Ar.ResolvedPath(resolved))
            if asset is None or asset.GetSize() > MOST_BYTES:
                return None, "the package does not hold it" if asset is None else "it is too large"
            data = bytes(asset.GetBuffer())
            head = data[:8]
        else:
            data = None
            if not Path(resolved).is_file():  # of a pipe no byte may ever come
                return None, "it is no regular file"
            with Path(resolved).open("rb") as stream:
                head = stream.read(8)
    except (OSError, RuntimeError) as error:
        return None, getattr(error, "strerror", None) or str(error)
    if not head.startswith(magic) or not head:
        return None, f"its bytes are not {media}"
    name = _relative(inner or resolved, opened, bool(inner))
    return (name, None if inner else Path(resolved), data, media), ""


def _relative(path: str, opened: OpenStage, packed: bool) -> str:
    """A name that is the same wherever the stage lies."""
    if not packed and opened.folder is not None:
        try:
            return Path(path).resolve().relative_to(opened.folder).as_posix()
        except ValueError:
            return Path(path).name
    return path if packed else Path(path).name


def _coordinates(
    shader: Any, uv_names: tuple[str, ...], values: Values
) -> tuple[int, tuple[float, float], tuple[float, float], float]:
    """Which uv set, and scale, offset and rotation (radians) of it."""
    moves: list[Move] = []
    name = ""
    given = shader.GetInput("st")
    for _ in range(8):  # reader behind transforms; a circle ends here
        producing: Any = given.GetValueProducingAttributes() if given else []
        source: Any = UsdShade.Shader(producing[0].GetPrim()) if producing else None
        kind = "" if not source else str(source.GetIdAttr().Get() or "")
        if kind == "UsdTransform2d":
            s = read_floats(source, "scale", (1.0, 1.0), values)
            t = read_floats(source, "translation", (0.0, 0.0), values)
            (turn,) = read_floats(source, "rotation", (0.0,), values)
            moves.append(((s[0], s[1]), (t[0], t[1]), math.radians(turn)))
            given = source.GetInput("in")
            continue
        if kind.startswith("UsdPrimvarReader"):
            name = str(read_input(source, "varname", values) or "")
        break
    prim, opened, report = shader.GetPrim(), values.opened, values.report
    (scale, offset, rotation), sheared = _chained(moves)
    if sheared:
        report.approximated(
            f"texture {prim.GetPath()}", "USD_FEATURE_APPROXIMATED", opened.place(prim),
            detail="its transforms shear the image together; it is turned and scaled alone",
        )  # fmt: skip
    if name and name not in uv_names:
        report.approximated(
            f"texture {prim.GetPath()}", "USD_FEATURE_APPROXIMATED", opened.place(prim),
            detail=f"the mesh has no coordinates '{name}'; its first were taken",
        )  # fmt: skip
    return (uv_names.index(name) if name in uv_names else 0), scale, offset, rotation


def _chained(moves: Sequence[Move]) -> tuple[Move, bool]:
    """Several moves of coordinates as one, and whether they are more than it.  moves: the last that is done first."""
    if len(moves) < 2:
        return (moves[0] if moves else STILL), False
    linear, shift = np.eye(2), np.zeros(2)
    for scale, offset, rotation in moves:
        s, c = math.sin(rotation), math.cos(rotation)
        shift = shift + linear @ np.array(offset)
        linear = linear @ np.array([[c, -s], [s, c]]) * np.array(scale)
    length = math.hypot(linear[0, 0], linear[1, 0])
    across = float(linear[:, 0] @ linear[:, 1])
    second = float(np.linalg.det(linear)) / length if length else 0.0
    sheared = abs(across) > SQUARE * length * max(length, abs(second))
    turned = math.atan2(linear[1, 0], linear[0, 0])
    return ((length, second), (float(shift[0]), float(shift[1])), turned), sheared
