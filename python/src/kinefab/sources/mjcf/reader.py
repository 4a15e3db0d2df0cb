"""An MJCF file as a scene.

MuJoCo compiles it, so that defaults, includes, attached models and inertias are those it resolves; what is read is the
compiled model.  The exported pose is the reference pose, or that of ``--keyframe``.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ...diagnostics import Report
from ...model import Node, NodeKind, Physics, Scene, Source
from ...spatial import Pose
from ..reading.request import Request
from ..reading.xml_text import root_name
from ..robots.packages import packages_of
from ..robots.rigid_links import Carrier, Link, add_links, unique
from ..robots.robot_frame import direction
from .actuators import read_actuators
from .bodies import Bodies
from .contacts import excluded, filters
from .engine import Compiled, compile_model, pose_of
from .equalities import Equalities
from .files import scan
from .joints import Made, add_free, add_joint, is_free, planned
from .looks import Looks
from .losses import tell_losses
from .stacks import Step


def sniff(head: bytes) -> bool:
    """Whether a file begins as MJCF does; fragments for others to include (``mujocoinclude``) are none."""
    return root_name(head) == "mujoco"


def read(path: Path, report: Report, request: Request = Request()) -> Scene:
    """The scene of an ``.xml`` or ``.mjcf``.  Raises KinefabError with every error found."""
    packages = packages_of(path, request, report)
    files = scan(path, packages, report)
    compiled = compile_model(files, packages, request.text("keyframe"), report)
    root = files.root.attributes.get("model", "").strip() or path.name.split(".")[0]
    source = Source(path.name, "Z", 1.0, files.sha256, tuple(files.read))
    scene = Scene(source=source, physics=_physics(compiled))
    scene.nodes.append(Node(root, root, NodeKind.ASSEMBLY, flexible=True, where=files.root.where))
    if compiled.keyframes:
        scene.offers = {"keyframe": compiled.keyframes}
    made, carriers = _add_bodies(scene, compiled, root, report)
    if len(scene.nodes) == 1:
        report.add("SCENE_WITHOUT_PARTS", files.root.where)
    scene.joints += made.joints
    equalities = Equalities(compiled, carriers, made, scene, report, frozenset(excluded(compiled)))
    equalities.read()
    scene.extras = filters(compiled, _joined(scene, carriers), report)
    tell_losses(compiled, equalities, report)
    report.raise_for_errors()
    return scene


def _physics(compiled: Compiled) -> Physics:
    m = compiled.model
    off = int(m.opt.disableflags) & int(compiled.mujoco.mjtDisableBit.mjDSBL_GRAVITY)
    gravity = np.zeros(3) if off else direction(np.array(m.opt.gravity))
    x, y, z = (float(v) + 0.0 for v in gravity)
    return Physics((x, y, z), fixed_timestep=float(m.opt.timestep))


def _add_bodies(
    scene: Scene, compiled: Compiled, root: str, report: Report
) -> tuple[Made, list[Carrier | None]]:
    """Links of all bodies, with light ones between the steps of a body's joints; then the joints between them."""
    m = compiled.model
    bodies = Bodies(compiled, root, scene.meshes, Looks(compiled, scene.surfaces, report), report)
    links: list[Link] = []
    fixed: list[tuple[int, int]] = []
    joined: list[tuple[int, int]] = []
    index: list[int | None] = []
    planned_steps: list[tuple[int, Step, Pose, int | None, int]] = []
    labels = {name: name for name in compiled.bodies}
    for body in range(m.nbody):
        if body == 0 and not _has_something(compiled):
            index.append(None)
            continue
        parent = index[int(m.body_parentid[body])] if body else None
        steps = planned(compiled, body)
        base = Pose() if not body else compiled.body_pose(int(m.body_parentid[body]))
        local = pose_of(m.body_pos[body], m.body_quat[body])
        before, last, placed_at = local, parent, base @ local
        for number, step in enumerate(steps):
            for axis in step.axes:
                placed_at = placed_at @ axis.moved()
            if number < len(steps) - 1:
                label = unique(labels, f"{compiled.bodies[body]} {compiled.joints[step.axes[-1].index]}")
                labels[label] = label
                middle = Link(
                    f"{root}/{label}", label, placed_at, compiled.where("body", compiled.name("body", body))
                )
                middle.parent = 0
                links.append(middle)
                report.approximated(
                    f"joints of {compiled.bodies[body]}", "MJCF_MIDDLE_BODY", middle.where,
                    body=compiled.bodies[body], middle=label,
                )  # fmt: skip
            else:
                links.append(bodies.link(body, compiled.bodies[body], compiled.body_pose(body)))
            here = len(links) - 1
            planned_steps.append((body, step, before, last, here))
            if last is not None:
                joined.append((last, here))
            before, last = Pose(), here
        if not steps:
            link = bodies.link(body, compiled.bodies[body], compiled.body_pose(body))
            links.append(link)
            here = len(links) - 1
            free = is_free(compiled, body)
            if not free and not link.kinematic:
                ground = int(m.body_parentid[body]) == 0
                link.grounded = ground
                if not ground and parent is not None:
                    fixed.append((parent, here))
        index.append(len(links) - 1)
    carriers = add_links(scene, links, fixed, joined, report)
    made = Made()
    driven = read_actuators(compiled, report)
    by_body = [None if i is None else carriers[i] for i in index]
    for _, step, before, last, here in planned_steps:
        add_joint(
            made,
            compiled,
            step,
            before,
            None if last is None else carriers[last],
            carriers[here],
            driven,
            report,
        )
    for body in range(m.nbody):
        carrier = by_body[body]
        if carrier is not None and is_free(compiled, body):
            add_free(made, compiled, body, carrier)
    return made, by_body


def _joined(scene: Scene, carriers: list[Carrier | None]) -> set[frozenset[int]]:
    """Pairs of bodies with a joint that keeps them from colliding."""
    bodies: dict[int | None, list[int]] = {}
    for body, carrier in enumerate(carriers):
        bodies.setdefault(None if carrier is None else carrier.node, []).append(body)
    apart = [joint for joint in scene.joints if not joint.collide]
    return {frozenset((a, b)) for j in apart for a in bodies.get(j.a, ()) for b in bodies.get(j.b, ())}


def _has_something(compiled: Compiled) -> bool:
    """Whether the world has shapes or frames of its own."""
    m = compiled.model
    return bool(m.body_geomnum[0]) or bool(np.any(np.asarray(m.site_bodyid) == 0))
