"""Two scenes of Unity compared by what they mean: bodies, joints, shapes and meshes in the world, whatever the tree above them.

A stage names its prims by paths; the id that each had in the source stands in its custom data, by which both are matched.
"""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from pathlib import Path

import kinefab
import numpy as np
from kinefab.diagnostics import Outcome
from kinefab.geometry.hulls import hull_of_points
from kinefab.spatial import matrix_from_quaternion
from kinefab.unity.scene import FixedJoint, Joint, MeshFilter, MeshRenderer, Rigidbody, UnityScene
from pxr import Usd
from unity_world import world_of

LENGTH = 1e-6
"""Share of a scene's size that places may differ by: USD keeps joint frames, masses and limits in 32 bits."""
SHARE = 2e-6
"""Share of themselves, or absolute below one, that other numbers may differ by."""
DEGREES = 5e-5
"""Degrees, or metres, that a coupling's offset may differ by: 1e-7 rad of its joints' frames."""
DIRECTIONS = np.array([[x, y, z] for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1) if x or y or z])
WORDS = {"because", "closure", "exact", "extras", "id", "connectedBody"}
"""Fields of a joint that say where it comes from."""


def sources(stage: Path) -> dict[str, str]:
    """For each prim's path, as the reader makes an id of it, what the prim was in the source."""
    found = {}
    opened = Usd.Stage.Open(str(stage))
    for prim in opened.TraverseAll():
        told = prim.GetCustomData().get("kinefab", {}).get("id")
        if told is not None:
            found[str(prim.GetPath())[1:]] = told
    return found


class Told:
    """What a scene says.  back: ids as they are called in the other one.  lost: couplings that the other was told not to have."""

    def __init__(
        self, scene: UnityScene, back: dict[str, str] | None = None, lost: frozenset[str] = frozenset()
    ):
        self.scene, self.back, self.lost = scene, back, lost
        objects = scene.gameObjects
        self.names = [self._name(o.id) for o in objects]
        self.world = world_of(scene)
        self.body: list[int | None] = []
        for i, entry in enumerate(objects):
            own = any(isinstance(c, Rigidbody) for c in entry.components)
            self.body.append(i if own else None if entry.parent is None else self.body[entry.parent])
        points = [p for _, p in self.world]
        self.size = max(1e-3, float(np.ptp(np.array(points), axis=0).max())) if points else 1.0

    def _name(self, id: str) -> str:
        return id if self.back is None else self.back.get(id, id)

    def body_name(self, number: int | None) -> str:
        """Of the body that an object is part of; all that stands still is one."""
        body = None if number is None else self.body[number]
        return "" if body is None or self.names[body] == "kinefab:ground" else self.names[body]

    def bodies(self) -> dict[str, dict[str, np.ndarray | float | bool]]:
        found = {}
        for i, entry in enumerate(self.scene.gameObjects):
            for c in entry.components:
                if isinstance(c, Rigidbody) and self.body_name(i):
                    linear, place = self.world[i]
                    turn = linear @ matrix_from_quaternion(np.array(c.inertiaTensorRotation))
                    found[self.names[i]] = {
                        "turn": linear, "place": place / self.size, "mass": c.mass,
                        "center": (linear @ np.array(c.centerOfMass) + place) / self.size,
                        "inertia": turn @ np.diag(c.inertiaTensor) @ turn.T / max(c.inertiaTensor),
                        "largest": np.log(max(c.inertiaTensor)), "kinematic": c.isKinematic,
                        "gravity": c.useGravity, "fastest": c.maxAngularVelocity or 0.0, "damping": (c.linearDamping, c.angularDamping),
                    }  # fmt: skip
        return found

    def joints(self) -> dict[str, tuple[str, str, str, dict]]:
        """By the source's id: type, own body, connected body, fields."""
        found = {}
        for i, entry in enumerate(self.scene.gameObjects):
            for c in entry.components:
                if isinstance(c, Joint):
                    values = {f.name: getattr(c, f.name) for f in fields(c) if f.name not in WORDS}
                    ends = (self.body_name(i), self.body_name(c.connectedBody))
                    name = " ".join(sorted(ends)) if isinstance(c, FixedJoint) else self._name(c.id)
                    found[name] = (type(c).__name__, *ends, values)
        return found

    def couplings(self) -> dict[tuple, tuple]:
        """Of all coordinates that are tied together how each follows the first by name, whichever follow which in the file;
        couplings of several terms by their ends."""

        def end(c):
            component = self.scene.gameObjects[c.gameObject].components[c.component]
            return self._name(component.id), c.coordinate

        found, ties = {}, {}
        for c in self.scene.couplings:
            if c.id in self.lost:
                continue
            own, *led = (end(e.coordinate) for e in (c, *c.terms))
            if len(led) > 1:
                found[(own, *led)] = (*(t.ratio for t in c.terms), c.offset)
                continue
            ratio = c.terms[0].ratio
            ties.setdefault(led[0], []).append((own, ratio, c.offset))
            ties.setdefault(own, []).append((led[0], 1.0 / ratio, -c.offset / ratio))
        known = set()
        for first in sorted(ties):
            waiting = [] if first in known else [(first, 1.0, 0.0)]
            for here, ratio, offset in waiting:
                if here not in known:
                    known.add(here)
                    found[here, first] = (ratio, offset)
                    waiting += [(there, k * ratio, k * offset + more) for there, k, more in ties[here]]
        return found

    def drawn(self) -> list[tuple[str, tuple, np.ndarray]]:
        """Body, materials, and middle and normal of each triangle in the world, shares of the size, of each drawn mesh."""
        found = []
        for i, entry in enumerate(self.scene.gameObjects):
            filters = [c for c in entry.components if isinstance(c, MeshFilter)]
            renderers = [c for c in entry.components if isinstance(c, MeshRenderer)]
            for f, r in zip(filters, renderers):
                materials = tuple(
                    (m.name, *np.round([*m.color, m.metallic, m.smoothness], 5)) for m in (self.scene.materials[k] for k in r.materials)
                )  # fmt: skip
                mesh = self.scene.meshes[f.mesh]
                told = (materials, r.enabled, entry.active, len(mesh.uvs) > 0, tuple(mesh.submeshes))
                a, b, c = (
                    self._placed(i, mesh.vertices[mesh.triangles].reshape(-1, 3))
                    .reshape(-1, 3, 3)
                    .swapaxes(0, 1)
                )
                mirrored = np.linalg.det(self.world[i][0]) < 0.0
                normal = np.cross(b - a, c - a) * (-1.0 if mirrored else 1.0)
                found.append((self.body_name(i), told, np.column_stack([a + b + c, normal])))
        return _sorted(found)

    def shapes(self) -> list[tuple[str, tuple, np.ndarray]]:
        """Body, kind and how far each collider reaches in the world in many directions."""
        found = []
        for i, entry in enumerate(self.scene.gameObjects):
            for c in entry.components:
                kind = type(c).__name__
                if not kind.endswith("Collider"):
                    continue
                material = None if c.material is None else self.scene.physicsMaterials[c.material]
                told = (kind, c.isTrigger, c.enabled, None if material is None else _values(material))
                found.append((self.body_name(i), told, self._reach(i, c)))
        return _sorted(found)

    def _placed(self, number: int, points: np.ndarray) -> np.ndarray:
        linear, place = self.world[number]
        return (np.asarray(points, float) @ linear.T + place) / self.size

    def _reach(self, number: int, c) -> np.ndarray:
        kind, radius = type(c).__name__, 0.0
        if kind == "MeshCollider":
            points = np.asarray(self.scene.meshes[c.mesh].vertices, float)
            if c.convex:
                hull = hull_of_points(points)
                points = points if hull is None else hull[0]
        elif kind == "BoxCollider":
            corners = [[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]
            points = np.array(c.center) + np.array(corners) * c.size
        elif kind == "SphereCollider":
            points, radius = np.array([c.center]), c.radius
        else:
            along = np.eye(3)["XYZ".index(c.direction)] * max(0.0, 0.5 * c.height - c.radius)
            points, radius = np.array([c.center + along, np.array(c.center) - along]), c.radius
        reach = (self._placed(number, points) @ DIRECTIONS.T).max(axis=0)
        return reach + radius / self.size * np.linalg.norm(DIRECTIONS, axis=1)


def _values(noun) -> tuple:
    told = (getattr(noun, f.name) for f in fields(noun))
    return tuple(round(v, 6) if isinstance(v, float) else v for v in told)


def _sorted(found):
    return sorted(
        found, key=lambda e: (e[0], str(e[1]), len(e[2]), tuple(np.round(e[2].sum(axis=0).ravel(), 4)))
    )


def apart(one, other, where: str, share: float = SHARE) -> list[str]:
    """What differs, numbers by more than the share."""
    if is_dataclass(one) and is_dataclass(other):
        names = [f.name for f in fields(one)]
        return [d for n in names for d in apart(getattr(one, n), getattr(other, n), f"{where}.{n}", share)]
    if isinstance(one, dict) and isinstance(other, dict):
        missing = [f"{where}: {key} only on one side" for key in sorted(map(str, one.keys() ^ other.keys()))]
        return missing + [
            d for k in one.keys() & other.keys() for d in apart(one[k], other[k], f"{where}.{k}", share)
        ]
    numbers = (int, float, np.ndarray, np.floating)
    if isinstance(one, (tuple, list)) and isinstance(other, (tuple, list)):
        if len(one) != len(other):
            return [f"{where}: {len(one)} and {len(other)}"]
        if where.endswith("Rotation") and np.dot(one, other) < 0.0:
            other = tuple(-x for x in other)
        return [d for i, (a, b) in enumerate(zip(one, other)) for d in apart(a, b, f"{where}[{i}]", share)]
    if isinstance(one, numbers) and isinstance(other, numbers) and not isinstance(one, bool):
        a, b = np.asarray(one, float), np.asarray(other, float)
        scale = np.maximum(1.0, np.abs(a))
        with np.errstate(invalid="ignore"):
            off = np.abs(a - b) if a.shape == b.shape else np.array(np.inf)
            if bool(((a == b) | (off <= share * scale)).all()) if a.shape == b.shape else False:
                return []
        shown = f"{one} became {other} " if a.size < 4 else ""
        return [f"{where}: {shown}{off.max()}"]
    return [] if one == other else [f"{where}: {one!r} became {other!r}"]


def compared(direct: UnityScene, stage, back: UnityScene) -> list[str]:
    """What the scene of a stage does not have as the scene exported directly has it.  stage: the result of its export."""
    dropped = {o.feature.partition(" ")[2] for o in stage.report.outcomes if o.outcome is Outcome.DROPPED}
    one, other = Told(direct, lost=frozenset(dropped)), Told(back, sources(stage.path))
    other.size = one.size
    found = apart(one.couplings(), other.couplings(), "couplings", DEGREES)
    for part in ("bodies", "joints", "shapes", "drawn"):
        share = LENGTH if part in ("shapes", "drawn") else SHARE
        found += apart(getattr(one, part)(), getattr(other, part)(), part, share)
    found += apart(direct.physics, back.physics, "physics")
    return found


def there_and_back(source, folder: Path, ending: str = ".usda", **options):
    """Exports a source to a stage, and both to scenes: (direct, stage's path, back), results of ``kinefab.export``."""
    given = kinefab.ExportOptions(**options)
    direct = kinefab.export(source, folder / "direct.kinefab", given)
    stage = kinefab.export(source, folder / f"stage{ending}", given)
    back = kinefab.export(stage.path, folder / "back.kinefab", given)
    return direct, stage, back
