"""Converts every robot in some folders, each in a process of its own, and scores what came out.

    python python/bench/corpus.py FOLDER... [--json out.json] [--format URDF] [--package-path DIR] [--limit 60]
                                            [--configurations 50] [--without-meshes]

Scored against the engine that owns the format, where it is installed (``engines/``): poses of every body at random
configurations inside the limits, moved by the forward kinematics of the tests from the scene file alone; mass, centre of
mass and inertia; limits; mobility as ``dotnet-kinefab`` counts it, where that is on the PATH, and no finding of its
``validate --strict``.  seconds are those of the export alone, with the libraries loaded.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import os
import statistics
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[2] / "tests" / "python")]

import kinefab  # noqa: E402
from engines import Refused  # noqa: E402
from kinefab.diagnostics import Report  # noqa: E402
from kinefab.model import ColliderKind, Scene  # noqa: E402
from kinefab.sources import format_of, read  # noqa: E402
from scoring import scored  # noqa: E402

ENGINES = ("urdf", "sdf", "mjcf", "usd")
"""Modules of ``engines``; one that is not there yet, or whose library is not installed, judges nothing."""
NOT_ROBOTS = ("CAD bundle", "CAD bundle as tagged CSV", "CSV of Braun et al. (2020)")


LEVER = Path(__file__).parents[2] / "fixtures" / "lever" / "lever.bundle.json"


def engine_modules() -> dict[str, ModuleType]:
    """By the name of the format."""
    found = {}
    for name in ENGINES:
        if (Path(__file__).parent / "engines" / f"{name}.py").exists():
            module = import_module(f"engines.{name}")
            found |= {entry: module for entry in module.FORMATS}
    return found


def robots(folders: list[Path], wanted: str | None) -> Iterator[tuple[Path, str]]:
    """Files that a reader knows, with the name of their format, in the order of their paths."""
    for folder in folders:
        for path in sorted(folder.rglob("*")) if folder.is_dir() else [folder]:
            if path.is_file() and (found := format_of(path)) is not None and found.name not in NOT_ROBOTS:
                if wanted in (None, found.name):
                    yield path, found.name


def converted(path: Path, format_name: str, arguments: argparse.Namespace) -> dict[str, Any]:
    """One file: how it went, and what was measured of it."""
    found: dict[str, Any] = {"file": str(path), "format": format_name}
    module = engine_modules().get(format_name)
    engine = None
    if module is not None:
        try:
            engine = module.load(path, tuple(arguments.package_path))
            found["engine"] = "loads"
        except Refused as error:
            found |= {"engine": "refuses", "why": str(error)[:300]}
        except ImportError:
            found["engine"] = "not installed"
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "robot.kinefab"
        options = {"package_path": [str(p) for p in arguments.package_path]} if arguments.package_path else {}
        start = time.perf_counter()
        try:
            report = Report()
            scene = read(path, report, options=options)
            if arguments.without_meshes:
                _strip(scene)
            result = kinefab.export(scene, target)
        except kinefab.KinefabError as error:
            codes = sorted({d.code for d in error.diagnostics})
            return found | {"outcome": "refused", "codes": codes, "message": str(error)[:500]}
        found |= {"outcome": "converted", "seconds": time.perf_counter() - start}
        outcomes = [
            o for o in [*report.outcomes, *result.report.outcomes] if o.code and o.outcome.value != "kept"
        ]
        found["losses"] = dict(Counter(f"{o.outcome.value} {o.code}" for o in outcomes))
        told = {o.feature for o in outcomes} | {d.code for d in result.report.diagnostics}
        return found | scored(target, engine, arguments.configurations, told)


def _strip(scene: Scene) -> None:
    """Leave out what needs a mesh file, or a mesh."""
    files = (ColliderKind.HULL, ColliderKind.MESH)
    for i, node in enumerate(scene.nodes):
        kept = tuple(c for c in node.colliders or () if c.kind not in files)
        scene.nodes[i] = replace(node, bodies=(), colliders=kept)


def _child(connection: Any, path: Path, format_name: str, arguments: argparse.Namespace) -> None:
    os.setpgrp()
    try:
        connection.send(converted(path, format_name, arguments))
    except BaseException:
        connection.send(
            {"file": str(path), "format": format_name, "outcome": "crashed", "why": traceback.format_exc()}
        )


def in_a_process(path: Path, format_name: str, arguments: argparse.Namespace) -> dict[str, Any]:
    """``converted`` in a process of its own, so that no file can take the others with it."""
    context = multiprocessing.get_context("fork" if sys.platform == "linux" else None)
    ours, theirs = context.Pipe(duplex=False)
    process = context.Process(target=_child, args=(theirs, path, format_name, arguments))
    process.start()
    theirs.close()
    found: dict[str, Any] = {"file": str(path), "format": format_name, "outcome": "crashed"}
    try:
        found = (
            ours.recv() if ours.poll(arguments.limit) else found | {"why": f"more than {arguments.limit} s"}
        )
    except EOFError:
        process.join()
        found["why"] = f"died, exit code {process.exitcode}"
    process.kill()
    process.join()
    return found


def _alike(here: float, engine: float) -> bool:
    return abs(here - engine) <= 1e-6 * max(engine, 1e-9)


def summary(results: list[dict[str, Any]]) -> dict[str, Any]:
    """The scores of one format."""
    done = [r for r in results if r["outcome"] == "converted"]
    loaded = [r for r in results if r.get("engine") == "loads"]
    seconds = [r["seconds"] for r in done]
    losses: Counter[str] = Counter()
    for r in done:
        losses.update(r["losses"])
    fk = [r["fk"] for r in done if "fk" in r]
    mass = [r["mass_error"] for r in done if "mass_error" in r]
    counted = [r for r in done if r.get("mobility_right") is not None]
    return {
        "found": len(results),
        "converted": len(done),
        "refused": dict(Counter(code for r in results if r["outcome"] == "refused" for code in r["codes"])),
        "crashed": sum(r["outcome"] == "crashed" for r in results),
        "engine loads": len(loaded),
        "of these converted": sum(r["outcome"] == "converted" for r in loaded),
        "seconds mean / median / worst": [
            round(f(seconds), 4) if seconds else None for f in (statistics.mean, statistics.median, max)
        ],
        "joints / loops / couplings": [
            sum(r.get(k, 0) for r in done) for k in ("joints", "loops", "couplings")
        ],
        "valid strictly": f"{sum(r.get('valid') is True for r in done)} of {sum('valid' in r for r in done)}",
        "mobility right": f"{sum(r['mobility_right'] for r in counted)} of {len(counted)}",
        "fk compared": len(fk),
        "fk worst m / rad": [max((f[i] for f in fk), default=None) for i in (0, 1)],
        "fk right": f"{sum(r['fk_right'] for r in done if 'fk' in r)} of {len(fk)}",
        "limits right": f"{sum(r['limits_wrong'] == [] for r in done if 'limits_wrong' in r)} of {len(fk)}",
        "mass worst (relative)": max(mass, default=None),
        "mass right": f"{sum(m <= 1e-6 for m in mass)} of {len(mass)}",
        "total mass right": f"{sum(_alike(*r['total_mass']) for r in done if 'total_mass' in r)} of {len(mass)}",
        "pairs that do not collide": sum(r.get("pairs", 0) for r in done),
        "pairs right": f"{sum(r['pairs_right'] for r in done if 'pairs' in r)} of {sum('pairs' in r for r in done)}",
        "approximated or dropped": dict(losses.most_common()),
    }


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folders", nargs="+", type=Path)
    parser.add_argument("--json", type=Path)
    parser.add_argument("--format", help="only this one, by Kinefab's name of it")
    parser.add_argument("--package-path", action="append", type=Path, default=[])
    parser.add_argument("--limit", type=float, default=120.0, help="seconds a file may take")
    parser.add_argument("--configurations", type=int, default=50)
    parser.add_argument("--without-meshes", action="store_true", help="mechanism, mass and joints only")
    arguments = parser.parse_args()
    engine_modules()
    with tempfile.TemporaryDirectory() as folder:  # so that no robot pays for what is loaded only once
        kinefab.export(LEVER, Path(folder) / "lever.kinefab")
    results = []
    for path, format_name in robots(arguments.folders, arguments.format):
        found = in_a_process(path, format_name, arguments)
        results.append(found)
        wrong = found["outcome"] == "crashed" or found.get("wrong")
        if wrong or (found["outcome"] == "refused" and found.get("engine") == "loads"):
            print(
                f"{found['outcome']}: {path}: {found.get('wrong') or found.get('why') or found.get('message')}",
                flush=True,
            )
    by_format = {
        name: [r for r in results if r["format"] == name] for name in sorted({r["format"] for r in results})
    }
    scores = {name: summary(entries) for name, entries in by_format.items()}
    for name, score in scores.items():
        print(f"\n{name}")
        for key, value in score.items():
            print(f"  {key:30} {value}")
    if arguments.json:
        document = {"scores": scores, "files": results}
        arguments.json.write_text(json.dumps(document, indent=1, default=str) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
