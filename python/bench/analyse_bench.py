"""How long the analysis takes, and how it grows: run with ``python python/bench/analyse_bench.py``.

The large assembly is many small mechanisms (four-bars, slider-cranks, levers with locked parts) on their
own plates plus long open chains, written as constraints; the block is one ladder of hinged bars in which
every body is in loops with every other; the ring is one loop of hinges.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
import time

import numpy as np
from kinefab.analysis import analyse
from kinefab.model import Constraint, ConstraintKind, Feature, FeatureKind, Node, Scene
from kinefab.spatial import Pose, rotation_about

EZ = np.array([0.0, 0.0, 1.0])


class Assembly:
    """Nodes and constraints being added, in WORLD coordinates."""

    def __init__(self) -> None:
        self.nodes = [Node("base", "base", grounded=True)]
        self.constraints: list[Constraint] = []

    def part(self, pose: Pose) -> int:
        name = f"part:{len(self.nodes)}"
        self.nodes.append(Node(name, name, pose=pose))
        return len(self.nodes) - 1

    def _feature(self, node: int, kind: FeatureKind, point, direction) -> Feature:
        inverse = self.nodes[node].pose.inverse()
        return Feature(node, kind, inverse.point(point), inverse.direction(direction), radius=0.01)

    def add(self, kind: ConstraintKind, geometry: FeatureKind, a: int, b: int, point, direction) -> None:
        sides = tuple(self._feature(n, geometry, point, direction) for n in (a, b))
        self.constraints.append(Constraint(f"{kind.value}:{len(self.constraints)}", kind, sides))

    def hinge(self, a: int, b: int, pose: Pose, point) -> None:
        """Axis on axis and face on face, as a CAD user mates them: two constraints, seven rows."""
        at, along = pose.point(np.asarray(point, dtype=float)), pose.direction(EZ)
        self.add(ConstraintKind.CONCENTRIC, FeatureKind.CYLINDER, a, b, at, along)
        self.add(ConstraintKind.COINCIDENT, FeatureKind.PLANE, a, b, at, along)


def four_bar(assembly: Assembly, frame: Pose, base: int) -> None:
    """A crank-rocker of 0.4, 1.2, 0.8 and 1.0 with a panel screwed to its rocker."""
    pin = 0.4 * np.array([math.cos(1.0), math.sin(1.0), 0.0])
    along = np.array([1.0, 0.0, 0.0]) - pin
    d = float(np.linalg.norm(along))
    x = (d * d + 1.2**2 - 0.8**2) / (2 * d)
    y = math.sqrt(1.2**2 - x * x)
    end = pin + along / d * x + np.array([-along[1], along[0], 0.0]) / d * y
    crank, coupler, rocker, panel = (assembly.part(frame) for _ in range(4))
    assembly.hinge(base, crank, frame, (0, 0, 0))
    assembly.hinge(crank, coupler, frame, pin)
    assembly.hinge(coupler, rocker, frame, end)
    assembly.hinge(base, rocker, frame, (1, 0, 0))
    for point, normal in ((end, (1, 0, 0)), (end, (0, 1, 0)), (end, (0, 0, 1)), (pin, (0, 0, 1))):
        at, n = frame.point(np.array(point, dtype=float)), frame.direction(np.array(normal, dtype=float))
        assembly.add(ConstraintKind.COINCIDENT, FeatureKind.PLANE, rocker, panel, at, n)


def chain(assembly: Assembly, frame: Pose, base: int, links: int) -> None:
    last = base
    for i in range(links):
        body = assembly.part(Pose(frame.rotation, frame.point(np.array([i, 0.0, 0.0]))))
        tilt = Pose(
            frame.rotation @ rotation_about(np.array([1.0, 0.0, 0.0]), 0.7 * i),
            frame.point(np.array([i, 0.0, 0.0])),
        )
        assembly.hinge(last, body, tilt, (0, 0, 0))
        last = body


def large(parts: int) -> Scene:
    """Half of the parts in four-bars, half in chains of at most 200 links."""
    assembly = Assembly()
    draw = np.random.default_rng(1)
    while len(assembly.nodes) <= parts // 2:
        axis = draw.standard_normal(3)
        frame = Pose(
            rotation_about(axis / np.linalg.norm(axis), float(draw.uniform(0, 6))), draw.uniform(-20, 20, 3)
        )
        four_bar(assembly, frame, 0)
    while len(assembly.nodes) < parts + 1:
        links = min(200, parts + 1 - len(assembly.nodes))
        chain(assembly, Pose(np.eye(3), draw.uniform(-20, 20, 3)), 0, links)
    return Scene(nodes=assembly.nodes, constraints=assembly.constraints)


def block(bodies: int) -> Scene:
    """Cranks side by side, each joined to the next by a rod; ``bodies`` (odd) of them, all in one block."""
    assembly = Assembly()
    count = bodies // 2
    frame = Pose()
    tip = np.array([math.cos(1.1), math.sin(1.1), 0.0])
    cranks = [assembly.part(Pose(np.eye(3), np.array([i, 0.0, 0.0]))) for i in range(count + 1)]
    for i, crank in enumerate(cranks):
        assembly.hinge(0, crank, frame, (i, 0, 0))
    for i in range(count):
        rod = assembly.part(Pose(np.eye(3), tip + [i, 0.0, 0.0]))
        assembly.hinge(cranks[i], rod, frame, tip + [i, 0, 0])
        assembly.hinge(rod, cranks[i + 1], frame, tip + [i + 1, 0, 0])
    return Scene(nodes=assembly.nodes, constraints=assembly.constraints)


def ring(hinges: int) -> Scene:
    """Bars end to end along a circle, the first one on the ground."""
    assembly = Assembly()
    bars = [0, *(assembly.part(Pose()) for _ in range(hinges - 1))]
    for i, turn in enumerate(np.linspace(0.0, math.tau, hinges, endpoint=False)):
        assembly.hinge(bars[i], bars[(i + 1) % hinges], Pose(), (math.cos(turn), math.sin(turn), 0.0))
    return Scene(nodes=assembly.nodes, constraints=assembly.constraints)


def measure(name: str, scene: Scene) -> dict[str, object]:
    begin, busy = time.perf_counter(), time.process_time()
    found = analyse(scene)
    listed = sum(f.dof for f in found.freedoms)
    seconds, busy = time.perf_counter() - begin, time.process_time() - busy
    print(
        f"{name}: {len(scene.nodes) - 1} parts, {len(scene.constraints)} constraints, {seconds:.2f} s "
        f"({busy:.2f} s of processor), "
        f"mobility {found.mobility}, {found.redundant} redundant rows, {listed} freedoms listed",
        flush=True,
    )
    return {
        "name": name,
        "parts": len(scene.nodes) - 1,
        "constraints": len(scene.constraints),
        "seconds": round(seconds, 3),
        "processor": round(busy, 3),
        "mobility": found.mobility,
    }


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--json", action="store_true", help="print the figures as JSON on the last line")
    arguments.add_argument("--parts", type=int, default=10_000)
    options = arguments.parse_args()
    analyse(large(50))  # the first call imports and warms up
    rows = [measure("assembly", large(options.parts // 10)), measure("assembly", large(options.parts))]
    exponent = math.log(rows[1]["seconds"] / rows[0]["seconds"]) / math.log(
        rows[1]["parts"] / rows[0]["parts"]
    )
    rows.append(measure("one block", block(401)))
    rows.append(measure("M40", block(81)))
    print(f"growth exponent {exponent:.2f} from {rows[0]['parts']} to {rows[1]['parts']} parts")
    rings = [measure("ring", ring(hinges)) for hinges in (125, 500)]
    growth = math.log(rings[1]["processor"] / rings[0]["processor"]) / math.log(500 / 125)
    rows += rings
    print(f"growth exponent of a ring {growth:.2f} from 125 to 500 hinges, by seconds of processor")
    if options.json:
        print(json.dumps({"analyse": rows, "exponent": round(exponent, 3)}))
    return 0


if __name__ == "__main__":
    sys.exit(main())
