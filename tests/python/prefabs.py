"""Exports every mechanism of ``fixtures`` twice, as a scene and as a prefab: ``python tests/python/prefabs.py FOLDER``.

What the Unity package makes of the scene must be what stands in the prefab; the C# tests compare them, object by object.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import kinefab
from golden import FIXTURES, golden_pairs

SETTINGS = {
    "body": kinefab.ExportOptions(),
    "world": kinefab.ExportOptions(ground="world", closures="minimal", colliders="box"),
}
MORE = ("lever/lever.urdf", "lever/lever.xml", "lever/lever.sdf", "lever/lever.FCStd", "lever/lever.usda")
"""The lever by other roads: robots' trees, names and drives."""
CLIPS = FIXTURES.parent / "tests" / "conformance" / "valid" / "animation"
"""Scenes, which are sources too."""
LINKS = kinefab.ExportOptions(writing={"physics": "articulation"})


def main(folder: Path) -> int:
    sources = [bundle for bundle, _ in golden_pairs()]
    jobs = [(source, name, options) for source in sources for name, options in SETTINGS.items()]
    jobs += [(FIXTURES / path, path.rpartition(".")[2], SETTINGS["body"]) for path in MORE]
    jobs += [(source, "links", LINKS) for source in [*sources, FIXTURES / "lever/lever.urdf"]]
    jobs += [(scene, "clips", SETTINGS["body"]) for scene in sorted(CLIPS.glob("*.kinefab"))]
    for source, kind, options in jobs:
        stem = source.name.partition(".")[0]
        target = folder / f"{stem} {kind}"
        target.mkdir(parents=True, exist_ok=True)
        try:
            for ending in (".kinefab", ".prefab"):
                kinefab.export(source, target / f"{stem}{ending}", replace(options))
        except kinefab.KinefabError as fault:
            print(f"{source.name} {kind}: {fault}", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
