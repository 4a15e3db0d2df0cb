"""Onshape's answers: over REST with keys from the environment, from a folder of saved JSON, or from a record.

Every answer is kept by its question (``definition``, ``features``, ``matevalues``, ``name``, ``gltf ...``, ``stl ...``, ``mass ...``,
``box ...``, ``parts ...``, ``limits ...``), once.
"""

from __future__ import annotations

import base64
import json
import re
import time
import urllib.error
import urllib.request
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from http.client import HTTPException
from pathlib import Path
from typing import Any, cast
from urllib.parse import quote, urlencode, urlsplit

from ...diagnostics import KinefabError, Report
from ...geometry.references import read_regular
from ..channel import MemberFailed, NotSaved, RecordBroken
from .gltf import nameless

ADDRESS = re.compile(
    r"/documents/(?P<did>[0-9a-zA-Z]+)/(?P<wvm>[wvm])/(?P<wid>[0-9a-zA-Z]+)/e/(?P<eid>[0-9a-zA-Z]+)"
)
KEYS = ("ONSHAPE_ACCESS_KEY", "ONSHAPE_SECRET_KEY")
TRIES, LONGEST_WAIT = 3, 60.0
AGAIN = frozenset({429, 502, 503, 504})
"""Asked to wait, or nobody was there for the moment."""
HOME = "onshape.com"
OF_PARTS = frozenset({"gltf", "stl", "mass", "box", "parts", "limits"})
"""What is asked of other elements than the assembly itself; ``limits``: the features of an assembly inside it."""
GLTF = "model/gltf-binary;qs=0.08, model/gltf+json;charset=UTF-8;qs=0.08"
"""As the documentation of ``partid/gltf`` has it; either is read."""
FACETS = {"angleTolerance": "0.2", "chordTolerance": "0.0001", "outputFaceAppearances": "true"}
"""Radians and metres: without them a turned part of 12 cm has 240,000 triangles."""
VERSION = "v/"
SAVED = ("definition", "features", "matevalues", "name")


@dataclass(slots=True)
class Answers:
    """fetch: the answer to a question that is not kept yet, JSON or bytes; None where there is no program.
    by_hand: whether each answer is a file, saved by hand."""

    answers: dict[str, Any] = field(default_factory=dict[str, Any])
    fetch: Callable[[str], Any] | None = None
    by_hand: bool = False
    calls: int = 0

    @property
    def root(self) -> Answers:
        return self

    def ask(self, question: str) -> Any:
        """Raises MemberFailed."""
        if question not in self.answers:
            if self.by_hand:
                raise NotSaved(_asked(question), _file(question))
            if self.fetch is None:
                raise MemberFailed(question, "no such answer was saved")
            self.calls += 1
            found = self.fetch(question)
            self.answers[question] = (
                {"base64": base64.b64encode(found).decode()} if isinstance(found, bytes) else found
            )
        return self.answers[question]

    def bytes_of(self, question: str) -> bytes:
        return base64.b64decode(self.ask(question)["base64"])


@dataclass(frozen=True, slots=True)
class Rest:
    """An assembly behind an address of the browser.  base: scheme and host.  where: document, version and element.
    patience: seconds that an answer is waited for."""

    base: str
    where: Mapping[str, str]
    keys: tuple[str, str]
    sleep: Callable[[float], None] = time.sleep
    patience: float = 60.0

    def fetch(self, question: str) -> Any:
        w = self.where
        element = "{did}/{wvm}/{wid}/e/{eid}".format_map(w)
        if question == "definition":
            flags = {
                "includeMateFeatures": "true",
                "includeMateConnectors": "true",
                "includeNonSolids": "true",
            }
            return self._json(f"/api/assemblies/d/{element}?{urlencode(flags)}")
        if question == "name":
            listed = self._json("/api/documents/d/{did}/{wvm}/{wid}/elements".format_map(w))
            return [e for e in cast("list[dict[str, Any]]", listed) if e.get("id") == w["eid"]]
        kind, _, rest = question.partition(" ")
        if kind in OF_PARTS:
            return self._of_part(kind, *rest.split(" ", 4))
        return self._json(f"/api/assemblies/d/{element}/{question}")

    def _of_part(self, kind: str, did: str, state: str, eid: str, part: str, configuration: str) -> Any:
        """state: a microversion, or ``v/`` and a version.  What the keys may not see themselves, the document that links to it
        shows; that is allowed of versions only.  Of standard content it has the properties too."""
        asked = {"configuration": configuration}
        versioned = state.startswith(VERSION)
        linked = versioned and did != self.where["did"]
        if linked:
            asked["linkDocumentId"] = self.where["did"]
        state = quote(state) if versioned else f"m/{quote(state)}"
        studio = f"/api/parts/d/{quote(did)}/{state}/e/{quote(eid)}"
        if kind == "limits":
            return self._json(
                f"/api/assemblies/d/{quote(did)}/{state}/e/{quote(eid)}/features?{urlencode(asked)}"
            )
        if kind == "parts":
            return self._json(f"{studio}?{urlencode(asked)}")
        if kind == "mass":
            asked |= {"useMassPropertyOverrides": "true"} | ({"inferMetadataOwner": "true"} if linked else {})
            return self._json(f"{studio}/partid/{quote(part, safe='')}/massproperties?{urlencode(asked)}")
        own = f"{studio}/partid/{quote(part, safe='')}"
        if kind == "box":
            return self._json(f"{own}/boundingboxes?{urlencode(asked)}")
        if kind == "gltf":
            return self._get(f"{own}/gltf?{urlencode({**FACETS, **asked})}", GLTF)
        asked = {"mode": "binary", "units": "meter", **asked}
        return self._get(f"{own}/stl?{urlencode(asked)}", "*/*")

    def _json(self, path: str) -> Any:
        try:
            return json.loads(self._get(path, "application/json"))
        except (ValueError, RecursionError) as error:
            raise MemberFailed(path.partition("?")[0], f"no JSON: {error}") from error

    def _get(self, path: str, accept: str) -> bytes:
        request = urllib.request.Request(self.base + path, headers={"Accept": accept})
        _signed(request, self.keys)
        opener = urllib.request.build_opener(_Redirects(self.base, self.keys))
        member = path.partition("?")[0]
        for attempt in range(TRIES):
            try:
                with opener.open(request, timeout=self.patience) as answer:
                    content: bytes = answer.read()
                    return content
            except urllib.error.HTTPError as error:
                error.close()  # it is an answer too, and holds the connection
                if error.code not in AGAIN or attempt == TRIES - 1:
                    raise MemberFailed(member, _words(error.code)) from error
                asked = error.headers.get("Retry-After", "1")
                self.sleep(min(LONGEST_WAIT, float(asked) if asked.isdigit() else 1.0))
            except (OSError, HTTPException, ValueError) as error:  # ValueError: an address that is none
                raise MemberFailed(member, str(getattr(error, "reason", error))) from error
        raise AssertionError("the last try returns or raises")


def _signed(request: urllib.request.Request, keys: tuple[str, str]) -> None:
    login = base64.b64encode(":".join(keys).encode()).decode()
    request.add_unredirected_header("Authorization", f"Basic {login}")


class _Redirects(urllib.request.HTTPRedirectHandler):
    """Meshes lie at other hosts of Onshape's, which ask for the keys again; others have no business with them."""

    def __init__(self, base: str, keys: tuple[str, str]) -> None:
        self.base, self.keys = base, keys

    def redirect_request(
        self, req: urllib.request.Request, fp: Any, code: int, msg: str, headers: Any, newurl: str
    ) -> urllib.request.Request | None:
        found = super().redirect_request(req, fp, code, msg, headers, newurl)
        if found is not None and may_have_keys(self.base, newurl):
            _signed(found, self.keys)
        return found


def may_have_keys(base: str, address: str) -> bool:
    """Whether the keys for one address may be sent to another: its own host, or between hosts of Onshape, never less safely."""
    own, other = urlsplit(base), urlsplit(address)
    if (own.scheme, own.netloc) == (other.scheme, other.netloc):
        return True
    hosts = (own.hostname or "", other.hostname or "")
    return other.scheme == "https" and all(host.endswith(f".{HOME}") for host in hosts)


def _words(code: int) -> str:
    said = {
        401: "the keys are not accepted",
        402: "the plan's yearly number of calls is used up",
        403: "the keys have no right to this document, or the computer's clock is off",
        404: "there is no such document, or the keys may not see it",
        429: "too many calls for now",
    }
    other = "a redirect that leads nowhere" if code < 400 else "the server failed"
    return f"HTTP {code}: {said.get(code, other)}"


def opened(source: str, environment: Mapping[str, str], report: Report) -> Answers:
    """The answers behind an address, or of a folder of saved ones.  Raises KinefabError."""
    if not source.startswith(("http://", "https://")):
        return _saved(Path(source), report)
    parts = urlsplit(source)
    address = ADDRESS.search(parts.path)
    if address is None:
        raise KinefabError([report.add("CAPTURE_ADDRESS", address=source)])
    access, secret = (environment.get(key, "") for key in KEYS)
    if not access or not secret:
        raise KinefabError([report.add("CAPTURE_KEYS", keys=" and ".join(KEYS))])
    rest = Rest(f"{parts.scheme}://{parts.netloc}", address.groupdict(), (access, secret))
    return Answers(fetch=rest.fetch)


def _saved(source: Path, report: Report) -> Answers:
    """``definition.json`` and, beside it, ``features.json``, ``matevalues.json``, ``name.json`` and for a part its glTF or an STL in
    metres, ``ELEMENTID_PARTID.glb``, ``PARTID.stl`` and the like; of an assembly inside it ``ELEMENTID_features.json``."""
    folder = source if source.is_dir() else source.parent
    files = {word: folder / _file(word) for word in SAVED}
    if not source.is_dir():
        files["definition"] = source
    found = Answers(by_hand=True)
    _read_json(files, found, report)
    if "definition" not in found.answers:
        raise KinefabError([report.add("SOURCE_NOT_FOUND", path=files["definition"])])
    inner = [limits_question(assembly) for assembly in _assemblies(found.answers["definition"])[1:]]
    beside = {question: path for question in inner if (path := folder / _file(question)).parent == folder}
    _read_json(beside, found, report)
    for question, path in _meshes(found.answers["definition"], folder):
        try:
            found.answers[question] = {"base64": base64.b64encode(read_regular(path)).decode()}
        except OSError as error:
            report.dropped(
                f"mesh {path.name}", "CAPTURE_MEMBER_FAILED",
                program="Onshape", member=path.name, detail=error.strerror or str(error),
            )  # fmt: skip
    return found


def _read_json(files: Mapping[str, Path], found: Answers, report: Report) -> None:
    """files: by the question that each answers."""
    for question, path in files.items():
        try:
            if path.is_file():
                found.answers[question] = json.loads(path.read_text(encoding="utf-8-sig"))
        except (OSError, ValueError, RecursionError) as error:
            raise KinefabError([report.add("CAPTURE_RECORD", path.name, detail=str(error))]) from None


def _file(question: str) -> str:
    """What the answer is called when it is saved by hand."""
    kind, _, rest = question.partition(" ")
    return f"{rest.split(' ')[2]}_features.json" if kind == "limits" else f"{kind}.json"


def _asked(question: str) -> str:
    """What to ask Onshape for."""
    kind, _, rest = question.partition(" ")
    return f"features of the assembly {rest.split(' ')[2]}" if kind == "limits" else kind


def _meshes(definition: Any, folder: Path) -> list[tuple[str, Path]]:
    """The mesh files that are there for the parts of a definition, each with the question that it answers."""
    there = {path.name: path for path in folder.iterdir() if path.suffix in MESHES}
    found: dict[str, Path] = {}
    for owner in _assemblies(definition):
        for instance in _listed(owner.get("instances")):
            if not isinstance(instance, dict):
                continue
            entry = cast("dict[str, Any]", instance)
            part = str(entry.get("partId"))
            for stem in (f"{entry.get('elementId')}_{part}", part):
                for ending, asked in MESHES.items():
                    if (path := there.get(stem + ending)) is not None:
                        found.setdefault(asked(entry), path)
    return list(found.items())


def _assemblies(definition: Any) -> list[dict[str, Any]]:
    """The asked one first, then those inside it."""
    held = cast("dict[str, Any]", definition) if isinstance(definition, dict) else {}
    every = (held.get("rootAssembly"), *_listed(held.get("subAssemblies")))
    return [cast("dict[str, Any]", entry) if isinstance(entry, dict) else {} for entry in every]


def _listed(value: Any) -> list[Any]:
    return cast("list[Any]", value) if isinstance(value, list) else []


def gltf_question(instance: Mapping[str, Any]) -> str:
    """What is asked for the mesh of an instance's part, with its colours and normals."""
    return _question("gltf", instance, str(instance.get("partId")))


def stl_question(instance: Mapping[str, Any]) -> str:
    """What is asked for the mesh of an instance's part, where there is no glTF."""
    return _question("stl", instance, str(instance.get("partId")))


def box_question(instance: Mapping[str, Any]) -> str:
    """What is asked for the bounding box of an instance's part."""
    return _question("box", instance, str(instance.get("partId")))


def mass_question(instance: Mapping[str, Any]) -> str:
    """What is asked for the mass of an instance's part."""
    return _question("mass", instance, str(instance.get("partId")))


def limits_question(assembly: Mapping[str, Any]) -> str:
    """What is asked for the limits of the mates that an assembly inside the asked one states."""
    return _question("limits", assembly, "-")


def look_question(instance: Mapping[str, Any]) -> str:
    """What is asked for the looks of all parts of the Part Studio that an instance's part is of."""
    return _question("parts", instance, "-")


def _question(kind: str, instance: Mapping[str, Any], part: str) -> str:
    version = instance.get("documentVersion")
    state = f"{VERSION}{version}" if version else str(instance.get("documentMicroversion"))
    where = str(instance.get("documentId")), state, str(instance.get("elementId"))
    return " ".join([kind, *where, part, str(instance.get("configuration", "default"))])


def unnamed(answers: Mapping[str, Any]) -> dict[str, Any]:
    """The answers of a record without what names are in beside the fields of that kind: in files, and in what was not asked for."""
    found: dict[str, Any] = {}
    for question, answer in answers.items():
        if question.startswith("gltf ") and isinstance(answer, dict):
            content = base64.b64decode(cast("dict[str, Any]", answer).get("base64", ""))
            answer = {"base64": base64.b64encode(nameless(content)).decode()}
        elif question.startswith("parts ") and isinstance(answer, list):
            parts = [cast("dict[str, Any]", entry) for entry in answer if isinstance(entry, dict)]  # pyright: ignore[reportUnknownVariableType]
            answer = [{key: part[key] for key in sorted(LOOKED_AT & part.keys())} for part in parts]
        found[question] = answer
    return found


LOOKED_AT = frozenset({"partId", "appearance", "material"})
"""Of a listed part, what is read."""
MESHES: Mapping[str, Callable[[Mapping[str, Any]], str]] = {
    ".glb": gltf_question, ".gltf": gltf_question, ".stl": stl_question,
}  # fmt: skip
"""Endings of saved meshes: what each answers."""


def replayed(answers: object) -> Answers:
    """The answers of a record.  Raises RecordBroken."""
    if not isinstance(answers, dict):
        raise RecordBroken("it holds no answers by their questions")
    return Answers(cast("dict[str, Any]", answers))
