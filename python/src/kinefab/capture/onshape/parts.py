"""Onshape's parts: mesh, look and mass, asked once for all their instances.

A part comes as glTF, with its normals and the colours of its faces; where it does not, as STL.  What the program says of its mass,
else of its box, tells in which unit and axes it stands (``stands``), and the list of a Part Studio's parts how colours are counted.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass, field
from typing import Any, cast

import numpy as np

from ...diagnostics import named
from ...spatial import Array
from ..draft import WRONG_ANSWER, BodyMesh, Draft, Numbers, Record
from ..looks import linear_rgba, listed, look
from ..masses import mass_record
from .answers import Answers, box_question, gltf_question, look_question, mass_question, stl_question
from .gltf import Paint, Shape, read_gltf
from .stands import DOCUMENTED, READINGS, Said, Votes, misfits, settled

STL_HEAD, STL_FACET = 84, 50
FULL = 255.0
ALIKE = 2.0 / FULL
"""Difference up to which two colours are one: Onshape's list has them in bytes."""
UNIT = 0.5
"""Length that a unit vector has at least."""
Json = dict[str, Any]


@dataclass(slots=True)
class Part:
    """name: of its first instance, in a form that an OBJ can hold.  form: ``glTF`` or ``STL``.  shape: as it came.  entry: of the list of its Part Studio's parts.
    weighed: what the program says of its mass."""

    name: str
    instance: Json
    form: str = ""
    shape: Shape | None = None
    entry: Json = field(default_factory=dict[str, Any])
    weighed: Json = field(default_factory=dict[str, Any])


@dataclass(slots=True)
class Parts:
    """wanted: every part of the assembly, by its definition.  found: ``bodies`` and ``mass`` of each."""

    answers: Answers
    draft: Draft
    wanted: dict[str, Part] = field(default_factory=dict[str, Part])
    found: dict[str, Record] = field(default_factory=dict[str, Record])

    def want(self, definition: str, name: str, instance: Json) -> None:
        """Note an instance's part.  name: the instance's."""
        self.wanted.setdefault(definition, Part(" ".join(name.replace("\\", "/").split()), instance))

    def read(self) -> None:
        """Ask for every part, once; without a program only for what was saved."""
        votes = {"glTF": Votes(), "STL": Votes()}
        for definition, part in self.wanted.items():
            self._shape(part)
            self._said(part)
            if part.shape is not None:
                with self.draft.safely(f"axes of {part.name}"):
                    votes[part.form].misfits[definition] = self._misfits(part, part.shape)
        self._tell_not_saved()
        screens = _as_screens_show([part for part in self.wanted.values() if part.form == "glTF"])
        if screens:
            self.draft.report.add("CAPTURE_COLORS_READ", form="glTF", count=len(votes["glTF"].misfits))
        for definition, part in self.wanted.items():
            found = self.found[definition] = {}
            if part.shape is not None:
                with self.draft.safely(f"mesh of {part.name}"):
                    self._mesh(definition, part, part.shape, votes[part.form], screens)
            with self.draft.safely(f"mass of {part.name}"):
                self._mass(definition, part, found)
        for form, vote in votes.items():
            self._tell(form, vote)

    def _answered(self, question: str) -> bool:
        return self.answers.fetch is not None or question in self.answers.answers

    def _shape(self, part: Part) -> None:
        """The part as glTF, else as STL."""
        lost = ""
        if self._answered(question := gltf_question(part.instance)):
            try:
                part.shape, part.form = read_gltf(self.answers.bytes_of(question)), "glTF"
                return
            except WRONG_ANSWER as error:
                lost = str(error)
        if self._answered(question := stl_question(part.instance)):
            with self.draft.safely(f"mesh of {part.name}"):
                part.shape, part.form = stl(self.answers.bytes_of(question)), "STL"
                if lost:
                    feature = f"colours and normals of {part.name}"
                    told = {"program": self.draft.program, "name": part.name, "detail": lost}
                    self.draft.report.approximated(feature, "CAPTURE_NO_GLTF", **told)
        elif lost:
            self.draft.failed(f"mesh of {part.name}", ValueError(lost))

    def _tell_not_saved(self) -> None:
        """Of answers saved by hand: the parts that no file draws, in one finding with the names such files would have."""
        asked = (gltf_question, stl_question)
        bare = [
            part
            for part in self.wanted.values()
            if part.shape is None and not any(self._answered(question(part.instance)) for question in asked)
        ]
        if bare and self.answers.by_hand:
            files = [f"{part.instance.get('elementId')}_{part.instance.get('partId')}.glb" for part in bare]
            told = {"count": len(bare), "files": named(files), "program": self.draft.program}
            features = [f"mesh of {part.name}" for part in bare]
            self.draft.report.dropped_alike(features, "CAPTURE_MESHES_NOT_SAVED", **told)

    def _said(self, part: Part) -> None:
        if part.shape is not None and self._answered(question := look_question(part.instance)):
            with self.draft.safely(f"look of {part.name}"):
                own = str(part.instance.get("partId"))
                entry = next((e for e in self.answers.ask(question) if e.get("partId") == own), None)
                part.entry = entry or {}
        if self._answered(question := mass_question(part.instance)):
            with self.draft.safely(f"mass of {part.name}"):
                bodies = cast(Json, self.answers.ask(question)["bodies"])
                part.weighed = next(iter(bodies.values()), None) or {}

    def _misfits(self, part: Part, shape: Shape) -> dict[str, float]:
        """How far off each reading of the mesh is: by its mass, which may be overridden, and where that tells nothing by its box."""
        off = misfits(shape.points, shape.faces, _weighed(part.weighed))
        if not settled(off) and self._answered(question := box_question(part.instance)):
            box = self.answers.ask(question)
            low, high = (np.array([float(box[f"{end}{axis}"]) for axis in "XYZ"]) for end in ("low", "high"))
            off = misfits(shape.points, shape.faces, Said(low=low, high=high)) or off
        return off

    def _mesh(self, definition: str, part: Part, shape: Shape, votes: Votes, screens: bool) -> None:
        words = votes.of(definition)
        if words is None:
            off = f"{votes.misfits[definition][DOCUMENTED]:.2g}"
            told = {"name": part.name, "program": self.draft.program, "form": part.form, "off": off}
            self.draft.report.add("CAPTURE_MESH_UNSETTLED", **told)
            words = votes.told()
        turn = READINGS[words]
        points, normals = shape.points @ turn.T, shape.normals
        if normals is not None:
            normals = normals @ (turn / np.cbrt(np.linalg.det(turn))).T
            normals = normals if np.all(np.linalg.norm(normals, axis=1) > UNIT) else None
        runs: list[tuple[int, str]] = []
        material: str | None = None
        with self.draft.safely(f"look of {part.name}"):
            runs, material = self._looks(part, shape, screens)
        mesh = BodyMesh(
            part.name, points.ravel().tolist(), shape.faces.ravel().tolist(),
            None if normals is None else normals.ravel().tolist(), runs,
        )  # fmt: skip
        self.draft.meshes[definition] = [mesh]
        body = {"id": part.name, "meshKey": part.name}
        self.found[definition]["bodies"] = [body | ({"material": material} if material else {})]

    def _looks(self, part: Part, shape: Shape, screens: bool) -> tuple[list[tuple[int, str]], str | None]:
        """The runs of faces with their materials where there are several, and the material of the whole body."""
        stated: Json = part.entry.get("material") or {}
        material = " ".join(str(stated.get("displayName") or "").replace("\\", "/").split())
        color = _shown(part.entry)
        named = [self._paint(part, paint, material, color, screens) for _, paint in shape.runs]
        if len(set(named)) > 1:
            plain = listed(self.draft, "", {}, f"{part.name}, without colour") if None in named else ""
            return [(count, name or plain) for (count, _), name in zip(shape.runs, named)], None
        return [], (named[0] if named else None) or look(self.draft, material, color, part.name)

    def _paint(
        self, part: Part, paint: Paint | None, material: str, color: Numbers | None, screens: bool
    ) -> str | None:
        """The material of some faces: the part's own, in the list's exact numbers, where they have its colour."""
        known: list[float] | None = None if color is None else linear_rgba(color)
        if paint is not None and (known is None or not _alike(_counted(paint, screens), known)):
            known = _counted(paint, screens)
        wanted: Record = {} if known is None else {"color": known}
        if paint is not None and paint.metallic is not None:
            wanted["metallic"] = paint.metallic
        if paint is not None and paint.roughness is not None:
            wanted["smoothness"] = 1.0 - paint.roughness
        if not wanted and not material:
            return None
        return listed(self.draft, material, wanted, part.name)

    def _mass(self, definition: str, part: Part, found: Record) -> None:
        """Three of each: as computed, least, most; a part without a material has none."""
        body = part.weighed
        if not body or not body.get("hasMass") or float(body["mass"][0]) <= 0.0:
            return
        m = [float(v) for v in body["inertia"][:9]]
        moments, principal = (
            [m[0], m[4], m[8], m[1], m[5], m[2]],
            [float(v) for v in body["principalInertia"][:3]],
        )
        meshes = self.draft.meshes.get(definition, ())
        found["mass"] = mass_record(
            self.draft, part.name, float(body["mass"][0]), body["centroid"][:3], moments, principal, "centre", meshes
        )  # fmt: skip

    def _tell(self, form: str, votes: Votes) -> None:
        """Tell of the parts that were read otherwise than documented."""
        others: dict[str, list[str]] = {}
        for definition, off in votes.misfits.items():
            words = votes.of(definition)
            if off and words is not None and words != DOCUMENTED:
                others.setdefault(words, []).append(definition)
        for words, definitions in others.items():
            off = max(votes.misfits[definition][DOCUMENTED] for definition in definitions)
            self.draft.report.add(
                "CAPTURE_MESH_READING", program=self.draft.program, form=form, count=len(definitions),
                first=self.wanted[definitions[0]].name, off=f"{off:.2g}", words=words,
            )  # fmt: skip


def _weighed(body: Json) -> Said:
    """What an answer on mass says of a part's shape."""
    if not body:
        return Said()
    volume = float((body.get("volume") or (0.0,))[0])
    center = np.array([float(v) for v in body["centroid"][:3]]) if body.get("centroid") else None
    mass = float(body["mass"][0]) if body.get("hasMass") else 0.0
    tensor: Array | None = None
    if mass > 0.0:
        tensor = np.array([float(v) for v in body["inertia"][:9]]).reshape(3, 3) / mass
    return Said(volume, center, tensor) if volume > 0.0 or mass > 0.0 else Said()


def _shown(entry: Json) -> Numbers | None:
    """Red green blue, opacity of a listed part, as screens have them."""
    shown: Json = entry.get("appearance") or {}
    if not (rgb := shown.get("color")):
        return None
    return [rgb[key] / FULL for key in ("red", "green", "blue")] + [shown.get("opacity", FULL) / FULL]


def _as_screens_show(parts: list[Part]) -> bool:
    """Whether the files state colours as screens have them, where glTF has them linear: what most listed parts tell."""
    votes = 0
    for part in parts:
        color = _shown(part.entry) if isinstance(part.entry.get("appearance"), dict) else None
        if color is None or part.shape is None:
            continue
        stated = [paint for _, paint in part.shape.runs if paint is not None]
        as_glTF, as_screens = (
            any(_alike(_counted(paint, screens), linear_rgba(color)) for paint in stated)
            for screens in (False, True)
        )
        votes += int(as_screens) - int(as_glTF)
    return votes > 0


def _counted(paint: Paint, screens: bool) -> list[float]:
    """A paint's colour as a bundle counts it.  screens: the file has it as screens do."""
    return linear_rgba(paint.color) if screens else [min(1.0, max(0.0, v)) for v in paint.color]


def _alike(one: Numbers, two: Numbers) -> bool:
    return max(abs(p - q) for p, q in zip(one, two)) <= ALIKE


def stl(content: bytes) -> Shape:
    """A binary STL.  Raises ValueError where it is none."""
    count = struct.unpack_from("<I", content, STL_HEAD - 4)[0] if len(content) >= STL_HEAD else -1
    if len(content) != STL_HEAD + STL_FACET * count:
        raise ValueError("no binary STL")
    kind = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("count", "<u2")])
    points = np.frombuffer(content, kind, count, STL_HEAD)["corners"].reshape(-1, 3).astype(float)
    return Shape(points, None, np.arange(3 * count).reshape(-1, 3), [(count, None)])
