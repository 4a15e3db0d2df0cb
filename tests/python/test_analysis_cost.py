"""Work that must not grow as the square of a mechanism is counted, since a clock decides no test."""

from __future__ import annotations

import gc
import math
from collections.abc import Iterator
from dataclasses import replace

import kinefab
import numpy as np
import pytest
from kinefab.analysis import analyse
from kinefab.analysis.assembly.assemble import assemble
from kinefab.analysis.findings import still
from kinefab.analysis.freedom import motion
from kinefab.analysis.freedom.probes import kept_of
from kinefab.spatial import Pose
from linkages import ring


def pins(count: int) -> list[np.ndarray]:
    turns = np.linspace(0.0, math.tau, count, endpoint=False)
    return [np.array([math.cos(t), 0.7 * math.sin(t), 0.0]) for t in turns]


def platform() -> tuple[kinefab.Scene, int, int]:
    """The base and the top of one, with no legs yet."""
    source = kinefab.Scene()
    return source, source.add_part("base", grounded=True), source.add_part("top", mass=3.0, translation=(0, 1, 0))


def legs() -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Foot and head of each of its six, all turned alike: the platform is singular."""
    for i in range(6):
        turns = np.array([math.tau * i / 6, math.tau * i / 6 + 0.5])
        foot, head = (np.array([r * math.cos(t), h, r * math.sin(t)]) for r, h, t in zip((1, 0.6), (0, 1), turns))
        yield foot, head


def move_joints_apart(source: kinefab.Scene, noise: float) -> None:
    draw = np.random.default_rng(1)
    source.joints[:] = [
        replace(j, frame_a=Pose(j.frame_a.rotation, j.frame_a.translation + noise * draw.standard_normal(3)))
        for j in source.joints
    ]


@pytest.mark.parametrize("count", [40, 160])
def test_a_ring_of_hinges_compares_those_alone_that_may_share_an_axis(monkeypatch, count):
    """No decomposition for each pair of hinges: their number in a ring is in proportion to the hinges."""
    calls = 0
    plain = np.linalg.svd

    def counted(*args, **more):
        nonlocal calls
        calls += 1
        return plain(*args, **more)

    monkeypatch.setattr(np.linalg, "svd", counted)
    found = analyse(ring(pins(count), [f"bar{i}" for i in range(count)]))
    assert found.mobility == count - 3 and found.idle == []
    assert calls < 2 * count


def test_bars_on_one_axis_in_a_ring_are_idle_together_as_before():
    """Three hinges on one line and four others: what turns between the three moves nothing else."""
    places = [(0, 0), (0, 0), (0, 0), (1, 0.2), (1.4, 1), (0.6, 1.5), (-0.3, 1.1)]
    found = analyse(ring([np.array([x, y, 0.0]) for x, y in places], [f"bar{i}" for i in range(7)]))
    told = [([found.source.nodes[n].id for n in idle.nodes], idle.count) for idle in found.idle]
    assert told == [(["bar1"], 1), (["bar2"], 1)]


@pytest.mark.parametrize("count", [40, 160])
def test_a_ring_takes_no_decomposition_as_large_as_itself(monkeypatch, count):
    """Whose time would grow as its cube: each has one side that is that of a body or a joint."""
    sides: list[int] = []
    for name in ("svd", "qr", "eigh", "inv", "solve", "cholesky"):
        plain = getattr(np.linalg, name)

        def noted(matrix, *args, plain=plain, **more):
            sides.append(min(np.shape(matrix)[-2:]))
            return plain(matrix, *args, **more)

        monkeypatch.setattr(np.linalg, name, noted)
    found = analyse(ring(pins(count), [f"bar{i}" for i in range(count)]))
    assert [f.dof for f in found.freedoms] == [0, 1, 2, *[3] * (count - 5), 2, 1]
    assert found.mobility == count - 3 and max(sides) <= 12


def test_the_collector_runs_again_after_an_analysis_that_fails():
    """It is paused meanwhile."""
    with pytest.raises(AttributeError):
        analyse(None)
    assert gc.isenabled()


def test_what_holds_a_singular_mechanism_is_looked_for_a_few_times_only(monkeypatch):
    """A platform on six legs, each a slide between two universal joints, whose frames miss each other by a CAD program's rounding:
    nothing moves, and without any of its joints all that is left has to be searched for motions.  The first few are named."""
    source, base, top = platform()
    for i, (foot, head) in enumerate(legs()):
        along = (head - foot) / np.linalg.norm(head - foot)
        across = np.cross(along, [0, 1, 0]) / np.linalg.norm(np.cross(along, [0, 1, 0]))
        third = np.cross(along, across)
        low = source.add_part(f"low{i}", mass=1.0, translation=tuple(foot + 0.2 * along))
        high = source.add_part(f"high{i}", mass=1.0, translation=tuple(head - 0.2 * along))
        for kind, a, b, point, axis, second in (
            ("universal", base, low, foot, across, third),
            ("prismatic", low, high, foot, along, across),
            ("universal", high, top, head, across, third),
        ):
            source.add_joint(kind, a, b, point=tuple(point), axis=tuple(axis), secondary=tuple(second))
    move_joints_apart(source, 1e-6)
    assembled = []
    monkeypatch.setattr(still, "assemble", lambda *given: assembled.append(given) or assemble(*given))
    found = analyse(source)
    assert found.mobility == 0
    (told,) = (d for d in found.report.diagnostics if d.code == "NOTHING_MOVES")
    assert "without any one of universal:1 (universal)" in told.message
    assert 2 <= len(assembled) < len(source.joints) / 2


@pytest.mark.parametrize("noise", [0.0, 1e-9])
def test_noise_makes_a_singular_platform_no_dearer_to_search(monkeypatch, noise):
    """A platform on six rods between balls, singular all along: in a small trial step noise hides what obstructs a velocity, and
    then each of the rods' spins was followed for itself, at ten times the cost."""
    source, base, top = platform()
    for i, (foot, head) in enumerate(legs()):
        rod = source.add_part(f"rod{i}", mass=1.0, translation=tuple(0.8 * foot + 0.2 * head))
        source.add_ball(base, rod, point=tuple(foot))
        source.add_ball(rod, top, point=tuple(head))
    move_joints_apart(source, noise)
    tried = []
    monkeypatch.setattr(motion, "kept_of", lambda *given: tried.append(given) or kept_of(*given))
    assert analyse(source).mobility == 7
    assert len(tried) <= 6
