"""Seconds a robot, by the clock and of the processor, beside those of urdf-usd-converter and mujoco-usd-converter, in one run.

    python python/bench/converters_bench.py FOLDER... [--converters PYTHON] [--format URDF|MJCF] [--most 200] [--limit 60] [--each]

PYTHON: the interpreter of an environment that has the two converters (they bring a USD of their own, which usd-core cannot
stand beside).  Each file is converted in a process of its own on either side, with the libraries loaded; only files that
both convert are counted.  Without PYTHON the other side is left out.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

MODULES = {"URDF": "urdf_usd_converter", "MJCF": "mujoco_usd_converter"}


def ours(path: Path, folder: Path) -> None:
    import kinefab

    kinefab.export(path, folder / "robot.kinefab")


def theirs(path: Path, folder: Path) -> None:
    from importlib import import_module

    import_module(MODULES["MJCF" if path.suffix == ".xml" else "URDF"]).Converter().convert(
        str(path), str(folder / "out")
    )


def _timed(convert: Callable[[Path, Path], None], path: Path, connection: Any) -> None:
    with tempfile.TemporaryDirectory() as folder:
        start, spent = time.perf_counter(), time.process_time()
        convert(path, Path(folder))
        connection.send((time.perf_counter() - start, time.process_time() - spent))


def seconds(convert: Callable[[Path, Path], None], path: Path, limit: float) -> tuple[float, float] | None:
    """Of one file, by the clock and of the processor; None where it is not converted within the limit."""
    context = multiprocessing.get_context("fork" if sys.platform == "linux" else None)
    here, there = context.Pipe(duplex=False)
    process = context.Process(target=_timed, args=(convert, path, there))
    process.start()
    there.close()
    try:
        return here.recv() if here.poll(limit) else None
    except EOFError:
        return None
    finally:
        process.kill()
        process.join()


def other_side() -> None:
    """Run by the other interpreter: a file a line comes in, its seconds go out.  The first line loads the libraries."""
    sys.stderr = open("/dev/null", "w")  # noqa: SIM115
    for word in sys.stdin:
        path, _, limit = word.strip().rpartition(" ")
        if path in MODULES.values():
            __import__(path)
        else:
            print("seconds", json.dumps(seconds(theirs, Path(path), float(limit))), flush=True)


def main() -> None:
    if sys.argv[1:] == ["--other-side"]:
        other_side()
        return
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folders", nargs="+", type=Path)
    parser.add_argument("--converters", metavar="PYTHON")
    parser.add_argument("--format", choices=[*MODULES], default="URDF")
    parser.add_argument("--most", type=int, default=200, help="files, spread evenly over those found")
    parser.add_argument("--limit", type=float, default=60.0, help="seconds a file may take")
    parser.add_argument("--each", action="store_true", help="print the seconds of each file too")
    arguments = parser.parse_args()
    from kinefab.sources import format_of

    found = [p for folder in arguments.folders for p in sorted(folder.rglob("*")) if p.is_file()]
    files = [
        p
        for p in found
        if p.suffix in (".urdf", ".xml") and (f := format_of(p)) is not None and f.name == arguments.format
    ]
    files = files[:: max(1, -(-len(files) // arguments.most))]
    with tempfile.TemporaryDirectory() as folder:  # so that no robot pays for what is loaded only once
        for path in files[:3]:
            try:
                ours(path, Path(folder))
            except Exception:
                continue
    other = None
    if arguments.converters:
        command = [arguments.converters, __file__, "--other-side"]
        other = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        print(f"{MODULES[arguments.format]} 0", file=other.stdin, flush=True)
    both: list[tuple[Sequence[float], ...]] = []
    for path in files:
        measured = [seconds(ours, path, arguments.limit)]
        if other is not None:
            assert other.stdin is not None and other.stdout is not None
            print(f"{path} {arguments.limit}", file=other.stdin, flush=True)
            line = ""
            while not line.startswith("seconds "):  # the converters speak on the same stream
                line = other.stdout.readline()
            measured.append(json.loads(line.removeprefix("seconds ")))
        if arguments.each:
            print(path, *(v and f"{v[0]:.2f} {v[1]:.2f}" for v in measured))
        if None not in measured:
            both.append(tuple(v for v in measured if v is not None))
    if other is not None:
        other.kill()
    print(f"{arguments.format}: {len(files)} files, {len(both)} converted" + (" by both" if other else ""))
    for number, measure in enumerate(("by the clock", "of the processor")):
        for name, column in zip(("kinefab", MODULES[arguments.format]), zip(*both)):
            taken = [pair[number] for pair in column]
            values = [f(taken) for f in (statistics.mean, statistics.median, max)]
            print(
                f"  {name:22} mean {values[0]:.3f} s, median {values[1]:.3f} s, worst {values[2]:.3f} s {measure}"
            )


if __name__ == "__main__":
    main()
