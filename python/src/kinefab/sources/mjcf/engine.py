"""MuJoCo: a file compiled, with stand-ins for what files are missing, and posed.

The library has no types of its own, so here its objects are Any, once for all.
"""

from __future__ import annotations

import os
import re
import warnings
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path, PurePosixPath
from typing import Any

import numpy as np

from ...diagnostics import KinefabError, Report
from ...spatial import Array, Pose
from ..reading.file import tell_opened
from ..reading.record import MAX_NUMBER
from ..robots.packages import Found, Packages
from ..robots.rigid_links import unique
from .files import Files

STAND_IN_RADIUS = 0.05
"""Metres of the ball that stands in for a mesh whose file is missing, so that a body without other shapes has a mass."""
FOLDERS = ("meshdir", "texturedir", "assetdir")
SOLID = ([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1], [0, 2, 1, 0, 3, 2, 0, 1, 3, 1, 2, 3])
"""Corners and faces of a mesh that nothing draws."""
HIDDEN = 5
"""Group of geoms that are not drawn."""


@dataclass(slots=True, eq=False)
class Compiled:
    """mujoco: the module.  model: MjModel.  data: MjData at the exported pose.  ctrl: the actuators' controls there.
    lost: ids of geoms that stand in for missing meshes.  textures: file of each texture by its name; None where it is
    made by numbers.  flipped: of those that are not shown as they lie in their file, whether sideways, and upside down.
    names: of bodies, by id, each of them one."""

    mujoco: Any
    model: Any
    data: Any
    files: Files
    ctrl: Array
    lost: frozenset[int]
    textures: dict[str, Path | None]
    flipped: dict[str, tuple[bool, bool]]
    bodies: list[str]
    joints: list[str]
    keyframes: tuple[str, ...]

    def name(self, kind: str, index: int) -> str:
        """What the file calls an element; "" where it does not."""
        return str(getattr(self.model, kind)(index).name)

    def body_pose(self, body: int) -> Pose:
        """In the world at the exported pose, MuJoCo's axes."""
        return Pose(np.array(self.data.xmat[body]).reshape(3, 3), np.array(self.data.xpos[body]))

    def where(self, kind: str, name: str) -> str:
        return self.files.where(kind, name)


def pose_of(position: Any, quaternion: Any) -> Pose:
    """From MuJoCo's numbers; its quaternions are (w, x, y, z)."""
    from ...spatial import matrix_from_quaternion

    w, x, y, z = (float(v) for v in quaternion)
    return Pose(matrix_from_quaternion(np.array([x, y, z, w])), np.array(position, dtype=np.float64))


def compile_model(files: Files, packages: Packages, keyframe: str, report: Report) -> Compiled:
    """The model as MuJoCo compiles it.  keyframe: "" for the reference pose.  Raises KinefabError."""
    mujoco = import_module("mujoco")
    library = _Library(mujoco, files, packages, report)
    model = library.compiled()
    lost = frozenset(i for i in range(model.ngeom) if model.geom(i).name in library.lost)
    return _posed(mujoco, model, files, keyframe, lost, library, report)


@dataclass(slots=True, eq=False)
class _Library:
    """From files to a compiled model."""

    mujoco: Any
    files: Files
    packages: Packages
    report: Report
    lost: set[str] = field(default_factory=set[str])
    folders: list[str] = field(default_factory=list[str])
    textures: dict[str, Path | None] = field(default_factory=dict[str, "Path | None"])
    flipped: dict[str, tuple[bool, bool]] = field(default_factory=dict[str, tuple[bool, bool]])

    def compiled(self) -> Any:
        spec = self._tried(self._opened)
        # What memory a simulation reserves is no matter here, and could be asked for without end.
        for size in ("memory", "nstack", "njmax", "nconmax"):
            setattr(spec, size, -1)
        self._mend_textures(spec)
        self._mend_meshes(spec)
        self._mend_heightfields(spec)
        self._mend_skins(spec)
        model = self._without_hulls(spec)
        self._tell_masses(spec, _body_names(model))
        self._check_numbers(model)
        return model

    def _without_hulls(self, spec: Any) -> Any:
        """The compiled model.  MuJoCo hulls every mesh that something may touch, a fifth of its time; the scene's hulls are
        our own, so the contacts are stated afterwards."""
        touched = [] if spec.compiler.discardvisual else [g for g in spec.geoms if g.contype or g.conaffinity]
        stated = [(int(geom.contype), int(geom.conaffinity)) for geom in touched]
        for geom in touched:
            geom.contype = geom.conaffinity = 0
        before = len(self.report.diagnostics)
        try:
            model = self._tried(spec.compile)
        except KinefabError:
            model = None
        for geom, bits in zip(touched, stated):
            geom.contype, geom.conaffinity = bits
            if model is not None:
                model.geom_contype[geom.id], model.geom_conaffinity[geom.id] = bits
        # There are elements that ask for something that may be touched, as sensors of touch do.
        if model is None:
            del self.report.diagnostics[before:]
            model = self._tried(spec.compile)
        return model

    def _opened(self) -> Any:
        path, open_ = self.files.path, self.mujoco.MjSpec.from_file
        if path.suffix == ".xml":
            return open_(str(path))
        # MuJoCo 4 chooses what decodes a file by its ending, in small letters
        named = path.with_suffix(".xml")
        return open_(str(named), include={named.name: path.read_bytes()})

    def _tried(self, call: Any) -> Any:
        found: Any = None
        # MuJoCo writes its warnings into a file of the working folder, and the newest raise Python's too.
        quiet = getattr(self.mujoco, "set_mju_user_warning", None)
        try:
            if quiet is not None:
                quiet(_say_nothing)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                found = call()
        except Exception as error:  # whatever MuJoCo raises is what it has against the file
            said = " ".join(str(error).split())
            line = re.search(r"line (\d+)", said)
            where = f"{self.files.path.name}:{line[1]}" if line else self.files.path.name
            self.report.add("MJCF_REFUSED", where, detail=said[:400].rstrip(".") or type(error).__name__)
        finally:
            if quiet is not None:
                quiet(None)
        self.report.raise_for_errors()
        return found

    def _check_numbers(self, model: Any) -> None:
        arrays = (
            "body_pos body_quat body_mass body_inertia body_ipos body_iquat jnt_pos jnt_axis qpos0 geom_pos geom_quat "
            "geom_size site_pos site_quat eq_data key_qpos dof_damping dof_armature mesh_vert"
        )
        for name in arrays.split():
            values = np.asarray(getattr(model, name))
            if not np.isfinite(values).all() or np.abs(values).max(initial=0.0) > MAX_NUMBER:
                detail = f"{name} holds numbers that are not finite, or beyond {MAX_NUMBER:g}"
                self.report.add("MJCF_REFUSED", self.files.path.name, detail=detail)
        self.report.raise_for_errors()

    # What is not there .................................................................................................

    def _found(self, spec: Any, folder: str, file: str) -> Found:
        """In the folder that the model states; of attached models, in those that they state, from where they lie."""
        name = PurePosixPath(file.replace("\\", "/")).name if spec.strippath else file
        if not self.folders:
            stated = [e.attributes.get(k, "") for e in self.files.all("compiler") for k in FOLDERS]
            self.folders = ["", *stated]
        places = dict.fromkeys((folder, *self.folders))
        homes = dict.fromkeys(("", *(str(PurePosixPath(f.uri).parent) for f in self.files.read)))
        first: Found | None = None
        for candidate in (os.path.join(home, place, name) for home in homes for place in places):
            found = self.packages.find(candidate)
            if found.path is not None:
                tell_opened(found.path)
                return found
            first = first or found
        return first or Found(None)

    def _tell(self, kind: str, name: str, file: str, found: Found) -> None:
        feature, where = f"{kind} {name or file}", self.files.where(kind, name)
        if kind == "texture":
            self.report.dropped(feature, "TEXTURE_NOT_FOUND", where, file=file)
        else:
            code = "MESH_OUTSIDE" if found.outside else "MESH_NOT_FOUND"
            self.report.dropped(feature, code, where, file=file)

    def _mend_textures(self, spec: Any) -> None:
        """Images are not read here: the scene names the files."""
        flat = self.mujoco.mjtBuiltin.mjBUILTIN_FLAT
        for texture in spec.textures:
            sides = [str(f) for f in texture.cubefiles if f]
            if not texture.file and not sides:
                continue
            file = str(texture.file) or sides[0]
            found = self._found(spec, spec.texturedir, file)
            if found.path is None:
                self._tell("texture", texture.name, file, found)
            name = texture.name or PurePosixPath(file).stem
            texture.name = name
            self.textures[name] = found.path if texture.file else None
            if texture.hflip or texture.vflip:
                self.flipped[name] = (bool(texture.hflip), bool(texture.vflip))
            texture.file, texture.builtin = "", flat
            for i in range(len(texture.cubefiles)):
                texture.cubefiles[i] = ""
            texture.width = texture.height = 1
            texture.gridsize = [1, 1]

    def _mend_meshes(self, spec: Any) -> None:
        sphere = self.mujoco.mjtGeom.mjGEOM_SPHERE
        lost: list[Any] = []
        shown: dict[str, list[Any]] = {}
        names: dict[str, None] = {}
        for geom in spec.geoms:
            shown.setdefault(geom.meshname, []).append(geom)
            names[geom.name] = None
        for mesh in list(spec.meshes):
            if not mesh.file:
                continue
            found = self._found(spec, spec.meshdir, mesh.file)
            if found.path is not None:
                continue
            name = mesh.name or PurePosixPath(mesh.file).stem
            self._tell("mesh", name, mesh.file, found)
            for geom in shown.get(name, ()):
                geom.meshname, geom.type, geom.size = "", sphere, [STAND_IN_RADIUS, 0.0, 0.0]
                geom.contype = geom.conaffinity = 0
                geom.group = HIDDEN
                geom.name = geom.name or unique(names, f"missing {name}")
                names[geom.name] = None
                self.lost.add(geom.name)
                lost.append(geom)
            # Nothing draws it any more; taking it out of the model would cost a walk through all of it for each.
            mesh.name, mesh.file = name, ""
            mesh.uservert, mesh.userface = SOLID
        weighs: dict[Any, bool] = {}
        for geom in lost:  # nobody knows what it weighs: nothing, where the body has a mass without it
            if (body := geom.parent) not in weighs:
                weighs[body] = any(_weighs(g) for g in body.geoms if g.name not in self.lost or not g.name)
            if np.isnan(geom.mass) and weighs[body]:
                geom.mass = 0.0

    def _tell_masses(self, spec: Any, names: list[str]) -> None:
        """Of bodies whose missing meshes would have given their mass.  names: of all bodies, in the model's order."""
        from_geoms = int(spec.compiler.inertiafromgeom) == int(
            self.mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_TRUE
        )
        for i, body in enumerate(spec.bodies):
            if i and (from_geoms or not body.explicitinertial):
                if any(geom.name in self.lost for geom in body.geoms):
                    name = names[int(body.id)] if body.id >= 0 else str(body.name)  # what is fused has no id
                    where = self.files.where("body", str(body.name))
                    self.report.approximated(f"mass {name}", "MASS_WITHOUT_MESH", where)

    def _mend_heightfields(self, spec: Any) -> None:
        for field_ in spec.hfields:
            if not field_.file:
                continue
            found = self._found(spec, spec.meshdir, field_.file)
            if found.path is None:
                self._tell("hfield", field_.name, field_.file, found)
                field_.file, field_.nrow, field_.ncol = "", 2, 2
                field_.userdata = [0.0] * 4

    def _mend_skins(self, spec: Any) -> None:
        """Nothing reads them, so no file of theirs is opened."""
        for skin in [s for s in spec.skins if s.file]:
            feature, where = f"skin {skin.name or skin.file}", self.files.where("skin", skin.name)
            self.report.dropped(feature, "MJCF_LEFT_OUT", where)
            spec.delete(skin)


def _weighs(geom: Any) -> bool:
    return geom.mass > 0.0 or (np.isnan(geom.mass) and geom.density > 0.0)


def _say_nothing(text: str) -> None:
    """Instead of MuJoCo's log."""


def _posed(
    mujoco: Any,
    model: Any,
    files: Files,
    keyframe: str,
    lost: frozenset[int],
    library: _Library,
    report: Report,
) -> Compiled:
    data = mujoco.MjData(model)
    keyframes = tuple(str(model.key(i).name) or str(i) for i in range(model.nkey))
    ctrl = np.zeros(model.nu)
    if keyframe:
        if keyframe in keyframes:
            number = keyframes.index(keyframe)
        elif keyframe.isdigit() and int(keyframe) < len(keyframes):
            number = int(keyframe)
        else:
            report.add("MJCF_KEYFRAME", files.path.name, name=keyframe, known=", ".join(keyframes) or "none")
            report.raise_for_errors()
            raise AssertionError("an unknown keyframe is an error")
        mujoco.mj_resetDataKeyframe(model, data, number)
        ctrl = np.array(model.key_ctrl[number])
    mujoco.mj_kinematics(model, data)
    bodies = _body_names(model)
    owners = [f"{bodies[int(body)]} joint" for body in model.jnt_bodyid]
    joints = _named([str(model.joint(i).name) for i in range(model.njnt)], owners)
    return Compiled(
        mujoco, model, data, files, ctrl, lost, library.textures, library.flipped, bodies, joints, keyframes
    )  # fmt: skip


def _body_names(model: Any) -> list[str]:
    """One without a name is called after the nearest body above that has one, so that what is put in elsewhere changes
    nothing of it: scenes and prefabs are known again by their names."""
    given = [str(model.body(i).name) for i in range(model.nbody)]
    above = [""] * model.nbody  # of each body, the name of the next one towards the world that has one
    for i in range(1, model.nbody):
        parent = int(model.body_parentid[i])
        above[i] = given[parent] if parent and given[parent] else above[parent]
    return _named(given, [f"{name} body" if name else "body" for name in above])


def _named(given: list[str], instead: list[str]) -> list[str]:
    """Each its own: those that the file gives, else what it is called instead, with a number among its likes."""
    taken: dict[str, None] = dict.fromkeys(filter(None, given))
    names: list[str] = []
    for name, other in zip(given, instead):
        names.append(name or unique(taken, other))
        taken[names[-1]] = None
    return names
