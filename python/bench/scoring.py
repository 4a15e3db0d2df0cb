"""A scene file held against the engine that owns its source: poses, limits, mass, mobility."""

from __future__ import annotations

import json
import math
import shutil
import subprocess
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from engines import Engine, Mass, Pose
from scene_kinematics import (
    LINEAR,
    Coordinate,
    SceneKinematics,
    difference,
    random_values,
    unity_inertia,
    unity_point,
    unity_pose,
)

TOOL = "dotnet-kinefab"
CLOSE = 1e-6
SLACK = 20.0
"""How far poses may be apart where the source's own bodies miss their joints, against the widest such gap."""
ALSO_SAID = {"JOINT_ANCHORS_APART": {"JOINT_POSE_GAP", "JOINT_OUTSIDE_LIMITS"}}
"""What the tool finds in a scene, by what the export found in its source."""


def scored(target: Path, engine: Engine | None, configurations: int, told: set[str]) -> dict[str, Any]:
    """What was counted and measured; ``wrong``: what of it is a defect, in words.

    told: features of the source that the report calls approximated or dropped ("joint elbow", "inertia hand"): their
    limits and inertias are not compared, everything else is.  It holds the codes of all findings too: a joint whose sides
    stand apart in the source is right where JOINT_POSE_GAP says so.
    """
    motion = SceneKinematics.load(target)
    found: dict[str, Any] = {
        "joints": len(motion.joints),
        "couplings": len(motion.document.get("couplings", ())),
    }
    wrong: list[str] = []
    if shutil.which(TOOL):
        found |= _tool(target, engine, told, wrong)
    if engine is not None:
        held = bool(found.get("mobility_right"))
        found |= compared(motion, engine, configurations, told, wrong, held)
    return found | {"wrong": wrong}


def _tool(target: Path, engine: Engine | None, told: set[str], wrong: list[str]) -> dict[str, Any]:
    checked = subprocess.run(
        [TOOL, "validate", str(target), "--strict", "--json"], capture_output=True, text=True, timeout=120
    )
    said = json.loads(checked.stdout)
    unsaid = [d for d in said["diagnostics"] if not told & ALSO_SAID.get(d["code"], set())]
    valid = bool(said["valid"]) and not unsaid
    if not valid:
        wrong.append(f"validate: {unsaid[:3]}")
    asked = subprocess.run(
        [TOOL, "mobility", str(target), "--json"], capture_output=True, text=True, timeout=120
    )
    answer = json.loads(asked.stdout)
    counted, findings = answer.get("mobility") or {}, answer.get("diagnostics", ())
    found = {
        "valid": valid,
        "mobility_findings": sorted({d["code"] for d in findings}),
        "mobility": counted.get("mobility"),
        "loops": sum(i.get("loops", 0) for i in counted.get("islands", ())),
    }
    # A coupling that the format cannot hold is told, and its mobility is one more.
    if engine is not None and engine.mobility is not None and "COUPLING_TERMS_DROPPED" not in told:
        found |= {
            "engine_mobility": engine.mobility,
            "mobility_right": counted.get("mobility") == engine.mobility,
        }
        if not found["mobility_right"]:
            wrong.append(f"mobility {counted.get('mobility')}, the engine's {engine.mobility}")
    return found


def compared(
    motion: SceneKinematics,
    engine: Engine,
    configurations: int,
    told: set[str],
    wrong: list[str],
    held: bool = False,
) -> dict[str, Any]:
    """Poses, limits and masses; what differs is added to ``wrong``.

    held: whether the mobility is the engine's, so that a joint without a coordinate is one that a loop holds.
    """
    chosen: dict[Coordinate, tuple[str, float, float, bool]] = {}
    ranges, limits_wrong = [], []
    for joint in engine.joints:
        axis = unity_point(joint.axis, engine.turn)
        read = motion.reading(joint.name, axis, joint.is_angle, joint.child)
        if read is None:
            if joint.lower < joint.upper and not held:
                wrong.append(f"joint {joint.name} has no coordinate in the scene")
            continue
        coordinate, sense = read
        unit = 180.0 / math.pi if joint.is_angle else engine.length
        ends = sorted(sense * unit * (end - joint.start) for end in (joint.lower, joint.upper))
        has = motion.range_of(coordinate)
        excused = any(
            f.startswith("joint ") and f[6:].rpartition("/")[2] == joint.name.rpartition("/")[2] for f in told
        )
        if not excused and any(a != b and abs(a - b) > CLOSE * max(1.0, abs(a)) for a, b in zip(ends, has)):
            limits_wrong.append(f"{joint.name}: {has}, the engine's {tuple(ends)}")
        chosen[coordinate] = (joint.key, sense * unit, joint.start, joint.is_angle)
        ranges.append(
            (coordinate, (max(ends[0], -720.0), min(ends[1], 720.0)) if joint.is_angle else tuple(ends))
        )
    generator = np.random.default_rng(14)
    worst = [0.0, 0.0]
    close = [CLOSE + SLACK * gap for gap in engine.slack]
    for number in range(configurations + 1):
        values = random_values(ranges, generator) if number else {}
        asked = {chosen[c][0]: v / chosen[c][1] + chosen[c][2] for c, v in values.items()}
        expected = engine.poses(asked)
        roots, kept = _carried(motion, expected, engine, told, worst)
        poses = motion.poses(motion.coupled(values), roots, kept)
        for name, (r, t) in expected.items():
            try:
                here = motion.pose_of(name, poses)
            except KeyError as error:
                wrong.append(str(error))
                continue
            for i, value in enumerate(difference(unity_pose(r, t, engine.turn, engine.length), here)):
                worst[i] = max(worst[i], value)
        if wrong:
            break
    if any(value > limit for value, limit in zip(worst, close)):
        wrong.append(f"poses differ by {worst[0]:.3g} m, {worst[1]:.3g} rad")
    if limits_wrong:
        wrong.append(f"limits: {limits_wrong[:3]}")
    right = not any(value > limit for value, limit in zip(worst, close))
    found = {"fk": worst, "fk_right": right, "limits_wrong": limits_wrong}
    return found | _masses(motion, engine, told, wrong) | _pairs(motion, engine, told, wrong)


def _carried(
    motion: SceneKinematics,
    expected: Mapping[str, Pose],
    engine: Engine,
    told: set[str],
    worst: list[float],
) -> tuple[dict[int, Any], dict[tuple[int, int], Any]]:
    """Where free bodies stand, and how components with slides and other freedoms, or three turns, do: they are plain
    enough to be counted from either side, so it is the engine's bodies that must keep what they hold."""
    unity = {}
    for name, (r, t) in expected.items():
        try:
            unity[motion.object(name)] = unity_pose(r, t, engine.turn, engine.length)
        except KeyError:
            continue  # told by the poses
    poses = [unity.get(i, placed) for i, placed in enumerate(motion.placed)]
    moving = set(motion.moving)
    held = {}
    for joint in motion.joints:
        names = [c.name for c in joint.coordinates]
        linear = [n for n in names if n in LINEAR]
        if len(names) < 2 or (not linear and len(names) < 3) or joint.game_object not in unity:
            continue
        if joint.connected in moving and joint.connected not in unity:
            continue
        held[joint.game_object, joint.index] = motion.c(joint, poses)
        apart = max(motion.gap(joint, motion.placed)) > CLOSE and "JOINT_POSE_GAP" in told
        if not joint.closure and not apart:
            for i, value in enumerate(motion.gap(joint, poses)):
                worst[i] = max(worst[i], value)
    return unity, held


def _masses(motion: SceneKinematics, engine: Engine, told: set[str], wrong: list[str]) -> dict[str, Any]:
    worst, where = 0.0, ""
    moving = set(motion.moving)
    together: dict[int, list[Mass]] = {}
    for name, mass in engine.masses().items():
        try:
            body = motion.body_of[motion.object(name)]
        except KeyError:
            continue  # told by the poses
        if body is not None and body in moving:
            together.setdefault(body, []).append(mass)
    helping: dict[str, list[int]] = {}  # light bodies between joints weigh a share of the one that they help
    for i, entry in enumerate(motion.objects):
        if helped := entry.get("extras", {}).get("helps"):
            helping.setdefault(helped, []).append(i)
    for body, parts in together.items():
        name = motion.objects[body]["name"]
        if not sum(part.mass for part in parts) > 0.0:
            continue  # the engine lets it move without mass; Unity does not
        if any(f"{what} {name}" in told for what in ("inertia", "mass")):
            continue
        expected = _combined(parts)
        mass, center, inertia = motion.mass(body)
        r, t = motion.placed[body]
        beside = helping.get(motion.objects[body]["id"], [])
        if beside:
            whole = _combined([_in_world(motion, i) for i in (body, *beside)])
            mass, center = whole.mass, r.T @ (whole.center - t)
            inertia = r.T @ whole.inertia @ r
        size = max(float(np.abs(expected.inertia).max()), 1e-12)
        reach = max(float(np.linalg.norm(expected.center)), 1e-3)
        here = r @ center + t
        errors = (
            abs(mass - expected.mass) / expected.mass,
            float(np.linalg.norm(here - unity_point(expected.center, engine.turn, engine.length))) / reach,
            float(np.abs(r @ inertia @ r.T - unity_inertia(expected.inertia, engine.turn)).max()) / size,
        )
        if max(errors) > worst:
            worst = max(errors)
            where = f"{name}: mass, centre, inertia off by {', '.join(f'{e:.2g}' for e in errors)}"
    if worst > CLOSE:
        wrong.append(where)
    total = sum(part.mass for parts in together.values() for part in parts)
    bodies = {*together, *(i for body in together for i in helping.get(motion.objects[body]["id"], ()))}
    weighed = sum(motion.mass(body)[0] for body in bodies)
    return {"mass_error": worst, "total_mass": [weighed, total]}


PAIRS_TOLD = {"PAIR_DROPPED", "GROUP_PARTLY_KEPT", "MJCF_COLLISION_FILTER", "USD_COLLISION_FILTER"}
"""Findings that tell a pair which the scene does not keep."""


def _pairs(motion: SceneKinematics, engine: Engine, told: set[str], wrong: list[str]) -> dict[str, Any]:
    """Pairs of bodies that do not collide, of those that the engine has something touchable on."""
    expected = engine.passing()
    if expected is None:
        return {}
    welded = {body: body for body in motion.body_of}
    for i, c in _joints(motion, "FixedJoint"):
        a, b = (welded[motion.body_of[k]] for k in (i, c.get("connectedBody", i)))
        welded = {k: a if v == b else v for k, v in welded.items()}
    shaped = {
        welded[motion.body_of[i]]
        for i, entry in enumerate(motion.objects)
        if any(c["type"].endswith("Collider") for c in entry.get("components", ()))
    }
    moving = {welded[body] for body in motion.moving}

    def counts(pair: frozenset[int | None]) -> bool:
        return len(pair) == 2 and pair <= shaped and bool(pair & moving)

    of_engine: set[frozenset[int | None]] = set()
    for pair in expected:
        try:
            of_engine.add(frozenset(welded[motion.body_of[motion.object(name)]] for name in pair))
        except KeyError:
            continue  # told by the poses
    here = {
        frozenset((welded[motion.body_of[i]], welded[motion.body_of[c["connectedBody"]]]))
        for i, c in _joints(motion, "HingeJoint", "ConfigurableJoint", "FixedJoint")
        if "connectedBody" in c and not c.get("enableCollision", False)
    }
    different = {pair for pair in here ^ of_engine if counts(pair)}
    right = not different or bool(PAIRS_TOLD & told)
    if not right:
        names = [sorted(motion.objects[i]["name"] for i in pair if i is not None) for pair in different]
        wrong.append(f"pairs that do not collide: {sorted(names)[:3]}")
    return {"pairs": len({pair for pair in here if counts(pair)}), "pairs_right": right}


def _joints(motion: SceneKinematics, *kinds: str) -> Iterator[tuple[int, Mapping[str, Any]]]:
    for i, entry in enumerate(motion.objects):
        for component in entry.get("components", ()):
            if component["type"] in kinds:
                yield i, component


def _in_world(motion: Any, body: int) -> Mass:
    """Of a body of the scene, along Unity's world axes."""
    mass, center, inertia = motion.mass(body)
    r, t = motion.placed[body]
    return Mass(mass, r @ center + t, r @ inertia @ r.T)


def _combined(parts: list[Mass]) -> Mass:
    """Of what a weld holds together: the scene may have it as one body."""
    mass = sum(part.mass for part in parts)
    center = sum((part.mass * part.center for part in parts), np.zeros(3)) / mass
    inertia = np.zeros((3, 3))
    for part in parts:
        arm = part.center - center
        inertia += part.inertia + part.mass * ((arm @ arm) * np.eye(3) - np.outer(arm, arm))
    return Mass(mass, center, inertia)
