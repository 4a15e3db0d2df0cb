"""Captures from records, and their scenes against the scene of the bundle that the records were made of."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import jsonschema
import kinefab
from cad.documented import watch
from golden import differences, unnamed
from kinefab.capture.channel import question, record
from kinefab.capture.run import Captured, replay
from kinefab.diagnostics import Report, schema_directory

SCHEMA = json.loads((schema_directory() / "bundle.schema.json").read_text("utf-8"))


def capture(program: str, answers: Any, folder: Path, up: str = "", report: Report | None = None) -> Captured:
    """Capture from a record, by way of a file; the bundle is checked against its schema."""
    source = folder / f"{program}.record.json"
    source.write_text(json.dumps(record(program, answers)), "utf-8")
    found = replay(source, folder / f"{program}.bundle.json", Report() if report is None else report, up)
    jsonschema.Draft202012Validator(SCHEMA).validate(json.loads(found.path.read_text("utf-8")))
    return found


def scene(source: Path) -> dict[str, Any]:
    target = source.with_name(source.name + ".kinefab")
    kinefab.export(source, target)
    content = json.loads(unnamed(target.read_text("utf-8")))  # programs name parts as they like
    kept = ("gameObjects", "couplings", "kinefab", "version")
    return {key: content[key] for key in kept if key in content}


def scene_differences(values: dict[str, Any], path: Path, folder: Path, tolerance: float = 1e-6) -> list[str]:
    """Where the scene of a captured bundle is another than that of the bundle it was made of, number by number."""
    reference = folder / "reference.bundle.json"
    reference.write_text(json.dumps(values), "utf-8")
    return differences(scene(reference), scene(path), tolerance)


class Program:
    """Objects that answer as a record says, as a bridge to a program would hand them out: new ones with every call."""

    def __init__(self, answers: list[dict[str, Any]], own: int = 0) -> None:
        self.answers, self.own = answers, own

    def seen(self, value: Any) -> Any:
        if isinstance(value, list):
            return tuple(self.seen(entry) for entry in value)
        return Program(self.answers, value["object"]) if isinstance(value, dict) else value


def call(target: Program, name: str, arguments: tuple[Any, ...] | None) -> Any:
    watch(target.answers[target.own], name)
    return target.seen(target.answers[target.own][question(name, arguments)])
