"""Bodies of the compiled model as links: inertias, geoms that are drawn and touched, sites and cameras."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from ...diagnostics import Report
from ...model import Combine, Mesh, PhysicsMaterial
from ...spatial import Pose
from ..robots.inertial import Inertial
from ..robots.rigid_links import Link, Part, unique
from ..robots.shapes import PLANE_EXTENT, Shape
from .engine import Compiled, pose_of
from .looks import Looks
from .meshes import compiled_mesh, heightfield

DRAWN_GROUPS = 3
"""MuJoCo's viewers draw the geoms of the groups below."""


@dataclass(slots=True)
class Bodies:
    """Makes links; meshes: the scene's, which grow, one for each of the model's that is used."""

    compiled: Compiled
    root: str
    meshes: list[Mesh]
    looks: Looks
    report: Report
    _meshes: dict[tuple[str, int], int] = field(default_factory=dict[tuple[str, int], int])

    def link(self, body: int, label: str, pose: Pose) -> Link:
        """label: unique.  pose: in the world, MuJoCo's axes."""
        compiled, m = self.compiled, self.compiled.model
        link = Link(f"{self.root}/{label}", label, pose, compiled.where("body", compiled.name("body", body)))
        link.parent = 0
        if body and float(m.body_mass[body]) > 0.0:
            inertia = np.diag(np.array(m.body_inertia[body], dtype=np.float64))
            at = pose_of(m.body_ipos[body], m.body_iquat[body])
            link.inertial = Inertial(float(m.body_mass[body]), at, inertia)
        first = int(m.body_geomadr[body])
        geoms = [g for g in range(first, first + int(m.body_geomnum[body])) if g not in compiled.lost]
        given = dict.fromkeys(filter(None, (compiled.name("geom", g) for g in geoms)))
        seen, felt = dict(given), dict(given)
        for geom in geoms:
            self._add_geom(link, geom, seen, felt)
        self._add_frames(link, body)
        self._add_gravity(link, body)
        link.kinematic = int(m.body_mocapid[body]) >= 0
        return link

    def _add_gravity(self, link: Link, body: int) -> None:
        share = float(self.compiled.model.body_gravcomp[body])
        if share == 0.0:
            return
        link.gravity = share < 0.5
        if share != 1.0:
            self.report.approximated(
                f"gravity of {link.name}", "MJCF_GRAVITY", link.where, body=link.name, share=f"{share:g}"
            )

    def _add_frames(self, link: Link, body: int) -> None:
        compiled, m = self.compiled, self.compiled.model
        for kind, owners, positions, turns in (
            ("site", m.site_bodyid, m.site_pos, m.site_quat),
            ("cam", m.cam_bodyid, m.cam_pos, m.cam_quat),
        ):
            for i in np.flatnonzero(np.asarray(owners) == body):
                name = compiled.name(kind, int(i))
                if name in compiled.bodies:
                    name = f"{name} {'camera' if kind == 'cam' else kind}"  # one object has one name
                if name:
                    link.frames[unique(link.frames, name)] = pose_of(positions[i], turns[i])

    def _add_geom(self, link: Link, geom: int, seen: dict[str, None], felt: dict[str, None]) -> None:
        """seen, felt: names that are taken of what the link has that is drawn, and that is touched: all that the file gives,
        and those of the geoms before."""
        m = self.compiled.model
        touches = bool(m.geom_contype[geom] or m.geom_conaffinity[geom]) or self._paired(geom)
        drawn = int(m.geom_group[geom]) < DRAWN_GROUPS and float(m.geom_rgba[geom][3]) > 0.0
        given = self.compiled.name("geom", geom)
        where = self.compiled.where("geom", given) if given else link.where
        label = given or self._called(geom)
        feature = f"geom {link.name}/{label}"
        pose = pose_of(m.geom_pos[geom], m.geom_quat[geom])
        shape = self._shape(geom, where)
        if shape is None:
            self.report.dropped(feature, "MJCF_LEFT_OUT", where)
            return
        if drawn:
            uvs = shape.kind == "plane" or (shape.mesh is not None and bool(self.meshes[shape.mesh].uvs))
            name = given or unique(seen, label)
            seen[name] = None
            link.drawn.append(Part(name, shape, pose, self.looks.of(geom, uvs), counted=not given))
        if touches:
            name = given or unique(felt, label)
            felt[name] = None
            material, group = self._material(geom), self._group(geom)
            link.touched.append(Part(name, shape, pose, material=material, group=group, counted=not given))
        if not (drawn or touches):
            self.report.dropped(feature, "MJCF_GEOM_UNSEEN", where)

    def _called(self, geom: int) -> str:
        """What a geom without a name is called: like its mesh, or by its kind, so that one of another kind that is put in
        before it changes nothing of it."""
        m = self.compiled.model
        index, kind = int(m.geom_dataid[geom]), self.compiled.mujoco.mjtGeom(int(m.geom_type[geom]))
        word = str(kind.name).removeprefix("mjGEOM_").lower()
        if index < 0:
            return word
        return self.compiled.name("hfield" if word == "hfield" else "mesh", index) or word

    def _paired(self, geom: int) -> bool:
        """Whether a contact pair is stated for it."""
        m = self.compiled.model
        return bool(np.any(m.pair_geom1 == geom) or np.any(m.pair_geom2 == geom))

    def _material(self, geom: int) -> PhysicsMaterial:
        """MuJoCo takes the larger of two frictions."""
        friction = float(self.compiled.model.geom_friction[geom][0])
        return PhysicsMaterial(f"friction {friction:g}", friction, friction, 0.0, Combine.MAXIMUM)

    def _group(self, geom: int) -> str:
        m = self.compiled.model
        kind, affinity = int(m.geom_contype[geom]), int(m.geom_conaffinity[geom])
        return "" if (kind, affinity) == (1, 1) else f"contype {kind} conaffinity {affinity}"

    def _shape(self, geom: int, where: str) -> Shape | None:
        """MuJoCo's sizes are half of what they measure."""
        m, kinds = self.compiled.model, self.compiled.mujoco.mjtGeom
        a, b, c = (float(v) for v in m.geom_size[geom])
        kind = int(m.geom_type[geom])
        index = int(m.geom_dataid[geom])
        if kind in (int(kinds.mjGEOM_MESH), int(kinds.mjGEOM_SDF)) and index >= 0:
            return Shape("mesh", (1.0, 1.0, 1.0), where=where, mesh=self._mesh("mesh", index))
        if kind == int(kinds.mjGEOM_HFIELD) and index >= 0:
            return Shape("surface", (1.0, 1.0, 1.0), where=where, mesh=self._mesh("hfield", index))
        found = {
            int(kinds.mjGEOM_SPHERE): ("sphere", (a,)),
            int(kinds.mjGEOM_CAPSULE): ("capsule", (a, 2.0 * b)),
            int(kinds.mjGEOM_CYLINDER): ("cylinder", (a, 2.0 * b)),
            int(kinds.mjGEOM_ELLIPSOID): ("ellipsoid", (a, b, c)),
            int(kinds.mjGEOM_BOX): ("box", (2.0 * a, 2.0 * b, 2.0 * c)),
            int(kinds.mjGEOM_PLANE): ("plane", (2.0 * a or PLANE_EXTENT, 2.0 * b or PLANE_EXTENT)),
        }.get(kind)
        return None if found is None else Shape(found[0], found[1], where=where)

    def _mesh(self, kind: str, index: int) -> int:
        if (kind, index) not in self._meshes:
            make = compiled_mesh if kind == "mesh" else heightfield
            self._meshes[kind, index] = len(self.meshes)
            made = make(self.compiled.model, index)
            self.meshes.append(replace(made, origin=f"{kind} {made.name}"))
        return self._meshes[kind, index]
