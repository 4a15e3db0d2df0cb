"""An MJCF file as a scene.

MuJoCo compiles it, so that defaults, includes, attached models and inertias are those it resolves; what is read is the
compiled model.  The exported pose is the reference pose, or that of ``--keyframe``.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ...diagnostics import Report
from ...model import Node, NodeKind, Physics, Scene, Source
from ..reading.request import Request
from ..reading.xml_text import root_name
from ..robots.packages import packages_of
from ..robots.rigid_links import Carrier, add_links
from ..robots.robot_frame import direction
from .actuators import read_actuators
from .bodies import Bodies
from .contacts import add_excludes, add_pairs, excluded, masks, with_parents_met
from .engine import Compiled, compile_model
from .equalities import Equalities
from .files import scan
from .joints import Made, add_free, add_joint, is_free
from .looks import Looks
from .losses import tell_losses
from .tree import Tree


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
    scene.joints = with_parents_met(scene, compiled, carriers)
    equalities = Equalities(compiled, carriers, made, scene, report, frozenset(excluded(compiled)))
    equalities.read()
    add_excludes(scene, compiled, carriers, _joined(scene, carriers), report)
    add_pairs(scene, compiled, carriers, report)
    scene.extras = masks(compiled)
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
    """Nodes of all bodies and the joints between them; where each body went."""
    bodies = Bodies(compiled, root, scene.meshes, Looks(compiled, scene.surfaces, report), report)
    tree = Tree(compiled, bodies, report)
    carriers = add_links(scene, tree.links, tree.fixed, tree.joined, report)
    made = Made()
    driven = read_actuators(compiled, report)
    for hung in tree.hung:
        a = None if hung.a is None else carriers[hung.a]
        add_joint(made, compiled, hung.step, hung.before, a, carriers[hung.b], driven, report)
    by_body = [None if link is None else carriers[link] for link in tree.of]
    for body, carrier in enumerate(by_body):
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
