"""The table of pairs and mechanisms: expected and found, run with ``python python/bench/mechanism_table.py``."""

from __future__ import annotations

import csv
import sys
import time
from pathlib import Path

from kinefab.analysis import analyse
from kinefab.diagnostics import Report
from kinefab.sources import read

ROOT = Path(__file__).resolve().parents[2]
COLUMNS = ("rows", "rank", "first_order", "redundant", "finite")


def main() -> int:
    print(f"{'case':4}  {'rows/rank/M/red/finite M':26}{'found':24}{'ms':>6}  joints")
    wrong = 0
    with open(ROOT / "tests/python/data/mechanisms/mobility.csv", encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            folder = "pairs" if row["id"][0] == "P" else "mechanisms"
            scene = read(ROOT / "fixtures" / folder / f"{row['id']}.bundle.json", Report())
            begin = time.perf_counter()
            found = analyse(scene)
            spent = 1e3 * (time.perf_counter() - begin)
            expected = tuple(int(row[c]) for c in COLUMNS)
            got = (found.rows, found.rank, found.first_order, found.redundant, found.mobility)
            wrong += got != expected
            kinds = [j.kind.value + ("*" if j.closure else "") for j in found.joints]
            counts = ", ".join(f"{kinds.count(k)} {k}" for k in dict.fromkeys(kinds)) or "fixed"
            texts = ["/".join(map(str, values)) for values in (expected, got)]
            print(f"{row['id']:4}  {texts[0]:26}{texts[1]:24}{spent:6.0f}  {counts}")
    print(f"{wrong} of the cases differ (* closes a loop)")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
