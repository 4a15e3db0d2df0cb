"""Exports every mechanism of ``fixtures`` twice, as a scene and as a prefab: ``python tests/python/prefabs.py FOLDER KIND``.

What the Unity package makes of the scene must be what stands in the prefab; the C# tests compare them, object by object.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

import kinefab
from golden import FIXTURES, golden_pairs
from kinefab.sources import format_of
from prefab_scenes import rich_scene

SETTINGS = {
    "body": kinefab.ExportOptions(),
    "world": kinefab.ExportOptions(ground="world", closures="minimal", colliders="box"),
}
MORE = sorted(
    path
    for path in (
        *(FIXTURES / "lever").glob("lever*.*"),
        *(FIXTURES / "lever" / name for name in ("simscape/lever.xml", "gallery/assembly.json", "onshape/definition.json")),
        *(FIXTURES / "freecad").glob("*.FCStd"),
        *(FIXTURES / "freecad").glob("*.asmt"),
        *(FIXTURES / "mjcf").glob("*.xml"),
        *(FIXTURES / "twins").glob("*.*"),
    )
    if not path.name.endswith(".kinefab") and format_of(path) is not None
)
"""The lever, an arm and a four-bar by other roads: robots' trees, names and drives; FreeCAD's documents and its solver's assemblies."""
CLIPS = FIXTURES.parent / "tests" / "conformance" / "valid" / "animation"
"""Scenes, which are sources too."""
LINKS = kinefab.ExportOptions(writing={"physics": "articulation"})
PIPELINES = ("builtin", "urp", "hdrp")
LAYERS = ("Default", "TransparentFX", "Ignore Raycast", "", "Water", "UI", "", "", "Scenery")
"""Of the project that exports with looks stand in; its one tag is Ground."""
LOOKS = CLIPS.parent / "look" / "textured.kinefab"


def looks(folder: Path) -> dict[str, object]:
    """Sources with looks of every kind; where Pillow is not installed without the maps that it packs."""
    scene = rich_scene(folder)
    if find_spec("PIL") is not None:
        return {"Rich": scene, "textured": LOOKS}
    plain = {"metallic_roughness_texture": None, "occlusion_texture": None}
    return {"Rich": replace(scene, surfaces=[replace(surface, **plain) for surface in scene.surfaces])}


def make_project(folder: Path) -> Path:
    """The Assets of a project with layers and tags of its own."""
    lines = ["%YAML 1.1", "TagManager:", "  tags:", "  - Ground", "  layers:", *(f"  - {word}" for word in LAYERS)]
    settings = folder / "ProjectSettings" / "TagManager.asset"
    settings.parent.mkdir(parents=True)
    settings.write_text("\n".join(lines) + "\n", "utf-8")
    return folder / "Assets"


def main(folder: Path, kind: str) -> int:
    sources: dict[str, object] = {source.name.partition(".")[0]: source for source, _ in golden_pairs()}
    options, writing = SETTINGS.get(kind, SETTINGS["body"]), {"scripts": True}
    if kind == "links":
        options = LINKS
        sources["lever urdf"] = FIXTURES / "lever/lever.urdf"
    elif kind == "asked":  # the scene by joints, of which the import makes links
        writing |= LINKS.writing
        sources |= {f"{path.parent.name} {path.name}": path for path in MORE}
        options = kinefab.ExportOptions(colliders="box")  # else hulls here, and there the meshes that Unity makes hulls of
    elif kind == "clips":
        sources = {scene.stem: scene for scene in sorted(CLIPS.glob("*.kinefab"))}
    elif kind in PIPELINES:
        sources, writing = looks(folder), {"pipeline": kind, "scripts": True}
        folder = make_project(folder)
    elif kind == "body":
        sources |= {f"{path.parent.name} {path.name}": path for path in MORE}
    for stem, source in sources.items():
        stem = stem.replace("/", " ")
        target = folder / stem
        target.mkdir(parents=True, exist_ok=True)
        try:
            kinefab.export(source, target / f"{stem}.kinefab", replace(options))
            kinefab.export(source, target / f"{stem}.prefab", replace(options, writing={**options.writing, **writing}))
        except kinefab.KinefabError as fault:
            print(f"{stem} {kind}: {fault}", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), sys.argv[2]))
