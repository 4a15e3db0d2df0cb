"""Onshape's assembly definition: instances and occurrences as components with ids that people can read."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from ..channel import MemberFailed
from ..draft import Draft, Record, pose_of_rows
from ..held import hold, standing
from .parts import Parts

Json = dict[str, Any]
IDENTITY = [1.0, 0, 0, 0, 0, 1.0, 0, 0, 0, 0, 1.0, 0, 0, 0, 0, 1.0]


@dataclass(slots=True)
class Definition:
    """An assembly definition.  ids: component of each path of instance ids.
    owners: the root and each sub-assembly, by path.
    still: the paths of the assemblies that stand still in the root.
    held: of one that may move the first instance that is fixed in it; all others go with that one.
    """

    parts: Parts
    draft: Draft
    root: str
    values: Json
    ids: dict[tuple[str, ...], str] = field(default_factory=dict[tuple[str, ...], str])
    owners: dict[tuple[str, ...], Json] = field(default_factory=dict[tuple[str, ...], Json])
    still: set[tuple[str, ...]] = field(default_factory=lambda: {()})
    held: dict[str, str] = field(default_factory=dict[str, str])

    def read(self) -> None:
        """Fill the draft's components; ``owners`` becomes the root and every occurrence of a sub-assembly."""
        top = self.values["rootAssembly"]
        subs = {_key(sub): sub for sub in self.values.get("subAssemblies", [])}
        occurrences = {tuple(o["path"]): o for o in top.get("occurrences", [])}
        self.owners[()] = top
        if (chosen := top.get("configuration", "default")) != "default":
            self.draft.configuration = chosen
        self._level(top, (), self.root, subs, occurrences)
        self.parts.read()
        for component in self.draft.components:
            component.update(self.parts.found.get(component.get("definition", ""), {}))

    def _level(
        self,
        assembly: Json,
        path: tuple[str, ...],
        parent: str,
        subs: dict[Any, Json],
        found: dict[tuple[str, ...], Json],
    ) -> None:
        names: dict[str, int] = {}
        for instance in assembly.get("instances", []):
            with self.draft.safely(f"an instance of {parent}"):
                self._instance(instance, path, parent, subs, found, names)

    def _instance(
        self, instance: Json, path: tuple[str, ...], parent: str, subs: dict[Any, Json],
        found: dict[tuple[str, ...], Json], names: dict[str, int],
    ) -> None:  # fmt: skip
        own_path = (*path, instance["id"])
        name = str(instance["name"]).replace("/", "_")
        names[name] = names.get(name, 0) + 1
        name = name if names[name] == 1 else f"{name} ({names[name]})"
        own = f"{parent}/{name}"
        is_assembly = instance.get("type") == "Assembly"
        record: Record = {
            "id": own,
            "name": name,
            "kind": "assembly" if is_assembly else "part",
            "parent": parent,
        }
        occurrence = found.get(own_path)
        if instance.get("suppressed") or occurrence is None:
            self.ids[own_path] = own
            self.draft.component({**record, "pose": pose_of_rows(IDENTITY), "suppressed": True})
            return
        record["pose"] = pose_of_rows([float(v) for v in occurrence["transform"]])
        self.ids[own_path] = own
        fixed = bool(occurrence.get("fixed", False))  # to its own assembly, which may move
        record["grounded"] = fixed and path in self.still
        record["visible"] = not occurrence.get("hidden", False)
        record["definition"] = " ".join(str(v) for v in (*_key(instance), instance.get("partId", "")))
        self.draft.component(record)
        if fixed and not record["grounded"]:
            hold(self.draft, self.held, parent, own)
        if is_assembly:
            record["flexible"] = True  # nothing in the answers says that one is rigid
            if record["grounded"]:
                self.still.add(own_path)
            sub = subs.get(_key(instance))
            if sub is None:
                lost = MemberFailed("subAssemblies", "this one is not listed")
                self.draft.failed(f"what is in {own}", lost)
                return
            self.owners[own_path] = sub
            self._level(sub, own_path, own, subs, found)
        else:
            self.parts.want(record["definition"], record["name"], instance)

    def component(self, owner: tuple[str, ...], path: list[str]) -> tuple[str, str]:
        """Id of what moves as what a feature of ``owner`` names does, and of what its frame is stated in.

        An empty path is ``owner`` itself; for an assembly, which is no body, stands what is fixed in it.  Raises KeyError.
        """
        whole = (*owner, *path)
        own = self.ids[whole] if whole else self.root
        if whole not in self.owners:
            return own, "part"
        return standing(self.held, own, whole in self.still), own if whole else "world"


def _key(entry: Json) -> tuple[Any, ...]:
    return tuple(entry.get(k) for k in ("documentId", "documentMicroversion", "elementId", "configuration"))
