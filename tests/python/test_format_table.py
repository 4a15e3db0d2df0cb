"""The table of what version 1.1 of the scene format adds is what its schema says."""

from __future__ import annotations

import json
import re
from pathlib import Path

SCHEMAS = Path(__file__).resolve().parents[2] / "schemas"
SINCE = "1.1"


def added() -> dict[str, set[str]]:
    """By the names of definitions, the fields that are new; of one that is new itself, all."""
    schema = json.loads((SCHEMAS / "scene.schema.json").read_text(encoding="utf-8"))
    found: dict[str, set[str]] = {}
    for name, own in {"the scene": schema, **schema["$defs"]}.items():
        if own.get("since") == SINCE:
            found[name] = {"all"}
        elif fields := {key for key, value in own.get("properties", {}).items() if value.get("since") == SINCE}:
            found[name] = fields
    return found


def test_the_table_says_what_the_schema_does():
    text = (SCHEMAS / "SPEC.md").read_text(encoding="utf-8")
    section = text.partition("### What version 1.1 adds\n")[2].partition("\n### ")[0]
    told: dict[str, set[str]] = {}
    for objects, fields in re.findall(r"^\| (?!object)([^|-][^|]*) \| ([^|]+) \|$", section, re.MULTILINE):
        fields = fields.replace("`uv2` to `uv8`", ", ".join(f"`uv{i}`" for i in range(2, 9)))
        for name in objects.split(", "):
            told[name.strip("`")] = {field.strip("`") for field in fields.split(", ")}
    new = added()
    within = {"image", "texture", "physicsMaterial", "couplingTerm", "ignoredCollision", "statedAxes", "statedAxis"}  # of fields that are new
    assert within <= new.keys() and told == {name: fields for name, fields in new.items() if name not in within}
