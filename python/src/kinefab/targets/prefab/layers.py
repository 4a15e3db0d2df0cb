"""Layers and tags, whose lists are the project's: a prefab holds a layer by its number and a tag by its word."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from ...diagnostics import Report
from ...unity.scene import UnityScene

BUILT_IN: Mapping[str, int] = {"Default": 0, "TransparentFX": 1, "Ignore Raycast": 2, "Water": 4, "UI": 5}
"""Layers of every project, with their numbers."""
TAGS = frozenset({"Untagged", "Respawn", "Finish", "EditorOnly", "MainCamera", "Player", "GameController"})
"""Tags of every project."""
SETTINGS = "ProjectSettings/TagManager.asset"
"""From the folder above ``Assets``."""
MOST_BYTES = 1 << 20


@dataclass(frozen=True, slots=True)
class LayersAndTags:
    """layers: numbers by their words.  tags: every one that there is.  known: whether they are a project's, not only those of every one."""

    layers: Mapping[str, int] = field(default_factory=lambda: BUILT_IN)
    tags: frozenset[str] = TAGS
    known: bool = False

    def layer(self, word: str) -> int:
        """Its number, Default's where the project has none of that word."""
        return self.layers.get(word, 0)

    def tag(self, word: str) -> str:
        """Itself, so that whoever has the tag finds it; untagged where the project is known and has none of that word."""
        return word if word and (not self.known or word in self.tags) else "Untagged"

    def tell(self, scene: UnityScene, report: Report) -> None:
        """Tell each word that the project lacks, once with all that want it."""
        lacking: dict[tuple[str, str], list[str]] = {}
        for entry in scene.gameObjects:
            if entry.layer and entry.layer not in self.layers:
                lacking.setdefault(("layer", entry.layer), []).append(entry.id)
            if entry.tag and entry.tag not in self.tags:
                lacking.setdefault(("tag", entry.tag), []).append(entry.id)
        for (kind, word), owners in lacking.items():
            features = [f"{kind} {word} of {owner}" for owner in owners]
            told = {"kind": kind, "word": word, "count": len(owners), "object": owners[0]}
            if self.known:
                report.dropped_alike(features, "UNITY_LAYER_OR_TAG_MISSING", **told)
            elif kind == "layer":
                report.dropped_alike(features, "TARGET_LAYER_OF_PROJECT", **told)
            else:
                report.approximated_alike(features, "TARGET_TAG_OF_PROJECT", **told)


def layers_and_tags(project: Path | None) -> LayersAndTags:
    """Of a project, by the folder that holds its ``Assets``; those of every project where there is none or its list is not in text."""
    if project is None:
        return LayersAndTags()
    try:
        with open(project / SETTINGS, "rb") as file:
            lines = file.read(MOST_BYTES).decode("utf-8").splitlines()
    except (OSError, UnicodeDecodeError):
        return LayersAndTags()
    if not lines or not lines[0].startswith("%YAML"):
        return LayersAndTags()
    layers = {word: number for number, word in reversed(list(enumerate(_items(lines, "layers")))) if word}
    return LayersAndTags(layers, TAGS | frozenset(_items(lines, "tags")), known=True)


def _items(lines: list[str], name: str) -> list[str]:
    """The entries of a list of plain words, as Unity writes it: a dash for each, in one column with the list's name."""
    found: list[str] = []
    head = f"  {name}:"
    for line in lines[lines.index(head) + 1 :] if head in lines else ():
        if not line.startswith("  -"):
            break
        found.append(_scalar(line[3:].strip()))
    return found


def _scalar(written: str) -> str:
    if written.startswith("'") and written.endswith("'") and len(written) > 1:
        return written[1:-1].replace("''", "'")
    if written.startswith('"'):  # JSON's escapes, and those of one byte
        try:
            return str(json.loads(re.sub(r"\\x([0-9A-Fa-f]{2})", r"\\u00\1", written)))
        except ValueError:
            return written
    return written
