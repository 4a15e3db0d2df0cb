"""How well mates are found: precision and recall over machines whose mates are known, and the time of a large assembly.

    python python/bench/mates_bench.py [--variants N] [--seed N] [--only NAME ...] [--parts N] [--verbose]

Each machine of ``fixtures/step/catalogue.py`` is written as STEP, read, its mates found, and the joints of the analysis are
held against those it was built with: kind, pair of bodies, axis within 1e-6 m and 1e-6 rad; what is one body; mobility.
A variant has another clearance, size, place, unit, order of parts and names without meaning.

``--parts 2000`` instead measures a production line (``fixtures/step/line.py``) of an eighth, a quarter, half and all of so
many parts: seconds of processor for reading it and for finding its mates, and how they grow.
"""

from __future__ import annotations

import argparse
import math
import os
import random
import sys
import tempfile
import time
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "fixtures"), str(ROOT / "python" / "src")]

from kinefab.analysis import AnalysisOptions, analyse  # noqa: E402
from kinefab.diagnostics import Report  # noqa: E402
from kinefab.mates.apply import with_found  # noqa: E402
from kinefab.mates.find import find_mates  # noqa: E402
from kinefab.model import ConstraintKind, Scene  # noqa: E402
from kinefab.options import Closures  # noqa: E402
from kinefab.sources import read  # noqa: E402
from kinefab.sources.guard import end_idle  # noqa: E402
from step.catalogue import MACHINES  # noqa: E402
from step.line import line  # noqa: E402
from step.machine import Machine, Truth  # noqa: E402
from step.solids import scaled  # noqa: E402
from step.writer import write_step  # noqa: E402

LENGTH, ANGLE = 1e-6, 1e-6
"""Metres and radians by which an axis may be off."""
TO_SCENE = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
"""Z up becomes +Y: what the reader does."""
CLEARANCES = (0.01, 0.2)


@dataclass
class Score:
    """hits, missed, wrong: joints and fixings.  locks: where a freedom that is there was lost."""

    hits: int = 0
    missed: int = 0
    wrong: int = 0
    machines: int = 0
    mobility: int = 0
    locks: list[str] = field(default_factory=list)

    def add(self, other: Score) -> None:
        self.hits += other.hits
        self.missed += other.missed
        self.wrong += other.wrong
        self.machines += other.machines
        self.mobility += other.mobility
        self.locks += other.locks

    @property
    def precision(self) -> float:
        return self.hits / max(self.hits + self.wrong, 1)

    @property
    def recall(self) -> float:
        return self.hits / max(self.hits + self.missed, 1)


@dataclass(frozen=True)
class Variant:
    """How a machine is written.  placement: of the whole, millimetres, (4, 4)."""

    clearance: float | None = None
    scale: float = 1.0
    placement: np.ndarray = field(default_factory=lambda: np.eye(4))
    unit: str = "MM"
    shuffle: random.Random | None = None


def written(name: str, variant: Variant, path: Path) -> Machine:
    """The machine as it was written, in millimetres where it stands."""
    make = MACHINES[name]
    machine = make() if variant.clearance is None else make(variant.clearance)
    names = {part.name: part.name for part in machine.parts}
    if variant.shuffle is not None:
        numbers = list(range(len(machine.parts)))
        variant.shuffle.shuffle(numbers)
        names = {part.name: f"P{number}" for part, number in zip(machine.parts, numbers, strict=True)}
        products: dict[str, str] = {}
        for part in machine.parts:
            products.setdefault(part.product, f"D{variant.shuffle.randrange(10**9)}")
        machine.parts = [
            replace(part, name=names[part.name], product=products[part.product]) for part in machine.parts
        ]
        variant.shuffle.shuffle(machine.parts)
    place, scale = variant.placement, variant.scale
    solids: dict[str, object] = {}
    for part in machine.parts:
        part.solid = solids.setdefault(part.product, scaled(part.solid, scale))
        part.pose[:3, 3] *= scale
        part.pose = place @ part.pose
    machine.joints = [
        Truth(
            joint.kind, names[joint.a], names[joint.b],
            tuple(place[:3, :3] @ np.array(joint.point) * scale + place[:3, 3]), tuple(place[:3, :3] @ np.array(joint.axis)),
        )
        for joint in machine.joints
    ]  # fmt: skip
    machine.fixed = [tuple(names[n] for n in group) for group in machine.fixed]
    machine.either = [
        (tuple(names[n] for n in parts), tuple(names[n] for n in others)) for parts, others in machine.either
    ]
    machine.ground = names[machine.ground]
    write_step(machine, path, unit=variant.unit)
    return machine


def score(machine: Machine, scene: Scene, verbose: bool = False) -> Score:
    """scene: as read, without mates."""
    report = Report()
    mates = find_mates(scene, ground=machine.ground)
    mated = with_found(scene, mates, report)
    options = AnalysisOptions(Closures.EXACT)
    mobility = analyse(mated, options).mobility
    # couplings may hang a wheel on its carrier instead of its base, on the same axis
    mated.constraints = [c for c in mated.constraints if c.kind is not ConstraintKind.GEAR]
    found = analyse(mated, options)
    index = {node.name: i for i, node in enumerate(scene.nodes)}
    names = [part.name for part in machine.parts]
    body = {name: found.groups.group_of[index[name]] for name in names}
    truth: dict[str, int] = {}
    for number, group in enumerate(
        [*machine.fixed, *([n] for n in names if not any(n in g for g in machine.fixed))]
    ):
        truth.update(dict.fromkeys(group, number))
    for parts, others in machine.either:
        for part in parts:
            truth[part] = next(
                (truth[other] for other in others if body[other] == body[part]), truth[others[0]]
            )
    result = Score(machines=1)
    for of, other in ((truth, body), (body, truth)):
        groups: dict[object, list[str]] = {}
        for name in names:
            groups.setdefault(of[name], []).append(name)
        for members in groups.values():
            pieces = len({other[name] for name in members})
            if of is truth:
                result.hits += len(members) - pieces
                result.missed += pieces - 1
                if pieces > 1 and verbose:
                    print("   not one body:", members)
            elif pieces > 1:
                result.wrong += pieces - 1
                result.locks.append(f"{machine.name}: {members} are one body")
    left = [joint for joint in found.joints]
    ground = next(i for i, still in enumerate(found.groups.grounded) if still)
    for joint in machine.joints:
        wanted = {body[joint.a], body[joint.b]}
        match = next(
            (
                j for j in left
                if {ground if n is None else found.groups.group_of[n] for n in (j.a, j.b)} == wanted and agrees(joint, j, mated)
            ),
            None,
        )  # fmt: skip
        if match is not None:
            left.remove(match)
            result.hits += 1
        else:
            result.missed += 1
            if verbose:
                print("   missed:", joint.kind, joint.a, joint.b)
    for joint in left:
        result.wrong += 1
        if verbose:
            print("   wrong:", joint.kind.value, mated.name(joint.a), mated.name(joint.b), joint.because)
    result.mobility += int(mobility == machine.mobility)
    if mobility < machine.mobility:
        result.locks.append(f"{machine.name}: mobility {mobility} instead of {machine.mobility}")
    elif mobility != machine.mobility and verbose:
        print(f"   mobility {mobility} instead of {machine.mobility}")
    return result


def agrees(truth: Truth, joint, scene: Scene) -> bool:
    if joint.kind.value != truth.kind:
        return False
    frame = scene.pose(joint.a) @ joint.frame_a
    x = frame.rotation[:, 0]
    point, axis = TO_SCENE @ np.array(truth.point) * 1e-3, TO_SCENE @ np.array(truth.axis)
    axis = axis / np.linalg.norm(axis)
    offset = frame.translation - point
    aligned = float(np.linalg.norm(np.cross(x, axis))) <= ANGLE
    if truth.kind in ("revolute", "cylindrical", "screw"):
        return aligned and float(np.linalg.norm(np.cross(offset, axis))) <= LENGTH
    if truth.kind == "spherical":
        return float(np.linalg.norm(offset)) <= LENGTH
    return aligned


def variants(count: int, seed: int) -> list[Variant]:
    """As drawn, then others."""
    source = random.Random(seed)
    found = [Variant()]
    for _ in range(count):
        place = np.eye(4)
        quaternion = np.array([source.gauss(0.0, 1.0) for _ in range(4)])
        x, y, z, w = quaternion / np.linalg.norm(quaternion)
        place[:3, :3] = [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
        place[:3, 3] = [source.uniform(-300.0, 300.0) for _ in range(3)]
        low, high = (math.log(c) for c in CLEARANCES)
        found.append(
            Variant(
                math.exp(source.uniform(low, high)), math.exp(source.uniform(math.log(0.3), math.log(8.0))), place,
                source.choice(["MM", "INCH", "M"]), random.Random(source.random()),
            )
        )  # fmt: skip
    return found


def large(parts: int) -> None:
    """Time and score of the line, and the exponents of its growth, by least squares of the logarithms."""
    rows: list[tuple[int, float, float]] = []
    with tempfile.TemporaryDirectory() as folder:
        for wanted in (parts // 8, parts // 4, parts // 2, parts):
            path = Path(folder) / "line.step"
            machine = line(wanted)
            write_step(machine, path)
            began, wall = processor(), time.perf_counter()
            scene = read(path, Report())
            end_idle()  # so that the child's seconds count
            middle, wall = processor(), time.perf_counter() - wall
            find_mates(scene, ground=machine.ground)
            end = processor()
            count, products = len(machine.parts), len({part.product for part in machine.parts})
            rows.append((count, middle - began, end - middle))
            own = score(machine, scene)
            print(
                f"{count:6} parts of {products:4} products  read {middle - began:5.1f} s (wall {wall:5.1f} s)  mates {end - middle:5.1f} s"
                f"  precision {own.precision:.3f}  recall {own.recall:.3f}  mobility {own.mobility}/{own.machines}",
                flush=True,
            )
    counts, reading, finding = (np.log(np.array(column)) for column in zip(*rows, strict=True))
    print(
        f"exponent         read {np.polyfit(counts, reading, 1)[0]:.2f}  mates {np.polyfit(counts, finding, 1)[0]:.2f}"
    )


def processor() -> float:
    """Seconds of this process and of the children that have ended."""
    return sum(os.times()[:4])


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--variants", type=int, default=2)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", nargs="*", default=())
    parser.add_argument("--verbose", action="store_true")
    parser.add_argument("--parts", type=int, default=0)
    asked = parser.parse_args()
    if asked.parts:
        large(asked.parts)
        return
    total, drawn = Score(), Score()
    began = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        for name in asked.only or MACHINES:
            own = Score()
            for number, variant in enumerate(variants(asked.variants, asked.seed)):
                path = Path(folder) / f"{name}.step"
                machine = written(name, variant, path)
                one = score(machine, read(path, Report()), asked.verbose)
                own.add(one)
                if not number:
                    drawn.add(one)
                if asked.verbose and (one.missed or one.wrong or not one.mobility):
                    print(
                        f"   ^ {name} variant {number}: clearance {variant.clearance}, scale {variant.scale:.3g}"
                    )
            total.add(own)
            print(
                f"{name:16} precision {own.precision:.3f}  recall {own.recall:.3f}  mobility {own.mobility}/{own.machines}",
                flush=True,
            )
    for label, which in (("as drawn", drawn), ("all", total)):
        print(
            f"{label:16} precision {which.precision:.3f}  recall {which.recall:.3f}  mobility {which.mobility}/{which.machines}"
        )
    for lock in total.locks:
        print("locked:", lock)
    print(f"{time.perf_counter() - began:.1f} s")


if __name__ == "__main__":
    main()
